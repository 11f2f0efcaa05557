//! Bond failure by energy: the work of the forces of a bond.
//!
//! An elongated bond breaks when the work w ∫ (T_i⟨ξ⟩ − T_j⟨−ξ⟩)·(y/|y|) de of its force states since the start exceeds the
//! critical bond energy w_c, J/m⁶, with the influence function w and the extension e = |y| − (1 + τ) |ξ| of a bond with
//! thermal stretch τ (Foster, Silling & Chen, Int. J. Multiscale Comput. Eng. 9, 2011, for ordinary materials). Only the
//! component of the force along the bond does work, so that a rotation of the body does none. Both ends store their own
//! values, so that a step can end for a subset of points.

use pericles::for_each_instruction_set;
use pericles::lanes::{LANES, Lanes, Row};
use pericles::operator::rows::Rows;
use pericles::operator::{Kinematics, PointSubset};
use pericles::parallel::{BLOCK, for_each_part};

use super::breaking::Entries;
use super::family::{Bond, Family, store};
use super::heat::Heat;
use super::history::{BondWork, HistorySize, cut};
use super::loops::{Ends, SecondLoop};
use super::{Solid, SolidForce};

/// Fraction of the critical bond energy above which bonds are checked individually.
const WATCH: f64 = 1.0 - 1e-9;

/// Stored numbers of the bonds of a block of points, and the batches with bonds beyond the limit: points, batches and bits.
struct BlockWork<'a> {
    of_bonds: &'a mut [f64],
    over: Vec<(usize, usize, u8)>,
}

/// What the loop reads.
struct WorkLoop<'a, S: Solid<D>, const D: usize> {
    second: SecondLoop<'a, S, D>,
    heat: &'a Heat,
    place: BondWork,
    /// Energy above which a bond may break, J/m⁶.
    limit: f64,
}

impl<S: Solid<D>, const D: usize> WorkLoop<'_, S, D> {
    /// Returns the mean thermal stretches of the bonds of a batch.
    #[inline(always)]
    fn thermal<T: Lanes>(&self, family: &Family<'_, D>, batch: usize) -> T {
        let sites = self.second.force.bonds.list().sites();
        let mut stretches = [0.0; LANES];
        if self.heat.stretches.is_some() {
            let here = self.heat.stretch(sites.point(family.site()));
            for (stretch, site) in stretches.iter_mut().zip(family.others(batch)) {
                *stretch = 0.5 * (here + self.heat.stretch(sites.point(site)));
            }
        }
        T::load(&stretches, 0)
    }
}

#[inline(always)]
fn work_rows_body<T: Lanes, S: Solid<D>, const D: usize>(
    work_loop: &WorkLoop<'_, S, D>,
    rows: &Rows<'_>,
    block: &mut BlockWork<'_>,
) {
    let (second, limit) = (&work_loop.second, T::splat(work_loop.limit));
    let (force, first) = (second.force, work_loop.place.first);
    let (start, width) = (force.bonds.list().start(), force.history_size.per_bond);
    let (half, zero) = (T::splat(0.5), T::splat(0.0));
    for k in 0..rows.count() {
        let i = rows.at(k);
        let family = Family::<D>::new(&force.bonds, i, force.bits(i), second.u);
        let mut here = second.here::<T>(family.site());
        for batch in 0..family.batches() {
            if family.intact(batch) == 0 {
                continue;
            }
            let bond: Bond<T, D> = family.bond(batch);
            let pull = second.pull(&family, batch, start[i] + batch, &mut here, &bond);
            let t = S::Kinematics::strain(bond.xi, bond.eta, bond.inverse_square);
            let direction = S::Kinematics::direction(bond.xi, bond.eta);
            let mut along = pull[0] * direction[0];
            for c in 1..D {
                along = pull[c].mul_add(direction[c], along);
            }
            let influence = family.influence::<T>(batch);
            let along = influence * along * S::Kinematics::contraction(t);
            let thermal = work_loop.thermal::<T>(&family, batch);
            let stretch = S::Kinematics::exact_stretch(t) - thermal;
            let number = (start[i] - start[rows.first] + batch) * width + first;
            let kept = |number: usize| T::load(block.of_bonds, number * LANES);
            let mean = half * (along + kept(number + 1));
            let work = mean.mul_add(stretch - kept(number + 2), kept(number));
            store(block.of_bonds, number, work);
            store(block.of_bonds, number + 1, along);
            store(block.of_bonds, number + 2, stretch);
            // Compressed bonds never break.
            let over = work.greater(limit) & stretch.greater(zero) & family.intact(batch);
            if over != 0 {
                block.over.push((i, batch, over));
            }
        }
    }
}

