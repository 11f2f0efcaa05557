//! The method of conjugate gradients.

use super::{SolveLimits, Solved, Work, add_scaled};
use crate::domain::Domain;
use crate::error::{PericlesError, Result};

/// Solves A x = b for a symmetric positive definite A given by its products `apply(x, out)`, starting from the
/// given `x`.
///
/// The limits compare ‖b − A x‖₂ with ‖b‖₂. At the end the true residual is computed and returned, not the
/// recursive one.
///
/// # Errors
/// [`PericlesError::NotConverged`] after too many iterations, or for a direction of negative curvature, which shows
/// that A is not positive definite; [`PericlesError::Interrupted`] if a stop is requested.
pub fn conjugate_gradient(
    apply: &mut dyn FnMut(&[f64], &mut [f64]),
    right: &[f64],
    x: &mut [f64],
    limits: &SolveLimits<'_>,
    work: &mut Work,
) -> Result<Solved> {
    let tolerance = limits.tolerance(work.domain.norm(right));
    let mut solved = Solved::default();
    // The recursive residual drifts from the true one by rounding; a restart from the true residual removes the
    // drift.
    loop {
        let before = solved.residual;
        let end = sweep(
            apply,
            right,
            x,
            tolerance,
            limits,
            (&work.domain, &mut work.krylov),
            &mut solved,
        )?;
        let stuck = solved.iterations >= limits.iterations
            || before > 0.0 && solved.residual > 0.5 * before;
        match end {
            End::Reached => return Ok(solved),
            End::Drifted if !stuck => {}
            End::Drifted | End::Exhausted => {
                return Err(PericlesError::NotConverged {
                    solver: "conjugate gradients",
                    iterations: solved.iterations,
                    residual: solved.residual,
                    tolerance,
                    cause: "rounding or too few iterations",
                });
            }
            End::Indefinite => {
                return Err(PericlesError::NotConverged {
                    solver: "conjugate gradients",
                    iterations: solved.iterations,
                    residual: solved.residual,
                    tolerance,
                    cause: "the matrix is not positive definite",
                });
            }
        }
    }
}

pub(super) enum End {
    /// The true residual meets the tolerance.
    Reached,
    /// The recursive residual meets it, the true one does not.
    Drifted,
    /// Too many iterations.
    Exhausted,
    /// A direction without positive curvature; `x` is the iterate before it.
    Indefinite,
}

/// Iterates from `x` until the recursive residual meets the tolerance.
pub(super) fn sweep(
    apply: &mut dyn FnMut(&[f64], &mut [f64]),
    right: &[f64],
    x: &mut [f64],
    tolerance: f64,
    limits: &SolveLimits<'_>,
    (domain, [residual, direction, product]): (&Domain, &mut [Vec<f64>; 3]),
    solved: &mut Solved,
) -> Result<End> {
    true_residual(apply, right, x, residual, product, solved);
    solved.residual = domain.norm(residual);
    if solved.residual <= tolerance {
        return Ok(End::Reached);
    }
    direction.copy_from_slice(residual);
    let mut squared = solved.residual * solved.residual;
    while solved.iterations < limits.iterations {
        limits.interrupt.poll()?;
        apply(direction, product);
        solved.products += 1;
        solved.iterations += 1;
        let curvature = domain.dot(direction, product);
        if curvature.is_nan() || curvature <= 0.0 {
            return Ok(End::Indefinite);
        }
        let length = squared / curvature;
        add_scaled(x, length, direction);
        add_scaled(residual, -length, product);
        let next = domain.dot(residual, residual);
        if next.sqrt() <= tolerance {
            true_residual(apply, right, x, residual, product, solved);
            solved.residual = domain.norm(residual);
            return Ok(if solved.residual <= tolerance {
                End::Reached
            } else {
                End::Drifted
            });
        }
        let ratio = next / squared;
        squared = next;
        for (d, r) in direction.iter_mut().zip(&*residual) {
            *d = r + ratio * *d;
        }
    }
    solved.residual = squared.sqrt();
    Ok(End::Exhausted)
}

fn true_residual(
    apply: &mut dyn FnMut(&[f64], &mut [f64]),
    right: &[f64],
    x: &[f64],
    residual: &mut [f64],
    product: &mut [f64],
    solved: &mut Solved,
) {
    apply(x, product);
    solved.products += 1;
    for ((r, b), p) in residual.iter_mut().zip(right).zip(&*product) {
        *r = b - p;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix with eigenvalues 1, 2, …, n in a basis given by reflections.
    fn product(x: &[f64], out: &mut [f64], shift: f64) {
        let n = x.len();
        let normal: Vec<f64> = (0..n).map(|i| ((i as f64) * 0.7).sin()).collect();
        let square: f64 = normal.iter().map(|a| a * a).sum();
        let reflect = |x: &mut [f64]| {
            let along: f64 = x.iter().zip(&normal).map(|(x, a)| x * a).sum();
            for (x, a) in x.iter_mut().zip(&normal) {
                *x -= 2.0 * along / square * a;
            }
        };
        let mut y = x.to_vec();
        reflect(&mut y);
        for (k, y) in y.iter_mut().enumerate() {
            *y *= k as f64 + shift;
        }
        reflect(&mut y);
        out.copy_from_slice(&y);
    }

    #[test]
    fn conjugate_gradients_need_at_most_as_many_iterations_as_eigenvalues() {
        let n = 12;
        let exact: Vec<f64> = (0..n).map(|i| (i as f64).cos()).collect();
        let mut right = vec![0.0; n];
        product(&exact, &mut right, 1.0);
        let mut x = vec![0.0; n];
        let mut apply = |x: &[f64], out: &mut [f64]| product(x, out, 1.0);
        let solved = conjugate_gradient(
            &mut apply,
            &right,
            &mut x,
            &SolveLimits::default(),
            &mut Work::new(n),
        )
        .unwrap();
        assert!(solved.iterations <= n + 1, "{solved:?}");
        for (x, exact) in x.iter().zip(&exact) {
            assert!((x - exact).abs() < 1e-11);
        }
        // Starting from the solution no iteration is needed.
        let again = conjugate_gradient(
            &mut apply,
            &right,
            &mut x,
            &SolveLimits::default(),
            &mut Work::new(n),
        )
        .unwrap();
        assert_eq!(again.iterations, 0);
    }

    #[test]
    fn an_indefinite_matrix_and_too_few_iterations_are_errors() {
        let n = 12;
        let mut x = vec![0.0; n];
        let right = vec![1.0; n];
        let mut indefinite = |x: &[f64], out: &mut [f64]| product(x, out, -5.5);
        let error = conjugate_gradient(
            &mut indefinite,
            &right,
            &mut x,
            &SolveLimits::default(),
            &mut Work::new(n),
        )
        .unwrap_err();
        assert!(
            error.to_string().contains("not positive definite"),
            "{error}"
        );
        let few = SolveLimits {
            iterations: 3,
            ..SolveLimits::default()
        };
        let mut definite = |x: &[f64], out: &mut [f64]| product(x, out, 1.0);
        let error =
            conjugate_gradient(&mut definite, &right, &mut x, &few, &mut Work::new(n)).unwrap_err();
        assert!(
            matches!(error, PericlesError::NotConverged { iterations: 3, .. }),
            "{error}"
        );
    }
}
