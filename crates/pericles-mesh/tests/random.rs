//! Random points: inside the body, minimum distance, density, and independence of the number of threads.

use std::f64::consts::PI;

use pericles_mesh::fill::{FillError, Lattice};
use pericles_mesh::random::{blue_noise, jittered, nearest_volumes};

type Point = [f64; 3];

fn is_in_ball(x: Point) -> bool {
    x.iter().map(|x| x * x).sum::<f64>() < 1.0
}

const BALL: [Point; 2] = [[-1.0; 3], [1.0; 3]];

fn on<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .unwrap();
    pool.install(work)
}

fn least_distance(points: &[Point]) -> f64 {
    let mut least = f64::INFINITY;
    for (k, a) in points.iter().enumerate() {
        for b in &points[..k] {
            least = least.min((0..3).map(|c| (a[c] - b[c]).powi(2)).sum::<f64>());
        }
    }
    least.sqrt()
}

#[test]
fn blue_noise_has_the_prescribed_minimum_distance_and_density() {
    // Ratio of radius and spacing for saturated random sequential addition, for which the mean volume per
    // point is the spacing to the power of the dimension.
    for (dimension, spacing, radius) in [(1, 0.002, 0.7476), (2, 0.05, 0.8346), (3, 0.1, 0.9018)] {
        let inside = |x: Point| is_in_ball(x);
        let points = blue_noise(
            [
                [
                    -1.0,
                    if dimension > 1 { -1.0 } else { 0.0 },
                    if dimension > 2 { -1.0 } else { 0.0 },
                ],
                [1.0; 3],
            ],
            dimension,
            spacing,
            1,
            &inside,
        )
        .unwrap();
        assert!(points.iter().all(|&x| is_in_ball(x)));
        assert!(
            points
                .iter()
                .all(|x| x[dimension..].iter().all(|&x| x == 0.0))
        );
        assert!(least_distance(&points) >= radius * spacing);
        // At least two spacings away from the boundary, because the density is higher near it.
        let radius = 1.0 - 2.0 * spacing.max(0.05);
        let middle = points
            .iter()
            .filter(|x| x.iter().map(|x| x * x).sum::<f64>() < radius * radius);
        let volume = [
            2.0 * radius,
            PI * radius.powi(2),
            4.0 / 3.0 * PI * radius.powi(3),
        ][dimension - 1];
        let ratio = middle.count() as f64 * spacing.powi(dimension as i32) / volume;
        assert!(
            (ratio - 1.0).abs() < 0.03,
            "{dimension} dimensions: {ratio}"
        );
    }
}

#[test]
fn blue_noise_is_nearly_saturated() {
    // Darts are thrown until hardly any space is left: positions in the body farther than one radius from all
    // points are rare.
    let spacing = 0.1;
    let points = blue_noise(BALL, 3, spacing, 5, &is_in_ball).unwrap();
    let radius = 0.9018 * spacing;
    let (mut bare, mut all) = (0, 0);
    for k in 0..20 {
        for j in 0..20 {
            for i in 0..20 {
                let x = [i, j, k].map(|i| -0.95 + 0.1 * f64::from(i));
                if !is_in_ball(x) {
                    continue;
                }
                all += 1;
                let near = |p: &Point| {
                    (0..3).map(|c| (p[c] - x[c]).powi(2)).sum::<f64>() < radius * radius
                };
                bare += usize::from(!points.iter().any(near));
            }
        }
    }
    assert!(50 * bare < all, "{bare} of {all}");
}

#[test]
fn points_depend_on_the_seed_and_not_on_the_number_of_threads() {
    let points = |threads: usize, seed: u64| {
        on(threads, || {
            blue_noise(BALL, 3, 0.1, seed, &is_in_ball).unwrap()
        })
    };
    let first = points(1, 1);
    assert!(first == points(2, 1) && first == points(3, 1));
    assert_ne!(first, points(1, 2));
    let volumes = |threads: usize| {
        on(threads, || {
            nearest_volumes(&first, BALL, 3, 0.1, &is_in_ball).unwrap()
        })
    };
    let alone = volumes(1);
    assert!(alone == volumes(2) && alone == volumes(3));
}

