//! Schemes by name, and runs with them.

use pericles::space::PointSet;
use pericles::time::{
    Fine, Follow, Integrator, Interpolant, MultiTimeStep, MultiTimeStepOptions, Predictor, Respa,
    RungeKutta, Tableau,
};
use pericles::{Control, Simulation, System};

use super::bodies::Problem;

pub fn tableau(order: u32) -> Tableau {
    match order {
        3 => Tableau::rk3(0.75).unwrap(),
        _ => Tableau::rk4(),
    }
}

pub fn options(ratio: u32, fine: &PointSet) -> MultiTimeStepOptions {
    let regions = if fine.is_empty() {
        vec![]
    } else {
        vec![fine.clone()]
    };
    MultiTimeStepOptions {
        ratio,
        fine: Fine::Fixed(regions),
        predictor: Predictor::Structured,
        interpolant: Interpolant::Hermite,
    }
}

pub fn two_steps(
    system: &System,
    order: u32,
    options: MultiTimeStepOptions,
) -> Box<dyn Integrator> {
    Box::new(MultiTimeStep::new(&tableau(order), options, system).unwrap())
}

/// Makes the scheme for a body and its fine points.
pub type Scheme<'a> = dyn Fn(&System, &PointSet) -> Box<dyn Integrator> + Sync + 'a;

/// The final state of a problem with `steps` steps.
pub fn run(
    (system, state, fine, end): Problem,
    steps: u64,
    scheme: impl Fn(&System, &PointSet) -> Box<dyn Integrator>,
) -> Simulation {
    let integrator = scheme(&system, &fine);
    let mut simulation =
        Simulation::new(system, integrator, state, end / steps as f64, steps).unwrap();
    simulation.run(|_| Control::Continue).unwrap();
    simulation
}

pub fn uniform(order: u32) -> impl Fn(&System, &PointSet) -> Box<dyn Integrator> {
    move |system, _| Box::new(RungeKutta::new(&tableau(order), system))
}

pub fn mixed(order: u32, ratio: u32) -> impl Fn(&System, &PointSet) -> Box<dyn Integrator> {
    move |system, fine| two_steps(system, order, options(ratio, fine))
}

pub fn adaptive(order: u32, ratio: u32) -> impl Fn(&System, &PointSet) -> Box<dyn Integrator> {
    move |system, _| {
        let options = MultiTimeStepOptions {
            fine: Fine::Adaptive(Follow::default()),
            ..options(ratio, &vec![])
        };
        two_steps(system, order, options)
    }
}

pub fn respa(ratio: u32) -> impl Fn(&System, &PointSet) -> Box<dyn Integrator> {
    move |system, fine| {
        Box::new(Respa::new(ratio, Fine::Fixed(vec![fine.clone()]), system).unwrap())
    }
}

/// max |u_x − reference| over the points.
pub fn error_x(simulation: &Simulation, reference: &[f64]) -> f64 {
    let n = simulation.system().points();
    (0..n)
        .map(|i| (simulation.state().u[i] - reference[i]).abs())
        .fold(0.0, f64::max)
}

pub fn reference(problem: Problem) -> Vec<f64> {
    run(problem, 2048, uniform(4)).state().u.clone()
}
