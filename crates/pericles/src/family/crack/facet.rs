//! Plane parts of cracks and their intersection with bonds.

use super::EndRule;
use crate::error::{PericlesError, Result};
use crate::space::Point;
use crate::vector::{cross, dot, minus, norm, scaled};

/// A coordinate system with two axes in the crack plane.
#[derive(Debug, Clone)]
pub(super) struct Frame {
    pub(super) origin: Point,
    pub(super) normal: Point,
    pub(super) along: Point,
    pub(super) across: Point,
}

impl Frame {
    pub(super) fn normal_to(origin: Point, normal: Point) -> Result<Self> {
        let length = norm(normal);
        if !(length.is_finite() && length > 0.0 && norm(origin).is_finite()) {
            return Err(PericlesError::BadCrack {
                reason: "its normal must be a finite vector other than zero",
            });
        }
        let normal = scaled(1.0 / length, normal);
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
        let along = scaled(1.0 / norm(along), along);
        Ok(Self {
            origin,
            normal,
            along,
            across: cross(normal, along),
        })
    }

    /// The plane of a polygon. The normal is Newell's sum, which does not depend on the choice of three corners.
    pub(super) fn through(corners: &[Point]) -> Result<Self> {
        let Some(&first) = corners.first() else {
            return Err(PericlesError::BadCrack {
                reason: "a polygon needs at least three corners",
            });
        };
        let mut normal = [0.0; 3];
        for k in 0..corners.len() {
            let (a, b) = (
                minus(corners[k], first),
                minus(corners[(k + 1) % corners.len()], first),
            );
            let part = cross(a, b);
            for c in 0..3 {
                normal[c] += part[c];
            }
        }
        let size = corners
            .iter()
            .map(|&p| norm(minus(p, first)))
            .fold(0.0, f64::max);
        let spans_area = norm(normal) > 1e-12 * size * size;
        if corners.len() < 3 || !spans_area {
            return Err(PericlesError::BadCrack {
                reason: "a polygon needs at least three corners that are not on one line",
            });
        }
        Self::normal_to(first, normal)
    }

    pub(super) fn height(&self, p: Point) -> f64 {
        dot(minus(p, self.origin), self.normal)
    }

    pub(super) fn place(&self, p: Point) -> [f64; 2] {
        let from = minus(p, self.origin);
        [dot(from, self.along), dot(from, self.across)]
    }
}

#[derive(Debug, Clone)]
pub(super) enum Outline {
    Everything,
    Interval(f64),
    Polygon(Vec<[f64; 2]>),
    Disc(f64),
}

/// A plane part of a crack.
#[derive(Debug, Clone)]
pub(super) struct Facet {
    pub(super) frame: Frame,
    pub(super) outline: Outline,
    pub(super) rule: EndRule,
    pub(super) tolerance: f64,
}

impl Facet {
    /// Returns whether the bond between two points meets the facet.
    pub(super) fn cuts(&self, p: Point, q: Point) -> bool {
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

    /// Distance of a point from the facet.
    pub(super) fn distance(&self, point: Point) -> f64 {
        let beside = (-self.depth(self.frame.place(point))).max(0.0);
        self.frame.height(point).hypot(beside)
    }

    /// Signed distance of a point of the crack plane from the edge, positive on the crack.
    fn depth(&self, place: [f64; 2]) -> f64 {
        match &self.outline {
            Outline::Everything => f64::INFINITY,
            Outline::Interval(length) => place[0].min(length - place[0]),
            Outline::Disc(radius) => radius - place[0].hypot(place[1]),
            Outline::Polygon(corners) => polygon_depth(place, corners),
        }
    }

    /// Returns whether a point of the crack plane belongs to the crack.
    fn covers(&self, place: [f64; 2]) -> bool {
        let depth = self.depth(place);
        match self.rule {
            EndRule::Closed => depth >= -self.tolerance,
            EndRule::Open => depth > self.tolerance,
        }
    }

    /// Returns whether any part of a bond in the crack plane is on the crack.
    fn meets_in_plane(&self, p: [f64; 2], q: [f64; 2]) -> bool {
        if self.covers(p) || self.covers(q) {
            return true;
        }
        let at = |t: f64| [p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])];
        match &self.outline {
            Outline::Everything => true,
            // Neither end is on the crack: the bond meets it only if the crack lies between them.
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

/// Signed distance to the edge of the polygon, positive inside.
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
