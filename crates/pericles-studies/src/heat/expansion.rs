//! Thermal expansion: free bodies without stress, and a bar between fixed ends.

use pericles::observe::Field;
use pericles_run::RunError;

use super::{ran, read, simulation};
use crate::data::{Case, Found};

const YOUNG: f64 = 210e9;
const EXPANSION: f64 = 12e-6;
/// Temperature change, K.
const HEATING: f64 = 100.0;

/// Largest force density of a free body of the given material model that is heated uniformly, at the displacement
/// u = α ΔT x, times the spacing and over E α ΔT.
pub(super) fn free(case: &Case<'_>) -> Result<Found, RunError> {
    let model = case.text("model")?;
    let (body, spacing) = match case.count("dimension")? {
        2 => (
            r#"shape = "plate", size = [0.02, 0.014], spacing = 0.001, plane = "stress""#,
            1e-3,
        ),
        _ => (
            r#"shape = "block", size = [0.012, 0.009, 0.008], spacing = 0.001"#,
            1e-3,
        ),
    };
    let run = simulation(&read(&format!(
        r#"
body = {{ {body} }}
material = {{ density = 7850, youngs_modulus = {YOUNG:?}, horizon_ratio = 3, {model} }}
thermal = {{ expansion = {EXPANSION:?}, temperature = {:?}, reference = 293 }}
time = {{ end = 1e-9, dt = 1e-9 }}
"#,
        293.0 + HEATING,
    ))?)?;
    let system = run.system();
    let strain = EXPANSION * HEATING;
    let u: Vec<f64> = system
        .cloud()
        .positions()
        .iter()
        .map(|x| strain * x)
        .collect();
    let mut force = vec![0.0; u.len()];
    system.force_density_into(0.0, &u, &mut force);
    let most = crate::common::largest(&force);
    Ok(Found::default().value("stress", most * spacing / (YOUNG * strain)))
}

/// Stress in the middle of a bar between fixed ends, over −E α ΔT.
pub(super) fn constrained(case: &Case<'_>) -> Result<Found, RunError> {
    let m = case.count("m")?;
    let run = ran(&read(&format!(
        r#"
body = {{ shape = "bar", length = 1, spacing = 0.02, area = 1 }}
material = {{ model = "linear", modulus = "lattice", density = 1, youngs_modulus = {YOUNG:?}, horizon_ratio = {m}, volume_correction = "none" }}
sets = {{ left = {{ layer = {{ side = "-x", cells = {m} }} }}, right = {{ layer = {{ side = "+x", cells = {m} }} }} }}
constraint = [{{ set = "left", displacement = 0 }}, {{ set = "right", displacement = 0 }}]
thermal = {{ expansion = {EXPANSION:?}, temperature = 293, reference = 293, conductivity = 1, specific_heat = 1, scheme = "steady", condition = [{{ set = "left", temperature = {:?} }}] }}
time = {{ scheme = "static", tolerance = 1e-10 }}
"#,
        293.0 + HEATING,
    ))?)?;
    let snapshot = run.snapshot();
    let stress = snapshot.field(Field::Stress);
    let middle = stress[stress.len() / 2];
    Ok(Found::default().value("ratio", middle / (-YOUNG * EXPANSION * HEATING)))
}
