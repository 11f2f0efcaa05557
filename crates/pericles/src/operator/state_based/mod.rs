//! Force kernels of state-based materials.
//!
//! | module | contents |
//! |---|---|
//! | `kinematics` | stretches and directions of bonds, shared by all loops |
//! | `bonds`, `weight` | data of the loops over lists |
//! | `kernels`, `bond_work` | loops over lists |
//! | `breaking`, `criterion` | bond failure and dissipated energy |
//! | `force`, `passes`, `view` | operator on lists |
//! | `grid` | stencil kernel for lattices |
//! | `body` | input of the operator and choice of the kernel |
//!
//! **Bond failure.** Points keep their weighted volume when bonds break: the force remains the gradient of the
//! energy, and the dilatation vanishes with the bonds. The dissipated energy is the change of the energy of a point,
//! with the half-step rule of single bonds. Surface correction factors multiply the energy, not only the force, so
//! that the energy balance holds.

mod body;
mod bond_work;
mod bonds;
mod breaking;
mod criterion;
mod force;
mod grid;
mod heat;
mod heated;
mod kernels;
mod kinematics;
mod passes;
mod view;
mod weight;

pub use body::LinearSolidBody;
pub use force::LinearSolidForce;
pub use grid::LinearSolidGrid;
pub use kinematics::{FiniteStrain, Kinematics, SmallStrain};
