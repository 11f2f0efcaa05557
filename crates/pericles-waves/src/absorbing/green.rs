//! Green function of the infinite lattice in continuous time.

use std::f64::consts::TAU;

use rayon::prelude::*;
use realfft::num_complex::Complex;

use super::LatticeStencil;
use crate::linear::LineTransform;

/// Nodes of the ring beyond the light cone; there the field has decayed below round-off.
const MARGIN: f64 = 400.0;
/// Number of times that share a ring.
const CHUNK: usize = 256;

/// Computes g_m(j dt) for m = 0 … sites − 1 and j = 0 … steps: the displacement u_m of the infinite lattice at rest
/// initially except for a unit velocity of site 0.
///
/// ```text
/// g_m(t) = (1/2π) ∫ cos(mθ) sin(ω(θ) t)/ω(θ) dθ
/// ```
///
/// The integral is evaluated by the trapezoidal rule with P points, which is the Green function of a ring of P
/// nodes: exact to round-off as long as no wave has travelled around the ring. One transform per time, in parallel.
pub fn green_functions(
    stencil: &LatticeStencil,
    dt: f64,
    steps: usize,
    sites: usize,
) -> Vec<Vec<f64>> {
    let fastest = stencil.fastest();
    let chunks: Vec<Vec<Vec<f64>>> = (0..=steps)
        .collect::<Vec<_>>()
        .par_chunks(CHUNK)
        .map(|chunk| {
            let last = chunk[chunk.len() - 1] as f64 * dt;
            let nodes = (2.0 * fastest * last + sites as f64 + MARGIN) as usize;
            let mut ring = Ring::new(stencil, nodes.next_power_of_two());
            let at = |&j: &usize| ring.at(j as f64 * dt, sites);
            chunk.iter().map(at).collect()
        })
        .collect();
    let of_site = |m: usize| chunks.iter().flatten().map(|g| g[m]).collect();
    (0..sites).map(of_site).collect()
}

/// Ring of lattice nodes.
struct Ring {
    frequencies: Vec<f64>,
    transform: LineTransform,
    spectrum: Vec<Complex<f64>>,
    line: Vec<f64>,
    scratch: Vec<Complex<f64>>,
}

impl Ring {
    fn new(stencil: &LatticeStencil, nodes: usize) -> Self {
        let transform = LineTransform::new(nodes);
        let frequency = |p: usize| {
            let theta = TAU * p as f64 / nodes as f64;
            stencil.square_frequency(theta).max(0.0).sqrt()
        };
        Self {
            frequencies: (0..transform.modes()).map(frequency).collect(),
            spectrum: vec![Complex::default(); transform.modes()],
            line: vec![0.0; nodes],
            scratch: transform.scratch(),
            transform,
        }
    }

    fn at(&mut self, t: f64, sites: usize) -> Vec<f64> {
        let norm = 1.0 / self.line.len() as f64;
        for (mode, omega) in self.spectrum.iter_mut().zip(&self.frequencies) {
            let swing = if *omega > 0.0 {
                (omega * t).sin() / omega
            } else {
                t
            };
            *mode = Complex::new(norm * swing, 0.0);
        }
        self.transform
            .inverse(&mut self.spectrum, &mut self.line, &mut self.scratch);
        self.line[..sites].to_vec()
    }
}
