//! The cells of a body as polygons of its pictures.
//!
//! A node of a cell moves with the mean of the cells that meet there, each extrapolated from its point to the node by its
//! displacement gradient, so that a body is drawn without gaps and affine motions are exact. Cells that are separated do
//! not contribute to each other's nodes, and their common side is drawn twice: sides cut by pre-cracks, and sides between
//! damaged points that move apart or into each other.

use pericles::space::{Point, PointCloud};
use pericles_mesh::CellKind;

use super::cell_mesh::CellMesh;
use super::motion::{GradientFit, Matrix, Motion};
use crate::numbering::points_by_number;
use crate::picture::{Polygon, Polygons};
use crate::vtk::VtuCells;

/// Least mean damage of two points whose cells can separate: less than that beside a crack.
const DAMAGED: f64 = 0.2;
/// Drawn distances of two such points relative to that at rest, for which the cells are not separated.
const TOGETHER: std::ops::RangeInclusive<f64> = 0.5..=1.1;

/// No cell, beyond the boundary of the body.
const OUTSIDE: u32 = u32::MAX;

/// A facet of a cell: an edge of a plane cell, a face of a solid.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Side {
    /// The cell on the other side, or [`OUTSIDE`].
    across: u32,
    /// Whether a pre-crack separates the cells.
    is_cut: bool,
}

/// The cells of a plane body or a solid with their neighbours.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct DrawnCells {
    is_solid: bool,
    nodes: Vec<Point>,
    cells: VtuCells,
    kinds: Vec<CellKind>,
    /// The point of each cell.
    points: Vec<u32>,
    has_cell: Vec<bool>,
    /// The number of cells at each node.
    meeting: Vec<u32>,
    /// Index of the first side of each cell, and of the end.
    first: Vec<u32>,
    sides: Vec<Side>,
    /// Lines in which pre-cracks meet the boundary of a solid: a cell and a node for each place.
    traces: Vec<Vec<(u32, u32)>>,
}

impl DrawnCells {
    /// Creates the cells of a body that are not of lower dimension; `cuts` tells whether a pre-crack separates two points.
    pub(super) fn new(
        cloud: &PointCloud,
        mesh: &CellMesh,
        cuts: impl Fn(Point, Point) -> bool,
    ) -> Self {
        let of_number = points_by_number(cloud);
        let count = mesh.nodes.len() / 3;
        let node = |k: usize| std::array::from_fn(|c| mesh.nodes[c * count + k]);
        let mut cells = VtuCells::default();
        let (mut kinds, mut points) = (Vec::new(), Vec::new());
        let mut has_cell = vec![false; cloud.len()];
        let mut meeting = vec![0; count];
        for (cell, &number) in mesh.points.iter().enumerate() {
            let Some(kind) = CellKind::of_vtk(mesh.cells.vtk_type(cell)) else {
                continue;
            };
            if kind.dimension() != cloud.dimension() {
                continue;
            }
            let corners = mesh.cells.corners_of(cell);
            cells.push(mesh.cells.vtk_type(cell), corners);
            corners.iter().for_each(|&node| meeting[node as usize] += 1);
            kinds.push(kind);
            let point = of_number[number as usize];
            points.push(point);
            has_cell[point as usize] = true;
        }
        let mut drawn = Self {
            is_solid: cloud.dimension() == 3,
            nodes: (0..count).map(node).collect(),
            cells,
            kinds,
            points,
            has_cell,
            meeting,
            first: Vec::new(),
            sides: Vec::new(),
            traces: Vec::new(),
        };
        drawn.find_sides();
        let place = |cell: u32| cloud.point(drawn.points[cell as usize] as usize);
        for cell in 0..drawn.kinds.len() as u32 {
            for side in drawn.first[cell as usize]..drawn.first[cell as usize + 1] {
                let side = &mut drawn.sides[side as usize];
                side.is_cut = side.across != OUTSIDE && cuts(place(cell), place(side.across));
            }
        }
        if drawn.is_solid {
            drawn.traces = drawn.crack_traces();
        }
        drawn
    }

    /// Finds the cell across each side.
    fn find_sides(&mut self) {
        let mut keys: Vec<([u32; 4], u32, u32)> = Vec::new();
        for cell in 0..self.kinds.len() {
            self.first.push(self.sides.len() as u32);
            let corners = self.cells.corners_of(cell);
            for (_, facet) in self.kinds[cell].facets() {
                let mut key = [u32::MAX; 4];
                for (key, &corner) in key.iter_mut().zip(*facet) {
                    *key = corners[corner];
                }
                key.sort_unstable();
                keys.push((key, cell as u32, self.sides.len() as u32));
                self.sides.push(Side {
                    across: OUTSIDE,
                    is_cut: false,
                });
            }
        }
        self.first.push(self.sides.len() as u32);
        keys.sort_unstable();
        for same in keys.chunk_by(|a, b| a.0 == b.0) {
            // More than two cells at a side are an invalid mesh.
            if let [(_, cell, side), (_, other, opposite)] = same {
                self.sides[*side as usize].across = *other;
                self.sides[*opposite as usize].across = *cell;
            }
        }
    }

