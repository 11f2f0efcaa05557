//! Nearest-neighbour surrogate: springs between neighbouring points that approximate the stiffness of the
//! body by a sparse matrix; the matrix of the body has hundreds of entries per row.
//!
//! A spring of stiffness k_ij = V_i V_j w (c_i + c_j) connects neighbouring points whose bond is intact. The
//! influence w makes the springs of a lattice isotropic: 1/r² with eight neighbours in the plane, 1 with
//! eighteen neighbours in space. The constant c_i is such that the energy of a point, summed over all unit
//! displacement gradients, equals that of the forces of the body; materials, surfaces and damage therefore
//! need no special treatment. The springs have Poisson's ratio 1/4 (1/3 in plane stress). For other values
//! the surrogate is a less accurate preconditioner, but its quality does not depend on the size of the body.
//!
//! On a body divided among processes each process selects the springs and evaluates the energies of its own points, and has
//! the surrogate of the whole body: matrix and multigrid are those of a single process, bit for bit. Their memory per
//! process does not decrease with the number of processes.

mod bonds;
mod probe;
mod rigid_modes;

pub use probe::{Resistance, Stiffness};
pub use rigid_modes::RigidModes;

use bonds::{Bond, Neighbours};

use pericles::System;
use pericles::domain::Replicated;

use crate::multigrid::{Multigrid, NearKernel};
use crate::sparse::{Number, SparseMatrix};
use crate::unknowns::Unknowns;

/// Surrogate of a body.
#[derive(Debug, Clone)]
pub struct Surrogate {
    neighbours: Neighbours,
    /// Constant c of each point.
    coefficients: Vec<f64>,
    resistance: Resistance,
    volumes: Vec<f64>,
    positions: Vec<f64>,
}

impl Surrogate {
    /// Creates the surrogate from the intact bonds of a body. Every process of a divided body has the surrogate of the whole
    /// body, with the same bits as on a single process. All processes must call it together.
    pub fn new(system: &System) -> Self {
        Self::with(system, None).0
    }

    /// Creates the surrogate of a body with a known stiffness, that of an earlier state with the same bonds, and returns it
    /// with the stiffness. If `None`, the stiffness is determined in the present state.
    pub fn with(system: &System, known: Option<Stiffness>) -> (Self, Stiffness) {
        let cloud = &*system.cloud().whole();
        let neighbours = Neighbours::of(system, cloud);
        let stiffness = known.unwrap_or_else(|| Stiffness::of(system, &neighbours));
        let resistance = stiffness.resistance;
        let replicated = Replicated::new(system.domain());
        let traces = &*replicated.of(&stiffness.traces);
        let d = system.dimension();
        let volumes = cloud.volumes().to_vec();
        let components = match resistance {
            Resistance::Stretch => 1,
            Resistance::Difference => d,
        };
        let mut coefficients: Vec<f64> = (0..cloud.len())
            .map(|i| {
                let bonds = neighbours.of_point(i).iter();
                let moment: f64 = bonds
                    .map(|bond| {
                        let square = bond.length_squared();
                        weight(d, square) * square * volumes[bond.neighbour as usize]
                    })
                    .sum();
                2.0 * traces[i] / (components as f64 * moment)
            })
            .collect();
        let usual = |c: f64| c.is_finite() && c > 0.0;
        let known: Vec<f64> = coefficients.iter().copied().filter(|&c| usual(c)).collect();
        let mean = match known.len() {
            0 => 1.0,
            count => known.iter().sum::<f64>() / count as f64,
        };
        for c in coefficients.iter_mut().filter(|c| !usual(**c)) {
            *c = mean;
        }
        let surrogate = Self {
            neighbours,
            coefficients,
            resistance,
            volumes,
            positions: cloud.positions().to_vec(),
        };
        (surrogate, stiffness)
    }

    /// Returns the positions of all points, m.
    pub(crate) fn positions(&self) -> &[f64] {
        &self.positions
    }

    /// Returns the deformations that bonds resist.
    pub fn resistance(&self) -> Resistance {
        self.resistance
    }

    /// Returns whether the body is periodic along an axis.
    pub fn is_periodic(&self, axis: usize) -> bool {
        self.neighbours.period[axis].is_some()
    }

    /// Returns whether a point has no neighbours.
    pub fn is_isolated(&self, i: usize) -> bool {
        self.neighbours.of_point(i).is_empty()
    }

