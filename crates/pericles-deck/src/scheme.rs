//! The scheme of `[time]` and its parameters.

use pericles::time::{
    Follow, ImplicitRule, Interpolant, LinearSolver, NewmarkOptions, Predictor, RelaxationOptions,
};
use pericles_waves::{FunctionMethod, LoadRule, TrigonometricOptions};
use serde::{Deserialize, Serialize};

use crate::newmark;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::relaxation;
use crate::set::SetNames;
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
    /// r-RESPA.
    Respa {
        /// Where and how fine.
        fine: FineStep,
    },
}

impl Scheme {
    /// Whether it has two time steps, and takes the force apart by points.
    pub fn has_two_steps(&self) -> bool {
        matches!(
            self,
            Self::MultiTimeStep3 { .. } | Self::MultiTimeStep4 { .. } | Self::Respa { .. }
        )
    }

    /// Whether it does with forces of six digits: it solves nothing, judges no small differences and takes no force apart.
    pub fn bears_rounding(&self) -> bool {
        matches!(
            self,
            Self::VelocityVerlet | Self::RungeKutta3 { .. } | Self::RungeKutta4
        )
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
}

pub(crate) fn read(table: &Table<'_>, names: &SetNames) -> Option<Scheme> {
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
        ],
    );
    let Some(kind) = kind else {
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
        {
            table.optional(key);
        }
        return None;
    };
    let alpha = match kind {
        Kind::Rk3 | Kind::Rk3Mts => alpha(table),
        _ => {
            table.forbid("alpha", "α is the parameter of rk3 and rk3-mts");
            Some(f64::NAN)
        }
    };
    let newmark = if kind == Kind::Newmark {
        newmark::read(table).map(Some)
    } else {
        for key in newmark::KEYS {
            if !(kind == Kind::Relaxation && key == "iterations") {
                table.forbid(key, "it belongs to scheme = \"newmark\"");
            }
        }
        Some(None)
    };
    let relaxation = if kind == Kind::Relaxation {
        relaxation::read(table).map(Some)
    } else {
        for key in relaxation::KEYS {
            table.forbid(key, "it belongs to scheme = \"relaxation\"");
        }
        Some(None)
    };
    let tolerance = match kind {
        Kind::DormandPrince => tolerance(table),
        Kind::DiscreteGradient => energy_tolerance(table),
        // Its own, a velocity.
        Kind::Newmark | Kind::Relaxation => Some(f64::NAN),
        _ => {
            table.forbid(
                "tolerance",
                "a tolerance belongs to scheme = \"dormand-prince\", \"newmark\", \"discrete-gradient\" or \"relaxation\"",
            );
            Some(f64::NAN)
        }
    };
    let two = matches!(kind, Kind::Rk3Mts | Kind::Rk4Mts | Kind::Respa);
    let fine = if two {
        fine_step(table, names).map(Some)
    } else {
        for key in ["ratio", "fine", "adaptive"] {
            table.forbid(
                key,
                "two time steps need scheme = \"rk3-mts\", \"rk4-mts\" or \"respa\"",
            );
        }
        Some(None)
    };
    let interface = if matches!(kind, Kind::Rk3Mts | Kind::Rk4Mts) {
        interface(table).map(Some)
    } else {
        for key in ["predictor", "interpolant"] {
            table.forbid(key, "it belongs to scheme = \"rk3-mts\" or \"rk4-mts\"");
        }
        Some(None)
    };
    let exact = if kind == Kind::Trigonometric {
        trigonometric(table).map(Some)
    } else {
        for key in ["functions", "loads", "regularisation"] {
            table.forbid(key, "it belongs to scheme = \"trigonometric\"");
        }
        Some(None)
    };
    let solver = if matches!(kind, Kind::Implicit(_)) {
        table.choice_or_first(
            "linear_solver",
            "linear solver",
            &LinearSolver::ALL.map(|solver| (solver.name(), solver)),
        )
    } else {
        table.forbid(
            "linear_solver",
            "it belongs to scheme = \"implicit-midpoint\" or \"trapezoidal\"",
        );
        Some(LinearSolver::default())
    };
    let (alpha, tolerance, fine, interface) = (alpha?, tolerance?, fine?, interface?);
    if let Some(options) = exact? {
        return Some(Scheme::Trigonometric(options));
    }
    if let Some(options) = newmark? {
        return Some(Scheme::Newmark(options));
    }
    if let Some(options) = relaxation? {
        return Some(Scheme::Relaxation(options));
    }
    Some(match (kind, fine, interface) {
        (Kind::Implicit(rule), ..) => Scheme::Implicit {
            rule,
            solver: solver?,
        },
        (Kind::Rk3Mts, Some(fine), Some(interface)) => Scheme::MultiTimeStep3 {
            alpha,
            fine,
            interface,
        },
        (Kind::Rk4Mts, Some(fine), Some(interface)) => Scheme::MultiTimeStep4 { fine, interface },
        (Kind::Respa, Some(fine), _) => Scheme::Respa { fine },
        (Kind::Rk3, ..) => Scheme::RungeKutta3 { alpha },
        (Kind::Rk4, ..) => Scheme::RungeKutta4,
        (Kind::DormandPrince, ..) => Scheme::DormandPrince { tolerance },
        (Kind::DiscreteGradient, ..) => Scheme::DiscreteGradient { tolerance },
        _ => Scheme::VelocityVerlet,
    })
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
    let functions = table.choice_or_first(
        "functions",
        "way of computing functions",
        &FunctionMethod::ALL.map(|method| (method.name(), method)),
    );
    let load_rule = table.choice_or_first(
        "loads",
        "rule for loads",
        &[("gauss", LoadRule::Gauss), ("midpoint", LoadRule::Midpoint)],
    );
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
    let predictor = table.choice_or_first(
        "predictor",
        "predictor",
        &[Predictor::Structured, Predictor::BackwardDifference].map(|kind| (kind.name(), kind)),
    );
    let interpolant = table.choice_or_first(
        "interpolant",
        "interpolant",
        &[Interpolant::Hermite, Interpolant::Stages].map(|kind| (kind.name(), kind)),
    );
    Some(Interface {
        predictor: predictor?,
        interpolant: interpolant?,
    })
}
