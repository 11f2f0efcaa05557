//! Time stepping of the lattice beyond an absorbing boundary.

use nalgebra::Complex;
use pericles::StepKind;

use super::roots::factor_at;
use super::{AbsorbingError, LatticeStencil};

/// Linear time integrator with a known symbol: its approximation of ∂²/∂t² in terms of the delay w of one step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LatticeScheme {
    /// σ(w) = (1/w − 2 + w)/dt²; kernels start at lag one.
    VelocityVerlet,
    /// σ(w) = (4/dt²) ((1 − w)/(1 + w))², of the implicit midpoint rule and, for linear exteriors, of the
    /// trapezoidal rule. Kernels act on the displacements at the middle of steps, including the current one.
    Midpoint,
}

impl LatticeScheme {
    /// Kinds of steps whose symbol is known.
    pub const KINDS: &'static [StepKind] = &[StepKind::EndOfStep, StepKind::Middle];

    /// Returns the scheme of a kind of step; `None` for kinds that absorbing boundaries do not support.
    pub fn of(kind: StepKind) -> Option<Self> {
        match kind {
            StepKind::EndOfStep => Some(Self::VelocityVerlet),
            StepKind::Middle => Some(Self::Midpoint),
            StepKind::Flow | StepKind::Stages | StepKind::Kicks => None,
        }
    }
}

/// Scheme and time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LatticeStep {
    /// The scheme.
    pub scheme: LatticeScheme,
    /// Time step, s.
    pub dt: f64,
}

impl LatticeStep {
    /// Creates a step of velocity Verlet.
    pub fn verlet(dt: f64) -> Self {
        let scheme = LatticeScheme::VelocityVerlet;
        Self { scheme, dt }
    }

    /// Creates a step of the midpoint rule.
    pub fn midpoint(dt: f64) -> Self {
        let scheme = LatticeScheme::Midpoint;
        Self { scheme, dt }
    }

    /// Checks that the lattice is stable with this step.
    ///
    /// # Errors
    /// A time step that is not positive and finite; for velocity Verlet dt max ω ≥ 2.
    pub fn check(self, stencil: &LatticeStencil) -> Result<(), AbsorbingError> {
        match self.scheme {
            LatticeScheme::VelocityVerlet => stencil.check_step(self.dt),
            LatticeScheme::Midpoint if self.dt > 0.0 && self.dt.is_finite() => Ok(()),
            LatticeScheme::Midpoint => Err(AbsorbingError::BadStep { dt: self.dt }),
        }
    }

    /// Symbol σ(w), 1/s².
    pub(super) fn symbol(self, w: Complex<f64>) -> Complex<f64> {
        let one = Complex::new(1.0, 0.0);
        // Differences first, to avoid cancellation near w = 1.
        match self.scheme {
            LatticeScheme::VelocityVerlet => (one - w) * (one - w) / (w * (self.dt * self.dt)),
            LatticeScheme::Midpoint => {
                let ratio = (one - w) / (one + w) * (2.0 / self.dt);
                ratio * ratio
            }
        }
    }

    /// Phase of a step at which the symbol equals −ω².
    pub(super) fn phase(self, omega: f64) -> f64 {
        let half = 0.5 * omega * self.dt;
        match self.scheme {
            LatticeScheme::VelocityVerlet => 2.0 * half.min(1.0).asin(),
            LatticeScheme::Midpoint => 2.0 * half.atan(),
        }
    }

    /// Dependence of the ghosts on displacements of the same step: h_1 … h_K at w = 0.
    pub(super) fn present(self, stencil: &LatticeStencil) -> Vec<f64> {
        match self.scheme {
            LatticeScheme::VelocityVerlet => vec![0.0; stencil.reach()],
            LatticeScheme::Midpoint => {
                let sigma = self.symbol(Complex::new(0.0, 0.0));
                factor_at(stencil, sigma).iter().map(|h| h.re).collect()
            }
        }
    }
}
