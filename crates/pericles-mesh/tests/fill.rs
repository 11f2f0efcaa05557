//! Lattices in closed surfaces: exact classification of nodes, in all orientations, on any number of threads.

use std::f64::consts::PI;

use pericles_mesh::fill::{
    FillError, Filled, Lattice, Outline, TriangleSurface, WindingTree, fill, fill_nodes, fill_open,
    fill_open_nodes, fill_open_partially, fill_partially,
};

type Point = [f64; 3];

/// Triangles of a prism over a convex counter-clockwise polygon, between two heights.
fn prism(polygon: &[[f64; 2]], low: f64, high: f64) -> (Vec<Point>, Vec<[u32; 3]>) {
    let n = polygon.len() as u32;
    let at = |z: f64| polygon.iter().map(move |p| [p[0], p[1], z]);
    let positions = at(low).chain(at(high)).collect();
    let mut triangles = Vec::new();
    for k in 1..n - 1 {
        triangles.push([0, k + 1, k]);
        triangles.push([n, n + k, n + k + 1]);
    }
    for k in 0..n {
        let next = (k + 1) % n;
        triangles.push([k, next, n + next]);
        triangles.push([k, n + next, n + k]);
    }
    (positions, triangles)
}

/// The 48 symmetries of a cube: permutations of the axes and signs.
fn symmetries() -> Vec<([usize; 3], Point)> {
    let orders = [
        [0, 1, 2],
        [1, 2, 0],
        [2, 0, 1],
        [0, 2, 1],
        [2, 1, 0],
        [1, 0, 2],
    ];
    let mut all = Vec::new();
    for order in orders {
        for signs in 0..8 {
            all.push((
                order,
                [0, 1, 2].map(|c| if signs >> c & 1 == 0 { 1.0 } else { -1.0 }),
            ));
        }
    }
    all
}

fn surface(
    (positions, triangles): (Vec<Point>, Vec<[u32; 3]>),
    (order, signs): ([usize; 3], Point),
) -> TriangleSurface {
    let odd = matches!(order, [0, 2, 1] | [2, 1, 0] | [1, 0, 2]);
    let mirrored = odd != (signs.iter().product::<f64>() < 0.0);
    let positions = positions
        .iter()
        .map(|x| std::array::from_fn(|c| signs[c] * x[order[c]]));
    let triangles = triangles
        .iter()
        .map(|&[a, b, c]| if mirrored { [a, c, b] } else { [a, b, c] });
    TriangleSurface::new(positions.collect(), triangles.collect()).unwrap()
}

/// Positions of the nodes inside, as multiples of 1/8.
fn nodes(filled: &Filled) -> Vec<[i64; 3]> {
    let lattice = *filled.lattice();
    let mut nodes: Vec<[i64; 3]> = filled
        .nodes()
        .map(|node| lattice.position(node).map(|x| (8.0 * x).round() as i64))
        .collect();
    nodes.sort_unstable();
    nodes
}

#[test]
fn a_cut_through_nodes_assigns_each_node_to_exactly_one_half() {
    // A cube of side 16 with nodes at −7.5, −6.5, … along each axis, cut along the diagonal plane x = y and
    // along the plane x = 0.5, which both pass through nodes.
    let h = 8.0;
    let frame = [[-h, -h], [h, -h], [h, h], [-h, h]];
    let halves: [[Vec<[f64; 2]>; 2]; 2] = [
        [
            vec![frame[0], frame[1], frame[2]],
            vec![frame[0], frame[2], frame[3]],
        ],
        [
            vec![[-h, -h], [0.5, -h], [0.5, h], [-h, h]],
            vec![[0.5, -h], [h, -h], [h, h], [0.5, h]],
        ],
    ];
    for symmetry in symmetries() {
        let whole = fill(&surface(prism(&frame, -h, h), symmetry), [1.0; 3]).unwrap();
        assert_eq!(whole.len(), 4096);
        for pair in &halves {
            let mut both: Vec<[i64; 3]> = Vec::new();
            for half in pair {
                // Two thin slivers in opposite corners extend the bounding box to that of the cube; they
                // contain no node.
                let mut shape = prism(half, -h, h);
                for corner in [-h, h] {
                    let d = 0.01 * corner.signum();
                    let square = [
                        [corner, corner],
                        [corner - d, corner],
                        [corner - d, corner - d],
                        [corner, corner - d],
                    ];
                    let (x, t) = prism(&square, corner.min(corner - d), corner.max(corner - d));
                    let first = shape.0.len() as u32;
                    shape.0.extend(x);
                    shape.1.extend(t.iter().map(|t| t.map(|v| v + first)));
                }
                let filled = fill(&surface(shape, symmetry), [1.0; 3]).unwrap();
                assert_eq!(filled.lattice(), whole.lattice());
                both.extend(nodes(&filled));
            }
            both.sort_unstable();
            assert_eq!(both, nodes(&whole), "{symmetry:?}");
        }
    }
}

