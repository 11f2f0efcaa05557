//! Keys of a deck fitted to a measured curve by least squares.
//!
//! The residuals are the differences between the curve of a run and the measured one at the measured x, divided by the
//! largest measured |y|. The folder of a fit:
//!
//! ```text
//! beam-fit/
//!   fit.json                   the deck, the keys with their bounds and the measured curve, used to resume
//!   run-0001/  …               one output folder per run
//!   fit.csv                    a row per key: values, standard errors, confidence intervals
//!   curve.csv, fit.png         the measured curve, that of the deck and the fitted one
//! ```
//!
//! The search depends on nothing but the record and the results of the runs. A fit is therefore resumed by repeating it:
//! runs that have finished are read, others continue from their checkpoint or start.

mod curve;
mod least_squares;
mod outcome;
mod parameter;
mod student;

use std::path::{Path, PathBuf};

use pericles_io::OutputFolder;
use serde::{Deserialize, Serialize};

use self::curve::{Measured, Sampled};
use self::least_squares::{Control, Kind, Range, minimise};
pub use self::outcome::{FittedValue, Outcome};
use self::parameter::Parameter;
pub use self::parameter::Wanted;
use crate::cancel::Cancel;
use crate::columns::Tables;
use crate::deck_text::DeckText;
use crate::error::RunError;
use crate::json::{read_json, write_json};
use crate::results::Results;
use crate::run::Ending;
use crate::sweep::{Member, Settings, SweepEvent, run_all, worst};

/// The record of a fit in its folder.
const RECORD: &str = "fit.json";

/// Returns whether a folder contains a fit.
pub fn is_fit(folder: &Path) -> bool {
    folder.join(RECORD).is_file()
}

/// What is fitted.
#[derive(Debug, Clone)]
pub struct Question<'a> {
    /// The measured curve, a CSV table.
    pub curve: &'a Path,
    /// The columns of the tables of a run that are compared with it.
    pub columns: [&'a str; 2],
    /// The keys with their bounds.
    pub keys: Vec<Wanted>,
    /// Relative change of a value for derivatives.
    pub step: f64,
    /// The fit ends when no value changes by more than this fraction.
    pub tolerance: f64,
    /// Maximum number of runs.
    pub runs: usize,
}

/// The content of `fit.json`.
#[derive(Debug, Clone, Serialize, Deserialize)]
struct Record {
    deck: DeckText,
    parameters: Vec<Parameter>,
    measured: Measured,
    step: f64,
    tolerance: f64,
    runs: usize,
}

/// A fit whose decks are valid, before its folder is created.
pub struct Plan(Record);

/// A fit with its locked folder.
pub struct Fit {
    record: Record,
    folder: OutputFolder,
}

/// An event of a fit; events come from several threads.
#[derive(Debug)]
#[non_exhaustive]
pub enum FitEvent<'a> {
    /// An event of the runs.
    Run(SweepEvent<'a>),
    /// The runs with these values of the keys begin.
    Values(&'a [(&'a str, f64)]),
}

/// How a fit ended.
pub enum FitEnd {
    /// The values with their errors.
    Found(Box<Outcome>),
    /// It was stopped; it can be resumed.
    Stopped(Ending),
}

impl Plan {
    /// Plans a fit.
    ///
    /// # Errors
    /// A key has no number in the deck, bounds do not contain it, the deck is invalid at a bound, or the curve cannot be
    /// used.
    pub fn new(deck: DeckText, question: &Question<'_>) -> Result<Self, RunError> {
        let measured = Measured::read(question.curve, question.columns)?;
        let parameters: Result<Vec<Parameter>, RunError> = question
            .keys
            .iter()
            .map(|wanted| Parameter::of(&deck, wanted))
            .collect();
        let parameters = parameters?;
        if let Some((k, twice)) = (parameters.iter().enumerate())
            .find(|(k, one)| parameters[..*k].iter().any(|other| other.key == one.key))
        {
            let reason = format!("key {} repeats {}", k + 1, twice.key);
            return Err(RunError::NoFit { reason });
        }
        let least = 3 * parameters.len() + 2;
        if question.runs < least {
            let reason = format!(
                "{} runs are too few for {} key(s): one step with the derivatives at its ends needs {least}",
                question.runs,
                parameters.len()
            );
            return Err(RunError::NoFit { reason });
        }
        Ok(Self(Record {
            deck,
            parameters,
            measured,
            step: question.step,
            tolerance: question.tolerance,
            runs: question.runs,
        }))
    }

