//! Pre-cracks: surfaces whose bonds are removed before the run starts.

mod facet;
mod grid;
mod layer;

use crate::error::{PericlesError, Result};
use crate::space::{Point, Sites};
use crate::vector::{minus, norm, scaled};

use facet::{Facet, Frame, Outline};
use grid::FacetGrid;
use layer::LayerCells;

/// A surface that no bond may cross.
#[derive(Debug, Clone, PartialEq)]
pub enum Crack {
    /// A cut through a bar (1D).
    Section {
        /// Coordinate of the cut, m.
        x: f64,
    },
    /// A straight crack in a plate (2D).
    Segment {
        /// One end, m.
        from: [f64; 2],
        /// The other end, m.
        to: [f64; 2],
    },
    /// A plane polygon, convex or concave (3D).
    Polygon {
        /// Corners in order, m; the last one connects to the first.
        corners: Vec<Point>,
    },
    /// A circular (penny-shaped) crack (3D).
    Disc {
        /// Centre, m.
        centre: Point,
        /// Normal of its plane, of any length.
        normal: Point,
        /// Radius, m.
        radius: f64,
    },
    /// A triangulated surface, edges included (3D).
    Triangles {
        /// Corners of the triangles, m; triangles without area are ignored.
        triangles: Vec<[Point; 3]>,
    },
    /// A layer of points: bonds between points outside of it do not cross it, while bonds with an end in it remain. For
    /// layers thinner than the horizon, which bonds would bridge otherwise.
    Layer {
        /// Points of the layer, m.
        points: Vec<Point>,
        /// Side of the cells of the points, m.
        spacing: f64,
        /// Dimension of the body.
        dimension: usize,
    },
}

/// Treatment of bonds that pass exactly through the edge of a crack.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum EndRule {
    /// They are removed: the crack includes its edge.
    #[default]
    Closed,
    /// They remain.
    Open,
}

impl Crack {
    /// Dimension of the bodies to which the crack applies.
    pub fn dimension(&self) -> usize {
        match self {
            Self::Section { .. } => 1,
            Self::Segment { .. } => 2,
            Self::Polygon { .. } | Self::Disc { .. } | Self::Triangles { .. } => 3,
            Self::Layer { dimension, .. } => *dimension,
        }
    }

    /// Distance of a point from the crack, m; infinite for a crack without extent.
    pub fn distance(&self, point: Point) -> f64 {
        match self.cutter(EndRule::Closed, 0.0) {
            Ok(cutter) => cutter.distance(point),
            Err(_) => f64::INFINITY,
        }
    }

    /// Returns a test whether the bond from `p` to `q` meets the crack.
    ///
    /// Points within `tolerance` (m) of the crack count as on it. A bond with an end on the crack meets it, so that
    /// points on a crack lose all their bonds.
    ///
    /// # Errors
    /// A crack without extent, or a polygon that is not plane.
    pub fn cutter(&self, rule: EndRule, tolerance: f64) -> Result<Cutter> {
        if let Self::Layer {
            points,
            spacing,
            dimension,
        } = self
        {
            let layer = LayerCells::new(points, *spacing, *dimension);
            return Ok(Cutter(Facets::Layer(layer)));
        }
        let Self::Triangles { triangles } = self else {
            return Ok(Cutter(Facets::One(self.facet(rule, tolerance)?)));
        };
        let facet = |corners: &[Point; 3]| {
            let triangle = Self::Polygon {
                corners: corners.to_vec(),
            };
            // Edges shared by neighbouring triangles belong to the surface.
            let facet = triangle.facet(EndRule::Closed, tolerance).ok()?;
            Some((*corners, facet))
        };
        let (corners, facets): (Vec<[Point; 3]>, Vec<Facet>) =
            triangles.iter().filter_map(facet).unzip();
        if facets.is_empty() {
            return Err(PericlesError::BadCrack {
                reason: "all of its triangles have zero area",
            });
        }
        let grid = FacetGrid::new(&corners, tolerance);
        Ok(Cutter(Facets::Many { facets, grid }))
    }

