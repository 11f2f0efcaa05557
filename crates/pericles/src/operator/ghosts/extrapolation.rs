//! Extrapolation of displacements to ghost points.

use super::layer::{GhostLayer, rejected};
use crate::error::Result;
use crate::family::BondList;
use crate::parallel::for_each_point;
use crate::units::quantity;
use crate::vector::{cross, dot};

/// The matrix T of u_g = Σ_j T_gj u_j for each component: u_g = u_p + H_p (x_g − x_p), with the point p of
/// the body nearest to the ghost g and the displacement gradient H_p = (Σ_j V_j (u_j − u_p) ⊗ ξ) (Σ_j V_j
/// ξ ⊗ ξ)⁻¹ fitted to the points of the body in the family of p. If several points are equally near, the mean
/// is used, which preserves the symmetry of a body.
///
/// Uniform displacement gradients, and therefore rigid motions, are extrapolated exactly.
#[derive(Debug, Clone)]
pub(super) struct Extrapolation {
    /// Rows per ghost, with indices of points.
    rows: Rows,
    /// Columns per point of the body, with indices of ghosts.
    columns: Rows,
    /// Nearest point of each ghost, the first of several; `None` for ghosts without bonds to points.
    nearest: Vec<Option<u32>>,
}

/// The nearest point of the body and the weights of the points for a ghost.
type Row = (Option<u32>, Vec<(u32, f64)>);

/// A sparse matrix in compressed rows.
#[derive(Debug, Clone)]
struct Rows {
    start: Vec<usize>,
    entries: Vec<(u32, f64)>,
}

impl Rows {
    fn of(rows: Vec<Vec<(u32, f64)>>) -> Self {
        let mut start = vec![0];
        let mut entries = Vec::new();
        for row in rows {
            entries.extend(row);
            start.push(entries.len());
        }
        Self { start, entries }
    }

    fn row(&self, i: usize) -> &[(u32, f64)] {
        &self.entries[self.start[i]..self.start[i + 1]]
    }
}

type Matrix = [[f64; 3]; 3];

/// Geometry of a body and its ghosts.
struct Geometry<'a> {
    bonds: &'a BondList,
    layer: &'a GhostLayer,
    numbers: Vec<Option<u32>>,
    dimension: usize,
}

impl Extrapolation {
    /// Computes the extrapolation from the existing bonds of the body and its ghosts: displacements are not
    /// extrapolated across pre-cracks.
    ///
    /// # Errors
    /// Points whose neighbours lie on a line or in a plane.
    pub fn new(layer: &GhostLayer, bonds: &BondList) -> Result<Self> {
        let geometry = Geometry {
            bonds,
            layer,
            numbers: layer.numbers(),
            dimension: layer.cloud().dimension(),
        };
        let ghosts = layer.ghosts();
        let found = for_each_point(ghosts.len(), &|g| geometry.row(ghosts[g] as usize));
        let found: Vec<Row> = found.into_iter().collect::<Result<_>>()?;
        let mut columns = vec![Vec::new(); layer.body().len()];
        for (g, (_, row)) in found.iter().enumerate() {
            for &(i, weight) in row {
                columns[i as usize].push((g as u32, weight));
            }
        }
        let (nearest, rows) = found.into_iter().unzip();
        Ok(Self {
            rows: Rows::of(rows),
            columns: Rows::of(columns),
            nearest,
        })
    }

    /// Returns the points from which a ghost is extrapolated, and their weights.
    pub fn row(&self, ghost: usize) -> &[(u32, f64)] {
        self.rows.row(ghost)
    }

    /// Returns the ghosts that are extrapolated from a point, and the weights of the point.
    pub fn column(&self, point: usize) -> &[(u32, f64)] {
        self.columns.row(point)
    }

    /// Returns the point of the body nearest to a ghost; `None` for a ghost without bonds to points.
    pub fn nearest(&self, ghost: usize) -> Option<u32> {
        self.nearest[ghost]
    }

