//! A running crack compared with the fine step everywhere.

use pericles::material::BondStretch;

use super::bodies::crack;
use super::schemes::{Scheme, adaptive, mixed, respa, run, uniform};

/// Result of a crack run: broken bonds, tip, displacement.
struct Cracked {
    broken: u64,
    tip: f64,
    u: Vec<f64>,
    fraction: f64,
}

fn cracked(cells: usize, speed: f64, end: f64, steps: u64, scheme: &Scheme<'_>) -> Cracked {
    let simulation = run(
        crack::<BondStretch>(cells, speed, 0.006, end),
        steps,
        scheme,
    );
    let system = simulation.system();
    let cloud = system.cloud();
    let mut damage = vec![0.0; cloud.len()];
    system.operator().damage_into(&mut damage);
    let tip = (0..cloud.len())
        .filter(|&i| damage[i] > 0.3)
        .map(|i| cloud.point(i)[0])
        .fold(0.0, f64::max);
    Cracked {
        broken: system.operator().broken_bonds(),
        tip,
        u: simulation.state().u.clone(),
        fraction: simulation
            .integrator()
            .refinement()
            .map_or(0.0, |report| report.mean_fraction),
    }
}

fn relative(a: &[f64], b: &[f64]) -> f64 {
    let square = |x: &mut dyn Iterator<Item = f64>| -> f64 { x.map(|x| x * x).sum() };
    let difference = square(&mut a.iter().zip(b).map(|(a, b)| a - b));
    (difference / square(&mut b.iter().copied())).sqrt()
}

#[test]
fn a_small_crack_agrees_with_the_fine_step_everywhere() {
    let (cells, speed, end, steps) = (40, 10.0, 1.2e-5, 64);
    let horizon = 3.015 * 0.05 / cells as f64;
    let fine = cracked(cells, speed, end, 4 * steps, &uniform(4));
    assert!(fine.broken > 50, "{}", fine.broken);
    let with = |scheme: &Scheme<'_>| {
        let found = cracked(cells, speed, end, steps, scheme);
        println!(
            "broken {} {}, tip {} {}, relative {}, fine {}",
            found.broken,
            fine.broken,
            found.tip,
            fine.tip,
            relative(&found.u, &fine.u),
            found.fraction
        );
        let broken = found.broken as f64 / fine.broken as f64;
        assert!((broken - 1.0).abs() < 0.1);
        assert!((found.tip - fine.tip).abs() < 2.0 * horizon);
        found
    };
    let strip = with(&mixed(4, 4));
    let following = with(&adaptive(4, 4));
    with(&respa(4));
    assert!(following.fraction < strip.fraction && following.fraction > 0.0);
}
