//! Static equilibrium, quasi-static fracture and natural modes of peridynamic bodies, with solvers whose
//! iteration counts do not grow with the body.
//!
//! | module | contents |
//! |---|---|
//! | [`StaticScheme`] | integrator whose steps are static load steps, solved by Newton's method |
//! | [`BreakingRule`] | rule that selects the bonds that break at a static state |
//! | [`Control`] | control of the load factor by a quantity of the displacements |
//! | [`NaturalModes`] | lowest natural frequencies and mode shapes |
//! | [`krylov`] | preconditioned conjugate gradients |
//! | [`surrogate`] | springs between neighbouring points that approximate the body in the preconditioner |
//! | [`multigrid`] | smoothed-aggregation multigrid for the stiffness matrix of these springs |
//! | [`rigid`] | unconstrained rigid-body motions |
//!
//! The crate uses only public items of the engine, [`pericles`].

mod block;
mod breaking;
mod control;
mod convergence;
mod eigen;
mod equilibrium;
mod error;
mod events;
pub mod krylov;
mod modes;
pub mod multigrid;
mod options;
mod path;
mod reference;
pub mod rigid;
mod scheme;
pub mod sparse;
mod stretch;
pub mod surrogate;
mod tangent;
mod unknowns;

pub use breaking::BreakingRule;
pub use control::{Control, ControlledQuantity};
pub use eigen::symmetric_eigen;
pub use equilibrium::{Effort, Equilibrium, Target};
pub use error::{MOST_REPLICATED, StaticsError};
pub use modes::{Mode, ModeGroup, ModeOptions, NaturalModes};
pub use options::StaticOptions;
pub use scheme::StaticScheme;
pub use tangent::Tangent;
pub use unknowns::Unknowns;
