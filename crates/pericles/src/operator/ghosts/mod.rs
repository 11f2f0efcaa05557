//! Ghost layers, which complete the families at unbroken outer surfaces.
//!
//! The family of a point near a surface is completed by ghost points, whose displacements are extrapolated
//! from those of the body. The energy
//!
//! E(u) = Σ_i V_i W_i over the points of the body, with complete families,
//!
//! depends on the displacements of the body only, and forces are its exact gradient: forces on ghosts are
//! distributed to the points from which their displacements are extrapolated. Traction-free surfaces are
//! natural boundary conditions. Momentum and angular momentum are conserved, and uniform strains are in
//! equilibrium up to the surface.
//!
//! A ghost layer belongs to the force of an inner body and stores no energy. The force equals the force of a larger body,
//! restricted to the body: F + Tᵀ F_g at (u, T u), with the extrapolation T. Lists, stencils, pair laws and materials
//! of the inner force need no rules for it.

mod bodies;
mod extrapolation;
mod force;
mod layer;
mod views;

pub use force::GhostForce;
pub use layer::GhostLayer;
