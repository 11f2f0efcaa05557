//! `[[impactor]]`: rigid bodies in contact with the body.

use std::path::{Path, PathBuf};

use pericles::boundary::MotionKind;
use serde::{Deserialize, Serialize};

use crate::body::{Rotation, rotation, unit};
use crate::course::{TimeHistory, smooth_function};
use crate::fault::Fault;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::region::direction;
use crate::set::bad_name;

/// A rigid body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Impactor {
    /// Name.
    pub name: String,
    /// Shape.
    pub shape: ImpactorShape,
    /// Position of the centre, a point of the plane of a half-space, or the position of the origin of a file's
    /// coordinates, m.
    pub centre: [f64; 3],
    /// Rotation about the centre of mass.
    #[serde(default)]
    pub rotation: Option<Rotation>,
    /// Mass and motion.
    pub motion: ImpactorMotion,
}

/// The shape of a rigid body, at the origin and without rotation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum ImpactorShape {
    /// A ball; a disc in 2D.
    Ball {
        /// Radius, m.
        radius: f64,
    },
    /// A box; a rectangle in 2D.
    Box {
        /// Edge lengths, m.
        size: [f64; 3],
    },
    /// A cylinder.
    Cylinder {
        /// Radius, m.
        radius: f64,
        /// Height, m.
        height: f64,
        /// Direction of the axis, of any length.
        axis: [f64; 3],
    },
    /// All points on one side of a plane.
    HalfSpace {
        /// Outward normal, of any length.
        normal: [f64; 3],
    },
    /// The interior of a closed triangulated surface.
    Surface {
        /// Path of the file; a relative path starts at the deck's folder.
        #[serde(rename = "file")]
        path: PathBuf,
        /// Unit of length of the file, m.
        unit: f64,
    },
}

/// Mass and motion of a rigid body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum ImpactorMotion {
    /// Moves by the contact forces.
    Free {
        /// Mass.
        inertia: ImpactorInertia,
        /// Initial velocity, m/s.
        velocity: [f64; 3],
        /// Initial angular velocity, rad/s.
        spin: [f64; 3],
    },
    /// Moves as a function of time, without rotation.
    Prescribed {
        /// Whether the amplitude is a displacement or a velocity.
        #[serde(with = "crate::form")]
        kind: MotionKind,
        /// Amplitude, m or m/s.
        amplitude: [f64; 3],
        /// Time function that multiplies the amplitude.
        #[serde(default)]
        function: TimeHistory,
    },
}

/// Mass of a rigid body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum ImpactorInertia {
    /// Mass and moments of inertia of the shape with this density, kg/m³.
    Density(f64),
    /// Mass, kg, and principal moments of inertia about the axes of the shape, kg m²; moments of the shape with this
    /// mass if none.
    Mass {
        /// Mass, kg.
        mass: f64,
        /// Principal moments of inertia, kg m².
        #[serde(default)]
        inertia: Option<[f64; 3]>,
    },
}