/// An icosahedron on a sphere, its triangles divided n times into four.
fn ball(times: usize, radius: f64, centre: Point) -> (Vec<Point>, Vec<[u32; 3]>) {
    let g = (1.0 + 5f64.sqrt()) / 2.0;
    let mut x: Vec<Point> = Vec::new();
    for (a, b) in [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)] {
        x.push([a, b, 0.0]);
    }
    for (a, b) in [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)] {
        x.push([0.0, a, b]);
    }
    for (a, b) in [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)] {
        x.push([b, 0.0, a]);
    }
    let mut t: Vec<[u32; 3]> = Vec::new();
    let distance = |a: Point, b: Point| (0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f64>();
    for a in 0..12u32 {
        for b in a + 1..12 {
            for c in b + 1..12 {
                let [p, q, r] = [a, b, c].map(|v| x[v as usize]);
                if [distance(p, q), distance(q, r), distance(r, p)]
                    .iter()
                    .all(|d| (d - 4.0).abs() < 1e-9)
                {
                    let volume = p[0] * (q[1] * r[2] - q[2] * r[1])
                        + p[1] * (q[2] * r[0] - q[0] * r[2])
                        + p[2] * (q[0] * r[1] - q[1] * r[0]);
                    t.push(if volume > 0.0 { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    assert_eq!(t.len(), 20);
    for _ in 0..times {
        let mut middle = std::collections::HashMap::new();
        let mut finer = Vec::new();
        for [a, b, c] in t {
            let [d, e, f] = [(a, b), (b, c), (c, a)].map(|(a, b)| {
                *middle.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    x.push(std::array::from_fn(|k| x[a as usize][k] + x[b as usize][k]));
                    x.len() as u32 - 1
                })
            });
            // Lengths are set once at the end, but points of the next division need equal lengths.
            finer.extend([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
            for v in [d, e, f] {
                let length =
                    distance(x[v as usize], [0.0; 3]).sqrt() / distance(x[0], [0.0; 3]).sqrt();
                x[v as usize] = x[v as usize].map(|x| x / length);
            }
        }
        t = finer;
    }
    let positions = x.iter().map(|p| {
        let length = distance(*p, [0.0; 3]).sqrt();
        std::array::from_fn(|c| centre[c] + radius * p[c] / length)
    });
    (positions.collect(), t)
}

fn together(parts: &[(Vec<Point>, Vec<[u32; 3]>)], inverted: &[bool]) -> TriangleSurface {
    let (mut x, mut t) = (Vec::new(), Vec::new());
    for ((positions, triangles), &inverted) in parts.iter().zip(inverted) {
        let first = x.len() as u32;
        x.extend(positions);
        t.extend(triangles.iter().map(|&[a, b, c]| {
            let t = if inverted { [a, c, b] } else { [a, b, c] };
            t.map(|v| v + first)
        }));
    }
    TriangleSurface::new(x, t).unwrap()
}

#[test]
fn nodes_in_balls_overlapping_balls_and_cavities_are_exact() {
    let is_in = |x: Point, centre: f64, radius: f64| {
        (x[0] - centre).powi(2) + x[1] * x[1] + x[2] * x[2] < radius * radius
    };
    // Nodes between the sphere and its triangulation are ignored: after 5 divisions the triangles are within
    // 0.1 % of the sphere.
    let clear = |x: Point, centre: f64, radius: f64| {
        let r = ((x[0] - centre).powi(2) + x[1] * x[1] + x[2] * x[2]).sqrt();
        (r / radius - 1.0).abs() > 1.1e-3
    };
    let ball = |radius, centre| ball(5, radius, [centre, 0.0, 0.0]);
    type Inside<'a> = Box<dyn Fn(Point) -> bool + 'a>;
    // Surface, indicator function, centres and radii of the spheres.
    type Case<'a> = (TriangleSurface, Inside<'a>, Vec<(f64, f64)>);
    let cases: Vec<Case<'_>> = vec![
        (
            together(&[ball(1.0, 0.0)], &[false]),
            Box::new(|x| is_in(x, 0.0, 1.0)),
            vec![(0.0, 1.0)],
        ),
        (
            together(&[ball(1.0, 0.0)], &[true]),
            Box::new(|x| is_in(x, 0.0, 1.0)),
            vec![(0.0, 1.0)],
        ),
        (
            together(&[ball(1.0, 0.0), ball(1.0, 1.1)], &[false, false]),
            Box::new(|x| is_in(x, 0.0, 1.0) || is_in(x, 1.1, 1.0)),
            vec![(0.0, 1.0), (1.1, 1.0)],
        ),
        (
            together(&[ball(1.0, 0.0), ball(0.6, 0.1)], &[false, true]),
            Box::new(|x| is_in(x, 0.0, 1.0) && !is_in(x, 0.1, 0.6)),
            vec![(0.0, 1.0), (0.1, 0.6)],
        ),
    ];
    for (number, (surface, inside, spheres)) in cases.iter().enumerate() {
        let filled = fill(surface, [0.05; 3]).unwrap();
        let lattice = *filled.lattice();
        assert_eq!(filled.was_turned(), number == 1);
        let mut checked = 0;
        for k in 0..lattice.counts[2] {
            for j in 0..lattice.counts[1] {
                for i in 0..lattice.counts[0] {
                    let x = lattice.position([i, j, k]);
                    if spheres
                        .iter()
                        .all(|&(centre, radius)| clear(x, centre, radius))
                    {
                        assert_eq!(
                            filled.contains([i, j, k]),
                            inside(x),
                            "case {number}: {x:?}"
                        );
                        checked += 1;
                    }
                }
            }
        }
        assert!(checked > lattice.len() * 99 / 100);
        assert_eq!(filled.nodes().count(), filled.len());
    }
}

#[test]
fn small_cells_in_a_box_equal_those_of_the_divided_lattice() {
    let (x, t) = ball(3, 1.0, [0.01, 0.02, 0.03]);
    let surface = TriangleSurface::new(x, t).unwrap();
    let tree = WindingTree::new(&surface);
    let corner = |k: u32| {
        let angle = f64::from(k) / 17.0 * std::f64::consts::TAU;
        [angle.cos(), 0.7 * angle.sin()]
    };
    let outline = Outline::new(vec![(0..17).map(corner).collect()]).unwrap();
    let large = Lattice::around(surface.bounds(), [0.25; 3]).unwrap();
    let plane = Lattice::around(outline.bounds(), [0.25, 0.25, 1.0]).unwrap();
    const RATIO: usize = 3;
    let compare = |whole: &Filled, part: &Filled, first: [usize; 3], dimension: usize| {
        let [nx, ny, nz] = part.lattice().counts;
        let mut inside = 0;
        for node in (0..nx * ny * nz).map(|n| [n % nx, n / nx % ny, n / (nx * ny)]) {
            let there = std::array::from_fn(|c| match c < dimension {
                true => node[c] + RATIO * first[c],
                false => node[c],
            });
            let (a, b) = (
                part.lattice().position(node),
                whole.lattice().position(there),
            );
            assert!((0..3).all(|c| (a[c] - b[c]).abs() < 1e-14));
            assert_eq!(part.contains(node), whole.contains(there), "{node:?}");
            inside += usize::from(part.contains(node));
        }
        assert!(inside > 0 && inside < nx * ny * nz, "{inside}");
    };
    let first = [1, 2, 5];
    let all = large.divided_box([0; 3], large.counts, 3, RATIO);
    let part = large.divided_box(first, [3, 4, 3], 3, RATIO);
    let whole = fill_nodes(&surface, all).unwrap();
    // The divided lattice reproduces the volume of the ball.
    assert!((whole.volume() / whole.enclosed_volume() - 1.0).abs() < 1e-2);
    compare(&whole, &fill_nodes(&surface, part).unwrap(), first, 3);
    let whole = fill_open_nodes(&surface, &tree, all);
    compare(&whole, &fill_open_nodes(&surface, &tree, part), first, 3);
    let all = plane.divided_box([0; 3], plane.counts, 2, RATIO);
    let part = plane.divided_box([0, 1, 0], [3, 3, 1], 2, RATIO);
    compare(
        &outline.fill_nodes(all),
        &outline.fill_nodes(part),
        [0, 1, 0],
        2,
    );
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let surface = together(
        &[ball(3, 1.0, [0.0; 3]), ball(3, 0.8, [0.7, 0.2, 0.1])],
        &[false, false],
    );
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let spacing = [0.11, 0.12, 0.13];
            (
                fill(&surface, spacing).unwrap(),
                fill_partially(&surface, spacing).unwrap(),
                fill_open(&surface, spacing).unwrap(),
                fill_open_partially(&surface, spacing).unwrap(),
            )
        })
    };
    let alone = on(1);
    assert!(alone == on(2) && alone == on(3));
}

#[test]
fn an_open_surface_is_rejected_and_can_be_filled_by_the_winding_number() {
    let (x, t) = ball(4, 1.0, [0.0; 3]);
    let whole = fill(
        &TriangleSurface::new(x.clone(), t.clone()).unwrap(),
        [0.1; 3],
    )
    .unwrap();
    // Every fiftieth triangle is missing.
    let holes: Vec<[u32; 3]> = (0..)
        .zip(t)
        .filter(|(k, _)| k % 50 != 0)
        .map(|(_, t)| t)
        .collect();
    let open = TriangleSurface::new(x, holes).unwrap();
    let error = fill(&open, [0.1; 3]).unwrap_err();
    let FillError::Open {
        columns, all, at, ..
    } = error
    else {
        panic!("{error}");
    };
    assert!(columns > 0 && columns < all && at[0].hypot(at[1]) <= 1.0);
    assert!(matches!(
        fill_partially(&open, [0.1; 3]),
        Err(FillError::Open { .. })
    ));
    // A hole of one triangle is 5 % of the radius wide and the node spacing is 10 %: the same nodes are inside.
    let filled = fill_open(&open, [0.1; 3]).unwrap();
    let differ = filled.nodes().filter(|&node| !whole.contains(node)).count();
    assert!(
        filled.len().abs_diff(whole.len()) + 2 * differ <= 4,
        "{} {}",
        filled.len(),
        whole.len()
    );
}

#[test]
fn the_winding_number_of_a_closed_surface_is_an_integer() {
    let (x, t) = ball(3, 1.0, [0.0; 3]);
    let surface = TriangleSurface::new(x, t).unwrap();
    let tree = WindingTree::new(&surface);
    for (point, expected) in [
        ([0.0; 3], 1.0),
        ([0.5, 0.3, -0.2], 1.0),
        ([1.5, 0.2, 0.0], 0.0),
        ([5.0, 4.0, 3.0], 0.0),
    ] {
        let found = tree.winding_number(point);
        // Error of dipole and first moment beyond two radii; the bound was chosen after seeing 0.061 at the
        // centre. An error of one half would misclassify nodes.
        assert!((found - expected).abs() < 0.11, "{point:?}: {found}");
    }
}

#[test]
fn volume_fractions_add_up_to_the_volume() {
    // For a box whose sides are not multiples of the spacing, all fractions are known.
    let side = 1.1;
    let frame = [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]];
    let shape =
        TriangleSurface::new(prism(&frame, 0.0, 0.85).0, prism(&frame, 0.0, 0.85).1).unwrap();
    let cells = fill_partially(&shape, [0.25; 3]).unwrap();
    let volume: f64 = cells.parts.iter().sum::<f64>() * cells.lattice.cell_volume();
    // Lengths along z are exact; in x and y, lines represent sixteenths of a cut side: 5 cells of 0.25 for 1.1.
    assert!(
        (volume / (side * side * 0.85) - 1.0).abs() < 0.06,
        "{volume}"
    );
    let (x, t) = ball(5, 1.0, [0.0; 3]);
    let surface = TriangleSurface::new(x, t).unwrap();
    let enclosed = surface.signed_volume();
    assert!(
        (enclosed / (4.0 / 3.0 * PI) - 1.0).abs() < 2e-3,
        "{enclosed}"
    );
    for (spacing, most) in [(0.2, 2e-3), (0.1, 5e-4)] {
        // Bounds chosen after seeing 2.1e-4 on the finer lattice.
        let cells = fill_partially(&surface, [spacing; 3]).unwrap();
        let volume = cells.parts.iter().sum::<f64>() * cells.lattice.cell_volume();
        assert!(
            (volume / enclosed - 1.0).abs() < most,
            "{spacing}: {}",
            volume / enclosed - 1.0
        );
        assert!(cells.parts.iter().all(|&part| part >= 0.1));
    }
}

