//! Linear bodies on periodic boxes by Fourier series: the exact operator of the continuum.
//!
//! On a box with periods P_a every plane wave exp(ik·x), k_a = 2π m_a/P_a, oscillates independently: ρ ω² = M(k)
//! with the **symbol** M(k) = ∫ c α(|ξ|) ξ⊗ξ/|ξ|³ (1 − cos k·ξ) dξ = M_p k̂⊗k̂ + M_s (1 − k̂⊗k̂), an integral over
//! the horizon instead of a sum over points ([`Symbol`]). Fields that are smooth on the scale of the spacing are
//! therefore exact to round-off: the error decreases faster than any power of the spacing, whereas the error of the grid
//! is of second order.
//!
//! [`SpectralForce`] is a [`Force`](pericles::operator::Force) for every scheme; functions of it cost two
//! transforms ([`Diagonal`](crate::function::Diagonal)), so one step of
//! [`Trigonometric`](pericles_waves::Trigonometric) can cover any time. [`SpectralCubicForce`] adds the quadratic
//! and cubic terms of the Green-strain law on a ring. Cost of a product: 2 D real transforms of the box. Memory:
//! two numbers per wavenumber and D + 1 complex fields.
//!
//! The body is periodic: a wave that leaves the box on one side enters on the other. A solution on the infinite
//! line is therefore reproduced until the first image arrives
//! ([`image_error`](crate::exact::LineSolution::image_error) estimates the error).
//!
//! Source: Coclite et al., Appl. Numer. Math. 155 (2020) 119–139, section 5, for one dimension and the Gaussian;
//! their basis functions exp(ikx) are exp(2πi m x/P) here, which agree for P = 2π only.

mod box_transform;
mod cosine_integral;
mod cubic;
mod force;
mod symbol;

pub use cubic::SpectralCubicForce;
pub use force::SpectralForce;
pub use symbol::Symbol;
