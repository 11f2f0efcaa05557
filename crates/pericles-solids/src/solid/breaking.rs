//! Bond failure and its dissipated energy.
//!
//! The energy of a point is a function of all its bonds. A point that loses bonds dissipates the difference
//! of its energies before and after, each with its own shape, less the work of its forces in the part
//! of the step in which they no longer act ([`StepEnd::dissipated_energy`]).

use std::collections::{BTreeMap, BTreeSet};

use pericles::StepEnd;
use pericles::domain::{Field, Letter};
use pericles::lanes::{F64x8, LANES, Row};
use pericles::material::PairForce;
use pericles::neighbourhood::{
    BondSet, BreakEvent, CoarseBreak, Crossing, Form, LostBond, turns_around,
};
use pericles::operator::records::pack_sites;
use pericles::operator::rows::Rows;
use pericles::operator::{Breakable, Kinematics, PointSubset};
use pericles::parallel::{BLOCK, for_each_part};
use rayon::prelude::*;

use super::family::SingleBond;
use super::heat::Heat;
use super::loops::{FirstLoop, advance_rows, for_each_pull, watch_rows};
use super::view::in_lanes;
use super::{Solid, SolidForce, State};

/// State of a point before it lost bonds in this step.
struct Before<S> {
    intact: Vec<u8>,
    shape: Option<S>,
}

/// Pairs of a point and a list entry.
pub(super) type Entries = Vec<(usize, usize)>;

/// Fraction of the threshold above which bonds are checked individually; the margin exceeds the rounding error of the
/// lanes.
const WATCH: f64 = 1.0 - 1e-9;

impl<S: Solid<D>, const D: usize> SolidForce<S, D> {
    /// Breaks the bonds of the points `on` that exceed their critical stretch, energy or strength, and all bonds of
    /// points whose remaining bonds do not determine a force state. Adds the dissipated energy. All processes must call it together.
    pub(super) fn break_bonds(&mut self, step: &StepEnd<'_>, u: Field<'_>, on: &PointSubset<'_>) {
        let domain = self.cloud.domain().clone();
        let heat = self.heat_at(step.t);
        let packed = self.packed(u);
        let mut found = self.beyond(step.t, &packed, on, &heat, 1.0);
        let worked = self.worked(step.t, &packed, on, &heat, 1.0);
        let numbers = worked.map(|(numbers, over)| {
            found.extend(over);
            numbers
        });
        let rows = (!domain.all(found.is_empty())).then(|| packed.to_vec());
        drop(packed);
        if let Some(numbers) = numbers {
            self.history.bonds = numbers;
        }
        let Some(rows) = rows else {
            return;
        };
        let mut before = BTreeMap::new();
        while !domain.all(found.is_empty()) {
            let others = self.other_ends(&found);
            found.extend(others);
            let mut touched: Vec<usize> = found.iter().map(|&(i, _)| i).collect();
            touched.sort_unstable();
            touched.dedup();
            for &i in &touched {
                before.entry(i).or_insert_with(|| Before {
                    intact: self.bits(i).to_vec(),
                    shape: self.shapes[i],
                });
            }
            for (i, entry) in found.drain(..) {
                let group = entry / LANES - self.bonds.list().groups(i).start;
                self.bonds.all.bits_mut(i)[group] &= !(1 << (entry % LANES));
            }
            for i in touched {
                self.shapes[i] = self.shape_of(i, &rows);
                if self.shapes[i].is_none() {
                    self.drop_point(i, &mut found);
                }
            }
        }
        self.book(step, &rows, before, &heat);
    }

    /// Returns the entries of the points `on` whose bonds exceed `fraction` of their critical stretch or strength. All
    /// processes must call it together.
    fn beyond(
        &self,
        t: f64,
        rows: &[Row],
        on: &PointSubset<'_>,
        heat: &Heat,
        fraction: f64,
    ) -> Entries {
        let mut found = self.over_stretched(rows, on, heat, fraction);
        if !self.materials.criteria().is_empty() {
            found.extend(self.over_stressed(t, rows, on, heat, fraction));
        }
        found
    }

