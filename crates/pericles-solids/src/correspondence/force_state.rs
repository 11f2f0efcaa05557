//! The force state of correspondence materials.

use std::borrow::Cow;

use pericles::lanes::{F64x8, Lanes};
use pericles::operator::FiniteStrain;

use super::classical::ClassicalSolid;
use super::control::Control;
use super::material::CorrespondenceConstants;
use super::plasticity::History;
use crate::solid::ShapeTensor;
use crate::solid::{Bond, End, Family, HistorySize, NextHistory, Point, Solid, State, YieldScale};
use crate::tensor::{
    Matrix, combination, determinant, in_space, principal_axes, product, transpose, unit,
};

/// A correspondence material as a [`Solid`]; `TENSOR` states whether its control of zero-energy modes is a tensor
/// ([`Stabilisation::Wan`](super::Stabilisation::Wan)) or a number.
///
/// With K = Σ ω ξ ⊗ ξ, F = I + (Σ ω η ⊗ ξ) K⁻¹, P = ∂ψ/∂F and z = ξ + η − F ξ, the force state is
/// T⟨ξ⟩ = P K⁻¹ ξ + Z z per unit of ω, and W = ψ(F) + ½ Σ ω z·Z z. The values of a point are the push
/// P K⁻¹ − Z (F − I), and Z. In plastic flow Z is multiplied by the ratio of the secant shear modulus to the elastic one,
/// because an elastic control would carry stress beyond the yield stress where the strain varies within the horizon. The
/// energy that it loses is dissipated. If fewer than D + 1 bonds remain, or the condition number of K exceeds 10⁶, the
/// bonds do not determine F.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ForceState<const TENSOR: bool>(pub CorrespondenceConstants);

/// Largest ratio of the stiffness of a damaged point to that of the undamaged one. The stiffness grows with the largest
/// principal value of K⁻¹: with few bonds, or bonds of similar directions, a point would oscillate faster than the time
/// step allows. The energy of a point whose K⁻¹ exceeds this ratio is multiplied by a factor that keeps the stiffness at
/// it.
const STIFFENING: f64 = 4.0;

/// K⁻¹ and Z of a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointShape<const D: usize> {
    inverse: Matrix<D>,
    control: Control<D>,
    /// Largest principal value of K⁻¹, 1/(m² of weighted volume).
    largest: f64,
    /// c/δ V_δ/Σ w b V of the undamaged point, N/m⁷.
    spring: f64,
    /// Factor of the energy of the point, at most 1; see [`STIFFENING`]. The control includes it.
    share: f64,
}

impl<const D: usize> PointShape<D> {
    /// Sets the values of a push s P K⁻¹ − Z H and of the control.
    fn values_into(
        &self,
        stress: &Matrix<D>,
        gradient: &Matrix<D>,
        control: &Control<D>,
        values: &mut [f64],
    ) {
        let push = product(stress, &self.inverse);
        let push = push.map(|row| row.map(|entry| self.share * entry));
        let push = combination(1.0, &push, -1.0, &control.times(gradient));
        for (value, entry) in values.iter_mut().zip(push.iter().flatten()) {
            *value = *entry;
        }
        match control {
            Control::Scalar(z) => values[D * D..].fill(*z),
            Control::Tensor(z) => {
                for (value, (a, b)) in values[D * D..].iter_mut().zip(places::<D>()) {
                    *value = z[a][b];
                }
            }
        }
    }
}

/// Returns the factor of the control of zero-energy modes at an accumulated plastic strain after the history.
fn control_ratio(point: &ClassicalSolid, history: &History, accumulated: f64) -> f64 {
    let ratio = point.secant_ratio(accumulated);
    // A yield stress that grows as a body cools does not restore the control, which would create energy.
    ratio.min(history.ratio)
}

/// Returns row and column of the components of a symmetric tensor, the diagonal first.
fn places<const D: usize>() -> impl Iterator<Item = (usize, usize)> {
    let diagonal = (0..D).map(|a| (a, a));
    diagonal.chain((0..D).flat_map(|a| (a + 1..D).map(move |b| (a, b))))
}

