//! Models: the points of a deck or of arrays, with sets, conditions and the time step.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard};

use numpy::{PyArray1, PyArray2, PyReadonlyArray1, PyReadonlyArray2};
use pericles::boundary::{
    AxisMotion, Load, LoadDensity, MotionKind, PrescribedMotion, TimeFunction,
};
use pericles::observe::Schedule;
use pericles::space::{ListedPoints, PointCloud};
use pericles_deck::{BuildError, Fault, KeyPath, Remark};
use pericles_io::{OutputFolder, in_user_order};
use pericles_run::{Assembled, Discretisation, Resources, Source, assemble, discretise};
use pyo3::prelude::*;
use pyo3::sync::MutexExt;

use crate::arrays::{Selection, component_major, in_cloud_order, owned};
use crate::deck::Deck;
use crate::entry::{means, waiting};
use crate::errors::{self, plain};
use crate::simulation::{Plan, Simulation};
use crate::values::{FunctionValues, Functions, Step, Trouble};

/// A body with its conditions.
#[pyclass(frozen, module = "pericles._pericles")]
pub struct Model {
    parts: Mutex<Parts>,
    source: Source,
    cloud: Arc<PointCloud>,
    dt: f64,
}

struct Parts {
    discretisation: Discretisation,
    /// Loads and prescribed motions by functions. Every simulation has values and errors of its own.
    additions: Vec<Addition>,
    /// The assembly of these parts, until it becomes a simulation or they change.
    assembled: Option<Assembled>,
    facts: String,
}

/// A load or prescribed motion by functions.
#[derive(Clone)]
enum Addition {
    Load(Arc<Functions>),
    Motion {
        name: String,
        axes: Vec<bool>,
        course: Course,
    },
}

/// The course of a prescribed motion.
#[derive(Clone)]
enum Course {
    Functions(Arc<Functions>),
    /// Constant displacements or velocities: component c of the k-th point is entry c · points + k.
    Constant {
        kind: MotionKind,
        points: Vec<u32>,
        values: Arc<Vec<f64>>,
    },
}

impl Addition {
    /// Adds it to a discretisation, for one simulation.
    fn apply(
        self,
        discretisation: &mut Discretisation,
        (step, trouble): (&Step, &Trouble),
    ) -> PyResult<()> {
        let conditions = &mut discretisation.conditions;
        let values = |functions: Arc<Functions>| {
            Arc::new(FunctionValues::new(
                functions,
                step.clone(),
                trouble.clone(),
            ))
        };
        match self {
            Self::Load(functions) => {
                let points = functions.selection.points.clone();
                let density = LoadDensity::Values(values(functions));
                let load = Load::new(points, density, TimeFunction::Constant);
                conditions.loads.push(load);
            }
            Self::Motion { name, axes, course } => {
                let given: Box<dyn Fn(usize) -> AxisMotion>;
                let (kind, points);
                match course {
                    Course::Functions(functions) => {
                        kind = match functions.are_rates {
                            true => MotionKind::Velocity,
                            false => MotionKind::Displacement,
                        };
                        points = functions.selection.points.clone();
                        let values = values(functions);
                        given = Box::new(move |_| AxisMotion::Values(values.clone()));
                    }
                    Course::Constant {
                        kind: of_values,
                        points: on,
                        values,
                    } => {
                        (kind, points) = (of_values, on);
                        let n = points.len();
                        given =
                            Box::new(move |c| AxisMotion::PerPoint(values[c * n..][..n].to_vec()));
                    }
                }
                let along = std::array::from_fn(|c| {
                    let prescribed = axes.get(c).copied().unwrap_or(false);
                    prescribed.then(|| given(c))
                });
                let n = discretisation.cloud.len();
                let motion = PrescribedMotion::along(
                    name,
                    points,
                    kind,
                    along,
                    TimeFunction::Constant,
                    // The simulation adds the initial displacement to prescribed velocities.
                    &vec![0.0; axes.len() * n],
                    n,
                );
                conditions.motions.push(motion.map_err(errors::of_engine)?);
            }
        }
        Ok(())
    }
}

/// A set given by the user numbers of its points.
type NumberedSet = (String, Vec<u32>);

