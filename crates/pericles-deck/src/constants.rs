//! Elastic moduli and strengths, and how bond constants follow from them.

use pericles::kernel::{Influence, InfluenceFunction};
use pericles::material::{
    Calibration, ElasticModulus, Fracture, FractureCalibration, Modulus, StressState,
};
use pericles_deck_derive::{DeckKeys, DeckTable};
use pericles_waves::ForceForm;
use serde::{Deserialize, Serialize};

use crate::body::{BodyRead, SolidShape};
use crate::form::described;
use crate::property::{MaterialProperty, number_of};
use crate::reader::Table;
use crate::vocabulary::STRENGTHS;
use crate::words::Worded;

/// Elastic modulus; the scope is the stress state.
#[derive(Serialize, Deserialize, DeckKeys)]
#[serde(remote = "ElasticModulus", deny_unknown_fields)]
#[deck(exclusive, remote = ElasticModulus, scope = Option<StressState>)]
enum ElasticModulusForm {
    #[serde(rename = "youngs_modulus")]
    #[deck(key = "youngs_modulus")]
    Young(
        /// Young's modulus E. Every material needs elastic constants: bond-based ones exactly one of E, K and G; state-based
        /// and correspondence ones two of E, ν, K and G, or E alone for a bar. A number or an expression of position, with
        /// which all moduli change in proportion at constant ν; a bond of a bond-based material has the mean stiffness of its
        /// end points. Expressions use a neighbour list in state-based materials.
        #[deck(
            with = number_of(MaterialProperty::YoungsModulus),
            range = POSITIVE,
            accept = young
        )]
        f64,
    ),
    #[serde(rename = "bulk_modulus")]
    #[deck(key = "bulk_modulus")]
    Bulk(
        /// Bulk modulus K.
        #[deck(quantity = Modulus, range = POSITIVE, accept = bulk)]
        f64,
    ),
    #[serde(rename = "shear_modulus")]
    #[deck(key = "shear_modulus")]
    Shear(
        /// Shear modulus G.
        #[deck(quantity = Modulus, range = POSITIVE, accept = shear)]
        f64,
    ),
}

fn young(modulus: &f64, state: Option<StressState>) -> pericles::Result<()> {
    accept(ElasticModulus::Young(*modulus), state)
}

fn bulk(modulus: &f64, state: Option<StressState>) -> pericles::Result<()> {
    accept(ElasticModulus::Bulk(*modulus), state)
}

fn shear(modulus: &f64, state: Option<StressState>) -> pericles::Result<()> {
    accept(ElasticModulus::Shear(*modulus), state)
}

/// Rejects a modulus that does not determine Young's modulus in this stress state.
fn accept(modulus: ElasticModulus, state: Option<StressState>) -> pericles::Result<()> {
    match state {
        Some(state) => modulus.young(state).map(drop),
        None => Ok(()),
    }
}

/// Elastic modulus of bonds with its calibration.
#[derive(Serialize, Deserialize, DeckTable)]
#[serde(remote = "Modulus", deny_unknown_fields)]
#[deck(remote = Modulus, scope = Option<StressState>)]
struct ModulusForm {
    #[serde(with = "crate::form")]
    #[deck(flatten)]
    value: ElasticModulus,
    /// Bond-based: how the bond constant c follows from the elastic modulus. `continuum`: integrals over the horizon; the
    /// stiffness on a grid then has the error that `check` prints (-5.8 % for a conical influence function and m = 3).
    /// `lattice`: sums over the bonds of the grid, exact in the bulk; recommended. `unmodified`: integrals of the constant
    /// influence function with the same `acts_on`. The functions `lattice-classes` and `tuned` always use `lattice`; spectral
    /// forces and Gauss nodes use integrals.
    #[serde(with = "crate::form")]
    #[deck(
        key = "modulus",
        default = Calibration::Continuum,
        otherwise = "the bulk stiffness of a state-based material is exact on every lattice; use influence = { function = \"isotropic\" } for exact shear"
    )]
    calibration: Calibration,
}

