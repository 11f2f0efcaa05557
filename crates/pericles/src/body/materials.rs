//! Bodies of several materials.

use super::Body;
use crate::error::{PericlesError, Result};
use crate::material::{BondConstants, PairClasses, StressState};
use crate::scalar::PointScalar;
use crate::space::check_points;

/// What several materials make of a body.
pub(super) struct Mixture {
    /// The materials by point; none where there is one only.
    pub classes: Option<PairClasses>,
    /// Mass densities, kg/m³.
    pub density: PointScalar,
}

impl Body {
    /// The constants of all bonds and the densities of all points; `first` are the constants of the first material.
    pub(super) fn mixture(&self, first: &BondConstants, state: StressState) -> Result<Mixture> {
        /// Numbers of materials are bytes.
        const MOST: usize = 255;
        if self.others.is_empty() {
            return Ok(Mixture {
                classes: None,
                density: PointScalar::Uniform(self.material.density),
            });
        }
        if self.others.len() > MOST {
            return Err(PericlesError::OutOfRange {
                quantity: "the number of materials beside the first",
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
                    what: "a material of some points",
                    reason: "its pair law, horizon, influence function and volume correction must be those of the first material",
                });
            }
            constants.push(material.constants(&self.cloud, state)?);
            for &i in points {
                number_of[i as usize] = number;
                density[i as usize] = material.density;
            }
        }
        Ok(Mixture {
            classes: Some(PairClasses::new(number_of, &constants, self.interface)?),
            density: PointScalar::PerPoint(density),
        })
    }
}
