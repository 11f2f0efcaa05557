//! Constraints: prescribed displacement and velocity.

use std::fmt;
use std::sync::Arc;

use super::{PointValues, TimeFunction};
use crate::archive::Laid;
use crate::error::{PericlesError, Result};
use crate::operator::PointSubset;
use crate::space::{PointSet, check_length, check_set};

const WHAT: &str = "the points of a prescribed motion";

/// The prescribed quantity.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MotionKind {
    /// u(t) = amplitude · g(t).
    Displacement,
    /// v(t) = amplitude · g(t), starting from the initial displacement.
    Velocity,
}

/// A prescribed displacement that is not a product of amplitude and time function.
pub trait Trajectory: fmt::Debug + Send + Sync {
    /// Displacement (m) at a position (m) and time (s), or its time derivative of order `order` (1 or 2).
    fn derivative(&self, order: usize, place: [f64; 3], t: f64) -> f64;
}

/// The prescribed motion along one axis.
#[derive(Debug, Clone)]
pub enum AxisMotion {
    /// The same amplitude (m or m/s) for all points.
    Uniform(f64),
    /// One amplitude per point of the set.
    PerPoint(Vec<f64>),
    /// A displacement as a function of position and time; amplitude and g(t) are not used.
    Trajectory {
        /// The displacement.
        trajectory: Arc<dyn Trajectory>,
        /// Positions of the points of the set, m.
        places: Vec<[f64; 3]>,
    },
    /// Displacements of all points of the set at once; amplitude and g(t) are not used. Component c of the values is
    /// read along axis c.
    Values(Arc<dyn PointValues>),
}

/// Constraint on a set of points along one or more axes, as a closed function of time: displacement and velocity
/// are exact at the end of every step.
#[derive(Debug, Clone)]
pub struct PrescribedMotion {
    /// Name in reports.
    pub name: String,
    /// The constrained points.
    pub points: PointSet,
    /// Displacement or velocity.
    pub kind: MotionKind,
    /// The prescribed motion along each axis; `None` where the axis is free.
    pub along: [Option<AxisMotion>; 3],
    /// Time function g(t).
    pub function: TimeFunction,
    /// Last time at which the constraint acts, s; afterwards the points are free.
    pub until: Option<f64>,
    /// Displacement of the points to which the motion adds, per prescribed axis; zero for prescribed displacements that do
    /// not [rise from it](Self::rising_from).
    pub(super) start: Vec<f64>,
    /// Reaction force density on the constrained points at the last accepted state, per prescribed axis.
    pub(super) reaction: Vec<f64>,
    /// Components that another constraint prescribes with the same values, as sorted entries of `reaction`: they
    /// belong to the other constraint, so that reactions and work count once.
    pub(super) shared: Vec<u32>,
}

impl PrescribedMotion {
    /// Points fixed along all axes of a body of this dimension.
    pub fn fixed(points: PointSet, dimension: usize) -> Self {
        let amplitude = std::array::from_fn(|c| (c < dimension).then_some(0.0));
        Self::displacement(points, amplitude, TimeFunction::Constant)
    }

    /// Points with the prescribed displacement amplitude · g(t), m; free along axes without an amplitude.
    pub fn displacement(
        points: PointSet,
        amplitude: [Option<f64>; 3],
        function: TimeFunction,
    ) -> Self {
        Self::from_rest(points, MotionKind::Displacement, amplitude, function)
    }

    /// Points with the prescribed velocity amplitude · g(t), m/s; free along axes without an amplitude. They start
    /// at zero displacement, or at the initial displacement set in
    /// [`Simulation::builder`](crate::Simulation::builder).
    pub fn velocity(points: PointSet, amplitude: [Option<f64>; 3], function: TimeFunction) -> Self {
        Self::from_rest(points, MotionKind::Velocity, amplitude, function)
    }

    fn from_rest(
        points: PointSet,
        kind: MotionKind,
        amplitude: [Option<f64>; 3],
        function: TimeFunction,
    ) -> Self {
        let along = amplitude.map(|amplitude| amplitude.map(AxisMotion::Uniform));
        let slots = along.iter().flatten().count() * points.len();
        Self {
            name: "support".into(),
            start: vec![0.0; slots],
            reaction: vec![0.0; slots],
            points,
            kind,
            along,
            function,
            until: None,
            shared: Vec::new(),
        }
    }