#[test]
fn nodes_in_outlines_with_holes_are_exact() {
    let square = |low: f64, high: f64| vec![[low, low], [high, low], [high, high], [low, high]];
    let mut hole = square(3.0, 5.0);
    for turned in [false, true] {
        if turned {
            hole.reverse();
        }
        let outline = Outline::new(vec![square(0.0, 8.0), hole.clone()]).unwrap();
        assert_eq!(outline.area(), 60.0);
        let filled = outline.fill([1.0, 1.0]).unwrap();
        assert_eq!(
            (filled.len(), filled.volume(), filled.enclosed_volume()),
            (60, 60.0, 60.0)
        );
        for node in filled.nodes() {
            let [x, y, _] = filled.lattice().position(node);
            assert!(outline.contains([x, y]) && ((x - 4.0).abs() > 1.0 || (y - 4.0).abs() > 1.0));
        }
    }
    // A cut along the diagonal through nodes: each node belongs to one half.
    let lower = Outline::new(vec![vec![[0.0, 0.0], [8.0, 0.0], [8.0, 8.0]]]).unwrap();
    let upper = Outline::new(vec![vec![[0.0, 0.0], [8.0, 8.0], [0.0, 8.0]]]).unwrap();
    let (a, b) = (lower.fill([1.0; 2]).unwrap(), upper.fill([1.0; 2]).unwrap());
    for j in 0..8 {
        for i in 0..8 {
            assert!(a.contains([i, j, 0]) != b.contains([i, j, 0]), "{i} {j}");
        }
    }
    assert!(matches!(
        Outline::new(vec![vec![[0.0; 2]; 2]]),
        Err(FillError::FewCorners { .. })
    ));
    assert!(matches!(
        Outline::new(vec![]),
        Err(FillError::FewCorners { .. })
    ));
}

