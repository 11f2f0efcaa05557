//! Loads and prescribed motions given by Python functions.

use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use numpy::{PyArrayMethods, PyReadonlyArray2};
use pericles::boundary::PointValues;
use pyo3::prelude::*;

use crate::arrays::{Selection, component_major};
use crate::errors::plain;

/// The first error of a function of a load or motion; the run that met it ends with it.
#[derive(Debug, Clone, Default)]
pub struct Trouble(Arc<Stored>);

#[derive(Debug, Default)]
struct Stored {
    /// Whether there is an error; read after every step.
    is_some: AtomicBool,
    error: Mutex<Option<PyErr>>,
}

impl Trouble {
    /// Stores an error unless there is one.
    pub fn note(&self, error: PyErr) {
        let mut stored = self.0.error.lock().unwrap_or_else(PoisonError::into_inner);
        stored.get_or_insert(error);
        self.0.is_some.store(true, Ordering::Release);
    }

    /// Returns whether there is an error.
    pub fn is_some(&self) -> bool {
        self.0.is_some.load(Ordering::Acquire)
    }

    /// Takes the error.
    pub fn take(&self) -> Option<PyErr> {
        let mut stored = self.0.error.lock().unwrap_or_else(PoisonError::into_inner);
        self.0.is_some.store(false, Ordering::Release);
        stored.take()
    }
}

/// The time step of a model, once it is known, as the distance of finite differences.
#[derive(Debug, Clone)]
pub struct Step(Arc<AtomicU64>);

impl Step {
    /// Starts with a small part of the run.
    pub fn new(seconds: f64) -> Self {
        Self(Arc::new(AtomicU64::new(seconds.to_bits())))
    }

    /// Sets the step, s.
    pub fn set(&self, seconds: f64) {
        self.0.store(seconds.to_bits(), Ordering::Relaxed);
    }

    fn get(&self) -> f64 {
        f64::from_bits(self.0.load(Ordering::Relaxed))
    }
}

/// Values of the points of a set, from functions of time and position, `f(t, x)`.
///
/// `functions` are the values and their known time derivatives: further derivatives are central differences over the time
/// step of the run.
pub struct FunctionValues {
    functions: Vec<Py<PyAny>>,
    /// Positions of the points in the user's order.
    places: Py<PyAny>,
    selection: Selection,
    dimension: usize,
    step: Step,
    trouble: Trouble,
    /// The last values, most recent last: (order, bits of t, values).
    kept: Mutex<Vec<Kept>>,
}

type Kept = (usize, u64, Arc<Vec<f64>>);

impl FunctionValues {
    /// Number of kept arrays: a step of a motion needs three derivatives at two times.
    const KEPT: usize = 8;

    /// Makes values for the points of a selection.
    pub fn new(
        functions: Vec<Py<PyAny>>,
        places: Py<PyAny>,
        selection: Selection,
        dimension: usize,
        (step, trouble): (Step, Trouble),
    ) -> Self {
        Self {
            functions,
            places,
            selection,
            dimension,
            step,
            trouble,
            kept: Mutex::default(),
        }
    }

    /// Calls a function at time t and checks what it returns.
    fn called(&self, py: Python<'_>, function: &Py<PyAny>, t: f64) -> PyResult<Vec<f64>> {
        let given = function.call1(py, (t, self.places.bind(py)))?;
        let asarray = py.import("pericles._arrays")?.getattr("as_vectors")?;
        let n = self.selection.points.len();
        let array = asarray.call1((given, n, self.dimension))?;
        let array: PyReadonlyArray2<'_, f64> = array.cast::<numpy::PyArray2<f64>>()?.readonly();
        let values = self.selection.ordered(&component_major(&array));
        match values.iter().position(|value| !value.is_finite()) {
            None => Ok(values),
            Some(_) => Err(plain(&format!(
                "a function of a load or prescribed motion returned NaN or infinity at t = {t} s"
            ))),
        }
    }

    /// The derivative of order `order` at time t.
    fn derivative(&self, py: Python<'_>, order: usize, t: f64) -> PyResult<Vec<f64>> {
        let known = order.min(self.functions.len() - 1);
        let at = |t: f64| self.called(py, &self.functions[known], t);
        let h = self.step.get();
        let zip = |a: Vec<f64>, b: Vec<f64>, f: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
            a.into_iter().zip(b).map(|(a, b)| f(a, b)).collect()
        };
        match order - known {
            0 => at(t),
            1 => Ok(zip(at(t + h)?, at(t - h)?, &|a, b| (a - b) / (2.0 * h))),
            _ => {
                let outer = zip(at(t + h)?, at(t - h)?, &|a, b| a + b);
                Ok(zip(outer, at(t)?, &|a, b| (a - 2.0 * b) / (h * h)))
            }
        }
    }

    fn values(&self, order: usize, t: f64) -> Arc<Vec<f64>> {
        let key = (order, t.to_bits());
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((.., values)) = kept.iter().find(|(o, bits, _)| (*o, *bits) == key) {
            return Arc::clone(values);
        }
        drop(kept);
        let made = Python::attach(|py| self.derivative(py, order, t));
        let values = Arc::new(made.unwrap_or_else(|error| {
            self.trouble.note(error);
            vec![f64::NAN; self.len()]
        }));
        kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.len() == Self::KEPT {
            kept.remove(0);
        }
        kept.push((key.0, key.1, Arc::clone(&values)));
        values
    }
}

impl fmt::Debug for FunctionValues {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "FunctionValues({} points)", self.selection.points.len())
    }
}

impl PointValues for FunctionValues {
    fn len(&self) -> usize {
        self.selection.points.len() * self.dimension
    }

    fn at(&self, order: usize, t: f64, read: &mut dyn FnMut(&[f64])) {
        read(&self.values(order, t));
    }
}
