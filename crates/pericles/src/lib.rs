//! Bond-based peridynamics: the engine of Pericles as a library.
//!
//! Peridynamics describes a body by points that act on each other over a finite distance, the horizon δ. The equation of
//! motion ρ u_tt(x) = ∫ f(ξ, η) dx′ + b, with ξ = x′ − x and η = u′ − u, holds across cracks, where displacements have no
//! derivatives. On points with volumes V it becomes ρ u_tt,i = Σ_j f_ij κ_ij V_j + b_i (Silling 2000; Silling & Askari 2005).
//!
//! This crate holds the physics and the numerics: points, bonds, pair laws, breaking, loads and supports, time integrators,
//! the time loop and observers. It reads and writes no files. Decks (TOML) are read by `pericles-deck`, files are written by
//! `pericles-io`, and `pericles-run` runs a deck or a model into a folder, with checkpoints.
//!
//! # The first program
//!
//! Points, a material, a body, a run:
//!
//! ```
//! use pericles::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A steel bar of 0.2 m in 200 cells; the horizon is three cells.
//! let bar = Grid::bar(0.2, 1e-3, 1e-4).points()?;
//! let left = bar.select(&Region::layer("-x", 0.1)?);
//! let steel = BondMaterial::new(ElasticModulus::Young(210e9), 7850.0, 3e-3);
//!
//! // Its left half moves at 1 m/s towards the right half.
//! let system = Body::new(bar, steel).build()?;
//! let mut run = Simulation::builder(system).velocity_of(&left, [1.0, 0.0, 0.0])?.end(1e-4).build()?;
//! run.run_to_end()?;
//!
//! // Nothing is lost: momentum is that of the start to round-off, energy to the order of the scheme.
//! let energies = run.snapshot().energies();
//! assert!(energies.balance().abs() < 1e-6 * energies.initial);
//! let momentum = run.system().momentum(&run.state().v)[0];
//! assert!((momentum / (7850.0 * 1e-4 * 0.1) - 1.0).abs() < 1e-12);
//! # Ok(())
//! # }
//! ```
//!
//! The programs in `examples/` go on from here; each is a page and prints what it compares with theory:
//!
//! | `cargo run --release -p pericles --example …` | shows |
//! |---|---|
//! | `bar` | all steps of a program; the speed of a wave |
//! | `cracking_plate` | a pre-crack, loads, breaking bonds; crack speed and Rayleigh speed |
//! | `two_materials` | materials by sets; reflection at an interface |
//! | `pair_law` | a pair law of one's own |
//! | `force` | a force of one's own beside the bonds |
//! | `observer` | an observer of one's own, with checkpoints |
//! | `integrator` | a time integrator of one's own and its order |
//!
//! # Conventions
//!
//! * **Units** are SI throughout: m, kg, s, N, Pa, J.
//! * **Vectors on points** are component-major: component c of point i is entry `c * n + i` of a slice of `dimension * n` numbers.
//!   Tensors have the order of [`observe::Field::components`].
//! * **Points** are numbered in an order that suits memory. [`PointCloud::user_number`](space::PointCloud::user_number) is the number
//!   under which a point is written to files. A [`PointSet`](space::PointSet) holds numbers in ascending order.
//! * **Places** have three coordinates ([`Point`](space::Point)), of which those beyond the dimension are zero.
//! * **Volumes** of plates contain the thickness, those of bars the area of the section: forces are per volume (N/m³), energies in J.
//! * **Results do not depend on the number of threads**, bit for bit: points are computed in fixed blocks, sums are exact ([`sum`]).
//!   They depend on the [instruction set](operator::InstructionSet) in the last digits; which bonds break does not.
//! * **Errors**: what does not fit together is refused with a [`PericlesError`] that names it. Methods that loops call, such as
//!   [`Force::add_force`](operator::Force::add_force), take slices of the right length for granted.
//!
//! # What is where
//!
//! | task | look at |
//! |---|---|
//! | place points: grids with holes, graded grids, lists | [`space`]: [`Grid`](space::Grid), [`GradedGrid`](space::GradedGrid), [`ListedPoints`](space::ListedPoints) |
//! | choose sets of points | [`Region`](space::Region), [`PointCloud::select`](space::PointCloud::select) |
//! | describe a material | [`material`]: [`BondMaterial`](material::BondMaterial); [`kernel`]: influence functions |
//! | cut pre-cracks | [`family::Crack`], [`Body::crack`] |
//! | load and hold a body | [`boundary`]: [`Load`](boundary::Load), [`PrescribedMotion`](boundary::PrescribedMotion), [`DampingLayer`](boundary::DampingLayer) |
//! | heat a body | [`ThermalExpansion`], [`Temperature`] |
//! | build the equation of motion | [`Body`], or by hand [`operator::BondBody`] and [`System::new`] |
//! | choose a scheme | [`time`]: explicit, implicit, static, adaptive, multirate |
//! | find the stable step | [`time::highest_frequency`]; [`Simulation::builder`] does it by itself |
//! | run, stop, resume | [`Simulation`], [`StopWhen`], [`archive`] |
//! | read results | [`observe`]: [`Snapshot`](observe::Snapshot), [`CrackTracker`](observe::CrackTracker), [`Fragments`](observe::Fragments) |
//! | compute state-based forces | [`operator::TwoPass`] |
//!
//! # Parts of one's own
//!
//! **A pair law** implements [`PairForce`](material::PairForce): force, energy and tangent of one bond of unit stiffness, generic over the
//! dimension and over [`Real`](lanes::Real), so that eight bonds are computed at once. [`Body::pair_law`] takes it; it runs as a list and as a
//! stencil, breaks, and goes with several materials like a built-in law. A law with a faster form for small strains implements
//! [`FastLaw`](operator::FastLaw) as well.
//!
//! ```
//! use pericles::prelude::*;
//!
//! /// A spring along the bond of the reference state: s = ξ·η/|ξ|², force s ξ/|ξ|, energy ½ s² |ξ|.
//! #[derive(Clone, Copy, Default)]
//! struct Spring;
//!
//! impl PairForce for Spring {
//!     const LINEAR: bool = true;
//!
//!     #[inline(always)]
//!     fn force<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> [T; D] {
//!         let square = dot(xi, xi);
//!         let size = dot(xi, eta) / (square * square.sqrt());
//!         vector(|c| size * xi[c])
//!     }
//!
//!     #[inline(always)]
//!     fn energy<T: Real, const D: usize>(xi: [T; D], eta: [T; D]) -> T {
//!         T::splat(0.5) * dot(Self::force(xi, eta), eta)
//!     }
//!
//!     #[inline(always)]
//!     fn tangent<T: Real, const D: usize>(xi: [T; D], _eta: [T; D], d: [T; D]) -> [T; D] {
//!         Self::force(xi, d)
//!     }
//! }
//!
//! let block = Grid::block([0.01, 0.01, 0.01], 1e-3).points()?;
//! let steel = BondMaterial::new(ElasticModulus::Young(210e9), 7850.0, 3e-3);
//! let system = Body::new(block, steel).pair_law::<Spring>().build()?;
//! assert!(system.operator().is_linear());
//! # Ok::<(), PericlesError>(())
//! ```
//!
//! **A force** beside the bonds (contact, a foundation, another material model) implements [`Force`](operator::Force): force density on a part of
//! the points, energy, tangent, and a bound of its frequency. What it can do beside that it says by its
//! [`Capabilities`](operator::Capabilities); schemes that need more than it has refuse it with the reason. A force whose bonds depend on other
//! bonds implements [`TwoPass`](operator::TwoPass).
//!
//! **An observer** implements [`Observer`](observe::Observer): it gets a [`Snapshot`](observe::Snapshot) when its
//! [`Schedule`](observe::Schedule) says so. To read it after the run, pass it as `Arc<Mutex<…>>` and keep a clone. For a few numbers the closure
//! of [`Simulation::run`] is enough.
//!
//! **An integrator** implements [`Integrator`](time::Integrator): its step asks the [`System`] for accelerations
//! ([`System::acceleration`]), sets supports ([`System::constrain`], [`System::constrain_velocity`]) and ends with
//! [`State::complete`](time::State::complete), which decides breaking and books work. It says which order it has and up to which ω dt it is stable.
//!
//! **Everything with a state from step to step** lists its fields in [`saved!`], from which checkpoints are made; a field that is forgotten does not
//! compile. [`round_trip::check_resume`] tests that a resumed run goes on bit for bit.

