//! Sums over the bonds of a point: viscous steps and trial states.

use std::marker::PhantomData;

use pericles::lanes::{F64x8, Lanes};
use pericles::operator::Kinematics;

use super::law::{MOST_TERMS, Yield};
use super::update::{Relaxation, Trial, mean_square};
use crate::solid::{Family, Point};

/// Weighted volumes of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InelasticShape {
    /// m of the undamaged point, m⁵ for a dimensionless influence function.
    pub volume: f64,
    /// Σ ω r² of the intact bonds.
    pub intact: f64,
    /// √(2 ψ₀), the norm of the deviatoric force state at first yield; infinite for points that do not yield.
    pub strength: f64,
}

/// Stored numbers of bonds: the stretch at the end of the last step, followed by the plastic stretch or by the
/// back-stretches of the viscous terms.
pub(super) const LAST: usize = 0;
pub(super) const INELASTIC: usize = 1;

/// Stored numbers of points: equivalent plastic strain, and plastic multiplier, whose change times the deviatoric force
/// state divided by w is the change of the plastic extensions.
pub(super) const PLASTIC_STRAIN: usize = 0;
pub(super) const MULTIPLIER: usize = 1;

/// A viscous step of a point.
pub(super) struct ViscousStep {
    pub relaxation: Relaxation,
    /// Means of the back-stretches less the means of the stretches at the start and the end of the step.
    pub shifts: [[f64; 2]; MOST_TERMS],
    /// Σ ω r² ψ.
    pub extension: f64,
}

/// A trial state of a plastic point.
pub(super) struct PlasticStep {
    pub trial: Trial,
    /// Mean of ψ − x.
    pub mean: f64,
    /// Σ ω r² ψ.
    pub extension: f64,
}

/// Returns 1/x, zero for points without bonds.
pub(super) fn inverse(x: f64) -> f64 {
    if x > 0.0 { 1.0 / x } else { 0.0 }
}

#[inline(always)]
pub(super) fn sum<T: Lanes>(lanes: T) -> f64 {
    F64x8(lanes.to_array()).sum()
}

/// Returns ω r² and ψ of a batch.
#[inline(always)]
pub(super) fn bond<T: Lanes, K: Kinematics, const D: usize>(
    family: &Family<'_, D>,
    batch: usize,
) -> [T; 2] {
    let bond = family.bond::<T>(batch);
    [bond.weight * bond.square, bond.stretch::<K>()]
}

/// Returns Σ ω r² ψ.
#[inline(always)]
pub(super) fn extension<T: Lanes, K: Kinematics, const D: usize>(family: &Family<'_, D>) -> f64 {
    let mut total = T::splat(0.0);
    for batch in 0..family.batches() {
        let [weight, stretch] = bond::<T, K, D>(family, batch);
        total = weight.mul_add(stretch, total);
    }
    sum(total)
}

/// A point of a material, with its constants divided by m.
pub(super) struct At<'a, K, const D: usize> {
    pub point: &'a Point<'a, InelasticShape, D>,
    /// A/m and B/m.
    pub pressure: f64,
    pub stiffness: f64,
    pub kinematics: PhantomData<K>,
}

