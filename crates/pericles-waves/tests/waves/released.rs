//! Release of constrained points within a run, for schemes that solve for a whole step.

use std::sync::Arc;

use pericles::boundary::{MotionKind, PrescribedMotion, TimeFunction};
use pericles::family::VolumeCorrection;
use pericles::kernel::Influence;
use pericles::material::{BondMaterial, Calibration, ElasticModulus, Fracture, Modulus};
use pericles::material::{PairLaw, StressState};
use pericles::operator::{BondBody, BondForm};
use pericles::round_trip::check_resume;
use pericles::space::{Grid, Shape};
use pericles::time::{
    DiscreteGradient, Implicit, ImplicitRule, InnerSolver, Integrator, LinearSolver, Newmark,
    NewmarkOptions, State, VelocityVerlet,
};
use pericles::{Control, PointScalar, Simulation, System};
use pericles_waves::{FunctionMethod, Trigonometric, TrigonometricOptions};

/// Bar of 40 cells whose right end is pulled at constant velocity until it is released; the left end is fixed
/// permanently, or free.
fn pulled(law: PairLaw, held: bool) -> System {
    let shape = Shape::Box {
        origin: [0.0; 3],
        size: vec![40.0],
    };
    let grid = Grid {
        shape,
        spacing: 1.0,
        section: 1.0,
        holes: vec![],
    };
    let cloud = Arc::new(grid.points().unwrap());
    let material = BondMaterial {
        law,
        density: 1.0,
        modulus: Modulus {
            value: ElasticModulus::Young(1.0),
            calibration: Calibration::Continuum,
        },
        horizon: 3.0,
        influence: Influence::default(),
        volume_correction: VolumeCorrection::Linear,
        fracture: Fracture::Unbreakable,
    };
    let constants = material.constants(&cloud, StressState::Uniaxial).unwrap();
    let body = BondBody::new(&cloud, &material, &constants);
    let operator = body.operator(BondForm::List).unwrap().operator;
    let mut system = System::new(cloud.clone(), operator, PointScalar::Uniform(1.0)).unwrap();
    let still = vec![0.0; cloud.len()];
    let motion = |name: &str, points: std::ops::Range<u32>, speed: f64| {
        PrescribedMotion::new(
            name.into(),
            points.collect(),
            MotionKind::Velocity,
            [Some(speed), None, None],
            TimeFunction::Constant,
            &still,
            cloud.len(),
        )
        .unwrap()
    };
    let mut right = motion("right", 37..40, 0.01);
    right.until = Some(UNTIL);
    system.add_motion(right).unwrap();
    if held {
        system.add_motion(motion("left", 0..3, 0.0)).unwrap();
    }
    system
}

/// A half-integer multiple of [`STEP`], and of a third of it: the last push of the support, half a step long, ends
/// then.
const UNTIL: f64 = 21.5 * STEP;
const STEP: f64 = 0.15;
const END: f64 = 60.0 * STEP;

type Make = fn(&System) -> Box<dyn Integrator>;

const fn trigonometric(functions: FunctionMethod) -> TrigonometricOptions {
    TrigonometricOptions {
        functions,
        load_rule: pericles_waves::LoadRule::Gauss,
        regularisation: 0.0,
    }
}

const SCHEMES: [(&str, Make); 8] = [
    ("midpoint, direct", |system| {
        let solver = LinearSolver::Direct;
        Box::new(Implicit::with_solver(ImplicitRule::Midpoint, solver, system).unwrap())
    }),
    ("midpoint, iterated", |system| {
        let solver = LinearSolver::ConjugateGradients;
        Box::new(Implicit::with_solver(ImplicitRule::Midpoint, solver, system).unwrap())
    }),
    ("trapezoidal", |system| {
        Box::new(Implicit::new(ImplicitRule::Trapezoidal, system).unwrap())
    }),
    ("newmark", |system| {
        let options = NewmarkOptions {
            solver: InnerSolver::NewtonKrylov,
            tolerance: 1e-13,
            ..NewmarkOptions::default()
        };
        Box::new(Newmark::new(options, system).unwrap())
    }),
    ("discrete gradient", |system| {
        Box::new(DiscreteGradient::new(1e-12, system).unwrap())
    }),
    ("trigonometric", |system| {
        let options = trigonometric(FunctionMethod::Chebyshev);
        Box::new(Trigonometric::new(options, system).unwrap())
    }),
    ("trigonometric, eigenvectors", |system| {
        let options = trigonometric(FunctionMethod::Eigenvectors);
        Box::new(Trigonometric::new(options, system).unwrap())
    }),
    ("velocity-verlet", |_| Box::new(VelocityVerlet)),
];

