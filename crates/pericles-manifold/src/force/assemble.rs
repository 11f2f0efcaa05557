//! Assembles the force operator of a surface.

use std::sync::Arc;

use super::bonds::Extra;
use super::{
    AnyExponent, ChordBond, DisplacementBond, Exponent, HalfInteger, SurfaceBonds, SurfaceForce,
    SurfaceLaw,
};
use crate::geodesic::GeodesicPairs;
use crate::surface::Surface;
use crate::{PowerMaterial, SurfaceBond};
use pericles::Result;
use pericles::operator::Force;
use pericles::space::PointCloud;

/// Input of the force operator of a surface of one material.
#[derive(Debug, Clone, Copy)]
pub struct SurfaceBody<'a> {
    /// The surface.
    pub surface: &'a Surface,
    /// Its vertices as points; the volumes are vertex areas.
    pub cloud: &'a Arc<PointCloud>,
    /// The bonds: pairs of vertices with their distances.
    pub pairs: &'a GeodesicPairs,
    /// The material.
    pub material: &'a PowerMaterial,
    /// Stiffness factor of each point, κ over the material's κ; empty means 1 everywhere. A bond uses the mean
    /// of its two ends.
    pub stiffness: &'a [f64],
    /// Points whose bonds never break.
    pub no_fail: &'a [u32],
}

impl SurfaceBody<'_> {
    /// Assembles the force operator.
    ///
    /// # Errors
    /// As [`PowerMaterial::check`].
    pub fn operator(&self) -> Result<Box<dyn Force>> {
        self.material.check()?;
        Ok(match self.material.p {
            2.0 => self.with_exponent(HalfInteger::<0, 0>),
            2.5 => self.with_exponent(HalfInteger::<1, 0>),
            3.0 => self.with_exponent(HalfInteger::<2, 0>),
            3.5 => self.with_exponent(HalfInteger::<3, 0>),
            4.0 => self.with_exponent(HalfInteger::<0, 1>),
            4.5 => self.with_exponent(HalfInteger::<1, 1>),
            5.0 => self.with_exponent(HalfInteger::<2, 1>),
            5.5 => self.with_exponent(HalfInteger::<3, 1>),
            p => self.with_exponent(AnyExponent(p)),
        })
    }

    fn with_exponent<E: Exponent>(&self, exponent: E) -> Box<dyn Force> {
        match self.material.bond {
            SurfaceBond::Displacement => Box::new(self.force(DisplacementBond(exponent))),
            SurfaceBond::Chord => Box::new(self.force(ChordBond(exponent))),
        }
    }

    /// Assembles the operator for a given law; [`SurfaceBody::operator`] chooses the law from the material.
    pub fn force<L: SurfaceLaw>(&self, law: L) -> SurfaceForce<L> {
        let areas = self.cloud.volumes();
        let mean = |i: usize, j: usize| match self.stiffness {
            [] => 1.0,
            stiffness => 0.5 * (stiffness[i] + stiffness[j]),
        };
        let factor = |i: usize, j: usize, d: f64| mean(i, j) * self.material.weight(d) * areas[j];
        let bonds = SurfaceBonds::new(self.pairs, factor, self.self_interactions(&mean));
        let limits = self
            .material
            .critical_stretch
            .is_finite()
            .then(|| self.limits(&bonds));
        SurfaceForce::new(law, Arc::clone(self.cloud), bonds, limits)
    }

    /// Self-interaction term ½ (c_i + c_j) w_ij / A_i of every edge, with cotangent weights w: its energy is
    /// the Dirichlet integral.
    fn self_interactions(&self, mean: &impl Fn(usize, usize) -> f64) -> Vec<Extra> {
        if !self.material.self_interaction {
            return Vec::new();
        }
        let areas = self.cloud.volumes();
        let c = |i: u32| self.material.self_interaction_stiffness(areas[i as usize]);
        let cotangents = self.surface.cotangents();
        let mut extra = Vec::with_capacity(2 * cotangents.edges.len());
        for (&[i, j], weight) in cotangents.edges.iter().zip(&cotangents.weights) {
            let weight = mean(i as usize, j as usize) * 0.5 * (c(i) + c(j)) * weight;
            extra.push((i, j, weight / areas[i as usize]));
            extra.push((j, i, weight / areas[j as usize]));
        }
        extra
    }

    /// Breaking limit (s d)² of every entry, s being the critical stretch; infinite where bonds cannot break.
    fn limits(&self, bonds: &SurfaceBonds) -> Vec<f64> {
        let mut held = vec![false; self.cloud.len()];
        for &i in self.no_fail {
            held[i as usize] = true;
        }
        let mut limits = vec![f64::INFINITY; bonds.weights().len()];
        for i in (0..held.len()).filter(|&i| !held[i]) {
            for (entry, j) in bonds.row(i).filter(|&(_, j)| !held[j]) {
                if let Some(distance) = self.pairs.between(i, j) {
                    limits[entry] = (self.material.critical_stretch * distance).powi(2);
                }
            }
        }
        limits
    }
}
