//! Correspondence materials: forces from the stress of a nonlocal deformation gradient.
//!
//! A correspondence material (Silling, Epton, Weckner, Xu & Askari, J. Elasticity 88, 2007) uses the stress
//! of a classical material at large strain. The deformation gradient of a point is the best fit to its bonds,
//! F = I + (Σ w η ⊗ ξ) K⁻¹ with the shape tensor K = Σ w ξ ⊗ ξ. The force state follows from the first
//! Piola–Kirchhoff stress P(F); a penalty controls deformations that F does not represent
//! ([`Stabilisation`]). For a uniform deformation the stress is classical at every point, surfaces included.
//!
//! [`CorrespondenceMaterial`] → [`CorrespondenceConstants`] → [`CorrespondenceBody`] →
//! [`SolidForce`](crate::solid::SolidForce).

mod body;
mod classical;
mod control;
mod force_state;
mod law;
mod material;
mod plasticity;
mod stiffness;

pub use body::CorrespondenceBody;
pub use classical::{ClassicalSolid, Expanded, PointState};
pub use control::{Control, Stabilisation};
pub use law::{ElasticLaw, Moduli};
pub use material::{CorrespondenceConstants, CorrespondenceMaterial};
pub use plasticity::{History, Plasticity};
pub use stiffness::{Orthotropy, Stiffness};

pub use crate::solid::LARGEST_CONDITION;
