//! Two materials: reflection and transmission of a pulse at the interface of a steel and an aluminium bar.

use std::error::Error;
use std::sync::Arc;

use pericles::prelude::*;

/// Young's modulus (Pa) and density (kg/m³) of steel.
const STEEL: (f64, f64) = (210e9, 7850.0);
/// Young's modulus (Pa) and density (kg/m³) of aluminium.
const ALUMINIUM: (f64, f64) = (70e9, 2700.0);

fn main() -> Result<(), Box<dyn Error>> {
    let spacing = 0.5e-3;
    let material =
        |(young, density)| BondMaterial::new(ElasticModulus::Young(young), density, 3.0 * spacing);
    // An `Arc` shares the points between the body and this program.
    let bar = Arc::new(Grid::bar(1.0, spacing, 1e-4).points()?);
    let right = bar.select(&Region::Box {
        min: [0.5, f64::NEG_INFINITY, f64::NEG_INFINITY],
        max: [f64::INFINITY; 3],
    });
    let system = Body::new(bar.clone(), material(STEEL))
        .material(right, material(ALUMINIUM))
        .build()?;

    // A pulse of velocity v(x) that travels to the right has the strain −v/c. Integration gives the displacement.
    let speed = |(young, density): (f64, f64)| (young / density).sqrt();
    let c = speed(STEEL);
    let width = 0.02;
    let velocity = |x: f64| (-((x - 0.3) / width).powi(2)).exp();
    let mut u0 = vec![0.0; bar.len()];
    for i in (0..bar.len() - 1).rev() {
        let between = 0.5 * (bar.axis(0)[i] + bar.axis(0)[i + 1]);
        u0[i] = u0[i + 1] + spacing * velocity(between) / c;
    }
    let mut start = State::of(&system);
    start.u.copy_from_slice(&u0);
    for (v, x) in start.v.iter_mut().zip(bar.axis(0)) {
        *v = velocity(*x);
    }
    // 0.2 m to the interface and 0.15 m back.
    let mut run = Simulation::builder(system)
        .state(start)?
        .end(0.35 / c)
        .build()?;
    run.run_to_end()?;

    // The velocity of largest magnitude on either side of the interface.
    let largest = |left: bool| {
        let pairs = bar.axis(0).iter().zip(&run.state().v);
        let side = pairs.filter(|(x, _)| (**x < 0.45) == left);
        side.map(|(_, v)| *v).fold(
            0.0,
            |most: f64, v| if v.abs() > most.abs() { v } else { most },
        )
    };
    let (reflected, transmitted) = (largest(true), largest(false));
    // With the impedances Z = ρ c the reflection coefficient of the velocity is (Z₁ − Z₂)/(Z₁ + Z₂), the transmission
    // coefficient 2 Z₁/(Z₁ + Z₂).
    let [z1, z2] = [STEEL, ALUMINIUM].map(|material| material.1 * speed(material));
    let (r, t) = ((z1 - z2) / (z1 + z2), 2.0 * z1 / (z1 + z2));
    println!("reflected:   {reflected:.4} (continuum: {r:.4})");
    println!("transmitted: {transmitted:.4} (continuum: {t:.4})");
    if (reflected - r).abs() > 0.02 || (transmitted - t).abs() > 0.02 {
        return Err("the reflected or transmitted pulse is wrong".into());
    }
    Ok(())
}
