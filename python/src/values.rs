//! Loads and prescribed motions given by Python functions.

use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use numpy::{PyArrayMethods, PyReadonlyArray2};
use pericles::boundary::PointValues;
use pyo3::prelude::*;

use crate::arrays::{Selection, component_major};
use crate::errors::plain;

/// The first error of a function of a load or motion; the run that met it undoes its step and ends with it.
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

/// Values of the points of a set in one simulation, from functions of time and position, `f(t, x)`. Derivatives without
/// a function are differences over the time step of the run.
pub struct FunctionValues {
    given: Arc<Functions>,
    step: Step,
    trouble: Trouble,
    /// The last values, most recent last: (order, bits of t, values).
    kept: Mutex<Vec<Kept>>,
    /// The last integrals of rates over whole steps, most recent last: (steps, values).
    integrals: Mutex<Vec<(u64, Arc<Vec<f64>>)>>,
}

/// Functions with the points that they receive.
pub struct Functions {
    /// The values and their known time derivatives.
    pub functions: Vec<Py<PyAny>>,
    /// Whether the first function is the time derivative of the values, which are zero at t = 0.
    pub are_rates: bool,
    /// Positions of the points in the user's order.
    pub places: Py<PyAny>,
    /// The points.
    pub selection: Selection,
    /// Dimension of the body.
    pub dimension: usize,
}

type Kept = (usize, u64, Arc<Vec<f64>>);

impl FunctionValues {
    /// Number of kept arrays: a step of a motion needs three derivatives at two times.
    const KEPT: usize = 8;

    /// Makes the values of one simulation.
    pub fn new(given: Arc<Functions>, step: Step, trouble: Trouble) -> Self {
        Self {
            given,
            step,
            trouble,
            kept: Mutex::default(),
            integrals: Mutex::default(),
        }
    }

    /// Calls a function at time t and checks what it returns.
    fn called(&self, py: Python<'_>, function: &Py<PyAny>, t: f64) -> PyResult<Vec<f64>> {
        let known = &*self.given;
        let given = function.call1(py, (t, known.places.bind(py)))?;
        let asarray = py.import("pericles._arrays")?.getattr("as_vectors")?;
        let n = known.selection.points.len();
        let array = asarray.call1((given, n, known.dimension))?;
        let array: PyReadonlyArray2<'_, f64> = array.cast::<numpy::PyArray2<f64>>()?.readonly();
        let values = known.selection.ordered(&component_major(&array));
        match values.iter().position(|value| !value.is_finite()) {
            None => Ok(values),
            Some(_) => Err(plain(&format!(
                "a function of a load or prescribed motion returned NaN or infinity at t = {t} s"
            ))),
        }
    }

    /// The derivative of order `order` at time t.
    fn derivative(&self, py: Python<'_>, order: usize, t: f64) -> PyResult<Vec<f64>> {
        let order = match (self.given.are_rates, order) {
            (true, 0) => return self.integral(py, t),
            (rates, order) => order - usize::from(rates),
        };
        let known = order.min(self.given.functions.len() - 1);
        let h = self.step.get();
        let mut sum = vec![0.0; self.len()];
        for &(place, weight) in stencil(order - known, t < h) {
            let values = self.called(py, &self.given.functions[known], t + place * h)?;
            let weight = weight / h.powi((order - known) as i32);
            for (sum, value) in sum.iter_mut().zip(values) {
                *sum += weight * value;
            }
        }
        Ok(sum)
    }

    /// The integral of the rates from 0 to t, by Simpson's rule over the steps of the run. It does not depend on the order of
    /// evaluations: a run that continues from a checkpoint has the same values.
    fn integral(&self, py: Python<'_>, t: f64) -> PyResult<Vec<f64>> {
        let h = self.step.get();
        // Times are whole multiples of the step to within rounding.
        let steps = (t / h + 1e-6).floor().max(0.0) as u64;
        let known = {
            let kept = self
                .integrals
                .lock()
                .unwrap_or_else(PoisonError::into_inner);
            let before = kept.iter().filter(|(at, _)| *at <= steps);
            before.max_by_key(|(at, _)| *at).cloned()
        };
        let (mut at, mut sum) = match known {
            Some((at, values)) => (at, values.to_vec()),
            None => (0, vec![0.0; self.len()]),
        };
        while at < steps {
            self.add_simpson(py, [at as f64 * h, (at + 1) as f64 * h], &mut sum)?;
            at += 1;
            let mut kept = self
                .integrals
                .lock()
                .unwrap_or_else(PoisonError::into_inner);
            if kept.len() == Self::KEPT {
                kept.remove(0);
            }
            kept.push((at, Arc::new(sum.clone())));
        }
        let start = steps as f64 * h;
        if t - start > 1e-6 * h {
            self.add_simpson(py, [start, t], &mut sum)?;
        }
        Ok(sum)
    }

    /// Adds the integral of the rates over an interval by Simpson's rule.
    fn add_simpson(&self, py: Python<'_>, [a, b]: [f64; 2], sum: &mut [f64]) -> PyResult<()> {
        for (t, weight) in [(a, 1.0), (0.5 * (a + b), 4.0), (b, 1.0)] {
            let rates = self.known(py, 1, t)?;
            for (sum, rate) in sum.iter_mut().zip(&*rates) {
                *sum += weight * (b - a) / 6.0 * rate;
            }
        }
        Ok(())
    }

    /// The derivative of order `order` at time t; the last ones are kept.
    fn known(&self, py: Python<'_>, order: usize, t: f64) -> PyResult<Arc<Vec<f64>>> {
        let key = (order, t.to_bits());
        let locked = || self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((.., values)) = locked().iter().find(|(o, bits, _)| (*o, *bits) == key) {
            return Ok(Arc::clone(values));
        }
        let values = Arc::new(self.derivative(py, order, t)?);
        let mut kept = locked();
        if kept.len() == Self::KEPT {
            kept.remove(0);
        }
        kept.push((key.0, key.1, Arc::clone(&values)));
        Ok(values)
    }

    fn values(&self, order: usize, t: f64) -> Arc<Vec<f64>> {
        // The step of a failed evaluation is undone: what it computes further does not matter.
        let unknown = || Arc::new(vec![f64::NAN; self.len()]);
        if self.trouble.is_some() {
            return unknown();
        }
        Python::attach(|py| self.known(py, order, t)).unwrap_or_else(|error| {
            self.trouble.note(error);
            unknown()
        })
    }
}

impl fmt::Debug for FunctionValues {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "FunctionValues({} values)", self.len())
    }
}

impl PointValues for FunctionValues {
    fn len(&self) -> usize {
        self.given.selection.points.len() * self.given.dimension
    }

    fn at(&self, order: usize, t: f64, read: &mut dyn FnMut(&[f64])) {
        read(&self.values(order, t));
    }

    fn can_fail(&self) -> bool {
        true
    }

    fn has_failed(&self) -> bool {
        self.trouble.is_some()
    }
}

/// Places and weights of the finite differences of second order for a derivative; `forward` uses no earlier times, for
/// functions that begin at t = 0.
fn stencil(order: usize, forward: bool) -> &'static [(f64, f64)] {
    match (order, forward) {
        (0, _) => &[(0.0, 1.0)],
        (1, false) => &[(-1.0, -0.5), (1.0, 0.5)],
        (1, true) => &[(0.0, -1.5), (1.0, 2.0), (2.0, -0.5)],
        (_, false) => &[(-1.0, 1.0), (0.0, -2.0), (1.0, 1.0)],
        (_, true) => &[(0.0, 2.0), (1.0, -5.0), (2.0, 4.0), (3.0, -1.0)],
    }
}
