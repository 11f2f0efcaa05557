use super::*;
use pericles::space::{Grid, Shape};

fn grid(size: &[f64]) -> PointCloud {
    let shape = Shape::Box {
        origin: [0.0; 3],
        size: size.to_vec(),
    };
    let grid = Grid {
        shape,
        spacing: 1.0,
        section: 1.0,
        holes: vec![],
    };
    grid.points().unwrap()
}

fn cells(cloud: &PointCloud, cuts: impl Fn(Point, Point) -> bool) -> DrawnCells {
    DrawnCells::new(cloud, &CellMesh::of_boxes(cloud), cuts)
}

/// A displacement, component-major.
fn field(cloud: &PointCloud, u: impl Fn(Point) -> Point) -> Vec<f64> {
    let component = |c: usize| {
        (0..cloud.len())
            .map(move |i| cloud.point(i))
            .map(&u)
            .map(move |u| u[c])
    };
    (0..cloud.dimension()).flat_map(component).collect()
}

fn polygons(
    cells: &DrawnCells,
    cloud: &PointCloud,
    u: &[f64],
    damage: Option<&[f64]>,
    scale: f64,
) -> Vec<Polygon> {
    let mut motion = Motion::new(cloud, u, scale);
    cells.deformed(&mut motion, damage).polygons().all
}

/// Area of plane polygons.
fn area(polygons: &[Polygon]) -> f64 {
    let of = |polygon: &Polygon| {
        let p = polygon.corners;
        let cross = |a: Point, b: Point| a[0] * b[1] - a[1] * b[0];
        (0..4)
            .map(|k| 0.5 * cross(p[k], p[(k + 1) % 4]))
            .sum::<f64>()
    };
    polygons.iter().map(of).sum()
}

/// Volume enclosed by faces that are ordered anticlockwise seen from outside.
fn volume(polygons: &[Polygon]) -> f64 {
    let six = |a: Point, b: Point, c: Point| {
        a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0])
    };
    let of = |polygon: &Polygon| {
        let [a, b, c, d] = polygon.corners;
        (six(a, b, c) + six(a, c, d)) / 6.0
    };
    polygons.iter().map(of).sum()
}

#[test]
fn a_rotated_and_stretched_plate_is_drawn_exactly() {
    let cloud = grid(&[5.0, 3.0]);
    // A quarter turn and a stretch by two along y.
    let place = |x: Point| [-2.0 * x[1], x[0], 0.0];
    let u = field(&cloud, |x| std::array::from_fn(|c| place(x)[c] - x[c]));
    let found = polygons(&cells(&cloud, |_, _| false), &cloud, &u, None, 1.0);
    assert_eq!(found.len(), 15);
    assert!((area(&found) - 30.0).abs() < 1e-3);
    let far = found.iter().flat_map(|polygon| polygon.corners);
    let far = far
        .map(|p| (p[0] + 6.0).hypot(p[1] - 5.0))
        .fold(f64::INFINITY, f64::min);
    assert!(far < 1e-4, "the corner is {far} from its place");
}

#[test]
fn only_the_boundary_of_a_deformed_cube_is_drawn() {
    let cloud = grid(&[4.0, 4.0, 4.0]);
    // Volume factor 1.5 · 0.8 · 1.25, and a shear.
    let u = field(&cloud, |x| {
        [0.5 * x[0] + 0.3 * x[1], -0.2 * x[1], 0.25 * x[2]]
    });
    let found = polygons(&cells(&cloud, |_, _| false), &cloud, &u, None, 1.0);
    assert_eq!(found.len(), 6 * 16);
    assert!((volume(&found) - 96.0).abs() < 1e-2, "{}", volume(&found));
}

