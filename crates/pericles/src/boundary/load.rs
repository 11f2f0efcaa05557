//! Loads: body forces and tractions.

use std::fmt;
use std::sync::Arc;

use super::{PointValues, TimeFunction};
use crate::error::{PericlesError, Result, positive};
use crate::operator::PointSubset;
use crate::space::{PointCloud, PointSet, check_length, check_set};

/// A vector field of position and time.
pub trait FieldFunction: fmt::Debug + Send + Sync {
    /// Component c at a position (m) and time (s).
    fn value(&self, c: usize, place: [f64; 3], t: f64) -> f64;
}

/// Amplitude of a load, N/m³.
#[derive(Debug, Clone)]
pub enum LoadDensity {
    /// The same on all points; components beyond the dimension of the body are zero.
    Uniform([f64; 3]),
    /// One number per loaded point and component: component c of the k-th loaded point is entry c · (loaded points)
    /// + k.
    PerPoint(Vec<f64>),
    /// A field of position and time multiplied by a factor.
    Field {
        /// The field.
        field: Arc<dyn FieldFunction>,
        /// The factor.
        factor: f64,
        /// Positions of the loaded points, m.
        places: Vec<[f64; 3]>,
    },
    /// Values of all loaded points at once, N/m³.
    Values(Arc<dyn PointValues>),
}

impl From<[f64; 3]> for LoadDensity {
    fn from(density: [f64; 3]) -> Self {
        Self::Uniform(density)
    }
}

/// A force density b(x, t) = density(x) · g(t), N/m³, on a set of points during a time window.
#[derive(Debug, Clone)]
pub struct Load {
    /// The loaded points.
    pub points: PointSet,
    /// Amplitude, N/m³.
    pub density: LoadDensity,
    /// Time function g(t).
    pub function: TimeFunction,
    /// First and last time at which the load acts, s.
    pub window: [f64; 2],
}

/// The window of a load that always acts.
pub const ALWAYS: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

impl Load {
    /// A load that always acts.
    pub fn new(points: PointSet, density: impl Into<LoadDensity>, function: TimeFunction) -> Self {
        Self {
            points,
            density: density.into(),
            function,
            window: ALWAYS,
        }
    }

    /// A traction (force per area, Pa) on `area` (m²) of a layer of points, distributed over the volume of the
    /// layer: b = traction · area / ΣV.
    ///
    /// # Errors
    /// A layer without points or with points that the body does not have; an area that is not positive.
    pub fn traction(
        cloud: &PointCloud,
        points: PointSet,
        traction: [f64; 3],
        area: f64,
        function: TimeFunction,
    ) -> Result<Self> {
        const WHAT: &str = "the points of a traction";
        check_set(WHAT, &points, cloud.len())?;
        if points.is_empty() {
            return Err(PericlesError::BadSet {
                what: WHAT,
                reason: "no points are given; at least one is needed",
            });
        }
        let factor = positive("the area of a traction", area)? / volume(cloud, &points);
        Ok(Self::new(points, traction.map(|c| c * factor), function))
    }

    /// Checks that a load fits a body of `points` points: point numbers, and one amplitude or position per point.
    pub(crate) fn check(&self, dimension: usize, points: usize) -> Result<()> {
        check_set("the points of a load", &self.points, points)?;
        let loaded = self.points.len();
        match &self.density {
            LoadDensity::Uniform(_) => Ok(()),
            // All three axes are given, even for bodies of fewer dimensions.
            LoadDensity::PerPoint(densities) if densities.len() == 3 * loaded => Ok(()),
            LoadDensity::PerPoint(densities) => check_length(
                "the amplitudes of a load",
                densities.len(),
                dimension * loaded,
            ),
            LoadDensity::Field { places, .. } => {
                check_length("the positions of a load", places.len(), loaded)
            }
            LoadDensity::Values(values) => {
                check_length("the values of a load", values.len(), dimension * loaded)
            }
        }
    }

    /// Returns whether the load has no component along axis c at any time.
    pub fn is_free_of(&self, c: usize) -> bool {
        matches!(self.density, LoadDensity::Uniform(density) if density[c] == 0.0)
    }

    /// Returns g(t) while the load acts, else zero.
    pub fn factor(&self, t: f64) -> f64 {
        if (self.window[0]..=self.window[1]).contains(&t) {
            self.function.value(t)
        } else {
            0.0
        }
    }

    /// Returns whether the load is a product of an amplitude of each point and [`Load::factor`].
    pub fn is_separable(&self) -> bool {
        match self.density {
            LoadDensity::Uniform(_) | LoadDensity::PerPoint(_) => true,
            LoadDensity::Field { .. } | LoadDensity::Values(_) => false,
        }
    }

