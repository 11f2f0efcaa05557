//! Repair of surfaces whose triangles do not share their vertices, or do not have one orientation.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::fmt;

use super::surface::TriangleSurface;
use crate::digits::short;

/// Triangles that have been reversed to run like their neighbours.
#[derive(Debug, Clone, PartialEq)]
pub struct Reversed {
    /// Number of the first one, from 1.
    pub first: usize,
    /// Its corners, m.
    pub corners: [[f64; 3]; 3],
    /// Number of such triangles.
    pub count: usize,
}

impl fmt::Display for Reversed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let corner = |x: [f64; 3]| {
            let [x, y, z] = x.map(short);
            format!("({x}, {y}, {z})")
        };
        let corners = self.corners.map(corner).join(" ");
        match self.count {
            1 => write!(
                f,
                "triangle {} with the corners {corners} m runs against its neighbours; it is reversed",
                self.first
            ),
            count => write!(
                f,
                "{count} triangles run against their neighbours and are reversed, the first is triangle {} with the \
                 corners {corners} m",
                self.first
            ),
        }
    }
}

impl TriangleSurface {
    /// Returns the surface with one vertex for all corners at one position, without triangles that have two corners
    /// there, and with the triangles of each connected part in one orientation, which most of them have. Parts that cannot
    /// be oriented are kept.
    pub fn repaired(&self) -> (Self, Option<Reversed>) {
        let welded = self.welded();
        let turned = welded.against_neighbours();
        let first = turned.iter().position(|turned| *turned);
        let reversed = first.map(|first| Reversed {
            first: first + 1,
            corners: welded.corners(first),
            count: turned.iter().filter(|turned| **turned).count(),
        });
        (welded.with_turned(&turned), reversed)
    }

    /// Returns for each triangle whether it is to be reversed.
    fn against_neighbours(&self) -> Vec<bool> {
        // The triangles along an edge, and whether they run from its lower to its higher vertex.
        let mut edges: HashMap<[u32; 2], Vec<(u32, bool)>> = HashMap::new();
        for (number, triangle) in (0u32..).zip(self.triangles()) {
            for k in 0..3 {
                let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
                let entry = edges.entry([a.min(b), a.max(b)]).or_default();
                entry.push((number, a < b));
            }
        }
        // Neighbours across edges of two triangles, and whether they have the same orientation.
        let mut neighbours = vec![Vec::new(); self.len()];
        for along in edges.values() {
            if let [(a, up), (b, other)] = along[..] {
                neighbours[a as usize].push((b, up != other));
                neighbours[b as usize].push((a, up != other));
            }
        }
        let mut turned: Vec<Option<bool>> = vec![None; self.len()];
        for start in 0..self.len() {
            if turned[start].is_some() {
                continue;
            }
            turned[start] = Some(false);
            let mut part = vec![start as u32];
            let mut is_orientable = true;
            let mut next = 0;
            while let Some(&triangle) = part.get(next) {
                next += 1;
                let own = turned[triangle as usize] == Some(true);
                for &(other, is_alike) in &neighbours[triangle as usize] {
                    let wanted = own == is_alike;
                    match turned[other as usize] {
                        None => {
                            turned[other as usize] = Some(wanted);
                            part.push(other);
                        }
                        Some(found) => is_orientable &= found == wanted,
                    }
                }
            }
            let against = part
                .iter()
                .filter(|one| turned[**one as usize] == Some(true));
            let most = 2 * against.count() > part.len();
            for one in part {
                let turn = &mut turned[one as usize];
                *turn = turn.map(|turn| is_orientable && turn != most);
            }
        }
        turned.into_iter().map(|turn| turn == Some(true)).collect()
    }

