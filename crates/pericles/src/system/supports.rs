//! Prescribed motion.

use super::System;
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
}
