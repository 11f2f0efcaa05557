//! Simulations: in memory, or with an output folder as the program's runs.

use std::cell::Cell;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, TryLockError};
use std::time::Instant;

use pericles::observe::Schedule;
use pericles::{Archive, Checkpointed, Control, Interrupt, Outcome};
use pericles_io::{Container, OutputFolder};
use pericles_run::{Assembled, Cancel, Ending, Event, KeptTable, Run, Source, machine, recorded};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::callback::{Asked, Callback, Live, energies, field_named, field_of, squeezed};
use crate::entry::{POLL, enter, guarded};
use crate::errors::{self, plain};
use crate::model::schedule_of;
use crate::recorder::{FieldKeeper, Kept, Recording};
use crate::values::Trouble;

/// The time loop of a simulation.
enum Engine {
    Memory(Box<pericles::Simulation>),
    Folder(Box<Run>),
}

impl Engine {
    fn simulation(&self) -> &pericles::Simulation {
        match self {
            Self::Memory(simulation) => simulation,
            Self::Folder(run) => run.simulation(),
        }
    }
}

/// A simulation.
#[pyclass(frozen, module = "pericles._pericles")]
pub struct Simulation {
    /// Locked while the simulation runs.
    engine: Mutex<Option<Engine>>,
    live: Arc<Live>,
    trouble: Trouble,
    recording: (Arc<Mutex<Kept>>, Vec<KeptTable>),
    folder: Option<PathBuf>,
    warnings: Vec<String>,
    steps: u64,
    dt: f64,
}

/// What a simulation is made from.
pub struct Plan<'a> {
    pub source: &'a Source,
    pub keep: &'a [String],
    pub schedule: Schedule,
    pub trouble: Trouble,
}

const BUSY: &str = "this simulation is running, in another thread or in the callback's own run; wait for it, or call stop()";

impl Simulation {
    /// Makes a simulation of an assembled model.
    pub fn of(
        assembled: Assembled,
        folder: Option<OutputFolder>,
        plan: Plan<'_>,
    ) -> PyResult<Self> {
        let (steps, dt) = (assembled.assembly.steps, assembled.assembly.dt);
        let points = assembled.assembly.cloud.len();
        let warnings = assembled.facts.warnings.clone();
        let fields: PyResult<Vec<_>> = plan.keep.iter().map(|name| field_named(name)).collect();
        let kept = Kept::new(fields?, assembled.assembly.cloud.dimension());
        let needed = kept.bytes(points) * plan.schedule.most(dt, steps) as f64;
        errors::check_memory(needed, machine::memory())?;
        let kept = Arc::new(Mutex::new(kept));
        let keeper = Box::new(FieldKeeper(Arc::clone(&kept)));
        let mut tables = Vec::new();
        let path = folder.as_ref().map(|folder| folder.path().to_path_buf());
        let engine = match folder {
            Some(folder) => {
                let run = Run::begin(plan.source, assembled, folder);
                let mut run = run.map_err(errors::of_run)?;
                if !plan.keep.is_empty() {
                    run.observe(plan.schedule, keeper);
                }
                Engine::Folder(Box::new(run))
            }
            None => {
                let model = plan.source.model();
                let mut simulation;
                (simulation, tables) =
                    recorded(model, assembled.assembly).map_err(errors::of_run)?;
                simulation.observe(plan.schedule, keeper);
                Engine::Memory(Box::new(simulation))
            }
        };
        for name in plan.keep {
            let snapshot = engine.simulation().snapshot();
            snapshot
                .check(field_named(name)?)
                .map_err(errors::of_engine)?;
        }
        Ok(Self {
            engine: Mutex::new(Some(engine)),
            live: Arc::default(),
            trouble: plan.trouble,
            recording: (kept, tables),
            folder: path,
            warnings,
            steps,
            dt,
        })
    }

