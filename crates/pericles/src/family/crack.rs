//! Pre-cracks: surfaces that cut bonds before the run starts.

use crate::error::{PericlesError, Result};
use crate::space::{Point, Sites};

/// A surface no bond may cross.
#[derive(Debug, Clone, PartialEq)]
pub enum Crack {
    /// A cut bar (1D).
    Section {
        /// Where the bar is cut, m.
        x: f64,
    },
    /// A straight crack in a plate (2D).
    Segment {
        /// One end, m.
        from: [f64; 2],
        /// The other end, m.
        to: [f64; 2],
    },
    /// A plane convex or concave polygon in space (3D).
    Polygon {
        /// Corners in order, m; the last joins the first.
        corners: Vec<Point>,
    },
    /// A penny-shaped crack in space (3D).
    Disc {
        /// Centre, m.
        centre: Point,
        /// Normal of its plane, any length.
        normal: Point,
        /// Radius, m.
        radius: f64,
    },
}

/// What happens to bonds that pass exactly through the border of a crack.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum EndRule {
    /// They are cut: the surface contains its border.
    #[default]
    Closed,
    /// They are kept.
    Open,
}

impl Crack {
    /// The dimension of the bodies it can cut.
    pub fn dimension(&self) -> usize {
        match self {
            Self::Section { .. } => 1,
            Self::Segment { .. } => 2,
            Self::Polygon { .. } | Self::Disc { .. } => 3,
        }
    }

    /// Distance of a point from the crack's surface, m; that to infinity for a crack without extent.
    pub fn distance(&self, point: Point) -> f64 {
        match self.cutter(EndRule::Closed, 0.0) {
            Ok(cutter) => cutter.distance(point),
            Err(_) => f64::INFINITY,
        }
    }

    /// A test whether the bond from `p` to `q` meets the crack.
    ///
    /// Points within `tolerance` (m) of the surface count as on it; a bond with an end on the surface meets it, so points on a crack
    /// lose their bonds.
    ///
    /// # Errors
    /// A crack without extent, or a polygon that is not plane.
    pub fn cutter(&self, rule: EndRule, tolerance: f64) -> Result<Cutter> {
        let plane = match self {
            Self::Section { x } => {
                if !x.is_finite() {
                    return Err(PericlesError::BadCrack {
                        reason: "its position must be finite",
                    });
                }
                return Ok(Cutter {
                    frame: Frame {
                        origin: [*x, 0.0, 0.0],
                        normal: [1.0, 0.0, 0.0],
                        along: [0.0, 1.0, 0.0],
                        across: [0.0, 0.0, 1.0],
                    },
                    outline: Outline::Everything,
                    rule,
                    tolerance,
                });
            }
            Self::Segment { from, to } => {
                let along = [to[0] - from[0], to[1] - from[1], 0.0];
                let length = norm(along);
                if !length.is_finite() || length <= tolerance {
                    return Err(PericlesError::BadCrack {
                        reason: "its two ends must be finite and apart",
                    });
                }
                let along = scaled(along, 1.0 / length);
                return Ok(Cutter {
                    frame: Frame {
                        origin: [from[0], from[1], 0.0],
                        normal: [-along[1], along[0], 0.0],
                        along,
                        across: [0.0, 0.0, 1.0],
                    },
                    outline: Outline::Interval(length),
                    rule,
                    tolerance,
                });
            }
            Self::Polygon { corners } => {
                let frame = Frame::through(corners)?;
                let flat = corners.iter().all(|&corner| {
                    frame.height(corner).abs()
                        <= tolerance.max(1e-9 * norm(sub(corner, corners[0])))
                });
                if !flat {
                    return Err(PericlesError::BadCrack {
                        reason: "the corners of a polygon must lie in one plane",
                    });
                }
                let outline = corners.iter().map(|&corner| frame.place(corner)).collect();
                (frame, Outline::Polygon(outline))
            }
            Self::Disc {
                centre,
                normal,
                radius,
            } => {
                if !(radius.is_finite() && *radius > tolerance) {
                    return Err(PericlesError::BadCrack {
                        reason: "its radius must be positive and finite",
                    });
                }
                (Frame::normal_to(*centre, *normal)?, Outline::Disc(*radius))
            }
        };
        Ok(Cutter {
            frame: plane.0,
            outline: plane.1,
            rule,
            tolerance,
        })
    }
}

