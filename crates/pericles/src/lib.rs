//! Peridynamics in Rust: the engine of Pericles as a library.
//!
//! Peridynamics describes a body by points that interact over a finite distance, the horizon δ. The equation
//! of motion
//!
//! ```text
//! ρ u_tt(x) = ∫ f(ξ, η) dx′ + b(x),    ξ = x′ − x,    η = u′ − u
//! ```
//!
//! with density ρ, displacement u, pair force f, bond ξ, relative displacement η and body force b also holds
//! across cracks, where displacements have no derivatives. On points with volumes V it becomes
//! ρ u_tt,i = Σ_j f_ij κ_ij V_j + b_i, where κ is the fraction of a neighbour's volume within the horizon
//! (Silling 2000; Silling & Askari 2005).
//!
//! This crate contains points, bonds, material models, fracture, loads, constraints, time integrators, the
//! time loop and observers. It reads and writes no files: `pericles-deck` reads input decks (TOML),
//! `pericles-io` writes result files, and `pericles-run` runs a deck with output and checkpoints.
//!
//! # Quick start
//!
//! Every program follows the same four steps: points, material, body, simulation.
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
//! // The left half starts at 1 m/s towards the right half.
//! let system = Body::new(bar, steel).build()?;
//! let mut run = Simulation::builder(system).velocity_of(&left, [1.0, 0.0, 0.0])?.end(1e-4).build()?;
//! run.run_to_end()?;
//!
//! // Momentum is conserved to round-off, energy to the order of the scheme.
//! let energies = run.snapshot().energies();
//! assert!(energies.balance().abs() < 1e-6 * energies.initial);
//! let momentum = run.system().momentum(&run.state().v)[0];
//! assert!((momentum / (7850.0 * 1e-4 * 0.1) - 1.0).abs() < 1e-12);
//! # Ok(())
//! # }
//! ```
//!
//! The programs in `examples/` continue from here. Each is about a page long and compares its result with
//! theory:
//!
//! | `cargo run --release -p pericles --example …` | shows |
//! |---|---|
//! | `bar` | all steps of a program; wave speed in a bar |
//! | `cracking_plate` | a pre-crack, loads and breaking bonds; crack speed and Rayleigh speed |
//! | `two_materials` | materials assigned to sets; reflection at an interface |
//! | `pair_law` | a custom pair law |
//! | `force` | a custom force in addition to the bonds |
//! | `observer` | a custom observer with checkpoints |
//! | `integrator` | a custom time integrator and its order |
//!
//! # Conventions
//!
//! * **Units** are SI: m, kg, s, N, Pa, J.
//! * **Vector fields** are component-major: component c of point i is entry `c * n + i` of a slice of
//!   `dimension * n` numbers. Tensors use the order of [`observe::Field::components`].
//! * **Points** are stored in an order that suits memory.
//!   [`PointCloud::user_number`](space::PointCloud::user_number) returns the number of a point in result
//!   files. A [`PointSet`](space::PointSet) contains point numbers in ascending order.
//! * **Coordinates** have three components ([`Point`](space::Point)); those beyond the dimension of the body
//!   are zero.
//! * **Volumes** include the thickness of plates and the cross-section of bars, so that forces are densities
//!   in N/m³ and energies are in J in every dimension.
//! * **Results do not depend on the number of threads**, bit for bit: loops run over fixed blocks of points
//!   and sums are exact ([`sum`]). The last digits depend on the [instruction set](operator::InstructionSet);
//!   which bonds break does not.
//! * **Errors**: functions that build a model return a [`PericlesError`] that names the invalid value and
//!   what is allowed. Methods called in inner loops, such as
//!   [`Force::add_force`](operator::Force::add_force), assume slices of the right length.
//!
//! # Where to look
//!
//! | task | items |
//! |---|---|
//! | place points: grids with holes, graded grids, lists | [`space`]: [`Grid`](space::Grid), [`GradedGrid`](space::GradedGrid), [`ListedPoints`](space::ListedPoints) |
//! | select sets of points | [`Region`](space::Region), [`PointCloud::select`](space::PointCloud::select) |
//! | define a material | [`material`]: [`BondMaterial`](material::BondMaterial); [`kernel`]: influence functions |
//! | use a state-based material | [`LinearSolid`](material::LinearSolid), [`operator::LinearSolidBody`]; viscous, plastic, of one's own: crate `pericles-solids` |
//! | define pre-cracks | [`family::Crack`], [`Body::crack`] |
//! | apply loads, constraints and damping | [`boundary`]: [`Load`](boundary::Load), [`PrescribedMotion`](boundary::PrescribedMotion), [`DampingLayer`](boundary::DampingLayer) |
//! | add contact and rigid bodies | [`Interaction`], [`System::add_interaction`]; `pericles-contact` |
//! | apply temperatures | [`ThermalExpansion`], [`Temperature`] |
//! | assemble the equation of motion | [`Body`], or [`operator::BondBody`] and [`System::new`] |
//! | choose a time integrator | [`time`]: explicit, implicit, static, adaptive, multirate |
//! | find the stable time step | [`time::highest_frequency`]; [`Simulation::builder`] uses it by default |
//! | run, stop and resume | [`Simulation`], [`StopWhen`], [`archive`] |
//! | read results | [`observe`]: [`Snapshot`](observe::Snapshot), [`CrackTracker`](observe::CrackTracker), [`Fragments`](observe::Fragments) |
//! | write a state-based force | [`operator::TwoPass`] |
//!
//! # Extending the engine
//!
//! **A pair law** implements [`PairForce`](material::PairForce): force, energy and tangent of one bond of
//! unit stiffness, generic over the dimension and over [`Real`](lanes::Real), so that eight bonds are
//! computed at once. Pass it to [`Body::pair_law`]. It works with neighbour lists and stencils, with fracture
//! and with several materials, like a built-in law. A law with a faster form for small strains also
//! implements [`VectorLaw`](operator::VectorLaw).
//!
//! ```
//! use pericles::prelude::*;
//!
//! /// A linear spring along the reference bond: s = ξ·η/|ξ|², force s ξ/|ξ|, energy ½ s² |ξ|.
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
//! **A force** in addition to the bonds (a foundation, another material model) implements
//! [`Force`](operator::Force): force density on a subset of the points, energy, tangent, and an upper bound
//! of its frequency. Optional features are reported by its [`Capabilities`](operator::Capabilities); a scheme
//! that needs a missing one is rejected with the reason. A force whose bonds depend on other bonds implements
//! [`TwoPass`](operator::TwoPass).
//!
//! **An observer** implements [`Observer`](observe::Observer). It receives a [`Snapshot`](observe::Snapshot)
//! at the times of its [`Schedule`](observe::Schedule). To read it after the run, pass it as `Arc<Mutex<…>>`
//! and keep a clone. For a few numbers the closure of [`Simulation::run`] is enough.
//!
//! **An integrator** implements [`Integrator`](time::Integrator). Its step gets accelerations from the
//! [`System`] ([`System::acceleration`]), applies constraints ([`System::constrain`],
//! [`System::constrain_velocity`]) and ends with [`State::complete`](time::State::complete), which breaks
//! bonds and updates the energy balance. It also reports its order and the largest stable ω dt.
//!
//! **A type with state from step to step** lists its fields in [`saved!`], which generates the code for
//! checkpoints; a missing field is a compile error. [`round_trip::check_resume`] tests that a resumed run
//! agrees bit for bit with an uninterrupted one.

