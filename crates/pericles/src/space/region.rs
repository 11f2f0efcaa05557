//! Regions of space, from which holes, sets and layers are made.

use super::Point;
use crate::error::{PericlesError, Result};

/// A face of a body's bounding box, named by its outward normal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Face {
    /// The axis of the outward normal: 0, 1 or 2.
    pub axis: usize,
    /// True for the face at the axis' upper end.
    pub upper: bool,
}

impl Face {
    /// The face called `-x`, `+x`, `-y`, `+y`, `-z` or `+z`.
    pub fn named(name: &str) -> Option<Self> {
        let mut letters = name.chars();
        let upper = match letters.next()? {
            '+' => true,
            '-' => false,
            _ => return None,
        };
        let axis = match letters.next()? {
            'x' => 0,
            'y' => 1,
            'z' => 2,
            _ => return None,
        };
        letters.next().is_none().then_some(Self { axis, upper })
    }
}

/// A closed region of space.
#[derive(Debug, Clone, PartialEq)]
pub enum Region {
    /// All of space.
    All,
    /// Axis-parallel box; infinite bounds are allowed.
    Box {
        /// Lower corner, m.
        min: Point,
        /// Upper corner, m.
        max: Point,
    },
    /// Points within `radius` of `centre` (a disc in 2D, an interval in 1D).
    Ball {
        /// Centre, m.
        centre: Point,
        /// Radius, m.
        radius: f64,
    },
    /// Points within `radius` of the infinite line through `centre` along the coordinate axis `axis`.
    Cylinder {
        /// A point of the axis, m.
        centre: Point,
        /// Coordinate axis: 0, 1 or 2.
        axis: usize,
        /// Radius, m.
        radius: f64,
    },
    /// Points x with (x − point)·normal ≤ 0.
    HalfSpace {
        /// A point of the bounding plane, m.
        point: Point,
        /// Outward normal, any length.
        normal: Point,
    },
    /// Points within `depth` of a face of the body's bounding box.
    Layer {
        /// The face.
        face: Face,
        /// Depth of the layer, m.
        depth: f64,
    },
    /// Points of a 2D polygon, extended infinitely along z.
    Polygon {
        /// Corners in order, m; the last joins the first.
        corners: Vec<[f64; 2]>,
    },
    /// Points in any of the regions.
    Union(Vec<Region>),
    /// Points in all of the regions.
    Intersection(Vec<Region>),
    /// Points outside the region.
    Complement(Box<Region>),
}

impl Region {
    /// The layer of a body within `depth` (m) of its face with this outward normal: `-x`, `+x`, `-y`, `+y`, `-z` or `+z`.
    ///
    /// # Errors
    /// Another name.
    pub fn layer(face: &str, depth: f64) -> Result<Self> {
        let face =
            Face::named(face).ok_or_else(|| PericlesError::UnknownFace { name: face.into() })?;
        Ok(Self::Layer { face, depth })
    }

    /// Whether `point` lies in the region of a body whose bounding box (of its cells) is `bounds`. Points on the boundary count
    /// as inside, up to `tolerance` (m).
    pub fn contains(&self, point: Point, bounds: &[Point; 2], tolerance: f64) -> bool {
        let inside = |region: &Region| region.contains(point, bounds, tolerance);
        match self {
            Self::All => true,
            Self::Box { min, max } => {
                (0..3).all(|c| point[c] >= min[c] - tolerance && point[c] <= max[c] + tolerance)
            }
            Self::Ball { centre, radius } => {
                let square: f64 = (0..3).map(|c| (point[c] - centre[c]).powi(2)).sum();
                square.sqrt() <= radius + tolerance
            }
            Self::Cylinder {
                centre,
                axis,
                radius,
            } => {
                let square: f64 = (0..3)
                    .filter(|c| c != axis)
                    .map(|c| (point[c] - centre[c]).powi(2))
                    .sum();
                square.sqrt() <= radius + tolerance
            }
            Self::HalfSpace { point: on, normal } => {
                let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
                let height: f64 = (0..3).map(|c| (point[c] - on[c]) * normal[c]).sum();
                height <= tolerance * length
            }
            Self::Layer { face, depth } => {
                // Space has no other axes, and no layers along them.
                let [Some(low), Some(high), Some(place)] = [
                    bounds[0].get(face.axis),
                    bounds[1].get(face.axis),
                    point.get(face.axis),
                ] else {
                    return false;
                };
                let inward = if face.upper {
                    high - place
                } else {
                    place - low
                };
                inward <= depth + tolerance
            }
            Self::Polygon { corners } => in_polygon([point[0], point[1]], corners),
            Self::Union(parts) => parts.iter().any(inside),
            Self::Intersection(parts) => parts.iter().all(inside),
            Self::Complement(part) => !inside(part),
        }
    }
}

/// Even–odd rule.
fn in_polygon(point: [f64; 2], corners: &[[f64; 2]]) -> bool {
    let mut inside = false;
    let mut previous = match corners.last() {
        Some(corner) => corner,
        None => return false,
    };
    for corner in corners {
        if (corner[1] > point[1]) != (previous[1] > point[1]) {
            let fraction = (point[1] - corner[1]) / (previous[1] - corner[1]);
            if point[0] < corner[0] + fraction * (previous[0] - corner[0]) {
                inside = !inside;
            }
        }
        previous = corner;
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::*;

    const BOUNDS: [Point; 2] = [[0.0, 0.0, 0.0], [2.0, 1.0, 0.0]];

    fn has(region: &Region, x: f64, y: f64) -> bool {
        region.contains([x, y, 0.0], &BOUNDS, 1e-12)
    }

    #[test]
    fn layers_follow_the_bounding_box() {
        let layer = Region::Layer {
            face: Face::named("+x").unwrap(),
            depth: 0.25,
        };
        assert!(has(&layer, 1.75, 0.5));
        assert!(!has(&layer, 1.74, 0.5));
        assert_eq!(Face::named("x"), None);
        assert_eq!(Face::named("+xy"), None);
    }

    #[test]
    fn regions_combine() {
        let ball = Region::Ball {
            centre: [1.0, 0.5, 0.0],
            radius: 0.3,
        };
        let left = Region::HalfSpace {
            point: [1.0, 0.0, 0.0],
            normal: [3.0, 0.0, 0.0],
        };
        let half_ball = Region::Intersection(vec![ball.clone(), left.clone()]);
        let outside = Region::Complement(Box::new(ball.clone()));
        assert!(has(&half_ball, 0.9, 0.5) && !has(&half_ball, 1.1, 0.5));
        assert!(has(&outside, 0.0, 0.0) && !has(&outside, 1.0, 0.5));
        let either = Region::Union(vec![ball, left]);
        assert!(has(&either, 1.1, 0.5) && has(&either, 0.1, 0.9) && !has(&either, 1.9, 0.9));
    }

    #[test]
    fn polygon_is_decided_by_crossings() {
        let corners = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let triangle = Region::Polygon { corners };
        assert!(has(&triangle, 0.3, 0.3) && !has(&triangle, 0.7, 0.7));
        assert!(!has(&Region::Polygon { corners: vec![] }, 0.0, 0.0));
    }
}
