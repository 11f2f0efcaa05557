//! Paths through wave-vector space.

use std::f64::consts::PI;

use super::lattice::BondLattice;
use super::vector::{Vector, dot, unit};

/// Straight segment of a contour.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// Start, rad/m.
    pub from: Vector,
    /// End, rad/m.
    pub to: Vector,
    /// Names of the two ends.
    pub ends: [&'static str; 2],
    /// Polarisation of each branch, if the symmetry of the lattice determines it along the segment.
    pub polarisation: Option<Vec<Vector>>,
}

impl Segment {
    /// Length, rad/m.
    pub fn length(&self) -> f64 {
        let d = self.vector();
        dot(d, d).sqrt()
    }

    /// Unit vector along the segment.
    pub fn direction(&self) -> Vector {
        unit(self.vector())
    }

    /// The wave vector at a distance from the start, rad/m.
    pub fn at(&self, distance: f64) -> Vector {
        let share = distance / self.length();
        let d = self.vector();
        std::array::from_fn(|c| self.from[c] + share * d[c])
    }

    fn vector(&self) -> Vector {
        std::array::from_fn(|c| self.to[c] - self.from[c])
    }
}

/// Path through wave-vector space with the branches followed along it: pressure first, then shear.
#[derive(Debug, Clone, PartialEq)]
pub struct Contour {
    /// Segments, each starting where the previous one ends.
    pub segments: Vec<Segment>,
    /// Names of the branches.
    pub branches: Vec<&'static str>,
}

const X: Vector = [1.0, 0.0, 0.0];
const Y: Vector = [0.0, 1.0, 0.0];
const Z: Vector = [0.0, 0.0, 1.0];

