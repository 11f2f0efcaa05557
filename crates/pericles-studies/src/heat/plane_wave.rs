//! Plane waves of temperature in periodic bodies: eigenvectors of the discrete operator.

use std::f64::consts::TAU;

use pericles::observe::Field;
use pericles_run::RunError;

use super::{ran, read};
use crate::data::{Case, Found};

/// Cells of 1 m along each axis.
const CELLS: [usize; 3] = [20, 16, 12];
/// Steps of the run, and the step in units of 1/λ.
const STEPS: i32 = 50;
const STEP: f64 = 0.02;

/// Decay rate of a plane wave exp(i q·x) in units of k/C: the sum of κ V (1 − cos q·ξ) over the lattice of the
/// undivided cells within the horizon, with κ ~ 1/|ξ| and ½ Σ κ ξ_x² V = 1.
fn rate(dimension: usize, m: i32, q: [f64; 3]) -> f64 {
    let span = |c: usize| if c < dimension { -m..=m } else { 0..=0 };
    let (mut moment, mut sum) = (0.0, 0.0);
    for x in span(0) {
        for y in span(1) {
            for z in span(2) {
                let square = x * x + y * y + z * z;
                if square == 0 || square > m * m {
                    continue;
                }
                let r = f64::from(square).sqrt();
                let phase: f64 = [x, y, z]
                    .iter()
                    .zip(q)
                    .map(|(&x, q)| f64::from(x) * q)
                    .sum();
                moment += 0.5 * f64::from(x * x) / r;
                // 1 − cos without cancellation
                sum += 2.0 * (0.5 * phase).sin().powi(2) / r;
            }
        }
    }
    sum / moment
}

/// Largest difference between a decaying plane wave and its closed form, relative to the initial amplitude.
pub(super) fn decay(case: &Case<'_>) -> Result<Found, RunError> {
    let dimension = case.count("dimension")?;
    let m = case.count("m")?;
    let modes = [case.count("first")?, case.count("second")?, 1];
    let scheme = case.text("scheme")?;
    let mut q = [0.0; 3];
    for c in 0..dimension {
        q[c] = TAU * modes[c] as f64 / CELLS[c] as f64;
    }
    let rate = rate(dimension, m as i32, q);
    let dt = STEP / rate;
    let shape = ["bar", "plate", "block"][dimension - 1];
    let size = &CELLS[..dimension];
    let plane = match dimension {
        1 => "area = 1",
        2 => "plane = \"stress\"",
        _ => "",
    };
    let phase: Vec<String> = (0..dimension)
        .map(|c| format!("{:?}*{}", q[c], ["x", "y", "z"][c]))
        .collect();
    let comma = if plane.is_empty() { "" } else { ", " };
    let text = format!(
        r#"
body = {{ shape = "{shape}", size = {size:?}, spacing = 1, periodic = true{comma}{plane} }}
material = {{ density = 2, youngs_modulus = 1, horizon_ratio = {m}, volume_correction = "none" }}
time = {{ scheme = "thermal", end = {:?}, dt = {dt:?} }}
[thermal]
conductivity = 6
specific_heat = 3
temperature = {{ expression = "300 + 100*cos({})" }}
scheme = "{scheme}"
"#,
        f64::from(STEPS) * dt,
        phase.join(" + "),
    );
    let run = ran(&read(&text)?)?;
    let factor = match &scheme[..] {
        "explicit" => 1.0 - STEP,
        "backward-euler" => 1.0 / (1.0 + STEP),
        _ => (1.0 - 0.5 * STEP) / (1.0 + 0.5 * STEP),
    };
    let amplitude = factor.powi(STEPS);
    let found = run.snapshot().field(Field::Temperature).to_vec();
    let cloud = run.system().cloud();
    let exact = |i: usize| {
        let phase: f64 = (0..dimension).map(|c| q[c] * cloud.axis(c)[i]).sum();
        300.0 + 100.0 * amplitude * phase.cos()
    };
    let errors = (0..found.len()).map(|i| (found[i] - exact(i)).abs() / 100.0);
    Ok(Found::default().value("error", errors.fold(0.0, f64::max)))
}
