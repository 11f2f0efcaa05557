//! The loaded area of a traction, if the deck does not give it.

use std::collections::{BTreeMap, BTreeSet};

use pericles::space::{PointCloud, Region};
use pericles_deck::AreaCaution;

/// Returns the axis normal to the loaded face: the axis of a layer's face, otherwise the axis of the load.
pub(crate) fn normal_axis(
    region: Option<&Region>,
    acts_along: &[bool; 3],
) -> Result<usize, &'static str> {
    if let Some(Region::Layer { face, .. }) = region {
        return Ok(face.axis);
    }
    let mut axes = (0..3).filter(|&c| acts_along[c]);
    match (axes.next(), axes.next()) {
        (Some(axis), None) => Ok(axis),
        (None, _) => Err("the traction is zero"),
        (Some(_), Some(_)) => {
            Err("the set is not a layer, and the traction is not parallel to an axis")
        }
    }
}

/// Returns whether a set is a layer at a face.
pub(crate) fn is_layer(region: Option<&Region>) -> bool {
    matches!(region, Some(Region::Layer { .. }))
}

/// The cells of a set under a load.
pub(crate) struct LoadedCells {
    dimension: usize,
    section: f64,
    sides: [f64; 3],
    /// The cell of each point, counted from the corner of the body. Cell centres, also of refined cells, lie well inside the large
    /// cells.
    cells: Vec<[i64; 3]>,
}

impl LoadedCells {
    /// Determines the cells of a set of points of all processes. All processes must call it together.
    pub(crate) fn new(cloud: &PointCloud, points: &[u32]) -> Self {
        let dimension = cloud.dimension();
        let [corner, _] = cloud.body_bounds();
        let sides = std::array::from_fn(|c| match c < dimension {
            true => cloud.cell_side(c),
            false => 1.0,
        });
        let cell = |&i: &u32| -> [f64; 3] {
            let place = cloud.point(i as usize);
            std::array::from_fn(|c| match c < dimension {
                true => ((place[c] - corner[c]) / sides[c]).floor(),
                false => 0.0,
            })
        };
        let own: Vec<f64> = points.iter().flat_map(cell).collect();
        let all = cloud.domain().collect_everywhere(own).concat();
        let cells = all.chunks_exact(3);
        Self {
            dimension,
            section: cloud.section(),
            sides,
            cells: cells
                .map(|cell| [0, 1, 2].map(|c| cell[c] as i64))
                .collect(),
        }
    }

    /// Returns the caution about the projected area along `axis` of a set that is not defined as a layer; `None` if its points form
    /// a single layer at one face.
    pub(crate) fn caution(&self, axis: usize) -> Option<AreaCaution> {
        /// Largest depth of a layer along the axis, relative to another axis.
        const DEEPER: f64 = 1.5;
        /// Largest depth of a column, relative to the median; caps of spheres and cylinders are uneven.
        const UNEVEN: usize = 4;
        let area = self.seen_along(axis);
        let levels = self.columns(axis);
        let apart = |levels: &BTreeSet<i64>| {
            let (first, last) = (levels.first(), levels.last());
            first
                .zip(last)
                .is_some_and(|(first, last)| last - first + 1 > levels.len() as i64)
        };
        let mut depths: Vec<usize> = levels.values().map(BTreeSet::len).collect();
        depths.sort_unstable();
        let uneven = depths[depths.len() - 1] > UNEVEN * depths[depths.len() / 2];
        if uneven || levels.values().any(apart) {
            return Some(AreaCaution::Parts { axis, area });
        }
        let depth = |axis: usize| self.cells.len() as f64 / self.columns(axis).len() as f64;
        let others = (0..self.dimension).filter(|&c| c != axis);
        let other = others.min_by(|&a, &b| depth(a).total_cmp(&depth(b)))?;
        (depth(axis) > DEEPER * depth(other)).then(|| AreaCaution::Thinner {
            axis,
            area,
            other,
            face: self.seen_along(other),
        })
    }

    /// Returns the projected area of the set along an axis, m²: the area of the cells that no other cell of the set hides. For a
    /// box it is the area of a face, for a layer of a cylinder the area of the cells of its base.
    pub(crate) fn seen_along(&self, axis: usize) -> f64 {
        let count = self.columns(axis).len();
        let across = (0..self.dimension).filter(|&c| c != axis);
        let cell: f64 = across.map(|c| self.sides[c]).product();
        count as f64 * self.section * cell
    }

