//! Linear operators by convolution: lines, and lattice bodies of any shape.
//!
//! If all bonds of an offset are equal, the linear force is a convolution and costs O(N log N) for any horizon.
//!
//! | | formula | routes |
//! |---|---|---|
//! | [`Toeplitz`] | y_i = Σ_r w_r (u_{i+r} + u_{i−r} − 2 u_i), also with different coefficients above and below | banded loop, overlap-save, one transform |
//! | [`ConvolutionForce`] | f_a = Σ_b [ K_ab * (χ u_b) − (K_ab * χ) u_b ], K = c α κ V ξ⊗ξ/‖ξ‖³ | transforms over the padded box; whole bars use `Toeplitz` |
//! | [`GaussForce`] | the force of a bar with two Gauss nodes per cell | four `Toeplitz` lines |
//! | [`SpectralForce`] | f = Σ_k −M(k) û exp(ik·x) on periodic boxes, M the [`Symbol`] of the continuum | transforms |
//!
//! χ is one on the points of the body and zero elsewhere, so holes and boundaries are exact: bonds to missing
//! points are missing. Individual bonds cannot be missing: pre-cracks and breaking need the bond list. Arrays are
//! component-major (see [`pericles::space::PointCloud`]), displacements in m, force densities in N/m³; a `Toeplitz`
//! line has any units.
//!
//! **Selection.** [`Toeplitz`] takes the route of least estimated cost: the loop up to R ≈ 20, overlap-save above,
//! one transform if R is close to N. [`CostComparison`] selects between convolution and the bond list in the same
//! way. Nothing is timed at run time, because the route determines the round-off.
//!
//! **Cost**, CPU ms of one product of N = 10⁶ points on one core (AMD EPYC, AVX-512):
//!
//! | R | 10 | 20 | 25 | 30 | 50 | 100 | 200 | 500 | 1000 |
//! |---|---|---|---|---|---|---|---|---|---|
//! | banded loop | **2.1** | **3.2** | 3.8 | 4.4 | 6.6 | 12.4 | 23.8 | | |
//! | overlap-save | 3.8 | 3.9 | **3.7** | **3.9** | **4.6** | **4.7** | **5.0** | **5.7** | **6.2** |
//! | one transform | 13 | 12 | 14 | 13 | 12 | 12 | 12 | 12 | 12 |
//!
//! (bold: selected). Lattice bodies take about 15 ns per point in 2D and 50 to 100 ns in 3D, as much as the bond
//! list with 3 to 20 neighbours.
//!
//! **Accuracy.** All routes agree with the sums to some 1e-15 of Σ|K| max|u|. Displacements are taken relative to
//! those of one point, so rigid translations give exactly zero. Results have the same bits for any number of
//! threads and any [`PointSubset`](pericles::parallel::PointSubset); transforms use the best instructions of the machine, so the last
//! bits may differ between machines. A mirror-symmetric body stays symmetric to round-off only.
//!
//! **Memory and threads.** Work arrays come from a pool ([`Toeplitz`] and [`ConvolutionForce`] work by `&self`,
//! from any number of threads at once); an application allocates nothing once the pool contains as many as are used
//! simultaneously.
//!
//! References: Zhang & Wang, Comput. Methods Appl. Mech. Engrg. 311 (2016) 280–303, for linear bond-based bodies by
//! Toeplitz structure; for overlap-save any book on digital signal processing, such as Oppenheim & Schafer's.
//!
//! ```
//! use pericles::operator::LinearOperator;
//! use pericles_waves::linear::{Ends, Toeplitz};
//! // The second difference with free ends: a linear field has no force inside.
//! let line = Toeplitz::stencil(5, &[1.0], Ends::Free).unwrap();
//! let mut force = [0.0; 5];
//! line.apply_into(&[0.0, 1.0, 2.0, 3.0, 4.0], &mut force);
//! assert_eq!(force, [1.0, 0.0, 0.0, 0.0, -1.0]);
//! ```

mod banded;
mod box_convolution;
mod comparison;
mod convolution_force;
mod cost;
mod energy;
mod fourier;
mod gauss_force;
mod lattice_bonds;
mod spectral;
mod tensor_kernel;
mod tensor_spectra;
mod toeplitz;
mod wanted;

pub use comparison::CostComparison;
pub use convolution_force::ConvolutionForce;
pub use cost::Route;
pub(crate) use cost::smooth_length;
pub(crate) use fourier::LineTransform;
pub use gauss_force::GaussForce;
pub use spectral::{SpectralCubicForce, SpectralForce, Symbol};
pub use toeplitz::{Ends, Toeplitz};

use pericles::material::{BondConstants, BondMaterial};
use pericles::operator::{Feature, Features};
use pericles::{PericlesError, Result};

use crate::form::ForceForm;

/// Returns the features of a material's bonds in a given dimension.
fn features_of(material: &BondMaterial, constants: &BondConstants, dimension: usize) -> Features {
    let law = Feature::of_law(material.law, dimension);
    let breaks = constants.critical_stretch.is_finite();
    law.map_or_else(Features::default, Features::from)
        .with(Feature::Breaking, breaks)
}

/// Returns an error for features that a form does not represent.
fn require(form: ForceForm, features: Features) -> Result<()> {
    form.rejection(features).map_or(Ok(()), reject)
}

/// Operator that cannot be applied as a convolution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("convolution: {reason}")]
pub struct NoConvolution {
    /// The reason and the allowed alternatives.
    pub reason: String,
}

impl From<NoConvolution> for PericlesError {
    fn from(error: NoConvolution) -> Self {
        Self::Extension(Box::new(error))
    }
}

/// Returns the error with a reason.
fn reject<T>(reason: impl Into<String>) -> Result<T> {
    let reason = reason.into();
    Err(NoConvolution { reason }.into())
}
