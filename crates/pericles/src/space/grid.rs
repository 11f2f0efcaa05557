//! Regular cell-centred grids.

use super::cell_count::{CELL_LIMIT, fitting_spacings, whole_cells};
use super::{Lattice, LatticeBody, Point, PointCloud, Region};
use crate::error::{PericlesError, Result, positive};

/// Outline of a body made of cells.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A box of dimension `size.len()` (bar, plate, block) from its lower corner `origin`.
    Box {
        /// Lower corner, m.
        origin: Point,
        /// Sides, m; one to three of them.
        size: Vec<f64>,
    },
    /// A disc in the plane.
    Disc {
        /// Centre, m.
        centre: Point,
        /// Radius, m.
        radius: f64,
    },
    /// A solid circular cylinder; with a hole, a tube.
    Cylinder {
        /// Centre of the lower base, m.
        base: Point,
        /// Coordinate axis along which it extends: 0, 1 or 2.
        axis: usize,
        /// Radius, m.
        radius: f64,
        /// Height along the axis, m.
        height: f64,
    },
    /// A ball (3D).
    Ball {
        /// Centre, m.
        centre: Point,
        /// Radius, m.
        radius: f64,
    },
}

/// A body made of the cubic cells of a regular grid whose centres lie inside a shape and outside its holes.
///
/// ```
/// use pericles::space::{Grid, Shape};
/// let disc = Grid {
///     shape: Shape::Disc { centre: [0.0; 3], radius: 0.1 },
///     spacing: 0.01,
///     section: 1.0,
///     holes: vec![],
/// };
/// let area: f64 = disc.points()?.volumes().iter().sum();
/// assert!((area / (std::f64::consts::PI * 0.01) - 1.0).abs() < 0.02);
/// let plate = Grid::plate([0.1, 0.04], 0.01, 1.0).points()?;
/// assert_eq!(plate.len(), 40);
/// assert_eq!(plate.point(0), [0.005, 0.005, 0.0]);
/// # Ok::<(), pericles::PericlesError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// Outline of the body.
    pub shape: Shape,
    /// Cell size Δx, m.
    pub spacing: f64,
    /// Cross-section of a bar (m²), thickness of a plate (m), 1 in 3D.
    pub section: f64,
    /// Regions without material.
    pub holes: Vec<Region>,
}

impl Grid {
    /// A bar from x = 0 to `length` (m) with cells of size `spacing` (m) and cross-section `area` (m²).
    pub fn bar(length: f64, spacing: f64, area: f64) -> Self {
        Self::from_origin(vec![length], spacing, area)
    }

    /// A rectangular plate with a corner at the origin: `sides`, `spacing` and `thickness` in m.
    pub fn plate(sides: [f64; 2], spacing: f64, thickness: f64) -> Self {
        Self::from_origin(sides.into(), spacing, thickness)
    }

    /// A block with a corner at the origin: `sides` and `spacing` in m.
    pub fn block(sides: [f64; 3], spacing: f64) -> Self {
        Self::from_origin(sides.into(), spacing, 1.0)
    }

    fn from_origin(size: Vec<f64>, spacing: f64, section: f64) -> Self {
        Self {
            shape: Shape::Box {
                origin: [0.0; 3],
                size,
            },
            spacing,
            section,
            holes: Vec::new(),
        }
    }

    /// Dimension of the body.
    pub fn dimension(&self) -> usize {
        match &self.shape {
            Shape::Box { size, .. } => size.len(),
            Shape::Disc { .. } => 2,
            Shape::Cylinder { .. } | Shape::Ball { .. } => 3,
        }
    }

    /// Returns lower corner, sides, and whether each side must be a whole number of cells.
    fn frame(&self) -> Result<(Point, [f64; 3], [bool; 3])> {
        let centred = |centre: &Point, radius: f64, dimension: usize| {
            let mut corner = [0.0; 3];
            let mut side = [0.0; 3];
            for c in 0..dimension {
                corner[c] = centre[c] - radius;
                side[c] = 2.0 * radius;
            }
            (corner, side)
        };
        match &self.shape {
            Shape::Box { origin, size } => {
                let mut side = [0.0; 3];
                for (c, &length) in size.iter().enumerate().take(3) {
                    side[c] = positive("a side of the body", length)?;
                }
                Ok((*origin, side, [true; 3]))
            }
            Shape::Disc { centre, radius } => {
                let (corner, side) =
                    centred(centre, positive("the radius of the disc", *radius)?, 2);
                Ok((corner, side, [false; 3]))
            }
            Shape::Ball { centre, radius } => {
                let (corner, side) =
                    centred(centre, positive("the radius of the ball", *radius)?, 3);
                Ok((corner, side, [false; 3]))
            }
            Shape::Cylinder {
                base,
                axis,
                radius,
                height,
            } => {
                if *axis > 2 {
                    return Err(PericlesError::OutOfRange {
                        quantity: "the axis of the cylinder",
                        value: *axis as f64,
                        allowed: "0, 1 or 2",
                    });
                }
                let radius = positive("the radius of the cylinder", *radius)?;
                let (mut corner, mut side) = centred(base, radius, 3);
                corner[*axis] = base[*axis];
                side[*axis] = positive("the height of the cylinder", *height)?;
                let mut whole = [false; 3];
                whole[*axis] = true;
                Ok((corner, side, whole))
            }
        }
    }

