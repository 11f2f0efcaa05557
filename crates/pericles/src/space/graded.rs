//! Graded grids: grids with smaller cells in some regions.
//!
//! The division of cells does not depend on the body: refined grids and refined filled shapes use the same code.

use super::grid::Cells;
use super::{Grid, Point, PointCloud, Region};
use crate::error::{PericlesError, Result};

/// A region with smaller cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Finer {
    /// Region; cells whose centres lie in it are divided.
    pub region: Region,
    /// Number of small cells per large cell along each axis, at least two.
    pub ratio: u32,
}

/// A regular grid of which some cells are divided into smaller ones.
///
/// ```
/// use pericles::space::{Finer, GradedGrid, Grid, Region, Shape};
/// let bar = Grid {
///     shape: Shape::Box { origin: [0.0; 3], size: vec![1.0] },
///     spacing: 0.1,
///     section: 1.0,
///     holes: vec![],
/// };
/// let end = Region::Box { min: [0.8, f64::NEG_INFINITY, f64::NEG_INFINITY], max: [f64::INFINITY; 3] };
/// let graded = GradedGrid { grid: bar, finer: vec![Finer { region: end, ratio: 3 }] };
/// let points = graded.points().unwrap();
/// assert_eq!(points.cloud.len(), 8 + 6);
/// assert_eq!(points.ratios, [1, 3]);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct GradedGrid {
    /// The grid of large cells.
    pub grid: Grid,
    /// Regions with smaller cells; later ones take precedence.
    pub finer: Vec<Finer>,
}

/// The points of a graded grid.
#[derive(Debug, Clone)]
pub struct GradedCloud {
    /// The point cloud.
    pub cloud: PointCloud,
    /// Refinement ratio of each grid: 1 for the large cells, then one per refined region.
    pub ratios: Vec<u32>,
    /// Index of the grid of each point.
    pub grid_of_point: Vec<u8>,
}

impl GradedCloud {
    /// Makes the points of a single grid.
    pub fn of_one_grid(cloud: PointCloud) -> Self {
        Self {
            grid_of_point: vec![0; cloud.len()],
            ratios: vec![1],
            cloud,
        }
    }
}

/// Division of the cells of a lattice, independent of which cells belong to the body.
#[derive(Debug, Clone, Copy)]
pub struct Division<'a> {
    /// Dimension of the body.
    pub dimension: usize,
    /// Size of the large cells, m.
    pub spacing: f64,
    /// Cross-section of a bar, thickness of a plate, 1 in 3D.
    pub section: f64,
    /// Regions with smaller cells; later ones take precedence.
    pub finer: &'a [Finer],
}

/// A cell that may belong to a body: a large cell, or a small cell of a divided one.
#[derive(Debug, Clone, Copy)]
pub struct GradedCell {
    /// Index of the large cell in the order of the centres.
    pub large: usize,
    /// Refined region of the large cell, if it is divided.
    pub part: Option<usize>,
    /// Index of the small cell along each axis of the large one.
    pub small: [u32; 3],
    /// Centre of the cell, m.
    pub centre: Point,
}

impl Division<'_> {
    /// Returns the refined region of a large cell, if it is divided. `is_in` returns whether the centre lies in a
    /// region.
    pub fn part(&self, is_in: impl Fn(&Region) -> bool) -> Option<usize> {
        self.finer.iter().rposition(|finer| is_in(&finer.region))
    }

    /// Makes the cloud: large cells in the order of their centres, divided ones as their small cells, x running
    /// fastest. `is_in` returns whether a position lies in a region, `holds` whether a cell belongs to the body.
    ///
    /// # Errors
    /// A region with a ratio below two or without cells; too many regions; a body without cells.
    pub fn points(
        &self,
        centres: impl Iterator<Item = Point>,
        is_in: impl Fn(&Region, Point) -> bool,
        mut holds: impl FnMut(&GradedCell) -> bool,
    ) -> Result<GradedCloud> {
        self.check()?;
        let (mut places, mut sizes): (Vec<Point>, Vec<f64>) = Default::default();
        let mut grid_of_point = Vec::new();
        for (large, centre) in centres.enumerate() {
            let part = self.part(|region| is_in(region, centre));
            let ratio = part.map_or(1, |part| self.finer[part].ratio);
            let size = self.spacing / f64::from(ratio);
            for_each_part(self.dimension, ratio, |small, offset| {
                let cell = GradedCell {
                    large,
                    part,
                    small,
                    centre: std::array::from_fn(|c| centre[c] + offset[c] * size),
                };
                if holds(&cell) {
                    places.push(cell.centre);
                    sizes.push(size);
                    grid_of_point.push(part.map_or(0, |part| part as u8 + 1));
                }
            });
        }
        for part in 0..self.finer.len() {
            if !grid_of_point.contains(&(part as u8 + 1)) {
                return Err(PericlesError::FinerEmpty { part });
            }
        }
        let positions = (0..self.dimension)
            .flat_map(|c| places.iter().map(move |place| place[c]))
            .collect();
        let volume = |size: &f64| self.section * size.powi(self.dimension as i32);
        let volumes = sizes.iter().map(volume).collect();
        let (dimension, section) = (self.dimension, self.section);
        Ok(GradedCloud {
            cloud: PointCloud::graded(dimension, positions, volumes, section, self.spacing)?,
            ratios: std::iter::once(1)
                .chain(self.finer.iter().map(|finer| finer.ratio))
                .collect(),
            grid_of_point,
        })
    }

    fn check(&self) -> Result<()> {
        if self.finer.len() > MOST_PARTS {
            return Err(PericlesError::FinerParts {
                parts: self.finer.len(),
                most: MOST_PARTS,
            });
        }
        for (part, finer) in self.finer.iter().enumerate() {
            if finer.ratio < 2 {
                return Err(PericlesError::FinerRatio {
                    part,
                    ratio: finer.ratio,
                });
            }
        }
        Ok(())
    }
}

