//! Tangential rational interpolation of a matrix-valued function.
//!
//! For K = 20 and 2048 steps the cross approximation takes 0.7 s; the singular values of the whole matrix would take
//! 11 s and give as many exponentials.

use std::f64::consts::SQRT_2;

use nalgebra::{Complex, DMatrix, DVector};

use super::schur::{complex_schur, triangular_eigenvectors};

type C = Complex<f64>;

/// Interpolation problem of Mayo & Antoulas (2007) for a K × K function G with G(w̄) = conj G(w), known at points
/// of the upper half plane: rows ℓᵀ G(μ) at one half of the points, columns G(w) r at the other, ℓ and r real, each
/// with its conjugate.
///
/// A cross approximation (Bebendorf 2000) of the divided differences L = ℓᵀ [G(μ) − G(w)] r/(μ − w) takes one row
/// and one column after the other, so that only these are computed. Its singular values, which decrease as fast as
/// the error of rational approximations, follow from triangular matrices of the size of its rank. Those above a
/// threshold, L ≈ A Σ B, give the realisation G(w) ≈ W X (M − w)⁻¹ Y V with Y = Σ^−½ Aᵀ, X = Bᵀ Σ^−½ and
///
/// ```text
/// M = Y [μ L + ℓ W] X = Σ^−½ Aᵀ μ A Σ^½ + (Y ℓ) (W X),
/// ```
///
/// because μ L + ℓ W are the divided differences of w G. O((K + r) n r + r³) for rank r and n rows.
pub(super) struct Loewner {
    tangents: Tangents,
    singular: DVector<f64>,
    /// Aᵀ μ A.
    shifted: DMatrix<f64>,
    /// Aᵀ ℓ, Aᵀ V: K columns.
    entering: [DMatrix<f64>; 2],
    /// W Bᵀ: K rows.
    leaving: DMatrix<f64>,
}

/// Exponential with a residue of rank one.
#[derive(Debug, Clone)]
pub(super) struct Exponential {
    pub(super) decay: C,
    /// a_n, K numbers.
    pub(super) give: Vec<C>,
    /// b_m, K numbers.
    pub(super) take: Vec<C>,
}

/// Treatment of eigenvalues λ outside the unit circle.
#[derive(Debug, Clone, Copy)]
pub(super) enum Growing {
    /// They are dropped, which is correct for superfluous ones, as most are.
    LeftOut,
    /// They are replaced by 1/λ̄ and their residues are recomputed. Dropping one that is needed would cause an
    /// error of its whole residue, some per cent.
    Reflected,
}

impl Growing {
    pub(super) const ALL: [Self; 2] = [Self::LeftOut, Self::Reflected];

    fn treated(self, decay: C) -> C {
        match self {
            Self::Reflected if decay.norm() > 1.0 => decay.conj().inv(),
            _ => decay,
        }
    }
}

/// Interpolation point with its data.
struct Tangent {
    at: C,
    direction: DVector<f64>,
    value: DVector<C>,
}

/// Interpolation data of the rows or of the columns.
struct Tangents {
    left: Vec<Tangent>,
    right: Vec<Tangent>,
}

/// Row and column of the remainder of L after the previous crosses, divided by their common entry.
struct Cross {
    entry: f64,
    /// Column.
    down: Vec<f64>,
    /// Row.
    along: Vec<f64>,
}

/// Number of consecutive small crosses after which the remainder is considered small.
const PATIENCE: usize = 4;

