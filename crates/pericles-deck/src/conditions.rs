//! `[[initial]]`, `[[prescribe]]`, `[[load]]` and `[[probe]]`: what is done to the body, and where it is watched.

use pericles::boundary::{MotionKind, TimeFunction};
use pericles::space::Point;

use crate::fault::Fault;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::set::{self, SetNames};
use crate::vocabulary::LOADS;

/// An initial displacement or velocity, or both.
#[derive(Debug, Clone, PartialEq)]
pub struct Initial {
    /// The set.
    pub set: String,
    /// Displacement, m.
    pub displacement: Option<Point>,
    /// Velocity, m/s.
    pub velocity: Option<Point>,
    /// Random velocities, added to that.
    pub random_velocity: Option<RandomVelocity>,
}

/// Velocities uniform in a ball, one after the other in the user's order of points, by the generator SplitMix64.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RandomVelocity {
    /// Radius of the ball, m/s.
    pub radius: f64,
    /// Seed.
    pub seed: u64,
}

/// A prescribed motion.
#[derive(Debug, Clone, PartialEq)]
pub struct Prescribe {
    /// The set.
    pub set: String,
    /// Displacement or velocity.
    pub kind: MotionKind,
    /// Amplitude along each axis, m or m/s; none where the motion is free.
    pub amplitude: [Option<f64>; 3],
    /// The course over time.
    pub function: TimeFunction,
}

/// A load.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// The set.
    pub set: String,
    /// Its amplitude.
    pub amplitude: LoadAmplitude,
    /// The course over time.
    pub function: TimeFunction,
}

/// How a load is given.
#[derive(Debug, Clone, PartialEq)]
pub enum LoadAmplitude {
    /// Force per volume, N/m³.
    BodyForce(Point),
    /// Force per area, Pa, spread over the volume of the set.
    Traction {
        /// The traction.
        traction: Point,
        /// The area it acts on, m²; if none, that of the face of the set's bounding box normal to the load.
        area: Option<f64>,
    },
}

/// A place whose motion is written to the history.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    /// Its name in the table.
    pub name: String,
    /// The place.
    pub place: ProbePlace,
}

/// What a probe follows.
#[derive(Debug, Clone, PartialEq)]
pub enum ProbePlace {
    /// The point nearest to a place, m.
    At(Point),
    /// The mean over a set.
    Set(String),
}

pub(crate) fn initial(
    table: Table<'_>,
    dimension: Option<usize>,
    sets: &SetNames,
) -> Option<Initial> {
    let set = table.or("set", set::ALL.to_owned(), |item| sets.reference(&item));
    let displacement = table.maybe("displacement", |item| {
        item.vector(Quantity::Length, dimension)
    });
    let velocity = table.maybe("velocity", |item| {
        item.vector(Quantity::Velocity, dimension)
    });
    let random_velocity = table.maybe("random_velocity", |item| random(item.table()?));
    if (displacement, velocity, random_velocity) == (Some(None), Some(None), Some(None)) {
        table.lacks_one_of(&["displacement", "velocity", "random_velocity"]);
    }
    table.finish();
    Some(Initial {
        set: set?,
        displacement: displacement?,
        velocity: velocity?,
        random_velocity: random_velocity?,
    })
}

fn random(table: Table<'_>) -> Option<RandomVelocity> {
    table.choice_or_first("generator", "generator", &[("splitmix64", ())]);
    let radius = table
        .required("radius")
        .and_then(|item| item.positive(Quantity::Velocity));
    let seed = table.or("seed", 1, |item| item.count());
    table.finish();
    Some(RandomVelocity {
        radius: radius?,
        seed: seed?,
    })
}

pub(crate) fn prescribe(
    table: Table<'_>,
    dimension: Option<usize>,
    sets: &SetNames,
) -> Option<Prescribe> {
    let set = table.required("set").and_then(|item| sets.reference(&item));
    let motion = table
        .exactly_one(&["velocity", "displacement"])
        .and_then(|(key, item)| {
            let (kind, quantity) = if key == "velocity" {
                (MotionKind::Velocity, Quantity::Velocity)
            } else {
                (MotionKind::Displacement, Quantity::Length)
            };
            Some((kind, amplitude(&item, quantity, dimension)?))
        });
    let function = function(&table);
    table.finish();
    let (kind, amplitude) = motion?;
    Some(Prescribe {
        set: set?,
        kind,
        amplitude,
        function: function?,
    })
}

