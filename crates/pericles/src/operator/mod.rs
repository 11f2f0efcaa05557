//! Force operators: u ↦ internal force density.
//!
//! Vectors on points are component-major slices of length `dimension * points` (see
//! [`crate::space::PointCloud`]): displacements in m, force densities in N/m³. An operator does not depend on
//! the density or the time integration scheme.
//!
//! | kernel | bodies | bonds | ns per directed bond, 3D |
//! |---|---|---|---|
//! | [`BondForce`] | any | listed, 3 bytes each | 3 |
//! | `SurfaceForce` (`pericles-manifold`) | surfaces | listed, 12 bytes each | 1.1 (p = 2), 1.2 (p = 3) |
//! | [`GridForce`] | on a lattice | one stencil, one bit each | 0.8 (AVX-512), 1.4 (AVX2), 4 (baseline); half of that in single precision |
//! | [`SofteningForce`] | any, softening bonds | listed, 11 bytes each | – |
//! | [`LinearSolidForce`] | state-based, any | listed, 3 bytes each; two passes | 2 to 2.5 times [`BondForce`] |
//! | [`LinearSolidGrid`] | state-based, on a lattice | one stencil, one bit each; two passes | 2 times [`GridForce`] |
//!
//! [`BondBody::operator`] and [`LinearSolidBody::operator`] select the kernel. Times are for one core of an
//! AMD EPYC 9004.
//!
//! **Dispatch.** Pair law and dimension are generic parameters of the loops; operators, boundaries, integrators and
//! observers are trait objects with one virtual call per evaluation. Only operators have the dimension as a
//! compile-time constant, because only their loops benefit from it: points, regions and integrators use flat slices,
//! so that [`State`](crate::time::State), [`System`](crate::System) and observers are not generic.
//!
//! **Both ends of a bond compute its force**, from ξ, η and −ξ, −η. For equal volumes the results are bitwise equal
//! except for the sign, and momentum is conserved to round-off. Forces are not scattered to neighbours, so that loops
//! need no locks and a part of a body can be evaluated alone. Every correction of a bond is the mean of its two ends.

mod assemble;
mod breakable;
mod by_law;
mod capabilities;
mod composite;
mod fast_law;
mod forces;
mod form;
mod ghosts;
mod graded;
mod grid;
mod growing;
mod heating;
mod limits;
mod linearisation;
mod list;
mod own_law;
mod polynomials;
pub mod pool;
pub mod prefetch;
pub mod records;
pub mod rows;
mod springs;
mod state_based;
mod stencil_force;
mod thresholds;
mod two_pass;
mod view;
mod zoned;

pub use assemble::{AssembledBonds, BondBody};
pub use breakable::{Breakable, Breaking};
pub use by_law::{ByLaw, by_law};
pub use capabilities::{Capabilities, Linearity};
pub use composite::CompositeBody;
pub use fast_law::{FixedBond, VectorLaw};
pub use forces::Forces;
pub use form::BondForm;
pub use ghosts::{GhostForce, GhostLayer};
pub use graded::{GradedBody, Materials};
pub use grid::GridForce;
pub use growing::Growing;
pub use limits::{Feature, Features, Limit};
pub use linearisation::Linearisation;
pub use list::{BondForce, SofteningForce};
pub use own_law::PlainLaw;
pub use springs::{LatticeSpring, LatticeSprings};
pub use state_based::{
    FiniteStrain, Kinematics, LinearSolidBody, LinearSolidForce, LinearSolidGrid, SmallStrain,
};
pub use stencil_force::{
    CriticalStretches, StencilData, StencilForce, StencilLaw, StencilMaterial, StencilSolid,
    StiffnessFactors,
};
pub use two_pass::{AtPoints, Neighbours, TwoPass, TwoPassForce, with_neighbours};
pub use view::{BondAt, BondValues, BondView, DilatationView, PlasticView, StressView};
pub use zoned::{LocalForce, SplitForce};

pub use crate::lanes::InstructionSet;
pub use crate::neighbourhood::{CoarseBreak, DamageMeasure};
pub use crate::parallel::PointSubset;

use self::heating::heating_of;
use crate::archive::Checkpointed;
use crate::step_end::StepEnd;
use crate::thermal::{Expandable, Pointwise};

/// The internal force density on the points of a body as a function of their displacements.
///
/// Optional features are described by [`Capabilities`]. The force on a point does not depend on which other
/// points are evaluated with it.
pub trait Force: Checkpointed + Send + Sync {
    /// Returns the number of points.
    fn points(&self) -> usize;

    /// Returns the dimension; vectors have `dimension * points` entries.
    fn dimension(&self) -> usize;

    /// Adds the force density at displacement `u` to `out` for the points `on`; other entries are unchanged.
    fn add_force(&self, t: f64, u: &[f64], on: PointSubset<'_>, out: &mut [f64]);

    /// Adds the elastic energy density (J/m³, one value per point) at displacement `u` to `out`.
    fn add_energy_density(&self, t: f64, u: &[f64], out: &mut [f64]);

    /// Returns the elastic energy of the body, J.
    fn energy(&self, t: f64, u: &[f64]) -> f64;

    /// Returns an upper bound of the highest angular frequency (1/s) about the reference state, for the
    /// density ρ (kg/m³) of each point.
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64;

    /// Sets `out` to the derivative of the force density at `u` in the given direction, for Newton–Krylov
    /// methods and frequency estimates.
    fn tangent_into(&self, t: f64, u: &[f64], direction: &[f64], out: &mut [f64]);

    /// Sets `out` to the derivative of the force density at `u` in the given direction if damage stays that of `u`, for
    /// iterations that must not lose positive stiffness. Forces without damage by softening have the tangent.
    fn secant_into(&self, t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        self.tangent_into(t, u, direction, out);
    }

    /// Applies the failure criterion at the end of a step and adds the force density for the points `on`. An
    /// over-stretched bond exerts no force from this evaluation on.
    ///
    /// A broken bond dissipates [`StepEnd::dissipated`]. Bonds for which this differs strongly from the
    /// energy at the critical stretch are returned by [`Breakable::take_coarse_breaks`].
    fn end_step(&mut self, step: &StepEnd<'_>, on: PointSubset<'_>, out: &mut [f64]) {
        self.add_force(step.t, step.u, on, out);
    }

    /// Returns the optional capabilities; none by default.
    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities::default()
    }