fn simulation(law: PairLaw, held: bool, make: Make, dt: f64) -> Simulation {
    let system = pulled(law, held);
    let scheme = make(&system);
    let mut state = State::at_rest(system.points());
    state.v[37..40].fill(0.01);
    Simulation::new(system, scheme, state, dt, (END / dt).round() as u64).unwrap()
}

fn ended(law: PairLaw, held: bool, make: Make, dt: f64) -> Simulation {
    let mut run = simulation(law, held, make, dt);
    run.run(|_| Control::Continue).unwrap();
    run
}

#[test]
fn released_points_converge_with_the_order_of_the_scheme() {
    // The bond-stretch law is linear in one dimension, but the schemes treat it as nonlinear.
    for law in [PairLaw::Linear, PairLaw::BondStretch, PairLaw::GreenStrain] {
        let verlet: Make = |_| Box::new(VelocityVerlet);
        let reference = ended(law, true, verlet, STEP / 27.0);
        let exact = &reference.state().u;
        let size = exact.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
        let held = 0.01 * END;
        assert!(
            (exact[39] - held).abs() > 0.1 * held,
            "the released end has moved back"
        );
        for (name, make) in SCHEMES {
            let error = |dt: f64| {
                let run = ended(law, true, make, dt);
                let each = run.state().u.iter().zip(exact).map(|(a, b)| (a - b).abs());
                each.fold(0.0, f64::max) / size
            };
            let [wide, narrow] = [STEP, STEP / 3.0].map(error);
            // One ninth for order two.
            assert!(
                wide < 0.05 && wide > 6.0 * narrow,
                "{law:?}, {name}: {wide:e}, {narrow:e}"
            );
        }
    }
}

#[test]
fn momentum_of_a_released_body_equals_the_impulse_of_its_support() {
    for (name, make) in SCHEMES {
        // Impulses of supports are means of the forces at both ends of a step: exact for linear forces and
        // two-point schemes.
        if name.starts_with("trigonometric") {
            continue;
        }
        let begun = simulation(PairLaw::Linear, false, make, STEP);
        let before = begun.system().momentum(&begun.state().v)[0];
        let run = ended(PairLaw::Linear, false, make, STEP);
        let after = run.system().momentum(&run.state().v)[0];
        let impulse = run.system().ledger().impulse[0];
        assert!(impulse > 0.01, "{name}: {impulse}");
        let off = (after - before - impulse).abs() / impulse;
        assert!(off < 1e-10, "{name}: {off:e}");
    }
}

#[test]
fn energy_balance_closes_over_a_release() {
    for (name, make) in SCHEMES {
        let off = |dt: f64| {
            let run = ended(PairLaw::Linear, true, make, dt);
            let energies = run.snapshot().energies();
            energies.balance().abs() / energies.work.abs()
        };
        let [wide, narrow] = [STEP, STEP / 3.0].map(off);
        // Exact for velocity Verlet.
        let exact = wide.max(narrow) < 1e-12;
        assert!(
            exact || (wide < 0.02 && wide > 6.0 * narrow),
            "{name}: {wide:e}, {narrow:e}"
        );
    }
}

#[test]
fn runs_resume_before_and_after_a_release() {
    for (name, make) in SCHEMES {
        let run = || simulation(PairLaw::Linear, true, make, STEP);
        check_resume(run, [10, 21, 22, 40]).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}
