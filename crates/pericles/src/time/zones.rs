//! The zones of a body under a multirate scheme.
//!
//! Zones are divided with their points. Marks spread along bonds, one bond per round; after each round the marks of
//! ghosts return to their owners. A force is evaluated on its own part of a zone, also if this part is empty; whether
//! an evaluation takes place depends on whether the zone is empty in the whole body, so that all processes exchange
//! the same messages.
//!
//! A multirate scheme needs evaluations on a subset of points only and, for r-RESPA, the part of a force that marked
//! neighbours exert. For a force in two passes a zone extends by two families. The cost of a part is the cost of its
//! points and of the rows that contain them.

use super::zone::Zone;
use crate::domain::Domain;
use crate::operator::LocalForce;
use crate::space::PointSet;

/// The zones that follow from the fine points F and their bonds. Each process has its own points of each zone; whether
/// a zone is empty in the whole body is known from the counts.
#[derive(Debug, Clone, Default)]
pub(super) struct Zones {
    /// C, the points with the coarse step.
    pub(super) coarse: Zone,
    /// CB: coarse points with a fine neighbour.
    pub(super) coarse_border: Zone,
    /// C without CB.
    pub(super) coarse_inner: Zone,
    /// F.
    pub(super) fine: Zone,
    /// FB: fine points with a coarse neighbour.
    pub(super) fine_border: Zone,
    /// F and CB.
    pub(super) active: Zone,
    pub(super) is_fine: Vec<bool>,
    pub(super) is_coarse: Vec<bool>,
    pub(super) count: Count,
}

/// Numbers of points of the zones of the whole body, the same on all processes.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Count {
    pub(super) fine: u64,
    pub(super) coarse: u64,
    /// Points of CB.
    pub(super) border: u64,
}

impl Count {
    pub(super) fn points(&self) -> u64 {
        self.fine + self.coarse
    }
}

impl Zones {
    /// Determines the zones from marked fine points. Only the bonds of fine points and, for forces that reach beyond
    /// one bond, the bonds of the border are visited. All processes must call it together.
    pub(super) fn new(force: &dyn LocalForce, domain: &Domain, is_fine: Vec<bool>) -> Self {
        let n = is_fine.len();
        let known = domain.marks_with_ghosts(&is_fine);
        let mut on_border = vec![false; known.len()];
        for i in (0..n).filter(|&i| is_fine[i]) {
            force.bonded(i, &mut |j| {
                if !known[j] {
                    on_border[i] = true;
                    on_border[j] = true;
                }
            });
        }
        drop(known);
        // Bonds between processes are visited from their fine end.
        domain.merge_ghost_marks(&mut on_border);
        // A point that reaches the other side reaches an end of a bond between the sides with one bond less.
        spread(force, domain, &mut on_border, force.range_in_bonds() - 1);
        let members = |wanted: &dyn Fn(usize) -> bool| -> PointSet {
            (0..n).filter(|&i| wanted(i)).map(|i| i as u32).collect()
        };
        let coarse = members(&|i| !is_fine[i]);
        let border = members(&|i| !is_fine[i] && on_border[i]);
        let count = Count {
            fine: domain.count((n - coarse.len()) as u64),
            coarse: domain.count(coarse.len() as u64),
            border: domain.count(border.len() as u64),
        };
        let [only_fine, only_coarse] = [count.coarse == 0, count.fine == 0];
        let zone = |wanted: &dyn Fn(usize) -> bool, whole| Zone::new(members(wanted), whole);
        Self {
            coarse: Zone::new(coarse, only_coarse),
            coarse_border: Zone::new(border, false),
            coarse_inner: zone(&|i| !is_fine[i] && !on_border[i], only_coarse),
            fine: zone(&|i| is_fine[i], only_fine),
            fine_border: zone(&|i| is_fine[i] && on_border[i], false),
            active: zone(
                &|i| is_fine[i] || on_border[i],
                count.border == count.coarse,
            ),
            is_coarse: is_fine.iter().map(|fine| !fine).collect(),
            is_fine,
            count,
        }
    }

    /// All points fine. All processes must call it together.
    pub(super) fn all_fine(domain: &Domain) -> Self {
        let n = domain.owned_points();
        Self {
            fine: Zone::all(n),
            active: Zone::all(n),
            is_fine: vec![true; n],
            is_coarse: vec![false; n],
            count: Count {
                fine: domain.count(n as u64),
                ..Count::default()
            },
            ..Self::default()
        }
    }
}

/// Marks all own points within `layers` families of the marked points. All processes must call it together.
pub(super) fn grow(force: &dyn LocalForce, domain: &Domain, marks: &mut Vec<bool>, layers: u32) {
    let n = marks.len();
    marks.resize(n + domain.ghost_points(), false);
    spread(force, domain, marks, layers * force.range_in_bonds());
    marks.truncate(n);
}

/// Marks all points within a number of bonds of the marked own points. There is one mark per point, own points first,
/// then ghosts, of which only those next to own points are marked.
fn spread(force: &dyn LocalForce, domain: &Domain, marks: &mut [bool], bonds: u32) {
    let n = domain.owned_points();
    let mut front: Vec<u32> = (0..n as u32).filter(|&i| marks[i as usize]).collect();
    for _ in 0..bonds {
        let mut next = Vec::new();
        for &i in &front {
            force.bonded(i as usize, &mut |j| {
                if !std::mem::replace(&mut marks[j], true) && j < n {
                    next.push(j as u32);
                }
            });
        }
        next.extend(domain.merge_ghost_marks(marks));
        front = next;
    }
}
