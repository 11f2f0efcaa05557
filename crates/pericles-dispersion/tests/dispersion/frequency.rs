//! Highest frequency of bodies compared with dense eigenvalues and with the dispersion relation of their lattice.

use crate::common;
use std::sync::Arc;

use nalgebra::DMatrix;
use pericles::boundary::{MotionKind, PrescribedMotion, TimeFunction};
use pericles::family::VolumeCorrection;
use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::material::{BondMaterial, BondStretch, Fracture, LinearBond, PairLaw, StressState};
use pericles::operator::{BondBody, BondForm};
use pericles::space::PointCloud;
use pericles::time::{HighestFrequency, highest_frequency};
use pericles::{PointScalar, System};
use pericles_dispersion::{BondLattice, stability};
use pericles_waves::linear::ConvolutionForce;

const YOUNG: f64 = 70e9;
const DENSITY: f64 = 2700.0;

fn material(cloud: &PointCloud, ratio: f64, influence: InfluenceFunction) -> BondMaterial {
    BondMaterial {
        law: PairLaw::BondStretch,
        influence: Influence {
            function: influence,
            acts_on: ActsOn::Stretch,
        },
        ..common::material(
            DENSITY,
            YOUNG,
            ratio * cloud.spacing(),
            VolumeCorrection::Extended,
            Fracture::Unbreakable,
        )
    }
}

/// Highest frequency from all eigenvalues of the dense matrix.
fn dense(system: &System) -> f64 {
    let u = vec![0.0; system.dimension() * system.points()];
    let roots: Vec<f64> = system.masses().iter().map(|m| m.sqrt()).collect();
    let n = u.len();
    let mut matrix = DMatrix::zeros(n, n);
    let (mut unit, mut column) = (u.clone(), u.clone());
    for k in 0..n {
        unit[k] = 1.0;
        system.hold(&mut unit);
        system.vibration_into(&u, &unit, &mut column);
        unit[k] = 0.0;
        for i in 0..n {
            matrix[(i, k)] = roots[i] * column[i] / roots[k];
        }
    }
    let matrix = 0.5 * (&matrix + matrix.transpose());
    matrix.symmetric_eigenvalues().max().sqrt()
}

fn assert_encloses(name: &str, found: HighestFrequency, truth: f64) {
    let [low, high] = [found.estimate, found.bound].map(|omega| omega / truth);
    assert!(
        low <= 1.0 + 1e-9,
        "{name}: estimate {low} of the truth, {found:?}"
    );
    assert!(
        high >= 1.0 - 1e-12,
        "{name}: bound {high} of the truth, {found:?}"
    );
    assert!(
        high <= 1.001,
        "{name}: bound {high} of the truth, {found:?}"
    );
    assert!(
        found.converged && found.failure_probability <= 1e-9,
        "{name}: {found:?}"
    );
}

