//! Linear operators by convolution.

mod banded;
mod box_convolution;
mod convolution_force;
mod cost;
mod fourier;
mod pool;
mod tensor_kernel;
mod tensor_spectra;
mod toeplitz;
mod wanted;

pub use convolution_force::ConvolutionForce;
pub use cost::Route;
pub use toeplitz::{Ends, Toeplitz};
