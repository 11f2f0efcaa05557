//! `[body]` of a surface: its shape and the areas of its vertices.

use std::path::PathBuf;

use pericles_manifold::surface::{AreaRule, Surface, SurfaceChecks, SurfaceError};
use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::{Item, Table};

/// Where a surface comes from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SurfaceShape {
    /// Triangles of a file.
    File {
        /// The file; a relative path starts at the folder of the deck.
        #[serde(rename = "file")]
        path: PathBuf,
        /// What is allowed of it.
        #[serde(default, with = "crate::form")]
        checks: SurfaceChecks,
    },
    /// A formula.
    Formula(SurfaceFormula),
}

/// Surfaces that are made by formula.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum SurfaceFormula {
    /// A sphere from an icosahedron whose edges are halved `level` times.
    Icosphere {
        /// Halvings.
        level: u32,
        /// m.
        radius: f64,
    },
    /// A sphere of meridians and parallels.
    UvSphere {
        /// Meridians.
        segments: u32,
        /// Parallels and one more.
        rings: u32,
        /// m.
        radius: f64,
    },
    /// An icosphere stretched along the axes.
    Ellipsoid {
        /// Halvings.
        level: u32,
        /// m.
        half_axes: [f64; 3],
    },
    /// A torus about the z axis.
    Torus {
        /// Radius of the middle line, m.
        major: f64,
        /// Radius of the tube, m.
        minor: f64,
        /// Vertices along the middle line.
        around: u32,
        /// Vertices around the tube.
        across: u32,
    },
    /// A cylinder about the z axis with half spheres at its ends.
    Capsule {
        /// m.
        radius: f64,
        /// Length of the cylinder, m.
        length: f64,
        /// Vertices around it.
        segments: u32,
    },
}

/// The area that a vertex stands for.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VertexAreas {
    /// Shared out from the triangles.
    Rule(#[serde(with = "crate::form")] AreaRule),
    /// The same number for every vertex, m²: not the surface's, but what some papers compute with.
    Same(f64),
}

/// A word of `body.shape` that is a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum SurfaceKind {
    File,
    Icosphere,
    UvSphere,
    Ellipsoid,
    Torus,
    Capsule,
}

impl SurfaceFormula {
    /// How many vertices it will have, about; so many that no surface is made is no error here.
    pub fn vertices(&self) -> f64 {
        match *self {
            Self::Icosphere { level, .. } | Self::Ellipsoid { level, .. } => {
                10.0 * 4f64.powi(level.min(i32::MAX as u32) as i32) + 2.0
            }
            Self::UvSphere {
                segments, rings, ..
            } => f64::from(segments) * f64::from(rings),
            Self::Torus { around, across, .. } => f64::from(around) * f64::from(across),
            Self::Capsule {
                radius,
                length,
                segments,
            } => {
                let segments = f64::from(segments);
                let side = std::f64::consts::TAU * radius / segments;
                segments * (0.5 * segments + length / side)
            }
        }
    }

    /// The surface, its vertices numbered along a space-filling curve.
    ///
    /// # Errors
    /// What [`Surface`]'s makers refuse.
    pub fn surface(&self) -> Result<Surface, SurfaceError> {
        Ok(self.made()?.renumbered())
    }

    /// The surface, its vertices in the order in which they are made.
    fn made(&self) -> Result<Surface, SurfaceError> {
        match *self {
            Self::Icosphere { level, radius } => Surface::icosphere(level, radius),
            Self::UvSphere {
                segments,
                rings,
                radius,
            } => Surface::uv_sphere(segments, rings, radius),
            Self::Ellipsoid { level, half_axes } => Surface::ellipsoid(level, half_axes),
            Self::Torus {
                major,
                minor,
                around,
                across,
            } => Surface::torus(major, minor, around, across),
            Self::Capsule {
                radius,
                length,
                segments,
            } => Surface::capsule(radius, length, segments),
        }
    }

