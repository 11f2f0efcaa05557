//! Lines on pictures that move with the body: pre-cracks, interfaces of materials, borders of refined parts.

use pericles::vector::cross;
use std::collections::HashMap;
use std::f64::consts::TAU;

use pericles::family::Crack;
use pericles::space::{Point, PointCloud};

use super::cell_mesh::CellMesh;
use super::motion::Motion;
use crate::numbering::points_by_number;

/// Lines on a body.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Overlay {
    lines: Vec<Vec<Carried>>,
}

/// A line at rest: places, each with the two points with whose mean it moves.
pub type CarriedLine = Vec<(Point, [u32; 2])>;

/// A place that moves with the mean of two points, which may be the same.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Carried {
    place: Point,
    points: [u32; 2],
}

/// Corners of a polygon that shows a circle.
const AROUND: usize = 64;

impl Overlay {
    /// Creates the lines of a body; points of different classes must be the centres of boxes.
    pub(super) fn new(cloud: &PointCloud, cracks: &[Crack], classes: &[u32]) -> Self {
        let mut lines: Vec<Vec<Carried>> = cracks
            .iter()
            .flat_map(|crack| crack_lines(cloud, crack))
            .collect();
        let is_uniform = classes.windows(2).all(|pair| pair[0] == pair[1]);
        if !is_uniform && cloud.dimension() == 2 {
            lines.extend(interfaces(cloud, &CellMesh::of_boxes(cloud), classes));
        }
        Self { lines }
    }

    /// Returns the lines at rest: places, each with the two points with whose mean it moves.
    pub(super) fn at_rest(&self) -> impl Iterator<Item = CarriedLine> + '_ {
        let of_line = |line: &Vec<Carried>| {
            line.iter()
                .map(|carried| (carried.place, carried.points))
                .collect()
        };
        self.lines.iter().map(of_line)
    }

    /// Returns the displaced lines, interrupted where fragments tear them apart and where their two points separate by more
    /// than the spacing.
    pub(super) fn lines<'a>(
        &'a self,
        motion: &'a Motion<'_>,
    ) -> impl Iterator<Item = Vec<Point>> + 'a {
        /// Drawn length of a part relative to that at rest.
        const TORN: f64 = 3.0;
        let spacing = motion.cloud.spacing();
        let ends = move |carried: &Carried| {
            let points = carried.points;
            points.map(|point| motion.place(carried.place, point as usize))
        };
        let moved = move |carried: &Carried| -> Point {
            let [a, b] = ends(carried);
            std::array::from_fn(|c| 0.5 * (a[c] + b[c]))
        };
        let is_together = move |carried: &Carried| {
            let [a, b] = ends(carried);
            squared_distance(a, b) <= spacing * spacing
        };
        let is_whole = move |a: &Carried, b: &Carried| {
            let drawn = squared_distance(moved(a), moved(b));
            let rest = squared_distance(a.place, b.place);
            drawn <= TORN.powi(2) * rest && is_together(a) && is_together(b)
        };
        let parts = self
            .lines
            .iter()
            .flat_map(move |line| line.chunk_by(is_whole));
        let parts = parts.filter(|part| part.len() > 1);
        parts.map(move |part| part.iter().map(moved).collect())
    }
}

/// Returns the lines of a pre-crack: both sides of a segment in the plane, the outline of a plane crack in space.
fn crack_lines(cloud: &PointCloud, crack: &Crack) -> Vec<Vec<Carried>> {
    match crack {
        Crack::Segment { from, to } => {
            let normal = [from[1] - to[1], to[0] - from[0], 0.0];
            let opposite = normal.map(|x| -x);
            let along = Along::new(cloud, &[from, to].map(|&[x, y]| [x, y, 0.0]));
            let sides = [normal, opposite].into_iter();
            sides.flat_map(|side| along.carried([side; 2])).collect()
        }
        Crack::Polygon { corners } => {
            let closed: Vec<Point> = corners.iter().chain(corners.first()).copied().collect();
            let normal = normal_of(corners);
            Along::new(cloud, &closed).carried([normal, normal.map(|x| -x)])
        }
        Crack::Disc {
            centre,
            normal,
            radius,
        } => {
            let along = Along::new(cloud, &circle(*centre, *normal, *radius));
            along.carried([*normal, normal.map(|x| -x)])
        }
        Crack::Section { .. } | Crack::Triangles { .. } | Crack::Layer { .. } => Vec::new(),
    }
}

/// Returns a normal of a plane polygon, of any length.
fn normal_of(corners: &[Point]) -> Point {
    let arm = |corner: Point| -> Point { std::array::from_fn(|c| corner[c] - corners[0][c]) };
    let parts = corners
        .windows(2)
        .map(|pair| cross(arm(pair[0]), arm(pair[1])));
    parts.fold([0.0; 3], |sum, part| {
        std::array::from_fn(|c| sum[c] + part[c])
    })
}