mod accounts;
pub mod archive;
mod body;
pub mod boundary;
mod breaking;
pub mod cache;
mod compatibility;
pub mod domain;
mod error;
pub mod family;
mod guard;
mod interrupt;
pub mod kernel;
pub mod lanes;
pub mod material;
pub mod noise;
pub mod observe;
pub mod operator;
pub mod parallel;
pub mod prelude;
pub mod round_trip;
mod scalar;
mod simulation;
pub mod solve;
pub mod space;
mod step_end;
mod step_kind;
mod stop;
pub mod sum;
mod system;
mod thermal;
pub mod time;
pub mod units;

pub use accounts::Ledger;
pub use archive::{Archive, Saved, Values};
pub use body::Body;
pub use compatibility::{Need, Requirement, require};
pub use error::{PericlesError, Result, positive};
pub use guard::Cause;
pub use interrupt::Interrupt;
pub use scalar::PointScalar;
pub use simulation::{
    Control, Outcome, Simulation, SimulationBuilder, SimulationError, check_compatibility,
};
pub use step_end::{BreakingBond, Path, StepEnd};
pub use step_kind::{StepKind, schemes_of};
pub use stop::{Found, StopCondition, StopReason, StopWhen};
pub use system::System;
pub use thermal::{Expandable, Temperature, ThermalExpansion};
