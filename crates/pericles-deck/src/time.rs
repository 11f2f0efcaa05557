//! `[time]`: how far, how fine and by which scheme.

use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::Table;
use crate::relaxation;
use crate::scheme::{self, Scheme};
use crate::set::SetNames;
use crate::stop::{StopWhen, stop_when};

/// The course of the run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// End, s.
    pub end: f64,
    /// The step.
    #[serde(default)]
    pub step: TimeStep,
    /// The scheme.
    #[serde(default)]
    pub scheme: Scheme,
    /// Whether a step beyond the stable limit is accepted.
    #[serde(default)]
    pub allow_unstable: bool,
    /// Conditions that end the run before its end.
    #[serde(default)]
    pub stop_when: Vec<StopWhen>,
}

impl Time {
    /// A run to `end` (s) by velocity Verlet with the largest stable step.
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
    /// The largest stable step times this factor.
    Auto {
        /// Safety factor, in (0, 1].
        safety: f64,
    },
    /// This step, s.
    Fixed(f64),
    /// So many to the end.
    Equal(u64),
}

/// Margin for stiffening under load, which the frequency of the reference state does not see.
const SAFETY: f64 = 0.95;

impl Default for TimeStep {
    /// The largest stable step with a margin.
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
            table.forbid("safety", "a safety factor belongs to dt = \"auto\"");
            Some(TimeStep::Fixed(dt))
        }
        None => {
            table.optional("safety");
            None
        }
    }
}
