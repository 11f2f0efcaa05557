//! Bonds of one point of an infinite lattice, and its plane waves.

use crate::DispersionError;
use pericles::family::VolumeCorrection;
use pericles::material::{BondConstants, BondMaterial};
use pericles::space::PointCloud;
use pericles::{PericlesError, Result, positive};

use super::modes::{Mode, modes_of};
use super::vector::{SquareMatrix, Vector, dot, unit};

/// Bond of a lattice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LatticeBond {
    /// Steps along the axes.
    pub offset: [i32; 3],
    /// ξ, m.
    pub xi: Vector,
    /// |ξ|, m.
    pub length: f64,
    /// c α κ V / ρ: acceleration per unit stretch, m/s².
    pub stiffness: f64,
}

/// Bonds of an interior point of a lattice, which determine its plane waves exp(i k·x).
///
/// The dynamical matrix is M(k) = Σ a (1 − cos k·ξ)/|ξ|³ ξ⊗ξ over all bonds with stiffness a; its eigenvalues are
/// ω². One bond of each pair ±ξ is stored; an evaluation costs one trigonometric function per stored bond.
#[derive(Debug, Clone, PartialEq)]
pub struct BondLattice {
    dimension: usize,
    spacing: Vector,
    half: Vec<LatticeBond>,
}

impl BondLattice {
    /// Creates the lattice with the given spacings (one per axis, m) and the bonds up to length `reach` (m).
    /// `stiffness` is called with the offset, ξ and |ξ| of one bond of each pair ±ξ and must be invariant under
    /// reflections of the axes (and under their exchange if spacings are equal).
    ///
    /// # Errors
    /// A spacing that is not positive; a reach that contains no bond, or too many for the memory (125 spacings in
    /// 3D).
    pub fn new(
        spacing: &[f64],
        reach: f64,
        stiffness: impl Fn([i32; 3], Vector, f64) -> f64,
    ) -> Result<Self> {
        /// Largest number of steps in the box around a family: some 4 million stored bonds in 3D, 300 MB.
        const MOST: f64 = 1.6e7;
        let dimension = spacing.len();
        if !(1..=3).contains(&dimension) {
            return Err(PericlesError::WrongDimension {
                what: "a lattice with this number of spacings",
                needed: "1, 2 or 3",
                dimension,
            });
        }
        let mut steps = [0; 3];
        let mut all = [0.0; 3];
        let mut places = 1.0;
        for (c, &dx) in spacing.iter().enumerate() {
            all[c] = positive("the spacing", dx)?;
            let ratio = positive("the maximum bond length", reach)? / dx;
            places *= 2.0 * ratio.floor() + 1.0;
            if places > MOST {
                return Err(PericlesError::OutOfRange {
                    quantity: "the maximum bond length in spacings",
                    value: ratio,
                    allowed: "at most 125 in 3D and 2000 in 2D for plane waves (16 million offsets in the box around \
                        a family)",
                });
            }
            steps[c] = ratio.floor() as i32;
        }
        let mut half = Vec::new();
        for x in -steps[0]..=steps[0] {
            for y in -steps[1]..=steps[1] {
                for z in -steps[2]..=steps[2] {
                    // Keep offsets whose first non-zero coordinate is positive.
                    if [x, y, z] <= [0; 3] {
                        continue;
                    }
                    let xi = std::array::from_fn(|c| f64::from([x, y, z][c]) * all[c]);
                    let length = dot(xi, xi).sqrt();
                    if length <= reach {
                        half.push(LatticeBond {
                            offset: [x, y, z],
                            xi,
                            length,
                            stiffness: stiffness([x, y, z], xi, length),
                        });
                    }
                }
            }
        }
        if half.is_empty() {
            return Err(PericlesError::HorizonTooSmall {
                horizon: reach,
                spacing: spacing.iter().copied().fold(f64::INFINITY, f64::min),
            });
        }
        Ok(Self {
            dimension,
            spacing: all,
            half,
        })
    }

    /// Creates the lattice of the interior of a body on a grid.
    ///
    /// # Errors
    /// The points of the body are not on a grid.
    pub fn of_body(
        cloud: &PointCloud,
        material: &BondMaterial,
        constants: &BondConstants,
    ) -> Result<Self> {
        if cloud.lattice().is_none() {
            return Err(DispersionError::NoLattice.into());
        }
        let spacing = vec![cloud.spacing(); cloud.dimension()];
        Self::of_material(&spacing, cloud.section(), material, constants)
    }

