//! Speed of the loops of state-based materials relative to those of bond-based materials.

use std::sync::Arc;

use crate::bodies::{solid, wave};
use crate::common::{boxed, material as bond_based};
use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{Fracture, LinearSolid, StressState};
use pericles::operator::{BondBody, BondForm, Force, InstructionSet, LinearSolidBody, PointSubset};
use pericles::space::PointCloud;

const HORIZON: f64 = 3.015;

fn state_based(
    cloud: &Arc<PointCloud>,
    function: InfluenceFunction,
    form: BondForm,
) -> Box<dyn Force> {
    let material = LinearSolid {
        volume_correction: VolumeCorrection::Linear,
        ..solid(0.3, HORIZON, function)
    };
    let constants = material.constants(cloud, StressState::Spatial).unwrap();
    let body = LinearSolidBody::new(cloud, &constants, VolumeCorrection::Linear);
    body.operator(form).unwrap().operator
}

/// Returns the CPU time of the calling thread, s; the pool has one thread. The sum over all threads of the process decreases
/// when a thread of another test ends.
fn cpu_seconds() -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap();
    1e-9 * text.split(' ').next().unwrap().parse::<f64>().unwrap()
}

/// CPU time of a sample, s: fifty ticks of a clock that advances by 4 ms, as it does on some virtual machines.
const SAMPLE: f64 = 0.2;

/// Returns the CPU time of an evaluation per directed bond, ns, as the mean over a sample.
fn nanoseconds_per_bond(force: &mut dyn Force, u: &[f64], out: &mut [f64]) -> f64 {
    let start = cpu_seconds();
    let mut evaluations = 0;
    loop {
        force.add_force(0.0, u, PointSubset::All, out);
        evaluations += 1;
        let seconds = cpu_seconds() - start;
        if seconds >= SAMPLE {
            return 1e9 * seconds / (evaluations * force.directed_bonds()) as f64;
        }
    }
}

/// An evaluation takes two passes over the bonds in place of one. The bound for lists is one and a half times the
/// measured value with AVX2; the bound for the stencil is a target.
#[test]
#[cfg_attr(debug_assertions, ignore = "measures optimised loops: --release")]
fn a_state_based_evaluation_costs_about_two_bond_based_ones() {
    let cloud = boxed([0.0; 3], &[32.0; 3], 1.0, 1.0);
    let plain = bond_based(
        1.0,
        10.0,
        HORIZON,
        VolumeCorrection::Linear,
        Fracture::Unbreakable,
    );
    let constants = plain.constants(&cloud, StressState::Spatial).unwrap();
    let pairs = |form: BondForm| {
        let body = BondBody::new(&cloud, &plain, &constants);
        body.operator(form).unwrap().operator
    };
    let solid = |form| state_based(&cloud, InfluenceFunction::Constant, form);
    let (list, grid) = (BondForm::List, BondForm::Grid);
    let mut forces: [(&str, Box<dyn Force>); 4] = [
        ("bond-based list", pairs(list)),
        ("state-based list", solid(list)),
        ("bond-based stencil", pairs(grid)),
        ("state-based stencil", solid(grid)),
    ];
    let u = wave(&cloud, 0.002);
    let mut out = vec![0.0; u.len()];
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.unwrap().install(|| {
        for set in InstructionSet::available() {
            if set == InstructionSet::Baseline {
                continue;
            }
            for (_, force) in &mut forces {
                force.use_instruction_set(set);
            }
            // The minimum of alternating samples, so that other programs on the machine affect all kinds equally.
            let mut best = [f64::INFINITY; 4];
            for _ in 0..5 {
                for ((_, force), best) in forces.iter_mut().zip(&mut best) {
                    *best = best.min(nanoseconds_per_bond(force.as_mut(), &u, &mut out));
                }
            }
            for ((name, _), best) in forces.iter().zip(best) {
                println!("{}, {name}: {best:.2} ns per directed bond", set.name());
            }
            let [list, grid] = [best[1] / best[0], best[3] / best[2]];
            println!("two passes over one: {list:.2} (list), {grid:.2} (stencil)");
            assert!(list < 2.8, "{best:?}");
            assert!(grid < 2.4, "{best:?}");
        }
    });
}
