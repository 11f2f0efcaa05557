//! Surface correction: factors of bonds near free surfaces.

use rayon::prelude::*;

use super::BondMaterial;
use super::lattice::Cells;
use crate::family::BondList;
use crate::parallel::BLOCK;
use crate::solve::principal_axes;
use crate::space::PointCloud;

/// Method of surface correction, by the quantity that points near a surface share with interior points.
///
/// Each bond has a factor that is the same from both end points, so that momentum is conserved to round-off.
/// The reference is the family of an interior point of a grid with the cells of the cloud; in the interior of
/// a grid the factor is 1. Bonds cut by pre-cracks are counted as present: crack faces are not corrected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SurfaceCorrection {
    /// No correction: bodies are softer within a horizon of their surface.
    #[default]
    None,
    /// ½(g_i + g_j) with g_i = V₀/V_i and the volume V = V_i + Σ_j κ V_j of a point and its family; V₀ is
    /// that of an interior point (Le & Bobaru, Comput. Mech. 61, 499, 2018).
    Volume,
    /// Factors for three directions c at each point from the energy of uniaxial tension along them, combined
    /// for a bond along the unit vector n by an ellipsoid (Madenci & Oterkus, Peridynamic Theory and Its
    /// Applications, 2014, chapter 4):
    ///
    /// g = (Σ_c (n_c/g_c)²)^(−1/2) = 1/|G⁻¹ n|, where the tensor G, the mean of both end points, has the
    /// factors g_c along the directions c.
    ///
    /// The directions are the principal axes of Σ_j κ α |ξ| n⊗n V_j rather than the coordinate axes, so that
    /// oblique surfaces are corrected as well as surfaces along the grid. The strain is 1 along c and −ν in
    /// the other directions, with Poisson's ratio ν of the bond-based body (1/3 in 2D, 1/4 in 3D); g_c is
    /// such that the energy density W_c ∝ Σ_j g κ α |ξ| (n_c² − ν (1 − n_c²))² V_j equals that of the
    /// interior. The condition depends on the factors themselves and is iterated three times from g = 1.
    /// Beyond four horizons from a surface the factor is 1 to round-off.
    Energy,
    /// Families completed by ghost points in free cells of the lattice, with displacements extrapolated from
    /// the body; forces are the exact gradient of the energy of the body
    /// ([`GhostForce`](crate::operator::GhostForce)). For outer surfaces without fracture: bonds cannot
    /// break, and pre-cracks are not corrected.
    Ghosts,
}

/// Symmetric tensor: xx, yy, zz, xy, yz, zx.
pub(super) type Tensor = [f64; 6];

/// Surface correction factors of the points of a body.
#[derive(Debug, Clone, PartialEq)]
pub enum SurfaceFactors {
    /// All bonds have the factor 1.
    None,
    /// A factor for each point.
    Scalar(Vec<f64>),
    /// A symmetric tensor for each point: xx, yy, zz, xy, yz, zx.
    Directional(Vec<[f64; 6]>),
}

impl SurfaceFactors {
    /// Returns the factor of the bond ξ (m) from point i to point j; bitwise the same for −ξ from j to i.
    pub fn of_bond(&self, i: usize, j: usize, xi: [f64; 3]) -> f64 {
        match self {
            Self::None => 1.0,
            Self::Scalar(factors) => 0.5 * (factors[i] + factors[j]),
            Self::Directional(tensors) => ellipsoid([&tensors[i], &tensors[j]], xi),
        }
    }
}

