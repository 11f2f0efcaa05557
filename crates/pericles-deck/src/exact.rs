//! `[exact]`: a known solution, from which the distance is written.

use pericles::kernel::{ActsOn, InfluenceFunction};
use serde::{Deserialize, Serialize};

use crate::fault::Fault;
use crate::material::Material;
use crate::quantity::Quantity;
use crate::reader::Table;

/// A solution to compare with.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Exact {
    /// Which.
    pub solution: KnownSolution,
    /// Points that count: those within this distance of the pulse's middle or of the origin, m; all if none.
    #[serde(default)]
    pub window: Option<f64>,
    /// Whether the body starts as the solution does.
    #[serde(default)]
    pub start: bool,
}

/// Solutions of bars and lines; modulus, density and micromodulus are those of the material.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum KnownSolution {
    /// A Gaussian start on the line with a Gaussian micromodulus of this length.
    NonlocalPulse {
        /// The start.
        pulse: Pulse,
        /// The length of the micromodulus, m.
        length: f64,
    },
    /// The same start on the local string.
    LocalPulse(Pulse),
    /// The local bar released from uniform strain, held at x = 0.
    StretchedBar {
        /// Its length, m.
        length: f64,
        /// The strain.
        strain: f64,
    },
    /// Its slowest vibration.
    BarMode {
        /// Its length, m.
        length: f64,
        /// The height, m.
        amplitude: f64,
    },
}

/// u = amplitude · exp(−((x − centre)/width)²), at rest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Pulse {
    /// m
    pub width: f64,
    /// m
    pub amplitude: f64,
    /// m
    pub centre: f64,
}

#[derive(Clone, Copy)]
enum Kind {
    NonlocalPulse,
    LocalPulse,
    StretchedBar,
    BarMode,
}

/// `[exact]`; `gaussian` is the length of the Gaussian micromodulus, none of a body that has another one, and unknown if the material could not be read.
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
            reason: "they are known for bars only",
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
                        reason: "it belongs to model = \"linear\" with influence = { function = \"gaussian\", acts_on = \"displacement\" } and horizon = \"infinite\"",
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

/// The length of a Gaussian micromodulus that is nowhere cut.
pub(crate) fn gaussian_length(material: &Material) -> Option<f64> {
    /// Lengths beyond which the Gaussian is below 1e-16 of its height.
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
