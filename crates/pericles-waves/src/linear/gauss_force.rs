//! Linear force on a bar with two Gauss nodes per cell.

use std::sync::Arc;

use super::energy::{elastic_energy, origin};
use super::toeplitz::{Ends, Toeplitz};
use super::wanted::for_each_wanted;
use super::{features_of, reject, require};
use crate::form::ForceForm;
use pericles::family::VolumeCorrection;
use pericles::material::{BondConstants, BondMaterial};
use pericles::operator::pool::Pool;
use pericles::operator::{
    Capabilities, Force, InstructionSet, LinearOperator, Linearity, PointSubset,
};
use pericles::space::PointCloud;
use pericles::{PericlesError, Result};

/// Force density f_i = Σ_j c α κ V/|ξ| (u_j − u_i) on the nodes of [`gauss_bar`](pericles::space::gauss_bar), with
/// free ends.
///
/// Equal to the bond list to round-off. Nodes at the same position within their cells form a Toeplitz matrix, those
/// at different positions another one and its transpose: four [`Toeplitz`] products of half the size, O(n log n)
/// for any horizon. A rigid translation gives exactly zero. Memory: O(n).
pub struct GaussForce {
    cloud: Arc<PointCloud>,
    /// Products between nodes at the same position in their cells.
    same: Toeplitz,
    /// Products of first nodes with second nodes, and of second nodes with first nodes.
    across: [Toeplitz; 2],
    /// Their sums over the existing nodes.
    sums: [Vec<f64>; 2],
    directed_bonds: u64,
    work: Pool<Work>,
}

struct Work {
    halves: [Vec<f64>; 2],
    product: Vec<f64>,
    force: Vec<f64>,
}

impl GaussForce {
    /// Returns true if the points are the two Gauss nodes of equal cells of a bar.
    pub fn fits(cloud: &PointCloud) -> bool {
        cell_of(cloud).is_some()
    }

    /// Creates the operator of a material on a bar.
    ///
    /// # Errors
    /// Unsupported cases, with the reason: other points, a nonlinear pair law, breaking.
    pub fn new(
        cloud: Arc<PointCloud>,
        material: &BondMaterial,
        constants: &BondConstants,
    ) -> Result<Self> {
        require(ForceForm::Convolution, features_of(material, constants, 1))?;
        let stiffness = |r| constants.micromodulus * material.influence.alpha(r, material.horizon);
        Self::with_stiffness(
            cloud,
            material.horizon,
            material.volume_correction,
            stiffness,
        )
    }

    /// Creates an operator whose bonds have the stiffness c α given as a function of their length, m.
    ///
    /// # Errors
    /// Points that are not Gauss nodes of equal cells; a horizon that contains no node; a stiffness that is not
    /// finite.
    pub fn with_stiffness(
        cloud: Arc<PointCloud>,
        horizon: f64,
        correction: VolumeCorrection,
        stiffness: impl Fn(f64) -> f64,
    ) -> Result<Self> {
        let Some(cell) = cell_of(&cloud) else {
            return reject(
                "the points are not the two Gauss nodes of equal cells of a bar; use the bond list",
            );
        };
        let cells = cloud.len() / 2;
        let between = cell / 3.0f64.sqrt();
        let (node, volume) = (cloud.spacing(), cloud.volumes()[0]);
        let reach = correction.reach(horizon, node);
        let weight = |r: f64| {
            if r <= reach {
                stiffness(r) * correction.factor(r, horizon, node) * volume / r
            } else {
                0.0
            }
        };
        let most = (((reach + between) / cell).floor() as usize).min(cells - 1);
        let line = |shift: f64| -> Vec<f64> {
            (1..=most)
                .map(|r| weight(r as f64 * cell + shift))
                .collect()
        };
        let (same, longer, shorter, centre) =
            (line(0.0), line(between), line(-between), weight(between));
        let bonds = |weights: &[f64]| -> u64 {
            let pairs = weights.iter().enumerate().filter(|(_, w)| **w != 0.0);
            pairs.map(|(k, _)| (cells - 1 - k) as u64).sum()
        };
        let directed_bonds = 2
            * (2 * bonds(&same)
                + bonds(&longer)
                + bonds(&shorter)
                + if centre == 0.0 { 0 } else { cells as u64 });
        if directed_bonds == 0 {
            return Err(PericlesError::HorizonTooSmall {
                horizon,
                spacing: between.min(cell - between),
            });
        }
        let product = |below: &[f64], above: &[f64]| {
            Toeplitz::product(cells, centre, below, above, Ends::Zero)
        };
        let across = [product(&shorter, &longer)?, product(&longer, &shorter)?];
        let sums = [(&shorter, &longer), (&longer, &shorter)]
            .map(|(below, above)| sums(cells, centre, below, above));
        Ok(Self {
            same: Toeplitz::stencil(cells, &same, Ends::Free)?,
            across,
            sums,
            directed_bonds,
            work: Pool::new(1, move || Work {
                halves: [vec![0.0; cells], vec![0.0; cells]],
                product: vec![0.0; cells],
                force: vec![0.0; 2 * cells],
            }),
            cloud,
        })
    }

