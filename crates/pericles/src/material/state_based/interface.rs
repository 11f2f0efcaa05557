//! Interfaces between state-based materials: failure limits of bonds across the interface.

use super::elastic::GivenConstants;
use super::failure::{BondFailure, BondLimits};
use super::linear_solid::LinearSolid;
use crate::error::Result;
use crate::material::StressState;
use crate::space::PointCloud;

impl LinearSolid {
    /// Returns the limits of bonds between this material and another one, for a failure criterion of the interface.
    ///
    /// Each end point of a bond has the force state of its own material. The fracture energy is linear in the
    /// constants A and B ([`LinearSolidConstants`](super::LinearSolidConstants)), and each side of the
    /// interface contributes half of it. A crack between two half-spaces therefore takes the energy of a
    /// crack in a solid with the mean A and the mean B, whose limits are returned. Horizon, influence
    /// function and partial volumes belong to this material.
    ///
    /// # Errors
    /// The errors of [`LinearSolid::constants`].
    pub fn limits_towards(
        &self,
        other: &Self,
        failure: BondFailure,
        cloud: &PointCloud,
        state: StressState,
    ) -> Result<BondLimits> {
        let across = Self {
            elastic: self.mean_elastic(other, state)?,
            failure,
            ..self.clone()
        };
        Ok(across.constants(cloud, state)?.limits)
    }

    /// Returns the elastic constants of the solid with the mean A and the mean B of both materials.
    fn mean_elastic(&self, other: &Self, state: StressState) -> Result<GivenConstants> {
        let [a, b] = [self.elastic.resolve(state)?, other.elastic.resolve(state)?];
        let mean = |a: f64, b: f64| 0.5 * (a + b);
        let kappa = mean(a.dilatation_modulus(state), b.dilatation_modulus(state));
        if state == StressState::Uniaxial {
            return Ok(GivenConstants {
                young: Some(kappa),
                ..GivenConstants::default()
            });
        }
        // A and B are linear in the dilatation modulus κ and the shear modulus G.
        let shear = mean(a.shear(), b.shear());
        let bulk = match state {
            StressState::PlaneStress => 4.0 * shear * kappa / (9.0 * shear - 3.0 * kappa),
            StressState::PlaneStrain => kappa - shear / 3.0,
            StressState::Uniaxial | StressState::Spatial => kappa,
        };
        Ok(GivenConstants {
            bulk: Some(bulk),
            shear: Some(shear),
            ..GivenConstants::default()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::family::VolumeCorrection;
    use crate::kernel::InfluenceFunction;
    use crate::material::{FractureCalibration, StateInfluence, StretchDefinition};
    use crate::space::{Grid, Shape};

    fn solid(young: f64, ratio: f64) -> LinearSolid {
        LinearSolid {
            density: 1.0,
            elastic: GivenConstants {
                young: Some(young),
                poisson_ratio: Some(ratio),
                ..GivenConstants::default()
            },
            horizon: 3.0,
            influence: StateInfluence::Function(InfluenceFunction::Conical),
            volume_correction: VolumeCorrection::None,
            failure: BondFailure::Unbreakable,
        }
    }

    /// The energy of an interface crack at a given critical stretch is the mean of the energies in both materials.
    #[test]
    fn interface_fracture_energy_is_the_mean_of_both_solids() {
        for (state, dimension) in [
            (StressState::PlaneStress, 2),
            (StressState::PlaneStrain, 2),
            (StressState::Spatial, 3),
        ] {
            let cloud = Grid {
                shape: Shape::Box {
                    origin: [0.0; 3],
                    size: vec![8.0; dimension],
                },
                spacing: 1.0,
                section: 1.0,
                holes: vec![],
            };
            let cloud = cloud.points().unwrap();
            let failure = BondFailure::Stretch {
                fracture_energy: 1.0,
                definition: StretchDefinition::Closing,
                calibration: FractureCalibration::Lattice,
            };
            // 1/s₀² is the crack energy at unit stretch over the fracture energy.
            let per_stretch = |limits: BondLimits| 1.0 / (limits.stretch * limits.stretch);
            let own = |solid: &LinearSolid| {
                let solid = LinearSolid {
                    failure,
                    ..solid.clone()
                };
                per_stretch(solid.constants(&cloud, state).unwrap().limits)
            };
            let (soft, hard) = (solid(1.0, 0.4), solid(7.0, 0.1));
            let between = soft.limits_towards(&hard, failure, &cloud, state).unwrap();
            let mean = 0.5 * (own(&soft) + own(&hard));
            assert!(
                (per_stretch(between) / mean - 1.0).abs() < 1e-12,
                "{state:?}"
            );
            let alike = soft.limits_towards(&soft, failure, &cloud, state).unwrap();
            assert!((per_stretch(alike) / own(&soft) - 1.0).abs() < 1e-12);
        }
    }
}
