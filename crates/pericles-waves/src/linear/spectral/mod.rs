//! Linear bodies on periodic boxes by Fourier series: the continuum's own operator.
//!
//! On a box with periods P_a every plane wave exp(ik·x), k_a = 2π m_a/P_a, swings on its own: ρ ω² = M(k) with the **symbol**
//! M(k) = ∫ c α(|ξ|) ξ⊗ξ/|ξ|³ (1 − cos k·ξ) dξ = M_p k̂⊗k̂ + M_s (1 − k̂⊗k̂), an integral over the horizon and no sum over points ([`Symbol`]). Fields that are smooth on the
//! scale of the spacing are therefore exact to round-off: the error falls faster than any power of the spacing, where the grid's falls with its square.
//!
//! [`SpectralForce`] is a [`Force`](pericles::operator::Force) for every scheme; functions of it cost two transforms
//! ([`Diagonal`](crate::function::Diagonal)), so that one step of [`Trigonometric`](pericles_waves::Trigonometric) reaches any time.
//! [`SpectralCubicForce`] adds the quadratic and cubic terms of the Green-strain law on a ring.
//! Cost of a product: 2 D real transforms of the box. Memory: two numbers for each wave number and D + 1 complex fields.
//!
//! What happens at the borders of the box is that the body repeats: a wave that leaves at one side comes in at the other. A solution on the line is therefore
//! met until the first image arrives ([`image_error`](crate::exact::LineSolution::image_error) estimates it).
//!
//! Source: Coclite et al., Appl. Numer. Math. 155 (2020) 119–139, section 5, for one dimension and the Gaussian; basis functions of their exp(ikx) are
//! exp(2πi m x/P) here, which theirs are for P = 2π only.

mod box_transform;
mod cosine_integral;
mod cubic;
mod force;
mod symbol;

pub use cubic::SpectralCubicForce;
pub use force::SpectralForce;
pub use symbol::Symbol;
