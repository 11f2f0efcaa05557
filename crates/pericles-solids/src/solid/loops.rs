//! The loops over the points and bonds of a body, for every instruction set.

use pericles::for_each_instruction_set;
use pericles::lanes::{F64x8, LANES, Lanes, Row};
use pericles::operator::Kinematics;
use pericles::operator::rows::Rows;

use super::family::{Bond, Family, Point};
use super::force::{SolidForce, States};
use super::heat::Heat;
use super::history::{BlockHistory, NextHistory};
use super::{End, MOST_VALUES, Solid, State};

/// What the first loop reads.
pub(super) struct FirstLoop<'a, S: Solid<D>, const D: usize> {
    pub force: &'a SolidForce<S, D>,
    pub heat: &'a Heat,
    pub t: f64,
    /// Displacements by site.
    pub u: &'a [Row],
    /// A direction by site, if derivatives are computed.
    pub direction: Option<&'a [Row]>,
}

/// Values of a block of points and of their bonds.
pub(super) struct BlockValues<'a> {
    pub values: &'a mut [f64],
    pub of_bonds: &'a mut [f64],
}

#[inline(always)]
fn state_rows_body<T: Lanes, S: Solid<D>, const D: usize>(
    first_loop: &FirstLoop<'_, S, D>,
    rows: &Rows<'_>,
    values: &mut BlockValues<'_>,
    dilatations: &mut [f64],
) {
    let force = first_loop.force;
    let start = force.bonds.list().start();
    let width = S::VALUES;
    for k in 0..rows.count() {
        let i = rows.at(k);
        let (place, first) = (i - rows.first, start[rows.first]);
        let mut out = State {
            values: &mut values.values[place * width..(place + 1) * width],
            of_bonds: match S::BOND_VALUES {
                true => {
                    &mut values.of_bonds[(start[i] - first) * LANES..(start[i + 1] - first) * LANES]
                }
                false => &mut [],
            },
        };
        let Some(at) = force.point(i, first_loop.t, first_loop.heat, first_loop.u) else {
            // `fill` is not inlined.
            for value in out.values.iter_mut().chain(&mut *out.of_bonds) {
                *value = 0.0;
            }
            dilatations[place] = 0.0;
            continue;
        };
        let material = force.material(i);
        match first_loop.direction {
            None => dilatations[place] = material.state::<T>(&at, &mut out),
            Some(direction) => {
                let direction = at.family.at(direction);
                material.state_change::<T>(&at, &direction, &mut out);
            }
        }
        if !force.stiffness.is_empty() {
            let factor = force.stiffness_of(i);
            for value in out.values.iter_mut().chain(&mut *out.of_bonds) {
                *value *= factor;
            }
        }
    }
}

for_each_instruction_set! {
    /// Calls [`Solid::state`] or [`Solid::state_change`] for the rows.
    pub(super) fn state_rows [S: Solid<D>, const D: usize] <S, D> (
        first_loop: &FirstLoop<'_, S, D>,
        rows: &Rows<'_>,
        values: &mut BlockValues<'_>,
        dilatations: &mut [f64],
    ) = state_rows_body on lanes
}

/// Values that bonds read at their ends.
pub(super) struct Ends<'a> {
    /// Values of points by site, in rows of four: the rows of all sites for the first four values come first.
    pub of_points: &'a [Row],
    /// Values of bonds by entry.
    pub of_bonds: &'a [f64],
}

/// What the second loop reads.
pub(super) struct SecondLoop<'a, S: Solid<D>, const D: usize> {
    pub force: &'a SolidForce<S, D>,
    pub u: &'a [Row],
    pub ends: Ends<'a>,
    /// A direction by site and the changes of the values, if derivatives are computed.
    pub change: Option<(&'a [Row], Ends<'a>)>,
}

impl Ends<'_> {
    /// Returns the values that the bonds of a point read at the point.
    #[inline(always)]
    fn here<T: Lanes>(&self, site: usize, sites: usize, width: usize) -> End<T> {
        let mut end = End::none();
        for number in 0..width {
            let row = &self.of_points[number / 4 * sites + site];
            end.values[number] = T::splat(row[number % 4]);
        }
        end
    }

    /// Sets the values that the bonds of a batch read at their other ends.
    #[inline(always)]
    fn there<T: Lanes, const D: usize>(
        &self,
        family: &Family<'_, D>,
        batch: usize,
        sites: usize,
        width: usize,
    ) -> End<T> {
        let mut end = End::none();
        for plane in 0..width.div_ceil(4) {
            let rows = &self.of_points[plane * sites..(plane + 1) * sites];
            let numbers = family.gather::<T>(batch, rows);
            for c in 0..4 {
                if 4 * plane + c < MOST_VALUES {
                    end.values[4 * plane + c] = numbers[c];
                }
            }
        }
        end
    }

    /// Sets the values of the bonds of a batch from both sides.
    #[inline(always)]
    fn of_batch<T: Lanes>(&self, group: usize, opposite: &[u32], ends: [&mut End<T>; 2]) {
        let [here, there] = ends;
        here.of_bond = T::load(self.of_bonds, group * LANES);
        let mut back = [0.0; LANES];
        for lane in 0..LANES {
            back[lane] = self.of_bonds[opposite[group * LANES + lane] as usize];
        }
        there.of_bond = T::load(&back, 0);
    }
}

