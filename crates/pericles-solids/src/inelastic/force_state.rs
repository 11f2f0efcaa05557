//! The force state of linear peridynamic solids with viscous or plastic shear.

use std::marker::PhantomData;

use pericles::lanes::{F64x8, LANES, Lanes};
use pericles::operator::Kinematics;

use super::law::{Inelasticity, ViscousTerm};
use super::point::{
    At, INELASTIC, InelasticShape, LAST, MULTIPLIER, PLASTIC_STRAIN, PlasticStep, bond, extension,
    factor_change, inverse, sum,
};
use super::update::{Relaxation, mean_square};
use crate::solid::{Family, HistorySize, NextHistory, Point, Solid, State};

/// A linear peridynamic solid with an inelastic law of its shear.
///
/// With the stretch ψ of a bond less the thermal stretch, the weighted volume m = Σ ω r² of the undamaged point and
/// θ = (D/m) Σ ω r² ψ, the force state is t = [A θ + B (ψ − x)]/m per unit of ω r with the inelastic stretch x of the
/// bond. Inelastic stretches are updated at the end of each accepted step. In between, the force at time t and
/// displacement u belongs to a step from the last accepted state to t: stages and static solvers include the viscosity
/// and plasticity of the current step. The energy is that at the last inelastic stretches.
///
/// For influence functions other than the constant one, the plastic flow of a point is radial but not normal
/// to the yield surface, and the tangent of yielding points is not symmetric.
#[derive(Debug, Clone)]
pub struct InelasticSolid<K> {
    /// A, Pa.
    pub dilatational: f64,
    /// B, Pa.
    pub deviatoric: f64,
    /// Law of the shear.
    pub law: Inelasticity,
    kinematics: PhantomData<K>,
}

impl<K: Kinematics> InelasticSolid<K> {
    /// Creates a solid with the constants A and B, Pa.
    pub fn new([dilatational, deviatoric]: [f64; 2], law: Inelasticity) -> Self {
        Self {
            dilatational,
            deviatoric,
            law,
            kinematics: PhantomData,
        }
    }

    #[inline(always)]
    fn at<'a, const D: usize>(&self, point: &'a Point<'a, InelasticShape, D>) -> At<'a, K, D> {
        At {
            point,
            pressure: self.dilatational / point.shape.volume,
            stiffness: self.deviatoric / point.shape.volume,
            kinematics: PhantomData,
        }
    }
}

impl<K: Kinematics, const D: usize> Solid<D> for InelasticSolid<K> {
    type Kinematics = K;
    type Shape = InelasticShape;
    const BOND_VALUES: bool = true;

    fn reads_influence(&self) -> bool {
        matches!(self.law, Inelasticity::Plastic(_))
    }

    fn shape(
        &self,
        family: &Family<'_, D>,
        before: Option<&InelasticShape>,
    ) -> Option<InelasticShape> {
        let (mut volume, mut square) = (0.0, 0.0);
        for batch in 0..family.batches() {
            let bond = family.bond::<F64x8>(batch);
            let weight = bond.weight * bond.square;
            volume += weight.sum();
            square += (weight * family.influence(batch)).sum();
        }
        if volume <= 0.0 {
            return None;
        }
        let strength = match &self.law {
            Inelasticity::Plastic(law) => law.stress * (mean_square(D) * square).sqrt() / volume,
            Inelasticity::Elastic | Inelasticity::Viscous(_) => f64::INFINITY,
        };
        let undamaged = before.copied().unwrap_or(InelasticShape {
            volume,
            intact: volume,
            strength,
        });
        Some(InelasticShape {
            intact: volume,
            ..undamaged
        })
    }

