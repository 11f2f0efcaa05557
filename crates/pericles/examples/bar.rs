//! Wave propagation in a steel bar: wave speed and energy balance.
//!
//! The program shows the steps of every simulation: points, material, body, run, evaluation.

use std::error::Error;

use pericles::prelude::*;
use pericles::units::quantity;

/// Length of the bar, m.
const LENGTH: f64 = 1.0;
/// Young's modulus, Pa.
const YOUNG: f64 = 210e9;
/// Mass density, kg/m³.
const DENSITY: f64 = 7850.0;

/// Displacement and slope of a Gaussian pulse of width 4 cm at `middle`, with an amplitude of 1 µm.
fn bump(x: f64, middle: f64) -> (f64, f64) {
    let z = (x - middle) / 0.04;
    let height = 1e-6 * (-z * z).exp();
    (height, -2.0 * z / 0.04 * height)
}

fn main() -> Result<(), Box<dyn Error>> {
    // 1. Points: the cell centres of a bar with a cross-section of 1 cm².
    let spacing = 1e-3;
    let bar = Grid::bar(LENGTH, spacing, 1e-4).points()?;

    // 2. Material: Young's modulus, density, and a horizon of three spacings.
    let steel = BondMaterial::new(ElasticModulus::Young(YOUNG), DENSITY, 3.0 * spacing);

    // 3. Body: the equation of motion, here without loads, constraints or cracks.
    let system = Body::new(bar, steel).build()?;

    // 4. Run: a pulse that travels to the right has the velocity −c u'. The time integrator (velocity Verlet) and the
    // time step (0.95 of the stable step) are the defaults.
    let exact = (YOUNG / DENSITY).sqrt();
    let end = 0.5 / exact;
    let mut run = Simulation::builder(system)
        .displacement(|[x, ..]| [bump(x, 0.25).0, 0.0, 0.0])
        .velocity(|[x, ..]| [-exact * bump(x, 0.25).1, 0.0, 0.0])
        .end(end)
        .build()?;
    println!("{} steps of {}", run.steps(), quantity(run.dt(), "s"));
    run.run_to_end()?;

    // 5. Evaluation: the position of the maximum, interpolated by a parabola. In one dimension the displacement has
    // one component, so that `u[i]` is the displacement of point i.
    let (u, points) = (&run.state().u, run.system().cloud());
    let top = (1..u.len() - 1).fold(1, |top, i| if u[i] > u[top] { i } else { top });
    let (left, right) = (u[top - 1] - u[top], u[top + 1] - u[top]);
    let crest = points.axis(0)[top] + 0.5 * spacing * (left - right) / (left + right);
    let speed = (crest - 0.25) / end;
    println!(
        "wave speed: {speed:.1} m/s; continuum: {exact:.1} m/s (difference {:+.3} %)",
        100.0 * (speed / exact - 1.0)
    );
    let energies = run.snapshot().energies();
    let error = energies.balance() / energies.initial;
    println!(
        "error of the energy balance: {:.1e} of the initial energy",
        error.abs()
    );

    // Waves that are long compared with the horizon travel at the speed of the continuum; dispersion makes shorter
    // waves slower.
    if (speed / exact - 1.0).abs() > 0.01 || error.abs() > 1e-6 {
        return Err("the wave speed or the energy balance is wrong".into());
    }
    Ok(())
}
