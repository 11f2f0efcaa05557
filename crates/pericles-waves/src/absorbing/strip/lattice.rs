//! Lattice beyond the boundary of a strip: bonds that are the same in all rows.

use std::f64::consts::TAU;

use crate::absorbing::{AbsorbingError, Side};
use pericles::System;
use pericles::sum::max_norm;

/// 2 × 2 matrix.
pub(super) type Matrix = [[f64; 2]; 2];

/// Lattice beyond a boundary, derived from the outermost points of a body.
///
/// Offsets d count columns outwards, l rows along +y (less than half the rows in size).
#[derive(Debug, Clone)]
pub struct StripLattice {
    /// Points of the body's outer columns, by depth and row.
    pub(super) points: Vec<Vec<usize>>,
    /// Mass of a point, kg.
    pub(super) mass: f64,
    /// A_{d,l}, 1/s², for d = 0 … K and l = 0 … rows − 1; indices above rows/2 stand for negative offsets.
    bonds: Vec<Vec<Matrix>>,
}

/// Relative difference (to the largest) below which bond matrices are considered equal.
const TOLERANCE: f64 = 1e-11;

impl StripLattice {
    /// Derives the lattice from a body: a plate on a square grid, full rows, periodic along y. The bonds are those
    /// of the tangent of its outermost point, and are compared with those of all columns of the outer layer.
    ///
    /// # Errors
    /// [`AbsorbingError::NotAStrip`] with the reason.
    pub fn of(system: &System, side: Side) -> Result<Self, AbsorbingError> {
        let not = |reason| Err(AbsorbingError::NotAStrip { reason });
        let cloud = system.cloud();
        if cloud.dimension() != 2 {
            return not("the body is not a plate");
        }
        let Some(columns) = columns(system, side) else {
            return not("its points are not a full rectangle of equal cells");
        };
        let rows = columns[0].len();
        let n = cloud.len();
        let response = |i: usize| -> [Vec<f64>; 2] {
            std::array::from_fn(|c| {
                let (rest, mut unit) = (vec![0.0; 2 * n], vec![0.0; 2 * n]);
                unit[c * n + i] = 1.0;
                let mut out = rest.clone();
                system.operator().tangent_into(0.0, &rest, &unit, &mut out);
                let density = |k: usize| system.density().at(k % n);
                out.iter_mut()
                    .enumerate()
                    .for_each(|(k, x)| *x /= density(k));
                out
            })
        };
        // Matrix of the bond from point i to point j.
        let matrix = |from: &[Vec<f64>; 2], j: usize| -> Matrix {
            std::array::from_fn(|a| std::array::from_fn(|b| from[b][a * n + j]))
        };
        let size = |m: &Matrix| max_norm(m.iter().flatten());
        let own = response(columns[0][0]);
        let all = || columns.iter().flatten().filter(|&&j| j != columns[0][0]);
        let strongest = all().map(|&j| size(&matrix(&own, j))).fold(0.0, f64::max);
        let reaches = |column: &Vec<usize>| {
            let bond =
                |&j: &usize| j != columns[0][0] && size(&matrix(&own, j)) > TOLERANCE * strongest;
            column.iter().any(bond)
        };
        let reach = columns.iter().rposition(reaches).unwrap_or(0);
        if reach == 0 || columns.len() < 2 * reach {
            return not("it is shorter than two horizons");
        }
        // A bond inwards and upwards is a bond outwards and downwards from its other end.
        let bond = |d: usize, l: usize| match (d, l) {
            (0, 0) => Matrix::default(),
            _ => matrix(&own, columns[d][(rows - l) % rows]),
        };
        let bonds: Vec<Vec<Matrix>> = (0..=reach)
            .map(|d| (0..rows).map(|l| bond(d, l)).collect())
            .collect();
        let lattice = Self {
            points: columns[..reach].to_vec(),
            mass: system.density().at(columns[0][0]) * cloud.volumes()[columns[0][0]],
            bonds,
        };
        lattice.check_mirror(strongest)?;
        for depth in 0..reach {
            // A different row for each depth.
            let row = (7 * depth + 1) % rows;
            let from = response(columns[depth][row]);
            for (other, column) in columns[..reach].iter().enumerate() {
                for (place, &j) in column.iter().enumerate() {
                    let up = (place + rows - row) % rows;
                    let (d, l) = match other < depth {
                        true => (depth - other, up),
                        false => (other - depth, (rows - up) % rows),
                    };
                    if (d, l) == (0, 0) {
                        continue;
                    }
                    let expected = lattice.bonds[d][l];
                    let found = matrix(&from, j);
                    let apart = |a: usize, b: usize| (found[a][b] - expected[a][b]).abs();
                    let worst = [apart(0, 0), apart(0, 1), apart(1, 0), apart(1, 1)];
                    if worst.iter().any(|gap| *gap > TOLERANCE * strongest) {
                        return not("its outer layer is not homogeneous");
                    }
                }
            }
        }
        Ok(lattice)
    }

