//! An order of vertices in which neighbours on the surface are near in memory.

use super::Surface;

/// Steps along each axis of the curve: three times 20 bits fit into a key.
const BITS: u32 = 20;

impl Surface {
    /// The same surface with its vertices in the order of a Hilbert curve through its bounding cube, and its triangles in the order of their lowest
    /// corner.
    ///
    /// [`Surface::user_number`] still gives the number under which a vertex was given. Cost O(V log V).
    pub fn renumbered(&self) -> Self {
        let [low, high] = self.bounds();
        let side = (0..3)
            .map(|c| high[c] - low[c])
            .fold(f64::MIN_POSITIVE, f64::max);
        let steps = f64::from(1u32 << BITS);
        let mut order: Vec<(u64, u32)> = self
            .positions
            .iter()
            .enumerate()
            .map(|(vertex, x)| {
                let cell = std::array::from_fn(|c| {
                    (((x[c] - low[c]) / side * steps) as u32).min((1 << BITS) - 1)
                });
                (hilbert(cell), vertex as u32)
            })
            .collect();
        order.sort_unstable();
        let mut new_number = vec![0u32; self.len()];
        for (new, &(_, old)) in order.iter().enumerate() {
            new_number[old as usize] = new as u32;
        }
        let take = |old: u32| old as usize;
        let mut triangles: Vec<[u32; 3]> = self
            .triangles
            .iter()
            .map(|corners| {
                let mut corners = corners.map(|vertex| new_number[vertex as usize]);
                let lowest = (0..3).min_by_key(|&k| corners[k]).unwrap_or(0);
                corners.rotate_left(lowest);
                corners
            })
            .collect();
        triangles.sort_unstable();
        Self {
            positions: order
                .iter()
                .map(|&(_, old)| self.positions[take(old)])
                .collect(),
            triangles,
            user_numbers: order
                .iter()
                .map(|&(_, old)| self.user_numbers[take(old)])
                .collect(),
        }
    }
}

/// The place of a cell along the Hilbert curve (Skilling, AIP Conf. Proc. 707, 381, 2004).
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
    use std::collections::BTreeSet;

    #[test]
    fn the_curve_goes_from_cell_to_neighbouring_cell() {
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

    #[test]
    fn renumbering_keeps_the_surface_and_shortens_its_edges() {
        let surface = Surface::torus(1.0, 0.4, 40, 30).unwrap();
        let renumbered = surface.renumbered();
        assert!((surface.volume() - renumbered.volume()).abs() < 1e-14);
        let numbers: BTreeSet<u32> = renumbered.user_numbers().iter().copied().collect();
        assert_eq!(numbers.len(), surface.len());
        for (vertex, x) in renumbered.positions().iter().enumerate() {
            assert_eq!(*x, surface.positions()[renumbered.user_number(vertex)]);
        }
        let given = |surface: &Surface| -> BTreeSet<[usize; 3]> {
            let corners = surface.triangles().iter();
            corners
                .map(|t| {
                    let mut t = t.map(|v| surface.user_number(v as usize));
                    t.sort_unstable();
                    t
                })
                .collect()
        };
        assert_eq!(given(&surface), given(&renumbered));
        let far = |surface: &Surface| {
            let edges = surface.edges();
            edges.iter().map(|[a, b]| (b - a) as usize).sum::<usize>() / edges.len()
        };
        assert!(
            2 * far(&renumbered) < 3 * far(&surface),
            "{} {}",
            far(&renumbered),
            far(&surface)
        );
    }
}
