//! The scheme of `[time]` and its parameters.

use pericles::time::{
    Damping, Follow, ImplicitRule, Interpolant, LinearSolver, NewmarkOptions, Predictor,
    RelaxationOptions,
};
use pericles_waves::TrigonometricOptions;
use serde::{Deserialize, Serialize};

use crate::newmark;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::relaxation;
use crate::set::SetNames;
use crate::statics::{self, RigidModes, Statics};
use crate::vocabulary::FINE_REGIONS;

/// Time integration schemes.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Scheme {
    /// Velocity Verlet.
    #[default]
    VelocityVerlet,
    /// Third-order Runge–Kutta with the parameter α.
    RungeKutta3 {
        /// α.
        alpha: f64,
    },
    /// Classical Runge–Kutta method of order four.
    RungeKutta4,
    /// Dormand–Prince pair with adaptive sub-steps in each step.
    DormandPrince {
        /// Relative error of a sub-step.
        tolerance: f64,
    },
    /// Multirate third-order Runge–Kutta.
    MultiTimeStep3 {
        /// α.
        alpha: f64,
        /// Fine time step.
        fine: FineStep,
        /// Coupling of fine and coarse points.
        interface: Interface,
    },
    /// Multirate classical Runge–Kutta method.
    MultiTimeStep4 {
        /// Fine time step.
        fine: FineStep,
        /// Coupling of fine and coarse points.
        interface: Interface,
    },
    /// Implicit midpoint or trapezoidal rule.
    Implicit {
        /// The rule.
        #[serde(with = "crate::form")]
        rule: ImplicitRule,
        /// Solver for linear bodies.
        #[serde(default, with = "crate::form")]
        solver: LinearSolver,
    },
    /// Trigonometric integrator: exact flow of the linear part.
    Trigonometric(#[serde(with = "crate::form")] TrigonometricOptions),
    /// Newmark's method.
    Newmark(#[serde(with = "crate::form")] NewmarkOptions),
    /// Discrete-gradient method, which conserves energy.
    DiscreteGradient {
        /// Relative energy error of a step.
        tolerance: f64,
    },
    /// Static states by adaptive dynamic relaxation or FIRE.
    Relaxation(#[serde(with = "crate::form")] RelaxationOptions),
    /// Static states by Newton's method.
    Static(Statics),
    /// Heat conduction in a body that does not move.
    Thermal,
    /// Multirate r-RESPA.
    Respa {
        /// Fine time step.
        fine: FineStep,
    },
}

impl Scheme {
    /// Returns whether the scheme computes static states.
    pub fn is_static(&self) -> bool {
        matches!(self, Self::Relaxation(_) | Self::Static(_))
    }

    /// Returns whether it removes rigid-body modes that no support prevents.
    pub fn removes_rigid_modes(&self) -> bool {
        matches!(self, Self::Static(options) if options.rigid_modes == RigidModes::Fix)
    }
}

/// The fine time step of a multirate scheme.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FineStep {
    /// Number of fine steps per coarse step.
    pub ratio: u32,
    /// Points with the fine step.
    pub region: FineRegion,
}

/// Points with the fine step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FineRegion {
    /// Points of these sets.
    Sets(Vec<String>),
    /// Points near bonds that break or are about to break.
    Adaptive(#[serde(with = "crate::form")] Follow),
}

/// Coupling of coarse and fine points within steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interface {
    /// Prediction of fine points at coarse stages.
    #[serde(default, with = "crate::form")]
    pub predictor: Predictor,
    /// Interpolation of coarse points at fine stages.
    #[serde(default, with = "crate::form")]
    pub interpolant: Interpolant,
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Verlet,
    Rk3,
    Rk4,
    DormandPrince,
    Rk3Mts,
    Rk4Mts,
    Respa,
    Implicit(ImplicitRule),
    Trigonometric,
    Newmark,
    DiscreteGradient,
    Relaxation,
    Fire,
    Static,
    Thermal,
}

/// Reads the name of the scheme.
fn kind(table: &Table<'_>) -> Option<Kind> {
    let kind = table.choice_or_first(
        "scheme",
        "scheme",
        &[
            ("velocity-verlet", Kind::Verlet),
            ("rk3", Kind::Rk3),
            ("rk4", Kind::Rk4),
            ("dormand-prince", Kind::DormandPrince),
            ("multirate-rk3", Kind::Rk3Mts),
            ("multirate-rk4", Kind::Rk4Mts),
            ("respa", Kind::Respa),
            (
                ImplicitRule::Midpoint.name(),
                Kind::Implicit(ImplicitRule::Midpoint),
            ),
            (
                ImplicitRule::Trapezoidal.name(),
                Kind::Implicit(ImplicitRule::Trapezoidal),
            ),
            ("trigonometric", Kind::Trigonometric),
            ("newmark", Kind::Newmark),
            ("discrete-gradient", Kind::DiscreteGradient),
            ("adaptive-dynamic-relaxation", Kind::Relaxation),
            ("fire", Kind::Fire),
            ("static", Kind::Static),
            ("thermal", Kind::Thermal),
        ],
    );
    if kind.is_none() {
        // The scheme is unknown, so that none of these keys is reported.
        for key in [
            "alpha",
            "tolerance",
            "ratio",
            "fine",
            "adaptive",
            "predictor",
            "interpolant",
            "functions",
            "loads",
            "regularisation",
            "linear_solver",
        ]
        .into_iter()
        .chain(newmark::KEYS)
        .chain(relaxation::KEYS)
        .chain([relaxation::LOAD_STEPS])
        .chain(statics::KEYS)
        {
            table.optional(key);
        }
    }
    kind
}