    /// Checks that bonds along +y and −y are mirror images; otherwise the matrices of the modes are not real.
    fn check_mirror(&self, strongest: f64) -> Result<(), AbsorbingError> {
        let rows = self.rows();
        for column in &self.bonds {
            for (l, one) in column.iter().enumerate() {
                let other = column[(rows - l) % rows];
                let gaps = [
                    one[0][0] - other[0][0],
                    one[1][1] - other[1][1],
                    one[0][1] + other[0][1],
                    one[1][0] + other[1][0],
                ];
                // A bond across half of the rows belongs to both directions.
                let is_half = 2 * l == rows;
                if !is_half && gaps.iter().any(|gap| gap.abs() > TOLERANCE * strongest) {
                    let reason = "its bonds upwards and downwards differ";
                    return Err(AbsorbingError::NotAStrip { reason });
                }
            }
        }
        Ok(())
    }

    /// Reach K, columns.
    pub fn reach(&self) -> usize {
        self.points.len()
    }

    /// Number of points along y.
    pub fn rows(&self) -> usize {
        self.points[0].len()
    }

    /// C_d of a mode for d = 0 … K outwards, without the diagonal stiffness of a point; the matrix inwards is the
    /// transpose.
    pub(super) fn couplings(&self, mode: usize) -> Vec<Matrix> {
        let rows = self.rows();
        let of_column = |column: &Vec<Matrix>| {
            let mut sum = Matrix::default();
            for (l, a) in column.iter().enumerate() {
                let theta = TAU * ((mode * l) % rows) as f64 / rows as f64;
                let (sin, cos) = theta.sin_cos();
                sum[0][0] += cos * a[0][0];
                sum[1][1] += cos * a[1][1];
                sum[0][1] += sin * a[0][1];
                sum[1][0] -= sin * a[1][0];
            }
            sum
        };
        self.bonds.iter().map(of_column).collect()
    }

    /// Σ A over the bonds to columns d = `nearest` … K, for both components.
    pub(super) fn stiffness_beyond(&self, nearest: usize) -> [f64; 2] {
        let bonds = self.bonds[nearest..].iter().flatten();
        bonds.fold([0.0; 2], |sum, a| [sum[0] + a[0][0], sum[1] + a[1][1]])
    }

    /// Σ A over all bonds of a point of the lattice, for both components.
    pub(super) fn stiffness_of_point(&self) -> [f64; 2] {
        let (all, beyond) = (self.stiffness_beyond(0), self.stiffness_beyond(1));
        [all[0] + beyond[0], all[1] + beyond[1]]
    }

    /// Upper bound of the group velocity along x, columns per second: (Σ d² A)^½, of either component.
    pub fn fastest(&self) -> f64 {
        let mut square = [0.0; 2];
        for d in 1..=self.reach() {
            for a in &self.bonds[d] {
                square[0] += (d * d) as f64 * a[0][0].abs();
                square[1] += (d * d) as f64 * a[1][1].abs();
            }
        }
        square[0].max(square[1]).sqrt()
    }
}

/// Points by column from the end inwards, and by row upwards; `None` if they are not a full rectangle.
fn columns(system: &System, side: Side) -> Option<Vec<Vec<usize>>> {
    let cloud = system.cloud();
    let number = |axis: usize, i: usize| {
        let least = cloud
            .axis(axis)
            .iter()
            .fold(f64::INFINITY, |a, x| a.min(*x));
        ((cloud.axis(axis)[i] - least) / cloud.spacing()).round() as usize
    };
    let places: Vec<[usize; 2]> = (0..cloud.len())
        .map(|i| [number(0, i), number(1, i)])
        .collect();
    let count = |axis: usize| places.iter().map(|place| place[axis]).max().map(|m| m + 1);
    let (across, rows) = (count(0)?, count(1)?);
    if across * rows != cloud.len() {
        return None;
    }
    let mut columns = vec![vec![usize::MAX; rows]; across];
    for (i, &[x, y]) in places.iter().enumerate() {
        columns[x][y] = i;
    }
    if side == Side::Right {
        columns.reverse();
    }
    let full = columns.iter().flatten().all(|&i| i != usize::MAX);
    full.then_some(columns)
}