    /// Returns the entries that `of_point` adds for the points `on`, in their order.
    pub(super) fn entries_of(
        &self,
        on: &PointSubset<'_>,
        of_point: impl Fn(usize, &mut Entries) + Sync,
    ) -> Entries {
        let n = self.cloud.len();
        let of_block = |block: usize| {
            let (first, mut found) = (block * BLOCK, Entries::new());
            if let Some(rows) = Rows::of_block(on, first, BLOCK.min(n - first)) {
                (0..rows.count()).for_each(|k| of_point(rows.at(k), &mut found));
            }
            found
        };
        let blocks: Vec<Entries> = (0..n.div_ceil(BLOCK))
            .into_par_iter()
            .map(of_block)
            .collect();
        blocks.concat()
    }

    /// Returns the entries of the points `on` whose bonds exceed `fraction` of their critical stretch.
    fn over_stretched(
        &self,
        rows: &[Row],
        on: &PointSubset<'_>,
        heat: &Heat,
        fraction: f64,
    ) -> Entries {
        if self.weakest.stretch.is_infinite() {
            return Entries::new();
        }
        if self.expansion.is_some() {
            return self.entries_of(on, |i, found| {
                let family = self.family(i, rows);
                family.for_each(|bond| self.check(i, bond, heat, fraction, found));
            });
        }
        let threshold = WATCH * threshold::<S, D>(fraction * self.weakest.stretch);
        let mut blocks: Vec<Vec<(usize, usize, u8)>> =
            vec![Vec::new(); self.cloud.len().div_ceil(BLOCK)];
        let (list, n) = (self.bonds.list(), self.cloud.len());
        let first = |block: usize| (block * BLOCK).min(n);
        for_each_part(
            [],
            &mut blocks,
            list.cost(on),
            &first,
            &|block, [], found| {
                let length = first(block + 1) - first(block);
                if let Some(wanted) = Rows::of_block(on, first(block), length) {
                    watch_rows::<S, D>(self.set, self, rows, threshold, &wanted, found);
                }
            },
        );
        let mut found = Entries::new();
        for (i, batch, bits) in blocks.into_iter().flatten() {
            let family = self.family(i, rows);
            family.for_each_of(batch, bits, |bond| {
                self.check(i, bond, heat, fraction, &mut found);
            });
        }
        found
    }

    /// Adds a bond that may break if it exceeds `fraction` of its critical stretch.
    fn check(
        &self,
        i: usize,
        bond: &SingleBond<D>,
        heat: &Heat,
        fraction: f64,
        found: &mut Entries,
    ) {
        let list = self.bonds.list();
        let here = list.site(i);
        let (xi, eta) = heat.expanded(list.sites(), [here, bond.site], bond.xi, bond.eta);
        let (measure, square) = Measure::<S, D>::stretch_measure(xi, eta);
        let limit = fraction * self.materials.limits(here, bond.site).stretch;
        if measure > threshold::<S, D>(limit) * square && list.may_break(bond.entry) {
            found.push((i, bond.entry));
        }
    }

    /// Returns the reverse entries of bonds that are intact and not in `found`.
    fn other_ends(&self, found: &Entries) -> Entries {
        let list = self.bonds.list();
        let letters = found.iter().map(|&(i, entry)| {
            list.letter(&BreakEvent {
                point: i as u32,
                entry,
                dissipated: 0.0,
            })
        });
        let known: BTreeSet<usize> = found.iter().map(|&(_, entry)| entry).collect();
        let letters = self.cloud.domain().deliver(letters.collect());
        let back = |letter: &Letter| {
            let entry = list.entry_at(list.place_of(letter)?);
            let wanted = self.bonds.all.is_intact(letter.to, entry) && !known.contains(&entry);
            wanted.then_some((letter.to, entry))
        };
        letters.iter().filter_map(back).collect()
    }

    /// Adds all remaining breakable bonds of a point whose bonds do not determine a force state.
    fn drop_point(&mut self, i: usize, found: &mut Entries) {
        let before = found.len();
        let breakable = |&(entry, _): &(usize, usize)| self.bonds.list().may_break(entry);
        let entries = self.bonds.all.intact_of(i).filter(breakable);
        found.extend(entries.map(|(entry, _)| (i, entry)));
        if found.len() > before {
            self.dropped = self.dropped.saturating_add(1);
        }
    }

