//! The area that a traction acts on, when the deck leaves it out.

use std::collections::BTreeSet;

use pericles::space::{PointCloud, Region};

/// The axis normal to the loaded face: that of a layer's face, else that of the load.
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
            Err("the set is no layer, and the traction is not along one of the axes")
        }
    }
}

/// The area of a set seen along an axis, m²: that of the cells which no other cell of the set hides. For a box it is a face of the box, for a
/// layer of a cylinder the cells of its base.
pub(crate) fn seen_along(cloud: &PointCloud, points: &[u32], axis: usize) -> f64 {
    let dimension = cloud.dimension();
    let [corner, _] = cloud.bounds();
    let columns: BTreeSet<[i64; 3]> = points
        .iter()
        .map(|&i| {
            let place = cloud.point(i as usize);
            // Centres of cells, divided ones too, lie well inside the large cells.
            let cell = |c: usize| ((place[c] - corner[c]) / cloud.cell_side(c)).floor() as i64;
            std::array::from_fn(|c| {
                if c == axis || c >= dimension {
                    0
                } else {
                    cell(c)
                }
            })
        })
        .collect();
    let across = (0..dimension).filter(|&c| c != axis);
    let cell: f64 = across.map(|c| cloud.cell_side(c)).product();
    columns.len() as f64 * cloud.section() * cell
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles::space::{Face, Grid, Shape, rectangular_cells};

    #[test]
    fn faces_of_boxes_and_bases_of_cylinders() {
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
            seen_along(cloud, &all, axis)
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
        // Twenty cells along the axis hide each other.
        close(area(&rod, 0), rod.len() as f64 / 20.0 * 0.01);
    }

    #[test]
    fn the_axis_is_that_of_the_layer_or_of_the_load() {
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
