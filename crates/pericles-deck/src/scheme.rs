//! The scheme of `[time]` and its parameters.

use pericles::time::{
    Follow, ImplicitRule, Interpolant, LinearSolver, NewmarkOptions, Predictor, RelaxationOptions,
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

/// Schemes of time integration.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Scheme {
    /// Velocity Verlet.
    #[default]
    VelocityVerlet,
    /// Runge–Kutta of order three with the parameter α.
    RungeKutta3 {
        /// α.
        alpha: f64,
    },
    /// The classical Runge–Kutta method.
    RungeKutta4,
    /// The Dormand–Prince pair: sub-steps within each step, as the tolerance asks for.
    DormandPrince {
        /// Relative error of a sub-step.
        tolerance: f64,
    },
    /// Runge–Kutta of order three with two time steps.
    MultiTimeStep3 {
        /// α.
        alpha: f64,
        /// Where and how fine.
        fine: FineStep,
        /// How the two talk.
        interface: Interface,
    },
    /// The classical Runge–Kutta method with two time steps.
    MultiTimeStep4 {
        /// Where and how fine.
        fine: FineStep,
        /// How the two talk.
        interface: Interface,
    },
    /// The implicit midpoint or the trapezoidal rule.
    Implicit {
        /// Which.
        #[serde(with = "crate::form")]
        rule: ImplicitRule,
        /// Of the steps of linear bodies.
        #[serde(default, with = "crate::form")]
        solver: LinearSolver,
    },
    /// The exact flow of the linear part.
    Trigonometric(#[serde(with = "crate::form")] TrigonometricOptions),
    /// Newmark's method.
    Newmark(#[serde(with = "crate::form")] NewmarkOptions),
    /// Discrete gradients, which conserve energy.
    DiscreteGradient {
        /// Relative error of the energy in a step.
        tolerance: f64,
    },
    /// Static states by dynamic relaxation.
    Relaxation(#[serde(with = "crate::form")] RelaxationOptions),
    /// Static states by Newton's method.
    Static(Statics),
    /// r-RESPA.
    Respa {
        /// Where and how fine.
        fine: FineStep,
    },
}

impl Scheme {
    /// Whether its states are static: true time plays no part.
    pub fn is_static(&self) -> bool {
        matches!(self, Self::Relaxation(_) | Self::Static(_))
    }

    /// Whether it takes out rigid-body motions that no support prevents.
    pub fn removes_rigid_modes(&self) -> bool {
        matches!(self, Self::Static(options) if options.rigid_modes == RigidModes::Fix)
    }
}

/// The smaller of two time steps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FineStep {
    /// Fine steps in a coarse one.
    pub ratio: u32,
    /// The points that take them.
    pub region: FineRegion,
}

/// The points with the smaller step.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FineRegion {
    /// Those of these sets.
    Sets(Vec<String>),
    /// Those near to where bonds break or are about to.
    Adaptive(#[serde(with = "crate::form")] Follow),
}

/// What coarse and fine points know of each other between their steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Interface {
    /// Of fine points at coarse stages.
    #[serde(default, with = "crate::form")]
    pub predictor: Predictor,
    /// Of coarse points at fine stages.
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
    Static,
}

/// The scheme by its name.
fn kind(table: &Table<'_>) -> Option<Kind> {
    let kind = table.choice_or_first(
        "scheme",
        "scheme",
        &[
            ("velocity-verlet", Kind::Verlet),
            ("rk3", Kind::Rk3),
            ("rk4", Kind::Rk4),
            ("dormand-prince", Kind::DormandPrince),
            ("rk3-mts", Kind::Rk3Mts),
            ("rk4-mts", Kind::Rk4Mts),
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
            ("relaxation", Kind::Relaxation),
            ("static", Kind::Static),
        ],
    );
    if kind.is_none() {
        // Which of these belong to the scheme is not known: none of them is an error of its own.
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
        "α is the parameter of rk3 and rk3-mts",
        alpha,
    );
    let newmark_keys: Vec<&'static str> = newmark::KEYS
        .into_iter()
        .filter(|key| !(kind == Kind::Relaxation && *key == "iterations"))
        .collect();
    let newmark = only(
        kind == Kind::Newmark,
        table,
        &newmark_keys,
        "it belongs to scheme = \"newmark\"",
        newmark::read,
    );
    let relaxation = only(
        kind == Kind::Relaxation,
        table,
        &relaxation::KEYS,
        "it belongs to scheme = \"relaxation\"",
        relaxation::read,
    );
    let statics = only(
        kind == Kind::Static,
        table,
        &statics::KEYS,
        "it belongs to scheme = \"static\"",
        statics::read,
    );
    if !matches!(kind, Kind::Relaxation | Kind::Static) {
        table.forbid(
            relaxation::LOAD_STEPS,
            "it belongs to scheme = \"relaxation\" or scheme = \"static\"",
        );
    }
    let tolerance = match kind {
        Kind::DormandPrince => tolerance(table).map(Some),
        Kind::DiscreteGradient => energy_tolerance(table).map(Some),
        // Their own, of other quantities.
        Kind::Newmark | Kind::Relaxation | Kind::Static => Some(None),
        _ => {
            table.forbid(
                "tolerance",
                "a tolerance belongs to scheme = \"dormand-prince\", \"newmark\", \"discrete-gradient\", \"relaxation\" or \"static\"",
            );
            Some(None)
        }
    };
    let fine = only(
        matches!(kind, Kind::Rk3Mts | Kind::Rk4Mts | Kind::Respa),
        table,
        &["ratio", "fine", "adaptive"],
        "two time steps need scheme = \"rk3-mts\", \"rk4-mts\" or \"respa\"",
        |table| fine_step(table, names),
    );
    let interface = only(
        matches!(kind, Kind::Rk3Mts | Kind::Rk4Mts),
        table,
        &["predictor", "interpolant"],
        "it belongs to scheme = \"rk3-mts\" or \"rk4-mts\"",
        interface,
    );
    let exact = only(
        kind == Kind::Trigonometric,
        table,
        &["functions", "loads", "regularisation"],
        "it belongs to scheme = \"trigonometric\"",
        trigonometric,
    );
    let solver = only(
        matches!(kind, Kind::Implicit(_)),
        table,
        &["linear_solver"],
        "it belongs to scheme = \"implicit-midpoint\" or \"trapezoidal\"",
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
        Kind::Relaxation => Scheme::Relaxation(relaxation?),
        Kind::Static => Scheme::Static(statics?),
    })
}

/// Reads what belongs to some schemes only, and forbids its keys to the others. The outer option is none if something is wrong.
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
    let functions = table.worded("functions", "way of computing functions");
    let load_rule = table.worded("loads", "rule for loads");
    let regularisation = table.or("regularisation", 0.0, |item| {
        item.within(
            Quantity::Number,
            "zero (the default, and always right) or a positive number, in 1/s²",
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

/// A whole number from 1 to a thousand.
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
            "a part of the critical stretch, above 0 and below 1",
            |part| part > 0.0 && part < 1.0,
        )
    });
    let layers = table.or("layers", default.layers, |item| small_count(&item));
    let hold = table.or("hold", default.hold, |item| {
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
        hold: hold?,
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