    /// Adds the energy dissipated by points that lost bonds. All processes must call it together.
    fn book(
        &mut self,
        step: &StepEnd<'_>,
        rows: &[Row],
        before: BTreeMap<usize, Before<S::Shape>>,
        heat: &Heat,
    ) {
        let ghosts = step.ghost_velocities(self.cloud.domain());
        let velocity = step.velocities(&ghosts);
        let mut velocities = vec![Row::default(); if velocity.is_some() { rows.len() } else { 0 }];
        if let Some(velocity) = velocity
            && !before.is_empty()
        {
            pack_sites::<D>(velocity, self.bonds.list().sites(), &mut velocities);
        }
        // Displacements at the start of the step.
        let moved = |(row, velocity): (&Row, &Row)| -> Row {
            Row(std::array::from_fn(|c| row[c] - step.dt * velocity[c]))
        };
        let earlier: Vec<Row> = rows.iter().zip(&velocities).map(moved).collect();
        for (i, before) in before {
            let (shape, after) = (self.shapes[i], self.bits(i).to_vec());
            let (velocities, volume) = (&velocities[..], self.cloud.volumes()[i]);
            let (crossing, lost) = self.lost_bonds(i, &before.intact, [rows, &earlier], heat);
            let mut loss = |rows: &[Row]| -> [f64; 2] {
                let [energy, power] = self.energy_and_power(i, step.t, [rows, velocities], heat);
                self.bonds.all.bits_mut(i).copy_from_slice(&before.intact);
                self.shapes[i] = before.shape;
                let [more, stronger] = self.energy_and_power(i, step.t, [rows, velocities], heat);
                self.bonds.all.bits_mut(i).copy_from_slice(&after);
                self.shapes[i] = shape;
                [volume * (more - energy), volume * (stronger - power)]
            };
            let end = loss(rows);
            let energy = crossing.dissipated(step, end, || loss(&earlier));
            let count = |bits: &[u8]| -> u64 {
                let ones = bits.iter().map(|byte| u64::from(byte.count_ones()));
                ones.sum()
            };
            let tally = self.bonds.all.tally_mut(i);
            tally.lose(i, energy, &lost);
            tally.broken.add(count(&before.intact) - count(&after));
        }
    }

    /// Returns the bonds of point i that are intact in `before` and broken now, and where within the step they reached their
    /// limits; `rows` and `earlier` are displacements at the end and the start of the step, the latter empty if unknown.
    fn lost_bonds(
        &self,
        i: usize,
        before: &[u8],
        [rows, earlier]: [&[Row]; 2],
        heat: &Heat,
    ) -> (Crossing, Vec<LostBond<D>>) {
        let (now, sites) = (self.bits(i), self.bonds.list().sites());
        let broken: Vec<u8> = before.iter().zip(now).map(|(a, b)| a & !b).collect();
        let (mut crossing, mut lost) = (Crossing::default(), Vec::new());
        let here = sites.of_point(i);
        let stretch = |bond: &SingleBond<D>| {
            let ends = [here, bond.site];
            let (xi, eta) = heat.expanded(sites, ends, bond.xi, bond.eta);
            in_lanes(&SingleBond { xi, eta, ..*bond })
                .stretch::<S::Kinematics>()
                .0[0]
        };
        let mut starts = Vec::new();
        if !earlier.is_empty() {
            self.family_with(i, &broken, earlier)
                .for_each(|bond| starts.push(*bond));
        }
        let mut starts = starts.iter();
        self.family_with(i, &broken, rows).for_each(|bond| {
            let start = starts.next();
            let end = stretch(bond);
            let square: f64 = bond.xi.iter().map(|x| x * x).sum();
            let share = bond.weight * square * end * end;
            let turned = start.is_some_and(|start| turns_around(&bond.xi, &start.eta, &bond.eta));
            let critical = self.materials.limits(here, bond.site).stretch;
            crossing.add(share, [start.map_or(end, stretch), end], critical, turned);
            let along = S::Kinematics::direction(in_lanes(bond).xi, in_lanes(bond).eta);
            lost.push(LostBond {
                neighbour: sites.point(bond.site),
                along: along.map(|x| x.0[0]),
                share,
            });
        });
        (crossing, lost)
    }

