//! Damping layers.

use pericles::boundary::{DampedSteps, DampingLayer, DampingProfile};
use pericles::round_trip::check_resume;
use pericles::space::Face;
use pericles::time::{
    AdaptiveRungeKutta, DiscreteGradient, Fine, Implicit, ImplicitRule, InnerSolver, Integrator,
    Interpolant, LinearSolver, MultiTimeStep, MultiTimeStepOptions, Newmark, NewmarkOptions,
    Predictor, Respa, RungeKutta, Tableau, VelocityVerlet,
};
use pericles::{Control, Simulation, StepKind, System};
use pericles_waves::{Trigonometric, TrigonometricOptions};

use crate::absorbing::bar::{bar, pulse, run};

const DT: f64 = 0.1;

fn layer(thickness: f64, reflection: f64) -> DampingProfile {
    DampingProfile::of_reflection(thickness, reflection, 2.0, 1.0)
}

/// Bar −20 … 20 with a damping layer at the right end.
fn damped(profile: DampingProfile) -> System {
    damped_for(StepKind::EndOfStep, profile, DT)
}

fn damped_for(kind: StepKind, profile: DampingProfile, dt: f64) -> System {
    let mut system = bar(200, 1.0);
    let face = Face::named("+x").unwrap();
    let steps = DampedSteps {
        kind,
        dt,
        frequency: Some(8.0),
    };
    let layer = DampingLayer::new(system.cloud(), system.density(), face, profile, steps);
    system.add_boundary(Box::new(layer.unwrap()));
    system
}

/// Amplitude reflected into −10 … 10 after a bell has left, relative to that without a layer.
fn reflected(profile: DampingProfile) -> f64 {
    let system = damped(profile);
    let state = pulse(&system, 0.0);
    // Without a layer the right half is back in the middle; the left half was reflected by the free end and is at
    // the left.
    let steps = 350;
    let end = run(system, state, DT, steps);
    let energies = end.snapshot().energies();
    assert!(
        energies.balance().abs() < 1e-12 * energies.initial,
        "{energies:?}"
    );
    let cloud = end.system().cloud();
    let back = cloud.axis(0).iter().zip(&end.state().u);
    back.filter(|(x, _)| **x > 0.0)
        .fold(0.0, |a: f64, (_, u)| a.max(u.abs()))
        / 0.5
}

#[test]
fn damping_layer_reflects_at_most_the_requested_fraction() {
    // Less than requested: the layer delays the long waves of the bell, which spread.
    for asked in [0.3, 0.1] {
        let found = reflected(layer(10.0, asked));
        assert!(found < asked && found > 0.4 * asked, "{asked}: {found}");
    }
    // Long waves, comparable to the layer thickness, are reflected less by a thicker layer.
    let [thin, thick] = [3.0, 12.0].map(|thickness| reflected(layer(thickness, 1e-4)));
    assert!(thick < 0.05 && thin > 3.0 * thick, "{thin:e}, {thick:e}");
}

#[test]
fn damped_run_resumes_bit_for_bit() {
    let make = || {
        let system = damped(layer(10.0, 0.01));
        let state = pulse(&system, 12.0);
        Simulation::new(system, Box::new(VelocityVerlet), state, DT, 200).unwrap()
    };
    check_resume(make, [77]).unwrap();
}

#[test]
fn invalid_damping_layers_are_errors() {
    let system = bar(50, 1.0);
    let rejection = |face: &str, profile, frequency| {
        let face = Face::named(face).unwrap();
        let steps = DampedSteps {
            kind: StepKind::EndOfStep,
            dt: DT,
            frequency: Some(frequency),
        };
        let rejected = DampingLayer::new(system.cloud(), system.density(), face, profile, steps);
        rejected
            .err()
            .map(|error| error.to_string())
            .unwrap_or_default()
    };
    assert!(rejection("+y", layer(1.0, 0.1), 8.0).contains("has no side +y"));
    assert!(rejection("+x", layer(0.05, 0.1), 8.0).contains("allowed: from one cell"));
    assert!(rejection("+x", layer(11.0, 0.1), 8.0).contains("less than the body"));
    assert!(rejection("+x", layer(0.3, 1e-6), 19.0).contains("ω dt is 1.900"));
}

type Make = fn(&System) -> Box<dyn Integrator>;

