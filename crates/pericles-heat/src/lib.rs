//! Scalar fields that diffuse in peridynamic bodies: heat conduction as the second field of a body.
//!
//! A field T with the capacity C (per volume) obeys
//!
//! ```text
//! C ∂T/∂t (x) = ∫ κ(ξ) (T(x′) − T(x)) dx′ + q(x, t)
//! ```
//!
//! over the points within the horizon (Bobaru & Duangpanya 2010, 2012; Oterkus, Madenci & Agwai 2014). For heat, T is
//! the temperature (K), C = ρ c the volumetric heat capacity (J/(m³ K)) and κ follows from the conductivity k (W/(m K)).
//! On points, Σ_j G_ij (T_j − T_i) with symmetric conductances G_ij = κ_ij V_i V_j (W/K), so that an insulated body
//! conserves its heat.
//!
//! | item | contents |
//! |---|---|
//! | [`PairConductivity`] | κ(ξ) from the conductivity: moments of the influence function, or sums over the lattice |
//! | [`Diffusion`] | conductances of all bonds: stencil kernel for lattices, neighbour list for other bodies |
//! | [`Condition`] | prescribed values, fluxes, convection, radiation, sources |
//! | [`Problem`] | capacity, conductances and conditions |
//! | [`Scheme`] | explicit, trapezoidal, backward Euler, steady state |
//! | [`DiffusingField`] | computed field of a system: temperature of thermal expansion, end of steps, checkpoints |
//! | [`FixedBody`] | time integrator of a body that does not move |
//!
//! A body may be divided among processes. Conditions, values and capacities then belong to own points, and all processes evaluate
//! the field together; results have the same bits for every number of processes.
//!
//! The crate uses only public items of [`pericles`] and the multigrid of [`pericles_statics`].
//!
//! The solver is independent of the physical quantity: it has capacities, conductances and conditions. For heat the
//! capacity is ρ c and the conductivity k; a concentration would use the same code.

mod advance;
mod calibration;
mod condition;
mod diffusion;
mod dissipation;
mod error;
mod field;
mod fixed_body;
mod problem;
mod solver;

pub use advance::{Flows, Scheme};
pub use calibration::PairConductivity;
pub use condition::{Condition, Exchange, Kind, Value};
pub use diffusion::{Diffusion, DiffusionBody, Interface};
pub use error::HeatError;
pub use field::{DiffusingField, FieldOptions, SharedField};
pub use fixed_body::FixedBody;
pub use problem::Problem;
pub use solver::Effort;
