//! Peridynamic solids whose force states depend on all bonds of a point.
//!
//! * [`solid`] – the trait [`Solid`](solid::Solid) of a material, and the force operator of a body of such materials.
//! * [`inelastic`] – linear peridynamic solids with viscous or plastic shear.
//! * [`correspondence`] – correspondence materials: stress from a nonlocal deformation gradient, with control
//!   of zero-energy modes.
//!
//! The crate uses only public items of the engine, [`pericles`].

pub mod correspondence;
mod error;
pub mod inelastic;
pub mod solid;
mod tensor;

pub use error::SingularShape;
pub use tensor::Matrix;
