//! J2 plasticity: closed forms of homogeneous paths, dissipation, and resumed runs.

use std::sync::Arc;

use pericles::material::StressState;
use pericles::operator::PointSubset;
use pericles::round_trip::check_resume;
use pericles::space::PointCloud;
use pericles::time::{State, VelocityVerlet, highest_frequency};
use pericles::{Control, PointScalar, Simulation, StepEnd, System};
use pericles_solids::correspondence::{
    ClassicalSolid, CorrespondenceMaterial, ElasticLaw, History, Moduli, Plasticity, Stabilisation,
};

use crate::bodies::{lattice, material, operator};

const YIELD: f64 = 0.25;
const HARDENING: f64 = 1.5;

fn solid(state: StressState) -> ClassicalSolid {
    ClassicalSolid {
        state,
        law: ElasticLaw::Hencky,
        // E = 10, ν = 0.3.
        moduli: Moduli::new(10.0 / 1.2, 10.0 / 2.6),
        plasticity: Some(Plasticity {
            yield_stress: YIELD,
            hardening: HARDENING,
        }),
    }
}

/// One-dimensional plasticity with linear hardening along a path of strains: stress and accumulated plastic strain.
struct Path {
    stiffness: f64,
    yield_stress: f64,
    hardening: f64,
    plastic: f64,
    accumulated: f64,
}

impl Path {
    /// Returns the exact stress at the end of a step with monotonic strain.
    fn stress(&mut self, strain: f64) -> f64 {
        let trial = self.stiffness * (strain - self.plastic);
        let excess = trial.abs() - (self.yield_stress + self.hardening * self.accumulated);
        if excess > 0.0 {
            let flow = excess / (self.stiffness + self.hardening);
            self.plastic += flow * trial.signum();
            self.accumulated += flow;
        }
        self.stiffness * (strain - self.plastic)
    }
}

/// Strains up to 6 %, then down to −4 %.
fn strains() -> Vec<f64> {
    let up = (0..=20).map(|k| 0.003 * f64::from(k));
    up.chain((0..=25).map(|k| 0.06 - 0.004 * f64::from(k)))
        .collect()
}

/// Kirchhoff stress P λ of a bar under the logarithmic strain ln λ: loading, unloading and reverse loading.
#[test]
fn uniaxial_plasticity_of_a_bar_matches_the_closed_form() {
    let solid = solid(StressState::Uniaxial);
    let mut path = Path {
        stiffness: 10.0,
        yield_stress: YIELD,
        hardening: HARDENING,
        plastic: 0.0,
        accumulated: 0.0,
    };
    let mut history = History::default();
    for strain in strains() {
        let f = [[strain.exp()]];
        let found = solid.stress(&f, &history).stress[0][0] * f[0][0];
        let expected = path.stress(strain);
        assert!(
            (found - expected).abs() < 1e-10 * YIELD,
            "{strain}: {found} {expected}"
        );
        history = solid.advanced(&f, &history).0;
        assert!((history.accumulated - path.accumulated).abs() < 1e-10);
        // The stress at the end of the step is the same from the new history.
        let again = solid.stress(&f, &history).stress[0][0] * f[0][0];
        assert!((again - expected).abs() < 1e-10 * YIELD);
    }
    assert!(path.accumulated > 0.05);
}

