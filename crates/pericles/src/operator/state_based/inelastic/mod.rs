//! Linear peridynamic solids with viscous or plastic shear, on a neighbour list.
//!
//! Each directed bond stores an inelastic stretch x = e_x/r of the force state of its first point:
//! t = (w/m)(A θ r + B (e − e_x)). The force states of both ends act along the bond, so that the loops read
//! the inelastic stretches of the entry and of its reverse entry. Within a step, inelastic stretches follow
//! from those at the end of the last step and from the displacement; they are stored when the step is
//! accepted.
//!
//! For fixed x the force is the gradient of Σ W V with W = A θ²/(2 D) + (B/2m) Σ ω r² (ψ² − 2 ψ x + c), where
//! c is Σ λ_k ψ_k² of the back-stretches ψ_k, or x² of the plastic stretch. A step therefore dissipates the
//! mean of −∂W/∂x before and after it times the change of x. The energy balance of velocity Verlet is then
//! exact to round-off for small strains, and of second order in the step otherwise.
//!
//! Points with broken bonds keep their weighted volume m, as in elastic solids. Their inelastic stretches
//! change by the part of ψ − x that is orthogonal to a dilatation of the intact bonds, Σ ω r² Δx = 0. For
//! points with all bonds this is the deviatoric extension divided by r, and the dissipation is never negative
//! for points with any bonds.
//!
//! | module | contents |
//! |---|---|
//! | `laws` | relaxation over a step, return to the yield surface |
//! | `history` | history variables of bonds and points |
//! | `advance` | loops at the end of a step |
//! | `kernels`, `tangent` | loops over points and bonds: values, force, energy; derivatives |
//! | `force`, `passes`, `criterion` | operator; bond failure by stress |
//! | `body` | input of the operator |
//!
//! Bond failure is evaluated before plastic flow, so that the force at the end of a step belongs to the stored state.

mod advance;
mod body;
mod criterion;
mod force;
mod history;
mod kernels;
mod laws;
mod passes;
mod tangent;

pub use body::InelasticSolidBody;
pub use force::InelasticSolidForce;
