//! Loops over the bonds of a surface, generic over law and instruction set.
//!
//! Bonds of a point are processed eight at a time. Displacements are read as rows of four numbers, one row per
//! neighbour, and transposed into lanes in registers.

use super::bonds::SurfaceBonds;
use super::law::SurfaceLaw;
use pericles::lanes::LANES;
use pericles::lanes::{F64x8, Lanes, for_each_instruction_set, vector};
use pericles::operator::records::Records;
use pericles::operator::rows::Rows;

/// Prefetch distance in groups: 3 kB, some hundred nanoseconds of work. Half of it is slower, twice is no
/// faster.
const AHEAD: usize = 32;

/// Bond list with reference positions.
pub(super) struct Bonds<'a> {
    list: &'a SurfaceBonds,
    /// Reference positions; empty if the law does not use them.
    reference: &'a Records,
    /// Marks of the points whose bonds count; `None` means all.
    partners: Option<&'a [bool]>,
}

impl<'a> Bonds<'a> {
    /// # Panics
    /// If the number of reference positions is neither zero nor the number of points.
    pub fn new(list: &'a SurfaceBonds, reference: &'a Records) -> Self {
        assert!(reference.is_empty() || reference.len() == list.len());
        Self {
            list,
            reference,
            partners: None,
        }
    }

    /// Restricts to bonds whose other end is marked; one mark per point.
    pub fn to(self, partners: &'a [bool]) -> Self {
        Self {
            partners: Some(partners),
            ..self
        }
    }

    /// Differences of a field along the eight bonds of a group.
    #[inline(always)]
    fn differences<T: Lanes>(&self, here: [T; 3], group: usize, field: &Records) -> [T; 3] {
        let neighbours = self.list.group(group);
        let mut indices = [0; LANES];
        for k in 0..LANES {
            indices[k] = neighbours[k] as usize;
        }
        // SAFETY: `SurfaceBonds` guarantees that neighbours are below the number of points, and `field` has as
        // many rows: see `checked`.
        let there = unsafe { T::gather(field, indices) };
        vector(|c| there[c] - here[c])
    }

    #[inline(always)]
    fn checked<'f>(&self, field: &'f Records) -> &'f Records {
        assert!(field.len() == self.list.len(), "a row for every point");
        field
    }

    #[inline(always)]
    fn here<T: Lanes>(field: &Records, i: usize) -> [T; 3] {
        vector(|c| T::splat(field[i][c]))
    }

    /// Factors of the eight bonds of a group, zero for bonds that do not count. Later groups are prefetched:
    /// the list is read faster than the hardware prefetcher keeps up with.
    #[inline(always)]
    fn weights<T: Lanes>(&self, group: usize) -> T {
        self.list.prefetch(group + AHEAD);
        let weights = T::load(self.list.weights(), group * LANES);
        match self.partners {
            None => weights,
            Some(marks) => {
                let neighbours = self.list.group(group);
                let mut bits = 0;
                for k in 0..LANES {
                    bits |= u8::from(marks[neighbours[k] as usize]) << k;
                }
                weights.masked(bits)
            }
        }
    }

    /// ξ of a group, if the law uses it.
    #[inline(always)]
    fn chords<T: Lanes, L: SurfaceLaw>(&self, i: usize, group: usize) -> [T; 3] {
        if L::CHORD {
            let reference = self.checked(self.reference);
            self.differences(Self::here(reference, i), group, reference)
        } else {
            [T::splat(0.0); 3]
        }
    }
}

#[inline(always)]
fn sum<T: Lanes>(lanes: T) -> f64 {
    F64x8(lanes.to_array()).sum()
}

#[inline(always)]
fn force_rows_body<T: Lanes, L: SurfaceLaw>(
    law: L,
    bonds: &Bonds<'_>,
    u: &Records,
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; 3],
) {
    let u = bonds.checked(u);
    // Not a closure: one that is not inlined would be compiled for the baseline instruction set.
    for k in 0..rows.count() {
        let i = rows.at(k);
        let here: [T; 3] = Bonds::here(u, i);
        let mut total = [T::splat(0.0); 3];
        for group in bonds.list.groups(i) {
            let eta = bonds.differences(here, group, u);
            let xi = bonds.chords::<T, L>(i, group);
            let weight: T = bonds.weights(group);
            let force = law.force(xi, eta);
            for c in 0..3 {
                total[c] = weight.mul_add(force[c], total[c]);
            }
        }
        for c in 0..3 {
            out[c][i - rows.first] += sum(total[c]);
        }
    }
}

#[inline(always)]
fn energy_rows_body<T: Lanes, L: SurfaceLaw>(
    law: L,
    bonds: &Bonds<'_>,
    u: &Records,
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; 1],
) {
    let u = bonds.checked(u);
    for k in 0..rows.count() {
        let i = rows.at(k);
        let here: [T; 3] = Bonds::here(u, i);
        let mut total = T::splat(0.0);
        for group in bonds.list.groups(i) {
            let eta = bonds.differences(here, group, u);
            let xi = bonds.chords::<T, L>(i, group);
            let weight: T = bonds.weights(group);
            total = weight.mul_add(law.energy(xi, eta), total);
        }
        out[0][i - rows.first] += 0.5 * sum(total);
    }
}

#[inline(always)]
fn tangent_rows_body<T: Lanes, L: SurfaceLaw>(
    law: L,
    bonds: &Bonds<'_>,
    u: &Records,
    direction: &Records,
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; 3],
) {
    let (u, direction) = (bonds.checked(u), bonds.checked(direction));
    for k in 0..rows.count() {
        let i = rows.at(k);
        let here: [T; 3] = Bonds::here(u, i);
        let direction_here: [T; 3] = Bonds::here(direction, i);
        let mut total = [T::splat(0.0); 3];
        for group in bonds.list.groups(i) {
            let eta = bonds.differences(here, group, u);
            let d = bonds.differences(direction_here, group, direction);
            let xi = bonds.chords::<T, L>(i, group);
            let weight: T = bonds.weights(group);
            let force = law.tangent(xi, eta, d);
            for c in 0..3 {
                total[c] = weight.mul_add(force[c], total[c]);
            }
        }
        for c in 0..3 {
            out[c][i - rows.first] = sum(total[c]);
        }
    }
}

for_each_instruction_set! {
    /// Adds the force density of the rows to `out`, indexed from the block's first point.
    pub(super) fn force_rows [L: SurfaceLaw] <L> (
        law: L,
        bonds: &Bonds<'_>,
        u: &Records,
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; 3],
    ) = force_rows_body on lanes
}

for_each_instruction_set! {
    /// Adds the energy density of the rows to `out`.
    pub(super) fn energy_rows [L: SurfaceLaw] <L> (
        law: L,
        bonds: &Bonds<'_>,
        u: &Records,
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; 1],
    ) = energy_rows_body on lanes
}

for_each_instruction_set! {
    /// Adds the directional derivative of the force density to `out`.
    pub(super) fn tangent_rows [L: SurfaceLaw] <L> (
        law: L,
        bonds: &Bonds<'_>,
        u: &Records,
        direction: &Records,
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; 3],
    ) = tangent_rows_body on lanes
}
