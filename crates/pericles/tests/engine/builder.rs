//! Bodies and simulations made by builders agree with those assembled by hand; custom pair laws, forces and
//! observers.

use std::sync::{Arc, Mutex};

use pericles::family::EndRule;
use pericles::material::{BondConstants, BondStretch, MaterialPairs};
use pericles::operator::{BondBody, CompositeBody};
use pericles::prelude::*;
use pericles::time::{RungeKutta, Tableau, highest_frequency};

const DX: f64 = 1e-3;

fn plate() -> Arc<PointCloud> {
    Arc::new(Grid::plate([0.03, 0.02], DX, 1e-3).points().unwrap())
}

fn glass() -> BondMaterial {
    BondMaterial::new(ElasticModulus::Young(72e9), 2440.0, 3.0 * DX).with_critical_stretch(1e-3)
}

fn half() -> Region {
    Region::Box {
        min: [0.015, f64::NEG_INFINITY, f64::NEG_INFINITY],
        max: [f64::INFINITY; 3],
    }
}

fn crack() -> Crack {
    Crack::Segment {
        from: [0.0, 0.01],
        to: [0.01, 0.01],
    }
}

/// A displacement with strains of about 1e-3.
fn uneven(cloud: &PointCloud) -> Vec<f64> {
    let mut u = vec![0.0; 2 * cloud.len()];
    for i in 0..cloud.len() {
        let [x, y, _] = cloud.point(i);
        u[i] = 1e-5 * (300.0 * y + 100.0 * x).sin();
        u[cloud.len() + i] = 1e-5 * (250.0 * x).cos();
    }
    u
}

fn force_of(system: &System) -> Vec<f64> {
    let u = uneven(system.cloud());
    let mut force = vec![0.0; u.len()];
    system
        .operator()
        .add_force(0.0, &u, PointSubset::All, &mut force);
    force
}

/// Largest difference divided by the largest entry.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    let largest = a.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let pairs = a.iter().zip(b);
    pairs.fold(0.0, |most: f64, (a, b)| most.max((a - b).abs())) / largest
}

#[test]
fn a_body_of_two_materials_equals_its_assembly_by_hand() {
    let cloud = plate();
    let soft = BondMaterial::new(ElasticModulus::Young(20e9), 1000.0, 3.0 * DX);
    let right = cloud.select(&half());
    let held = cloud.select(&Region::layer("+y", 3.0 * DX).unwrap());
    let built = Body::new(cloud.clone(), glass())
        .stress_state(StressState::PlaneStrain)
        .material(right.clone(), soft.clone())
        .interface(InterfaceRule::Weaker)
        .surface_correction(SurfaceCorrection::Volume)
        .crack(crack())
        .no_fail(held.clone())
        .build()
        .unwrap();

    let constants: [BondConstants; 2] =
        [glass(), soft].map(|m| m.constants(&cloud, StressState::PlaneStrain).unwrap());
    let mut of_point = vec![0; cloud.len()];
    right.iter().for_each(|&i| of_point[i as usize] = 1);
    let classes = MaterialPairs::new(of_point, &constants, InterfaceRule::Weaker).unwrap();
    let (material, cracks) = (glass(), [(crack(), EndRule::Closed)]);
    let body = BondBody {
        cracks: &cracks,
        no_fail: &held,
        ..BondBody::new(&cloud, &material, &constants[0])
    };
    let by_hand = CompositeBody {
        classes: Some(&classes),
        correction: SurfaceCorrection::Volume,
        ..CompositeBody::from(body)
    };
    let operator = by_hand.operator(BondForm::Fastest).unwrap().operator;
    let u = uneven(&cloud);
    let mut force = vec![0.0; u.len()];
    operator.add_force(0.0, &u, PointSubset::All, &mut force);
    assert_eq!(force_of(&built), force);
    assert_eq!(built.density().at(0), 2440.0);
    assert_eq!(built.density().at(29), 1000.0);
}

/// The bond-stretch law written from its definition, as a program outside the engine does it.
#[derive(Clone, Copy, Default)]
struct Outside;

impl PairForce for Outside {
    const LINEAR: bool = false;

    #[inline(always)]
    fn force<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> [T; D] {
        BondStretch::force(xi, eta)
    }

    #[inline(always)]
    fn energy<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> T {
        BondStretch::energy(xi, eta)
    }

    #[inline(always)]
    fn tangent<T: Real, const D: usize>(xi: [T; D], eta: [T; D], d: [T; D]) -> [T; D] {
        BondStretch::tangent(xi, eta, d)
    }
}

