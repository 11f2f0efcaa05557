//! Linear peridynamic solids whose shear is viscous or plastic, on a bond list.
//!
//! Each directed bond keeps an inelastic stretch x = e_x/r of the force state of its first point: t = (w/m)(A θ r + B (e − e_x)). Both states of a bond act along it, so that the loops over bonds read the inelastic stretch of
//! the entry itself and of the entry that leads back. Within a step the inelastic stretches follow from those at the end of the last step and from the displacement; they are kept when the step has been accepted.
//!
//! With x fixed, the force is the gradient of Σ W V, W = A θ²/(2 D) + (B/2m) Σ ω r² (ψ² − 2 ψ x + c), where c is Σ λ_k ψ_k² of the back-stretches ψ_k, or x² of the plastic stretch. A step therefore dissipates the mean of
//! −∂W/∂x before and after times the change of x: energy and work then balance to rounding under velocity Verlet where strains are small, and to second order in the step elsewhere.
//!
//! Points that have lost bonds keep their weighted volume m, as elastic solids do. Their inelastic stretches change by the part of ψ − x that is orthogonal to a dilatation of the bonds that are left, Σ ω r² Δx = 0: for points with
//! all bonds this is the deviatoric extension over r, and dissipation is never negative for points with any.
//!
//! | part | what |
//! |---|---|
//! | `laws` | relaxation over a step, return to the yield surface |
//! | `history` | what bonds and points keep |
//! | `advance` | the loops at the end of a step |
//! | `kernels`, `tangent` | the loops over points and bonds: values, force, energy; their derivatives |
//! | `force`, `passes` | the operator |
//! | `body` | what the operator is made of |

mod advance;
mod body;
mod force;
mod history;
mod kernels;
mod laws;
mod passes;
mod tangent;

pub use body::InelasticSolidBody;
pub use force::InelasticSolidForce;
