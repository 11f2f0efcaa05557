//! Options of `scheme = "newmark"`.

use pericles::time::{InnerSolver, NewmarkOptions, VelocityNorm};
use pericles_deck_derive::{DeckKeys, DeckTable};
use serde::{Deserialize, Serialize};

use crate::form::described;
use crate::range::{Range, above_to, from_to};

/// Options of the scheme.
#[derive(Serialize, Deserialize, DeckTable)]
#[serde(remote = "NewmarkOptions", deny_unknown_fields)]
#[deck(remote = NewmarkOptions)]
struct NewmarkOptionsForm {
    #[serde(with = "crate::form")]
    #[deck(flatten)]
    solver: InnerSolver,
    /// newmark: parameter β.
    #[deck(range = betas(solver), default = NewmarkOptions::default().beta)]
    beta: f64,
    /// newmark: parameter γ.
    #[deck(range = from_to(0.5, 1.0), default = NewmarkOptions::default().gamma)]
    gamma: f64,
    /// newmark: change of the velocity between iterations (m/s).
    #[deck(
        quantity = Velocity,
        range = POSITIVE,
        default = NewmarkOptions::default().tolerance
    )]
    tolerance: f64,
    /// newmark: norm of the velocity change Δv. `l2`: √(Σ |Δv|²); `area-weighted`: √(Σ V |Δv|²); `max`: largest component.
    #[serde(with = "crate::form")]
    #[deck(default = VelocityNorm::Sum)]
    norm: VelocityNorm,
    /// newmark, adaptive-dynamic-relaxation, fire: largest number of iterations per step.
    #[deck(range = count_to(1_000_000), default = NewmarkOptions::default().iterations)]
    iterations: u32,
}

/// Range of β: Newton's method divides by it.
fn betas(solver: Option<&InnerSolver>) -> Range {
    match solver {
        Some(InnerSolver::NewtonKrylov) => above_to(0.0, 0.5),
        _ => from_to(0.0, 0.5),
    }
}

/// newmark: solver of the implicit step. `fixed-point`: predictor–corrector P-(EC)^k; `anderson`: fixed point with Anderson
/// acceleration; `newton-krylov`: Newton's method with a Krylov solver, for steps of any size.
#[derive(Serialize, Deserialize, DeckKeys)]
#[serde(remote = "InnerSolver", rename_all = "kebab-case", deny_unknown_fields)]
#[deck(remote = InnerSolver, tag = "solver", what = "solver")]
enum InnerSolverForm {
    #[default]
    FixedPoint,
    Anderson {
        /// newmark, solver = "anderson": number of previous iterates.
        #[deck(range = count_to(8), default = 4)]
        depth: u32,
    },
    NewtonKrylov,
}

described!(
    NewmarkOptions: NewmarkOptionsForm,
    InnerSolver: InnerSolverForm,
);
