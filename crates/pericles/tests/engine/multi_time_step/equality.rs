//! Bitwise identical results: equivalent schemes, resumed runs, numbers of threads; and the number of evaluations.

use pericles::material::BondStretch;
use pericles::round_trip::check_resume;
use pericles::space::PointSet;
use pericles::time::{
    AdaptiveRungeKutta, Fine, Follow, Integrator, Interpolant, MultiTimeStepOptions, Predictor,
    Respa, State, VelocityVerlet,
};
use pericles::{Archive, Checkpointed, Control, Simulation, System};

use super::bodies::{Problem, crack, cracking_plate, plate};
use super::schemes::{Scheme, adaptive, mixed, options, respa, run, two_steps, uniform};

/// The bits of the state of a run, except for what belongs to the scheme.
fn bits(simulation: &Simulation) -> (Vec<u64>, Vec<u64>, u64, u64) {
    let State { u, v, .. } = simulation.state();
    let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect();
    let operator = simulation.system().operator();
    (
        bits(u),
        bits(v),
        operator.broken_bonds(),
        operator.dissipated().to_bits(),
    )
}

#[test]
fn scheme_without_coarse_or_fine_points_equals_the_single_rate_scheme() {
    // Bitwise, including breaking bonds.
    let nothing = |problem: Problem| (problem.0, problem.1, vec![], problem.3);
    let everything = |problem: Problem| {
        let all = (0..problem.0.points() as u32).collect();
        (problem.0, problem.1, all, problem.3)
    };
    let verlet = |_: &System, _: &PointSet| -> Box<dyn Integrator> { Box::new(VelocityVerlet) };
    let respa = |system: &System, fine: &PointSet| -> Box<dyn Integrator> {
        let fine = options(4, fine).fine;
        Box::new(Respa::new(4, fine, system).unwrap())
    };
    for order in [2, 3, 4] {
        let (plain, two): (&Scheme<'_>, &Scheme<'_>) = match order {
            2 => (&verlet, &respa),
            3 => (&uniform(3), &mixed(3, 4)),
            _ => (&uniform(4), &mixed(4, 4)),
        };
        let coarse = run(cracking_plate(), 64, plain);
        let fine = run(cracking_plate(), 256, plain);
        assert!(coarse.system().operator().broken_bonds() > 20);
        assert!(bits(&coarse) != bits(&fine));
        let none = run(nothing(cracking_plate()), 64, two);
        let all = run(everything(cracking_plate()), 64, two);
        // The dissipated energy of a bond contains the mean velocity of a velocity Verlet step, which r-RESPA
        // rounds differently.
        let compare = |a: &Simulation, b: &Simulation| {
            let (a, b) = (bits(a), bits(b));
            assert!((&a.0, &a.1, a.2) == (&b.0, &b.1, b.2), "order {order}");
            let (a, b) = (f64::from_bits(a.3), f64::from_bits(b.3));
            assert!((a / b - 1.0).abs() < 1e-12);
        };
        compare(&coarse, &none);
        compare(&fine, &all);
    }
}

#[test]
fn stop_and_resume_equals_the_uninterrupted_run() {
    let following_respa = |system: &System, _: &PointSet| -> Box<dyn Integrator> {
        Box::new(Respa::new(3, Fine::Adaptive(Follow::default()), system).unwrap())
    };
    let pair = |system: &System, _: &PointSet| -> Box<dyn Integrator> {
        Box::new(AdaptiveRungeKutta::new(1e-6, system).unwrap())
    };
    let backward = |system: &System, fine: &PointSet| {
        let options = MultiTimeStepOptions {
            predictor: Predictor::BackwardDifference,
            interpolant: Interpolant::Stages,
            ..options(3, fine)
        };
        two_steps(system, 4, options)
    };
    let schemes: [&Scheme<'_>; 7] = [
        &uniform(3),
        &mixed(3, 3),
        &adaptive(4, 3),
        &backward,
        &respa(3),
        &following_respa,
        &pair,
    ];
    for scheme in schemes {
        let start = || {
            let (system, state, fine, end) = cracking_plate();
            let integrator = scheme(&system, &fine);
            Simulation::new(system, integrator, state, end / 64.0, 64).unwrap()
        };
        let name = start().integrator().name();
        let checked = check_resume(start, [1, 2, 41]);
        let end = checked.unwrap_or_else(|wrong| panic!("{name}: {wrong}"));
        let directed: u64 = end.u64s("operator/broken").unwrap().iter().sum();
        assert!(directed > 40);
    }
}