    #[inline(always)]
    fn state<T: Lanes>(&self, point: &Point<'_, InelasticShape, D>, out: &mut State<'_>) -> f64 {
        let (at, family) = (self.at(point), &point.family);
        let thermal = T::splat(point.thermal);
        let s = T::splat(at.stiffness);
        match &self.law {
            Inelasticity::Elastic => {
                let [whole, theta] = at.dilatations(extension::<T, K, D>(family));
                for batch in 0..family.batches() {
                    let [_, stretch] = bond::<T, K, D>(family, batch);
                    out.set_bonds(
                        batch,
                        s.mul_add(stretch - thermal, T::splat(at.pressure * theta)),
                    );
                }
                whole
            }
            Inelasticity::Viscous(terms) => {
                let step = at.viscous::<T>(Relaxation::new(terms, point.dt));
                let [whole, theta] = at.dilatations(step.extension);
                for batch in 0..family.batches() {
                    let [_, stretch] = bond::<T, K, D>(family, batch);
                    let mut elastic = stretch - thermal;
                    for term in 0..step.relaxation.terms {
                        let share = T::splat(-step.relaxation.share[term]);
                        elastic = share.mul_add(at.back(&step, batch, term, stretch), elastic);
                    }
                    out.set_bonds(batch, s.mul_add(elastic, T::splat(at.pressure * theta)));
                }
                whole
            }
            Inelasticity::Plastic(law) => {
                let step = at.plastic::<T>();
                let [whole, theta] = at.dilatations(step.extension);
                let flow = T::splat(1.0 - step.trial.factor(&law.scaled(point.yields)));
                for batch in 0..family.batches() {
                    let [_, stretch] = bond::<T, K, D>(family, batch);
                    let elastic = stretch - point.bond_history::<T>(batch, INELASTIC);
                    let deviator = elastic - T::splat(step.mean);
                    let elastic = elastic - flow * deviator - thermal;
                    out.set_bonds(batch, s.mul_add(elastic, T::splat(at.pressure * theta)));
                }
                whole
            }
        }
    }

    #[inline(always)]
    fn state_change<T: Lanes>(
        &self,
        point: &Point<'_, InelasticShape, D>,
        direction: &Family<'_, D>,
        out: &mut State<'_>,
    ) {
        let (at, family) = (self.at(point), &point.family);
        let mut total = T::splat(0.0);
        for batch in 0..family.batches() {
            let bond = family.bond::<T>(batch);
            let change = bond.stretch_change::<K>(direction.eta(batch));
            total = (bond.weight * bond.square).mul_add(change, total);
        }
        let total = sum(total);
        let pressure = T::splat(at.pressure * D as f64 / point.shape.volume * total);
        let mean = T::splat(total * inverse(point.shape.intact));
        let s = T::splat(at.stiffness);
        // The elastic stretch ψ − x of a bond changes by a multiple of the change of ψ, another one of its mean, and a
        // multiple of its deviator.
        let (of_bond, of_mean, step) = match &self.law {
            Inelasticity::Elastic => (1.0, 0.0, None),
            Inelasticity::Viscous(terms) => {
                let relaxed = Relaxation::new(terms, point.dt).relaxed();
                (1.0 - relaxed, relaxed, None)
            }
            Inelasticity::Plastic(law) => {
                let (step, law) = (at.plastic::<T>(), law.scaled(point.yields));
                let factor = step.trial.factor(&law);
                (factor, 1.0 - factor, Some((law, step)))
            }
        };
        // No closure here: without inlining it would use baseline instructions.
        let turn = match &step {
            Some((law, step)) => factor_change::<T, K, D>(&at, law, step, direction, mean),
            None => 0.0,
        };
        for batch in 0..family.batches() {
            let bond = family.bond::<T>(batch);
            let change = bond.stretch_change::<K>(direction.eta(batch));
            let mut elastic = T::splat(of_bond) * change + T::splat(of_mean) * mean;
            if let Some((_, step)) = &step {
                let x = point.bond_history::<T>(batch, INELASTIC);
                let deviator = bond.stretch::<K>() - x - T::splat(step.mean);
                elastic = T::splat(turn).mul_add(deviator, elastic);
            }
            out.set_bonds(batch, s.mul_add(elastic, pressure));
        }
    }

    /// W = A θ²/(2 D) + (B/2 m) Σ ω r² (ψ² − 2 ψ x + c) with c = x² for plastic, Σ λ_k ψ_k² for viscous materials.
    #[inline(always)]
    fn energy<T: Lanes>(&self, point: &Point<'_, InelasticShape, D>) -> f64 {
        let (at, family) = (self.at(point), &point.family);
        let [_, theta] = at.dilatations(extension::<T, K, D>(family));
        let mut squares = T::splat(0.0);
        for batch in 0..family.batches() {
            let [weight, stretch] = bond::<T, K, D>(family, batch);
            let stretch = stretch - T::splat(point.thermal);
            let square = match &self.law {
                Inelasticity::Elastic => stretch * stretch,
                Inelasticity::Plastic(_) => {
                    let elastic = stretch - point.bond_history::<T>(batch, INELASTIC);
                    elastic * elastic
                }
                Inelasticity::Viscous(terms) => {
                    let mut square = stretch * stretch;
                    for term in 0..terms.len() {
                        let back = point.bond_history::<T>(batch, INELASTIC + term);
                        let share = T::splat(terms[term].share);
                        square = (share * back).mul_add(back - stretch - stretch, square);
                    }
                    square
                }
            };
            squares = weight.mul_add(square, squares);
        }
        let bulk = self.dilatational / D as f64;
        0.5 * (bulk * theta * theta + at.stiffness * sum(squares))
    }

