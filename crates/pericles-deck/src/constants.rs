//! Elastic moduli and strengths, and how bond constants follow from them.

use pericles::kernel::{Influence, InfluenceFunction};
use pericles::material::{
    Calibration, ElasticModulus, Fracture, FractureCalibration, Modulus, StressState,
};
use pericles_waves::ForceForm;

use crate::body::{BodyRead, SolidShape};
use crate::property::{MaterialProperty, number_of};
use crate::quantity::Quantity;
use crate::reader::Table;
use crate::vocabulary::{MODULI, STRENGTHS};
use crate::words::Worded;

/// Rules by which bond constants follow from moduli and fracture energies.
pub(crate) struct ConstantRules {
    /// Stress state.
    pub(crate) state: Option<StressState>,
    /// Allowed calibrations of the modulus.
    pub(crate) sums: Sums,
    /// How critical stretches follow from fracture energies; none if invalid.
    pub(crate) fracture: Option<FractureCalibration>,
}

impl ConstantRules {
    /// Checks the calibration of a modulus; influence functions per lattice class default to the lattice calibration.
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

    /// Sets the body's calibration of the fracture energy.
    pub(crate) fn fracture(&self, read: Option<Fracture>) -> Option<Fracture> {
        Some(match read? {
            Fracture::Energy { energy, .. } => Fracture::Energy {
                energy,
                calibration: self.fracture?,
            },
            other => other,
        })
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

/// Reads the modulus with its calibration, unchecked; see [`ConstantRules::modulus`].
pub(crate) fn modulus(table: &Table<'_>, state: Option<StressState>) -> Option<Modulus> {
    let value = table.exactly_one(MODULI).and_then(|(kind, item)| {
        let number = match kind {
            "youngs_modulus" => number_of(&item, MaterialProperty::YoungsModulus)?,
            _ => item.positive(Quantity::Modulus)?,
        };
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

/// Checks Poisson's ratio against the value of bond-based models.
pub(crate) fn poisson_ratio(table: &Table<'_>, state: Option<StressState>) {
    if state == Some(StressState::Uniaxial) {
        table.forbid(
            "poisson_ratio",
            "the motion of a bar does not depend on Poisson's ratio; remove the key",
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

/// Reads `fracture_energy` or `critical_stretch`; [`ConstantRules::fracture`] sets the calibration.
pub(crate) fn fracture(table: &Table<'_>) -> Option<Fracture> {
    match table.at_most_one(STRENGTHS)? {
        None => Some(Fracture::Unbreakable),
        Some(("fracture_energy", item)) => Some(Fracture::Energy {
            energy: number_of(&item, MaterialProperty::FractureEnergy)?,
            calibration: FractureCalibration::default(),
        }),
        Some((_, item)) => {
            let stretch = number_of(&item, MaterialProperty::CriticalStretch)?;
            Some(Fracture::CriticalStretch(stretch))
        }
    }
}
