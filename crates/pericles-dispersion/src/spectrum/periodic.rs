//! Force operator of lattice bonds on a periodic box.

use pericles::operator::{
    Capabilities, Force, InstructionSet, LinearOperator, Linearity, PointSubset,
};
use pericles::parallel::{BLOCK, Cost, components, components_mut, for_each_block};
use pericles::sum::sum;
use pericles::{PericlesError, Result};

use super::super::lattice::BondLattice;

/// Bond of every point, in both directions.
#[derive(Debug, Clone, Copy)]
struct Spoke {
    /// a/|ξ|³ times the density.
    factor: f64,
    xi: [f64; 3],
    length: f64,
}

/// Linear force density of a [`BondLattice`] on a periodic box with `nodes` points along every axis: f_i = ρ Σ_ξ
/// a/|ξ|³ ξ (ξ·(u_{i+ξ} − u_i)).
///
/// Used to measure plane waves; bonds do not break. Points are in grid order, x fastest. Memory: 4 bytes per bond
/// of each point.
pub struct PeriodicForce {
    dimension: usize,
    points: usize,
    volume: f64,
    density: f64,
    spokes: Vec<Spoke>,
    /// Other end of spoke s of point i: entry `i * spokes + s`.
    ends: Vec<u32>,
}

impl PeriodicForce {
    /// Creates the force density of a lattice with mass density `density` (kg/m³) on cells of volume `volume` (m³).
    ///
    /// # Errors
    /// Fewer than two points along an axis, or more than a billion in total.
    pub fn new(lattice: &BondLattice, nodes: usize, volume: f64, density: f64) -> Result<Self> {
        const LIMIT: u64 = 1_000_000_000;
        if nodes < 2 {
            return Err(PericlesError::OutOfRange {
                quantity: "the number of points along an axis of a periodic box",
                value: nodes as f64,
                allowed: "at least 2",
            });
        }
        let dimension = lattice.dimension();
        let cells = (nodes as f64).powi(dimension as i32);
        if cells > LIMIT as f64 {
            return Err(PericlesError::TooManyPoints {
                cells,
                limit: LIMIT,
            });
        }
        let points = nodes.pow(dimension as u32);
        let mut spokes = Vec::new();
        let mut offsets = Vec::new();
        for bond in lattice.bonds() {
            for sign in [1, -1] {
                spokes.push(Spoke {
                    factor: density * bond.stiffness / bond.length.powi(3),
                    xi: bond.xi.map(|x| f64::from(sign) * x),
                    length: bond.length,
                });
                offsets.push(bond.offset.map(|c| sign * c));
            }
        }
        let mut ends = Vec::with_capacity(points * spokes.len());
        for i in 0..points {
            let place = [i % nodes, i / nodes % nodes, i / nodes / nodes];
            for offset in &offsets {
                let mut end = 0;
                for c in (0..dimension).rev() {
                    let moved = place[c] as i64 + i64::from(offset[c]);
                    end = end * nodes + moved.rem_euclid(nodes as i64) as usize;
                }
                ends.push(end as u32);
            }
        }
        Ok(Self {
            dimension,
            points,
            volume,
            density,
            spokes,
            ends,
        })
    }

    /// Calls `visit(spoke, ξ·η)` for the bonds of a point.
    #[inline]
    fn each_bond<const D: usize>(
        &self,
        u: &[&[f64]; D],
        i: usize,
        mut visit: impl FnMut(&Spoke, f64),
    ) {
        let here: [f64; D] = std::array::from_fn(|c| u[c][i]);
        let ends = &self.ends[i * self.spokes.len()..][..self.spokes.len()];
        for (spoke, end) in self.spokes.iter().zip(ends) {
            let mut along = 0.0;
            for c in 0..D {
                along += spoke.xi[c] * (u[c][*end as usize] - here[c]);
            }
            visit(spoke, along);
        }
    }

    fn force_of<const D: usize>(&self, u: &[&[f64]; D], i: usize) -> [f64; D] {
        let mut force = [0.0; D];
        self.each_bond(u, i, |spoke, along| {
            for c in 0..D {
                force[c] += spoke.factor * along * spoke.xi[c];
            }
        });
        force
    }