    /// Returns [`Solid::potential`] of a point (J/m³) and its rate Σ_j b V_j T_ij·(v_j − v_i) (W/m³) from the velocities of
    /// sites; without velocities the rate is zero.
    fn energy_and_power(
        &self,
        i: usize,
        t: f64,
        [rows, velocities]: [&[Row]; 2],
        heat: &Heat,
    ) -> [f64; 2] {
        let Some(at) = self.point(i, t, heat, rows) else {
            return [0.0; 2];
        };
        let factor = self.stiffness_of(i);
        let energy = factor * self.material(i).potential(&at);
        if velocities.is_empty() {
            return [energy, 0.0];
        }
        let (moving, mut power) = (at.family.at(velocities), F64x8([0.0; LANES]));
        let set_state = |out: &mut State<'_>| self.material(i).potential_state(&at, out);
        for_each_pull::<S, D>(&at, set_state, |batch, bond, pull| {
            let moved = moving.eta::<F64x8>(batch);
            for c in 0..D {
                power = power + bond.weight * pull[c] * moved[c];
            }
        });
        [energy, factor * power.sum()]
    }

    /// Sets the stored numbers of the points `on` to the end of a step, and adds the energy that they dissipate.
    pub(super) fn advance(&mut self, step: &StepEnd<'_>, u: Field<'_>, on: &PointSubset<'_>) {
        let mut history = std::mem::take(&mut self.history);
        let mut blocks = history.blocks();
        {
            let (heat, rows) = (self.heat_at(step.t), self.packed(u));
            let (n, list, this) = (self.cloud.len(), self.bonds.list(), &*self);
            let first_loop = FirstLoop {
                force: this,
                heat: &heat,
                t: step.t,
                u: &rows,
                direction: None,
            };
            let first = |block: usize| (block * BLOCK).min(n);
            for_each_part([], &mut blocks, list.cost(on), &first, &|block, [], own| {
                let length = first(block + 1) - first(block);
                if let Some(wanted) = Rows::of_block(on, first(block), length) {
                    advance_rows::<S, D>(this.set, &first_loop, step.is_start(), &wanted, own);
                }
            });
        }
        let works = blocks.into_iter().flat_map(|block| block.works);
        for (i, work) in works.enumerate().filter(|(_, work)| *work != 0.0) {
            self.bonds.all.tally_mut(i).dissipate(i, work);
        }
        self.history = history;
    }

    /// Returns the time of the last stored numbers, s.
    pub(super) fn latest_time(&self) -> f64 {
        self.history.time.iter().copied().fold(0.0, f64::max)
    }
}

/// The stretch measure of the kinematics of a material.
type Measure<S, const D: usize> = <<S as Solid<D>>::Kinematics as Kinematics>::Measure;

/// Returns the threshold of the measure for a critical stretch.
fn threshold<S: Solid<D>, const D: usize>(stretch: f64) -> f64 {
    Measure::<S, D>::threshold(stretch)
}

impl<S: Solid<D>, const D: usize> Breakable for SolidForce<S, D> {
    fn bonds(&self) -> &dyn BondSet {
        &self.bonds.all
    }

    fn bonds_mut(&mut self) -> &mut dyn BondSet {
        &mut self.bonds.all
    }

    fn can_break(&self) -> bool {
        self.can_lose_bonds()
    }

    fn dropped_points(&self) -> u64 {
        SolidForce::dropped_points(self)
    }

    fn stiffening(&self) -> f64 {
        let factors = self.materials.all().iter().map(Solid::stiffening);
        match self.can_lose_bonds() {
            true => factors.fold(1.0, f64::max),
            false => 1.0,
        }
    }

    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak> {
        self.bonds.all.take_coarse_parts()
    }

    fn mark_endangered(&self, u: &[f64], fraction: f64, marks: &mut [bool]) {
        let ghosts = self.cloud.domain().ghosts(u);
        let rows = self.packed(Field::new(u, &ghosts));
        let (heat, all) = (self.latest_heat(), PointSubset::All);
        let t = self.latest_time();
        let mut found = self.beyond(t, &rows, &all, &heat, fraction);
        let worked = self.worked(t, &rows, &all, &heat, fraction);
        found.extend(worked.into_iter().flat_map(|(_, over)| over));
        for (i, _) in found {
            marks[i] = true;
        }
    }
}