impl Contour {
    /// Border of the irreducible Brillouin zone for spacing D: Γ–X in 1D; O–M–Y–O, that is (0,0), (π,0), (π,π),
    /// (0,0) over D, on square lattices; Γ–X–M–R–Γ on cubic ones. Symmetry determines the polarisations on all of
    /// it: along the axes and the zone border the products sin(k_x ξ_x) sin(k_y ξ_y) of the off-diagonal entries
    /// vanish, and along diagonals the axes are equivalent. The pressure branch continues from segment to segment,
    /// so on M–Y it is the one polarised along x.
    ///
    /// On rectangular lattices the path follows lines with at most one component of k strictly inside its range,
    /// where all polarisations are along the axes: Γ–X–S–Y–Γ in 2D, Γ–X–S–R–T–Z–Γ in 3D. Their branches are named
    /// by polarisation.
    pub fn irreducible(lattice: &BondLattice) -> Self {
        let edge = |c: usize| PI / lattice.spacing()[c];
        let axes = || Some(vec![X, Y, Z][..lattice.dimension()].to_vec());
        let node = |present: [bool; 3]| -> Vector {
            std::array::from_fn(|c| if present[c] { edge(c) } else { 0.0 })
        };
        let path = |stops: &[(&'static str, [bool; 3])]| -> Vec<Segment> {
            let leg = |pair: &[(&'static str, [bool; 3])]| Segment {
                from: node(pair[0].1),
                to: node(pair[1].1),
                ends: [pair[0].0, pair[1].0],
                polarisation: axes(),
            };
            stops.windows(2).map(leg).collect()
        };
        let (o, i) = (false, true);
        let (half, third, sixth) = (0.5f64.sqrt(), (1.0f64 / 3.0).sqrt(), (1.0f64 / 6.0).sqrt());
        let (mut segments, branches, diagonal) = match (lattice.dimension(), lattice.is_cubic()) {
            (1, _) => (path(&[("Γ", [o, o, o]), ("X", [i, o, o])]), vec!["p"], None),
            (2, true) => (
                path(&[
                    ("O", [o, o, o]),
                    ("M", [i, o, o]),
                    ("Y", [i, i, o]),
                    ("O", [o, o, o]),
                ]),
                vec!["p", "s"],
                Some(vec![[half, half, 0.0], [half, -half, 0.0]]),
            ),
            (2, false) => (
                path(&[
                    ("Γ", [o, o, o]),
                    ("X", [i, o, o]),
                    ("S", [i, i, o]),
                    ("Y", [o, i, o]),
                    ("Γ", [o, o, o]),
                ]),
                vec!["x", "y"],
                None,
            ),
            (_, true) => (
                path(&[
                    ("Γ", [o, o, o]),
                    ("X", [i, o, o]),
                    ("M", [i, i, o]),
                    ("R", [i, i, i]),
                    ("Γ", [o, o, o]),
                ]),
                vec!["p", "s1", "s2"],
                Some(vec![
                    [third; 3],
                    [half, -half, 0.0],
                    [sixth, sixth, -2.0 * sixth],
                ]),
            ),
            (_, false) => (
                path(&[
                    ("Γ", [o, o, o]),
                    ("X", [i, o, o]),
                    ("S", [i, i, o]),
                    ("R", [i, i, i]),
                    ("T", [o, i, i]),
                    ("Z", [o, o, i]),
                    ("Γ", [o, o, o]),
                ]),
                vec!["x", "y", "z"],
                None,
            ),
        };
        if let (Some(diagonal), Some(last)) = (diagonal, segments.last_mut()) {
            last.polarisation = Some(diagonal);
        }
        Self { segments, branches }
    }

    /// Path from the origin along a direction (any length) to the border of the zone. Branches are followed by the
    /// similarity of their polarisations.
    pub fn ray(lattice: &BondLattice, direction: Vector) -> Self {
        let n = lattice.unit_direction(direction);
        let reach = (0..lattice.dimension())
            .map(|c| PI / lattice.spacing()[c] / n[c].abs())
            .fold(f64::INFINITY, f64::min);
        let segment = Segment {
            from: [0.0; 3],
            to: n.map(|x| x * reach),
            ends: ["Γ", "border"],
            polarisation: None,
        };
        Self {
            segments: vec![segment],
            branches: ["p", "s1", "s2"][..lattice.dimension()].to_vec(),
        }
    }

    /// Length, rad/m.
    pub fn length(&self) -> f64 {
        self.segments.iter().map(Segment::length).sum()
    }

    /// Returns the segment at an arc length, and the distance from its start. A corner belongs to the segment that
    /// ends there.
    pub fn locate(&self, abscissa: f64) -> (usize, f64) {
        let mut rest = abscissa;
        for (number, segment) in self.segments.iter().enumerate() {
            let length = segment.length();
            if rest <= length * (1.0 + 1e-12) || number + 1 == self.segments.len() {
                return (number, rest.min(length));
            }
            rest -= length;
        }
        (0, 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::LatticeBond;

    fn lattice(spacing: &[f64]) -> BondLattice {
        let weight = |offset: [i32; 3], _: Vector, r: f64| {
            1.0 / r + 0.1 * f64::from(offset.iter().map(|c| c.abs()).sum::<i32>())
        };
        BondLattice::new(spacing, 3.2, weight).unwrap()
    }

    #[test]
    fn polarisations_on_the_contour_are_eigenvectors() {
        for spacing in [
            &[1.0][..],
            &[1.0, 1.0],
            &[1.0, 0.7],
            &[1.0, 1.0, 1.0],
            &[1.0, 0.8, 1.3],
        ] {
            let lattice = lattice(spacing);
            let contour = Contour::irreducible(&lattice);
            for segment in &contour.segments {
                for step in 0..=10 {
                    let k = segment.at(segment.length() * f64::from(step) / 10.0);
                    let matrix = lattice.dynamical_matrix(k);
                    for e in segment.polarisation.as_ref().unwrap() {
                        let value = lattice.omega_squared(k, *e);
                        for row in 0..3 {
                            let residual = dot(matrix[row], *e) - value * e[row];
                            assert!(residual.abs() < 1e-12, "{spacing:?} {:?}", segment.ends);
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn square_contour_has_the_expected_length() {
        let contour = Contour::irreducible(&lattice(&[1.0, 1.0]));
        assert!((contour.length() - (2.0 + 2.0f64.sqrt()) * PI).abs() < 1e-14);
        assert_eq!(contour.locate(PI).0, 0);
        let (segment, distance) = contour.locate(2.5 * PI);
        assert_eq!(segment, 2);
        let k = contour.segments[2].at(distance);
        assert!((k[0] - PI * (1.0 - 0.5 / 2.0f64.sqrt())).abs() < 1e-14 && k[0] == k[1]);
    }

    #[test]
    fn rays_end_at_the_zone_border() {
        let lattice = lattice(&[1.0, 0.5]);
        let ray = Contour::ray(&lattice, [1.0, 1.0, 9.0]);
        let end = ray.segments[0].to;
        assert!((end[0] - PI).abs() < 1e-14 && (end[1] - PI).abs() < 1e-14 && end[2] == 0.0);
        let _: &[LatticeBond] = lattice.bonds();
    }
}