/// A regular polygon with n corners.
fn regular(n: u32, radius: f64, centre: [f64; 2]) -> Vec<[f64; 2]> {
    let angle = |k: u32| 2.0 * PI * f64::from(k) / f64::from(n) + 0.1;
    let corner = |k: u32| {
        let (sin, cos) = angle(k).sin_cos();
        [centre[0] + radius * cos, centre[1] + radius * sin]
    };
    (0..n).map(corner).collect()
}

#[test]
fn area_fractions_of_plane_cells_are_exact() {
    // A right triangle in four squares: one full, two halves, one empty.
    let corners = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    for start in 0..3 {
        for turned in [false, true] {
            let mut corners = corners.clone();
            corners.rotate_left(start);
            if turned {
                corners.reverse();
            }
            let outline = Outline::new(vec![corners]).unwrap();
            let cells = outline.fill_partially([0.5, 0.5]).unwrap();
            assert_eq!(cells.cells, [[0, 0, 0], [1, 0, 0], [0, 1, 0]]);
            let exact = [1.0, 0.5, 0.5];
            for (part, exact) in cells.parts.iter().zip(exact) {
                assert!((part - exact).abs() < 1e-14, "{part} {exact}");
            }
        }
    }
    // Rings with a hole, with either orientation of both polygons: the area equals the area between the polygons.
    for (n, spacing) in [(3, 0.3), (7, 0.21), (400, 0.1), (400, 3.0)] {
        for turned in [false, true] {
            let mut hole = regular(n, 0.4, [0.1, -0.05]);
            if turned {
                hole.reverse();
            }
            let outline = Outline::new(vec![regular(n, 1.0, [0.0; 2]), hole]).unwrap();
            let cells = outline.fill_partially([spacing, 1.1 * spacing]).unwrap();
            let area = cells.parts.iter().sum::<f64>() * cells.lattice.cell_volume();
            assert!(
                (area / outline.area() - 1.0).abs() < 1e-13,
                "{n} {spacing}: {area}"
            );
            assert!(cells.parts.iter().all(|&part| part > 0.0));
        }
    }
}

