//! Heated bodies.

use std::sync::Arc;

use crate::bodies::{jittered, solid};
use pericles::family::{Crack, EndRule, VolumeCorrection};
use pericles::kernel::InfluenceFunction;
use pericles::material::{BondLimits, BondMaterial, ElasticModulus, PairLaw, Strains, StressState};
use pericles::operator::{BondBody, BondForm, Force, LinearSolidBody};
use pericles::space::PointCloud;
use pericles::{PointScalar, Temperature, ThermalExpansion};
use pericles_solids::inelastic::{InelasticSolidBody, Inelasticity, ViscousTerm, Yield};

/// T = 20 + 100 (a + b x/10 + c t) K.
#[derive(Debug, Clone)]
pub struct Ramp {
    pub cloud: Arc<PointCloud>,
    pub base: f64,
    pub slope: f64,
    pub rate: f64,
}

impl Temperature for Ramp {
    fn temperatures_into(&self, t: f64, out: &mut [f64]) {
        for (i, out) in out.iter_mut().enumerate() {
            let x = self.cloud.point(i)[0];
            *out = 20.0 + 100.0 * (self.base + 0.1 * self.slope * x + self.rate * t);
        }
    }

    fn is_steady(&self) -> bool {
        self.rate == 0.0
    }
}

/// α of all tests: 100 K stretch a bond by one per cent.
pub const ALPHA: f64 = 1e-4;

/// The expansion of a body with the thermal stretch `base` + `slope` x/10 + `rate` t, in per cent.
pub fn expansion(cloud: &Arc<PointCloud>, [base, slope, rate]: [f64; 3]) -> ThermalExpansion {
    let ramp = Ramp {
        cloud: cloud.clone(),
        base,
        slope,
        rate,
    };
    let coefficient = PointScalar::Uniform(ALPHA);
    ThermalExpansion::new(cloud.clone(), Arc::new(ramp), 20.0, coefficient).unwrap()
}

/// The model of the material of a body.
#[derive(Debug, Clone)]
pub enum Model {
    Bonds(PairLaw),
    Solid(Strains, Inelasticity),
}

/// All models, with small and finite strains.
pub fn models() -> Vec<Model> {
    let viscous = Inelasticity::Viscous(vec![ViscousTerm {
        share: 0.4,
        time: 0.5,
    }]);
    let plastic = Inelasticity::Plastic(Yield {
        stress: 0.1,
        hardening: 0.5,
    });
    vec![
        Model::Bonds(PairLaw::Linear),
        Model::Bonds(PairLaw::BondStretch),
        Model::Bonds(PairLaw::GreenStrain),
        Model::Solid(Strains::Small, Inelasticity::Elastic),
        Model::Solid(Strains::Finite, Inelasticity::Elastic),
        Model::Solid(Strains::Small, viscous.clone()),
        Model::Solid(Strains::Finite, viscous),
        Model::Solid(Strains::Small, plastic),
    ]
}

/// The force of a body of displaced cells with E = 10 and a cut from its left side, not heated; bonds break at the
/// given stretch.
pub fn operator(cloud: &Arc<PointCloud>, model: &Model, limit: f64) -> Box<dyn Force> {
    operator_of(cloud, model, limit, BondForm::List)
}

/// The force of such a body with a force kernel.
pub fn operator_of(
    cloud: &Arc<PointCloud>,
    model: &Model,
    limit: f64,
    form: BondForm,
) -> Box<dyn Force> {
    let state = match cloud.dimension() {
        1 => StressState::Uniaxial,
        2 => StressState::PlaneStress,
        _ => StressState::Spatial,
    };
    let cracks = [(
        Crack::Segment {
            from: [-1.0, 3.03],
            to: [4.0, 3.04],
        },
        EndRule::Closed,
    )];
    let cracks = if cloud.dimension() == 2 {
        &cracks[..]
    } else {
        &[]
    };
    match model {
        Model::Bonds(law) => {
            let mut material = BondMaterial::new(ElasticModulus::Young(10.0), 1.0, 2.5);
            material.law = *law;
            material.volume_correction = VolumeCorrection::None;
            let mut constants = material.constants(cloud, state).unwrap();
            constants.critical_stretch = limit;
            let body = BondBody {
                cracks,
                ..BondBody::new(cloud, &material, &constants)
            };
            body.operator(form).unwrap().operator
        }
        Model::Solid(strains, inelastic) => {
            let function = match inelastic {
                Inelasticity::Plastic(_) => InfluenceFunction::Constant,
                _ => InfluenceFunction::Conical,
            };
            let mut constants = solid(0.35, 2.5, function).constants(cloud, state).unwrap();
            constants.limits = BondLimits {
                stretch: limit,
                ..BondLimits::NONE
            };
            let elastic = LinearSolidBody {
                strains: *strains,
                cracks,
                ..LinearSolidBody::new(cloud, &constants, VolumeCorrection::None)
            };
            if inelastic.is_elastic() {
                return elastic.operator(form).unwrap().operator;
            }
            let laws = [inelastic.clone()];
            let body = InelasticSolidBody {
                elastic,
                laws: &laws,
            };
            body.operator(BondForm::List).unwrap().operator
        }
    }
}

/// A plate and its heated force.
pub fn plate(model: &Model, stretch: [f64; 3], limit: f64) -> (Arc<PointCloud>, Box<dyn Force>) {
    let cloud = jittered(&[12, 8]);
    let mut force = operator(&cloud, model, limit);
    force.expand(expansion(&cloud, stretch)).unwrap();
    (cloud, force)
}
