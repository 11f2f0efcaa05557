//! Failure criteria of bonds in terms of stress and strain.
//!
//! The *failure index* of a bond is a dimensionless number that is above one where the bond breaks. It is a function
//! of stress and strain, the means of both end points, so that both ends of a bond reach the same decision.

use std::fmt;
use std::sync::Arc;

use crate::error::{Result, positive};
use crate::solve::principal_axes;
use crate::units::quantity;

/// Stress and strain at a bond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BondState {
    /// Dimension D of the body; components beyond it are zero.
    pub dimension: usize,
    /// Mean stress of both end points, Pa.
    pub stress: [[f64; 3]; 3],
    /// Mean strain of both end points without thermal strain, dimensionless.
    pub strain: [[f64; 3]; 3],
    /// Unit vector along the deformed bond, in either sense.
    pub direction: [f64; 3],
    /// Stretch relative to the stress-free length.
    pub stretch: f64,
    /// Position and time.
    pub at: BondPlace,
}

/// Position, time and temperature of a bond, for criteria that depend on them.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BondPlace {
    /// Centre of the undeformed bond, m.
    pub place: [f64; 3],
    /// Time, s.
    pub t: f64,
    /// Mean temperature of both end points, K; zero for a body without temperatures.
    pub temperature: f64,
}

impl BondState {
    /// Returns the state of the bond between two points from the tensors of all points, 2 D² values: the D × D
    /// components of the stress, then the components of the strain. The vectors are ξ (the stress-free bond) and η.
    pub fn between<const D: usize>(
        tensor: impl Fn(usize, usize) -> f64,
        [i, j]: [usize; 2],
        [xi, eta]: [[f64; D]; 2],
        at: BondPlace,
    ) -> Self {
        let mean = |slot: usize| 0.5 * (tensor(slot, i) + tensor(slot, j));
        let (mut stress, mut strain) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
        for a in 0..D {
            for b in 0..D {
                stress[a][b] = mean(a * D + b);
                strain[a][b] = mean(D * D + a * D + b);
            }
        }
        let (mut square, mut length) = (0.0, 0.0);
        let mut direction = [0.0; 3];
        for c in 0..D {
            direction[c] = xi[c] + eta[c];
            square += xi[c] * xi[c];
            length += direction[c] * direction[c];
        }
        let length = length.sqrt();
        Self {
            dimension: D,
            stress,
            strain,
            direction: direction.map(|x| x / length),
            stretch: length / square.sqrt() - 1.0,
            at,
        }
    }

    /// Returns the normal stress n·σn on the plane across the bond, Pa; positive in tension.
    pub fn normal_stress(&self) -> f64 {
        quadratic(&self.stress, self.direction)
    }

    /// Returns the magnitude of the shear stress on the plane across the bond, Pa.
    pub fn shear_stress(&self) -> f64 {
        let normal = self.normal_stress();
        let mut square = 0.0;
        for (row, n) in self.stress.iter().zip(self.direction) {
            let traction: f64 = row.iter().zip(self.direction).map(|(s, n)| s * n).sum();
            square += (traction - normal * n).powi(2);
        }
        square.sqrt()
    }

    /// Returns the principal stresses in descending order, Pa; D of them.
    pub fn principal_stresses(&self) -> [f64; 3] {
        principal_values(self.dimension, &self.stress)
    }

    /// Returns the principal strains in descending order; D of them.
    pub fn principal_strains(&self) -> [f64; 3] {
        principal_values(self.dimension, &self.strain)
    }

    /// Returns the von Mises equivalent stress, Pa; in the plane of the components within it.
    pub fn equivalent_stress(&self) -> f64 {
        let s = &self.stress;
        let normal =
            (s[0][0] - s[1][1]).powi(2) + (s[1][1] - s[2][2]).powi(2) + (s[2][2] - s[0][0]).powi(2);
        let shear = s[0][1].powi(2) + s[1][2].powi(2) + s[2][0].powi(2);
        (0.5 * normal + 3.0 * shear).sqrt()
    }
}