    fn add<const D: usize>(&self, u: &[f64], on: &PointSubset<'_>, out: &mut [f64]) {
        let n = self.points;
        let u = components::<D>(u, n);
        let mut out = components_mut::<D>(out, n);
        match on {
            PointSubset::All => {
                let mut nothing = vec![(); n.div_ceil(BLOCK)];
                let cost = Cost::bonds(self.directed_bonds());
                for_each_block(out, &mut nothing, cost, &|first, out, ()| {
                    for k in 0..out[0].len() {
                        let force = self.force_of(&u, first + k);
                        for c in 0..D {
                            out[c][k] += force[c];
                        }
                    }
                });
            }
            PointSubset::Range(_) | PointSubset::Set(_) => {
                let mut put = |i: usize| {
                    let force = self.force_of(&u, i);
                    for c in 0..D {
                        out[c][i] += force[c];
                    }
                };
                match on {
                    PointSubset::Range(range) => range.clone().for_each(&mut put),
                    PointSubset::Set(set) => set.iter().for_each(|i| put(*i as usize)),
                    PointSubset::All => {}
                }
            }
        }
    }

    fn energy_density_of<const D: usize>(&self, u: &[&[f64]; D], i: usize) -> f64 {
        let mut energy = 0.0;
        // ½ c s² |ξ| of every bond, half of it at each end; s |ξ|² = ξ·η.
        self.each_bond(u, i, |spoke, along| {
            energy += 0.25 * spoke.factor * along * along;
        });
        energy
    }

    fn energy_density(&self, u: &[f64], i: usize) -> f64 {
        let n = self.points;
        match self.dimension {
            1 => self.energy_density_of(&components::<1>(u, n), i),
            2 => self.energy_density_of(&components::<2>(u, n), i),
            _ => self.energy_density_of(&components::<3>(u, n), i),
        }
    }
}

impl Force for PeriodicForce {
    fn points(&self) -> usize {
        self.points
    }

    fn dimension(&self) -> usize {
        self.dimension
    }

    fn add_force(&self, _t: f64, u: &[f64], on: PointSubset<'_>, out: &mut [f64]) {
        match self.dimension {
            1 => self.add::<1>(u, &on, out),
            2 => self.add::<2>(u, &on, out),
            _ => self.add::<3>(u, &on, out),
        }
    }

    fn add_energy_density(&self, _t: f64, u: &[f64], out: &mut [f64]) {
        for (i, energy) in out.iter_mut().enumerate() {
            *energy += self.energy_density(u, i);
        }
    }

    fn energy(&self, _t: f64, u: &[f64]) -> f64 {
        self.volume * sum(self.points, |i| self.energy_density(u, i))
    }

    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let least = (0..self.points).map(density).fold(f64::INFINITY, f64::min);
        // M is at most Σ 2a/|ξ| over all bonds; negative stiffnesses do not reduce the bound.
        let sum: f64 = self
            .spokes
            .iter()
            .map(|s| 2.0 * s.factor.abs() * s.length * s.length)
            .sum();
        (sum / least).sqrt()
    }

    fn tangent_into(&self, t: f64, _u: &[f64], direction: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.add_force(t, direction, PointSubset::All, out);
    }

    fn directed_bonds(&self) -> u64 {
        self.ends.len() as u64
    }

    fn bytes(&self) -> usize {
        size_of_val(&self.ends[..]) + size_of_val(&self.spokes[..])
    }

    fn instruction_set(&self) -> InstructionSet {
        InstructionSet::Baseline
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            linear: Linearity::Exact(self),
            ..Capabilities::default()
        }
    }
}

impl LinearOperator for PeriodicForce {
    fn apply_into(&self, u: &[f64], out: &mut [f64]) {
        self.tangent_into(0.0, u, u, out);
    }
}

pericles::saved! {
    impl Checkpointed for PeriodicForce {
        dimension, points, volume, density, spokes, ends: fixed,
    }
}

impl PeriodicForce {
    /// Mass density of the lattice, kg/m³.
    pub fn density(&self) -> f64 {
        self.density
    }
}
