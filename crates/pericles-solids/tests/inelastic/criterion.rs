//! Bonds of viscous solids that break by stress.

use crate::bodies::{jittered, solid};
use pericles::StepEnd;
use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{
    BondCriterion, BondFailure, BondState, Criterion, GivenConstants, LinearSolid,
    LinearSolidConstants, Strains, StressState,
};
use pericles::operator::{BondForm, Force, LinearSolidBody, PointSubset};
use pericles::space::PointCloud;
use pericles_solids::inelastic::{InelasticSolidBody, Inelasticity, ViscousTerm};

/// The equivalent stress as a failure index.
#[derive(Debug)]
struct EquivalentStress;

impl BondCriterion for EquivalentStress {
    fn failure_index(&self, bond: &BondState) -> f64 {
        bond.equivalent_stress()
    }

    fn words(&self) -> String {
        "by the equivalent stress".into()
    }
}

fn constants(
    material: &LinearSolid,
    cloud: &PointCloud,
    state: StressState,
    criterion: Criterion,
) -> LinearSolidConstants {
    let material = LinearSolid {
        failure: BondFailure::ByCriterion,
        ..material.clone()
    };
    LinearSolidConstants {
        criterion: Some(criterion),
        ..material.constants(cloud, state).unwrap()
    }
}

/// u = H x.
fn affine(cloud: &PointCloud, gradient: [[f64; 3]; 3]) -> Vec<f64> {
    let mut u = Vec::new();
    for row in &gradient[..cloud.dimension()] {
        for i in 0..cloud.len() {
            let x = cloud.point(i);
            u.push(row[0] * x[0] + row[1] * x[1] + row[2] * x[2]);
        }
    }
    u
}

fn marks(force: &dyn Force, u: &[f64], fraction: f64) -> Vec<bool> {
    let mut marks = vec![false; force.points()];
    let breaking = force.capabilities().breaking.unwrap();
    breaking.mark_endangered(u, fraction, &mut marks);
    marks
}

/// Returns the largest failure index of a body, to 1e-13 of it.
fn largest(force: &dyn Force, u: &[f64]) -> f64 {
    let (mut low, mut high) = (0.0, 100.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let any = marks(force, u, middle).contains(&true);
        *(if any { &mut low } else { &mut high }) = middle;
    }
    0.5 * (low + high)
}

/// A viscous solid has the stress of an elastic one with the initial shear modulus at first, and of one with the
/// relaxed shear modulus after a long time.
#[test]
fn stress_of_a_viscous_solid_relaxes() {
    let cloud = jittered(&[5, 5, 4]);
    let of_shear = |shear: f64| LinearSolid {
        elastic: GivenConstants {
            bulk: Some(8.0),
            shear: Some(shear),
            ..GivenConstants::default()
        },
        ..solid(0.3, 2.3, InfluenceFunction::Inverse)
    };
    let criterion = || Criterion::new(EquivalentStress);
    let state = StressState::Spatial;
    let gradient = [[1e-3, 2e-3, 0.0], [0.0, -2e-3, 1e-3], [5e-4, 0.0, 1e-3]];
    let u = affine(&cloud, gradient);
    let [initial, relaxed] = [4.0, 1.6].map(|shear| {
        let constants = constants(&of_shear(shear), &cloud, state, criterion());
        let body = LinearSolidBody {
            strains: Strains::Small,
            ..LinearSolidBody::new(&cloud, &constants, VolumeCorrection::None)
        };
        largest(&*body.operator(BondForm::List).unwrap().operator, &u)
    });
    assert!(relaxed < 0.6 * initial);
    let constants = constants(&of_shear(4.0), &cloud, state, criterion());
    let body = InelasticSolidBody {
        elastic: LinearSolidBody {
            strains: Strains::Small,
            ..LinearSolidBody::new(&cloud, &constants, VolumeCorrection::None)
        },
        laws: &[Inelasticity::Viscous(vec![ViscousTerm {
            share: 0.6,
            time: 0.1,
        }])],
    };
    let mut force = body.operator(BondForm::List).unwrap().operator;
    let mut out = vec![0.0; u.len()];
    let started = largest(&*force, &u);
    assert!(
        (started / initial - 1.0).abs() < 1e-11,
        "{started} {initial}"
    );
    for t in [0.0, 10.0] {
        force.end_step(&StepEnd::sub_step(t, t, &u), PointSubset::All, &mut out);
    }
    let ended = largest(&*force, &u);
    assert!((ended / relaxed - 1.0).abs() < 1e-9, "{ended} {relaxed}");
}
