//! The Pericles part of the comparison in `benches/lammps`, run by its script.
//!
//! `time CASE ROUNDS` prints one line of JSON with wall and CPU time per directed bond;
//! `forces CELLS [grid|grid-f32|list]` prints cells and force densities of a deformed block, one line
//! `i j k fx fy fz` per point; `fracture CELLS STEPS [grid|grid-f32|list]` prints one line of JSON for a
//! block pulled apart.

use std::f64::consts::TAU;
use std::sync::Arc;

use pericles::Interrupt;
use pericles::boundary::{MotionKind, PrescribedMotion, TimeFunction};
use pericles::material::StressState;
use pericles::operator::{BondBody, BondForm, PointSubset};
use pericles::time::{Integrator, State, VelocityVerlet};
use pericles_bench::{Case, Timing, cpu_seconds, run, run_by_clock};

fn time(case: &Case, rounds: usize) -> pericles::Result<()> {
    let wall = run(case, rounds)?;
    let cpu: Timing = run_by_clock(case, rounds, &cpu_seconds)?;
    println!(
        "{{\"case\":\"{}\",\"isa\":\"{}\",\"points\":{},\"directed_bonds\":{},\"threads\":{},\"wall_ns\":{},\"cpu_ns\":{},\"roofline_ns\":{},\"bytes_per_point\":{}}}",
        cpu.case,
        cpu.instruction_set.name(),
        cpu.points,
        cpu.directed_bonds,
        cpu.threads,
        wall.ns_per_bond,
        cpu.ns_per_bond,
        cpu.roofline_ns,
        cpu.bytes_per_point,
    );
    Ok(())
}

/// Displacement of `in.forces`: strains of about one per cent that vary over the block.
fn displacement(cell: [f64; 3], length: f64, spacing: f64) -> [f64; 3] {
    let x = cell.map(|k| k * spacing);
    let wave = |x: f64| TAU * x / length;
    let amplitude = length / TAU;
    [
        0.006 * x[0] + 0.003 * amplitude * wave(x[2]).sin(),
        -0.002 * x[1] + 0.004 * amplitude * wave(x[0]).cos(),
        0.004 * x[2] + 0.003 * amplitude * wave(x[1]).sin(),
    ]
}

fn forces(cells: usize, form: BondForm) -> pericles::Result<()> {
    let case = Case::new("forces", vec![cells; 3], form);
    let cloud = case.cloud()?;
    let material = case.material();
    let constants = material.constants(&cloud, StressState::Spatial)?;
    let body = BondBody::new(&cloud, &material, &constants);
    let operator = body.operator(case.form)?.operator;
    let n = cloud.len();
    let spacing = cloud.spacing();
    let cell = |i: usize| cloud.point(i).map(|x| (x / spacing - 0.5).round());
    let mut u = vec![0.0; 3 * n];
    for i in 0..n {
        let moved = displacement(cell(i), cells as f64 * spacing, spacing);
        (0..3).for_each(|c| u[c * n + i] = moved[c]);
    }
    let mut force = vec![0.0; 3 * n];
    operator.add_force(0.0, &u, PointSubset::All, &mut force);
    println!("{}", operator.directed_bonds());
    for i in 0..n {
        let [x, y, z] = cell(i);
        let f = [force[i], force[n + i], force[2 * n + i]];
        println!("{x} {y} {z} {:.17e} {:.17e} {:.17e}", f[0], f[1], f[2]);
    }
    Ok(())
}

/// The block of `in.fracture`, pulled apart by its end layers: CPU nanoseconds per step and initial bond, and
/// the mean damage.
fn fracture(cells: usize, steps: usize, form: BondForm) -> pericles::Result<()> {
    let case = Case {
        critical_stretch: 0.002,
        ..Case::new("fracture", vec![cells; 3], form)
    };
    let (mut system, moving) = case.system()?;
    let cloud = Arc::clone(system.cloud());
    let (n, spacing) = (cloud.len(), cloud.spacing());
    let mut state = State::at_rest(moving.u.len());
    let layer = |from: usize, to: usize| -> Vec<u32> {
        let cell = |i: u32| (cloud.point(i as usize)[0] / spacing) as usize;
        (0..n as u32)
            .filter(|&i| (from..to).contains(&cell(i)))
            .collect()
    };
    for (name, points, speed) in [
        ("left", layer(0, 3), -5.0),
        ("right", layer(cells - 3, cells), 5.0),
    ] {
        system.add_motion(
            PrescribedMotion::new(
                name.to_owned(),
                points,
                MotionKind::Velocity,
                [Some(speed), Some(0.0), Some(0.0)],
                TimeFunction::Constant,
                &state.u,
                n,
            )
            .unwrap(),
        )?;
    }
    let bonds = system.operator().directed_bonds();
    let mut verlet = VelocityVerlet;
    verlet.start(&mut system, &mut state);
    let begin = cpu_seconds();
    for step in 1..=steps {
        verlet.step(
            &mut system,
            &mut state,
            1e-7 * step as f64,
            Interrupt::never(),
        )?;
    }
    let time = (cpu_seconds() - begin) / steps as f64;
    let mut damage = vec![0.0; n];
    system.operator().damage_into(&mut damage);
    println!(
        "{{\"directed_bonds\":{bonds},\"cpu_ns\":{},\"broken\":{},\"damage\":{}}}",
        1e9 * time / bonds as f64,
        system.operator().broken_bonds(),
        damage.iter().sum::<f64>() / n as f64
    );
    Ok(())
}

fn main() -> pericles::Result<()> {
    // Cargo adds --bench.
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|word| word != "--bench")
        .collect();
    let number = |k: usize, default: usize| {
        words
            .get(k)
            .and_then(|word| word.parse().ok())
            .unwrap_or(default)
    };
    let form = |k: usize| match words.get(k).map(String::as_str) {
        Some("list") => BondForm::List,
        Some("grid-f32") => BondForm::FloatGrid,
        _ => BondForm::Grid,
    };
    match words.first().map(String::as_str) {
        Some("forces") => forces(number(1, 20), form(2)),
        Some("fracture") => fracture(number(1, 40), number(2, 300), form(3)),
        Some("time") => match words.get(1).and_then(|name| Case::named(name)) {
            Some(case) => time(&case, number(2, 5)),
            None => {
                eprintln!(
                    "unknown case; allowed: {:?}",
                    Case::all().into_iter().map(|c| c.name).collect::<Vec<_>>()
                );
                Ok(())
            }
        },
        _ => {
            println!(
                "usage: time CASE ROUNDS | forces CELLS [grid|list] | fracture CELLS STEPS [grid|list]; see benches/lammps"
            );
            Ok(())
        }
    }
}
