//! Points that become part of the body during a run, as in additive manufacturing.

use super::System;
use crate::domain::Field;
use crate::error::{PericlesError, Result};
use crate::operator::BondForm;
use crate::parallel::PointSubset;
use crate::solve::principal_axes;
use crate::space::check_length;
use crate::vector::dot;

const NO_GROWTH: &str = "bonds that come into being must be free of force, but here the force of a bond depends on other \
    bonds of its ends, or on the stress of complete families; use a bond-based material without failure = \"strength\"";

/// Times from which points belong to the body.
#[derive(Debug)]
pub(super) struct Activation {
    /// Of own points, s.
    times: Vec<f64>,
    /// Time up to which points have become active, s.
    reached: f64,
    /// Points that became active after this time, s, have not been in equilibrium with their loads.
    settled: f64,
    /// Earliest later time at which a point of any process becomes active, s; infinite if there is none.
    next: f64,
    /// Own points that are not active.
    held: Vec<u32>,
}

/// When points become active.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ActivationRange {
    /// Number of points that do not belong to the body at t = 0.
    pub points: u64,
    /// Time at which the first of them becomes active, s.
    pub first: f64,
    /// Time at which the last of them becomes active, s.
    pub last: f64,
    /// Number of points that never become active.
    pub never: u64,
}

crate::saved! {
    impl Checkpointed for Activation {
        reached, settled: array("activation/reached"),
        times: fixed,
        next, held: rebuilt,
    }
}

impl Activation {
    fn is_active(&self, i: usize) -> bool {
        is_due(self.times[i], self.reached)
    }

    /// Returns the shares of its loads that act on a point at the start and the end of a step: no load acts on a point that
    /// is not active. Between static states the loads of a new point grow from zero.
    pub fn load_shares(&self, i: usize, is_static: bool) -> [f64; 2] {
        match self.is_active(i) {
            false => [0.0; 2],
            true if is_static && !is_due(self.times[i], self.settled) => [0.0, 1.0],
            true => [1.0; 2],
        }
    }

    /// Ends a step between static states, in which all points are in equilibrium.
    pub fn settle(&mut self) {
        self.settled = self.reached;
    }
}

/// Times are whole multiples of the step, so that a time of activation may differ from one by rounding.
fn is_due(time: f64, t: f64) -> bool {
    time <= t + 1e-12 * t.abs()
}

impl System {
    /// Sets the time from which each own point belongs to the body, s. Points of the past belong to it from the start.
    ///
    /// A point that is not active has no bonds and no acceleration. When it becomes active, at the end of a step, it takes
    /// displacement and velocity of the affine motion that fits the active points of its family best, and its bonds to other
    /// active points come into being free of force. Its kinetic energy and momentum count as work and impulse from outside.
    /// Loads act on active points only.
    ///
    /// # Errors
    /// A number of times other than that of the points; times that are NaN; forces whose bonds cannot come into being
    /// during a run.
    pub fn add_activation(&mut self, times: Vec<f64>) -> Result<()> {
        check_length(
            "the times at which points become active",
            times.len(),
            self.points(),
        )?;
        if let Some(time) = times.iter().find(|time| time.is_nan()) {
            return Err(PericlesError::OutOfRange {
                quantity: "the time at which a point becomes active",
                value: *time,
                allowed: "a number",
            });
        }
        let Some(growing) = self.operator_mut().growing_mut() else {
            return Err(PericlesError::FormNotUsable {
                form: BondForm::List.name(),
                reason: NO_GROWTH,
            });
        };
        growing.grow();
        self.activation = Some(Activation {
            times,
            reached: f64::NEG_INFINITY,
            settled: f64::NEG_INFINITY,
            next: f64::INFINITY,
            held: Vec::new(),
        });
        Ok(())
    }

    /// Returns whether points become active during the run.
    pub fn has_activation(&self) -> bool {
        self.activation.is_some()
    }

    /// Returns 1 for each own point that belongs to the body, and 0 for the others.
    pub(crate) fn active_marks(&self) -> Vec<f64> {
        let mut marks = vec![1.0; self.points()];
        for &i in self.activation.iter().flat_map(|one| &one.held) {
            marks[i as usize] = 0.0;
        }
        marks
    }

    /// Returns when points become active after the start of a run; `None` if all belong to the body from the start. All
    /// processes must call it together.
    pub fn activation_range(&self) -> Option<ActivationRange> {
        let times = &self.activation.as_ref()?.times;
        let domain = self.domain();
        let count = |holds: &dyn Fn(f64) -> bool| {
            domain.count(times.iter().filter(|time| holds(**time)).count() as u64)
        };
        let timed = || {
            times
                .iter()
                .copied()
                .filter(|time| *time > 0.0 && time.is_finite())
        };
        Some(ActivationRange {
            points: count(&|time| time > 0.0),
            first: -domain.max(timed().fold(f64::NEG_INFINITY, |first, time| first.max(-time))),
            last: domain.max(timed().fold(f64::NEG_INFINITY, f64::max)),
            never: count(&|time| time == f64::INFINITY),
        })
    }

