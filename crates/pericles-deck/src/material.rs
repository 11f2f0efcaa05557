//! `[material]`: constants, horizon, influence function and breaking.

use pericles::family::VolumeCorrection;
use pericles::kernel::{Influence, InfluenceFunction};
use pericles::material::{BondMaterial, CubicLaw, PairLaw, SurfaceCorrection, Treatment};
use pericles::operator::DamageMeasure;
use pericles_dispersion::tuning::TunedTable;
use pericles_waves::ForceForm;
use serde::{Deserialize, Serialize};

use crate::body::BodyRead;
use crate::constants::{
    ConstantRules, Sums, fracture, fracture_calibration, modulus, poisson_ratio,
};
use crate::influence::{InfluenceRead, Setting, influence};
use crate::part::{self, MaterialInterface, Part};
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::set::SetNames;
use crate::vocabulary::HORIZONS;

/// The material with what goes with it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// A name for people.
    #[serde(default)]
    pub name: Option<String>,
    /// Law, constants, horizon and breaking.
    #[serde(with = "crate::form")]
    pub bonds: BondMaterial,
    /// How the coefficients of the influence function were found, if it is tuned against dispersion.
    #[serde(default, with = "crate::form")]
    pub tuned: Option<TunedTable>,
    /// Sets whose bonds never break.
    #[serde(default)]
    pub no_fail: Vec<String>,
    /// Parts that are stiffer or softer, later ones before earlier ones.
    #[serde(default, rename = "inclusion")]
    pub inclusions: Vec<Inclusion>,
    /// Other materials, later ones before earlier ones.
    #[serde(default, rename = "part")]
    pub parts: Vec<Part>,
    /// Bonds between materials.
    #[serde(default)]
    pub interface: MaterialInterface,
    /// What is done about the bonds that points near surfaces lack.
    #[serde(default, with = "crate::form")]
    pub surface_correction: SurfaceCorrection,
    /// How damage is measured, if it is given.
    #[serde(default, with = "crate::form")]
    pub damage: Option<DamageMeasure>,
    /// How bonds are kept: a matter of speed only.
    #[serde(default, with = "crate::form")]
    pub form: ForceForm,
}

impl From<BondMaterial> for Material {
    /// One material for the whole body, whose bonds are kept as is fastest.
    fn from(bonds: BondMaterial) -> Self {
        Self {
            name: None,
            bonds,
            tuned: None,
            no_fail: Vec::new(),
            inclusions: Vec::new(),
            parts: Vec::new(),
            interface: MaterialInterface::default(),
            surface_correction: SurfaceCorrection::default(),
            damage: None,
            form: ForceForm::default(),
        }
    }
}

impl Material {
    /// The word of `material.model` for its law, whatever its treatment.
    pub fn model_name(&self) -> &'static str {
        match self.bonds.law {
            PairLaw::BondStretch => "bond-stretch",
            PairLaw::Linear => "linear",
            PairLaw::GreenStrain | PairLaw::Treated(CubicLaw::GreenStrain, _) => "green-strain",
            PairLaw::Literal57 | PairLaw::Treated(CubicLaw::Literal57, _) => "literal57",
        }
    }
}

/// A part of other stiffness.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Inclusion {
    /// The set.
    pub set: String,
    /// Stiffness over the material's; a bond has the mean of its ends.
    pub stiffness: f64,
}