/// Orthonormal axes on a crack.
#[derive(Debug, Clone)]
struct Frame {
    origin: Point,
    normal: Point,
    along: Point,
    across: Point,
}

impl Frame {
    fn normal_to(origin: Point, normal: Point) -> Result<Self> {
        let length = norm(normal);
        if !(length.is_finite() && length > 0.0 && norm(origin).is_finite()) {
            return Err(PericlesError::BadCrack {
                reason: "its normal must be a finite vector other than zero",
            });
        }
        let normal = scaled(normal, 1.0 / length);
        let least = (0..3).fold(0, |best, c| {
            if normal[c].abs() < normal[best].abs() {
                c
            } else {
                best
            }
        });
        let mut axis = [0.0; 3];
        axis[least] = 1.0;
        let along = cross(normal, axis);
        let along = scaled(along, 1.0 / norm(along));
        Ok(Self {
            origin,
            normal,
            along,
            across: cross(normal, along),
        })
    }

    /// The plane of a polygon, its normal by Newell's sum, which does not depend on a lucky choice of three corners.
    fn through(corners: &[Point]) -> Result<Self> {
        let Some(&first) = corners.first() else {
            return Err(PericlesError::BadCrack {
                reason: "a polygon needs at least three corners",
            });
        };
        let mut normal = [0.0; 3];
        for k in 0..corners.len() {
            let (a, b) = (
                sub(corners[k], first),
                sub(corners[(k + 1) % corners.len()], first),
            );
            let part = cross(a, b);
            for c in 0..3 {
                normal[c] += part[c];
            }
        }
        let size = corners
            .iter()
            .map(|&p| norm(sub(p, first)))
            .fold(0.0, f64::max);
        let spans_area = norm(normal) > 1e-12 * size * size;
        if corners.len() < 3 || !spans_area {
            return Err(PericlesError::BadCrack {
                reason: "a polygon needs at least three corners that span an area",
            });
        }
        Self::normal_to(first, normal)
    }

    fn height(&self, p: Point) -> f64 {
        dot(sub(p, self.origin), self.normal)
    }

    fn place(&self, p: Point) -> [f64; 2] {
        let from = sub(p, self.origin);
        [dot(from, self.along), dot(from, self.across)]
    }
}

#[derive(Debug, Clone)]
enum Outline {
    Everything,
    Interval(f64),
    Polygon(Vec<[f64; 2]>),
    Disc(f64),
}

/// Decides which bonds a crack cuts; made by [`Crack::cutter`].
#[derive(Debug, Clone)]
pub struct Cutter {
    frame: Frame,
    outline: Outline,
    rule: EndRule,
    tolerance: f64,
}

impl Cutter {
    /// Whether the bond between two points meets the crack.
    pub fn cuts(&self, p: Point, q: Point) -> bool {
        let (a, b) = (self.frame.height(p), self.frame.height(q));
        let on = |height: f64| height.abs() <= self.tolerance;
        match (on(a), on(b)) {
            (true, true) => self.meets_in_plane(self.frame.place(p), self.frame.place(q)),
            (true, false) => self.covers(self.frame.place(p)),
            (false, true) => self.covers(self.frame.place(q)),
            (false, false) => {
                if (a > 0.0) == (b > 0.0) {
                    return false;
                }
                let (p, q) = (self.frame.place(p), self.frame.place(q));
                let fraction = a / (a - b);
                self.covers([
                    p[0] + fraction * (q[0] - p[0]),
                    p[1] + fraction * (q[1] - p[1]),
                ])
            }
        }
    }

