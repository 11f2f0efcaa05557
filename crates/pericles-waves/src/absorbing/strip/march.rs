//! Kernels of the modes of a strip by time marching.

use rayon::prelude::*;

use super::lattice::{Matrix, StripLattice};
use crate::absorbing::GhostKernels;

/// Columns beyond the light cone, where fields have decayed below round-off.
const MARGIN: usize = 60;

impl StripLattice {
    /// Computes the kernels of each mode q = 0 … rows/2 for N steps of velocity Verlet: 2K × 2K, entry (2n + a,
    /// 2m + b) the component a of ghost −n after a unit displacement b of the body's outer column m + 1.
    ///
    /// Each input is marched through an exterior long enough that its far end has no influence, in increments d +=
    /// dt² A v, v += d: the form 2 v − v_before would lose digits.
    pub fn kernels(&self, dt: f64, steps: usize) -> Vec<GhostKernels> {
        let modes: Vec<usize> = (0..=self.rows() / 2).collect();
        let one = |&mode: &usize| self.kernels_of(mode, dt, steps);
        modes.par_iter().map(one).collect()
    }

    fn kernels_of(&self, mode: usize, dt: f64, steps: usize) -> GhostKernels {
        let reach = self.reach();
        let sites = (0.5 * self.fastest() * dt * steps as f64) as usize + MARGIN + 8 * reach;
        let chain = Chain::new(self, mode, sites, dt);
        let count = 2 * reach;
        let mut series = vec![vec![0.0; steps + 1]; count * count];
        for input in 0..count {
            let mut state = vec![[0.0; 2]; sites + 2 * reach];
            // Outer columns precede the exterior sites, the outermost one next to them.
            state[reach - 1 - input / 2][input % 2] = 1.0;
            let mut increment = chain.accelerated(&state);
            for (v, d) in state.iter_mut().zip(&increment) {
                *v = *d;
            }
            for j in 1..=steps {
                for ghost in 0..reach {
                    for a in 0..2 {
                        let output = 2 * ghost + a;
                        series[output * count + input][j] = state[reach + ghost][a];
                    }
                }
                for (d, more) in increment.iter_mut().zip(chain.accelerated(&state)) {
                    *d = [d[0] + more[0], d[1] + more[1]];
                }
                for (v, d) in state.iter_mut().zip(&increment) {
                    *v = [v[0] + d[0], v[1] + d[1]];
                }
            }
        }
        GhostKernels::full(count, series)
    }
}

/// Chain of a mode, between K columns of the body and K columns beyond its far end that stay at rest.
struct Chain {
    sites: usize,
    /// dt² C_d.
    couplings: Vec<Matrix>,
    /// dt² times the diagonal stiffness of a point.
    own: [f64; 2],
}

impl Chain {
    fn new(lattice: &StripLattice, mode: usize, sites: usize, dt: f64) -> Self {
        let square = dt * dt;
        let couplings = lattice.couplings(mode);
        let whole = lattice.stiffness_of_point();
        Self {
            sites,
            own: [0, 1].map(|a| square * (couplings[0][a][a] - whole[a])),
            couplings: couplings
                .iter()
                .map(|c| c.map(|row| row.map(|x| square * x)))
                .collect(),
        }
    }

    /// dt² v''; zero outside the chain.
    fn accelerated(&self, state: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let reach = self.couplings.len() - 1;
        let mut out = vec![[0.0; 2]; state.len()];
        for s in reach..reach + self.sites {
            let mut sum = [self.own[0] * state[s][0], self.own[1] * state[s][1]];
            for d in 1..=reach {
                let (c, outer, inner) = (&self.couplings[d], state[s + d], state[s - d]);
                // The matrix inwards is the transpose.
                sum[0] += c[0][0] * (outer[0] + inner[0]) + c[0][1] * outer[1] + c[1][0] * inner[1];
                sum[1] += c[1][1] * (outer[1] + inner[1]) + c[1][0] * outer[0] + c[0][1] * inner[0];
            }
            out[s] = sum;
        }
        out
    }
}
