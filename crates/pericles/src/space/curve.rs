//! Ordering of points along a Hilbert curve, so that neighbours in space are close in memory.

use super::Point;

/// Bits per axis of the curve: three times 20 bits fit into a key.
const BITS: u32 = 20;

/// Returns the numbers of points in the order of a Hilbert curve through their bounding cube. Cost O(n log n).
pub fn hilbert_order(points: &[Point]) -> Vec<u32> {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for point in points {
        for c in 0..3 {
            low[c] = low[c].min(point[c]);
            high[c] = high[c].max(point[c]);
        }
    }
    let side = (0..3)
        .map(|c| high[c] - low[c])
        .fold(f64::MIN_POSITIVE, f64::max);
    let steps = f64::from(1u32 << BITS);
    let mut order: Vec<(u64, u32)> = points
        .iter()
        .enumerate()
        .map(|(number, x)| {
            let cell = std::array::from_fn(|c| {
                (((x[c] - low[c]) / side * steps) as u32).min((1 << BITS) - 1)
            });
            (hilbert(cell), number as u32)
        })
        .collect();
    order.sort_unstable();
    order.into_iter().map(|(_, number)| number).collect()
}

/// Index of a cell along the Hilbert curve (Skilling, AIP Conf. Proc. 707, 381, 2004).
fn hilbert(cell: [u32; 3]) -> u64 {
    let mut x = cell;
    let mut bit = 1 << (BITS - 1);
    while bit > 1 {
        let below = bit - 1;
        for c in 0..3 {
            if x[c] & bit != 0 {
                x[0] ^= below;
            } else {
                let swapped = (x[0] ^ x[c]) & below;
                x[0] ^= swapped;
                x[c] ^= swapped;
            }
        }
        bit >>= 1;
    }
    for c in 1..3 {
        x[c] ^= x[c - 1];
    }
    let mut gray = 0;
    let mut bit = 1 << (BITS - 1);
    while bit > 1 {
        if x[2] & bit != 0 {
            gray ^= bit - 1;
        }
        bit >>= 1;
    }
    let mut key = 0u64;
    for bit in (0..BITS).rev() {
        for c in x {
            key = key << 1 | u64::from((c ^ gray) >> bit & 1);
        }
    }
    key
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn consecutive_cells_of_the_curve_are_neighbours() {
        // The cells of the lowest 8 × 8 × 8 corner are the first 512 of the curve.
        let mut cells: Vec<(u64, [u32; 3])> = (0..512u32)
            .map(|k| [k % 8, k / 8 % 8, k / 64])
            .map(|cell| (hilbert(cell), cell))
            .collect();
        cells.sort_unstable();
        assert_eq!(cells[511].0, 511);
        for pair in cells.windows(2) {
            let apart: u32 = (0..3).map(|c| pair[0].1[c].abs_diff(pair[1].1[c])).sum();
            assert_eq!(apart, 1, "{pair:?}");
        }
    }
}
