//! Several runs: the steps of a deck, sweeps and fits.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Mutex;

use pericles_io::OutputFolder;
use pericles_run::fit::{FitEnd, FitEvent, Plan, Question, Wanted};
use pericles_run::sequence;
use pericles_run::sweep::{self, Axis, Settings, SweepEvent, SweepResults};
use pericles_run::{Cancel, InitialState, RunError};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::deck::Deck;
use crate::entry::{cancellable, enter, guarded, means};
use crate::errors::{of_io, of_run, plain};

/// Creates the folder `out`, or a numbered folder beginning with `stem`.
fn folder_of(out: Option<PathBuf>, stem: PathBuf, force: bool) -> PyResult<OutputFolder> {
    let folder = match out {
        Some(out) => OutputFolder::create(out, force),
        None => OutputFolder::create_numbered(stem),
    };
    folder.map_err(of_io)
}

/// Runs at most `jobs` at once, by default one per core; the cores are divided among them.
fn settings(jobs: Option<NonZeroUsize>) -> Settings {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    Settings {
        threads: jobs.map_or(1, |jobs| cores.div_ceil(jobs.get())),
        means: means(),
        deadline: None,
    }
}

/// Runs the steps of a deck; returns the folder.
#[pyfunction]
pub fn run_steps(
    py: Python<'_>,
    deck: &Deck,
    out: Option<PathBuf>,
    stem: PathBuf,
    force: bool,
) -> PyResult<PathBuf> {
    let (text, cancel) = (deck.text().clone(), Cancel::new());
    let stop = cancel.clone();
    cancellable(py, &cancel, move || {
        let means = means();
        let plan = sequence::Plan::new(text, None).map_err(of_run)?;
        let plan = plan.ok_or_else(|| plain("the deck has no steps"))?;
        plan.check(InitialState::Model, &means, &mut |_| {})
            .map_err(of_run)?;
        let folder = folder_of(out, stem, force)?;
        let steps = plan.begin(folder, &means).map_err(of_run)?;
        let ended = steps.drive::<RunError>(&means, &mut |_| {}, |_, mut run| {
            run.drive(None, &stop, &mut |_| {})
        });
        ended.map_err(of_run)?;
        Ok(steps.folder().to_path_buf())
    })
}

/// A sweep in its folder.
#[pyclass(frozen, module = "pericles._pericles")]
pub struct Sweep {
    folder: PathBuf,
    results: SweepResults,
    cancel: Mutex<Cancel>,
}

impl Sweep {
    fn of(folder: PathBuf) -> PyResult<Self> {
        Ok(Self {
            results: SweepResults::open(&folder).map_err(of_run)?,
            cancel: Mutex::default(),
            folder,
        })
    }
}

#[pymethods]
impl Sweep {
    /// Checks all combinations of values of the keys, and begins the sweep in a folder, or continues it there.
    #[staticmethod]
    fn begin(
        py: Python<'_>,
        deck: &Deck,
        axes: Vec<(String, Vec<String>)>,
        folder: PathBuf,
    ) -> PyResult<Self> {
        let text = deck.text().clone();
        let axes = axes.into_iter();
        let axes: Vec<Axis> = axes.map(|(key, values)| Axis { key, values }).collect();
        py.detach(|| {
            let plan = sweep::Plan::new(text, axes, None).map_err(of_run)?;
            drop(plan.enter(&folder).map_err(of_run)?);
            Self::of(folder)
        })
    }

    /// Opens the sweep in a folder; none if the folder has no sweep.
    #[staticmethod]
    fn open(folder: PathBuf) -> PyResult<Option<Self>> {
        match sweep::is_sweep(&folder) {
            true => Self::of(folder).map(Some),
            false => Ok(None),
        }
    }

    /// The keys.
    fn keys(&self) -> Vec<&str> {
        self.results.keys().map(|(key, _)| key).collect()
    }

    /// The values of the keys of each run as written in decks.
    fn values(&self) -> Vec<Vec<String>> {
        self.results.values().map(<[String]>::to_vec).collect()
    }

    /// The values of the keys of each run in SI units; none for values that are not numbers.
    fn numbers(&self) -> PyResult<Vec<Vec<Option<f64>>>> {
        self.results.numbers().map_err(of_run)
    }

    /// The names of the folders of the runs.
    fn names(&self) -> Vec<String> {
        self.results
            .runs()
            .map(|(name, _)| name.to_owned())
            .collect()
    }

