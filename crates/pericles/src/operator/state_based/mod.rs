//! The force of state-based materials.
//!
//! | part | what |
//! |---|---|
//! | `kinematics` | how stretches and directions follow from displacements: the law, shared by all forms of loops |
//! | `bonds`, `weight` | what the loops over lists read |
//! | `kernels`, `bond_work` | the loops over lists |
//! | `breaking` | which bonds break, and what that dissipates |
//! | `force`, `passes`, `view` | the operator on lists |
//! | `grid` | the same on a lattice, by one stencil |
//! | `inelastic` | solids whose shear is viscous or plastic, on lists |
//! | `body` | what the operator is made of, and the choice of its form |

mod body;
mod bond_work;
mod bonds;
mod breaking;
mod force;
mod grid;
mod heat;
mod heated;
mod inelastic;
mod kernels;
mod kinematics;
mod passes;
mod view;
mod weight;

pub use body::LinearSolidBody;
pub use force::LinearSolidForce;
pub use grid::LinearSolidGrid;
pub use inelastic::{InelasticSolidBody, InelasticSolidForce};
pub use kinematics::{FiniteStrain, Kinematics, SmallStrain};
