//! The problems of the studies, and the schemes they are solved by.

use pericles::time::{Integrator, RungeKutta, Tableau};
use pericles::{Control, Simulation};
use pericles_deck::Deck;
use pericles_run::{Assembly, Resources, RunError, build};

/// The paper of the topic.
pub(super) const PAPER: &str = "Liu et al. 2024, arXiv 2401.04966";

/// A deck inside the library, with what decks cannot say.
pub(super) struct Problem {
    pub(super) file: &'static str,
    pub(super) text: &'static str,
    pub(super) prepare: fn(&mut Assembly),
}

/// A problem of `validation/multi-time-step/`, or of the examples.
macro_rules! problem {
    ($file:literal) => {
        problem!($file, |_| ())
    };
    ($file:literal, $prepare:expr) => {
        $crate::multi_time_step::problem::Problem {
            file: $file,
            text: include_str!(concat!("../../../../validation/multi-time-step/", $file)),
            prepare: $prepare,
        }
    };
    (example $file:literal, $prepare:expr) => {
        $crate::multi_time_step::problem::Problem {
            file: $file,
            text: include_str!(concat!("../../../../examples/multi-time-step/", $file)),
            prepare: $prepare,
        }
    };
}
pub(super) use problem;

/// A scheme with one or two time steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Method {
    /// Runge–Kutta of this order with one step.
    Uniform(u32),
    /// Velocity Verlet.
    Verlet,
    /// Runge–Kutta of this order with the fine step this many times smaller.
    Two(u32, u32),
    /// r-RESPA with the fine step this many times smaller.
    Respa(u32),
}

impl Method {
    pub(super) fn name(self) -> String {
        match self {
            Self::Uniform(order) => format!("RK{order}"),
            Self::Verlet => "velocity Verlet".into(),
            Self::Two(order, ratio) => format!("RK{order} with two steps, M = {ratio}"),
            Self::Respa(ratio) => format!("r-RESPA, M = {ratio}"),
        }
    }

    /// What it changes in a deck with two time steps.
    pub(super) fn changes(self) -> Vec<String> {
        match self {
            // The deck's own scheme gives way to one made from the model.
            Self::Uniform(_) | Self::Verlet => Vec::new(),
            Self::Two(order, ratio) => vec![
                format!("time.scheme=rk{order}-mts"),
                format!("time.ratio={ratio}"),
            ],
            Self::Respa(ratio) => vec!["time.scheme=respa".into(), format!("time.ratio={ratio}")],
        }
    }
}

pub(super) fn tableau(order: u32) -> Result<Tableau, RunError> {
    Ok(match order {
        // Heun's method: the paper's parameter is lost.
        3 => Tableau::rk3(0.75)?,
        _ => Tableau::rk4(),
    })
}

impl Problem {
    pub(super) fn assembly(
        &self,
        method: Method,
        changes: &[String],
    ) -> Result<Assembly, RunError> {
        let mut all = method.changes();
        all.extend_from_slice(changes);
        let mut assembly = build(
            &Deck::parse(self.text, self.file, &all)?,
            &Resources::default(),
        )?;
        (self.prepare)(&mut assembly);
        let one_step: Option<Box<dyn Integrator>> = match method {
            Method::Uniform(order) => Some(Box::new(RungeKutta::new(
                &tableau(order)?,
                &assembly.system,
            ))),
            Method::Verlet => Some(Box::new(pericles::time::VelocityVerlet)),
            _ => None,
        };
        if let Some(scheme) = one_step {
            assembly.integrator = scheme;
        }
        Ok(assembly)
    }

    /// The end of the problem in so many steps.
    pub(super) fn run(
        &self,
        method: Method,
        steps: u64,
        changes: &[String],
    ) -> Result<Simulation, RunError> {
        let end = Deck::parse(self.text, self.file, changes)?.model.time.end;
        let mut all = vec![format!("time.dt={:?}", end / steps as f64)];
        all.extend_from_slice(changes);
        let mut simulation = self.assembly(method, &all)?.simulation()?;
        finish(&mut simulation)?;
        Ok(simulation)
    }
}

pub(super) fn finish(simulation: &mut Simulation) -> Result<(), RunError> {
    simulation
        .run(|_| Control::Continue)
        .map_err(|error| RunError::of_run(error, || "the study stopped there".into()))?;
    Ok(())
}

/// |a − b| over |b|, in the Euclidean norm.
pub(super) fn relative(a: &[f64], b: &[f64]) -> f64 {
    let square = |x: &mut dyn Iterator<Item = f64>| -> f64 { x.map(|x| x * x).sum() };
    let difference = square(&mut a.iter().zip(b).map(|(a, b)| a - b));
    (difference / square(&mut b.iter().copied())).sqrt()
}
