//! Sparse matrices in compressed rows.
//!
//! Each row is computed by one thread in a fixed order, so that results do not depend on the number of threads.

use pericles::for_each_instruction_set;
use pericles::lanes::{InstructionSet, Real};
use pericles::parallel::{BLOCK, Cost, for_each_chunk, for_each_chunk_of};
use rayon::prelude::*;

/// Entry of a vector, or the entries of eight vectors ([`F64x8`](pericles::lanes::F64x8)), which are multiplied by a matrix
/// at the same time.
pub trait Number: Real + Send + Sync {}

impl<T: Real + Send + Sync> Number for T {}

/// Receives the column and value of an entry.
pub type Push<'a> = dyn FnMut(usize, f64) + 'a;

/// Sparse matrix in compressed rows: row i has the entries `start[i]` to `start[i + 1]`, with ascending columns.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SparseMatrix {
    columns: usize,
    start: Vec<usize>,
    column: Vec<u32>,
    value: Vec<f64>,
}

/// Consecutive rows of a matrix.
#[derive(Default)]
struct Rows {
    lengths: Vec<usize>,
    column: Vec<u32>,
    value: Vec<f64>,
}

/// Accumulator of a row: a sum of sparse rows.
struct Accumulator {
    value: Vec<f64>,
    present: Vec<bool>,
    columns: Vec<u32>,
}

impl Accumulator {
    fn new(columns: usize) -> Self {
        Self {
            value: vec![0.0; columns],
            present: vec![false; columns],
            columns: Vec::new(),
        }
    }

    fn add(&mut self, column: u32, value: f64) {
        let k = column as usize;
        if !self.present[k] {
            self.present[k] = true;
            self.columns.push(column);
            self.value[k] = 0.0;
        }
        self.value[k] += value;
    }

    /// Appends the row and clears the accumulator.
    fn take_into(&mut self, rows: &mut Rows) {
        self.columns.sort_unstable();
        rows.lengths.push(self.columns.len());
        for &column in &self.columns {
            self.present[column as usize] = false;
            rows.column.push(column);
            rows.value.push(self.value[column as usize]);
        }
        self.columns.clear();
    }
}

impl SparseMatrix {
    /// Creates a matrix from consecutive groups of rows.
    fn of_rows(columns: usize, parts: Vec<Rows>) -> Self {
        let entries = parts.iter().map(|part| part.column.len()).sum();
        let mut matrix = Self {
            columns,
            start: vec![0],
            column: Vec::with_capacity(entries),
            value: Vec::with_capacity(entries),
        };
        let mut end = 0;
        for part in parts {
            for length in part.lengths {
                end += length;
                matrix.start.push(end);
            }
            matrix.column.extend(part.column);
            matrix.value.extend(part.value);
        }
        matrix
    }

