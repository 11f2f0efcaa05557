//! Newmark's method with several inner solvers, and the discrete gradient scheme.
//!
//! With vP = v + (1−γ) dt a and uP = u + dt v + (1/2−β) dt² a, a step of Newmark's method (1959) solves
//!
//! > a′ = (f(u′) + b(t′))/ρ,  u′ = uP + β dt² a′,  v′ = vP + γ dt a′.
//!
//! | inner solver | cost of a step | converges for |
//! |---|---|---|
//! | [`InnerSolver::FixedPoint`], the P-(EC)^k form | k force evaluations | ω dt < 1/√β: not beyond explicit schemes |
//! | [`InnerSolver::Anderson`] | as many, fewer near the limit; 2 · depth additional vectors | somewhat larger steps, not guaranteed |
//! | [`InnerSolver::NewtonKrylov`] | products with the tangent | any step, if the tangent is negative semi-definite |
//!
//! β = 1/4, γ = 1/2 is the trapezoidal rule: second order, no dissipation, stable for any step if the equation is
//! solved. For γ = 1/2 and linear forces ½ v·Mv + ½ u·Ku + (β − 1/4) dt²/2 a·Ma is conserved (Hughes 1987, section
//! 9.1.2).
//!
//! [`DiscreteGradient`] conserves energy for any elastic forces and for any step where the elastic energy is
//! convex.

mod discrete_gradient;
mod equation;
mod scheme;

pub use discrete_gradient::DiscreteGradient;
pub use scheme::Newmark;

use crate::compatibility::{Need, Requirement};
use crate::error::{PericlesError, Result};
use crate::step_kind::StepKind;
use crate::sum::max_norm;
use crate::system::System;

/// Solver for the equation of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum InnerSolver {
    /// Fixed-point iteration, P-(EC)^k: evaluate and correct until the velocity converges.
    #[default]
    FixedPoint,
    /// Fixed-point iteration with Anderson acceleration from the last `depth` corrections (Anderson 1965; Walker &
    /// Ni 2011).
    Anderson {
        /// Number of corrections used, 1 to 8.
        depth: u32,
    },
    /// Newton's method with conjugate gradients.
    NewtonKrylov,
}

impl InnerSolver {
    /// Name of the scheme with this solver in messages.
    fn scheme(self) -> &'static str {
        match self {
            Self::FixedPoint | Self::Anderson { .. } => "newmark",
            Self::NewtonKrylov => "newmark with Newton's method",
        }
    }

    /// Time within a step at which forces are evaluated. Newton's method solves for displacements, so that
    /// velocity-dependent boundaries act between the steps.
    pub const fn step_kind(self) -> StepKind {
        match self {
            Self::FixedPoint | Self::Anderson { .. } => StepKind::Stages,
            Self::NewtonKrylov => StepKind::Kicks,
        }
    }

    /// Requirements of the scheme with this solver.
    pub const fn requirements(self) -> &'static [Requirement] {
        match self {
            Self::FixedPoint | Self::Anderson { .. } => &[
                Requirement::IN_DOUBLES,
                Requirement::CONSERVATIVE_CONTACT,
                Requirement::NO_FREE_BODIES,
            ],
            Self::NewtonKrylov => &[
                Requirement::IN_DOUBLES,
                Requirement {
                    need: Need::NoMemory,
                    reason: "its equation contains forces that depend on displacements only, not boundaries with memory; use velocity-verlet",
                },
                Requirement::CONSERVATIVE_CONTACT,
                Requirement::NO_FREE_BODIES,
            ],
        }
    }
}

/// Norm of the change of the velocity, m/s.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum VelocityNorm {
    /// √(Σ |Δv_i|²) over all points.
    #[default]
    Sum,
    /// √(Σ V_i |Δv_i|²).
    Weighted,
    /// Largest absolute value of a component.
    Largest,
}