    /// Returns the memory use, bytes.
    pub fn bytes(&self) -> usize {
        [&self.rows, &self.columns]
            .iter()
            .map(|rows| size_of_val(&rows.entries[..]) + size_of_val(&rows.start[..]))
            .sum()
    }
}

impl Geometry<'_> {
    /// Returns the points of the body in the family of a place, with their places.
    fn in_body(&self, place: usize) -> impl Iterator<Item = (u32, usize)> + '_ {
        let family = self.bonds.family(place);
        let there = family.filter(|&(entry, _)| self.bonds.is_present(entry));
        there.filter_map(|(_, other)| Some((self.numbers[other]?, other)))
    }

    /// Returns the nearest point and the weights of a ghost.
    fn row(&self, ghost: usize) -> Result<Row> {
        /// Ratio up to which distances are considered equal.
        const EQUAL: f64 = 1.0 + 1e-6;
        let distance = |other: usize| self.bonds.length(ghost, other);
        let least = self
            .in_body(ghost)
            .map(|(_, other)| distance(other))
            .fold(f64::INFINITY, f64::min);
        let nearest: Vec<(u32, usize)> = self
            .in_body(ghost)
            .filter(|&(_, other)| distance(other) <= EQUAL * least)
            .collect();
        let share = 1.0 / nearest.len() as f64;
        let mut row: Vec<(u32, f64)> = Vec::new();
        for &(p, place) in &nearest {
            let mut own = 1.0;
            let along = self.coefficients(place, self.bonds.vector(place, ghost))?;
            for (j, other) in self.in_body(place) {
                let xi = self.bonds.vector(place, other);
                let weight = self.bonds.volume(other) * dot(along, xi);
                own -= weight;
                row.push((j, share * weight));
            }
            row.push((p, share * own));
        }
        row.sort_by_key(|&(j, _)| j);
        row.dedup_by(|next, kept| {
            let same = next.0 == kept.0;
            if same {
                kept.1 += next.1;
            }
            same
        });
        Ok((nearest.first().map(|&(p, _)| p), row))
    }

    /// Returns (Σ_j V_j ξ ⊗ ξ)⁻¹ d at a place for a vector d.
    fn coefficients(&self, place: usize, d: [f64; 3]) -> Result<[f64; 3]> {
        let mut shape = Matrix::default();
        for (_, other) in self.in_body(place) {
            let xi = self.bonds.vector(place, other);
            for (row, a) in shape.iter_mut().zip(xi) {
                for (entry, b) in row.iter_mut().zip(xi) {
                    *entry += self.bonds.volume(other) * a * b;
                }
            }
        }
        let trace: f64 = (0..self.dimension).map(|c| shape[c][c]).sum();
        let mean = trace / self.dimension as f64;
        (self.dimension..3).for_each(|c| shape[c][c] = mean);
        /// Determinant relative to that of an isotropic family below which neighbours lie on a line or in a
        /// plane.
        const SINGULAR: f64 = 1e-6;
        match solve(shape, d) {
            Some((solution, determinant)) if determinant > SINGULAR * mean.powi(3) => Ok(solution),
            _ => {
                let [x, y, z] = self.layer.cloud().point(place).map(|x| quantity(x, "m"));
                Err(rejected(format!(
                    "displacements cannot be extrapolated from the point at ({x}, {y}, {z}), because its neighbours lie on a line or in a plane; use at least two cells along each axis"
                )))
            }
        }
    }
}

/// Returns the solution of a symmetric system of three equations and its determinant; `None` if that is zero.
fn solve(matrix: Matrix, right: [f64; 3]) -> Option<([f64; 3], f64)> {
    let [a, b, c] = matrix;
    let cofactors = [cross(b, c), cross(c, a), cross(a, b)];
    let determinant = dot(a, cofactors[0]);
    let usable = determinant.is_finite() && determinant != 0.0;
    usable.then(|| {
        let solution = cofactors.map(|row| dot(row, right) / determinant);
        (solution, determinant)
    })
}
