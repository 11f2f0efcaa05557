//! What a lattice makes of a linear peridynamic solid: shear stiffness by direction, the influence function that makes it isotropic, the stable step.

use std::sync::Arc;

use pericles::family::VolumeCorrection;
use pericles::kernel::{Influence, InfluenceFunction};
use pericles::material::{
    IsotropicInfluence, LatticeShear, LinearSolidConstants, StateInfluence, StressState,
};
use pericles::operator::{BondForm, LinearSolidBody};
use pericles::time::highest_frequency;
use pericles::{PointScalar, System};
use pericles_run::RunError;

use super::stencil::{Bond, bonds, weighted_volume};
use super::{
    cells, correction_words, function_words, horizon, influence_words, solid, state_words,
};
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(super) const STUDY: Study = Study {
    id: "state-based/lattice",
    paper: "Silling et al. 2007, J. Elasticity 88; Le et al. 2014, Int. J. Numer. Meth. Eng. 98",
    title: "Linear peridynamic solids on lattices: shear by direction, isotropic function, stable step",
    run,
};

const NONE: VolumeCorrection = VolumeCorrection::None;
const LINEAR: VolumeCorrection = VolumeCorrection::Linear;

fn run(_: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let mut rows = shear();
    rows.extend(isotropic()?);
    rows.extend(stable_steps()?);
    rows.extend(periodic_bodies()?);
    Ok(rows)
}

fn influence(function: InfluenceFunction) -> Influence {
    Influence {
        function,
        ..Influence::default()
    }
}

/// G of a shear along the axes and along the diagonals over G, at δ = (N + 0.015) Δx: to the four digits of the table.
fn shear() -> Vec<Row> {
    let functions = [
        (InfluenceFunction::Constant, NONE),
        (InfluenceFunction::Constant, LINEAR),
        (InfluenceFunction::Inverse, LINEAR),
        (InfluenceFunction::Conical, NONE),
    ];
    let table: [(usize, usize, [[f64; 2]; 4]); 5] = [
        (
            3,
            3,
            [
                [1.1102, 0.8347],
                [1.0845, 0.8732],
                [1.0600, 0.9100],
                [1.0019, 0.9972],
            ],
        ),
        (
            3,
            4,
            [
                [1.0191, 0.9714],
                [1.0242, 0.9637],
                [1.0168, 0.9748],
                [1.0082, 0.9877],
            ],
        ),
        (
            2,
            3,
            [
                [0.9647, 1.0353],
                [1.0242, 0.9758],
                [1.0051, 0.9949],
                [1.0356, 0.9644],
            ],
        ),
        (
            2,
            4,
            [
                [0.9532, 1.0468],
                [1.0187, 0.9813],
                [1.0095, 0.9905],
                [1.0241, 0.9759],
            ],
        ),
        (
            2,
            6,
            [
                [1.0341, 0.9659],
                [1.0393, 0.9607],
                [1.0274, 0.9726],
                [1.0102, 0.9898],
            ],
        ),
    ];
    let mut rows = Vec::new();
    for (dimension, spacings, values) in table {
        for ((function, correction), expected) in functions.iter().zip(values) {
            let horizon = spacings as f64 + 0.015;
            let sides = vec![1.0; dimension];
            let function_of = influence(function.clone());
            let found = LatticeShear::of(&sides, &function_of, horizon, *correction);
            let [words, volumes] = [function_words(function), correction_words(*correction)];
            let case = format!("{dimension}D, m = {spacings}, {words}, {volumes}");
            for (what, found, expected) in [
                ("axes", found.map(|shear| shear.axes), expected[0]),
                ("diagonals", found.map(|shear| shear.diagonals), expected[1]),
            ] {
                let case = format!("shear along {what} over G: {case}");
                rows.push(Row::new(case, "", found).within(expected, 6e-5));
            }
        }
    }
    rows
}

/// c of w = 1 − c r/δ at δ = N Δx, to the six digits of the table, and what is left of the anisotropy.
fn isotropic() -> Result<Vec<Row>, RunError> {
    let table = [
        (2, NONE, [0.972200, 0.840501, 0.899245, 1.003997, 1.061526]),
        (
            2,
            LINEAR,
            [0.920993, 1.130157, 1.247754, 1.006401, 1.020997],
        ),
        (3, NONE, [0.898781, 0.997459, 1.081682, 1.013780, 1.004169]),
        (
            3,
            LINEAR,
            [-2.467883, 0.985808, 1.012116, 0.989999, 0.988147],
        ),
    ];
    let mut rows = Vec::new();
    for (dimension, correction, coefficients) in table {
        for (spacings, expected) in (2..).zip(coefficients) {
            let sides = vec![1.0; dimension];
            let horizon = horizon(spacings);
            let found = IsotropicInfluence::of_lattice(&sides, horizon, correction)?;
            let volumes = correction_words(correction);
            let case = format!("{dimension}D, m = {spacings}, {volumes}");
            let row = Row::new(
                format!("c of w = 1 − c r/δ: {case}"),
                "",
                Some(found.coefficient()),
            );
            rows.push(row.within(expected, 3e-6).note(match found.is_signed() {
                true => "negative near the horizon: refused where bonds break",
                false => "",
            }));
            let shear = LatticeShear::of(&sides, &found.influence(), horizon, correction);
            let row = Row::new(
                format!("its anisotropy of the shear: {case}"),
                "",
                shear.map(|shear| shear.anisotropy()),
            );
            rows.push(row.within(0.0, 1e-13));
        }
    }
    Ok(rows)
}

