//! The kernels and the history of an end, as asked for.

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

/// Which lattice the ends stand for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum KernelMethod {
    /// That stepped as the body is: exact for the scheme.
    #[default]
    Discrete,
    /// That in continuous time, by the trapezoidal rule: second order, the paper's.
    SemiDiscrete,
    /// The same with the paper's closed chain: its errors grow.
    Historical,
}

impl KernelMethod {
    /// As in decks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Discrete => "discrete",
            Self::SemiDiscrete => "semi-discrete",
            Self::Historical => "historical",
        }
    }
}

/// What an end is to be made of.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EndPlan {
    /// The kernels.
    pub method: KernelMethod,
    /// The form of the history; none for the cheapest by [`HistoryCost`], which is one of the exact forms unless a tolerance is given.
    pub form: Option<HistoryForm>,
    /// Allowed error of a ghost's displacement, relative to displacements; [`EndPlan::TOLERANCE`] where exponentials are asked for without.
    pub tolerance: Option<f64>,
    /// Whether the exponentials are compared with the exact kernels.
    pub verify: bool,
}

/// What was made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EndReport {
    /// Kernels.
    pub method: KernelMethod,
    /// The history's name.
    pub history: &'static str,
    /// Its memory, bytes.
    pub bytes: usize,
    /// Number of exponentials; none for exact forms.
    pub exponentials: Option<usize>,
    /// Their error on the samples of the fit.
    pub residual: Option<f64>,
    /// Their distance from the exact kernels ([`history_distance`]), if it was asked for.
    pub distance: Option<f64>,
    /// The error of the Green functions that the historical method makes in this run, relative to their largest.
    pub growth: Option<f64>,
}

impl EndPlan {
    /// Of a fit that no tolerance is given for.
    pub const TOLERANCE: f64 = 1e-9;

    /// Whether only exponentials will do, whose memory does not grow with the steps; where they are compared with exact kernels, it does.
    pub fn forgets(&self) -> bool {
        self.form == Some(HistoryForm::Exponentials) && !self.verify
    }

    /// Makes the history of an end for N steps of a scheme; exact kernels come from the cache. A fit that is tried because it would be cheaper gives way to blocks if it misses
    /// the tolerance.
    ///
    /// # Errors
    /// [`AbsorbingError::Fit`] and [`AbsorbingError::Tolerance`] where exponentials are asked for, or where they are verified and farther from the exact kernels than ten
    /// times the tolerance. [`AbsorbingError::VerletOnly`] for continuous-time kernels with another scheme.
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
            // Sums over time of an error whose spectrum holds the tolerance.
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

/// The largest error of the closed chain's Green functions at the last step, relative to the largest value of all.
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
