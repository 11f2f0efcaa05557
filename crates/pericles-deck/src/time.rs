//! `[time]`: end time, time step and scheme.

use pericles_deck_derive::DeckTable;
use serde::{Deserialize, Serialize};

use crate::declaration::{Check, DeckKeys};
use crate::key_path::KeyPath;
use crate::reader::Table;
use crate::scheme::Scheme;
use crate::set::SetNames;
use crate::stop::StopWhen;

/// Time integration: end time, time step and scheme.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = &'s SetNames)]
pub struct Time {
    /// Scheme.
    #[serde(default)]
    #[deck(flatten)]
    pub scheme: Scheme,
    /// End time. Required except for static schemes; there it is the pseudo-time at which all loads have their final
    /// values.
    ///
    /// In s.
    #[deck(quantity = Time, range = POSITIVE, default = 1.0, required_if(moves(scheme)))]
    pub end: f64,
    /// Time step.
    #[serde(default)]
    #[deck(
        flatten,
        keys("dt", "safety", "load_steps"),
        with = step,
        scope = scheme,
        check = check_step
    )]
    pub step: TimeStep,
    /// Continue with a warning if the time step is unstable or the energy grows. NaN or infinity still stops the run.
    #[serde(default)]
    #[deck(default = false)]
    pub allow_unstable: bool,
    /// Conditions that end the run early.
    #[serde(default)]
    pub stop_when: Vec<StopWhen>,
}

impl Time {
    /// Velocity Verlet up to `end` (s) with the largest stable step.
    pub fn to(end: f64) -> Self {
        Self {
            scheme: Scheme::default(),
            end,
            step: TimeStep::default(),
            allow_unstable: false,
            stop_when: Vec::new(),
        }
    }
}

/// The time step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum TimeStep {
    /// The largest stable step times a safety factor.
    Auto {
        /// Safety factor, in (0, 1].
        safety: f64,
    },
    /// A fixed step, s.
    Fixed(f64),
    /// A number of equal steps.
    Equal(u64),
}

impl Default for TimeStep {
    /// The largest stable step with the default margin.
    fn default() -> Self {
        Self::Auto {
            safety: StepKeys::default_safety(),
        }
    }
}

/// The keys of the time step. The scope is the scheme; none if it is invalid, so that it is unknown which keys it has.
#[derive(DeckTable)]
#[deck(default, scope = Option<&'s Scheme>)]
struct StepKeys {
    /// Time step. "auto": the largest stable step times `safety`; half of it for correspondence materials whose bonds can
    /// break, because damaged points are up to four times as stiff. A step that does not divide `end` is shortened so that
    /// the run ends exactly at `end`. Required for dormand-prince, newmark, discrete-gradient, implicit-midpoint,
    /// trapezoidal and trigonometric; static schemes use `load_steps` instead.
    #[deck(
        quantity = Time,
        range = POSITIVE,
        none = "auto",
        default,
        required_if(is_thermal(scope)),
        forbid_if(is_static(scope), NO_STEP)
    )]
    dt: Option<f64>,
    /// dt = "auto": fraction of the largest stable step.
    ///
    /// The margin is for stiffening under load, which the highest frequency of the reference state does not include.
    #[deck(
        range = above_to(0.0, 1.0),
        default = 0.95,
        forbid_if(is_static(scope), NO_STEP),
        forbid_if(is_thermal(scope), NOT_AUTOMATIC),
        forbid_if(matches!(dt, Some(Some(_))), "it requires dt = \"auto\"")
    )]
    safety: f64,
    /// adaptive-dynamic-relaxation, fire, static: number of load steps up to `end`.
    #[deck(default = 1, forbid_if(moves(scope), NOT_STATIC))]
    load_steps: u64,
}

impl From<&TimeStep> for StepKeys {
    fn from(step: &TimeStep) -> Self {
        let mut keys = Self::default();
        match *step {
            TimeStep::Auto { safety } => keys.safety = safety,
            TimeStep::Fixed(dt) => keys.dt = Some(dt),
            TimeStep::Equal(count) => keys.load_steps = count,
        }
        keys
    }
}

const NO_STEP: &str = "static schemes have no time step: set load_steps";
const NOT_AUTOMATIC: &str = "scheme = \"thermal\" has no automatic step";
const NOT_STATIC: &str =
    "it requires a static scheme: \"adaptive-dynamic-relaxation\", \"fire\" or \"static\"";

fn moves(scheme: Option<&Scheme>) -> bool {
    scheme.is_some_and(|scheme| !scheme.is_static())
}

fn is_static(scheme: Option<&Scheme>) -> bool {
    scheme.is_some_and(Scheme::is_static)
}

fn is_thermal(scheme: Option<&Scheme>) -> bool {
    scheme == Some(&Scheme::Thermal)
}

fn step(table: &Table<'_>, scheme: Option<&Scheme>) -> Option<TimeStep> {
    let keys = StepKeys::read_keys(table, scheme)?;
    Some(match keys.dt {
        _ if is_static(scheme) => TimeStep::Equal(keys.load_steps),
        Some(dt) => TimeStep::Fixed(dt),
        None if is_thermal(scheme) => {
            table.optional("dt")?.out_of_range(NOT_AUTOMATIC);
            return None;
        }
        None => TimeStep::Auto {
            safety: keys.safety,
        },
    })
}

fn check_step(step: &TimeStep, path: &KeyPath, scheme: Option<&Scheme>, check: &mut Check) {
    StepKeys::from(step).check_keys(path, scheme, check);
}