/// Returns the corners of a closed polygon on a circle.
fn circle(centre: Point, normal: Point, radius: f64) -> Vec<Point> {
    let unit = |a: Point| {
        let length = a.iter().map(|x| x * x).sum::<f64>().sqrt();
        a.map(|x| x / length)
    };
    let normal = unit(normal);
    let mut axis = [0.0; 3];
    let least = (0..3).min_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs()));
    axis[least.unwrap_or(0)] = 1.0;
    let first = unit(cross(normal, axis));
    let second = cross(normal, first);
    let corner = |k: usize| {
        let (sin, cos) = ((k % AROUND) as f64 * TAU / AROUND as f64).sin_cos();
        std::array::from_fn(|c| centre[c] + radius * (cos * first[c] + sin * second[c]))
    };
    (0..=AROUND).map(corner).collect()
}

/// Places along a line, with the points near the line.
struct Along<'a> {
    cloud: &'a PointCloud,
    places: Vec<Point>,
    near: Vec<u32>,
}

impl<'a> Along<'a> {
    /// Divides a line with the given corners into parts of half the point spacing.
    fn new(cloud: &'a PointCloud, corners: &[Point]) -> Self {
        /// Largest number of parts of one side.
        const MOST: f64 = 4000.0;
        /// Distance of points near the line, in cells.
        const NEAR: f64 = 1.8;
        let mut places = Vec::new();
        for pair in corners.windows(2) {
            let length = squared_distance(pair[0], pair[1]).sqrt();
            let parts = (2.0 * length / cloud.spacing()).ceil().clamp(1.0, MOST);
            for k in 0..=parts as usize {
                let place: Point = std::array::from_fn(|c| {
                    pair[0][c] + (pair[1][c] - pair[0][c]) * k as f64 / parts
                });
                if places.last() != Some(&place) {
                    places.push(place);
                }
            }
        }
        let is_near = |&i: &u32| {
            let (x, reach) = (cloud.point(i as usize), NEAR * cloud.cell_size(i as usize));
            let mut pairs = corners.windows(2);
            pairs.any(|pair| squared_distance(x, foot(x, pair[0], pair[1])) < reach * reach)
        };
        Self {
            near: (0..cloud.len() as u32).filter(is_near).collect(),
            cloud,
            places,
        }
    }

    /// Returns whether a place is inside the body, at least `depth` cells from its boundary.
    fn is_inside(&self, place: Point, depth: f64) -> bool {
        /// A place belongs to the body if it is within this distance of a point along every axis, in cells.
        const INSIDE: f64 = 0.6;
        let spacing = self.cloud.spacing();
        (0..6).all(|k| {
            let mut shifted = place;
            shifted[k / 2] += if k % 2 == 0 { depth } else { -depth } * spacing;
            self.near.iter().any(|&i| {
                let x = self.cloud.point(i as usize);
                let reach = INSIDE * self.cloud.cell_size(i as usize);
                (0..3).all(|c| (x[c] - shifted[c]).abs() <= reach)
            })
        })
    }

    /// Returns the parts of the line inside the body. Places move with the mean of the nearest points on two sides, to
    /// which these normals point. If the sides differ, parts on the boundary are left out.
    fn carried(&self, sides: [Point; 2]) -> Vec<Vec<Carried>> {
        /// Distance of places from the boundary, in cells, for lines that are not drawn there.
        const DEPTH: f64 = 0.3;
        let is_outline = sides[0] != sides[1];
        let depth = if is_outline { DEPTH } else { 0.0 };
        let mut lines = vec![Vec::new()];
        for &place in &self.places {
            let mut nearest = [(None, f64::INFINITY); 2];
            for &i in &self.near {
                let x = self.cloud.point(i as usize);
                let distance = squared_distance(x, place);
                for ((nearest, least), normal) in nearest.iter_mut().zip(sides) {
                    let beyond: f64 = (0..3).map(|c| normal[c] * (x[c] - place[c])).sum();
                    if beyond >= 0.0 && distance < *least {
                        (*nearest, *least) = (Some(i), distance);
                    }
                }
            }
            let [one, other] = nearest.map(|(nearest, _)| nearest);
            match (one.or(other), other.or(one), lines.last_mut()) {
                (Some(one), Some(other), Some(line)) if self.is_inside(place, depth) => {
                    line.push(Carried {
                        place,
                        points: [one, other],
                    })
                }
                _ => lines.push(Vec::new()),
            }
        }
        lines.retain(|line| line.len() > 1);
        lines
    }
}

fn squared_distance(a: Point, b: Point) -> f64 {
    (0..3).map(|c| (a[c] - b[c]).powi(2)).sum()
}

