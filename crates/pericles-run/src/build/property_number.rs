//! The number of a property in the model of a material.

use pericles::material::{BondFailure, ElasticModulus, Fracture, LinearSolid};
use pericles_deck::{FailureCriterion, MaterialModel, MaterialProperty, Model};
use pericles_solids::inelastic::Inelasticity;

/// Returns whether the critical stretch of a material follows from its fracture energy and modulus.
pub(super) fn has_stretch_of_energy(model: &MaterialModel) -> bool {
    let of_solid = |failure: &BondFailure| matches!(failure, BondFailure::Stretch { .. });
    match model {
        MaterialModel::Bonds(bonds) => matches!(bonds.fracture, Fracture::Energy { .. }),
        MaterialModel::StateBased(own) => of_solid(&own.solid.failure),
        MaterialModel::Correspondence(own) => of_solid(&own.solid.failure),
    }
}

/// Returns the number of a property of a material; `None` if the material does not have it.
pub(super) fn number_of(model: &MaterialModel, property: MaterialProperty) -> Option<f64> {
    let mut copy = model.clone();
    number_in(&mut copy, property).map(|number| *number)
}

pub(super) fn set_number(
    model: &mut Model,
    material: usize,
    property: MaterialProperty,
    value: f64,
) {
    let own = match material.checked_sub(1) {
        None => model
            .body
            .solid_mut()
            .map(|solid| &mut solid.material.model),
        Some(other) => model.materials.get_mut(other).map(|other| &mut other.model),
    };
    if let Some(number) = own.and_then(|own| number_in(own, property)) {
        *number = value;
    }
}

/// Returns the number of a property of a material for modification.
fn number_in(model: &mut MaterialModel, property: MaterialProperty) -> Option<&mut f64> {
    use MaterialProperty::{
        CriticalStretch, Density, FractureEnergy, Strength, YieldStress, YoungsModulus,
    };
    match model {
        MaterialModel::Bonds(bonds) => match (property, &mut bonds.fracture) {
            (Density, _) => Some(&mut bonds.density),
            (YoungsModulus, _) => match &mut bonds.modulus.value {
                ElasticModulus::Young(value) => Some(value),
                ElasticModulus::Bulk(_) | ElasticModulus::Shear(_) => None,
            },
            (CriticalStretch, Fracture::CriticalStretch(stretch)) => Some(stretch),
            (FractureEnergy, Fracture::Energy { energy, .. }) => Some(energy),
            (CriticalStretch | FractureEnergy | Strength | YieldStress, _) => None,
        },
        MaterialModel::StateBased(own) => match property {
            Strength => strength_in(&mut own.criterion),
            YieldStress => match &mut own.inelastic {
                Inelasticity::Plastic(law) => Some(&mut law.stress),
                Inelasticity::Elastic | Inelasticity::Viscous(_) => None,
            },
            _ => of_solid(&mut own.solid, property),
        },
        MaterialModel::Correspondence(own) => match property {
            Strength => strength_in(&mut own.criterion),
            YieldStress => own.plasticity.as_mut().map(|law| &mut law.yield_stress),
            _ => of_solid(&mut own.solid, property),
        },
    }
}

fn strength_in(criterion: &mut Option<FailureCriterion>) -> Option<&mut f64> {
    match criterion {
        Some(FailureCriterion::PrincipalStress(strength)) => Some(strength),
        Some(FailureCriterion::Expression(_)) | None => None,
    }
}

fn of_solid(solid: &mut LinearSolid, property: MaterialProperty) -> Option<&mut f64> {
    match (property, &mut solid.failure) {
        (MaterialProperty::Density, _) => Some(&mut solid.density),
        (MaterialProperty::YoungsModulus, _) => solid.elastic.young.as_mut(),
        (MaterialProperty::CriticalStretch, BondFailure::CriticalStretch(stretch)) => Some(stretch),
        (
            MaterialProperty::FractureEnergy,
            BondFailure::Stretch {
                fracture_energy, ..
            }
            | BondFailure::BondEnergy {
                fracture_energy, ..
            },
        ) => Some(fracture_energy),
        _ => None,
    }
}
