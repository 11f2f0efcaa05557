//! Evaluation of values of points and of forces of bonds.

use pericles::ThermalExpansion;
use pericles::domain::Field;
use pericles::lanes::{F64x8, Row};
use pericles::operator::pool::Lent;
use pericles::operator::records::pack_sites;
use pericles::operator::rows::Rows;
use pericles::operator::{PointSubset, with_neighbours};
use pericles::parallel::{BLOCK, for_each_part};
use rayon::prelude::*;

use super::Solid;
use super::force::{SolidForce, States};
use super::heat::Heat;
use super::loops::{Ends, FirstLoop, SecondLoop, force_rows, state_rows};

impl<S: Solid<D>, const D: usize> SolidForce<S, D> {
    /// Returns the thermal stretches at a time.
    pub(super) fn heat_at(&self, t: f64) -> Heat {
        let (expansion, yields) = (self.expansion.as_ref(), self.yields.as_ref());
        Heat {
            stretches: expansion.map(|expansion| expansion.stretches(t)),
            yields: yields.map(|factor| factor.at(t)),
        }
    }

    /// Returns the thermal stretches at a time, with the yield stresses of the last stored numbers: the energy changes
    /// with the temperature at fixed displacements by the thermal stretch only.
    pub(super) fn heat_of_energy(&self, t: f64) -> Heat {
        let expansion = self.expansion.as_ref();
        Heat {
            stretches: expansion.map(|expansion| expansion.stretches(t)),
            ..self.latest_heat()
        }
    }

    /// Returns the thermal stretches at the time of the last force evaluation, and the yield stresses at that of the last
    /// stored numbers.
    pub(super) fn latest_heat(&self) -> Heat {
        let yields = self.yields.as_ref();
        Heat {
            stretches: self.expansion.as_ref().map(ThermalExpansion::latest),
            yields: yields.map(|factor| factor.at(self.latest_time())),
        }
    }

    /// Returns the elastic moduli of a point relative to those of its material.
    #[inline(always)]
    pub(super) fn stiffness_of(&self, i: usize) -> f64 {
        self.stiffness.get(i).copied().unwrap_or(1.0)
    }

    /// Returns rows of displacements by site.
    pub(super) fn packed(&self, u: Field<'_>) -> Lent<'_, Vec<Row>> {
        let mut rows = self.displaced.take();
        pack_sites::<D>(u, self.bonds.list().sites(), &mut rows);
        rows
    }

    /// Computes the values of the points `on` and of their bonds at a displacement, or their derivatives in a direction.
    /// All processes must call it together.
    pub(super) fn states(
        &self,
        t: f64,
        heat: &Heat,
        u: &[Row],
        direction: Option<&[Row]>,
        on: &PointSubset<'_>,
    ) -> Lent<'_, States> {
        let mut states = self.states.take();
        let first_loop = FirstLoop {
            force: self,
            heat,
            t,
            u,
            direction,
        };
        let States {
            values,
            of_bonds,
            dilatation,
        } = &mut *states;
        let list = self.bonds.list();
        let mut blocks = States::blocks(values, of_bonds, list.start(), S::VALUES);
        let first = |block: usize| (block * BLOCK).min(list.len());
        for_each_part(
            [&mut dilatation[..]],
            &mut blocks,
            list.cost(on),
            &first,
            &|block, [dilatation], values| {
                if let Some(rows) = Rows::of_block(on, block * BLOCK, dilatation.len()) {
                    state_rows::<S, D>(self.set, &first_loop, &rows, values, dilatation);
                }
            },
        );
        self.opposite.exchange(list, &mut states.of_bonds);
        states
    }

    /// Computes the values of the points `on` and of their neighbours, which the bonds of the points read. All processes must
    /// call it together.
    pub(super) fn states_of_ends(
        &self,
        t: f64,
        heat: &Heat,
        u: &[Row],
        on: &PointSubset<'_>,
    ) -> Lent<'_, States> {
        let needed = match on {
            PointSubset::All => None,
            part => Some(with_neighbours(self.cloud.domain(), part, &|i, visit| {
                self.bonds.list().for_each_neighbour(i, visit);
            })),
        };
        let needed = match &needed {
            None => PointSubset::All,
            Some(points) => PointSubset::Set(points),
        };
        self.states(t, heat, u, None, &needed)
    }

    /// Returns values of own points with those of ghosts, component-major. All processes must call it together.
    pub(super) fn exchanged(&self, values: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let n = self.cloud.len();
        let mut own = vec![0.0; values.len()];
        for (i, numbers) in values.chunks_exact(S::VALUES.max(1)).enumerate() {
            for (number, value) in numbers.iter().enumerate() {
                own[number * n + i] = *value;
            }
        }
        let ghosts = self.cloud.domain().ghosts(&own);
        (own, ghosts)
    }

    /// Returns values of points by site in rows of four, the rows for the first four values first. All processes must
    /// call it together.
    pub(super) fn planes(&self, values: &[f64]) -> Lent<'_, Vec<Row>> {
        let (mut planes, n, width) = (self.planes.take(), self.cloud.len(), S::VALUES);
        let sites = self.bonds.list().sites();
        let ghosts = match self.cloud.domain().is_divided() {
            true => self.exchanged(values).1,
            false => Vec::new(),
        };
        let ghost_points = ghosts.len().checked_div(width).unwrap_or(0);
        let value = |point: usize, number: usize| match point < n {
            _ if number >= width => 0.0,
            true => values[point * width + number],
            false => ghosts[number * ghost_points + (point - n)],
        };
        const PART: usize = 1024;
        for (plane, rows) in planes.chunks_mut(sites.len().max(1)).enumerate() {
            rows.par_chunks_mut(PART)
                .enumerate()
                .for_each(|(part, rows)| {
                    for (site, row) in (part * PART..).zip(rows) {
                        let point = sites.point(site);
                        for (c, entry) in row.0.iter_mut().enumerate() {
                            *entry = value(point, 4 * plane + c);
                        }
                    }
                });
        }
        planes
    }

    /// Adds the force density of the points `on`, or its derivative, from the values of both ends of bonds.
    pub(super) fn add_bonds(
        &self,
        on: &PointSubset<'_>,
        u: &[Row],
        states: &States,
        change: Option<(&[Row], &States)>,
        out: &mut [f64],
    ) {
        let planes = self.planes(&states.values);
        let change_planes = change.map(|(_, changes)| self.planes(&changes.values));
        let change = change.zip(change_planes.as_ref());
        let second = SecondLoop {
            force: self,
            u,
            ends: Ends {
                of_points: &planes,
                of_bonds: &states.of_bonds,
            },
            change: change.map(|((direction, changes), planes)| {
                let ends = Ends {
                    of_points: planes,
                    of_bonds: &changes.of_bonds,
                };
                (direction, ends)
            }),
        };
        let cost = self.bonds.list().cost(on);
        self.bonds
            .all
            .for_each_block::<D>(cost, out, |block, intact, out| {
                if let Some(rows) = Rows::of_block(on, block * BLOCK, out[0].len()) {
                    force_rows::<S, D>(self.set, &second, intact, &rows, out);
                }
            });
    }

    /// Returns the energy density of a point, J/m³.
    pub(super) fn energy_of(&self, i: usize, t: f64, heat: &Heat, u: &[Row]) -> f64 {
        let at = self.point(i, t, heat, u);
        let energy = at.map_or(0.0, |at| self.material(i).energy::<F64x8>(&at));
        self.stiffness_of(i) * energy
    }
}
