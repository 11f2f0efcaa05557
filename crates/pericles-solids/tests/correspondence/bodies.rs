//! Bodies shared by several tests.

use std::sync::Arc;

use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{BondFailure, GivenConstants, LinearSolid, StateInfluence, StressState};
use pericles::operator::{BondForm, Force, PointSubset};
use pericles::space::{Grid, PointCloud, Shape};
use pericles_solids::correspondence::{
    CorrespondenceBody, CorrespondenceMaterial, ElasticLaw, Stabilisation,
};

/// An unbreakable material with E = 10 Pa.
pub fn material(
    poisson_ratio: f64,
    horizon: f64,
    law: ElasticLaw,
    stabilisation: Stabilisation,
) -> CorrespondenceMaterial {
    let solid = LinearSolid {
        density: 1.0,
        elastic: GivenConstants {
            young: Some(10.0),
            poisson_ratio: Some(poisson_ratio),
            ..GivenConstants::default()
        },
        horizon,
        influence: StateInfluence::Function(InfluenceFunction::Constant),
        volume_correction: VolumeCorrection::None,
        failure: BondFailure::Unbreakable,
    };
    CorrespondenceMaterial::new(solid, law, stabilisation)
}

/// Force operator of a material on a body.
pub fn operator(
    cloud: &Arc<PointCloud>,
    material: &CorrespondenceMaterial,
    state: StressState,
) -> Box<dyn Force> {
    let constants = material.constants(cloud, state).unwrap();
    let correction = material.solid.volume_correction;
    let body = CorrespondenceBody::new(cloud, &constants, correction);
    body.operator(BondForm::Fastest).unwrap().operator
}

/// A lattice with unit cells.
pub fn lattice(sides: &[f64]) -> Arc<PointCloud> {
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: sides.to_vec(),
        },
        spacing: 1.0,
        section: 1.0,
        holes: vec![],
    };
    Arc::new(grid.points().unwrap())
}

/// Displaced unit cells with different volumes: x = k + 1/2 + 0.1 sin(1.7 n + 0.3 c), V = 1 + 0.1 sin n for
/// the n-th cell in row-major order.
pub fn jittered(sides: &[usize]) -> Arc<PointCloud> {
    let (dimension, n) = (sides.len(), sides.iter().product::<usize>());
    let mut positions = vec![0.0; dimension * n];
    for cell in 0..n {
        let mut rest = cell;
        for c in (0..dimension).rev() {
            let place = (rest % sides[c]) as f64;
            rest /= sides[c];
            positions[c * n + cell] =
                place + 0.5 + 0.1 * (1.7 * cell as f64 + 0.3 * c as f64).sin();
        }
    }
    let volumes = (0..n).map(|cell| 1.0 + 0.1 * (cell as f64).sin()).collect();
    Arc::new(PointCloud::new(dimension, positions, volumes, 1.0).unwrap())
}

/// u = size cos(0.9 n + 1.1 c).
pub fn wave(cloud: &PointCloud, size: f64) -> Vec<f64> {
    let n = cloud.len();
    let of = |entry: usize| {
        let (c, i) = (entry / n, entry % n);
        size * (0.9 * i as f64 + 1.1 * c as f64).cos()
    };
    (0..cloud.dimension() * n).map(of).collect()
}

/// u = H x.
pub fn affine(cloud: &PointCloud, h: &[[f64; 3]; 3]) -> Vec<f64> {
    let n = cloud.len();
    let of = |entry: usize| {
        let (c, x) = (entry / n, cloud.point(entry % n));
        (0..3).map(|k| h[c][k] * x[k]).sum()
    };
    (0..cloud.dimension() * n).map(of).collect()
}

/// Pseudorandom numbers of magnitude at most 1.
pub fn noise(entries: usize, seed: f64) -> Vec<f64> {
    (0..entries)
        .map(|k| ((k as f64 + seed) * 12.9898).sin() * ((k as f64) * 0.37 + seed).cos())
        .collect()
}

/// Force densities at u.
pub fn force(operator: &dyn Force, u: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; u.len()];
    operator.add_force(0.0, u, PointSubset::All, &mut out);
    out
}

/// Largest magnitude.
pub fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |most, x| most.max(x.abs()))
}