    /// Returns [`Capabilities::breaking`] for modification.
    fn breaking_mut(&mut self) -> Option<&mut dyn Breakable> {
        None
    }

    /// Returns [`Capabilities::split`] for modification.
    fn split_mut(&mut self) -> Option<&mut dyn SplitForce> {
        None
    }

    /// Returns [`Capabilities::stencil`] for modification.
    fn stencil_mut(&mut self) -> Option<&mut dyn StencilForce> {
        None
    }

    /// Returns the material for setting a thermal expansion, if the force supports it.
    fn expandable_mut(&mut self) -> Option<&mut dyn Expandable> {
        None
    }

    /// Returns the material for setting factors of the stiffness and the yield stress of points, if the force supports them.
    fn pointwise_mut(&mut self) -> Option<&mut dyn Pointwise> {
        None
    }

    /// Returns the force as one whose bonds come into being during a run, if it supports this.
    fn growing_mut(&mut self) -> Option<&mut dyn Growing> {
        None
    }

    /// Returns the work of changing temperatures within a step, J: the change of the energy at fixed
    /// displacements, averaged over both ends of the step.
    ///
    /// With the forces of both ends, each acting for half of the step, the energy balance is exact for
    /// energies that are quadratic in displacements and temperatures. The work is zero for a step without a
    /// known path.
    fn heating(&self, step: &StepEnd<'_>) -> f64 {
        heating_of(self.capabilities().thermal, step, &|t, u| self.energy(t, u))
    }

    /// Returns the springs of an infinite lattice that contains the body at rest, for a bound of its highest
    /// frequency; `None` for other bodies.
    fn lattice_springs(&self) -> Option<LatticeSprings> {
        None
    }

    /// Returns the largest error of the force at `u` due to single precision, relative to the largest force;
    /// `None` for forces in double precision.
    fn rounding(&self, u: &[f64]) -> Option<f64> {
        let _ = u;
        None
    }

    /// Returns a point with a non-positive volume ratio at the end of the last step, if the material requires
    /// a positive one.
    fn inversion(&self) -> Option<Inversion> {
        None
    }

    /// Returns a point of this process whose yield stress was not positive at its temperature at the end of the last step.
    fn lost_yield(&self) -> Option<LostYield> {
        None
    }

    /// Returns the number of family entries in the loops: each bond counts twice. Zero for forces without
    /// bonds.
    fn directed_bonds(&self) -> u64 {
        0
    }

    /// Returns the memory use without the points, bytes.
    fn bytes(&self) -> usize {
        0
    }

    /// Returns the number of values per point that the processes that share a body exchange between the passes of an
    /// evaluation, besides the displacements; zero for forces with a single pass.
    fn values_between_passes(&self) -> usize {
        0
    }

    /// Returns the instruction set of the loops.
    fn instruction_set(&self) -> InstructionSet {
        InstructionSet::Baseline
    }

    /// Selects another instruction set for the loops, if both operator and machine support it; for tests and
    /// benchmarks.
    fn use_instruction_set(&mut self, set: InstructionSet) {
        let _ = set;
    }
}

/// A point with inverted material, which stops the run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inversion {
    /// The point.
    pub point: usize,
    /// J = det F of the deformation gradient F, zero or negative.
    pub volume_ratio: f64,
}

/// A point whose yield stress is not positive, which stops the run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LostYield {
    /// The point.
    pub point: usize,
    /// Yield stress relative to that of the material.
    pub ratio: f64,
}

/// A force density linear in the displacement.
pub trait LinearOperator: Send + Sync {
    /// Sets `out` to the force density at `u`.
    fn apply_into(&self, u: &[f64], out: &mut [f64]);

    /// Returns the largest |i − j| of coupled unknowns if the matrix is known to be banded, as for bars
    /// without periodic ends.
    fn half_bandwidth(&self) -> Option<usize> {
        None
    }

    /// Returns the operator as a diagonal one if its eigenvectors are known.
    fn as_diagonal(&self) -> Option<&dyn Diagonal> {
        None
    }
}

/// A linear operator with known eigenvectors: any function of it costs two changes of basis.
pub trait Diagonal: Send + Sync {
    /// Adds g(A) x to the result of each function, with A = K/ρ + shift (1/s²) and a uniform density ρ
    /// (kg/m³).
    fn add_functions(&self, density: f64, shift: f64, x: &[f64], functions: &mut [FunctionOf<'_>]);
}

/// A function of an operator applied to a vector.
pub struct FunctionOf<'a> {
    /// g as a function of an eigenvalue of the operator.
    pub value: &'a (dyn Fn(f64) -> f64 + Sync),
    /// Vector to which g(A) x is added.
    pub out: &'a mut [f64],
}
