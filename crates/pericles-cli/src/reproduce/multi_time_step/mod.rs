//! Two time steps in one body: orders, stability, failure, conservation and cost.
//!
//! Liu, Sun, Tian, Don, Ju, A high-order multi-time-step scheme for bond-based peridynamics, arXiv 2401.04966 (2024). The paper's formulas of the interface and most of its
//! parameters are not in print; the bodies are as the text describes them, and the expected numbers were computed by an independent code
//! (`validation/multi-time-step/`). `structured` and `hermite` are the predictor and the interpolant of [`pericles::time`] unless a row says otherwise.

mod convergence;
mod cost;
mod crack;
mod energy;
mod inclusion;
mod stability;
mod turns;
mod two_grid;

use pericles::time::{Integrator, RungeKutta, Tableau};
use pericles::{Control, Simulation};
use pericles_deck::{Deck, Model};

use pericles_run::RunError;

use super::Study;

/// The studies of this topic.
pub(super) const STUDIES: [Study; 9] = [
    convergence::PLATE,
    convergence::PLATE_NONLINEAR,
    convergence::BLOCK,
    crack::STUDY,
    stability::STUDY,
    energy::STUDY,
    cost::STUDY,
    inclusion::STUDY,
    two_grid::STUDY,
];

const PAPER: &str = "Liu et al. 2024, arXiv 2401.04966";

/// A deck inside the program, with what decks cannot say.
struct Problem {
    file: &'static str,
    text: &'static str,
    prepare: fn(&mut Model),
}

/// A problem of `validation/multi-time-step/`, or of the examples.
macro_rules! problem {
    ($file:literal) => {
        problem!($file, |_| ())
    };
    ($file:literal, $prepare:expr) => {
        $crate::reproduce::multi_time_step::Problem {
            file: $file,
            text: include_str!(concat!("../../../../../validation/multi-time-step/", $file)),
            prepare: $prepare,
        }
    };
    (example $file:literal, $prepare:expr) => {
        $crate::reproduce::multi_time_step::Problem {
            file: $file,
            text: include_str!(concat!("../../../../../examples/multi-time-step/", $file)),
            prepare: $prepare,
        }
    };
}
use problem;

/// A scheme with one or two time steps.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Method {
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
    fn name(self) -> String {
        match self {
            Self::Uniform(order) => format!("RK{order}"),
            Self::Verlet => "velocity Verlet".into(),
            Self::Two(order, ratio) => format!("RK{order} with two steps, M = {ratio}"),
            Self::Respa(ratio) => format!("r-RESPA, M = {ratio}"),
        }
    }

    /// What it changes in a deck with two time steps.
    fn changes(self) -> Vec<String> {
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

fn tableau(order: u32) -> Result<Tableau, RunError> {
    Ok(match order {
        // Heun's method: the paper's parameter is lost.
        3 => Tableau::rk3(0.75)?,
        _ => Tableau::rk4(),
    })
}

impl Problem {
    fn model(&self, method: Method, changes: &[String]) -> Result<Model, RunError> {
        let mut all = method.changes();
        all.extend_from_slice(changes);
        let mut model = Deck::parse(self.text, self.file, &all)?.build()?;
        (self.prepare)(&mut model);
        let one_step: Option<Box<dyn Integrator>> = match method {
            Method::Uniform(order) => {
                Some(Box::new(RungeKutta::new(&tableau(order)?, &model.system)))
            }
            Method::Verlet => Some(Box::new(pericles::time::VelocityVerlet)),
            _ => None,
        };
        if let Some(scheme) = one_step {
            model.integrator = scheme;
        }
        Ok(model)
    }

    /// The end of the problem in so many steps.
    fn run(&self, method: Method, steps: u64, changes: &[String]) -> Result<Simulation, RunError> {
        let end = Deck::parse(self.text, self.file, changes)?.time.end;
        let mut all = vec![format!("time.dt={:?}", end / steps as f64)];
        all.extend_from_slice(changes);
        let mut simulation = self.model(method, &all)?.simulation();
        finish(&mut simulation)?;
        Ok(simulation)
    }
}

fn finish(simulation: &mut Simulation) -> Result<(), RunError> {
    simulation
        .run(|_| Control::Continue)
        .map_err(|error| RunError::of_run(error, || "the study stopped there".into()))?;
    Ok(())
}

/// |a − b| over |b|, in the Euclidean norm.
fn relative(a: &[f64], b: &[f64]) -> f64 {
    let square = |x: &mut dyn Iterator<Item = f64>| -> f64 { x.map(|x| x * x).sum() };
    let difference = square(&mut a.iter().zip(b).map(|(a, b)| a - b));
    (difference / square(&mut b.iter().copied())).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::{Context, Study, row::Row};

    /// Every study whose rows do not depend on the clock: all judged rows hold, and there are some.
    #[test]
    fn studies_hold() {
        let context = Context::without_figures();
        let studies: [&Study; 7] = [
            &convergence::PLATE,
            &convergence::PLATE_NONLINEAR,
            &convergence::BLOCK,
            &crack::STUDY,
            &stability::STUDY,
            &energy::STUDY,
            &two_grid::STUDY,
        ];
        for study in studies {
            let rows = (study.run)(&context).unwrap();
            let wrong: Vec<&Row> = rows.iter().filter(|r| r.pass() == Some(false)).collect();
            assert!(wrong.is_empty(), "{}: {wrong:#?}", study.id);
            assert!(
                rows.iter().any(|row| row.pass() == Some(true)),
                "{}",
                study.id
            );
        }
    }
}