    /// Sets the name in reports.
    #[must_use]
    pub fn named(self, name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..self
        }
    }

    /// A constraint with the same amplitudes (m or m/s) for all points, for a body with initial displacement `u`.
    ///
    /// # Errors
    /// The errors of [`PrescribedMotion::along`].
    pub fn new(
        name: String,
        points: PointSet,
        kind: MotionKind,
        amplitude: [Option<f64>; 3],
        function: TimeFunction,
        u: &[f64],
        cloud_len: usize,
    ) -> Result<Self> {
        let along = amplitude.map(|amplitude| amplitude.map(AxisMotion::Uniform));
        Self::along(name, points, kind, along, function, u, cloud_len)
    }

    /// A constraint along the given axes, for a body with initial displacement `u`.
    ///
    /// # Errors
    /// Points that a body of `cloud_len` points does not have; a displacement without `cloud_len` entries for every
    /// axis along which the velocity is prescribed.
    pub fn along(
        name: String,
        points: PointSet,
        kind: MotionKind,
        along: [Option<AxisMotion>; 3],
        function: TimeFunction,
        u: &[f64],
        cloud_len: usize,
    ) -> Result<Self> {
        check_set(WHAT, &points, cloud_len)?;
        let axes = along.iter().flatten().count();
        let mut motion = Self {
            start: vec![0.0; axes * points.len()],
            reaction: vec![0.0; axes * points.len()],
            name,
            points,
            kind,
            along,
            function,
            until: None,
            shared: Vec::new(),
        };
        let last = motion.axes().last();
        if let (MotionKind::Velocity, Some(last)) = (kind, last) {
            let needed = (last + 1) * cloud_len;
            check_length(
                "the initial displacement of a body",
                u.len().min(needed),
                needed,
            )?;
            motion.start_from(u, cloud_len);
        }
        Ok(motion)
    }

    /// Sets the initial displacement, to which prescribed velocities add.
    pub(crate) fn start_from(&mut self, u: &[f64], cloud_len: usize) {
        if self.kind == MotionKind::Displacement {
            return;
        }
        let entries = self.axes().flat_map(|c| {
            let of_point = move |&i: &u32| u[c * cloud_len + i as usize];
            self.points.iter().map(of_point)
        });
        self.start = entries.collect();
    }

    /// Makes a displacement amplitude · g(t) start from the displacement `u` of the body instead of zero: it is
    /// u + (amplitude − u) g(t). Prescribed functions of position and time, and velocities, are unchanged.
    #[must_use]
    pub fn rising_from(mut self, u: &[f64], cloud_len: usize) -> Self {
        if self.kind == MotionKind::Velocity {
            return self;
        }
        let held = self.points.len();
        let axes: Vec<usize> = self.axes().collect();
        for (axis, c) in axes.into_iter().enumerate() {
            let amplitude = |k: usize| match &self.along[c] {
                Some(AxisMotion::Uniform(amplitude)) => Some(*amplitude),
                Some(AxisMotion::PerPoint(amplitudes)) => Some(amplitudes[k]),
                _ => None,
            };
            let places = self.points.iter().enumerate();
            let rises: Option<Vec<[f64; 2]>> = places
                .map(|(k, &i)| {
                    let start = u[c * cloud_len + i as usize];
                    Some([start, amplitude(k)? - start])
                })
                .collect();
            let Some(rises) = rises else { continue };
            for (k, [start, _]) in rises.iter().enumerate() {
                self.start[axis * held + k] = *start;
            }
            let rises = rises.into_iter().map(|[_, rise]| rise);
            self.along[c] = Some(AxisMotion::PerPoint(rises.collect()));
        }
        self
    }

    /// Checks that a constraint fits a body: point numbers, axes, and one amplitude or position per point.
    pub(crate) fn check(&self, dimension: usize, points: usize) -> Result<()> {
        check_set(WHAT, &self.points, points)?;
        let held = self.points.len();
        for (c, along) in self.along.iter().enumerate() {
            let given = match along {
                Some(_) if c >= dimension => {
                    return Err(PericlesError::WrongDimension {
                        what: "a motion along this axis",
                        needed: ["1, 2 or 3", "2 or 3", "3"][c],
                        dimension,
                    });
                }
                None | Some(AxisMotion::Uniform(_)) => held,
                Some(AxisMotion::PerPoint(amplitudes)) => amplitudes.len(),
                Some(AxisMotion::Trajectory { places, .. }) => places.len(),
                // The values have components for all axes up to this one.
                Some(AxisMotion::Values(values)) if values.len() >= (c + 1) * held => held,
                Some(AxisMotion::Values(values)) => values.len(),
            };
            check_length("the amplitudes or positions of a motion", given, held)?;
        }
        check_length(
            "the values of a motion whose points or axes were changed after it was made",
            self.start.len(),
            self.axes().count() * held,
        )
    }

    /// Indices of the prescribed axes.
    pub fn axes(&self) -> impl Iterator<Item = usize> + '_ {
        (0..3).filter(|&c| self.along[c].is_some())
    }

    /// Leaves to `other` the components that both prescribe.
    ///
    /// # Errors
    /// The first point (number in the body) and axis along which they prescribe different values.
    pub(crate) fn share(&mut self, other: &Self) -> std::result::Result<(), (u32, usize)> {
        let mut shared = Vec::new();
        for (axis, c) in self.axes().enumerate() {
            if other.along[c].is_none() {
                continue;
            }
            for (k, &i) in self.points.iter().enumerate() {
                let Ok(of_other) = other.points.binary_search(&i) else {
                    continue;
                };
                if !self.agrees(other, c, [k, of_other]) {
                    return Err((i, c));
                }
                shared.push((axis * self.points.len() + k) as u32);
            }
        }
        self.shared.append(&mut shared);
        self.shared.sort_unstable();
        self.shared.dedup();
        Ok(())
    }

    /// Returns whether both constraints prescribe the same motion along an axis of a point, the `own`-th of this
    /// constraint and the `others`-th of the other.
    fn agrees(&self, other: &Self, axis: usize, [own, others]: [usize; 2]) -> bool {
        let amplitude = |motion: &Self, k: usize| match &motion.along[axis] {
            Some(AxisMotion::Uniform(amplitude)) => Some(*amplitude),
            Some(AxisMotion::PerPoint(amplitudes)) => Some(amplitudes[k]),
            _ => None,
        };
        let (Some(a), Some(b)) = (amplitude(self, own), amplitude(other, others)) else {
            return false;
        };
        let same_course = a == 0.0 || self.function == other.function;
        a == b && same_course && self.kind == other.kind && self.until == other.until
    }

    /// The amplitude along an axis, if it is the same for all points.
    pub fn amplitude(&self, axis: usize) -> Option<f64> {
        match self.along[axis] {
            Some(AxisMotion::Uniform(amplitude)) => Some(amplitude),
            _ => None,
        }
    }

    /// Returns whether the constraint acts at time t.
    pub fn holds(&self, t: f64) -> bool {
        // Times are whole multiples of the step: the last one before the release may differ by rounding.
        self.until
            .is_none_or(|until| t <= until * (1.0 + 1e-12) + f64::MIN_POSITIVE)
    }

    /// Returns whether displacement, velocity and acceleration at time t are finite; for fields of position and
    /// time at the first, middle and last point.
    pub fn is_finite_at(&self, t: f64) -> bool {
        if !self.holds(t) || self.points.is_empty() {
            return true;
        }
        let last = self.points.len() - 1;
        let is_finite = |order: usize| {
            self.along.iter().flatten().all(|along| match along {
                AxisMotion::Trajectory { trajectory, places } => [0, last / 2, last]
                    .into_iter()
                    .all(|k| trajectory.derivative(order, places[k], t).is_finite()),
                AxisMotion::Values(_) => true,
                _ => self.unit(order, t).is_finite(),
            })
        };
        // A displacement that is an integral of its velocity is finite where the velocity is.
        let first = usize::from(self.kind == MotionKind::Velocity);
        (first..=2).all(is_finite)
    }

    /// Displacement beyond the initial one (order 0), velocity (1) or acceleration (2) at time t for unit
    /// amplitude.
    pub fn unit(&self, order: usize, t: f64) -> f64 {
        let g = &self.function;
        match order + usize::from(self.kind == MotionKind::Displacement) {
            0 => g.integral(t),
            1 => g.value(t),
            2 => g.derivative(t),
            _ => g.second_derivative(t),
        }
    }

    /// Calls `set(entry of the state's arrays, slot, value)` for every prescribed component of the points of `on`
    /// that no other constraint prescribes. The value is the displacement beyond the initial one, the velocity or the acceleration.
    pub(super) fn for_each(
        &self,
        order: usize,
        t: f64,
        on: &PointSubset<'_>,
        cloud_len: usize,
        mut set: impl FnMut(usize, usize, f64),
    ) {
        let mut set = |entry: usize, slot: usize, value: f64| {
            if self.shared.binary_search(&(slot as u32)).is_err() {
                set(entry, slot, value);
            }
        };
        let unit = self.unit(order, t);
        let motions = self.along.iter().enumerate();
        let motions = motions.filter_map(|(c, along)| Some((c, along.as_ref()?)));
        for (axis, (c, along)) in motions.enumerate() {
            if let AxisMotion::Values(values) = along {
                let n = self.points.len();
                values.at(order, t, &mut |all| {
                    on.common(&self.points, |k, i| {
                        set(c * cloud_len + i, axis * n + k, all[c * n + k]);
                    });
                });
                continue;
            }
            on.common(&self.points, |k, i| {
                let number = match along {
                    AxisMotion::Uniform(amplitude) => amplitude * unit,
                    AxisMotion::PerPoint(amplitudes) => amplitudes[k] * unit,
                    AxisMotion::Trajectory { trajectory, places } => {
                        trajectory.derivative(order, places[k], t)
                    }
                    AxisMotion::Values(_) => return,
                };
                set(c * cloud_len + i, axis * self.points.len() + k, number);
            });
        }
    }

    /// Returns the values of all points at once by which axes are prescribed.
    pub(crate) fn values(&self) -> impl Iterator<Item = &dyn PointValues> {
        self.along.iter().filter_map(|along| match along {
            Some(AxisMotion::Values(values)) => Some(&**values),
            _ => None,
        })
    }

    /// Sets the displacements at time t.
    pub(crate) fn place(&self, t: f64, on: &PointSubset<'_>, cloud_len: usize, u: &mut [f64]) {
        if self.holds(t) {
            self.for_each(0, t, on, cloud_len, |entry, slot, displacement| {
                u[entry] = self.start[slot] + displacement;
            });
        }
    }

    /// Sets the velocities at time t.
    pub(crate) fn drive(&self, t: f64, on: &PointSubset<'_>, cloud_len: usize, v: &mut [f64]) {
        if self.holds(t) {
            self.for_each(1, t, on, cloud_len, |entry, _, velocity| {
                v[entry] = velocity
            });
        }
    }

    /// Sets the mean velocities between t and t + dt.
    pub(crate) fn drive_mean(
        &self,
        t: f64,
        dt: f64,
        on: &PointSubset<'_>,
        cloud_len: usize,
        v: &mut [f64],
    ) {
        if self.holds(t + dt) {
            self.for_each(0, t + dt, on, cloud_len, |entry, _, after| v[entry] = after);
            self.for_each(0, t, on, cloud_len, |entry, _, before| {
                v[entry] = (v[entry] - before) / dt;
            });
        }
    }

    /// Replaces accelerations by the prescribed ones at time t.
    pub(crate) fn accelerate(
        &self,
        t: f64,
        on: &PointSubset<'_>,
        cloud_len: usize,
        acceleration: &mut [f64],
    ) {
        if self.holds(t) {
            self.for_each(2, t, on, cloud_len, |entry, _, rate| {
                acceleration[entry] = rate;
            });
        }
    }

    /// Zeros the prescribed entries of a virtual displacement. Points with a release time count as free.
    pub(crate) fn project(&self, cloud_len: usize, vector: &mut [f64]) {
        if self.until.is_none() {
            self.zero(cloud_len, vector);
        }
    }

    /// Zeros the prescribed entries of a vector.
    pub(crate) fn zero(&self, cloud_len: usize, vector: &mut [f64]) {
        for c in self.axes() {
            for &i in &self.points {
                vector[c * cloud_len + i as usize] = 0.0;
            }
        }
    }

    /// Adds the prescribed accelerations at time t.
    pub(crate) fn add_acceleration(&self, t: f64, cloud_len: usize, acceleration: &mut [f64]) {
        if self.holds(t) {
            self.for_each(2, t, &PointSubset::All, cloud_len, |entry, _, rate| {
                acceleration[entry] += rate;
            });
        }
    }
}

crate::saved! {
    impl SavedUnder(place) for PrescribedMotion {
        reaction: by(Laid::on(format!("{place}/reaction"), points)),
        name, points, kind, along, function, until, start, shared: fixed,
    }
}