pub(crate) fn read(table: Table<'_>, body: &BodyRead, sets: &SetNames) -> Option<Material> {
    let dimension = body.frame.dimension;
    let name = table.maybe("name", |item| item.text());
    let law = law(&table);
    let density = table
        .required("density")
        .and_then(|item| item.positive(Quantity::Density));
    let modulus = modulus(&table, body.state);
    let extent = horizon(&table, body.frame.spacing);
    let horizon = extent.as_ref().and_then(Extent::length);
    let volume_correction = table.choice_or_first(
        "volume_correction",
        "volume correction",
        &[
            ("extended", VolumeCorrection::Extended),
            ("linear", VolumeCorrection::Linear),
            ("none", VolumeCorrection::None),
        ],
    );
    let surface_correction = table.choice_or_first(
        "surface_correction",
        "surface correction",
        &[
            ("none", SurfaceCorrection::None),
            ("volume", SurfaceCorrection::Volume),
            ("energy", SurfaceCorrection::Energy),
        ],
    );
    poisson_ratio(&table, body.state);
    let influence = influence(
        &table,
        &Setting {
            dimension,
            state: body.state,
            spacing: body.frame.spacing,
            cells: body.frame.cells,
            horizon,
            correction: volume_correction,
        },
    );
    let (influence, tuned) = match influence {
        Some(InfluenceRead { influence, tuned }) => (Some(influence), tuned),
        None => (None, None),
    };
    let horizon = extent.and_then(|extent| extent.with(influence.as_ref(), dimension));
    let fracture = fracture(&table);
    let fracture_calibration = fracture_calibration(&table, body);
    let no_fail = table
        .optional("no_fail")
        .map_or(Some(Vec::new()), |item| sets.references(&item));
    let inclusions: Vec<Option<Inclusion>> = table
        .tables("inclusion")
        .into_iter()
        .map(|table| inclusion(table, sets))
        .collect();
    let parts = table.tables("part");
    let damage = damage(&table);
    let form = form(&table);
    let rules = ConstantRules {
        state: body.state,
        sums: Sums::of(influence.as_ref(), form, body),
        fracture: fracture_calibration,
    };
    rules.judge_volume_correction(&table);
    let modulus = rules.modulus(&table, modulus);
    let fracture = rules.fracture(fracture);
    let parts = part::parts(parts, &rules, sets);
    let interface = interface(&table, name.as_ref(), parts.as_deref());
    table.finish();
    Some(Material {
        name: name?,
        bonds: BondMaterial {
            law: law?,
            density: density?,
            modulus: modulus?,
            horizon: horizon?,
            influence: influence?,
            volume_correction: volume_correction?,
            fracture: fracture?,
        },
        tuned,
        no_fail: no_fail?,
        inclusions: inclusions.into_iter().collect::<Option<_>>()?,
        parts: parts?,
        interface: interface?,
        surface_correction: surface_correction?,
        damage: damage?,
        form: form?,
    })
}

/// How bonds are kept.
fn form(table: &Table<'_>) -> Option<ForceForm> {
    table.choice_or_first(
        "bonds",
        "form of bonds",
        &[
            ("fastest", ForceForm::Fastest),
            ("grid", ForceForm::Grid),
            ("grid-f32", ForceForm::FloatGrid),
            ("list", ForceForm::List),
            ("convolution", ForceForm::Convolution),
            ("spectral", ForceForm::Spectral),
        ],
    )
}

/// Bonds between materials, where there are several.
fn interface(
    table: &Table<'_>,
    name: Option<&Option<String>>,
    parts: Option<&[Part]>,
) -> Option<MaterialInterface> {
    if !table.has("part") {
        table.forbid(
            "interface",
            "only a body with [[material.part]] has interfaces",
        );
        return Some(MaterialInterface::default());
    }
    let interface = table.table_or_empty("interface");
    let own = name.cloned().flatten();
    let others = parts?.iter().map(|part| Some(part.name.clone()));
    let names: Vec<Option<String>> = std::iter::once(own).chain(others).collect();
    part::interface(interface?, &names)
}

/// The law as it is taken.
fn law(table: &Table<'_>) -> Option<PairLaw> {
    let law = table.choice_or_first(
        "model",
        "model",
        &[
            ("bond-stretch", PairLaw::BondStretch),
            ("linear", PairLaw::Linear),
            ("green-strain", PairLaw::GreenStrain),
            ("literal57", PairLaw::Literal57),
        ],
    );
    treated(table, law)
}