/// Returns n·m n, with the same bits for n and −n.
fn quadratic(m: &[[f64; 3]; 3], n: [f64; 3]) -> f64 {
    let mut sum = 0.0;
    for a in 0..3 {
        for b in 0..3 {
            sum += m[a][b] * (n[a] * n[b]);
        }
    }
    sum
}

/// Returns the eigenvalues of a symmetric matrix within the first axes, in descending order; zeros follow.
fn principal_values(dimension: usize, m: &[[f64; 3]; 3]) -> [f64; 3] {
    match dimension {
        1 => [m[0][0], 0.0, 0.0],
        2 => {
            let (middle, half) = (0.5 * (m[0][0] + m[1][1]), 0.5 * (m[0][0] - m[1][1]));
            let radius = half.hypot(m[0][1]);
            [middle + radius, middle - radius, 0.0]
        }
        _ => {
            let mut values = principal_axes(*m).map(|axis| quadratic(m, axis));
            values.sort_unstable_by(|a, b| b.total_cmp(a));
            values
        }
    }
}

/// A failure criterion of bonds.
pub trait BondCriterion: fmt::Debug + Send + Sync {
    /// Returns the failure index: the bond breaks if it is above one. It must not depend on the sense of the
    /// direction; NaN means that the bond does not break.
    fn failure_index(&self, bond: &BondState) -> f64;

    /// Returns whether the index also depends on [`BondState::at`], which is known in
    /// bodies of state-based and correspondence materials on a neighbour list only.
    fn varies(&self) -> bool {
        false
    }

    /// Returns the criterion in words that complete "bonds break", for reports.
    fn words(&self) -> String;
}

/// The maximum principal stress criterion (Rankine): the index is the normal stress n·σn on the plane across the bond
/// over the tensile strength. It is largest for bonds along the axis of the largest principal stress, so that cracks
/// open across that axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrincipalStress {
    strength: f64,
}

impl PrincipalStress {
    /// Makes the criterion for a tensile strength, Pa.
    ///
    /// # Errors
    /// A strength that is not positive.
    pub fn new(strength: f64) -> Result<Self> {
        let strength = positive("the tensile strength", strength)?;
        Ok(Self { strength })
    }
}

impl BondCriterion for PrincipalStress {
    fn failure_index(&self, bond: &BondState) -> f64 {
        bond.normal_stress() / self.strength
    }

    fn words(&self) -> String {
        format!("at the principal stress {}", quantity(self.strength, "Pa"))
    }
}

/// A shared failure criterion; equal to its copies only.
#[derive(Debug, Clone)]
pub struct Criterion(Arc<dyn BondCriterion>);

impl Criterion {
    /// Shares a criterion.
    pub fn new(criterion: impl BondCriterion + 'static) -> Self {
        Self(Arc::new(criterion))
    }

    /// Returns the failure index of a bond.
    pub fn failure_index(&self, bond: &BondState) -> f64 {
        self.0.failure_index(bond)
    }

    /// Returns whether the index also depends on position, time or temperature.
    pub fn varies(&self) -> bool {
        self.0.varies()
    }

    /// Returns the criterion in words that complete "bonds break".
    pub fn words(&self) -> String {
        self.0.words()
    }
}

impl PartialEq for Criterion {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// Failure criteria of bonds by the materials of their ends. A bond between two materials breaks where one of their
/// criteria is met.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PairCriteria {
    materials: usize,
    /// Criteria by pair of materials; empty if no material has one.
    of_pair: Vec<[Option<Criterion>; 2]>,
}

impl PairCriteria {
    /// Makes the table of the materials of a body.
    pub fn new(materials: &[Option<Criterion>]) -> Self {
        if materials.iter().all(Option::is_none) {
            return Self::default();
        }
        let of = |a: &Option<Criterion>, b: &Option<Criterion>| [a.clone(), b.clone()];
        let pairs = materials
            .iter()
            .flat_map(|a| materials.iter().map(move |b| of(a, b)));
        Self {
            materials: materials.len(),
            of_pair: pairs.collect(),
        }
    }

