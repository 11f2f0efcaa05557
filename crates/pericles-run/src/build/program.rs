//! Initial state, loads and prescribed motions given by a program.
//!
//! Arrays and functions of a program are conditions on points and sets of the discretisation, next to those of the
//! deck; a deck may refer to sets that the program adds. `run.json` names the additions, and only the program can
//! resume such a run.

use pericles::System;
use pericles::boundary::{Load, PrescribedMotion};
use pericles::time::State;
use pericles_deck::{BuildError, Fault};

use super::rejection::{at, at_path};

/// Initial state, loads and prescribed motions that a program adds to those of a model. The initial state replaces the initial state
/// of the model; loads add to those of the model; a motion of a point that the model constrains along the same axis is
/// rejected.
#[derive(Debug, Clone, Default)]
pub struct Conditions {
    /// Initial displacement of the points, component-major, m.
    pub displacement: Option<Vec<f64>>,
    /// Initial velocity of the points, component-major, m/s.
    pub velocity: Option<Vec<f64>>,
    /// Loads.
    pub loads: Vec<Load>,
    /// Prescribed motions.
    pub motions: Vec<PrescribedMotion>,
}

impl Conditions {
    /// Returns whether there are no loads and prescribed motions.
    pub(super) fn is_empty(&self) -> bool {
        self.loads.is_empty() && self.motions.is_empty()
    }

    /// Replaces the initial state.
    pub(super) fn start(&self, state: &mut State) -> Result<(), BuildError> {
        let fields = [
            (&self.displacement, &mut state.u, "displacement"),
            (&self.velocity, &mut state.v, "velocity"),
        ];
        for (given, field, what) in fields {
            let Some(given) = given else { continue };
            let reject = |reason| Err(at_path("initial", Fault::BadDiscretisation { reason }));
            let (found, needed) = (given.len(), field.len());
            if found != needed {
                let reason =
                    format!("the initial {what} has {found} values, the body needs {needed}");
                return reject(reason);
            }
            if !given.iter().all(|value| value.is_finite()) {
                let reason = format!("the initial {what} has values that are NaN or infinite");
                return reject(reason);
            }
            field.copy_from_slice(given);
        }
        Ok(())
    }

    /// Adds the loads.
    pub(super) fn add_loads(&self, system: &mut System) -> Result<(), BuildError> {
        for load in &self.loads {
            let added = system.add_load(load.clone());
            added.map_err(|error| at("load", error))?;
        }
        Ok(())
    }

    /// Adds the prescribed motions to a body with the initial displacement `u`.
    pub(super) fn add_motions(&self, system: &mut System, u: &[f64]) -> Result<(), BuildError> {
        for motion in &self.motions {
            let PrescribedMotion {
                name,
                points,
                kind,
                along,
                function,
                until,
                ..
            } = motion.clone();
            let n = system.points();
            let started = PrescribedMotion::along(name, points, kind, along, function, u, n);
            let added = started.and_then(|mut started| {
                started.until = until;
                system.add_motion(started)
            });
            added.map_err(|error| at("constraint", error))?;
        }
        Ok(())
    }
}
