//! `[material]` and `[materials.NAME]`: all keys of a material.

use pericles::kernel::Influence;
use pericles::material::{
    BondFailure, BondMaterial, CubicLaw, Fracture, FractureCalibration, GivenConstants,
    LinearSolid, PairLaw, StateInfluence,
};
use pericles::operator::DamageMeasure;
use pericles_deck_derive::{DeckKeys, DeckTable};
use pericles_waves::ForceForm;
use serde::{Deserialize, Serialize};

use super::bond_based::{BondKeys, CubicKeys};
use super::family::Family;
use super::scatter::Scatter;
use super::scope::MaterialScope;
use super::softening::StrengthKeys;
use super::solids::{CorrespondenceKeys, StateKeys};
use super::types::{Material, MaterialModel};
use crate::constants::{ConstantRules, Sums, fracture_calibration};
use crate::declaration::{DeckKeys, DeckTable};
use crate::form::described;
use crate::property::{MaterialFunctions, MaterialProperty, functions, number_of};
use crate::reader::Table;
use crate::vocabulary::STRENGTHS;

/// Constitutive law, elastic constants, horizon and strength of the body's material. For bodies of several materials see
/// `[materials]` and `[[assign]]`.
#[derive(DeckTable)]
#[deck(scope = MaterialScope<'s>)]
struct GivenMaterial {
    #[deck(flatten)]
    model: GivenModel,
    /// Mass density, a number or an expression of position. Required for every material.
    #[deck(with = number_of(MaterialProperty::Density))]
    density: f64,
    #[deck(flatten)]
    family: Family,
    /// How the critical stretch follows from `fracture_energy`. `lattice`: sums over the bonds of the grid, so that
    /// cracks cost the fracture energy in the mean over the planes (10), (11) in 2D and (100), (110), (111) in 3D.
    /// `continuum`: integrals of the theory; cracks on the grid then cost several per cent more or less, as `check`
    /// prints. Listed points always use `continuum`. With `critical_stretch` only the onset of softening by
    /// `tensile_strength` depends on it.
    #[deck(flatten, key = "fracture_calibration", with = calibration)]
    calibration: FractureCalibration,
    #[deck(
        flatten,
        with = fracture,
        scope = (scope, calibration.copied()),
        keys("fracture_energy", "critical_stretch")
    )]
    fracture: Fracture,
    #[deck(flatten)]
    shared: Shared,
}

/// Keys without rules that involve other keys.
#[derive(DeckTable)]
#[deck(scope = MaterialScope<'s>)]
struct Shared {
    /// Name of the material, for `[[assign]]` and `[[interface]]`. Default: "default". Tables of `[materials]` are named by
    /// their heading.
    #[deck(forbid_if(scope.is_named, "the heading of the table is the name of the material"))]
    name: Option<String>,
    /// Sets whose bonds never break: a name or a list of names.
    #[deck(flatten, key = "no_fail", with = no_fail)]
    no_fail: Vec<String>,
    /// Randomly distributed strength. Every point has a random factor; the critical stretch (or bond energy) of a bond is
    /// multiplied by the mean of its end points' factors. The factors have the mean 1.
    scatter: Option<Scatter>,
    #[deck(flatten, with = damage, keys("damage"))]
    damage: Option<DamageMeasure>,
    /// Force kernel; affects speed and memory, not the model. `fastest`: chosen automatically; `grid`: stencil of a lattice;
    /// `grid-f32`: stencil in single precision, twice as fast, forces accurate to about six digits, for velocity Verlet and
    /// Runge–Kutta schemes; `list`: neighbour list; `convolution`: FFT on grids; `spectral`: Fourier symbol of the continuum on
    /// periodic bodies. The last two need linear bodies without fracture.
    #[deck(default)]
    bonds: ForceForm,
    #[deck(flatten, keys(), with = functions, scope = scope.body.frame.dimension)]
    functions: MaterialFunctions,
}

