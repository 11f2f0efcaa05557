//! Examples with known solutions, without output.

use std::path::Path;

use super::common::Build;
use pericles::{Control, Simulation};
use pericles_deck::Deck;

/// Returns an assembled example and the point of each probe by name.
fn example(name: &str, overrides: &[&str]) -> (Simulation, impl Fn(&str) -> usize + use<>) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../examples")
        .join(name);
    let overrides: Vec<String> = overrides.iter().map(|text| (*text).to_owned()).collect();
    let deck = Deck::read(path, &overrides).unwrap_or_else(|error| panic!("{error}"));
    let model = deck.build().unwrap_or_else(|error| panic!("{error}"));
    let probes = model.probes.clone();
    let point = move |name: &str| {
        let probe = probes.iter().find(|probe| probe.name == name).unwrap();
        probe.points[0] as usize
    };
    (model.simulation(), point)
}

#[test]
fn a_bar_in_tension_follows_hookes_law() {
    for correction in ["none", "volume", "energy"] {
        let change = format!("material.surface_correction={correction}");
        let (mut run, point) = example("statics/bar.toml", &[&change]);
        run.run(|_| Control::Continue).unwrap();
        let u = &run.state().u;
        let end = u[point("end")];
        assert!((end / 1e-3 - 1.0).abs() < 0.01, "{correction}: {end}");
        let between = u[point("three_quarters")] - u[point("quarter")];
        assert!(
            (between / 0.5e-3 - 1.0).abs() < 1e-5,
            "{correction}: {between}"
        );
        let reaction = run.system().motions()[0].reaction(run.system().cloud())[0];
        assert!(
            (reaction / -2e6 - 1.0).abs() < 1e-6,
            "{correction}: {reaction}"
        );
        println!("{correction}: end {end:e} m, strain {} ‰", 2e3 * between);
    }
}

#[test]
fn reflection_at_an_interface_follows_from_the_impedances() {
    let impedance = |young: f64, density: f64| (young * density).sqrt();
    let (first, second) = (impedance(210e9, 7850.0), impedance(70e9, 2700.0));
    for rule in ["harmonic", "arithmetic", "weaker"] {
        let change = format!("interface.0.rule={rule}");
        let (mut run, point) = example("wave/two-materials.toml", &[&change]);
        let (before, behind) = (point("before"), point("behind"));
        let (mut sent, mut reflected, mut transmitted) = (0.0f64, 0.0f64, 0.0f64);
        run.run(|run| {
            let state = run.state();
            // At this time the pulse has passed the first probe, and its reflection has not yet returned.
            if state.t < 35e-6 {
                sent = sent.max(state.u[before]);
            } else {
                reflected = reflected.max(state.u[before]);
            }
            transmitted = transmitted.max(state.u[behind]);
            Control::Continue
        })
        .unwrap();
        let exact = 2.0 * first / (first + second);
        let share = transmitted / sent;
        assert!(
            (share / exact - 1.0).abs() < 0.02,
            "{rule}: {share} {exact}"
        );
        println!("{rule}: transmitted {share:.4}, exact {exact:.4}");
        let exact = (first - second) / (first + second);
        let share = reflected / sent;
        assert!(
            (share / exact - 1.0).abs() < 0.02,
            "{rule}: {share} {exact}"
        );
        println!("{rule}: reflected {share:.4}, exact {exact:.4}");
    }
}

/// Returns the strain at a hole, half a cell from its edge, relative to the far field: for the plate of the example,
/// and Kirsch's solution at the same positions.
fn beside_the_hole(spacing: f64) -> (f64, f64) {
    let half = 0.5 * spacing;
    let overrides = [
        format!("body.spacing={spacing}"),
        format!("probe.0.at=[{}, {}]", 0.01 + half, 3.0 * half),
        format!("probe.1.at=[{}, {}]", 0.01 + half, -3.0 * half),
    ];
    let overrides: Vec<&str> = overrides.iter().map(String::as_str).collect();
    let (mut run, point) = example("statics/hole.toml", &overrides);
    run.run(|_| Control::Continue).unwrap();
    let n = run.system().points();
    let u = |name: &str| run.state().u[n + point(name)];
    let strain = (u("above") - u("below")) / (6.0 * half);
    (strain / (10e6 / 72e9), kirsch(0.01 + half, 3.0 * half))
}

/// Returns (u_y(x, y) − u_y(x, −y))/2y relative to the far-field strain, for a hole of radius 10 mm in an infinite
/// plate in plane stress with ν = 1/3 under tension along y.
fn kirsch(x: f64, y: f64) -> f64 {
    let (a, r) = (0.01, x.hypot(y));
    // Angle from the direction of the load.
    let angle = (-x).atan2(y);
    let nu = 1.0 / 3.0;
    let kappa = (3.0 - nu) / (1.0 + nu);
    let three = (3.0 * angle).cos();
    let sum = r / a * (kappa + 1.0) * angle.cos()
        + 2.0 * a / r * ((1.0 + kappa) * angle.cos() + three)
        - 2.0 * (a / r).powi(3) * three;
    // u = a σ sum/(8 μ) with E = 2 μ (1 + ν).
    0.25 * a * (1.0 + nu) * sum / y
}

