//! Bonds of a point by direction, and their stress in a homogeneous deformation.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

use crate::material::lattice::Cells;
use crate::material::{BondMaterial, StressState};

/// A symmetric tensor that loads or relaxes a body.
pub(super) type Tensor = [[f64; 3]; 3];

/// The bonds of a point by direction n, each with its share w of the stiffness: the stress of a homogeneous deformation
/// is σ = E Σ w g(n·ε n) n ⊗ n.
///
/// The stretch of a bond does not depend on its length, so that bonds of one direction are added up. Opposite
/// directions count as one.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Fan(Vec<Spoke>);

/// A direction with its share of the stiffness.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Spoke {
    direction: [f64; 3],
    weight: f64,
}

impl Fan {
    /// Returns the bonds of a lattice point: w = ½ c A V Σ κ α |ξ|/E over the bonds of a direction, with the cell volume
    /// A V (section and sides). `stiffness` is c times the section over E.
    pub fn of_lattice(material: &BondMaterial, cells: Cells<'_>, stiffness: f64) -> Self {
        let mut weights: BTreeMap<[i32; 3], f64> = BTreeMap::new();
        let size = cells.size();
        material.for_each_offset(cells, |offset, xi, r| {
            let kappa = material.volume_correction.factor(r, material.horizon, size);
            let weight = kappa * material.influence.alpha_of(xi, material.horizon) * r;
            *weights.entry(primitive(offset)).or_default() += weight;
        });
        let factor = 0.5 * stiffness * cells.volume();
        let spokes = weights.into_iter().map(|(offset, weight)| {
            let sides = cells.sides();
            let along: [f64; 3] =
                std::array::from_fn(|c| f64::from(offset[c]) * sides.get(c).unwrap_or(&0.0));
            Spoke {
                direction: normalised(along),
                weight: factor * weight,
            }
        });
        Self(spokes.collect())
    }

    /// Returns the bonds of the continuum for deformations that are symmetric about the axes and, in three dimensions,
    /// about the first axis: σ = N ⟨g n ⊗ n⟩ with the mean over all directions and N = E in a bar, 3E in plane stress,
    /// 3.2E in plane strain and 6E in three dimensions. `ratio` is the modulus of the bonds over E.
    ///
    /// In three dimensions the directions lie in the plane of the first two axes, so that the sum of the second and third
    /// normal stress stands for both.
    pub fn axial(state: StressState, ratio: f64) -> Self {
        /// Even, for Simpson's rule.
        const NODES: usize = 720;
        let (factor, nodes) = (ratio * factor(state), NODES as f64);
        let spoke = |direction, weight| Spoke { direction, weight };
        let spokes: Vec<Spoke> = match state {
            StressState::Uniaxial => vec![spoke([1.0, 0.0, 0.0], factor)],
            // Trapezoidal rule in the angle, exact for the elastic stiffness.
            StressState::PlaneStress | StressState::PlaneStrain => (0..=NODES)
                .map(|k| {
                    let (sin, cos) = (FRAC_PI_2 * k as f64 / nodes).sin_cos();
                    let end = if k == 0 || k == NODES { 0.5 } else { 1.0 };
                    spoke([cos, sin, 0.0], factor * end / nodes)
                })
                .collect(),
            StressState::Spatial => (0..=NODES)
                .map(|k| {
                    let (sin, cos) = (FRAC_PI_2 * k as f64 / nodes).sin_cos();
                    spoke([cos, sin, 0.0], factor * polar(k, NODES))
                })
                .collect(),
        };
        Self(spokes)
    }

    /// Returns the bonds of the continuum for deformations that are symmetric about the three planes of the axes.
    pub fn orthotropic(state: StressState, ratio: f64) -> Self {
        const POLAR: usize = 120;
        const AROUND: usize = 90;
        if state != StressState::Spatial {
            return Self::axial(state, ratio);
        }
        let factor = ratio * factor(state);
        let spokes = (0..=POLAR).flat_map(|k| {
            let (sin, cos) = (FRAC_PI_2 * k as f64 / POLAR as f64).sin_cos();
            (0..=AROUND).map(move |m| {
                let (across, along) = (FRAC_PI_2 * m as f64 / AROUND as f64).sin_cos();
                let end = if m == 0 || m == AROUND { 0.5 } else { 1.0 };
                Spoke {
                    direction: [sin * along, sin * across, cos],
                    weight: factor * polar(k, POLAR) * end / AROUND as f64,
                }
            })
        });
        Self(spokes.collect())
    }

    /// Returns the share of each direction and the projections n·M n of it on tensors M, direction by direction.
    pub fn projected(&self, tensors: &[Tensor]) -> (Vec<f64>, Vec<f64>) {
        let weights = self.0.iter().map(|spoke| spoke.weight).collect();
        let projections = self.0.iter().flat_map(|spoke| {
            let n = spoke.direction;
            tensors.iter().map(move |tensor| {
                let rows = (0..3).map(|a| (0..3).map(|b| n[a] * tensor[a][b] * n[b]).sum::<f64>());
                rows.sum()
            })
        });
        (weights, projections.collect())
    }
}

/// Returns N/E: the stress of all bonds with the stretch 1 in the mean over directions, for a material with the modulus E.
fn factor(state: StressState) -> f64 {
    match state {
        StressState::Uniaxial => 1.0,
        StressState::PlaneStress => 3.0,
        StressState::PlaneStrain => 3.2,
        StressState::Spatial => 6.0,
    }
}

/// Returns the share of the directions at node k of the angle from an axis: Simpson's rule for ∫ sin θ dθ over a quarter
/// of a circle with an even number of intervals.
fn polar(k: usize, intervals: usize) -> f64 {
    let step = FRAC_PI_2 / intervals as f64;
    let weight = match k {
        _ if k == 0 || k == intervals => 1.0,
        _ if k % 2 == 1 => 4.0,
        _ => 2.0,
    };
    weight * step / 3.0 * (step * k as f64).sin()
}

/// Returns the shortest lattice vector along an offset or against it; opposite offsets have the same one.
fn primitive(offset: [i32; 3]) -> [i32; 3] {
    let gcd = offset.into_iter().fold(0, gcd);
    let first = offset.into_iter().find(|steps| *steps != 0);
    let sign = first.map_or(1, i32::signum);
    offset.map(|steps| sign * steps / gcd.max(1))
}

fn gcd(a: i32, b: i32) -> i32 {
    match b {
        0 => a.abs(),
        _ => gcd(b, a % b),
    }
}

/// Returns a vector over its length.
pub(super) fn normalised(vector: [f64; 3]) -> [f64; 3] {
    let length = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    vector.map(|x| x / length)
}
