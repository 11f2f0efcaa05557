//! Bond failure by energy: the accumulated work of the force states of a bond.

use super::bonds::SolidBonds;
use super::breaking::{BreakRule, take_bonds};
use super::kernels::{extension_of, groups_of};
use super::kinematics::Kinematics;
use super::weight::Weight;
use crate::lanes::{LANES, Lanes, for_each_instruction_set};
use crate::neighbourhood::{BlockDamage, Tally};
use crate::operator::records::Records;
use crate::operator::rows::Rows;

/// Number of values stored per group of eight bonds: for each bond the accumulated work ∫ (p + ψ s) dψ, and
/// p + ψ s and ψ at the end of the last step.
///
/// The bond energy is w r² times the work. Both ends store their own values, so that a step can end for a
/// subset of points.
pub(super) const KEPT: usize = 3 * LANES;

/// Bonds with their stored values.
pub(super) struct Worked<'a> {
    pub bonds: SolidBonds<'a>,
    /// Influence function w.
    pub influence: &'a Weight,
}

#[inline(always)]
fn work_rows_body<T: Lanes, L: Kinematics, const D: usize>(
    worked: &Worked<'_>,
    rule: &BreakRule<'_>,
    u: &Records,
    block: &mut BlockDamage,
    kept: &mut [f64],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; 1],
) {
    let BlockDamage { intact, tally } = block;
    let (bonds, zero) = (&worked.bonds, T::splat(0.0));
    let (half, one) = (T::splat(0.5), T::splat(1.0));
    // The margin below the limit exceeds the rounding error of the sums.
    let limit = T::splat(rule.energy * (1.0 - 1e-9));
    for row in 0..rows.count() {
        let i = rows.at(row);
        let groups = groups_of(bonds.list, i, rows.first);
        let here = bonds.here::<T, D>(i, u);
        let first = bonds.list.start()[i];
        let mut endangered = 0;
        for k in 0..groups.len() {
            let group = groups.start + k;
            if intact[group] == 0 {
                continue;
            }
            let bond = bonds.group(first + k, &here, u);
            let kept = &mut kept[group * KEPT..(group + 1) * KEPT];
            let stretch = L::exact_stretch(L::strain(bond.xi, bond.eta, bond.inverse_square));
            let pull = stretch.mul_add(bond.stiffness, bond.last);
            let mean = half * (pull + T::load(kept, LANES));
            let work = T::load(kept, 0) + mean * (stretch - T::load(kept, 2 * LANES));
            kept[..LANES].copy_from_slice(&work.to_array());
            kept[LANES..2 * LANES].copy_from_slice(&pull.to_array());
            kept[2 * LANES..].copy_from_slice(&stretch.to_array());
            let inverse = bond.inverse_square.sqrt();
            let r = bond.square * inverse;
            let influence = worked
                .influence
                .of_group(first + k, r, inverse, one, [zero, zero]);
            let energy = influence * bond.square * work;
            // Compressed bonds never break.
            let over = energy.greater(limit) & stretch.greater(zero);
            endangered |= over & rule.candidates(first + k, intact[group]);
        }
        if endangered != 0 {
            let groups = groups.start..groups.end;
            let kept = &kept[groups.start * KEPT..groups.end * KEPT];
            if break_by_work::<L, D>(worked, rule, u, i, &mut intact[groups.clone()], kept, tally) {
                let extension = extension_of::<T, L, D>(bonds, u, i, &intact[groups]);
                out[0][i - rows.first] = rule.states.dilatation[i] * extension;
            }
        }
    }
}

/// Breaks the bonds of a point whose energy exceeds the limit of their pair of materials.
#[cold]
#[inline(never)]
fn break_by_work<L: Kinematics, const D: usize>(
    worked: &Worked<'_>,
    rule: &BreakRule<'_>,
    u: &Records,
    i: usize,
    intact: &mut [u8],
    kept: &[f64],
    tally: &mut Tally,
) -> bool {
    let bonds = &worked.bonds;
    let (first, here) = (bonds.list.start()[i], bonds.list.site(i));
    let mut broken = vec![0; intact.len()];
    for (k, broken) in broken.iter_mut().enumerate() {
        let kept = &kept[k * KEPT..(k + 1) * KEPT];
        let candidates = rule.candidates(first + k, intact[k]);
        let neighbours = bonds.list.group(first + k);
        for lane in (0..LANES).filter(|lane| candidates >> lane & 1 == 1) {
            let j = neighbours[lane];
            let xi = bonds.vector::<D>(here, j);
            let energy = worked.bond_energy((first + k) * LANES + lane, xi, kept[lane]);
            if energy > rule.classes.limits(here, j).energy && kept[2 * LANES + lane] > 0.0 {
                *broken |= 1 << lane;
            }
        }
    }
    take_bonds::<L, D>(bonds, rule, u, i, intact, &broken, tally)
}

impl Worked<'_> {
    /// Returns the bond energy of an entry, w r² times its work, J/m⁶.
    pub fn bond_energy<const D: usize>(&self, entry: usize, xi: [f64; D], work: f64) -> f64 {
        let square = crate::lanes::dot(xi, xi);
        let influence = self
            .influence
            .of_entry(entry, square.sqrt(), 1.0, [0.0, 0.0]);
        influence * square * work
    }
}

for_each_instruction_set! {
    /// Updates the work of the bonds of the rows, breaks bonds whose energy exceeds their limit, and sets the
    /// dilatation of points that lost bonds. The fourth entry of the rows of `u` is p.
    pub(super) fn work_rows [L: Kinematics, const D: usize] <L, D> (
        worked: &Worked<'_>,
        rule: &BreakRule<'_>,
        u: &Records,
        block: &mut BlockDamage,
        kept: &mut [f64],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; 1],
    ) = work_rows_body on lanes
}
