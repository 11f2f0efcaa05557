//! Constraints of a system.

use super::System;
use crate::boundary::{Exchange, PrescribedMotion};
use crate::parallel::PointSubset;

impl System {
    /// Applies prescribed displacements at time t, and the displacements of boundaries, before a force evaluation.
    pub fn constrain(&mut self, t: f64, u: &mut [f64], v: &mut [f64]) {
        self.place_on(t, &PointSubset::All, u);
        for boundary in &mut self.boundaries {
            boundary.before_force(t, u, v);
        }
    }

    /// Applies prescribed velocities at time t.
    pub fn constrain_velocity(&self, t: f64, v: &mut [f64]) {
        self.drive_on(t, &PointSubset::All, v);
    }

    /// Applies prescribed mean velocities of the step from t to t + dt.
    pub fn constrain_mean_velocity(&self, t: f64, dt: f64, v: &mut [f64]) {
        self.drive_mean_on(t, dt, &PointSubset::All, v);
    }

    /// Applies prescribed displacements at time t to the points of `on`.
    pub fn place_on(&self, t: f64, on: &PointSubset<'_>, u: &mut [f64]) {
        for motion in &self.motions {
            motion.place(t, on, self.points(), u);
        }
    }

    /// Applies prescribed velocities at time t to the points of `on`.
    pub fn drive_on(&self, t: f64, on: &PointSubset<'_>, v: &mut [f64]) {
        for motion in &self.motions {
            motion.drive(t, on, self.points(), v);
        }
        self.hold_inactive(v);
    }

    /// Applies prescribed mean velocities of the step from t to t + dt to the points of `on`.
    pub fn drive_mean_on(&self, t: f64, dt: f64, on: &PointSubset<'_>, v: &mut [f64]) {
        for motion in &self.motions {
            motion.drive_mean(t, dt, on, self.points(), v);
        }
        self.hold_inactive(v);
    }

    /// Lets boundaries damp the velocities of unconstrained points over a time dt and returns work and impulse
    /// ([`Boundary::damp`](crate::boundary::Boundary::damp)). `work` is a work array for velocities.
    pub fn damp(&self, t: f64, dt: f64, v: &mut [f64], work: &mut Vec<f64>) -> Exchange {
        let mut exchange = Exchange::default();
        if self.boundaries.is_empty() {
            return exchange;
        }
        work.clear();
        work.extend_from_slice(v);
        self.hold_at(t, work);
        // Damping does not change prescribed velocities.
        for (v, free) in v.iter_mut().zip(&*work) {
            *v -= free;
        }
        for boundary in &self.boundaries {
            exchange.add(boundary.damp(dt, work));
        }
        for (v, free) in v.iter_mut().zip(&*work) {
            *v += free;
        }
        exchange
    }

    /// Adds work and impulse of boundaries to the energy balance.
    pub fn book_exchange(&mut self, exchange: Exchange) {
        self.ledger.book(exchange.work, exchange.impulse);
    }

    /// Zeros prescribed entries.
    pub fn hold(&self, vector: &mut [f64]) {
        for motion in &self.motions {
            motion.project(self.points(), vector);
        }
    }

    /// Zeros the entries prescribed at time t, and those of points that are not active.
    pub fn hold_at(&self, t: f64, vector: &mut [f64]) {
        for motion in self.motions.iter().filter(|motion| motion.holds(t)) {
            motion.zero(self.points(), vector);
        }
        self.hold_inactive(vector);
    }

    /// Computes K d / ρ at displacement u, zero on the entries prescribed at time t ([`System::vibration_into`]
    /// zeros those prescribed at all times).
    pub fn vibration_at(&self, t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        self.free_vibration_into(u, direction, out);
        self.hold_at(t, out);
    }

    /// Returns √Σ (V f)² of the part of the internal forces at displacement u caused by thermal strain, N: the
    /// force scale of a heated body without loads, for the tolerances of static schemes.
    pub fn thermal_force(&self, t: f64, u: &[f64]) -> f64 {
        if self.operator().capabilities().thermal.is_none() {
            return 0.0;
        }
        let (mut heated, mut cold) = (vec![0.0; u.len()], vec![0.0; u.len()]);
        self.operator()
            .add_force(t, u, PointSubset::All, &mut heated);
        let unheated = f64::NEG_INFINITY;
        self.operator()
            .add_force(unheated, u, PointSubset::All, &mut cold);
        let (n, volumes) = (self.points(), self.cloud().volumes());
        let square = |entry: usize| (volumes[entry % n] * (heated[entry] - cold[entry])).powi(2);
        self.domain().sum(u.len(), square).sqrt()
    }

    /// Number of constraints that act at time t. Released points stay free, so that the number identifies the
    /// constraints.
    pub fn holding(&self, t: f64) -> u64 {
        self.motions.iter().filter(|motion| motion.holds(t)).count() as u64
    }

    /// Returns half of the accelerations (m/s²) by constraints at time t on the points released before `t_next`,
    /// zero elsewhere; `None` if no point is released. `u` is the displacement at t.
    ///
    /// A constraint acts at the start of the first step after the release and not at its end. Schemes therefore
    /// apply half of its last force over this step, as velocity Verlet does, and the energy balance contains the
    /// same.
    pub fn last_push(&mut self, [t, t_next]: [f64; 2], u: &[f64]) -> Option<Vec<f64>> {
        let lets_go = |motion: &&PrescribedMotion| motion.holds(t) && !motion.holds(t_next);
        self.motions.iter().find(lets_go)?;
        let mut force = vec![0.0; u.len()];
        self.free_acceleration(t, u, &PointSubset::All, &mut force);
        let n = self.points();
        let mut push = force.clone();
        for motion in self.motions.iter().filter(lets_go) {
            motion.accelerate(t, &PointSubset::All, n, &mut push);
        }
        // On entries that are not released the push is the force itself.
        for (push, force) in push.iter_mut().zip(&force) {
            *push = 0.5 * (*push - force);
        }
        Some(push)
    }
}
