//! Writing what a run leaves: one file of fields, one checkpoint.
//!
//! `cd benches/criterion && cargo bench --bench output`; throughput is in points.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pericles::observe::Observer;
use pericles::operator::BondForm;
use pericles::time::VelocityVerlet;
use pericles::{Archive, Checkpointed, Simulation};
use pericles_bench::Case;
use pericles_io::observers::FieldSeries;

fn output(criterion: &mut Criterion) {
    let case = Case::new("", vec![60; 3], BondForm::Grid);
    let (system, state) = case.system().expect("the case is sound");
    let points = system.points() as u64;
    let simulation = Simulation::new(system, Box::new(VelocityVerlet), state, 1e-9, 1).unwrap();
    let mut group = criterion.benchmark_group("output");
    group
        .sample_size(10)
        .throughput(Throughput::Elements(points));
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::create_dir(folder.path().join("fields")).expect("a folder");
    group.bench_function("fields", |b| {
        let mut series = FieldSeries::new(folder.path(), false);
        b.iter(|| {
            series
                .observe(&simulation.snapshot())
                .expect("the disk has room");
            // The writer runs beside the simulation; its work is waited for here.
            series.settle().expect("the disk has room");
        });
    });
    group.bench_function("state", |b| {
        b.iter(|| {
            let mut archive = Archive::default();
            simulation.save(&mut archive);
            archive
        });
    });
    group.finish();
}

criterion_group!(benches, output);
criterion_main!(benches);
