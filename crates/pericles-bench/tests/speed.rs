//! Speed of the operators relative to a reference loop, independent of the machine.
//!
//! CPU times of this process are measured alternately with those of the reference loop on the same body, as
//! the minimum over several rounds; only their ratio counts. The bounds are half of the ratios measured on an
//! idle machine, so that they fail if loops lose their vector instructions but not on a busy machine.

use pericles::operator::InstructionSet;
use pericles_bench::{Case, cpu_seconds, run_in_turn};

#[test]
#[cfg_attr(debug_assertions, ignore = "measures optimised loops: --release")]
fn the_operators_are_faster_than_the_reference_loop() {
    if InstructionSet::detect() == InstructionSet::Baseline {
        eprintln!("the machine has no vector instructions: test skipped");
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
        .expect("the cases are valid");
    for body in timings.chunks(3) {
        let best: Vec<f64> = body.iter().map(|case| case.best_ns_per_bond).collect();
        let (grid, list) = (best[0] / best[1], best[0] / best[2]);
        println!(
            "{}: speed-up {grid:.2} (grid), {list:.2} (list)",
            body[0].case
        );
        assert!(grid > 1.6, "{body:?}");
        assert!(list > 0.8, "{body:?}");
    }
}
