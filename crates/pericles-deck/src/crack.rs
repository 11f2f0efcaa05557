//! `[[crack]]`: pre-cracks, which cut bonds before the run.

use std::path::{Path, PathBuf};

use pericles::family::{Crack, EndRule};
use pericles::space::Point;
use pericles_deck_derive::{DeckKeys, DeckTable};
use serde::{Deserialize, Serialize};

use crate::body::{check_unit, unit_of};
use crate::declaration::Spatial;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};
use crate::region::{self, Frame};
use crate::set::SetNames;

/// Pre-cracks: bonds that cross them are removed before the run and do not count as damage by default. Any number of
/// tables.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckTable)]
#[serde(deny_unknown_fields)]
#[deck(scope = CrackScope<'s>, verify = require_cutter)]
pub struct PreCrack {
    /// The surface.
    #[deck(flatten)]
    pub surface: CrackSurface,
    /// Bonds through the edge of the crack are cut (`closed`) or kept (`open`).
    #[serde(default, with = "crate::form")]
    #[deck(
        default,
        forbid_if(
            matches!(surface, Some(CrackSurface::Layer(_))),
            "bonds with an end in the `layer` always remain"
        ),
        forbid_if(
            matches!(surface, Some(CrackSurface::File { .. })),
            "a crack from a `file` always includes its edges"
        )
    )]
    pub ends: EndRule,
}

/// The surface of a pre-crack.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "snake_case")]
#[deck(exclusive, scope = CrackScope<'s>)]
pub enum CrackSurface {
    /// Bar: position of the cut.
    ///
    /// In m.
    #[deck(allow_if(scope.fits(1), "`section` requires a bar (1D)"))]
    Section(#[deck(with = section)] f64),
    /// 2D: end points of a straight crack.
    ///
    /// In m.
    #[deck(allow_if(scope.fits(2), "`segment` requires a 2D body"))]
    Segment(#[deck(with = segment)] [[f64; 2]; 2]),
    /// 3D: corners of a planar polygon.
    ///
    /// In m.
    #[deck(allow_if(scope.fits(3), "`polygon` requires a 3D body"))]
    Polygon(#[deck(with = polygon)] Vec<Point>),
    /// 3D: circular crack.
    #[deck(table, allow_if(scope.fits(3), "`disc` requires a 3D body"))]
    Disc {
        /// Centre.
        ///
        /// In m.
        #[deck(quantity = Length)]
        centre: Point,
        /// Normal vector, of any length.
        #[deck(with = direction)]
        normal: Point,
        /// Radius.
        ///
        /// In m.
        #[deck(quantity = Length, range = POSITIVE)]
        radius: f64,
    },
    /// Triangles from a file.
    #[deck(allow_if(scope.fits(3), "`file` requires a 3D body"))]
    File {
        /// 3D: file of triangles (STL, OBJ, PLY, OFF, Gmsh, VTU, VTP) that cut every bond they meet, edges included. A
        /// relative path starts at the deck's folder.
        #[serde(rename = "file")]
        path: PathBuf,
        /// Unit of length of the file's coordinates, such as "mm".
        ///
        /// In m.
        #[deck(with = unit_of, check = check_unit)]
        unit: f64,
    },
    /// Name of a set: bonds between points outside of this layer do not cross it, while bonds with an end in it remain. For
    /// layers thinner than the horizon, such as adhesives, which bonds would bridge otherwise.
    Layer(#[deck(with = set_name)] String),
}

impl CrackSurface {
    /// Returns the crack of the engine; files (path, unit) and layers (name of the set) are read by functions.
    ///
    /// # Errors
    /// Those of the functions.
    pub fn crack<E>(
        &self,
        of_file: impl FnOnce(&Path, f64) -> Result<Crack, E>,
        of_layer: impl FnOnce(&str) -> Result<Crack, E>,
    ) -> Result<Crack, E> {
        Ok(match self {
            &Self::Section(x) => Crack::Section { x },
            &Self::Segment([from, to]) => Crack::Segment { from, to },
            Self::Polygon(corners) => Crack::Polygon {
                corners: corners.clone(),
            },
            &Self::Disc {
                centre,
                normal,
                radius,
            } => Crack::Disc {
                centre,
                normal,
                radius,
            },
            Self::File { path, unit } => return of_file(path, *unit),
            Self::Layer(set) => return of_layer(set),
        })
    }

    /// Returns the path of the file, if there is one.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::File { path, .. } => Some(path),
            _ => None,
        }
    }
}

/// Scope of pre-cracks.
#[derive(Clone, Copy)]
pub(crate) struct CrackScope<'s> {
    pub(crate) frame: Frame,
    pub(crate) sets: &'s SetNames,
}

impl CrackScope<'_> {
    /// Returns whether a body, if its dimension is known, has this dimension.
    fn fits(self, dimension: usize) -> bool {
        self.frame.dimension.is_none_or(|own| own == dimension)
    }
}

impl Spatial for CrackScope<'_> {
    fn dimension(&self) -> Option<usize> {
        self.frame.dimension
    }
}

/// Requires a surface that cuts bonds.
fn require_cutter(table: &Table<'_>, crack: &PreCrack, scope: CrackScope<'_>) -> Option<()> {
    let plane = crack.surface.crack(|_, _| Err(()), |_| Err(()));
    if let (Ok(plane), Some(spacing)) = (plane, scope.frame.spacing) {
        // The tolerance must be the one with which bonds are cut.
        table.accept(plane.cutter(crack.ends, 1e-9 * spacing))?;
    }
    Some(())
}

fn section<S>(item: &Item<'_>, _: S) -> Option<f64> {
    Some(item.vector(Quantity::Length, Some(1))?[0])
}

fn segment<S>(item: &Item<'_>, _: S) -> Option<[[f64; 2]; 2]> {
    let ends = item.exactly(2, "two points [[x, y], [x, y]]")?;
    let [from, to] = [&ends[0], &ends[1]].map(|end| end.vector(Quantity::Length, Some(2)));
    Some([from?, to?].map(|[x, y, _]| [x, y]))
}

fn polygon<S>(item: &Item<'_>, _: S) -> Option<Vec<Point>> {
    region::corners(item, Some(3))
}

fn direction<S>(item: &Item<'_>, _: S) -> Option<Point> {
    region::direction(item, Some(3))
}

fn set_name(item: &Item<'_>, scope: CrackScope<'_>) -> Option<String> {
    scope.sets.reference(item)
}
