//! Extension of a run beyond its end.
//!
//! A run can be resumed with another `time.end`. The time step stays, so that the steps already done are those of a run
//! that had this end from the start; the new end is rounded up to a whole number of steps.

use pericles_deck::{Model, Scheme, TimeHistory, TimeStep};

use crate::build::whole_steps;
use crate::checkpoint::Metadata;
use crate::deck_text::DeckText;
use crate::error::RunError;
use crate::source::SourceRecord;
use crate::units::quantity;

/// The only key that may change.
const END: &str = "time.end";

/// Returns the source of a run with changed keys, for a run that resumes from a checkpoint.
///
/// # Errors
/// A key other than `time.end`, an end before the checkpoint, or one on which the loads depend.
pub(crate) fn extended(metadata: &Metadata, changes: &[String]) -> Result<SourceRecord, RunError> {
    let source = metadata.source.clone();
    if changes.is_empty() {
        return Ok(source);
    }
    let key = |change: &String| {
        change
            .split('=')
            .next()
            .unwrap_or_default()
            .trim()
            .to_owned()
    };
    if let Some(other) = changes.iter().map(key).find(|key| key != END) {
        return Err(rejected(format!("`{other}` cannot be changed")));
    }
    let SourceRecord::Deck(text) = source else {
        return Err(rejected("its model was built by a program".into()));
    };
    let with = |changes: &[String]| DeckText {
        overrides: [&text.overrides[..], changes].concat(),
        ..text.clone()
    };
    let old = text.read()?;
    let gives_safety = old.gives("time.safety");
    let old = old.model;
    let end = with(changes).read()?.model.time.end;
    let dt = metadata.dt;
    let steps = whole_steps(end / dt);
    if steps <= metadata.step as f64 {
        return Err(rejected(format!(
            "the run has reached t = {} already; `{END}` must be later",
            quantity(metadata.t, "s")
        )));
    }
    let step = match old.time.step {
        TimeStep::Equal(_) => format!("time.load_steps={steps}"),
        TimeStep::Auto { .. } | TimeStep::Fixed(_) => format!("time.dt={dt:?}"),
    };
    let safety = match old.time.step {
        TimeStep::Auto { .. } if gives_safety => Some("time.safety=unset"),
        _ => None,
    };
    let changes: Vec<String> = [format!("{END}={:?}", steps * dt), step]
        .into_iter()
        .chain(safety.map(str::to_owned))
        .collect();
    let text = with(&changes);
    let new = text.read()?.model;
    let unchanged = Model {
        time: new.time.clone(),
        ..old
    };
    let same = without_idle_courses(unchanged) == without_idle_courses(new.clone());
    let controlled =
        matches!(&new.time.scheme, Scheme::Static(options) if options.control.is_some());
    match same && !controlled {
        true => Ok(SourceRecord::Deck(text)),
        false => Err(rejected(format!(
            "its loads or constraints follow from `{END}`, so that another end changes the past"
        ))),
    }
}

/// Returns a model in which supports have no time function: a ramp of zero does not depend on its length.
fn without_idle_courses(mut model: Model) -> Model {
    for constraint in model.constraints.iter_mut().filter(|one| !one.moves()) {
        constraint.function = TimeHistory::Constant;
    }
    model
}

fn rejected(reason: String) -> RunError {
    RunError::NotExtended { reason }
}
