//! History variables of bonds and points of inelastic solids.

use rayon::prelude::*;

use super::laws::{Laws, Relaxation, weighted};
use crate::archive::Laid;
use crate::error::Result;
use crate::family::BondList;
use crate::lanes::{F64x8, LANES};
use crate::material::{Inelasticity, SolidClasses};
use crate::neighbourhood::BlockDamage;
use crate::parallel::BLOCK;

/// Inelastic stretches of bonds, and sums over the bonds of points.
#[derive(Default)]
pub(super) struct History {
    /// Number of viscous terms per bond.
    pub terms: usize,
    /// Inelastic stretch x of each entry.
    pub inelastic: Vec<f64>,
    /// Stretch of each entry at the end of the last step.
    pub last: Vec<f64>,
    /// Back-stretches ψ_k; the terms of a group of eight entries are consecutive.
    pub back: Vec<f64>,
    /// Time of the last update of each point, s.
    pub time: Vec<f64>,
    /// Σ ω r² over the intact bonds of each point.
    pub volume: Vec<f64>,
    /// Per point: Σ ω r² times the stretch of the last step (viscous) or the plastic stretch, followed by
    /// Σ ω r² ψ_k of each back-stretch.
    pub sums: Vec<f64>,
    /// Equivalent plastic strain of points.
    pub plastic_strain: Vec<f64>,
    /// Plastic multiplier of points: the change of e_p is its change times the deviatoric force state divided
    /// by w.
    pub multiplier: Vec<f64>,
    /// Reverse entry of each entry; itself for padding.
    pub opposite: Vec<u32>,
    /// First group of each point, and at the end the number of groups.
    start: Vec<usize>,
}

crate::saved! {
    impl Checkpointed for History {
        inelastic: by(Laid::rows("inelastic/stretch", start, inelastic.len())),
        last: by(Laid::rows("inelastic/last", start, last.len())),
        back: by(Laid::rows("inelastic/back", start, back.len())),
        time: points("inelastic/time"),
        volume: points("inelastic/volume"),
        sums: by(Laid::per_point("inelastic/sums", time.len(), sums.len())),
        plastic_strain: points("inelastic/plastic-strain"),
        multiplier: points("inelastic/multiplier"),
        terms, opposite, start: fixed,
    }
}

/// History of a block of points.
pub(super) struct Part<'a> {
    pub damage: &'a mut BlockDamage,
    pub inelastic: &'a mut [f64],
    pub last: &'a mut [f64],
    pub back: &'a mut [f64],
    pub sums: &'a mut [f64],
}

impl History {
    /// Creates an empty history; `volumes` are the weighted volumes of points.
    pub fn new(bonds: &BondList, terms: usize, volumes: Vec<f64>) -> Result<Self> {
        let (n, entries) = (volumes.len(), bonds.present().len() * LANES);
        Ok(Self {
            terms,
            inelastic: vec![0.0; entries],
            last: vec![0.0; entries],
            back: vec![0.0; terms * entries],
            time: vec![0.0; n],
            volume: volumes,
            sums: vec![0.0; (1 + terms) * n],
            plastic_strain: vec![0.0; n],
            multiplier: vec![0.0; n],
            opposite: bonds.opposites()?,
            start: bonds.start().to_vec(),
        })
    }

    /// Returns the sums of a point.
    pub fn sums(&self, i: usize) -> &[f64] {
        &self.sums[i * (1 + self.terms)..(i + 1) * (1 + self.terms)]
    }

    /// Returns Σ ω r² x of a point with the inelastic stretches x at the end of the last step.
    pub fn inelastic_sum(&self, law: &Inelasticity, i: usize) -> f64 {
        let sums = self.sums(i);
        match law {
            Inelasticity::Elastic => 0.0,
            Inelasticity::Plastic(_) => sums[0],
            Inelasticity::Viscous(terms) => {
                let terms = terms.iter().zip(&sums[1..]);
                terms.map(|(term, back)| term.share * back).sum()
            }
        }
    }

