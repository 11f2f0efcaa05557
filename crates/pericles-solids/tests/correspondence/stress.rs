//! Bond failure by stress.

use std::sync::Arc;

use pericles::domain::Field;
use pericles::family::{Crack, EndRule, VolumeCorrection};
use pericles::material::{Criterion, PrincipalStress, StressState};
use pericles::operator::{BondForm, Force, PointSubset};
use pericles::round_trip::check_resume;
use pericles::space::PointCloud;
use pericles::time::{State, VelocityVerlet, highest_frequency};
use pericles::{Control, PointScalar, Simulation, StepEnd, System};
use pericles_solids::correspondence::{
    CorrespondenceBody, CorrespondenceMaterial, ElasticLaw, History, Plasticity, Stabilisation,
};

use crate::bodies::{lattice, material};

fn strong(strength: f64) -> CorrespondenceMaterial {
    let own = material(
        0.3,
        3.0 * (1.0 + 1e-6),
        ElasticLaw::NeoHooke,
        Stabilisation::Isotropic,
    );
    CorrespondenceMaterial {
        criterion: Some(Criterion::new(PrincipalStress::new(strength).unwrap())),
        ..own
    }
}

fn operator(
    cloud: &Arc<PointCloud>,
    material: &CorrespondenceMaterial,
    cracks: &[(Crack, EndRule)],
    no_fail: &[u32],
) -> Box<dyn Force> {
    let constants = material.constants(cloud, StressState::PlaneStress).unwrap();
    let body = CorrespondenceBody {
        cracks,
        no_fail,
        ..CorrespondenceBody::new(cloud, &constants, VolumeCorrection::None)
    };
    body.operator(BondForm::List).unwrap().operator
}

/// A body under uniform stress with principal stresses σ₁ and σ₂: bonds at the angle φ to the first axis
/// break if σ₁ cos²φ + σ₂ sin²φ exceeds the strength, for any rotation of the body.
#[test]
fn bonds_break_by_the_normal_stress_in_their_direction() {
    let cloud = lattice(&[9.0, 7.0]);
    let (n, stretches) = (cloud.len(), [1.05, 1.01]);
    let constants = strong(1.0)
        .constants(&cloud, StressState::PlaneStress)
        .unwrap();
    let f = [[stretches[0], 0.0], [0.0, stretches[1]]];
    let state = constants.point.stress(&f, &History::default());
    let volume = stretches[0] * stretches[1] * state.across;
    let principal = [0, 1].map(|c| state.stress[c][c] * stretches[c] / volume);
    assert!(principal[0] > principal[1] && principal[1] > 0.0);
    let whole = operator(&cloud, &strong(f64::MAX), &[], &[]);
    let rest = vec![0.0; 2 * n];
    for part in [1.001, 0.999, 0.9, 0.7] {
        let strength = part * principal[0];
        let mut wanted = 0;
        let view = whole.capabilities().bonds.unwrap();
        let values = view.values_at(Field::new(&rest, &[]));
        for i in 0..n {
            view.for_each_bond(&values, i, &mut |bond| {
                let y = [0, 1].map(|c| stretches[c] * bond.xi[c]);
                let square = y[0] * y[0] + y[1] * y[1];
                let normal = (0..2).map(|c| principal[c] * y[c] * y[c]).sum::<f64>() / square;
                wanted += u64::from(normal > strength);
            });
        }
        assert_eq!(wanted > 0, part < 1.0);
        for angle in [0.0_f64, 0.7] {
            let (sin, cos) = angle.sin_cos();
            let mut u = vec![0.0; 2 * n];
            for i in 0..n {
                let [x, y, _] = cloud.point(i);
                let [a, b] = [stretches[0] * x, stretches[1] * y];
                u[i] = cos * a - sin * b - x;
                u[n + i] = sin * a + cos * b - y;
            }
            let mut force = operator(&cloud, &strong(strength), &[], &[]);
            let mut marks = vec![false; n];
            let breaking = force.capabilities().breaking.unwrap();
            breaking.mark_endangered(&u, 1.0, &mut marks);
            assert_eq!(marks.contains(&true), wanted > 0);
            let mut out = vec![0.0; 2 * n];
            force.end_step(&StepEnd::sub_step(0.0, 0.0, &u), PointSubset::All, &mut out);
            assert_eq!(2 * force.broken_bonds(), wanted, "{part} {angle}");
        }
    }
}

/// A notched plate with initial velocities that cause tension.
fn torn(plasticity: Option<Plasticity>, part: f64) -> Simulation {
    let cloud = lattice(&[12.0, 10.0]);
    let n = cloud.len();
    let notch = Crack::Segment {
        from: [0.0, 5.0],
        to: [4.0, 5.0],
    };
    let law = match plasticity {
        Some(_) => ElasticLaw::Hencky,
        None => ElasticLaw::NeoHooke,
    };
    let material = CorrespondenceMaterial {
        plasticity,
        law,
        ..strong(0.5)
    };
    let force = operator(&cloud, &material, &[(notch, EndRule::Closed)], &[]);
    let system = System::new(cloud.clone(), force, PointScalar::Uniform(1.0)).unwrap();
    let mut start = State::at_rest(2 * n);
    for i in 0..n {
        start.v[n + i] = 0.08 * (cloud.point(i)[1] - 5.0);
    }
    let dt = highest_frequency(&system, &start.u)
        .unwrap()
        .stable_step(2.0, 0.5);
    let steps = (8.0 / dt / part) as u64;
    Simulation::new(system, Box::new(VelocityVerlet), start, part * dt, steps).unwrap()
}

/// The energy balance at strains of a few per cent converges with second order in the time step.
#[test]
fn energy_balance_closes_momentum_is_conserved_and_runs_resume() {
    let soft = Plasticity {
        yield_stress: 0.45,
        hardening: 1.0,
    };
    for plasticity in [None, Some(soft)] {
        let errors = [1.0, 0.25].map(|part| {
            let mut run = torn(plasticity, part);
            run.run(|_| Control::Continue).unwrap();
            let broken = run.system().operator().broken_bonds();
            assert!(broken > 20, "{broken}");
            let ended = run.system().momentum(&run.state().v);
            assert!(
                ended[0].abs() < 1e-12 && ended[1].abs() < 1e-12,
                "{ended:?}"
            );
            let energies = run.snapshot().energies();
            energies.balance().abs() / energies.initial
        });
        println!("{plasticity:?}: {errors:?}");
        assert!(
            errors[0] < 1e-2 && errors[1] < errors[0] / 8.0,
            "{errors:?}"
        );
        check_resume(|| torn(plasticity, 1.0), [5, 30]).unwrap();
    }
}

#[test]
fn strengths_that_are_not_positive_are_errors() {
    let error = PrincipalStress::new(0.0).unwrap_err();
    assert!(error.to_string().contains("tensile strength"), "{error}");
}
