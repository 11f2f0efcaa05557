//! Contact between points as an interaction.

use rayon::prelude::*;

use pericles::boundary::Exchange;
use pericles::operator::{Force, PointSubset};
use pericles::{Configuration, Interaction, InteractionStep, PointScalar, Result};

use super::search::Candidates;
use super::{Listed, PointContact};
use crate::bodies::Touching;
use crate::law::PairLaw;
use crate::vector::{V3, dot, minus, plus, scaled};

/// Points per task.
const TASK: usize = 128;

/// Relative margin of the first test of a pair, far above the rounding errors of differences of positions.
const MARGIN: f64 = 1e-6;

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
pub(super) struct OfPoint {
    force: V3,
    drag: V3,
    contacts: u64,
    overlap: f64,
}

/// Memory of the evaluation at the end of a step.
#[derive(Debug, Default)]
pub(super) struct Work {
    places: Vec<V3>,
    sums: Vec<OfPoint>,
}

impl Touching {
    /// Returns the vector (m) from one point to another in the reference configuration and at displacement u.
    #[inline(always)]
    fn apart<const D: usize>(&self, u: &[f64], [i, j]: [usize; 2]) -> [V3; 2] {
        let (n, x) = (self.cloud.len(), self.cloud.positions());
        let (mut xi, mut y) = ([0.0; 3], [0.0; 3]);
        for c in 0..D {
            xi[c] = x[c * n + j] - x[c * n + i];
            y[c] = xi[c] + (u[c * n + j] - u[c * n + i]);
        }
        [xi, y]
    }

