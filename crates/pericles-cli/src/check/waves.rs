//! Lines of `check` about plane waves.

use pericles_deck::Model;
use pericles_run::units::{percent, quantity, significant};
use pericles_run::{Assembly, KernelQuality};
use serde_json::json;

use super::line::Line;

/// Returns the lines about dispersion by the kernel and by the grid.
pub(super) fn plane_waves(model: &Model, assembly: &Assembly) -> Vec<Line> {
    let Some(waves) = assembly.plane_waves(model) else {
        return Vec::new();
    };
    let grid = waves.grid;
    let tolerance = percent(grid.tolerance);
    let length = std::f64::consts::TAU / grid.wavenumber;
    let spacings = length / assembly.cloud.spacing();
    let mut lines = Vec::new();
    if let Some(longest) = waves.model {
        let horizons = longest / model.body.horizon();
        let text = format!(
            "phase speed within {tolerance} of the long-wave limit for wavelengths above {} ({} horizons)",
            quantity(longest, "m"),
            significant(horizons, 3)
        );
        let value =
            json!({ "tolerance": grid.tolerance, "wavelength": longest, "horizons": horizons });
        lines.push(Line::new("kernel dispersion", text).with("kernel_dispersion", value));
    }
    let reference = match waves.model {
        Some(_) => "the nonlocal continuum",
        None => "the long-wave limit",
    };
    let text = format!(
        "phase speed within {tolerance} of {reference} for wavelengths above {} ({} spacings)",
        quantity(length, "m"),
        significant(spacings, 3)
    );
    let value = json!({ "tolerance": grid.tolerance, "wavelength": length, "spacings": spacings });
    lines.push(Line::new("grid dispersion", text).with("grid_dispersion", value));
    let table = (model.body.solid()).and_then(|solid| solid.material.tuned.as_ref());
    if let (Some(pair), Some(table)) = (waves.tuning, table) {
        lines.push(tuned_kernel(pair, table.tuning.lower_bound));
    }
    lines
}

/// Compares a tuned kernel with a constant one.
fn tuned_kernel([tuned, constant]: [KernelQuality; 2], lower_bound: Option<f64>) -> Line {
    const TOLERANCE: f64 = 0.01;
    let shortest = KernelQuality::SHORTEST;
    let bound = match lower_bound {
        Some(bound) => format!("; coefficients ≥ {bound}"),
        None => String::new(),
    };
    let text = format!(
        "phase speed within {} of the long-wave limit above {} spacings per wavelength (constant kernel: {}); largest error above {shortest} spacings {} (constant: {}){bound}",
        percent(TOLERANCE),
        significant(tuned.spacings, 3),
        significant(constant.spacings, 3),
        percent(tuned.worst),
        percent(constant.worst)
    );
    let quality = |quality: KernelQuality| json!({ "spacings": quality.spacings, "largest_error": quality.worst });
    let value = json!({
        "tolerance": TOLERANCE,
        "shortest_spacings": shortest,
        "tuned": quality(tuned),
        "constant": quality(constant),
        "lower_bound": lower_bound,
    });
    Line::new("tuned kernel", text).with("tuned_kernel", value)
}
