//! Unlikely coefficients of thermal expansion, and temperatures of bodies with radiation, which must be absolute.

use pericles::space::PointCloud;
use pericles::units::quantity;
use pericles_deck::{
    BuildError, Caution, Component, Fault, KeyPath, ModelWarning, Property, Remark, Thermal,
    ThermalAmplitude,
};

use super::assembler::Assembler;
use super::rejection::at_path;

/// Temperatures that are likely to be in degrees Celsius if there is radiation, K: below are temperatures of outer space,
/// above those of liquid nitrogen.
const DOUBTFUL: std::ops::Range<f64> = 5.0..75.0;

/// Rejects negative temperatures of a body with radiation, whose law holds for absolute temperatures, and warns of those
/// that are likely to be in degrees Celsius. `start` are the initial temperatures.
pub(super) fn check_radiation(
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
            let problem = format!(
                "the temperature is {} in a body with radiation, which depends on absolute temperatures; add 273.15 to \
                 temperatures in °C",
                quantity(value, "K")
            );
            warnings.push(Remark::new(path, Caution::ImplausibleHeat { problem }));
        }
    }
    Ok(warnings)
}

impl Assembler<'_> {
    /// Warns of coefficients of thermal expansion that no solid has.
    pub(super) fn check_expansion(&self) -> Vec<ModelWarning> {
        /// Largest coefficient of solids with a margin, 1/K: rubber has 2e-4.
        const LARGEST: f64 = 0.01;
        let Some(thermal) = &self.model.thermal else {
            return Vec::new();
        };
        let key = KeyPath::from("thermal");
        let own = thermal.materials.iter().enumerate();
        let own = own.filter_map(|(k, material)| {
            let key = key.key("material").index(k).key("expansion");
            Some((key, material.expansion.as_ref()?.number()?))
        });
        let all = thermal.expansion.as_ref().and_then(Property::number);
        let all = all.map(|value| (key.key("expansion"), value));
        let large = all
            .into_iter()
            .chain(own)
            .filter(|(_, value)| value.abs() > LARGEST);
        let caution = |(key, value)| {
            let problem = format!(
                "the coefficient of thermal expansion is {value} 1/K, larger than that of any solid (steel: 12e-6 1/K); \
                 check its unit"
            );
            Remark::new(key, Caution::ImplausibleHeat { problem })
        };
        large.map(caution).collect()
    }
}
