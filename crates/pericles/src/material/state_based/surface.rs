//! Correction of the deviatoric stiffness of points near a surface.

use super::classes::SolidClasses;
use crate::family::BondList;
use crate::kernel::Influence;
use crate::material::lattice::{Cells, for_each_offset};
use crate::material::surface_correction::{
    Directions, SurfaceFactors, axes_of, ellipsoid, tensors_of_sites,
};
use crate::parallel::for_each_point;
use crate::space::PointCloud;

/// What is kept the same near surfaces as inside a body of state-based material.
///
/// The dilatation of a uniform strain is exact at every point, for the weighted volume m shrinks with the family; so is the energy of the dilatation. The deviatoric part is not: families that are cut off are
/// too stiff in some directions and too soft in others, by some per cent in all.
///
/// The volume method of bond-based materials ([`SurfaceCorrection::Volume`](crate::material::SurfaceCorrection)) does not apply: m accounts for the missing volume already, and bodies would be 6 to 15 %
/// too stiff.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SolidSurface {
    /// Bodies are up to a few per cent too stiff.
    #[default]
    None,
    /// A factor g of each bond, with which the energy of its extension, B/(2 m) Σ g ω e², is at every point that of the interior for uniaxial tension along each of three directions: a strain of 1 along
    /// and of −ν across it, with the solid's own contraction ν in the body's dimensions, (κ − G)/(κ + G) in the plane.
    ///
    /// g = 1/|G⁻¹ n| for a bond along n, with the mean G of tensors at both ends that have the factors g_c along the principal axes c of Σ ω r² n⊗n, as for bond-based materials (Madenci & Oterkus,
    /// Peridynamic Theory and Its Applications, 2014, chapter 4), iterated three times from g = 1. The factor is part of the energy, not of the forces alone, so that the balance of energy stays exact.
    /// Inside a body it is 1. Bonds that pre-cracks cut count as there: cracks are not corrected.
    Energy,
}

/// Passes from g = 1; see [`SurfaceCorrection::Energy`](crate::material::SurfaceCorrection::Energy).
const PASSES: usize = 3;

impl SolidSurface {
    /// The factors of a body.
    pub(crate) fn factors(
        self,
        bonds: &BondList,
        influence: &Influence,
        classes: &SolidClasses,
    ) -> SurfaceFactors {
        match self {
            Self::None => SurfaceFactors::None,
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

/// What factors are found for.
struct Body<'a> {
    cloud: &'a PointCloud,
    bonds: &'a BondList,
    influence: &'a Influence,
    classes: &'a SolidClasses,
}

/// The squared stretch of a bond under uniaxial tension along each axis.
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
    /// The strain across a uniaxial tension over that along it, with the sign changed.
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

    /// The directions of every point with the factors 1, and what is to be reached: the mean squared stretch of an interior point, weighted by ω r².
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
            // The mean over all directions, where there is no lattice: n² and n⁴ have the means 1/D and 3/(D (D + 2)).
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

    /// ω r² of the bond between two sites.
    fn weight(&self, a: usize, b: usize, xi: [f64; 3]) -> f64 {
        let influence = self.influence.alpha_of(xi, self.bonds.horizon());
        let volume = self.bonds.volume_factor(a, b) * self.bonds.volume(b);
        influence * volume * square(xi)
    }

    /// The principal axes of a family; those of the coordinates where they are principal.
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

    /// Takes factors under which the energies of corrected bonds are nearer those of the interior.
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
            // A point without bonds, or without bonds along an axis, has nothing to be corrected there.
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