impl<S: Solid<D>, const D: usize> SecondLoop<'_, S, D> {
    /// Returns the values that the bonds of a point read at the point.
    #[inline(always)]
    pub fn here<T: Lanes>(&self, site: usize) -> End<T> {
        self.ends.here(site, self.u.len(), S::VALUES)
    }

    /// Returns T_i⟨ξ⟩ − T_j⟨−ξ⟩ of the intact bonds of a batch, or its derivative. `group` is the number of the batch in the
    /// list.
    #[inline(always)]
    pub fn pull<T: Lanes>(
        &self,
        family: &Family<'_, D>,
        batch: usize,
        group: usize,
        here: &mut End<T>,
        bond: &Bond<T, D>,
    ) -> [T; D] {
        let (sites, width) = (self.u.len(), S::VALUES);
        let opposite = self.force.opposite.of_entry();
        let mut there = self.ends.there::<T, D>(family, batch, sites, width);
        if S::BOND_VALUES {
            self.ends.of_batch(group, opposite, [here, &mut there]);
        }
        let pulls = match &self.change {
            None => [S::pull(here, bond), S::pull(&there, bond)],
            Some((direction, ends)) => {
                let mut change_here = ends.here::<T>(family.site(), sites, width);
                let mut change_there = ends.there::<T, D>(family, batch, sites, width);
                if S::BOND_VALUES {
                    let changes = [&mut change_here, &mut change_there];
                    ends.of_batch(group, opposite, changes);
                }
                let moved = family.at(direction).eta(batch);
                [
                    S::pull_change(here, &change_here, bond, moved),
                    S::pull_change(&there, &change_there, bond, moved),
                ]
            }
        };
        let mut pull = [T::splat(0.0); D];
        for c in 0..D {
            pull[c] = (pulls[0][c] + pulls[1][c]).masked(family.intact(batch));
        }
        pull
    }
}

#[inline(always)]
fn force_rows_body<T: Lanes, S: Solid<D>, const D: usize>(
    second: &SecondLoop<'_, S, D>,
    intact: &[u8],
    rows: &Rows<'_>,
    out: &mut [&mut [f64]; D],
) {
    let force = second.force;
    let start = force.bonds.list().start();
    for k in 0..rows.count() {
        let i = rows.at(k);
        let first = start[i];
        let bits = &intact[first - start[rows.first]..start[i + 1] - start[rows.first]];
        let family = Family::new(&force.bonds, i, bits, second.u);
        let mut here = second.here::<T>(family.site());
        let mut sum = [T::splat(0.0); D];
        for batch in 0..bits.len() {
            if bits[batch] == 0 {
                continue;
            }
            let bond: Bond<T, D> = family.bond(batch);
            let pull = second.pull(&family, batch, first + batch, &mut here, &bond);
            for c in 0..D {
                sum[c] = bond.weight.mul_add(pull[c], sum[c]);
            }
        }
        for c in 0..D {
            out[c][i - rows.first] += F64x8(sum[c].to_array()).sum();
        }
    }
}

for_each_instruction_set! {
    /// Adds Σ ω (T_i⟨ξ⟩ − T_j⟨−ξ⟩) of the rows, or its derivative.
    pub(super) fn force_rows [S: Solid<D>, const D: usize] <S, D> (
        second: &SecondLoop<'_, S, D>,
        intact: &[u8],
        rows: &Rows<'_>,
        out: &mut [&mut [f64]; D],
    ) = force_rows_body on lanes
}

#[inline(always)]
fn advance_rows_body<T: Lanes, S: Solid<D>, const D: usize>(
    first_loop: &FirstLoop<'_, S, D>,
    starts: bool,
    rows: &Rows<'_>,
    block: &mut BlockHistory<'_>,
) {
    let force = first_loop.force;
    let (start, size) = (force.bonds.list().start(), force.history_size);
    let [last_points, last_bonds] = &block.last;
    for k in 0..rows.count() {
        let i = rows.at(k);
        let place = i - rows.first;
        let width = size.per_bond * LANES;
        let groups =
            (start[i] - start[rows.first]) * width..(start[i + 1] - start[rows.first]) * width;
        let points = place * size.per_point..(place + 1) * size.per_point;
        let dt = match starts {
            true => 0.0,
            false => (first_loop.t - block.time[place]).max(0.0),
        };
        block.time[place] = first_loop.t;
        // The stored numbers of the body are taken apart for the loop.
        let Some(shape) = &force.shapes[i] else {
            continue;
        };
        let at = Point {
            family: force.family(i, first_loop.u),
            shape,
            history: &last_points[points.clone()],
            of_bonds: &last_bonds[groups.clone()],
            per_bond: size.per_bond,
            dt,
            thermal: first_loop.heat.stretch(i),
            yields: first_loop.heat.yield_scale(i, force.stiffness_of(i)),
        };
        let mut next = NextHistory {
            history: &mut block.points[points],
            of_bonds: &mut block.bonds[groups],
            per_bond: size.per_bond,
        };
        let work = force.material(i).advance::<T>(&at, &mut next);
        if !starts {
            block.works[place] = force.stiffness_of(i) * work * force.cloud.volumes()[i];
        }
    }
}