    /// Returns the numbers of the sides of a cell.
    fn sides_of(&self, cell: u32) -> std::ops::Range<usize> {
        self.first[cell as usize] as usize..self.first[cell as usize + 1] as usize
    }

    /// Returns the nodes of a facet of a cell.
    fn nodes_of(&self, cell: u32, facet: usize) -> impl Iterator<Item = u32> + '_ {
        let corners = self.cells.corners_of(cell as usize);
        let (_, facet) = self.kinds[cell as usize].facets()[facet];
        facet.iter().map(|&corner| corners[corner])
    }

    /// Returns the lines along which cut sides meet the boundary, joined to long ones.
    fn crack_traces(&self) -> Vec<Vec<(u32, u32)>> {
        let mut edges: Vec<(u32, [u32; 2])> = Vec::new();
        for cell in 0..self.kinds.len() as u32 {
            let sides = &self.sides[self.sides_of(cell)];
            for (cut, _) in sides.iter().enumerate().filter(|(_, side)| side.is_cut) {
                let outer = sides.iter().enumerate();
                for (outer, _) in outer.filter(|(_, side)| side.across == OUTSIDE) {
                    let common = self.nodes_of(cell, cut);
                    let common =
                        common.filter(|&node| self.nodes_of(cell, outer).any(|k| k == node));
                    if let [a, b] = common.collect::<Vec<u32>>()[..] {
                        edges.push((cell, [a, b]));
                    }
                }
            }
        }
        let joined = |a: u32, b: u32| {
            a == b
                || (self.sides[self.sides_of(a)].iter())
                    .any(|side| side.across == b && !side.is_cut)
        };
        let mut lines = Vec::new();
        while let Some((cell, [from, to])) = edges.pop() {
            let mut line = vec![(cell, from), (cell, to)];
            for _ in 0..2 {
                while let Some(&(cell, end)) = line.last() {
                    let next = edges
                        .iter()
                        .position(|(other, ends)| ends.contains(&end) && joined(cell, *other));
                    let Some(next) = next else { break };
                    let (other, [a, b]) = edges.swap_remove(next);
                    line.push((other, if a == end { b } else { a }));
                }
                line.reverse();
            }
            lines.push(line);
        }
        lines
    }

    /// Returns for each side whether the cells there are drawn apart.
    fn open_sides(&self, motion: &Motion<'_>, damage: Option<&[f64]>) -> Vec<bool> {
        let damage_of =
            |cell: u32| damage.map_or(0.0, |damage| damage[self.points[cell as usize] as usize]);
        let length = |x: Point| x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let mut open = Vec::with_capacity(self.sides.len());
        for cell in 0..self.kinds.len() as u32 {
            for side in &self.sides[self.sides_of(cell)] {
                if side.across == OUTSIDE || side.is_cut {
                    open.push(true);
                    continue;
                }
                let (arm, moved) = self.relative(motion, cell, side.across);
                let drawn = length(std::array::from_fn(|c| arm[c] + motion.scale * moved[c]));
                let mean_damage = 0.5 * (damage_of(cell) + damage_of(side.across));
                let is_apart = mean_damage >= DAMAGED && !TOGETHER.contains(&(drawn / length(arm)));
                open.push(is_apart || !drawn.is_finite());
            }
        }
        open
    }

    /// Returns position and displacement of the point of another cell relative to those of a cell.
    fn relative(&self, motion: &Motion<'_>, cell: u32, other: u32) -> (Point, Point) {
        let [here, there] = [cell, other].map(|cell| self.points[cell as usize] as usize);
        let (x, y) = (motion.cloud.point(here), motion.cloud.point(there));
        let (u, v) = (motion.of_point(here), motion.of_point(there));
        (
            std::array::from_fn(|c| y[c] - x[c]),
            std::array::from_fn(|c| v[c] - u[c]),
        )
    }

    /// Returns the displacement gradient at each point, from the neighbours that are not drawn apart.
    fn gradients(&self, motion: &Motion<'_>, open: &[bool]) -> Vec<Matrix> {
        let mut gradients = vec![Matrix::default(); motion.cloud.len()];
        for cell in 0..self.kinds.len() as u32 {
            let mut fit = GradientFit::default();
            for side in self.sides_of(cell).filter(|side| !open[*side]) {
                let (arm, moved) = self.relative(motion, cell, self.sides[side].across);
                fit.add(arm, moved);
            }
            gradients[self.points[cell as usize] as usize] = fit.gradient();
        }
        gradients
    }

    /// Returns the cells as they are drawn in a motion, which receives the displacement gradients. `damage` is that of
    /// the points, if bonds can break.
    pub(super) fn deformed<'a, 'm>(
        &'a self,
        motion: &'a mut Motion<'m>,
        damage: Option<&[f64]>,
    ) -> DeformedCells<'a, 'm> {
        let open = self.open_sides(motion, damage);
        motion.gradients = self.gradients(motion, &open);
        DeformedCells {
            cells: self,
            motion,
            open,
            whole: vec![None; self.nodes.len()],
        }
    }
}

