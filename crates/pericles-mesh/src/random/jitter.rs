//! Lattices with randomly displaced nodes.

use rayon::prelude::*;

use super::Inside;
use super::hash::uniform;
use crate::fill::{FillError, Lattice};

/// Number of times that a displacement out of the body is halved before the node stays in place.
const HALVINGS: i32 = 4;

/// Returns the positions of lattice nodes, each displaced along the first `dimension` axes by at most
/// `amplitude` spacings, uniformly at random. A displacement out of the body is halved until the position is
/// inside, or omitted. Each point keeps the volume of its cell.
///
/// # Errors
/// Returns an error for an amplitude outside 0 ≤ amplitude < ½: with more, points of neighbouring cells could
/// coincide.
pub fn jittered(
    lattice: &Lattice,
    nodes: &[[usize; 3]],
    dimension: usize,
    amplitude: f64,
    seed: u64,
    inside: &Inside<'_>,
) -> Result<Vec<[f64; 3]>, FillError> {
    if !(0.0..0.5).contains(&amplitude) {
        return Err(FillError::Amplitude { value: amplitude });
    }
    let [nx, ny, _] = lattice.counts;
    let displaced = |&node: &[usize; 3]| {
        let number = ((node[2] * ny + node[1]) * nx + node[0]) as u64;
        let at = lattice.position(node);
        let offset: [f64; 3] = std::array::from_fn(|c| match c < dimension {
            true => {
                (2.0 * uniform(seed, number, 0, c as u64) - 1.0) * amplitude * lattice.spacing[c]
            }
            false => 0.0,
        });
        let tries = (0..HALVINGS).map(|halvings| {
            let factor = 0.5f64.powi(halvings);
            std::array::from_fn(|c| at[c] + factor * offset[c])
        });
        tries.into_iter().find(|&x| inside(x)).unwrap_or(at)
    };
    Ok(nodes.par_iter().map(displaced).collect())
}
