//! Bodies of several state-based materials.

use super::failure::BondLimits;
use super::linear_solid::LinearSolidConstants;
use crate::error::{PericlesError, Result};
use crate::material::{BondState, Criterion, Factors, PairCriteria, check_materials};
use crate::space::Sites;

/// Failure of bonds within a material.
#[derive(Debug, Clone, PartialEq)]
pub struct BondStrength {
    /// Critical stretch and critical bond energy.
    pub limits: BondLimits,
    /// Criterion of stress and strain, if bonds break by it.
    pub criterion: Option<Criterion>,
}

impl BondStrength {
    /// Bonds that never break.
    pub const UNBREAKABLE: Self = Self {
        limits: BondLimits::NONE,
        criterion: None,
    };
}

/// The materials of a body with constants `C`: the material of every point, and the failure of bonds for every pair of
/// materials.
///
/// The force state of a point has the constants of its own material, so that interfaces need no mixing rule.
/// All materials share horizon and influence function, so that families are symmetric. A bond between two
/// materials has the limits of the weaker one, unless [`Materials::set_limits`] sets others.
#[derive(Debug, Clone, PartialEq)]
pub struct Materials<C> {
    /// Numbers by point or by site; empty for a single material.
    of_point: Vec<u8>,
    all: Vec<C>,
    /// Limits by pair of materials.
    limits: Vec<BondLimits>,
    /// Criteria of stress and strain by pair of materials.
    criteria: PairCriteria,
    /// Factor of the critical stretch of each point.
    strength: Factors,
}

impl<C> Materials<C> {
    /// Creates a body of one material.
    pub fn uniform(material: C, strength: BondStrength) -> Self {
        Self::of(Vec::new(), vec![(material, strength)])
    }

    /// Creates a body of several materials; `of_point` is the number of the material of each point.
    ///
    /// # Errors
    /// More than 256 materials, a material number out of range.
    pub fn new(of_point: Vec<u8>, materials: Vec<(C, BondStrength)>) -> Result<Self> {
        check_materials(&of_point, materials.len())?;
        Ok(Self::of(of_point, materials))
    }