impl Loewner {
    /// Builds the problem with `directions` random directions at each point, up to crosses below a `share` of the
    /// largest.
    pub(super) fn new(points: &[C], values: &[DMatrix<C>], directions: usize, share: f64) -> Self {
        let reach = values[0].nrows();
        let noise = pericles::noise::noise(2 * points.len() * directions * reach, 1);
        let mut noise = noise.chunks(reach).map(|v| {
            let direction = DVector::from_column_slice(v);
            let norm = direction.norm();
            direction / norm
        });
        let (mut left, mut right) = (Vec::new(), Vec::new());
        for (k, (&at, g)) in points.iter().zip(values).enumerate() {
            for direction in noise.by_ref().take(directions) {
                let complex = direction.map(|x| C::new(x, 0.0));
                let (side, value) = match k % 2 {
                    0 => (&mut left, g.tr_mul(&complex)),
                    _ => (&mut right, g * &complex),
                };
                side.push(Tangent {
                    at,
                    direction,
                    value,
                });
            }
        }
        let tangents = Tangents { left, right };
        let crosses = tangents.crosses(share);
        let entries = |k: usize| crosses[k].entry;
        let down: Vec<&[f64]> = crosses.iter().map(|cross| &cross.down[..]).collect();
        let along: Vec<&[f64]> = crosses.iter().map(|cross| &cross.along[..]).collect();
        let [down, along] = [down, along].map(|lines| lines_as_columns(&lines));
        // L = U D Vᵀ; with U = A₀ R, V = B₀ S the singular values are the ones of R D Sᵀ.
        let [(a, r), (b, s)] = [down, along].map(orthogonalised);
        let core = DMatrix::from_fn(r.nrows(), r.ncols(), |i, k| r[(i, k)] * entries(k));
        let svd = (core * s.transpose()).svd(true, true);
        let a = a * svd.u.unwrap_or_default();
        let b = b * svd.v_t.unwrap_or_default().transpose();
        let shifted = a.tr_mul(&tangents.times_points(&a));
        let entering = [tangents.directions(), tangents.rows()].map(|rows| a.tr_mul(&rows));
        let leaving = tangents.columns() * b;
        Self {
            tangents,
            singular: svd.singular_values,
            shifted,
            entering,
            leaving,
        }
    }

    /// Smaller one of the numbers of rows and columns.
    pub(super) fn size(&self) -> usize {
        2 * self.tangents.left.len().min(self.tangents.right.len())
    }

    /// Number of singular values above this fraction of the first.
    pub(super) fn rank(&self, share: f64) -> usize {
        let least = share * self.singular.get(0).copied().unwrap_or_default();
        self.singular.iter().take_while(|s| **s > least).count()
    }

    /// Exponentials of the realisation of this order: eigenvalues 1/λ of M with Im λ ≥ 0, with right and left
    /// eigenvectors. Empty if they cannot be computed.
    ///
    /// Round-off moves some eigenvalues close to the unit circle to its wrong side.
    pub(super) fn exponentials(&self, order: usize, growing: Growing) -> Vec<Exponential> {
        let root = |k: usize| self.singular[k].sqrt();
        let scaled = |matrix: &DMatrix<f64>| {
            DMatrix::from_fn(order, matrix.ncols(), |k, m| matrix[(k, m)] / root(k))
        };
        let [directions, rows] = [&self.entering[0], &self.entering[1]].map(scaled);
        let columns = scaled(&self.leaving.transpose()).transpose();
        let similar = |i, j| self.shifted[(i, j)] / root(i) * root(j);
        let matrix = DMatrix::from_fn(order, order, similar) + directions * &columns;
        let Some((q, triangle)) = complex_schur(matrix) else {
            return Vec::new();
        };
        let complex = |matrix: DMatrix<f64>| matrix.map(|x| C::new(x, 0.0));
        let vectors = triangular_eigenvectors(&triangle);
        let give = complex(columns) * &q * &vectors;
        let mut take = q.ad_mul(&complex(rows));
        vectors.solve_upper_triangular_mut(&mut take);
        let decays = triangle.diagonal().map(|pole| growing.treated(pole.inv()));
        let kept = (0..order).filter(|&p| decays[p].norm() < 1.0 && decays[p].im > -1e-10);
        kept.map(|p| {
            let real = decays[p].im < 1e-10;
            let factor = decays[p] * if real { 1.0 } else { 2.0 };
            Exponential {
                decay: if real {
                    C::new(decays[p].re, 0.0)
                } else {
                    decays[p]
                },
                give: give.column(p).iter().map(|x| x * factor).collect(),
                take: take.row(p).iter().copied().collect(),
            }
        })
        .collect()
    }
}

impl Tangents {
    /// Computes crosses with partial pivoting: the next row contains the largest remaining entry of the last
    /// column.
    fn crosses(&self, share: f64) -> Vec<Cross> {
        let mut crosses: Vec<Cross> = Vec::new();
        let (rows, columns) = (2 * self.left.len(), 2 * self.right.len());
        let mut taken = [vec![false; rows], vec![false; columns]];
        let (mut row, mut largest, mut small) = (0, 0.0_f64, 0);
        while crosses.len() < rows.min(columns) {
            taken[0][row] = true;
            let mut along = self.row(row);
            for cross in &crosses {
                subtract(&mut along, cross.down[row] * cross.entry, &cross.along);
            }
            let Some(column) = largest_free(&along, &taken[1]) else {
                return crosses;
            };
            let entry = along[column];
            largest = largest.max(entry.abs());
            if entry.abs() <= share * largest {
                small += 1;
                if small == PATIENCE {
                    return crosses;
                }
            } else {
                small = 0;
            }
            if entry == 0.0 {
                let Some(next) = taken[0].iter().position(|taken| !taken) else {
                    return crosses;
                };
                row = next;
                continue;
            }
            taken[1][column] = true;
            let mut down = self.column(column);
            for cross in &crosses {
                subtract(&mut down, cross.along[column] * cross.entry, &cross.down);
            }
            let next = largest_free(&down, &taken[0]);
            for x in along.iter_mut().chain(&mut down) {
                *x /= entry;
            }
            crosses.push(Cross { entry, down, along });
            let Some(next) = next else {
                return crosses;
            };
            row = next;
        }
        crosses
    }