    /// Removes the criteria of bonds between two materials, which break by other limits.
    pub fn remove(&mut self, [a, b]: [usize; 2]) {
        for [a, b] in [[a, b], [b, a]] {
            if let Some(pair) = self.of_pair.get_mut(a * self.materials + b) {
                *pair = [None, None];
            }
        }
    }

    /// Returns whether a criterion depends on position, time or temperature.
    pub fn vary(&self) -> bool {
        let mut all = self.of_pair.iter().flatten().flatten();
        all.any(Criterion::varies)
    }

    /// Returns whether no bond breaks by a criterion.
    pub fn is_empty(&self) -> bool {
        self.of_pair.iter().flatten().all(Option::is_none)
    }

    /// Returns the larger failure index of the criteria of two materials; −∞ if there is none.
    pub fn failure_index(&self, [a, b]: [usize; 2], bond: impl FnOnce() -> BondState) -> f64 {
        match self.of_pair.get(a * self.materials + b) {
            None | Some([None, None]) => f64::NEG_INFINITY,
            Some([Some(one), other]) if other.as_ref().is_none_or(|other| other == one) => {
                one.failure_index(&bond())
            }
            Some(pair) => {
                let bond = bond();
                let indices = pair.iter().flatten().map(|one| one.failure_index(&bond));
                indices.fold(f64::NEG_INFINITY, f64::max)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(stress: [[f64; 3]; 3], direction: [f64; 3]) -> BondState {
        BondState {
            dimension: 3,
            stress,
            strain: [[0.0; 3]; 3],
            direction,
            stretch: 0.0,
            at: BondPlace::default(),
        }
    }

    /// On a plane with the normal n, the traction σn has the normal part n·σn, and the square of the shear part is the
    /// rest of |σn|². Invariants do not depend on the axes.
    #[test]
    fn tractions_and_invariants_of_a_stress() {
        let stress = [[3.0, 1.0, -0.5], [1.0, -2.0, 0.7], [-0.5, 0.7, 0.4]];
        let n = [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0];
        let at = state(stress, n);
        let traction = stress.map(|row| row[0] * n[0] + row[1] * n[1] + row[2] * n[2]);
        let normal = traction[0] * n[0] + traction[1] * n[1] + traction[2] * n[2];
        let square: f64 = traction.iter().map(|x| x * x).sum();
        assert!((at.normal_stress() - normal).abs() < 1e-15);
        assert!((at.shear_stress().powi(2) - square + normal * normal).abs() < 1e-14);
        let [a, b, c] = at.principal_stresses();
        assert!(a > b && b > c);
        assert!((a + b + c - 1.4).abs() < 1e-14);
        let squares: f64 = stress.iter().flatten().map(|x| x * x).sum();
        assert!((a * a + b * b + c * c - squares).abs() < 1e-13);
        let mises = (0.5 * ((a - b).powi(2) + (b - c).powi(2) + (c - a).powi(2))).sqrt();
        assert!((at.equivalent_stress() - mises).abs() < 1e-14);
    }

    #[test]
    fn pairs_take_the_larger_index_and_interfaces_may_have_none() {
        let [weak, strong] = [1.0, 2.0].map(|s| Criterion::new(PrincipalStress::new(s).unwrap()));
        let stress = [[3.0, 0.0, 0.0], [0.0; 3], [0.0; 3]];
        let bond = || state(stress, [1.0, 0.0, 0.0]);
        let mut pairs = PairCriteria::new(&[Some(weak), Some(strong), None]);
        let index = |pairs: &PairCriteria, pair| pairs.failure_index(pair, bond);
        assert_eq!(index(&pairs, [0, 0]), 3.0);
        assert_eq!(index(&pairs, [1, 1]), 1.5);
        assert_eq!(index(&pairs, [1, 0]), 3.0);
        assert_eq!(index(&pairs, [1, 2]), 1.5);
        assert_eq!(index(&pairs, [2, 2]), f64::NEG_INFINITY);
        pairs.remove([0, 1]);
        assert_eq!(index(&pairs, [1, 0]), f64::NEG_INFINITY);
        assert!(PairCriteria::new(&[None, None]).is_empty());
        assert!(PrincipalStress::new(0.0).is_err());
    }
}
