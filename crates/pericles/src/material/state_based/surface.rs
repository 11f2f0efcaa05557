//! Surface correction of the deviatoric stiffness of state-based solids.

use super::materials::{Materials, StateConstants};
use crate::family::BondList;
use crate::kernel::Influence;
use crate::material::lattice::{Cells, for_each_offset};
use crate::material::surface_correction::{
    Directions, SurfaceFactors, axes_of, ellipsoid, tensors_of_sites,
};
use crate::parallel::for_each_point;
use crate::space::PointCloud;

/// Method of surface correction of a state-based material, by the quantity that points near a surface share
/// with interior points.
///
/// The dilatation of a uniform strain and its energy are exact at every point, because the weighted volume m
/// accounts for the incomplete family. The deviatoric part is not exact: incomplete families are too stiff in
/// some directions and too soft in others, by a few per cent.
///
/// The volume method of bond-based materials
/// ([`SurfaceCorrection::Volume`](crate::material::SurfaceCorrection)) does not apply: m already accounts for
/// the missing volume, and bodies would be 6 to 15 % too stiff.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SolidSurface {
    /// No correction: bodies are up to a few per cent too stiff.
    #[default]
    None,
    /// A factor g of each bond such that the energy of extensions, B/(2 m) Σ g ω e², equals that of an
    /// interior point for uniaxial tension along each of three directions. The strain is 1 along the
    /// direction and −ν in the others, where ν is the transverse contraction of the solid in the dimension of
    /// the body, in the plane (κ − G)/(κ + G).
    ///
    /// g = 1/|G⁻¹ n| for a bond along n, where G is the mean of tensors at both end points with the factors
    /// g_c along the principal axes c of Σ ω r² n⊗n, as for bond-based materials (Madenci & Oterkus,
    /// Peridynamic Theory and Its Applications, 2014, chapter 4), iterated three times from g = 1. The factor
    /// is part of the energy, not only of the forces, so that the energy balance remains exact. In the
    /// interior it is 1. Bonds cut by pre-cracks are counted as present: crack faces are not corrected.
    Energy,
    /// Families completed by ghost points in free cells of the lattice, with displacements extrapolated from
    /// the body; forces are the exact gradient of the energy of the body
    /// ([`GhostForce`](crate::operator::GhostForce)). For outer surfaces without fracture: bonds cannot
    /// break, and pre-cracks are not corrected.
    Ghosts,
}

/// Number of passes from g = 1; see [`SurfaceCorrection::Energy`](crate::material::SurfaceCorrection::Energy).
const PASSES: usize = 3;

impl SolidSurface {
    /// Returns the factors of a body.
    pub(crate) fn factors(
        self,
        bonds: &BondList,
        influence: &Influence,
        classes: &Materials<StateConstants>,
    ) -> SurfaceFactors {
        match self {
            // Ghosts are points, not factors.
            Self::None | Self::Ghosts => SurfaceFactors::None,
            Self::Energy => {
                let body = Body {
                    cloud: bonds.sites().cloud(),
                    bonds,
                    influence,
                    classes,
                };
                let mut points = body.uncorrected();
                for _ in 0..PASSES {
                    body.improve(&mut points);
                }
                SurfaceFactors::Directional(tensors_of_sites(bonds, &points))
            }
        }
    }
}

/// The body whose factors are computed.
struct Body<'a> {
    cloud: &'a PointCloud,
    bonds: &'a BondList,
    influence: &'a Influence,
    classes: &'a Materials<StateConstants>,
}

/// Returns the squared stretch of a bond under uniaxial tension along each axis.
fn stretches(axes: &[[f64; 3]; 3], contraction: f64, xi: [f64; 3]) -> [f64; 3] {
    axes.map(|axis| {
        let along = axis[0] * xi[0] + axis[1] * xi[1] + axis[2] * xi[2];
        let square = along * along / square(xi);
        (square - contraction * (1.0 - square)).powi(2)
    })
}

fn square(xi: [f64; 3]) -> f64 {
    xi.iter().map(|x| x * x).sum()
}

