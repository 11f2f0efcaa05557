//! Points from mesh elements: one point per element, at its centroid, with its volume.
//!
//! Elements of the highest dimension become points; elements of lower dimension only define sets. Groups,
//! face sets and node sets of the mesh become point sets:
//!
//! | in the mesh | points of the set | area |
//! |---|---|---|
//! | group of elements that become points | these elements | – |
//! | face set, or group of elements one dimension lower | elements that own one of its faces | of these faces |
//! | node set, or group of elements of still lower dimension | elements that have one of its nodes | – |
//!
//! Names are unique: if several kinds of sets share one, element sets keep it, and ` (faces)` or ` (nodes)`
//! is appended to the others.

mod near;
mod problem;
mod sets;
mod summary;
mod vectors;

pub use problem::{ElementSize, Problem};
pub use sets::{PointSet, SetKind};
pub use summary::{SetSummary, Summary};

use rayon::prelude::*;

use crate::cell::CellKind;
use crate::element::{Measure, is_folded, measure};
use crate::raw::RawMesh;

/// Options for the conversion of a mesh to points.
#[derive(Debug, Clone, PartialEq)]
pub struct PointOptions {
    /// Length unit of the file, m.
    pub unit: f64,
    /// Thickness of a plane mesh, m; not used for solids.
    pub thickness: f64,
    /// Groups whose elements are used; by default all elements of the highest dimension.
    pub blocks: Option<Vec<String>>,
}

impl Default for PointOptions {
    fn default() -> Self {
        Self {
            unit: 1.0,
            thickness: 1.0,
            blocks: None,
        }
    }
}

/// The points of a mesh, in the order of its elements.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshPoints {
    /// 2 for plane meshes, 3 for solids.
    pub dimension: usize,
    /// Centroids of the elements, m.
    pub positions: Vec<[f64; 3]>,
    /// Volumes, m³.
    pub volumes: Vec<f64>,
    /// Element sizes d = (V / thickness)^(1/dimension), m; V^(1/3) for solids.
    pub sizes: Vec<f64>,
    /// Cell of the mesh for each point.
    pub cells: Vec<u32>,
    /// Sets of points, with unique names.
    pub sets: Vec<PointSet>,
    /// Warnings.
    pub warnings: Vec<Problem>,
}

impl MeshPoints {
    /// Returns the number of points.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Always false: a mesh without points is an error.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Returns the set with this name.
    pub fn set(&self, name: &str) -> Option<&PointSet> {
        self.sets.iter().find(|set| set.name == name)
    }

    /// Returns the mean size of the elements, m, which is the spacing of the body.
    pub fn mean_size(&self) -> f64 {
        self.sizes.iter().sum::<f64>() / self.len() as f64
    }

    /// Returns the points with the smallest and the largest element.
    pub fn extremes(&self) -> [usize; 2] {
        let (mut least, mut most) = (0, 0);
        for (point, &size) in self.sizes.iter().enumerate() {
            if size < self.sizes[least] {
                least = point;
            }
            if size > self.sizes[most] {
                most = point;
            }
        }
        [least, most]
    }

    /// Checks the element sizes against a horizon (m): the largest should be at most half of it, and none
    /// smaller than an eighth of the largest.
    pub fn check_sizes(&self, horizon: f64) -> Vec<Problem> {
        let [least, most] = self.extremes();
        let at = |point: usize| ElementSize {
            size: self.sizes[point],
            position: self.positions[point],
        };
        let (smallest, largest) = (at(least), at(most));
        let mut problems = Vec::new();
        if largest.size > 0.5 * horizon {
            problems.push(Problem::Coarse {
                smallest,
                largest,
                horizon,
            });
        }
        if smallest.size < largest.size / 8.0 {
            problems.push(Problem::Graded { smallest, largest });
        }
        problems
    }
}

/// Volume relative to the cube of the element's size below which it counts as zero.
const NO_VOLUME: f64 = 1e-14;

/// Range of the largest side of a body, m, outside which the unit is implausible.
const LIKELY_SIDES: [f64; 2] = [1e-3, 100.0];

impl RawMesh {
    /// Converts the mesh to points and sets.
    ///
    /// # Errors
    /// Returns an error for a mesh that [`RawMesh::check`] rejects, a mesh without elements of dimension 2 or
    /// 3 (or points with volumes), a folded element or one without volume, a plane mesh outside a plane of
    /// constant z, and blocks that do not exist.
    pub fn points(&self, options: &PointOptions) -> Result<MeshPoints, Problem> {
        self.check()?;
        let (dimension, cells) = self.elements(options)?;
        let body_dimension = if dimension == 0 { 3 } else { dimension };
        if dimension == 2 {
            self.check_plane(&cells)?;
        }
        let section = match dimension {
            2 => options.thickness,
            _ => 1.0,
        };
        let scale = options.unit.powi(body_dimension as i32) * section;
        let (mut positions, mut volumes, mut sizes) = (vec![], vec![], vec![]);
        let mut empty: Option<(u64, usize)> = None;
        let elements: Vec<_> = cells.par_iter().map(|&cell| self.element(cell)).collect();
        for (&cell, element) in cells.iter().zip(elements) {
            let Measure { volume, centroid } = element?;
            if self.has_no_volume(cell, volume) {
                let number = self.cells.number(cell as usize);
                let (_, count) = empty.get_or_insert((number, 0));
                *count += 1;
            }
            positions.push(centroid.map(|x| x * options.unit));
            let volume = volume.abs() * scale;
            volumes.push(volume);
            sizes.push((volume / section).powf(1.0 / body_dimension as f64));
        }
        if let Some((first, count)) = empty {
            return Err(Problem::NoVolume { first, count });
        }
        let (sets, warnings) = sets::point_sets(self, dimension, &cells, options);
        let mut points = MeshPoints {
            dimension: body_dimension,
            positions,
            volumes,
            sizes,
            cells,
            sets,
            warnings,
        };
        points.check_unit();
        Ok(points)
    }

