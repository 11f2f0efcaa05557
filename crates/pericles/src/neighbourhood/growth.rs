//! Bonds that come into being during a run.
//!
//! A bond of a growing body exists from the time at which both of its ends are active. Its vector at that time, divided by
//! 1 + τ with the thermal stretch τ, is its reference vector ξ₀ = ξ + η₀: forces read ξ₀ and η − η₀ with the stored η₀, so
//! that the bond is free of force when it comes into being, and rotations of the body do not stretch it. Linear laws, for
//! small displacements, read ξ and η − η₀ with η₀ = η − τ ξ.

use super::Neighbourhood;
use crate::archive::{Archive, Layout, Values};
use crate::error::Result;
use crate::family::BondList;
use crate::lanes::LANES;
use crate::parallel::{BLOCK, for_each_point};

const ORIGIN: &str = "operator/origin";

/// Which bonds do not exist yet, and the relative displacements at which bonds came into being.
#[derive(Debug, Clone, Default)]
pub(super) struct Growth {
    /// Bits of the bonds that do not exist yet, in the order of entries; empty for a body that does not grow.
    pending: Vec<u8>,
    /// Number of directed bonds of each block that were removed at the start or came into being; empty likewise.
    changes: Vec<u64>,
    /// η₀ in groups of eight bonds, one component after another, m; empty likewise.
    origin: Vec<f64>,
    layout: Layout,
}

impl Growth {
    /// Returns whether the bond of an entry does not exist yet.
    pub fn is_pending(&self, entry: usize) -> bool {
        let byte = self.pending.get(entry / LANES);
        byte.is_some_and(|bits| bits >> (entry % LANES) & 1 == 1)
    }

    /// Returns the number of changes of the bonds of a block.
    pub fn changes(&self, block: usize) -> u64 {
        self.changes.get(block).copied().unwrap_or(0)
    }

    pub fn save(&self, archive: &mut Archive) {
        if !self.origin.is_empty() {
            let values = Values::F64(self.origin.clone());
            archive.put_as(ORIGIN, values, self.layout.clone());
        }
    }

    pub fn restore(&mut self, archive: &Archive) -> Result<()> {
        match self.origin.is_empty() {
            true => Ok(()),
            false => archive.f64_into(ORIGIN, &mut self.origin),
        }
    }
}

impl Neighbourhood<BondList> {
    /// η₀ of the bonds in groups of eight, one component after another, m; empty for a body that does not grow.
    #[inline(always)]
    pub fn origin(&self) -> &[f64] {
        &self.growth.origin
    }

    /// Makes the bonds of a body in D dimensions grow with its points.
    pub(crate) fn grow<const D: usize>(&mut self) {
        let (list, groups) = (&self.form, self.form.present().len());
        let numbers = groups * LANES * D;
        self.growth = Growth {
            pending: vec![0; groups],
            changes: vec![0; self.blocks.len()],
            origin: vec![0.0; numbers],
            layout: Layout::rows(list.start(), numbers),
        };
    }

    /// Removes the bonds that have an end that is not active; points are followed by ghosts.
    pub(crate) fn remove_inactive(&mut self, active: &[bool]) {
        self.note_active(active);
        for i in 0..self.form.len() {
            let groups = self.form.groups(i);
            let pending = self.growth.pending[groups].to_vec();
            let removed: u32 = pending.iter().map(|bits| bits.count_ones()).sum();
            for (bits, pending) in self.bits_mut(i).iter_mut().zip(pending) {
                *bits &= !pending;
            }
            let block = i / BLOCK;
            self.growth.changes[block] += u64::from(removed);
        }
    }

    /// Reads which bonds do not exist yet from the active points, followed by ghosts.
    pub(crate) fn note_active(&mut self, active: &[bool]) {
        let list = &self.form;
        let rows = for_each_point(list.len(), &|i| {
            let groups = list.groups(i);
            let mut bits = vec![0u8; groups.len()];
            for (entry, site) in list.family(i) {
                let both = active[i] && active[list.sites().point(site)];
                if !both && list.is_present(entry) {
                    bits[entry / LANES - groups.start] |= 1 << (entry % LANES);
                }
            }
            bits
        });
        self.growth.pending = rows.concat();
    }

    /// Adds the bonds whose ends have both become active; `origin_of(list, point, site of the other end)` is
    /// their η₀.
    pub(crate) fn add_active<const D: usize>(
        &mut self,
        active: &[bool],
        origin_of: impl Fn(&BondList, usize, usize) -> [f64; D],
    ) {
        for i in (0..self.form.len()).filter(|&i| active[i]) {
            let list = &self.form;
            let family = list.family(i).map(|(entry, site)| {
                let point = list.sites().point(site);
                (entry, site, point)
            });
            let born: Vec<_> = family
                .filter(|&(entry, _, point)| active[point] && self.growth.is_pending(entry))
                .collect();
            for (entry, site, _) in born {
                let (group, lane) = (entry / LANES, entry % LANES);
                for (c, value) in origin_of(&self.form, i, site).into_iter().enumerate() {
                    self.growth.origin[(group * D + c) * LANES + lane] = value;
                }
                self.growth.pending[group] &= !(1 << lane);
                let place = self.form.place(i, entry);
                self.blocks[place.block].intact[place.group] |= 1 << lane;
                self.growth.changes[place.block] += 1;
            }
        }
    }
}

/// Returns η₀ of an entry; zero for a body that does not grow.
#[inline(always)]
pub(crate) fn origin_of_entry<const D: usize>(origin: &[f64], entry: usize) -> [f64; D] {
    match origin.is_empty() {
        true => [0.0; D],
        false => std::array::from_fn(|c| origin[(entry / LANES * D + c) * LANES + entry % LANES]),
    }
}