pub(crate) fn read(table: &Table<'_>, names: &SetNames) -> Option<Scheme> {
    let kind = kind(table)?;
    let alpha = only(
        matches!(kind, Kind::Rk3 | Kind::Rk3Mts),
        table,
        &["alpha"],
        "it requires scheme = \"rk3\" or \"multirate-rk3\"",
        alpha,
    );
    let newmark_keys: Vec<&'static str> = newmark::KEYS
        .into_iter()
        .filter(|key| !(matches!(kind, Kind::Relaxation | Kind::Fire) && *key == "iterations"))
        .collect();
    let newmark = only(
        kind == Kind::Newmark,
        table,
        &newmark_keys,
        "it requires scheme = \"newmark\"",
        newmark::read,
    );
    let damping = only(
        kind == Kind::Relaxation,
        table,
        &relaxation::KEYS,
        "it requires scheme = \"adaptive-dynamic-relaxation\"",
        relaxation::damping,
    );
    let relaxation = match kind {
        Kind::Relaxation => relaxation::read(table, damping.flatten()).map(Some),
        Kind::Fire => relaxation::read(table, Some(Damping::Fire)).map(Some),
        _ => Some(None),
    };
    let statics = only(
        kind == Kind::Static,
        table,
        &statics::KEYS,
        "it requires scheme = \"static\"",
        statics::read,
    );
    if !matches!(kind, Kind::Relaxation | Kind::Fire | Kind::Static) {
        table.forbid(
            relaxation::LOAD_STEPS,
            "it requires a static scheme: \"adaptive-dynamic-relaxation\", \"fire\" or \"static\"",
        );
    }
    let tolerance = match kind {
        Kind::DormandPrince => tolerance(table).map(Some),
        Kind::DiscreteGradient => energy_tolerance(table).map(Some),
        // These read tolerances of their own.
        Kind::Newmark | Kind::Relaxation | Kind::Fire | Kind::Static => Some(None),
        _ => {
            table.forbid(
                "tolerance",
                "it requires scheme = \"dormand-prince\", \"newmark\", \"discrete-gradient\", \"adaptive-dynamic-relaxation\", \"fire\" or \"static\"",
            );
            Some(None)
        }
    };
    let fine = only(
        matches!(kind, Kind::Rk3Mts | Kind::Rk4Mts | Kind::Respa),
        table,
        &["ratio", "fine", "adaptive"],
        "it requires a multirate scheme: \"multirate-rk3\", \"multirate-rk4\" or \"respa\"",
        |table| fine_step(table, names),
    );
    let interface = only(
        matches!(kind, Kind::Rk3Mts | Kind::Rk4Mts),
        table,
        &["predictor", "interpolant"],
        "it requires scheme = \"multirate-rk3\" or \"multirate-rk4\"",
        interface,
    );
    let exact = only(
        kind == Kind::Trigonometric,
        table,
        &["functions", "loads", "regularisation"],
        "it requires scheme = \"trigonometric\"",
        trigonometric,
    );
    let solver = only(
        matches!(kind, Kind::Implicit(_)),
        table,
        &["linear_solver"],
        "it requires scheme = \"implicit-midpoint\" or \"trapezoidal\"",
        linear_solver,
    );
    let (alpha, tolerance, fine, interface) = (alpha?, tolerance?, fine?, interface?);
    let (newmark, relaxation, exact, solver) = (newmark?, relaxation?, exact?, solver?);
    let statics = statics?;
    Some(match kind {
        Kind::Verlet => Scheme::VelocityVerlet,
        Kind::Rk3 => Scheme::RungeKutta3 { alpha: alpha? },
        Kind::Rk4 => Scheme::RungeKutta4,
        Kind::DormandPrince => Scheme::DormandPrince {
            tolerance: tolerance?,
        },
        Kind::Rk3Mts => Scheme::MultiTimeStep3 {
            alpha: alpha?,
            fine: fine?,
            interface: interface?,
        },
        Kind::Rk4Mts => Scheme::MultiTimeStep4 {
            fine: fine?,
            interface: interface?,
        },
        Kind::Respa => Scheme::Respa { fine: fine? },
        Kind::Implicit(rule) => Scheme::Implicit {
            rule,
            solver: solver?,
        },
        Kind::Trigonometric => Scheme::Trigonometric(exact?),
        Kind::Newmark => Scheme::Newmark(newmark?),
        Kind::DiscreteGradient => Scheme::DiscreteGradient {
            tolerance: tolerance?,
        },
        Kind::Relaxation | Kind::Fire => Scheme::Relaxation(relaxation?),
        Kind::Static => Scheme::Static(statics?),
        Kind::Thermal => Scheme::Thermal,
    })
}