    fn welded(&self) -> Self {
        // Zeros of both signs are the same position.
        let key = |x: [f64; 3]| x.map(|x| (x + 0.0).to_bits());
        let mut numbers = HashMap::new();
        let mut positions = Vec::new();
        let mut triangles = Vec::with_capacity(self.len());
        for triangle in 0..self.len() {
            let corners = self.corners(triangle).map(|x| match numbers.entry(key(x)) {
                Entry::Occupied(known) => *known.get(),
                Entry::Vacant(free) => {
                    positions.push(x);
                    *free.insert(positions.len() as u32 - 1)
                }
            });
            let [a, b, c] = corners;
            if a != b && b != c && c != a {
                triangles.push(corners);
            }
        }
        match triangles.is_empty() {
            true => self.clone(),
            false => Self::of_parts(positions, triangles),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fill::fill;

    /// A box of 3 × 2 × 1 whose twelve triangles have vertices of their own, as in STL; some are reversed.
    fn separate_box(shift: f64, reversed: &[usize]) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        let corner = |k: usize| {
            [
                shift + 3.0 * (k & 1) as f64,
                2.0 * (k >> 1 & 1) as f64,
                (k >> 2) as f64,
            ]
        };
        let mut positions = Vec::new();
        let mut triangles = Vec::new();
        for q in [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ] {
            for triangle in [[q[0], q[1], q[2]], [q[0], q[2], q[3]]] {
                let first = positions.len() as u32;
                positions.extend(triangle.map(corner));
                triangles.push(match reversed.contains(&triangles.len()) {
                    true => [first + 1, first, first + 2],
                    false => [first, first + 1, first + 2],
                });
            }
        }
        (positions, triangles)
    }

    #[test]
    fn reversed_triangles_are_named_and_turned_whichever_they_are() {
        let sets: Vec<Vec<usize>> = (0..12)
            .map(|k| vec![k])
            .chain([vec![0, 1], vec![0, 5, 9], vec![2, 3, 7, 8, 11]])
            .collect();
        for reversed in sets {
            let (positions, triangles) = separate_box(0.0, &reversed);
            let surface = TriangleSurface::new(positions, triangles).unwrap();
            assert!(surface.unmatched_edges() > 0);
            let (repaired, found) = surface.repaired();
            let found = found.unwrap();
            assert_eq!(
                (found.first - 1, found.count),
                (reversed[0], reversed.len())
            );
            assert_eq!(repaired.unmatched_edges(), 0);
            assert!((repaired.signed_volume() - 6.0).abs() < 1e-12);
            assert_eq!(repaired.positions().len(), 8);
            assert_eq!(fill(&repaired, [0.1; 3]).unwrap().nodes().count(), 6000);
        }
    }

    #[test]
    fn consistent_surfaces_keep_their_orientation() {
        // One body points outwards, the other one inwards.
        let (mut positions, mut triangles) = separate_box(0.0, &[]);
        let (more, others) = separate_box(10.0, &(0..12).collect::<Vec<_>>());
        let first = positions.len() as u32;
        positions.extend(more);
        triangles.extend(others.iter().map(|triangle| triangle.map(|v| v + first)));
        let surface = TriangleSurface::new(positions, triangles).unwrap();
        let (repaired, reversed) = surface.repaired();
        assert_eq!(reversed, None);
        assert!(repaired.signed_volume().abs() < 1e-12);
        // A Möbius strip of five quadrilaterals has no orientation and is kept.
        let strip: Vec<[f64; 3]> = (0..10)
            .map(|k| {
                [
                    f64::from(k / 2).cos(),
                    f64::from(k / 2).sin(),
                    f64::from(k % 2),
                ]
            })
            .collect();
        let corner = |k: u32| match k < 10 {
            true => k,
            false => [1, 0][k as usize - 10],
        };
        let triangles: Vec<[u32; 3]> = (0..10)
            .map(|k| match k % 2 {
                0 => [k, k + 1, k + 2],
                _ => [k + 1, k, k + 2],
            })
            .map(|triangle| triangle.map(corner))
            .collect();
        let strip = TriangleSurface::new(strip, triangles).unwrap();
        let (kept, reversed) = strip.repaired();
        assert_eq!(reversed, None);
        assert_eq!(kept.len(), 10);
    }
}