#[test]
fn triangles_of_a_mesh_share_their_nodes() {
    // A square of four triangles around its centre, given in another order than the points.
    let thirds = [
        [1.0, 1.0 / 3.0],
        [5.0 / 3.0, 1.0],
        [1.0, 5.0 / 3.0],
        [1.0 / 3.0, 1.0],
    ];
    let positions: Vec<f64> = (0..2)
        .flat_map(|c| thirds.iter().map(move |x| x[c]))
        .collect();
    let cloud = PointCloud::new(2, positions, vec![1.0; 4], 1.0).unwrap();
    let nodes = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0]];
    let along = |c: usize| nodes.iter().map(move |x| if c < 2 { x[c] } else { 0.0 });
    let mut triangles = VtuCells::default();
    for k in 0..4 {
        triangles.push(5, &[k, (k + 1) % 4, 4]);
    }
    let mesh = CellMesh {
        nodes: (0..3).flat_map(along).collect(),
        cells: triangles,
        points: (0..4).collect(),
    };
    let cells = DrawnCells::new(&cloud, &mesh, |_, _| false);
    let u = field(&cloud, |x| [1.0 * x[0], 0.5 * x[0], 0.0]);
    let found = polygons(&cells, &cloud, &u, None, 1.0);
    assert_eq!(found.len(), 4);
    assert!(
        found
            .iter()
            .all(|polygon| polygon.corners[2] == polygon.corners[3])
    );
    assert!((area(&found) - 8.0).abs() < 1e-4);
    let centres: Vec<Point> = found.iter().map(|polygon| polygon.corners[2]).collect();
    assert!(
        centres.windows(2).all(|pair| pair[0] == pair[1]),
        "{centres:?}"
    );
}

#[test]
fn both_sides_of_a_pre_crack_move_with_their_cells() {
    // A cut over half of the width at z = 1, which opens by 0.1.
    let cloud = grid(&[4.0, 2.0, 2.0]);
    let cut = |p: Point, q: Point| (p[2] < 1.0) != (q[2] < 1.0) && p[0].max(q[0]) < 2.0;
    let cells = cells(&cloud, cut);
    let u = field(&cloud, |x| {
        [0.0, 0.0, if x[2] > 1.0 && x[0] < 2.0 { 0.1 } else { 0.0 }]
    });
    let found = polygons(&cells, &cloud, &u, None, 1.0);
    // 2 × 2 faces on either side are open.
    assert_eq!(found.len(), 2 * (8 + 8 + 4) + 8);
    let mut motion = Motion::new(&cloud, &u, 1.0);
    let mut deformed = cells.deformed(&mut motion, None);
    let traces = deformed.crack_traces();
    let places: Vec<Point> = traces.into_iter().flatten().collect();
    assert!(
        places
            .iter()
            .any(|p| p[0] == 0.0 && (p[2] - 1.1).abs() < 1e-5)
    );
    assert!(
        places
            .iter()
            .any(|p| p[0] == 0.0 && (p[2] - 1.0).abs() < 1e-5)
    );
    // The crack meets the faces x = 0, y = 0 and y = 2.
    let on = |p: &Point| p[0] == 0.0 || p[1] == 0.0 || p[1] == 2.0;
    assert!(places.iter().all(|p| on(p) && p[0] <= 2.1), "{places:?}");
}

#[test]
fn traces_are_joined_to_one_line_per_side() {
    let cloud = grid(&[4.0, 2.0, 2.0]);
    let cells = cells(&cloud, |p, q| {
        (p[2] < 1.0) != (q[2] < 1.0) && p[0].max(q[0]) < 2.0
    });
    let lengths: Vec<usize> = cells.traces.iter().map(Vec::len).collect();
    // 2 + 2 + 2 edges.
    assert_eq!(lengths, [7, 7]);
}

#[test]
fn cells_of_damaged_points_separate_when_they_are_drawn_apart() {
    let cloud = grid(&[2.0, 1.0]);
    let cells = cells(&cloud, |_, _| false);
    let u = field(&cloud, |x| [if x[0] > 1.0 { 0.05 } else { 0.0 }, 0.0, 0.0]);
    let drawn = |damage, scale| area(&polygons(&cells, &cloud, &u, damage, scale));
    let (whole, broken) = ([0.1, 0.2], [0.0, 0.9]);
    // Stretched cells cover the gap, separated ones keep their area.
    for (damage, scale, expected) in [
        (None, 10.0, 3.0),
        (Some(&whole[..]), 10.0, 3.0),
        (Some(&broken[..]), 10.0, 2.0),
        (Some(&broken[..]), 1.0, 2.1),
    ] {
        let found = drawn(damage, scale);
        assert!((found - expected).abs() < 1e-5, "{found}, not {expected}");
    }
}

#[test]
fn points_that_are_not_finite_do_not_spread() {
    let cloud = grid(&[5.0, 1.0]);
    let mut u = vec![0.0; 10];
    u[4] = f64::NAN;
    let found = polygons(&cells(&cloud, |_, _| false), &cloud, &u, None, 1.0);
    let finite = found
        .iter()
        .filter(|p| p.corners.iter().flatten().all(|x| x.is_finite()));
    assert_eq!(finite.count(), 4);
}
