//! Force operators: u ↦ internal force density.
//!
//! All vectors on points are component-major slices of length `dimension * points` (see [`crate::space::PointCloud`]): displacements in m,
//! force densities in N/m³. An operator knows neither the density nor the scheme that calls it.
//!
//! | form | bodies | bonds | ns per directed bond, 3D |
//! |---|---|---|---|
//! | [`BondForce`] | any | listed, 3 bytes each | 3 |
//! | `SurfaceForce` (`pericles-manifold`) | surfaces | listed, 12 bytes each | 1.1 (p = 2), 1.2 (p = 3) |
//! | [`GridForce`] | on a lattice, one material | one stencil, one bit each | 0.8 (AVX-512), 1.4 (AVX2), 4 (baseline); in floats half of that |
//! | [`LinearSolidForce`] | state-based, any | listed, 3 bytes each; two passes | twice to two and a half times [`BondForce`] |
//! | [`InelasticSolidForce`] | state-based, viscous or plastic | listed, 23 bytes each and 8 for every viscous term | – |
//! | [`LinearSolidGrid`] | state-based, on a lattice | one stencil, one bit each; two passes | twice [`GridForce`] |
//!
//! [`BondBody::operator`] and [`LinearSolidBody::operator`] choose. (Times: one core of an AMD EPYC 9004.)

mod assemble;
mod breakable;
mod by_law;
mod capabilities;
mod composite;
mod damage;
mod fast_law;
mod forces;
mod form;
mod graded;
mod grid;
mod limits;
mod linearisation;
mod list;
mod own_law;
pub mod pool;
pub mod prefetch;
pub mod records;
pub mod rows;
mod springs;
mod state_based;
mod thresholds;
mod two_pass;
mod view;
mod zoned;

pub use assemble::{AssembledBonds, BondBody};
pub use breakable::Breakable;
pub use by_law::{ByLaw, by_law};
pub use capabilities::{Capabilities, Linearity};
pub use composite::CompositeBody;
pub use damage::{Breaking, CoarseBreak, DamageMeasure, each_once};
pub use fast_law::{FastLaw, FixedBond};
pub use forces::Forces;
pub use form::BondForm;
pub use graded::{GradedBody, Materials};
pub use grid::GridForce;
pub use limits::{Feature, Features, Limit};
pub use linearisation::Linearisation;
pub use list::BondForce;
pub use own_law::PlainLaw;
pub use springs::{LatticeSpring, LatticeSprings};
pub use state_based::{
    FiniteStrain, InelasticSolidBody, InelasticSolidForce, Kinematics, LinearSolidBody,
    LinearSolidForce, LinearSolidGrid, SmallStrain,
};
pub use two_pass::{AtPoints, TwoPass, TwoPassForce};
pub use view::{BondAt, BondView, DilatationView, PlasticView};
pub use zoned::{LocalForce, SplitForce};

pub use crate::lanes::InstructionSet;
pub use crate::parallel::On;

use crate::archive::Saved;
use crate::step_end::{Path, StepEnd};
use crate::thermal::Expandable;

/// A force density on the points of a body as a function of their displacements.
///
/// What a force must do is small; what it can do beside that it says by its [`Capabilities`]. A point's force does not depend on which points are evaluated together.
pub trait Force: Saved + Send + Sync {
    /// Number of points.
    fn points(&self) -> usize;

    /// Dimension, so that vectors have `dimension * points` entries.
    fn dimension(&self) -> usize;

    /// Adds the force density at displacement `u` to `out`, for the points named by `on`; other entries stay.
    fn add_force(&self, t: f64, u: &[f64], on: On<'_>, out: &mut [f64]);

    /// Adds the elastic energy density (J/m³, one number per point) at displacement `u` to `out`.
    fn add_energy_density(&self, t: f64, u: &[f64], out: &mut [f64]);

    /// Elastic energy of the body, J.
    fn energy(&self, t: f64, u: &[f64]) -> f64;

    /// An upper bound of the highest angular frequency (1/s) about the reference state, for the density ρ (kg/m³) of each point.
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64;

    /// `out` = the derivative of the force density at `u` in the given direction, for Newton–Krylov methods and frequency estimates.
    fn tangent_into(&self, t: f64, u: &[f64], direction: &[f64], out: &mut [f64]);

    /// Decides breaking at the end of a step and adds the force density there, for the points named by `on`: a bond found over-stretched exerts no force in this evaluation and later ones.
    ///
    /// What it dissipates is [`StepEnd::dissipated`]. Where that is far from its energy at the critical stretch, [`Breakable::take_coarse_breaks`] tells.
    fn end_step(&mut self, step: &StepEnd<'_>, on: On<'_>, out: &mut [f64]) {
        self.add_force(step.t, step.u, on, out);
    }

    /// What it can do beside computing forces; nothing unless it says so.
    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities::default()
    }

