//! Stress of the points of a list of softening bonds.

use super::kernels::{Softened, groups_of, retained};
use crate::lanes::{F64x8, Lanes, for_each_instruction_set};
use crate::operator::fast_law::VectorLaw;
use crate::operator::list::arrays::Bonds;
use crate::operator::records::Records;
use crate::operator::rows::Rows;

/// Axes of the components of a symmetric tensor in Voigt's order: xx, yy, zz, yz, xz, xy.
pub(super) const VOIGT: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [1, 2], [0, 2], [0, 1]];

/// Numbers per point: the stress, Pa, and Σ c α κ V |ξ| of the remaining stiffness.
pub(super) const NUMBERS: usize = 7;

#[inline(always)]
fn stress_rows_body<T: Lanes, L: VectorLaw, const D: usize>(
    bonds: &Bonds<'_>,
    kept: &Softened<'_>,
    u: &Records,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; NUMBERS],
) {
    for k in 0..rows.count() {
        let i = rows.at(k);
        let here = bonds.here::<T, D>(i, u);
        let groups = groups_of(bonds.list, i, rows.first);
        let (site, first) = (bonds.list.site(i), bonds.list.start()[i]);
        let mut total = [T::splat(0.0); NUMBERS];
        for k in 0..groups.len() {
            let mask = intact[groups.start + k];
            if mask == 0 {
                continue;
            }
            let (bond, eta) = bonds.group::<T, L, D>(first + k, &here, u);
            let ends = [site, first + k];
            let (factor, _) = retained::<T, L, D>(bonds, kept, ends, (&bond, eta), mask);
            let stiffness = bond.stiffness * factor;
            let force = L::force(bond.xi, eta);
            for c in 0..VOIGT.len() {
                let [a, b] = VOIGT[c];
                if b < D {
                    let along = if L::LINEAR {
                        bond.xi[b]
                    } else {
                        bond.xi[b] + eta[b]
                    };
                    total[c] = total[c] + (stiffness * force[a] * along).masked(mask);
                }
            }
            let length = T::splat(1.0) / bond.inverse_square.sqrt();
            total[6] = total[6] + (stiffness * length).masked(mask);
        }
        for c in 0..VOIGT.len() {
            out[c][i - rows.first] += 0.5 * F64x8(total[c].to_array()).sum();
        }
        out[6][i - rows.first] += F64x8(total[6].to_array()).sum();
    }
}

for_each_instruction_set! {
    /// Adds the numbers of the points of the rows to `out`: the stress ½ Σ f ⊗ y with the force densities f and the bonds
    /// y, undeformed for small strains, and the remaining stiffness.
    pub(super) fn stress_rows [L: VectorLaw, const D: usize] <L, D> (
        bonds: &Bonds<'_>,
        kept: &Softened<'_>,
        u: &Records,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; NUMBERS],
    ) = stress_rows_body on lanes
}
