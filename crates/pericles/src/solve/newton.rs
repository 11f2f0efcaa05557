//! Newton's method with conjugate gradients (Newton–Krylov).

use super::conjugate_gradient::{End, sweep};
use super::{SolveLimits, Solved, Work, add_scaled};
use crate::error::{PericlesError, Result};

/// A nonlinear system F(x) = 0 with symmetric positive definite derivative.
pub trait Nonlinear {
    /// Computes `out` = F(x).
    fn residual_into(&mut self, x: &[f64], out: &mut [f64]);
    /// Computes `out` = F′(x) direction.
    fn derivative_into(&mut self, x: &[f64], direction: &[f64], out: &mut [f64]);
    /// Sets `out` to errors of x that change F(x) as much as the rounding errors of its evaluation do, for example those of the
    /// positions from which F is computed; zero if the given tolerance is above rounding.
    fn rounding_into(&mut self, x: &[f64], out: &mut [f64]) {
        let _ = x;
        out.fill(0.0);
    }
}

/// Largest number of conjugate-gradient iterations per Newton step.
const INNER: usize = 400;
/// Largest number of halvings of a step that does not reduce the residual.
const HALVINGS: usize = 12;
/// Residual accepted where it does not decrease, relative to the effect of rounding errors.
const AT_ROUNDING: f64 = 16.0;

/// Solves F(x) = 0 starting from the given `x`: x ← x − λ F′(x)⁻¹ F(x). Conjugate gradients solve the linear system
/// to a tolerance that tightens as Newton's method converges (Eisenstat & Walker, choice 2 with γ = 0.9 and
/// exponent 2); λ is halved until ‖F‖ decreases.
///
/// The limits compare ‖F(x)‖₂ with `scale`, the size of the terms whose difference is F. A residual that no longer decreases
/// is accepted if it consists of the rounding errors of F ([`Nonlinear::rounding_into`]).
///
/// # Errors
/// [`PericlesError::NotConverged`] if the residual stagnates or after too many iterations; `x` is then the best
/// iterate. [`PericlesError::Interrupted`] if a stop is requested.
pub fn newton_krylov(
    problem: &mut dyn Nonlinear,
    x: &mut [f64],
    scale: f64,
    limits: &SolveLimits<'_>,
    work: &mut Work,
) -> Result<Solved> {
    let Work {
        domain,
        krylov,
        newton,
    } = work;
    let [residual, right, correction, trial] = newton;
    let tolerance = limits.tolerance(scale);
    let mut solved = Solved::default();
    problem.residual_into(x, residual);
    solved.residual = domain.norm(residual);
    let mut forcing: f64 = 0.1;
    let failed = |solved: Solved, cause| PericlesError::NotConverged {
        solver: "Newton's method",
        iterations: solved.iterations,
        residual: solved.residual,
        tolerance,
        cause,
    };
    let cause = loop {
        if solved.residual <= tolerance {
            return Ok(solved);
        }
        if solved.iterations == limits.iterations {
            break "too few iterations";
        }
        limits.interrupt.poll()?;
        solved.iterations += 1;
        for (b, r) in right.iter_mut().zip(&*residual) {
            *b = -r;
        }
        correction.fill(0.0);
        // Not tighter than the outer iteration needs.
        let inner_tolerance = (forcing * solved.residual).max(0.1 * tolerance);
        let inner = SolveLimits {
            iterations: INNER,
            ..*limits
        };
        let mut counted = Solved::default();
        let mut apply = |d: &[f64], out: &mut [f64]| problem.derivative_into(x, d, out);
        let end = sweep(
            &mut apply,
            right,
            correction,
            inner_tolerance,
            &inner,
            (&*domain, krylov),
            &mut counted,
        )?;
        solved.products += counted.products;
        if matches!(end, End::Indefinite) && counted.iterations == 1 {
            break "the derivative is not positive definite";
        }
        let before = solved.residual;
        let mut length = 1.0;
        let mut halvings = 0;
        let stagnates = loop {
            trial.copy_from_slice(x);
            add_scaled(trial, length, correction);
            limits.interrupt.poll()?;
            problem.residual_into(trial, residual);
            solved.residual = domain.norm(residual);
            if solved.residual < before * (1.0 - 1e-4 * length) {
                x.copy_from_slice(trial);
                break false;
            }
            halvings += 1;
            if halvings > HALVINGS {
                solved.residual = before;
                break true;
            }
            length *= 0.5;
        };
        if stagnates {
            break "the residual stagnates: the tolerance is below rounding, or the step is too large";
        }
        let ratio = solved.residual / before;
        let safeguard = 0.9 * forcing * forcing;
        forcing = (0.9 * ratio * ratio).min(0.1);
        if safeguard > 0.1 {
            forcing = forcing.max(safeguard);
        }
    };
    problem.rounding_into(x, trial);
    problem.derivative_into(x, trial, right);
    match solved.residual <= AT_ROUNDING * domain.norm(right) {
        true => Ok(solved),
        false => Err(failed(solved, cause)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x_i + x_i³ + coupling (2 x_i − x_{i−1} − x_{i+1}) = b_i
    struct Chain {
        right: Vec<f64>,
        coupling: f64,
        cubic: f64,
    }

    impl Chain {
        fn coupled(&self, x: &[f64], i: usize) -> f64 {
            let at = |k: usize| x.get(k).copied().unwrap_or(0.0);
            self.coupling * (2.0 * x[i] - at(i.wrapping_sub(1)) - at(i + 1))
        }
    }

    impl Nonlinear for Chain {
        fn residual_into(&mut self, x: &[f64], out: &mut [f64]) {
            for i in 0..x.len() {
                out[i] = x[i] + self.cubic * x[i].powi(3) + self.coupled(x, i) - self.right[i];
            }
        }
        fn derivative_into(&mut self, x: &[f64], d: &[f64], out: &mut [f64]) {
            for i in 0..x.len() {
                out[i] = (1.0 + 3.0 * self.cubic * x[i] * x[i]) * d[i] + self.coupled(d, i);
            }
        }
    }

    #[test]
    fn newton_converges_quickly_to_the_root() {
        let n = 40;
        let exact: Vec<f64> = (0..n).map(|i| 2.0 * (0.3 * i as f64).sin()).collect();
        let mut chain = Chain {
            right: vec![0.0; n],
            coupling: 3.0,
            cubic: 1.0,
        };
        let mut right = vec![0.0; n];
        chain.residual_into(&exact, &mut right);
        let scale = crate::domain::Domain::alone(right.len()).norm(&right);
        chain.right = right;
        let mut x = vec![0.0; n];
        let solved = newton_krylov(
            &mut chain,
            &mut x,
            scale,
            &SolveLimits::default(),
            &mut Work::new(n),
        )
        .unwrap();
        assert!(solved.iterations <= 10, "{solved:?}");
        for (x, exact) in x.iter().zip(&exact) {
            assert!((x - exact).abs() < 1e-11);
        }
    }

    #[test]
    fn a_system_without_a_root_is_an_error() {
        // x − x³ has its largest value at x = 1/√3, 0.385
        let mut chain = Chain {
            right: vec![0.5],
            coupling: 0.0,
            cubic: -1.0,
        };
        let mut x = vec![0.0];
        let error = newton_krylov(
            &mut chain,
            &mut x,
            1.0,
            &SolveLimits::default(),
            &mut Work::new(1),
        )
        .unwrap_err();
        assert!(
            matches!(error, PericlesError::NotConverged { .. }),
            "{error}"
        );
        assert!(x[0].is_finite());
    }
}
