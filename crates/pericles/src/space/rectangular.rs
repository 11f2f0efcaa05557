//! Boxes of cells with anisotropic spacing.

use super::cell_count::{CELL_LIMIT, whole_cells};
use super::{Lattice, LatticeBody, Point, PointCloud, Region};
use crate::error::{PericlesError, Result};

/// Makes the cloud of equal cells with the given spacing along each axis (m) that fill a box, starting at its lower
/// corner, without the cells whose centre lies in a hole; x fastest.
///
/// Volume corrections use the size of the cube of equal volume.
///
/// # Errors
/// Sides that are not whole numbers of cells; arrays of different lengths; no cell outside the holes.
pub fn rectangular_cells(
    origin: Point,
    size: &[f64],
    spacing: &[f64],
    section: f64,
    holes: &[Region],
) -> Result<PointCloud> {
    Ok(rectangular_body(origin, size, spacing, section, holes)?.points())
}

/// Returns the body whose points are the centres of the cells of [`rectangular_cells`].
///
/// # Errors
/// The errors of [`rectangular_cells`].
pub fn rectangular_body<'a>(
    origin: Point,
    size: &[f64],
    spacing: &'a [f64],
    section: f64,
    holes: &'a [Region],
) -> Result<LatticeBody<'a>> {
    let cells = BoxOfCells::new(origin, size, spacing)?;
    let first = cells.centre(0);
    let lattice = Lattice {
        node: Vec::new(),
        shape: cells.shape,
        spacing: std::array::from_fn(|c| spacing.get(c).copied().unwrap_or(spacing[0])),
    };
    let holds: Option<Box<dyn Fn(u32) -> bool + Sync>> = match holes.is_empty() {
        true => None,
        false => Some(Box::new(move |node| {
            let place = cells.centre(node as usize);
            !holes.iter().any(|hole| cells.is_in(hole, place))
        })),
    };
    LatticeBody::new(size.len(), first, lattice, section, holds)
}

/// Returns the indices of the holes that contain no cell centre and thus remove nothing.
///
/// # Errors
/// The errors of [`rectangular_cells`].
pub fn idle_holes(
    origin: Point,
    size: &[f64],
    spacing: &[f64],
    holes: &[Region],
) -> Result<Vec<usize>> {
    let cells = BoxOfCells::new(origin, size, spacing)?;
    let mut idle: Vec<usize> = (0..holes.len()).collect();
    for place in cells.centres() {
        if idle.is_empty() {
            break;
        }
        idle.retain(|&k| !cells.is_in(&holes[k], place));
    }
    Ok(idle)
}

/// Equal cells that fill a box.
struct BoxOfCells<'a> {
    origin: Point,
    spacing: &'a [f64],
    shape: [usize; 3],
    bounds: [Point; 2],
}

impl<'a> BoxOfCells<'a> {
    fn new(origin: Point, size: &[f64], spacing: &'a [f64]) -> Result<Self> {
        let dimension = size.len();
        if !(1..=3).contains(&dimension) || spacing.len() != dimension {
            return Err(PericlesError::WrongDimension {
                what: "a box with this number of sides and a spacing for each",
                needed: "1, 2 or 3",
                dimension: spacing.len(),
            });
        }
        let mut shape = [1usize; 3];
        let mut cells = 1.0;
        for c in 0..dimension {
            let count = whole_cells(size[c], spacing[c])?;
            cells *= count;
            if cells > CELL_LIMIT as f64 {
                return Err(PericlesError::TooManyPoints {
                    cells,
                    limit: CELL_LIMIT,
                });
            }
            shape[c] = count as usize;
        }
        let mut end = [0.0; 3];
        for c in 0..dimension {
            end[c] = origin[c] + size[c];
        }
        Ok(Self {
            origin,
            spacing,
            shape,
            bounds: [origin, end],
        })
    }

    /// Centres of the cells, x fastest.
    fn centres(&self) -> impl Iterator<Item = Point> + '_ {
        (0..self.shape.iter().product()).map(|cell| self.centre(cell))
    }

    fn centre(&self, cell: usize) -> Point {
        let row = cell / self.shape[0];
        let steps = [
            cell % self.shape[0],
            row % self.shape[1],
            row / self.shape[1],
        ];
        std::array::from_fn(|c| match self.spacing.get(c) {
            Some(dx) => self.origin[c] + (steps[c] as f64 + 0.5) * dx,
            None => 0.0,
        })
    }

    fn is_in(&self, region: &Region, place: Point) -> bool {
        let least = self.spacing.iter().copied().fold(f64::INFINITY, f64::min);
        region.contains(place, &self.bounds, 1e-9 * least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{Grid, Shape};

    #[test]
    fn equal_spacings_reproduce_the_points_of_a_grid() {
        let (origin, size) = ([0.5, -1.0, 0.0], [1.2, 0.8, 0.6]);
        let hole = Region::Ball {
            centre: [1.0, -0.6, 0.2],
            radius: 0.25,
        };
        for dimension in 1..=3 {
            let holes = vec![hole.clone()];
            let grid = Grid {
                shape: Shape::Box {
                    origin,
                    size: size[..dimension].to_vec(),
                },
                spacing: 0.2,
                section: 0.7,
                holes: holes.clone(),
            };
            let (a, b) = (
                grid.points().unwrap(),
                rectangular_cells(
                    origin,
                    &size[..dimension],
                    &[0.2; 3][..dimension],
                    0.7,
                    &holes,
                )
                .unwrap(),
            );
            assert_eq!(a.len(), b.len());
            for i in 0..a.len() {
                for c in 0..3 {
                    assert!((a.point(i)[c] - b.point(i)[c]).abs() < 1e-14);
                }
                assert!((a.volumes()[i] / b.volumes()[i] - 1.0).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn every_axis_has_its_own_spacing() {
        let cloud = rectangular_cells([0.0; 3], &[1.0, 1.0], &[0.25, 0.1], 2.0, &[]).unwrap();
        assert_eq!(cloud.len(), 40);
        let lattice = cloud.lattice().unwrap();
        assert_eq!(
            (lattice.spacing[..2].to_vec(), lattice.is_cubic(2)),
            (vec![0.25, 0.1], false)
        );
        assert!((cloud.volumes()[0] - 0.05).abs() < 1e-16);
        assert!((cloud.spacing() - 0.025f64.sqrt()).abs() < 1e-15);
        assert_eq!(cloud.cell_sides(), Some(&[0.25, 0.1][..]));
        // The box filled by the cells.
        let [low, high] = cloud.bounds();
        for c in 0..2 {
            assert!(low[c].abs() < 1e-15 && (high[c] - 1.0).abs() < 1e-15);
        }
        assert!((cloud.point(5)[0] - 0.375).abs() < 1e-15);
        assert!((cloud.point(5)[1] - 0.15).abs() < 1e-15);
        assert!(rectangular_cells([0.0; 3], &[1.0, 1.0], &[0.25, 0.3], 1.0, &[]).is_err());
    }
}