/// The cells of a body with their neighbours as plain arrays.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CellArrays {
    /// Positions of the nodes, m.
    pub nodes: Vec<Point>,
    /// VTK's type of each cell.
    pub types: Vec<u32>,
    /// The nodes of all cells, one cell after the other.
    pub corners: Vec<u32>,
    /// The point of each cell.
    pub points: Vec<u32>,
    /// The cell beyond each facet, one cell after the other; `u32::MAX` beyond the boundary of the body.
    pub across: Vec<u32>,
    /// Whether a pre-crack separates the cells at a facet.
    pub cut: Vec<bool>,
}

impl DrawnCells {
    /// Returns the cells as arrays.
    pub(super) fn arrays(&self) -> CellArrays {
        CellArrays {
            nodes: self.nodes.clone(),
            types: self
                .kinds
                .iter()
                .map(|kind| u32::from(kind.vtk()))
                .collect(),
            corners: self.cells.corners().to_vec(),
            points: self.points.clone(),
            across: self.sides.iter().map(|side| side.across).collect(),
            cut: self.sides.iter().map(|side| side.is_cut).collect(),
        }
    }

    /// Returns the lines in which pre-cracks meet the boundary of a solid: places, each with the point that it moves with.
    pub(super) fn traces_at_rest(&self) -> impl Iterator<Item = Vec<(Point, u32)>> + '_ {
        let place =
            |&(cell, node): &(u32, u32)| (self.nodes[node as usize], self.points[cell as usize]);
        self.traces
            .iter()
            .map(move |line| line.iter().map(place).collect())
    }
}

/// Cells in a motion.
pub(super) struct DeformedCells<'a, 'm> {
    cells: &'a DrawnCells,
    motion: &'a Motion<'m>,
    /// For each side whether the cells there are drawn apart.
    open: Vec<bool>,
    /// Positions of nodes whose cells all hold together.
    whole: Vec<Option<Point>>,
}

impl DeformedCells<'_, '_> {
    /// Returns the polygons: the cells of a plane body, the visible faces of a solid.
    pub(super) fn polygons(&mut self) -> Polygons {
        let cells = self.cells;
        let mut all = Vec::new();
        for cell in 0..cells.kinds.len() as u32 {
            let point = cells.points[cell as usize];
            if !cells.is_solid {
                let corners = cells.cells.corners_of(cell as usize);
                let corners = self.places(cell, corners.iter().copied());
                all.push(Polygon { corners, point });
                continue;
            }
            for (facet, side) in cells.sides_of(cell).enumerate() {
                if self.open[side] {
                    let corners = self.places(cell, cells.nodes_of(cell, facet));
                    all.push(Polygon { corners, point });
                }
            }
        }
        Polygons {
            all,
            has_cell: cells.has_cell.clone(),
        }
    }

    /// Returns the lines in which pre-cracks meet the boundary of a solid.
    pub(super) fn crack_traces(&mut self) -> Vec<Vec<Point>> {
        let cells = self.cells;
        let lines = cells.traces.iter().map(|line| {
            let places = line.iter().map(|&(cell, node)| self.place(cell, node));
            places.collect()
        });
        lines.collect()
    }

    fn places(&mut self, cell: u32, nodes: impl Iterator<Item = u32>) -> [Point; 4] {
        let mut places = [[0.0; 3]; 4];
        let mut count = 0;
        for node in nodes {
            places[count] = self.place(cell, node);
            count += 1;
        }
        for k in count..4 {
            places[k] = places[count - 1];
        }
        places
    }

    /// Returns the displaced position of a node of a cell: the mean of the cells that hold together there.
    fn place(&mut self, cell: u32, node: u32) -> Point {
        if let Some(place) = self.whole[node as usize] {
            return place;
        }
        let cells = self.cells;
        let mut group = vec![cell];
        let mut next = 0;
        while let Some(&member) = group.get(next) {
            for side in cells.sides_of(member).filter(|side| !self.open[*side]) {
                let other = cells.sides[side].across;
                let meets = cells.cells.corners_of(other as usize).contains(&node);
                if meets && !group.contains(&other) {
                    group.push(other);
                }
            }
            next += 1;
        }
        group.sort_unstable();
        let mut sum = [0.0; 3];
        for &member in &group {
            let point = cells.points[member as usize] as usize;
            let place = self.motion.place(cells.nodes[node as usize], point);
            (0..3).for_each(|c| sum[c] += place[c]);
        }
        let place = sum.map(|x| x / group.len() as f64);
        if group.len() as u32 == cells.meeting[node as usize] {
            self.whole[node as usize] = Some(place);
        }
        place
    }
}

#[cfg(test)]
mod tests;
