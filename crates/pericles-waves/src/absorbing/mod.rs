//! Exact absorbing (non-reflecting) boundaries of bars: the body is semi-infinite, and only its interior is
//! computed.
//!
//! A homogeneous linear lattice u_n'' = Σ a_k (u_{n+k} − 2 u_n + u_{n−k}) beyond the end of a bar, at rest
//! initially, is driven by the body's K outermost points 1 … K only. Its first K sites, the ghosts 0, −1 … −(K −
//! 1), follow from the history of these points,
//!
//! ```text
//! u_{−n}^j = Σ_m Σ_{α ≥ 1} F_n^m[α] u_m^{j−α}          (u^0 with half its weight)
//! ```
//!
//! and with the bonds to the ghosts the body moves as in the infinite lattice.
//!
//! | kernels | lattice | equal to |
//! |---|---|---|
//! | [`factor_kernels`] | stepped by velocity Verlet | the run on a large body with the same step, to round-off |
//! | [`contour_kernels`] | stepped by velocity Verlet or the midpoint rule | the same |
//! | [`semi_discrete_kernels`] | continuous time, trapezoidal rule | the exact solution, to second order in dt |
//! | [`green_functions_closed`], [`trapezoidal_kernels`] | the same with the closed chain of the paper | historical: unstable for long runs |
//!
//! | history | cost of N steps | memory |
//! |---|---|---|
//! | [`DirectHistory`](history::DirectHistory) | K² N² | K N |
//! | [`BlockedHistory`](history::BlockedHistory) | K N log² N + K² N log N | 7 K N numbers |
//! | [`ExponentialHistory`](history::ExponentialHistory) | K p N, within a tolerance ([`ExponentialKernels`]) | K p numbers for p exponentials |
//!
//! [`AbsorbingBoundaryPlan`] creates the history, by default the cheapest by [`HistoryCost`](history::HistoryCost). Bands with
//! many branches need many exponentials: the constant micromodulus with K = 20 has twenty stationary frequencies
//! and takes 134 terms for 1e-6 over 2048 steps, 234 over 8192.
//!
//! **Kernels.** With the delay w of one step, the factor 1 − Σ h_m z^m of the lattice's symbol with zeros outside
//! the unit circle gives u_{−n} = Σ_m h_m * u_{m−n}: K kernels instead of K², computed by Cauchy's integral formula
//! ([`contour_kernels`]) or as power series ([`factor_kernels`], a third of the time and slightly less accurate); F
//! follows by F_{n+1}^m = F_n^1 * h_m + F_n^{m+1}.
//!
//! **Requirements.** The outermost K points are linear, undamaged, of one material, without loads, prescribed
//! motion or initial field ([`OuterLayer`] verifies this from the body's own bonds). The rest of the body is
//! arbitrary: heterogeneous, nonlinear, breaking, loaded. Initial fields may extend beyond the boundary if given to
//! [`FreeWave`].
//!
//! **Strips.** Plates that are periodic across have absorbing boundaries by Fourier modes, each with 2K × 2K
//! kernels computed by time marching: [`strip`].
//!
//! **Plates.** Sides and corners of plates on square lattices have matched layers, which are approximate: [`open`].
//!
//! **Schemes.** Velocity Verlet ([`AbsorbingEnd`]); the implicit midpoint and trapezoidal rules ([`MidpointEnd`])
//! with σ(w) = (4/dt²)((1 − w)/(1 + w))², whose kernels have an instantaneous part F\[0\] ≠ 0 that becomes a corner
//! of the step's matrix. The trigonometric scheme is not supported: it multiplies by cos(dt W), which is not
//! rational in the stiffness and extends as far as its series, so no number K of ghosts is sufficient.
//!
//! Reference: Ji, Pang, Zhang, Yang, Perdikaris, *Exact artificial boundary conditions of 1D semi-discretized
//! peridynamics* (equations 19–34), for the semi-discrete lattice; the discrete kernels, their factorisation and
//! the fast histories are original to this code.

mod blocks;
mod cached;
mod contour;
mod end;
mod error;
mod exterior;
mod factor;
mod fit;
mod green;
mod historical;
pub mod history;
mod kernels;
mod layer;
mod loewner;
mod midpoint_end;
pub mod open;
mod plan;
mod roots;
mod schur;
mod semi_discrete;
mod stencil;
mod step;
pub mod strip;

pub use cached::cached_kernels;
pub use contour::contour_kernels;
pub use end::AbsorbingEnd;
pub use error::AbsorbingError;
pub use exterior::FreeWave;
pub use factor::factor_kernels;
pub use fit::ExponentialKernels;
pub use green::green_functions;
pub use historical::green_functions_closed;
pub use kernels::GhostKernels;
pub use layer::{OuterLayer, Side};
pub use midpoint_end::MidpointEnd;
pub use plan::{AbsorbingBoundaryPlan, EndReport, KernelMethod};
pub use semi_discrete::{semi_discrete_kernels, trapezoidal_kernels};
pub use stencil::LatticeStencil;
pub use step::{LatticeScheme, LatticeStep};