/// Returns |ξ|/|G⁻¹ ξ| with the mean G of the tensors of both end points.
pub(super) fn ellipsoid([a, b]: [&Tensor; 2], xi: [f64; 3]) -> f64 {
    let [xx, yy, zz, xy, yz, zx]: Tensor = std::array::from_fn(|k| 0.5 * (a[k] + b[k]));
    // Cofactors, which are the inverse times the determinant.
    let inverse = [
        [yy * zz - yz * yz, yz * zx - xy * zz, xy * yz - yy * zx],
        [yz * zx - xy * zz, xx * zz - zx * zx, xy * zx - xx * yz],
        [xy * yz - yy * zx, xy * zx - xx * yz, xx * yy - xy * xy],
    ];
    let determinant = xx * inverse[0][0] + xy * inverse[0][1] + zx * inverse[0][2];
    let (mut square, mut reduced) = (0.0, 0.0);
    for (x, row) in xi.iter().zip(&inverse) {
        let y = (row[0] * xi[0] + row[1] * xi[1] + row[2] * xi[2]) / determinant;
        square += x * x;
        reduced += y * y;
    }
    (square / reduced).sqrt()
}

impl SurfaceCorrection {
    /// Returns the factors of a body.
    pub fn factors(self, bonds: &BondList, material: &BondMaterial) -> SurfaceFactors {
        /// Two passes leave an error of 7 % in the tension of thin bars; more than three make shear softer.
        const PASSES: usize = 3;
        let body = Body {
            cloud: bonds.sites().cloud(),
            bonds,
            material,
        };
        match self {
            // Ghosts are points, not factors.
            Self::None | Self::Ghosts => SurfaceFactors::None,
            Self::Volume => body.volume_factors(),
            Self::Energy => {
                let mut points = body.uncorrected();
                for _ in 0..PASSES {
                    body.improve(&mut points);
                }
                SurfaceFactors::Directional(tensors_of_sites(bonds, &points))
            }
        }
    }
}

/// Factors of a point along three directions.
#[derive(Debug, Clone, Copy)]
pub(super) struct Directions {
    /// Orthogonal unit vectors.
    pub(super) axes: [[f64; 3]; 3],
    /// Energies of uniaxial tension along them in the interior.
    pub(super) interior: [f64; 3],
    pub(super) factors: [f64; 3],
}

impl Directions {
    /// Σ_c g_c c⊗c
    pub(super) fn tensor(&self) -> Tensor {
        const ENTRIES: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [2, 0]];
        ENTRIES.map(|[a, b]| {
            let terms = self.axes.iter().zip(self.factors);
            terms
                .map(|(axis, factor)| factor * axis[a] * axis[b])
                .sum::<f64>()
        })
    }
}

/// Returns the principal axes of a second moment; the coordinate axes if they are principal.
pub(super) fn axes_of(moment: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    /// Relative round-off of the sums, far below off-diagonal entries that turn the axes.
    const NOTHING: f64 = 1e-9;
    let trace = moment[0][0] + moment[1][1] + moment[2][2];
    let across = [moment[0][1], moment[1][2], moment[0][2]];
    let bent = across.iter().any(|x| x.abs() > NOTHING * trace);
    match bent && trace > 0.0 && trace.is_finite() {
        true => principal_axes(moment),
        false => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    }
}

/// Returns the tensors of all sites of a bond list.
pub(super) fn tensors_of_sites(bonds: &BondList, points: &[Directions]) -> Vec<Tensor> {
    let own: Vec<Tensor> = points.iter().map(Directions::tensor).collect();
    let sites = bonds.sites();
    if sites.are_points() {
        return own;
    }
    let entry = |k: usize| {
        let of_points: Vec<f64> = own.iter().map(|tensor| tensor[k]).collect();
        sites.spread(&of_points).into_owned()
    };
    let entries: [Vec<f64>; 6] = std::array::from_fn(entry);
    (0..sites.len())
        .map(|site| std::array::from_fn(|k| entries[k][site]))
        .collect()
}

/// The body whose factors are computed.
struct Body<'a> {
    cloud: &'a PointCloud,
    bonds: &'a BondList,
    material: &'a BondMaterial,
}

