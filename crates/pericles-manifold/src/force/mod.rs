//! Peridynamic forces on closed surfaces (2-manifolds): bonds over geodesic distances, forces that are powers
//! of the relative displacement.
//!
//! > (K u)_i = Σ_j κ_ij |u_j − u_i|^(p−2) (u_j − u_i) A_j / d_ij^(2+αp),
//! >
//! > e_i = 1/(2p) Σ_j κ_ij |u_j − u_i|^p A_j / d_ij^(2+αp)
//!
//! summed over the vertices within the horizon (Coclite, Coclite, Maddalena, Politi 2022, equations 2.6 and
//! 2.7, with the restoring sign). Vertex areas A take the place of volumes: forces are per area (N/m²),
//! energies e per area (J/m²). K is minus the gradient of Σ A_i e_i divided by A_i, and momentum is conserved.
//! For p = 2 the operator is linear and the same for the three components. The exponents 2, 2.5 … 5.5 are
//! evaluated by square roots and products, others by the power function.
//!
//! Cost: a bond loads 12 bytes and the row of its neighbour, about 1.1 ns for p = 2 and 1.2 ns for p = 3 with
//! AVX-512 (Xeon of family 6, model 207, one thread; reading 12 bytes per bond without computing takes 1.1 ns),
//! so the loops are memory-bound. `cargo bench -p pericles-bench --bench surface` measures it against the
//! memory bandwidth. Surface forces can be split by zones ([`LocalForce`](pericles::operator::LocalForce),
//! [`SplitForce`](pericles::operator::SplitForce)), so multirate schemes apply to them.
//!
//! Bonds are stored and prefetched 3 kB ahead, which brings the force close to the rate of plain reading. Both ends
//! compute a bond. One evaluation for both ends would halve bytes and time for p = 2 (not for p ≥ 3, where
//! transposing rows to lanes and back costs as much), but the force on a point would then depend on the rows of its
//! neighbours, and parts of a body could not be evaluated alone.
//!
//! ```
//! use std::sync::Arc;
//! use pericles::operator::Force;
//! use pericles_manifold::force::SurfaceBody;
//! use pericles_manifold::geodesic::{GeodesicMethod, geodesic_pairs};
//! use pericles_manifold::surface::{AreaRule, Surface};
//! use pericles_manifold::{PowerMaterial, SurfaceBond};
//!
//! let sphere = Surface::icosphere(3, 1.0)?;
//! let pairs = geodesic_pairs(&sphere, 0.5, GeodesicMethod::Edge)?;
//! let cloud = Arc::new(sphere.points(sphere.vertex_areas(AreaRule::Barycentric))?);
//! let material = PowerMaterial {
//!     density: 1.0, kappa: 1.0, alpha: 0.5, p: 3.0, horizon: 0.5,
//!     bond: SurfaceBond::Displacement, self_interaction: false, critical_stretch: f64::INFINITY,
//! };
//! let body = SurfaceBody { surface: &sphere, cloud: &cloud, pairs: &pairs, material: &material, stiffness: &[], no_fail: &[] };
//! let operator = body.operator()?;
//! assert_eq!(operator.directed_bonds(), 22740);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod assemble;
mod bonds;
mod breaking;
mod kernels;
mod law;
mod surface_force;

pub use assemble::SurfaceBody;
pub use bonds::SurfaceBonds;
pub use law::{AnyExponent, ChordBond, DisplacementBond, Exponent, HalfInteger, SurfaceLaw};
pub use surface_force::SurfaceForce;
