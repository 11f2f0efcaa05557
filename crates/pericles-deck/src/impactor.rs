//! `[[impactor]]`: rigid bodies in contact with the body.

use std::path::{Path, PathBuf};

use pericles::boundary::MotionKind;
use pericles_deck_derive::{DeckKeys, DeckTable};
use serde::{Deserialize, Serialize};

use crate::body::{self, Rotation, RotationScope};
use crate::course::{self, TimeHistory};
use crate::declaration::{Check, Spatial};
use crate::fault::Fault;
use crate::key_path::KeyPath;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::region;
use crate::scope::{Scope, name};

/// A rigid body in contact with the body: a projectile, indenter or wall. Its motion follows from the contact forces or
/// is prescribed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = Scope<'s>, unique("name", "impactor"))]
pub struct Impactor {
    /// Name of the impactor, used in `impactors.csv` and file names.
    #[deck(with = name)]
    pub name: String,
    /// Shape.
    #[deck(flatten)]
    pub shape: ImpactorShape,
    /// Position of the centre. Half-space: a point of the plane. Surface: position of the origin of the file's
    /// coordinates.
    ///
    /// In m.
    #[deck(quantity = Length)]
    pub centre: [f64; 3],
    /// Initial rotation about the centre of mass.
    #[serde(default)]
    #[deck(
        scope = RotationScope::of_impactor(scope.dimension),
        forbid_if(has_no_rotation(shape, scope), "it requires a box, cylinder or surface in 2D or 3D")
    )]
    pub rotation: Option<Rotation>,
    /// Mass and motion.
    #[deck(flatten, scope = MotionScope::new(shape, scope))]
    pub motion: ImpactorMotion,
}

/// Shape: `ball` (a disc in 2D), `box`, `cylinder`, `half-space` (a plane wall), or `surface` (a closed triangulated
/// surface from a file).
///
/// At the origin and without rotation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[deck(tag = "shape", what = "shape", scope = Scope<'s>)]
pub enum ImpactorShape {
    /// A ball; a disc in 2D.
    Ball {
        /// Ball, cylinder: radius.
        ///
        /// In m.
        #[deck(quantity = Length, range = POSITIVE)]
        radius: f64,
    },
    /// A box; a rectangle in 2D.
    Box {
        /// Box: edge lengths.
        ///
        /// In m.
        #[deck(quantity = Length, range = POSITIVE.described("positive edge lengths"))]
        size: [f64; 3],
    },
    /// A cylinder.
    #[deck(allow_if(is_spatial(scope), SHAPES))]
    Cylinder {
        /// Ball, cylinder: radius.
        ///
        /// In m.
        #[deck(quantity = Length, range = POSITIVE)]
        radius: f64,
        /// Cylinder: height.
        ///
        /// In m.
        #[deck(quantity = Length, range = POSITIVE)]
        height: f64,
        /// Cylinder: direction of the axis, of any length.
        #[deck(with = direction, default = [0.0, 0.0, 1.0])]
        axis: [f64; 3],
    },
    /// All points on one side of a plane.
    HalfSpace {
        /// Half-space: outward normal, of any length.
        #[deck(with = direction, check = check_normal)]
        normal: [f64; 3],
    },
    /// The interior of a closed triangulated surface.
    #[deck(allow_if(is_spatial(scope), SHAPES))]
    Surface {
        /// Surface: OBJ, PLY, STL, OFF, Gmsh, VTU or VTP file of a closed surface; a relative path starts at the deck's
        /// folder.
        #[serde(rename = "file")]
        #[deck(key = "file")]
        path: PathBuf,
        /// Surface: unit of length of the coordinates, such as "mm". Required for shape = "surface".
        ///
        /// In m.
        #[deck(with = body::unit_of, check = body::check_unit)]
        unit: f64,
    },
}

/// `free`: the contact forces move the impactor. `prescribed`: it moves as given by `velocity` or `displacement` times
/// `function`, without rotation. Default for half-spaces: `prescribed`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[deck(
    tag = "motion",
    what = "kind of motion",
    scope = MotionScope<'s>,
    default = usual_motion(scope)
)]
pub enum ImpactorMotion {
    /// Moves by the contact forces.
    #[deck(allow_if(scope.is_half_space != Some(true), "\"prescribed\": a half-space has no finite mass"))]
    Free {
        /// Mass.
        #[deck(
            flatten,
            otherwise = "a prescribed motion does not depend on mass; it requires motion = \"free\""
        )]
        inertia: ImpactorInertia,
        /// Initial velocity of a free impactor; velocity of a prescribed motion, multiplied by `function`.
        ///
        /// In m/s.
        #[deck(quantity = Velocity, default = [0.0; 3])]
        velocity: [f64; 3],
        /// Initial angular velocity of a free impactor: a vector, in 2D a number. "1 rad/s" or a plain number in 1/s.
        ///
        /// In rad/s.
        #[deck(
            flatten,
            key = "spin",
            with = spin,
            otherwise = "an impactor of prescribed motion does not rotate; it requires motion = \"free\""
        )]
        spin: [f64; 3],
    },
    /// Moves as a function of time, without rotation.
    Prescribed {
        /// Whether the amplitude is a displacement or a velocity.
        #[serde(with = "crate::form")]
        #[deck(flatten, keys("velocity", "displacement"), with = motion_kind)]
        kind: MotionKind,
        /// Amplitude, m or m/s.
        #[deck(flatten, keys("velocity", "displacement"), with = amplitude, scope = (kind, scope))]
        amplitude: [f64; 3],
        /// Time function of a prescribed motion. Default: g = 1; in static schemes, a displacement grows linearly from
        /// zero at t = 0 to its value at `end`.
        #[serde(default)]
        #[deck(flatten, key = "function", with = function, scope = (kind, scope))]
        function: TimeHistory,
    },
}