for_each_instruction_set! {
    /// Calls [`Solid::advance`] for the rows.
    pub(super) fn advance_rows [S: Solid<D>, const D: usize] <S, D> (
        first_loop: &FirstLoop<'_, S, D>,
        starts: bool,
        rows: &Rows<'_>,
        block: &mut BlockHistory<'_>,
    ) = advance_rows_body on lanes
}

#[inline(always)]
fn watch_rows_body<T: Lanes, S: Solid<D>, const D: usize>(
    force: &SolidForce<S, D>,
    u: &[Row],
    limit: f64,
    rows: &Rows<'_>,
    found: &mut Vec<(usize, usize, u8)>,
) {
    let limit = T::splat(limit);
    for k in 0..rows.count() {
        let i = rows.at(k);
        let family = Family::<D>::new(&force.bonds, i, force.bits(i), u);
        for batch in 0..family.batches() {
            let bond: Bond<T, D> = family.bond(batch);
            let strain = S::Kinematics::strain(bond.xi, bond.eta, bond.inverse_square);
            let over = strain.greater(limit) & family.intact(batch);
            if over != 0 {
                found.push((i, batch, over));
            }
        }
    }
}

for_each_instruction_set! {
    /// Adds the bonds of the rows whose strain t exceeds `limit`: points, batches and bits.
    pub(super) fn watch_rows [S: Solid<D>, const D: usize] <S, D> (
        force: &SolidForce<S, D>,
        u: &[Row],
        limit: f64,
        rows: &Rows<'_>,
        found: &mut Vec<(usize, usize, u8)>,
    ) = watch_rows_body on lanes
}

/// Calls `visit(batch, bonds, T⟨ξ⟩)` for the bonds of a point, with the values that `set_state` sets.
pub(super) fn for_each_pull<S: Solid<D> + ?Sized, const D: usize>(
    at: &Point<'_, S::Shape, D>,
    set_state: impl FnOnce(&mut State<'_>),
    mut visit: impl FnMut(usize, &Bond<F64x8, D>, [F64x8; D]),
) {
    let batches = at.family.batches();
    let mut values = vec![0.0; S::VALUES];
    let mut of_bonds = vec![0.0; if S::BOND_VALUES { batches * LANES } else { 0 }];
    set_state(&mut State {
        values: &mut values,
        of_bonds: &mut of_bonds,
    });
    for batch in 0..batches {
        let bond = at.family.bond::<F64x8>(batch);
        let of_bond = match S::BOND_VALUES {
            true => F64x8::load(&of_bonds, batch * LANES),
            false => F64x8([0.0; LANES]),
        };
        let pull = S::pull(&end_of(&values, of_bond), &bond);
        visit(batch, &bond, pull);
    }
}

/// Returns the values of a state as those of an end, for single bonds.
pub(super) fn end_of(values: &[f64], of_bond: F64x8) -> End<F64x8> {
    let mut end = End {
        of_bond,
        ..End::none()
    };
    for (lanes, value) in end.values.iter_mut().zip(values) {
        *lanes = F64x8([*value; LANES]);
    }
    end
}

/// Work arrays for the values of own points.
impl States {
    /// Divides the values into blocks of points.
    pub fn blocks<'a>(
        values: &'a mut [f64],
        of_bonds: &'a mut [f64],
        start: &[usize],
        width: usize,
    ) -> Vec<BlockValues<'a>> {
        let n = start.len() - 1;
        let (mut values, mut of_bonds) = (values, of_bonds);
        let with_bonds = !of_bonds.is_empty();
        let blocks = (0..n).step_by(pericles::parallel::BLOCK).map(|first| {
            let end = n.min(first + pericles::parallel::BLOCK);
            let groups = if with_bonds {
                start[end] - start[first]
            } else {
                0
            };
            BlockValues {
                values: super::history::cut(&mut values, (end - first) * width),
                of_bonds: super::history::cut(&mut of_bonds, groups * LANES),
            }
        });
        blocks.collect()
    }
}
