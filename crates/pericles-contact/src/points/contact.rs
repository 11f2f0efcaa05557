//! Contact between points as an interaction.

use rayon::prelude::*;

use pericles::boundary::Exchange;
use pericles::operator::{Force, PointSubset};
use pericles::{Configuration, Interaction, InteractionStep, PointScalar, Result, StepEnd};

use super::{Listed, PointContact};
use crate::bodies::Touching;
use crate::law::PairLaw;
use crate::vector::{V3, dot, plus, scaled};

/// Points per task.
const TASK: usize = 128;

/// A pair in contact, seen from its first point.
#[derive(Debug, Clone, Copy)]
struct Contact {
    /// Direction from the first to the second point.
    normal: V3,
    /// Distance r, m.
    distance: f64,
    /// Overlap g, m, and contact distance d, m.
    overlap: f64,
    limit: f64,
    /// Stiffness k, N/m.
    stiffness: f64,
    /// Force with a potential, N.
    force: f64,
}

/// Sums over the contacts of a point.
#[derive(Debug, Clone, Copy, Default)]
struct OfPoint {
    force: V3,
    drag: V3,
    contacts: u64,
    overlap: f64,
}

impl Touching {
    /// Returns the contact of two points at displacement u, if they touch.
    #[inline]
    fn contact(&self, u: &[f64], [i, j]: [usize; 2]) -> Option<Contact> {
        let (n, x) = (self.cloud.len(), self.cloud.positions());
        let (mut xi, mut y) = ([0.0; 3], [0.0; 3]);
        for c in 0..self.cloud.dimension() {
            xi[c] = x[c * n + j] - x[c * n + i];
            y[c] = xi[c] + (u[c * n + j] - u[c * n + i]);
        }
        let square = dot(y, y);
        let size = self.law.distance * (0.5 * (self.size[i] + self.size[j]));
        // Points at the same place have no direction of contact.
        if square >= size * size || square == 0.0 {
            return None;
        }
        let distance = square.sqrt();
        let limit = size.min(self.law.closing * dot(xi, xi).sqrt());
        let overlap = limit - distance;
        if overlap <= 0.0 || overlap.is_nan() {
            return None;
        }
        let stiffness = self.pair_stiffness(i, j);
        Some(Contact {
            normal: y.map(|y| y / distance),
            distance,
            overlap,
            limit,
            stiffness,
            force: self.law.law.force(stiffness, limit, overlap),
        })
    }

    /// Returns the force of damper and friction of a contact on its first point, N.
    fn drag(&self, contact: &Contact, [i, j]: [usize; 2], step: &StepEnd<'_>) -> V3 {
        let n = self.cloud.len();
        let mut w = [0.0; 3];
        for c in 0..self.cloud.dimension() {
            w[c] = step.mean_velocity(c * n + j) - step.mean_velocity(c * n + i);
        }
        let (a, b) = (self.mass(i), self.mass(j));
        let reduced = a * b / (a + b);
        let speed = dot(w, contact.normal);
        let damper = 2.0 * self.law.damping * (contact.stiffness * reduced).sqrt();
        let pressure = (contact.force - damper * speed).max(0.0);
        let mut drag = scaled(contact.force - pressure, contact.normal);
        if let Some(friction) = self.law.friction {
            let along = plus(w, -speed, contact.normal);
            let smooth = (dot(along, along) + friction.speed * friction.speed).sqrt();
            drag = plus(drag, friction.coefficient * pressure / smooth, along);
        }
        drag
    }
}

impl PointContact {
    /// Evaluates `of_point` for the given points in parallel, in their order.
    fn each<T: Send>(&self, points: &[u32], of_point: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
        let points = points.par_iter().with_min_len(TASK);
        points.map(|&i| of_point(i as usize)).collect()
    }

    /// Adds vectors (N) at points as force densities.
    fn add_at(&self, points: &[u32], vectors: impl Iterator<Item = V3>, out: &mut [f64]) {
        let (n, volumes) = (self.touching.cloud.len(), self.touching.cloud.volumes());
        for (&i, vector) in points.iter().zip(vectors) {
            let i = i as usize;
            for c in 0..self.touching.cloud.dimension() {
                out[c * n + i] += vector[c] / volumes[i];
            }
        }
    }
}

impl Interaction for PointContact {
    fn name(&self) -> &str {
        "contact"
    }

    fn check(&self, forces: &dyn Force) -> Result<()> {
        self.touching.check_forces(forces)?;
        self.check_bonds(forces)
    }

    fn add_force(&self, at: &Configuration<'_>, on: &PointSubset<'_>, out: &mut [f64]) {
        let list = self.candidates(at);
        let mut wanted = Vec::new();
        let points = match on {
            PointSubset::All => list.exposed(),
            _ => {
                on.common(list.exposed(), |_, i| wanted.push(i as u32));
                &wanted
            }
        };
        let forces = self.each(points, |i| {
            let mut sum = [0.0; 3];
            for j in list.row(i) {
                if let Some(contact) = self.touching.contact(at.u, [i, j]) {
                    sum = plus(sum, -contact.force, contact.normal);
                }
            }
            sum
        });
        self.add_at(points, forces.into_iter(), out);
    }