    /// Creates a matrix row by row: `fill(row, entries)` pushes the columns and values of a row in any order;
    /// values of the same column are added in the order of their calls.
    pub fn from_rows(
        rows: usize,
        columns: usize,
        fill: &(dyn Fn(usize, &mut Push<'_>) + Sync),
    ) -> Self {
        let parts = (0..rows.div_ceil(BLOCK))
            .into_par_iter()
            .map_init(
                || Accumulator::new(columns),
                |accumulator, block| {
                    let mut part = Rows::default();
                    for row in block * BLOCK..rows.min((block + 1) * BLOCK) {
                        fill(row, &mut |column, value| {
                            accumulator.add(column as u32, value);
                        });
                        accumulator.take_into(&mut part);
                    }
                    part
                },
            )
            .collect();
        Self::of_rows(columns, parts)
    }

    /// Returns the number of rows.
    pub fn rows(&self) -> usize {
        self.start.len().saturating_sub(1)
    }

    /// Returns the number of columns.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Returns the number of stored entries.
    pub fn entries(&self) -> usize {
        self.value.len()
    }

    /// Returns the columns and values of a row.
    pub fn row(&self, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.start[i]..self.start[i + 1];
        let columns = self.column[range.clone()].iter();
        columns
            .zip(&self.value[range])
            .map(|(&column, &value)| (column as usize, value))
    }

    /// Returns the diagonal entry of a row; zero if it is not stored.
    pub fn diagonal(&self, i: usize) -> f64 {
        self.row(i).find(|(k, _)| *k == i).map_or(0.0, |(_, a)| a)
    }

    /// `out` = A x.
    pub fn multiply_into<T: Number>(&self, x: &[T], out: &mut [T]) {
        self.update(Update::Set, x, out);
    }

    /// `out` −= A x.
    pub fn subtract_product<T: Number>(&self, x: &[T], out: &mut [T]) {
        self.update(Update::Subtract, x, out);
    }

    /// `out` += A x.
    pub fn add_product<T: Number>(&self, x: &[T], out: &mut [T]) {
        self.update(Update::Add, x, out);
    }

    fn update<T: Number>(&self, update: Update, x: &[T], out: &mut [T]) {
        assert_eq!(x.len(), self.columns);
        let set = InstructionSet::detect();
        // Eight vectors take about as long as one bond per entry and vector as well.
        let numbers = size_of::<T>() / size_of::<f64>();
        let cost = Cost::bonds((self.value.len() * numbers) as u64);
        for_each_chunk_of(out, cost, &|first, chunk| {
            multiply_rows(set, self, (update, first), x, chunk);
        });
    }

    /// Returns Aᵀ.
    pub fn transposed(&self) -> Self {
        let mut start = vec![0; self.columns + 1];
        for &column in &self.column {
            start[column as usize + 1] += 1;
        }
        for k in 0..self.columns {
            start[k + 1] += start[k];
        }
        let mut next = start.clone();
        let mut column = vec![0; self.column.len()];
        let mut value = vec![0.0; self.value.len()];
        for i in 0..self.rows() {
            for (k, a) in self.row(i) {
                column[next[k]] = i as u32;
                value[next[k]] = a;
                next[k] += 1;
            }
        }
        Self {
            columns: self.rows(),
            start,
            column,
            value,
        }
    }

    /// Returns A B.
    pub fn product(&self, other: &Self) -> Self {
        Self::from_rows(self.rows(), other.columns, &|i, add| {
            for (k, a) in self.row(i) {
                for (column, b) in other.row(k) {
                    add(column, a * b);
                }
            }
        })
    }

    /// Returns the memory, bytes.
    pub fn bytes(&self) -> usize {
        self.start.len() * size_of::<usize>()
            + self.column.len() * size_of::<u32>()
            + self.value.len() * size_of::<f64>()
    }
}

/// Use of a product.
#[derive(Clone, Copy)]
enum Update {
    Set,
    Add,
    Subtract,
}

#[inline(always)]
fn multiply_rows_body<T: Number>(
    matrix: &SparseMatrix,
    (update, first): (Update, usize),
    x: &[T],
    out: &mut [T],
) {
    for k in 0..out.len() {
        let range = matrix.start[first + k]..matrix.start[first + k + 1];
        let columns = &matrix.column[range.clone()];
        let values = &matrix.value[range][..columns.len()];
        // Two independent sums, which a processor adds in parallel.
        let (mut even, mut odd) = (T::splat(0.0), T::splat(0.0));
        let pairs = columns.len() / 2 * 2;
        let mut e = 0;
        while e < pairs {
            even = even + T::splat(values[e]) * x[columns[e] as usize];
            odd = odd + T::splat(values[e + 1]) * x[columns[e + 1] as usize];
            e += 2;
        }
        if pairs < columns.len() {
            even = even + T::splat(values[pairs]) * x[columns[pairs] as usize];
        }
        let product = even + odd;
        out[k] = match update {
            Update::Set => product,
            Update::Add => out[k] + product,
            Update::Subtract => out[k] - product,
        };
    }
}

for_each_instruction_set! {
    /// Multiplies the rows from `first` on.
    fn multiply_rows [T: Number] <T> (
        matrix: &SparseMatrix,
        place: (Update, usize),
        x: &[T],
        out: &mut [T],
    ) = multiply_rows_body
}

/// y += factor x
pub(crate) fn add_multiple<T: Number>(y: &mut [T], factor: f64, x: &[T]) {
    let factor = T::splat(factor);
    for_each_chunk(y, &|first, chunk| {
        let length = chunk.len();
        for (y, x) in chunk.iter_mut().zip(&x[first..first + length]) {
            *y = *y + factor * *x;
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A matrix of pseudorandom entries.
    fn matrix(rows: usize, columns: usize, seed: usize) -> SparseMatrix {
        SparseMatrix::from_rows(rows, columns, &|i, add| {
            for k in 0..4 {
                let column = (i * 7 + k * k * 5 + seed) % columns;
                add(column, ((i + 3 * k + seed) as f64).sin());
            }
        })
    }

    fn noise(n: usize) -> Vec<f64> {
        (0..n).map(|i| (1.3 * i as f64).cos()).collect()
    }

    #[test]
    fn product_of_matrices_acts_as_both_matrices_in_sequence() {
        let (a, b) = (matrix(1100, 70, 1), matrix(70, 33, 2));
        let x = noise(33);
        let mut bx = vec![0.0; 70];
        b.multiply_into(&x, &mut bx);
        let (mut abx, mut at_once) = (vec![0.0; 1100], vec![0.0; 1100]);
        a.multiply_into(&bx, &mut abx);
        a.product(&b).multiply_into(&x, &mut at_once);
        for (one, other) in abx.iter().zip(&at_once) {
            assert!((one - other).abs() < 1e-13);
        }
    }

    #[test]
    fn transposed_matrix_is_the_adjoint() {
        let a = matrix(50, 31, 3);
        let (x, y) = (noise(31), noise(50));
        let (mut ax, mut aty) = (vec![0.0; 50], vec![0.0; 31]);
        a.multiply_into(&x, &mut ax);
        a.transposed().multiply_into(&y, &mut aty);
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        assert!((dot(&ax, &y) - dot(&x, &aty)).abs() < 1e-13);
        assert_eq!(a.transposed().transposed(), a);
    }
}
