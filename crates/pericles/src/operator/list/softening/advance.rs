//! End of a step of softening bonds: update of the largest stretches and of the dissipated energy.

use super::gate::{Gate, Mark, Marks};
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
    /// Onsets of the entries, if they depend on the strength.
    pub onsets: Option<&'a mut [f64]>,
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

/// A bond at the end of the step.
struct Stretched<const D: usize> {
    ends: [usize; 2],
    xi: [f64; D],
    eta: [f64; D],
    /// Factor of the stiffness by thermal expansion.
    scale: f64,
    stretch: f64,
}

impl<const D: usize> Stretched<D> {
    /// Returns the bond of an entry between two sites.
    fn of<L: VectorLaw>(
        bonds: &Bonds<'_>,
        u: &Records,
        entry: usize,
        [here, j]: [usize; 2],
    ) -> Self {
        let xi: [f64; D] = bonds.vector(here, j);
        let eta: [f64; D] = std::array::from_fn(|c| u[j][c] - u[here][c]);
        let (xi, eta, scale) = bonds.relative::<L, D>(entry, [here, j], xi, eta);
        let (measure, square) = L::stretch_measure(xi, eta);
        Self {
            ends: [here, j],
            xi,
            eta,
            scale,
            stretch: L::stretch(measure / square),
        }
    }

    /// Returns the bond with its force, for an entry of a point.
    fn bond<L: VectorLaw>(
        &self,
        bonds: &Bonds<'_>,
        rule: &Advance<'_>,
        u: &Records,
        (i, entry): (usize, usize),
    ) -> BreakingBond<D> {
        let [here, j] = self.ends;
        let cells = [u[here][3], u[j][3]];
        let ends = [i, bonds.list().sites().point(j)];
        let stiffness = bonds.stiffness_of::<D>(entry, self.ends, cells);
        BreakingBond {
            ends,
            velocity: relative_velocity(rule.velocity, ends),
            force: L::force(self.xi, self.eta),
            energy: L::energy(self.xi, self.eta),
            // Softening has no critical energy that a step could exceed.
            critical: None,
            weight: rule.volumes[i] * self.scale * stiffness,
        }
    }
}

/// Gives the closed bonds of marked points the stretch from which they soften, and breaks those that are stretched beyond
/// their critical stretch: all that are stretched at points whose stress has reached the strength, and those near their
/// critical stretch at points that have lost stiffness.
pub(super) fn open_rows<L: VectorLaw, const D: usize>(
    bonds: &Bonds<'_>,
    rule: &Advance<'_>,
    (marks, gate): (&Marks, &Gate),
    u: &Records,
    part: &mut Part<'_>,
    rows: &Rows<'_>,
) {
    /// Part of the critical stretch from which bonds beside damage soften. Bonds that break at once hold the crack back
    /// until the load exceeds that of Griffith's theory by 30 to 40 % (lattice trapping); softening with the same energy
    /// reduces the excess to a few per cent.
    const RELEASE: f64 = 0.5;
    let Some(onsets) = part.onsets.as_deref_mut() else {
        return;
    };
    let BlockDamage { intact, tally } = &mut *part.damage;
    let list = bonds.list();
    for i in (0..rows.count()).map(|k| rows.at(k)) {
        let (first, here) = (list.start()[i], list.site(i));
        for (k, at) in groups_of(list, i, rows.first).enumerate() {
            let candidates = rule.kept.candidates(first + k, intact[at]);
            let neighbours = list.group(first + k);
            for lane in (0..LANES).filter(|lane| candidates >> lane & 1 == 1) {
                let (j, index) = (neighbours[lane], at * LANES + lane);
                let mark = marks.of_bond([i, list.sites().point(j)]);
                if mark == Mark::Elastic || onsets[index].is_finite() {
                    continue;
                }
                let Some((curve, factor)) = rule.kept.curves.of(here, j) else {
                    continue;
                };
                let entry = (first + k) * LANES + lane;
                let stretched = Stretched::<D>::of::<L>(bonds, u, entry, [here, j]);
                let critical = factor * curve.critical_stretch();
                let ends = [here, j].map(|site| rule.kept.curves.of_point(site).0);
                let onset = match mark {
                    Mark::Reached => stretched.stretch.max(factor * gate.least_onset(ends)),
                    _ if stretched.stretch >= RELEASE * critical => stretched.stretch,
                    _ => continue,
                };
                if onset < critical {
                    onsets[index] = onset;
                    continue;
                }
                let bond = stretched.bond::<L>(bonds, rule, u, (i, entry));
                let energy = match rule.step.is_start() {
                    true => 0.0,
                    false => rule.step.dissipated(&bond),
                };
                tally.dissipate(i, 0.5 * energy);
                intact[at] &= !(1 << lane);
                tally.broken.add(1);
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
    (intact, largest, onsets): (&mut [u8], &mut [f64], Option<&[f64]>),
    tally: &mut Tally,
) {
    let list = bonds.list();
    let (first, here) = (list.start()[i], list.site(i));
    let kept = Softened {
        onsets,
        ..rule.kept
    };
    for k in 0..intact.len() {
        let group = first + k;
        let candidates = rule.kept.candidates(group, intact[k]);
        let neighbours = list.group(group);
        for lane in (0..LANES).filter(|lane| candidates >> lane & 1 == 1) {
            let j = neighbours[lane];
            let Some((curve, factor)) = kept.curve(k * LANES + lane, [here, j]) else {
                continue;
            };
            let entry = group * LANES + lane;
            let stretched = Stretched::<D>::of::<L>(bonds, u, entry, [here, j]);
            let now = stretched.stretch;
            let before = largest[k * LANES + lane];
            if !(now > before && now > factor * curve.onset()) {
                continue;
            }
            largest[k * LANES + lane] = now;
            let bond = stretched.bond::<L>(bonds, rule, u, (i, entry));
            let length = dot(stretched.xi, stretched.xi).sqrt();
            let dissipated = rule.dissipated((&curve, factor), [before, now], &bond, length);
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
    let Part {
        damage,
        largest,
        onsets,
    } = part;
    let BlockDamage { intact, tally } = &mut **damage;
    let first = bonds.list.start()[rows.first];
    for k in 0..rows.count() {
        let i = rows.at(k);
        let groups = groups_of(bonds.list, i, rows.first);
        let intact = &mut intact[groups.clone()];
        let kept = Softened {
            largest: &largest[..],
            onsets: onsets.as_deref(),
            first,
            ..rule.kept
        };
        // The update of the largest stretch does not change the force, bitwise.
        let (force, grown) = point_force::<T, L, D>(bonds, &kept, u, i, intact);
        for c in 0..D {
            out[c][i - rows.first] += force[c];
        }
        if grown {
            let entries = groups.start * LANES..groups.end * LANES;
            let onsets = onsets.as_deref().map(|onsets| &onsets[entries.clone()]);
            let largest = &mut largest[entries];
            soften_row::<L, D>(bonds, rule, u, i, (intact, largest, onsets), tally);
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
