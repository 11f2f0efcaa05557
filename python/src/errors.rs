//! Errors of the libraries as Python exceptions. The classes are written in Python (`_errors.py`).

use std::borrow::Borrow;

use pericles::{PericlesError, SimulationError};
use pericles_deck::{BuildError, DeckError, Fault, Problem, Subject};
use pericles_io::{IoError, MeshError};
use pericles_run::RunError;
use pericles_run::units::bytes;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

/// Makes an exception of a class of `pericles._errors` with a message and attributes.
fn raise(
    class: &str,
    message: &str,
    fill: impl FnOnce(&Bound<'_, PyDict>) -> PyResult<()>,
) -> PyErr {
    Python::attach(|py| {
        let made = || -> PyResult<PyErr> {
            let class = py.import("pericles._errors")?.getattr(class)?;
            let attributes = PyDict::new(py);
            fill(&attributes)?;
            let value = class.call((message,), Some(&attributes))?;
            Ok(PyErr::from_value(value))
        };
        made().unwrap_or_else(|error| error)
    })
}

/// An error without attributes.
pub fn plain(message: &str) -> PyErr {
    raise("PericlesError", message, |_| Ok(()))
}

/// An error of an output or input file.
fn output(message: &str) -> PyErr {
    raise("OutputError", message, |_| Ok(()))
}

fn too_large(message: &str, needed: Option<f64>, allowed: Option<u64>) -> PyErr {
    raise("TooLargeError", message, |attributes| {
        attributes.set_item("needed", needed)?;
        attributes.set_item("allowed", allowed)
    })
}

/// Rejects results that do not fit into memory.
pub fn check_memory(needed: f64, allowed: u64) -> PyResult<()> {
    if needed <= allowed as f64 {
        return Ok(());
    }
    let message = format!(
        "the kept fields need {}, but {} are available; keep fewer fields or outputs, or give an output folder",
        bytes(needed as u64),
        bytes(allowed)
    );
    Err(too_large(&message, Some(needed), Some(allowed)))
}

/// The memory needed and allowed according to a fault.
fn memory_of(fault: &Fault) -> (Option<f64>, Option<u64>) {
    match fault {
        Fault::TooLarge { needed, memory, .. } => (Some(*needed), Some(*memory)),
        _ => (None, None),
    }
}

/// An error of a deck.
pub fn of_deck(error: impl Borrow<DeckError>) -> PyErr {
    let error = error.borrow();
    let message = error.to_string();
    if error.is_too_large() {
        let fault = error.problems().first().map(Problem::subject);
        let (needed, allowed) = fault.map_or((None, None), memory_of);
        return too_large(&message, needed, allowed);
    }
    if let DeckError::Unreadable { .. } = error {
        return output(&message);
    }
    raise("DeckError", &message, |attributes| {
        let problems = PyList::empty(attributes.py());
        for problem in error.problems() {
            let (at, entry) = (problem.location(), PyDict::new(attributes.py()));
            entry.set_item("file", at.file())?;
            entry.set_item("line", at.line())?;
            entry.set_item("column", at.column())?;
            entry.set_item("message", problem.to_string())?;
            entry.set_item("help", problem.subject().advice())?;
            entry.set_item("excerpt", at.excerpt())?;
            entry.set_item("text", problem.line())?;
            problems.append(entry)?;
        }
        attributes.set_item("problems", problems)
    })
}

/// An error of a model without text.
pub fn of_build(error: impl Borrow<BuildError>) -> PyErr {
    let error = error.borrow();
    let message = error.to_string();
    if error.is_too_large() {
        let fault = error.problems().first().map(|problem| problem.subject());
        let (needed, allowed) = fault.map_or((None, None), memory_of);
        return too_large(&message, needed, allowed);
    }
    raise("DeckError", &message, |attributes| {
        let problems = PyList::empty(attributes.py());
        for problem in error.problems() {
            let entry = PyDict::new(attributes.py());
            let path = problem.keys().first().map(pericles_deck::KeyPath::dotted);
            entry.set_item("path", path)?;
            entry.set_item("message", problem.to_string())?;
            entry.set_item("help", problem.subject().advice())?;
            entry.set_item("text", problem.line())?;
            problems.append(entry)?;
        }
        attributes.set_item("problems", problems)
    })
}

/// An error of the engine.
pub fn of_engine(error: impl Borrow<PericlesError>) -> PyErr {
    let error = error.borrow();
    plain(&error.to_string())
}

/// An error of a file.
pub fn of_io(error: impl Borrow<IoError>) -> PyErr {
    let error = error.borrow();
    match error {
        IoError::TooLarge { needed, memory, .. } => {
            too_large(&error.to_string(), Some(*needed as f64), Some(*memory))
        }
        other => output(&other.to_string()),
    }
}

/// An exception of a callback on its way through the engine.
#[derive(Debug)]
pub struct Raised(pub PyErr);

impl std::fmt::Display for Raised {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl std::error::Error for Raised {}

/// An error of a running simulation; `left` says where its state was saved.
pub fn of_simulation(error: impl Borrow<SimulationError>, left: &str) -> PyErr {
    let error = error.borrow();
    let message = match left {
        "" => error.to_string(),
        left => format!("{error}; {left}"),
    };
    let (step, time, point, place, cause, advice) = match error {
        SimulationError::Observe(source) => {
            if let Some(Raised(raised)) = source.downcast_ref() {
                return Python::attach(|py| raised.clone_ref(py));
            }
            return match source.downcast_ref() {
                Some(error) => of_io(error),
                None => plain(&source.to_string()),
            };
        }
        SimulationError::Misfit(error) => return of_engine(error),
        SimulationError::Unstable {
            step,
            t,
            cause,
            point,
            place,
            ..
        } => {
            let advice = cause.advice().to_string();
            (step, t, point, place, cause.to_string(), Some(advice))
        }
        SimulationError::Stuck {
            step,
            t,
            source,
            point,
            place,
            ..
        }
        | SimulationError::NoStaticState {
            step,
            t,
            source,
            point,
            place,
            ..
        } => (step, t, point, place, source.to_string(), None),
        other => return plain(&other.to_string()),
    };
    raise("UnstableError", &message, |attributes| {
        attributes.set_item("step", step)?;
        attributes.set_item("time", time)?;
        attributes.set_item("point", point)?;
        attributes.set_item("place", place)?;
        attributes.set_item("cause", cause)?;
        attributes.set_item("advice", advice)
    })
}

/// An error of a run.
pub fn of_run(error: impl Borrow<RunError>) -> PyErr {
    let error = error.borrow();
    match error {
        RunError::Deck(error) => of_deck(error),
        RunError::Model(error) => of_build(error),
        RunError::Io(error) | RunError::Mesh(MeshError::Io(error)) => of_io(error),
        RunError::Unstable { source, left } => of_simulation(source, left),
        RunError::Simulation(error) => of_simulation(error, ""),
        RunError::NoResults { .. } | RunError::NoRun { .. } | RunError::Damaged { .. } => {
            output(&error.to_string())
        }
        RunError::Unknown { hint, kind, name } => {
            plain(&format!("there is no {kind} \"{name}\"; {hint}"))
        }
        other => plain(&other.to_string()),
    }
}
