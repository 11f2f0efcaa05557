//! Renumbers vertices so that neighbours on the surface are close in memory.

use super::Surface;
use pericles::space::hilbert_order;

impl Surface {
    /// Returns the surface with its vertices in the order of a Hilbert curve through its bounding cube, and its
    /// triangles in the order of their lowest corner.
    ///
    /// [`Surface::user_number`] still returns the number under which a vertex was given. Cost O(V log V).
    pub fn renumbered(&self) -> Self {
        let order = hilbert_order(&self.positions);
        let mut new_number = vec![0u32; self.len()];
        for (new, &old) in order.iter().enumerate() {
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
            positions: order.iter().map(|&old| self.positions[take(old)]).collect(),
            triangles,
            user_numbers: order
                .iter()
                .map(|&old| self.user_numbers[take(old)])
                .collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn renumbering_keeps_the_surface_and_reduces_index_distance_of_neighbours() {
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