impl<const TENSOR: bool> ForceState<TENSOR> {
    /// [`Solid::state`] from Σ ω η ⊗ ξ: the part that is not a loop over bonds. The control is that of the last step if
    /// it is frozen.
    #[inline(never)]
    fn state_of_moment<const D: usize>(
        &self,
        at: &Point<'_, PointShape<D>, D>,
        (moment, is_frozen): (&Matrix<D>, bool),
        out: &mut State<'_>,
    ) -> f64 {
        let shape = at.shape;
        let gradient = product(moment, &shape.inverse);
        let f = combination(1.0, &unit::<D>(), 1.0, &gradient);
        let point = self.point_at(at);
        let solid = point.expanded(1.0 + at.thermal);
        let history = self.history_at(at);
        let state = solid.stress(&f, &history);
        let ratio = match is_frozen {
            true => history.ratio,
            false => control_ratio(&point, &history, history.accumulated + state.flow),
        };
        let control = shape.control.scaled(ratio);
        shape.values_into(&state.stress, &gradient, &control, out.values);
        determinant(&in_space(&f, 1.0)) - 1.0
    }

    /// [`Solid::state_change`] from Σ ω η ⊗ ξ and its change.
    #[inline(never)]
    fn change_of_moment<const D: usize>(
        &self,
        at: &Point<'_, PointShape<D>, D>,
        moments: [&Matrix<D>; 2],
        out: &mut State<'_>,
    ) {
        let shape = at.shape;
        let [gradient, change] = moments.map(|moment| product(moment, &shape.inverse));
        let f = combination(1.0, &unit::<D>(), 1.0, &gradient);
        let point = self.point_at(at);
        let solid = point.expanded(1.0 + at.thermal);
        let history = self.history_at(at);
        let flow = match self.0.point.plasticity {
            Some(_) => solid.stress(&f, &history).flow,
            None => 0.0,
        };
        let ratio = control_ratio(&point, &history, history.accumulated + flow);
        let control = shape.control.scaled(ratio);
        let stress = solid.stress_change(&f, &change, &history);
        shape.values_into(&stress, &change, &control, out.values);
        // The change of the control with the plastic strain is neglected: it would make the tangent unsymmetric.
        out.values[D * D..].fill(0.0);
    }

    /// [`Solid::advance`] from Σ ω η ⊗ ξ and Σ ω z ⊗ z.
    #[inline(never)]
    fn advance_of_moment<const D: usize>(
        &self,
        at: &Point<'_, PointShape<D>, D>,
        [moment, left]: [&Matrix<D>; 2],
        next: &mut NextHistory<'_>,
    ) -> f64 {
        let gradient = product(moment, &at.shape.inverse);
        let f = combination(1.0, &unit::<D>(), 1.0, &gradient);
        let point = self.point_at(at);
        let solid = point.expanded(1.0 + at.thermal);
        let before = self.history_at(at);
        let (mut history, work) = solid.advanced(&f, &before);
        history.control = 0.5 * at.shape.control.contraction(left);
        history.ratio = control_ratio(&point, &before, history.accumulated);
        history.keep(next.history);
        // With Z in force at both ends of a step, the loss is ½ (Z_before − Z_after) z_before z_after.
        let softened = before.ratio - history.ratio;
        at.shape.share * work + softened * 0.5 * (before.control + history.control)
    }

    /// Returns F − I from Σ ω η ⊗ ξ.
    #[inline(never)]
    fn gradient_of_moment<const D: usize>(shape: &PointShape<D>, moment: &Matrix<D>) -> Matrix<D> {
        product(moment, &shape.inverse)
    }

    /// Returns Σ ω z ⊗ z, with which the energy density of the control of the elastic material is ½ Z : Σ ω z ⊗ z.
    #[inline(always)]
    fn unresolved<T: Lanes, const D: usize>(
        at: &Point<'_, PointShape<D>, D>,
        gradient: &Matrix<D>,
    ) -> Matrix<D> {
        let mut sums = [[T::splat(0.0); D]; D];
        for batch in 0..at.family.batches() {
            let bond = at.family.bond::<T>(batch);
            let mut z = bond.eta;
            for a in 0..D {
                for b in 0..D {
                    z[a] = z[a] - T::splat(gradient[a][b]) * bond.xi[b];
                }
            }
            for a in 0..D {
                for b in 0..D {
                    sums[a][b] = (bond.weight * z[a]).mul_add(z[b], sums[a][b]);
                }
            }
        }
        let mut left = [[0.0; D]; D];
        for a in 0..D {
            for b in 0..D {
                left[a][b] = F64x8(sums[a][b].to_array()).sum();
            }
        }
        left
    }

