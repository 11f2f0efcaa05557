//! Reference loop with which operators are compared.

use pericles::family::pairs_within;
use pericles::material::{BondConstants, BondMaterial};
use pericles::parallel::{components, components_mut};
use pericles::space::PointCloud;
use pericles::time::State;

/// Bond-stretch peridynamics as a plain loop: for every entry of a family it stores the neighbour, the
/// reference length, the stiffness c α κ V and whether the bond is intact, and computes a square root and a
/// division, on one thread.
///
/// f_i = Σ_j c α κ V_j s y/|y|, s = (|y| − |ξ|)/|ξ|, with y between deformed positions; bonds stretched
/// beyond s₀ are broken. Memory: 21 bytes per entry.
#[derive(Debug, Clone)]
pub struct StoredList {
    dimension: usize,
    positions: Vec<f64>,
    start: Vec<usize>,
    neighbours: Vec<u32>,
    lengths: Vec<f64>,
    stiffnesses: Vec<f64>,
    intact: Vec<bool>,
    critical_stretch: f64,
    density: f64,
}

impl StoredList {
    /// Creates the families of a body of one material.
    pub fn new(cloud: &PointCloud, material: &BondMaterial, constants: &BondConstants) -> Self {
        let spacing = cloud.spacing();
        let correction = material.volume_correction;
        let reach = correction.reach(material.horizon, spacing);
        let (start, neighbours) = pairs_within(cloud, reach);
        let mut list = Self {
            dimension: cloud.dimension(),
            positions: cloud.positions().to_vec(),
            lengths: Vec::with_capacity(neighbours.len()),
            stiffnesses: Vec::with_capacity(neighbours.len()),
            intact: vec![true; neighbours.len()],
            critical_stretch: constants.critical_stretch,
            density: material.density,
            start,
            neighbours,
        };
        for i in 0..cloud.len() {
            let here = cloud.point(i);
            for &j in &list.neighbours[list.start[i]..list.start[i + 1]] {
                let there = cloud.point(j as usize);
                let squares = (0..list.dimension).map(|c| (there[c] - here[c]).powi(2));
                let length = squares.sum::<f64>().sqrt();
                let volume = cloud.volumes()[j as usize]
                    * correction.factor(length, material.horizon, spacing);
                let micromodulus =
                    constants.micromodulus * material.influence.alpha(length, material.horizon);
                list.lengths.push(length);
                list.stiffnesses.push(micromodulus * volume);
            }
        }
        list
    }

    /// Returns the number of directed bonds: entries of all families.
    pub fn directed_bonds(&self) -> u64 {
        self.neighbours.len() as u64
    }

    /// Returns the memory, bytes.
    pub fn bytes(&self) -> usize {
        let entry = size_of::<u32>() + 2 * size_of::<f64>() + size_of::<bool>();
        self.neighbours.len() * entry + self.start.len() * size_of::<usize>()
    }

    /// Computes the force density at u in `out`, N/m³, after breaking bonds stretched beyond the limit.
    pub fn break_and_force(&mut self, u: &[f64], out: &mut [f64]) {
        match self.dimension {
            1 => self.sweep::<1>(u, out),
            2 => self.sweep::<2>(u, out),
            _ => self.sweep::<3>(u, out),
        }
    }

    fn sweep<const D: usize>(&mut self, u: &[f64], out: &mut [f64]) {
        let n = self.start.len() - 1;
        let x = components::<D>(&self.positions, n);
        let u = components::<D>(u, n);
        let out = components_mut::<D>(out, n);
        for i in 0..n {
            let here: [f64; D] = std::array::from_fn(|c| x[c][i] + u[c][i]);
            let mut force = [0.0; D];
            for entry in self.start[i]..self.start[i + 1] {
                if !self.intact[entry] {
                    continue;
                }
                let j = self.neighbours[entry] as usize;
                let y: [f64; D] = std::array::from_fn(|c| x[c][j] + u[c][j] - here[c]);
                let length = y.iter().map(|y| y * y).sum::<f64>().sqrt();
                let stretch = (length - self.lengths[entry]) / self.lengths[entry];
                if stretch > self.critical_stretch {
                    self.intact[entry] = false;
                    continue;
                }
                let factor = self.stiffnesses[entry] * stretch / length;
                for c in 0..D {
                    force[c] += factor * y[c];
                }
            }
            for c in 0..D {
                out[c][i] = force[c];
            }
        }
    }

    /// Advances one step of velocity Verlet without loads.
    pub fn step(&mut self, state: &mut State, dt: f64) {
        let State { t, step, u, v, a } = state;
        for ((u, v), a) in u.iter_mut().zip(v.iter_mut()).zip(a.iter()) {
            *v += 0.5 * dt * a;
            *u += dt * *v;
        }
        self.break_and_force(u, a);
        for (a, v) in a.iter_mut().zip(v) {
            *a /= self.density;
            *v += 0.5 * dt * *a;
        }
        *t += dt;
        *step += 1;
    }
}

#[cfg(test)]
mod tests {
    use crate::Case;
    use pericles::operator::PointSubset;
    use pericles::sum::max_norm;

    #[test]
    fn the_reference_loop_gives_the_forces_of_the_operators() {
        for name in ["bar-40", "plate-14", "block-9", "block-9-moved"] {
            let case = Case::named(name).unwrap();
            let (mut list, mut state) = case.stored_list().unwrap();
            let system = case.system().unwrap().0;
            let operator = system.operator();
            assert_eq!(list.directed_bonds(), operator.directed_bonds(), "{name}");
            for (u, v) in state.u.iter_mut().zip(&state.v) {
                *u = 1e-5 * v;
            }
            let (mut plain, mut fast) = (vec![0.0; state.u.len()], vec![0.0; state.u.len()]);
            list.break_and_force(&state.u, &mut plain);
            operator.add_force(0.0, &state.u, PointSubset::All, &mut fast);
            let largest = max_norm(&fast);
            for (a, b) in plain.iter().zip(&fast) {
                // The reference loop computes the difference of two lengths.
                assert!((a - b).abs() < 1e-10 * largest, "{name}: {a:e} {b:e}");
            }
        }
    }
}
