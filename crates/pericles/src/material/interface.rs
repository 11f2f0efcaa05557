//! Interfaces between bond-based materials: the constant and the critical stretch of the bonds across.

use super::bond_material::{BondMaterial, Fracture, Modulus};
use super::composite::{InterfaceRule, PairClasses};
use super::constants::BondConstants;
use super::modulus::ElasticModulus;
use crate::error::Result;

/// What the constant c of bonds between two materials follows from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum InterfaceStiffness {
    /// The constants of both materials.
    Rule(InterfaceRule),
    /// An elastic modulus of the interface, as a material's constant does.
    Modulus(Modulus),
}

impl Default for InterfaceStiffness {
    fn default() -> Self {
        Self::Rule(InterfaceRule::default())
    }
}

/// The bonds between two materials.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MaterialInterface {
    /// What their constant follows from.
    pub stiffness: InterfaceStiffness,
    /// When they break; none for the smaller of the two critical stretches.
    ///
    /// A fracture energy is calibrated as that of a material with the constant c of these bonds: a crack between two half-spaces of the materials breaks no other bonds.
    pub fracture: Option<Fracture>,
}

impl PairClasses {
    /// Gives bonds between two materials the constants of an interface. `material` is the material of the first number, and `constants` finds the constants that a material has on the body.
    ///
    /// # Errors
    /// A number that is not one of the materials given; what `constants` refuses.
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
    /// The same modulus times a factor.
    fn scaled(self, factor: f64) -> Self {
        let value = match self.value {
            ElasticModulus::Young(value) => ElasticModulus::Young(factor * value),
            ElasticModulus::Bulk(value) => ElasticModulus::Bulk(factor * value),
            ElasticModulus::Shear(value) => ElasticModulus::Shear(factor * value),
        };
        Self { value, ..self }
    }
}