    fn of(of_point: Vec<u8>, materials: Vec<(C, BondStrength)>) -> Self {
        let (all, strengths): (Vec<C>, Vec<BondStrength>) = materials.into_iter().unzip();
        let pairs = strengths
            .iter()
            .flat_map(|a| strengths.iter().map(|b| a.limits.weaker(b.limits)));
        let limits = pairs.collect();
        let criteria: Vec<_> = strengths.into_iter().map(|own| own.criterion).collect();
        Self {
            of_point,
            all,
            limits,
            criteria: PairCriteria::new(&criteria),
            strength: Factors::default(),
        }
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

    /// Sets the limits of bonds between two materials, which replace their failure criteria of stress and strain.
    ///
    /// # Panics
    /// If a material number is out of range.
    pub fn set_limits(&mut self, [a, b]: [u8; 2], limits: BondLimits) {
        let (count, a, b) = (self.all.len(), usize::from(a), usize::from(b));
        assert!(
            a < count && b < count,
            "material numbers of the pair are in range"
        );
        self.limits[a * count + b] = limits;
        self.limits[b * count + a] = limits;
        self.criteria.remove([a, b]);
    }

    /// Returns the same body with constants that `convert` makes from the number and the constants of each material.
    pub fn map<M>(self, mut convert: impl FnMut(usize, C) -> M) -> Materials<M> {
        let all = self.all.into_iter().enumerate();
        Materials {
            of_point: self.of_point,
            all: all.map(|(number, own)| convert(number, own)).collect(),
            limits: self.limits,
            criteria: self.criteria,
            strength: self.strength,
        }
    }

    /// Returns the failure criteria of stress and strain.
    pub fn criteria(&self) -> &PairCriteria {
        &self.criteria
    }

    /// Returns the failure index of the bond between two points, divided by its factor of strength; −∞ if it does not
    /// break by stress or strain.
    pub fn failure_index(&self, i: usize, j: usize, bond: impl FnOnce() -> BondState) -> f64 {
        let pair = [self.number(i), self.number(j)];
        self.criteria.failure_index(pair, bond) / self.strength.of_bond(i, j)
    }

    /// Returns whether any bond can break.
    pub fn can_break(&self) -> bool {
        self.weakest().can_break() || !self.criteria.is_empty()
    }

    /// Returns the same materials with numbers by site, the end points of bonds.
    pub fn on_sites(self, sites: &Sites) -> Self {
        Self {
            of_point: sites.spread_numbers(&self.of_point),
            strength: Factors::new(sites.spread(self.strength.as_slice()).into_owned()),
            ..self
        }
    }

    /// Returns whether materials and strengths cover this number of points.
    pub fn covers(&self, points: usize) -> bool {
        let has = |count: usize| count == 0 || count == points;
        has(self.of_point.len()) && has(self.strength.as_slice().len())
    }

    /// Returns the constants of all materials.
    pub fn all(&self) -> &[C] {
        &self.all
    }

    /// Returns the number of the material of a point.
    #[inline(always)]
    pub fn number(&self, i: usize) -> usize {
        self.of_point
            .get(i)
            .map_or(0, |&material| usize::from(material))
    }

    /// Returns the constants of the material of a point.
    #[inline(always)]
    pub fn constants(&self, i: usize) -> &C {
        &self.all[self.number(i)]
    }

    /// Returns the limits of the bond between two points.
    pub fn limits(&self, i: usize, j: usize) -> BondLimits {
        let pair = self.number(i) * self.all.len() + self.number(j);
        self.limits[pair].scaled(self.strength.of_bond(i, j))
    }

    /// Returns the critical stretches by pair of materials.
    pub(crate) fn critical_stretches(&self) -> Vec<f64> {
        self.limits.iter().map(|limits| limits.stretch).collect()
    }

    /// Returns the factor of the critical stretch of every point or site; empty if strengths do not scatter.
    pub(crate) fn strengths(&self) -> &[f64] {
        self.strength.as_slice()
    }

    /// Returns the lowest limits of all bonds.
    pub fn weakest(&self) -> BondLimits {
        let limits = self.limits.iter();
        let weakest = limits.fold(BondLimits::NONE, |weakest, pair| weakest.weaker(*pair));
        weakest.scaled(self.strength.smallest())
    }
}

/// Constants A and B of a linear peridynamic solid, Pa.
pub type StateConstants = [f64; 2];

impl LinearSolidConstants {
    /// Returns the materials of a body of this material.
    pub fn uniform(&self) -> Materials<StateConstants> {
        Materials::uniform([self.dilatational, self.deviatoric], self.strength())
    }

    /// Returns the materials of a body of several materials; `of_point` is the number of the material of each point.
    ///
    /// # Errors
    /// More than 256 materials, a material number out of range, materials with different horizons or
    /// influence functions.
    pub fn several(of_point: Vec<u8>, materials: &[Self]) -> Result<Materials<StateConstants>> {
        let same = |pair: &[Self]| {
            pair[0].horizon == pair[1].horizon && pair[0].influence == pair[1].influence
        };
        check_materials(&of_point, materials.len())?;
        if !materials.windows(2).all(same) {
            return Err(PericlesError::BadInfluence {
                reason: "the materials of a body must have the same horizon and influence function"
                    .into(),
            });
        }
        let with_strength = |own: &Self| ([own.dilatational, own.deviatoric], own.strength());
        Materials::new(of_point, materials.iter().map(with_strength).collect())
    }

    fn strength(&self) -> BondStrength {
        BondStrength {
            limits: self.limits,
            criterion: self.criterion.clone(),
        }
    }
}

impl Materials<StateConstants> {
    /// Returns the materials of a larger set of points, in which the points of this body have the given
    /// positions. The other points have A = B = 0, so that their states store no energy. Their bonds are
    /// unbreakable; bonds of this body keep their limits, not their criteria of stress and strain.
    ///
    /// # Errors
    /// A body that already has 256 materials.
    pub(crate) fn among(&self, places: &[u32], points: usize) -> Result<Self> {
        let count = self.all.len();
        let void = count.min(255) as u8;
        let mut of_point = vec![void; points];
        let mut strengths = match self.strength.is_uniform() {
            true => Vec::new(),
            false => vec![1.0; points],
        };
        for (i, &place) in places.iter().enumerate() {
            of_point[place as usize] = self.number(i) as u8;
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
            all: [&self.all[..], &[[0.0; 2]]].concat(),
            limits: pairs.map(|(a, b)| pair(a, b)).collect(),
            criteria: PairCriteria::default(),
            strength: Factors::new(strengths),
        })
    }
}
