//! The force of a surface: a sphere of 10 242 vertices, 6.4 million directed bonds, for each power and instruction set.
//!
//! `RAYON_NUM_THREADS=1 cargo bench -p pericles --bench surface`: time per directed bond and thread. The last case reads as many bytes as the bonds take, for comparison.

use std::hint::black_box;
use std::sync::Arc;

use criterion::{BenchmarkId, Criterion, Throughput};
use pericles::family::geodesic::{GeodesicMethod, geodesic_pairs};
use pericles::material::{PowerMaterial, SurfaceBond};
use pericles::operator::surface::{
    DisplacementBond, Exponent, HalfInteger, SurfaceBody, SurfaceForce,
};
use pericles::operator::{ForceOperator, InstructionSet, On};
use pericles::space::PointCloud;
use pericles::space::surface::{AreaRule, Surface};

fn force<E: Exponent>(
    group: &mut criterion::BenchmarkGroup<'_, criterion::measurement::WallTime>,
    make: &dyn Fn(DisplacementBond<E>) -> SurfaceForce<DisplacementBond<E>>,
    exponent: E,
) {
    for set in InstructionSet::available() {
        let operator = make(DisplacementBond(exponent)).with_instruction_set(set);
        let entries = 3 * operator.points();
        let u: Vec<f64> = (0..entries).map(|k| (k as f64 * 0.37).sin()).collect();
        let mut out = vec![0.0; entries];
        group.throughput(Throughput::Elements(operator.directed_bonds()));
        group.bench_function(
            BenchmarkId::new(format!("p = {}", exponent.p()), set.name()),
            |b| {
                b.iter(|| operator.add_force(0.0, black_box(&u), On::All, &mut out));
            },
        );
    }
}

fn main() {
    let mut criterion = Criterion::default().sample_size(10).configure_from_args();
    let surface = Surface::icosphere(5, 1.0).expect("a sphere").renumbered();
    let areas = surface.vertex_areas(AreaRule::Barycentric);
    let cloud = Arc::new(PointCloud::of_surface(&surface, areas).expect("positive areas"));
    let pairs = geodesic_pairs(&surface, 0.5, GeodesicMethod::Edge).expect("neighbours");
    let material = PowerMaterial {
        density: 1.0,
        kappa: 1.0,
        alpha: 0.5,
        p: 2.0,
        horizon: 0.5,
        bond: SurfaceBond::Displacement,
        self_cell: false,
        critical_stretch: f64::INFINITY,
    };
    let body = SurfaceBody {
        surface: &surface,
        cloud: &cloud,
        pairs: &pairs,
        material: &material,
        stiffness: &[],
        no_fail: &[],
    };
    let mut group = criterion.benchmark_group("surface");
    force(&mut group, &|law| body.force(law), HalfInteger::<0, 0>);
    force(&mut group, &|law| body.force(law), HalfInteger::<2, 0>);
    force(&mut group, &|law| body.force(law), HalfInteger::<0, 1>);
    force(&mut group, &|law| body.force(law), HalfInteger::<2, 1>);
    let numbers = vec![1.0_f64; pairs.len() * 12 / 8];
    group.bench_function("reading 12 bytes a bond", |b| {
        b.iter(|| black_box(&numbers).iter().sum::<f64>());
    });
    group.finish();
}