    /// Creates the lattice of a material for any spacings; cells have the volume section · Π spacing.
    ///
    /// # Errors
    /// As [`BondLattice::new`].
    pub fn of_material(
        spacing: &[f64],
        section: f64,
        material: &BondMaterial,
        constants: &BondConstants,
    ) -> Result<Self> {
        let volume = spacing.iter().product::<f64>() * section;
        let cell = spacing
            .iter()
            .product::<f64>()
            .powf(1.0 / spacing.len().max(1) as f64);
        let factor = constants.micromodulus * volume / positive("the density", material.density)?;
        let correction: VolumeCorrection = material.volume_correction;
        let horizon = material.horizon;
        Self::new(spacing, correction.reach(horizon, cell), |_, xi, r| {
            factor * material.influence.alpha_of(xi, horizon) * correction.factor(r, horizon, cell)
        })
    }

    /// Dimension: 1, 2 or 3.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Spacings along the axes, m; zero for missing axes.
    pub fn spacing(&self) -> Vector {
        self.spacing
    }

    /// Stored bonds, one of each pair ±ξ.
    pub fn bonds(&self) -> &[LatticeBond] {
        &self.half
    }

    /// Returns true if all spacings are equal, so that the lattice is square or cubic.
    pub fn is_cubic(&self) -> bool {
        let first = self.spacing[0];
        self.spacing[..self.dimension]
            .iter()
            .all(|dx| (dx / first - 1.0).abs() < 1e-12)
    }

    /// Dynamical matrix M(k), 1/s²; k in rad/m.
    pub fn dynamical_matrix(&self, k: Vector) -> SquareMatrix {
        self.sum(|bond| {
            let half = (0.5 * dot(k, bond.xi)).sin();
            // 1 − cos φ = 2 sin²(φ/2) is accurate for long waves.
            4.0 * half * half
        })
    }

    /// Long-wave limit ½ Σ a (n·ξ)²/|ξ|³ ξ⊗ξ of M(k)/|k|² along the unit vector n, m²/s².
    pub fn long_wave_matrix(&self, direction: Vector) -> SquareMatrix {
        let n = self.unit_direction(direction);
        self.sum(|bond| dot(n, bond.xi).powi(2))
    }

    /// Normalises a direction, ignoring components beyond the dimension.
    pub(super) fn unit_direction(&self, direction: Vector) -> Vector {
        let mut n = [0.0; 3];
        n[..self.dimension].copy_from_slice(&direction[..self.dimension]);
        unit(n)
    }

    fn sum(&self, weight: impl Fn(&LatticeBond) -> f64) -> SquareMatrix {
        let mut matrix = [[0.0; 3]; 3];
        for bond in &self.half {
            let factor = bond.stiffness * weight(bond) / bond.length.powi(3);
            for a in 0..self.dimension {
                for b in a..self.dimension {
                    matrix[a][b] += factor * bond.xi[a] * bond.xi[b];
                }
            }
        }
        for a in 0..3 {
            for b in 0..a {
                matrix[a][b] = matrix[b][a];
            }
        }
        matrix
    }

    /// Returns e·M(k)e, which is ω² if e is a polarisation.
    pub fn omega_squared(&self, k: Vector, e: Vector) -> f64 {
        let terms = self.half.iter().map(|bond| {
            let half = (0.5 * dot(k, bond.xi)).sin();
            4.0 * bond.stiffness * half * half * dot(e, bond.xi).powi(2) / bond.length.powi(3)
        });
        terms.sum()
    }

    /// Returns ∂(e·M(k)e)/∂k, which is 2ω times the group velocity if e is the polarisation of a branch.
    pub fn omega_squared_gradient(&self, k: Vector, e: Vector) -> Vector {
        let mut gradient = [0.0; 3];
        for bond in &self.half {
            let factor = 2.0 * bond.stiffness * dot(k, bond.xi).sin() * dot(e, bond.xi).powi(2)
                / bond.length.powi(3);
            for c in 0..3 {
                gradient[c] += factor * bond.xi[c];
            }
        }
        gradient
    }

    /// Modes of wave vector k in ascending order of frequency.
    pub fn modes(&self, k: Vector) -> Vec<Mode> {
        modes_of(&self.dynamical_matrix(k), self.dimension)
    }

    /// Component ½ Σ a ξ_a ξ_b ξ_c ξ_d/|ξ|³ of the elasticity tensor over density, summed over all bonds, m²/s².
    pub fn elasticity(&self, a: usize, b: usize, c: usize, d: usize) -> f64 {
        let terms = self.half.iter().map(|bond| {
            let xi = bond.xi;
            bond.stiffness * xi[a] * xi[b] * xi[c] * xi[d] / bond.length.powi(3)
        });
        terms.sum()
    }