    /// Bounding box of the body: lower and upper corner, m.
    ///
    /// # Errors
    /// The errors of [`Grid::points`], except for a body without points.
    pub fn bounds(&self) -> Result<[Point; 2]> {
        Ok(self.cells()?.bounds)
    }

    /// Returns a test whether a position (m) belongs to the body: inside the shape and outside its holes.
    ///
    /// # Errors
    /// The errors of [`Grid::points`], except for a body without points.
    pub fn inside(&self) -> Result<impl Fn(Point) -> bool + Sync + '_> {
        let cells = self.cells()?;
        Ok(move |place: Point| {
            let [low, high] = cells.bounds;
            let in_box = (0..cells.dimension).all(|c| (low[c]..=high[c]).contains(&place[c]));
            in_box && cells.holds(place)
        })
    }

    /// Makes the point cloud, x fastest.
    ///
    /// # Errors
    /// Lengths that are not positive; sides that are not whole numbers of cells; too many cells; no points.
    pub fn points(&self) -> Result<PointCloud> {
        Ok(self.body()?.points())
    }

    /// Returns the body whose points are the centres of the cells.
    ///
    /// # Errors
    /// The errors of [`Grid::points`].
    pub fn body(&self) -> Result<LatticeBody<'_>> {
        let cells = self.cells()?;
        let origin = cells.origin;
        let lattice = Lattice {
            spacing: [self.spacing; 3],
            shape: cells.shape,
            node: Vec::new(),
        };
        let holds: Option<Box<dyn Fn(u32) -> bool + Sync>> = match cells.is_full() {
            true => None,
            false => {
                let frame = lattice.clone();
                Some(Box::new(move |node| {
                    cells.holds(cells.centre(frame.coordinates(node)))
                }))
            }
        };
        LatticeBody::new(self.dimension(), origin, lattice, self.section, holds)
    }

    /// Returns the cells of the bounding box and a test which of them belong to the body.
    pub(super) fn cells(&self) -> Result<Cells<'_>> {
        let spacing = positive("the spacing", self.spacing)?;
        let dimension = self.dimension();
        if !(1..=3).contains(&dimension) {
            return Err(PericlesError::WrongDimension {
                what: "a box with this number of sides",
                needed: "1, 2 or 3",
                dimension,
            });
        }
        let (corner, side, whole) = self.frame()?;
        let mut shape = [1usize; 3];
        let mut origin = [0.0; 3];
        let mut cells = 1.0;
        for c in 0..dimension {
            let count = if whole[c] {
                whole_cells(side[c], spacing).map_err(|error| match error {
                    // The spacing must fit all sides, not one alone.
                    PericlesError::NotWholeCells {
                        length,
                        spacing,
                        below,
                        above,
                        ..
                    } => {
                        let sides = (0..dimension).filter(|&c| whole[c]).map(|c| side[c]);
                        PericlesError::NotWholeCells {
                            length,
                            spacing,
                            below,
                            above,
                            fitting: fitting_spacings(&sides.collect::<Vec<_>>(), spacing),
                        }
                    }
                    other => other,
                })?
            } else {
                (side[c] / spacing - 1e-9).ceil().max(1.0)
            };
            cells *= count;
            if cells > CELL_LIMIT as f64 {
                return Err(PericlesError::TooManyPoints {
                    cells,
                    limit: CELL_LIMIT,
                });
            }
            shape[c] = count as usize;
            // Round bodies are centred on their bounding box, so that the cells share the symmetry of the body.
            let slack = 0.5 * (side[c] - count * spacing);
            origin[c] = corner[c] + slack + 0.5 * spacing;
        }
        let mut end = corner;
        for c in 0..dimension {
            end[c] += side[c];
        }
        let bounds = [corner, end];
        let outline = self.outline();
        let simple = outline == Region::All && self.holes.is_empty();
        Ok(Cells {
            dimension,
            spacing,
            shape,
            origin,
            bounds,
            outline: (!simple).then_some(outline),
            holes: &self.holes,
            tolerance: 1e-9 * spacing,
        })
    }

    fn outline(&self) -> Region {
        match &self.shape {
            Shape::Box { .. } => Region::All,
            Shape::Disc { centre, radius } | Shape::Ball { centre, radius } => Region::Ball {
                centre: *centre,
                radius: *radius,
            },
            Shape::Cylinder {
                base, axis, radius, ..
            } => Region::Cylinder {
                centre: *base,
                axis: *axis,
                radius: *radius,
            },
        }
    }
}

