//! Runs of a deck and its variants, and the values that are compared with measured ones.

use std::env;
use std::path::Path;
use std::rc::Rc;

use pericles_io::{IoError, OutputFolder, read_csv};
use pericles_run::{Assembled, Caching, Cancel, Event, Means, Results, Run, RunError, Source};
use tempfile::TempDir;

use crate::data::{Case, Found};
use crate::decks::deck;
use crate::fracture::slopes;

/// Name of the run without changes.
const BASE: &str = "base";

/// A finished run and its tables.
struct Experiment {
    results: Results,
    /// Deletes the results of runs that are not kept.
    _folder: Option<TempDir>,
}

impl Experiment {
    /// Runs the deck of a case with the changes of a variant, once per study. The results are kept in the folder of the
    /// figures, if there is one.
    fn of(case: &Case<'_>, variant: &str, changes: &[String]) -> Result<Rc<Self>, RunError> {
        let deck = deck(case, changes)?;
        let source = Source::of_deck(deck, "study.toml".into());
        let key = format!("{:?}", source.record());
        case.once(key, || {
            let temporary = match case.context.figures {
                Some(_) => None,
                None => Some(temporary_folder()?),
            };
            let kept = temporary.as_ref().map(TempDir::path);
            let place = kept.or(case.context.figures).unwrap_or(Path::new("."));
            let name = variant.replace(' ', "-");
            let folder = OutputFolder::create_numbered(place.join(name))?;
            let means = Means {
                caching: Caching::Off,
                ..Means::default()
            };
            let tell = &mut |event: Event<'_>| (case.context.tell)(event);
            let assembled = Assembled::of(&source, &means, tell)?;
            let mut run = Run::begin(&source, assembled, folder)?;
            run.drive(None, &Cancel::new(), tell)?;
            Ok(Self {
                results: Results::open(run.folder())?,
                _folder: temporary,
            })
        })
    }

    /// Returns a column of the tables.
    fn column(&self, name: &str) -> Result<Vec<f64>, RunError> {
        for path in self.results.tables() {
            let table = read_csv(path)?;
            if let Some(values) = table.column(name) {
                return Ok(values.to_vec());
            }
        }
        Err(RunError::unknown(
            "column",
            name,
            [""; 0],
            "no table has it",
        ))
    }
}

fn temporary_folder() -> Result<TempDir, RunError> {
    let folder = tempfile::tempdir();
    Ok(folder.map_err(|error| IoError::writing(&env::temp_dir(), error))?)
}

/// Runs the deck, and in the long form of the study its variants.
fn runs(case: &Case<'_>) -> Result<Vec<(String, Rc<Experiment>)>, RunError> {
    let mut variants = vec![(BASE.to_owned(), Vec::new())];
    if case.context.full {
        variants.extend(case.lists("variants")?);
    }
    let run = |(name, changes): (String, Vec<String>)| {
        let run = Experiment::of(case, &name, &changes)?;
        Ok((name, run))
    };
    variants.into_iter().map(run).collect()
}

/// A value of the first run, `value`, and its spread over several runs, `least` and `greatest`; the largest error of the
/// energy balance over the work and the initial energy, `balance`.
fn compared(
    runs: &[(String, Rc<Experiment>)],
    value: impl Fn(&Experiment) -> Result<f64, RunError>,
) -> Result<Found, RunError> {
    let values: Result<Vec<f64>, RunError> = runs.iter().map(|(_, run)| value(run)).collect();
    let values = values?;
    let balance = |run: &Experiment| {
        let number = |name: &str| run.results.number(name).unwrap_or(f64::NAN);
        let supplied = number("/audit/external_work").abs() + number("/audit/initial_energy");
        (number("/audit/balance") / supplied).abs()
    };
    let errors = runs.iter().map(|(_, run)| balance(run));
    // A missing number is an error.
    let worst = errors.fold(0.0, |worst, error| match error <= worst {
        true => worst,
        false => error,
    });
    let found = Found::default()
        .value("value", values[0])
        .value("balance", worst);
    if values.len() == 1 {
        return Ok(found);
    }
    let of = |pick: fn(f64, f64) -> f64| values.iter().copied().reduce(pick);
    Ok(found
        .value("least", of(f64::min))
        .value("greatest", of(f64::max)))
}

