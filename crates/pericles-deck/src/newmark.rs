//! Options of `scheme = "newmark"`.

use pericles::time::{InnerSolver, NewmarkOptions};

use crate::quantity::Quantity;
use crate::reader::Table;

/// Keys of this scheme only.
pub(crate) const KEYS: [&str; 6] = ["beta", "gamma", "norm", "iterations", "solver", "depth"];

pub(crate) fn read(table: &Table<'_>) -> Option<NewmarkOptions> {
    let default = NewmarkOptions::default();
    let solver = solver(table);
    let newton = matches!(solver, Some(InnerSolver::NewtonKrylov));
    let beta = table.or("beta", default.beta, |item| {
        let allowed = if newton {
            "a number above 0 and at most 0.5"
        } else {
            "a number from 0 to 0.5"
        };
        item.within(Quantity::Number, allowed, |beta| {
            (0.0..=0.5).contains(&beta) && !(newton && beta == 0.0)
        })
    });
    let gamma = table.or("gamma", default.gamma, |item| {
        item.within(Quantity::Number, "a number from 0.5 to 1", |gamma| {
            (0.5..=1.0).contains(&gamma)
        })
    });
    let tolerance = table.or("tolerance", default.tolerance, |item| {
        item.positive(Quantity::Velocity)
    });
    let norm = table.worded("norm", "norm");
    let iterations = table.or("iterations", default.iterations, |item| {
        let count = item.count()?;
        match u32::try_from(count) {
            Ok(count) if count <= 1_000_000 => Some(count),
            _ => {
                item.out_of_range("a whole number from 1 to 1000000");
                None
            }
        }
    });
    Some(NewmarkOptions {
        beta: beta?,
        gamma: gamma?,
        tolerance: tolerance?,
        norm: norm?,
        iterations: iterations?,
        solver: solver?,
    })
}

fn solver(table: &Table<'_>) -> Option<InnerSolver> {
    const DEPTH: u32 = 4;
    let solver = table.choice_or_first(
        "solver",
        "solver",
        &[
            ("fixed-point", InnerSolver::FixedPoint),
            ("anderson", InnerSolver::Anderson { depth: DEPTH }),
            ("newton-krylov", InnerSolver::NewtonKrylov),
        ],
    );
    if let Some(InnerSolver::Anderson { .. }) = solver {
        let depth = table.or("depth", DEPTH, |item| {
            let depth = item.within(Quantity::Number, "a whole number from 1 to 8", |depth| {
                (1.0..=8.0).contains(&depth) && depth.fract() == 0.0
            })?;
            Some(depth as u32)
        });
        return Some(InnerSolver::Anderson { depth: depth? });
    }
    if solver.is_some() {
        table.forbid("depth", "it requires solver = \"anderson\"");
    } else {
        table.optional("depth");
    }
    solver
}