    fn row(&self, row: usize) -> Vec<f64> {
        let left = &self.left[row / 2];
        let entries = self.right.iter().map(|right| block(left, right));
        entries.flat_map(|block| block[row % 2]).collect()
    }

    fn column(&self, column: usize) -> Vec<f64> {
        let right = &self.right[column / 2];
        let entries = self.left.iter().map(|left| block(left, right));
        entries
            .flat_map(|block| block.map(|row| row[column % 2]))
            .collect()
    }

    /// Multiplies the columns of a matrix by μ, in the real form of rows.
    fn times_points(&self, matrix: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, k| {
            let at = self.left[i / 2].at;
            let (first, second) = (matrix[(i - i % 2, k)], matrix[(i - i % 2 + 1, k)]);
            match i % 2 {
                0 => at.re * first + at.im * second,
                _ => at.re * second - at.im * first,
            }
        })
    }

    /// ℓ, V = ℓᵀ G(μ) and W = G(w) r in their real forms.
    fn directions(&self) -> DMatrix<f64> {
        self.by_rows(|left, m| C::new(left.direction[m], 0.0))
    }

    fn rows(&self) -> DMatrix<f64> {
        self.by_rows(|left, m| left.value[m])
    }

    fn by_rows(&self, entry: impl Fn(&Tangent, usize) -> C) -> DMatrix<f64> {
        let reach = self.left[0].direction.len();
        DMatrix::from_fn(2 * self.left.len(), reach, |i, m| {
            let x = entry(&self.left[i / 2], m) * SQRT_2;
            if i % 2 == 0 { x.re } else { -x.im }
        })
    }

    fn columns(&self) -> DMatrix<f64> {
        let reach = self.left[0].direction.len();
        DMatrix::from_fn(reach, 2 * self.right.len(), |n, j| {
            let x = self.right[j / 2].value[n] * SQRT_2;
            if j % 2 == 0 { x.re } else { x.im }
        })
    }
}

fn lines_as_columns(lines: &[&[f64]]) -> DMatrix<f64> {
    let length = lines.first().map_or(0, |line| line.len());
    DMatrix::from_fn(length, lines.len(), |i, k| lines[k][i])
}

/// Factorises a matrix into orthonormal columns and a triangle by the Cholesky factor of its Gram matrix; the
/// columns of crosses are well conditioned.
fn orthogonalised(columns: DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    match columns.tr_mul(&columns).cholesky() {
        Some(factor) => {
            let triangle = factor.l();
            let mut transposed = columns.transpose();
            triangle.solve_lower_triangular_mut(&mut transposed);
            (transposed.transpose(), triangle.transpose())
        }
        None => {
            let qr = columns.qr();
            (qr.q(), qr.r())
        }
    }
}

/// `line` −= factor · other.
fn subtract(line: &mut [f64], factor: f64, other: &[f64]) {
    for (x, y) in line.iter_mut().zip(other) {
        *x -= factor * y;
    }
}

/// Index of the largest entry not yet taken.
fn largest_free(line: &[f64], taken: &[bool]) -> Option<usize> {
    (0..line.len())
        .filter(|&k| !taken[k])
        .max_by(|&i, &j| line[i].abs().total_cmp(&line[j].abs()))
}

/// Entries of L for a row and a column with their conjugates in real form: [real, imaginary] rows of [real,
/// imaginary] columns.
fn block(row: &Tangent, column: &Tangent) -> [[f64; 2]; 2] {
    let along = |value: &DVector<C>, direction: &DVector<f64>| -> C {
        value.iter().zip(direction).map(|(v, d)| v * *d).sum()
    };
    let a = along(&row.value, &column.direction);
    let b = along(&column.value, &row.direction);
    let one = (a - b) / (row.at - column.at);
    let other = (a - b.conj()) / (row.at - column.at.conj());
    let (sum, gap) = (one + other, one - other);
    [[sum.re, gap.im], [-sum.im, gap.re]]
}