    /// Returns for each axis whether an infinitesimal rotation of the whole body about it has no energy.
    pub fn rotations(&self, dimension: usize) -> [bool; 3] {
        let stretches = self.resistance == Resistance::Stretch;
        std::array::from_fn(|axis| {
            let turns = match dimension {
                1 => false,
                2 => axis == 2,
                _ => true,
            };
            let across = (0..3).filter(|&c| c != axis);
            stretches && turns && across.into_iter().all(|c| !self.is_periodic(c))
        })
    }

    /// Calls `visit` with the points of every pair of neighbours, in both orders.
    pub fn for_each_pair(&self, visit: &mut dyn FnMut(usize, usize)) {
        for i in 0..self.volumes.len() {
            for bond in self.neighbours.of_point(i) {
                visit(i, bond.neighbour as usize);
            }
        }
    }

    fn spring(&self, dimension: usize, i: usize, bond: &Bond) -> f64 {
        let j = bond.neighbour as usize;
        let w = weight(dimension, bond.length_squared());
        self.volumes[i] * self.volumes[j] * w * (self.coefficients[i] + self.coefficients[j])
    }

    /// Returns the stiffness matrix (N/m) of the unknowns, with all other components constrained.
    pub fn matrix(&self, unknowns: &Unknowns) -> SparseMatrix {
        let d = unknowns.dimension();
        let stiffest = self.reference_stiffness(d);
        SparseMatrix::from_rows(unknowns.len(), unknowns.len(), &|row, add| {
            let (i, c) = unknowns.point_and_axis(row);
            let mut own = 0.0;
            for bond in self.neighbours.of_point(i) {
                let k = self.spring(d, i, bond);
                let square = bond.length_squared();
                for axis in 0..d {
                    let part = match self.resistance {
                        Resistance::Stretch => bond.xi[c] * bond.xi[axis] / square,
                        Resistance::Difference => f64::from(u8::from(c == axis)),
                    };
                    /// Round-off of the cosine of a right angle.
                    const NOTHING: f64 = 1e-12;
                    if part.abs() < NOTHING {
                        continue;
                    }
                    if axis == c {
                        own += k * part;
                    }
                    if let Some(column) = unknowns.number(i, axis) {
                        add(column, k * part);
                    }
                    if let Some(column) = unknowns.number(bond.neighbour as usize, axis) {
                        add(column, -k * part);
                    }
                }
            }
            /// Fraction of the mean stiffness below which a component has no stiffness.
            const LOOSE: f64 = 1e-9;
            if own < LOOSE * stiffest {
                add(row, stiffest);
            }
        })
    }

    /// Returns the mean of the total spring stiffness of a point, N/m.
    fn reference_stiffness(&self, d: usize) -> f64 {
        let n = self.volumes.len();
        let of_point = |i: usize| -> f64 {
            let bonds = self.neighbours.of_point(i).iter();
            bonds.map(|bond| self.spring(d, i, bond)).sum()
        };
        let total = pericles::domain::Domain::alone(n).sum(n, of_point);
        if total > 0.0 { total / n as f64 } else { 1.0 }
    }

    /// Returns the displacements of low energy: translations and, unless the body is periodic or resists
    /// rotations, infinitesimal rotations.
    pub fn near_kernel(&self, unknowns: &Unknowns) -> NearKernel {
        let d = unknowns.dimension();
        let modes = RigidModes::new(d, self.rotations(d), &self.positions);
        let count = modes.count();
        let mut vectors = Vec::with_capacity(unknowns.len() * count);
        for row in 0..unknowns.len() {
            let (i, c) = unknowns.point_and_axis(row);
            vectors.extend((0..count).map(|k| modes.value(k, i, c)));
        }
        NearKernel {
            nodes: unknowns.nodes().to_vec(),
            count,
            vectors,
        }
    }

    /// Returns the multigrid preconditioner of the unknowns.
    pub fn preconditioner<T: Number>(&self, unknowns: &Unknowns) -> Multigrid<T> {
        Multigrid::new(self.matrix(unknowns), self.near_kernel(unknowns))
    }
}

/// Returns the influence that makes the springs of a lattice isotropic, for a squared length.
fn weight(dimension: usize, square: f64) -> f64 {
    match dimension {
        2 => 1.0 / square,
        _ => 1.0,
    }
}
