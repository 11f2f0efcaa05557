//! Stress and strain at points, computed from their bonds.
//!
//! Symmetric tensors are stored by component, in the order xx (1D), xx, yy, xy (2D), xx, yy, zz, xy, yz, xz (3D).

use rayon::prelude::*;

use crate::domain::Field;
use crate::operator::{BondAt, BondView};
use crate::parallel::BLOCK;
use crate::solve::inverse;
use crate::space::PointCloud;

/// Row and column of every component.
pub(super) fn places(dimension: usize) -> &'static [(usize, usize)] {
    match dimension {
        1 => &[(0, 0)],
        2 => &[(0, 0), (1, 1), (0, 1)],
        _ => &[(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)],
    }
}

type Matrix = [[f64; 3]; 3];

/// Returns the von Mises equivalent stress, Pa, in two dimensions of the in-plane components.
pub(super) fn equivalent_stress(dimension: usize, stress: &[f64]) -> Vec<f64> {
    let n = stress.len() / places(dimension).len();
    let of_point = |i: usize| {
        let part = |k: usize| stress[k * n + i];
        match dimension {
            1 => part(0).abs(),
            2 => {
                let [xx, yy, xy] = [0, 1, 2].map(part);
                (xx * xx - xx * yy + yy * yy + 3.0 * xy * xy).sqrt()
            }
            _ => {
                let [xx, yy, zz, xy, yz, xz] = [0, 1, 2, 3, 4, 5].map(part);
                let normal = (xx - yy).powi(2) + (yy - zz).powi(2) + (zz - xx).powi(2);
                let shear = xy * xy + yz * yz + xz * xz;
                (0.5 * normal + 3.0 * shear).sqrt()
            }
        }
    };
    (0..n).map(of_point).collect()
}

/// Principal stresses in descending order, Pa, component-major: the eigenvalues of stresses in the order of their components.
pub(super) fn principal_stresses(dimension: usize, stress: &[f64]) -> Vec<f64> {
    let places = places(dimension);
    let n = stress.len() / places.len();
    let mut principal = vec![0.0; dimension * n];
    for i in 0..n {
        let mut matrix = Matrix::default();
        for (k, &(a, b)) in places.iter().enumerate() {
            (matrix[a][b], matrix[b][a]) = (stress[k * n + i], stress[k * n + i]);
        }
        diagonalise(&mut matrix);
        let mut values = [matrix[0][0], matrix[1][1], matrix[2][2]];
        // Axes that the body does not have keep their zero, which does not count as a principal stress.
        values[..dimension].sort_unstable_by(|a, b| b.total_cmp(a));
        for (c, value) in values[..dimension].iter().enumerate() {
            principal[c * n + i] = *value;
        }
    }
    principal
}

/// Turns a symmetric matrix to its principal axes by Jacobi rotations: the eigenvalues are on the diagonal to round-off of the largest one.
fn diagonalise(m: &mut Matrix) {
    /// Convergence is quadratic: three to five sweeps reach round-off.
    const SWEEPS: usize = 12;
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            // Not a number stays one.
            if m[p][q] == 0.0 || m[p][q].is_nan() {
                continue;
            }
            let theta = 0.5 * (m[q][q] - m[p][p]) / m[p][q];
            let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
            let c = 1.0 / t.hypot(1.0);
            let s = t * c;
            let r = 3 - p - q;
            let (pp, qq, pq) = (m[p][p], m[q][q], m[p][q]);
            let (rp, rq) = (m[r][p], m[r][q]);
            (m[p][p], m[q][q]) = (pp - t * pq, qq + t * pq);
            (m[p][q], m[q][p]) = (0.0, 0.0);
            (m[r][p], m[p][r]) = (c * rp - s * rq, c * rp - s * rq);
            (m[r][q], m[q][r]) = (s * rp + c * rq, s * rp + c * rq);
        }
    }
}

/// Returns the symmetric part of the virial stress of the bonds of each point, Pa. With the force densities f_ij it is
/// σ_i = ½ Σ_j f_ij ⊗ ξ for laws of small strains, and the Cauchy stress σ_i = ½ Σ_j f_ij ⊗ (ξ + η)/J for others, with
/// J = det(I + G) of the fitted displacement gradient in the dimension of the body. Under uniform strain it equals the
/// stress of the continuum, except within a horizon of free surfaces, where bonds are missing.
pub(super) fn virial_stress(cloud: &PointCloud, bonds: &dyn BondView, u: &[f64]) -> Vec<f64> {
    let ghosts = cloud.domain().ghosts(u);
    let values = bonds.values_at(Field::new(u, &ghosts));
    let volumes = cloud.domain().with_ghosts(cloud.volumes());
    per_point(cloud, |i| {
        let (mut stress, mut fit) = (Matrix::default(), Fit::default());
        let mut is_finite = false;
        bonds.for_each_bond(&values, i, &mut |bond: BondAt| {
            let along = match bond.small_strain {
                true => bond.xi,
                false => std::array::from_fn(|c| bond.xi[c] + bond.eta[c]),
            };
            if !bond.small_strain {
                is_finite = true;
                fit.add(&bond, volumes[bond.neighbour]);
            }
            for a in 0..3 {
                for b in 0..3 {
                    stress[a][b] += 0.5 * bond.force[a] * along[b];
                }
            }
        });
        // Bonds that do not span the space, or that are turned inside out, determine no change of volume.
        let growth = is_finite.then(|| fit.gradient(cloud.dimension()));
        let growth = growth
            .flatten()
            .map_or(1.0, |gradient| volume_ratio(&gradient));
        let growth = if growth > 0.0 { growth } else { 1.0 };
        stress.map(|row| row.map(|entry| entry / growth))
    })
}

