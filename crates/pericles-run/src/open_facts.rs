//! Properties of open boundaries for reports.

use pericles_waves::absorbing::open::IncidentWave;
use serde::Serialize;

use crate::build::OpenReport;
use crate::units::{bytes, percent, quantity, significant};

/// Properties of an open boundary; SI units.
#[derive(Debug, Clone, Serialize)]
pub struct OpenFacts {
    /// The open sides, such as `+x`.
    pub sides: Vec<String>,
    /// Number of cells of the layer at each side.
    pub cells: Vec<usize>,
    /// Points in the layers relative to all points.
    pub share: f64,
    /// Memory of the layers, bytes.
    pub memory: u64,
    /// Expected reflection of the thinnest layer.
    pub reflection: Vec<ReflectionFacts>,
}

/// Expected reflection of waves of one length.
#[derive(Debug, Clone, Serialize)]
pub struct ReflectionFacts {
    /// Wavelength in spacings.
    pub spacings: f64,
    /// Wavelength, m.
    pub wavelength: f64,
    /// Angle of incidence in degrees, and the reflection coefficient: the larger one of longitudinal and transverse waves.
    pub by_angle: Vec<[f64; 2]>,
}

impl OpenFacts {
    /// Wavelengths in spacings.
    const WAVELENGTHS: [f64; 4] = [6.0, 8.0, 12.0, 24.0];
    /// Angles of incidence, degrees.
    const ANGLES: [f64; 4] = [0.0, 45.0, 60.0, 80.0];

    pub(crate) fn of(report: &OpenReport, points: usize, spacing: f64) -> Self {
        let sides: Vec<_> = report.sides.open_sides().collect();
        let thinnest = sides.iter().map(|side| side.1).min().unwrap_or(0);
        let coefficient = |wavelength: f64, degrees: f64| {
            let wave = |is_shear| IncidentWave {
                wavelength,
                angle: degrees.to_radians(),
                is_shear,
            };
            let of =
                |is_shear| wave(is_shear).reflection(&report.weights, &report.options, thinnest);
            [false, true].into_iter().filter_map(of).fold(0.0, f64::max)
        };
        let waves = |spacings: f64| ReflectionFacts {
            spacings,
            wavelength: spacings * spacing,
            by_angle: Self::ANGLES
                .map(|angle| [angle, coefficient(spacings, angle)])
                .to_vec(),
        };
        Self {
            sides: sides.iter().map(|side| side.0.to_string()).collect(),
            cells: sides.iter().map(|side| side.1).collect(),
            share: report.points as f64 / points as f64,
            memory: report.bytes as u64,
            reflection: Self::WAVELENGTHS.map(waves).to_vec(),
        }
    }

    /// Returns a summary line.
    pub fn line(&self) -> String {
        let sides = self.sides.iter().zip(&self.cells);
        let sides: Vec<String> = sides
            .map(|(side, cells)| format!("{side} ({cells} cells)"))
            .collect();
        format!(
            "{}; layers have {} of the points and {} of memory (experimental)",
            sides.join(", "),
            percent(self.share),
            bytes(self.memory)
        )
    }
}

impl ReflectionFacts {
    /// Returns a summary line.
    pub fn line(&self) -> String {
        let angles = self.by_angle.iter();
        let angles: Vec<String> = angles
            .map(|[angle, reflection]| format!("{} at {angle}°", significant(*reflection, 1)))
            .collect();
        format!(
            "of waves of {} ({} spacings): {}",
            quantity(self.wavelength, "m"),
            self.spacings,
            angles.join(", ")
        )
    }
}