    /// The same as [`Capabilities::breaking`], to be changed.
    fn breaking_mut(&mut self) -> Option<&mut dyn Breakable> {
        None
    }

    /// The same as [`Capabilities::split`], to decide breaking part by part.
    fn split_mut(&mut self) -> Option<&mut dyn SplitForce> {
        None
    }

    /// Its material as one that can be given a thermal expansion, if the force represents that.
    fn expandable_mut(&mut self) -> Option<&mut dyn Expandable> {
        None
    }

    /// The work that temperatures do by changing within a step, J: ∂E/∂t of the energy at fixed displacements, as the mean of both ends of the step.
    ///
    /// With the forces of both ends, each for half of the step, it closes the energy balance exactly where the energy is a quadratic function of displacements and temperatures. A step that is not known as a path does none.
    fn heating(&self, step: &StepEnd<'_>) -> f64 {
        let thermal = self.capabilities().thermal;
        let Some(before) = thermal.and_then(|_| step.displacement_before()) else {
            return 0.0;
        };
        // The first static state is reached from the body before it was heated.
        let first = matches!(step.path, Path::Chord { first: true, .. });
        let cold = match first {
            true => f64::NEG_INFINITY,
            false => step.t - step.dt,
        };
        let steady = thermal.is_none_or(|thermal| thermal.is_steady());
        if !first && (steady || step.dt == 0.0) {
            return 0.0;
        }
        let gain = |u: &[f64]| self.energy(step.t, u) - self.energy(cold, u);
        let mean = 0.5 * (gain(&before) + gain(step.u));
        match first {
            // Energy of the state before counts as it was heated there.
            true => mean + self.energy(cold, &before) - self.energy(step.t - step.dt, &before),
            false => mean,
        }
    }

    /// The springs of an infinite lattice of which the body at rest is a part: a bound of its highest frequency. None of bodies that are no part of a lattice of springs.
    fn lattice_springs(&self) -> Option<LatticeSprings> {
        None
    }

    /// The largest error of the force at `u` for being computed in floats, over the largest force; none of forces that are computed in doubles.
    fn rounding(&self, u: &[f64]) -> Option<f64> {
        let _ = u;
        None
    }

    /// A point whose material had no positive volume left at the end of the last step, if the force has a material that needs one.
    fn inversion(&self) -> Option<Inversion> {
        None
    }

    /// Family entries that the loops run over: each bond counts twice. Zero of forces without bonds.
    fn directed_bonds(&self) -> u64 {
        0
    }

    /// Memory beside that of the points, bytes.
    fn bytes(&self) -> usize {
        0
    }

    /// What the loops are compiled for.
    fn instruction_set(&self) -> InstructionSet {
        InstructionSet::Baseline
    }

    /// Runs the loops with another instruction set, if the operator has loops for it and the machine has it; for tests and benchmarks.
    fn use_instruction_set(&mut self, set: InstructionSet) {
        let _ = set;
    }
}

/// A point whose material is turned inside out: the run cannot go on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inversion {
    /// The point.
    pub point: usize,
    /// J = det F of its deformation gradient F, zero or negative.
    pub volume_ratio: f64,
}

/// A force density linear in the displacement.
pub trait LinearOperator: Send + Sync {
    /// `out` = force density at `u`.
    fn apply_into(&self, u: &[f64], out: &mut [f64]);

    /// The largest |i − j| of unknowns that act on each other, where it is known and the matrix a band; bars without periodic ends are.
    fn half_bandwidth(&self) -> Option<usize> {
        None
    }

    /// The operator as one whose eigenvectors are known, if it is one.
    fn as_diagonal(&self) -> Option<&dyn Diagonal> {
        None
    }
}

/// A linear operator whose eigenvectors are known: any function of it costs two changes of basis.
pub trait Diagonal: Send + Sync {
    /// Adds g(A) x to the result of every function, with A = K/ρ + shift (1/s²) for the same density ρ (kg/m³) everywhere.
    fn add_functions(&self, density: f64, shift: f64, x: &[f64], functions: &mut [FunctionOf<'_>]);
}

/// A function of an operator applied to a vector.
pub struct FunctionOf<'a> {
    /// g at an eigenvalue of the operator.
    pub value: &'a (dyn Fn(f64) -> f64 + Sync),
    /// Where g(A) x is added.
    pub out: &'a mut [f64],
}
