//! `[material]`: constants, horizon, influence function and breaking.

use pericles::family::VolumeCorrection;
use pericles::kernel::{Influence, InfluenceFunction};
use pericles::material::{
    BondMaterial, CubicLaw, LinearSolid, PairLaw, StateInfluence, Strains, SurfaceCorrection,
    Treatment,
};
use pericles::operator::DamageMeasure;
use pericles_dispersion::tuning::TunedTable;
use pericles_waves::ForceForm;
use serde::{Deserialize, Serialize};

use crate::body::BodyRead;
use crate::constants::{
    ConstantRules, Sums, fracture, fracture_calibration, modulus, poisson_ratio,
};
use crate::influence::{InfluenceRead, Setting, influence, state_influence};
use crate::part::{self, MaterialInterface, Part, PartRules};
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::set::SetNames;
use crate::state_based::{SolidRules, StateBased};
use crate::vocabulary::HORIZONS;

/// The material with what goes with it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// A name for people.
    #[serde(default)]
    pub name: Option<String>,
    /// Law, constants, horizon and breaking.
    pub model: MaterialModel,
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

/// The model of a material.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MaterialModel {
    /// A pair force for each bond: Poisson's ratio is fixed.
    Bonds(#[serde(with = "crate::form")] BondMaterial),
    /// Forces that depend on all bonds of both ends: any Poisson's ratio.
    StateBased(StateBased),
}

impl From<BondMaterial> for Material {
    /// One material for the whole body, whose bonds are kept as is fastest.
    fn from(bonds: BondMaterial) -> Self {
        Self::from(MaterialModel::Bonds(bonds))
    }
}

impl From<StateBased> for Material {
    /// One material for the whole body.
    fn from(solid: StateBased) -> Self {
        Self::from(MaterialModel::StateBased(solid))
    }
}

