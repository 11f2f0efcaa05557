//! Bodies of several materials: bond constants by the materials of both end points.
//!
//! A body of several materials stores one byte per point, and a constant and a critical stretch per pair of
//! materials. Law and influence function belong to the body, so that both ends evaluate the same bond.

use super::BondConstants;
use super::scatter::Factors;
use crate::error::{PericlesError, Result};
use crate::space::{Sites, check_length};

/// Mixing rule for the constant c of bonds between two materials.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum InterfaceRule {
    /// 2 c₁c₂/(c₁ + c₂): two springs of half the length in series.
    #[default]
    Harmonic,
    /// (c₁ + c₂)/2.
    Arithmetic,
    /// min(c₁, c₂).
    Weaker,
}

impl InterfaceRule {
    /// Returns the constant of a bond between materials with the constants a and b.
    pub fn mix(self, [a, b]: [f64; 2]) -> f64 {
        match self {
            // Bitwise exact for equal constants.
            _ if a == b => a,
            Self::Harmonic => 2.0 * a * b / (a + b),
            Self::Arithmetic => 0.5 * (a + b),
            Self::Weaker => a.min(b),
        }
    }
}

/// Material of every point, and a symmetric table of bond constants for every pair of materials.
///
/// A bond between materials a and b has the constant c_ab of the [`InterfaceRule`] and the smaller of both
/// critical stretches, unless [`MaterialPairs::set_critical_stretch`] sets another one. If bonds soften, they do so from
/// the smaller of both onsets ([`MaterialPairs::with_onsets`]).
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialPairs {
    of_point: Vec<u8>,
    count: usize,
    micromodulus: Vec<f64>,
    critical_stretch: Vec<f64>,
    /// Stretch at which softening starts, per pair; empty if all bonds have the onset of the body.
    onset: Vec<f64>,
    /// Factor of the critical stretch of each point.
    strength: Factors,
}