impl<K: Kinematics, const D: usize> At<'_, K, D> {
    /// Returns θ for Σ ω r² ψ of total stretches, and for stretches less the thermal stretch.
    #[inline(always)]
    pub fn dilatations(&self, extension: f64) -> [f64; 2] {
        let InelasticShape { volume, intact, .. } = self.point.shape;
        let thermal = self.point.thermal * intact;
        let over = D as f64 / volume;
        [over * extension, over * (extension - thermal)]
    }

    /// Returns the step of a viscous point with these terms.
    #[inline(always)]
    pub fn viscous<T: Lanes>(&self, relaxation: Relaxation) -> ViscousStep {
        let (family, zero) = (&self.point.family, T::splat(0.0));
        let (mut before, mut now, mut backs) = (zero, zero, [zero; MOST_TERMS]);
        for batch in 0..family.batches() {
            let [weight, stretch] = bond::<T, K, D>(family, batch);
            before = weight.mul_add(self.point.bond_history(batch, LAST), before);
            now = weight.mul_add(stretch, now);
            for term in 0..relaxation.terms {
                let back = self.point.bond_history::<T>(batch, INELASTIC + term);
                backs[term] = weight.mul_add(back, backs[term]);
            }
        }
        let (before, now) = (sum(before), sum(now));
        let over = inverse(self.point.shape.intact);
        let mut shifts = [[0.0; 2]; MOST_TERMS];
        for term in 0..relaxation.terms {
            let back = sum(backs[term]);
            shifts[term] = [(back - before) * over, (back - now) * over];
        }
        ViscousStep {
            relaxation,
            shifts,
            extension: now,
        }
    }

    /// Returns a back-stretch at the end of the step for the stretches of a batch.
    #[inline(always)]
    pub fn back<T: Lanes>(&self, step: &ViscousStep, batch: usize, term: usize, stretch: T) -> T {
        let last = self.point.bond_history::<T>(batch, LAST);
        let old = self.point.bond_history::<T>(batch, INELASTIC + term);
        let [start, end] = step.shifts[term];
        let (start, end) = (last + T::splat(start), stretch + T::splat(end));
        let new = T::splat(step.relaxation.gain[term]).mul_add(start - old, old);
        T::splat(step.relaxation.slope[term]).mul_add(end - start, new)
    }

    /// Returns the trial state of a plastic point.
    #[inline(always)]
    pub fn plastic<T: Lanes>(&self) -> PlasticStep {
        let (point, zero) = (self.point, T::splat(0.0));
        let (mut whole, mut elastic) = (zero, zero);
        for batch in 0..point.family.batches() {
            let [weight, stretch] = bond::<T, K, D>(&point.family, batch);
            let x = point.bond_history::<T>(batch, INELASTIC);
            whole = weight.mul_add(stretch, whole);
            elastic = weight.mul_add(stretch - x, elastic);
        }
        let mean = sum(elastic) * inverse(point.shape.intact);
        let (mut norm, mut square) = (zero, zero);
        for batch in 0..point.family.batches() {
            let [weight, stretch] = bond::<T, K, D>(&point.family, batch);
            let x = point.bond_history::<T>(batch, INELASTIC);
            let deviator = stretch - x - T::splat(mean);
            let term = weight * deviator * deviator;
            square = square + term;
            norm = norm + point.family.influence::<T>(batch) * term;
        }
        PlasticStep {
            trial: Trial {
                strength: point.yields.stress * point.shape.strength,
                strain: point.history[PLASTIC_STRAIN],
                norm: self.stiffness * sum(norm).sqrt(),
                equivalent: (mean_square(D) / point.shape.volume * sum(square)).sqrt(),
            },
            mean,
            extension: sum(whole),
        }
    }
}

/// Returns the change of γ, the factor that returns the deviatoric force state to the yield surface, in a direction in
/// which the mean of ψ changes by `mean`.
#[inline(always)]
pub(super) fn factor_change<T: Lanes, K: Kinematics, const D: usize>(
    at: &At<'_, K, D>,
    law: &Yield,
    step: &PlasticStep,
    direction: &Family<'_, D>,
    mean: T,
) -> f64 {
    let (point, zero) = (at.point, T::splat(0.0));
    let (mut norm, mut square) = (zero, zero);
    for batch in 0..point.family.batches() {
        let bond = point.family.bond::<T>(batch);
        let x = point.bond_history::<T>(batch, INELASTIC);
        let deviator = bond.stretch::<K>() - x - T::splat(step.mean);
        let change = bond.stretch_change::<K>(direction.eta(batch)) - mean;
        let term = bond.weight * bond.square * deviator * change;
        square = square + term;
        norm = norm + point.family.influence::<T>(batch) * term;
    }
    let trial = &step.trial;
    let norm = at.stiffness * at.stiffness * sum(norm) * inverse(trial.norm);
    let equivalent = mean_square(D) / point.shape.volume * sum(square) * inverse(trial.equivalent);
    trial.factor_change(law, norm, equivalent)
}
