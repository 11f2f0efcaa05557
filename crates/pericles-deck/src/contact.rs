//! `[contact]`: forces between points that no bond joins.

use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::units;

/// Contact between points of the body, and of the body with impactors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Pairs of points that may be in contact.
    #[serde(default)]
    pub pairs: ContactPairs,
    /// Contact law.
    #[serde(default)]
    pub law: ContactLaw,
    /// Contact stiffness.
    #[serde(default)]
    pub stiffness: ContactStiffness,
    /// Contact distance β relative to the mean cell size.
    #[serde(default = "one")]
    pub distance: f64,
    /// Contact distance θ relative to the initial distance of the two points, an upper bound.
    #[serde(default = "one")]
    pub closing: f64,
    /// Damping ratio ζ of a pair of points in contact.
    #[serde(default)]
    pub damping: f64,
    /// Coulomb friction.
    #[serde(default)]
    pub friction: Option<ContactFriction>,
}

/// Coulomb friction.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactFriction {
    /// Coefficient of friction μ.
    pub coefficient: f64,
    /// Sliding speed below which friction between points decreases, m/s; friction of impactors has no such speed.
    pub speed: f64,
}

/// Pairs of points that may be in contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ContactPairs {
    /// Points without an intact bond.
    #[default]
    Unbonded,
    /// Points of different pieces.
    Pieces,
    /// All points.
    All,
}

/// Contact force as a function of the overlap g.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ContactLaw {
    /// F = k g.
    #[default]
    Linear,
    /// F = k d (g/d)^p with the contact distance d.
    Power(f64),
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

impl Default for Contact {
    fn default() -> Self {
        Self {
            pairs: ContactPairs::default(),
            law: ContactLaw::default(),
            stiffness: ContactStiffness::default(),
            distance: 1.0,
            closing: 1.0,
            damping: 0.0,
            friction: None,
        }
    }
}

/// Default of the relative stiffness χ: the stiffest contact that raises the highest frequency of a body by less than
/// 9 %.
const RELATIVE: f64 = 2.25;

/// Largest θ with `pairs = "all"`: bonded points are in contact only if they are squeezed by a tenth.
const SQUEEZED: f64 = 0.9;

/// Contact distance of `law = "emu"` as published, in spacings.
const EMU_DISTANCE: f64 = 1.35;

fn one() -> f64 {
    1.0
}

/// Reads `[contact]`.
pub(crate) fn read(table: Table<'_>) -> Option<Contact> {
    let law = law(&table);
    let is_emu = law == Some(ContactLaw::Emu);
    let mut words = [
        ("unbonded", ContactPairs::Unbonded),
        ("pieces", ContactPairs::Pieces),
        ("all", ContactPairs::All),
    ];
    if is_emu {
        // As published.
        words.rotate_right(1);
    }
    let pairs = table.choice_or_first("pairs", "kind of pairs", &words);
    let stiffness = match law {
        Some(ContactLaw::Emu) => {
            table.forbid("stiffness", "law = \"emu\" has the stiffness 15 c V V/δ");
            Some(ContactStiffness::default())
        }
        _ => stiffness(&table),
    };
    let positive = |item: Item<'_>| item.positive(Quantity::Number);
    let distance = table.or(
        "distance",
        if is_emu { EMU_DISTANCE } else { 1.0 },
        positive,
    );
    let closing = match pairs {
        Some(ContactPairs::All) => table.or("closing", SQUEEZED, |item| {
            let allowed = "above 0 and at most 0.9 with pairs = \"all\": bonded points would be in contact at the start";
            item.within(Quantity::Number, allowed, |theta| theta > 0.0 && theta <= SQUEEZED)
        }),
        _ => table.or("closing", 1.0, |item| {
            let allowed = "above 0 and at most 1: a larger contact distance would release energy when a bond breaks";
            item.within(Quantity::Number, allowed, |theta| theta > 0.0 && theta <= 1.0)
        }),
    };
    let damping = table.or("damping", 0.0, |item| {
        item.within(Quantity::Number, "at least 0", |zeta| zeta >= 0.0)
    });
    let friction = table.maybe("friction", |item| friction(item.table()?));
    table.finish();
    Some(Contact {
        pairs: pairs?,
        law: law?,
        stiffness: stiffness?,
        distance: distance?,
        closing: closing?,
        damping: damping?,
        friction: friction?,
    })
}

fn law(table: &Table<'_>) -> Option<ContactLaw> {
    let law = table.choice_or_first(
        "law",
        "contact law",
        &[
            ("linear", ContactLaw::Linear),
            ("power", ContactLaw::Power(1.0)),
            ("emu", ContactLaw::Emu),
        ],
    )?;
    if let ContactLaw::Power(_) = law {
        let exponent = table.required("exponent")?;
        let allowed = "at least 1";
        return exponent
            .within(Quantity::Number, allowed, |p| p >= 1.0)
            .map(ContactLaw::Power);
    }
    table.forbid("exponent", "it requires law = \"power\"");
    Some(law)
}

/// Reads a relative stiffness (a number) or a stiffness with its unit.
fn stiffness(table: &Table<'_>) -> Option<ContactStiffness> {
    let Some(item) = table.optional("stiffness") else {
        table.record("stiffness", RELATIVE);
        return Some(ContactStiffness::default());
    };
    let measure = item.word().and_then(|text| units::parse(text).ok());
    let has_unit = measure.is_some_and(|measure| {
        measure.dimension.is_some() && measure.dimension != Some(Quantity::Number.dimension())
    });
    match has_unit {
        true => item
            .positive(Quantity::Stiffness)
            .map(ContactStiffness::Absolute),
        false => item
            .positive(Quantity::Number)
            .map(ContactStiffness::Relative),
    }
}

fn friction(table: Table<'_>) -> Option<ContactFriction> {
    let coefficient = table
        .required("coefficient")
        .and_then(|item| item.within(Quantity::Number, "at least 0", |mu| mu >= 0.0));
    let speed = table
        .required("speed")
        .and_then(|item| item.positive(Quantity::Velocity));
    table.finish();
    Some(ContactFriction {
        coefficient: coefficient?,
        speed: speed?,
    })
}
