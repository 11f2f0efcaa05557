//! Bodies shared by several tests.

use std::sync::Arc;

use pericles::family::{BondList, VolumeCorrection};
use pericles::kernel::InfluenceFunction;
use pericles::material::{
    BondFailure, GivenConstants, LinearSolid, LinearSolidConstants, StateInfluence, StressState,
};
use pericles::space::PointCloud;

/// A solid with E = 10 Pa and Poisson's ratio ν that does not break.
pub fn solid(poisson_ratio: f64, horizon: f64, function: InfluenceFunction) -> LinearSolid {
    LinearSolid {
        density: 1.0,
        elastic: GivenConstants {
            young: Some(10.0),
            poisson_ratio: Some(poisson_ratio),
            ..GivenConstants::default()
        },
        horizon,
        influence: StateInfluence::Function(function),
        volume_correction: VolumeCorrection::None,
        failure: BondFailure::Unbreakable,
    }
}

/// Displaced cells of size one with different volumes: x = k + 1/2 + 0.1 sin(1.7 n + 0.3 c), V = 1 + 0.1 sin n for
/// the n-th cell in the order of C arrays.
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

/// Irregular numbers of absolute value up to one.
pub fn noise(entries: usize, seed: f64) -> Vec<f64> {
    (0..entries)
        .map(|k| ((k as f64 + seed) * 12.9898).sin() * ((k as f64) * 0.37 + seed).cos())
        .collect()
}

/// The three bodies of the reference values with their constants.
pub fn bodies(function: &InfluenceFunction) -> Vec<(Arc<PointCloud>, LinearSolidConstants)> {
    [
        (vec![5, 5, 5], StressState::Spatial, 0.4, 2.3),
        (vec![9, 9], StressState::PlaneStrain, 0.1, 2.7),
        (vec![9, 9], StressState::PlaneStress, 0.45, 2.7),
        (vec![20], StressState::Uniaxial, 0.3, 3.2),
    ]
    .into_iter()
    .map(|(sides, state, nu, horizon)| {
        let cloud = jittered(&sides);
        let constants = solid(nu, horizon, function.clone()).constants(&cloud, state);
        (cloud, constants.unwrap())
    })
    .collect()
}

/// The bonds of a body within its horizon, without volume correction.
pub fn families(cloud: &Arc<PointCloud>, constants: &LinearSolidConstants) -> BondList {
    BondList::new(cloud, constants.horizon, VolumeCorrection::None).unwrap()
}