/// Scheme whose damping layers act on the velocities of its stages or of the middle of its steps.
struct Case {
    name: &'static str,
    kind: StepKind,
    make: Make,
    /// Order of displacements and of the energy balance; zero where the error is determined by a tolerance.
    order: i32,
}

fn rule(rule: ImplicitRule, solver: LinearSolver, system: &System) -> Box<dyn Integrator> {
    Box::new(Implicit::with_solver(rule, solver, system).unwrap())
}

fn newmark(solver: InnerSolver, system: &System) -> Box<dyn Integrator> {
    let options = NewmarkOptions {
        solver,
        tolerance: 1e-12,
        iterations: 200,
        ..NewmarkOptions::default()
    };
    Box::new(Newmark::new(options, system).unwrap())
}

/// Multirate scheme with the smaller step where the layer begins, in half of the layer and half of the remaining
/// bar.
fn two_steps(tableau: &Tableau, system: &System) -> Box<dyn Integrator> {
    let inside = |x: f64| (5.0..15.0).contains(&x);
    let axis = system.cloud().axis(0).iter();
    let fine = (0u32..).zip(axis).filter(|(_, x)| inside(**x));
    let options = MultiTimeStepOptions {
        ratio: 2,
        fine: Fine::Fixed(vec![fine.map(|(i, _)| i).collect()]),
        predictor: Predictor::Structured,
        interpolant: Interpolant::Hermite,
    };
    Box::new(MultiTimeStep::new(tableau, options, system).unwrap())
}

const CASES: [Case; 13] = [
    Case {
        name: "rk3",
        kind: StepKind::Stages,
        make: |system| Box::new(RungeKutta::new(&Tableau::rk3(0.5).unwrap(), system)),
        order: 3,
    },
    Case {
        name: "rk4",
        kind: StepKind::Stages,
        make: |system| Box::new(RungeKutta::new(&Tableau::rk4(), system)),
        order: 4,
    },
    Case {
        name: "dormand-prince",
        kind: StepKind::Stages,
        make: |system| Box::new(AdaptiveRungeKutta::new(1e-8, system).unwrap()),
        order: 0,
    },
    Case {
        name: "multirate-rk3",
        kind: StepKind::Stages,
        make: |system| two_steps(&Tableau::rk3(0.5).unwrap(), system),
        order: 3,
    },
    Case {
        name: "multirate-rk4",
        kind: StepKind::Stages,
        make: |system| two_steps(&Tableau::rk4(), system),
        order: 4,
    },
    Case {
        name: "newmark",
        kind: StepKind::Stages,
        make: |system| newmark(InnerSolver::FixedPoint, system),
        order: 2,
    },
    Case {
        name: "implicit-midpoint",
        kind: StepKind::Middle,
        make: |system| {
            rule(
                ImplicitRule::Midpoint,
                LinearSolver::ConjugateGradients,
                system,
            )
        },
        order: 2,
    },
    Case {
        name: "implicit-midpoint, direct",
        kind: StepKind::Middle,
        make: |system| rule(ImplicitRule::Midpoint, LinearSolver::Direct, system),
        order: 2,
    },
    Case {
        name: "trapezoidal",
        kind: StepKind::Middle,
        make: |system| rule(ImplicitRule::Trapezoidal, LinearSolver::Fastest, system),
        order: 2,
    },
    Case {
        name: "discrete-gradient",
        kind: StepKind::Middle,
        make: |system| Box::new(DiscreteGradient::new(1e-13, system).unwrap()),
        order: 2,
    },
    Case {
        name: "newmark",
        kind: StepKind::Kicks,
        make: |system| newmark(InnerSolver::NewtonKrylov, system),
        order: 2,
    },
    Case {
        name: "respa",
        kind: StepKind::Kicks,
        make: |system| {
            let axis = system.cloud().axis(0).iter();
            let fine = (0u32..).zip(axis).filter(|(_, x)| (5.0..15.0).contains(*x));
            let fine = Fine::Fixed(vec![fine.map(|(i, _)| i).collect()]);
            Box::new(Respa::new(2, fine, system).unwrap())
        },
        order: 2,
    },
    Case {
        name: "trigonometric",
        kind: StepKind::Flow,
        make: |system| {
            Box::new(Trigonometric::new(TrigonometricOptions::default(), system).unwrap())
        },
        order: 2,
    },
];