impl Impactor {
    /// Returns the path of the file of its shape, if there is one.
    pub fn file(&self) -> Option<&Path> {
        match &self.shape {
            ImpactorShape::Surface { path, .. } => Some(path),
            _ => None,
        }
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Ball,
    Box,
    Cylinder,
    HalfSpace,
    Surface,
}

/// Reads an entry of `[[impactor]]`.
pub(crate) fn read(
    table: Table<'_>,
    dimension: Option<usize>,
    usual: &TimeHistory,
) -> Option<Impactor> {
    const KINDS: [(&str, Kind); 5] = [
        ("ball", Kind::Ball),
        ("box", Kind::Box),
        ("cylinder", Kind::Cylinder),
        ("half-space", Kind::HalfSpace),
        ("surface", Kind::Surface),
    ];
    let name = table.required("name").and_then(|item| {
        let name = item.text()?;
        match bad_name(&name) {
            Some(fault) => {
                item.report(fault());
                None
            }
            None => Some(name),
        }
    });
    let shape_item = table.required("shape");
    let kind = shape_item
        .as_ref()
        .and_then(|item| item.choice("shape", &KINDS));
    let solid = matches!(kind, Some(Kind::Cylinder | Kind::Surface));
    if let (true, Some(item), Some(1 | 2)) = (solid, &shape_item, dimension) {
        let allowed = "\"ball\" (a disc in 2D), \"box\" or \"half-space\"; cylinders and surfaces require a 3D body";
        item.out_of_range(allowed);
        return None;
    }
    let shape = kind.and_then(|kind| shape(&table, kind, dimension));
    let centre = table
        .required("centre")
        .and_then(|item| item.vector(Quantity::Length, dimension));
    let rotation = match (kind, dimension) {
        (Some(Kind::Ball | Kind::HalfSpace), _) | (_, Some(1)) => {
            table.forbid(
                "rotation",
                "it requires a box, cylinder or surface in 2D or 3D",
            );
            Some(None)
        }
        _ => table.maybe("rotation", |item| rotation(item.table()?, dimension, false)),
    };
    let motion = motion(&table, kind, dimension, usual);
    table.finish();
    Some(Impactor {
        name: name?,
        shape: shape?,
        centre: centre?,
        rotation: rotation?,
        motion: motion?,
    })
}

fn shape(table: &Table<'_>, kind: Kind, dimension: Option<usize>) -> Option<ImpactorShape> {
    let length = |key| {
        table
            .required(key)
            .and_then(|item| item.positive(Quantity::Length))
    };
    match kind {
        Kind::Ball => length("radius").map(|radius| ImpactorShape::Ball { radius }),
        Kind::Box => {
            let item = table.required("size")?;
            let size = item.vector(Quantity::Length, dimension)?;
            if size
                .iter()
                .take(dimension.unwrap_or(3))
                .any(|&side| side <= 0.0)
            {
                item.out_of_range("positive edge lengths");
                return None;
            }
            Some(ImpactorShape::Box { size })
        }
        Kind::Cylinder => {
            let (radius, height) = (length("radius"), length("height"));
            let axis = match table.optional("axis") {
                Some(item) => direction(&item, dimension),
                None => {
                    table.record("axis", vec![0.0, 0.0, 1.0]);
                    Some([0.0, 0.0, 1.0])
                }
            };
            Some(ImpactorShape::Cylinder {
                radius: radius?,
                height: height?,
                axis: axis?,
            })
        }
        Kind::HalfSpace => {
            let normal = table.required("normal");
            let normal = normal.and_then(|item| direction(&item, dimension));
            normal.map(|normal| ImpactorShape::HalfSpace { normal })
        }
        Kind::Surface => {
            let path = table.required("file").and_then(|item| item.text());
            let unit = unit(table);
            Some(ImpactorShape::Surface {
                path: path?.into(),
                unit: unit?,
            })
        }
    }
}

fn motion(
    table: &Table<'_>,
    kind: Option<Kind>,
    dimension: Option<usize>,
    usual: &TimeHistory,
) -> Option<ImpactorMotion> {
    const WORDS: [(&str, bool); 2] = [("free", true), ("prescribed", false)];
    let motion = table.optional("motion");
    let free = match (&motion, kind) {
        (Some(item), _) => item.choice("kind of motion", &WORDS),
        (None, Some(Kind::HalfSpace)) => {
            table.record("motion", "prescribed");
            Some(false)
        }
        (None, _) => {
            table.record("motion", "free");
            Some(true)
        }
    };
    let vector = |key, quantity| table.maybe(key, |item| item.vector(quantity, dimension));
    if free? {
        if let (Some(Kind::HalfSpace), Some(item)) = (kind, &motion) {
            item.out_of_range("\"prescribed\": a half-space has no finite mass");
            return None;
        }
        for key in ["displacement", "function"] {
            table.forbid(key, "it requires motion = \"prescribed\"");
        }
        let inertia = inertia(table, dimension);
        let velocity = vector("velocity", Quantity::Velocity);
        let spin = table.maybe("spin", |item| spin(&item, dimension));
        return Some(ImpactorMotion::Free {
            inertia: inertia?,
            velocity: velocity?.unwrap_or_default(),
            spin: spin?.unwrap_or_default(),
        });
    }
    for key in ["density", "mass", "inertia"] {
        table.forbid(
            key,
            "a prescribed motion does not depend on mass; it requires motion = \"free\"",
        );
    }
    table.forbid(
        "spin",
        "an impactor of prescribed motion does not rotate; it requires motion = \"free\"",
    );
    let found = table.at_most_one(&["velocity", "displacement"])?;
    let (function, is_given) = (smooth_function(table), table.has("function"));
    let (kind, amplitude) = match found {
        None => (MotionKind::Displacement, Some([0.0; 3])),
        Some(("velocity", item)) => (
            MotionKind::Velocity,
            item.vector(Quantity::Velocity, dimension),
        ),
        Some((_, item)) => (
            MotionKind::Displacement,
            item.vector(Quantity::Length, dimension),
        ),
    };
    let is_constant = kind == MotionKind::Displacement;
    Some(ImpactorMotion::Prescribed {
        kind,
        amplitude: amplitude?,
        function: match is_constant && !is_given {
            true => usual.clone(),
            false => function?,
        },
    })
}

fn inertia(table: &Table<'_>, dimension: Option<usize>) -> Option<ImpactorInertia> {
    let (key, item) = table.exactly_one(&["density", "mass"])?;
    if key == "density" {
        table.forbid("inertia", "it follows from `density`; it requires `mass`");
        return item
            .positive(Quantity::Density)
            .map(ImpactorInertia::Density);
    }
    let mass = item.positive(Quantity::Mass);
    let moments = table.maybe("inertia", |item| moments(&item, dimension));
    Some(ImpactorInertia::Mass {
        mass: mass?,
        inertia: moments?,
    })
}

/// Reads principal moments of inertia: one about z in 2D, three in 3D.
fn moments(item: &Item<'_>, dimension: Option<usize>) -> Option<[f64; 3]> {
    if let Some(1 | 2) = dimension {
        let about_z = item.positive(Quantity::Inertia)?;
        return Some([about_z; 3]);
    }
    let moments = item.vector(Quantity::Inertia, Some(3))?;
    // No moment of a body exceeds the sum of the two others.
    let sum: f64 = moments.iter().sum();
    let real = |&one: &f64| one > 0.0 && 2.0 * one <= sum * (1.0 + 1e-9);
    if !moments.iter().all(real) {
        item.report(Fault::OutOfRange {
            value: format!("{moments:?}"),
            allowed: "allowed: three positive moments, none larger than the sum of the two others"
                .into(),
        });
        return None;
    }
    Some(moments)
}

/// Reads an angular velocity: about z in 2D, a vector in 3D.
fn spin(item: &Item<'_>, dimension: Option<usize>) -> Option<[f64; 3]> {
    match dimension {
        Some(1) => {
            item.out_of_range("no spin: impactors of a bar do not rotate");
            None
        }
        Some(2) => Some([0.0, 0.0, item.quantity(Quantity::Rate)?]),
        _ => item.vector(Quantity::Rate, Some(3)),
    }
}
