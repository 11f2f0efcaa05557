//! Bodies of several state-based materials.

use super::failure::BondLimits;
use super::linear_solid::LinearSolidConstants;
use crate::error::{PericlesError, Result};
use crate::material::{BondState, Factors, PairCriteria, check_materials};
use crate::space::Sites;

/// Material of every point, and failure limits of bonds for every pair of materials.
///
/// The force state of a point has the constants of its own material, so that interfaces need no mixing rule.
/// All materials share horizon and influence function, so that families are symmetric. A bond between two
/// materials has the limits of the weaker one, unless [`SolidClasses::set_limits`] sets others.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidClasses {
    /// Empty for a single material.
    of_point: Vec<u8>,
    /// A and B, Pa, by material.
    constants: Vec<[f64; 2]>,
    /// Limits by pair of materials.
    limits: Vec<BondLimits>,
    /// Criteria of stress and strain by pair of materials.
    criteria: PairCriteria,
    /// Factor of the critical stretch of each point.
    strength: Factors,
}

impl SolidClasses {
    /// Creates the classes of a body of one material.
    pub fn uniform(constants: &LinearSolidConstants) -> Self {
        Self {
            of_point: Vec::new(),
            constants: vec![[constants.dilatational, constants.deviatoric]],
            limits: vec![constants.limits],
            criteria: PairCriteria::new(std::slice::from_ref(&constants.criterion)),
            strength: Factors::default(),
        }
    }

    /// Creates the classes of several materials; `of_point` gives the material number of each point.
    ///
    /// # Errors
    /// More than 256 materials, a material number out of range, materials with different horizons or
    /// influence functions.
    pub fn new(of_point: Vec<u8>, materials: &[LinearSolidConstants]) -> Result<Self> {
        check_materials(&of_point, materials.len())?;
        let same = |pair: &[LinearSolidConstants]| {
            pair[0].horizon == pair[1].horizon && pair[0].influence == pair[1].influence
        };
        if !materials.windows(2).all(same) {
            return Err(PericlesError::BadInfluence {
                reason: "the materials of a body must have the same horizon and influence function"
                    .into(),
            });
        }
        let criteria: Vec<_> = materials.iter().map(|own| own.criterion.clone()).collect();
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
            criteria: PairCriteria::new(&criteria),
            strength: Factors::default(),
        })
    }

    /// Sets a factor of the critical stretch for every point, for example
    /// [`StrengthScatter::factors`](crate::material::StrengthScatter::factors). A bond has the mean factor of
    /// its end points; its critical bond energy is multiplied by the square.
    pub fn with_strengths(self, factors: Vec<f64>) -> Self {
        Self {
            strength: Factors::new(factors),
            ..self
        }
    }

    /// Returns the failure criteria of stress and strain.
    pub fn criteria(&self) -> &PairCriteria {
        &self.criteria
    }

    /// Returns the failure index of the bond between two points, divided by its factor of strength; −∞ if it does not
    /// break by stress or strain.
    pub fn failure_index(&self, i: usize, j: usize, bond: impl FnOnce() -> BondState) -> f64 {
        let pair = [self.of_point(i), self.of_point(j)];
        self.criteria.failure_index(pair, bond) / self.strength.of_bond(i, j)
    }

    /// Returns whether any bond can break.
    pub fn can_break(&self) -> bool {
        self.weakest().can_break() || !self.criteria.is_empty()
    }

    /// Sets the limits of bonds between two materials, which replace their failure criteria of stress and strain.
    ///
    /// # Panics
    /// If a material number is out of range.
    pub fn set_limits(&mut self, [a, b]: [u8; 2], limits: BondLimits) {
        let (count, a, b) = (self.constants.len(), usize::from(a), usize::from(b));
        assert!(
            a < count && b < count,
            "material numbers of the pair are in range"
        );
        self.limits[a * count + b] = limits;
        self.limits[b * count + a] = limits;
        self.criteria.remove([a, b]);
    }

    /// Returns the classes by sites, the end points of bonds.
    pub(crate) fn on_sites(&self, sites: &Sites) -> Self {
        Self {
            of_point: sites.spread_numbers(&self.of_point),
            strength: Factors::new(sites.spread(self.strength.as_slice()).into_owned()),
            ..self.clone()
        }
    }

    /// Returns the classes of a larger set of points, in which the points of this body have the given
    /// positions. The other points have A = B = 0, so that their states store no energy. Their bonds are
    /// unbreakable; bonds of this body keep their limits, not their criteria of stress and strain.
    ///
    /// # Errors
    /// A body that already has 256 materials.
    pub(crate) fn among(&self, places: &[u32], points: usize) -> Result<Self> {
        let count = self.constants.len();
        let void = count.min(255) as u8;
        let mut of_point = vec![void; points];
        let mut strengths = match self.strength.is_uniform() {
            true => Vec::new(),
            false => vec![1.0; points],
        };
        for (i, &place) in places.iter().enumerate() {
            of_point[place as usize] = self.of_point(i) as u8;
            if let Some(strength) = self.strength.as_slice().get(i) {
                strengths[place as usize] = *strength;
            }
        }
        check_materials(&of_point, count + 1)?;
        let pair = |a: usize, b: usize| match a < count && b < count {
            true => self.limits[a * count + b],
            false => BondLimits::NONE,
        };
        let pairs = (0..=count).flat_map(|a| (0..=count).map(move |b| (a, b)));
        Ok(Self {
            of_point,
            constants: [&self.constants[..], &[[0.0; 2]]].concat(),
            limits: pairs.map(|(a, b)| pair(a, b)).collect(),
            criteria: PairCriteria::default(),
            strength: Factors::new(strengths),
        })
    }

    /// Returns whether materials and strengths cover this number of points.
    pub fn covers(&self, points: usize) -> bool {
        let has = |count: usize| count == 0 || count == points;
        has(self.of_point.len()) && has(self.strength.as_slice().len())
    }

    /// Returns the number of materials.
    pub fn materials(&self) -> usize {
        self.constants.len()
    }

    /// Returns the material number of a point.
    pub fn of_point(&self, i: usize) -> usize {
        self.of_point
            .get(i)
            .map_or(0, |&material| usize::from(material))
    }

    /// Returns A and B of the material of a point, Pa.
    pub fn constants(&self, i: usize) -> [f64; 2] {
        self.constants[self.of_point(i)]
    }

    /// Returns the limits of the bond between two points.
    pub fn limits(&self, i: usize, j: usize) -> BondLimits {
        let pair = self.of_point(i) * self.constants.len() + self.of_point(j);
        self.limits[pair].scaled(self.strength.of_bond(i, j))
    }

    /// Returns the lowest limits of all bonds.
    pub fn weakest(&self) -> BondLimits {
        let limits = self.limits.iter();
        let weakest = limits.fold(BondLimits::NONE, |weakest, pair| weakest.weaker(*pair));
        weakest.scaled(self.strength.smallest())
    }
}
