//! Interfaces between bond-based materials: constant and critical stretch of bonds across the interface.

use super::bond_material::{BondMaterial, Fracture, Modulus};
use super::composite::{InterfaceRule, MaterialPairs};
use super::constants::BondConstants;
use super::modulus::ElasticModulus;
use crate::error::Result;

/// Source of the constant c of bonds between two materials.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InterfaceStiffness {
    /// A rule that mixes the constants of both materials.
    Rule(InterfaceRule),
    /// An elastic modulus of the interface, calibrated like that of a material.
    Modulus(Modulus),
}

impl Default for InterfaceStiffness {
    fn default() -> Self {
        Self::Rule(InterfaceRule::default())
    }
}

/// Properties of the bonds between two materials.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MaterialInterface {
    /// Stiffness of the bonds.
    pub stiffness: InterfaceStiffness,
    /// Failure criterion; `None` for the smaller of both critical stretches.
    ///
    /// A fracture energy is calibrated as for a material with the constant c of these bonds, because a crack
    /// along the interface of two half-spaces breaks only such bonds.
    pub fracture: Option<Fracture>,
}

impl MaterialPairs {
    /// Sets the constants of bonds between two materials. `material` is the first material of the pair;
    /// `constants` returns the constants of a material on the body.
    ///
    /// # Errors
    /// A material number out of range; errors of `constants`.
    pub fn set_interface(
        &mut self,
        pair: [u8; 2],
        interface: &MaterialInterface,
        material: &BondMaterial,
        constants: impl Fn(&BondMaterial) -> Result<BondConstants>,
    ) -> Result<()> {
        self.check_pair(pair)?;
        let [first, second] = pair.map(|number| self.pair_micromodulus([number; 2]));
        let micromodulus = match interface.stiffness {
            InterfaceStiffness::Rule(rule) => rule.mix([first, second]),
            InterfaceStiffness::Modulus(modulus) => {
                let across = BondMaterial {
                    modulus,
                    fracture: Fracture::Unbreakable,
                    ..material.clone()
                };
                constants(&across)?.micromodulus
            }
        };
        self.set_micromodulus(pair, micromodulus)?;
        let Some(fracture) = interface.fracture else {
            return Ok(());
        };
        let stretch = match fracture {
            Fracture::Unbreakable => f64::INFINITY,
            Fracture::CriticalStretch(stretch) => stretch,
            Fracture::Energy { .. } => {
                // c is proportional to the modulus.
                let across = BondMaterial {
                    modulus: material.modulus.scaled(micromodulus / first),
                    fracture,
                    ..material.clone()
                };
                constants(&across)?.critical_stretch
            }
        };
        self.set_critical_stretch(pair, stretch)
    }
}

impl Modulus {
    /// Multiplies the modulus by a factor.
    fn scaled(self, factor: f64) -> Self {
        let value = match self.value {
            ElasticModulus::Young(value) => ElasticModulus::Young(factor * value),
            ElasticModulus::Bulk(value) => ElasticModulus::Bulk(factor * value),
            ElasticModulus::Shear(value) => ElasticModulus::Shear(factor * value),
        };
        Self { value, ..self }
    }
}
