//! Open boundaries of plates: a discrete perfectly matched layer for lattices with many neighbours.
//!
//! The body is the interior of an infinite plate. A layer of N cells along each open side absorbs the waves that leave;
//! beyond it u = 0.
//!
//! **Stretching.** The lattice u_n'' = Σ_ξ W_ξ (u_{n+ξ} − u_n) is solved for displacements that depend on a complex
//! coordinate. Node n of the layer (n = 0 at the interface, N at the end) sees its neighbour at n + j through the
//! *continued shift* U_n^j, "the field j unstretched steps from the stretched node n", with U_n^0 = u_n. Neighbouring nodes
//! differ by
//!
//! ```text
//! ψ_{n+1/2}^{j+1/2} = U_{n+1}^j − U_n^{j+1},     j = −K … K − 1
//! dψ/dt = σ/2 (U_{n+1}^{j+1} + U_n^{j+1} − U_{n+1}^j − U_n^j) − α ψ
//! ```
//!
//! with the rate σ of the cell. ψ is the only memory. The trapezoidal rule advances it at every step; along the lines n + j =
//! const its equations are explicit, so that no σ limits the step. The relation holds for every cell and shift alike:
//! the layer is matched to the lattice itself, and a discrete perfectly matched layer reflects at its end only (Chern,
//! arXiv:1804.01390, for the scalar wave equation with nearest neighbours; the form for vectors and many neighbours is
//! original to this code). In corners the y extension acts on every field that the x extension makes.
//!
//! **Filter.** Short waves of peridynamic lattices have group velocities opposite to their phase velocities and would grow in the
//! layer. After each kick v ← v − Dᵀ β D v along both axes, with D = (1, −4, 6, −4, 1)/16 and β = 1 − exp(−τ g): a
//! contraction with the symbol β sin⁸(k/2), which long waves do not notice. Long steps have several passes, τ ≤ 0.35 Δx/c_P
//! apart: with a single pass per step the filter is too weak and layers are unstable above about 0.8 Δx/c_P for K = 3.
//!
//! **Parameters.** σ = σ₀ x² at the middle of cells and g = g₀ x² at nodes with the relative depth x; in units of
//! c_P/Δx σ₀ = 3, g₀ = 8 and α = 0.01, which removes a slow static drift ([`OpenOptions`]).
//!
//! **Forces.** The forces of the layer and of the K − 1 nodes before it are those of the lattice linearised about the
//! undeformed state, whatever the kernel of the body is: the boundary replaces their accelerations. Its weights W_ξ
//! are measured from the tangent of the body ([`LatticeWeights`]). The energy balance contains the work of the difference
//! between the replaced and the original force.
//!
//! **Limits.** Waves shorter than about 6 Δx are reflected. Of the two sides across an open side one must be open too, or the
//! body periodic: waves guided between two free sides grow in the layer (3e-3 per step in a plate of 34 × 34 points with
//! K = 3). Stability is tested with noise in small boxes only; the option is experimental. All processes of a divided body compute
//! the layers identically.

mod body;
mod boundary;
mod error;
mod exchange;
mod filter;
mod force;
mod layer;
mod placed;
mod plate;
mod reflection;
mod sides;
mod weights;

pub use boundary::OpenBoundary;
pub use error::OpenError;
pub use reflection::IncidentWave;
pub use sides::{OpenOptions, OpenSides};
pub use weights::LatticeWeights;