    fn facet(&self, rule: EndRule, tolerance: f64) -> Result<Facet> {
        let plane = match self {
            Self::Section { x } => {
                if !x.is_finite() {
                    return Err(PericlesError::BadCrack {
                        reason: "its position must be finite",
                    });
                }
                return Ok(Facet {
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
                        reason: "its two ends must be finite and distinct",
                    });
                }
                let along = scaled(1.0 / length, along);
                return Ok(Facet {
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
                        <= tolerance.max(1e-9 * norm(minus(corner, corners[0])))
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
            Self::Triangles { .. } | Self::Layer { .. } => {
                return Err(PericlesError::BadCrack {
                    reason: "a surface of triangles or a layer is not supported here",
                });
            }
        };
        Ok(Facet {
            frame: plane.0,
            outline: plane.1,
            rule,
            tolerance,
        })
    }
}

/// The test which bonds a crack removes; made by [`Crack::cutter`].
#[derive(Debug, Clone)]
pub struct Cutter(Facets);

#[derive(Debug, Clone)]
enum Facets {
    One(Facet),
    Many { facets: Vec<Facet>, grid: FacetGrid },
    Layer(LayerCells),
}

impl Cutter {
    /// Returns whether the bond between two points meets the crack.
    pub fn cuts(&self, p: Point, q: Point) -> bool {
        match &self.0 {
            Facets::One(facet) => facet.cuts(p, q),
            Facets::Many { facets, grid } => {
                let mut near = grid.near(p, q);
                near.any(|facet| facets[facet as usize].cuts(p, q))
            }
            Facets::Layer(layer) => layer.cuts(p, q),
        }
    }

    /// Returns whether the bond between two sites, or one of its images beyond periodic faces, meets the crack.
    /// Both ends of a bond compute it from the same numbers.
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
        // A crack may leave through one face and re-enter through the opposite one.
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

    /// Distance of a point from the crack.
    fn distance(&self, point: Point) -> f64 {
        match &self.0 {
            Facets::One(facet) => facet.distance(point),
            Facets::Many { facets, .. } => {
                let distances = facets.iter().map(|facet| facet.distance(point));
                distances.fold(f64::INFINITY, f64::min)
            }
            Facets::Layer(layer) => layer.distance(point),
        }
    }
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
    fn a_segment_cuts_the_bonds_that_cross_it() {
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
        // Exactly through the end of the crack.
        assert!(closed([4.5, -0.5], [5.5, 0.5]));
        assert!(!open([4.5, -0.5], [5.5, 0.5]));
        // A point on the crack loses its bonds under either rule.
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
    fn cracks_without_extent_are_rejected() {
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

    #[test]
    fn triangles_cut_the_same_bonds_as_their_polygon() {
        // A square of 2 × n × n triangles in a tilted plane, compared with the polygon including its edge.
        let n = 7;
        let at = |i: usize, j: usize| -> Point {
            let (x, y) = (i as f64 / n as f64, j as f64 / n as f64);
            [x, y, 0.3 + 0.2 * x - 0.1 * y]
        };
        let mut triangles = Vec::new();
        for i in 0..n {
            for j in 0..n {
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        // A triangle without area is ignored.
        triangles.push([at(0, 0); 3]);
        let triangles = Crack::Triangles { triangles };
        let polygon = Crack::Polygon {
            corners: vec![at(0, 0), at(n, 0), at(n, n), at(0, n)],
        };
        let mut seen = [0; 2];
        for k in 0..4000u32 {
            let x = |salt: u32| f64::from((k * 7919 + salt * 104_729) % 4001) / 4001.0 * 1.4 - 0.2;
            let (p, q) = ([x(1), x(2), x(3)], [x(4), x(5), x(6)]);
            let cut = cuts(&polygon, EndRule::Closed, p, q);
            assert_eq!(cuts(&triangles, EndRule::Open, p, q), cut, "{p:?} {q:?}");
            seen[usize::from(cut)] += 1;
        }
        assert!(seen.iter().all(|count| *count > 500), "{seen:?}");
        let place = [0.4, 0.4, 0.9];
        let (one, many) = (polygon.distance(place), triangles.distance(place));
        assert!((one - many).abs() < 1e-12, "{one} {many}");
        let none = Crack::Triangles {
            triangles: vec![[[0.0; 3]; 3]],
        };
        assert!(none.cutter(EndRule::Closed, TOLERANCE).is_err());
    }
}
