//! Benchmark of the surface force: a sphere with 10 242 vertices and 6.4 million directed bonds, for each power
//! and instruction set.
//!
//! `RAYON_NUM_THREADS=1 cargo bench -p pericles-bench --bench surface` prints the CPU time per directed bond
//! and the rate at which bonds are read, next to the rate at which this machine reads the same number of bytes
//! without computing. All cases are timed in turn, round after round, so that they see the same machine load.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use pericles::operator::{Force, InstructionSet, PointSubset};
use pericles_bench::{cpu_seconds, read};
use pericles_manifold::force::{DisplacementBond, Exponent, HalfInteger, SurfaceBody};
use pericles_manifold::geodesic::{GeodesicMethod, geodesic_pairs};
use pericles_manifold::surface::{AreaRule, Surface};
use pericles_manifold::{PowerMaterial, SurfaceBond};
use rayon::prelude::*;

const ROUNDS: usize = 15;

/// Passes timed together; one pass takes a few milliseconds, about the resolution of the clock.
const PASSES: usize = 10;

struct Case<'a> {
    name: String,
    work: Box<dyn FnMut() + 'a>,
    /// CPU and wall time of a pass, s.
    times: Vec<[f64; 2]>,
}

impl<'a> Case<'a> {
    fn new(name: String, work: impl FnMut() + 'a) -> Self {
        let (work, times) = (Box::new(work), Vec::new());
        Self { name, work, times }
    }

    fn time(&mut self) {
        let (cpu, wall) = (cpu_seconds(), Instant::now());
        (0..PASSES).for_each(|_| (self.work)());
        let times = [cpu_seconds() - cpu, wall.elapsed().as_secs_f64()];
        self.times.push(times.map(|time| time / PASSES as f64));
    }

    fn sorted(&self, clock: usize) -> Vec<f64> {
        let mut times: Vec<f64> = self.times.iter().map(|times| times[clock]).collect();
        times.sort_by(f64::total_cmp);
        times
    }
}

fn forces<E: Exponent>(body: &SurfaceBody<'_>, exponent: E) -> Vec<Case<'static>> {
    let case = |set: InstructionSet| {
        let operator = body
            .force(DisplacementBond(exponent))
            .with_instruction_set(set);
        let entries = 3 * operator.points();
        let u: Vec<f64> = (0..entries).map(|k| (k as f64 * 0.37).sin()).collect();
        let mut out = vec![0.0; entries];
        let work = move || operator.add_force(0.0, black_box(&u), PointSubset::All, &mut out);
        Case::new(format!("p = {}, {}", exponent.p(), set.name()), work)
    };
    let fast = |set: &InstructionSet| *set != InstructionSet::Baseline;
    let sets = InstructionSet::available();
    sets.into_iter().filter(fast).map(case).collect()
}

fn main() {
    let surface = Surface::icosphere(5, 1.0).expect("a sphere").renumbered();
    let areas = surface.vertex_areas(AreaRule::Barycentric);
    let cloud = Arc::new(surface.points(areas).expect("positive areas"));
    let pairs = geodesic_pairs(&surface, 0.5, GeodesicMethod::Exact).expect("neighbours");
    let material = PowerMaterial {
        density: 1.0,
        kappa: 1.0,
        alpha: 0.5,
        p: 2.0,
        horizon: 0.5,
        bond: SurfaceBond::Displacement,
        self_interaction: false,
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
    let bonds = pairs.len() as f64;
    let bytes = 12.0 * bonds;
    let numbers = vec![1.0_f64; (bytes / 8.0) as usize];
    let set = InstructionSet::detect();
    let mut cases = vec![Case::new("read only, 12 bytes per bond".into(), || {
        let parts = black_box(&numbers).par_chunks(1 << 16);
        black_box(parts.map(|part| read(set, part)).sum::<f64>());
    })];
    cases.extend(forces(&body, HalfInteger::<0, 0>));
    cases.extend(forces(&body, HalfInteger::<2, 0>));
    cases.extend(forces(&body, HalfInteger::<0, 1>));
    cases.extend(forces(&body, HalfInteger::<2, 1>));
    for _ in 0..ROUNDS {
        cases.iter_mut().for_each(Case::time);
    }
    let threads = rayon::current_num_threads();
    println!("{bonds} directed bonds, {threads} threads; ns per directed bond, {ROUNDS} rounds");
    println!("{:<24} CPU best  median  GB/s best  wall best", "");
    for case in &cases {
        let (cpu, wall) = (case.sorted(0), case.sorted(1));
        println!(
            "{:<24} {:>8.3} {:>7.3} {:>10.1} {:>10.3}",
            case.name,
            1e9 * cpu[0] / bonds,
            1e9 * cpu[ROUNDS / 2] / bonds,
            1e-9 * bytes / cpu[0] * threads as f64,
            1e9 * wall[0] / bonds
        );
    }
}
