//! Geodesic distances.

use std::f64::consts::PI;

use pericles_manifold::geodesic::{GeodesicErrors, GeodesicMethod, GeodesicPairs, geodesic_pairs};
use pericles_manifold::surface::Surface;

use crate::surface::oracle;

fn exact(surface: &Surface, delta: f64) -> GeodesicPairs {
    geodesic_pairs(surface, delta, GeodesicMethod::Exact).unwrap()
}

/// Moves vertices at random by up to `amount` along each axis, which creates saddles and obtuse and skewed
/// triangles.
fn shaken(surface: &Surface, amount: f64, seed: u64) -> Surface {
    let mut state = seed;
    let mut random = || {
        state = state
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        amount * ((state >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
    };
    let positions = surface
        .positions()
        .iter()
        .map(|x| x.map(|x| x + random()))
        .collect();
    Surface::new(positions, surface.triangles().to_vec()).unwrap()
}

/// Box with faces divided into squares of two triangles: the cube (−1, 1)³ with `cells` per side, scaled.
fn cut_box(cells: u32, half: [f64; 3]) -> Surface {
    let mut numbers = std::collections::HashMap::new();
    let (mut positions, mut triangles) = (Vec::new(), Vec::new());
    let mut vertex = |node: [u32; 3]| {
        *numbers.entry(node).or_insert_with(|| {
            positions.push(
                [0, 1, 2].map(|c| half[c] * (2.0 * f64::from(node[c]) / f64::from(cells) - 1.0)),
            );
            positions.len() as u32 - 1
        })
    };
    for axis in 0..3 {
        for (side, turn) in [(0, true), (cells, false)] {
            for a in 0..cells {
                for b in 0..cells {
                    let mut at = |a: u32, b: u32| {
                        let mut node = [side; 3];
                        node[(axis + 1) % 3] = a;
                        node[(axis + 2) % 3] = b;
                        vertex(node)
                    };
                    let corners = [at(a, b), at(a + 1, b), at(a + 1, b + 1), at(a, b + 1)];
                    for mut triangle in [
                        [corners[0], corners[1], corners[2]],
                        [corners[0], corners[2], corners[3]],
                    ] {
                        if turn {
                            triangle.swap(1, 2);
                        }
                        triangles.push(triangle);
                    }
                }
            }
        }
    }
    Surface::new(positions, triangles).unwrap()
}

fn vertex_at(surface: &Surface, place: [f64; 3]) -> usize {
    let apart = |x: &[f64; 3]| (0..3).map(|c| (x[c] - place[c]).powi(2)).sum::<f64>();
    let found = surface.positions().iter().position(|x| apart(x) < 1e-18);
    found.unwrap_or_else(|| panic!("no vertex at {place:?}"))
}

#[test]
fn exact_distances_equal_exhaustive_ray_search() {
    let spike = {
        let ball = Surface::icosphere(2, 1.0).unwrap();
        let x = ball
            .positions()
            .iter()
            .map(|x| if x[2] > 0.8 { x.map(|c| 3.0 * c) } else { *x })
            .collect();
        Surface::new(x, ball.triangles().to_vec()).unwrap()
    };
    let surfaces = [
        (shaken(&Surface::icosphere(2, 1.0).unwrap(), 0.1, 1), 2.0),
        (shaken(&Surface::icosphere(2, 1.0).unwrap(), 0.25, 2), 1.3),
        (
            shaken(&Surface::torus(1.0, 0.5, 12, 8).unwrap(), 0.05, 3),
            1.5,
        ),
        (
            shaken(&Surface::torus(1.0, 0.3, 24, 4).unwrap(), 0.02, 4),
            1.0,
        ),
        (Surface::torus(1.0, 0.6, 10, 10).unwrap(), 1.6),
        (Surface::ellipsoid(2, [3.0, 1.0, 0.2]).unwrap(), 1.5),
        (Surface::uv_sphere(24, 5, 1.0).unwrap(), 1.5),
        (Surface::capsule(0.5, 1.0, 10).unwrap(), 1.5),
        (Surface::capsule(0.5, 2.0, 16).unwrap(), 0.9),
        (cut_box(3, [1.0, 1.0, 1.0]), 2.5),
        (cut_box(3, [1.0, 0.4, 0.1]), 1.5),
        (spike, 2.0),
    ];
    for (number, (surface, delta)) in surfaces.iter().enumerate() {
        let pairs = exact(surface, *delta);
        let truth = oracle::distances(surface, *delta);
        let mut count = 0;
        for (i, row) in truth.iter().enumerate() {
            for (j, &d) in row.iter().enumerate() {
                if i == j || d > delta * (1.0 - 1e-12) {
                    continue;
                }
                count += 1;
                let found = pairs.between(i, j).unwrap_or(f64::INFINITY);
                assert!(
                    (found - d).abs() < 1e-12 * delta,
                    "surface {number}: {i} to {j}: {found}, {d} in truth"
                );
            }
        }
        assert!(
            pairs.len() >= count && count > 1000,
            "surface {number}: {count}"
        );
        assert!(pairs.distance.iter().all(|d| d < delta));
    }
}

#[test]
fn cube_has_the_known_shortest_paths() {
    let cube = cut_box(4, [1.0; 3]);
    let pairs = exact(&cube, 4.6);
    let between = |a: [f64; 3], b: [f64; 3]| {
        pairs
            .between(vertex_at(&cube, a), vertex_at(&cube, b))
            .unwrap()
    };
    for (a, b, squared) in [
        // Opposite corners: over two faces, 2 by 4.
        ([-1.0, -1.0, -1.0], [1.0, 1.0, 1.0], 20.0),
        ([-1.0, -1.0, -1.0], [1.0, 1.0, -1.0], 8.0),
        // Midpoints of opposite and of neighbouring faces, of opposite edges.
        ([0.0, 0.0, -1.0], [0.0, 0.0, 1.0], 16.0),
        ([0.0, 0.0, -1.0], [1.0, 0.0, 0.0], 4.0),
        ([1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], 16.0),
        // Midpoint of a face to a corner of the opposite one: 3 by 3 and 1, 1.
        ([0.0, 0.0, -1.0], [1.0, 1.0, 1.0], 10.0),
    ] {
        assert!(
            (between(a, b) - f64::sqrt(squared)).abs() < 1e-13,
            "{a:?} {b:?}"
        );
    }
}

#[test]
fn dudeneys_spider_and_fly_path_has_length_40() {
    // Dudeney's room of 30 by 12 by 12: the spider is 1 below the ceiling in the middle of an end wall, the fly
    // 1 above the floor in the middle of the opposite wall; the shortest path is 40, over five of the six
    // walls.
    let room = cut_box(12, [15.0, 6.0, 6.0]);
    let pairs = exact(&room, 40.5);
    let (spider, fly) = (
        vertex_at(&room, [-15.0, 0.0, 5.0]),
        vertex_at(&room, [15.0, 0.0, -5.0]),
    );
    assert!((pairs.between(spider, fly).unwrap() - 40.0).abs() < 1e-12);
}

#[test]
fn distances_on_the_tube_of_a_capsule_equal_those_on_the_unrolled_tube() {
    let (radius, length, segments) = (0.5, 2.0, 16u32);
    let capsule = Surface::capsule(radius, length, segments).unwrap();
    let delta = 0.9;
    let pairs = exact(&capsule, delta);
    let width = 2.0 * radius * (PI / f64::from(segments)).sin();
    let mut count = 0;
    for (i, x) in capsule.positions().iter().enumerate() {
        for (j, y) in capsule.positions().iter().enumerate() {
            // Shortest paths between points this far from the caps stay on the tube.
            if i == j || x[2].abs() > 0.4 || y[2].abs() > 0.4 {
                continue;
            }
            let angle = |p: &[f64; 3]| p[1].atan2(p[0]) * f64::from(segments) / (2.0 * PI);
            let apart = (angle(x) - angle(y)).abs().round();
            let faces = apart.min(f64::from(segments) - apart);
            let d = (faces * width).hypot(x[2] - y[2]);
            if d < delta {
                count += 1;
                let found = pairs.between(i, j).unwrap();
                assert!(
                    (found - d).abs() < 1e-13,
                    "{x:?} {y:?}: {found}, {d} in truth"
                );
            }
        }
    }
    assert!(count > 1000);
}

#[test]
fn exact_distances_converge_to_those_of_the_sphere() {
    // Computed for Coclite, Coclite, Maddalena, Politi (2022): largest errors .25, .07 and (level 5, by the
    // study) .02 %.
    for (level, entries, limit) in [(3, 23580, 0.00255), (4, 399600, 0.0007)] {
        let sphere = Surface::icosphere(level, 1.0).unwrap();
        let pairs = exact(&sphere, 0.5);
        assert_eq!(pairs.len(), entries);
        let mut worst = 0.0f64;
        for i in 0..sphere.len() {
            let (neighbours, distances) = pairs.row(i);
            for (&j, d) in neighbours.iter().zip(distances) {
                let arc = 2.0 * (0.5 * sphere.chord(i, j as usize)).asin();
                worst = worst.max((d / arc - 1.0).abs());
            }
        }
        assert!(worst < limit && worst > 0.5 * limit, "{level} {worst}");
    }
}

#[test]
fn shorter_horizon_removes_pairs_and_keeps_distances() {
    for surface in [
        Surface::icosphere(2, 1.0).unwrap(),
        Surface::torus(1.0, 0.4, 24, 12).unwrap(),
    ] {
        let (all, near) = (exact(&surface, 50.0), exact(&surface, 0.5));
        assert_eq!(all.len(), surface.len() * (surface.len() - 1));
        for i in 0..surface.len() {
            let (neighbours, distances) = all.row(i);
            let kept: Vec<(u32, f64)> = neighbours
                .iter()
                .copied()
                .zip(distances.iter().copied())
                .filter(|(_, d)| *d < 0.5)
                .collect();
            let (neighbours, distances) = near.row(i);
            let found: Vec<(u32, f64)> = neighbours
                .iter()
                .copied()
                .zip(distances.iter().copied())
                .collect();
            assert_eq!(kept, found);
        }
    }
}

#[test]
fn approximate_distances_are_upper_bounds() {
    let surface = shaken(&Surface::torus(1.0, 0.4, 30, 16).unwrap(), 0.01, 5);
    let delta = 0.6;
    let truth = exact(&surface, delta);
    let errors = |method| GeodesicErrors::of_method(&surface, delta, method, &truth).unwrap();
    let mut last = f64::INFINITY;
    for method in [
        GeodesicMethod::Edge,
        GeodesicMethod::EdgeDiagonals,
        GeodesicMethod::Steiner(3),
        GeodesicMethod::Steiner(6),
        GeodesicMethod::Steiner(12),
    ] {
        let found = errors(method);
        assert!(found.mean < 0.7 * last, "{method}: {found:?}");
        assert!(found.mean >= 0.0 && found.extra == 0.0);
        last = found.mean;
    }
    assert!(last < 1e-3, "{last}");
    let itself = errors(GeodesicMethod::Exact);
    assert_eq!((itself.max, itself.lost, itself.extra), (0.0, 0.0, 0.0));
    assert!(errors(GeodesicMethod::Edge).lost > 0.02);
}

#[test]
fn every_method_is_symmetric_and_the_same_on_any_number_of_threads() {
    let surface = shaken(&Surface::icosphere(2, 1.0).unwrap(), 0.1, 7).renumbered();
    for method in [
        GeodesicMethod::Exact,
        GeodesicMethod::Edge,
        GeodesicMethod::EdgeDiagonals,
        GeodesicMethod::Steiner(2),
    ] {
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| geodesic_pairs(&surface, 0.9, method).unwrap())
        };
        let pairs = on(1);
        assert_eq!(pairs, on(3));
        for i in 0..surface.len() {
            let (neighbours, distances) = pairs.row(i);
            assert!(neighbours.is_sorted());
            for (&j, d) in neighbours.iter().zip(distances) {
                assert_eq!(pairs.between(j as usize, i).unwrap().to_bits(), d.to_bits());
                assert!(*d < 0.9 && *d >= surface.chord(i, j as usize) * (1.0 - 1e-14));
            }
        }
    }
}