    /// Removes the bonds of points that are not active at the start of a run.
    pub(crate) fn start_activation(&mut self, t: f64, v: &mut [f64]) {
        let Some(activation) = &mut self.activation else {
            return;
        };
        activation.reached = t;
        activation.settled = t;
        self.find_next();
        let active = self.active();
        if let Some(growing) = self.operator_mut().growing_mut() {
            growing.start_with(&active);
        }
        self.hold_inactive(v);
    }

    /// Returns whether points of any process become active at the end of a step, time t.
    pub(crate) fn activates_at(&self, t: f64) -> bool {
        let activation = self.activation.as_ref();
        activation.is_some_and(|activation| is_due(activation.next, t))
    }

    /// Activates the points whose time has come at the end of a step: changes their displacements u and velocities v, and
    /// computes the accelerations of the changed body, if it has any.
    pub(crate) fn activate(
        &mut self,
        t: f64,
        [u, v]: [&mut [f64]; 2],
        accelerations: Option<&mut [f64]>,
    ) {
        let Some(activation) = &mut self.activation else {
            return;
        };
        let before = std::mem::replace(&mut activation.reached, t);
        let is_new = |i: &usize| activation.is_active(*i) && !is_due(activation.times[*i], before);
        let new: Vec<usize> = (0..activation.times.len()).filter(is_new).collect();
        self.find_next();
        self.place_new(&new, [&mut *u, &mut *v]);
        self.place_on(t, &PointSubset::All, u);
        self.drive_on(t, &PointSubset::All, v);
        self.book_new(&new, v);
        let (active, forces) = (self.active(), &mut self.forces);
        let points: Vec<u32> = new.iter().map(|&i| i as u32).collect();
        // The temperature at activation first: bonds come into being free of force at it.
        for field in &mut self.fields {
            field.set_new(&points);
        }
        if let Some(growing) = forces.sum_mut().growing_mut() {
            growing.activate(t, u, &active);
        }
        for field in &mut self.fields {
            field.read_bonds(forces.sum());
        }
        if let Some(a) = accelerations {
            self.acceleration(t, u, v, PointSubset::All, a);
        }
    }

    /// Computes the loads with which a static state at time t is in equilibrium, N/m³: without those on points that have
    /// become active since it was found.
    pub fn balanced_load_into(&self, t: f64, out: &mut [f64]) {
        self.load_density_into(t, out);
        let Some(activation) = &self.activation else {
            return;
        };
        let n = self.points();
        for (entry, load) in out.iter_mut().enumerate() {
            *load *= activation.load_shares(entry % n, true)[0];
        }
    }

    /// Gives new points the affine motion of the points of their families that are active or have been placed before; a
    /// point without any keeps its displacement and velocity.
    fn place_new(&mut self, new: &[usize], [u, v]: [&mut [f64]; 2]) {
        let (n, dimension) = (self.points(), self.dimension());
        let mut placed = self.active_marks();
        for &i in new {
            placed[i] = 0.0;
        }
        let domain = self.domain().clone();
        let mut left = new.to_vec();
        loop {
            let known = domain.with_ghosts(&placed).into_owned();
            let ghosts = [&*u, &*v].map(|vector| domain.ghosts(vector));
            let fields = [Field::new(u, &ghosts[0]), Field::new(v, &ghosts[1])];
            let mut found = Vec::new();
            let Some(growing) = self.forces.sum_mut().growing_mut() else {
                return;
            };
            for &i in &left {
                let mut fit = AffineFit::default();
                growing.for_each_neighbour(i, &mut |j, xi| {
                    if known[j] != 0.0 {
                        let of = |field: &Field<'_>| -> [f64; 3] {
                            std::array::from_fn(|c| match c < dimension {
                                true => field.entry(dimension, c, j),
                                false => 0.0,
                            })
                        };
                        fit.add(xi, [of(&fields[0]), of(&fields[1])]);
                    }
                });
                if let Some(place) = fit.at_origin() {
                    found.push((i, place));
                }
            }
            if domain.all(found.is_empty()) {
                return;
            }
            for (i, [moved, velocity]) in found {
                placed[i] = 1.0;
                for c in 0..dimension {
                    u[c * n + i] = moved[c];
                    v[c * n + i] = velocity[c];
                }
            }
            left.retain(|&i| placed[i] == 0.0);
        }
    }

    /// Adds the kinetic energy and momentum of new points to work and impulse.
    fn book_new(&mut self, new: &[usize], v: &[f64]) {
        let (n, dimension) = (self.points(), self.dimension());
        let domain = self.domain();
        let square = |i: usize| (0..dimension).map(|c| v[c * n + i].powi(2)).sum::<f64>();
        let energy = domain.sum(new.len(), |k| 0.5 * self.mass_of(new[k]) * square(new[k]));
        let impulse = std::array::from_fn(|c| match c < dimension {
            true => domain.sum(new.len(), |k| self.mass_of(new[k]) * v[c * n + new[k]]),
            false => 0.0,
        });
        self.ledger.book(energy, impulse);
    }

    /// Zeros the entries of points that are not active.
    pub(super) fn hold_inactive(&self, vector: &mut [f64]) {
        let (n, held) = (
            self.points(),
            self.activation.iter().flat_map(|one| &one.held),
        );
        for &i in held {
            for c in 0..self.dimension() {
                vector[c * n + i as usize] = 0.0;
            }
        }
    }

    /// Passes the active points to the forces after their bonds were restored.
    pub(super) fn note_active(&mut self) {
        if self.activation.is_none() {
            return;
        }
        self.find_next();
        let active = self.active();
        if let Some(growing) = self.operator_mut().growing_mut() {
            growing.note_active(&active);
        }
    }

    /// Finds the points that are not active, and the earliest time at which one of any process becomes active.
    fn find_next(&mut self) {
        let domain = self.cloud.domain().clone();
        if let Some(activation) = &mut self.activation {
            let later = (0..activation.times.len()).filter(|&i| !activation.is_active(i));
            activation.held = later.map(|i| i as u32).collect();
            let held = activation.held.iter();
            let next = held.map(|&i| activation.times[i as usize]);
            let next = next.fold(f64::INFINITY, f64::min);
            activation.next = -domain.max(-next);
        }
    }

    /// Returns which points are active, ghosts after own points.
    fn active(&self) -> Vec<bool> {
        let own = self.active_marks();
        let all = self.domain().with_ghosts(&own);
        all.iter().map(|mark| *mark != 0.0).collect()
    }
}

