//! Speed of a device.

use std::time::Instant;

use pericles::material::{BondMaterial, ElasticModulus};
use pericles::space::Grid;
use pericles::time::{State, VelocityVerlet};
use pericles::{Body, PericlesError};

use crate::verlet::Gpu;

/// Largest number of steps of a batch.
const LONGEST: u64 = 100;
/// Time of a batch, s.
const TIME: f64 = 0.1;
/// Number of batches, of which the shortest counts.
const BATCHES: usize = 3;

/// Measured speed of a device.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Speed {
    /// Points of the body.
    pub points: usize,
    /// Directed bonds of the body.
    pub bonds: u64,
    /// Steps of a batch.
    pub steps: u64,
    /// Shortest time of a step, s.
    pub step: f64,
}

impl Speed {
    /// Returns the directed bonds per second.
    pub fn bonds_per_second(&self) -> f64 {
        self.bonds as f64 / self.step
    }
}

impl Gpu {
    /// Measures steps of a block of steel with bond-stretch bonds, a horizon of three spacings and `edge`³ points: the shortest of
    /// several batches after a first one.
    ///
    /// # Errors
    /// The driver fails, or the block does not fit.
    pub fn speed(&self, edge: usize) -> Result<Speed, PericlesError> {
        let spacing = 1e-3;
        let size = edge as f64 * spacing;
        let block = Grid::block([size; 3], spacing).points()?;
        let steel = BondMaterial::new(ElasticModulus::Young(210e9), 7850.0, 3.015 * spacing);
        let mut system = Body::new(block, steel).build()?;
        let bound = system.operator().frequency_bound(&|_| 7850.0);
        let dt = 0.5 / bound;
        let mut state = State::of(&system);
        for (k, v) in state.v.iter_mut().enumerate() {
            *v = f64::from((k % 7) as u8) - 3.0;
        }
        state.start(&mut system);
        let bonds = system.operator().directed_bonds();
        let mut device = self.device(&system, &VelocityVerlet, (dt, LONGEST as usize))?;
        let mut batch = |steps: u64| {
            let start = Instant::now();
            device.advance(&mut system, &mut state, dt, steps)?;
            Ok::<f64, PericlesError>(start.elapsed().as_secs_f64() / steps as f64)
        };
        // The first batch uploads the body.
        batch(1)?;
        let steps = ((TIME / batch(2)?) as u64).clamp(2, LONGEST);
        let mut best = f64::INFINITY;
        for _ in 0..BATCHES {
            best = best.min(batch(steps)?);
        }
        Ok(Speed {
            points: system.points(),
            bonds,
            steps,
            step: best,
        })
    }
}
