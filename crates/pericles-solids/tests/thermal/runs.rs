//! Runs of heated bodies: energy balance, resume, threads.

use crate::setup::{Model, models, plate};
use pericles::boundary::{PrescribedMotion, TimeFunction};
use pericles::material::{PairLaw, Strains};
use pericles::round_trip::check_resume;
use pericles::time::{Relaxation, RelaxationOptions, State, VelocityVerlet};
use pericles::{Control, PointScalar, Simulation, System};

/// A plate heated over time, more at its right side.
fn heated(model: &Model, limit: f64, dt: f64) -> Simulation {
    let (cloud, force) = plate(model, [0.5, 1.0, 0.8], limit);
    let mut system = System::new(cloud.clone(), force, PointScalar::Uniform(1.0)).unwrap();
    let n = cloud.len();
    let left: Vec<u32> = (0..n as u32)
        .filter(|&i| cloud.point(i as usize)[0] < 2.0)
        .collect();
    let held = [Some(0.0), Some(0.0), None];
    let hold = PrescribedMotion::velocity(left, held, TimeFunction::Constant);
    system.add_motion(hold).unwrap();
    let mut start = State::at_rest(2 * n);
    for i in 0..n {
        let [x, y, _] = cloud.point(i);
        if x >= 2.0 {
            start.v[i] = 0.02 * (0.5 * y).sin();
            start.v[n + i] = 0.02 * (0.4 * x).cos();
        }
    }
    let steps = (4.0 / dt).round() as u64;
    Simulation::new(system, Box::new(VelocityVerlet), start, dt, steps).unwrap()
}

fn is_small(model: &Model) -> bool {
    matches!(
        model,
        Model::Bonds(PairLaw::Linear) | Model::Solid(Strains::Small, _)
    )
}

/// The work of temperature changes is exact where the energy is quadratic in displacements and temperatures,
/// including steps in which bonds break.
#[test]
fn energy_balance_with_small_strains_closes_to_round_off() {
    for model in models().iter().filter(|model| is_small(model)) {
        for limit in [f64::INFINITY, 0.012] {
            let mut run = heated(model, limit, 0.05);
            run.run(|_| Control::Continue).unwrap();
            let energies = run.snapshot().energies();
            let broken = run.system().operator().broken_bonds();
            assert_eq!(broken > 10, limit.is_finite(), "{model:?}: {broken}");
            assert!(energies.work > 0.1 * energies.elastic, "{energies:?}");
            let error = energies.balance().abs() / energies.work;
            assert!(error < 1e-11, "{model:?}, {limit}: {error:e}");
        }
    }
}

#[test]
fn energy_balance_with_finite_strains_converges_with_second_order() {
    for model in models().iter().filter(|model| !is_small(model)) {
        let errors = [0.08, 0.04, 0.02].map(|dt| {
            let mut run = heated(model, f64::INFINITY, dt);
            run.run(|_| Control::Continue).unwrap();
            let energies = run.snapshot().energies();
            energies.balance().abs() / energies.work
        });
        println!("{model:?}: {errors:?}");
        // Chosen before the first run.
        assert!(errors[2] < 1e-5, "{model:?}: {errors:?}");
        let order = (errors[0] / errors[2]).log2() / 2.0;
        assert!(order > 1.6, "{model:?}: {errors:?}");
    }
}

#[test]
fn runs_resume_and_are_bitwise_identical_for_any_number_of_threads() {
    for model in models() {
        let make = || heated(&model, 0.012, 0.05);
        let middle = make().steps() / 2;
        let end = check_resume(make, [middle]).unwrap_or_else(|e| panic!("{model:?}: {e}"));
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let stored = pool.unwrap().install(|| {
                let mut run = make();
                run.run(|_| Control::Continue).unwrap();
                let mut archive = pericles::Archive::default();
                pericles::Checkpointed::save(&run, &mut archive);
                archive
            });
            assert_eq!(end.differences(&stored), Vec::<String>::new(), "{threads}");
        }
    }
}

/// A body that expands freely is stress-free in equilibrium: the first load step heats it from its
/// stress-free temperature, and the energy balance includes the energy released by relaxation.
#[test]
fn static_states_of_a_free_body_have_no_stress() {
    for model in models() {
        let (cloud, force) = plate(&model, [1.0, 0.0, 0.0], f64::INFINITY);
        let n = cloud.len();
        let system = System::new(cloud, force, PointScalar::Uniform(1.0)).unwrap();
        let options = RelaxationOptions {
            tolerance: 1e-9,
            ..RelaxationOptions::default()
        };
        let scheme = Box::new(Relaxation::new(options, &system).unwrap());
        let start = State::at_rest(2 * n);
        let mut run = Simulation::new(system, scheme, start, 1.0, 1).unwrap();
        run.run(|_| Control::Continue).unwrap();
        let energies = run.snapshot().energies();
        let before = energies.initial;
        assert!(energies.elastic < 1e-10 * before, "{model:?}: {energies:?}");
        let balance = energies.balance().abs();
        // One load step of a quadratic energy is exact; the others deviate by their nonlinearity at one per cent of
        // strain.
        let bound = if is_small(&model) { 1e-6 } else { 0.02 };
        assert!(balance < bound * before, "{model:?}: {energies:?}");
    }
}