mod accounts;
pub mod archive;
mod body;
pub mod boundary;
mod breaking;
pub mod cache;
mod compatibility;
pub mod division;
pub mod domain;
mod error;
pub mod family;
mod guard;
mod interaction;
mod interrupt;
pub mod kernel;
pub mod lanes;
pub mod material;
pub mod neighbourhood;
pub mod noise;
pub mod observe;
pub mod operator;
pub mod parallel;
pub mod prelude;
pub mod round_trip;
mod scalar;
mod secondary;
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
pub mod vector;

pub use accounts::Ledger;
pub use archive::{Archive, Checkpointed, Values};
pub use body::Body;
pub use compatibility::{Need, Requirement, require};
pub use error::{DeviceError, PericlesError, Result, UnreachableStrength, positive};
pub use guard::InstabilityCause;
pub use interaction::{Configuration, Interaction, InteractionStep};
pub use interrupt::{Interrupt, IterationProgress};
pub use scalar::PointScalar;
pub use secondary::{BodyStep, SecondaryField};
pub use simulation::{
    Control, Outcome, Simulation, SimulationBuilder, SimulationError, check_compatibility,
};
pub use step_end::{BreakingBond, Path, StepEnd};
pub use step_kind::{StepKind, schemes_of};
pub use stop::{Found, StopCondition, StopReason, StopTest, StopWhen};
pub use system::{ActivationRange, System, SystemParts};
pub use thermal::{
    Expandable, HeatedFactor, OfTemperature, Pointwise, Temperature, ThermalExpansion, YieldFactor,
};