/// The argument `scalar` of the runs: the last value of a column, `max:COLUMN`, `min:COLUMN` or a number of `run.json`.
pub(super) fn scalar(case: &Case<'_>) -> Result<Found, RunError> {
    let name = case.text("scalar")?;
    compared(&runs(case)?, |run| {
        Ok(pericles_run::scalar(&run.results, &name)?.0)
    })
}

/// The column `y` where the column `x` reaches `at`, and the curves `model`, one for each run, and `measured`, the
/// limits `low` and `high` over the places `measured`.
pub(super) fn curve(case: &Case<'_>) -> Result<Found, RunError> {
    let (x, y, at) = (case.text("x")?, case.text("y")?, case.number("at")?);
    let runs = runs(case)?;
    let mut found = compared(&runs, |run| {
        Ok(interpolated(&run.column(&x)?, &run.column(&y)?, at))
    })?;
    for (name, run) in &runs {
        let (x, y) = (run.column(&x)?, run.column(&y)?);
        found = found.labelled("model", Some(name.clone()), &x, &y);
    }
    if case.has("measured_at") {
        let places = case.numbers("measured_at")?;
        for (name, label) in [
            ("measured_low", "measured, least"),
            ("measured_high", "measured, greatest"),
        ] {
            found = found.labelled(
                "measured",
                Some(label.into()),
                &places,
                &case.numbers(name)?,
            );
        }
    }
    Ok(found)
}

/// Value of y at x on a piecewise linear curve with ascending x; NaN outside, except for rounding at its end.
fn interpolated(x: &[f64], y: &[f64], at: f64) -> f64 {
    const ROUNDING: f64 = 1e-9;
    let after = x.partition_point(|x| *x < at);
    match after {
        0 if x.first() == Some(&at) => y[0],
        0 => f64::NAN,
        k if k == x.len() => match at <= x[k - 1] * (1.0 + ROUNDING) {
            true => y[k - 1],
            false => f64::NAN,
        },
        k => y[k - 1] + (y[k] - y[k - 1]) * (at - x[k - 1]) / (x[k] - x[k - 1]),
    }
}

/// Largest damage at the end of points with x above `beyond`.
pub(super) fn damage(case: &Case<'_>) -> Result<Found, RunError> {
    let beyond = case.number("beyond")?;
    compared(&runs(case)?, |run| {
        let last = run.results.fields()?.pop();
        let fields = last.map(|file| file.read()).transpose()?;
        let damage = fields.iter().flat_map(|data| {
            let fields = data.fields.iter().filter(|field| field.name == "Damage");
            fields.flat_map(|field| data.points.chunks(3).zip(&field.values))
        });
        let there = damage.filter(|(place, _)| place[0] > beyond);
        Ok(there
            .map(|(_, damage)| *damage)
            .reduce(f64::max)
            .unwrap_or(f64::NAN))
    })
}

/// Largest slope of the column `column` over time in a window of `window` seconds.
pub(super) fn speed(case: &Case<'_>) -> Result<Found, RunError> {
    let (column, window) = (case.text("column")?, case.number("window")?);
    compared(&runs(case)?, |run| {
        let times = run.column("time")?;
        let points: Vec<_> = times.into_iter().zip(run.column(&column)?).collect();
        let speeds = slopes(&points, window).into_iter().map(|speed| speed.1);
        Ok(speeds.reduce(f64::max).unwrap_or(f64::NAN))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_interpolated_between_the_rows_of_a_table() {
        let (x, y) = ([1.0, 2.0, 4.0], [10.0, 20.0, 0.0]);
        assert_eq!(interpolated(&x, &y, 1.0), 10.0);
        assert_eq!(interpolated(&x, &y, 1.5), 15.0);
        assert_eq!(interpolated(&x, &y, 4.0), 0.0);
        assert_eq!(interpolated(&x, &y, 4.0 + 1e-12), 0.0);
        assert!(interpolated(&x, &y, 0.5).is_nan());
        assert!(interpolated(&x, &y, 4.5).is_nan());
    }
}
