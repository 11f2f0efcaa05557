//! End of a step of softening bonds: update of the largest stretches and of the dissipated energy.

use super::kernels::{Softened, groups_of, point_force};
use crate::domain::Field;
use crate::lanes::{LANES, Lanes, dot, for_each_instruction_set};
use crate::material::SofteningCurve;
use crate::neighbourhood::{BlockDamage, Tally};
use crate::operator::fast_law::VectorLaw;
use crate::operator::list::arrays::Bonds;
use crate::operator::records::Records;
use crate::operator::rows::Rows;
use crate::step_end::{BreakingBond, Path, StepEnd, relative_velocity};

/// Data of the end of a step read by the loops.
#[derive(Clone, Copy)]
pub(super) struct Advance<'a> {
    /// Curves and bits; the largest stretches are not used.
    pub kept: Softened<'a>,
    pub volumes: &'a [f64],
    /// The step that ends.
    pub step: &'a StepEnd<'a>,
    /// Mean velocities over the step, if it has any.
    pub velocity: Option<Field<'a>>,
}

/// State of a block of points.
pub(super) struct Part<'a> {
    pub damage: &'a mut BlockDamage,
    pub largest: &'a mut [f64],
}

impl Advance<'_> {
    /// Returns the energy dissipated by a bond whose largest stretch grows from `before` to `now`, J.
    ///
    /// If forces act for half of a step at each end, this is the energy that the lost fraction of the bond
    /// would dissipate as a breaking bond ([`StepEnd::dissipated`]), so that the energy balance of a linear
    /// bond is exact. For other paths it is the area under the softening curve, for any step length.
    fn dissipated<const D: usize>(
        &self,
        (curve, factor): (&SofteningCurve, f64),
        [before, now]: [f64; 2],
        bond: &BreakingBond<D>,
        length: f64,
    ) -> f64 {
        let [before, now] = [before / factor, now / factor];
        match self.step.path {
            // Initial stretches belong to the initial energy.
            _ if self.step.is_start() => 0.0,
            Path::MeanVelocity(_) => {
                (curve.retained(before) - curve.retained(now)) * self.step.dissipated(bond)
            }
            _ => {
                let area = curve.dissipated(now) - curve.dissipated(before);
                bond.weight * length * factor * factor * area
            }
        }
    }
}

/// Updates the largest stretches of the bonds of a point and records the dissipated energy, half for each
/// end.
#[cold]
#[inline(never)]
fn soften_row<L: VectorLaw, const D: usize>(
    bonds: &Bonds<'_>,
    rule: &Advance<'_>,
    u: &Records,
    i: usize,
    (intact, largest): (&mut [u8], &mut [f64]),
    tally: &mut Tally,
) {
    let list = bonds.list();
    let (first, here) = (list.start()[i], list.site(i));
    for k in 0..intact.len() {
        let group = first + k;
        let candidates = rule.kept.candidates(group, intact[k]);
        let neighbours = list.group(group);
        for lane in (0..LANES).filter(|lane| candidates >> lane & 1 == 1) {
            let j = neighbours[lane];
            let Some((curve, factor)) = rule.kept.curves.of(here, j) else {
                continue;
            };
            let xi: [f64; D] = bonds.vector(here, j);
            let eta: [f64; D] = std::array::from_fn(|c| u[j][c] - u[here][c]);
            let (xi, eta, scale) = bonds.expanded([here, j], xi, eta);
            let (measure, square) = L::stretch_measure(xi, eta);
            let now = L::stretch(measure / square);
            let before = largest[k * LANES + lane];
            if !(now > before && now > factor * curve.onset()) {
                continue;
            }
            largest[k * LANES + lane] = now;
            let cells = [u[here][3], u[j][3]];
            let entry = group * LANES + lane;
            let ends = [i, list.sites().point(j)];
            let bond = BreakingBond {
                ends,
                velocity: relative_velocity(rule.velocity, ends),
                force: L::force(xi, eta),
                energy: L::energy(xi, eta),
                // Softening has no critical energy that a step could exceed.
                critical: None,
                weight: rule.volumes[i] * scale * bonds.stiffness_of::<D>(entry, [here, j], cells),
            };
            let length = dot(xi, xi).sqrt();
            let dissipated = rule.dissipated((curve, factor), [before, now], &bond, length);
            tally.dissipate(i, 0.5 * dissipated);
            if now >= factor * curve.end() {
                intact[k] &= !(1 << lane);
                tally.broken.add(1);
            }
        }
    }
}

#[inline(always)]
fn advance_rows_body<T: Lanes, L: VectorLaw, const D: usize>(
    bonds: &Bonds<'_>,
    rule: &Advance<'_>,
    u: &Records,
    part: &mut Part<'_>,
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; D],
) {
    let Part { damage, largest } = part;
    let BlockDamage { intact, tally } = &mut **damage;
    let first = bonds.list.start()[rows.first];
    for k in 0..rows.count() {
        let i = rows.at(k);
        let groups = groups_of(bonds.list, i, rows.first);
        let intact = &mut intact[groups.clone()];
        let kept = Softened {
            largest: &largest[..],
            first,
            ..rule.kept
        };
        // The update of the largest stretch does not change the force, bitwise.
        let (force, grown) = point_force::<T, L, D>(bonds, &kept, u, i, intact);
        for c in 0..D {
            out[c][i - rows.first] += force[c];
        }
        if grown {
            let largest = &mut largest[groups.start * LANES..groups.end * LANES];
            soften_row::<L, D>(bonds, rule, u, i, (intact, largest), tally);
        }
    }
}

for_each_instruction_set! {
    /// Adds the force density of the rows at the end of a step to `out` and updates the largest stretches.
    pub(super) fn advance_rows [L: VectorLaw, const D: usize] <L, D> (
        bonds: &Bonds<'_>,
        rule: &Advance<'_>,
        u: &Records,
        part: &mut Part<'_>,
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; D],
    ) = advance_rows_body on lanes
}