impl From<MaterialModel> for Material {
    fn from(model: MaterialModel) -> Self {
        Self {
            name: None,
            model,
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
    /// The bond-based material, if it is one.
    pub fn bonds(&self) -> Option<&BondMaterial> {
        match &self.model {
            MaterialModel::Bonds(bonds) => Some(bonds),
            MaterialModel::StateBased(_) => None,
        }
    }

    /// The same, to be changed.
    pub fn bonds_mut(&mut self) -> Option<&mut BondMaterial> {
        match &mut self.model {
            MaterialModel::Bonds(bonds) => Some(bonds),
            MaterialModel::StateBased(_) => None,
        }
    }

    /// The state-based material, if it is one.
    pub fn state_based(&self) -> Option<&StateBased> {
        match &self.model {
            MaterialModel::Bonds(_) => None,
            MaterialModel::StateBased(solid) => Some(solid),
        }
    }

    /// Mass density ρ, kg/m³.
    pub fn density(&self) -> f64 {
        match &self.model {
            MaterialModel::Bonds(bonds) => bonds.density,
            MaterialModel::StateBased(state) => state.solid.density,
        }
    }

    /// Horizon δ, m.
    pub fn horizon(&self) -> f64 {
        match &self.model {
            MaterialModel::Bonds(bonds) => bonds.horizon,
            MaterialModel::StateBased(state) => state.solid.horizon,
        }
    }

    /// Partial volumes at the horizon.
    pub fn volume_correction(&self) -> VolumeCorrection {
        match &self.model {
            MaterialModel::Bonds(bonds) => bonds.volume_correction,
            MaterialModel::StateBased(state) => state.solid.volume_correction,
        }
    }

    /// The word of `material.model`, whatever the treatment of a law.
    pub fn model_name(&self) -> &'static str {
        let MaterialModel::Bonds(bonds) = &self.model else {
            return "state-based";
        };
        match bonds.law {
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
    match model(&table) {
        Some(ModelWord::StateBased) => state_based(table, body, sets),
        Some(ModelWord::Law(law)) => bond_based(table, Some(law), body, sets),
        None => bond_based(table, None, body, sets),
    }
}

/// The word of `model`.
#[derive(Clone, Copy)]
enum ModelWord {
    Law(PairLaw),
    StateBased,
}

fn model(table: &Table<'_>) -> Option<ModelWord> {
    table.choice_or_first(
        "model",
        "model",
        &[
            ("bond-stretch", ModelWord::Law(PairLaw::BondStretch)),
            ("linear", ModelWord::Law(PairLaw::Linear)),
            ("green-strain", ModelWord::Law(PairLaw::GreenStrain)),
            ("literal57", ModelWord::Law(PairLaw::Literal57)),
            ("state-based", ModelWord::StateBased),
        ],
    )
}

fn bond_based(
    table: Table<'_>,
    law: Option<PairLaw>,
    body: &BodyRead,
    sets: &SetNames,
) -> Option<Material> {
    for key in ["strains", "failure", "stretch_definition"] {
        table.forbid(key, "it belongs to model = \"state-based\"");
    }
    let dimension = body.frame.dimension;
    let name = table.maybe("name", |item| item.text());
    let law = treated(&table, law);
    let density = density(&table);
    let modulus = modulus(&table, body.state);
    let extent = horizon(&table, body.frame.spacing);
    let volume_correction = volume_correction(&table);
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
    let influence = influence(&table, &setting(body, extent.as_ref(), volume_correction));
    let (influence, tuned) = match influence {
        Some(InfluenceRead { influence, tuned }) => (Some(influence), tuned),
        None => (None, None),
    };
    let horizon = extent.and_then(|extent| extent.with(influence.as_ref(), dimension));
    let fracture = fracture(&table);
    let fracture_calibration = fracture_calibration(&table, body);
    let no_fail = no_fail(&table, sets);
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
    let parts = part::parts(parts, &PartRules::Bonds(&rules), sets);
    let interface = interface(&table, name.as_ref(), parts.as_deref(), false);
    table.finish();
    Some(Material {
        name: name?,
        model: MaterialModel::Bonds(BondMaterial {
            law: law?,
            density: density?,
            modulus: modulus?,
            horizon: horizon?,
            influence: influence?,
            volume_correction: volume_correction?,
            fracture: fracture?,
        }),
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

fn state_based(table: Table<'_>, body: &BodyRead, sets: &SetNames) -> Option<Material> {
    table.forbid(
        "treatment",
        "it belongs to model = \"green-strain\" or \"literal57\"",
    );
    table.forbid(
        "inclusion",
        "inclusions scale the constant of bonds; give a [[material.part]] with elastic constants of its own",
    );
    let name = table.maybe("name", |item| item.text());
    let strains = table.choice_or_first(
        "strains",
        "strains",
        &[("finite", Strains::Finite), ("small", Strains::Small)],
    );
    let density = density(&table);
    let extent = horizon(&table, body.frame.spacing);
    let volume_correction = volume_correction(&table);
    let surface_correction = solid_surface(&table);
    let influence = state_influence(&table, &setting(body, extent.as_ref(), volume_correction));
    let given = match &influence {
        Some(StateInfluence::Function(function)) => Some(Influence {
            function: function.clone(),
            ..Influence::default()
        }),
        _ => None,
    };
    let horizon = extent.and_then(|extent| extent.with(given.as_ref(), body.frame.dimension));
    let rules = SolidRules::read(&table, body.state, fracture_calibration(&table, body));
    let (elastic, failure) = (rules.elastic(&table), rules.failure(&table));
    let no_fail = no_fail(&table, sets);
    let damage = damage(&table);
    let form = form(&table);
    let parts = part::parts(table.tables("part"), &PartRules::StateBased(&rules), sets);
    let interface = interface(&table, name.as_ref(), parts.as_deref(), true);
    table.finish();
    let solid = LinearSolid {
        density: density?,
        elastic: elastic?,
        horizon: horizon?,
        influence: influence?,
        volume_correction: volume_correction?,
        failure: failure?,
    };
    Some(Material {
        name: name?,
        no_fail: no_fail?,
        parts: parts?,
        interface: interface?,
        surface_correction: surface_correction?,
        damage: damage?,
        form: form?,
        ..Material::from(StateBased {
            solid,
            strains: strains?,
        })
    })
}

fn density(table: &Table<'_>) -> Option<f64> {
    let item = table.required("density");
    item.and_then(|item| item.positive(Quantity::Density))
}

fn volume_correction(table: &Table<'_>) -> Option<VolumeCorrection> {
    table.choice_or_first(
        "volume_correction",
        "volume correction",
        &[
            ("extended", VolumeCorrection::Extended),
            ("linear", VolumeCorrection::Linear),
            ("none", VolumeCorrection::None),
        ],
    )
}

/// The correction of surfaces that a state-based material can have.
fn solid_surface(table: &Table<'_>) -> Option<SurfaceCorrection> {
    if let Some(item) = table.optional("surface_correction")
        && item.is_keyword("volume")
    {
        item.out_of_range(
            "\"none\" or \"energy\": the weighted volume of a state-based material accounts for missing bonds already, and the volume method would make bodies 6 to 15 % too stiff",
        );
        return None;
    }
    table.choice_or_first(
        "surface_correction",
        "surface correction",
        &[
            ("none", SurfaceCorrection::None),
            ("energy", SurfaceCorrection::Energy),
        ],
    )
}

fn no_fail(table: &Table<'_>, sets: &SetNames) -> Option<Vec<String>> {
    let item = table.optional("no_fail");
    item.map_or(Some(Vec::new()), |item| sets.references(&item))
}

/// What an influence function is made for.
fn setting(
    body: &BodyRead,
    extent: Option<&Extent<'_>>,
    correction: Option<VolumeCorrection>,
) -> Setting {
    Setting {
        dimension: body.frame.dimension,
        state: body.state,
        spacing: body.frame.spacing,
        cells: body.frame.cells,
        horizon: extent.and_then(Extent::length),
        correction,
    }
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
    state_based: bool,
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
    part::interface(interface?, &names, state_based)
}

/// The law as it is taken.
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
