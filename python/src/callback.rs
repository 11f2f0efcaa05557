//! Callbacks of a run.

use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

use numpy::PyArray2;
use pericles::observe::{Energies, Field, FieldKind, ObserveError, Observer};
use pericles::{Archive, Checkpointed};
use pericles_io::in_user_order;
use pericles_run::units::quantity;
use pyo3::prelude::*;
use pyo3::sync::MutexExt;
use pyo3::types::PyDict;

use crate::arrays::owned;
use crate::errors::{Raised, of_engine, plain};

/// What other threads may read of a simulation while it runs, and how they stop it.
#[derive(Debug, Default)]
pub struct Live {
    step: AtomicU64,
    time: AtomicU64,
    asked: AtomicU8,
}

/// Who asks a run to stop.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Asked {
    /// A callback.
    Callback = 1,
    /// The method `stop`.
    Program = 2,
    /// An exception of a signal handler.
    Signal = 3,
}

impl Live {
    /// Notes the last state.
    pub fn note(&self, step: u64, t: f64) {
        self.step.store(step, Ordering::Relaxed);
        self.time.store(t.to_bits(), Ordering::Relaxed);
    }

    /// The number of completed steps.
    pub fn step(&self) -> u64 {
        self.step.load(Ordering::Relaxed)
    }

    /// The time reached, s.
    pub fn time(&self) -> f64 {
        f64::from_bits(self.time.load(Ordering::Relaxed))
    }

    /// Asks the run to stop.
    pub fn ask_to_stop(&self, by: Asked) {
        self.asked.store(by as u8, Ordering::Relaxed);
    }

    /// Withdraws the request to stop.
    pub fn go_on(&self) {
        self.asked.store(0, Ordering::Relaxed);
    }

    /// Returns whether the run is to stop.
    pub fn is_asked(&self) -> bool {
        self.asked.load(Ordering::Relaxed) != 0
    }

    /// Returns what stopped the run, if it was asked to stop.
    pub fn stopped(&self) -> Option<String> {
        let asked = self.asked.load(Ordering::Relaxed);
        let who = [
            (Asked::Callback, "a callback returned STOP"),
            (Asked::Program, "stop() was called"),
            (Asked::Signal, "interrupted"),
        ];
        let found = who.into_iter().find(|(by, _)| *by as u8 == asked);
        found.map(|(_, words)| format!("{words} at t = {}", quantity(self.time(), "s")))
    }
}

/// Returns the energies as a dict.
pub fn energies<'py>(py: Python<'py>, energies: &Energies) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("kinetic_energy", energies.kinetic)?;
    dict.set_item("elastic_energy", energies.elastic)?;
    dict.set_item("dissipated_energy", energies.dissipated)?;
    dict.set_item("external_work", energies.work)?;
    dict.set_item("initial_energy", energies.initial)?;
    dict.set_item("scheme_correction", energies.scheme)?;
    dict.set_item("balance", energies.balance())?;
    Ok(dict)
}

/// Returns the field with a name of the package: that in files, in lower case.
pub fn field_named(name: &str) -> PyResult<Field> {
    Field::named(name).ok_or_else(|| {
        let names: Vec<String> = Field::ALL.map(|field| field.name().to_lowercase()).to_vec();
        plain(&format!(
            "there is no field \"{name}\"; allowed: {}",
            names.join(", ")
        ))
    })
}

/// Returns the unit of a field, empty for dimensionless fields and those that only files have.
#[pyfunction]
pub fn field_unit(name: &str) -> &'static str {
    Field::named(name).map_or("", Field::unit)
}

/// Returns the names of the components of a field for a body of a dimension, such as `xx`; none for scalars and fields that only
/// files have.
#[pyfunction]
pub fn field_components(name: &str, dimension: usize) -> Vec<&'static str> {
    Field::named(name).map_or_else(Vec::new, |field| {
        field.components(dimension.clamp(1, 3)).to_vec()
    })
}

/// Number of components of a field.
pub fn components(field: Field, dimension: usize) -> usize {
    field.components(dimension).len().max(1)
}

/// Returns a field of a state as an array of its own, in the user's order of points.
pub fn field_of<'py>(
    py: Python<'py>,
    snapshot: &pericles::observe::Snapshot<'_>,
    name: &str,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let field = field_named(name)?;
    snapshot.check(field).map_err(of_engine)?;
    let cloud = snapshot.system().cloud();
    let values = in_user_order(cloud, snapshot.field(field)).into_owned();
    owned(py, values, components(field, cloud.dimension()))
}

