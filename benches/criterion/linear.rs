//! Linear operators: a line by its three routes, and lattice bodies by convolution and by the bond list.
//!
//! `cd benches/criterion && cargo bench --bench linear`; threads by RAYON_NUM_THREADS. These figures are where the constants of `operator/linear/cost.rs`
//! come from.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion};
use pericles::family::{BondList, VolumeCorrection};
use pericles::material::LinearBond;
use pericles::operator::{BondForce, Breaking, DamageMeasure, LinearOperator};
use pericles_waves::linear::{ConvolutionForce, Ends, Route, Toeplitz};
use pericles::space::{Grid, PointCloud, Shape};

fn wave(len: usize) -> Vec<f64> {
    (0..len).map(|k| (k as f64 * 0.37).sin()).collect()
}

/// N = 1e6, half-width R: the banded loop up to R = 200, overlap-save, one transform, and the route chosen.
fn line(criterion: &mut Criterion) {
    let nodes = 1_000_000;
    let (u, mut y) = (wave(nodes), vec![0.0; nodes]);
    let mut group = criterion.benchmark_group("line of 1e6");
    for reach in [10, 15, 20, 25, 30, 50, 75, 100, 200, 500, 1000] {
        let weights: Vec<f64> = (1..=reach).map(|r| 1.0 / f64::from(r)).collect();
        let line = || Toeplitz::stencil(nodes, &weights, Ends::Free).expect("valid weights");
        let chosen = line().route();
        for route in [Route::Banded, Route::OverlapSave, Route::OneTransform] {
            if route == Route::Banded && reach > 200 {
                continue;
            }
            let operator = line().with_route(route);
            let mark = if route == chosen { " (chosen)" } else { "" };
            group.bench_function(BenchmarkId::new(format!("{route:?}{mark}"), reach), |b| {
                b.iter(|| operator.apply_into(black_box(&u), &mut y));
            });
        }
    }
    group.finish();
}

fn body(dimension: usize, cells: f64) -> Arc<PointCloud> {
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: vec![cells; dimension],
        },
        spacing: 1.0,
        section: 1.0,
        holes: vec![],
    };
    Arc::new(grid.points().expect("a box of whole cells"))
}

fn lattice<const D: usize>(
    criterion: &mut Criterion,
    cells: f64,
    horizons: &[f64],
    list_up_to: f64,
) {
    let cloud = body(D, cells);
    let u = wave(D * cloud.len());
    let mut out = vec![0.0; u.len()];
    let mut group = criterion.benchmark_group(format!("{D}D, {cells} points a side"));
    for &m in horizons {
        let none = VolumeCorrection::None;
        let fast =
            ConvolutionForce::<D>::with_stiffness(cloud.clone(), m, none, |_| 1.0, [false; D])
                .expect("a lattice");
        group.bench_function(BenchmarkId::new("convolution", m), |b| {
            b.iter(|| fast.apply_into(black_box(&u), &mut out));
        });
        if m <= list_up_to {
            let bonds = BondList::new(&cloud, m, none).expect("a family");
            let breaking = Breaking {
                critical_stretch: f64::INFINITY,
                no_fail: &[],
            };
            let list = BondForce::<LinearBond, D>::with_stiffness(
                cloud.clone(),
                bonds,
                |_| 1.0,
                breaking,
                DamageMeasure::default(),
            ).unwrap();
            group.bench_function(BenchmarkId::new("bond list", m), |b| {
                b.iter(|| list.apply_into(black_box(&u), &mut out));
            });
        }
    }
    group.finish();
}

fn main() {
    let mut criterion = Criterion::default()
        .sample_size(10)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(600))
        .configure_from_args();
    line(&mut criterion);
    lattice::<2>(&mut criterion, 500.0, &[3.0, 6.0, 12.0, 50.0], 12.0);
    lattice::<3>(&mut criterion, 64.0, &[2.0, 3.0, 5.0, 10.0, 20.0], 5.0);
    criterion.final_summary();
}
