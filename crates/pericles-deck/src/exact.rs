//! `[exact]`: analytical solutions with which a run is compared.

use pericles::kernel::{ActsOn, InfluenceFunction};
use serde::{Deserialize, Serialize};

use crate::fault::Fault;
use crate::material::Material;
use crate::quantity::Quantity;
use crate::reader::Table;

/// Comparison with an analytical solution.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exact {
    /// The solution.
    pub solution: KnownSolution,
    /// Half-width of the window of comparison around the centre of the pulse or the origin, m; none for all points.
    #[serde(default)]
    pub window: Option<f64>,
    /// Whether the initial displacement is taken from the solution.
    #[serde(default)]
    pub start: bool,
}

/// Analytical solutions of finite and infinite bars with the modulus, density and micromodulus of the material.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum KnownSolution {
    /// Gaussian initial displacement on an infinite nonlocal bar with a Gaussian micromodulus.
    NonlocalPulse {
        /// The initial displacement.
        pulse: Pulse,
        /// Length of the micromodulus, m.
        length: f64,
    },
    /// The same for the local wave equation.
    LocalPulse(Pulse),
    /// Local bar fixed at x = 0, released from a uniform strain.
    StretchedBar {
        /// Length of the bar, m.
        length: f64,
        /// Initial strain.
        strain: f64,
    },
    /// The lowest vibration mode of that bar.
    BarMode {
        /// Length of the bar, m.
        length: f64,
        /// Amplitude, m.
        amplitude: f64,
    },
}

/// u = amplitude · exp(−((x − centre)/width)²), initially at rest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pulse {
    /// Width, m.
    pub width: f64,
    /// Amplitude, m.
    pub amplitude: f64,
    /// Position of the maximum, m.
    pub centre: f64,
}

#[derive(Clone, Copy)]
enum Kind {
    NonlocalPulse,
    LocalPulse,
    StretchedBar,
    BarMode,
}

/// Reads `[exact]`. `gaussian`: the length of the Gaussian micromodulus, `Some(None)` for other micromoduli,
/// none if the material could not be read.
pub(crate) fn read(
    table: Table<'_>,
    dimension: Option<usize>,
    gaussian: Option<Option<f64>>,
) -> Option<Exact> {
    const KINDS: [(&str, Kind); 4] = [
        ("nonlocal-pulse", Kind::NonlocalPulse),
        ("local-pulse", Kind::LocalPulse),
        ("stretched-bar", Kind::StretchedBar),
        ("bar-mode", Kind::BarMode),
    ];
    if dimension.is_some_and(|dimension| dimension != 1) {
        table.report(Fault::NoExactSolution {
            reason: "exact solutions are available for bars only",
        });
    }
    let item = table.required("solution")?;
    let kind = item.choice("exact solution", &KINDS)?;
    let length = |key| {
        table
            .required(key)
            .and_then(|item| item.positive(Quantity::Length))
    };
    let amplitude = |quantity| {
        let key = if matches!(quantity, Quantity::Length) {
            "amplitude"
        } else {
            "strain"
        };
        table.required(key).and_then(|item| item.quantity(quantity))
    };
    let pulse = || {
        let (width, amplitude) = (length("width"), amplitude(Quantity::Length));
        let centre = table.or("centre", 0.0, |item| item.quantity(Quantity::Length));
        Some(Pulse {
            width: width?,
            amplitude: amplitude?,
            centre: centre?,
        })
    };
    let solution = match kind {
        Kind::NonlocalPulse => {
            let pulse = pulse();
            let length = gaussian.and_then(|length| {
                if length.is_none() {
                    item.report(Fault::NoExactSolution {
                        reason: "it requires model = \"linear\" with influence = { function = \"gaussian\", acts_on = \"displacement\" } and horizon = \"infinite\"",
                    });
                }
                length
            });
            pulse
                .zip(length)
                .map(|(pulse, length)| KnownSolution::NonlocalPulse { pulse, length })
        }
        Kind::LocalPulse => pulse().map(KnownSolution::LocalPulse),
        Kind::StretchedBar => {
            let (length, strain) = (length("length"), amplitude(Quantity::Number));
            length
                .zip(strain)
                .map(|(length, strain)| KnownSolution::StretchedBar { length, strain })
        }
        Kind::BarMode => {
            let (length, amplitude) = (length("length"), amplitude(Quantity::Length));
            length
                .zip(amplitude)
                .map(|(length, amplitude)| KnownSolution::BarMode { length, amplitude })
        }
    };
    let window = table.maybe("window", |item| item.positive(Quantity::Length));
    let start = table.or("start", false, |item| item.boolean());
    table.finish();
    Some(Exact {
        start: start?,
        solution: solution?,
        window: window?,
    })
}

/// Returns the length of a Gaussian micromodulus without a significant cutoff.
pub(crate) fn gaussian_length(material: &Material) -> Option<f64> {
    /// Number of lengths beyond which the Gaussian is below 1e-16.
    const ALL: f64 = 6.1;
    let bonds = material.bonds()?;
    match &bonds.influence.function {
        InfluenceFunction::Gaussian { length, cutoff }
            if bonds.influence.acts_on == ActsOn::Displacement
                && bonds.law == pericles::material::PairLaw::Linear
                && cutoff.unwrap_or(bonds.horizon) >= ALL * length =>
        {
            Some(*length)
        }
        _ => None,
    }
}