/// Strength of bonds. The scope is the calibration of the fracture energy; none if it is invalid.
#[derive(Serialize, Deserialize, DeckKeys)]
#[serde(remote = "Fracture", rename_all = "snake_case", deny_unknown_fields)]
#[deck(
    exclusive,
    remote = Fracture,
    default = Fracture::Unbreakable,
    scope = Option<FractureCalibration>
)]
enum FractureForm {
    Unbreakable,
    #[deck(key = "fracture_energy")]
    Energy {
        /// Fracture energy G_c per crack area, a number or an expression of position. It determines the critical stretch by
        /// `fracture_calibration`. Default: bonds never break unless `critical_stretch` is given.
        #[deck(with = number_of(MaterialProperty::FractureEnergy), range = POSITIVE)]
        energy: f64,
        #[serde(with = "crate::form")]
        #[deck(flatten, keys(), with = calibration)]
        calibration: FractureCalibration,
    },
    CriticalStretch(
        /// Critical stretch s₀, a number or an expression of position: bonds break when their stretch exceeds it. A bond has the
        /// mean of its end points.
        #[deck(with = number_of(MaterialProperty::CriticalStretch), range = POSITIVE)]
        f64,
    ),
}

fn calibration(_: &Table<'_>, scope: Option<FractureCalibration>) -> Option<FractureCalibration> {
    scope
}

described!(ElasticModulus: ElasticModulusForm, Modulus: ModulusForm, Fracture: FractureForm);

/// Rules by which bond constants follow from moduli and fracture energies.
pub(crate) struct ConstantRules {
    /// Allowed calibrations of the modulus.
    pub(crate) sums: Sums,
}

impl ConstantRules {
    /// Checks the calibration of a modulus; influence functions per lattice class default to the lattice calibration.
    pub(crate) fn modulus(&self, table: &Table<'_>, read: Modulus) -> Option<Modulus> {
        let given = table.optional("modulus");
        match (self.sums, read.calibration, given) {
            (Sums::Lattice, _, None) => {
                table.record("modulus", "lattice");
                Some(Modulus {
                    calibration: Calibration::Lattice,
                    ..read
                })
            }
            (Sums::Lattice, Calibration::Continuum | Calibration::Unmodified, Some(item)) => {
                item.out_of_range(
                    "\"lattice\"; the influence functions `lattice-classes` and `tuned` have no integrals",
                );
                None
            }
            (Sums::Spectral | Sums::Gauss, Calibration::Lattice, Some(item)) => {
                item.out_of_range(match self.sums {
                    Sums::Gauss => {
                        "\"continuum\" or \"unmodified\"; Gauss nodes are not a lattice"
                    }
                    _ => {
                        "\"continuum\" or \"unmodified\"; bonds = \"spectral\" uses integrals instead of lattice sums"
                    }
                });
                None
            }
            _ => Some(read),
        }
    }

    pub(crate) fn check_volume_correction(&self, table: &Table<'_>) {
        if matches!(self.sums, Sums::Spectral) {
            table.forbid(
                "volume_correction",
                "bonds = \"spectral\" integrates exactly up to the horizon, without partial cells; remove the key",
            );
        }
    }
}

/// Sums or integrals from which bond constants follow.
#[derive(Clone, Copy)]
pub(crate) enum Sums {
    Any,
    /// Lattice sums only: influence functions per lattice class.
    Lattice,
    /// Fourier symbol of an integral operator.
    Spectral,
    /// Sums over Gauss nodes.
    Gauss,
}

impl Sums {
    pub(crate) fn of(
        influence: Option<&Influence>,
        form: Option<ForceForm>,
        body: &BodyRead,
    ) -> Self {
        let gauss = body.shape.as_ref().is_some_and(SolidShape::has_gauss_nodes);
        match influence.map(|influence| &influence.function) {
            Some(InfluenceFunction::Classes(_)) => Self::Lattice,
            _ if form == Some(ForceForm::Spectral) => Self::Spectral,
            _ if gauss => Self::Gauss,
            _ => Self::Any,
        }
    }
}

/// Reads `fracture_calibration`. `shared`: other materials inherit it, so that it is allowed even if the
/// bonds of this one never break.
pub(crate) fn fracture_calibration(
    table: &Table<'_>,
    body: &BodyRead,
    shared: bool,
) -> Option<FractureCalibration> {
    let listed = body.shape.as_ref().is_some_and(SolidShape::is_listed);
    if !shared && !STRENGTHS.iter().any(|key| table.has(key)) {
        table.forbid(
            "fracture_calibration",
            "bonds without `fracture_energy` never break",
        );
        return Some(FractureCalibration::default());
    }
    let Some(item) = table.optional("fracture_calibration") else {
        let calibration = match listed {
            true => FractureCalibration::Continuum,
            false => FractureCalibration::Lattice,
        };
        table.record("fracture_calibration", calibration.name());
        return Some(calibration);
    };
    let given = item.choice("fracture calibration", &FractureCalibration::words())?;
    if listed && given == FractureCalibration::Lattice {
        item.out_of_range("\"continuum\"; listed points have no lattice planes");
        return None;
    }
    Some(given)
}
