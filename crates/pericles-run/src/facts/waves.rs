//! Facts of plane waves.

use pericles_deck::Model;
use serde_json::json;

use super::list::{Facts, Section};
use crate::build::{Assembly, KernelQuality};
use crate::units::{percent, quantity, significant};

impl Facts {
    /// Adds dispersion by the kernel and by the grid.
    pub(super) fn plane_waves(&mut self, model: &Model, assembly: &Assembly) {
        let Some(waves) = assembly.plane_waves(model) else {
            return;
        };
        let grid = waves.grid;
        let tolerance = percent(grid.tolerance);
        let length = std::f64::consts::TAU / grid.wavenumber;
        let spacings = length / assembly.cloud.spacing();
        if let Some(longest) = waves.model {
            let horizons = longest / model.body.horizon();
            let text = format!(
                "phase speed within {tolerance} of the long-wave limit for wavelengths above {} ({} horizons)",
                quantity(longest, "m"),
                significant(horizons, 3)
            );
            let value =
                json!({ "tolerance": grid.tolerance, "wavelength": longest, "horizons": horizons });
            self.line(Section::Waves, "kernel dispersion", text)
                .checked("kernel_dispersion", "", value);
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
        let value =
            json!({ "tolerance": grid.tolerance, "wavelength": length, "spacings": spacings });
        self.line(Section::Waves, "grid dispersion", text)
            .checked("grid_dispersion", "", value);
        let table = (model.body.solid()).and_then(|solid| solid.material.tuned.as_ref());
        if let (Some(pair), Some(table)) = (waves.tuning, table) {
            self.tuned_kernel(pair, table.tuning.lower_bound);
        }
    }

    /// Compares a tuned kernel with a constant one.
    fn tuned_kernel(&mut self, [tuned, constant]: [KernelQuality; 2], lower_bound: Option<f64>) {
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
        self.line(Section::Waves, "tuned kernel", text)
            .checked("tuned_kernel", "", value);
    }
}
