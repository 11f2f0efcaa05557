//! `[exact]`: analytical solutions with which a run is compared.

use pericles::kernel::{ActsOn, InfluenceFunction};
use pericles_deck_derive::{DeckKeys, DeckTable};
use serde::{Deserialize, Serialize};

use crate::declaration::{Check, DeckTable};
use crate::fault::Fault;
use crate::key_path::KeyPath;
use crate::material::Material;
use crate::reader::Table;

/// Bars: analytical solution. history.csv then has columns with the error of the run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = ExactScope)]
pub struct Exact {
    /// The solution.
    #[deck(flatten)]
    pub solution: KnownSolution,
    /// Only points within this distance of the centre enter the error. Default: all points.
    ///
    /// In m; the centre is that of the pulse or the origin.
    #[serde(default)]
    #[deck(quantity = Length, range = POSITIVE)]
    pub window: Option<f64>,
    /// Start from the analytical solution; replaces the displacement of `[[initial]]`.
    #[serde(default)]
    #[deck(default = false)]
    pub start: bool,
}

/// Analytical solution. `nonlocal-pulse`: Gaussian initial displacement on an infinite bar with a Gaussian micromodulus;
/// `local-pulse`: the same for the local wave equation; `stretched-bar`: local bar fixed at x = 0, released from a uniform
/// strain; `bar-mode`: lowest vibration mode of that bar.
///
/// The solutions have the modulus, density and micromodulus of the material.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[deck(tag = "solution", what = "exact solution", scope = ExactScope)]
pub enum KnownSolution {
    /// Gaussian initial displacement on an infinite nonlocal bar with a Gaussian micromodulus.
    NonlocalPulse {
        /// The initial displacement.
        #[deck(flatten)]
        pulse: Pulse,
        /// Length of the micromodulus, m.
        #[deck(flatten, keys(), with = micromodulus_length, check = check_length)]
        length: f64,
    },
    /// The same for the local wave equation.
    LocalPulse(#[deck(flatten)] Pulse),
    /// Local bar fixed at x = 0, released from a uniform strain.
    StretchedBar {
        /// stretched-bar, bar-mode: length of the bar.
        ///
        /// In m.
        #[deck(quantity = Length, range = POSITIVE)]
        length: f64,
        /// stretched-bar: initial strain.
        #[deck(quantity = Number)]
        strain: f64,
    },
    /// The lowest vibration mode of that bar.
    BarMode {
        /// stretched-bar, bar-mode: length of the bar.
        ///
        /// In m.
        #[deck(quantity = Length, range = POSITIVE)]
        length: f64,
        /// Pulses, bar-mode: amplitude.
        ///
        /// In m.
        #[deck(quantity = Length)]
        amplitude: f64,
    },
}

/// u = amplitude · exp(−((x − centre)/width)²), initially at rest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
pub struct Pulse {
    /// Pulses: width w of u = amplitude · exp(−((x − centre)/w)²), initially at rest.
    ///
    /// In m.
    #[deck(quantity = Length, range = POSITIVE)]
    pub width: f64,
    /// Pulses, bar-mode: amplitude.
    ///
    /// In m.
    #[deck(quantity = Length)]
    pub amplitude: f64,
    /// Pulses: position of the maximum.
    ///
    /// In m.
    #[deck(quantity = Length, default = 0.0)]
    pub centre: f64,
}

/// Scope of `[exact]`.
#[derive(Clone, Copy)]
pub(crate) struct ExactScope {
    /// Length of the Gaussian micromodulus, `Some(None)` for other micromoduli, none if the material could not be read.
    pub(crate) gaussian: Option<Option<f64>>,
}

/// Reads `[exact]` of a body of some dimension.
pub(crate) fn read(table: Table<'_>, dimension: Option<usize>, scope: ExactScope) -> Option<Exact> {
    if dimension.is_some_and(|dimension| dimension != 1) {
        table.report(Fault::NoExactSolution {
            reason: "exact solutions are available for bars only",
        });
    }
    Exact::read_table(table, scope)
}

fn check_length(length: &f64, path: &KeyPath, _: ExactScope, check: &mut Check) {
    check.positive(path.key("length"), *length);
}

/// Returns the length of the micromodulus of the material.
fn micromodulus_length(table: &Table<'_>, scope: ExactScope) -> Option<f64> {
    let length = scope.gaussian?;
    if let (None, Some(item)) = (length, table.optional("solution")) {
        item.report(Fault::NoExactSolution {
            reason: "it requires model = \"linear\" with influence = { function = \"gaussian\", acts_on = \"displacement\" } and horizon = \"infinite\"",
        });
    }
    length
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
