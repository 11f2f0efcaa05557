//! Materials of points, and failure of bonds between them.

use pericles::Result;
use pericles::material::{
    BondLimits, BondState, Criterion, Factors, PairCriteria, check_materials,
};
use pericles::space::Sites;

/// Failure of bonds within a material.
#[derive(Debug, Clone, PartialEq)]
pub struct BondStrength {
    /// Critical stretch; infinite if bonds do not break by their stretch.
    pub stretch: f64,
    /// Criterion of stress and strain, if bonds break by it.
    pub criterion: Option<Criterion>,
}

impl BondStrength {
    /// Bonds that never break.
    pub const UNBREAKABLE: Self = Self {
        stretch: f64::INFINITY,
        criterion: None,
    };
}

/// The materials of a body: the material of every point, and the failure of bonds for every pair of materials, which is that
/// of the weaker one unless [`Materials::set_limits`] sets another critical stretch.
///
/// The force state of a point is computed by its own material.
#[derive(Debug, Clone, PartialEq)]
pub struct Materials<S> {
    /// Numbers by point, or by site; empty for a single material.
    of_point: Vec<u8>,
    all: Vec<S>,
    /// Critical stretches by pair of materials.
    stretch: Vec<f64>,
    criteria: PairCriteria,
    /// Factor of the strength of each point.
    factors: Factors,
}

impl<S> Materials<S> {
    /// Creates a body of one material.
    pub fn uniform(material: S, strength: BondStrength) -> Self {
        Self::of(Vec::new(), vec![(material, strength)])
    }

    /// Creates a body of several materials; `of_point` is the number of the material of each point.
    ///
    /// # Errors
    /// More than 256 materials; a number out of range.
    pub fn new(of_point: Vec<u8>, materials: Vec<(S, BondStrength)>) -> Result<Self> {
        check_materials(&of_point, materials.len())?;
        Ok(Self::of(of_point, materials))
    }

    fn of(of_point: Vec<u8>, materials: Vec<(S, BondStrength)>) -> Self {
        let (all, strengths): (Vec<S>, Vec<BondStrength>) = materials.into_iter().unzip();
        let stretches: Vec<f64> = strengths.iter().map(|own| own.stretch).collect();
        let criteria: Vec<_> = strengths.into_iter().map(|own| own.criterion).collect();
        let pairs = stretches
            .iter()
            .flat_map(|a| stretches.iter().map(move |b| a.min(*b)));
        Self {
            of_point,
            all,
            stretch: pairs.collect(),
            criteria: PairCriteria::new(&criteria),
            factors: Factors::default(),
        }
    }

    /// Sets a factor of the critical stretch for every point, for example
    /// [`StrengthScatter::factors`](pericles::material::StrengthScatter::factors). A bond has the mean factor of its ends.
    pub fn with_strengths(self, factors: Vec<f64>) -> Self {
        Self {
            factors: Factors::new(factors),
            ..self
        }
    }

    /// Sets the critical stretch of bonds between two materials, which replaces their criteria of stress and strain.
    ///
    /// # Panics
    /// If a material number is out of range.
    pub fn set_limits(&mut self, [a, b]: [u8; 2], limits: BondLimits) {
        let (count, a, b) = (self.all.len(), usize::from(a), usize::from(b));
        assert!(
            a < count && b < count,
            "material numbers of the pair are in range"
        );
        self.stretch[a * count + b] = limits.stretch;
        self.stretch[b * count + a] = limits.stretch;
        self.criteria.remove([a, b]);
    }

    /// Converts the materials.
    pub(crate) fn map<M>(self, convert: impl FnMut(S) -> M) -> Materials<M> {
        Materials {
            of_point: self.of_point,
            all: self.all.into_iter().map(convert).collect(),
            stretch: self.stretch,
            criteria: self.criteria,
            factors: self.factors,
        }
    }

    /// Returns whether materials and strengths cover this number of points.
    pub fn covers(&self, points: usize) -> bool {
        let has = |count: usize| count == 0 || count == points;
        has(self.of_point.len()) && has(self.factors.as_slice().len())
    }

    /// Returns all materials.
    pub fn all(&self) -> &[S] {
        &self.all
    }

    /// Returns the number of the material of a point, or of a site.
    #[inline(always)]
    pub(super) fn number(&self, k: usize) -> usize {
        self.of_point
            .get(k)
            .map_or(0, |&material| usize::from(material))
    }

    /// Returns the same materials with numbers by site, the end points of bonds.
    pub(super) fn on_sites(self, sites: &Sites) -> Self {
        Self {
            of_point: sites.spread_numbers(&self.of_point),
            factors: Factors::new(sites.spread(self.factors.as_slice()).into_owned()),
            ..self
        }
    }

    /// Returns the lowest critical stretch of all bonds.
    pub(super) fn weakest(&self) -> f64 {
        let stretch = self.stretch.iter().copied().fold(f64::INFINITY, f64::min);
        self.factors.smallest() * stretch
    }

    /// Returns the critical stretch of the bond between two sites.
    pub(super) fn stretch(&self, a: usize, b: usize) -> f64 {
        let pair = self.number(a) * self.all.len() + self.number(b);
        self.factors.of_bond(a, b) * self.stretch[pair]
    }

    /// Returns whether bonds of any material break by stress or strain.
    pub(super) fn has_criteria(&self) -> bool {
        !self.criteria.is_empty()
    }

    /// Returns the failure index of the bond between two sites, divided by its factor of strength; −∞ if it does not
    /// break by stress or strain.
    pub(super) fn failure_index(
        &self,
        a: usize,
        b: usize,
        bond: impl FnOnce() -> BondState,
    ) -> f64 {
        let pair = [self.number(a), self.number(b)];
        self.criteria.failure_index(pair, bond) / self.factors.of_bond(a, b)
    }
}
