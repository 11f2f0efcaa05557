//! The items that most programs need: `use pericles::prelude::*;`.

pub use crate::archive::Checkpointed;
pub use crate::body::Body;
pub use crate::boundary::{Load, PrescribedMotion, TimeFunction};
pub use crate::error::PericlesError;
pub use crate::family::{Crack, VolumeCorrection};
pub use crate::interrupt::Interrupt;
pub use crate::kernel::{Influence, InfluenceFunction};
pub use crate::lanes::{Real, dot, vector};
pub use crate::material::{
    BondMaterial, ElasticModulus, InterfaceRule, PairForce, PairLaw, StressState, SurfaceCorrection,
};
pub use crate::observe::{
    CrackTracker, Energies, Field, ObserveError, Observer, Probe, Schedule, Snapshot, TrackedCrack,
};
pub use crate::operator::{BondForm, Force, PointSubset};
pub use crate::saved;
pub use crate::simulation::{Control, Outcome, Simulation, SimulationError};
pub use crate::space::{Face, Grid, ListedPoints, Point, PointCloud, PointSet, Region, Shape};
pub use crate::step_end::{Path, StepEnd};
pub use crate::system::System;
pub use crate::time::{Integrator, State, VelocityVerlet};