    /// Returns the contact of two points at displacement u, if they touch.
    #[inline(always)]
    fn contact(&self, u: &[f64], [i, j]: [usize; 2]) -> Option<Contact> {
        // Loops over components of known number are unrolled.
        let [xi, y] = match self.cloud.dimension() {
            1 => self.apart::<1>(u, [i, j]),
            2 => self.apart::<2>(u, [i, j]),
            _ => self.apart::<3>(u, [i, j]),
        };
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
            normal: scaled(1.0 / distance, y),
            distance,
            overlap,
            limit,
            stiffness,
            force: self.law.law.force(stiffness, limit, overlap),
        })
    }

    /// Returns the force of damper and friction of a contact on its first point, N. `velocity` has the entries of the mean
    /// velocity of the step, m/s.
    fn drag(&self, contact: &Contact, [i, j]: [usize; 2], velocity: impl Fn(usize) -> f64) -> V3 {
        let n = self.cloud.len();
        let mut w = [0.0; 3];
        for c in 0..self.cloud.dimension() {
            w[c] = velocity(c * n + j) - velocity(c * n + i);
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

/// The points and pairs of an evaluation: own points, and points of other processes near them.
#[derive(Clone, Copy)]
struct Evaluation<'a> {
    list: &'a Candidates,
    touching: &'a Touching,
    /// Displacement of all points, m.
    u: &'a [f64],
    /// Positions of the points that may touch others, m; other entries have no meaning.
    places: &'a [V3],
}

impl<'a> Evaluation<'a> {
    /// Determines the positions of the points at displacement u, in memory that is used again.
    fn new(
        list: &'a Candidates,
        touching: &'a Touching,
        u: &'a [f64],
        places: &'a mut Vec<V3>,
    ) -> Self {
        places.resize(touching.cloud.len(), [0.0; 3]);
        let tasks = places.par_chunks_mut(TASK).enumerate();
        tasks.for_each(|(task, places)| {
            for &i in within(list.exposed(), task).1 {
                let i = i as usize;
                places[i - task * TASK] = touching.place(u, i);
            }
        });
        for i in list.nearby().own_points()..touching.cloud.len() {
            places[i] = touching.place(u, i);
        }
        Self {
            list,
            touching,
            u,
            places,
        }
    }

    /// Calls `found` for the contacts of own point i, in ascending order of the other points.
    #[inline(always)]
    fn visit(&self, i: usize, mut found: impl FnMut(&Contact, usize)) {
        let (size, places) = (&self.touching.size, self.places);
        let factor = 0.5 * self.touching.law.distance * (1.0 + MARGIN);
        let (place, own) = (places[i], size[i]);
        for j in self.list.row(i) {
            let apart = minus(places[j], place);
            let reach = factor * (own + size[j]);
            if dot(apart, apart) < reach * reach
                && let Some(contact) = self.touching.contact(self.u, [i, j])
            {
                found(&contact, j);
            }
        }
    }
}

impl PointContact {
    /// Adds vectors (N) at points, given in ascending order, as force densities.
    fn add_at(&self, points: &[u32], vector: impl Fn(usize) -> V3 + Sync, out: &mut [f64]) {
        let volumes = self.touching.cloud.volumes();
        for (c, out) in out.chunks_mut(volumes.len().max(1)).enumerate() {
            out.par_chunks_mut(TASK)
                .enumerate()
                .for_each(|(task, out)| {
                    let (first, own) = within(points, task);
                    for (k, &i) in own.iter().enumerate() {
                        let i = i as usize;
                        out[i - task * TASK] += vector(first + k)[c] / volumes[i];
                    }
                });
        }
    }
}

/// Evaluates `of_point` for the given points in parallel, in their order.
fn each<T: Send>(points: &[u32], of_point: impl Fn(usize) -> T + Sync + Send, into: &mut Vec<T>) {
    let points = points.par_iter().with_min_len(TASK);
    points.map(|&i| of_point(i as usize)).collect_into_vec(into);
}

/// Returns the given points, in ascending order, that belong to a task, and the place of the first.
fn within(points: &[u32], task: usize) -> (usize, &[u32]) {
    let place = |point: usize| points.partition_point(|&i| (i as usize) < point);
    let first = place(task * TASK);
    (first, &points[first..place((task + 1) * TASK)])
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
        let (mut places, mut forces) = (Vec::new(), Vec::new());
        let (touching, u) = (
            list.nearby().touching(&self.touching),
            list.nearby().vector(at.u),
        );
        let pairs = Evaluation::new(&list, touching, &u, &mut places);
        let force = |i| {
            let mut sum = [0.0; 3];
            pairs.visit(i, |contact, _| {
                sum = plus(sum, -contact.force, contact.normal);
            });
            sum
        };
        each(points, force, &mut forces);
        self.add_at(points, |k| forces[k], out);
    }

    fn energy(&self, at: &Configuration<'_>) -> f64 {
        let list = self.candidates(at);
        let (law, points) = (self.touching.law.law, list.exposed());
        let mut places = Vec::new();
        let (touching, u) = (
            list.nearby().touching(&self.touching),
            list.nearby().vector(at.u),
        );
        let pairs = Evaluation::new(&list, touching, &u, &mut places);
        self.touching.cloud.domain().sum(points.len(), |k| {
            let mut sum = 0.0;
            pairs.visit(points[k] as usize, |contact, _| {
                sum += law.energy(contact.force, contact.overlap);
            });
            0.5 * sum
        })
    }

    fn add_tangent(&self, at: &Configuration<'_>, direction: &[f64], out: &mut [f64]) {
        let list = self.candidates(at);
        let (mut places, mut changes) = (Vec::new(), Vec::new());
        let (touching, u) = (
            list.nearby().touching(&self.touching),
            list.nearby().vector(at.u),
        );
        let (pairs, n) = (
            Evaluation::new(&list, touching, &u, &mut places),
            touching.cloud.len(),
        );
        let direction = list.nearby().vector(direction);
        let change = |i| {
            let mut sum = [0.0; 3];
            pairs.visit(i, |contact, j| {
                let mut d = [0.0; 3];
                for c in 0..touching.cloud.dimension() {
                    d[c] = direction[c * n + j] - direction[c * n + i];
                }
                let along = dot(d, contact.normal);
                let slope = self.touching.law.law.slope(contact.force, contact.overlap);
                let turned = contact.force / contact.distance;
                sum = plus(sum, (slope + turned) * along, contact.normal);
                sum = plus(sum, -turned, d);
            });
            sum
        };
        each(list.exposed(), change, &mut changes);
        self.add_at(list.exposed(), |k| changes[k], out);
    }

    fn end_step(&mut self, end: &InteractionStep<'_>, out: &mut [f64]) -> Exchange {
        let step = end.step;
        let list = self.candidates(&end.configuration());
        let domain = self.touching.cloud.domain();
        // The same on all processes, also on one without points.
        let with_drag = !self.touching.law.is_conservative();
        // Kept for the next step, because new memory costs as much as the contacts.
        let Work {
            mut places,
            mut sums,
        } = std::mem::take(&mut self.work);
        let nearby = list.nearby();
        let (touching, u) = (nearby.touching(&self.touching), nearby.vector(step.u));
        let velocities = (with_drag && !nearby.are_own()).then(|| {
            let own: Vec<f64> = (0..step.u.len())
                .map(|entry| step.mean_velocity(entry))
                .collect();
            nearby.vector(&own).into_owned()
        });
        let velocity = |entry: usize| match &velocities {
            None => step.mean_velocity(entry),
            Some(velocities) => velocities[entry],
        };
        let pairs = Evaluation::new(&list, touching, &u, &mut places);
        let of_point = |i| {
            let mut sum = OfPoint::default();
            pairs.visit(i, |contact, j| {
                sum.force = plus(sum.force, -contact.force, contact.normal);
                sum.contacts += 1;
                sum.overlap = sum.overlap.max(contact.overlap / contact.limit);
                if with_drag {
                    let drag = touching.drag(contact, [i, j], velocity);
                    sum.drag = plus(sum.drag, 1.0, drag);
                }
            });
            sum
        };
        each(list.exposed(), of_point, &mut sums);
        self.pairs = domain.count(sums.iter().map(|sum| sum.contacts).sum()) / 2;
        self.overlap = domain.max(sums.iter().map(|sum| sum.overlap).fold(0.0, f64::max));
        let force = |k: usize| plus(sums[k].force, 1.0, sums[k].drag);
        self.add_at(list.exposed(), force, out);
        if with_drag {
            let (n, dimension) = (self.touching.cloud.len(), self.touching.cloud.dimension());
            let mut drag = vec![0.0; self.drag.len()];
            for (&i, sum) in list.exposed().iter().zip(&sums) {
                for c in 0..dimension {
                    drag[c * n + i as usize] = sum.drag[c];
                }
            }
            let power = domain.sum(drag.len(), |entry| {
                (drag[entry] + self.drag[entry]) * step.mean_velocity(entry)
            });
            self.dissipated -= 0.5 * step.dt * power;
            self.drag = drag;
        }
        self.work = Work { places, sums };
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
        let domain = touching.cloud.domain();
        let largest = domain.max(volumes.iter().copied().fold(0.0, f64::max));
        let square = |i: usize| {
            let stiffness = match touching.law.law {
                PairLaw::Emu => touching.stiffness[i] * volumes[i] * largest,
                _ => touching.stiffness[i],
            };
            stiffness / (density.at(i) * volumes[i])
        };
        let most = domain.max((0..volumes.len()).map(square).fold(0.0, f64::max));
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
        drag: points("contact/drag"),
        dissipated: array("contact/dissipated"),
        pairs: array("contact/pairs"),
        overlap: array("contact/overlap"),
        touching, pieces, skin: fixed,
        list: set(std::sync::Mutex::new(Listed::default())),
        work: set(Work::default()),
    }
}
