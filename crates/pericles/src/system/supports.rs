//! Prescribed motion.

use super::System;
use crate::boundary::{Exchange, PrescribedMotion};
use crate::parallel::On;

impl System {
    /// Sets prescribed displacements of time t, and what boundaries set, before a force evaluation.
    pub fn constrain(&mut self, t: f64, u: &mut [f64], v: &mut [f64]) {
        self.place_on(t, &On::All, u);
        for boundary in &mut self.boundaries {
            boundary.before_force(t, u, v);
        }
    }

    /// Sets prescribed velocities of time t.
    pub fn constrain_velocity(&self, t: f64, v: &mut [f64]) {
        self.drive_on(t, &On::All, v);
    }

    /// Sets prescribed mean velocities of the step from t to t + dt.
    pub fn constrain_mean_velocity(&self, t: f64, dt: f64, v: &mut [f64]) {
        self.drive_mean_on(t, dt, &On::All, v);
    }

    /// Sets prescribed displacements of time t for the points named by `on`.
    pub fn place_on(&self, t: f64, on: &On<'_>, u: &mut [f64]) {
        for motion in &self.motions {
            motion.place(t, on, self.points(), u);
        }
    }

    /// Sets prescribed velocities of time t for the points named by `on`.
    pub fn drive_on(&self, t: f64, on: &On<'_>, v: &mut [f64]) {
        for motion in &self.motions {
            motion.drive(t, on, self.points(), v);
        }
    }

    /// Sets prescribed mean velocities of the step from t to t + dt for the points named by `on`.
    pub fn drive_mean_on(&self, t: f64, dt: f64, on: &On<'_>, v: &mut [f64]) {
        for motion in &self.motions {
            motion.drive_mean(t, dt, on, self.points(), v);
        }
    }

    /// Lets boundaries damp the velocities of points that are free at time t as they do over a time dt, and returns what they did ([`Boundary::damp`](crate::boundary::Boundary::damp)). `work` is for velocities.
    pub fn damp(&self, t: f64, dt: f64, v: &mut [f64], work: &mut Vec<f64>) -> Exchange {
        let mut exchange = Exchange::default();
        if self.boundaries.is_empty() {
            return exchange;
        }
        work.clear();
        work.extend_from_slice(v);
        self.hold_at(t, work);
        // Of prescribed velocities all is left, of others nothing.
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

    /// Books what boundaries did to the body.
    pub fn book_exchange(&mut self, exchange: Exchange) {
        self.ledger.book(exchange.work, exchange.impulse);
    }

    /// Zeros prescribed entries.
    pub fn hold(&self, vector: &mut [f64]) {
        for motion in &self.motions {
            motion.project(self.points(), vector);
        }
    }

    /// Zeros the entries that are prescribed at time t.
    pub fn hold_at(&self, t: f64, vector: &mut [f64]) {
        for motion in self.motions.iter().filter(|motion| motion.holds(t)) {
            motion.zero(self.points(), vector);
        }
    }

    /// K d / ρ at displacement u, with the entries held that are prescribed at time t ([`System::vibration_into`] holds those that are prescribed at all times).
    pub fn vibration_at(&self, t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        self.free_vibration_into(u, direction, out);
        self.hold_at(t, out);
    }

    /// √Σ (V f)² of the part of the internal forces at displacement u that thermal strain makes, N: what acts on a heated body without loads, for the tolerances of static schemes.
    pub fn thermal_force(&self, t: f64, u: &[f64]) -> f64 {
        if self.operator().capabilities().thermal.is_none() {
            return 0.0;
        }
        let (mut heated, mut cold) = (vec![0.0; u.len()], vec![0.0; u.len()]);
        self.operator().add_force(t, u, On::All, &mut heated);
        let unheated = f64::NEG_INFINITY;
        self.operator().add_force(unheated, u, On::All, &mut cold);
        let (n, volumes) = (self.points(), self.cloud().volumes());
        let square = |entry: usize| (volumes[entry % n] * (heated[entry] - cold[entry])).powi(2);
        self.domain().sum(u.len(), square).sqrt()
    }

    /// The number of prescribed motions that hold their points at time t. Points that are let go stay free, so that it says which motions these are.
    pub fn holding(&self, t: f64) -> u64 {
        self.motions.iter().filter(|motion| motion.holds(t)).count() as u64
    }

    /// Half of the accelerations (m/s²) that supports give at time t to the points that they let go before `t_next`, zero elsewhere; none if they let none go. `u` is the displacement at t.
    ///
    /// A support acts at the start of the first step after the release and not at its end. Schemes give its points half of its last force over this step, as velocity Verlet does, and the ledger books it so.
    pub fn last_push(&mut self, [t, t_next]: [f64; 2], u: &[f64]) -> Option<Vec<f64>> {
        let lets_go = |motion: &&PrescribedMotion| motion.holds(t) && !motion.holds(t_next);
        self.motions.iter().find(lets_go)?;
        let mut force = vec![0.0; u.len()];
        self.free_acceleration(t, u, &On::All, &mut force);
        let n = self.points();
        let mut push = force.clone();
        for motion in self.motions.iter().filter(lets_go) {
            motion.accelerate(t, &On::All, n, &mut push);
        }
        // Entries that are not let go are the force itself.
        for (push, force) in push.iter_mut().zip(&force) {
            *push = 0.5 * (*push - force);
        }
        Some(push)
    }
}