    /// Computes the products of the values relative to a common origin.
    fn products(&self, u: impl Fn(usize) -> f64, work: &mut Work) {
        for (place, half) in work.halves.iter_mut().enumerate() {
            for (k, half) in half.iter_mut().enumerate() {
                *half = u(2 * k + place);
            }
        }
        for place in 0..2 {
            let own = &work.halves[place];
            self.same.apply_into(own, &mut work.product);
            for (k, value) in work.product.iter().enumerate() {
                work.force[2 * k + place] = *value;
            }
            self.across[place].apply_into(&work.halves[1 - place], &mut work.product);
            for (k, value) in work.product.iter().enumerate() {
                work.force[2 * k + place] += value - self.sums[place][k] * own[k];
            }
        }
    }
}

/// Returns the width of the cells whose Gauss nodes the points are.
fn cell_of(cloud: &PointCloud) -> Option<f64> {
    let cell = 2.0 * cloud.spacing();
    let between = cell / 3.0f64.sqrt();
    let n = cloud.len();
    if cloud.dimension() != 1 || cloud.lattice().is_some() || n < 2 || !n.is_multiple_of(2) {
        return None;
    }
    let x = cloud.axis(0);
    // Round-off of positions is relative to their size, which may be large compared with a cell.
    let tolerance = 1e-9 * cell + 1e-15 * x[0].abs().max(x[n - 1].abs());
    let fits = (0..n).all(|k| {
        let place = (k / 2) as f64 * cell + if k % 2 == 0 { 0.0 } else { between };
        (x[k] - x[0] - place).abs() <= tolerance * (1.0 + k as f64 * 1e-3)
    });
    let volumes = cloud.volumes();
    let equal = volumes.iter().all(|v| (v / volumes[0] - 1.0).abs() < 1e-12);
    (fits && equal).then_some(cell)
}

/// Sum of the coefficients whose partner exists, for every node of a line.
fn sums(nodes: usize, centre: f64, below: &[f64], above: &[f64]) -> Vec<f64> {
    let partial = |t: &[f64]| {
        let mut sum = vec![0.0];
        for (r, t) in t.iter().enumerate() {
            sum.push(sum[r] + t);
        }
        sum
    };
    let (down, up) = (partial(below), partial(above));
    (0..nodes)
        .map(|i| centre + down[i.min(below.len())] + up[(nodes - 1 - i).min(above.len())])
        .collect()
}

impl LinearOperator for GaussForce {
    fn apply_into(&self, u: &[f64], out: &mut [f64]) {
        let [origin] = origin(u);
        let mut work = self.work.take();
        self.products(|i| u[i] - origin, &mut work);
        out.copy_from_slice(&work.force);
    }

    fn half_bandwidth(&self) -> Option<usize> {
        let cells = self.same.reach().max(self.across[0].reach());
        Some((2 * cells + 1).min(self.points() - 1))
    }
}

impl Force for GaussForce {
    fn points(&self) -> usize {
        self.cloud.len()
    }

    fn dimension(&self) -> usize {
        1
    }

    fn add_force(&self, _t: f64, u: &[f64], on: PointSubset<'_>, out: &mut [f64]) {
        let [origin] = origin(u);
        let mut work = self.work.take();
        self.products(|i| u[i] - origin, &mut work);
        for_each_wanted(&on, 0..u.len(), |points| {
            for (out, force) in out[points.clone()].iter_mut().zip(&work.force[points]) {
                *out += force;
            }
        });
    }

    /// Energy density w_i = ¼ Σ_j k (u_j² − u_i²) − ½ f_i u_i, relative to a common origin.
    fn add_energy_density(&self, _t: f64, u: &[f64], out: &mut [f64]) {
        let [origin] = origin(u);
        let mut work = self.work.take();
        self.products(|i| (u[i] - origin).powi(2), &mut work);
        for (out, square) in out.iter_mut().zip(&work.force) {
            *out += 0.25 * square;
        }
        self.products(|i| u[i] - origin, &mut work);
        for ((out, force), u) in out.iter_mut().zip(&work.force).zip(u) {
            *out -= 0.5 * force * (u - origin);
        }
    }

    /// Energy −½ Σ V f·u.
    fn energy(&self, _t: f64, u: &[f64]) -> f64 {
        let [origin] = origin(u);
        let mut work = self.work.take();
        self.products(|i| u[i] - origin, &mut work);
        elastic_energy(self.cloud.volumes(), u, &work.force, [origin])
    }

    /// Gershgorin bound ω² ≤ max_i (2/ρ_i) Σ_j |k_ij|; for functions without negative values.
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let row = |i: usize| self.sums[i % 2][i / 2] - self.same.diagonal(i / 2);
        let largest =
            (0..self.points()).fold(0.0f64, |largest, i| largest.max(2.0 * row(i) / density(i)));
        (largest * (1.0 + 1e-12)).sqrt()
    }

    fn tangent_into(&self, _t: f64, _u: &[f64], direction: &[f64], out: &mut [f64]) {
        self.apply_into(direction, out);
    }

    /// Number of bonds represented by the products; no loop runs over them.
    fn directed_bonds(&self) -> u64 {
        self.directed_bonds
    }

    fn bytes(&self) -> usize {
        let lines = self.same.bytes() + self.across.iter().map(Toeplitz::bytes).sum::<usize>();
        lines + 4 * self.points() * size_of::<f64>()
    }

    fn instruction_set(&self) -> InstructionSet {
        InstructionSet::detect()
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            linear: Linearity::Exact(self),
            ..Capabilities::default()
        }
    }
}

pericles::saved! {
    impl Checkpointed for GaussForce {
        cloud, same, across, sums, directed_bonds: fixed,
        work: scratch,
    }
}
