//! Bodies of several materials.

use super::Body;
use crate::error::{PericlesError, Result};
use crate::material::{BondConstants, MaterialPairs, StressState};
use crate::scalar::PointScalar;
use crate::space::check_points;

/// The materials of a body.
pub(super) struct Mixture {
    /// Material of each point; `None` for a single material.
    pub classes: Option<MaterialPairs>,
    /// Mass densities, kg/m³.
    pub density: PointScalar,
}

impl Body {
    /// Returns the constants of all bonds and the densities of all points; `first` are the constants of the first
    /// material.
    pub(super) fn mixture(&self, first: &BondConstants, state: StressState) -> Result<Mixture> {
        /// Material numbers are bytes.
        const MOST: usize = 255;
        if self.others.is_empty() {
            return Ok(Mixture {
                classes: None,
                density: PointScalar::Uniform(self.material.density),
            });
        }
        if self.others.len() > MOST {
            return Err(PericlesError::OutOfRange {
                quantity: "the number of materials after the first",
                value: self.others.len() as f64,
                allowed: "at most 255",
            });
        }
        let n = self.cloud.len();
        let (mut number_of, mut constants) = (vec![0; n], vec![first.clone()]);
        let mut density = vec![self.material.density; n];
        for (number, (points, material)) in (1..=u8::MAX).zip(&self.others) {
            check_points("the points of a material", points, n)?;
            let same = (material.law, material.horizon, material.volume_correction)
                == (
                    self.material.law,
                    self.material.horizon,
                    self.material.volume_correction,
                )
                && material.influence == self.material.influence;
            if !same {
                return Err(PericlesError::BadSet {
                    what: "a further material of the body",
                    reason: "its pair law, horizon, influence function and volume correction must equal those of the first material",
                });
            }
            constants.push(material.constants(&self.cloud, state)?);
            for &i in points {
                number_of[i as usize] = number;
                density[i as usize] = material.density;
            }
        }
        Ok(Mixture {
            classes: Some(MaterialPairs::new(number_of, &constants, self.interface)?),
            density: PointScalar::PerPoint(density),
        })
    }
}
