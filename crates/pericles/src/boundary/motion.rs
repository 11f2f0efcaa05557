//! Prescribed displacement and velocity.

use super::TimeFunction;
use crate::operator::On;
use crate::space::PointSet;

/// What is prescribed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MotionKind {
    /// u(t) = amplitude · g(t).
    Displacement,
    /// v(t) = amplitude · g(t), from the displacement at the start.
    Velocity,
}

/// Relative error of times that are meant to be equal.
const TIME_ERROR: f64 = 1e-12;

/// The motion of a set of points along one or more axes, as a closed function of time: displacement and velocity are exact at the end of every
/// step.
#[derive(Debug, Clone)]
pub struct PrescribedMotion {
    /// Name for reports.
    pub name: String,
    /// The held points.
    pub points: PointSet,
    /// Displacement or velocity.
    pub kind: MotionKind,
    /// Amplitude per axis (m or m/s); none where the axis is free.
    pub amplitude: [Option<f64>; 3],
    /// g(t).
    pub function: TimeFunction,
    /// When the points are released, s; infinite if never.
    until: f64,
    /// Displacement at the start of the points, per prescribed axis; zero for prescribed displacements.
    start: Vec<f64>,
    /// Force density of the support on the held points at the last accepted state, per prescribed axis.
    reaction: Vec<f64>,
}

impl PrescribedMotion {
    /// A motion for a body whose initial displacement is `u`.
    pub fn new(
        name: String,
        points: PointSet,
        kind: MotionKind,
        amplitude: [Option<f64>; 3],
        function: TimeFunction,
        u: &[f64],
        cloud_len: usize,
    ) -> Self {
        let axes = (0..3).filter(|&c| amplitude[c].is_some());
        let start: Vec<f64> = match kind {
            MotionKind::Displacement => axes.flat_map(|_| points.iter().map(|_| 0.0)).collect(),
            MotionKind::Velocity => axes
                .flat_map(|c| points.iter().map(move |&i| u[c * cloud_len + i as usize]))
                .collect(),
        };
        Self {
            reaction: vec![0.0; start.len()],
            start,
            name,
            points,
            kind,
            amplitude,
            function,
            until: f64::INFINITY,
        }
    }

    /// The same, with the points released at a time (s): they go on freely with the displacement and velocity prescribed for it.
    #[must_use]
    pub fn until(mut self, release: f64) -> Self {
        self.until = release;
        self
    }

    /// Whether the motion is prescribed at t.
    fn holds(&self, t: f64) -> bool {
        t <= self.until * (1.0 + TIME_ERROR)
    }

    /// Whether it still is right after t.
    fn goes_on(&self, t: f64) -> bool {
        t < self.until * (1.0 - TIME_ERROR)
    }

    /// The prescribed axes with their amplitudes.
    pub fn axes(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        (0..3).filter_map(|c| Some((c, self.amplitude[c]?)))
    }

    /// Displacement beyond the start, velocity and acceleration at time t for unit amplitude.
    fn course(&self, t: f64) -> (f64, f64, f64) {
        let g = &self.function;
        match self.kind {
            MotionKind::Displacement => (g.value(t), g.derivative(t), g.second_derivative(t)),
            MotionKind::Velocity => (g.integral(t), g.value(t), g.derivative(t)),
        }
    }

    /// Calls `set(entry of the state's arrays, start displacement, amplitude, slot)` for every prescribed number of the points named by `on`.
    fn for_each(&self, on: &On<'_>, cloud_len: usize, mut set: impl FnMut(usize, f64, f64, usize)) {
        for (axis, (c, amplitude)) in self.axes().enumerate() {
            on.common(&self.points, |k, i| {
                let slot = axis * self.points.len() + k;
                set(c * cloud_len + i, self.start[slot], amplitude, slot);
            });
        }
    }