    /// The mean distance of vertices, m. Whether there is memory for the surface is not known here: of a large one the area is that of the smooth surface, which differs by less than a part in
    /// ten thousand.
    ///
    /// # Errors
    /// What [`Surface`]'s makers refuse, if it is not large.
    fn spacing(&self) -> Result<f64, SurfaceError> {
        use std::f64::consts::PI;
        const LARGE: f64 = 2e5;
        /// Of the icosphere whose stretched area stands for that of a smooth ellipsoid.
        const COARSE: u32 = 7;
        /// The finest icosphere.
        const FINEST: u32 = 10;
        let area = match *self {
            // Too fine is refused, not made.
            Self::Icosphere { level, .. } | Self::Ellipsoid { level, .. } if level > FINEST => {
                self.made()?.area()
            }
            _ if self.vertices() <= LARGE => {
                let surface = self.made()?;
                return Ok((surface.area() / surface.len() as f64).sqrt());
            }
            Self::Icosphere { radius, .. } | Self::UvSphere { radius, .. } => {
                4.0 * PI * radius * radius
            }
            Self::Ellipsoid { half_axes, .. } => Surface::ellipsoid(COARSE, half_axes)?.area(),
            Self::Torus { major, minor, .. } => 4.0 * PI * PI * major * minor,
            Self::Capsule { radius, length, .. } => 2.0 * PI * radius * (2.0 * radius + length),
        };
        Ok((area / self.vertices()).sqrt())
    }
}

/// The shape of `[body]`, with the mean distance of its vertices unless it is still to be read from a file.
pub(super) fn shape(table: &Table<'_>, kind: SurfaceKind) -> Option<(SurfaceShape, Option<f64>)> {
    let length = |key| {
        table
            .required(key)
            .and_then(|item| item.positive(Quantity::Length))
    };
    let number = |key| table.required(key).and_then(|item| small_count(&item));
    let shape = match kind {
        SurfaceKind::File => return file(table).map(|shape| (shape, None)),
        SurfaceKind::Icosphere => {
            let (level, radius) = (number("level"), length("radius"));
            SurfaceFormula::Icosphere {
                level: level?,
                radius: radius?,
            }
        }
        SurfaceKind::UvSphere => {
            let (segments, rings, radius) = (number("segments"), number("rings"), length("radius"));
            SurfaceFormula::UvSphere {
                segments: segments?,
                rings: rings?,
                radius: radius?,
            }
        }
        SurfaceKind::Ellipsoid => {
            let level = number("level");
            let half_axes = table.required("half_axes").and_then(|item| {
                let axes = item.components(Some(3), &Quantity::Length.expected())?;
                let lengths: Vec<Option<f64>> = axes
                    .iter()
                    .map(|axis| axis.positive(Quantity::Length))
                    .collect();
                let lengths: Option<Vec<f64>> = lengths.into_iter().collect();
                lengths?.try_into().ok()
            });
            SurfaceFormula::Ellipsoid {
                level: level?,
                half_axes: half_axes?,
            }
        }
        SurfaceKind::Torus => {
            let (major, minor) = (length("major_radius"), length("minor_radius"));
            let (around, across) = (number("around"), number("across"));
            SurfaceFormula::Torus {
                major: major?,
                minor: minor?,
                around: around?,
                across: across?,
            }
        }
        SurfaceKind::Capsule => {
            let (radius, segments) = (length("radius"), number("segments"));
            let length = length("length");
            SurfaceFormula::Capsule {
                radius: radius?,
                length: length?,
                segments: segments?,
            }
        }
    };
    let spacing = table.accept(shape.spacing().map_err(Into::into))?;
    Some((SurfaceShape::Formula(shape), Some(spacing)))
}

fn file(table: &Table<'_>) -> Option<SurfaceShape> {
    let path = table.required("file").and_then(|item| item.text());
    let allow = |key| table.or(key, false, |item| item.boolean());
    let (open, several, flip) = (allow("open"), allow("several"), allow("flip"));
    Some(SurfaceShape::File {
        path: path?.into(),
        checks: SurfaceChecks {
            open: open?,
            several_components: several?,
            flip: flip?,
        },
    })
}

/// A whole number from 1 to a hundred thousand.
fn small_count(item: &Item<'_>) -> Option<u32> {
    const MOST: u64 = 100_000;
    let count = item.count()?;
    if count <= MOST {
        Some(count as u32)
    } else {
        item.out_of_range("a whole number from 1 to 100000");
        None
    }
}

pub(super) fn areas(table: &Table<'_>) -> Option<VertexAreas> {
    const RULES: [(&str, VertexAreas); 2] = [
        ("barycentric", VertexAreas::Rule(AreaRule::Barycentric)),
        ("mixed-voronoi", VertexAreas::Rule(AreaRule::MixedVoronoi)),
    ];
    match table.optional("areas") {
        None => {
            table.record("areas", RULES[0].0);
            Some(RULES[0].1)
        }
        Some(item) => match item.word() {
            Some(word) if !word.contains(|c: char| c.is_ascii_digit()) => {
                item.choice("rule for areas", &RULES)
            }
            _ => item.positive(Quantity::Area).map(VertexAreas::Same),
        },
    }
}