#[test]
fn highest_frequency_of_small_bodies_is_accurate_to_a_thousandth() {
    let grid = |size: &[f64]| common::boxed([0.0; 3], size, 1e-3, 1.0);
    let body = |cloud: &Arc<PointCloud>, ratio, influence| -> System {
        let material = material(cloud, ratio, influence);
        let state = [
            StressState::Uniaxial,
            StressState::PlaneStress,
            StressState::Spatial,
        ][cloud.dimension() - 1];
        let constants = material.constants(cloud, state).unwrap();
        let bonds = BondBody::new(cloud, &material, &constants);
        let operator = bonds.operator(BondForm::Fastest).unwrap().operator;
        System::new(cloud.clone(), operator, PointScalar::Uniform(DENSITY)).unwrap()
    };
    let (bar, plate, block) = (
        grid(&[0.06]),
        grid(&[0.016, 0.009]),
        grid(&[7e-3, 5e-3, 4e-3]),
    );
    let wave = InfluenceFunction::Conical;
    let constant = InfluenceFunction::Constant;
    let bodies = [
        ("bar", body(&bar, 3.0, constant.clone())),
        ("conical bar", body(&bar, 6.0, wave.clone())),
        ("plate", body(&plate, 3.0, constant.clone())),
        ("conical plate", body(&plate, 4.0, wave)),
        ("block", body(&block, 2.0, constant.clone())),
    ];
    for (name, system) in &bodies {
        let rest = vec![0.0; system.dimension() * system.points()];
        assert_encloses(
            name,
            highest_frequency(system, &rest).unwrap(),
            dense(system),
        );
    }
    // With supports and lighter parts.
    let mut held = body(&plate, 3.0, constant);
    let edge = common::points(&plate, |x, _, _| x < 2e-3);
    let n = plate.len();
    let motion = PrescribedMotion::new(
        "edge".into(),
        edge,
        MotionKind::Displacement,
        [Some(0.0), Some(0.0), None],
        TimeFunction::Constant,
        &vec![0.0; 2 * n],
        n,
    )
    .unwrap();
    held.add_motion(motion).unwrap();
    let rest = vec![0.0; 2 * n];
    assert_encloses(
        "supported plate",
        highest_frequency(&held, &rest).unwrap(),
        dense(&held),
    );
    let light = material(&plate, 3.0, InfluenceFunction::Constant);
    let list =
        common::listed::<BondStretch, 2>(&plate, &light, StressState::PlaneStress, None, &[]);
    let densities = (0..n)
        .map(|i| if i % 3 == 0 { 300.0 } else { 7000.0 })
        .collect();
    let mixed = System::new(
        plate.clone(),
        Box::new(list),
        PointScalar::PerPoint(densities),
    )
    .unwrap();
    assert_encloses(
        "mixed plate",
        highest_frequency(&mixed, &rest).unwrap(),
        dense(&mixed),
    );
}

#[test]
fn highest_frequency_is_accurate_when_all_points_interact() {
    // About 60 points that all interact; an earlier estimate was 1e-5 too low here.
    let cloud = common::boxed([0.0; 3], &[6.0], 0.1, 1.0);
    let gaussian = |xi: [f64; 3]| (-xi[0] * xi[0]).exp() * xi[0].abs();
    let operator = ConvolutionForce::<1>::with_stiffness(
        cloud.clone(),
        100.0,
        VolumeCorrection::None,
        gaussian,
        [false],
    )
    .unwrap();
    let system = common::system(&cloud, operator, 1.0);
    let found = highest_frequency(&system, &vec![0.0; cloud.len()]).unwrap();
    assert_encloses("bar", found, dense(&system));
    assert!(found.bound / found.estimate < 1.0 + 1e-5, "{found:?}");
}

#[test]
fn large_lattice_bodies_use_the_bound_of_their_dispersion_relation() {
    let cloud = common::boxed([0.0; 3], &[0.12, 0.09], 1e-3, 1.0);
    let material = BondMaterial {
        law: PairLaw::Linear,
        ..material(&cloud, 3.0, InfluenceFunction::Constant)
    };
    let constants = material
        .constants(&cloud, StressState::PlaneStress)
        .unwrap();
    let lattice = BondLattice::of_body(&cloud, &material, &constants).unwrap();
    let infinite = stability(&lattice).omega_max;
    let list =
        common::listed::<LinearBond, 2>(&cloud, &material, StressState::PlaneStress, None, &[]);
    let body = BondBody::new(&cloud, &material, &constants);
    let grid = body.grid::<BondStretch, 2>().unwrap();
    let convolution =
        ConvolutionForce::<2>::new(cloud.clone(), &material, &constants, &[], [false; 2]).unwrap();
    let systems = [
        common::system(&cloud, list, DENSITY),
        common::system(&cloud, grid, DENSITY),
        common::system(&cloud, convolution, DENSITY),
    ];
    for system in &systems {
        let found = highest_frequency(system, &vec![0.0; 2 * cloud.len()]).unwrap();
        assert_eq!(found.failure_probability, 0.0);
        assert!(found.converged && found.applications <= 8, "{found:?}");
        let ratio = found.bound / infinite;
        assert!((1.0 - 1e-12..1.001).contains(&ratio), "{ratio}");
        assert!(found.bound / found.estimate < 1.02, "{found:?}");
        assert!(found.estimate <= infinite, "{found:?}");
    }
}
