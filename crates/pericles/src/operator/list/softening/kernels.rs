//! Loops over softening bonds. Groups of eight bonds that have never exceeded their elastic limit read one
//! number per bond, the largest stretch. The curve of a softened bond is evaluated individually, bitwise
//! identical at both ends and for all instruction sets.

use super::curves::Curves;
use crate::family::BondList;
use crate::lanes::{F64x8, LANES, Lanes, for_each_instruction_set, vector};
use crate::material::SofteningCurve;
use crate::operator::fast_law::{FixedBond, VectorLaw};
use crate::operator::list::arrays::Bonds;
use crate::operator::records::Records;
use crate::operator::rows::Rows;

/// State of softening bonds read by the loops.
#[derive(Clone, Copy)]
pub(super) struct Softened<'a> {
    pub curves: &'a Curves,
    /// Largest stretches of the entries of groups from `first` on.
    pub largest: &'a [f64],
    /// Onsets of these entries; `None` if they are those of the curves.
    pub onsets: Option<&'a [f64]>,
    pub first: usize,
    /// Bits of the bonds that may soften; `None`: all.
    pub breakable: Option<&'a [u8]>,
    /// Whether bonds keep the damage at the end of the last step.
    pub is_frozen: bool,
}

/// Bonds of a derivative of the force.
#[derive(Clone, Copy)]
pub(super) struct Change<'a> {
    pub kept: &'a Softened<'a>,
    /// Whether the damage changes with the stretch; otherwise it stays that of the displacement.
    pub is_softening: bool,
}

impl Softened<'_> {
    /// Returns the index of the first entry of a group.
    #[inline(always)]
    fn at(&self, group: usize) -> usize {
        (group - self.first) * LANES
    }

    /// Returns the curve of an entry, given by its index from `first` on, and the factor of its stretches; `None` if the
    /// bond is elastic.
    #[inline(always)]
    pub fn curve(&self, index: usize, [here, there]: [usize; 2]) -> Option<(SofteningCurve, f64)> {
        let (curve, factor) = self.curves.of(here, there)?;
        match self.onsets {
            None => Some((*curve, factor)),
            Some(onsets) if onsets[index].is_finite() => {
                Some((curve.with_onset(onsets[index] / factor), factor))
            }
            Some(_) => None,
        }
    }

    /// Returns 1 − d of an entry with the largest stretch κ.
    #[inline(always)]
    pub fn retained(&self, index: usize, ends: [usize; 2], largest: f64) -> f64 {
        match self.curve(index, ends) {
            Some((curve, factor)) => curve.retained(largest / factor),
            None => 1.0,
        }
    }

    /// Returns the stretches at which the bonds of a group soften, or a smaller one.
    #[inline(always)]
    fn onset<T: Lanes>(&self, group: usize) -> T {
        match self.onsets {
            None => T::splat(self.curves.smallest_onset()),
            Some(onsets) => T::load(onsets, self.at(group)),
        }
    }

    /// Returns the bits of the bonds of a group that may soften.
    #[inline(always)]
    pub fn candidates(&self, group: usize, intact: u8) -> u8 {
        match self.breakable {
            Some(bits) => intact & bits[group],
            None => intact,
        }
    }
}

/// Returns the stretches of a group, and the lanes of bonds that exceed or have exceeded the smallest elastic
/// limit.
#[inline(always)]
fn softened_lanes<T: Lanes, L: VectorLaw, const D: usize>(
    kept: &Softened<'_>,
    group: usize,
    bond: &FixedBond<T, D>,
    eta: [T; D],
    intact: u8,
) -> (T, T, u8) {
    let (measure, square) = L::stretch_measure(bond.xi, eta);
    let stretch = L::stretch(measure / square);
    let largest = T::load(kept.largest, kept.at(group));
    let onset = kept.onset::<T>(group);
    let either = stretch.greater(onset) | largest.greater(onset);
    (stretch, largest, either & kept.candidates(group, intact))
}

/// Returns 1 − d of the bonds of a group in the given lanes, for the larger of current and stored stretch, or
/// the stored one if they are frozen; 1 in other lanes.
#[cold]
#[inline(never)]
fn retained_of(
    kept: &Softened<'_>,
    [here, group]: [usize; 2],
    neighbours: [usize; LANES],
    [stretch, largest]: [[f64; LANES]; 2],
    lanes: u8,
) -> [f64; LANES] {
    std::array::from_fn(|lane| match lanes >> lane & 1 {
        0 => 1.0,
        _ => {
            let reached = match kept.is_frozen {
                true => largest[lane],
                false => stretch[lane].max(largest[lane]),
            };
            let index = kept.at(group) + lane;
            kept.retained(index, [here, neighbours[lane]], reached)
        }
    })
}

