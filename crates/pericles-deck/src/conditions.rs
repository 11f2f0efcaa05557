//! `[[initial]]`, `[[prescribe]]`, `[[load]]` and `[[probe]]`: what is done to the body, and where it is watched.

use std::path::PathBuf;

use pericles::boundary::MotionKind;
use pericles::space::Point;
use serde::{Deserialize, Serialize};

use crate::component::{Component, Variables, VectorField, component, vector_field};
use crate::course::{TimeHistory, function, smooth_function};
use crate::fault::Fault;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::set::{self, SetNames};
use crate::vocabulary::LOADS;

/// An initial displacement or velocity, or both.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Initial {
    /// The set.
    pub set: String,
    /// Displacement, m.
    #[serde(default)]
    pub displacement: Option<VectorField>,
    /// Velocity, m/s.
    #[serde(default)]
    pub velocity: Option<VectorField>,
    /// A file with displacement and velocity of all points, in place of both; a relative path starts at the folder of the deck.
    #[serde(default)]
    pub file: Option<PathBuf>,
    /// Random velocities, added to that.
    #[serde(default)]
    pub random_velocity: Option<RandomVelocity>,
}

/// Velocities uniform in a ball, one after the other in the user's order of points, by the generator SplitMix64.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RandomVelocity {
    /// Radius of the ball, m/s.
    pub radius: f64,
    /// Seed.
    pub seed: u64,
}

/// A prescribed motion.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Prescribe {
    /// The set.
    pub set: String,
    /// Displacement or velocity.
    #[serde(with = "crate::form")]
    pub kind: MotionKind,
    /// Amplitude along each axis, m or m/s; none where the motion is free.
    pub amplitude: [Option<Component>; 3],
    /// The course over time.
    #[serde(default)]
    pub function: TimeHistory,
    /// The last time at which the points are held, s; none if they are held for good.
    #[serde(default)]
    pub until: Option<f64>,
}

impl Prescribe {
    /// Whether anything but rest is prescribed.
    pub fn moves(&self) -> bool {
        let mut amplitudes = self.amplitude.iter().flatten();
        amplitudes.any(|amplitude| amplitude.number() != Some(0.0))
    }
}

/// A load.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Load {
    /// The set.
    pub set: String,
    /// Its amplitude.
    pub amplitude: LoadAmplitude,
    /// The course over time.
    #[serde(default)]
    pub function: TimeHistory,
    /// From when it acts, s; none if it acts from the start.
    #[serde(default)]
    pub from: Option<f64>,
    /// Until when it acts, s; none if it acts to the end.
    #[serde(default)]
    pub until: Option<f64>,
}

impl Load {
    /// From when to when it acts, s.
    pub fn window(&self) -> [f64; 2] {
        [
            self.from.unwrap_or(f64::NEG_INFINITY),
            self.until.unwrap_or(f64::INFINITY),
        ]
    }
}

/// How a load is given.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum LoadAmplitude {
    /// Force per volume, N/m³.
    BodyForce(VectorField),
    /// Force per area, Pa, spread over the volume of the set.
    Traction {
        /// The traction.
        traction: VectorField,
        /// The area it acts on, m²; if none, that of the face of the set's bounding box normal to the load.
        #[serde(default)]
        area: Option<f64>,
    },
    /// Force per area against the outward normal of faces, Pa: of a face set of a mesh, or of the face of a layer.
    Pressure(Component),
}

impl LoadAmplitude {
    /// The numbers and expressions that it is given by: three of a vector, one of a pressure.
    pub fn components(&self) -> &[Component] {
        match self {
            Self::BodyForce(field)
            | Self::Traction {
                traction: field, ..
            } => field,
            Self::Pressure(pressure) => std::slice::from_ref(pressure),
        }
    }
}

/// A place whose motion is written to the history.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Probe {
    /// Its name in the table.
    pub name: String,
    /// The place.
    pub place: ProbePlace,
}

/// What a probe follows.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
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
    let variables = Variables {
        dimension,
        time: false,
    };
    let file = table.maybe("file", |item| item.text());
    let vector = |key, quantity| {
        if matches!(file, Some(None)) {
            table.maybe(key, |item| vector_field(&item, quantity, variables))
        } else {
            table.forbid(
                key,
                "`file` gives both displacement and velocity; give either `file` or these",
            );
            Some(None)
        }
    };
    let displacement = vector("displacement", Quantity::Length);
    let velocity = vector("velocity", Quantity::Velocity);
    let random_velocity = table.maybe("random_velocity", |item| random(item.table()?));
    if let (Some(None), Some(None), Some(None), Some(None)) =
        (&displacement, &velocity, &random_velocity, &file)
    {
        table.lacks_one_of(&["displacement", "velocity", "random_velocity", "file"]);
    }
    table.finish();
    Some(Initial {
        set: set?,
        displacement: displacement?,
        velocity: velocity?,
        file: file?.map(PathBuf::from),
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
    let function = smooth_function(&table);
    let until = table.maybe("until", |item| item.positive(Quantity::Time));
    table.finish();
    let (kind, amplitude) = motion?;
    Some(Prescribe {
        set: set?,
        kind,
        amplitude,
        function: function?,
        until: until?,
    })
}

/// Components of which some may be free.
fn amplitude(
    item: &Item<'_>,
    quantity: Quantity,
    dimension: Option<usize>,
) -> Option<[Option<Component>; 3]> {
    let variables = Variables {
        dimension,
        time: true,
    };
    let expected = format!("{}, or \"free\"", quantity.expected());
    let items = item.components(dimension, &expected)?;
    let mut amplitude = Some([None, None, None]);
    let mut free = 0;
    for (c, entry) in items.iter().enumerate() {
        if entry.is_keyword("free") {
            free += 1;
            continue;
        }
        match (component(entry, quantity, variables), &mut amplitude) {
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
        if key == "pressure" {
            let variables = Variables {
                dimension,
                time: false,
            };
            let pressure = component(&item, Quantity::Traction, variables)?;
            return Some(LoadAmplitude::Pressure(pressure));
        }
        let quantity = if key == "traction" {
            Quantity::Traction
        } else {
            Quantity::ForceDensity
        };
        let variables = Variables {
            dimension,
            time: true,
        };
        let field = vector_field(&item, quantity, variables)?;
        Some(match key {
            "traction" => LoadAmplitude::Traction {
                traction: field,
                area: None,
            },
            _ => LoadAmplitude::BodyForce(field),
        })
    });
    let area = if table.has("traction") {
        table.maybe("area", |item| item.positive(Quantity::Area))
    } else {
        table.forbid("area", "only a `traction` acts on an area");
        Some(None)
    };
    let function = function(&table);
    let window = window(&table);
    table.finish();
    let amplitude = match force? {
        LoadAmplitude::Traction { traction, .. } => LoadAmplitude::Traction {
            traction,
            area: area?,
        },
        other => other,
    };
    let [from, until] = window?;
    Some(Load {
        set: set?,
        amplitude,
        function: function?,
        from,
        until,
    })
}

/// From when to when something acts.
fn window(table: &Table<'_>) -> Option<[Option<f64>; 2]> {
    let from = table.maybe("from", |item| item.quantity(Quantity::Time));
    let until = table.maybe("until", |item| {
        let time = item.quantity(Quantity::Time)?;
        match from {
            Some(Some(from)) if time <= from => {
                item.out_of_range("a time later than `from`");
                None
            }
            _ => Some(time),
        }
    });
    Some([from?, until?])
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
