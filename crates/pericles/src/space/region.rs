//! Regions of space that define holes, sets and layers.

use std::fmt;

use super::Point;
use crate::error::{PericlesError, Result};

/// A face of the bounding box of a body, named by its outward normal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Face {
    /// Axis of the outward normal: 0, 1 or 2.
    pub axis: usize,
    /// True for the face at the upper end of the axis.
    pub upper: bool,
}

impl fmt::Display for Face {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sign = if self.upper { '+' } else { '-' };
        write!(f, "{sign}{}", ['x', 'y', 'z'][self.axis])
    }
}

impl Face {
    /// Returns the face with the name `-x`, `+x`, `-y`, `+y`, `-z` or `+z`.
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
    /// A box along the axes; infinite bounds are allowed.
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
        /// A point on the axis, m.
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
        /// Outward normal of any length.
        normal: Point,
    },
    /// Points within `depth` of a face of the bounding box of the body.
    Layer {
        /// The face.
        face: Face,
        /// Depth of the layer, m.
        depth: f64,
    },
    /// Points of a 2D polygon, extended infinitely along z.
    Polygon {
        /// Corners in order, m; the last one connects to the first.
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
    /// Layer of a body within `depth` (m) of the face with this outward normal: `-x`, `+x`, `-y`, `+y`, `-z` or
    /// `+z`.
    ///
    /// # Errors
    /// A name that is not a face.
    pub fn layer(face: &str, depth: f64) -> Result<Self> {
        let face =
            Face::named(face).ok_or_else(|| PericlesError::UnknownFace { name: face.into() })?;
        Ok(Self::Layer { face, depth })
    }

    /// Returns whether `point` lies in the region, for a body with bounding box `bounds`. Points within `tolerance`
    /// (m) of the boundary count as inside.
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
                // Axes beyond 2 do not exist, nor do layers along them.
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
    fn unions_intersections_and_complements_combine_regions() {
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
    fn polygons_use_the_even_odd_rule() {
        let corners = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let triangle = Region::Polygon { corners };
        assert!(has(&triangle, 0.3, 0.3) && !has(&triangle, 0.7, 0.7));
        assert!(!has(&Region::Polygon { corners: vec![] }, 0.0, 0.0));
    }
}
