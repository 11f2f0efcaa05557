//! Cost of products, estimated from sizes alone.
//!
//! Nothing is timed at run time: the route determines the round-off, and equal runs must give equal results. The
//! constants were measured on one core of an AMD EPYC (AVX-512, 1 MiB L2 per core, 32 MiB L3) with
//! `cargo bench --bench linear` in `benches/criterion`; only their ratios matter, and these vary little between
//! machines.

/// Measured time of a real transform forward and backward with a product in between, ns per point, for lengths 2^6,
/// 2^7, … 2^22. The steps occur where the arrays exceed the L2 (2^17) and the L3 cache (2^20).
const TRANSFORM: [f64; 17] = [
    2.5, 2.0, 2.0, 2.6, 2.8, 2.9, 3.1, 3.6, 3.8, 4.3, 4.8, 5.1, 7.5, 8.7, 9.8, 12.0, 12.0,
];
const SHORTEST: u32 = 6;

/// Measured time of a banded product: ns per point, and ns per point and pair of coefficients.
const BANDED_POINT: f64 = 0.7;
const BANDED_PAIR: f64 = 0.12;
/// Factor for pairs of different coefficients, which cost one more multiplication.
const UNSYMMETRIC: f64 = 1.25;

/// Measured time of loading and storing a point around the transforms, ns.
const TRANSFORM_POINT: f64 = 0.9;

/// Route by which a line product is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Route {
    /// Sum over the coefficients.
    Banded,
    /// Transforms of overlapping pieces of the line.
    OverlapSave,
    /// One transform of the whole line.
    OneTransform,
}

/// Division of a line into pieces: transforms of `length` points that give `outputs` results each, the first of
/// them at index `lead` of the piece.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pieces {
    pub length: usize,
    pub lead: usize,
    pub outputs: usize,
}

/// Cost of a transform forward and backward, ns per point.
pub(super) fn transform_cost(length: usize) -> f64 {
    let place = (length.max(1) as f64).log2() - f64::from(SHORTEST);
    let place = place.clamp(0.0, (TRANSFORM.len() - 1) as f64);
    let k = (place as usize).min(TRANSFORM.len() - 2);
    let between = TRANSFORM[k] + (place - k as f64) * (TRANSFORM[k + 1] - TRANSFORM[k]);
    // Mixed radices measured at 3072 … 15360: up to 1.3 times the neighbouring powers of two.
    between * if length.is_power_of_two() { 1.0 } else { 1.2 }
}

/// Cost of a banded product of a line, ns.
pub(super) fn banded_cost(nodes: usize, reach: usize, symmetric: bool) -> f64 {
    let pair = BANDED_PAIR * if symmetric { 1.0 } else { UNSYMMETRIC };
    nodes as f64 * (BANDED_POINT + pair * reach as f64)
}

/// Cost of a product of a line by pieces, ns.
pub(super) fn pieces_cost(nodes: usize, pieces: Pieces) -> f64 {
    let count = nodes.div_ceil(pieces.outputs) as f64;
    count * pieces.length as f64 * transform_cost(pieces.length) + TRANSFORM_POINT * nodes as f64
}

/// Cheapest pieces for overlap-save.
pub(super) fn overlap_save(nodes: usize, reach: usize) -> Pieces {
    let candidate = |k: u32| {
        let length = 1usize << k;
        Pieces {
            length,
            lead: reach,
            outputs: length - 2 * reach,
        }
    };
    let first = (2 * reach + 1).next_power_of_two().ilog2().max(SHORTEST);
    let mut best = candidate(first);
    for k in first + 1..first + 8 {
        // Beyond one piece for the whole line, longer pieces only cost more.
        if best.outputs >= nodes {
            break;
        }
        let next = candidate(k);
        if pieces_cost(nodes, next) < pieces_cost(nodes, best) {
            best = next;
        }
    }
    best
}

/// One piece for the whole line.
pub(super) fn one_transform(nodes: usize, reach: usize, periodic: bool) -> Pieces {
    let (length, lead) = if !periodic {
        (smooth_length(nodes + reach), 0)
    } else if smooth_length(nodes) == nodes {
        (nodes, 0)
    } else {
        (smooth_length(nodes + 2 * reach), reach)
    };
    Pieces {
        length,
        lead,
        outputs: nodes,
    }
}

/// Returns the smallest even number not below `least` (1 stays 1) without prime factors above 5, for which
/// transforms are fast.
pub(crate) fn smooth_length(least: usize) -> usize {
    if least <= 1 {
        return 1;
    }
    let mut best = least.next_power_of_two();
    let mut fives = 1;
    while fives < best {
        let mut threes = fives;
        while threes < best {
            let twos = least.div_ceil(threes).next_power_of_two().max(2);
            best = best.min(threes * twos);
            threes *= 3;
        }
        fives *= 5;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_lengths_are_minimal() {
        for least in 2..2000 {
            let smooth = |mut n: usize| {
                for p in [2, 3, 5] {
                    while n.is_multiple_of(p) {
                        n /= p;
                    }
                }
                n == 1
            };
            let naive = (least..).find(|&n| n % 2 == 0 && smooth(n)).unwrap();
            assert_eq!(smooth_length(least), naive, "{least}");
        }
        assert_eq!((smooth_length(0), smooth_length(1)), (1, 1));
    }

    #[test]
    fn route_crossover_is_at_the_measured_reach() {
        let nodes = 1_000_000;
        let fastest = |reach| {
            let banded = banded_cost(nodes, reach, true);
            let pieces = pieces_cost(nodes, overlap_save(nodes, reach));
            let one = pieces_cost(nodes, one_transform(nodes, reach, false));
            assert!(pieces < one);
            banded < pieces
        };
        assert!(fastest(15) && !fastest(50));
        // A full matrix: one transform.
        let one = pieces_cost(2000, one_transform(2000, 1999, false));
        assert!(one < pieces_cost(2000, overlap_save(2000, 1999)));
        assert!(one < banded_cost(2000, 1999, true));
    }
}