#[test]
fn the_exact_stress_concentration_at_the_edge_is_three() {
    assert!((kirsch(0.01, 1e-7) - 3.0).abs() < 1e-5);
}

/// Minutes without optimisation: `cargo test --release -p pericles-deck --test solutions -- --ignored --nocapture`.
#[test]
#[ignore = "minutes"]
fn strain_at_a_hole_is_three_times_the_far_field() {
    for spacing in [2e-3, 1e-3, 0.5e-3] {
        let (found, exact) = beside_the_hole(spacing);
        println!(
            "dx = {spacing}: {found:.4}, Kirsch {exact:.4}, ratio {:.4}",
            found / exact
        );
    }
    let (found, exact) = beside_the_hole(0.5e-3);
    assert!((found / exact - 1.0).abs() < 0.05, "{found} {exact}");
}

/// Returns the least-squares coefficients of 1, r² and r⁴, by the normal equations.
fn even_polynomial(samples: &[(f64, f64)]) -> [f64; 3] {
    let powers = |r: f64| [1.0, r * r, r.powi(4)];
    let mut rows = [[0.0; 4]; 3];
    for &(r, value) in samples {
        let basis = powers(r);
        for i in 0..3 {
            for j in 0..3 {
                rows[i][j] += basis[i] * basis[j];
            }
            rows[i][3] += basis[i] * value;
        }
    }
    for i in 0..3 {
        let row = rows[i].map(|x| x / rows[i][i]);
        rows[i] = row;
        for other in (0..3).filter(|&k| k != i) {
            let factor = rows[other][i];
            for j in 0..4 {
                rows[other][j] -= factor * row[j];
            }
        }
    }
    rows.map(|row| row[3])
}

/// Returns the stress concentration at the hole: the strain along the ligament from two horizons to 25 mm from the
/// edge is fitted by the form of Kirsch's solution c₀ + c₂ (a/x)² + c₄ (a/x)⁴, extrapolated to the edge and divided
/// by c₀.
fn concentration(spacing: f64, ratio: u32) -> f64 {
    let radius = 0.01;
    let half = 0.5 * spacing;
    let overrides = [
        format!("body.spacing={spacing}"),
        format!("material.horizon_ratio={ratio}"),
        format!("sets.top.layer.cells={ratio}"),
        format!("sets.bottom.layer.cells={ratio}"),
        "output.fields=never".to_owned(),
        "output.picture=[]".to_owned(),
    ];
    let overrides: Vec<&str> = overrides.iter().map(String::as_str).collect();
    let (mut run, _) = example("statics/hole.toml", &overrides);
    run.run(|_| Control::Continue).unwrap();
    let (cloud, n) = (run.system().cloud(), run.system().points());
    let from = radius + 2.0 * f64::from(ratio) * spacing;
    let samples: Vec<(f64, f64)> = (0..n)
        .filter(|&i| (cloud.axis(1)[i] - half).abs() < 0.1 * half)
        .filter(|&i| (from..radius + 0.025).contains(&cloud.axis(0)[i]))
        .map(|i| (radius / cloud.axis(0)[i], run.state().u[n + i] / half))
        .collect();
    let fitted = even_polynomial(&samples);
    fitted.iter().sum::<f64>() / fitted[0]
}

#[test]
fn the_fit_recovers_even_polynomials() {
    let samples: Vec<(f64, f64)> = (1..9)
        .map(|k| 0.1 * f64::from(k))
        .map(|r| (r, 1.0 + 0.5 * r * r - 2.0 * r.powi(4)))
        .collect();
    let found = even_polynomial(&samples);
    for (found, given) in found.iter().zip([1.0, 0.5, -2.0]) {
        assert!((found - given).abs() < 1e-9, "{found} {given}");
    }
}

/// Takes minutes, as above.
#[test]
#[ignore = "minutes"]
fn the_stress_concentration_converges_to_three() {
    let table = [
        (2e-3, 3),
        (1e-3, 3),
        (0.5e-3, 3),
        (1e-3, 4),
        (0.5e-3, 4),
        (1e-3, 6),
    ];
    let found = table.map(|(spacing, ratio)| {
        let found = concentration(spacing, ratio);
        let horizon = 1e3 * spacing * f64::from(ratio);
        println!("m = {ratio}, horizon {horizon} mm: {found:.3}");
        found
    });
    // Howland's solution for a plate ten times as wide as its hole.
    let exact = 3.03;
    assert!((found[2] / exact - 1.0).abs() < 0.05, "{found:?}");
    // Converged in m at a horizon of 6 mm; linear in the horizon as it tends to zero.
    assert!((found[5] / found[0] - 1.0).abs() < 0.02, "{found:?}");
    for [coarse, fine] in [[found[1], found[2]], [found[3], found[4]]] {
        let limit = 2.0 * fine - coarse;
        assert!((limit / exact - 1.0).abs() < 0.03, "{limit} of {found:?}");
    }
}