/// Largest number of regions: grid numbers are bytes.
const MOST_PARTS: usize = 200;

impl GradedGrid {
    /// Returns the number of points without making them, or an upper bound if it exceeds `most`. A body that is not
    /// a full box is counted cell by cell, with all small cells of divided cells.
    ///
    /// # Errors
    /// The errors of the grid.
    pub fn count(&self, most: f64) -> Result<f64> {
        let cells = self.grid.cells()?;
        let dimension = self.grid.dimension() as i32;
        let finest = self.finer.iter().map(|finer| finer.ratio).max();
        let most_parts = f64::from(finest.unwrap_or(1)).powi(dimension);
        let bound = cells.shape.iter().product::<usize>() as f64 * most_parts;
        if bound <= most || (cells.is_full() && self.finer.is_empty()) {
            return Ok(bound);
        }
        let mut count = 0.0;
        let shape = cells.shape.map(|count| count as i32);
        for z in 0..shape[2] {
            for y in 0..shape[1] {
                for x in 0..shape[0] {
                    let centre = cells.centre([x, y, z]);
                    if cells.holds(centre) {
                        let ratio = self
                            .part(&cells, centre)
                            .map_or(1, |part| self.finer[part].ratio);
                        count += f64::from(ratio).powi(dimension);
                    }
                }
                if count > most {
                    return Ok(bound);
                }
            }
        }
        Ok(count)
    }

    /// Returns the indices of the holes that contain no cell centre of the shape and thus remove nothing.
    ///
    /// # Errors
    /// The errors of the grid.
    pub fn idle_holes(&self) -> Result<Vec<usize>> {
        let mut idle: Vec<usize> = (0..self.grid.holes.len()).collect();
        if idle.is_empty() {
            return Ok(idle);
        }
        let cells = self.grid.cells()?;
        let shape = cells.shape.map(|count| count as i32);
        for z in 0..shape[2] {
            for y in 0..shape[1] {
                for x in 0..shape[0] {
                    let centre = cells.centre([x, y, z]);
                    let part = self.part(&cells, centre);
                    let ratio = part.map_or(1, |part| self.finer[part].ratio);
                    let size = self.grid.spacing / f64::from(ratio);
                    for_each_part(self.grid.dimension(), ratio, |_, offset| {
                        let place: Point = std::array::from_fn(|c| centre[c] + offset[c] * size);
                        if cells.is_in_outline(place) {
                            idle.retain(|&k| !cells.is_in(&self.grid.holes[k], place));
                        }
                    });
                }
                if idle.is_empty() {
                    return Ok(idle);
                }
            }
        }
        Ok(idle)
    }

    /// Returns the refined region of a large cell, if it is divided.
    fn part(&self, cells: &Cells<'_>, centre: Point) -> Option<usize> {
        let holds = |finer: &Finer| cells.is_in(&finer.region, centre);
        self.finer.iter().rposition(holds)
    }

    /// Makes the cloud: cells of the large grid in its order, x fastest, divided ones as their small cells in the
    /// same order. The centre of each small cell decides whether it belongs to the body.
    ///
    /// # Errors
    /// The errors of [`Grid::points`]; a region with a ratio below two or without cells; too many regions.
    pub fn points(&self) -> Result<GradedCloud> {
        let cells = self.grid.cells()?;
        let division = Division {
            dimension: self.grid.dimension(),
            spacing: self.grid.spacing,
            section: self.grid.section,
            finer: &self.finer,
        };
        let count = cells.shape.map(|count| count as i32);
        let rows = (0..count[2]).flat_map(|z| (0..count[1]).map(move |y| (y, z)));
        let nodes = rows.flat_map(|(y, z)| (0..count[0]).map(move |x| [x, y, z]));
        division.points(
            nodes.map(|node| cells.centre(node)),
            |region, place| cells.is_in(region, place),
            |cell| cells.holds(cell.centre),
        )
    }
}