/// Mass of a rigid body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[deck(exclusive, scope = MotionScope<'s>)]
pub enum ImpactorInertia {
    /// Free impactors: density, from which mass and moments of inertia follow. In 2D multiplied by the thickness, in 1D by
    /// the area.
    ///
    /// In kg/m³.
    Density(#[deck(quantity = Density, range = POSITIVE)] f64),
    /// Mass and principal moments of inertia.
    Mass {
        /// Free impactors: mass, instead of the density.
        ///
        /// In kg.
        #[deck(quantity = Mass, range = POSITIVE)]
        mass: f64,
        /// Free impactors with a mass: principal moments of inertia about the axes of the shape; in 2D the moment about z.
        /// Default: moments of the shape with this mass.
        ///
        /// In kg m².
        #[serde(default)]
        #[deck(with = moments, otherwise = "it follows from `density`; it requires `mass`")]
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

/// Scope of the motion.
#[derive(Clone, Copy)]
struct MotionScope<'s> {
    deck: Scope<'s>,
    /// None if the shape is invalid.
    is_half_space: Option<bool>,
}

impl<'s> MotionScope<'s> {
    fn new(shape: Option<&ImpactorShape>, deck: Scope<'s>) -> Self {
        Self {
            deck,
            is_half_space: shape.map(|shape| matches!(shape, ImpactorShape::HalfSpace { .. })),
        }
    }
}

impl Spatial for MotionScope<'_> {
    fn dimension(&self) -> Option<usize> {
        self.deck.dimension
    }
}

fn usual_motion(scope: MotionScope<'_>) -> Option<&'static str> {
    scope
        .is_half_space
        .map(|is_half_space| match is_half_space {
            true => "prescribed",
            false => "free",
        })
}

/// Shapes of bars and plane bodies.
const SHAPES: &str =
    "\"ball\" (a disc in 2D), \"box\" or \"half-space\"; cylinders and surfaces require a 3D body";

fn is_spatial(scope: Scope<'_>) -> bool {
    !matches!(scope.dimension, Some(1 | 2))
}

fn has_no_rotation(shape: Option<&ImpactorShape>, scope: Scope<'_>) -> bool {
    use ImpactorShape::{Ball, HalfSpace};
    scope.dimension == Some(1) || matches!(shape, Some(Ball { .. } | HalfSpace { .. }))
}

fn direction(item: &Item<'_>, scope: Scope<'_>) -> Option<[f64; 3]> {
    region::direction(item, scope.dimension)
}

fn check_normal(normal: &[f64; 3], path: &KeyPath, _: Scope<'_>, check: &mut Check) {
    let right = normal.iter().any(|&x| x != 0.0);
    let allowed = "allowed: a nonzero vector";
    check.within(right, path.key("normal"), "zero", allowed);
}

/// Reads which of the keys of a prescribed motion is given.
fn motion_kind(table: &Table<'_>, _: MotionScope<'_>) -> Option<MotionKind> {
    table.describe(
        "displacement",
        "Displacement of a prescribed motion, multiplied by `function`.",
    );
    Some(match table.at_most_one(&["velocity", "displacement"])? {
        Some(("velocity", _)) => MotionKind::Velocity,
        _ => MotionKind::Displacement,
    })
}

/// Reads the amplitude of a prescribed motion; zero if it is missing.
fn amplitude(
    table: &Table<'_>,
    (kind, scope): (Option<&MotionKind>, MotionScope<'_>),
) -> Option<[f64; 3]> {
    let (key, quantity) = match kind? {
        MotionKind::Velocity => ("velocity", Quantity::Velocity),
        MotionKind::Displacement => ("displacement", Quantity::Length),
    };
    match table.optional(key) {
        Some(item) => item.vector(quantity, scope.deck.dimension),
        None => Some([0.0; 3]),
    }
}

fn function(
    table: &Table<'_>,
    (kind, scope): (Option<&MotionKind>, MotionScope<'_>),
) -> Option<TimeHistory> {
    let (function, is_given) = (
        course::function(table, table.has("displacement")),
        table.has("function"),
    );
    match kind == Some(&MotionKind::Displacement) && !is_given {
        true => Some(scope.deck.usual.clone()),
        false => function,
    }
}

/// Reads principal moments of inertia: one about z in 2D, three in 3D.
fn moments(item: &Item<'_>, scope: MotionScope<'_>) -> Option<[f64; 3]> {
    if let Some(1 | 2) = scope.deck.dimension {
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
fn spin(table: &Table<'_>, scope: MotionScope<'_>) -> Option<[f64; 3]> {
    let Some(item) = table.optional("spin") else {
        return Some([0.0; 3]);
    };
    match scope.deck.dimension {
        Some(1) => {
            item.out_of_range("no spin: impactors of a bar do not rotate");
            None
        }
        Some(2) => Some([0.0, 0.0, item.quantity(Quantity::Rate)?]),
        _ => item.vector(Quantity::Rate, Some(3)),
    }
}
