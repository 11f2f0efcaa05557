//! Corrections for the bonds that points near a surface lack.

use rayon::prelude::*;

use super::BondMaterial;
use crate::family::BondList;
use crate::parallel::BLOCK;
use crate::space::PointCloud;

/// What is kept the same near surfaces as inside the body.
///
/// Each point i has a factor g_i, and a bond is multiplied by the mean ½(g_i + g_j), so that both ends exert the same force. Inside a body on a grid g = 1 to
/// round-off: the reference is the family of a grid's interior, of the cloud's spacing. Bonds that pre-cracks cut count as there: cracks are
/// not corrected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum SurfaceCorrection {
    /// g = 1: bodies are softer within a horizon of their surface.
    #[default]
    None,
    /// g_i = V₀/V_i with the volume V = Σ_j κ V_j of a family and of the point itself (Le & Bobaru, Comput. Mech. 61, 499, 2018).
    Volume,
    /// g_i = W₀/W_i with the energy density of uniform dilation, W ∝ Σ_j κ α |ξ| V_j (Macek & Silling 2007; Madenci & Oterkus 2014, without its dependence on
    /// direction).
    Energy,
}

impl SurfaceCorrection {
    /// The factor of each point; empty if there is no correction.
    pub fn factors(
        self,
        cloud: &PointCloud,
        bonds: &BondList,
        material: &BondMaterial,
    ) -> Vec<f64> {
        if self == Self::None {
            return Vec::new();
        }
        let weight = |xi: [f64; 3], r: f64| match self {
            Self::Energy => material.influence.alpha_of(xi, material.horizon) * r,
            _ => 1.0,
        };
        // The point itself has volume, and no energy.
        let own = f64::from(u8::from(self == Self::Volume));
        let (dimension, spacing) = (cloud.dimension(), cloud.spacing());
        let mut interior = own;
        material.for_each_offset(dimension, spacing, |_, xi, r| {
            interior += material
                .volume_correction
                .factor(r, material.horizon, spacing)
                * weight(xi, r);
        });
        interior *= cloud.section() * spacing.powi(dimension as i32);
        let volumes = cloud.volumes();
        (0..cloud.len())
            .into_par_iter()
            .with_min_len(BLOCK)
            .map(|i| {
                let family = bonds.family(i).map(|(_, j)| {
                    let xi = bonds.vector(cloud, i, j);
                    let r = bonds.length(cloud, i, j);
                    bonds.volume_factor(cloud, i, j) * weight(xi, r) * volumes[j]
                });
                let sum = own * volumes[i] + family.sum::<f64>();
                // A point without bonds has nothing to be corrected.
                if sum > 0.0 { interior / sum } else { 1.0 }
            })
            .collect()
    }
}