impl Body<'_> {
    /// Calls `visit(κ, ξ, |ξ|)` for each bond of an interior point and returns the volume of its cell.
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
        // The volume of the point itself.
        let mut cells = 1.0;
        let volume = self.interior(|kappa, _, _| cells += kappa);
        let interior = cells * volume;
        let volumes = self.cloud.volumes();
        let factor = |i: usize| {
            let (bonds, here) = (self.bonds, self.bonds.site(i));
            let family = bonds.family(i);
            let sum: f64 = family
                .map(|(_, b)| bonds.volume_factor(here, b) * bonds.volume(b))
                .sum();
            interior / (volumes[i] + sum)
        };
        let factors = self.for_each_point(factor);
        SurfaceFactors::Scalar(self.bonds.sites().spread(&factors).into_owned())
    }

    /// Returns α |ξ| of a bond.
    fn weight(&self, xi: [f64; 3], r: f64) -> f64 {
        self.material.influence.alpha_of(xi, self.material.horizon) * r
    }

    /// Returns the contribution of a bond of weight 1 to the energies of tension along each axis, over c s² V/2.
    fn energies(&self, axes: &[[f64; 3]; 3], xi: [f64; 3], r: f64) -> [f64; 3] {
        const CONTRACTION: [f64; 3] = [0.0, 1.0 / 3.0, 1.0 / 4.0];
        let nu = CONTRACTION[self.cloud.dimension() - 1];
        axes.map(|axis| {
            let along = (axis[0] * xi[0] + axis[1] * xi[1] + axis[2] * xi[2]) / r;
            let square = along * along;
            let stretch = square - nu * (1.0 - square);
            stretch * stretch
        })
    }

    /// Returns the directions of every point with the factors 1.
    fn uncorrected(&self) -> Vec<Directions> {
        let mut family = Vec::new();
        let volume = self.interior(|kappa, xi, r| family.push((kappa, xi, r)));
        for (kappa, xi, r) in &mut family {
            *kappa *= self.weight(*xi, *r) * volume;
        }
        self.for_each_point(|i| {
            let axes = self.principal_axes(i);
            let mut interior = [0.0; 3];
            for &(weight, xi, r) in &family {
                add(&mut interior, weight, self.energies(&axes, xi, r));
            }
            Directions {
                axes,
                interior,
                factors: [1.0; 3],
            }
        })
    }

    /// Returns the principal axes of a family; the coordinate axes if they are principal.
    fn principal_axes(&self, i: usize) -> [[f64; 3]; 3] {
        let (bonds, here) = (self.bonds, self.bonds.site(i));
        let mut moment = [[0.0; 3]; 3];
        for (_, b) in bonds.family(i) {
            let (xi, r) = (bonds.vector(here, b), bonds.length(here, b));
            let weight = self.weight(xi, r) * bonds.volume_factor(here, b);
            let weight = weight * bonds.volume(b);
            for (row, a) in moment.iter_mut().zip(xi) {
                for (entry, b) in row.iter_mut().zip(xi) {
                    *entry += weight * (a / r) * (b / r);
                }
            }
        }
        axes_of(moment)
    }

    /// Performs one pass of the iteration of the factors.
    fn improve(&self, points: &mut [Directions]) {
        let bonds = self.bonds;
        let tensors = tensors_of_sites(bonds, points);
        let improved: Vec<[f64; 3]> = self.for_each_point(|i| {
            let (own, here) = (&points[i], bonds.site(i));
            let mut sums = [0.0; 3];
            for (_, b) in bonds.family(i) {
                let (xi, r) = (bonds.vector(here, b), bonds.length(here, b));
                let factor = ellipsoid([&tensors[here], &tensors[b]], xi);
                let weight = factor * self.weight(xi, r) * bonds.volume_factor(here, b);
                add(
                    &mut sums,
                    weight * bonds.volume(b),
                    self.energies(&own.axes, xi, r),
                );
            }
            // Points without bonds keep their factors.
            std::array::from_fn(|c| match sums[c] {
                sum if sum > 0.0 => own.factors[c] * own.interior[c] / sum,
                _ => own.factors[c],
            })
        });
        for (point, factors) in points.iter_mut().zip(improved) {
            point.factors = factors;
        }
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