    /// The table of the runs with its header.
    fn table(&self) -> Vec<Vec<String>> {
        self.results.table().rows().to_vec()
    }

    /// Runs all unfinished runs. `ended` is called with the name of each one and its error.
    fn run(&self, py: Python<'_>, jobs: Option<NonZeroUsize>, ended: Py<PyAny>) -> PyResult<()> {
        enter()?;
        let cancel = Cancel::new();
        *self.cancel.lock().map_err(|_| plain("a sweep panicked"))? = cancel.clone();
        let show = |event: SweepEvent<'_>| {
            let SweepEvent::Ended { run, how } = event else {
                return;
            };
            let error = how.as_ref().err().map(of_run);
            Python::attach(|py| {
                let error = error.map(|error| error.into_value(py));
                if let Err(error) = ended.call1(py, (run, error)) {
                    error.write_unraisable(py, None);
                }
            });
        };
        py.detach(|| {
            guarded(|| {
                let sweep = sweep::Sweep::open(&self.folder).map_err(of_run)?;
                let end = sweep.drive(&settings(jobs), &cancel, &show);
                end.map(drop).map_err(of_run)
            })
        })
    }

    /// Stops the runs in progress.
    fn stop(&self) {
        if let Ok(cancel) = self.cancel.lock() {
            cancel.cancel();
        }
    }
}

/// What is fitted.
#[derive(FromPyObject)]
pub struct FitOptions {
    #[pyo3(item)]
    curve: PathBuf,
    #[pyo3(item)]
    x: String,
    #[pyo3(item)]
    y: String,
    #[pyo3(item)]
    keys: Vec<String>,
    #[pyo3(item)]
    step: f64,
    #[pyo3(item)]
    tolerance: f64,
    #[pyo3(item)]
    runs: usize,
    #[pyo3(item)]
    jobs: Option<NonZeroUsize>,
}

/// Fits keys of a deck to a measured curve; returns the results as a dict. `begun` is called with the number of runs so far.
#[pyfunction]
pub fn fit<'py>(
    py: Python<'py>,
    deck: &Deck,
    options: FitOptions,
    out: Option<PathBuf>,
    stem: PathBuf,
    begun: Py<PyAny>,
) -> PyResult<Bound<'py, PyDict>> {
    let (text, cancel) = (deck.text().clone(), Cancel::new());
    let stop = cancel.clone();
    let (folder, end) = cancellable(py, &cancel, move || {
        let keys = options.keys.iter().map(|key| key.parse::<Wanted>());
        let question = Question {
            curve: &options.curve,
            columns: [&options.x, &options.y],
            keys: keys
                .collect::<Result<_, _>>()
                .map_err(|reason| plain(&reason))?,
            step: options.step,
            tolerance: options.tolerance,
            runs: options.runs,
        };
        let plan = Plan::new(text, &question).map_err(of_run)?;
        let fit = plan.begin(folder_of(out, stem, false)?).map_err(of_run)?;
        let show = |event: FitEvent<'_>| {
            if let FitEvent::Run(SweepEvent::Ended { .. }) = event {
                Python::attach(|py| {
                    if let Err(error) = begun.call0(py) {
                        error.write_unraisable(py, None);
                    }
                });
            }
        };
        let end = fit.drive(&settings(options.jobs), &stop, &show);
        Ok((fit.folder().to_path_buf(), end.map_err(of_run)?))
    })?;
    let outcome = match end {
        FitEnd::Found(outcome) => outcome,
        FitEnd::Stopped(_) => {
            let folder = folder.display();
            return Err(plain(&format!("the fit in {folder} was stopped")));
        }
    };
    let found = PyDict::new(py);
    let values = outcome.values().iter();
    let rows: Vec<_> = values
        .map(|value| {
            let unit = pericles_deck::unit_of_key(&value.key);
            let numbers = [
                value.start,
                value.value,
                value.error,
                value.half,
                value.low,
                value.high,
            ];
            (value.key.clone(), unit, numbers)
        })
        .collect();
    found.set_item("rows", rows)?;
    found.set_item("folder", folder)?;
    found.set_item("converged", outcome.has_converged())?;
    found.set_item("runs", outcome.runs())?;
    found.set_item("misfits", outcome.misfits())?;
    found.set_item("warnings", outcome.warnings())?;
    found.set_item("lines", outcome.lines())?;
    Ok(found)
}