/// Components of which some may be free.
fn amplitude(
    item: &Item<'_>,
    quantity: Quantity,
    dimension: Option<usize>,
) -> Option<[Option<f64>; 3]> {
    let expected = format!("{}, or \"free\"", quantity.expected());
    let items = item.components(dimension, &expected)?;
    let mut amplitude = Some([None; 3]);
    let mut free = 0;
    for (c, entry) in items.iter().enumerate() {
        if entry.word() == Some("free") {
            entry.record("free");
            free += 1;
            continue;
        }
        match (entry.quantity(quantity), &mut amplitude) {
            (Some(value), Some(amplitude)) => amplitude[c] = Some(value),
            _ => amplitude = None,
        }
    }
    if free == items.len() {
        item.report(Fault::NothingPrescribed);
        return None;
    }
    amplitude
}

pub(crate) fn load(table: Table<'_>, dimension: Option<usize>, sets: &SetNames) -> Option<Load> {
    let set = table.required("set").and_then(|item| sets.reference(&item));
    let force = table.exactly_one(LOADS).and_then(|(key, item)| {
        let quantity = if key == "traction" {
            Quantity::Traction
        } else {
            Quantity::ForceDensity
        };
        Some((key, item.vector(quantity, dimension)?))
    });
    let area = if table.has("traction") {
        table.maybe("area", |item| item.positive(Quantity::Area))
    } else {
        table.forbid("area", "only a `traction` acts on an area");
        Some(None)
    };
    let function = function(&table);
    table.finish();
    let amplitude = match force? {
        ("traction", traction) => LoadAmplitude::Traction {
            traction,
            area: area?,
        },
        (_, density) => LoadAmplitude::BodyForce(density),
    };
    Some(Load {
        set: set?,
        amplitude,
        function: function?,
    })
}

#[derive(Clone, Copy)]
enum Course {
    Constant,
    Ramp,
    Pulse,
}

fn function(table: &Table<'_>) -> Option<TimeFunction> {
    const COURSES: [(&str, Course); 3] = [
        ("constant", Course::Constant),
        ("ramp", Course::Ramp),
        ("pulse", Course::Pulse),
    ];
    let table = table.table_or_empty("function")?;
    let course = table.choice_or_first("kind", "function of time", &COURSES)?;
    let function = match course {
        Course::Constant => Some(TimeFunction::Constant),
        Course::Ramp | Course::Pulse => {
            let start = table.or("start", 0.0, |item| item.quantity(Quantity::Time));
            let duration = table
                .required("duration")
                .and_then(|item| item.positive(Quantity::Time));
            let (start, duration) = (start?, duration?);
            Some(match course {
                Course::Ramp => TimeFunction::Ramp { start, duration },
                _ => TimeFunction::Pulse { start, duration },
            })
        }
    };
    table.finish();
    function
}

/// All probes; their names must differ.
pub(crate) fn probes(
    tables: Vec<Table<'_>>,
    dimension: Option<usize>,
    sets: &SetNames,
) -> Option<Vec<Probe>> {
    let mut names: Vec<String> = Vec::new();
    let probes: Vec<Option<Probe>> = tables
        .into_iter()
        .map(|table| {
            let name = table.required("name").and_then(|item| {
                let name = item.text()?;
                let fault = set::bad_name(&name).map(|fault| fault()).or_else(|| {
                    names.contains(&name).then(|| Fault::BadName {
                        name: name.clone(),
                        reason: "another probe has it",
                        allowed: "allowed: a name of its own for each probe",
                    })
                });
                names.push(name.clone());
                match fault {
                    Some(fault) => {
                        item.report(fault);
                        None
                    }
                    None => Some(name),
                }
            });
            let place = table
                .exactly_one(&["at", "set"])
                .and_then(|(key, item)| match key {
                    "at" => Some(ProbePlace::At(item.vector(Quantity::Length, dimension)?)),
                    _ => Some(ProbePlace::Set(sets.reference(&item)?)),
                });
            table.finish();
            Some(Probe {
                name: name?,
                place: place?,
            })
        })
        .collect();
    probes.into_iter().collect()
}