    /// Energy per unit area of a crack surface with normal n, divided by ρ s₀²: ½ Σ_{ξ·n>0} a |ξ| (ξ·n), m³/s². The
    /// surface passes between points.
    pub fn crack_energy(&self, normal: Vector) -> f64 {
        let n = self.unit_direction(normal);
        let terms = self
            .half
            .iter()
            .map(|bond| 0.5 * bond.stiffness * bond.length * dot(bond.xi, n).abs());
        terms.sum()
    }

    /// Returns the lattice with the bonds that satisfy a predicate.
    pub(super) fn only(&self, wanted: impl Fn(&LatticeBond) -> bool) -> Self {
        let mut lattice = self.clone();
        lattice.half.retain(wanted);
        lattice
    }

    /// Returns the lattice with other stiffnesses.
    pub(super) fn with_stiffness(&self, stiffness: impl Fn(&LatticeBond) -> f64) -> Self {
        let mut lattice = self.clone();
        for bond in &mut lattice.half {
            bond.stiffness = stiffness(bond);
        }
        lattice
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(n: f64) -> BondLattice {
        BondLattice::new(&[1.0, 1.0], n + 1e-9, |offset, _, r| {
            1.0 + f64::from(offset[0].abs() + offset[1].abs()) / r
        })
        .unwrap()
    }

    #[test]
    fn bonds_are_counted_once() {
        assert_eq!(square(3.0).bonds().len(), 14);
        let cube = BondLattice::new(&[2.0; 3], 6.0, |_, _, _| 1.0).unwrap();
        assert_eq!(cube.bonds().len(), 61);
        assert!(BondLattice::new(&[1.0, 2.0], 0.9, |_, _, _| 1.0).is_err());
        assert!(BondLattice::new(&[1.0], f64::NAN, |_, _, _| 1.0).is_err());
    }

    #[test]
    fn dynamical_matrix_is_the_sum_over_all_bonds() {
        let lattice = square(2.3);
        let k = [0.7, -1.9, 0.0];
        let mut plain = [[0.0; 2]; 2];
        for x in -2..=2 {
            for y in -2..=2_i32 {
                let r = f64::from(x * x + y * y).sqrt();
                if r == 0.0 || r > 2.3 {
                    continue;
                }
                let xi = [f64::from(x), f64::from(y)];
                let a = 1.0 + f64::from(x.abs() + y.abs()) / r;
                let wave = 1.0 - (k[0] * xi[0] + k[1] * xi[1]).cos();
                for p in 0..2 {
                    for q in 0..2 {
                        plain[p][q] += a * wave / r.powi(3) * xi[p] * xi[q];
                    }
                }
            }
        }
        let matrix = lattice.dynamical_matrix(k);
        for p in 0..2 {
            for q in 0..2 {
                assert!((matrix[p][q] - plain[p][q]).abs() < 1e-13);
            }
        }
        let e = unit([0.3, 0.8, 0.0]);
        let form: f64 = (0..2)
            .flat_map(|p| (0..2).map(move |q| (p, q)))
            .map(|(p, q)| e[p] * plain[p][q] * e[q])
            .sum();
        assert!((lattice.omega_squared(k, e) - form).abs() < 1e-13);
    }

    #[test]
    fn gradients_equal_difference_quotients() {
        let lattice = square(3.0);
        let (k, e, h) = ([0.4, 1.3, 0.0], unit([1.0, 2.0, 0.0]), 1e-5);
        let gradient = lattice.omega_squared_gradient(k, e);
        for c in 0..2 {
            let moved = |sign: f64| {
                let mut at = k;
                at[c] += sign * h;
                lattice.omega_squared(at, e)
            };
            let slope = (moved(1.0) - moved(-1.0)) / (2.0 * h);
            assert!((slope - gradient[c]).abs() < 1e-8);
        }
    }

    #[test]
    fn dynamical_matrix_tends_to_the_long_wave_matrix() {
        let lattice = square(3.0);
        let n = unit([2.0, 1.0, 0.0]);
        let small = 1e-4;
        let matrix = lattice.dynamical_matrix(n.map(|x| x * small));
        let limit = lattice.long_wave_matrix(n);
        for a in 0..2 {
            for b in 0..2 {
                assert!((matrix[a][b] / (small * small) - limit[a][b]).abs() < 1e-6);
            }
        }
        let along = lattice.long_wave_matrix([1.0, 0.0, 0.0]);
        assert!((along[0][0] - lattice.elasticity(0, 0, 0, 0)).abs() < 1e-13);
        assert!((along[1][1] - lattice.elasticity(0, 0, 1, 1)).abs() < 1e-13);
    }
}