    /// Returns the dimension of the elements that become points, and the elements.
    fn elements(&self, options: &PointOptions) -> Result<(usize, Vec<u32>), Problem> {
        let all = 0..self.cells.len() as u32;
        let candidates: Vec<u32> = match &options.blocks {
            None => all.collect(),
            Some(blocks) => {
                let mut wanted = vec![false; self.cells.len()];
                for block in blocks {
                    let mut groups = self.groups.iter().filter(|group| group.name == *block);
                    let Some(first) = groups.next() else {
                        let known = self.groups.iter().map(|group| group.name.clone());
                        return Err(Problem::UnknownBlock {
                            name: block.clone(),
                            known: known.collect(),
                        });
                    };
                    for group in std::iter::once(first).chain(groups) {
                        for &cell in &group.members {
                            wanted[cell as usize] = true;
                        }
                    }
                }
                all.filter(|&cell| wanted[cell as usize]).collect()
            }
        };
        let dimension_of = |cell: &u32| self.cells.kind(*cell as usize).dimension();
        let highest = candidates.iter().map(dimension_of).max();
        match highest {
            Some(dimension @ (2 | 3)) => {
                let cells = candidates
                    .into_iter()
                    .filter(|c| dimension_of(c) == dimension);
                Ok((dimension, cells.collect()))
            }
            Some(0)
                if candidates
                    .iter()
                    .all(|&cell| self.point_volume(cell).is_some()) =>
            {
                Ok((0, candidates))
            }
            _ => Err(Problem::NoElements {
                kinds: self.cells.counts(),
            }),
        }
    }

    fn point_volume(&self, cell: u32) -> Option<f64> {
        let place = self.point_volumes.binary_search_by_key(&cell, |&(c, _)| c);
        Some(self.point_volumes[place.ok()?].1)
    }

    pub(crate) fn corner_positions(&self, corners: &[u32]) -> Vec<[f64; 3]> {
        let nodes = corners.iter().map(|&node| self.nodes[node as usize]);
        nodes.collect()
    }

    /// Returns volume and centroid of an element, in the units of the file.
    fn element(&self, cell: u32) -> Result<Measure, Problem> {
        let kind = self.cells.kind(cell as usize);
        let corners = self.cells.corners(cell as usize);
        if kind == CellKind::Point {
            return Ok(Measure {
                volume: self.point_volume(cell).unwrap_or_default(),
                centroid: self.nodes[corners[0] as usize],
            });
        }
        let positions = self.corner_positions(corners);
        match measure(kind, &positions) {
            Some(measure) if !is_folded(kind, &positions) => Ok(measure),
            _ => Err(Problem::Folded {
                number: self.cells.number(cell as usize),
                kind,
                corners: positions,
            }),
        }
    }

    fn has_no_volume(&self, cell: u32, volume: f64) -> bool {
        let kind = self.cells.kind(cell as usize);
        let positions = self.corner_positions(self.cells.corners(cell as usize));
        let side = (0..3)
            .map(|c| {
                let along = positions.iter().map(|x| x[c]);
                along.clone().fold(f64::MIN, f64::max) - along.fold(f64::MAX, f64::min)
            })
            .fold(0.0, f64::max);
        !volume.is_finite()
            || volume.abs()
                <= NO_VOLUME * side.powi(kind.dimension() as i32) * {
                    // The given volume of a point must be positive.
                    if kind == CellKind::Point { 0.0 } else { 1.0 }
                }
    }

    fn check_plane(&self, cells: &[u32]) -> Result<(), Problem> {
        let nodes = || {
            cells
                .iter()
                .flat_map(|&cell| self.cells.corners(cell as usize))
        };
        let z = || nodes().map(|&node| self.nodes[node as usize][2]);
        let (low, high) = (z().fold(f64::MAX, f64::min), z().fold(f64::MIN, f64::max));
        let extent = |c: usize| {
            let x = nodes().map(|&node| self.nodes[node as usize][c]);
            x.clone().fold(f64::MIN, f64::max) - x.fold(f64::MAX, f64::min)
        };
        // Round-off of programs that write seven digits.
        if high - low > 1e-6 * extent(0).max(extent(1)) {
            return Err(Problem::NotPlane { low, high });
        }
        Ok(())
    }
}

impl MeshPoints {
    fn check_unit(&mut self) {
        let extent = |c: usize| {
            let x = self.positions.iter().map(|x| x[c]);
            x.clone().fold(f64::MIN, f64::max) - x.fold(f64::MAX, f64::min)
        };
        // Centroids are half an element inside.
        let side = (0..3).map(extent).fold(0.0, f64::max) + self.mean_size();
        if !(LIKELY_SIDES[0]..=LIKELY_SIDES[1]).contains(&side) {
            self.warnings.push(Problem::ImplausibleUnit { side });
        }
    }
}
