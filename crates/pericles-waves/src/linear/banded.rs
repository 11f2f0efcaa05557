//! Banded product Σ_r t_r u_{i+r} with the results of 32 neighbouring points in registers.

use pericles::lanes::LANES;
use pericles::lanes::{F64x8, for_each_instruction_set};

/// Groups of eight outputs in registers: four AVX-512 or eight AVX2 registers, enough to hide the latency of an
/// addition.
const GROUPS: usize = 4;
/// Number of outputs computed in one pass over the coefficients.
pub(super) const TILE: usize = GROUPS * LANES;

#[inline(always)]
fn load(window: &[f64], at: usize) -> F64x8 {
    let eight = &window[at..at + LANES];
    let mut lanes = [0.0; LANES];
    lanes.copy_from_slice(eight);
    F64x8(lanes)
}

/// `SYMMETRIC`: `below` equals `above`, and a pair costs one multiplication.
#[inline(always)]
fn banded_tiles_body<const SYMMETRIC: bool>(
    below: &[f64],
    above: &[f64],
    window: &[f64],
    out: &mut [f64],
) {
    let reach = above.len();
    let below = &below[..reach];
    let mut first = 0;
    while first < out.len() {
        let mut sum = [F64x8([0.0; LANES]); GROUPS];
        let around = &window[first..first + TILE + 2 * reach];
        for r in 0..reach {
            let up = &around[reach + 1 + r..][..TILE];
            let down = &around[reach - 1 - r..][..TILE];
            let (high, low) = (F64x8([above[r]; LANES]), F64x8([below[r]; LANES]));
            for g in 0..GROUPS {
                let (up, down) = (load(up, g * LANES), load(down, g * LANES));
                sum[g] = sum[g]
                    + if SYMMETRIC {
                        high * (up + down)
                    } else {
                        high * up + low * down
                    };
            }
        }
        for g in 0..GROUPS {
            let from = first + g * LANES;
            // The last tile is truncated at the end of the outputs.
            let count = out.len().saturating_sub(from).min(LANES);
            if count == LANES {
                out[from..from + LANES].copy_from_slice(&sum[g].0);
            } else if count > 0 {
                out[from..from + count].copy_from_slice(&sum[g].0[..count]);
            }
        }
        first += TILE;
    }
}

for_each_instruction_set! {
    /// Computes `out[i]` = Σ_r (`above[r−1]` w_{R+i+r} + `below[r−1]` w_{R+i−r}), r = 1 … R. The window w extends R
    /// beyond the outputs on both sides, with their number rounded up to whole tiles of [`TILE`].
    pub(super) fn banded_tiles [const SYMMETRIC: bool] <SYMMETRIC> (
        below: &[f64],
        above: &[f64],
        window: &[f64],
        out: &mut [f64],
    ) = banded_tiles_body
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles::operator::InstructionSet;

    #[test]
    fn every_instruction_set_equals_the_plain_sum_bit_for_bit() {
        for (outputs, reach) in [(1usize, 3usize), (32, 1), (70, 40)] {
            let number = |k: usize| ((k * k) as f64 * 0.37).sin();
            let above: Vec<f64> = (0..reach).map(|r| number(r + 5)).collect();
            let below: Vec<f64> = (0..reach).map(|r| number(r + 50)).collect();
            let window: Vec<f64> = (0..outputs.next_multiple_of(TILE) + 2 * reach)
                .map(number)
                .collect();
            for set in InstructionSet::available() {
                let mut out = vec![f64::NAN; outputs];
                banded_tiles::<false>(set, &below, &above, &window, &mut out);
                let mut pairs = out.clone();
                banded_tiles::<true>(set, &above, &above, &window, &mut pairs);
                for i in 0..outputs {
                    let (mut sum, mut pair) = (0.0, 0.0);
                    for r in 1..=reach {
                        let (up, down) = (window[i + reach + r], window[i + reach - r]);
                        sum += above[r - 1] * up + below[r - 1] * down;
                        pair += above[r - 1] * (up + down);
                    }
                    assert_eq!((out[i], pairs[i]), (sum, pair), "{set:?} {i}");
                }
            }
        }
    }
}
