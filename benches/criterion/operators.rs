//! Building, force and step of both operator forms in one, two and three dimensions.
//!
//! `cd benches/criterion && cargo bench --bench operators`; throughput is in directed bonds.

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use pericles::Interrupt;
use pericles::family::pairs_within;
use pericles::operator::{BondForm, PointSubset};
use pericles::time::{Integrator, VelocityVerlet};
use pericles_bench::Case;

fn cases() -> Vec<(String, Case)> {
    let mut cases = Vec::new();
    for cells in [vec![200_000], vec![256; 2], vec![30; 3]] {
        for form in [BondForm::Grid, BondForm::FloatGrid, BondForm::List] {
            let case = Case::new("", cells.clone(), form);
            cases.push((format!("{}d-{form:?}", cells.len()).to_lowercase(), case));
        }
    }
    cases
}

fn operators(criterion: &mut Criterion) {
    for (name, case) in cases() {
        let (mut system, mut state) = case.system().expect("the case is sound");
        let bonds = Throughput::Elements(system.operator().directed_bonds());

        let mut group = criterion.benchmark_group("build");
        group.sample_size(10).throughput(bonds.clone());
        group.bench_function(BenchmarkId::from_parameter(&name), |b| {
            b.iter(|| case.system().expect("the case is sound"));
        });
        group.finish();

        let mut group = criterion.benchmark_group("force");
        group.sample_size(20).throughput(bonds.clone());
        let mut out = vec![0.0; state.u.len()];
        group.bench_function(BenchmarkId::from_parameter(&name), |b| {
            b.iter(|| {
                let operator = system.operator();
                operator.add_force(0.0, &state.u, PointSubset::All, &mut out);
            });
        });
        group.finish();

        let mut group = criterion.benchmark_group("step");
        group.sample_size(20).throughput(bonds);
        let mut verlet = VelocityVerlet;
        verlet.start(&mut system, &mut state);
        group.bench_function(BenchmarkId::from_parameter(&name), |b| {
            b.iter(|| {
                let next = state.t + 1e-9;
                verlet
                    .step(&mut system, &mut state, next, Interrupt::never())
                    .expect("Verlet does not fail");
            });
        });
        group.finish();
    }
}

fn search(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("search");
    group.sample_size(10);
    let case = Case::new("", vec![30; 3], BondForm::List);
    let cloud = case.cloud().expect("the case is sound");
    let reach = case.material().horizon;
    group.throughput(Throughput::Elements(
        pairs_within(&cloud, reach).1.len() as u64
    ));
    group.bench_function("3d", |b| b.iter(|| pairs_within(&cloud, reach)));
    group.finish();
}

criterion_group!(benches, operators, search);
criterion_main!(benches);
