//! Functions of the stiffness of a system, by the method that the options select.

use rayon::prelude::*;

use crate::function::{Chebyshev, Eigenvectors, Lanczos, MatrixFunction, Term};
use pericles::Interrupt;
use pericles::operator::FunctionOf;
use pericles::parallel::BLOCK;
use pericles::{PericlesError, Result};
use pericles::{PointScalar, System};

/// Method for functions of the stiffness (see [`crate::function`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FunctionMethod {
    /// Fourier if the operator is diagonal in plane waves and no point is constrained, otherwise Chebyshev.
    #[default]
    Fastest,
    /// Chebyshev series.
    Chebyshev,
    /// Plane waves.
    Fourier,
    /// Krylov spaces.
    Lanczos,
    /// All eigenvectors: a reference for small bodies.
    Eigenvectors,
}

impl FunctionMethod {
    /// All methods, the default first.
    pub const ALL: [Self; 5] = [
        Self::Fastest,
        Self::Chebyshev,
        Self::Fourier,
        Self::Lanczos,
        Self::Eigenvectors,
    ];

    /// Name in decks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fastest => "fastest",
            Self::Chebyshev => "chebyshev",
            Self::Fourier => "fourier",
            Self::Lanczos => "lanczos",
            Self::Eigenvectors => "eigenvectors",
        }
    }
}

pub(super) const NAME: &str = "trigonometric";

/// The functions of a system.
pub(super) enum Engine {
    Fourier(f64),
    Krylov(Box<dyn MatrixFunction>),
}

/// Creates the functions of the stiffness with the points that are constrained at time t.
pub(super) fn engine(
    (functions, regularisation): (FunctionMethod, f64),
    system: &System,
    reference: &[f64],
    t: f64,
) -> Result<Engine> {
    let diagonal = system
        .operator()
        .as_linear()
        .and_then(|linear| linear.as_diagonal());
    let uniform = match system.density() {
        PointScalar::Uniform(density) if diagonal.is_some() && system.motions().is_empty() => {
            Some(*density)
        }
        _ => None,
    };
    let bound = system
        .operator()
        .frequency_bound(&|i| system.density().at(i));
    if uniform.is_none() && !(bound > 0.0 && bound.is_finite()) {
        return Err(PericlesError::SchemeNotUsable {
            scheme: NAME,
            reason: "its forces have no linear part at rest (as on a surface with p > 2), which this scheme solves \
                exactly; use scheme = \"rk4\", \"newmark\" or \"discrete-gradient\"",
        });
    }
    Ok(match (functions, uniform) {
        (FunctionMethod::Fastest | FunctionMethod::Fourier, Some(density)) => {
            Engine::Fourier(density)
        }
        (FunctionMethod::Fourier, None) => {
            return Err(PericlesError::SchemeNotUsable {
                scheme: "trigonometric with Fourier functions",
                reason: "it needs bonds = \"spectral\" and no prescribed motion; functions = \"chebyshev\" supports \
                    any body",
            });
        }
        (FunctionMethod::Fastest | FunctionMethod::Chebyshev, _) => {
            let square = bound * bound + regularisation;
            Engine::Krylov(Box::new(Chebyshev::new(square, reference.len())))
        }
        (FunctionMethod::Lanczos, _) => Engine::Krylov(Box::new(Lanczos::new(system.masses()))),
        (FunctionMethod::Eigenvectors, _) => {
            // Constrained points exert no force, so that the matrix is symmetric.
            let mut free = vec![0.0; reference.len()];
            let mut shifted = |x: &[f64], out: &mut [f64]| {
                free.copy_from_slice(x);
                system.hold_at(t, &mut free);
                system.vibration_at(t, reference, &free, out);
                add(out, regularisation, x);
            };
            Engine::Krylov(Box::new(Eigenvectors::new(&mut shifted, &system.masses())?))
        }
    })
}

/// Adds functions of the stiffness applied to `x`, whose constrained entries are zero.
pub(super) fn apply(
    (engine, regularisation): (&mut Engine, f64),
    system: &System,
    (reference, t_next): (&[f64], f64),
    (x, mut terms): (&[f64], [Term<'_>; 2]),
    interrupt: Interrupt<'_>,
) -> Result<()> {
    match engine {
        Engine::Fourier(density) => {
            let linear = system.operator().as_linear();
            if let Some(diagonal) = linear.and_then(|linear| linear.as_diagonal()) {
                let values = terms.each_ref().map(|term| {
                    let (function, tau, factor) = (term.function, term.tau, term.factor);
                    move |square: f64| factor * function.value(tau, square)
                });
                let mut functions: Vec<_> = terms
                    .iter_mut()
                    .zip(&values)
                    .map(|(term, value)| FunctionOf {
                        value,
                        out: &mut *term.out,
                    })
                    .collect();
                diagonal.add_functions(*density, regularisation, x, &mut functions);
            }
            Ok(())
        }
        Engine::Krylov(engine) => {
            let mut product = |x: &[f64], out: &mut [f64]| {
                system.vibration_at(t_next, reference, x, out);
                if regularisation > 0.0 {
                    add(out, regularisation, x);
                }
            };
            engine.add(&mut product, x, &mut terms, interrupt)
        }
    }
}

/// y += factor x.
pub(super) fn add(y: &mut [f64], factor: f64, x: &[f64]) {
    y.par_chunks_mut(BLOCK)
        .zip(x.par_chunks(BLOCK))
        .for_each(|(y, x)| y.iter_mut().zip(x).for_each(|(y, x)| *y += factor * x));
}

pub(super) fn subtract(y: &mut [f64], x: &[f64]) {
    add(y, -1.0, x);
}
