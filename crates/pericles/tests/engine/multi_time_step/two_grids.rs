//! Bodies with cells of several sizes.

use std::sync::Arc;

use pericles::family::VolumeCorrection;
use pericles::material::{BondMaterial, Fracture, StressState};
use pericles::operator::{BondBody, BondForm, DamageMeasure, Force, GradedBody, On};
use pericles::space::{Finer, GradedCloud, GradedGrid, Grid, PointCloud, Region, Shape};
use pericles::time::{Fine, Integrator, Respa, State, highest_frequency};
use pericles::{Control, PointScalar, Simulation, System};

use crate::common::{boxed, material, points};

const SPACING: f64 = 0.01;

fn glass(volume_correction: VolumeCorrection) -> BondMaterial {
    material(
        2440.0,
        72e9,
        3.0 * SPACING,
        volume_correction,
        Fracture::Unbreakable,
    )
}

/// A box of cells, those inside the region divided by `ratio`.
fn graded(size: &[f64], region: Region, ratio: u32) -> GradedCloud {
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: size.to_vec(),
        },
        spacing: SPACING,
        section: 1.0,
        holes: vec![],
    };
    let finer = vec![Finer { region, ratio }];
    GradedGrid { grid, finer }.points().unwrap()
}

fn bonds(
    points: GradedCloud,
    material: &BondMaterial,
    state: StressState,
) -> (Arc<PointCloud>, Box<dyn Force>) {
    let cloud = Arc::new(points.cloud);
    let body = GradedBody {
        cloud: &cloud,
        ratios: &points.ratios,
        grid_of_point: &points.grid_of_point,
        material,
        state,
        cracks: &[],
        no_fail: &[],
        stiffness: &[],
        damage: DamageMeasure::default(),
    };
    let operator = body.operator().unwrap().operator;
    (cloud, operator)
}

fn middle(dimension: usize) -> Region {
    let mut bounds = [[f64::NEG_INFINITY; 3], [f64::INFINITY; 3]];
    for c in 0..dimension {
        bounds[0][c] = 0.04;
        bounds[1][c] = 0.08;
    }
    Region::Box {
        min: bounds[0],
        max: bounds[1],
    }
}

/// Smooth and different everywhere.
fn bumpy(cloud: &PointCloud) -> Vec<f64> {
    let n = cloud.len();
    (0..cloud.dimension() * n)
        .map(|k| {
            let [x, y, z] = cloud.point(k % n);
            let phase = (k / n) as f64;
            1e-4 * (37.0 * x + 3.0 * phase).sin() * (1.0 + (23.0 * y - 11.0 * z).cos())
        })
        .collect()
}

#[test]
fn divided_everywhere_it_is_the_body_of_small_cells() {
    for correction in [VolumeCorrection::None, VolumeCorrection::Extended] {
        let material = glass(correction);
        let state = StressState::PlaneStress;
        let (cloud, force) = bonds(graded(&[0.12, 0.08], Region::All, 2), &material, state);
        let half = 0.5 * SPACING;
        let plain = boxed([0.0; 3], &[0.12, 0.08], half, 1.0);
        let small = BondMaterial {
            horizon: 3.0 * half,
            ..material
        };
        let constants = small.constants(&plain, state).unwrap();
        let body = BondBody::new(&plain, &small, &constants);
        let expected = body.operator(BondForm::List).unwrap().operator;
        assert_eq!(force.directed_bonds(), expected.directed_bonds());
        // The points come in another order.
        let same: Vec<usize> = (0..cloud.len())
            .map(|i| plain.nearest(cloud.point(i)))
            .collect();
        let evaluate = |force: &dyn Force, cloud: &PointCloud| {
            let mut out = vec![0.0; 2 * cloud.len()];
            force.add_force(0.0, &bumpy(cloud), On::All, &mut out);
            out
        };
        let (found, expected) = (evaluate(&*force, &cloud), evaluate(&*expected, &plain));
        let n = cloud.len();
        let scale = expected.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
        for i in 0..n {
            for c in 0..2 {
                let error = (found[c * n + i] - expected[c * n + same[i]]).abs();
                assert!(error < 1e-11 * scale, "{error} {scale}");
            }
        }
    }
}

#[test]
fn both_ends_of_every_bond_pull_alike() {
    for (dimension, state) in [
        (1, StressState::Uniaxial),
        (2, StressState::PlaneStrain),
        (3, StressState::Spatial),
    ] {
        let size = vec![0.12; dimension];
        let points = graded(&size, middle(dimension), 2);
        let (cloud, force) = bonds(points, &glass(VolumeCorrection::Extended), state);
        let n = cloud.len();
        let mut density = vec![0.0; dimension * n];
        force.add_force(0.0, &bumpy(&cloud), On::All, &mut density);
        for component in density.chunks(n) {
            let pull = |i: usize| component[i] * cloud.volumes()[i];
            let (sum, size) = (0..n).fold((0.0, 0.0), |(sum, size), i| {
                (sum + pull(i), size + pull(i).abs())
            });
            assert!(sum.abs() < 1e-13 * size, "{sum} of {size}");
        }
    }
}

#[test]
fn two_time_steps_on_two_grids_keep_momentum_and_energy() {
    let points_of = graded(&[0.24, 0.16], middle_of_plate(), 3);
    let state = StressState::PlaneStress;
    let (cloud, force) = bonds(points_of, &glass(VolumeCorrection::Extended), state);
    let system = System::new(cloud.clone(), force, PointScalar::Uniform(2440.0)).unwrap();
    let fine = points(&cloud, |x, y, _| {
        (x - 0.12).abs() < 0.062 && (y - 0.08).abs() < 0.062
    });
    let mut state = State::at_rest(2 * cloud.len());
    for (k, v) in state.v.iter_mut().enumerate() {
        *v = 1.0 + ((k * k) as f64).sin();
    }
    let scheme = Respa::new(3, Fine::Fixed(vec![fine]), &system).unwrap();
    // The large cells alone limit the coarse step.
    let whole = highest_frequency(&system, &state.u).unwrap();
    let limiting = scheme.limiting_frequency(&system, &state.u, whole).unwrap();
    let ratio = whole.estimate / limiting.estimate;
    assert!((2.4..3.1).contains(&ratio), "{ratio}");
    let momentum = system.momentum(&state.v);
    let dt = limiting.stable_step(2.0, 0.5);
    let mut run = Simulation::new(system, Box::new(scheme), state, dt, 400).unwrap();
    let at_start = run.start_energy().energy;
    run.run(|_| Control::Continue).unwrap();
    let energies = run.snapshot().energies();
    let change = (energies.kinetic + energies.elastic) / at_start - 1.0;
    assert!(change.abs() < 0.1, "{change}");
    let after = run.system().momentum(&run.state().v);
    for c in 0..2 {
        assert!((after[c] / momentum[c] - 1.0).abs() < 1e-12);
    }
}

fn middle_of_plate() -> Region {
    Region::Box {
        min: [0.09, 0.05, f64::NEG_INFINITY],
        max: [0.15, 0.11, f64::INFINITY],
    }
}
