//! Bodies of several materials: the constants of a bond by the materials of its two ends.

use super::BondConstants;
use super::scatter::Factors;
use crate::error::{PericlesError, Result};
use crate::space::{Sites, check_length};

/// The constant c of a bond between two materials, from theirs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum InterfaceRule {
    /// 2 c₁c₂/(c₁ + c₂): two springs of half the length in a row.
    #[default]
    Harmonic,
    /// (c₁ + c₂)/2.
    Arithmetic,
    /// min(c₁, c₂).
    Weaker,
}

impl InterfaceRule {
    /// The constant of a bond between two materials, from theirs.
    pub fn mix(self, [a, b]: [f64; 2]) -> f64 {
        match self {
            // A mean of equals is that number, to the last bit.
            _ if a == b => a,
            Self::Harmonic => 2.0 * a * b / (a + b),
            Self::Arithmetic => 0.5 * (a + b),
            Self::Weaker => a.min(b),
        }
    }
}

/// The material of every point, and a small symmetric table of the constants for every pair of materials.
///
/// A bond between points of the materials a and b has the constant c_ab by the [`InterfaceRule`] and the smaller of the two critical stretches, unless
/// [`PairClasses::set_critical_stretch`] says otherwise.
#[derive(Debug, Clone, PartialEq)]
pub struct PairClasses {
    of_point: Vec<u8>,
    count: usize,
    micromodulus: Vec<f64>,
    critical_stretch: Vec<f64>,
    /// Factors of the critical stretch by points.
    strength: Factors,
}

impl PairClasses {
    /// The classes of materials with these constants; `of_point` gives the number of each point's material.
    ///
    /// # Errors
    /// More than 256 materials, or a number without a material.
    pub fn new(
        of_point: Vec<u8>,
        constants: &[BondConstants],
        rule: InterfaceRule,
    ) -> Result<Self> {
        let count = constants.len();
        check_materials(&of_point, count)?;
        let table = |entry: &dyn Fn(&BondConstants, &BondConstants) -> f64| {
            let pairs = constants
                .iter()
                .flat_map(|a| constants.iter().map(move |b| (a, b)));
            pairs.map(|(a, b)| entry(a, b)).collect()
        };
        Ok(Self {
            of_point,
            count,
            micromodulus: table(&|a, b| rule.mix([a.micromodulus, b.micromodulus])),
            critical_stretch: table(&|a, b| a.critical_stretch.min(b.critical_stretch)),
            strength: Factors::default(),
        })
    }

    /// Gives bonds between two materials a critical stretch of their own; infinite: they never break.
    ///
    /// # Errors
    /// A number that is not one of the materials given.
    pub fn set_critical_stretch(&mut self, pair: [u8; 2], stretch: f64) -> Result<()> {
        for class in self.classes_of(pair)? {
            self.critical_stretch[class] = stretch;
        }
        Ok(())
    }

    /// The same with a factor of the critical stretch for every point, such as [`StrengthScatter::factors`](super::StrengthScatter::factors): a bond has the mean of its ends.
    ///
    /// # Errors
    /// Factors that are not one for each point.
    pub fn with_strengths(self, factors: Vec<f64>) -> Result<Self> {
        check_length(
            "the strengths of the points",
            factors.len(),
            self.of_point.len(),
        )?;
        Ok(Self {
            strength: Factors::new(factors),
            ..self
        })
    }

    /// Gives bonds between two materials a constant of their own.
    ///
    /// # Errors
    /// A number that is not one of the materials given.
    pub fn set_micromodulus(&mut self, pair: [u8; 2], micromodulus: f64) -> Result<()> {
        for class in self.classes_of(pair)? {
            self.micromodulus[class] = micromodulus;
        }
        Ok(())
    }

    /// Refuses a number that is not one of the materials given.
    pub(super) fn check_pair(&self, pair: [u8; 2]) -> Result<()> {
        self.classes_of(pair).map(|_| ())
    }

    /// The classes of bonds between two materials, seen from either end.
    fn classes_of(&self, pair: [u8; 2]) -> Result<[usize; 2]> {
        let [a, b] = pair.map(usize::from);
        let last = a.max(b);
        if last >= self.count {
            return Err(PericlesError::OutOfRange {
                quantity: "the number of a material of a pair",
                value: last as f64,
                allowed: "numbers of the materials given, from 0",
            });
        }
        Ok([a * self.count + b, b * self.count + a])
    }

    /// The same by the sites that bonds lead to.
    pub(crate) fn on_sites(&self, sites: &Sites) -> Self {
        Self {
            of_point: sites.spread_numbers(&self.of_point),
            strength: Factors::new(sites.spread(self.strength.as_slice()).into_owned()),
            ..self.clone()
        }
    }

    /// The same for other places, with the number of the material of each and, where strengths scatter, its factor.
    pub(crate) fn at(&self, of_place: Vec<u8>, strengths: Vec<f64>) -> Self {
        Self {
            of_point: of_place,
            strength: Factors::new(strengths),
            ..self.clone()
        }
    }

