//! The loops over bonds, one text for every law, dimension and instruction set.
//!
//! A point's bonds are taken eight at a time: gather the neighbours, compute the pair force in lanes, mask bonds that do not exist, and
//! add up. The lanes of the sum are added in a fixed order at the end, so a point's force depends on nothing but its neighbours.

use crate::family::LANES;
use crate::material::PairForce;
use crate::operator::damage::{BreakEvent, Tally};
use crate::operator::lanes::{F64x8, InstructionSet, for_each_instruction_set, vector};
use crate::operator::rows::Rows;

/// The read-only arrays of a bond list as the loops see them.
pub(super) struct Bonds<'a, const D: usize> {
    /// Reference coordinates in units of `unit`.
    pub reference: [&'a [f64]; D],
    /// Length of one coordinate unit, m.
    pub unit: f64,
    pub start: &'a [usize],
    pub neighbours: &'a [u32],
    /// c α κ V of the neighbour, per entry.
    pub stiffness: &'a [f64],
    /// Marks of the points whose bonds count; all of them if none.
    pub partners: Option<&'a [bool]>,
}

impl<const D: usize> Bonds<'_, D> {
    #[inline(always)]
    fn gather(&self, group: usize, array: &[f64]) -> F64x8 {
        let neighbours = &self.neighbours[group * LANES..(group + 1) * LANES];
        F64x8::from_fn(|k| array[neighbours[k] as usize])
    }

    /// ξ of the eight bonds of a group of point i.
    #[inline(always)]
    fn vectors(&self, i: usize, group: usize) -> [F64x8; D] {
        vector(|c| {
            let here = self.reference[c][i];
            let there = self.gather(group, self.reference[c]);
            F64x8::from_fn(|k| (there.0[k] - here) * self.unit)
        })
    }

    /// Differences of a vector field along the eight bonds of a group.
    #[inline(always)]
    fn differences(&self, i: usize, group: usize, field: &[&[f64]; D]) -> [F64x8; D] {
        vector(|c| {
            let here = field[c][i];
            let there = self.gather(group, field[c]);
            F64x8::from_fn(|k| there.0[k] - here)
        })
    }

    /// Bits of the bonds of a group that count.
    #[inline(always)]
    fn wanted(&self, group: usize) -> u8 {
        match self.partners {
            None => 0xFF,
            Some(marks) => {
                let neighbours = &self.neighbours[group * LANES..(group + 1) * LANES];
                let mut bits = 0;
                for k in 0..LANES {
                    bits |= u8::from(marks[neighbours[k] as usize]) << k;
                }
                bits
            }
        }
    }

    #[inline(always)]
    fn stiffness(&self, group: usize) -> F64x8 {
        let stiffness = &self.stiffness[group * LANES..(group + 1) * LANES];
        F64x8::from_fn(|k| stiffness[k])
    }
}

#[inline(always)]
fn force_rows_body<L: PairForce, const D: usize>(
    bonds: &Bonds<'_, D>,
    u: &[&[f64]; D],
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; D],
) {
    let first_group = bonds.start[rows.first];
    // No closure here: one that is not inlined would take the baseline's instructions.
    for k in 0..rows.len() {
        let i = rows.at(k);
        let mut sum = [F64x8([0.0; LANES]); D];
        for group in bonds.start[i]..bonds.start[i + 1] {
            let mask = intact[group - first_group] & bonds.wanted(group);
            if mask != 0 {
                let xi = bonds.vectors(i, group);
                let eta = bonds.differences(i, group, u);
                let stiffness = bonds.stiffness(group);
                let force = L::force(xi, eta);
                for c in 0..D {
                    sum[c] = sum[c] + (stiffness * force[c]).masked(mask);
                }
            }
        }
        for c in 0..D {
            out[c][i - rows.first] += sum[c].sum();
        }
    }
}

