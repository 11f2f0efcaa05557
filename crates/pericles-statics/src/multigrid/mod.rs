//! Smoothed-aggregation multigrid: an approximate inverse of a sparse symmetric positive definite matrix at a
//! cost proportional to its size.
//!
//! Neighbouring points are grouped into aggregates. Rigid-body motions, the displacements of low energy, are
//! represented exactly on each aggregate. One step of damped Jacobi iteration smooths them to the
//! prolongation P, and PᵀAP is the matrix of the next level, until it is small enough for a dense
//! factorisation. One application is a V-cycle with Chebyshev smoothing, which is symmetric and positive
//! definite and thus a valid preconditioner for conjugate gradients.
//!
//! Aggregates depend only on the order of the points and every sum has a fixed order, so that results do not
//! depend on the number of threads.
//!
//! References: Vaněk, Mandel & Brezina, Computing 56, 179 (1996); Adams, Brezina, Hu & Tuminaro, J. Comput.
//! Phys. 188, 593 (2003) for polynomial smoothing.

mod aggregate;
mod dense;
mod nodes;
mod smoother;
mod tentative;

pub use dense::DenseCholesky;
pub use nodes::NearKernel;

use crate::sparse::{Number, SparseMatrix};
use nodes::Nodes;
use smoother::Smoother;
use tentative::Tentative;

/// Largest number of unknowns for a dense factorisation.
const COARSEST: usize = 300;
/// Largest accepted ratio of unknowns of a level to those of the finer level.
const LEAST_REDUCTION: f64 = 0.8;

#[derive(Debug, Clone)]
struct Level<T> {
    matrix: SparseMatrix,
    smoother: Smoother,
    prolongation: SparseMatrix,
    restriction: SparseMatrix,
    solution: Vec<T>,
    right: Vec<T>,
    residual: Vec<T>,
    direction: Vec<T>,
}

#[derive(Debug, Clone)]
enum Coarsest {
    Dense(DenseCholesky),
    /// An empty matrix, or one that cannot be coarsened further; it is smoothed.
    Smoothed(SparseMatrix, Smoother),
}

/// Multigrid hierarchy, with work vectors for one vector or for eight at the same time.
#[derive(Debug, Clone)]
pub struct Multigrid<T = f64> {
    levels: Vec<Level<T>>,
    coarsest: Coarsest,
    /// Work vectors of the coarsest level: solution, right-hand side, residual, direction.
    work: [Vec<T>; 4],
}

impl<T: Number> Multigrid<T> {
    /// Creates the hierarchy of a symmetric positive definite matrix with a positive diagonal.
    pub fn new(matrix: SparseMatrix, kernel: NearKernel) -> Self {
        let mut levels = Vec::new();
        let mut present = matrix;
        let mut nodes = Nodes::from(kernel);
        while present.rows() > COARSEST {
            let smoother = Smoother::new(&present);
            let tentative = Tentative::new(&present, &nodes);
            let coarse = tentative.matrix.columns();
            if coarse == 0 || coarse as f64 > LEAST_REDUCTION * present.rows() as f64 {
                break;
            }
            let prolongation = smoother.smoothed(&present, &tentative.matrix);
            let restriction = prolongation.transposed();
            let next = restriction.product(&present.product(&prolongation));
            nodes = tentative.coarse;
            let zeros = || vec![T::splat(0.0); present.rows()];
            levels.push(Level {
                smoother,
                prolongation,
                restriction,
                solution: zeros(),
                right: zeros(),
                residual: zeros(),
                direction: zeros(),
                matrix: present,
            });
            present = next;
        }
        let n = present.rows();
        let coarsest = if n <= 2 * COARSEST {
            Coarsest::Dense(DenseCholesky::new(&present))
        } else {
            let smoother = Smoother::new(&present);
            Coarsest::Smoothed(present, smoother)
        };
        Self {
            levels,
            coarsest,
            work: std::array::from_fn(|_| vec![T::splat(0.0); n]),
        }
    }

    /// Computes `out`, an approximation of A⁻¹ x.
    pub fn apply_into(&mut self, x: &[T], out: &mut [T]) {
        match self.levels.first_mut() {
            Some(finest) => finest.right.copy_from_slice(x),
            None => self.work[1].copy_from_slice(x),
        }
        self.cycle(0);
        out.copy_from_slice(match self.levels.first() {
            Some(finest) => &finest.solution,
            None => &self.work[0],
        });
    }

    /// Applies one cycle from a level, which computes its `solution` from its `right`.
    fn cycle(&mut self, number: usize) {
        let Some(level) = self.levels.get_mut(number) else {
            let [solution, right, residual, direction] = &mut self.work;
            match &self.coarsest {
                Coarsest::Dense(factor) => factor.solve_into(right, solution),
                Coarsest::Smoothed(matrix, smoother) => {
                    solution.fill(T::splat(0.0));
                    smoother.smooth(matrix, right, solution, [residual, direction], true);
                }
            }
            return;
        };
        level.solution.fill(T::splat(0.0));
        level.smoother.smooth(
            &level.matrix,
            &level.right,
            &mut level.solution,
            [&mut level.residual, &mut level.direction],
            true,
        );
        level.residual.copy_from_slice(&level.right);
        level
            .matrix
            .subtract_product(&level.solution, &mut level.residual);
        let (above, below) = self.levels.split_at_mut(number + 1);
        let level = &mut above[number];
        let right = match below.first_mut() {
            Some(next) => &mut next.right,
            None => &mut self.work[1],
        };
        level.restriction.multiply_into(&level.residual, right);
        self.cycle(number + 1);
        let (above, below) = self.levels.split_at_mut(number + 1);
        let level = &mut above[number];
        let correction = match below.first() {
            Some(next) => &next.solution,
            None => &self.work[0],
        };
        level
            .prolongation
            .add_product(correction, &mut level.solution);
        level.smoother.smooth(
            &level.matrix,
            &level.right,
            &mut level.solution,
            [&mut level.residual, &mut level.direction],
            false,
        );
    }

    /// Returns the unknowns and stored entries of each level, starting with the finest.
    pub fn sizes(&self) -> Vec<[usize; 2]> {
        let levels = self.levels.iter();
        let mut sizes: Vec<[usize; 2]> = levels
            .map(|level| [level.matrix.rows(), level.matrix.entries()])
            .collect();
        let n = self.work[0].len();
        sizes.push(match &self.coarsest {
            Coarsest::Dense(_) => [n, n * n],
            Coarsest::Smoothed(matrix, _) => [n, matrix.entries()],
        });
        sizes
    }

    /// Returns the memory, bytes.
    pub fn bytes(&self) -> usize {
        let of_level = |level: &Level<T>| {
            let matrices = [&level.matrix, &level.prolongation, &level.restriction];
            let numbers = 4 * level.solution.len() * size_of::<T>();
            numbers + matrices.iter().map(|one| one.bytes()).sum::<usize>()
        };
        let last = self.sizes().last().map_or(0, |[_, entries]| entries * 12);
        last + self.levels.iter().map(of_level).sum::<usize>()
    }
}