    /// The force state at the last inelastic stretches.
    fn potential_state(&self, point: &Point<'_, InelasticShape, D>, out: &mut State<'_>) {
        let (at, family) = (self.at::<D>(point), &point.family);
        let [_, theta] = at.dilatations(extension::<F64x8, K, D>(family));
        let lanes = |x: f64| F64x8([x; LANES]);
        for batch in 0..family.batches() {
            let [_, stretch] = bond::<F64x8, K, D>(family, batch);
            let mut elastic = stretch - lanes(point.thermal);
            match &self.law {
                Inelasticity::Elastic => {}
                Inelasticity::Plastic(_) => {
                    elastic = elastic - point.bond_history::<F64x8>(batch, INELASTIC);
                }
                Inelasticity::Viscous(terms) => {
                    for (term, ViscousTerm { share, .. }) in terms.iter().enumerate() {
                        let back = point.bond_history::<F64x8>(batch, INELASTIC + term);
                        elastic = elastic - lanes(*share) * back;
                    }
                }
            }
            let pull = lanes(at.stiffness) * elastic + lanes(at.pressure * theta);
            out.set_bonds(batch, pull);
        }
    }

    /// W ≤ ½ Σ k ω e² by Cauchy's inequality θ² ≤ (D²/m) Σ ω e²; viscosity and plasticity reduce the stiffness.
    fn stiffness(&self, shape: &InelasticShape) -> f64 {
        ((D as f64 * self.dilatational).max(0.0) + self.deviatoric) / shape.volume
    }

    fn history(&self) -> HistorySize {
        let (per_point, per_bond) = match &self.law {
            Inelasticity::Elastic => (0, 0),
            Inelasticity::Viscous(terms) => (0, 1 + terms.len()),
            Inelasticity::Plastic(_) => (2, 2),
        };
        HistorySize {
            per_point,
            per_bond,
        }
    }

    /// With hardening, all plastic work counts as dissipated.
    #[inline(always)]
    fn advance<T: Lanes>(
        &self,
        point: &Point<'_, InelasticShape, D>,
        next: &mut NextHistory<'_>,
    ) -> f64 {
        let (at, family) = (self.at(point), &point.family);
        let (mut dissipated, half) = (T::splat(0.0), T::splat(0.5));
        match &self.law {
            Inelasticity::Elastic => return 0.0,
            Inelasticity::Viscous(terms) => {
                let step = at.viscous::<T>(Relaxation::new(terms, point.dt));
                for batch in 0..family.batches() {
                    let [weight, stretch] = bond::<T, K, D>(family, batch);
                    let last = point.bond_history::<T>(batch, LAST);
                    for term in 0..terms.len() {
                        let old = point.bond_history::<T>(batch, INELASTIC + term);
                        let new = at.back(&step, batch, term, stretch);
                        let share = T::splat(terms[term].share);
                        let push = half * ((last - old) + (stretch - new));
                        dissipated = (share * weight * push).mul_add(new - old, dissipated);
                        next.set_bonds(batch, INELASTIC + term, new.masked(family.intact(batch)));
                    }
                    next.set_bonds(batch, LAST, stretch.masked(family.intact(batch)));
                }
            }
            Inelasticity::Plastic(law) => {
                let PlasticStep { trial, mean, .. } = at.plastic::<T>();
                let factor = trial.factor(&law.scaled(point.yields));
                for batch in 0..family.batches() {
                    let [weight, stretch] = bond::<T, K, D>(family, batch);
                    let last = point.bond_history::<T>(batch, LAST);
                    let old = point.bond_history::<T>(batch, INELASTIC);
                    let new = T::splat(1.0 - factor).mul_add(stretch - old - T::splat(mean), old);
                    let push = half * ((last - old) + (stretch - new));
                    dissipated = (weight * push).mul_add(new - old, dissipated);
                    next.set_bonds(batch, INELASTIC, new.masked(family.intact(batch)));
                    next.set_bonds(batch, LAST, stretch.masked(family.intact(batch)));
                }
                if factor < 1.0 {
                    next.history[PLASTIC_STRAIN] += (1.0 - factor) * trial.equivalent;
                    next.history[MULTIPLIER] += (1.0 / factor - 1.0) / at.stiffness;
                }
            }
        }
        at.stiffness * sum(dissipated)
    }

    fn plastic_strain(&self, history: &[f64]) -> Option<f64> {
        match self.law {
            Inelasticity::Plastic(_) => Some(history[PLASTIC_STRAIN]),
            Inelasticity::Elastic | Inelasticity::Viscous(_) => None,
        }
    }
}