/// Returns the place on a segment that is nearest to a point.
fn foot(x: Point, from: Point, to: Point) -> Point {
    let along: Point = std::array::from_fn(|c| to[c] - from[c]);
    let square: f64 = along.iter().map(|x| x * x).sum();
    let projection: f64 = (0..3).map(|c| along[c] * (x[c] - from[c])).sum();
    let part = match square > 0.0 {
        true => (projection / square).clamp(0.0, 1.0),
        false => 0.0,
    };
    std::array::from_fn(|c| from[c] + part * along[c])
}

/// Returns the edges between cells of different class; where cells of different size meet, the edges of the cells that are
/// not of the first class.
fn interfaces(cloud: &PointCloud, mesh: &CellMesh, class: &[u32]) -> Vec<Vec<Carried>> {
    let nodes = mesh.nodes.len() / 3;
    let of_number = points_by_number(cloud);
    let place =
        |node: u32| -> Point { std::array::from_fn(|c| mesh.nodes[c * nodes + node as usize]) };
    let edge = |(a, b): (u32, u32), points: [u32; 2]| -> Vec<Carried> {
        let ends = [a, b].map(place);
        ends.map(|place| Carried { place, points }).to_vec()
    };
    let mut open: HashMap<(u32, u32), u32> = HashMap::new();
    let mut found = Vec::new();
    for (cell, &number) in mesh.points.iter().enumerate() {
        let point = of_number[number as usize];
        let corners = mesh.cells.corners_of(cell);
        for (k, &a) in corners.iter().enumerate() {
            let b = corners[(k + 1) % corners.len()];
            let key = (a.min(b), a.max(b));
            match open.remove(&key) {
                Some(other) if class[other as usize] != class[point as usize] => {
                    found.push(edge(key, [other, point]));
                }
                Some(_) => {}
                None => {
                    open.insert(key, point);
                }
            }
        }
    }
    let [low, high] = cloud.bounds();
    let slack = 1e-3 * cloud.spacing();
    let is_outer = |ends: &[Carried]| {
        (0..2).any(|c| {
            let on = |x: f64| ends.iter().all(|end| (end.place[c] - x).abs() < slack);
            on(low[c]) || on(high[c])
        })
    };
    let base = class[0];
    let mut hanging: Vec<_> = open.into_iter().collect();
    hanging.sort_unstable();
    for (key, point) in hanging {
        let single = edge(key, [point, point]);
        if class[point as usize] != base && !is_outer(&single) {
            found.push(single);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles::space::{Grid, Shape};

    fn plate() -> PointCloud {
        let shape = Shape::Box {
            origin: [0.0; 3],
            size: vec![4.0, 2.0],
        };
        let plate = Grid {
            shape,
            spacing: 1.0,
            section: 1.0,
            holes: vec![],
        };
        plate.points().unwrap()
    }

    #[test]
    fn interfaces_are_the_edges_between_classes_and_move_with_the_body() {
        let cloud = plate();
        let class: Vec<u32> = cloud.axis(0).iter().map(|&x| u32::from(x > 2.0)).collect();
        let overlay = Overlay::new(&cloud, &[], &class);
        let mut u = vec![0.0; 16];
        u[..8].fill(0.5);
        let lines: Vec<_> = overlay.lines(&Motion::new(&cloud, &u, 2.0)).collect();
        let mut heights: Vec<f64> = lines.iter().flatten().map(|p| p[1]).collect();
        heights.sort_by(f64::total_cmp);
        assert_eq!(heights, [0.0, 1.0, 1.0, 2.0]);
        assert!(lines.iter().flatten().all(|p| p[0] == 3.0));
    }

    #[test]
    fn both_sides_of_a_pre_crack_move_with_the_body() {
        let cloud = plate();
        let crack = Crack::Segment {
            from: [-3.0, 1.0],
            to: [2.0, 1.0],
        };
        let overlay = Overlay::new(&cloud, &[crack], &[]);
        // The upper row moves up, both move to the right.
        let mut u = vec![0.5; 16];
        u[8..12].fill(0.0);
        u[12..].fill(0.1);
        let lines: Vec<_> = overlay.lines(&Motion::new(&cloud, &u, 10.0)).collect();
        assert_eq!(lines.len(), 2);
        let heights: Vec<f64> = lines.iter().map(|line| line[0][1]).collect();
        assert_eq!(heights, [2.0, 1.0]);
        for line in &lines {
            assert!(line.iter().all(|p| p[1] == line[0][1]));
            // The part outside the body is not drawn.
            assert_eq!((line[0][0], line[line.len() - 1][0]), (5.0, 7.0));
        }
    }

    #[test]
    fn the_outline_of_a_disc_is_a_closed_circle() {
        let corners = circle([1.0, 2.0, 3.0], [0.0, 0.0, 5.0], 2.0);
        assert_eq!(corners[0], corners[AROUND]);
        for corner in corners {
            assert!((squared_distance(corner, [1.0, 2.0, 3.0]) - 4.0).abs() < 1e-12);
            assert_eq!(corner[2], 3.0);
        }
    }
}
