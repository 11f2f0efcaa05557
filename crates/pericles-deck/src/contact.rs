//! `[contact]`: forces between points that no bond joins.

use pericles_deck_derive::{DeckKeys, DeckTable, DeckWords};
use serde::{Deserialize, Serialize};

use crate::declaration::{Check, DeckValue, Fallback};
use crate::key_path::KeyPath;
use crate::quantity::Quantity;
use crate::range::{Range, above_to};
use crate::reader::{Item, Table};
use crate::units;

/// Contact forces between points that no bond joins. Without this table, points of a body do not interact by contact;
/// impactors use the defaults.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(default, deny_unknown_fields)]
#[deck(default)]
pub struct Contact {
    /// Contact law.
    #[deck(flatten, default)]
    pub law: ContactLaw,
    /// Pairs of points that may be in contact. `unbonded`: points without an intact bond, so that crack faces, fragments
    /// and pieces are in contact. `pieces`: points of different pieces. `all`: bonded points too, which keeps points of
    /// strongly compressed bodies apart; the default for law = "emu".
    #[deck(default = usual_pairs(law))]
    pub pairs: ContactPairs,
    /// Contact stiffness: χ in k = χ E V/δ² with Young's modulus E, the volume V of a point and the horizon δ (a
    /// number), or k itself ("3 MN/m"). Above 2.25 contact raises the highest frequency of the body by more than 9 %.
    #[deck(
        default,
        forbid_if(is_emu(law), "law = \"emu\" has the stiffness 15 c V V/δ")
    )]
    pub stiffness: ContactStiffness,
    /// Contact distance β in mean cell sizes. Default 1.35 for law = "emu". Impactors are in contact with a point at half
    /// of its cell size.
    #[deck(range = POSITIVE, default = usual_distance(law))]
    pub distance: f64,
    /// Contact distance θ in initial distances of the two points: d = min(θ |ξ|, β h). With 1, a bond that breaks in
    /// tension starts contact without a force, and a crack that closes carries load at once. Default 0.9 for
    /// pairs = "all".
    #[deck(range = closing_range(pairs), default = usual_closing(pairs))]
    pub closing: f64,
    /// Damping ratio ζ of a pair of points. It suppresses oscillations of the contact force; the coefficient of
    /// restitution of bodies hardly depends on it.
    #[deck(range = at_least(0.0), default = 0.0)]
    pub damping: f64,
    /// Coulomb friction.
    pub friction: Option<ContactFriction>,
}

/// Coulomb friction of points in contact: F_t = −μ F_n w_t/√(w_t² + v²) with the sliding velocity w_t. On impactors
/// friction is not regularised.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
pub struct ContactFriction {
    /// Coefficient of friction μ.
    #[deck(range = at_least(0.0))]
    pub coefficient: f64,
    /// Sliding speed v below which friction between points decreases. Points on a slope creep at about this speed.
    ///
    /// In m/s.
    #[deck(quantity = Velocity, range = POSITIVE)]
    pub speed: f64,
}

/// Pairs of points that may be in contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, DeckWords)]
#[serde(rename_all = "kebab-case")]
#[deck(what = "kind of pairs")]
pub enum ContactPairs {
    /// Points without an intact bond.
    #[default]
    Unbonded,
    /// Points of different pieces.
    Pieces,
    /// All points.
    All,
}

/// Contact force F for the overlap g and the contact distance d. `linear`: F = k g. `power`: F = k d (g/d)^p. `emu`:
/// F = k g with k = 15 c V V/δ and the micromodulus c (Silling & Askari 2005), which decreases with the fifth power of
/// the horizon ratio.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "kebab-case")]
#[deck(tag = "law", what = "contact law")]
pub enum ContactLaw {
    /// F = k g.
    #[default]
    Linear,
    /// F = k d (g/d)^p with the contact distance d.
    Power(
        /// law = "power": exponent p. 1.5 is the exponent of Hertz.
        #[deck(key = "exponent", range = at_least(1.0))]
        f64,
    ),
    /// F = k g with the stiffness 15 c V V/δ of Silling and Askari (2005), c the micromodulus.
    Emu,
}

/// Contact stiffness.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ContactStiffness {
    /// k = χ E V/δ² with this χ.
    Relative(f64),
    /// k, N/m.
    Absolute(f64),
}

impl Default for ContactStiffness {
    fn default() -> Self {
        Self::Relative(RELATIVE)
    }
}

/// Default of the relative stiffness χ: the stiffest contact that raises the highest frequency of a body by less than
/// 9 %.
const RELATIVE: f64 = 2.25;

/// Largest θ with `pairs = "all"`: bonded points are in contact only if they are squeezed by a tenth.
const SQUEEZED: f64 = 0.9;

/// Contact distance of `law = "emu"` as published, in spacings.
const EMU_DISTANCE: f64 = 1.35;

fn is_emu(law: Option<&ContactLaw>) -> bool {
    law == Some(&ContactLaw::Emu)
}

fn usual_pairs(law: Option<&ContactLaw>) -> ContactPairs {
    match is_emu(law) {
        // As published.
        true => ContactPairs::All,
        false => ContactPairs::Unbonded,
    }
}

fn usual_distance(law: Option<&ContactLaw>) -> f64 {
    if is_emu(law) { EMU_DISTANCE } else { 1.0 }
}

/// Returns the range of θ.
fn closing_range(pairs: Option<&ContactPairs>) -> Range {
    match pairs {
        Some(ContactPairs::All) => above_to(0.0, SQUEEZED).described(
            "above 0 and at most 0.9 with pairs = \"all\": bonded points would be in contact at the start",
        ),
        _ => above_to(0.0, 1.0).described(
            "above 0 and at most 1: a larger contact distance would release energy when a bond breaks",
        ),
    }
}

fn usual_closing(pairs: Option<&ContactPairs>) -> f64 {
    match pairs {
        Some(ContactPairs::All) => SQUEEZED,
        _ => 1.0,
    }
}

impl<S> DeckValue<S> for ContactStiffness {
    /// Reads a relative stiffness (a number) or a stiffness with its unit.
    fn read(item: &Item<'_>, _: S) -> Option<Self> {
        let measure = item.word().and_then(|text| units::parse(text).ok());
        let has_unit = measure.is_some_and(|measure| {
            measure.dimension.is_some() && measure.dimension != Some(Quantity::Number.dimension())
        });
        match has_unit {
            true => item.positive(Quantity::Stiffness).map(Self::Absolute),
            false => item.positive(Quantity::Number).map(Self::Relative),
        }
    }

    fn check(&self, path: KeyPath, _: S, check: &mut Check) {
        let (Self::Relative(stiffness) | Self::Absolute(stiffness)) = self;
        check.positive(path, *stiffness);
    }
}

impl<S> Fallback<S> for ContactStiffness {
    fn missing(self, table: &Table<'_>, key: &'static str, _: S) -> Option<Self> {
        table.record(key, RELATIVE);
        Some(self)
    }
}
