//! Rational interpolation of a matrix-valued function along directions.

use nalgebra::{Complex, DMatrix, DVector};

use super::fit::Exponential;

type C = Complex<f64>;

/// The interpolation problem of Mayo & Antoulas (2007) for a K × K function G with G(w̄) = conj G(w), known on points of the upper half plane: rows ℓᵀ G(μ) on one half of the points, columns
/// G(w) r on the other, ℓ and r real, each with its conjugate.
///
/// The singular values of the divided differences L = ℓᵀ [G(μ) − G(w)] r/(μ − w) fall as fast as the error of rational functions can; those above a threshold give, with
/// L' = ℓᵀ [μ G(μ) − w G(w)] r/(μ − w), the realisation G(w) ≈ W X (M − w)⁻¹ Y V, M = Y L' X.
pub(super) struct Loewner {
    left: DMatrix<f64>,
    right: DMatrix<f64>,
    singular: DVector<f64>,
    shifted: DMatrix<f64>,
    /// ℓᵀ G(μ).
    rows: DMatrix<f64>,
    /// G(w) r.
    columns: DMatrix<f64>,
}

/// A point with what is known there.
struct Tangent {
    at: C,
    direction: DVector<C>,
    value: DVector<C>,
}

impl Loewner {
    /// With `directions` random directions at each point.
    pub(super) fn new(points: &[C], values: &[DMatrix<C>], directions: usize) -> Self {
        let reach = values[0].nrows();
        let noise = crate::noise::noise(2 * points.len() * directions * reach, 1);
        let mut noise = noise.chunks(reach).map(|v| {
            let norm = v.iter().map(|x| x * x).sum::<f64>().sqrt();
            DVector::from_iterator(reach, v.iter().map(|x| C::new(x / norm, 0.0)))
        });
        let (mut left, mut right) = (Vec::new(), Vec::new());
        for (k, (&at, g)) in points.iter().zip(values).enumerate() {
            for direction in noise.by_ref().take(directions) {
                if k % 2 == 0 {
                    let value = g.tr_mul(&direction);
                    left.push(Tangent {
                        at,
                        direction,
                        value,
                    });
                } else {
                    let value = g * &direction;
                    right.push(Tangent {
                        at,
                        direction,
                        value,
                    });
                }
            }
        }
        let mut plain = DMatrix::zeros(2 * left.len(), 2 * right.len());
        let mut shifted = plain.clone();
        for (i, row) in left.iter().enumerate() {
            for (j, column) in right.iter().enumerate() {
                let difference = |w: C, value: &DVector<C>| {
                    let a = row.value.dot(&column.direction);
                    let b = row.direction.dot(value);
                    let apart = row.at - w;
                    [(a - b) / apart, (row.at * a - w * b) / apart]
                };
                let one = difference(column.at, &column.value);
                let other = difference(column.at.conj(), &column.value.map(|x| x.conj()));
                for (k, matrix) in [&mut plain, &mut shifted].into_iter().enumerate() {
                    let (a, b) = (one[k], other[k]);
                    matrix[(2 * i, 2 * j)] = (a + b).re;
                    matrix[(2 * i, 2 * j + 1)] = (a - b).im;
                    matrix[(2 * i + 1, 2 * j)] = -(a + b).im;
                    matrix[(2 * i + 1, 2 * j + 1)] = (a - b).re;
                }
            }
        }
        let root = std::f64::consts::SQRT_2;
        let rows = DMatrix::from_fn(plain.nrows(), reach, |i, m| {
            let x = left[i / 2].value[m];
            root * if i % 2 == 0 { x.re } else { -x.im }
        });
        let columns = DMatrix::from_fn(reach, plain.ncols(), |n, j| {
            let x = right[j / 2].value[n];
            root * if j % 2 == 0 { x.re } else { x.im }
        });
        let svd = plain.svd(true, true);
        Self {
            left: svd.u.unwrap_or_default().transpose(),
            right: svd.v_t.unwrap_or_default().transpose(),
            singular: svd.singular_values,
            shifted,
            rows,
            columns,
        }
    }

    /// Rows and columns, the smaller number.
    pub(super) fn size(&self) -> usize {
        self.singular.len()
    }

    /// Number of singular values above this share of the first.
    pub(super) fn rank(&self, share: f64) -> usize {
        let least = share * self.singular[0];
        self.singular.iter().take_while(|s| **s > least).count()
    }

    /// The decaying exponentials of the realisation of this order: eigenvalues 1/λ of M with Im λ ≥ 0, right and left eigenvectors.
    pub(super) fn exponentials(&self, order: usize) -> Vec<Exponential> {
        let weight = DMatrix::from_diagonal(&self.singular.rows(0, order).map(|s| 1.0 / s.sqrt()));
        let left = &weight * self.left.rows(0, order);
        let right = self.right.columns(0, order) * weight;
        let complex = |matrix: DMatrix<f64>| matrix.map(|x| C::new(x, 0.0));
        let matrix = complex(&left * &self.shifted * &right);
        let (q, triangle) = matrix.schur().unpack();
        let vectors = triangular_eigenvectors(&triangle);
        let give = complex(&self.columns * right) * &q * &vectors;
        let mut take = q.ad_mul(&complex(left * &self.rows));
        vectors.solve_upper_triangular_mut(&mut take);
        let decays = triangle.diagonal().map(|pole| pole.inv());
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

/// The eigenvectors of an upper triangular matrix, as columns of an upper triangular matrix with ones on the diagonal.
fn triangular_eigenvectors(triangle: &DMatrix<C>) -> DMatrix<C> {
    let n = triangle.nrows();
    let smallest = f64::EPSILON * triangle.norm();
    let mut vectors = DMatrix::identity(n, n);
    for p in 0..n {
        for i in (0..p).rev() {
            let sum: C = (i + 1..=p)
                .map(|k| triangle[(i, k)] * vectors[(k, p)])
                .sum();
            let mut gap = triangle[(p, p)] - triangle[(i, i)];
            if gap.norm() < smallest {
                gap = C::new(smallest, 0.0);
            }
            vectors[(i, p)] = sum / gap;
        }
    }
    vectors
}