    /// Returns the solid with the plastic constants of a point.
    fn point_at<S, const D: usize>(&self, at: &Point<'_, S, D>) -> Cow<'_, ClassicalSolid> {
        match &self.0.point.plasticity {
            Some(plasticity) if at.yields != YieldScale::ONE => Cow::Owned(ClassicalSolid {
                plasticity: Some(plasticity.scaled(at.yields)),
                ..self.0.point
            }),
            _ => Cow::Borrowed(&self.0.point),
        }
    }

    fn history_at<S, const D: usize>(&self, at: &Point<'_, S, D>) -> History {
        match at.history.len() >= History::KEPT {
            true => History::of(at.history),
            false => History::default(),
        }
    }

    /// Adds Z x.
    #[inline(always)]
    fn add_control<T: Lanes, const D: usize>(end: &End<T>, x: &[T; D], out: &mut [T; D]) {
        let z = |number: usize| end.values[D * D + number];
        for a in 0..D {
            out[a] = z(if TENSOR { a } else { 0 }).mul_add(x[a], out[a]);
        }
        if TENSOR {
            let mut number = D;
            for a in 0..D {
                for b in a + 1..D {
                    out[a] = z(number).mul_add(x[b], out[a]);
                    out[b] = z(number).mul_add(x[a], out[b]);
                    number += 1;
                }
            }
        }
    }

    /// Returns A ξ with the push A of an end.
    #[inline(always)]
    fn push<T: Lanes, const D: usize>(end: &End<T>, xi: &[T; D]) -> [T; D] {
        let mut out = [T::splat(0.0); D];
        for a in 0..D {
            for b in 0..D {
                out[a] = end.values[a * D + b].mul_add(xi[b], out[a]);
            }
        }
        out
    }
}

impl<const TENSOR: bool, const D: usize> Solid<D> for ForceState<TENSOR> {
    type Kinematics = FiniteStrain;
    type Shape = PointShape<D>;
    const VALUES: usize = D * D + if TENSOR { D * (D + 1) / 2 } else { 1 };
    const NEEDS_POSITIVE_VOLUME: bool = true;
    const HAS_STRESS: bool = true;

    fn shape(
        &self,
        family: &Family<'_, D>,
        before: Option<&PointShape<D>>,
    ) -> Option<PointShape<D>> {
        let inverse = ShapeTensor::of(family).inverse()?;
        let spring = match before {
            Some(before) => before.spring,
            None => {
                let mut weight = 0.0;
                for batch in 0..family.batches() {
                    weight += family.bond::<F64x8>(batch).weight.sum();
                }
                self.0.spring() / weight
            }
        };
        let (values, _) = principal_axes(&inverse);
        let largest = values.into_iter().fold(0.0, f64::max);
        let limit = before.map_or(f64::INFINITY, |before| STIFFENING * before.largest);
        let share = (limit / largest).min(1.0);
        let control = self
            .0
            .stabilisation
            .control(&self.0.point, &inverse, spring);
        Some(PointShape {
            inverse,
            control: control.scaled(share),
            largest,
            spring,
            share,
        })
    }

    #[inline(always)]
    fn state<T: Lanes>(&self, at: &Point<'_, PointShape<D>, D>, out: &mut State<'_>) -> f64 {
        let moment = at.family.moment::<T>(&at.family);
        self.state_of_moment(at, (&moment, false), out)
    }

    #[inline(always)]
    fn state_change<T: Lanes>(
        &self,
        at: &Point<'_, PointShape<D>, D>,
        direction: &Family<'_, D>,
        out: &mut State<'_>,
    ) {
        let now = at.family.moment::<T>(&at.family);
        let change = at.family.moment::<T>(direction);
        self.change_of_moment(at, [&now, &change], out);
    }

    #[inline(always)]
    fn pull<T: Lanes>(end: &End<T>, bond: &Bond<T, D>) -> [T; D] {
        let mut pull = Self::push(end, &bond.xi);
        Self::add_control(end, &bond.eta, &mut pull);
        pull
    }