/// A plane wave on the infinite lattice, ρ ω² û = Q(k) û: the largest eigenvalue of Q, for a wave vector k in 1/Δx, by the bonds of a node.
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

/// 2/ω_max times the speed of pressure waves over the spacing, partial volumes; the fastest wave runs along an axis.
fn stable_steps() -> Result<Vec<Row>, RunError> {
    let functions = [
        InfluenceFunction::Constant,
        InfluenceFunction::Inverse,
        InfluenceFunction::Conical,
    ];
    let table = [
        (
            StressState::Spatial,
            3,
            [[1.984, 2.729], [1.883, 2.601], [1.687, 2.321]],
        ),
        (
            StressState::Spatial,
            4,
            [[2.630, 3.604], [2.510, 3.450], [2.300, 3.164]],
        ),
        (
            StressState::PlaneStrain,
            3,
            [[2.063, 2.885], [1.895, 2.662], [1.684, 2.358]],
        ),
        (
            StressState::PlaneStress,
            3,
            [[1.945, 2.173], [1.787, 1.996], [1.589, 1.775]],
        ),
    ];
    let mut rows = Vec::new();
    for (state, spacings, values) in table {
        for (function, values) in functions.iter().zip(values) {
            for (nu, expected) in [0.25, 0.4].into_iter().zip(values) {
                let influence = StateInfluence::Function(function.clone());
                let material = solid(nu, spacings, influence, LINEAR);
                let dimension = state.dimension();
                let constants = material.constants_on(&vec![1.0; dimension], 1.0, state)?;
                let bonds = bonds(dimension, &constants.influence, material.horizon, LINEAR);
                let along = |steps: u32| {
                    let mut k = vec![0.0; dimension];
                    k[0] = std::f64::consts::PI * f64::from(steps) / 300.0;
                    stiffness_of_wave(&bonds, &constants, &k)
                };
                let fastest = (1..=300).map(along).fold(0.0, f64::max);
                let pressure = constants.elastic.longitudinal_modulus(state);
                let step = 2.0 * (pressure / fastest).sqrt();
                let words = function_words(function);
                let case = format!("{}, m = {spacings}, {words}, ν = {nu}", state_words(state));
                let row = Row::new(format!("stable step × c/Δx: {case}"), "", Some(step));
                rows.push(row.within(expected, 1e-3));
            }
        }
    }
    Ok(rows)
}

/// The highest frequency of periodic bodies by the force operator, against the plane waves that these bodies have.
fn periodic_bodies() -> Result<Vec<Row>, RunError> {
    let cases = [
        (
            StressState::Spatial,
            vec![13, 12, 14],
            StateInfluence::Isotropic,
            0.4,
        ),
        (
            StressState::PlaneStrain,
            vec![40, 36],
            StateInfluence::Function(InfluenceFunction::Inverse),
            0.4,
        ),
        (
            StressState::PlaneStress,
            vec![38, 40],
            StateInfluence::Function(InfluenceFunction::Conical),
            0.1,
        ),
    ];
    let mut rows = Vec::new();
    for (state, counts, influence, nu) in cases {
        let words = influence_words(&influence);
        let material = solid(nu, 3, influence, LINEAR);
        let cloud = Arc::new(cells(&counts)?.with_periodic_faces()?);
        let constants = material.constants(&cloud, state)?;
        let bonds = bonds(counts.len(), &constants.influence, material.horizon, LINEAR);
        let wave = |number: usize| {
            let mut rest = number;
            let k: Vec<f64> = counts
                .iter()
                .map(|&count| {
                    let steps = rest % count;
                    rest /= count;
                    2.0 * std::f64::consts::PI * steps as f64 / count as f64
                })
                .collect();
            stiffness_of_wave(&bonds, &constants, &k)
        };
        let waves: usize = counts.iter().product();
        let expected = (0..waves).map(wave).fold(0.0, f64::max).sqrt();
        let body = LinearSolidBody::new(&cloud, &constants, LINEAR);
        let operator = body.operator(BondForm::Fastest)?.operator;
        let system = System::new(cloud.clone(), operator, PointScalar::Uniform(1.0))?;
        let rest = vec![0.0; counts.len() * cloud.len()];
        let found = highest_frequency(&system, &rest)?;
        let case = format!(
            "highest frequency of a periodic body: {}, {words}",
            state_words(state)
        );
        rows.push(
            Row::new(case, "1/s", Some(found.estimate))
                .within_share(expected, 1e-3)
                .note(format!("{} products", found.applications)),
        );
    }
    Ok(rows)
}