    /// Whether the bond between two sites, or one of its images beyond periodic faces, meets the crack. Both ends of a bond compute it from the same numbers.
    pub fn cuts_bond(&self, sites: &Sites, here: usize, there: usize) -> bool {
        let places = sites.places();
        if !sites.cloud().is_periodic() {
            return self.cuts(places.point(here), places.point(there));
        }
        let shift = sites.shift(there);
        let periods = sites.periods();
        let unmoved = sites.of_point(sites.point(there));
        let [p, q] = [here, unmoved].map(|site| places.point(site));
        let moved = |x: Point, by: [i16; 3]| -> Point {
            std::array::from_fn(|c| x[c] + f64::from(by[c]) * periods[c])
        };
        // A crack may leave through a face and come in at the other.
        let steps = |c: usize| match c < places.dimension() {
            true => shift[c].min(0) - 1..=shift[c].max(0) + 1,
            false => 0..=0,
        };
        steps(2).any(|z| {
            steps(1).any(|y| {
                steps(0).any(|x| {
                    let [p_by, q_by] = [[-x, -y, -z], [shift[0] - x, shift[1] - y, shift[2] - z]];
                    self.cuts(moved(p, p_by), moved(q, q_by))
                })
            })
        })
    }

    /// Distance of a point from the surface.
    fn distance(&self, point: Point) -> f64 {
        let beside = (-self.depth(self.frame.place(point))).max(0.0);
        self.frame.height(point).hypot(beside)
    }

    /// Distance of a place of the crack's plane from the border, positive on the crack.
    fn depth(&self, place: [f64; 2]) -> f64 {
        match &self.outline {
            Outline::Everything => f64::INFINITY,
            Outline::Interval(length) => place[0].min(length - place[0]),
            Outline::Disc(radius) => radius - place[0].hypot(place[1]),
            Outline::Polygon(corners) => polygon_depth(place, corners),
        }
    }

    /// Whether a place of the crack's plane belongs to the crack.
    fn covers(&self, place: [f64; 2]) -> bool {
        let depth = self.depth(place);
        match self.rule {
            EndRule::Closed => depth >= -self.tolerance,
            EndRule::Open => depth > self.tolerance,
        }
    }

    /// A bond that lies in the crack's plane: whether any of it is covered.
    fn meets_in_plane(&self, p: [f64; 2], q: [f64; 2]) -> bool {
        if self.covers(p) || self.covers(q) {
            return true;
        }
        let at = |t: f64| [p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])];
        match &self.outline {
            Outline::Everything => true,
            // Neither end is on the crack: it is covered only if the crack lies between them.
            Outline::Interval(length) => (p[0] < 0.5 * length) != (q[0] < 0.5 * length),
            Outline::Disc(_) => {
                let d = [q[0] - p[0], q[1] - p[1]];
                let square = d[0] * d[0] + d[1] * d[1];
                let t = -(p[0] * d[0] + p[1] * d[1]) / square;
                (0.0..=1.0).contains(&t) && self.covers(at(t))
            }
            Outline::Polygon(corners) => (0..corners.len()).any(|k| {
                let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
                segments_cross(p, q, a, b)
            }),
        }
    }
}