#[test]
fn a_custom_pair_law_agrees_with_the_built_in_law_in_every_form() {
    for form in [BondForm::List, BondForm::Grid, BondForm::Fastest] {
        let body = || {
            Body::new(plate(), glass())
                .stress_state(StressState::PlaneStress)
                .crack(crack())
                .form(form)
        };
        let built_in = body().build().unwrap();
        let outside = body().pair_law::<Outside>().build().unwrap();
        // The small-strain polynomials of the built-in law differ from its square roots in the last digits.
        assert!(distance(&force_of(&built_in), &force_of(&outside)) < 1e-11);
        // The same bonds break.
        let broken = |system: System| {
            let mut run = Simulation::builder(system)
                .displacement(|[x, y, _]| [0.0, 0.02 * y * (100.0 * x).sin(), 0.0])
                .steps(20)
                .build()
                .unwrap();
            run.run_to_end().unwrap();
            run.system().operator().broken_bonds()
        };
        let count = broken(built_in);
        assert!(count > 0);
        assert_eq!(count, broken(outside));
    }
}

#[test]
fn a_custom_pair_law_supports_several_materials_and_surface_corrections() {
    let body = || {
        let soft = BondMaterial::new(ElasticModulus::Young(20e9), 1000.0, 3.0 * DX);
        let right = plate().select(&half());
        Body::new(plate(), glass())
            .stress_state(StressState::PlaneStress)
            .material(right, soft)
            .surface_correction(SurfaceCorrection::Volume)
    };
    let built_in = force_of(&body().build().unwrap());
    let outside = force_of(&body().pair_law::<Outside>().build().unwrap());
    assert!(distance(&built_in, &outside) < 1e-11);
}

#[test]
fn the_default_step_is_stable_and_reaches_the_end_exactly() {
    let system = || {
        Body::new(plate(), glass())
            .stress_state(StressState::PlaneStress)
            .build()
            .unwrap()
    };
    let rest = State::of(&system());
    let stable = highest_frequency(&system(), &rest.u)
        .unwrap()
        .stable_step(2.0, 0.95);
    let run = Simulation::builder(system()).end(1e-5).build().unwrap();
    let (dt, steps) = (run.dt(), run.steps() as f64);
    assert!((dt * steps / 1e-5 - 1.0).abs() < 1e-14);
    assert!(dt <= stable && 1e-5 / (steps - 1.0) > stable);
    // A given step of which a whole number reaches the end is unchanged.
    let run = Simulation::builder(system()).dt(1e-8).end(1e-6).build();
    assert_eq!(run.unwrap().steps(), 100);
    // A step far above the stable one is an error unless unstable steps are allowed.
    let long = || Simulation::builder(system()).dt(2.0 * stable).steps(3);
    let rejection = long().build().err().unwrap();
    assert!(matches!(rejection, PericlesError::UnstableStep { .. }));
    assert!(long().allow_unstable().build().is_ok());
    // The limit depends on the scheme.
    let fourth = Simulation::builder(system())
        .scheme_for(|system| Ok(RungeKutta::new(&Tableau::rk4(), system)))
        .unwrap()
        .steps(1)
        .build()
        .unwrap();
    let limit = RungeKutta::new(&Tableau::rk4(), &system()).stability_limit();
    let ratio = fourth.dt() / stable;
    assert!((ratio - limit.unwrap() / 2.0).abs() < 1e-12, "{ratio}");
}

#[test]
fn prescribed_velocities_add_to_the_initial_displacement() {
    let cloud = plate();
    let top = cloud.select(&Region::layer("+y", DX).unwrap());
    let first = top[0] as usize;
    let pull = PrescribedMotion::velocity(top, [None, Some(2.0), None], TimeFunction::Constant);
    let mut run = Simulation::builder(
        Body::new(cloud, glass())
            .stress_state(StressState::PlaneStress)
            .motion(pull)
            .build()
            .unwrap(),
    )
    .displacement(|[_, y, _]| [0.0, 1e-4 * y, 0.0])
    .end(1e-6)
    .build()
    .unwrap();
    let n = run.system().points();
    let start = run.state().u[n + first];
    assert!(start > 0.0);
    run.run_to_end().unwrap();
    let moved = run.state().u[n + first] - start;
    assert!((moved / 2e-6 - 1.0).abs() < 1e-12, "{moved}");
}

/// Counts the states it receives.
struct Counter {
    seen: u64,
}

impl Observer for Counter {
    fn observe(&mut self, _snapshot: &Snapshot<'_>) -> Result<(), ObserveError> {
        self.seen += 1;
        Ok(())
    }
}

saved! {
    impl Checkpointed for Counter {
        seen: array("counter/seen"),
    }
}

#[test]
fn a_shared_observer_is_saved_with_the_run_and_read_after_it() {
    let counter = Arc::new(Mutex::new(Counter { seen: 0 }));
    let system = Body::new(plate(), glass()).stress_state(StressState::PlaneStress);
    let mut run = Simulation::builder(system.build().unwrap())
        .observe(Schedule::Every(2), counter.clone())
        .steps(10)
        .build()
        .unwrap();
    run.run_to_end().unwrap();
    // The initial state and five later states.
    assert_eq!(counter.lock().unwrap().seen, 6);
    let mut archive = pericles::Archive::default();
    run.save(&mut archive);
    counter.lock().unwrap().seen = 0;
    run.restore(&archive).unwrap();
    assert_eq!(counter.lock().unwrap().seen, 6);
}