/// Returns 1 − d of the bonds of a group at the current displacement, and whether the stretch of a bond
/// exceeds its largest one and the smallest elastic limit.
#[inline(always)]
pub(super) fn retained<T: Lanes, L: VectorLaw, const D: usize>(
    bonds: &Bonds<'_>,
    kept: &Softened<'_>,
    [here, group]: [usize; 2],
    (bond, eta): (&FixedBond<T, D>, [T; D]),
    intact: u8,
) -> (T, bool) {
    let (stretch, largest, lanes) = softened_lanes::<T, L, D>(kept, group, bond, eta, intact);
    if lanes == 0 {
        return (T::splat(1.0), false);
    }
    let grown = stretch.greater(largest) & lanes != 0;
    let both = [stretch.to_array(), largest.to_array()];
    let factors = retained_of(kept, [here, group], bonds.list.group(group), both, lanes);
    (T::load(&factors, 0), grown)
}

/// Returns the force on a point, and whether the stretch of one of its bonds exceeds its largest one.
#[inline(always)]
pub(super) fn point_force<T: Lanes, L: VectorLaw, const D: usize>(
    bonds: &Bonds<'_>,
    kept: &Softened<'_>,
    u: &Records,
    i: usize,
    intact: &[u8],
) -> ([f64; D], bool) {
    let here = bonds.here::<T, D>(i, u);
    let (site, first) = (bonds.list.site(i), bonds.list.start()[i]);
    let mut sum = [T::splat(0.0); D];
    let mut any = false;
    for k in 0..intact.len() {
        let (group, mask) = (first + k, intact[k]);
        if mask == 0 {
            continue;
        }
        let (bond, eta) = bonds.group::<T, L, D>(group, &here, u);
        let force = L::force(bond.xi, eta);
        let (factor, grown) = retained::<T, L, D>(bonds, kept, [site, group], (&bond, eta), mask);
        any |= grown;
        for c in 0..D {
            sum[c] = sum[c] + (bond.stiffness * factor * force[c]).masked(mask);
        }
    }
    let mut total = [0.0; D];
    for c in 0..D {
        total[c] = F64x8(sum[c].to_array()).sum();
    }
    (total, any)
}

/// Returns the groups of a point relative to its block.
#[inline(always)]
pub(super) fn groups_of(list: &BondList, i: usize, first_point: usize) -> std::ops::Range<usize> {
    let start = list.start();
    start[i] - start[first_point]..start[i + 1] - start[first_point]
}

#[inline(always)]
fn force_rows_body<T: Lanes, L: VectorLaw, const D: usize>(
    bonds: &Bonds<'_>,
    kept: &Softened<'_>,
    u: &Records,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; D],
) {
    for k in 0..rows.count() {
        let i = rows.at(k);
        let intact = &intact[groups_of(bonds.list, i, rows.first)];
        let (force, _) = point_force::<T, L, D>(bonds, kept, u, i, intact);
        for c in 0..D {
            out[c][i - rows.first] += force[c];
        }
    }
}

#[inline(always)]
fn energy_rows_body<T: Lanes, L: VectorLaw, const D: usize>(
    bonds: &Bonds<'_>,
    kept: &Softened<'_>,
    u: &Records,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; 1],
) {
    for k in 0..rows.count() {
        let i = rows.at(k);
        let here = bonds.here::<T, D>(i, u);
        let groups = groups_of(bonds.list, i, rows.first);
        let (site, first) = (bonds.list.site(i), bonds.list.start()[i]);
        let mut total = T::splat(0.0);
        for k in 0..groups.len() {
            let mask = intact[groups.start + k];
            let (bond, eta) = bonds.group::<T, L, D>(first + k, &here, u);
            let ends = [site, first + k];
            let (factor, _) = retained::<T, L, D>(bonds, kept, ends, (&bond, eta), mask);
            let energy = bond.stiffness * factor * L::energy(bond.xi, eta);
            total = total + energy.masked(mask);
        }
        out[0][i - rows.first] += 0.5 * F64x8(total.to_array()).sum();
    }
}