/// Constitutive law. `bond-stretch`: force proportional to the bond stretch (prototype microelastic brittle material);
/// `linear`: its linearisation for small displacements; `green-strain`: force proportional to the Green strain of the bond;
/// `cubic-softening`: bars only, the softening law printed in Coclite et al. 2020; `state-based`: linear peridynamic solid with
/// free Poisson's ratio, whose bond forces depend on the dilatations of both end points; `correspondence`: classical
/// constitutive laws through a nonlocal deformation gradient.
#[derive(DeckKeys)]
#[deck(tag = "model", what = "model", scope = MaterialScope<'s>)]
#[expect(
    clippy::large_enum_variant,
    reason = "one value exists while a table is read"
)]
enum GivenModel {
    #[default]
    BondStretch {
        #[deck(flatten)]
        keys: BondKeys,
        #[deck(flatten)]
        strength: StrengthKeys,
    },
    Linear {
        #[deck(flatten)]
        keys: BondKeys,
        #[deck(flatten)]
        strength: StrengthKeys,
    },
    GreenStrain {
        #[deck(flatten)]
        cubic: CubicKeys,
        #[deck(flatten)]
        keys: BondKeys,
    },
    CubicSoftening {
        #[deck(flatten)]
        cubic: CubicKeys,
        #[deck(flatten)]
        keys: BondKeys,
    },
    StateBased(#[deck(flatten)] StateKeys),
    Correspondence(#[deck(flatten)] CorrespondenceKeys),
}

/// Reads the table of a material.
pub(super) fn material(table: Table<'_>, scope: MaterialScope<'_>) -> Option<Material> {
    table.about(<GivenMaterial as DeckTable<_>>::ABOUT);
    let given = GivenMaterial::read_keys(&table, scope);
    let made = given.and_then(|given| given.made(&table, scope));
    table.finish();
    made
}

impl GivenMaterial {
    fn made(self, table: &Table<'_>, scope: MaterialScope<'_>) -> Option<Material> {
        let horizon = self.family.horizon(table, scope)?;
        let Family {
            influence: (influence, tuned),
            volume_correction,
            ..
        } = self.family;
        let solid = |influence: Option<Influence>| LinearSolid {
            density: self.density,
            elastic: GivenConstants::default(),
            horizon,
            influence: match influence {
                Some(given) => StateInfluence::Function(given.function),
                None => StateInfluence::Isotropic,
            },
            volume_correction,
            failure: BondFailure::Unbreakable,
        };
        let (law, keys, strength) = match self.model {
            GivenModel::StateBased(keys) => {
                let surface_correction = keys.surface_correction;
                let model = MaterialModel::StateBased(keys.made(solid(influence), self.fracture));
                return Some(Material {
                    surface_correction,
                    ..self.shared.of(model)
                });
            }
            GivenModel::Correspondence(keys) => {
                let made = keys.made(solid(influence), self.fracture);
                return Some(self.shared.of(MaterialModel::Correspondence(made)));
            }
            GivenModel::BondStretch { keys, strength } => {
                (PairLaw::BondStretch, keys, Some(strength))
            }
            GivenModel::Linear { keys, strength } => (PairLaw::Linear, keys, Some(strength)),
            GivenModel::GreenStrain { cubic, keys } => {
                (cubic.law(CubicLaw::GreenStrain), keys, None)
            }
            GivenModel::CubicSoftening { cubic, keys } => {
                (cubic.law(CubicLaw::CubicSoftening), keys, None)
            }
        };
        let rules = ConstantRules {
            sums: Sums::of(influence.as_ref(), Some(self.shared.bonds), scope.body),
        };
        rules.check_volume_correction(table);
        let bonds = BondMaterial {
            law,
            density: self.density,
            modulus: rules.modulus(table, keys.modulus)?,
            horizon,
            influence: influence?,
            volume_correction,
            fracture: self.fracture,
        };
        let strength = strength.map(|strength| strength.made(self.calibration));
        let (tensile_strength, softening, strength_surface) = strength.unwrap_or_default();
        Some(Material {
            surface_correction: keys.surface_correction,
            tuned,
            tensile_strength,
            softening,
            strength_surface,
            ..self.shared.of(MaterialModel::Bonds(bonds))
        })
    }
}

impl Shared {
    /// Returns the material of a model.
    fn of(self, model: MaterialModel) -> Material {
        Material {
            name: self.name,
            no_fail: self.no_fail,
            scatter: self.scatter,
            damage: self.damage,
            form: self.bonds,
            functions: self.functions,
            ..Material::from(model)
        }
    }
}

fn calibration(table: &Table<'_>, scope: MaterialScope<'_>) -> Option<FractureCalibration> {
    fracture_calibration(table, scope.body, scope.is_shared)
}

/// Reads the strength of bonds, unless they break by stress or strain.
fn fracture(
    table: &Table<'_>,
    (scope, calibration): (MaterialScope<'_>, Option<FractureCalibration>),
) -> Option<Fracture> {
    if let Some(limit) = scope.limit() {
        for key in STRENGTHS {
            table.forbid(
                key,
                &format!(
                    "with failure = \"{}\" bonds break by `{limit}`, which determines the dissipated energy",
                    scope.failure
                ),
            );
        }
    }
    if scope.is_solid() && scope.failure == "bond-energy" {
        table.forbid(
            "critical_stretch",
            "failure = \"bond-energy\" requires `fracture_energy`, which determines the critical bond energy",
        );
    }
    Fracture::read_keys(table, calibration)
}

fn no_fail(table: &Table<'_>, scope: MaterialScope<'_>) -> Option<Vec<String>> {
    let item = table.optional("no_fail");
    item.map_or(Some(Vec::new()), |item| scope.sets.references(&item))
}

/// Definition of the damage field.
#[derive(Serialize, Deserialize, DeckTable)]
#[serde(remote = "DamageMeasure", deny_unknown_fields)]
#[deck(remote = DamageMeasure)]
struct DamageMeasureForm {
    /// Damage of a point: volume fraction (`volume`) or number fraction (`count`) of its broken bonds.
    #[deck(flatten, key = "measure", with = counts)]
    count: bool,
    /// Count bonds cut by pre-cracks as broken.
    #[deck(default = false)]
    count_precut: bool,
}

described!(DamageMeasure: DamageMeasureForm);

fn counts<S>(table: &Table<'_>, _: S) -> Option<bool> {
    let words = [("volume", false), ("count", true)];
    table.choice_or_first("measure", "damage measure", &words)
}

/// Reads the damage measure, if it is given; its defaults are recorded in any case.
fn damage(table: &Table<'_>, _: MaterialScope<'_>) -> Option<Option<DamageMeasure>> {
    let measure = DamageMeasure::read_table(table.table_or_empty("damage")?, ())?;
    Some(table.has("damage").then_some(measure))
}