for_each_instruction_set! {
    /// Updates the work of the bonds of the rows, and adds the bonds beyond the limit.
    fn work_rows [S: Solid<D>, const D: usize] <S, D> (
        work_loop: &WorkLoop<'_, S, D>,
        rows: &Rows<'_>,
        block: &mut BlockWork<'_>,
    ) = work_rows_body on lanes
}

impl<S: Solid<D>, const D: usize> SolidForce<S, D> {
    /// Returns how many numbers the materials store, without the work of bonds, on which no force depends.
    pub(super) fn material_history(&self) -> HistorySize {
        let all = self.history_size;
        HistorySize {
            per_bond: self.work.map_or(all.per_bond, |work| work.first),
            ..all
        }
    }

    /// Returns the stored numbers of all bonds with the work of the points `on` at a displacement, and their entries that
    /// exceed `fraction` of the critical bond energy; `None` if bonds do not break by energy. All processes must call it
    /// together.
    pub(super) fn worked(
        &self,
        t: f64,
        u: &[Row],
        on: &PointSubset<'_>,
        heat: &Heat,
        fraction: f64,
    ) -> Option<(Vec<f64>, Entries)> {
        let place = self.work?;
        let states = self.states_of_ends(t, heat, u, on);
        let planes = self.planes(&states.values);
        let work_loop = WorkLoop {
            second: SecondLoop {
                force: self,
                u,
                ends: Ends {
                    of_points: &planes,
                    of_bonds: &states.of_bonds,
                },
                change: None,
            },
            heat,
            place,
            limit: WATCH * fraction * self.weakest.energy,
        };
        let (list, mut kept) = (self.bonds.list(), self.history.bonds.clone());
        let width = self.history_size.per_bond * LANES;
        let first = |block: usize| (block * BLOCK).min(list.len());
        let mut rest = &mut kept[..];
        let of_block = |block: usize| {
            let groups = list.start()[first(block + 1)] - list.start()[first(block)];
            BlockWork {
                of_bonds: cut(&mut rest, groups * width),
                over: Vec::new(),
            }
        };
        let mut blocks: Vec<BlockWork<'_>> =
            (0..list.len().div_ceil(BLOCK)).map(of_block).collect();
        for_each_part([], &mut blocks, list.cost(on), &first, &|block, [], own| {
            let length = first(block + 1) - first(block);
            if let Some(rows) = Rows::of_block(on, first(block), length) {
                work_rows::<S, D>(self.set, &work_loop, &rows, own);
            }
        });
        let over: Vec<_> = blocks.into_iter().flat_map(|block| block.over).collect();
        let mut found = Entries::new();
        for (i, batch, bits) in over {
            self.family(i, u).for_each_of(batch, bits, |bond| {
                let (group, lane) = (bond.entry / LANES, bond.entry % LANES);
                let energy = kept[group * width + place.first * LANES + lane];
                let limit = self.materials.limits(list.site(i), bond.site).energy;
                if energy > fraction * limit && list.may_break(bond.entry) {
                    found.push((i, bond.entry));
                }
            });
        }
        Some((kept, found))
    }
}