    /// Writes the record to the folder.
    ///
    /// # Errors
    /// The record cannot be written.
    pub fn begin(self, folder: OutputFolder) -> Result<Fit, RunError> {
        write_json(&folder.file(RECORD), &self.0)?;
        Ok(Fit {
            record: self.0,
            folder,
        })
    }
}

/// A run of a fit.
struct Evaluation {
    values: Vec<f64>,
    sampled: Sampled,
}

/// Why a search ends early.
enum Halt {
    Stopped(Ending),
    Failed(RunError),
}

impl Fit {
    /// Opens the fit in a folder.
    ///
    /// # Errors
    /// The folder does not contain a fit.
    pub fn open(path: &Path) -> Result<Self, RunError> {
        let folder = OutputFolder::open(path)?;
        let record = read_json(&folder.file(RECORD))?;
        Ok(Self { record, folder })
    }

    /// Returns the folder.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Searches the values, and writes the table, the curves and the picture.
    ///
    /// # Errors
    /// A run fails that is not a trial, its curve cannot be compared, or results cannot be written.
    pub fn drive(
        &self,
        settings: &Settings,
        cancel: &Cancel,
        tell: &(dyn Fn(FitEvent<'_>) + Sync),
    ) -> Result<FitEnd, RunError> {
        let record = &self.record;
        let ranges: Vec<Range> = record.parameters.iter().map(Parameter::range).collect();
        let control = Control {
            step: record.step,
            tolerance: record.tolerance,
            most: record.runs,
        };
        let mut evaluations: Vec<Evaluation> = Vec::new();
        let mut number = 0;
        let found = minimise(&ranges, &control, &mut |lists, kind| {
            let members: Vec<Member> = lists
                .iter()
                .map(|values| {
                    number += 1;
                    self.member(number, values)
                })
                .collect();
            self.tell_values(lists, tell);
            let place = (None, &self.folder);
            let show = |event: SweepEvent<'_>| tell(FitEvent::Run(event));
            let ends = run_all(&members, place, settings, cancel, &show);
            let mut answers = Vec::new();
            for ((values, member), end) in lists.iter().zip(&members).zip(ends) {
                match worst(vec![end]) {
                    Ok(Ending::Finished) => {}
                    Ok(stopped) => return Err(Halt::Stopped(stopped)),
                    Err(_) if kind == Kind::Trial => {
                        answers.push(None);
                        continue;
                    }
                    Err(error) => return Err(Halt::Failed(error)),
                }
                let sampled = self.sampled(&member.name).map_err(Halt::Failed)?;
                answers.push(Some(record.measured.residuals(&sampled)));
                evaluations.push(Evaluation {
                    values: values.clone(),
                    sampled,
                });
            }
            Ok(answers)
        });
        let minimum = match found {
            Ok(minimum) => minimum,
            Err(Halt::Stopped(how)) => return Ok(FitEnd::Stopped(how)),
            Err(Halt::Failed(error)) => return Err(error),
        };
        let outcome = Outcome::of(record, &minimum, &ranges, &evaluations);
        outcome.write(self.folder.path())?;
        Ok(FitEnd::Found(Box::new(outcome)))
    }

    fn tell_values(&self, lists: &[Vec<f64>], tell: &(dyn Fn(FitEvent<'_>) + Sync)) {
        for values in lists {
            let keys = self.record.parameters.iter().map(|one| one.key.as_str());
            let pairs: Vec<(&str, f64)> = keys.zip(values.iter().copied()).collect();
            tell(FitEvent::Values(&pairs));
        }
    }

    fn member(&self, number: usize, values: &[f64]) -> Member {
        let texts: Vec<String> = values.iter().map(|value| format!("{value:?}")).collect();
        let mut deck = self.record.deck.clone();
        let sets = self.record.parameters.iter().zip(&texts);
        deck.overrides
            .extend(sets.map(|(parameter, value)| format!("{}={value}", parameter.key)));
        Member {
            name: format!("run-{number:04}"),
            values: texts,
            deck,
        }
    }

    /// Returns the curve of a run at the measured points.
    fn sampled(&self, run: &str) -> Result<Sampled, RunError> {
        let path: PathBuf = self.folder.file(run);
        let tables = Tables::of(&Results::open(&path)?)?;
        let [x, y] = &self.record.measured.names;
        self.record.measured.sample(&tables.pair(x, y)?)
    }
}