#[test]
fn area_fractions_equal_sampled_areas() {
    const SAMPLES: usize = 60;
    let outline =
        Outline::new(vec![regular(5, 1.0, [0.0; 2]), regular(6, 0.3, [0.2, 0.1])]).unwrap();
    let spacing = 0.17;
    let cells = outline.fill_partially([spacing; 2]).unwrap();
    let [nx, ny, _] = cells.lattice.counts;
    let sampled = |i: usize, j: usize| {
        let [x, y, _] = cells.lattice.position([i, j, 0]);
        let offset = |k: usize| spacing * ((k as f64 + 0.5) / SAMPLES as f64 - 0.5);
        let is_inside =
            |k: &usize| outline.contains([x + offset(k % SAMPLES), y + offset(k / SAMPLES)]);
        let all = SAMPLES * SAMPLES;
        (0..all).filter(is_inside).count() as f64 / all as f64
    };
    let parts: Vec<f64> = (0..nx * ny).map(|k| sampled(k % nx, k / nx)).collect();
    // Cells below a tenth without neighbours keep their own fraction. An edge crosses at most 2 · 60 of the
    // 3600 sample squares, and few cells intersect several edges.
    let error = 0.03;
    let mut compared = 0;
    for (&[i, j, _], part) in cells.cells.iter().zip(&cells.parts) {
        let around = (j.saturating_sub(1)..(j + 2).min(ny))
            .flat_map(|j| (i.saturating_sub(1)..(i + 2).min(nx)).map(move |i| j * nx + i));
        if around
            .clone()
            .all(|k| parts[k] == 0.0 || parts[k] > 0.1 + error)
        {
            let sampled = parts[j * nx + i];
            assert!((part - sampled).abs() < error, "{i} {j}: {part} {sampled}");
            compared += usize::from(*part < 1.0);
        }
    }
    assert!(compared > 10, "{compared}");
}