    /// Sets displacements of time t.
    pub(crate) fn place(&self, t: f64, on: &On<'_>, cloud_len: usize, u: &mut [f64]) {
        if !self.holds(t) {
            return;
        }
        let (displacement, _, _) = self.course(t);
        self.for_each(on, cloud_len, |entry, start, amplitude, _| {
            u[entry] = start + amplitude * displacement;
        });
    }

    /// Sets velocities of time t.
    pub(crate) fn drive(&self, t: f64, on: &On<'_>, cloud_len: usize, v: &mut [f64]) {
        if !self.holds(t) {
            return;
        }
        let (_, velocity, _) = self.course(t);
        self.for_each(on, cloud_len, |entry, _, amplitude, _| {
            v[entry] = amplitude * velocity
        });
    }

    /// Sets the mean velocities between t and t + dt.
    pub(crate) fn drive_mean(&self, t: f64, dt: f64, on: &On<'_>, cloud_len: usize, v: &mut [f64]) {
        if !self.holds(t + dt) {
            return;
        }
        let mean = (self.course(t + dt).0 - self.course(t).0) / dt;
        self.for_each(on, cloud_len, |entry, _, amplitude, _| {
            v[entry] = amplitude * mean
        });
    }

    /// Replaces accelerations by the prescribed ones of time t.
    pub(crate) fn accelerate(
        &self,
        t: f64,
        on: &On<'_>,
        cloud_len: usize,
        acceleration: &mut [f64],
    ) {
        if !self.goes_on(t) {
            return;
        }
        let (_, _, rate) = self.course(t);
        self.for_each(on, cloud_len, |entry, _, amplitude, _| {
            acceleration[entry] = amplitude * rate;
        });
    }

    /// Zeros the prescribed entries of a vector, as in a virtual displacement.
    pub(crate) fn project(&self, cloud_len: usize, vector: &mut [f64]) {
        self.for_each(&On::All, cloud_len, |entry, _, _, _| vector[entry] = 0.0);
    }

    /// Notes the reaction ρ a − f at an accepted state, from the accelerations f/ρ before they are replaced, and returns the work (J)
    /// and impulse (N s) of the support since the last accepted state.
    pub(crate) fn account(
        &mut self,
        t: f64,
        dt: f64,
        cloud_len: usize,
        acceleration: &[f64],
        density: &dyn Fn(usize) -> f64,
        volumes: &[f64],
    ) -> (f64, [f64; 3]) {
        if !self.holds(t) {
            self.reaction.fill(0.0);
            return (0.0, [0.0; 3]);
        }
        let rate = self.course(t).2;
        let advance = self.course(t).0 - self.course(t - dt).0;
        let (mut work, mut impulse) = (0.0, [0.0; 3]);
        let mut reaction = std::mem::take(&mut self.reaction);
        self.for_each(&On::All, cloud_len, |entry, _, amplitude, slot| {
            let (c, i) = (entry / cloud_len, entry % cloud_len);
            let now = density(i) * (amplitude * rate - acceleration[entry]);
            let mean = 0.5 * (reaction[slot] + now) * volumes[i];
            work += mean * amplitude * advance;
            impulse[c] += mean * dt;
            reaction[slot] = now;
        });
        self.reaction = reaction;
        (work, impulse)
    }

    /// The force of the support on the body at the last accepted state, N.
    pub fn reaction(&self, cloud_len: usize, volumes: &[f64]) -> [f64; 3] {
        let mut sum = [0.0; 3];
        self.for_each(&On::All, cloud_len, |entry, _, _, slot| {
            sum[entry / cloud_len] += self.reaction[slot] * volumes[entry % cloud_len];
        });
        sum
    }

    /// The noted reactions (N/m³), for checkpoints.
    pub(crate) fn reactions(&self) -> &[f64] {
        &self.reaction
    }

    /// The same, to be restored.
    pub(crate) fn reactions_mut(&mut self) -> &mut [f64] {
        &mut self.reaction
    }
}
