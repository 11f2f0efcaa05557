//! Newmark's method, its inner iterations, and a scheme that conserves energy whatever the forces are.
//!
//! With vP = v + (1−γ) dt a and uP = u + dt v + (1/2−β) dt² a a step of Newmark's method (1959) solves
//!
//! > a′ = (f(u′) + b(t′))/ρ,  u′ = uP + β dt² a′,  v′ = vP + γ dt a′.
//!
//! | inner solver | a step costs | converges for |
//! |---|---|---|
//! | [`InnerSolver::FixedPoint`], the P-(EC)^k form | k force evaluations | ω dt < 1/√β: no more than an explicit scheme |
//! | [`InnerSolver::Anderson`] | as many, fewer near the limit; 2 · depth more vectors | somewhat larger steps, not guaranteed |
//! | [`InnerSolver::NewtonKrylov`] | products with the tangent | any step, if the tangent is negative semi-definite |
//!
//! β = 1/4, γ = 1/2 is the trapezoidal rule: second order, no dissipation, stable for any step once the equation is solved. For γ = 1/2 and linear forces
//! ½ v·Mv + ½ u·Ku + (β − 1/4) dt²/2 a·Ma is conserved (Hughes 1987, section 9.1.2).
//!
//! [`DiscreteGradient`] conserves energy for any elastic forces, for any step where the elastic energy is convex.

mod anderson;
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

/// How the equation of a step is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum InnerSolver {
    /// Evaluate and correct until the velocity stays: P-(EC)^k.
    #[default]
    FixedPoint,
    /// The same, accelerated from the last `depth` corrections (Anderson 1965; Walker & Ni 2011).
    Anderson {
        /// Corrections remembered, 1 to 8.
        depth: u32,
    },
    /// Newton's method with conjugate gradients.
    NewtonKrylov,
}

impl InnerSolver {
    /// The scheme with this solver, in messages.
    fn scheme(self) -> &'static str {
        match self {
            Self::FixedPoint | Self::Anderson { .. } => "newmark",
            Self::NewtonKrylov => "newmark with Newton's method",
        }
    }

    /// Where within a step the scheme takes the forces. Newton's method solves for displacements, so that what depends on velocities acts between the steps.
    pub const fn step_kind(self) -> StepKind {
        match self {
            Self::FixedPoint | Self::Anderson { .. } => StepKind::Stages,
            Self::NewtonKrylov => StepKind::Kicks,
        }
    }

    /// What the scheme with this solver needs of a system.
    pub const fn requirements(self) -> &'static [Requirement] {
        match self {
            Self::FixedPoint | Self::Anderson { .. } => &[Requirement::IN_DOUBLES],
            Self::NewtonKrylov => &[
                Requirement::IN_DOUBLES,
                Requirement {
                    need: Need::NoMemory,
                    reason: "its equation has forces by displacements only, none of boundaries with a memory; use velocity-verlet",
                },
            ],
        }
    }
}

/// In which norm the change of the velocity (m/s) is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum VelocityNorm {
    /// √(Σ |Δv_i|²) over all points.
    #[default]
    Sum,
    /// √(Σ V_i |Δv_i|²).
    Weighted,
    /// The largest component.
    Largest,
}

impl VelocityNorm {
    /// As written in decks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sum => "l2",
            Self::Weighted => "area-weighted",
            Self::Largest => "max",
        }
    }

    /// The norm of `factor` times a component-major vector.
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
    /// γ, 1/2 to 1: above 1/2 the scheme is of first order and dissipates.
    pub gamma: f64,
    /// The inner iteration ends when the velocity changes by no more than this, m/s in the chosen norm.
    pub tolerance: f64,
    /// That norm.
    pub norm: VelocityNorm,
    /// Inner iterations after which the step fails.
    pub iterations: u32,
    /// How the equation of a step is solved.
    pub solver: InnerSolver,
}

impl Default for NewmarkOptions {
    /// The trapezoidal rule to 1e-7 m/s in at most 50 iterations.
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
            "the tolerance",
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
                "Anderson's depth",
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

    /// The largest ω dt at which the scheme itself is stable, its equation solved exactly (Hughes 1987, table 9.1.1); none if any is.
    fn stable(&self) -> Option<f64> {
        let excess = 0.5 * self.gamma - self.beta;
        (excess > 0.0).then(|| 1.0 / excess.sqrt())
    }
}

/// What the inner iterations of a scheme did.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct InnerIterations {
    /// Iterations of the last step.
    pub last: u64,
    /// The last change of the velocity, m/s in the scheme's norm; of relaxation the forces out of balance over those that act.
    pub change: f64,
    /// The most iterations a step took.
    pub most: u64,
    /// Iterations of all steps.
    pub total: u64,
}

impl InnerIterations {
    pub(in crate::time) fn count(&mut self, iterations: u64, change: f64) {
        self.last = iterations;
        self.change = change;
        self.most = self.most.max(iterations);
        // A checkpoint may hold any number.
        self.total = self.total.saturating_add(iterations);
    }
}

crate::saved! {
    impl Saved for InnerIterations {
        last, most, total: array("inner/iterations"),
        change: array("inner/change"),
    }
}