/// Calls `visit` with the indices of each small cell and the offset of its centre from that of the large cell, in
/// small cells.
fn for_each_part(dimension: usize, ratio: u32, mut visit: impl FnMut([u32; 3], Point)) {
    let range = |c: usize| 0..if c < dimension { ratio } else { 1 };
    let middle = 0.5 * f64::from(ratio - 1);
    let offset = |c: usize, k: u32| {
        if c < dimension {
            f64::from(k) - middle
        } else {
            0.0
        }
    };
    for z in range(2) {
        for y in range(1) {
            for x in range(0) {
                visit([x, y, z], [offset(0, x), offset(1, y), offset(2, z)]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::Shape;

    fn block(finer: Vec<Finer>) -> GradedGrid {
        GradedGrid {
            grid: Grid {
                shape: Shape::Box {
                    origin: [0.0; 3],
                    size: vec![0.6, 0.4, 0.2],
                },
                spacing: 0.1,
                section: 1.0,
                holes: vec![],
            },
            finer,
        }
    }

    #[test]
    fn the_total_volume_does_not_depend_on_the_division() {
        let region = Region::Box {
            min: [0.2, 0.1, f64::NEG_INFINITY],
            max: [0.4, 0.3, f64::INFINITY],
        };
        let points = block(vec![Finer { region, ratio: 3 }]).points().unwrap();
        assert_eq!(points.cloud.len(), 48 - 8 + 8 * 27);
        let volume: f64 = points.cloud.volumes().iter().sum();
        assert!((volume / 0.048 - 1.0).abs() < 1e-12);
        let [low, high] = points.cloud.bounds();
        for (c, side) in [0.6, 0.4, 0.2].into_iter().enumerate() {
            assert!(low[c].abs() < 1e-12 && (high[c] - side).abs() < 1e-12);
        }
        for (i, &grid) in points.grid_of_point.iter().enumerate() {
            let size = [0.1, 0.1 / 3.0][usize::from(grid)];
            assert!((points.cloud.cell_size(i) / size - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn smaller_cells_approximate_a_ball_better() {
        let ball = |finer| GradedGrid {
            grid: Grid {
                shape: Shape::Ball {
                    centre: [0.0; 3],
                    radius: 1.0,
                },
                spacing: 0.25,
                section: 1.0,
                holes: vec![],
            },
            finer,
        };
        let error = |finer| {
            let points = ball(finer).points().unwrap();
            let volume: f64 = points.cloud.volumes().iter().sum();
            (volume / (4.0 / 3.0 * std::f64::consts::PI) - 1.0).abs()
        };
        let whole = Finer {
            region: Region::All,
            ratio: 4,
        };
        assert!(error(vec![whole]) < 0.5 * error(vec![]));
    }

    #[test]
    fn counts_equal_the_numbers_of_points() {
        let region = Region::Box {
            min: [0.2, 0.1, f64::NEG_INFINITY],
            max: [0.4, 0.3, f64::INFINITY],
        };
        let graded = block(vec![Finer { region, ratio: 3 }]);
        // The upper bound is reached by a body divided everywhere.
        assert_eq!(graded.count(1e9).unwrap(), 48.0 * 27.0);
        assert_eq!(graded.count(300.0).unwrap(), 48.0 - 8.0 + 8.0 * 27.0);
        assert_eq!(graded.count(100.0).unwrap(), 48.0 * 27.0);
        let mut bored = block(vec![]);
        bored.grid.holes = vec![Region::Ball {
            centre: [0.3, 0.2, 0.1],
            radius: 0.12,
        }];
        let points = bored.points().unwrap().cloud.len() as f64;
        assert!(points < 48.0);
        assert_eq!(bored.count(47.0).unwrap(), points);
        assert_eq!(bored.count(points - 1.0).unwrap(), 48.0);
    }

    #[test]
    fn regions_that_divide_no_cell_are_rejected() {
        let part = |min: f64, ratio| Finer {
            region: Region::Box {
                min: [min; 3],
                max: [f64::INFINITY; 3],
            },
            ratio,
        };
        let error = |finer| block(finer).points().unwrap_err();
        assert!(matches!(
            error(vec![part(0.0, 1)]),
            PericlesError::FinerRatio { part: 0, ratio: 1 }
        ));
        assert!(matches!(
            error(vec![part(0.0, 2), part(5.0, 2)]),
            PericlesError::FinerEmpty { part: 1 }
        ));
        // A later region covers an earlier one completely.
        assert!(matches!(
            error(vec![part(0.1, 2), part(0.0, 3)]),
            PericlesError::FinerEmpty { part: 0 }
        ));
    }
}
