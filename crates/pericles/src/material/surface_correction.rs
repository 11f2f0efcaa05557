//! Corrections for the bonds that points near a surface lack.

use rayon::prelude::*;

use super::BondMaterial;
use super::lattice::Cells;
use crate::family::BondList;
use crate::parallel::BLOCK;
use crate::space::PointCloud;

/// What is kept the same near surfaces as inside the body.
///
/// A bond is multiplied by a factor that is the same seen from both of its ends, so that momentum is conserved to round-off. Inside a body on a grid it is 1: the
/// reference is the family of a grid's interior, of the cloud's cells. Bonds that pre-cracks cut count as there: cracks are not corrected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SurfaceCorrection {
    /// The factor 1: bodies are softer within a horizon of their surface.
    #[default]
    None,
    /// ½(g_i + g_j) with g_i = V₀/V_i, the volume V = Σ_j κ V_j of a family and of the point itself (Le & Bobaru, Comput. Mech. 61, 499, 2018).
    Volume,
    /// Factors for each coordinate direction c from the energy of uniaxial tension along it, combined for a bond along the unit vector n by an ellipsoid:
    ///
    /// g = (Σ_c (n_c/g_c)²)^(−1/2), g_c the mean of both ends (Madenci & Oterkus, Peridynamic Theory and Its Applications, 2014, chapter 4).
    ///
    /// The strain is 1 along c and −ν across, ν the contraction of the bond-based body (1/3 in 2D, 1/4 in 3D), and g_c is such that the energy density
    /// W_c ∝ Σ_j g κ α |ξ| (n_c² − ν (1 − n_c²))² V_j is that of the interior. The condition hangs on the factors themselves; it is iterated three times from
    /// g = 1. Beyond four horizons from a surface the factor is 1 to round-off.
    Energy,
}

/// The factors of a body's points.
#[derive(Debug, Clone, PartialEq)]
pub enum SurfaceFactors {
    /// All bonds have the factor 1.
    None,
    /// A factor for each point.
    Scalar(Vec<f64>),
    /// A factor for each point and coordinate direction.
    Directional(Vec<[f64; 3]>),
}

impl SurfaceFactors {
    /// The factor of the bond ξ (m) from point i to point j; the same bits for −ξ from j to i.
    pub fn of_bond(&self, i: usize, j: usize, xi: [f64; 3]) -> f64 {
        match self {
            Self::None => 1.0,
            Self::Scalar(factors) => 0.5 * (factors[i] + factors[j]),
            Self::Directional(factors) => ellipsoid([&factors[i], &factors[j]], xi),
        }
    }
}

/// The factor of a bond ξ from those of its ends for each direction.
fn ellipsoid([a, b]: [&[f64; 3]; 2], xi: [f64; 3]) -> f64 {
    let (mut square, mut sum) = (0.0, 0.0);
    for c in 0..3 {
        let along = xi[c] / (0.5 * (a[c] + b[c]));
        square += xi[c] * xi[c];
        sum += along * along;
    }
    (square / sum).sqrt()
}

impl SurfaceCorrection {
    /// The factors of a body.
    pub fn factors(
        self,
        cloud: &PointCloud,
        bonds: &BondList,
        material: &BondMaterial,
    ) -> SurfaceFactors {
        /// The first two leave up to 7 % of the tension of thin bars, further ones make shear softer.
        const PASSES: usize = 3;
        let body = Body {
            cloud,
            bonds,
            material,
        };
        match self {
            Self::None => SurfaceFactors::None,
            Self::Volume => body.volume_factors(),
            Self::Energy => {
                let interior = body.interior_energies();
                let mut factors = vec![[1.0; 3]; cloud.len()];
                for _ in 0..PASSES {
                    factors = body.improved(&interior, &factors);
                }
                SurfaceFactors::Directional(factors)
            }
        }
    }
}

/// What factors are found for.
struct Body<'a> {
    cloud: &'a PointCloud,
    bonds: &'a BondList,
    material: &'a BondMaterial,
}

impl Body<'_> {
    /// Calls `visit(κ, ξ, |ξ|)` for the bonds of an interior point, and returns the volume of its cell.
    fn interior(&self, mut visit: impl FnMut(f64, [f64; 3], f64)) -> f64 {
        let (cloud, material) = (self.cloud, self.material);
        let cubic = vec![cloud.spacing(); cloud.dimension()];
        let cells = Cells::new(cloud.cell_sides().unwrap_or(&cubic));
        let (correction, size) = (material.volume_correction, cells.size());
        material.for_each_offset(cells, |_, xi, r| {
            visit(correction.factor(r, material.horizon, size), xi, r);
        });
        cloud.section() * cells.volume()
    }

    fn volume_factors(&self) -> SurfaceFactors {
        // The point itself has volume.
        let mut cells = 1.0;
        let volume = self.interior(|kappa, _, _| cells += kappa);
        let interior = cells * volume;
        let volumes = self.cloud.volumes();
        let factor = |i: usize| {
            let family = self.bonds.family(i);
            let sum: f64 = family
                .map(|(_, j)| self.bonds.volume_factor(self.cloud, i, j) * volumes[j])
                .sum();
            interior / (volumes[i] + sum)
        };
        SurfaceFactors::Scalar(self.for_each_point(factor))
    }

    /// What a bond adds to the energies of tension along each axis, over c s² V/2.
    fn energies(&self, xi: [f64; 3], r: f64) -> [f64; 3] {
        const CONTRACTION: [f64; 3] = [0.0, 1.0 / 3.0, 1.0 / 4.0];
        let dimension = self.cloud.dimension();
        let nu = CONTRACTION[dimension - 1];
        let weight = self.material.influence.alpha_of(xi, self.material.horizon) * r;
        std::array::from_fn(|c| {
            let square = (xi[c] / r) * (xi[c] / r);
            let stretch = square - nu * (1.0 - square);
            if c < dimension {
                weight * stretch * stretch
            } else {
                0.0
            }
        })
    }

    fn interior_energies(&self) -> [f64; 3] {
        let mut sums = [0.0; 3];
        let volume = self.interior(|kappa, xi, r| add(&mut sums, kappa, self.energies(xi, r)));
        sums.map(|sum| sum * volume)
    }

    /// Factors under which the energies of corrected bonds are nearer those of the interior.
    fn improved(&self, interior: &[f64; 3], factors: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let (cloud, bonds, volumes) = (self.cloud, self.bonds, self.cloud.volumes());
        self.for_each_point(|i| {
            let mut sums = [0.0; 3];
            for (_, j) in bonds.family(i) {
                let (xi, r) = (bonds.vector(cloud, i, j), bonds.length(cloud, i, j));
                let factor = ellipsoid([&factors[i], &factors[j]], xi);
                let weight = factor * bonds.volume_factor(cloud, i, j) * volumes[j];
                add(&mut sums, weight, self.energies(xi, r));
            }
            let own = factors[i];
            // A point without bonds has nothing to be corrected.
            std::array::from_fn(|c| match sums[c] {
                sum if sum > 0.0 => own[c] * interior[c] / sum,
                _ => own[c],
            })
        })
    }

    fn for_each_point<T: Send>(&self, value: impl Fn(usize) -> T + Send + Sync) -> Vec<T> {
        (0..self.cloud.len())
            .into_par_iter()
            .with_min_len(BLOCK)
            .map(value)
            .collect()
    }
}

fn add(sums: &mut [f64; 3], weight: f64, terms: [f64; 3]) {
    for (sum, term) in sums.iter_mut().zip(terms) {
        *sum += weight * term;
    }
}
