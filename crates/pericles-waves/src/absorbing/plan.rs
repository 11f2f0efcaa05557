//! Choice of the kernels and the history of an absorbing boundary.

use super::history::{
    BlockedHistory, DirectHistory, ExponentialHistory, History, HistoryCost, HistoryForm,
    history_distance,
};
use super::{
    AbsorbingError, ExponentialKernels, GhostKernels, LatticeScheme, LatticeStencil, LatticeStep,
    cached_kernels, green_functions, green_functions_closed, semi_discrete_kernels,
    trapezoidal_kernels,
};
use pericles::cache::Cache;
use pericles::sum::max_norm;

/// Lattice that the boundary represents.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum KernelMethod {
    /// The lattice integrated by the scheme of the body: exact for the scheme.
    #[default]
    Discrete,
    /// The lattice in continuous time, by the trapezoidal rule: second order, as in the paper.
    SemiDiscrete,
    /// As `SemiDiscrete`, with the closed chain of the paper: its errors grow.
    Historical,
}

impl KernelMethod {
    /// Name in decks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Discrete => "discrete",
            Self::SemiDiscrete => "semi-discrete",
            Self::Historical => "historical",
        }
    }
}

/// Requested kernels and history.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AbsorbingBoundaryPlan {
    /// Method for the kernels.
    pub method: KernelMethod,
    /// Form of the history; `None` for the cheapest by [`HistoryCost`], which is an exact form unless a tolerance
    /// is given.
    pub form: Option<HistoryForm>,
    /// Allowed error of a ghost displacement, relative to displacements; [`AbsorbingBoundaryPlan::TOLERANCE`] if exponentials are
    /// requested without one.
    pub tolerance: Option<f64>,
    /// Compare the exponentials with the exact kernels.
    pub verify: bool,
}

/// Properties of the created history.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndReport {
    /// Method of the kernels.
    pub method: KernelMethod,
    /// Name of the history.
    pub history: &'static str,
    /// Memory of the history, bytes.
    pub bytes: usize,
    /// Number of exponentials; `None` for exact forms.
    pub exponentials: Option<usize>,
    /// Error of the exponentials at the samples of the fit.
    pub residual: Option<f64>,
    /// Difference from the exact kernels ([`history_distance`]), if requested.
    pub distance: Option<f64>,
    /// Error of the Green functions of the historical method in this run, relative to their largest value.
    pub growth: Option<f64>,
}

impl AbsorbingBoundaryPlan {
    /// Default tolerance of a fit.
    pub const TOLERANCE: f64 = 1e-9;

    /// Returns true if only exponentials are acceptable, whose memory does not grow with the number of steps;
    /// comparing them with exact kernels does need such memory.
    pub fn forgets(&self) -> bool {
        self.form == Some(HistoryForm::Exponentials) && !self.verify
    }

    /// Creates the history of a boundary for N steps of a scheme; exact kernels are cached. If a fit is tried only
    /// because it would be cheaper and misses the tolerance, the blocked form is used.
    ///
    /// # Errors
    /// [`AbsorbingError::Fit`] and [`AbsorbingError::Tolerance`] if exponentials are requested, or if they are
    /// verified and differ from the exact kernels by more than ten times the tolerance.
    /// [`AbsorbingError::VerletOnly`] for continuous-time kernels with another scheme.
    pub fn history(
        &self,
        stencil: &LatticeStencil,
        step: LatticeStep,
        steps: usize,
        cache: &dyn Cache,
    ) -> Result<(Box<dyn History>, EndReport), AbsorbingError> {
        if self.method != KernelMethod::Discrete && step.scheme != LatticeScheme::VelocityVerlet {
            let what = self.method.name();
            return Err(AbsorbingError::VerletOnly { what });
        }
        let form = self.form.unwrap_or_else(|| {
            let exact = self.tolerance.is_none() || self.method != KernelMethod::Discrete;
            HistoryCost::estimate(stencil, step, steps).cheapest(exact)
        });
        if form == HistoryForm::Exponentials {
            match self.exponentials(stencil, step, steps, cache) {
                Err(AbsorbingError::Fit { .. } | AbsorbingError::FitTooLong { .. })
                    if self.form.is_none() => {}
                made => return made,
            }
        }
        let (kernels, growth) = self.kernels(stencil, step, steps, cache);
        let history: Box<dyn History> = match form {
            HistoryForm::Direct => Box::new(DirectHistory::new(kernels)),
            _ => Box::new(BlockedHistory::new(kernels)),
        };
        let report = EndReport {
            method: self.method,
            history: history.name(),
            bytes: history.bytes(),
            exponentials: None,
            residual: None,
            distance: None,
            growth,
        };
        Ok((history, report))
    }

    fn kernels(
        &self,
        stencil: &LatticeStencil,
        step: LatticeStep,
        steps: usize,
        cache: &dyn Cache,
    ) -> (GhostKernels, Option<f64>) {
        let dt = step.dt;
        match self.method {
            KernelMethod::Discrete => (cached_kernels(stencil, step, steps, cache), None),
            KernelMethod::SemiDiscrete => (semi_discrete_kernels(stencil, dt, steps), None),
            KernelMethod::Historical => {
                let closed = green_functions_closed(stencil, dt, steps);
                let growth = growth(stencil, dt, &closed);
                (trapezoidal_kernels(stencil, dt, &closed), Some(growth))
            }
        }
    }

    fn exponentials(
        &self,
        stencil: &LatticeStencil,
        step: LatticeStep,
        steps: usize,
        cache: &dyn Cache,
    ) -> Result<(Box<dyn History>, EndReport), AbsorbingError> {
        let tolerance = self.tolerance.unwrap_or(Self::TOLERANCE);
        let fit = ExponentialKernels::fit(stencil, step, steps, tolerance)?;
        let (terms, residual) = (fit.terms(), fit.residual);
        let mut history = ExponentialHistory::new(fit);
        let mut distance = None;
        if self.verify {
            let mut exact = BlockedHistory::new(cached_kernels(stencil, step, steps, cache));
            let apart = history_distance([&mut history, &mut exact], stencil.reach(), steps);
            // The sum over time of an error whose spectrum is within the tolerance.
            if apart.is_nan() || apart > 10.0 * tolerance {
                return Err(AbsorbingError::Fit {
                    tolerance,
                    residual: apart,
                    fits: 1,
                });
            }
            distance = Some(apart);
        }
        let report = EndReport {
            method: self.method,
            history: history.name(),
            bytes: history.bytes(),
            exponentials: Some(terms),
            residual: Some(residual),
            distance,
            growth: None,
        };
        Ok((Box::new(history), report))
    }
}

/// Largest error of the closed chain's Green functions at the last step, relative to the largest value of all.
fn growth(stencil: &LatticeStencil, dt: f64, closed: &[Vec<f64>]) -> f64 {
    let steps = closed[0].len() - 1;
    let exact = green_functions(stencil, dt, steps, closed.len());
    let largest = max_norm(exact.iter().flatten());
    let last = exact
        .iter()
        .zip(closed)
        .map(|(a, b)| (a[steps] - b[steps]).abs());
    let worst = last.fold(0.0, |a: f64, x| if x > a || x.is_nan() { x } else { a });
    worst / largest
}