    #[inline(always)]
    fn pull_change<T: Lanes>(
        end: &End<T>,
        change: &End<T>,
        bond: &Bond<T, D>,
        moved: [T; D],
    ) -> [T; D] {
        let mut pull = Self::push(change, &bond.xi);
        Self::add_control(end, &moved, &mut pull);
        pull
    }

    #[inline(always)]
    fn energy<T: Lanes>(&self, at: &Point<'_, PointShape<D>, D>) -> f64 {
        let shape = at.shape;
        let moment = at.family.moment::<T>(&at.family);
        let gradient = product(&moment, &shape.inverse);
        let f = combination(1.0, &unit::<D>(), 1.0, &gradient);
        let point = self.point_at(at);
        let solid = point.expanded(1.0 + at.thermal);
        let history = self.history_at(at);
        let state = solid.stress(&f, &history);
        let ratio = control_ratio(&point, &history, history.accumulated + state.flow);
        let control = (shape.control).contraction(&Self::unresolved::<T, D>(at, &gradient));
        shape.share * state.energy + ratio * 0.5 * control
    }

    /// The control is that of the last step.
    fn potential(&self, at: &Point<'_, PointShape<D>, D>) -> f64 {
        let moment = at.family.moment::<F64x8>(&at.family);
        let gradient = product(&moment, &at.shape.inverse);
        let f = combination(1.0, &unit::<D>(), 1.0, &gradient);
        let point = self.point_at(at);
        let solid = point.expanded(1.0 + at.thermal);
        let history = self.history_at(at);
        let elastic = solid.stress(&f, &history).energy;
        let (_, work) = solid.advanced(&f, &history);
        let ratio = history.ratio;
        let left = Self::unresolved::<F64x8, D>(at, &gradient);
        let control = at.shape.control.contraction(&left);
        at.shape.share * (elastic + work) + ratio * 0.5 * control
    }

    fn potential_state(&self, at: &Point<'_, PointShape<D>, D>, out: &mut State<'_>) {
        let moment = at.family.moment::<F64x8>(&at.family);
        self.state_of_moment(at, (&moment, true), out);
    }

    /// H : H ≤ Σ ω |F ξ − ξ|²/K_min with the smallest principal value of K, so that k is the larger of the stiffest modulus
    /// over K_min and the largest principal value of Z.
    fn stiffness(&self, shape: &PointShape<D>) -> f64 {
        let stress = shape.share * self.0.stiffest() * shape.largest;
        stress.max(shape.control.largest())
    }

    fn stiffening(&self) -> f64 {
        STIFFENING.sqrt()
    }

    fn history(&self) -> HistorySize {
        let yields = self.0.point.plasticity.is_some();
        HistorySize {
            per_point: if yields { History::KEPT } else { 0 },
            per_bond: 0,
        }
    }

    fn start_history(&self, history: &mut [f64]) {
        if history.len() >= History::KEPT {
            History::default().keep(history);
        }
    }

    #[inline(always)]
    fn advance<T: Lanes>(
        &self,
        at: &Point<'_, PointShape<D>, D>,
        next: &mut NextHistory<'_>,
    ) -> f64 {
        if self.0.point.plasticity.is_none() {
            return 0.0;
        }
        let moment = at.family.moment::<T>(&at.family);
        let gradient = Self::gradient_of_moment(at.shape, &moment);
        let left = Self::unresolved::<T, D>(at, &gradient);
        self.advance_of_moment(at, [&moment, &left], next)
    }

    /// The accumulated plastic strain ∫ √(2/3 d_p : d_p) dt.
    fn plastic_strain(&self, history: &[f64]) -> Option<f64> {
        self.0.point.plasticity?;
        Some(History::of(history).accumulated)
    }

    /// σ = P Fᵀ/J
    fn stress(&self, at: &Point<'_, PointShape<D>, D>) -> Matrix<D> {
        let moment = at.family.moment::<F64x8>(&at.family);
        let gradient = product(&moment, &at.shape.inverse);
        let f = combination(1.0, &unit::<D>(), 1.0, &gradient);
        let point = self.point_at(at);
        let solid = point.expanded(1.0 + at.thermal);
        let state = solid.stress(&f, &self.history_at(at));
        let volume = determinant(&in_space(&f, state.across));
        let stress = product(&state.stress, &transpose(&f));
        stress.map(|row| row.map(|entry| entry / volume))
    }
}
