//! Static equilibrium, quasi-static fracture and natural modes of peridynamic bodies, by solvers whose number of iterations does not grow with the body.
//!
//! | module | contents |
//! |---|---|
//! | [`StaticScheme`] | the integrator whose steps go from one static state to the next by Newton's method |
//! | [`BreakingRule`] | which bonds break at a static state |
//! | [`NaturalModes`] | lowest natural frequencies and mode shapes |
//! | [`krylov`] | conjugate gradients with a preconditioner |
//! | [`surrogate`] | the springs between neighbouring points that stand for the body in the preconditioner |
//! | [`multigrid`] | smoothed-aggregation multigrid of their matrix |
//! | [`rigid`] | rigid-body motions that no support prevents |
//!
//! The crate uses only what the engine, [`pericles`], exports.

mod block;
mod breaking;
mod chunks;
mod eigen;
mod equilibrium;
mod error;
mod events;
pub mod krylov;
mod modes;
pub mod multigrid;
mod options;
mod path;
pub mod rigid;
mod scheme;
pub mod sparse;
mod stretch;
pub mod surrogate;
mod tangent;
mod unknowns;

pub use breaking::BreakingRule;
pub use eigen::symmetric_eigen;
pub use equilibrium::{Effort, Equilibrium, Target};
pub use error::StaticsError;
pub use modes::{Mode, ModeGroup, ModeOptions, NaturalModes};
pub use options::StaticOptions;
pub use scheme::StaticScheme;
pub use tangent::Tangent;
pub use unknowns::Unknowns;
