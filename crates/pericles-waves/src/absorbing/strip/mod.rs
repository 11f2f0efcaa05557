//! Absorbing ends of strips: plates that are periodic along y and go on for ever along x.
//!
//! Along y the exterior is a Fourier series, û_q(x) with θ = 2πq/rows, and each of its modes a chain along x whose sites carry two components,
//!
//! ```text
//! v_s'' = Σ_d C_d(θ) v_{s+d},     v = (û_x, i û_y),     C_d = Σ_l A_{d,l} (cos lθ on the diagonal, ±sin lθ beside it)
//! ```
//!
//! with the bonds' matrices A_{d,l} = k/ρ n⊗n. In v the matrices C_d are real, so that real and imaginary parts move alike. For θ = 0 the components part and each is a bar; else they do not, and the
//! scalar factorisation of [`factor_kernels`](super::factor_kernels) has no counterpart as simple: kernels are found by marching each mode's chain ([`StripLattice::kernels`]). They are 2K × 2K per mode, exact
//! for velocity Verlet.
//!
//! Cost: marching takes K² N² v dt (v columns per time) for each mode, the histories K² N log N + K N log² N.

mod end;
mod lattice;
mod march;

pub use end::StripEnd;
pub use lattice::StripLattice;
