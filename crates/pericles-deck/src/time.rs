//! `[time]`: end time, time step and scheme.

use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::Table;
use crate::relaxation;
use crate::scheme::{self, Scheme};
use crate::set::SetNames;
use crate::stop::{StopWhen, stop_when};

/// Time integration of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// End time, s.
    pub end: f64,
    /// Time step.
    #[serde(default)]
    pub step: TimeStep,
    /// Scheme.
    #[serde(default)]
    pub scheme: Scheme,
    /// Whether an unstable time step is accepted.
    #[serde(default)]
    pub allow_unstable: bool,
    /// Conditions that end the run early.
    #[serde(default)]
    pub stop_when: Vec<StopWhen>,
}

impl Time {
    /// Velocity Verlet up to `end` (s) with the largest stable step.
    pub fn to(end: f64) -> Self {
        Self {
            end,
            step: TimeStep::default(),
            scheme: Scheme::default(),
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

/// Margin for stiffening under load, which the highest frequency of the reference state does not include.
const SAFETY: f64 = 0.95;

impl Default for TimeStep {
    /// The largest stable step with the default margin.
    fn default() -> Self {
        Self::Auto { safety: SAFETY }
    }
}

pub(crate) fn read(table: Table<'_>, names: &SetNames) -> Option<Time> {
    let scheme = scheme::read(&table, names);
    let (end, step) = match scheme {
        Some(ref scheme) if scheme.is_static() => (
            table.or("end", relaxation::END, |item| item.positive(Quantity::Time)),
            relaxation::load_steps(&table).map(TimeStep::Equal),
        ),
        Some(Scheme::Thermal) => {
            table.forbid("safety", "scheme = \"thermal\" has no automatic step");
            let dt = table
                .required("dt")
                .and_then(|item| item.positive(Quantity::Time));
            let end = table
                .required("end")
                .and_then(|item| item.positive(Quantity::Time));
            (end, dt.map(TimeStep::Fixed))
        }
        _ => (
            table
                .required("end")
                .and_then(|item| item.positive(Quantity::Time)),
            step(&table),
        ),
    };
    let allow_unstable = table.or("allow_unstable", false, |item| item.boolean());
    let stops: Vec<Option<StopWhen>> = table
        .tables("stop_when")
        .into_iter()
        .map(|table| stop_when(table, names))
        .collect();
    table.finish();
    Some(Time {
        end: end?,
        step: step?,
        scheme: scheme?,
        allow_unstable: allow_unstable?,
        stop_when: stops.into_iter().collect::<Option<_>>()?,
    })
}

fn step(table: &Table<'_>) -> Option<TimeStep> {
    const AUTO: &str = "auto";
    let fixed = match table.optional("dt") {
        None => {
            table.record("dt", AUTO);
            Some(None)
        }
        Some(item) if item.is_keyword(AUTO) => Some(None),
        Some(item) => match item.word() {
            Some(word) if !word.contains(|c: char| c.is_ascii_digit()) => {
                item.unknown_word("time step", word, std::iter::once(AUTO));
                None
            }
            _ => item.positive(Quantity::Time).map(Some),
        },
    };
    match fixed {
        Some(None) => {
            let safety = table.or("safety", SAFETY, |item| {
                item.within(
                    Quantity::Number,
                    "a number above 0 and at most 1",
                    |safety| safety > 0.0 && safety <= 1.0,
                )
            });
            Some(TimeStep::Auto { safety: safety? })
        }
        Some(Some(dt)) => {
            table.forbid("safety", "it requires dt = \"auto\"");
            Some(TimeStep::Fixed(dt))
        }
        None => {
            table.optional("safety");
            None
        }
    }
}