/// Selects a set of points.
fn selected(cloud: &PointCloud, name: &str, numbers: &[u32]) -> Result<Vec<u32>, BuildError> {
    let reject = |reason: String| {
        let path = KeyPath::from("sets").key(name);
        Err(Remark::new(path, Fault::BadDiscretisation { reason }).into())
    };
    if let Some(number) = numbers
        .iter()
        .find(|&&number| number as usize >= cloud.len())
    {
        let points = cloud.len();
        return reject(format!(
            "the set `{name}` has point {number}, but the {points} points are numbered from 0 to {}",
            points - 1
        ));
    }
    if numbers.is_empty() {
        return reject(format!("the set `{name}` has no points"));
    }
    Ok(Selection::of_numbers(cloud, numbers).points)
}

/// Builds points, sets and assembly.
fn built(
    source: &Source,
    listed: Option<&ListedPoints>,
    sets: &[NumberedSet],
) -> PyResult<(Discretisation, Assembled)> {
    let mut kept = None;
    let made = Assembled::made(source, &means(), &mut |_| {}, |resources| {
        let given = |_: &std::path::Path, _: usize, _: u64| Ok(listed.cloned().unwrap_or_default());
        let resources = match listed {
            None => *resources,
            Some(_) => Resources {
                read_points: &given,
                ..*resources
            },
        };
        let mut discretisation = discretise(source.model(), &resources)?;
        for (name, numbers) in sets {
            let points = selected(&discretisation.cloud, name, numbers)?;
            discretisation.sets.push((name.clone(), points));
        }
        kept = Some(discretisation.clone());
        assemble(source.model(), discretisation, &resources)
    });
    let assembled = made.map_err(errors::of_run)?;
    let discretisation = kept.ok_or_else(|| plain("the model has no points"))?;
    Ok((discretisation, assembled))
}

impl Model {
    fn parts(&self, py: Python<'_>) -> PyResult<MutexGuard<'_, Parts>> {
        let locked = self.parts.lock_py_attached(py);
        locked.map_err(|_| plain("a computation with this model panicked"))
    }

    /// Functions for the points of a selection.
    fn functions(
        &self,
        py: Python<'_>,
        functions: Vec<Py<PyAny>>,
        are_rates: bool,
        selection: Selection,
    ) -> PyResult<Arc<Functions>> {
        let dimension = self.cloud.dimension();
        let places = owned(py, selection.positions(&self.cloud), dimension)?;
        // Functions receive rows of consecutive coordinates.
        let places = places.call_method1("copy", ("C",))?;
        Ok(Arc::new(Functions {
            functions,
            are_rates,
            places: places.unbind(),
            selection,
            dimension,
        }))
    }

    fn change(&self, py: Python<'_>, change: impl FnOnce(&mut Parts)) -> PyResult<()> {
        let mut parts = self.parts(py)?;
        change(&mut parts);
        parts.assembled = None;
        Ok(())
    }
}

#[pymethods]
impl Model {
    /// Builds the model of a deck; `points`, `volumes` and `blocks` replace the file of a body of listed points.
    #[new]
    #[pyo3(signature = (deck, points, volumes, blocks, sets))]
    fn new(
        py: Python<'_>,
        deck: &Deck,
        points: Option<PyReadonlyArray2<'_, f64>>,
        volumes: Option<PyReadonlyArray1<'_, f64>>,
        blocks: Option<PyReadonlyArray1<'_, u32>>,
        sets: Vec<NumberedSet>,
    ) -> PyResult<Self> {
        let listed = match (points, volumes, blocks) {
            (Some(points), Some(volumes), Some(blocks)) => {
                let rows = points.as_array();
                let place = |row: numpy::ndarray::ArrayView1<'_, f64>| {
                    std::array::from_fn(|c| row.get(c).copied().unwrap_or(0.0))
                };
                Some(ListedPoints {
                    positions: rows.rows().into_iter().map(place).collect(),
                    volumes: volumes.as_array().to_vec(),
                    blocks: blocks.as_array().to_vec(),
                })
            }
            _ => None,
        };
        let steps = deck.deck().steps();
        if !steps.is_empty() {
            return Err(plain(&format!(
                "the deck has {} steps ([[step]]), which are runs of their own; run it with pericles.run(deck), and open its steps by `result.steps`",
                steps.len()
            )));
        }
        let source = deck.source.clone();
        let (source, (discretisation, assembled)) = waiting(py, move || {
            let made = built(&source, listed.as_ref(), &sets)?;
            Ok((source, made))
        })?;
        let facts = serde_json::to_string(&assembled.facts);
        Ok(Self {
            dt: assembled.assembly.dt,
            cloud: Arc::clone(&discretisation.cloud),
            parts: Mutex::new(Parts {
                discretisation,
                facts: facts.map_err(|error| plain(&error.to_string()))?,
                assembled: Some(assembled),
                additions: Vec::new(),
            }),
            source,
        })
    }