    fn energy(&self, at: &Configuration<'_>) -> f64 {
        let list = self.candidates(at);
        let (law, points) = (self.touching.law.law, list.exposed());
        pericles::sum::sum(points.len(), |k| {
            let i = points[k] as usize;
            let contacts = list
                .row(i)
                .filter_map(|j| self.touching.contact(at.u, [i, j]));
            0.5 * contacts
                .map(|one| law.energy(one.force, one.overlap))
                .sum::<f64>()
        })
    }

    fn add_tangent(&self, at: &Configuration<'_>, direction: &[f64], out: &mut [f64]) {
        let list = self.candidates(at);
        let n = self.touching.cloud.len();
        let changes = self.each(list.exposed(), |i| {
            let mut sum = [0.0; 3];
            for j in list.row(i) {
                let Some(contact) = self.touching.contact(at.u, [i, j]) else {
                    continue;
                };
                let mut d = [0.0; 3];
                for c in 0..self.touching.cloud.dimension() {
                    d[c] = direction[c * n + j] - direction[c * n + i];
                }
                let along = dot(d, contact.normal);
                let slope = self.touching.law.law.slope(contact.force, contact.overlap);
                let turned = contact.force / contact.distance;
                sum = plus(sum, (slope + turned) * along, contact.normal);
                sum = plus(sum, -turned, d);
            }
            sum
        });
        self.add_at(list.exposed(), changes.into_iter(), out);
    }

    fn end_step(&mut self, end: &InteractionStep<'_>, out: &mut [f64]) -> Exchange {
        let step = end.step;
        let list = self.candidates(&end.configuration());
        let with_drag = !self.drag.is_empty();
        let sums = self.each(list.exposed(), |i| {
            let mut sum = OfPoint::default();
            for j in list.row(i) {
                let Some(contact) = self.touching.contact(step.u, [i, j]) else {
                    continue;
                };
                sum.force = plus(sum.force, -contact.force, contact.normal);
                sum.contacts += 1;
                sum.overlap = sum.overlap.max(contact.overlap / contact.limit);
                if with_drag {
                    let drag = self.touching.drag(&contact, [i, j], step);
                    sum.drag = plus(sum.drag, 1.0, drag);
                }
            }
            sum
        });
        self.pairs = sums.iter().map(|sum| sum.contacts).sum::<u64>() / 2;
        self.overlap = sums.iter().map(|sum| sum.overlap).fold(0.0, f64::max);
        let forces = sums.iter().map(|sum| plus(sum.force, 1.0, sum.drag));
        self.add_at(list.exposed(), forces, out);
        if with_drag {
            let (n, dimension) = (self.touching.cloud.len(), self.touching.cloud.dimension());
            let mut drag = vec![0.0; self.drag.len()];
            for (&i, sum) in list.exposed().iter().zip(&sums) {
                for c in 0..dimension {
                    drag[c * n + i as usize] = sum.drag[c];
                }
            }
            let power = pericles::sum::sum(drag.len(), |entry| {
                (drag[entry] + self.drag[entry]) * step.mean_velocity(entry)
            });
            self.dissipated -= 0.5 * step.dt * power;
            self.drag = drag;
        }
        Exchange::default()
    }

    fn add_drag(&self, out: &mut [f64]) {
        let (n, volumes) = (self.touching.cloud.len(), self.touching.cloud.volumes());
        for (entry, drag) in self.drag.iter().enumerate() {
            out[entry] += drag / volumes[entry % n];
        }
    }

    fn dissipated(&self) -> f64 {
        self.dissipated
    }

    /// For springs in series, k_ij (1/m_i + 1/m_j) = 2 (1/m_i + 1/m_j)/(1/k_i + 1/k_j) is at most twice the larger k/m.
    fn contact_frequency(&self, density: &PointScalar) -> f64 {
        let touching = &self.touching;
        let volumes = touching.cloud.volumes();
        let largest = volumes.iter().copied().fold(0.0, f64::max);
        let square = |i: usize| {
            let stiffness = match touching.law.law {
                PairLaw::Emu => touching.stiffness[i] * volumes[i] * largest,
                _ => touching.stiffness[i],
            };
            stiffness / (density.at(i) * volumes[i])
        };
        let most = (0..volumes.len()).map(square).fold(0.0, f64::max);
        (2.0 * touching.law.law.exponent() * most).sqrt()
    }

    fn is_conservative(&self) -> bool {
        self.touching.law.is_conservative()
    }

    fn overlap(&self) -> f64 {
        self.overlap
    }
}

pericles::saved! {
    impl Checkpointed for PointContact {
        drag: array("contact/drag"),
        dissipated: array("contact/dissipated"),
        pairs: array("contact/pairs"),
        overlap: array("contact/overlap"),
        touching, pieces, skin: fixed,
        list: set(std::sync::Mutex::new(Listed::default())),
    }
}