/// Distance to the polygon's border, positive inside.
fn polygon_depth(place: [f64; 2], corners: &[[f64; 2]]) -> f64 {
    let mut inside = false;
    let mut distance = f64::INFINITY;
    for k in 0..corners.len() {
        let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
        let edge = [b[0] - a[0], b[1] - a[1]];
        let from = [place[0] - a[0], place[1] - a[1]];
        let square = edge[0] * edge[0] + edge[1] * edge[1];
        let t = if square > 0.0 {
            ((from[0] * edge[0] + from[1] * edge[1]) / square).clamp(0.0, 1.0)
        } else {
            0.0
        };
        distance = distance.min((from[0] - t * edge[0]).hypot(from[1] - t * edge[1]));
        if (a[1] > place[1]) != (b[1] > place[1])
            && place[0] < a[0] + (place[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        {
            inside = !inside;
        }
    }
    if inside { distance } else { -distance }
}

fn segments_cross(p: [f64; 2], q: [f64; 2], a: [f64; 2], b: [f64; 2]) -> bool {
    let side = |o: [f64; 2], s: [f64; 2], t: [f64; 2]| {
        (s[0] - o[0]) * (t[1] - o[1]) - (s[1] - o[1]) * (t[0] - o[0])
    };
    side(p, q, a) * side(p, q, b) < 0.0 && side(a, b, p) * side(a, b, q) < 0.0
}

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn norm(a: Point) -> f64 {
    dot(a, a).sqrt()
}

fn scaled(a: Point, factor: f64) -> Point {
    [a[0] * factor, a[1] * factor, a[2] * factor]
}

fn cross(a: Point, b: Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOLERANCE: f64 = 1e-9;

    fn cuts(crack: &Crack, rule: EndRule, p: Point, q: Point) -> bool {
        let cutter = crack.cutter(rule, TOLERANCE).unwrap();
        assert_eq!(
            cutter.cuts(p, q),
            cutter.cuts(q, p),
            "both ends of a bond must agree"
        );
        cutter.cuts(p, q)
    }

    #[test]
    fn a_segment_cuts_what_crosses_it() {
        let notch = Crack::Segment {
            from: [0.0, 0.0],
            to: [5.0, 0.0],
        };
        let closed = |p: [f64; 2], q: [f64; 2]| {
            cuts(
                &notch,
                EndRule::Closed,
                [p[0], p[1], 0.0],
                [q[0], q[1], 0.0],
            )
        };
        let open = |p: [f64; 2], q: [f64; 2]| {
            cuts(&notch, EndRule::Open, [p[0], p[1], 0.0], [q[0], q[1], 0.0])
        };
        assert!(closed([1.0, -0.5], [2.0, 0.5]) && open([1.0, -0.5], [2.0, 0.5]));
        assert!(!closed([5.5, -0.5], [5.5, 0.5]));
        assert!(!closed([1.0, 0.5], [2.0, 0.6]));
        // Exactly through the end.
        assert!(closed([4.5, -0.5], [5.5, 0.5]));
        assert!(!open([4.5, -0.5], [5.5, 0.5]));
        // A point on the crack loses its bonds by either rule.
        assert!(closed([2.0, 0.0], [2.0, 1.0]) && open([2.0, 0.0], [2.0, 1.0]));
        // Bonds along the line of the crack.
        assert!(closed([2.0, 0.0], [3.0, 0.0]) && closed([4.5, 0.0], [5.5, 0.0]));
        assert!(closed([-1.0, 0.0], [6.0, 0.0]));
        assert!(!closed([5.5, 0.0], [6.5, 0.0]));
    }

    #[test]
    fn discs_and_polygons_agree_where_they_overlap() {
        let disc = Crack::Disc {
            centre: [0.0, 0.0, 0.5],
            normal: [0.0, 0.0, 2.0],
            radius: 1.0,
        };
        let square = Crack::Polygon {
            corners: vec![
                [-1.0, -1.0, 0.5],
                [1.0, -1.0, 0.5],
                [1.0, 1.0, 0.5],
                [-1.0, 1.0, 0.5],
            ],
        };
        let through = |x: f64, y: f64| ([x, y, 0.0], [x, y, 1.0]);
        for (x, y, in_disc, in_square) in [
            (0.0, 0.0, true, true),
            (0.9, 0.9, false, true),
            (1.1, 0.0, false, false),
            (-0.7, 0.6, true, true),
        ] {
            let (p, q) = through(x, y);
            assert_eq!(cuts(&disc, EndRule::Closed, p, q), in_disc);
            assert_eq!(cuts(&square, EndRule::Closed, p, q), in_square);
        }
        let (p, q) = through(1.0, 0.0);
        assert!(cuts(&disc, EndRule::Closed, p, q) && !cuts(&disc, EndRule::Open, p, q));
        assert!(cuts(&square, EndRule::Closed, p, q) && !cuts(&square, EndRule::Open, p, q));
        // A bond in the plane, across the whole surface.
        let (p, q) = ([-3.0, 0.1, 0.5], [3.0, 0.1, 0.5]);
        assert!(cuts(&disc, EndRule::Closed, p, q) && cuts(&square, EndRule::Closed, p, q));
    }

    #[test]
    fn cracks_without_extent_are_refused() {
        let point = Crack::Segment {
            from: [1.0, 1.0],
            to: [1.0, 1.0],
        };
        assert!(point.cutter(EndRule::Closed, TOLERANCE).is_err());
        let line = Crack::Polygon {
            corners: vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]],
        };
        assert!(line.cutter(EndRule::Closed, TOLERANCE).is_err());
        let bent = Crack::Polygon {
            corners: vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 0.0]],
        };
        assert!(bent.cutter(EndRule::Closed, TOLERANCE).is_err());
    }
}