    /// Uses the engine, unless it is running.
    fn with<T>(&self, act: impl FnOnce(&mut Engine) -> PyResult<T>) -> PyResult<T> {
        let mut engine = match self.engine.try_lock() {
            Ok(engine) => engine,
            Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
            Err(TryLockError::WouldBlock) => return Err(plain(BUSY)),
        };
        act(engine
            .as_mut()
            .ok_or_else(|| plain("the simulation was closed"))?)
    }

    /// Runs until the end, or until `until` steps are completed; returns whether the end was reached.
    fn advance(&self, engine: &mut Engine, until: Option<u64>) -> PyResult<bool> {
        self.live.go_on();
        let watch = Watch {
            live: &self.live,
            trouble: &self.trouble,
            until,
            last: Cell::new(Instant::now()),
            raised: Cell::new(None),
        };
        let ended = match engine {
            Engine::Memory(simulation) => in_memory(simulation, &watch),
            Engine::Folder(run) => in_folder(run, &watch),
        };
        let state = engine.simulation().state();
        self.live.note(state.step, state.t);
        if let Some(error) = self.trouble.take() {
            return Err(error);
        }
        if let Some(error) = watch.raised.take() {
            return Err(error);
        }
        ended
    }
}

/// Decides after every step, and within iterative steps, whether to stop.
struct Watch<'a> {
    live: &'a Live,
    trouble: &'a Trouble,
    until: Option<u64>,
    last: Cell<Instant>,
    /// The exception of a signal handler, such as KeyboardInterrupt.
    raised: Cell<Option<PyErr>>,
}

impl Watch<'_> {
    /// Returns whether the run is to stop within the present step.
    fn is_asked(&self) -> bool {
        if self.last.get().elapsed() >= POLL {
            self.last.set(Instant::now());
            if let Err(error) = Python::attach(|py| py.check_signals()) {
                self.raised.set(Some(error));
                self.live.ask_to_stop(Asked::Signal);
            }
        }
        self.live.is_asked() || self.trouble.is_some()
    }

    /// Returns whether the run is to stop after a step.
    fn stops_after(&self, step: u64, t: f64) -> bool {
        self.live.note(step, t);
        self.is_asked() || self.until.is_some_and(|until| step >= until)
    }
}

fn in_memory(simulation: &mut pericles::Simulation, watch: &Watch<'_>) -> PyResult<bool> {
    let asked = || watch.is_asked();
    let ended = simulation.run_interruptible(Interrupt::when(&asked), |simulation| {
        let state = simulation.state();
        match watch.stops_after(state.step, state.t) {
            true => Control::Stop,
            false => Control::Continue,
        }
    });
    let outcome = ended.map_err(|error| errors::of_simulation(error, ""))?;
    Ok(outcome == Outcome::Finished)
}

fn in_folder(run: &mut Run, watch: &Watch<'_>) -> PyResult<bool> {
    let cancel = Cancel::new();
    let ended = run.drive(None, &cancel, &mut |event| {
        let stop = match event {
            Event::Step { step, t } => watch.stops_after(step, t),
            Event::Iteration(_) => watch.is_asked(),
            _ => false,
        };
        if stop {
            cancel.cancel();
        }
    });
    Ok(ended.map_err(errors::of_run)? == Ending::Finished)
}

#[pymethods]
impl Simulation {
    /// Calls a function at states of a schedule; it stops the run by returning `stop`.
    fn observe(
        &self,
        kind: &str,
        value: f64,
        function: Py<PyAny>,
        stop: Py<PyAny>,
    ) -> PyResult<()> {
        let schedule = schedule_of(kind, value)?;
        let callback = Callback::new(function, stop, Arc::clone(&self.live));
        self.with(|engine| {
            match engine {
                Engine::Memory(simulation) => simulation.observe(schedule, Box::new(callback)),
                Engine::Folder(run) => run.observe(schedule, Box::new(callback)),
            }
            Ok(())
        })
    }

    /// Runs to the end, or until a number of steps is completed; returns whether the end was reached.
    #[pyo3(signature = (until))]
    fn run(&self, py: Python<'_>, until: Option<u64>) -> PyResult<bool> {
        enter()?;
        py.detach(|| self.with(|engine| guarded(|| self.advance(engine, until))))
    }