/// Reads keys of some schemes only and rejects them for other schemes. The outer option is none after an error.
fn only<T>(
    belongs: bool,
    table: &Table<'_>,
    keys: &[&'static str],
    why: &'static str,
    read: impl FnOnce(&Table<'_>) -> Option<T>,
) -> Option<Option<T>> {
    if belongs {
        return read(table).map(Some);
    }
    for key in keys {
        table.forbid(key, why);
    }
    Some(None)
}

fn linear_solver(table: &Table<'_>) -> Option<LinearSolver> {
    table.worded("linear_solver", "linear solver")
}

fn alpha(table: &Table<'_>) -> Option<f64> {
    /// Heun's method.
    const HEUN: f64 = 0.75;
    table.or("alpha", HEUN, |item| {
        item.within(
            Quantity::Number,
            "any number but 0 (0.75 is Heun's method)",
            |alpha| alpha != 0.0,
        )
    })
}

fn tolerance(table: &Table<'_>) -> Option<f64> {
    const TOLERANCE: f64 = 1e-6;
    table.or("tolerance", TOLERANCE, |item| {
        item.within(
            Quantity::Number,
            "a number above 0 and below 1",
            |tolerance| tolerance > 0.0 && tolerance < 1.0,
        )
    })
}

fn trigonometric(table: &Table<'_>) -> Option<TrigonometricOptions> {
    let functions = table.worded("functions", "method for matrix functions");
    let load_rule = table.worded("loads", "load quadrature");
    let regularisation = table.or("regularisation", 0.0, |item| {
        item.within(
            Quantity::Number,
            "zero (the default) or a positive number, in 1/s²",
            |value| value >= 0.0,
        )
    });
    Some(TrigonometricOptions {
        functions: functions?,
        load_rule: load_rule?,
        regularisation: regularisation?,
    })
}

fn energy_tolerance(table: &Table<'_>) -> Option<f64> {
    const TOLERANCE: f64 = 1e-10;
    table.or("tolerance", TOLERANCE, |item| {
        item.within(
            Quantity::Number,
            "a number from 1e-14 to 0.01",
            |tolerance| (1e-14..1e-2).contains(&tolerance),
        )
    })
}

fn fine_step(table: &Table<'_>, names: &SetNames) -> Option<FineStep> {
    let ratio = table.required("ratio").and_then(|item| small_count(&item));
    let region = table
        .exactly_one(FINE_REGIONS)
        .and_then(|(key, item)| match key {
            "fine" => names.references(&item).map(FineRegion::Sets),
            _ => follow(item.table()?).map(FineRegion::Adaptive),
        });
    Some(FineStep {
        ratio: ratio?,
        region: region?,
    })
}

/// Reads a whole number from 1 to 1000.
fn small_count(item: &Item<'_>) -> Option<u32> {
    const MOST: u64 = 1000;
    let count = item.count()?;
    if count <= MOST {
        Some(count as u32)
    } else {
        item.out_of_range("a whole number from 1 to 1000");
        None
    }
}

fn follow(table: Table<'_>) -> Option<Follow> {
    let default = Follow::default();
    let every = table.or("every", default.every, |item| small_count(&item));
    let threshold = table.or("threshold", default.threshold, |item| {
        item.within(
            Quantity::Number,
            "a fraction of the critical stretch, above 0 and below 1",
            |part| part > 0.0 && part < 1.0,
        )
    });
    let layers = table.or("layers", default.layers, |item| small_count(&item));
    let keep_checks = table.or("keep_checks", default.keep_checks, |item| {
        let looks = item.within(Quantity::Number, "a whole number from 0 to 200", |looks| {
            (0.0..=200.0).contains(&looks) && looks.fract() == 0.0
        })?;
        Some(looks as u32)
    });
    table.finish();
    Some(Follow {
        every: every?,
        threshold: threshold?,
        layers: layers?,
        keep_checks: keep_checks?,
    })
}

fn interface(table: &Table<'_>) -> Option<Interface> {
    let predictor = table.worded("predictor", "predictor");
    let interpolant = table.worded("interpolant", "interpolant");
    Some(Interface {
        predictor: predictor?,
        interpolant: interpolant?,
    })
}
