//! Bodies of several state-based materials.

use super::failure::BondLimits;
use super::linear_solid::LinearSolidConstants;
use crate::error::{PericlesError, Result};
use crate::material::{Factors, check_materials};
use crate::space::Sites;

/// The material of every point, and what bonds between each pair of materials can bear.
///
/// The force state of a point has the constants of the point's own material: there is nothing to average at an interface. Horizon and influence function are those of the body, so that both ends of a bond
/// see the same bond. A bond between two materials bears what the weaker of them does, unless [`SolidClasses::set_limits`] says otherwise.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidClasses {
    /// Empty if there is one material.
    of_point: Vec<u8>,
    /// A and B, Pa, by material.
    constants: Vec<[f64; 2]>,
    /// By pairs of materials.
    limits: Vec<BondLimits>,
    /// Factors of the critical stretch by points.
    strength: Factors,
}

impl SolidClasses {
    /// One material everywhere.
    pub fn uniform(constants: &LinearSolidConstants) -> Self {
        Self {
            of_point: Vec::new(),
            constants: vec![[constants.dilatational, constants.deviatoric]],
            limits: vec![constants.limits],
            strength: Factors::default(),
        }
    }

    /// Several materials; `of_point` gives the number of each point's material.
    ///
    /// # Errors
    /// More than 256 materials, a number without a material, materials of different horizons or influence functions.
    pub fn new(of_point: Vec<u8>, materials: &[LinearSolidConstants]) -> Result<Self> {
        check_materials(&of_point, materials.len())?;
        let same = |pair: &[LinearSolidConstants]| {
            pair[0].horizon == pair[1].horizon && pair[0].influence == pair[1].influence
        };
        if !materials.windows(2).all(same) {
            return Err(PericlesError::BadInfluence {
                reason: "the materials of a body must have one horizon and one influence function"
                    .into(),
            });
        }
        let pairs = materials
            .iter()
            .flat_map(|a| materials.iter().map(move |b| a.limits.weaker(b.limits)));
        Ok(Self {
            of_point,
            constants: materials
                .iter()
                .map(|material| [material.dilatational, material.deviatoric])
                .collect(),
            limits: pairs.collect(),
            strength: Factors::default(),
        })
    }

    /// The same with a factor of the critical stretch for every point, such as [`StrengthScatter::factors`](crate::material::StrengthScatter::factors): a bond has the mean of its ends. Critical bond energies have the
    /// square of it.
    pub fn with_strengths(self, factors: Vec<f64>) -> Self {
        Self {
            strength: Factors::new(factors),
            ..self
        }
    }

    /// Gives bonds between two materials limits of their own.
    ///
    /// # Panics
    /// If a material is not one of those given.
    pub fn set_limits(&mut self, [a, b]: [u8; 2], limits: BondLimits) {
        let (count, a, b) = (self.constants.len(), usize::from(a), usize::from(b));
        assert!(a < count && b < count, "a pair of materials given");
        self.limits[a * count + b] = limits;
        self.limits[b * count + a] = limits;
    }

    /// The same by the sites that bonds lead to.
    pub(crate) fn on_sites(&self, sites: &Sites) -> Self {
        Self {
            of_point: sites.spread_numbers(&self.of_point),
            strength: Factors::new(sites.spread(self.strength.as_slice()).into_owned()),
            ..self.clone()
        }
    }

    /// Whether there is a material for each of so many points.
    pub fn covers(&self, points: usize) -> bool {
        let has = |count: usize| count == 0 || count == points;
        has(self.of_point.len()) && has(self.strength.as_slice().len())
    }

    /// How many materials there are.
    pub fn materials(&self) -> usize {
        self.constants.len()
    }

    /// The number of a point's material.
    pub fn of_point(&self, i: usize) -> usize {
        self.of_point
            .get(i)
            .map_or(0, |&material| usize::from(material))
    }

    /// A and B of a point's material, Pa.
    pub fn constants(&self, i: usize) -> [f64; 2] {
        self.constants[self.of_point(i)]
    }

    /// What a bond between two points can bear.
    pub fn limits(&self, i: usize, j: usize) -> BondLimits {
        let pair = self.of_point(i) * self.constants.len() + self.of_point(j);
        self.limits[pair].scaled(self.strength.of_bond(i, j))
    }

    /// The lowest limits of all pairs.
    pub fn weakest(&self) -> BondLimits {
        let limits = self.limits.iter();
        let weakest = limits.fold(BondLimits::NONE, |weakest, pair| weakest.weaker(*pair));
        weakest.scaled(self.strength.smallest())
    }
}
