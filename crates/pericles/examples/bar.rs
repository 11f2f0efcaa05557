//! A wave travels along a steel bar. How fast, and how well is its energy kept?
//!
//! The steps of every program with Pericles: points, a material, a body, a simulation, a look at the result.

use std::error::Error;

use pericles::prelude::*;

const LENGTH: f64 = 1.0;
const YOUNG: f64 = 210e9;
const DENSITY: f64 = 7850.0;

/// A bump of width 4 cm about `middle`, and its slope.
fn bump(x: f64, middle: f64) -> (f64, f64) {
    let z = (x - middle) / 0.04;
    let height = 1e-6 * (-z * z).exp();
    (height, -2.0 * z / 0.04 * height)
}

fn main() -> Result<(), Box<dyn Error>> {
    // 1. Points: cell centres of a bar of 1 m with a section of 1 cm².
    let spacing = 1e-3;
    let bar = Grid::bar(LENGTH, spacing, 1e-4).points()?;

    // 2. A material: modulus, density, and a horizon of three spacings.
    let steel = BondMaterial::new(ElasticModulus::Young(YOUNG), DENSITY, 3.0 * spacing);

    // 3. The body: its equation of motion. No loads, no supports, no cracks.
    let system = Body::new(bar, steel).build()?;

    // 4. The run: a wave that travels to the right has the velocity −c u'. Scheme (velocity Verlet) and time step are left to the library.
    let exact = (YOUNG / DENSITY).sqrt();
    let end = 0.5 / exact;
    let mut run = Simulation::builder(system)
        .displacement(|[x, ..]| [bump(x, 0.25).0, 0.0, 0.0])
        .velocity(|[x, ..]| [-exact * bump(x, 0.25).1, 0.0, 0.0])
        .end(end)
        .build()?;
    println!("{} steps of {:.3e} s", run.steps(), run.dt());
    run.run_to_end()?;

    // 5. The result: the place of the crest, between points by a parabola. In one dimension component 0 of the displacement is all there is.
    let (u, points) = (&run.state().u, run.system().cloud());
    let top = (1..u.len() - 1).fold(1, |top, i| if u[i] > u[top] { i } else { top });
    let (left, right) = (u[top - 1] - u[top], u[top + 1] - u[top]);
    let crest = points.axis(0)[top] + 0.5 * spacing * (left - right) / (left + right);
    let speed = (crest - 0.25) / end;
    println!(
        "wave speed: {speed:.1} m/s; continuum: {exact:.1} m/s ({:+.3} %)",
        100.0 * (speed / exact - 1.0)
    );
    let energies = run.snapshot().energies();
    let error = energies.balance() / energies.initial;
    println!("energy balance: {:.1e} of the initial energy", error.abs());

    // Long waves travel at the speed of the continuum, less the dispersion of the horizon.
    if (speed / exact - 1.0).abs() > 0.01 || error.abs() > 1e-6 {
        return Err("the wave is too slow, too fast, or loses energy".into());
    }
    Ok(())
}
