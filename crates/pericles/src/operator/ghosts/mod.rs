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

mod bodies;
mod extrapolation;
mod force;
mod layer;
mod views;

pub use force::GhostForce;
pub use layer::GhostLayer;