/// A borrowed state of the engine.
struct Pointer(*const pericles::observe::Snapshot<'static>);

// SAFETY: the pointer is read under the lock of its snapshot only, and cleared under it before the state ends; the state
// is not changed meanwhile.
unsafe impl Send for Pointer {}

/// A state inside a callback.
#[pyclass(frozen, module = "pericles")]
pub struct Snapshot {
    inner: Mutex<Option<Pointer>>,
    step: u64,
    time: f64,
}

impl Snapshot {
    fn with<T>(
        &self,
        py: Python<'_>,
        read: impl FnOnce(&pericles::observe::Snapshot<'_>) -> PyResult<T>,
    ) -> PyResult<T> {
        let inner = self.inner.lock_py_attached(py);
        let inner = inner.map_err(|_| plain("a callback panicked"))?;
        let Some(Pointer(state)) = &*inner else {
            return Err(plain(
                "a snapshot ends with its callback; copy what is needed with `field`",
            ));
        };
        // SAFETY: `Callback::observe` clears the pointer under the lock, which is held, before the state ends.
        read(unsafe { &**state })
    }
}

#[pymethods]
impl Snapshot {
    /// Number of completed steps.
    #[getter]
    fn step(&self) -> u64 {
        self.step
    }

    /// Time, s.
    #[getter]
    fn time(&self) -> f64 {
        self.time
    }

    /// The energy balance, J.
    #[getter]
    fn energies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.with(py, |state| energies(py, &state.energies()))
    }

    /// Number of broken bonds.
    #[getter]
    fn broken_bonds(&self, py: Python<'_>) -> PyResult<u64> {
        self.with(py, |state| Ok(state.system().operator().broken_bonds()))
    }

    /// A copy of a field: shape (points, components), or (points,) for scalars.
    fn field<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        let array = self.with(py, |state| field_of(py, state, name))?;
        squeezed(array, name)
    }

    fn __repr__(&self) -> String {
        format!(
            "<pericles.Snapshot: step {}, t = {:.6e} s>",
            self.step, self.time
        )
    }
}

/// Returns the array of a scalar field as a flat array; vectors keep their components, also the single one of a bar.
pub fn squeezed<'py>(array: Bound<'py, PyArray2<f64>>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    let field = field_named(name)?;
    let array = array.into_any();
    match matches!(field.kind(), FieldKind::Scalar | FieldKind::Integer) {
        true => array.call_method1("reshape", (-1,)),
        false => Ok(array),
    }
}

/// An observer that calls a Python function.
pub struct Callback {
    function: Py<PyAny>,
    /// The function stops the run by returning this.
    stop: Py<PyAny>,
    live: Arc<Live>,
}

impl Callback {
    /// Makes an observer.
    pub fn new(function: Py<PyAny>, stop: Py<PyAny>, live: Arc<Live>) -> Self {
        Self {
            function,
            stop,
            live,
        }
    }
}

impl Observer for Callback {
    fn observe(&mut self, snapshot: &pericles::observe::Snapshot<'_>) -> Result<(), ObserveError> {
        let state = snapshot.state();
        self.live.note(state.step, state.t);
        let called = Python::attach(|py| {
            let pointer: *const pericles::observe::Snapshot<'_> = snapshot;
            let handle = Snapshot {
                inner: Mutex::new(Some(Pointer(pointer.cast()))),
                step: state.step,
                time: state.t,
            };
            let handle = Bound::new(py, handle)?;
            let answer = self.function.call1(py, (&handle,));
            let cleared = handle.get().inner.lock_py_attached(py);
            *cleared.unwrap_or_else(std::sync::PoisonError::into_inner) = None;
            if answer?.is(&self.stop) {
                self.live.ask_to_stop(Asked::Callback);
            }
            Ok(())
        });
        called.map_err(|error: PyErr| Box::new(Raised(error)) as ObserveError)
    }
}

/// Functions have no state that a checkpoint could hold.
impl Checkpointed for Callback {
    fn save(&self, _archive: &mut Archive) {}

    fn restore(&mut self, _archive: &Archive) -> pericles::Result<()> {
        Ok(())
    }
}
