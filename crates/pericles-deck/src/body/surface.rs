//! `[body]` of a 2-manifold: shape and vertex areas.

use std::path::PathBuf;

use pericles_manifold::surface::{AreaRule, Surface, SurfaceChecks, SurfaceError};
use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::{Item, Table};

/// Source of a triangulated surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SurfaceShape {
    /// Triangles from a file.
    File {
        /// Path of the file; a relative path starts at the deck's folder.
        #[serde(rename = "file")]
        path: PathBuf,
        /// Accepted defects.
        #[serde(default, with = "crate::form")]
        checks: SurfaceChecks,
    },
    /// A parametric surface.
    Formula(SurfaceFormula),
}

/// Parametric surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum SurfaceFormula {
    /// A subdivided icosahedron.
    Icosphere {
        /// Number of subdivisions; each halves all edges.
        level: u32,
        /// Radius, m.
        radius: f64,
    },
    /// A sphere of meridians and parallels.
    UvSphere {
        /// Number of meridians.
        segments: u32,
        /// Number of parallels, without the poles.
        rings: u32,
        /// Radius, m.
        radius: f64,
    },
    /// An icosphere stretched along the axes.
    Ellipsoid {
        /// Number of subdivisions; each halves all edges.
        level: u32,
        /// Half-axes, m.
        half_axes: [f64; 3],
    },
    /// A torus about the z axis.
    Torus {
        /// Radius of the centre line, m.
        major: f64,
        /// Radius of the tube, m.
        minor: f64,
        /// Number of vertices along the centre line.
        major_segments: u32,
        /// Number of vertices around the tube.
        minor_segments: u32,
    },
    /// A cylinder about the z axis with hemispherical caps.
    Capsule {
        /// Radius, m.
        radius: f64,
        /// Length of the cylinder, m.
        length: f64,
        /// Number of vertices around the circumference.
        segments: u32,
    },
}

/// Areas of vertices.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VertexAreas {
    /// Distributed from the triangles.
    Rule(#[serde(with = "crate::form")] AreaRule),
    /// The same area for every vertex, m², as some papers use.
    Same(f64),
}

/// Words of `body.shape` for 2-manifolds.
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
    /// Returns the approximate number of vertices, without checking whether the surface can be made.
    pub fn vertices(&self) -> f64 {
        match *self {
            Self::Icosphere { level, .. } | Self::Ellipsoid { level, .. } => {
                10.0 * 4f64.powi(level.min(i32::MAX as u32) as i32) + 2.0
            }
            Self::UvSphere {
                segments, rings, ..
            } => f64::from(segments) * f64::from(rings),
            Self::Torus {
                major_segments,
                minor_segments,
                ..
            } => f64::from(major_segments) * f64::from(minor_segments),
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

    /// Returns the surface with its vertices numbered along a space-filling curve.
    ///
    /// # Errors
    /// Errors of the constructors of [`Surface`].
    pub fn surface(&self) -> Result<Surface, SurfaceError> {
        Ok(self.made()?.renumbered())
    }

    /// Returns the surface with its vertices in the order of construction.
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
                major_segments,
                minor_segments,
            } => Surface::torus(major, minor, major_segments, minor_segments),
            Self::Capsule {
                radius,
                length,
                segments,
            } => Surface::capsule(radius, length, segments),
        }
    }

    /// Returns the mean distance of vertices, m. Available memory is unknown here, so that large surfaces are
    /// not built: the area of the smooth surface is used, which differs by less than 1e-4.
    ///
    /// # Errors
    /// Errors of the constructors of [`Surface`], unless it is large.
    fn spacing(&self) -> Result<f64, SurfaceError> {
        use std::f64::consts::PI;
        const LARGE: f64 = 2e5;
        /// Level of the icosphere whose stretched area approximates that of a smooth ellipsoid.
        const COARSE: u32 = 7;
        /// The finest icosphere.
        const FINEST: u32 = 10;
        let area = match *self {
            // The constructor rejects surfaces that are too fine.
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

/// Reads the shape of `[body]`, with the mean distance of its vertices unless it comes from a file.
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
            let (major_segments, minor_segments) =
                (number("major_segments"), number("minor_segments"));
            SurfaceFormula::Torus {
                major: major?,
                minor: minor?,
                major_segments: major_segments?,
                minor_segments: minor_segments?,
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

/// Reads a whole number from 1 to 100 000.
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
                item.choice("area rule", &RULES)
            }
            _ => item.positive(Quantity::Area).map(VertexAreas::Same),
        },
    }
}
