//! The fast loops are fast: a check that does not depend on the machine's speed.
//!
//! Times are CPU times of one process that does nothing else, taken in turn with those of the plain loop on the same body, the best of several rounds; only their
//! ratio counts. The bounds are half of what is measured on a quiet machine, so that they fail if loops lose their vector instructions and not if somebody else is busy.

use pericles::operator::InstructionSet;
use pericles_bench::{Case, cpu_seconds, run_in_turn};

#[test]
#[cfg_attr(debug_assertions, ignore = "measures optimised loops: --release")]
fn the_operators_outrun_the_plain_loop() {
    if InstructionSet::detect() == InstructionSet::Baseline {
        eprintln!("no vector instructions here: nothing to compare");
        return;
    }
    let names = [
        "plate-160-scalar",
        "plate-160-avx2",
        "plate-160-list-avx2",
        "block-24-scalar",
        "block-24-avx2",
        "block-24-list-avx2",
    ];
    let cases: Vec<Case> = names.iter().filter_map(|name| Case::named(name)).collect();
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .expect("a thread");
    let timings = pool
        .install(|| run_in_turn(&cases, 4, &cpu_seconds))
        .expect("the cases are sound");
    for body in timings.chunks(3) {
        let best: Vec<f64> = body.iter().map(|case| case.best_ns_per_bond).collect();
        let (grid, list) = (best[0] / best[1], best[0] / best[2]);
        println!(
            "{}: {grid:.2} times by grid, {list:.2} by list",
            body[0].case
        );
        assert!(grid > 1.6, "{body:?}");
        assert!(list > 0.8, "{body:?}");
    }
}
