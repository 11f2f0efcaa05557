//! Speed of the loops of state-based materials relative to those of bond-based materials.

use std::sync::Arc;

use crate::bodies::{solid, wave};
use crate::clock::cpu_seconds;
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
    let gaussian = InfluenceFunction::Gaussian {
        length: 1.5,
        cutoff: None,
    };
    let solid = |function: &InfluenceFunction, form| state_based(&cloud, function.clone(), form);
    let (list, grid) = (BondForm::List, BondForm::Grid);
    let (constant, inverse) = (InfluenceFunction::Constant, InfluenceFunction::Inverse);
    let mut forces: [(&str, Box<dyn Force>); 7] = [
        ("bond-based list", pairs(list)),
        ("list, constant", solid(&constant, list)),
        ("list, inverse", solid(&inverse, list)),
        ("list, gaussian", solid(&gaussian, list)),
        ("bond-based stencil", pairs(grid)),
        ("stencil, constant", solid(&constant, grid)),
        ("stencil, gaussian", solid(&gaussian, grid)),
    ];
    let u = wave(&cloud, 0.002);
    let mut out = vec![0.0; u.len()];
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.unwrap().install(|| {
        for set in InstructionSet::available() {
            let mut times = [const { Vec::new() }; 7];
            for (_, force) in &mut forces {
                force.use_instruction_set(set);
            }
            // Alternating evaluations with medians, so that other programs affect all kinds equally.
            for round in 0..60 {
                let first = if round % 8 == 0 { 0 } else { 4 };
                for ((_, force), times) in forces.iter().zip(&mut times).skip(first) {
                    let start = cpu_seconds();
                    force.add_force(0.0, &u, PointSubset::All, &mut out);
                    let ns = 1e9 * (cpu_seconds() - start) / force.directed_bonds() as f64;
                    times.push(ns);
                }
            }
            let median = times.map(|mut times: Vec<f64>| {
                times.sort_by(f64::total_cmp);
                times[times.len() / 2]
            });
            for ((name, force), median) in forces.iter().zip(median) {
                let set = force.instruction_set().name();
                println!("{set}, {name}: {median:.2} ns per directed bond");
            }
            println!(
                "two passes over one: {:.2} (list), {:.2} (stencil)",
                median[1] / median[0],
                median[5] / median[4]
            );
            let vectors = set != InstructionSet::Baseline;
            assert!(!vectors || median[1] < 2.8 * median[0], "{median:?}");
            assert!(!vectors || median[5] < 2.4 * median[4], "{median:?}");
        }
    });
}
