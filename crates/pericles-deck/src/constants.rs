//! Elastic moduli and strengths in a deck, and how the constants of bonds follow from them.

use pericles::kernel::{Influence, InfluenceFunction};
use pericles::material::{
    Calibration, ElasticModulus, Fracture, FractureCalibration, Modulus, StressState,
};
use pericles_waves::ForceForm;

use crate::body::{BodyRead, SolidShape};
use crate::quantity::Quantity;
use crate::reader::Table;
use crate::vocabulary::{MODULI, STRENGTHS};
use crate::words::Worded;

/// How the constants of bonds follow from moduli and fracture energies.
pub(crate) struct ConstantRules {
    /// The state of stress.
    pub(crate) state: Option<StressState>,
    /// How the modulus may be calibrated.
    pub(crate) sums: Sums,
    /// How critical stretches follow from fracture energies; none if it is not given rightly.
    pub(crate) fracture: Option<FractureCalibration>,
}

impl ConstantRules {
    /// The modulus as read, if its calibration can be had; tables per class take the lattice's where none is given.
    pub(crate) fn modulus(&self, table: &Table<'_>, read: Option<Modulus>) -> Option<Modulus> {
        let read = read?;
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
                    "\"lattice\": coefficients per class of bonds (`classes`, `tuned`) have no integrals",
                );
                None
            }
            (Sums::Spectral | Sums::Gauss, Calibration::Lattice, Some(item)) => {
                item.out_of_range(match self.sums {
                    Sums::Gauss => {
                        "\"continuum\" or \"unmodified\": the Gauss nodes of a bar are no lattice"
                    }
                    _ => {
                        "\"continuum\" or \"unmodified\": bonds = \"spectral\" takes integrals, no sums over a lattice"
                    }
                });
                None
            }
            _ => Some(read),
        }
    }

    /// The fracture as read, with the body's calibration.
    pub(crate) fn fracture(&self, read: Option<Fracture>) -> Option<Fracture> {
        Some(match read? {
            Fracture::Energy { energy, .. } => Fracture::Energy {
                energy,
                calibration: self.fracture?,
            },
            other => other,
        })
    }

    pub(crate) fn judge_volume_correction(&self, table: &Table<'_>) {
        if matches!(self.sums, Sums::Spectral) {
            table.forbid(
                "volume_correction",
                "bonds = \"spectral\" integrates up to the horizon exactly: no cells are cut; leave it out",
            );
        }
    }
}

/// The sums or integrals that the modulus of a body's bonds may follow from.
#[derive(Clone, Copy)]
pub(crate) enum Sums {
    Any,
    /// A table per class has no integrals.
    Lattice,
    /// The spectrum of an integral operator.
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

/// The modulus with the calibration as written; see [`ConstantRules::modulus`].
pub(crate) fn modulus(table: &Table<'_>, state: Option<StressState>) -> Option<Modulus> {
    let value = table.exactly_one(MODULI).and_then(|(kind, item)| {
        let number = item.positive(Quantity::Modulus)?;
        let value = match kind {
            "youngs_modulus" => ElasticModulus::Young(number),
            "bulk_modulus" => ElasticModulus::Bulk(number),
            _ => ElasticModulus::Shear(number),
        };
        if let Some(state) = state {
            item.accept(value.young(state))?;
        }
        Some(value)
    });
    let calibration = table.worded("modulus", "calibration");
    Some(Modulus {
        value: value?,
        calibration: calibration?,
    })
}

/// How critical stretches follow from fracture energies. `shared`: other materials take it over, so that it has a meaning even where the bonds of this one never break.
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
        item.out_of_range("\"continuum\": points listed in a file have no lattice planes");
        return None;
    }
    Some(given)
}

/// Checks Poisson's ratio against the one that bonds have.
pub(crate) fn poisson_ratio(table: &Table<'_>, state: Option<StressState>) {
    if state == Some(StressState::Uniaxial) {
        table.forbid(
            "poisson_ratio",
            "a bar contracts across its axis without any effect on its motion; leave it out",
        );
        return;
    }
    let Some(item) = table.optional("poisson_ratio") else {
        return;
    };
    if let (Some(ratio), Some(state)) = (item.quantity(Quantity::Number), state) {
        item.accept(state.check_poisson_ratio(ratio));
    }
}

/// When bonds break; how the critical stretch follows from a fracture energy is the body's matter ([`ConstantRules::fracture`]).
pub(crate) fn fracture(table: &Table<'_>) -> Option<Fracture> {
    match table.at_most_one(STRENGTHS)? {
        None => Some(Fracture::Unbreakable),
        Some(("fracture_energy", item)) => Some(Fracture::Energy {
            energy: item.positive(Quantity::SurfaceEnergy)?,
            calibration: FractureCalibration::default(),
        }),
        Some((_, item)) => Some(Fracture::CriticalStretch(item.positive(Quantity::Number)?)),
    }
}