impl Body<'_> {
    /// Returns the transverse contraction ν of a point under uniaxial tension.
    fn contraction(&self, i: usize) -> f64 {
        let dimension = self.cloud.dimension() as f64;
        let [dilatational, deviatoric] = self.classes.constants(self.bonds.site(i));
        let shear = deviatoric / (dimension * (dimension + 2.0));
        let kappa = (dilatational + (dimension + 2.0) * shear) / dimension;
        match self.cloud.dimension() {
            1 => 0.0,
            2 => (kappa - shear) / (kappa + shear),
            _ => (3.0 * kappa - 2.0 * shear) / (2.0 * (3.0 * kappa + shear)),
        }
    }

    /// Returns the directions of every point with the factors 1 and the target values: the mean squared
    /// stretch of an interior point, weighted by ω r².
    fn uncorrected(&self) -> Vec<Directions> {
        let dimension = self.cloud.dimension() as f64;
        let horizon = self.bonds.horizon();
        let mut family = Vec::new();
        let mut whole = 0.0;
        if let Some(sides) = self.cloud.cell_sides() {
            let (cells, correction) = (Cells::new(sides), self.bonds.correction());
            for_each_offset(cells, horizon, correction, |_, xi, r| {
                let factor = correction.factor(r, horizon, cells.size());
                let weight = factor * self.influence.alpha_of(xi, horizon) * r * r;
                whole += weight;
                family.push((weight, xi));
            });
        }
        for_each_point(self.cloud.len(), &|i| {
            let axes = self.axes(i);
            let nu = self.contraction(i);
            // Without a lattice, the mean over all directions: n² and n⁴ have the means 1/D and 3/(D (D + 2)).
            let (second, fourth) = (1.0 / dimension, 3.0 / (dimension * (dimension + 2.0)));
            let mean = (1.0 + nu).powi(2) * fourth - 2.0 * nu * (1.0 + nu) * second + nu * nu;
            let mut interior = [mean; 3];
            if whole > 0.0 {
                interior = [0.0; 3];
                for &(weight, xi) in &family {
                    let terms = stretches(&axes, nu, xi);
                    (0..3).for_each(|c| interior[c] += weight / whole * terms[c]);
                }
            }
            Directions {
                axes,
                interior,
                factors: [1.0; 3],
            }
        })
    }

    /// Returns ω r² of the bond between two sites, times its volume.
    fn weight(&self, a: usize, b: usize, xi: [f64; 3]) -> f64 {
        let influence = self.influence.alpha_of(xi, self.bonds.horizon());
        let volume = self.bonds.volume_factor(a, b) * self.bonds.volume(b);
        influence * volume * square(xi)
    }

    /// Returns the principal axes of a family; the coordinate axes if they are principal.
    fn axes(&self, i: usize) -> [[f64; 3]; 3] {
        let mut moment = [[0.0; 3]; 3];
        let here = self.bonds.site(i);
        for (_, b) in self.bonds.family(i) {
            let xi = self.bonds.vector(here, b);
            let weight = self.weight(here, b, xi) / square(xi);
            for (row, a) in moment.iter_mut().zip(xi) {
                for (entry, b) in row.iter_mut().zip(xi) {
                    *entry += weight * a * b;
                }
            }
        }
        axes_of(moment)
    }

    /// Performs one pass of the iteration of the factors.
    fn improve(&self, points: &mut [Directions]) {
        let tensors = tensors_of_sites(self.bonds, points);
        let improved: Vec<[f64; 3]> = for_each_point(points.len(), &|i| {
            let (own, here) = (&points[i], self.bonds.site(i));
            let nu = self.contraction(i);
            let (mut whole, mut sums) = (0.0, [0.0; 3]);
            for (_, b) in self.bonds.family(i) {
                let xi = self.bonds.vector(here, b);
                let weight = self.weight(here, b, xi);
                whole += weight;
                let factor = ellipsoid([&tensors[here], &tensors[b]], xi);
                let terms = stretches(&own.axes, nu, xi);
                (0..3).for_each(|c| sums[c] += factor * weight * terms[c]);
            }
            // Points without bonds along an axis keep their factors.
            std::array::from_fn(|c| match sums[c] {
                sum if sum > 1e-6 * whole => own.factors[c] * own.interior[c] * whole / sum,
                _ => own.factors[c],
            })
        });
        for (point, factors) in points.iter_mut().zip(improved) {
            point.factors = factors;
        }
    }
}
