//! Functions of an operator by its eigenvectors: the reference.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

use super::{MatrixFunction, Product, Term};
use pericles::Interrupt;
use pericles::{PericlesError, Result};

/// Computes g(A) x from all eigenvectors of the matrix, which is symmetric in the inner product Σ m_i x_i y_i.
///
/// O(n³) time and O(n²) memory once, O(n²) per application: for checks, and for bodies of some hundred points that
/// take very many steps.
pub struct Eigenvectors {
    /// m^½.
    root_mass: Vec<f64>,
    values: DVector<f64>,
    vectors: DMatrix<f64>,
}

/// Largest number of entries; beyond it the matrix exceeds a gigabyte.
const MOST: usize = 10_000;

impl Eigenvectors {
    /// Computes the eigenvectors of x ↦ A x from the mass of every entry.
    ///
    /// # Errors
    /// More than ten thousand entries.
    pub fn new(apply: &mut Product<'_>, mass: &[f64]) -> Result<Self> {
        let n = mass.len();
        if n > MOST {
            return Err(PericlesError::OutOfRange {
                quantity: "the number of unknowns for all eigenvectors of a body",
                value: n as f64,
                allowed: "at most 10000; functions = \"chebyshev\" has no limit",
            });
        }
        let root_mass: Vec<f64> = mass.iter().map(|m| m.sqrt()).collect();
        let mut matrix = DMatrix::zeros(n, n);
        let (mut unit, mut column) = (vec![0.0; n], vec![0.0; n]);
        for j in 0..n {
            unit[j] = 1.0;
            apply(&unit, &mut column);
            unit[j] = 0.0;
            for i in 0..n {
                matrix[(i, j)] = root_mass[i] * column[i] / root_mass[j];
            }
        }
        // Removes asymmetry due to round-off.
        let symmetric = 0.5 * (&matrix + matrix.transpose());
        let SymmetricEigen {
            eigenvalues: values,
            eigenvectors: vectors,
        } = SymmetricEigen::new(symmetric);
        Ok(Self {
            root_mass,
            values,
            vectors,
        })
    }

    /// Largest eigenvalue, 1/s².
    pub fn largest(&self) -> f64 {
        self.values.max()
    }
}

impl MatrixFunction for Eigenvectors {
    fn add(
        &mut self,
        _apply: &mut Product<'_>,
        x: &[f64],
        terms: &mut [Term<'_>],
        _interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let scaled = DVector::from_iterator(
            x.len(),
            x.iter().zip(&self.root_mass).map(|(x, root)| x * root),
        );
        let modes = self.vectors.tr_mul(&scaled);
        for term in terms {
            let swung = DVector::from_iterator(
                x.len(),
                modes
                    .iter()
                    .zip(&self.values)
                    .map(|(mode, square)| term.value(*square) * mode),
            );
            let result = &self.vectors * swung;
            for ((out, value), root) in term.out.iter_mut().zip(&result).zip(&self.root_mass) {
                *out += value / root;
            }
        }
        Ok(())
    }
}
