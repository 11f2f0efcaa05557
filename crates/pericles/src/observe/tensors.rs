//! Stress and strain at points, from their bonds.
//!
//! Symmetric tensors are kept as their components xx (1D), xx, yy, xy (2D), xx, yy, zz, xy, yz, xz (3D), one after the other.

use rayon::prelude::*;

use crate::domain::Field;
use crate::operator::{BondAt, BondView};
use crate::parallel::BLOCK;
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

/// Von Mises' equivalent stress of stresses in the order of their components, Pa; of the components within the plane in two dimensions.
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

/// The virial stress σ_i = ½ Σ_j f_ij ⊗ (ξ + η), Pa, with the force densities f_ij of the bonds of point i; the symmetric part. In a body under uniform strain it is that of
/// the continuum; within a horizon of a surface bonds, and so parts of it, are missing.
pub(super) fn virial_stress(cloud: &PointCloud, bonds: &dyn BondView, u: &[f64]) -> Vec<f64> {
    let ghosts = cloud.domain().ghosts(u);
    let u = Field::new(u, &ghosts);
    per_point(cloud, |i| {
        let mut stress = Matrix::default();
        bonds.for_each_bond(u, i, &mut |bond: BondAt| {
            for a in 0..3 {
                for b in 0..3 {
                    stress[a][b] += 0.5 * bond.force[a] * (bond.xi[b] + bond.eta[b]);
                }
            }
        });
        stress
    })
}

/// The strain of the displacement gradient G that fits the bonds best: Σ_j V_j |η − G ξ|² is least. Zero where the bonds left do not span the space.
pub(super) fn fitted_strain(cloud: &PointCloud, bonds: &dyn BondView, u: &[f64]) -> Vec<f64> {
    let dimension = cloud.dimension();
    let ghosts = cloud.domain().ghosts(u);
    let u = Field::new(u, &ghosts);
    let volumes = cloud.domain().with_ghosts(cloud.volumes());
    per_point(cloud, |i| {
        let (mut shape, mut moment) = (Matrix::default(), Matrix::default());
        bonds.for_each_bond(u, i, &mut |bond: BondAt| {
            let volume = volumes[bond.neighbour];
            for a in 0..3 {
                for b in 0..3 {
                    shape[a][b] += volume * bond.xi[a] * bond.xi[b];
                    moment[a][b] += volume * bond.eta[a] * bond.xi[b];
                }
            }
        });
        let size = (0..dimension).map(|c| shape[c][c]).sum::<f64>();
        // Missing axes stand apart, so that the inverse is that of the others.
        for c in dimension..3 {
            shape[c][c] = size;
        }
        match inverse(&shape) {
            Some(inverse) => product(&moment, &inverse),
            None => Matrix::default(),
        }
    })
}

/// The symmetric parts of a matrix for every point, component-major.
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

/// None if the matrix is singular to round-off.
fn inverse(m: &Matrix) -> Option<Matrix> {
    let minor = |i: usize, j: usize| {
        let (a, b) = ((i + 1) % 3, (i + 2) % 3);
        let (c, d) = ((j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * minor(0, j)).sum();
    let size = (0..3).map(|c| m[c][c].abs()).fold(0.0, f64::max);
    if determinant.abs() <= 1e-9 * size.powi(3) {
        return None;
    }
    Some(std::array::from_fn(|i| {
        std::array::from_fn(|j| minor(j, i) / determinant)
    }))
}
