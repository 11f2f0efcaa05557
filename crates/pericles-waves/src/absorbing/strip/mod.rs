//! Absorbing boundaries of strips: plates that are periodic along y and semi-infinite along x.
//!
//! Along y the exterior is a Fourier series, û_q(x) with θ = 2πq/rows, and each of its modes is a chain along x
//! whose sites have two components,
//!
//! ```text
//! v_s'' = Σ_d C_d(θ) v_{s+d},     v = (û_x, i û_y),     C_d = Σ_l A_{d,l} (cos lθ on the diagonal, ±sin lθ beside it)
//! ```
//!
//! with the bond matrices A_{d,l} = k/ρ n⊗n. In v the matrices C_d are real, so real and imaginary parts obey the
//! same equation. For θ = 0 the components decouple and each is a bar. Otherwise they are coupled, and the scalar
//! factorisation of [`factor_kernels`](super::factor_kernels) has no equally simple counterpart: kernels are
//! computed by marching the chain of each mode in time ([`StripLattice::kernels`]). They are 2K × 2K per mode,
//! exact for velocity Verlet.
//!
//! Cost: marching takes K² N² v dt (v columns per unit of time) for each mode, the histories K² N log N + K N log²
//! N.

mod end;
mod lattice;
mod march;

pub use end::StripEnd;
pub use lattice::StripLattice;
