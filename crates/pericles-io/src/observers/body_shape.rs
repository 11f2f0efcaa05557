//! The shape of a body in its pictures: cells and lines that move with it.

use pericles::family::Crack;
use pericles::space::{Point, PointCloud};

use super::cell_mesh::CellMesh;
use super::drawn_cells::{CellArrays, DrawnCells};
use super::motion::Motion;
use super::overlay::{CarriedLine, Overlay};
use crate::picture::Polygons;

/// The shape of a body in its pictures.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyShape {
    cells: Option<DrawnCells>,
    overlay: Overlay,
}

/// A body to draw.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DrawnShape {
    /// The cells; empty for a body without cells.
    pub polygons: Polygons,
    /// Pre-cracks, interfaces and borders of refined parts, m.
    pub lines: Vec<Vec<Point>>,
}

impl BodyShape {
    /// Creates the shape of a body from its cells, if it has any, its pre-cracks and a class for each point: lines are
    /// drawn between plane points of different material or cell size, which must be the centres of boxes. No classes are
    /// the same as equal ones.
    pub fn new(
        cloud: &PointCloud,
        mesh: Option<&CellMesh>,
        cracks: &[Crack],
        classes: &[u32],
    ) -> Self {
        /// Points within this share of a cell of a pre-crack are on it.
        const SLACK: f64 = 1e-9;
        let cutters = cracks.iter().filter_map(|crack| {
            let cutter = crack.cutter(Default::default(), SLACK * cloud.spacing());
            cutter.ok()
        });
        let cutters: Vec<_> = cutters.collect();
        let cuts = |p: Point, q: Point| cutters.iter().any(|cutter| cutter.cuts(p, q));
        let mesh = mesh.filter(|_| cloud.dimension() > 1);
        Self {
            cells: mesh.map(|mesh| DrawnCells::new(cloud, mesh, cuts)),
            overlay: Overlay::new(cloud, cracks, classes),
        }
    }

    /// Returns the cells as arrays; `None` for a body without cells.
    pub fn cells(&self) -> Option<CellArrays> {
        self.cells.as_ref().map(DrawnCells::arrays)
    }

    /// Returns the pre-cracks, interfaces and borders of refined parts of the body at rest.
    pub fn lines_at_rest(&self) -> Vec<CarriedLine> {
        let traces = self.cells.iter().flat_map(DrawnCells::traces_at_rest);
        let traces = traces.map(|line| line.into_iter().map(|(place, point)| (place, [point; 2])));
        let traces = traces.map(Iterator::collect);
        traces.chain(self.overlay.at_rest()).collect()
    }

    /// Returns the body with a displacement, component-major, magnified by `scale`. `damage` is that of the points, if
    /// bonds can break: cells beside a crack are then drawn apart.
    pub fn drawn(
        &self,
        cloud: &PointCloud,
        displacement: &[f64],
        damage: Option<&[f64]>,
        scale: f64,
    ) -> DrawnShape {
        let mut motion = Motion::new(cloud, displacement, scale);
        let mut drawn = DrawnShape::default();
        if let Some(cells) = &self.cells {
            let mut deformed = cells.deformed(&mut motion, damage);
            drawn.polygons = deformed.polygons();
            drawn.lines = deformed.crack_traces();
        }
        drawn.lines.extend(self.overlay.lines(&motion));
        let is_finite = |line: &Vec<Point>| line.iter().flatten().all(|x| x.is_finite());
        drawn.lines.retain(is_finite);
        drawn
    }
}
