//! Orders of the schemes on bodies that do not fail.
//!
//! Error: the largest |u_x − reference| over the points at the end; the reference is RK4 with T/2048.

use pericles::Simulation;
use pericles_run::RunError;

use super::problem::{Method, PAPER, Problem, problem};
use crate::row::Row;
use crate::study::{Context, Study};

/// A linear plate pulled from rest.
pub(crate) const PLATE: Study = Study {
    id: "multi-time-step/plate",
    paper: PAPER,
    title: "Orders with two time steps: a plate under sudden tension",
    run: plate,
};

/// Geometric nonlinearity, waves of all directions, ragged interfaces.
pub(crate) const PLATE_NONLINEAR: Study = Study {
    id: "multi-time-step/plate-nonlinear",
    paper: PAPER,
    title: "Orders with two time steps: nonlinear force and a ragged fine region",
    run: plate_nonlinear,
};

/// Three dimensions and a support.
pub(crate) const BLOCK: Study = Study {
    id: "multi-time-step/block",
    paper: PAPER,
    title: "Orders with two time steps: a block bent at one end",
    run: block,
};

/// Steps of the levels; the numbers of the independent code belong to the first four.
const LEVELS: [u64; 6] = [32, 64, 128, 256, 512, 1024];
const REFERENCE: u64 = 2048;

/// The bands in which the order of the last pair has to lie: 2.95 … 3.10 and 3.90 … 4.05.
fn band(order: u32) -> (f64, f64) {
    match order {
        3 => (3.025, 0.075),
        _ => (3.975, 0.075),
    }
}

/// Errors at the levels by the independent code.
struct Expected {
    method: Method,
    errors: [f64; 4],
}

const fn expected(method: Method, errors: [f64; 4]) -> Expected {
    Expected { method, errors }
}

/// The errors of a method on a problem, coarsest level first.
struct Convergence {
    method: Method,
    first: usize,
    errors: Vec<f64>,
}

impl Convergence {
    fn measure(
        problem: &Problem,
        reference: &[f64],
        method: Method,
        levels: std::ops::Range<usize>,
        changes: &[String],
    ) -> Result<Self, RunError> {
        let first = levels.start;
        let errors: Result<Vec<f64>, RunError> = levels
            .map(|level| {
                let run = problem.run(method, LEVELS[level], changes)?;
                Ok(error(&run, reference))
            })
            .collect();
        Ok(Self {
            method,
            first,
            errors: errors?,
        })
    }

    fn error_rows(&self, expected: &[f64]) -> Vec<Row> {
        self.errors
            .iter()
            .zip(&expected[self.first..])
            .zip(&LEVELS[self.first..])
            .map(|((found, expected), steps)| {
                let case = format!("{}: error at T/{steps}", self.method.name());
                Row::new(case, "m", Some(*found)).within_share(*expected, 0.03)
            })
            .collect()
    }

    fn order(&self) -> Option<f64> {
        let last = self.errors.len().checked_sub(2)?;
        Some((self.errors[last] / self.errors[last + 1]).log2())
    }

    fn order_row(&self, what: &str) -> Row {
        let last = LEVELS[self.first + self.errors.len() - 1];
        let case = format!(
            "{}{what}: order from T/{} to T/{last}",
            self.method.name(),
            last / 2
        );
        Row::new(case, "", self.order())
    }
}

fn error(run: &Simulation, reference: &[f64]) -> f64 {
    let n = run.system().points();
    let pairs = run.state().u[..n].iter().zip(reference);
    pairs
        .map(|(u, exact)| (u - exact).abs())
        .fold(0.0, f64::max)
}

fn reference(problem: &Problem) -> Result<Vec<f64>, RunError> {
    let run = problem.run(Method::Uniform(4), REFERENCE, &[])?;
    Ok(run.state().u[..run.system().points()].to_vec())
}

fn largest(u: &[f64]) -> f64 {
    u.iter().fold(0.0, |most: f64, u| most.max(u.abs()))
}

/// The levels of a study: the last three of the independent code's, all of them with `full`.
fn levels(context: &Context<'_>) -> std::ops::Range<usize> {
    if context.full { 0..4 } else { 1..4 }
}

const PLATE_UNIFORM: [Expected; 2] = [
    expected(Method::Uniform(3), [2.509e-6, 3.720e-7, 4.708e-8, 5.791e-9]),
    expected(
        Method::Uniform(4),
        [4.247e-7, 3.544e-8, 2.329e-9, 1.471e-10],
    ),
];
/// The same for M = 2, 4 and 8 within 0.2 %.
const PLATE_TWO: [(u32, [f64; 4]); 2] = [
    (3, [2.36e-6, 3.714e-7, 4.700e-8, 5.780e-9]),
    (4, [4.135e-7, 3.49e-8, 2.31e-9, 1.467e-10]),
];

fn plate(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let problem = problem!("plate.toml");
    let exact = reference(&problem)?;
    let mut rows = vec![
        Row::new("largest displacement", "m", Some(largest(&exact))).within_share(6.759e-4, 1e-3),
    ];
    for (Expected { method, errors }, (order, two)) in PLATE_UNIFORM.iter().zip(PLATE_TWO) {
        let uniform = Convergence::measure(&problem, &exact, *method, levels(context), &[])?;
        let (middle, half) = band(order);
        rows.extend(uniform.error_rows(errors));
        rows.push(uniform.order_row("").within(middle, half));
        for ratio in [2, 4, 8] {
            let method = Method::Two(order, ratio);
            let found = Convergence::measure(&problem, &exact, method, levels(context), &[])?;
            rows.extend(found.error_rows(&two));
            rows.push(printed_orders(
                order,
                found.order_row("").within(middle, half),
            ));
            let last = found.errors.len() - 1;
            let case = format!("{}: last error over that of one step", method.name());
            rows.push(
                Row::new(case, "", Some(found.errors[last] / uniform.errors[last]))
                    .within(1.0, 0.1),
            );
        }
        rows.push(equal_steps(&problem, order)?);
    }
    if context.full {
        rows.extend(every_choice(&problem, &exact, context)?);
    }
    Ok(rows)
}