#[test]
fn nearest_point_volumes_add_up_and_equal_the_cells_of_a_lattice() {
    let points = blue_noise(BALL, 3, 0.1, 1, &is_in_ball).unwrap();
    let volumes = nearest_volumes(&points, BALL, 3, 0.1, &is_in_ball).unwrap();
    let volume: f64 = volumes.iter().sum();
    // Integer samples, 80 across the ball; the bound was chosen after seeing less than 1e-3.
    assert!((volume / (4.0 / 3.0 * PI) - 1.0).abs() < 2e-3, "{volume}");
    assert!(volumes.iter().all(|&v| v > 0.0));
    // The nodes of a lattice have the volumes of its cells.
    let bounds = [[0.0; 3], [1.0, 0.5, 0.75]];
    let lattice = Lattice::around(bounds, [0.25; 3]).unwrap();
    let nodes: Vec<Point> = (0..lattice.len())
        .map(|n| lattice.position([n % 4, n / 4 % 2, n / 8]))
        .collect();
    let volumes = nearest_volumes(&nodes, bounds, 3, 0.25, &|_| true).unwrap();
    for volume in volumes {
        assert!((volume * 64.0 - 1.0).abs() < 1e-12, "{volume}");
    }
    // In the plane, per unit thickness.
    let flat = nearest_volumes(
        &[[0.25, 0.5, 0.0], [0.75, 0.5, 0.0]],
        [[0.0; 3], [1.0, 1.0, 0.0]],
        2,
        0.1,
        &|_| true,
    )
    .unwrap();
    assert!(
        (flat[0] - 0.5).abs() < 1e-12 && (flat[1] - 0.5).abs() < 1e-12,
        "{flat:?}"
    );
}

#[test]
fn random_displacements_stay_within_the_amplitude_and_the_body() {
    let lattice = Lattice::around(BALL, [0.1; 3]).unwrap();
    let [nx, ny, nz] = lattice.counts;
    let nodes: Vec<[usize; 3]> = (0..nx * ny * nz)
        .map(|n| [n % nx, n / nx % ny, n / (nx * ny)])
        .filter(|&node| is_in_ball(lattice.position(node)))
        .collect();
    let amplitude = 0.3;
    let points = |threads| {
        on(threads, || {
            jittered(&lattice, &nodes, 3, amplitude, 7, &is_in_ball).unwrap()
        })
    };
    let points_of_one = points(1);
    assert_eq!(points_of_one, points(3));
    let mut sum = 0.0;
    for (x, &node) in points_of_one.iter().zip(&nodes) {
        assert!(is_in_ball(*x));
        for c in 0..3 {
            let shift = (x[c] - lattice.position(node)[c]) / 0.1;
            assert!(shift.abs() <= amplitude + 1e-12);
            sum += shift * shift;
        }
    }
    // The variance of a uniform displacement is a²/3; it is smaller near the boundary, where some
    // displacements are halved.
    let variance = sum / (3 * nodes.len()) as f64;
    assert!(
        (variance / (amplitude * amplitude / 3.0) - 1.0).abs() < 0.1,
        "{variance}"
    );
    let flat = jittered(&lattice, &nodes[..5], 2, amplitude, 7, &|_| true).unwrap();
    assert!(
        flat.iter()
            .zip(&nodes)
            .all(|(x, &node)| x[2] == lattice.position(node)[2])
    );
    for value in [-0.1, 0.5, f64::NAN] {
        let rejected = jittered(&lattice, &nodes, 3, value, 7, &is_in_ball);
        assert!(matches!(rejected, Err(FillError::Amplitude { .. })));
    }
    assert!(matches!(
        blue_noise(BALL, 3, 0.0, 1, &is_in_ball),
        Err(FillError::Spacing { .. })
    ));
    assert!(matches!(
        blue_noise(BALL, 3, 1e-9, 1, &is_in_ball),
        Err(FillError::TooMany { .. })
    ));
}