/// Returns −d′(κ), the derivative of 1 − d with respect to the stretch, of bonds whose stretch exceeds their
/// largest one; 0 for other bonds.
#[cold]
#[inline(never)]
fn softening_rates(
    kept: &Softened<'_>,
    [here, group]: [usize; 2],
    neighbours: [usize; LANES],
    [stretch, largest]: [[f64; LANES]; 2],
    lanes: u8,
) -> [f64; LANES] {
    std::array::from_fn(|lane| {
        let s = stretch[lane];
        let curve = kept.curve(kept.at(group) + lane, [here, neighbours[lane]]);
        match curve {
            Some((curve, factor)) if lanes >> lane & 1 == 1 && s > largest[lane] => {
                let s = s / factor;
                // d(g/κ)/dκ
                match s > curve.onset() {
                    true => (curve.slope(s) - curve.retained(s)) / (s * factor),
                    false => 0.0,
                }
            }
            _ => 0.0,
        }
    })
}

#[inline(always)]
fn tangent_rows_body<T: Lanes, L: VectorLaw, const D: usize>(
    bonds: &Bonds<'_>,
    change: &Change<'_>,
    u: &Records,
    direction: &Records,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; D],
) {
    let kept = change.kept;
    for k in 0..rows.count() {
        let i = rows.at(k);
        let here = bonds.here::<T, D>(i, u);
        let (site, first) = (bonds.list.site(i), bonds.list.start()[i]);
        let direction_here: [T; D] = vector(|c| T::splat(direction[site][c]));
        let groups = groups_of(bonds.list, i, rows.first);
        let mut total = [T::splat(0.0); D];
        for k in 0..groups.len() {
            let (group, mask) = (first + k, intact[groups.start + k]);
            let (bond, eta) = bonds.group::<T, L, D>(group, &here, u);
            let there = bonds.there::<T>(group, direction);
            let d = vector(|c| there[c] - direction_here[c]);
            let mut force = L::tangent(bond.xi, eta, d);
            let (stretch, largest, lanes) =
                softened_lanes::<T, L, D>(kept, group, &bond, eta, mask);
            if lanes != 0 {
                let both = [stretch.to_array(), largest.to_array()];
                let neighbours = bonds.list.group(group);
                let ends = [site, group];
                let factors = retained_of(kept, ends, neighbours, both, lanes);
                let softening = if change.is_softening { lanes } else { 0 };
                let rates = softening_rates(kept, ends, neighbours, both, softening);
                let (factor, rate) = (T::load(&factors, 0), T::load(&rates, 0));
                // ds = n·d/|ξ| with n = F/s; the rate is zero for bonds that do not soften.
                let pull = L::force(bond.xi, eta);
                let mut along = pull[0] * d[0];
                for c in 1..D {
                    along = along + pull[c] * d[c];
                }
                let length = T::splat(1.0) / bond.inverse_square.sqrt();
                let change = (rate * along / (stretch * length)).masked(lanes);
                for c in 0..D {
                    force[c] = factor * force[c] + change * pull[c];
                }
            }
            for c in 0..D {
                total[c] = total[c] + (bond.stiffness * force[c]).masked(mask);
            }
        }
        for c in 0..D {
            out[c][i - rows.first] = F64x8(total[c].to_array()).sum();
        }
    }
}

for_each_instruction_set! {
    /// Adds the force density of the rows to `out` (indexed from the first point of the block).
    pub(super) fn force_rows [L: VectorLaw, const D: usize] <L, D> (
        bonds: &Bonds<'_>,
        kept: &Softened<'_>,
        u: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; D],
    ) = force_rows_body on lanes
}

for_each_instruction_set! {
    /// Adds the energy density of the rows to `out`.
    pub(super) fn energy_rows [L: VectorLaw, const D: usize] <L, D> (
        bonds: &Bonds<'_>,
        kept: &Softened<'_>,
        u: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; 1],
    ) = energy_rows_body on lanes
}

for_each_instruction_set! {
    /// Adds the derivative of the force density in a direction to `out`.
    pub(super) fn tangent_rows [L: VectorLaw, const D: usize] <L, D> (
        bonds: &Bonds<'_>,
        change: &Change<'_>,
        u: &Records,
        direction: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; D],
    ) = tangent_rows_body on lanes
}
