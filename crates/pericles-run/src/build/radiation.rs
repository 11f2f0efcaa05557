//! Temperatures of bodies with radiation, which must be absolute.

use pericles::space::PointCloud;
use pericles::units::quantity;
use pericles_deck::{
    BuildError, Caution, Component, Fault, KeyPath, ModelWarning, Remark, Thermal, ThermalAmplitude,
};

use super::refusal::at_path;

/// Temperatures that are likely to be in degrees Celsius if there is radiation, K: below are temperatures of outer space,
/// above those of liquid nitrogen.
const DOUBTFUL: std::ops::Range<f64> = 5.0..75.0;

/// Rejects negative temperatures of a body with radiation, whose law holds for absolute temperatures, and warns of those
/// that are likely to be in degrees Celsius. `start` are the initial temperatures.
pub(super) fn judge_radiation(
    thermal: &Thermal,
    cloud: &PointCloud,
    start: &[f64],
) -> Result<Vec<ModelWarning>, BuildError> {
    let conduction = thermal.conduction.iter();
    let conditions: Vec<_> = conduction
        .flat_map(|own| &own.conditions)
        .enumerate()
        .collect();
    let radiates =
        |amplitude: &ThermalAmplitude| matches!(amplitude, ThermalAmplitude::Radiation { .. });
    if !conditions.iter().any(|(_, own)| radiates(&own.amplitude)) {
        return Ok(Vec::new());
    }
    let lowest = |value: &Component| {
        let values = (0..cloud.len()).map(|i| value.value(cloud.point(i), 0.0));
        values.fold(f64::INFINITY, f64::min)
    };
    let initial = start.iter().copied().fold(f64::INFINITY, f64::min);
    let key = match thermal.file {
        Some(_) => "file",
        None => "temperature",
    };
    let mut all = vec![(KeyPath::from("thermal").key(key), initial)];
    for (k, condition) in conditions {
        let path = KeyPath::from("thermal").key("condition").index(k);
        all.extend(match &condition.amplitude {
            ThermalAmplitude::Temperature(value) => Some((path.key("temperature"), lowest(value))),
            ThermalAmplitude::Radiation { ambient, .. } => {
                Some((path.key("radiation").key("ambient"), lowest(ambient)))
            }
            ThermalAmplitude::Convection { ambient, .. } => {
                Some((path.key("convection").key("ambient"), lowest(ambient)))
            }
            ThermalAmplitude::Flux(_) | ThermalAmplitude::Source(_) => None,
        });
    }
    let mut warnings = Vec::new();
    for (path, value) in all {
        if value < 0.0 {
            let fault = Fault::OutOfRange {
                value: quantity(value, "K"),
                allowed: "allowed with radiation: absolute temperatures, at least 0 K; add 273.15 to a temperature in °C"
                    .into(),
            };
            return Err(at_path(path, fault));
        }
        if DOUBTFUL.contains(&value) {
            warnings.push(Remark::new(path, Caution::ColdRadiation { value }));
        }
    }
    Ok(warnings)
}