#[test]
fn distances_on_open_surfaces_go_around_holes() {
    // Cube without its top: from the midpoint of one upper edge to that of the opposite one, over a side or
    // along the rim.
    let cube = cut_box(4, [1.0; 3]);
    let open = cube.triangles().iter().copied();
    let open: Vec<[u32; 3]> = open
        .filter(|t| !t.iter().all(|&v| cube.positions()[v as usize][2] == 1.0))
        .collect();
    let mut used: Vec<u32> = open.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let number = |v: &u32| used.binary_search(v).unwrap() as u32;
    let surface = Surface::new(
        used.iter().map(|&v| cube.positions()[v as usize]).collect(),
        open.iter()
            .map(|t| [number(&t[0]), number(&t[1]), number(&t[2])])
            .collect(),
    )
    .unwrap();
    let pairs = exact(&surface, 7.0);
    let between = |a, b| {
        pairs
            .between(vertex_at(&surface, a), vertex_at(&surface, b))
            .unwrap()
    };
    assert!((between([-1.0, 0.0, 1.0], [1.0, 0.0, 1.0]) - 4.0).abs() < 1e-13);
    assert!((between([-1.0, -1.0, 1.0], [1.0, 1.0, 1.0]) - 4.0).abs() < 1e-13);
    assert!((between([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]) - 4.0).abs() < 1e-13);
}

#[test]
fn horizon_below_the_edge_length_is_an_error() {
    let sphere = Surface::icosphere(2, 1.0).unwrap();
    for delta in [0.0, -1.0, f64::NAN, 0.1] {
        assert!(geodesic_pairs(&sphere, delta, GeodesicMethod::Edge).is_err());
    }
    for points in [0, 33] {
        assert!(geodesic_pairs(&sphere, 0.5, GeodesicMethod::Steiner(points)).is_err());
    }
}