impl VelocityNorm {
    /// Name in decks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sum => "l2",
            Self::Weighted => "area-weighted",
            Self::Largest => "max",
        }
    }

    /// Returns the norm of `factor` times a component-major vector.
    fn of(self, system: &System, factor: f64, x: &[f64]) -> f64 {
        let n = system.points();
        let (domain, volumes) = (system.domain(), system.cloud().volumes());
        let scaled = match self {
            Self::Sum => domain.norm(x),
            Self::Weighted => domain.sum(x.len(), |k| volumes[k % n] * x[k] * x[k]).sqrt(),
            Self::Largest => domain.max(max_norm(x)),
        };
        factor.abs() * scaled
    }
}

/// Parameters of [`Newmark`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewmarkOptions {
    /// β, 0 to 1/2.
    pub beta: f64,
    /// γ, 1/2 to 1; above 1/2 the scheme is of first order and dissipative.
    pub gamma: f64,
    /// Tolerance: the inner iteration ends when the velocity changes by at most this, m/s in the given norm.
    pub tolerance: f64,
    /// Norm of the change.
    pub norm: VelocityNorm,
    /// Largest number of inner iterations; then the step fails.
    pub iterations: u32,
    /// Solver for the equation of a step.
    pub solver: InnerSolver,
}

impl Default for NewmarkOptions {
    /// The trapezoidal rule to 1e-7 m/s with at most 50 iterations.
    fn default() -> Self {
        Self {
            beta: 0.25,
            gamma: 0.5,
            tolerance: 1e-7,
            norm: VelocityNorm::default(),
            iterations: 50,
            solver: InnerSolver::default(),
        }
    }
}

impl NewmarkOptions {
    fn check(&self) -> Result<()> {
        let within = |parameter, value: f64, allowed, is: bool| {
            if is {
                Ok(())
            } else {
                Err(PericlesError::SchemeParameter {
                    parameter,
                    value,
                    allowed,
                })
            }
        };
        let Self {
            beta,
            gamma,
            tolerance,
            iterations,
            solver,
            ..
        } = *self;
        within("β", beta, "0 to 0.5", (0.0..=0.5).contains(&beta))?;
        within("γ", gamma, "0.5 to 1", (0.5..=1.0).contains(&gamma))?;
        within(
            "the tolerance of the inner iteration",
            tolerance,
            "a positive velocity, m/s",
            tolerance > 0.0 && tolerance.is_finite(),
        )?;
        within(
            "the number of inner iterations",
            f64::from(iterations),
            "at least 1",
            iterations > 0,
        )?;
        match solver {
            InnerSolver::Anderson { depth } => within(
                "the depth of Anderson acceleration",
                f64::from(depth),
                "1 to 8",
                (1..=8).contains(&depth),
            ),
            InnerSolver::NewtonKrylov => within(
                "β with Newton's method",
                beta,
                "above 0, up to 0.5",
                beta > 0.0,
            ),
            InnerSolver::FixedPoint => Ok(()),
        }
    }

    /// Largest ω dt at which the scheme is stable if its equation is solved exactly (Hughes 1987, table 9.1.1);
    /// `None` if any step is stable.
    fn stable(&self) -> Option<f64> {
        let excess = 0.5 * self.gamma - self.beta;
        (excess > 0.0).then(|| 1.0 / excess.sqrt())
    }
}

/// Statistics of inner iterations.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct InnerIterations {
    /// Number of iterations of the last step.
    pub last: u64,
    /// Last change of the velocity, m/s in the norm of the scheme; for adaptive dynamic relaxation the relative
    /// residual.
    pub change: f64,
    /// Largest number of iterations of a step.
    pub most: u64,
    /// Number of iterations of all steps.
    pub total: u64,
}

impl InnerIterations {
    pub(in crate::time) fn count(&mut self, iterations: u64, change: f64) {
        self.last = iterations;
        self.change = change;
        self.most = self.most.max(iterations);
        // A checkpoint may contain any number.
        self.total = self.total.saturating_add(iterations);
    }
}

crate::saved! {
    impl Checkpointed for InnerIterations {
        last, most, total: array("inner/iterations"),
        change: array("inner/change"),
    }
}
