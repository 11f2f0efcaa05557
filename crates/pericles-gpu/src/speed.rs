//! Speed of a device.

use std::time::Instant;

use pericles::material::{BondMaterial, ElasticModulus};
use pericles::space::Grid;
use pericles::time::State;
use pericles::{Body, PericlesError};

use crate::verlet::Gpu;

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

/// Measures the steps of a block: the shortest of several batches after a first one.
pub(crate) fn measured(gpu: &Gpu, edge: usize) -> Result<Speed, PericlesError> {
    let (spacing, batches) = (1e-3, 3);
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
    let steps = (200_000_000 / bonds.max(1)).clamp(2, 50);
    let mut device = gpu.device(&system, dt, steps as usize)?;
    let mut best = f64::INFINITY;
    for batch in 0..=batches {
        let start = Instant::now();
        device.advance(&mut system, &mut state, dt, steps)?;
        if batch > 0 {
            best = best.min(start.elapsed().as_secs_f64());
        }
    }
    Ok(Speed {
        points: system.points(),
        bonds,
        steps,
        step: best / steps as f64,
    })
}
