//! Cells of a grid: spacing, holes, refined parts, positions of points.

use pericles::space::{Finer, Grid, Point, Region, Shape};
use pericles_deck_derive::DeckTable;
use serde::{Deserialize, Serialize};

use super::plane::section;
use super::positions::{Positions, Quadrature};
use super::types::Lattice;
use crate::declaration::Check;
use crate::form::described;
use crate::key_path::KeyPath;
use crate::quantity::Quantity;
use crate::range::POSITIVE;
use crate::reader::{Item, Table};
use crate::region::Frame;

/// Scope of the cells of a shape.
#[derive(Clone, Copy)]
pub(super) struct CellScope {
    pub(super) dimension: usize,
    /// Whether the body is a bar, plate or block.
    pub(super) is_box: bool,
}

/// Cells of a bar, plate, disc, block, cylinder or ball.
#[derive(DeckTable)]
#[deck(scope = CellScope, verify = fit)]
pub(super) struct GivenCells {
    /// Grid spacing Δx. Plates and blocks accept one value per axis; `horizon_ratio` then refers to the largest.
    #[deck(required, with = spacings, check = check_spacings)]
    spacing: Vec<f64>,
    #[deck(flatten, with = section, keys("area", "thickness"), scope = Some(scope.dimension))]
    section: f64,
    /// Regions without material. Any number of tables.
    #[deck(key = "hole", scope = frame(scope, spacing))]
    holes: Vec<Region>,
    #[deck(
        key = "refine",
        scope = frame(scope, spacing),
        forbid_if(is_uneven(spacing), "refinement requires equal spacings along all axes")
    )]
    finer: Vec<Finer>,
    #[deck(flatten)]
    positions: Positions,
    /// Bar, plate, block without holes: periodic boundary conditions along all axes.
    #[deck(
        default = false,
        forbid_if(
            !scope.is_box || !are_whole(holes, finer, positions),
            "periodicity requires a bar, plate or block with one cell size and without holes"
        )
    )]
    periodic: bool,
    /// Bar: one point at the centre of each cell (`midpoint`) or its two Gauss nodes (`gauss`).
    #[deck(
        default,
        forbid_if(
            scope.dimension != 1 || !are_whole(holes, finer, positions) || periodic == Some(&true),
            "Gauss nodes require a bar that is not periodic and has no holes"
        )
    )]
    quadrature: Quadrature,
}

impl GivenCells {
    /// Returns the lattice in a shape from which a bore is cut.
    pub(super) fn lattice(self, shape: Shape, bore: Option<Region>) -> Lattice {
        let mut holes = self.holes;
        holes.extend(bore);
        let largest = self.spacing.iter().copied().fold(0.0, f64::max);
        Lattice {
            grid: Grid {
                shape,
                spacing: largest,
                section: self.section,
                holes,
            },
            finer: self.finer,
            periodic: self.periodic,
            quadrature: self.quadrature,
            rectangular: Some(self.spacing).filter(|spacing| is_uneven(Some(spacing))),
            positions: self.positions,
        }
    }

    /// Returns the cells of a lattice.
    pub(super) fn of(lattice: &Lattice) -> Self {
        let even = || vec![lattice.grid.spacing];
        Self {
            spacing: lattice.rectangular.clone().unwrap_or_else(even),
            section: lattice.grid.section,
            holes: lattice.grid.holes.clone(),
            finer: lattice.finer.clone(),
            positions: lattice.positions,
            periodic: lattice.periodic,
            quadrature: lattice.quadrature,
        }
    }
}

/// Returns whether the spacings along the axes differ.
fn is_uneven(spacing: Option<&Vec<f64>>) -> bool {
    spacing.is_some_and(|spacing| spacing.iter().any(|dx| *dx != spacing[0]))
}

/// Returns whether all cells are whole and have one point at the same place.
fn are_whole(
    holes: Option<&Vec<Region>>,
    finer: Option<&Vec<Finer>>,
    positions: Option<&Positions>,
) -> bool {
    holes.is_none_or(Vec::is_empty)
        && finer.is_none_or(Vec::is_empty)
        && !positions.is_some_and(Positions::are_random)
}

/// Rejects random positions in cells of several sizes.
fn fit(table: &Table<'_>, cells: &GivenCells, _: CellScope) -> Option<()> {
    if cells.positions.are_random() && is_uneven(Some(&cells.spacing)) {
        table.forbid(
            "positions",
            "random positions require equal spacings along all axes",
        );
    }
    if cells.positions.are_random() && !cells.finer.is_empty() {
        table.forbid("refine", "refinement requires positions = \"lattice\"");
    }
    Some(())
}

/// Returns the reference of holes and refined parts.
fn frame(scope: CellScope, spacing: Option<&Vec<f64>>) -> Frame {
    Frame {
        spacing: spacing.map(|all| all.iter().copied().fold(0.0, f64::max)),
        cells: !is_uneven(spacing),
        mesh: false,
        ..Frame::of_model(scope.dimension)
    }
}

/// Reads one spacing, or one per axis of a plate or block.
fn spacings(item: &Item<'_>, scope: CellScope) -> Option<Vec<f64>> {
    if !item.is_list() {
        return item.positive(Quantity::Length).map(|dx| vec![dx]);
    }
    if scope.dimension == 1 || !scope.is_box {
        item.out_of_range("one length; only plates and blocks have one spacing per axis");
        return None;
    }
    let entries = item.exactly(scope.dimension, "a length, or one length per axis")?;
    let lengths: Vec<Option<f64>> = entries
        .iter()
        .map(|entry| entry.positive(Quantity::Length))
        .collect();
    lengths.into_iter().collect()
}

fn check_spacings(spacing: &[f64], path: &KeyPath, scope: CellScope, check: &mut Check) {
    let path = path.key("spacing");
    let axes = if scope.is_box { scope.dimension } else { 1 };
    let allowed = "allowed: one spacing, or one per axis of a plate or block";
    check.within(
        [1, axes].contains(&spacing.len()),
        path.clone(),
        spacing.len(),
        allowed,
    );
    for (k, dx) in spacing.iter().enumerate() {
        let path = if spacing.len() == 1 {
            path.clone()
        } else {
            path.index(k)
        };
        check.number(path, *dx, POSITIVE);
    }
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Grid", deny_unknown_fields)]
struct GridForm {
    #[serde(with = "crate::form")]
    shape: Shape,
    spacing: f64,
    section: f64,
    #[serde(rename = "hole", with = "crate::form")]
    holes: Vec<Region>,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Shape", rename_all = "snake_case", deny_unknown_fields)]
enum ShapeForm {
    Box {
        origin: Point,
        size: Vec<f64>,
    },
    Disc {
        centre: Point,
        radius: f64,
    },
    Cylinder {
        base: Point,
        axis: usize,
        radius: f64,
        height: f64,
    },
    Ball {
        centre: Point,
        radius: f64,
    },
}

described!(Grid: GridForm, Shape: ShapeForm);
