//! Refined cells in closed surfaces and outlines.

use pericles::space::{Division, GradedCloud};
use pericles_deck::{BuildError, FilledShape, Solid};
use pericles_mesh::fill::{Filled, Lattice};

use super::assembler::Assembler;
use super::enclosure::{Enclosure, Holes};
use super::rejection::{at, at_path, refined_key};
use super::resources::Resources;

/// The points of a body with refined parts.
pub(super) struct GradedCells {
    pub(super) cloud: GradedCloud,
    /// Volume or area of all cells, holes included.
    pub(super) volume: f64,
    /// Whether all triangle normals point inwards.
    pub(super) was_turned: bool,
}

/// The bounding box of the large cells of a refined part, filled with a lattice of small cells.
struct Part {
    /// First and last cell along each axis.
    ends: [[usize; 3]; 2],
    /// Number of refined large cells.
    cells: usize,
    ratio: usize,
}

impl Part {
    fn lattice(&self, large: &Lattice, dimension: usize) -> Lattice {
        let [first, last] = self.ends;
        let counts = std::array::from_fn(|c| last[c] + 1 - first[c]);
        large.divided_box(first, counts, dimension, self.ratio)
    }

    /// Returns the number of small cells of the box.
    fn small_cells(&self, dimension: usize) -> f64 {
        let [first, last] = self.ends;
        let sides = (0..dimension).map(|c| ((last[c] + 1 - first[c]) * self.ratio) as f64);
        sides.product()
    }
}

/// Returns the indices of a cell from its position in the order x, y, z.
fn cell([nx, ny, _]: [usize; 3], place: usize) -> [usize; 3] {
    [place % nx, place / nx % ny, place / (nx * ny)]
}

/// Returns the box of each part; `None` for parts without cells.
fn parts(division: &Division<'_>, large: &Lattice, holes: &Holes<'_>) -> Vec<Option<Part>> {
    let mut parts: Vec<Option<Part>> = division.finer.iter().map(|_| None).collect();
    for place in 0..large.len() {
        let cell = cell(large.counts, place);
        let centre = large.position(cell);
        let Some(number) = division.part(|region| holes.is_in(region, centre)) else {
            continue;
        };
        let part = parts[number].get_or_insert(Part {
            ends: [cell; 2],
            cells: 0,
            ratio: division.finer[number].ratio as usize,
        });
        part.cells += 1;
        for c in 0..3 {
            part.ends[0][c] = part.ends[0][c].min(cell[c]);
            part.ends[1][c] = part.ends[1][c].max(cell[c]);
        }
    }
    parts
}

impl Assembler<'_> {
    /// Creates the points in large cells and, in refined parts, small ones. Cells belong to the body if their centres
    /// are inside. `filled` is the boundary, its holes and its volume or area.
    pub(super) fn graded_cells(
        &self,
        solid: &Solid,
        shape: &FilledShape,
        filled: (&Enclosure, &Holes<'_>, f64),
        resources: &Resources<'_>,
    ) -> Result<GradedCells, BuildError> {
        let (enclosure, holes, enclosed) = filled;
        let rejected = |error| self.no_fill(shape, error);
        let dimension = shape.dimension;
        let division = Division {
            dimension,
            spacing: shape.spacing,
            section: shape.section,
            finer: &shape.finer,
        };
        let spacing = std::array::from_fn(|c| if c < dimension { shape.spacing } else { 1.0 });
        let large = Lattice::around(enclosure.bounds(), spacing).map_err(rejected)?;
        let parts = parts(&division, &large, holes);
        let full = enclosed / (large.len() as f64 * large.cell_volume());
        let divided = parts.iter().flatten().map(|part| {
            let more = (part.ratio as f64).powi(dimension as i32) - 1.0;
            (part.cells as f64 * more, part.small_cells(dimension))
        });
        let (points, cells) = divided.fold((0.0, 0.0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
        let large_cells = large.len() as f64;
        let points = full.min(1.0) * (large_cells + points);
        self.check_filled(solid, points, large_cells + cells, resources)?;
        let whole = enclosure.fill_nodes(large).map_err(rejected)?;
        let mut small: Vec<Option<Filled>> = Vec::new();
        for part in &parts {
            let lattice = part.as_ref().map(|part| part.lattice(&large, dimension));
            let nodes = lattice.map(|lattice| enclosure.fill_nodes(lattice));
            small.push(nodes.transpose().map_err(rejected)?);
        }
        let mut volume = 0.0;
        let cloud = division.points(
            (0..large.len()).map(|place| large.position(cell(large.counts, place))),
            |region, centre| holes.is_in(region, centre),
            |one| {
                let node = cell(large.counts, one.large);
                let divided = one
                    .part
                    .and_then(|k| small[k].as_ref().zip(parts[k].as_ref()));
                let (is_inside, ratio) = match divided {
                    Some((filled, part)) => {
                        let first = part.ends[0];
                        let small = std::array::from_fn(|c| match c < dimension {
                            true => (node[c] - first[c]) * part.ratio + one.small[c] as usize,
                            false => 0,
                        });
                        (filled.contains(small), part.ratio)
                    }
                    None => (whole.contains(node), 1),
                };
                if is_inside {
                    volume += (shape.spacing / ratio as f64).powi(dimension as i32);
                }
                is_inside && !holes.contain(one.centre)
            },
        );
        let cloud = cloud.map_err(|error| match refined_key(&error) {
            Some(key) => at_path(key, error.into()),
            None => at("body.spacing", error),
        })?;
        Ok(GradedCells {
            cloud,
            volume,
            was_turned: whole.was_turned(),
        })
    }
}
