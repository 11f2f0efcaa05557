//! Linear solvers of implicit steps: a reused Cholesky factor, or conjugate gradients.
//!
//! A Cholesky factor is used where it is cheaper than conjugate gradients, by sizes only. It belongs to the first of
//! many steps whose lengths differ by rounding: each solution is refined against the matrix of its own step, and a
//! checkpoint stores the step of the factor.

use super::add_and_weigh;
use crate::error::Result;
use crate::operator::{Force, LinearOperator};
use crate::solve::{BandedCholesky, SolveLimits, Work, conjugate_gradient};
use crate::system::System;
use crate::time::ends;

/// Solver for the linear system of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LinearSolver {
    /// The faster of the two by estimated cost.
    #[default]
    Fastest,
    /// Cholesky factor, computed once for a time step and refined: for bars, whose matrix is a band, and small
    /// bodies.
    Direct,
    /// Conjugate gradients: for any body.
    ConjugateGradients,
}

impl LinearSolver {
    /// All solvers, the default first.
    pub const ALL: [Self; 3] = [Self::Fastest, Self::Direct, Self::ConjugateGradients];

    /// Name in decks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fastest => "fastest",
            Self::Direct => "direct",
            Self::ConjugateGradients => "conjugate-gradients",
        }
    }
}

/// Properties of the matrix that determine the choice of the solver.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape {
    unknowns: f64,
    /// Half bandwidth: largest |i − j| of coupled unknowns.
    reach: f64,
    /// Number of multiplications per matrix–vector product.
    product: f64,
    /// Upper bound of the highest frequency, 1/s.
    frequency: f64,
}

/// Largest number of entries of a factor that is chosen automatically: a quarter of a gigabyte.
const MOST: f64 = 3e7;
/// Number of steps over which the cost of the factor is distributed; most runs have more.
const STEPS: f64 = 100.0;

impl Shape {
    fn of(system: &System, linear: &dyn LinearOperator) -> Self {
        /// Number of multiplications per point above which operators use transforms.
        const TRANSFORM: f64 = 100.0;
        let operator: &dyn Force = system.operator();
        let points = system.points() as f64;
        let unknowns = system.dimension() as f64 * points;
        let reach = linear.half_bandwidth();
        let bonds = operator.directed_bonds() as f64 / points;
        Self {
            unknowns,
            reach: reach.map_or(unknowns - 1.0, |reach| reach as f64),
            product: unknowns * (system.dimension() as f64 * bonds).min(TRANSFORM),
            frequency: operator.frequency_bound(&|i| system.density().at(i)),
        }
    }

    /// Returns whether a factor is cheaper than conjugate gradients for steps of length tau.
    fn favours_a_factor(&self, tau: f64) -> bool {
        let numbers = self.unknowns * (self.reach + 1.0);
        // Number of iterations to a residual of 1e-14, with a few vector operations in each.
        let condition = 1.0 + (0.5 * tau * self.frequency).powi(2);
        let iteration = self.product + 6.0 * self.unknowns;
        let iterative = (15.0 * condition.sqrt()).min(self.unknowns) * iteration;
        let direct = 2.0 * numbers + 2.0 * iteration;
        let once = numbers * self.reach + (2.0 * self.reach + 1.0) * self.product;
        numbers <= MOST && direct + once / STEPS < iterative
    }
}

/// Solver for the linear systems of a run.
pub(super) struct StepSolver {
    choice: LinearSolver,
    shape: Shape,
    /// Time step of the factor, s; zero if there is none. It is unchanged while steps differ by rounding only.
    factored: f64,
    /// Number of constraints that acted when the factor was computed.
    held: u64,
    factor: Option<BandedCholesky>,
}

impl StepSolver {
    pub(super) fn new(choice: LinearSolver, system: &System) -> Option<Self> {
        let linear = system.operator().as_linear()?;
        Some(Self {
            choice,
            shape: Shape::of(system, linear),
            factored: 0.0,
            held: 0,
            factor: None,
        })
    }