/// Affine functions of ξ, for displacement and velocity, that fit values at several ξ by least squares.
#[derive(Default)]
struct AffineFit {
    count: f64,
    /// Σ ξ
    place: [f64; 3],
    /// Σ ξ ⊗ ξ
    shape: [[f64; 3]; 3],
    /// Σ x of both fields.
    sum: [[f64; 3]; 2],
    /// Σ x ⊗ ξ of both fields.
    moment: [[[f64; 3]; 3]; 2],
}

impl AffineFit {
    fn add(&mut self, xi: [f64; 3], values: [[f64; 3]; 2]) {
        self.count += 1.0;
        for a in 0..3 {
            self.place[a] += xi[a];
            for b in 0..3 {
                self.shape[a][b] += xi[a] * xi[b];
            }
        }
        for (k, value) in values.into_iter().enumerate() {
            for a in 0..3 {
                self.sum[k][a] += value[a];
                for b in 0..3 {
                    self.moment[k][a][b] += value[a] * xi[b];
                }
            }
        }
    }

    /// Returns the values at ξ = 0; `None` without values. Gradients are zero along axes in which the places do not differ.
    fn at_origin(&self) -> Option<[[f64; 3]; 2]> {
        /// Least moment of the places along an axis with a gradient, relative to the trace.
        const LEAST: f64 = 1e-9;
        if self.count == 0.0 {
            return None;
        }
        let centre = self.place.map(|x| x / self.count);
        let shape: [[f64; 3]; 3] = std::array::from_fn(|a| {
            std::array::from_fn(|b| self.shape[a][b] - self.place[a] * centre[b])
        });
        let trace: f64 = (0..3).map(|a| shape[a][a]).sum();
        let mut values = self.sum.map(|sum| sum.map(|x| x / self.count));
        for axis in principal_axes(shape) {
            let along = shape.map(|row| dot(row, axis));
            let moment = dot(along, axis);
            if moment <= LEAST * trace {
                continue;
            }
            let share = dot(centre, axis) / moment;
            for (k, value) in values.iter_mut().enumerate() {
                for (a, value) in value.iter_mut().enumerate() {
                    let slope = dot(self.moment[k][a], axis) - self.sum[k][a] * dot(centre, axis);
                    *value -= slope * share;
                }
            }
        }
        Some(values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn affine_fits_continue_affine_fields_where_values_determine_them() {
        let field = |[x, y, z]: [f64; 3]| [[0.3 + 2.0 * x - y, x + 3.0 * z, 1.0], [y, z, x]];
        let places = [
            [1.0, 0.0, 0.5],
            [2.0, 1.0, 0.0],
            [2.0, -1.0, 0.3],
            [3.0, 0.5, -0.4],
        ];
        let mut fit = AffineFit::default();
        assert_eq!(fit.at_origin(), None);
        for place in places {
            fit.add(place, field(place));
        }
        let (found, exact) = (fit.at_origin().unwrap(), field([0.0; 3]));
        for (found, exact) in found.iter().flatten().zip(exact.iter().flatten()) {
            assert!((found - exact).abs() < 1e-12, "{found} {exact}");
        }
        // One place, and places on a line beside the origin.
        let mut fit = AffineFit::default();
        fit.add([0.0, 1.0, 0.0], [[5.0, 0.0, 0.0]; 2]);
        assert_eq!(fit.at_origin(), Some([[5.0, 0.0, 0.0]; 2]));
        fit.add([2.0, 1.0, 0.0], [[7.0, 0.0, 0.0]; 2]);
        let [[u, ..], _] = fit.at_origin().unwrap();
        assert!((u - 5.0).abs() < 1e-12, "{u}");
    }
}