fn printed_orders(order: u32, row: Row) -> Row {
    row.note(match order {
        3 => "the paper prints 3.00 … 3.09 for all M",
        _ => "the paper prints 3.91 … 3.99 for all M",
    })
}

/// How fast the zoned scheme with M = 1 comes to the plain one.
fn equal_steps(problem: &Problem, order: u32) -> Result<Row, RunError> {
    let difference = |steps| -> Result<f64, RunError> {
        let plain = problem.run(Method::Uniform(order), steps, &[])?;
        let zoned = problem.run(Method::Two(order, 1), steps, &[])?;
        Ok(error(&zoned, &plain.state().u))
    };
    let observed = (difference(128)? / difference(256)?).log2();
    let case = format!("RK{order}: order in which two equal steps come to one step");
    Ok(Row::new(case, "", Some(observed))
        .within(f64::from(order) + 0.5, 0.7)
        .note("at least the order of the method; the difference sits at the interface only, which waves reach late"))
}

/// The paper's predictor and interpolant as well.
fn every_choice(
    problem: &Problem,
    exact: &[f64],
    context: &Context<'_>,
) -> Result<Vec<Row>, RunError> {
    let mut rows = Vec::new();
    for (predictor, interpolant) in [
        ("structured", "stages"),
        ("backward-difference", "hermite"),
        ("backward-difference", "stages"),
    ] {
        let changes = [
            format!("time.predictor={predictor}"),
            format!("time.interpolant={interpolant}"),
        ];
        for (order, _) in PLATE_TWO {
            let (middle, half) = band(order);
            for ratio in [2, 4, 8] {
                let method = Method::Two(order, ratio);
                let found =
                    Convergence::measure(problem, exact, method, levels(context), &changes)?;
                let what = format!(", {predictor}, {interpolant}");
                rows.push(found.order_row(&what).within(middle, half));
            }
        }
    }
    Ok(rows)
}

const NONLINEAR: [Expected; 2] = [
    expected(Method::Two(3, 4), [5.215e-5, 7.801e-6, 9.523e-7, 1.178e-7]),
    expected(Method::Two(4, 4), [1.026e-5, 7.848e-7, 4.989e-8, 3.103e-9]),
];

fn plate_nonlinear(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let problem = problem!("plate-nonlinear.toml");
    let exact = reference(&problem)?;
    let mut rows = Vec::new();
    for Expected { method, errors } in &NONLINEAR {
        let order = match method {
            Method::Two(order, _) => *order,
            _ => continue,
        };
        let (middle, half) = band(order);
        let found = Convergence::measure(&problem, &exact, *method, levels(context), &[])?;
        rows.extend(found.error_rows(errors));
        rows.push(found.order_row("").within(middle, half));
        let others: &[u32] = if context.full { &[1, 2, 8] } else { &[] };
        for &ratio in others {
            let method = Method::Two(order, ratio);
            let found = Convergence::measure(&problem, &exact, method, 2..4, &[])?;
            rows.push(found.order_row("").within(middle, half));
        }
        rows.push(equal_steps(&problem, order)?);
    }
    for ratio in [4, 8] {
        let found = Convergence::measure(&problem, &exact, Method::Respa(ratio), 3..5, &[])?;
        rows.push(found.order_row("").within(1.98, 0.05));
    }
    Ok(rows)
}

const BLOCK_TWO: [Expected; 2] = [
    expected(
        Method::Two(3, 4),
        [4.248e-9, 7.326e-10, 1.016e-10, 1.320e-11],
    ),
    expected(
        Method::Two(4, 4),
        [7.858e-10, 4.312e-11, 2.592e-12, 1.56e-13],
    ),
];

fn block(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let problem = problem!("block.toml");
    let exact = reference(&problem)?;
    let mut rows = Vec::new();
    for (Expected { method, errors }, (order, found_elsewhere)) in
        BLOCK_TWO.iter().zip([(3, 2.94), (4, 4.05)])
    {
        let (middle, half) = band(order);
        let found = Convergence::measure(&problem, &exact, *method, levels(context), &[])?;
        rows.extend(found.error_rows(errors));
        rows.push(
            found
                .order_row("")
                .within(found_elsewhere, 0.03)
                .note("the largest error sits at the loaded end, where the methods come to their order late; expected is what the independent code found"),
        );
        if order == 3 || context.full {
            // RK4's error at finer levels is round-off.
            let last = if context.full && order == 3 { 6 } else { 5 };
            let finer = Convergence::measure(&problem, &exact, *method, 3..last, &[])?;
            rows.push(
                finer
                    .order_row("")
                    .within(middle, half)
                    .note("one level further, in the band of the other bodies"),
            );
        }
        if context.full {
            for ratio in [1, 2, 8] {
                let found =
                    Convergence::measure(&problem, &exact, Method::Two(order, ratio), 2..4, &[])?;
                rows.push(found.order_row(""));
            }
        }
    }
    Ok(rows)
}
