//! Bond failure, plastic flow and their dissipated energy.
//!
//! The energy of a point is a function of all its bonds. A point that loses bonds dissipates the difference
//! of its energies before and after, each with its own shape tensor, less the work of its forces in the part
//! of the step in which they no longer act ([`StepEnd::dissipated_energy`]).

use std::collections::BTreeMap;

use pericles::StepEnd;
use pericles::domain::{Field, Letter};
use pericles::lanes::{LANES, Row};
use pericles::material::{BondStretch, PairForce};
use pericles::neighbourhood::{
    BondSet, BreakEvent, CoarseBreak, Crossing, Form, LostBond, turns_around,
};
use pericles::operator::rows::Rows;
use pericles::operator::{Breakable, PointSubset};
use pericles::parallel::{BLOCK, for_each_chunk_of};
use rayon::prelude::*;

use super::force::{CorrespondenceForce, PointShape, STIFFENING};
use super::heat::Heat;
use super::plasticity::History;
use super::tensor::{combination, unit};

/// State of a point before it lost bonds in this step.
struct Before<const D: usize> {
    intact: Vec<u8>,
    shape: PointShape<D>,
}

/// Pairs of a point and a list entry.
pub(super) type Entries = Vec<(usize, usize)>;

impl<const D: usize> CorrespondenceForce<D> {
    /// Breaks the bonds of the points `on` that exceed their critical stretch or strength, and all bonds of points whose
    /// remaining bonds do not span the space. Adds the dissipated energy.
    pub(super) fn break_bonds(&mut self, step: &StepEnd<'_>, u: Field<'_>, on: &PointSubset<'_>) {
        let domain = self.cloud.domain().clone();
        let heat = self.heat_at(step.t);
        let mut found = self.over_stretched(&self.packed(u), on, &heat);
        if self.limits.has_criteria() {
            found.extend(self.over_stressed(&self.packed(u), on, &heat, 1.0));
        }
        if domain.all(found.is_empty()) {
            return;
        }
        let rows = self.packed(u).to_vec();
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
                let shape = self.shape(i);
                if shape.bonds > 0 && !shape.is_regular() {
                    self.drop_point(i, &mut found);
                }
                self.shapes[i] = self.shape_of(i);
            }
        }
        self.book(step, &rows, before, &heat);
    }

    /// Returns the entries of the points `on` whose bonds exceed their critical stretch.
    fn over_stretched(&self, rows: &[Row], on: &PointSubset<'_>, heat: &Heat) -> Entries {
        let n = self.cloud.len();
        let threshold = BondStretch::threshold(self.weakest);
        let sites = self.bonds.list().sites();
        let of_block = |block: usize| {
            let first = block * BLOCK;
            let mut found = Entries::new();
            let Some(wanted) = Rows::of_block(on, first, BLOCK.min(n - first)) else {
                return found;
            };
            for i in (0..wanted.count()).map(|k| wanted.at(k)) {
                let here = self.bonds.list().site(i);
                self.bonds.for_each::<D>(i, self.bits(i), |bond| {
                    let eta = Self::eta(rows, here, &bond);
                    let (xi, eta) = heat.expanded(sites, [here, bond.site], bond.xi, eta);
                    let (measure, square) = BondStretch::stretch_measure(xi, eta);
                    let limit = self.limits.stretch(here, bond.site);
                    if measure > threshold * square
                        && self.bonds.list().may_break(bond.entry)
                        && measure > BondStretch::threshold(limit) * square
                    {
                        found.push((i, bond.entry));
                    }
                });
            }
            found
        };
        let blocks: Vec<Entries> = (0..n.div_ceil(BLOCK))
            .into_par_iter()
            .map(of_block)
            .collect();
        blocks.concat()
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
        let known: std::collections::BTreeSet<usize> =
            found.iter().map(|&(_, entry)| entry).collect();
        let letters = self.cloud.domain().deliver(letters.collect());
        let back = |letter: &Letter| {
            let entry = list.entry_at(list.place_of(letter)?);
            let wanted = self.bonds.all.is_intact(letter.to, entry) && !known.contains(&entry);
            wanted.then_some((letter.to, entry))
        };
        letters.iter().filter_map(back).collect()
    }

    /// Adds all remaining breakable bonds of a point whose bonds do not determine a deformation gradient.
    fn drop_point(&mut self, i: usize, found: &mut Entries) {
        let before = found.len();
        self.bonds.for_each::<D>(i, self.bits(i), |bond| {
            if self.bonds.list().may_break(bond.entry) {
                found.push((i, bond.entry));
            }
        });
        if found.len() > before {
            self.dropped = self.dropped.saturating_add(1);
        }
    }

    /// Adds the energy dissipated by points that lost bonds.
    fn book(
        &mut self,
        step: &StepEnd<'_>,
        rows: &[Row],
        before: BTreeMap<usize, Before<D>>,
        heat: &Heat,
    ) {
        let ghosts = step.ghost_velocities(self.cloud.domain());
        let velocity = step.velocities(&ghosts);
        let volumes = self.cloud.clone();
        let mut velocities = vec![Row::default(); if velocity.is_some() { rows.len() } else { 0 }];
        if let Some(velocity) = velocity
            && !before.is_empty()
        {
            let sites = self.bonds.list().sites();
            pericles::operator::records::pack_sites::<D>(velocity, sites, &mut velocities);
        }
        // Displacements at the start of the step.
        let moved = |(row, velocity): (&Row, &Row)| -> Row {
            Row(std::array::from_fn(|c| row[c] - step.dt * velocity[c]))
        };
        let earlier: Vec<Row> = rows.iter().zip(&velocities).map(moved).collect();
        for (i, before) in before {
            let shape = self.shapes[i];
            let after = self.bits(i).to_vec();
            let (velocities, volume) = (&velocities[..], volumes.volumes()[i]);
            let (crossing, lost) = self.lost_bonds(i, &before.intact, [rows, &earlier], heat);
            let mut loss = |rows: &[Row]| -> [f64; 2] {
                let [energy, power] = self.energy_and_power(i, &shape, [rows, velocities], heat);
                self.bonds.all.bits_mut(i).copy_from_slice(&before.intact);
                let [more, stronger] =
                    self.energy_and_power(i, &before.shape, [rows, velocities], heat);
                self.bonds.all.bits_mut(i).copy_from_slice(&after);
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
        let here = self.bonds.list().site(i);
        let (now, sites) = (self.bits(i), self.bonds.list().sites());
        let broken: Vec<u8> = before.iter().zip(now).map(|(a, b)| a & !b).collect();
        let (mut crossing, mut lost) = (Crossing::default(), Vec::new());
        self.bonds.for_each::<D>(i, &broken, |bond| {
            let stretch = |rows: &[Row]| {
                let eta = Self::eta(rows, here, &bond);
                let (xi, eta) = heat.expanded(sites, [here, bond.site], bond.xi, eta);
                let length = |x: [f64; D]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
                length(std::array::from_fn(|c| xi[c] + eta[c])) / length(xi) - 1.0
            };
            let end = stretch(rows);
            let start = if earlier.is_empty() {
                end
            } else {
                stretch(earlier)
            };
            let square: f64 = bond.xi.iter().map(|x| x * x).sum();
            let share = bond.weight * square * end * end;
            let eta = Self::eta(rows, here, &bond);
            let turned = !earlier.is_empty()
                && turns_around(&bond.xi, &Self::eta(earlier, here, &bond), &eta);
            let critical = self.limits.stretch(here, bond.site);
            crossing.add(share, [start, end], critical, turned);
            lost.push(LostBond {
                neighbour: sites.point(bond.site),
                along: std::array::from_fn(|c| bond.xi[c] + eta[c]),
                share,
            });
        });
        (crossing, lost)
    }

    /// Returns the energy W of a point with a shape (J/m³), including the plastic work of the step so that
    /// its gradient is the stress, and its rate Σ_j b V_j T_ij·(v_j − v_i) (W/m³) from the velocities of
    /// sites; without velocities the rate is zero.
    fn energy_and_power(
        &self,
        i: usize,
        shape: &PointShape<D>,
        [rows, velocities]: [&[Row]; 2],
        heat: &Heat,
    ) -> [f64; 2] {
        let gradient = self.gradient(i, &shape.inverse, &self.etas(i, rows));
        let f = combination(1.0, &unit::<D>(), 1.0, &gradient);
        let solid = self.classes.solid(i).expanded(heat.factor(i));
        let (_, plastic_work) = solid.advanced(&f, &self.history_of(i));
        let energy = self.energy_of(i, shape, rows, heat) + shape.share * plastic_work;
        if velocities.is_empty() {
            return [energy, 0.0];
        }
        let (state, _) = self.state_of(i, shape, &self.etas(i, rows), heat);
        let (here, nothing) = (self.bonds.list().site(i), Default::default());
        let mut power = 0.0;
        self.bonds.for_each::<D>(i, self.bits(i), |bond| {
            let (eta, moved) = (
                Self::eta(rows, here, &bond),
                Self::eta(velocities, here, &bond),
            );
            let mut pull = [0.0; D];
            state.add_force(&nothing, &bond, &eta, &mut pull);
            power += (0..D).map(|c| pull[c] * moved[c]).sum::<f64>();
        });
        [energy, power]
    }

    /// Advances the plastic flow of the points `on` to the end of the step at `u`, and adds its work.
    pub(super) fn advance_history(&mut self, t: f64, u: Field<'_>, on: &PointSubset<'_>) {
        let (n, heat) = (self.cloud.len(), self.heat_at(t));
        let mut history = std::mem::take(&mut self.history);
        let rows = self.packed(u);
        let of_blocks: Vec<Vec<(usize, f64)>> = history
            .par_chunks_mut(BLOCK * History::KEPT)
            .enumerate()
            .map(|(block, kept)| {
                let (first, mut works) = (block * BLOCK, Vec::new());
                let Some(wanted) = Rows::of_block(on, first, BLOCK.min(n - first)) else {
                    return works;
                };
                for i in (0..wanted.count()).map(|k| wanted.at(k)) {
                    let kept = &mut kept[(i - first) * History::KEPT..][..History::KEPT];
                    let gradient = self.gradient(i, &self.shapes[i].inverse, &self.etas(i, &rows));
                    let f = combination(1.0, &unit::<D>(), 1.0, &gradient);
                    let solid = self.classes.solid(i).expanded(heat.factor(i));
                    let (next, work) = solid.advanced(&f, &History::of(kept));
                    next.keep(kept);
                    if work != 0.0 {
                        works.push((i, self.shapes[i].share * work * self.cloud.volumes()[i]));
                    }
                }
                works
            })
            .collect();
        drop(rows);
        self.history = history;
        for (i, work) in of_blocks.into_iter().flatten() {
            self.bonds.all.tally_mut(i).dissipate(i, work);
        }
    }
}

impl<const D: usize> Breakable for CorrespondenceForce<D> {
    fn bonds(&self) -> &dyn BondSet {
        &self.bonds.all
    }

    fn bonds_mut(&mut self) -> &mut dyn BondSet {
        &mut self.bonds.all
    }

    fn can_break(&self) -> bool {
        self.weakest.is_finite() || self.limits.has_criteria()
    }

    fn dropped_points(&self) -> u64 {
        CorrespondenceForce::dropped_points(self)
    }

    fn stiffening(&self) -> f64 {
        if self.can_break() {
            STIFFENING.sqrt()
        } else {
            1.0
        }
    }

    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak> {
        self.bonds.all.take_coarse_parts()
    }

    fn mark_endangered(&self, u: &[f64], fraction: f64, marks: &mut [bool]) {
        let ghosts = self.cloud.domain().ghosts(u);
        let rows = self.packed(Field::new(u, &ghosts));
        let (heat, sites) = (self.latest_heat(), self.bonds.list().sites());
        if self.limits.has_criteria() {
            for (i, _) in self.over_stressed(&rows, &PointSubset::All, &heat, fraction) {
                marks[i] = true;
            }
        }
        for_each_chunk_of(
            marks,
            self.bonds.list().cost(&PointSubset::All),
            &|first, marks| {
                for (i, mark) in (first..).zip(marks).filter(|(_, mark)| !**mark) {
                    let here = self.bonds.list().site(i);
                    self.bonds.for_each::<D>(i, self.bits(i), |bond| {
                        let eta = Self::eta(&rows, here, &bond);
                        let (xi, eta) = heat.expanded(sites, [here, bond.site], bond.xi, eta);
                        let (measure, square) = BondStretch::stretch_measure(xi, eta);
                        let limit = fraction * self.limits.stretch(here, bond.site);
                        *mark |= self.bonds.list().may_break(bond.entry)
                            && measure > BondStretch::threshold(limit) * square;
                    });
                }
            },
        );
    }
}
