//! Layers that bonds between points outside of them may not cross.

use std::collections::HashMap;

use crate::space::Point;
use crate::vector::{minus, norm, scaled};

/// The cubic cells around the points of a layer.
#[derive(Debug, Clone)]
pub(super) struct LayerCells {
    /// Points by the cell of a grid with the given spacing.
    cells: HashMap<[i64; 3], Vec<Point>>,
    spacing: f64,
    dimension: usize,
}

impl LayerCells {
    pub(super) fn new(points: &[Point], spacing: f64, dimension: usize) -> Self {
        let mut layer = Self {
            cells: HashMap::new(),
            spacing,
            dimension,
        };
        for &point in points {
            let cell = layer.cell(point);
            layer.cells.entry(cell).or_default().push(point);
        }
        layer
    }

    fn cell(&self, point: Point) -> [i64; 3] {
        std::array::from_fn(|c| match c < self.dimension {
            true => (point[c] / self.spacing).floor() as i64,
            false => 0,
        })
    }

    /// Returns whether a place is within the given distance of a point of the layer along every axis.
    fn contains(&self, place: Point, distance: f64) -> bool {
        let at = self.cell(place);
        let range = |c: usize| match c < self.dimension {
            true => at[c] - 1..=at[c] + 1,
            false => 0..=0,
        };
        let is_near = |point: &Point| {
            let mut axes = 0..self.dimension;
            axes.all(|c| (point[c] - place[c]).abs() < distance)
        };
        range(0).any(|x| {
            range(1).any(|y| {
                range(2).any(|z| {
                    let points = self.cells.get(&[x, y, z]);
                    points.is_some_and(|points| points.iter().any(is_near))
                })
            })
        })
    }

    /// Returns whether a bond between points outside of the layer crosses it.
    pub(super) fn cuts(&self, p: Point, q: Point) -> bool {
        /// Part of the spacing within which a point is one of the layer.
        const SAME: f64 = 1e-6;
        /// Half of a cell; a bond along its face does not cross it.
        const HALF: f64 = 0.5 * (1.0 - 1e-6);
        let same = SAME * self.spacing;
        if self.contains(p, same) || self.contains(q, same) {
            return false;
        }
        // Both ends of a bond examine the same places.
        let (from, to) = if p <= q { (p, q) } else { (q, p) };
        let along = minus(to, from);
        let parts = (4.0 * norm(along) / self.spacing).ceil().max(1.0);
        (0..parts as usize).any(|k| {
            let step = scaled((k as f64 + 0.5) / parts, along);
            let place = std::array::from_fn(|c| from[c] + step[c]);
            self.contains(place, HALF * self.spacing)
        })
    }

    /// Distance of a place from the nearest point of the layer.
    pub(super) fn distance(&self, place: Point) -> f64 {
        let points = self.cells.values().flatten();
        points
            .map(|&point| norm(minus(place, point)))
            .fold(f64::INFINITY, f64::min)
    }
}
