//! Inelastic bodies and prescribed steps.

use std::sync::Arc;

use pericles::Path;
use pericles::StepEnd;
use pericles::family::VolumeCorrection;
use pericles::material::LinearSolidConstants;
use pericles::operator::{FiniteStrain, Force, LinearSolidBody, PointSubset};
use pericles::space::PointCloud;
use pericles_solids::inelastic::{
    InelasticSolid, InelasticSolidBody, Inelasticity, ViscousTerm, Yield,
};
use pericles_solids::solid::SolidForce;

pub type Operator<const D: usize> = SolidForce<InelasticSolid<FiniteStrain>, D>;

pub fn viscous(terms: &[[f64; 2]]) -> Inelasticity {
    let terms = terms.iter();
    Inelasticity::Viscous(
        terms
            .map(|&[share, time]| ViscousTerm { share, time })
            .collect(),
    )
}

pub fn plastic(stress: f64, hardening: f64) -> Inelasticity {
    Inelasticity::Plastic(Yield { stress, hardening })
}

/// The force of a body of one material without volume correction.
pub fn operator<const D: usize>(
    cloud: &Arc<PointCloud>,
    constants: &LinearSolidConstants,
    law: &Inelasticity,
) -> Operator<D> {
    let laws = [law.clone()];
    let body = InelasticSolidBody {
        elastic: LinearSolidBody::new(cloud, constants, VolumeCorrection::None),
        laws: &laws,
    };
    let (force, _) = body.force::<FiniteStrain, D>().unwrap();
    force
}

/// Ends a step from `before` to `u` with forces acting as under velocity Verlet; returns the force density.
pub fn step(force: &mut dyn Force, [t, dt]: [f64; 2], before: &[f64], u: &[f64]) -> Vec<f64> {
    let mean: Vec<f64> = before
        .iter()
        .zip(u)
        .map(|(from, to)| if dt > 0.0 { (to - from) / dt } else { 0.0 })
        .collect();
    let end = StepEnd {
        t,
        dt,
        u,
        path: Path::MeanVelocity(&mean),
    };
    let mut out = vec![0.0; u.len()];
    force.end_step(&end, PointSubset::All, &mut out);
    out
}

/// The force density at a time.
pub fn force_at(force: &dyn Force, t: f64, u: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; u.len()];
    force.add_force(t, u, PointSubset::All, &mut out);
    out
}

pub fn scaled(u: &[f64], factor: f64) -> Vec<f64> {
    u.iter().map(|u| factor * u).collect()
}

/// Largest difference of two vectors divided by the largest entry of the second.
pub fn difference(a: &[f64], b: &[f64]) -> f64 {
    let size = b.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let pairs = a.iter().zip(b);
    pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / size
}