    /// Returns whether steps of length tau are solved by a factor. It is not used if breaking bonds would
    /// invalidate it, or for a body divided among processes.
    pub(super) fn is_direct(&self, tau: f64, system: &System) -> bool {
        match self.choice {
            _ if system.operator().can_break() => false,
            // A factor needs the whole matrix.
            _ if system.domain().is_divided() => false,
            LinearSolver::Direct => true,
            LinearSolver::ConjugateGradients => false,
            LinearSolver::Fastest => self.shape.favours_a_factor(tau),
        }
    }

    /// Solves (M + τ²/4 K) x = right for the step between two times, with a right-hand side that is zero where
    /// motion is prescribed at the end of the step; `mass` is the diagonal of M.
    pub(super) fn solve(
        &mut self,
        system: &System,
        mass: &[f64],
        [t, t_next]: [f64; 2],
        right: &[f64],
        x: &mut [f64],
        (limits, work): (&SolveLimits<'_>, &mut Work),
    ) -> Result<()> {
        let tau = t_next - t;
        let mut product =
            |x: &[f64], out: &mut [f64]| product_into(system, mass, [tau, t_next], x, out);
        if !self.is_direct(tau, system) {
            x.fill(0.0);
            return conjugate_gradient(&mut product, right, x, limits, work).map(|_| ());
        }
        let factor = self.factor_of(system, mass, [tau, t_next])?;
        x.copy_from_slice(right);
        factor.solve(x);
        factor
            .refine(&mut product, right, x, limits, work)
            .map(|_| ())
    }

    /// Returns the factor of a step, computing it if needed.
    fn factor_of(
        &mut self,
        system: &System,
        mass: &[f64],
        [tau, t_next]: [f64; 2],
    ) -> Result<&BandedCholesky> {
        /// Steps that differ by less, relative to their length, count as equal: they are differences of rounded
        /// times.
        const SAME: f64 = 1e-6;
        let held = system.holding(t_next);
        if (self.factored / tau - 1.0).abs() > SAME || self.held != held {
            self.factored = tau;
            self.held = held;
            self.factor = None;
        }
        let factor = match self.factor.take() {
            Some(factor) => factor,
            None => {
                let step = [self.factored, t_next];
                factorise(system, mass, step, self.shape.reach as usize)?
            }
        };
        Ok(self.factor.insert(factor))
    }
}

/// Computes M x + τ²/4 K x including boundaries, with K x = 0 where motion is prescribed at the end of the step.
fn product_into(
    system: &System,
    mass: &[f64],
    [tau, t_next]: [f64; 2],
    x: &[f64],
    out: &mut [f64],
) {
    // For linear forces the point of linearisation is arbitrary.
    system.vibration_at(t_next, x, x, out);
    ends::add_stiffness(system, x, out);
    add_and_weigh(out, 0.25 * tau * tau, x, mass);
}

/// Computes the factor of the matrix, with unit rows and columns for prescribed entries.
fn factorise(
    system: &System,
    mass: &[f64],
    step: [f64; 2],
    reach: usize,
) -> Result<BandedCholesky> {
    let mut free = vec![0.0; mass.len()];
    let mut apply = |x: &[f64], out: &mut [f64]| {
        free.copy_from_slice(x);
        system.hold_at(step[1], &mut free);
        product_into(system, mass, step, &free, out);
        for (out, (x, free)) in out.iter_mut().zip(x.iter().zip(&free)) {
            *out += x - free;
        }
    };
    BandedCholesky::new(&mut apply, mass.len(), reach)
}

// The factor belongs to the first of many steps that differ by rounding; the checkpoint stores that step.
crate::saved! {
    impl Checkpointed for StepSolver {
        factored: array("implicit/factored"),
        held: array("implicit/held"),
        factor: set(None),
        choice, shape: fixed,
    }
}
