//! `[body]` of a 2-manifold: shape and vertex areas.

use std::path::PathBuf;

use pericles_deck_derive::{DeckKeys, DeckTable};
use pericles_manifold::surface::{AreaRule, Surface, SurfaceChecks, SurfaceError};
use serde::{Deserialize, Serialize};

use crate::form::described;
use crate::quantity::Quantity;
use crate::range::{Range, count_to};
use crate::reader::Table;
use crate::region::Frame;

/// Source of a triangulated surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum SurfaceShape {
    /// Triangles from a file.
    File(SurfaceFile),
    /// A parametric surface.
    Formula(SurfaceFormula),
}

/// A triangulated surface in a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
pub struct SurfaceFile {
    /// Surface: OBJ, PLY, STL, OFF, Gmsh, VTU or VTP.
    #[serde(rename = "file")]
    #[deck(key = "file")]
    pub path: PathBuf,
    /// Accepted defects.
    #[serde(default, with = "crate::form")]
    #[deck(flatten)]
    pub checks: SurfaceChecks,
}

/// Accepted defects of a surface.
#[derive(Serialize, Deserialize, DeckTable)]
#[serde(remote = "SurfaceChecks", deny_unknown_fields)]
#[deck(remote = SurfaceChecks)]
struct SurfaceChecksForm {
    /// Surface: accept boundary edges (edges with one triangle).
    #[deck(default = false)]
    open: bool,
    /// Surface: accept several connected components.
    #[serde(rename = "several")]
    #[deck(key = "several", default = false)]
    several_components: bool,
    /// Surface: fix inconsistent triangle orientation.
    #[deck(default = false)]
    flip: bool,
}

described!(SurfaceChecks: SurfaceChecksForm);

/// Triangulated 2-manifolds whose vertices are the points: `icosphere`, `uv-sphere`, `ellipsoid`, `torus`, `capsule`, and
/// `surface` (read from a file).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
#[deck(tag = "shape", what = "shape", scope = Frame)]
pub enum SurfaceFormula {
    /// A subdivided icosahedron.
    Icosphere {
        /// Icosphere, ellipsoid: number of subdivisions of the icosahedron; each halves all edges.
        #[deck(range = NUMBERS)]
        level: u32,
        /// Sphere, capsule: radius.
        ///
        /// In m.
        #[deck(quantity = Length, range = POSITIVE)]
        radius: f64,
    },
    /// A sphere of meridians and parallels.
    UvSphere {
        /// UV-sphere: number of meridians, the vertices per parallel.
        #[deck(range = NUMBERS)]
        segments: u32,
        /// UV-sphere: number of parallels (circles of latitude), without the poles.
        #[deck(range = NUMBERS)]
        rings: u32,
        /// Sphere, capsule: radius.
        ///
        /// In m.
        #[deck(quantity = Length, range = POSITIVE)]
        radius: f64,
    },
    /// An icosphere stretched along the axes.
    Ellipsoid {
        /// Icosphere, ellipsoid: number of subdivisions of the icosahedron; each halves all edges.
        #[deck(range = NUMBERS)]
        level: u32,
        /// Ellipsoid: half-axes.
        ///
        /// In m.
        #[deck(quantity = Length, range = POSITIVE)]
        half_axes: [f64; 3],
    },
    /// A torus about the z axis.
    Torus {
        /// Torus: radius of the centre line.
        ///
        /// In m.
        #[deck(key = "major_radius", quantity = Length, range = POSITIVE)]
        major: f64,
        /// Torus: radius of the tube.
        ///
        /// In m.
        #[deck(key = "minor_radius", quantity = Length, range = POSITIVE)]
        minor: f64,
        /// Torus: number of vertices along the centre line.
        #[deck(range = NUMBERS)]
        major_segments: u32,
        /// Torus: number of vertices around the tube.
        #[deck(range = NUMBERS)]
        minor_segments: u32,
    },
    /// A cylinder about the z axis with hemispherical caps.
    Capsule {
        /// Sphere, capsule: radius.
        ///
        /// In m.
        #[deck(quantity = Length, range = POSITIVE)]
        radius: f64,
        /// Capsule: length of its cylindrical part.
        ///
        /// In m.
        #[deck(quantity = Length, range = POSITIVE)]
        length: f64,
        /// Capsule: number of vertices around its circumference.
        #[deck(range = NUMBERS)]
        segments: u32,
    },
}

const NUMBERS: Range = count_to(100_000);

/// Areas of vertices.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum VertexAreas {
    /// Distributed from the triangles.
    Rule(#[serde(with = "crate::form")] AreaRule),
    /// The same area for every vertex, m², as some papers use.
    Same(f64),
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

/// Returns a surface with the mean distance of its vertices, unless it comes from a file.
pub(super) fn with_spacing(
    table: &Table<'_>,
    shape: SurfaceShape,
) -> Option<(SurfaceShape, Option<f64>)> {
    let spacing = match &shape {
        SurfaceShape::File(_) => None,
        SurfaceShape::Formula(formula) => {
            Some(table.accept(formula.spacing().map_err(Into::into))?)
        }
    };
    Some((shape, spacing))
}

const AREAS: &str = "2-manifolds: how triangle areas are distributed to vertices, or one area for all vertices. `barycentric`: a third to each corner; `mixed-voronoi`: Voronoi areas, modified in obtuse triangles (Meyer et al. 2003).";

/// Reads the areas of the vertices.
pub(super) fn areas(table: &Table<'_>) -> Option<VertexAreas> {
    const RULES: [(&str, VertexAreas); 2] = [
        ("barycentric", VertexAreas::Rule(AreaRule::Barycentric)),
        ("mixed-voronoi", VertexAreas::Rule(AreaRule::MixedVoronoi)),
    ];
    table.describe("areas", AREAS);
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
