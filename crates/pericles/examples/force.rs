//! A custom force in addition to the bonds: contact with a rigid wall. A bar hits the wall and rebounds.

use std::error::Error;

use pericles::prelude::*;

/// A wall with penalty contact: a point at a depth d > 0 behind it has the force density k d and the energy
/// density ½ k d².
struct Wall {
    /// Coordinate of the wall, m.
    place: f64,
    /// Reference positions of the points, m.
    positions: Vec<f64>,
    /// Volumes of the points, m³.
    volumes: Vec<f64>,
    /// Contact stiffness k, N/m⁴.
    stiffness: f64,
}

impl Wall {
    fn depth(&self, u: &[f64], i: usize) -> f64 {
        (self.place - self.positions[i] - u[i]).max(0.0)
    }
}

impl Force for Wall {
    fn points(&self) -> usize {
        self.positions.len()
    }

    fn dimension(&self) -> usize {
        1
    }

    fn add_force(&self, _t: f64, u: &[f64], on: PointSubset<'_>, out: &mut [f64]) {
        on.for_each(self.points(), |i| {
            out[i] += self.stiffness * self.depth(u, i)
        });
    }

    fn add_energy_density(&self, _t: f64, u: &[f64], out: &mut [f64]) {
        for (i, density) in out.iter_mut().enumerate() {
            *density += 0.5 * self.stiffness * self.depth(u, i).powi(2);
        }
    }

    fn energy(&self, t: f64, u: &[f64]) -> f64 {
        let mut density = vec![0.0; self.points()];
        self.add_energy_density(t, u, &mut density);
        density.iter().zip(&self.volumes).map(|(w, v)| w * v).sum()
    }

    /// The wall contributes ω² ≤ k/ρ to the highest frequency, from which the stable step follows.
    fn frequency_bound(&self, density: &dyn Fn(usize) -> f64) -> f64 {
        let square = |i: usize| self.stiffness / density(i);
        (0..self.points()).map(square).fold(0.0, f64::max).sqrt()
    }

    fn tangent_into(&self, _t: f64, u: &[f64], direction: &[f64], out: &mut [f64]) {
        for i in 0..self.points() {
            let touches = self.depth(u, i) > 0.0;
            out[i] = if touches {
                -self.stiffness * direction[i]
            } else {
                0.0
            };
        }
    }
}

// All fields are constant, so that checkpoints contain nothing of the wall.
saved! {
    impl Checkpointed for Wall {
        place, positions, volumes, stiffness: fixed,
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    const SPEED: f64 = 5.0;
    let (young, density, length, spacing) = (210e9, 7850.0, 0.1, 1e-3);
    let bar = Grid::bar(length, spacing, 1e-4).points()?;
    // The wall is at the first point.
    let place = 0.5 * spacing;
    let wall = Wall {
        place,
        positions: bar.axis(0).to_vec(),
        volumes: bar.volumes().to_vec(),
        stiffness: 0.1 * young / (spacing * spacing),
    };
    let steel = BondMaterial::new(ElasticModulus::Young(young), density, 3.0 * spacing);
    let system = Body::new(bar, steel).force(Box::new(wall)).build()?;
    let mass: f64 = system.masses().iter().sum();

    // A compression wave travels to the free end and back, so that the bar touches the wall for the time 2 L/c.
    let transit = length / (young / density).sqrt();
    // A fifth of the stable step resolves the start of the contact.
    let mut run = Simulation::builder(system)
        .velocity(|_| [-SPEED, 0.0, 0.0])
        .safety(0.2)
        .end(4.0 * transit)
        .build()?;
    let mut contact: f64 = 0.0;
    run.run(|now| {
        let (points, u) = (now.system().cloud(), &now.state().u);
        if points.axis(0)[0] + u[0] < place {
            contact = now.state().t;
        }
        Control::Continue
    })?;

    let rebound = run.system().momentum(&run.state().v)[0] / mass;
    println!("impact speed: {SPEED} m/s; rebound speed: {rebound:.3} m/s");
    println!(
        "contact ends after {:.2} L/c; continuum: 2 L/c",
        contact / transit
    );
    let energies = run.snapshot().energies();
    let error = energies.balance() / energies.initial;
    println!("error of the energy balance: {error:+.1e} of the initial energy");
    // The rebound is slower than the impact by the energy that remains in vibrations of the bar.
    if !(0.9 * SPEED..=SPEED).contains(&rebound) || error.abs() > 1e-3 {
        return Err("the rebound of the elastic bar is wrong".into());
    }
    Ok(())
}