    /// Groups the cells into columns along an axis; returns the levels of each column.
    fn columns(&self, axis: usize) -> BTreeMap<[i64; 3], BTreeSet<i64>> {
        let mut columns: BTreeMap<[i64; 3], BTreeSet<i64>> = BTreeMap::new();
        for &cell in &self.cells {
            let mut column = cell;
            column[axis] = 0;
            columns.entry(column).or_default().insert(cell[axis]);
        }
        columns
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles::space::{Face, Grid, Shape, rectangular_cells};

    #[test]
    fn projected_areas_of_boxes_and_cylinders_are_exact() {
        let points = |shape, section| {
            let holes = vec![];
            Grid {
                shape,
                spacing: 0.1,
                section,
                holes,
            }
            .points()
            .unwrap()
        };
        let origin = [0.3, 0.0, 0.0];
        let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
        let area = |cloud: &PointCloud, axis| {
            let all: Vec<u32> = (0..cloud.len() as u32).collect();
            LoadedCells::new(cloud, &all).seen_along(axis)
        };
        let size = vec![2.0];
        close(area(&points(Shape::Box { origin, size }, 0.25), 0), 0.25);
        let size = vec![2.0, 1.0];
        let plate = points(Shape::Box { origin, size }, 0.25);
        close(area(&plate, 0), 0.25);
        close(area(&plate, 1), 0.5);
        let size = vec![2.0, 1.0, 3.0];
        close(area(&points(Shape::Box { origin, size }, 1.0), 1), 6.0);
        let oblong = rectangular_cells([0.0; 3], &[2.0, 1.0], &[0.1, 0.05], 0.25, &[]).unwrap();
        close(area(&oblong, 0), 0.25);
        close(area(&oblong, 1), 0.5);
        let rod = Shape::Cylinder {
            base: [0.0; 3],
            axis: 0,
            radius: 1.0,
            height: 2.0,
        };
        let rod = points(rod, 1.0);
        // Twenty cells along the axis count once.
        close(area(&rod, 0), rod.len() as f64 / 20.0 * 0.01);
    }

    #[test]
    fn sets_that_are_not_a_single_layer_are_reported() {
        let plate = Grid {
            shape: Shape::Box {
                origin: [0.0; 3],
                size: vec![8.0, 4.0],
            },
            spacing: 0.1,
            section: 1.0,
            holes: vec![],
        };
        let cloud = plate.points().unwrap();
        let set = |inside: &dyn Fn(f64, f64) -> bool| -> Vec<u32> {
            let all = 0..cloud.len() as u32;
            all.filter(|&i| {
                let [x, y, _] = cloud.point(i as usize);
                inside(x, y)
            })
            .collect()
        };
        let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
        let right = set(&|x, _| x > 7.7);
        assert_eq!(LoadedCells::new(&cloud, &right).caution(0), None);
        // Shear on a box three cells deep: the projection along the load is its narrow side.
        match LoadedCells::new(&cloud, &right).caution(1) {
            Some(AreaCaution::Thinner {
                axis: 1,
                area,
                other: 0,
                face,
            }) => {
                close(area, 0.3);
                close(face, 4.0);
            }
            other => panic!("{other:?}"),
        }
        // Opposite faces, and two faces with a common edge.
        for union in [
            set(&|x, _| !(0.3..7.7).contains(&x)),
            set(&|x, y| x > 7.7 || y > 3.7),
        ] {
            let caution = LoadedCells::new(&cloud, &union).caution(0);
            assert!(
                matches!(caution, Some(AreaCaution::Parts { axis: 0, .. })),
                "{caution:?}"
            );
        }
    }

    #[test]
    fn the_normal_axis_follows_from_the_layer_or_the_load() {
        let layer = Region::Layer {
            face: Face {
                axis: 1,
                upper: true,
            },
            depth: 1.0,
        };
        assert_eq!(normal_axis(Some(&layer), &[true, false, false]), Ok(1));
        assert_eq!(
            normal_axis(Some(&Region::All), &[false, true, false]),
            Ok(1)
        );
        assert!(normal_axis(None, &[true, true, false]).is_err());
        assert!(normal_axis(None, &[false; 3]).is_err());
    }
}
