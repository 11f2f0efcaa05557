//! The scheme of `[time]` and its parameters.

use pericles::time::{
    Damping, Follow, Interpolant, LinearSolver, NewmarkOptions, Predictor, RelaxationOptions,
};
use pericles_deck_derive::{DeckKeys, DeckTable};
use pericles_waves::{FunctionMethod, LoadRule, TrigonometricOptions};
use serde::{Deserialize, Serialize};

use crate::form::described;
use crate::range::{NONZERO, Range, between};
use crate::reader::Item;
use crate::set::SetNames;
use crate::statics::{RESIDUALS, RigidModes, Statics};

/// Time integration scheme. Explicit: `velocity-verlet`, `rk3`, `rk4`, `dormand-prince` (adaptive sub-steps).
/// Exponential: `trigonometric` (exact for linear forces). Multirate, with two time steps: `multirate-rk3`,
/// `multirate-rk4`, `respa`. Implicit: `implicit-midpoint`, `trapezoidal`, `newmark`, `discrete-gradient` (conserves
/// energy). Static states: `static` (Newton's method), `adaptive-dynamic-relaxation`, `fire` (fast inertial relaxation
/// engine). `thermal`: heat conduction in a body that does not move (requires `dt` and `conductivity` in `[thermal]`).
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[deck(tag = "scheme", what = "scheme", scope = &'s SetNames)]
pub enum Scheme {
    /// Velocity Verlet.
    #[default]
    VelocityVerlet,
    /// Third-order Runge–Kutta with the parameter α.
    #[deck(word = "rk3")]
    RungeKutta3 {
        /// rk3, multirate-rk3: parameter α of the family; 0.75 is Heun's method.
        #[deck(range = ALPHAS, default = HEUN)]
        alpha: f64,
    },
    /// Classical Runge–Kutta method of order four.
    #[deck(word = "rk4")]
    RungeKutta4,
    /// Dormand–Prince pair with adaptive sub-steps in each step.
    DormandPrince {
        /// dormand-prince: relative error of a sub-step.
        #[deck(range = between(0.0, 1.0), default = 1e-6)]
        tolerance: f64,
    },
    /// Multirate third-order Runge–Kutta.
    #[deck(word = "multirate-rk3")]
    MultiTimeStep3 {
        /// rk3, multirate-rk3: parameter α of the family; 0.75 is Heun's method.
        #[deck(range = ALPHAS, default = HEUN)]
        alpha: f64,
        /// Fine time step.
        #[deck(flatten)]
        fine: FineStep,
        /// Coupling of fine and coarse points.
        #[deck(flatten)]
        interface: Interface,
    },
    /// Multirate classical Runge–Kutta method.
    #[deck(word = "multirate-rk4")]
    MultiTimeStep4 {
        /// Fine time step.
        #[deck(flatten)]
        fine: FineStep,
        /// Coupling of fine and coarse points.
        #[deck(flatten)]
        interface: Interface,
    },
    /// Multirate r-RESPA.
    Respa {
        /// Fine time step.
        #[deck(flatten)]
        fine: FineStep,
    },
    /// Implicit midpoint rule.
    ImplicitMidpoint {
        /// implicit-midpoint, trapezoidal: solver for linear bodies. `fastest`: chosen by size; `direct`: Cholesky
        /// factorisation; `conjugate-gradients`.
        #[serde(default, with = "crate::form")]
        #[deck(key = "linear_solver", default)]
        solver: LinearSolver,
    },
    /// Trapezoidal rule.
    Trapezoidal {
        /// implicit-midpoint, trapezoidal: solver for linear bodies. `fastest`: chosen by size; `direct`: Cholesky
        /// factorisation; `conjugate-gradients`.
        #[serde(default, with = "crate::form")]
        #[deck(key = "linear_solver", default)]
        solver: LinearSolver,
    },
    /// Trigonometric integrator: exact flow of the linear part.
    Trigonometric(
        #[serde(with = "crate::form")]
        #[deck(flatten)]
        TrigonometricOptions,
    ),
    /// Newmark's method.
    Newmark(
        #[serde(with = "crate::form")]
        #[deck(flatten)]
        NewmarkOptions,
    ),
    /// Discrete-gradient method, which conserves energy.
    DiscreteGradient {
        /// discrete-gradient: relative energy error of a step.
        #[deck(range = from_to(1e-14, 0.01), default = 1e-10)]
        tolerance: f64,
    },
    /// Static states by adaptive dynamic relaxation.
    AdaptiveDynamicRelaxation {
        /// adaptive-dynamic-relaxation: "adaptive", or a fixed damping coefficient per iteration.
        #[deck(range = DAMPINGS, none = "adaptive", default)]
        damping: Option<f64>,
        /// Accuracy.
        #[deck(flatten)]
        limits: RelaxationLimits,
    },
    /// Static states by FIRE.
    Fire(#[deck(flatten)] RelaxationLimits),
    /// Static states by Newton's method.
    Static(#[deck(flatten)] Statics),
    /// Heat conduction in a body that does not move.
    Thermal,
}

/// The parameter α of Heun's method.
const HEUN: f64 = 0.75;

const ALPHAS: Range = NONZERO.described("any number but 0 (0.75 is Heun's method)");

const DAMPINGS: Range =
    between(0.0, 2.0).described("\"adaptive\", or a number above 0 and below 2, per iteration");

impl Scheme {
    /// Returns whether the scheme computes static states.
    pub fn is_static(&self) -> bool {
        matches!(
            self,
            Self::AdaptiveDynamicRelaxation { .. } | Self::Fire(_) | Self::Static(_)
        )
    }

    /// Returns whether it removes rigid-body modes that no support prevents.
    pub fn removes_rigid_modes(&self) -> bool {
        matches!(self, Self::Static(options) if options.rigid_modes == RigidModes::Fix)
    }
}

/// Accuracy of static states by a fictitious motion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(default)]
pub struct RelaxationLimits {
    /// adaptive-dynamic-relaxation, fire, static: residual relative to loads and reactions.
    #[deck(range = RESIDUALS, default = RelaxationOptions::default().tolerance)]
    pub tolerance: f64,
    /// newmark, adaptive-dynamic-relaxation, fire: largest number of iterations per step.
    #[deck(range = count_to(100_000_000), default = RelaxationOptions::default().iterations)]
    pub iterations: u32,
}

impl RelaxationLimits {
    /// Returns the options of the engine.
    pub fn with(self, damping: Damping) -> RelaxationOptions {
        RelaxationOptions {
            damping,
            tolerance: self.tolerance,
            iterations: self.iterations,
        }
    }
}

/// The fine time step of a multirate scheme.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = &'s SetNames)]
pub struct FineStep {
    /// multirate-rk3, multirate-rk4, respa: number of fine steps per coarse step.
    #[deck(range = count_to(1000))]
    pub ratio: u32,
    /// Points with the fine step.
    #[deck(flatten)]
    pub region: FineRegion,
}

/// Points with the fine step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "snake_case")]
#[deck(exclusive, scope = &'s SetNames)]
pub enum FineRegion {
    /// multirate-rk3, multirate-rk4, respa: sets of points with the fine step; they must not overlap.
    #[deck(key = "fine")]
    Sets(#[deck(with = set_names)] Vec<String>),
    /// multirate-rk3, multirate-rk4, respa: fine time step only near bonds that are about to break.
    Adaptive(#[serde(with = "crate::form")] Follow),
}

/// Points near bonds that break or are about to break.
#[derive(Serialize, Deserialize, DeckTable)]
#[serde(remote = "Follow", deny_unknown_fields)]
#[deck(remote = Follow)]
struct FollowForm {
    /// Number of coarse steps between two updates of the fine region.
    #[deck(range = count_to(1000), default = Follow::default().every)]
    every: u32,
    /// Bonds with a stretch above this fraction of their critical stretch mark their end points as fine.
    #[deck(range = FRACTIONS, default = Follow::default().threshold)]
    threshold: f64,
    /// Width of the fine region around marked points, in horizons.
    #[deck(range = count_to(1000), default = Follow::default().layers)]
    layers: u32,
    /// Number of updates for which a point stays marked after its bonds fall below `threshold`.
    #[deck(range = whole_to(200), default = Follow::default().keep_checks)]
    keep_checks: u32,
}

const FRACTIONS: Range =
    between(0.0, 1.0).described("a fraction of the critical stretch, above 0 and below 1");

/// Coupling of coarse and fine points within steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
pub struct Interface {
    /// multirate-rk3, multirate-rk4: displacement of fine points at the stages of the coarse step. `structured`: Taylor
    /// polynomial from the known acceleration; `backward-difference`: derivatives by backward differences, weakly
    /// unstable.
    #[serde(default, with = "crate::form")]
    #[deck(default)]
    pub predictor: Predictor,
    /// multirate-rk3, multirate-rk4: displacement of coarse points at the stages of fine steps. `hermite`: cubic Hermite
    /// interpolation; `stages`: weighted stages of the coarse step.
    #[serde(default, with = "crate::form")]
    #[deck(default)]
    pub interpolant: Interpolant,
}

/// Options of the trigonometric integrator.
#[derive(Serialize, Deserialize, DeckTable)]
#[serde(remote = "TrigonometricOptions", deny_unknown_fields)]
#[deck(remote = TrigonometricOptions)]
struct TrigonometricOptionsForm {
    /// trigonometric: evaluation of functions of the stiffness matrix. `fastest`: Fourier transform where it diagonalises
    /// the matrix and no point is constrained, otherwise Chebyshev; `chebyshev`: Chebyshev series; `fourier`: Fourier
    /// transform; `lanczos`: Krylov subspaces; `eigenvectors`: full decomposition, for small bodies.
    #[serde(with = "crate::form")]
    #[deck(default)]
    functions: FunctionMethod,
    /// trigonometric: quadrature of loads over a step: `gauss` (order 4) or `midpoint` (order 2).
    #[serde(rename = "loads", with = "crate::form")]
    #[deck(key = "loads", default)]
    load_rule: LoadRule,
    /// trigonometric: number added to squared frequencies (1/s²). Not needed in practice.
    #[deck(
        range = NOT_NEGATIVE.described("zero (the default) or a positive number, in 1/s²"),
        default = 0.0
    )]
    regularisation: f64,
}

described!(
    Follow: FollowForm,
    TrigonometricOptions: TrigonometricOptionsForm,
);

fn set_names(item: &Item<'_>, sets: &SetNames) -> Option<Vec<String>> {
    sets.references(item)
}