/// Returns stresses of all points, component-major.
pub(super) fn components(cloud: &PointCloud, stresses: &[Matrix]) -> Vec<f64> {
    per_point(cloud, |i| stresses[i])
}

/// Returns the strain of the displacement gradient G that minimises Σ_j V_j |η − G ξ|². Zero where the unbroken
/// bonds do not span the space.
pub(super) fn fitted_strain(cloud: &PointCloud, bonds: &dyn BondView, u: &[f64]) -> Vec<f64> {
    let ghosts = cloud.domain().ghosts(u);
    let values = bonds.values_at(Field::new(u, &ghosts));
    let volumes = cloud.domain().with_ghosts(cloud.volumes());
    per_point(cloud, |i| {
        let mut fit = Fit::default();
        bonds.for_each_bond(&values, i, &mut |bond: BondAt| {
            fit.add(&bond, volumes[bond.neighbour]);
        });
        fit.gradient(cloud.dimension()).unwrap_or_default()
    })
}

/// Least-squares fit of a displacement gradient to bonds.
#[derive(Default)]
struct Fit {
    /// Σ V ξ ⊗ ξ
    shape: Matrix,
    /// Σ V η ⊗ ξ
    moment: Matrix,
}

impl Fit {
    fn add(&mut self, bond: &BondAt, volume: f64) {
        for a in 0..3 {
            for b in 0..3 {
                self.shape[a][b] += volume * bond.xi[a] * bond.xi[b];
                self.moment[a][b] += volume * bond.eta[a] * bond.xi[b];
            }
        }
    }

    /// Returns the gradient; `None` if the bonds do not span the space.
    fn gradient(mut self, dimension: usize) -> Option<Matrix> {
        let size = (0..dimension).map(|c| self.shape[c][c]).sum::<f64>();
        // A unit diagonal for missing axes makes the inverse block-diagonal.
        for c in dimension..3 {
            self.shape[c][c] = size;
        }
        inverse(&self.shape).map(|inverse| product(&self.moment, &inverse))
    }
}

/// Returns det(I + G).
fn volume_ratio(gradient: &Matrix) -> f64 {
    let f: Matrix = std::array::from_fn(|a| {
        std::array::from_fn(|b| gradient[a][b] + f64::from(u8::from(a == b)))
    });
    let minor = |a: usize, b: usize| f[1][a] * f[2][b] - f[1][b] * f[2][a];
    f[0][0] * minor(1, 2) - f[0][1] * minor(0, 2) + f[0][2] * minor(0, 1)
}

/// Returns the symmetric part of a matrix for every point, component-major.
fn per_point(cloud: &PointCloud, matrix: impl Fn(usize) -> Matrix + Send + Sync) -> Vec<f64> {
    let n = cloud.len();
    let matrices: Vec<Matrix> = (0..n)
        .into_par_iter()
        .with_min_len(BLOCK)
        .map(matrix)
        .collect();
    let places = places(cloud.dimension()).iter();
    places
        .flat_map(|&(a, b)| matrices.iter().map(move |m| 0.5 * (m[a][b] + m[b][a])))
        .collect()
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// R diag(values) Rᵀ for the rotation by `angle` about the axis (1, 2, 2)/3, as components.
    fn turned(values: [f64; 3], angle: f64) -> Vec<f64> {
        let axis = [1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0];
        let (s, c) = angle.sin_cos();
        let cross = [
            [0.0, -axis[2], axis[1]],
            [axis[2], 0.0, -axis[0]],
            [-axis[1], axis[0], 0.0],
        ];
        let rotation: Matrix = std::array::from_fn(|a| {
            std::array::from_fn(|b| {
                let same = if a == b { c } else { 0.0 };
                same + s * cross[a][b] + (1.0 - c) * axis[a] * axis[b]
            })
        });
        let entry = |&(a, b): &(usize, usize)| {
            (0..3)
                .map(|k| rotation[a][k] * values[k] * rotation[b][k])
                .sum()
        };
        places(3).iter().map(entry).collect()
    }

    #[test]
    fn principal_stresses_are_the_eigenvalues_in_descending_order() {
        for values in [
            [3.0, -1.0, 0.5],
            [2.0, 2.0, -5.0],
            [1.0, 1.0, 1.0],
            [1e9, 1.0, -1e9],
        ] {
            let mut sorted: [f64; 3] = values;
            sorted.sort_by(|a, b| b.total_cmp(a));
            for angle in [0.0, 0.3, 1.2, 2.9] {
                let found = principal_stresses(3, &turned(values, angle));
                let size = values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
                for (found, value) in found.iter().zip(sorted) {
                    assert!((found - value).abs() < 4e-15 * size, "{values:?}: {found}");
                }
            }
        }
    }

    #[test]
    fn principal_stresses_in_the_plane_follow_mohrs_circle() {
        let (xx, yy, xy): (f64, f64, f64) = (3.0, -1.0, 1.5);
        let (middle, radius) = (0.5 * (xx + yy), (0.25 * (xx - yy).powi(2) + xy * xy).sqrt());
        let found = principal_stresses(2, &[xx, yy, xy]);
        assert!((found[0] - middle - radius).abs() < 1e-15);
        assert!((found[1] - middle + radius).abs() < 1e-15);
        let pressed = principal_stresses(2, &[-2.0, -1.0, 0.0]);
        assert_eq!(pressed, [-1.0, -2.0]);
        assert_eq!(principal_stresses(1, &[-2.0]), [-2.0]);
        assert!(principal_stresses(2, &[f64::NAN; 3])[0].is_nan());
    }
}