/// Pure shear F = diag(e^γ, e^−γ, 1): principal Kirchhoff stresses ±τ, yield stress in shear σ_y/√3, α = 2 γ_p/√3.
#[test]
fn plasticity_in_pure_shear_matches_the_closed_form() {
    let solid = solid(StressState::Spatial);
    let mut path = Path {
        stiffness: 2.0 * solid.moduli.shear,
        yield_stress: YIELD / 3f64.sqrt(),
        hardening: HARDENING * 2.0 / 3.0,
        plastic: 0.0,
        accumulated: 0.0,
    };
    let mut history = History::default();
    for strain in strains() {
        let f = [
            [strain.exp(), 0.0, 0.0],
            [0.0, (-strain).exp(), 0.0],
            [0.0, 0.0, 1.0],
        ];
        let stress = solid.stress(&f, &history).stress;
        let expected = path.stress(strain);
        for (a, expected) in [expected, -expected, 0.0].into_iter().enumerate() {
            let found = stress[a][a] * f[a][a];
            assert!(
                (found - expected).abs() < 1e-10 * YIELD,
                "{strain}: {found} {expected}"
            );
        }
        history = solid.advanced(&f, &history).0;
        let accumulated = 2.0 / 3f64.sqrt() * path.accumulated;
        assert!((history.accumulated - accumulated).abs() < 1e-10);
    }
}

/// Plastic flow is isochoric, det Cₚ⁻¹ = 1; a uniform dilatation does not yield; a rotation after yielding
/// turns the stress.
#[test]
fn plastic_flow_is_isochoric_and_objective() {
    let solid = solid(StressState::Spatial);
    let f = [[1.08, 0.05, 0.0], [0.0, 0.97, -0.04], [0.02, 0.0, 0.99]];
    let (history, work) = solid.advanced(&f, &History::default());
    let [xx, yy, zz, xy, yz, xz] = history.plastic;
    let determinant =
        xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz);
    assert!(
        work > 0.0 && (determinant - 1.0).abs() < 1e-13,
        "{determinant}"
    );
    let swollen = [[1.3, 0.0, 0.0], [0.0, 1.3, 0.0], [0.0, 0.0, 1.3]];
    assert_eq!(solid.advanced(&swollen, &History::default()).1, 0.0);
}

fn yielding(stabilisation: Stabilisation) -> CorrespondenceMaterial {
    CorrespondenceMaterial {
        plasticity: Some(Plasticity {
            yield_stress: YIELD,
            hardening: HARDENING,
        }),
        ..material(0.3, 2.1, ElasticLaw::Hencky, stabilisation)
    }
}

/// The stored and dissipated energies of a body under uniform deformation equal the closed form of a bar.
#[test]
fn plastic_work_of_a_body_matches_the_closed_form() {
    let cloud = lattice(&[6.0]);
    let mut material = yielding(Stabilisation::Isotropic);
    material.solid.elastic.poisson_ratio = None;
    let mut operator = operator(&cloud, &material, StressState::Uniaxial);
    let mut path = Path {
        stiffness: 10.0,
        yield_stress: YIELD,
        hardening: HARDENING,
        plastic: 0.0,
        accumulated: 0.0,
    };
    for strain in strains() {
        let stretch = strain.exp() - 1.0;
        let u: Vec<f64> = (0..6).map(|i| stretch * cloud.point(i)[0]).collect();
        let mut out = vec![0.0; 6];
        operator.end_step(&StepEnd::sub_step(0.0, 1.0, &u), PointSubset::All, &mut out);
        let stress = path.stress(strain);
        let stored = 6.0 * 0.5 * stress * stress / 10.0;
        assert!((operator.energy(0.0, &u) - stored).abs() < 1e-10);
        let hardened = YIELD + 0.5 * HARDENING * path.accumulated;
        let dissipated = 6.0 * path.accumulated * hardened;
        assert!((operator.dissipated() - dissipated).abs() < 1e-10);
    }
}

/// A plate with initial velocities that cause yielding in tension.
fn thrown(part: f64) -> Simulation {
    thrown_on(lattice(&[10.0, 8.0]), part)
}

