//! The linear systems of implicit steps: by a factor that is kept, or by iteration.

use super::add_and_weigh;
use crate::error::Result;
use crate::operator::{Force, LinearOperator};
use crate::solve::{BandedCholesky, SolveLimits, Work, conjugate_gradient};
use crate::system::System;
use crate::time::ends;

/// How the linear system of a step is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LinearSolver {
    /// The cheaper of the two, by estimated cost.
    #[default]
    Fastest,
    /// Cholesky's factor, computed once for a step and refined: bars, whose matrix is a band, and small bodies.
    Direct,
    /// Conjugate gradients: any body.
    ConjugateGradients,
}

impl LinearSolver {
    /// All, the default first.
    pub const ALL: [Self; 3] = [Self::Fastest, Self::Direct, Self::ConjugateGradients];

    /// As written in decks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fastest => "fastest",
            Self::Direct => "direct",
            Self::ConjugateGradients => "conjugate-gradients",
        }
    }
}

/// The matrix of a body as the choice of a solver sees it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shape {
    unknowns: f64,
    /// Largest |i − j| of unknowns that act on each other.
    reach: f64,
    /// Multiplications of a product.
    product: f64,
    /// A bound of the highest frequency, 1/s.
    frequency: f64,
}

/// Numbers of a factor beyond which it is not made unasked: a quarter of a gigabyte.
const MOST: f64 = 3e7;
/// Steps over which the cost of the factor is spread; most runs have more.
const STEPS: f64 = 100.0;

impl Shape {
    fn of(system: &System, linear: &dyn LinearOperator) -> Self {
        /// Multiplications per point beyond which operators use transforms.
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

    /// Whether a factor is cheaper than conjugate gradients for steps of length tau.
    fn favours_a_factor(&self, tau: f64) -> bool {
        let numbers = self.unknowns * (self.reach + 1.0);
        // Iterations to a residual of 1e-14, some vectors of work in each.
        let condition = 1.0 + (0.5 * tau * self.frequency).powi(2);
        let iteration = self.product + 6.0 * self.unknowns;
        let iterative = (15.0 * condition.sqrt()).min(self.unknowns) * iteration;
        let direct = 2.0 * numbers + 2.0 * iteration;
        let once = numbers * self.reach + (2.0 * self.reach + 1.0) * self.product;
        numbers <= MOST && direct + once / STEPS < iterative
    }
}

/// Solves the systems of the steps of a run.
pub(super) struct StepSolver {
    choice: LinearSolver,
    shape: Shape,
    /// The step that the factor belongs to, s; zero if there is none. It stays while steps differ by rounding only.
    factored: f64,
    /// The number of prescribed motions that held their points then.
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

    /// Whether steps of length tau are solved by a factor. One that breaking bonds would spoil is not made, nor one of a body divided among processes.
    pub(super) fn is_direct(&self, tau: f64, system: &System) -> bool {
        match self.choice {
            _ if system.operator().can_break() => false,
            // A factor takes the whole matrix.
            _ if system.domain().is_divided() => false,
            LinearSolver::Direct => true,
            LinearSolver::ConjugateGradients => false,
            LinearSolver::Fastest => self.shape.favours_a_factor(tau),
        }
    }

    /// Solves (M + τ²/4 K) x = right of the step between two times, for a right-hand side that is zero where motion is prescribed at its end; `mass` is the diagonal of M.
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

    /// The factor of a step, made where there is none yet.
    fn factor_of(
        &mut self,
        system: &System,
        mass: &[f64],
        [tau, t_next]: [f64; 2],
    ) -> Result<&BandedCholesky> {
        /// Steps that differ by less are one step, the difference of rounded times.
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

/// M x + τ²/4 K x, boundaries included, with K x zero where motion is prescribed at the end of the step.
fn product_into(
    system: &System,
    mass: &[f64],
    [tau, t_next]: [f64; 2],
    x: &[f64],
    out: &mut [f64],
) {
    // The place about which a linear force is linearised does not matter.
    system.vibration_at(t_next, x, x, out);
    ends::add_stiffness(system, x, out);
    add_and_weigh(out, 0.25 * tau * tau, x, mass);
}

/// The factor of the matrix whose rows and columns of prescribed entries are those of the unit matrix.
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

// A factor is that of the first of many steps whose lengths differ by rounding; which step that was is remembered.
crate::saved! {
    impl Saved for StepSolver {
        factored: array("implicit/factored"),
        held: array("implicit/held"),
        factor: set(None),
        choice, shape: fixed,
    }
}