    /// The number of each point's material.
    pub fn of_point(&self) -> &[u8] {
        &self.of_point
    }

    /// The constant c of a bond between two points.
    pub fn micromodulus(&self, i: usize, j: usize) -> f64 {
        self.micromodulus[self.class(i, j)]
    }

    /// The critical stretch s₀ of a bond between two points; infinite if it never breaks.
    pub fn critical_stretch(&self, i: usize, j: usize) -> f64 {
        self.critical_stretch[self.class(i, j)] * self.strength.of_bond(i, j)
    }

    /// The constant c of bonds between two materials.
    ///
    /// # Panics
    /// If a material is not one of those given.
    pub fn pair_micromodulus(&self, [a, b]: [u8; 2]) -> f64 {
        self.micromodulus[usize::from(a) * self.count + usize::from(b)]
    }

    /// The critical stretch s₀ of bonds between two materials.
    ///
    /// # Panics
    /// If a material is not one of those given.
    pub fn pair_critical_stretch(&self, [a, b]: [u8; 2]) -> f64 {
        self.critical_stretch[usize::from(a) * self.count + usize::from(b)]
    }

    /// Whether all bonds have one critical stretch.
    pub fn has_one_critical_stretch(&self) -> bool {
        let first = self.critical_stretch[0];
        let mut stretches = self.critical_stretch.iter();
        self.strength.is_uniform() && stretches.all(|stretch| *stretch == first)
    }

    /// The smallest critical stretch of all.
    pub fn smallest_critical_stretch(&self) -> f64 {
        let stretches = self.critical_stretch.iter();
        self.strength.smallest() * stretches.copied().fold(f64::INFINITY, f64::min)
    }

    /// Whether critical stretches scatter from point to point.
    pub fn scatters(&self) -> bool {
        !self.strength.is_uniform()
    }

    /// The factor of the critical stretch of every point; empty if strengths do not scatter.
    pub(crate) fn strengths(&self) -> &[f64] {
        self.strength.as_slice()
    }

    /// Critical stretches by class.
    pub(crate) fn critical_stretches(&self) -> &[f64] {
        &self.critical_stretch
    }

    /// The class of a bond between two points.
    #[inline(always)]
    pub(crate) fn class(&self, i: usize, j: usize) -> usize {
        usize::from(self.of_point[i]) * self.count + usize::from(self.of_point[j])
    }
}

/// Refuses more than 256 materials, and points of a material that is not one of so many.
pub(crate) fn check_materials(of_point: &[u8], count: usize) -> Result<()> {
    if count > 256 {
        return Err(PericlesError::OutOfRange {
            quantity: "the number of materials",
            value: count as f64,
            allowed: "at most 256",
        });
    }
    let unknown = of_point
        .iter()
        .find(|&&number| usize::from(number) >= count);
    match unknown {
        Some(&number) => Err(PericlesError::OutOfRange {
            quantity: "the number of a point's material",
            value: f64::from(number),
            allowed: "numbers of the materials given, from 0",
        }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn constants(micromodulus: f64, critical_stretch: f64) -> BondConstants {
        BondConstants {
            micromodulus,
            critical_stretch,
            fracture_energy: f64::NAN,
            fracture_calibration: None,
            crack_planes: Vec::new(),
            young: f64::NAN,
            stiffness_error: 0.0,
            shear_error: 0.0,
        }
    }

    #[test]
    fn mixed_bonds_follow_the_rule() {
        let two = [constants(3.0, 0.01), constants(6.0, f64::INFINITY)];
        let mixed = |rule| {
            PairClasses::new(vec![0, 1, 1], &two, rule)
                .unwrap()
                .micromodulus(0, 2)
        };
        assert_eq!(mixed(InterfaceRule::Harmonic), 4.0);
        assert_eq!(mixed(InterfaceRule::Arithmetic), 4.5);
        assert_eq!(mixed(InterfaceRule::Weaker), 3.0);
        let mut classes = PairClasses::new(vec![0, 1, 1], &two, InterfaceRule::Weaker).unwrap();
        assert_eq!(classes.micromodulus(1, 2), 6.0);
        assert_eq!(classes.critical_stretch(2, 0), 0.01);
        assert_eq!(classes.critical_stretch(1, 2), f64::INFINITY);
        classes.set_critical_stretch([1, 0], 0.002).unwrap();
        assert!(classes.set_critical_stretch([0, 3], 0.002).is_err());
        assert_eq!(classes.critical_stretch(0, 1), 0.002);
        assert_eq!(classes.critical_stretch(2, 0), 0.002);
        assert_eq!(classes.smallest_critical_stretch(), 0.002);
        assert!(PairClasses::new(vec![2], &two, InterfaceRule::Weaker).is_err());
    }
}