/// The cells of the bounding box of a grid.
pub(super) struct Cells<'a> {
    pub(super) dimension: usize,
    pub(super) spacing: f64,
    /// Cells along each axis.
    pub(super) shape: [usize; 3],
    /// Centre of the first cell.
    pub(super) origin: Point,
    pub(super) bounds: [Point; 2],
    /// `None` if every cell belongs to the body.
    outline: Option<Region>,
    holes: &'a [Region],
    tolerance: f64,
}

impl Cells<'_> {
    /// Returns whether every cell belongs to the body.
    pub(super) fn is_full(&self) -> bool {
        self.outline.is_none()
    }

    /// Centre of a cell, m.
    pub(super) fn centre(&self, cell: [i32; 3]) -> Point {
        std::array::from_fn(|c| {
            if c < self.dimension {
                self.origin[c] + f64::from(cell[c]) * self.spacing
            } else {
                0.0
            }
        })
    }

    /// Returns whether a position belongs to the body.
    pub(super) fn holds(&self, place: Point) -> bool {
        let inside = |region: &Region| self.is_in(region, place);
        match &self.outline {
            None => true,
            Some(outline) => inside(outline) && !self.holes.iter().any(inside),
        }
    }

    /// Returns whether a position lies in the shape, ignoring holes.
    pub(super) fn is_in_outline(&self, place: Point) -> bool {
        let outline = self.outline.as_ref();
        outline.is_none_or(|outline| self.is_in(outline, place))
    }

    /// Returns whether a position lies in a region.
    pub(super) fn is_in(&self, region: &Region, place: Point) -> bool {
        region.contains(place, &self.bounds, self.tolerance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn volume_of_round_bodies_converges() {
        let disc = |spacing| Grid {
            shape: Shape::Disc {
                centre: [1.0, 2.0, 0.0],
                radius: 1.0,
            },
            spacing,
            section: 0.5,
            holes: vec![Region::Ball {
                centre: [1.0, 2.0, 0.0],
                radius: 0.5,
            }],
        };
        let volume: f64 = disc(0.01).points().unwrap().volumes().iter().sum();
        let exact = 0.5 * std::f64::consts::PI * 0.75;
        assert!((volume / exact - 1.0).abs() < 2e-3, "{volume} {exact}");
    }

    #[test]
    fn cylinder_is_symmetric_about_its_axis() {
        let cylinder = Grid {
            shape: Shape::Cylinder {
                base: [0.0, 0.0, -1.0],
                axis: 2,
                radius: 0.37,
                height: 2.0,
            },
            spacing: 0.1,
            section: 1.0,
            holes: vec![],
        };
        let points = cylinder.points().unwrap();
        for c in 0..3 {
            let mean = points.axis(c).iter().sum::<f64>() / points.len() as f64;
            assert!(mean.abs() < 1e-12, "axis {c}: {mean}");
        }
        assert_eq!(points.len() % 20, 0);
    }

    #[test]
    fn sides_must_be_whole_numbers_of_cells() {
        let grid = |side| Grid {
            shape: Shape::Box {
                origin: [0.0; 3],
                size: vec![side],
            },
            spacing: 0.3,
            section: 1.0,
            holes: vec![],
        };
        assert_eq!(grid(0.9).points().unwrap().len(), 3);
        let error = grid(1.0).points().unwrap_err();
        assert!(matches!(error, PericlesError::NotWholeCells { .. }));
        let message = error.to_string();
        assert!(
            message.contains("spacings that divide all sides: 250 mm and 333.3333 mm"),
            "{message}"
        );
        assert!(grid(f64::NAN).points().is_err());
        assert!(grid(1e30).points().is_err());
    }

    #[test]
    fn positions_belong_to_the_body_where_its_cells_do() {
        let ring = Grid {
            shape: Shape::Disc {
                centre: [1.0, 2.0, 0.0],
                radius: 1.0,
            },
            spacing: 0.1,
            section: 1.0,
            holes: vec![Region::Ball {
                centre: [1.0, 2.0, 0.0],
                radius: 0.5,
            }],
        };
        assert_eq!(ring.bounds().unwrap(), [[0.0, 1.0, 0.0], [2.0, 3.0, 0.0]]);
        let points = ring.points().unwrap();
        let inside = ring.inside().unwrap();
        assert!((0..points.len()).all(|i| inside(points.point(i))) && !inside([1.0, 2.0, 0.0]));
        let plate = Grid::plate([1.0, 0.5], 0.1, 1.0);
        let inside = plate.inside().unwrap();
        assert!(inside([0.99, 0.01, 0.0]) && !inside([0.5, 0.51, 0.0]));
    }

    #[test]
    fn a_hole_that_covers_the_body_is_rejected() {
        let grid = Grid {
            shape: Shape::Box {
                origin: [0.0; 3],
                size: vec![1.0, 1.0],
            },
            spacing: 0.5,
            section: 1.0,
            holes: vec![Region::All],
        };
        assert!(matches!(grid.points(), Err(PericlesError::EmptyBody)));
    }
}