impl MaterialPairs {
    /// Creates the table for materials with these constants; `of_point` gives the material number of each point.
    ///
    /// # Errors
    /// More than 256 materials, or a material number out of range.
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
            onset: Vec::new(),
            strength: Factors::default(),
        })
    }

    /// Sets the stretch at which the bonds of each material soften, infinite for bonds that stay elastic. A bond between
    /// two materials has the smaller onset.
    ///
    /// # Errors
    /// A number of onsets other than the number of materials.
    pub fn with_onsets(self, onsets: &[f64]) -> Result<Self> {
        check_length("the onsets of the materials", onsets.len(), self.count)?;
        let pairs = onsets.iter().flat_map(|a| onsets.iter().map(|b| a.min(*b)));
        Ok(Self {
            onset: pairs.collect(),
            ..self
        })
    }

    /// Sets the critical stretch of bonds between two materials; infinite for unbreakable bonds.
    ///
    /// # Errors
    /// A material number out of range.
    pub fn set_critical_stretch(&mut self, pair: [u8; 2], stretch: f64) -> Result<()> {
        for class in self.classes_of(pair)? {
            self.critical_stretch[class] = stretch;
        }
        Ok(())
    }

    /// Sets a factor of the critical stretch for every point, for example
    /// [`StrengthScatter::factors`](super::StrengthScatter::factors). A bond has the mean factor of its end
    /// points.
    ///
    /// # Errors
    /// A number of factors other than the number of points.
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

    /// Sets the constant c of bonds between two materials.
    ///
    /// # Errors
    /// A material number out of range.
    pub fn set_micromodulus(&mut self, pair: [u8; 2], micromodulus: f64) -> Result<()> {
        for class in self.classes_of(pair)? {
            self.micromodulus[class] = micromodulus;
        }
        Ok(())
    }

    /// Returns an error if a material number is out of range.
    pub(super) fn check_pair(&self, pair: [u8; 2]) -> Result<()> {
        self.classes_of(pair).map(|_| ())
    }

    /// Table entries of bonds between two materials, for both directions.
    fn classes_of(&self, pair: [u8; 2]) -> Result<[usize; 2]> {
        let [a, b] = pair.map(usize::from);
        let last = a.max(b);
        if last >= self.count {
            return Err(PericlesError::OutOfRange {
                quantity: "the material number of an interface",
                value: last as f64,
                allowed: "0 to the number of materials less 1",
            });
        }
        Ok([a * self.count + b, b * self.count + a])
    }

    /// Returns the table by sites, the end points of bonds.
    pub(crate) fn on_sites(&self, sites: &Sites) -> Self {
        Self {
            of_point: sites.spread_numbers(&self.of_point),
            strength: Factors::new(sites.spread(self.strength.as_slice()).into_owned()),
            ..self.clone()
        }
    }

    /// Returns the table for other positions, given the material number of each and, if strengths scatter, its factor.
    pub(crate) fn at(&self, of_place: Vec<u8>, strengths: Vec<f64>) -> Self {
        Self {
            of_point: of_place,
            strength: Factors::new(strengths),
            ..self.clone()
        }
    }

    /// Returns the material number of each point.
    pub fn of_point(&self) -> &[u8] {
        &self.of_point
    }

    /// Returns the constant c of the bond between two points.
    pub fn micromodulus(&self, i: usize, j: usize) -> f64 {
        self.micromodulus[self.class(i, j)]
    }

    /// Returns the critical stretch s₀ of the bond between two points; infinite for unbreakable bonds.
    pub fn critical_stretch(&self, i: usize, j: usize) -> f64 {
        self.critical_stretch[self.class(i, j)] * self.strength.of_bond(i, j)
    }

    /// Returns the constant c of bonds between two materials.
    ///
    /// # Panics
    /// If a material number is out of range.
    pub fn pair_micromodulus(&self, [a, b]: [u8; 2]) -> f64 {
        self.micromodulus[usize::from(a) * self.count + usize::from(b)]
    }

    /// Returns the critical stretch s₀ of bonds between two materials.
    ///
    /// # Panics
    /// If a material number is out of range.
    pub fn pair_critical_stretch(&self, [a, b]: [u8; 2]) -> f64 {
        self.critical_stretch[usize::from(a) * self.count + usize::from(b)]
    }

    /// Returns whether all bonds have the same critical stretch.
    pub fn has_one_critical_stretch(&self) -> bool {
        let first = self.critical_stretch[0];
        let mut stretches = self.critical_stretch.iter();
        self.strength.is_uniform() && stretches.all(|stretch| *stretch == first)
    }

    /// Returns the smallest critical stretch of all bonds.
    pub fn smallest_critical_stretch(&self) -> f64 {
        let stretches = self.critical_stretch.iter();
        self.strength.smallest() * stretches.copied().fold(f64::INFINITY, f64::min)
    }

    /// Returns whether critical stretches scatter from point to point.
    pub fn scatters(&self) -> bool {
        !self.strength.is_uniform()
    }

    /// Returns the factor of the critical stretch of every point; empty if strengths do not scatter.
    pub(crate) fn strengths(&self) -> &[f64] {
        self.strength.as_slice()
    }

    /// Returns the factor of the critical stretch of the bond between two points.
    #[inline(always)]
    pub(crate) fn strength(&self, i: usize, j: usize) -> f64 {
        self.strength.of_bond(i, j)
    }

    /// Returns the smallest factor of all points.
    pub(crate) fn smallest_strength(&self) -> f64 {
        self.strength.smallest()
    }

    /// Returns the onset of softening of a pair of materials, given by its table entry; `None` if all bonds have the
    /// onset of the body.
    pub(crate) fn onset(&self, class: usize) -> Option<f64> {
        self.onset.get(class).copied()
    }

    /// Returns the critical stretches by pair of materials.
    pub(crate) fn critical_stretches(&self) -> &[f64] {
        &self.critical_stretch
    }

    /// Returns the table entry of the bond between two points.
    #[inline(always)]
    pub(crate) fn class(&self, i: usize, j: usize) -> usize {
        usize::from(self.of_point[i]) * self.count + usize::from(self.of_point[j])
    }
}

/// Checks the numbers of the materials of points.
///
/// # Errors
/// More than 256 materials; a number that is not below `count`.
pub fn check_materials(of_point: &[u8], count: usize) -> Result<()> {
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
            quantity: "the material number of a point",
            value: f64::from(number),
            allowed: "0 to the number of materials less 1",
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
    fn bonds_between_materials_follow_the_interface_rule() {
        let two = [constants(3.0, 0.01), constants(6.0, f64::INFINITY)];
        let mixed = |rule| {
            MaterialPairs::new(vec![0, 1, 1], &two, rule)
                .unwrap()
                .micromodulus(0, 2)
        };
        assert_eq!(mixed(InterfaceRule::Harmonic), 4.0);
        assert_eq!(mixed(InterfaceRule::Arithmetic), 4.5);
        assert_eq!(mixed(InterfaceRule::Weaker), 3.0);
        let mut classes = MaterialPairs::new(vec![0, 1, 1], &two, InterfaceRule::Weaker).unwrap();
        assert_eq!(classes.micromodulus(1, 2), 6.0);
        assert_eq!(classes.critical_stretch(2, 0), 0.01);
        assert_eq!(classes.critical_stretch(1, 2), f64::INFINITY);
        classes.set_critical_stretch([1, 0], 0.002).unwrap();
        assert!(classes.set_critical_stretch([0, 3], 0.002).is_err());
        assert_eq!(classes.critical_stretch(0, 1), 0.002);
        assert_eq!(classes.critical_stretch(2, 0), 0.002);
        assert_eq!(classes.smallest_critical_stretch(), 0.002);
        assert!(MaterialPairs::new(vec![2], &two, InterfaceRule::Weaker).is_err());
    }
}
