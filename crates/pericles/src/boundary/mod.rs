//! Loads, prescribed motion, and the seam for other boundaries.

mod function;
mod load;
mod motion;
mod table;

pub use function::{TimeCourse, TimeFunction};
pub use load::{ALWAYS, FieldFunction, Load, LoadDensity};
pub use motion::{AxisMotion, MotionKind, PrescribedMotion, Trajectory};
pub use table::TimeTable;

use crate::archive::Saved;

/// A boundary that acts on the state around force evaluations: ghost points, absorbing ends, damping layers.
pub trait Boundary: Saved + Send + Sync {
    /// Called before the force is evaluated at time t, with the displacement and velocity of that stage.
    fn before_force(&mut self, t: f64, u: &mut [f64], v: &mut [f64]);

    /// Called after the accelerations of a stage are known; may change them.
    fn after_stage(&mut self, t: f64, u: &[f64], v: &[f64], acceleration: &mut [f64]);
}
