//! Dynamic fracture: an edge crack in a glass plate under tension, and its speed compared with the Rayleigh speed.

use std::error::Error;

use pericles::prelude::*;
use pericles::units::{count, quantity};

/// Young's modulus, Pa.
const YOUNG: f64 = 72e9;
/// Mass density, kg/m³.
const DENSITY: f64 = 2440.0;
/// Fracture energy, J/m².
const ENERGY: f64 = 135.0;

fn main() -> Result<(), Box<dyn Error>> {
    let spacing = 0.5e-3;
    let plate = Grid::plate([0.06, 0.03], spacing, 1e-3).points()?;
    let glass = BondMaterial::new(ElasticModulus::Young(YOUNG), DENSITY, 3.0 * spacing)
        .with_fracture_energy(ENERGY);

    // Regions select sets of points: here the layers of cells at the top and bottom, which carry the traction.
    let layer = |face: &str| Ok::<_, PericlesError>(plate.select(&Region::layer(face, spacing)?));
    let traction = |face: &str, size: f64| {
        let area = 0.06 * 1e-3;
        Load::traction(
            &plate,
            layer(face)?,
            [0.0, size, 0.0],
            area,
            TimeFunction::Constant,
        )
    };
    let loads = [traction("+y", 24e6)?, traction("-y", -24e6)?];

    // The pre-crack from the left edge to x = 15 mm. The tracker finds the damage that grows from it.
    let crack = Crack::Segment {
        from: [0.0, 0.015],
        to: [0.015, 0.015],
    };
    let tracked = TrackedCrack {
        crack: crack.clone(),
        points: plate.select(&Region::Box {
            min: [0.0, 0.015 - spacing, 0.0],
            max: [0.015, 0.015 + spacing, 0.0],
        }),
    };
    let tracker = CrackTracker::new(&plate, vec![tracked], 0.35)?;

    let [up, down] = loads;
    let system = Body::new(plate, glass)
        .stress_state(StressState::PlaneStress)
        .crack(crack)
        .load(up)
        .load(down)
        .build()?;
    let mut run = Simulation::builder(system).end(16e-6).build()?;

    // The closure is called after every step; it reads the state and returns whether to continue.
    let mut path: Vec<(f64, f64)> = Vec::new();
    run.run(|now| {
        if now.state().step.is_multiple_of(10) {
            let snapshot = now.snapshot();
            let tips = tracker.tips(now.system().cloud(), snapshot.field(Field::Damage));
            if let Some(tip) = tips[0] {
                path.push((now.state().t, tip.advance));
            }
        }
        Control::Continue
    })?;

    // The mean speed after the crack has grown by 5 mm.
    let running: Vec<_> = path.iter().filter(|(_, advance)| *advance > 5e-3).collect();
    let (Some((t0, a0)), Some((t1, a1))) = (running.first(), running.last()) else {
        return Err("the crack has grown by less than 5 mm".into());
    };
    let speed = (a1 - a0) / (t1 - t0);
    // Viktorov's approximation of the Rayleigh speed; bond-based plane stress has Poisson's ratio 1/3.
    let ratio = 1.0 / 3.0;
    let shear = (YOUNG / (2.0 * (1.0 + ratio) * DENSITY)).sqrt();
    let rayleigh = shear * (0.862 + 1.14 * ratio) / (1.0 + ratio);
    println!(
        "crack speed: {speed:.0} m/s = {:.2} times the Rayleigh speed",
        speed / rayleigh
    );

    let energies = run.snapshot().energies();
    println!(
        "{} bonds broke and dissipated {}; error of the energy balance: {:+.1e} of it",
        count(run.system().operator().broken_bonds()),
        quantity(energies.dissipated, "J"),
        energies.balance() / energies.dissipated
    );

    // The Rayleigh speed is the upper limit for a crack in tension.
    if !(0.2..1.0).contains(&(speed / rayleigh)) {
        return Err("the crack speed is outside the physical range".into());
    }
    Ok(())
}