    /// Returns x of an entry and c, the energy constant of its inelastic stretches.
    pub fn stored(&self, law: &Inelasticity, entry: usize) -> [f64; 2] {
        let x = self.inelastic[entry];
        let first = entry / LANES * LANES * self.terms + entry % LANES;
        let square = |(k, share): (usize, f64)| share * self.back[first + k * LANES].powi(2);
        match law {
            Inelasticity::Elastic => [0.0; 2],
            Inelasticity::Plastic(_) => [x, x * x],
            Inelasticity::Viscous(terms) => {
                let shares = terms.iter().map(|term| term.share).enumerate();
                [x, shares.map(square).sum()]
            }
        }
    }

    /// Sets R of each entry at time t, the remaining contribution of inelastic stretches at the end of the
    /// last step. The deviatoric pull of the first point of the entry is S ψ − G R plus a number of the
    /// point.
    pub fn reliefs_into(
        &self,
        t: f64,
        bonds: &BondList,
        laws: &Laws,
        classes: &SolidClasses,
        out: &mut [f64],
    ) {
        let n = bonds.len();
        let parts = split_groups(bonds.start(), out, LANES);
        parts.into_par_iter().enumerate().for_each(|(block, out)| {
            let first = block * BLOCK;
            let start = bonds.start()[first];
            for i in first..n.min(first + BLOCK) {
                let terms = laws.of_material[classes.of_point(bonds.site(i))].terms();
                let relaxation = Relaxation::new(terms, (t - self.time[i]).max(0.0));
                for group in bonds.groups(i) {
                    let entries = group * LANES..(group + 1) * LANES;
                    let out = &mut out[(group - start) * LANES..(group - start + 1) * LANES];
                    if relaxation.terms == 0 {
                        out.copy_from_slice(&self.inelastic[entries]);
                        continue;
                    }
                    let back = &self.back[group * LANES * self.terms..];
                    let mut keep = relaxation.keep;
                    for (keep, share) in keep.iter_mut().zip(relaxation.share) {
                        *keep *= share;
                    }
                    let kept: F64x8 = weighted(&keep, relaxation.terms, back);
                    for (k, entry) in entries.enumerate() {
                        out[k] = kept.0[k] + relaxation.of_start() * self.last[entry];
                    }
                }
            }
        });
    }

    /// Returns time, intact weighted volume, plastic strain and multiplier of all points, and the history of
    /// each block.
    pub fn split<'a>(
        &'a mut self,
        start: &[usize],
        blocks: &'a mut [BlockDamage],
    ) -> ([&'a mut [f64]; 4], Vec<Part<'a>>) {
        let (n, terms) = (self.time.len(), self.terms);
        let of_groups = |array: &'a mut [f64], width| split_groups(start, array, width).into_iter();
        let mut inelastic = of_groups(&mut self.inelastic, LANES);
        let mut last = of_groups(&mut self.last, LANES);
        let mut back = of_groups(&mut self.back, terms * LANES);
        let mut sums = self.sums.chunks_mut((1 + terms) * BLOCK);
        let parts = blocks.iter_mut().map_while(|damage| {
            Some(Part {
                damage,
                inelastic: inelastic.next()?,
                last: last.next()?,
                back: back.next()?,
                sums: sums.next()?,
            })
        });
        let parts: Vec<_> = parts.collect();
        debug_assert_eq!(parts.len(), n.div_ceil(BLOCK));
        let points = [
            &mut self.time[..],
            &mut self.volume[..],
            &mut self.plastic_strain[..],
            &mut self.multiplier[..],
        ];
        (points, parts)
    }

    /// Returns the memory use, bytes.
    pub fn bytes(&self) -> usize {
        let numbers = [
            &self.inelastic,
            &self.last,
            &self.back,
            &self.time,
            &self.volume,
            &self.sums,
            &self.plastic_strain,
            &self.multiplier,
        ];
        let numbers: usize = numbers.iter().map(|array| size_of_val(&array[..])).sum();
        numbers + size_of_val(&self.opposite[..]) + size_of_val(&self.start[..])
    }
}

/// Splits an array with `width` numbers per group into parts for the blocks of points.
pub(super) fn split_groups<'a>(
    start: &[usize],
    mut array: &'a mut [f64],
    width: usize,
) -> Vec<&'a mut [f64]> {
    let n = start.len() - 1;
    let mut parts = Vec::with_capacity(n.div_ceil(BLOCK));
    for first in (0..n).step_by(BLOCK) {
        let groups = start[n.min(first + BLOCK)] - start[first];
        let (own, rest) = array.split_at_mut(width * groups);
        parts.push(own);
        array = rest;
    }
    parts
}