fn treated(table: &Table<'_>, law: Option<PairLaw>) -> Option<PairLaw> {
    #[derive(Clone, Copy)]
    enum Kind {
        Exact,
        FirstOrder,
        As(Treatment),
    }
    let cubic = match law? {
        PairLaw::GreenStrain => CubicLaw::GreenStrain,
        PairLaw::Literal57 => CubicLaw::Literal57,
        other => {
            table.forbid(
                "treatment",
                "it belongs to model = \"green-strain\" or \"literal57\"",
            );
            return Some(other);
        }
    };
    let treatment = table.choice_or_first(
        "treatment",
        "treatment",
        &[
            ("exact", Kind::Exact),
            ("taylor-1", Kind::FirstOrder),
            ("taylor-2", Kind::As(Treatment::SecondOrder)),
            // The law itself.
            ("taylor-3", Kind::Exact),
            ("trapezoidal", Kind::As(Treatment::Trapezoidal)),
        ],
    );
    Some(match treatment? {
        Kind::Exact => law?,
        Kind::FirstOrder => PairLaw::Linear,
        Kind::As(treatment) => PairLaw::Treated(cubic, treatment),
    })
}

pub(crate) fn inclusion(table: Table<'_>, sets: &SetNames) -> Option<Inclusion> {
    let set = table.required("set").and_then(|item| sets.reference(&item));
    let stiffness = table
        .required("stiffness")
        .and_then(|item| item.positive(Quantity::Number));
    table.finish();
    Some(Inclusion {
        set: set?,
        stiffness: stiffness?,
    })
}

/// A horizon as written.
enum Extent<'a> {
    /// m
    Finite(f64),
    /// As far as the influence function goes.
    Infinite(Item<'a>),
}

impl Extent<'_> {
    fn length(&self) -> Option<f64> {
        match self {
            Self::Finite(horizon) => Some(*horizon),
            Self::Infinite(_) => None,
        }
    }

    /// The horizon in metres, for a function that is known.
    fn with(self, influence: Option<&Influence>, dimension: Option<usize>) -> Option<f64> {
        /// Lengths of a Gaussian beyond which it is below 1e-21 of its height.
        const ALL: f64 = 7.0;
        let item = match self {
            Self::Finite(horizon) => return Some(horizon),
            Self::Infinite(item) => item,
        };
        match influence.map(|influence| (&influence.function, influence)) {
            Some((
                InfluenceFunction::Gaussian {
                    length,
                    cutoff: None,
                },
                influence,
            )) => {
                let horizon = ALL * length;
                item.accept(influence.check(dimension?, horizon))?;
                item.record(horizon);
                Some(horizon)
            }
            _ => {
                item.out_of_range(
                    "\"infinite\" needs a function that decays: influence = { function = \"gaussian\", length = … } without a cutoff",
                );
                None
            }
        }
    }
}

/// The horizon, given as a length or as a multiple of the spacing.
fn horizon<'a>(table: &Table<'a>, spacing: Option<f64>) -> Option<Extent<'a>> {
    let (kind, item) = table.exactly_one(HORIZONS)?;
    if kind == "horizon" && item.is_keyword("infinite") {
        return Some(Extent::Infinite(item));
    }
    let length = match kind {
        "horizon" => item.within(
            Quantity::Length,
            "a length of at least one spacing (usual: 3 spacings), or \"infinite\"",
            // Horizons are mostly whole multiples of the spacing, up to round-off.
            |horizon| horizon > 0.0 && spacing.is_none_or(|dx| horizon >= dx * (1.0 - 1e-9)),
        ),
        _ => {
            let ratio = item.within(
                Quantity::Number,
                "a number of at least 1 (usual: 3)",
                |ratio| ratio >= 1.0,
            );
            ratio.zip(spacing).map(|(ratio, dx)| ratio * dx)
        }
    };
    length.map(Extent::Finite)
}

fn damage(table: &Table<'_>) -> Option<Option<DamageMeasure>> {
    let given = table.has("damage");
    let table = table.table_or_empty("damage")?;
    let count = table.choice_or_first(
        "measure",
        "measure of damage",
        &[("volume", false), ("count", true)],
    );
    let count_precut = table.or("count_precut", false, |item| item.boolean());
    table.finish();
    let measure = DamageMeasure {
        count: count?,
        count_precut: count_precut?,
    };
    Some(given.then_some(measure))
}