    /// Stops the run of another thread after its current step.
    fn stop(&self) {
        self.live.ask_to_stop(Asked::Program);
    }

    /// Number of completed steps; also during a run.
    #[getter]
    fn step(&self) -> u64 {
        self.live.step()
    }

    /// Time reached, s; also during a run.
    #[getter]
    fn time(&self) -> f64 {
        self.live.time()
    }

    /// Number of steps of the whole run.
    #[getter]
    fn steps(&self) -> u64 {
        self.steps
    }

    /// Time step, s.
    #[getter]
    fn dt(&self) -> f64 {
        self.dt
    }

    /// The output folder.
    #[getter]
    fn folder(&self) -> Option<PathBuf> {
        self.folder.clone()
    }

    /// Warnings about the model with its conditions.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    /// The energy balance, J.
    #[getter]
    fn energies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let found = py.detach(|| self.with(|engine| Ok(engine.simulation().snapshot().energies())));
        energies(py, &found?)
    }

    /// Number of broken bonds.
    #[getter]
    fn broken_bonds(&self) -> PyResult<u64> {
        self.with(|engine| Ok(engine.simulation().system().operator().broken_bonds()))
    }

    /// Whether the last step or a stop condition of the deck was reached.
    #[getter]
    fn is_finished(&self) -> PyResult<bool> {
        self.with(|engine| {
            let simulation = engine.simulation();
            Ok(simulation.state().step >= self.steps || simulation.stop_reason().is_some())
        })
    }

    /// The condition of the deck, the callback or the call of `stop` that ended the run.
    #[getter]
    fn stop_reason(&self) -> PyResult<Option<String>> {
        let of_deck =
            self.with(|engine| Ok(engine.simulation().stop_reason().map(ToString::to_string)))?;
        Ok(of_deck.or_else(|| self.live.stopped()))
    }

    /// A copy of a field of the current state.
    fn field<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        self.with(|engine| squeezed(field_of(py, &engine.simulation().snapshot(), name)?, name))
    }

    /// Writes the state to a file.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| {
            self.with(|engine| {
                let simulation = engine.simulation();
                let mut archive = Archive::default();
                simulation.save(&mut archive);
                let metadata = serde_json::json!({
                    "version": env!("CARGO_PKG_VERSION"),
                    "step": simulation.state().step,
                });
                let container = Container::from_archive(metadata, archive);
                container.write(&path).map_err(errors::of_io)
            })
        })
    }

    /// Reads the state from a file.
    fn load(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| {
            self.with(|engine| {
                let container = Container::read(&path, machine::memory()).map_err(errors::of_io)?;
                let (_, archive) = container.into_archive().map_err(|reason| plain(&reason))?;
                match engine {
                    Engine::Memory(simulation) => {
                        simulation.restore(&archive).map_err(errors::of_engine)?;
                    }
                    Engine::Folder(run) => run.restore(&archive).map_err(errors::of_run)?,
                }
                let state = engine.simulation().state();
                self.live.note(state.step, state.t);
                Ok(())
            })
        })
    }

    /// The results kept in memory.
    fn recording(&self) -> Recording {
        Recording {
            kept: Arc::clone(&self.recording.0),
            tables: self.recording.1.clone(),
        }
    }

    /// Releases engine and output folder.
    fn close(&self, py: Python<'_>) -> PyResult<()> {
        py.detach(|| match self.engine.try_lock() {
            Ok(mut engine) => {
                drop(engine.take());
                Ok(())
            }
            Err(_) => Err(plain(BUSY)),
        })
    }
}

impl Drop for Simulation {
    /// Frees large arrays without blocking other threads of the interpreter.
    fn drop(&mut self) {
        let engine = self.engine.get_mut().map(Option::take).unwrap_or_default();
        if engine.is_some() {
            Python::attach(|py| py.detach(|| drop(engine)));
        }
    }
}