/// Breaking as the loops see it.
pub(super) struct BreakRule<'a, const D: usize> {
    pub threshold: f64,
    /// Bits of the bonds that may break; all of them if none.
    pub breakable: Option<&'a [u8]>,
    pub volumes: &'a [f64],
    /// Mean velocity and length of the step that ended, where the force acted for only half of it.
    pub step: Option<([&'a [f64]; D], f64)>,
    /// Note what breaks, so that the other end can be told.
    pub note_events: bool,
}

#[inline(always)]
fn accept_rows_body<L: PairForce, const D: usize, const FORCE: bool>(
    bonds: &Bonds<'_, D>,
    rule: &BreakRule<'_, D>,
    u: &[&[f64]; D],
    intact: &mut [u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; D],
    tally: &mut Tally,
) {
    let first_group = bonds.start[rows.first];
    let threshold = F64x8([rule.threshold; LANES]);
    for k in 0..rows.len() {
        let i = rows.at(k);
        let mut sum = [F64x8([0.0; LANES]); D];
        for group in bonds.start[i]..bonds.start[i + 1] {
            let mut mask = intact[group - first_group] & bonds.wanted(group);
            if mask == 0 {
                continue;
            }
            let xi = bonds.vectors(i, group);
            let eta = bonds.differences(i, group, u);
            let (measure, square) = L::stretch_measure(xi, eta);
            let breakable = rule.breakable.map_or(0xFF, |bits| bits[group]);
            let over = measure.greater(threshold * square) & mask & breakable;
            if over != 0 {
                mask &= !over;
                intact[group - first_group] &= !over;
                break_bonds::<L, D>(bonds, rule, u, i, group, over, tally);
            }
            if FORCE {
                let stiffness = bonds.stiffness(group);
                let force = L::force(xi, eta);
                for c in 0..D {
                    sum[c] = sum[c] + (stiffness * force[c]).masked(mask);
                }
            }
        }
        if FORCE {
            for c in 0..D {
                out[c][i - rows.first] += sum[c].sum();
            }
        }
    }
}

/// Books the energy of the bonds of a group that have just broken. Each end books half.
#[cold]
#[inline(never)]
fn break_bonds<L: PairForce, const D: usize>(
    bonds: &Bonds<'_, D>,
    rule: &BreakRule<'_, D>,
    u: &[&[f64]; D],
    i: usize,
    group: usize,
    over: u8,
    tally: &mut Tally,
) {
    for k in (0..LANES).filter(|k| over >> k & 1 == 1) {
        let entry = group * LANES + k;
        let j = bonds.neighbours[entry] as usize;
        let difference = |field: &[&[f64]; D]| -> [f64; D] {
            std::array::from_fn(|c| field[c][j] - field[c][i])
        };
        let xi: [f64; D] =
            std::array::from_fn(|c| (bonds.reference[c][j] - bonds.reference[c][i]) * bonds.unit);
        let eta = difference(u);
        let mut energy = L::energy(xi, eta);
        if let Some((velocity, dt)) = &rule.step {
            let force = L::force(xi, eta);
            let rate = difference(velocity);
            let power: f64 = (0..D).map(|c| force[c] * rate[c]).sum();
            energy -= 0.5 * dt * power;
        }
        let dissipated = 0.5 * rule.volumes[i] * bonds.stiffness[entry] * energy;
        tally.dissipated += dissipated;
        tally.broken += 1;
        if rule.note_events {
            tally.events.push(BreakEvent {
                point: i as u32,
                entry,
                dissipated,
            });
        }
    }
}

#[inline(always)]
fn energy_rows_body<L: PairForce, const D: usize>(
    bonds: &Bonds<'_, D>,
    u: &[&[f64]; D],
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; 1],
) {
    let first_group = bonds.start[rows.first];
    for k in 0..rows.len() {
        let i = rows.at(k);
        let mut sum = F64x8([0.0; LANES]);
        for group in bonds.start[i]..bonds.start[i + 1] {
            let mask = intact[group - first_group];
            let xi = bonds.vectors(i, group);
            let eta = bonds.differences(i, group, u);
            sum = sum + (bonds.stiffness(group) * L::energy(xi, eta)).masked(mask);
        }
        out[0][i - rows.first] += 0.5 * sum.sum();
    }
}

#[inline(always)]
fn tangent_rows_body<L: PairForce, const D: usize>(
    bonds: &Bonds<'_, D>,
    u: &[&[f64]; D],
    direction: &[&[f64]; D],
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; D],
) {
    let first_group = bonds.start[rows.first];
    for k in 0..rows.len() {
        let i = rows.at(k);
        let mut sum = [F64x8([0.0; LANES]); D];
        for group in bonds.start[i]..bonds.start[i + 1] {
            let mask = intact[group - first_group];
            let xi = bonds.vectors(i, group);
            let eta = bonds.differences(i, group, u);
            let d = bonds.differences(i, group, direction);
            let stiffness = bonds.stiffness(group);
            let force = L::tangent(xi, eta, d);
            for c in 0..D {
                sum[c] = sum[c] + (stiffness * force[c]).masked(mask);
            }
        }
        for c in 0..D {
            out[c][i - rows.first] = sum[c].sum();
        }
    }
}

for_each_instruction_set! {
    /// Adds the force density of the rows to `out` (indexed from the block's first point).
    pub(super) fn force_rows [L: PairForce, const D: usize] <L, D> (
        bonds: &Bonds<'_, D>,
        u: &[&[f64]; D],
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; D],
    ) = force_rows_body
}

for_each_instruction_set! {
    /// Breaks over-stretched bonds of the rows and, with FORCE, adds the force density of those that are left.
    pub(super) fn accept_rows [L: PairForce, const D: usize, const FORCE: bool] <L, D, FORCE> (
        bonds: &Bonds<'_, D>,
        rule: &BreakRule<'_, D>,
        u: &[&[f64]; D],
        intact: &mut [u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; D],
        tally: &mut Tally,
    ) = accept_rows_body
}

for_each_instruction_set! {
    /// Adds the energy density of the rows to `out`.
    pub(super) fn energy_rows [L: PairForce, const D: usize] <L, D> (
        bonds: &Bonds<'_, D>,
        u: &[&[f64]; D],
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; 1],
    ) = energy_rows_body
}

for_each_instruction_set! {
    /// The derivative of the force density in a direction.
    pub(super) fn tangent_rows [L: PairForce, const D: usize] <L, D> (
        bonds: &Bonds<'_, D>,
        u: &[&[f64]; D],
        direction: &[&[f64]; D],
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; D],
    ) = tangent_rows_body
}