#[test]
fn results_are_bitwise_identical_for_any_number_of_threads() {
    let following_respa = |system: &System, _: &PointSet| -> Box<dyn Integrator> {
        Box::new(Respa::new(3, Fine::Adaptive(Follow::default()), system).unwrap())
    };
    let pair = |system: &System, _: &PointSet| -> Box<dyn Integrator> {
        Box::new(AdaptiveRungeKutta::new(1e-6, system).unwrap())
    };
    let schemes: [&Scheme<'_>; 4] = [&mixed(3, 3), &adaptive(4, 3), &following_respa, &pair];
    for scheme in schemes {
        let on = |threads| {
            rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap()
                .install(|| {
                    let simulation = run(crack::<BondStretch>(60, 20.0, 0.006, 7e-6), 48, scheme);
                    let mut archive = Archive::default();
                    simulation.save(&mut archive);
                    archive
                })
        };
        let one = on(1);
        for threads in [2, 3] {
            assert!(on(threads) == one, "{threads} threads");
        }
    }
}

#[test]
fn number_of_evaluations_equals_its_formula() {
    for ratio in [1, 3, 4] {
        for order in [3u64, 4] {
            let (system, state, fine, end) = plate();
            let (n, f) = (system.points() as u64, fine.len() as u64);
            let integrator = two_steps(&system, order as u32, options(ratio, &fine));
            let mut simulation =
                Simulation::new(system, integrator, state, end / 256.0, 10).unwrap();
            simulation.run(|_| Control::Continue).unwrap();
            let report = simulation.integrator().refinement().unwrap();
            let m = u64::from(ratio);
            // One evaluation at the start; the first steps are fine everywhere and supply the levels of the
            // predictor.
            assert_eq!(report.starting_steps, order - 3);
            let starting = report.starting_steps * order * m * n;
            let expected = n + starting + report.steps * order * (n - f + m * f);
            assert_eq!(simulation.system().evaluated_points(), expected);
            let speed_up = (order * m * n) as f64 / (order * (n - f + m * f)) as f64;
            assert!((report.speed_up() / speed_up - 1.0).abs() < 1e-12);
        }
        let (system, state, fine, end) = plate();
        let integrator = respa(ratio)(&system, &fine);
        let mut simulation = Simulation::new(system, integrator, state, end / 256.0, 10).unwrap();
        let at_start = simulation.system().evaluated_points();
        simulation.run(|_| Control::Continue).unwrap();
        let report = simulation.integrator().refinement().unwrap();
        let (n, f, m) = (report.points, report.fine_points, u64::from(ratio));
        let per_step = n - f + m * (f + report.border_points);
        let counted = simulation.system().evaluated_points() - at_start;
        assert_eq!(counted, 10 * per_step);
    }
}

#[test]
fn several_fine_regions_equal_their_union() {
    let halves = |fine: &PointSet| {
        let middle = fine.len() / 2;
        vec![fine[..middle].to_vec(), fine[middle..].to_vec()]
    };
    let parted_mts = |system: &System, fine: &PointSet| {
        let options = MultiTimeStepOptions {
            fine: Fine::Fixed(halves(fine)),
            ..options(4, fine)
        };
        two_steps(system, 4, options)
    };
    let parted_respa = |system: &System, fine: &PointSet| -> Box<dyn Integrator> {
        Box::new(Respa::new(4, Fine::Fixed(halves(fine)), system).unwrap())
    };
    let pairs: [(&Scheme<'_>, &Scheme<'_>); 2] =
        [(&mixed(4, 4), &parted_mts), (&respa(4), &parted_respa)];
    for (whole, parted) in pairs {
        let (whole, parted) = (
            run(cracking_plate(), 64, whole),
            run(cracking_plate(), 64, parted),
        );
        assert!(whole.system().operator().broken_bonds() > 20);
        assert!(bits(&whole) == bits(&parted));
    }
}