    /// Properties of the model, as JSON.
    fn facts(&self, py: Python<'_>) -> PyResult<String> {
        Ok(self.parts(py)?.facts.clone())
    }

    /// Positions of the points, m.
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let positions = in_user_order(&self.cloud, self.cloud.positions()).into_owned();
        owned(py, positions, self.cloud.dimension())
    }

    /// Volumes of the points, m³.
    fn volumes<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &in_user_order(&self.cloud, self.cloud.volumes()))
    }

    /// Sides of the cells of the points, m: shape (points, dimension). None for surfaces, whose points are vertices.
    fn cell_sides<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let cloud = &self.cloud;
        if self.source.model().body.solid().is_none() {
            return Ok(None);
        }
        let along = |c: usize| {
            let side = move |i: usize| match cloud.cell_sides() {
                Some(sides) => sides[c],
                None => cloud.cell_size(i),
            };
            (0..cloud.len()).map(side)
        };
        let sides: Vec<f64> = (0..cloud.dimension()).flat_map(along).collect();
        let sides = in_user_order(cloud, &sides).into_owned();
        owned(py, sides, cloud.dimension()).map(Some)
    }

    /// Names of the sets.
    fn sets(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let parts = self.parts(py)?;
        let sets = parts.discretisation.sets.iter();
        Ok(sets.map(|(name, _)| name.clone()).collect())
    }

    /// User numbers of the points of a set, ascending.
    fn numbers<'py>(
        &self,
        py: Python<'py>,
        set: &str,
    ) -> PyResult<Option<Bound<'py, PyArray1<u32>>>> {
        let parts = self.parts(py)?;
        let points = parts.discretisation.set(set);
        let numbers = points
            .map(|points| Selection::of_points(&self.cloud, points.clone()).numbers(&self.cloud));
        Ok(numbers.map(|numbers| PyArray1::from_vec(py, numbers)))
    }

    /// Replaces the initial state.
    #[pyo3(signature = (displacement, velocity))]
    fn set_initial(
        &self,
        py: Python<'_>,
        displacement: Option<PyReadonlyArray2<'_, f64>>,
        velocity: Option<PyReadonlyArray2<'_, f64>>,
    ) -> PyResult<()> {
        let ordered = |array: &PyReadonlyArray2<'_, f64>| in_cloud_order(&self.cloud, array);
        let (u, v) = (
            displacement.as_ref().map(ordered),
            velocity.as_ref().map(ordered),
        );
        self.change(py, |parts| {
            let conditions = &mut parts.discretisation.conditions;
            conditions.displacement = u.or(conditions.displacement.take());
            conditions.velocity = v.or(conditions.velocity.take());
        })
    }

    /// Adds a load, constant or a function, N/m³, on points given by user numbers.
    fn add_load(
        &self,
        py: Python<'_>,
        numbers: Vec<u32>,
        density: Option<PyReadonlyArray2<'_, f64>>,
        function: Option<Py<PyAny>>,
    ) -> PyResult<()> {
        let selection = Selection::of_numbers(&self.cloud, &numbers);
        match (density, function) {
            (Some(density), _) => {
                let mut values = selection.ordered(&component_major(&density));
                // All three axes are given, even for bodies of fewer dimensions.
                values.resize(3 * selection.points.len(), 0.0);
                let density = LoadDensity::PerPoint(values);
                let load = Load::new(selection.points, density, TimeFunction::Constant);
                self.change(py, |parts| parts.discretisation.conditions.loads.push(load))
            }
            (None, Some(function)) => {
                let functions = self.functions(py, vec![function], false, selection)?;
                self.change(py, |parts| parts.additions.push(Addition::Load(functions)))
            }
            (None, None) => Err(plain("a load needs values or a function")),
        }
    }

    /// Prescribes the displacement of points given by user numbers along axes: the displacement and its known time
    /// derivatives are functions. If `are_rates`, the first function is the velocity.
    fn add_motion(
        &self,
        py: Python<'_>,
        name: String,
        numbers: Vec<u32>,
        axes: Vec<bool>,
        functions: Vec<Py<PyAny>>,
        are_rates: bool,
    ) -> PyResult<()> {
        let selection = Selection::of_numbers(&self.cloud, &numbers);
        let course = Course::Functions(self.functions(py, functions, are_rates, selection)?);
        let addition = Addition::Motion { name, axes, course };
        self.change(py, |parts| parts.additions.push(addition))
    }

    /// Prescribes constant displacements (m), or velocities (m/s) if `are_rates`, of points given by user numbers along axes.
    fn add_constant_motion(
        &self,
        py: Python<'_>,
        name: String,
        numbers: Vec<u32>,
        axes: Vec<bool>,
        values: PyReadonlyArray2<'_, f64>,
        are_rates: bool,
    ) -> PyResult<()> {
        let selection = Selection::of_numbers(&self.cloud, &numbers);
        let course = Course::Constant {
            kind: match are_rates {
                true => MotionKind::Velocity,
                false => MotionKind::Displacement,
            },
            values: Arc::new(selection.ordered(&component_major(&values))),
            points: selection.points,
        };
        let addition = Addition::Motion { name, axes, course };
        self.change(py, |parts| parts.additions.push(addition))
    }

    /// Makes a simulation: in the folder `out`, in a numbered folder beginning with `stem`, or in memory.
    #[pyo3(signature = (out, stem, force, keep, schedule, amended))]
    #[expect(clippy::too_many_arguments, reason = "called from one place, by name")]
    fn simulation(
        &self,
        py: Python<'_>,
        out: Option<PathBuf>,
        stem: Option<PathBuf>,
        force: bool,
        keep: Vec<String>,
        schedule: (String, f64),
        amended: Vec<String>,
    ) -> PyResult<Simulation> {
        let (trouble, step) = (Trouble::default(), Step::new(self.dt));
        let (assembled, discretisation) = {
            let mut parts = self.parts(py)?;
            let mut discretisation = parts.discretisation.clone();
            for addition in &parts.additions {
                let addition = addition.clone();
                addition.apply(&mut discretisation, (&step, &trouble))?;
            }
            (parts.assembled.take(), discretisation)
        };
        let mut source = self.source.clone();
        if let Source::Deck { text, .. } = &mut source {
            text.amended = amended;
        }
        let schedule = schedule_of(&schedule.0, schedule.1)?;
        waiting(py, move || {
            let assembled = match assembled {
                Some(assembled) => assembled,
                None => {
                    let assemble = |resources: &Resources<'_>| {
                        assemble(source.model(), discretisation, resources)
                    };
                    Assembled::made(&source, &means(), &mut |_| {}, assemble)
                        .map_err(errors::of_run)?
                }
            };
            if let Some(error) = trouble.take() {
                return Err(error);
            }
            step.set(assembled.assembly.dt);
            let folder = match (&out, &stem) {
                (Some(out), _) => Some(OutputFolder::create(out, force)),
                (None, Some(stem)) => Some(OutputFolder::create_numbered(stem)),
                (None, None) => None,
            };
            let folder = folder.transpose().map_err(errors::of_io)?;
            let plan = Plan {
                source: &source,
                keep: &keep,
                schedule,
                trouble: trouble.clone(),
            };
            let simulation = Simulation::of(assembled, folder, plan)?;
            // The initial state has values too.
            trouble.take().map_or(Ok(simulation), Err)
        })
    }
}

/// Returns the schedule of a callback or output.
pub fn schedule_of(kind: &str, value: f64) -> PyResult<Schedule> {
    match kind {
        "steps" if value >= 1.0 => Ok(Schedule::Every(value as u64)),
        "time" if value > 0.0 => Ok(Schedule::Interval(value)),
        "count" if value >= 1.0 => Ok(Schedule::Count(value as u64)),
        "never" => Ok(Schedule::Never),
        _ => Err(plain(&format!(
            "the schedule {kind} = {value} is not positive"
        ))),
    }
}
