//! Access to bonds and neighbours of bodies with ghost layers.

use super::force::GhostForce;
use crate::domain::Field;
use crate::operator::{BondAt, BondValues, BondView, LocalForce};

impl GhostForce {
    /// Calls `visit` for the places on whose displacements the force on a place depends, including itself.
    fn reached(&self, place: usize, visit: &mut dyn FnMut(usize)) {
        visit(place);
        if let Some(local) = self.inner.capabilities().local {
            local.neighbours(place, visit);
        }
    }

    /// Returns the index of the ghost at a place.
    fn ghost_at(&self, place: usize) -> Option<usize> {
        self.layer.ghosts().binary_search(&(place as u32)).ok()
    }

    /// Calls `visit` for the points of the body that determine the displacement at a place.
    fn sources(&self, place: usize, visit: &mut dyn FnMut(u32, f64)) {
        match (self.numbers[place], self.ghost_at(place)) {
            (Some(i), _) => visit(i, 1.0),
            (None, Some(g)) => {
                let row = self.extrapolation.row(g).iter();
                row.for_each(|&(j, weight)| visit(j, weight));
            }
            (None, None) => {}
        }
    }
}

/// A bond to a ghost joins a point to all points that determine the displacement of the ghost.
impl LocalForce for GhostForce {
    fn bonded(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        let mut points = Vec::new();
        let mut places = Vec::new();
        let ghosts = self.extrapolation.column(i).iter();
        let fed = ghosts.map(|&(g, _)| self.layer.ghosts()[g as usize]);
        for place in fed.chain([self.layer.body()[i]]) {
            self.reached(place as usize, &mut |near| places.push(near));
        }
        places.sort_unstable();
        places.dedup();
        for place in places {
            self.sources(place, &mut |j, _| points.push(j));
        }
        points.sort_unstable();
        points.dedup();
        let others = points.into_iter().map(|j| j as usize);
        others.filter(|&j| j != i).for_each(visit);
    }
}

/// Bonds to ghosts lead to the nearest point of the body and are marked.
impl BondView for GhostForce {
    fn values_at(&self, u: Field<'_>) -> BondValues {
        match self.inner.capabilities().bonds {
            Some(bonds) => bonds.values_at(Field::new(&self.extended(u.owned), &[])),
            None => BondValues::of_displacement(u),
        }
    }

    fn for_each_bond(&self, values: &BondValues, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let Some(bonds) = self.inner.capabilities().bonds else {
            return;
        };
        let here = self.layer.body()[i] as usize;
        bonds.for_each_bond(values, here, &mut |bond| {
            self.of_body(bond).into_iter().for_each(&mut *visit);
        });
    }

    fn for_each_undeformed(&self, i: usize, visit: &mut dyn FnMut(BondAt)) {
        let Some(bonds) = self.inner.capabilities().bonds else {
            return;
        };
        let here = self.layer.body()[i] as usize;
        bonds.for_each_undeformed(here, &mut |bond| {
            self.of_body(bond).into_iter().for_each(&mut *visit);
        });
    }
}

impl GhostForce {
    /// Returns a bond of the inner body as one of the body.
    fn of_body(&self, bond: BondAt) -> Option<BondAt> {
        let ghost = self.ghost_at(bond.neighbour);
        let nearest = ghost.and_then(|g| self.extrapolation.nearest(g));
        let neighbour = self.numbers[bond.neighbour].or(nearest)?;
        Some(BondAt {
            neighbour: neighbour as usize,
            to_ghost: ghost.is_some(),
            ..bond
        })
    }
}