    /// Amplitude along axis c on the k-th loaded point.
    pub fn amplitude(&self, c: usize, k: usize, t: f64) -> f64 {
        match &self.density {
            LoadDensity::Uniform(density) => density[c],
            LoadDensity::PerPoint(densities) => densities[c * self.points.len() + k],
            LoadDensity::Field {
                field,
                factor,
                places,
            } => factor * field.value(c, places[k], t),
            LoadDensity::Values(values) => {
                let mut value = 0.0;
                values.at(0, t, &mut |all| value = all[c * self.points.len() + k]);
                value
            }
        }
    }

    /// Passes a function that returns the amplitudes at several times along axis c on the k-th loaded point.
    /// Values of all points at once are asked for once per time.
    pub(crate) fn with_amplitudes<const M: usize>(
        &self,
        times: [f64; M],
        read: impl FnOnce(&(dyn Fn(usize, usize) -> [f64; M] + Sync)),
    ) {
        let LoadDensity::Values(values) = &self.density else {
            read(&|c, k| times.map(|t| self.amplitude(c, k, t)));
            return;
        };
        let all = times.map(|t| {
            let mut copy = Vec::new();
            values.at(0, t, &mut |all| copy.extend_from_slice(all));
            copy
        });
        let n = self.points.len();
        read(&|c, k| std::array::from_fn(|m| all[m][c * n + k]));
    }

    /// Returns the values of all points at once, if the load is given by them.
    pub(crate) fn values(&self) -> Option<&dyn PointValues> {
        match &self.density {
            LoadDensity::Values(values) => Some(&**values),
            _ => None,
        }
    }

    /// Returns whether the force at time t is finite: on all points for a constant amplitude, on the first, middle
    /// and last point for a field of position and time. Values computed for all points at once are not evaluated:
    /// the times at which they are given belong to the run.
    pub fn is_finite_at(&self, t: f64, dimension: usize) -> bool {
        let factor = self.factor(t);
        if factor == 0.0 || self.points.is_empty() {
            return true;
        }
        let last = self.points.len() - 1;
        let amplitudes = |k: usize| (0..dimension).map(move |c| self.amplitude(c, k, t));
        factor.is_finite()
            && match self.density {
                LoadDensity::Field { .. } => [0, last / 2, last]
                    .into_iter()
                    .flat_map(amplitudes)
                    .all(f64::is_finite),
                LoadDensity::Uniform(_) | LoadDensity::PerPoint(_) | LoadDensity::Values(_) => true,
            }
    }

    /// Adds the force density at time t, times a factor, on the points of `on`.
    pub(crate) fn add_force(
        &self,
        (t, share): (f64, f64),
        on: &PointSubset<'_>,
        points: usize,
        dimension: usize,
        out: &mut [f64],
    ) {
        let factor = share * self.factor(t);
        if factor == 0.0 {
            return;
        }
        for c in 0..dimension {
            let component = &mut out[c * points..(c + 1) * points];
            match self.density {
                LoadDensity::Uniform(density) => {
                    let force = density[c] * factor;
                    if force != 0.0 {
                        on.common(&self.points, |_, i| component[i] += force);
                    }
                }
                LoadDensity::Values(ref values) => values.at(0, t, &mut |all| {
                    let own = &all[c * self.points.len()..];
                    on.common(&self.points, |k, i| component[i] += own[k] * factor);
                }),
                _ => on.common(&self.points, |k, i| {
                    component[i] += self.amplitude(c, k, t) * factor;
                }),
            }
        }
    }

    /// Resultant force on the whole body at time t, N. All processes must call it together.
    pub fn resultant(&self, t: f64, cloud: &PointCloud) -> [f64; 3] {
        let factor = self.factor(t);
        let mut sum = [0.0; 3];
        if factor == 0.0 {
            return sum;
        }
        if let LoadDensity::Uniform(density) = self.density {
            let volume = volume(cloud, &self.points);
            for c in 0..cloud.dimension() {
                sum[c] = density[c] * factor * volume;
            }
            return sum;
        }
        self.with_amplitudes([t], |amplitude| {
            for (c, sum) in sum.iter_mut().enumerate().take(cloud.dimension()) {
                let force = |k: usize| {
                    let volume = cloud.volumes()[self.points[k] as usize];
                    amplitude(c, k)[0] * factor * volume
                };
                *sum = cloud.domain().sum(self.points.len(), force);
            }
        });
        sum
    }
}

/// Returns the volume of a set, m³. All processes must call it together.
fn volume(cloud: &PointCloud, points: &[u32]) -> f64 {
    let volume = |k: usize| cloud.volumes()[points[k] as usize];
    cloud.domain().sum(points.len(), volume)
}
