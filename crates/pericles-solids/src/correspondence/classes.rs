//! Bodies of several correspondence materials.

use pericles::material::BondLimits;
use pericles::space::Sites;
use pericles::{PericlesError, Result};

use super::control::Stabilisation;
use super::material::CorrespondenceConstants;
use super::solid::Solid;

/// The material of every point, and the critical stretch of the bonds between each pair of materials: that of the weaker one, unless [`CorrespondenceClasses::set_limits`] says otherwise.
///
/// The force state of a point has the constants of the point's own material. Horizon, influence function and stabilisation are those of the body.
#[derive(Debug, Clone, PartialEq)]
pub struct CorrespondenceClasses {
    /// Empty if there is one material.
    of_point: Vec<u8>,
    materials: Vec<CorrespondenceConstants>,
    /// Critical stretches by pairs of materials.
    stretch: Vec<f64>,
    /// Factors of the critical stretch by points; empty if they are as given.
    strengths: Vec<f64>,
}

impl CorrespondenceClasses {
    /// One material everywhere.
    pub fn uniform(constants: &CorrespondenceConstants) -> Self {
        Self {
            of_point: Vec::new(),
            materials: vec![constants.clone()],
            stretch: vec![constants.solid.limits.stretch],
            strengths: Vec::new(),
        }
    }

    /// Several materials; `of_point` gives the number of each point's material.
    ///
    /// # Errors
    /// A number without a material; materials of different horizons, influence functions or stabilisations.
    pub fn new(of_point: Vec<u8>, materials: &[CorrespondenceConstants]) -> Result<Self> {
        let largest = of_point.iter().copied().max().map_or(0, usize::from);
        if largest >= materials.len() {
            return Err(PericlesError::OutOfRange {
                quantity: "the number of a point's material",
                value: largest as f64,
                allowed: "numbers of the materials given, counted from 0",
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
                reason: "the correspondence materials of a body must have one horizon, one influence function and one stabilisation".into(),
            });
        }
        let limit = |material: &CorrespondenceConstants| material.solid.limits.stretch;
        let pairs = materials
            .iter()
            .flat_map(|a| materials.iter().map(move |b| limit(a).min(limit(b))));
        Ok(Self {
            of_point,
            stretch: pairs.collect(),
            materials: materials.to_vec(),
            strengths: Vec::new(),
        })
    }

    /// The same with a factor of the critical stretch for every point, such as [`StrengthScatter::factors`](pericles::material::StrengthScatter::factors): a bond has the mean of its ends.
    pub fn with_strengths(self, factors: Vec<f64>) -> Self {
        Self {
            strengths: factors,
            ..self
        }
    }

    /// Gives bonds between two materials a critical stretch of their own.
    ///
    /// # Panics
    /// If a material is not one of those given.
    pub fn set_limits(&mut self, [a, b]: [u8; 2], limits: BondLimits) {
        let (count, a, b) = (self.materials.len(), usize::from(a), usize::from(b));
        assert!(a < count && b < count, "a pair of materials given");
        self.stretch[a * count + b] = limits.stretch;
        self.stretch[b * count + a] = limits.stretch;
    }

    /// Whether there is a material for each of so many points.
    pub fn covers(&self, points: usize) -> bool {
        let has = |count: usize| count == 0 || count == points;
        has(self.of_point.len()) && has(self.strengths.len())
    }

    /// The constants of a point's material.
    pub fn constants(&self, i: usize) -> &CorrespondenceConstants {
        &self.materials[number(&self.of_point, i)]
    }

    /// The solid of a point.
    pub(super) fn solid(&self, i: usize) -> &Solid {
        &self.constants(i).point
    }

    /// The stabilisation of the body.
    pub fn stabilisation(&self) -> Stabilisation {
        self.materials[0].stabilisation
    }

    /// The lowest critical stretch.
    pub(super) fn weakest(&self) -> f64 {
        let weakest = self.strengths.iter().copied().reduce(f64::min);
        let stretch = self.stretch.iter().copied().fold(f64::INFINITY, f64::min);
        weakest.unwrap_or(1.0) * stretch
    }

    /// Whether any material yields.
    pub fn yields(&self) -> bool {
        let mut solids = self.materials.iter();
        solids.any(|material| material.point.plasticity.is_some())
    }

    /// Critical stretches by the sites that bonds lead to.
    pub(super) fn on_sites(&self, sites: &Sites) -> SiteLimits {
        SiteLimits {
            of_site: sites.spread_numbers(&self.of_point),
            count: self.materials.len(),
            stretch: self.stretch.clone(),
            strengths: sites.spread(&self.strengths).into_owned(),
        }
    }
}

fn number(numbers: &[u8], k: usize) -> usize {
    numbers.get(k).map_or(0, |&material| usize::from(material))
}

/// The critical stretch of the bond between two sites.
#[derive(Debug, Clone)]
pub(super) struct SiteLimits {
    of_site: Vec<u8>,
    count: usize,
    stretch: Vec<f64>,
    strengths: Vec<f64>,
}

impl SiteLimits {
    pub fn stretch(&self, a: usize, b: usize) -> f64 {
        let pair = number(&self.of_site, a) * self.count + number(&self.of_site, b);
        let strength = match &self.strengths[..] {
            [] => 1.0,
            strengths => 0.5 * (strengths[a] + strengths[b]),
        };
        strength * self.stretch[pair]
    }
}
