//! `bench`: performance of the force operators on this machine.

use std::path::Path;

use pericles_bench::{Case, SmallTiming, Timing, small_bodies};
use pericles_run::{RunError, machine};
use serde::Serialize;

use crate::args::BenchArgs;
use crate::console;
use crate::devices;
use crate::error::CliError;
use crate::exit::Exit;

/// Number of rounds; the median is reported.
const ROUNDS: usize = 9;

/// The JSON output.
#[derive(Serialize)]
struct Results {
    machine: String,
    cases: Vec<CaseResult>,
}

#[derive(Serialize)]
struct CaseResult {
    case: String,
    operator: &'static str,
    isa: &'static str,
    points: usize,
    directed_bonds: u64,
    threads: usize,
    ns_per_bond: f64,
    roofline_fraction: f64,
    bytes_per_point: f64,
    gigabytes_per_second: f64,
    build_seconds: f64,
}

impl From<&Timing> for CaseResult {
    fn from(timing: &Timing) -> Self {
        Self {
            case: timing.case.clone(),
            operator: timing.form,
            isa: timing.instruction_set.name(),
            points: timing.points,
            directed_bonds: timing.directed_bonds,
            threads: timing.threads,
            ns_per_bond: timing.ns_per_bond,
            roofline_fraction: timing.roofline_fraction,
            bytes_per_point: timing.bytes_per_point,
            gigabytes_per_second: timing.gigabytes_per_second,
            build_seconds: timing.build_seconds,
        }
    }
}

/// Name of the bench of small bodies.
const SMALL: &str = "small-bodies";
/// Number of rounds for small bodies.
const SMALL_ROUNDS: usize = 7;
/// Numbers of threads for small bodies.
const SMALL_THREADS: [usize; 2] = [1, 2];

/// The JSON output for small bodies.
#[derive(Serialize)]
struct SmallResults {
    machine: String,
    threads: [usize; 2],
    bodies: Vec<SmallResult>,
}

#[derive(Serialize)]
struct SmallResult {
    body: &'static str,
    points: usize,
    force_ns_per_point: f64,
    evaluations: f64,
    step_ns_per_point: Vec<f64>,
}

/// Measures small bodies on one and two threads.
fn bench_small(args: &BenchArgs) -> Result<Exit, CliError> {
    let pools =
        SMALL_THREADS.map(|count| rayon::ThreadPoolBuilder::new().num_threads(count).build());
    let pools = pools
        .into_iter()
        .collect::<Result<Vec<_>, _>>()
        .map_err(RunError::from)?;
    let machine = machine::words();
    let table = args.json.as_deref() != Some(Path::new("-"));
    if table {
        console::print(format_args!(
            "{machine}; ns per point\n{:<20} {:>8} {:>16} {:>12} {:>15} {:>16}",
            "body", "points", "force, 1 thread", "forces/step", "step, 1 thread", "step, 2 threads"
        ))?;
    }
    let mut bodies = Vec::new();
    small_bodies(
        &pools,
        SMALL_ROUNDS,
        usize::MAX,
        &mut |timing: SmallTiming| {
            if table {
                console::print(format_args!(
                    "{:<20} {:>8} {:>16.2} {:>12.2} {:>15.2} {:>16.2}",
                    timing.body,
                    timing.points,
                    timing.force_ns,
                    timing.evaluations,
                    timing.step_ns[0],
                    timing.step_ns[1]
                ))?;
            }
            bodies.push(SmallResult {
                body: timing.body,
                points: timing.points,
                force_ns_per_point: timing.force_ns,
                evaluations: timing.evaluations,
                step_ns_per_point: timing.step_ns,
            });
            Ok::<(), CliError>(())
        },
    )?;
    if let Some(path) = &args.json {
        let threads = SMALL_THREADS;
        console::write_json(
            path,
            &SmallResults {
                machine,
                threads,
                bodies,
            },
        )?;
    }
    Ok(Exit::Done)
}

/// Measures one case, all cases, or small bodies.
///
/// # Errors
/// The case is unknown, or output cannot be written.
pub(crate) fn bench(args: &BenchArgs) -> Result<Exit, CliError> {
    if let Some(wanted) = args.device.graphics() {
        return devices::bench(args, wanted);
    }
    if args.case.as_deref() == Some(SMALL) {
        return bench_small(args);
    }
    let cases = match &args.case {
        None => Case::all(),
        Some(name) => vec![Case::named(name).ok_or_else(|| {
            let cases = Case::all();
            let mut names: Vec<&str> = cases.iter().map(|case| case.name.as_str()).collect();
            names.push(SMALL);
            let all = format!(
                "bar-N, plate-N or block-N with N cells per axis, followed by any of -list, -lps, -f32, -scalar, -avx2, -moved, such as {}",
                names.join(", ")
            );
            RunError::unknown("case", name, names, &all)
        })?],
    };
    let threads = args.threads.start()?;
    let machine = machine::words();
    let table = args.json.as_deref() != Some(Path::new("-"));
    if table {
        console::print(format_args!(
            "{machine}; {threads} threads\n{:<20} {:>8} {:>8} {:>10} {:>12} {:>8} {:>11} {:>6} {:>9} {:>8}",
            "case",
            "kernel",
            "isa",
            "points",
            "bonds (dir.)",
            "ns/bond",
            "Mbonds/s",
            "GB/s",
            "roofline",
            "B/point"
        ))?;
    }
    let mut timings = Vec::new();
    for case in &cases {
        let timing = pericles_bench::run(case, ROUNDS)?;
        if table {
            console::print(format_args!(
                "{:<20} {:>8} {:>8} {:>10} {:>12} {:>8.3} {:>11.0} {:>6.1} {:>8.0}% {:>8.0}",
                timing.case,
                timing.form,
                timing.instruction_set.name(),
                timing.points,
                timing.directed_bonds,
                timing.ns_per_bond,
                1e-6 * timing.bonds_per_second(),
                timing.gigabytes_per_second,
                100.0 * timing.roofline_fraction,
                timing.bytes_per_point
            ))?;
        }
        timings.push(timing);
    }
    if let Some(path) = &args.json {
        let cases = timings.iter().map(CaseResult::from).collect();
        console::write_json(path, &Results { machine, cases })?;
    }
    Ok(Exit::Done)
}