#[test]
fn volume_fractions_of_an_open_surface_equal_those_of_the_closed_one() {
    let (x, t) = ball(4, 1.0, [0.0; 3]);
    let closed = TriangleSurface::new(x.clone(), t.clone()).unwrap();
    // Every fiftieth triangle is missing.
    let holes: Vec<[u32; 3]> = (0..)
        .zip(t)
        .filter(|(k, _)| k % 50 != 0)
        .map(|(_, t)| t)
        .collect();
    let open = TriangleSurface::new(x, holes).unwrap();
    let volume = |surface: &TriangleSurface| {
        let cells = fill_open_partially(surface, [0.2; 3]).unwrap();
        assert!(cells.parts.iter().all(|&part| part >= 0.1));
        cells.parts.iter().sum::<f64>() * cells.lattice.cell_volume()
    };
    // 64 samples per cell with 10 cells per diameter correspond to a lattice with 40 nodes per diameter,
    // whose volume error is 0.18 % in tables for such balls.
    let enclosed = closed.signed_volume();
    for surface in [&closed, &open] {
        let volume = volume(surface);
        assert!(
            (volume / enclosed - 1.0).abs() < 5e-3,
            "{volume} {enclosed}"
        );
    }
    // A cube that is a multiple of the spacing has only full cells.
    let cube = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let (x, t) = prism(&cube, 0.0, 1.0);
    let cube = TriangleSurface::new(x, t).unwrap();
    let cells = fill_open_partially(&cube, [0.25; 3]).unwrap();
    assert_eq!(cells.parts, [1.0; 64]);
}

#[test]
fn invalid_spacings_and_surfaces_are_rejected() {
    let (x, t) = ball(1, 1.0, [0.0; 3]);
    let surface = TriangleSurface::new(x.clone(), t.clone()).unwrap();
    for spacing in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            fill(&surface, [spacing; 3]),
            Err(FillError::Spacing { .. })
        ));
    }
    assert!(matches!(
        fill(&surface, [1e-9; 3]),
        Err(FillError::TooMany { .. })
    ));
    assert!(matches!(
        TriangleSurface::new(x.clone(), vec![]),
        Err(FillError::Empty)
    ));
    assert!(matches!(
        TriangleSurface::new(x, vec![[0, 1, 99]]),
        Err(FillError::NoSuchVertex { .. })
    ));
    assert!(matches!(
        TriangleSurface::new(vec![[f64::NAN; 3]], t),
        Err(FillError::NotFinite { .. })
    ));
}