/// The plate, or a part of it.
pub fn thrown_on(cloud: Arc<PointCloud>, part: f64) -> Simulation {
    let operator = operator(
        &cloud,
        &yielding(Stabilisation::Isotropic),
        StressState::PlaneStrain,
    );
    let system = System::new(cloud.clone(), operator, PointScalar::Uniform(1.0)).unwrap();
    let n = cloud.len();
    let mut start = State::at_rest(2 * n);
    for i in 0..n {
        let [x, y, _] = cloud.point(i);
        start.v[i] = 0.4 * (x - 5.0) / 5.0;
        start.v[n + i] = 0.2 * (0.4 * y).sin();
    }
    let dt = highest_frequency(&system, &start.u)
        .unwrap()
        .stable_step(2.0, 0.5);
    let steps = (6.0 / dt / part) as u64;
    Simulation::new(system, Box::new(VelocityVerlet), start, part * dt, steps).unwrap()
}

/// The sum of kinetic, elastic and dissipated energy is conserved to second order in the time step: errors of
/// 3.2e-3 and, with a quarter of the step, 2.1e-4 of the energy. The bounds were chosen after seeing the
/// result.
#[test]
fn energy_balance_of_plastic_flow_converges_with_second_order() {
    let error = |part: f64| {
        let mut run = thrown(part);
        run.run(|_| Control::Continue).unwrap();
        let energies = run.snapshot().energies();
        assert!(
            energies.dissipated > 0.05 * energies.initial,
            "{energies:?}"
        );
        (energies.balance() / energies.initial).abs()
    };
    let [coarse, fine] = [1.0, 0.25].map(error);
    let ratio = coarse / fine;
    assert!(
        fine < 3e-4 && (13.0..19.0).contains(&ratio),
        "{coarse:e} {fine:e}"
    );
}

#[test]
fn resumed_run_with_plastic_flow_is_bitwise_identical() {
    check_resume(|| thrown(1.0), [3, 9]).unwrap();
}

/// Two halves of a bar strike each other at the speed V each. The elastic wave carries the yield stress σ_y, so that the
/// material behind it still moves at V − σ_y/(ρ c) with c = √(E/ρ); the plastic wave of speed √(E H/((E + H) ρ)) stops it.
#[test]
fn impact_of_a_bar_sends_out_an_elastic_and_a_plastic_wave() {
    const SPEED: f64 = 0.02;
    const HALF: f64 = 300.0;
    let (young, yield_stress) = (10.0_f64, 0.01);
    let mut material = yielding(Stabilisation::Isotropic);
    material.solid.elastic.poisson_ratio = None;
    material.plasticity = Some(Plasticity {
        yield_stress,
        hardening: HARDENING,
    });
    let cloud = lattice(&[2.0 * HALF]);
    let operator = operator(&cloud, &material, StressState::Uniaxial);
    let system = System::new(cloud.clone(), operator, PointScalar::Uniform(1.0)).unwrap();
    let mut start = State::at_rest(cloud.len());
    for i in 0..cloud.len() {
        start.v[i] = -SPEED * (cloud.point(i)[0] - HALF).signum();
    }
    let (elastic, plastic) = (
        young.sqrt(),
        (young * HARDENING / (young + HARDENING)).sqrt(),
    );
    let t = 0.8 * HALF / elastic;
    let steps = 1200;
    let dt = t / steps as f64;
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), start, dt, steps).unwrap();
    run.run(|_| Control::Continue).unwrap();
    let mean = |from: f64, to: f64| {
        let inside = |i: &usize| (from..to).contains(&(cloud.point(*i)[0] - HALF));
        let points: Vec<usize> = (0..cloud.len()).filter(inside).collect();
        points.iter().map(|&i| run.state().v[i]).sum::<f64>() / points.len() as f64
    };
    let [stopped, between, ahead] = [
        mean(0.0, 0.8 * plastic * t),
        mean(1.2 * plastic * t, 0.9 * elastic * t),
        mean(1.1 * elastic * t, HALF),
    ];
    let jump = yield_stress / elastic;
    assert!(stopped.abs() < 0.05 * jump, "{stopped}");
    assert!((between + SPEED - jump).abs() < 0.05 * jump, "{between}");
    assert!((ahead + SPEED).abs() < 0.05 * jump, "{ahead}");
}
