//! Linear peridynamic solids on a lattice: shear stiffness by direction, the influence function that makes it
//! isotropic, the stable step.

use std::f64::consts::PI;
use std::sync::Arc;

use pericles::kernel::Influence;
use pericles::material::{IsotropicInfluence, LatticeShear, LinearSolidConstants};
use pericles::operator::{BondForm, LinearSolidBody};
use pericles::time::highest_frequency;
use pericles::{PointScalar, System};
use pericles_run::RunError;

use super::stencil::{Bond, bonds, weighted_volume};
use super::{cells, correction_of, function_of, horizon, influence_of, solid, state_of};
use crate::data::{Case, Found};

/// Shear modulus along the axes and along the diagonals over G, at δ = (m + 0.015) Δx.
pub(super) fn shear(case: &Case<'_>) -> Result<Found, RunError> {
    let influence = Influence {
        function: function_of(case)?,
        ..Influence::default()
    };
    let sides = vec![1.0; case.count("dimension")?];
    let horizon = case.number("m")? + 0.015;
    let found = LatticeShear::of(&sides, &influence, horizon, correction_of(case)?);
    Ok(Found::default()
        .value("axes", found.map(|shear| shear.axes))
        .value("diagonals", found.map(|shear| shear.diagonals)))
}

/// Coefficient c of w = 1 − c r/δ at δ = m Δx, and the remaining anisotropy.
pub(super) fn isotropic(case: &Case<'_>) -> Result<Found, RunError> {
    let sides = vec![1.0; case.count("dimension")?];
    let (horizon, correction) = (horizon(case.count("m")?), correction_of(case)?);
    let found = IsotropicInfluence::of_lattice(&sides, horizon, correction)?;
    let shear = LatticeShear::of(&sides, &found.influence(), horizon, correction);
    let sign = match found.is_signed() {
        true => "negative near the horizon: not available with breaking bonds",
        false => "",
    };
    Ok(Found::from([("coefficient", found.coefficient())])
        .value("anisotropy", shear.map(|shear| shear.anisotropy()))
        .text("sign", sign))
}

/// Largest eigenvalue of Q for a plane wave on the infinite lattice, ρ ω² û = Q(k) û, with wave vector k in 1/Δx,
/// from the bonds of a node.
fn stiffness_of_wave(bonds: &[Bond], constants: &LinearSolidConstants, k: &[f64]) -> f64 {
    let (d, m) = (k.len(), weighted_volume(bonds));
    let mut matrix = nalgebra::DMatrix::zeros(d, d);
    let mut s = nalgebra::DVector::zeros(d);
    for bond in bonds {
        let xi = nalgebra::DVector::from_fn(d, |c, _| f64::from(bond.xi[c]));
        let phase: f64 = k.iter().zip(xi.iter()).map(|(k, x)| k * x).sum();
        let springs = 2.0 * constants.deviatoric / m * bond.weight * (1.0 - phase.cos())
            / (bond.length * bond.length);
        matrix += springs * &xi * xi.transpose();
        s += bond.weight * phase.sin() * xi;
    }
    matrix += constants.dilatational * d as f64 / (m * m) * &s * s.transpose();
    matrix.symmetric_eigenvalues().max()
}

/// 2/ω_max times the speed of pressure waves over the spacing; the fastest wave travels along an axis.
pub(super) fn stable_step(case: &Case<'_>) -> Result<Found, RunError> {
    let (state, correction) = (state_of(case)?, correction_of(case)?);
    let material = solid(
        case.number("nu")?,
        case.count("m")?,
        influence_of(case)?,
        correction,
    );
    let dimension = state.dimension();
    let constants = material.constants_on(&vec![1.0; dimension], 1.0, state)?;
    let bonds = bonds(
        dimension,
        &constants.influence,
        material.horizon,
        correction,
    );
    let along = |steps: u32| {
        let mut k = vec![0.0; dimension];
        k[0] = PI * f64::from(steps) / 300.0;
        stiffness_of_wave(&bonds, &constants, &k)
    };
    let fastest = (1..=300).map(along).fold(0.0, f64::max);
    let pressure = constants.elastic.longitudinal_modulus(state);
    Ok((2.0 * (pressure / fastest).sqrt()).into())
}

/// Highest frequency of a periodic body by the force operator, and that of the plane waves of the body.
pub(super) fn periodic_body(case: &Case<'_>) -> Result<Found, RunError> {
    let (state, correction) = (state_of(case)?, correction_of(case)?);
    let counts = case.numbers("counts")?;
    let counts: Vec<usize> = counts.into_iter().map(|count| count as usize).collect();
    let material = solid(
        case.number("nu")?,
        case.count("m")?,
        influence_of(case)?,
        correction,
    );
    let cloud = Arc::new(cells(&counts)?.with_periodic_faces()?);
    let constants = material.constants(&cloud, state)?;
    let bonds = bonds(
        counts.len(),
        &constants.influence,
        material.horizon,
        correction,
    );
    let wave = |number: usize| {
        let mut rest = number;
        let along = |&count: &usize| {
            let steps = rest % count;
            rest /= count;
            2.0 * PI * steps as f64 / count as f64
        };
        let k: Vec<f64> = counts.iter().map(along).collect();
        stiffness_of_wave(&bonds, &constants, &k)
    };
    let waves: usize = counts.iter().product();
    let expected = (0..waves).map(wave).fold(0.0, f64::max).sqrt();
    let body = LinearSolidBody::new(&cloud, &constants, correction);
    let operator = body.operator(BondForm::Fastest)?.operator;
    let system = System::new(cloud.clone(), operator, PointScalar::Uniform(1.0))?;
    let found = highest_frequency(&system, &vec![0.0; counts.len() * cloud.len()])?;
    Ok([
        ("value", found.estimate),
        ("waves", expected),
        ("products", found.applications as f64),
    ]
    .into())
}