/// Bell that travels into the layer and back, with initial velocity.
fn bell(case: &Case, dt: f64) -> Simulation {
    let system = damped_for(case.kind, layer(10.0, 0.1), dt);
    let scheme = (case.make)(&system);
    let mut state = pulse(&system, 8.0);
    for (v, x) in state.v.iter_mut().zip(system.cloud().axis(0)) {
        *v = 2.0 * (x - 8.0) * (-(x - 8.0).powi(2)).exp() + 0.1;
    }
    Simulation::new(system, scheme, state, dt, (15.0 / dt).round() as u64).unwrap()
}

/// Displacements at the end, the energy imbalance relative to the initial energy, and the difference of the
/// momentum from the impulse of the layer relative to the impulse.
fn ended(case: &Case, dt: f64) -> (Vec<f64>, f64, f64) {
    let mut run = bell(case, dt);
    let before = run.system().momentum(&run.state().v)[0];
    run.run(|_| Control::Continue).unwrap();
    let energies = run.snapshot().energies();
    let after = run.system().momentum(&run.state().v)[0];
    let impulse = run.system().ledger().impulse[0];
    assert!(impulse < -0.1, "{}: {impulse}", case.name);
    let off = (after - before - impulse) / impulse;
    let balance = energies.balance() / energies.initial;
    (run.state().u.clone(), balance.abs(), off.abs())
}

#[test]
fn damping_layers_converge_with_the_order_of_every_scheme() {
    let (reference, ..) = ended(&CASES[1], DT / 16.0);
    let distance = |u: &[f64]| {
        let each = u.iter().zip(&reference).map(|(a, b)| (a - b).abs());
        each.fold(0.0, f64::max)
    };
    for case in &CASES {
        let [(coarse, wide, first), (fine, narrow, second)] =
            [DT, 0.5 * DT].map(|dt| ended(case, dt));
        let name = case.name;
        let (coarse, fine) = (distance(&coarse), distance(&fine));
        if case.order == 0 {
            assert!(fine < 1e-6 && narrow < 1e-6, "{name}: {fine:e}, {narrow:e}");
        } else {
            // Waves of a few spacings are not resolved in time: half an order is allowed for them.
            let least = 2f64.powf(f64::from(case.order) - 0.5);
            assert!(coarse > least * fine, "{name}: {coarse:e}, {fine:e}");
            assert!(coarse < 0.05, "{name}: {coarse:e}");
        }
        // Points on both sides of the multirate interface evaluate the force at stages of their own.
        let two_steps = name.starts_with("multirate-");
        let exact = if two_steps { 1e-4 } else { 1e-11 };
        assert!(
            first < exact && second < exact,
            "{name}: {first:e}, {second:e}"
        );
        match case.kind {
            StepKind::Middle | StepKind::Flow => {
                assert!(wide < 1e-11 && narrow < 1e-11, "{name}: {wide:e}")
            }
            // The mean of the work at both ends equals that of the velocity in between.
            _ if name == "newmark" => assert!(wide < 1e-9, "{name}: {wide:e}"),
            _ if case.order == 0 => {}
            _ => assert!(
                wide < 1e-2 && wide > 3.0 * narrow,
                "{name}: {wide:e}, {narrow:e}"
            ),
        }
    }
}

#[test]
fn damping_layers_resume_with_every_scheme() {
    for case in &CASES {
        check_resume(|| bell(case, DT), [40, 90]).unwrap_or_else(|error| {
            panic!("{}: {error}", case.name);
        });
    }
}

#[test]
fn schemes_without_velocities_reject_damping_layers() {
    let remembering = damped(layer(10.0, 0.1));
    let respa = Respa::new(2, Fine::Fixed(vec![(150..250).collect()]), &remembering);
    let respa = respa.err().unwrap().to_string();
    assert!(respa.contains("support a single time step only"), "{respa}");
    let newton = NewmarkOptions {
        solver: InnerSolver::NewtonKrylov,
        ..NewmarkOptions::default()
    };
    let newton = Newmark::new(newton, &remembering).err().unwrap();
    assert!(newton.to_string().contains("memory"), "{newton}");
    let system = damped_for(StepKind::Stages, layer(10.0, 0.1), DT);
    // A layer created for another step is detected at the start of the run.
    let state = pulse(&system, 0.0);
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), state, DT, 10).unwrap();
    let rejected = run.run(|_| Control::Continue).err().unwrap().to_string();
    assert!(rejected.contains("velocity-verlet"), "{rejected}");
}
