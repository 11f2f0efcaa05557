//! Bodies of several correspondence materials.

use pericles::material::{BondLimits, BondState, PairCriteria};
use pericles::space::Sites;
use pericles::{PericlesError, Result};

use super::control::Stabilisation;
use super::material::CorrespondenceConstants;
use super::solid::Solid;

/// Material of every point, and critical stretch of bonds for every pair of materials: the value of the weaker
/// one, unless [`CorrespondenceClasses::set_limits`] sets another one.
///
/// The force state of a point has the constants of its own material. All materials share horizon, influence
/// function and stabilisation.
#[derive(Debug, Clone, PartialEq)]
pub struct CorrespondenceClasses {
    /// Empty for a single material.
    of_point: Vec<u8>,
    materials: Vec<CorrespondenceConstants>,
    /// Critical stretches by pair of materials.
    stretch: Vec<f64>,
    /// Criteria of stress and strain by pair of materials.
    criteria: PairCriteria,
    /// Factor of the critical stretch of each point; empty if strengths do not scatter.
    strengths: Vec<f64>,
}

impl CorrespondenceClasses {
    /// Creates the classes of a body of one material.
    pub fn uniform(constants: &CorrespondenceConstants) -> Self {
        Self {
            of_point: Vec::new(),
            materials: vec![constants.clone()],
            stretch: vec![constants.solid.limits.stretch],
            criteria: PairCriteria::new(std::slice::from_ref(&constants.solid.criterion)),
            strengths: Vec::new(),
        }
    }

    /// Creates the classes of several materials; `of_point` gives the material number of each point.
    ///
    /// # Errors
    /// A material number out of range; materials with different horizons, influence functions or stabilisations.
    pub fn new(of_point: Vec<u8>, materials: &[CorrespondenceConstants]) -> Result<Self> {
        let largest = of_point.iter().copied().max().map_or(0, usize::from);
        if largest >= materials.len() {
            return Err(PericlesError::OutOfRange {
                quantity: "the material number of a point",
                value: largest as f64,
                allowed: "0 to the number of materials less 1",
            });
        }
        let same = |pair: &[CorrespondenceConstants]| {
            let [a, b] = [&pair[0], &pair[1]];
            a.solid.horizon == b.solid.horizon
                && a.solid.influence == b.solid.influence
                && a.stabilisation == b.stabilisation
        };
        if !materials.windows(2).all(same) {
            return Err(PericlesError::BadInfluence {
                reason: "the correspondence materials of a body must have the same horizon, influence function and stabilisation".into(),
            });
        }
        let limit = |material: &CorrespondenceConstants| material.solid.limits.stretch;
        let criteria = materials.iter().map(|own| own.solid.criterion.clone());
        let criteria: Vec<_> = criteria.collect();
        let pairs = materials
            .iter()
            .flat_map(|a| materials.iter().map(move |b| limit(a).min(limit(b))));
        Ok(Self {
            of_point,
            stretch: pairs.collect(),
            criteria: PairCriteria::new(&criteria),
            materials: materials.to_vec(),
            strengths: Vec::new(),
        })
    }

    /// Sets a factor of the critical stretch for every point, for example
    /// [`StrengthScatter::factors`](pericles::material::StrengthScatter::factors). A bond has the mean factor
    /// of its end points.
    pub fn with_strengths(self, factors: Vec<f64>) -> Self {
        Self {
            strengths: factors,
            ..self
        }
    }

    /// Sets the critical stretch of bonds between two materials, which replaces their criteria of stress and strain.
    ///
    /// # Panics
    /// If a material number is out of range.
    pub fn set_limits(&mut self, [a, b]: [u8; 2], limits: BondLimits) {
        let (count, a, b) = (self.materials.len(), usize::from(a), usize::from(b));
        assert!(
            a < count && b < count,
            "material numbers of the pair are in range"
        );
        self.stretch[a * count + b] = limits.stretch;
        self.stretch[b * count + a] = limits.stretch;
        self.criteria.remove([a, b]);
    }

    /// Returns whether materials and strengths cover this number of points.
    pub fn covers(&self, points: usize) -> bool {
        let has = |count: usize| count == 0 || count == points;
        has(self.of_point.len()) && has(self.strengths.len())
    }

    /// Returns the constants of the material of a point.
    pub fn constants(&self, i: usize) -> &CorrespondenceConstants {
        &self.materials[number(&self.of_point, i)]
    }

    /// Returns the solid of a point.
    pub(super) fn solid(&self, i: usize) -> &Solid {
        &self.constants(i).point
    }

    /// Returns the stabilisation of the body.
    pub fn stabilisation(&self) -> Stabilisation {
        self.materials[0].stabilisation
    }

    /// Returns the lowest critical stretch.
    pub(super) fn weakest(&self) -> f64 {
        let weakest = self.strengths.iter().copied().reduce(f64::min);
        let stretch = self.stretch.iter().copied().fold(f64::INFINITY, f64::min);
        weakest.unwrap_or(1.0) * stretch
    }

    /// Returns whether any material yields.
    pub fn yields(&self) -> bool {
        let mut solids = self.materials.iter();
        solids.any(|material| material.point.plasticity.is_some())
    }

    /// Returns the limits of bonds by sites.
    pub(super) fn on_sites(&self, sites: &Sites) -> SiteLimits {
        SiteLimits {
            of_site: sites.spread_numbers(&self.of_point),
            count: self.materials.len(),
            stretch: self.stretch.clone(),
            strengths: sites.spread(&self.strengths).into_owned(),
            criteria: self.criteria.clone(),
        }
    }
}

fn number(numbers: &[u8], k: usize) -> usize {
    numbers.get(k).map_or(0, |&material| usize::from(material))
}

/// Failure limits of bonds between sites.
#[derive(Debug, Clone)]
pub(super) struct SiteLimits {
    of_site: Vec<u8>,
    count: usize,
    stretch: Vec<f64>,
    strengths: Vec<f64>,
    criteria: PairCriteria,
}

impl SiteLimits {
    /// Returns whether bonds of any material break by stress or strain.
    pub fn has_criteria(&self) -> bool {
        !self.criteria.is_empty()
    }

    /// Returns the failure index of the bond between two sites, divided by its factor of strength; −∞ if it does not
    /// break by stress or strain.
    pub fn failure_index(&self, a: usize, b: usize, bond: impl FnOnce() -> BondState) -> f64 {
        let pair = [a, b].map(|site| number(&self.of_site, site));
        self.criteria.failure_index(pair, bond) / self.factor(a, b)
    }

    /// Returns the factor of both limits.
    fn factor(&self, a: usize, b: usize) -> f64 {
        match &self.strengths[..] {
            [] => 1.0,
            strengths => 0.5 * (strengths[a] + strengths[b]),
        }
    }

    pub fn stretch(&self, a: usize, b: usize) -> f64 {
        let pair = number(&self.of_site, a) * self.count + number(&self.of_site, b);
        self.factor(a, b) * self.stretch[pair]
    }
}
