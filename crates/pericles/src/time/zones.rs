//! The zones of a body under a multirate scheme.

use super::zone::Zone;
use crate::operator::LocalForce;
use crate::space::PointSet;

/// The zones that follow from the fine points F and their bonds.
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
}

impl Zones {
    /// Determines the zones from marked fine points. Only the neighbours of fine points are visited.
    pub(super) fn new(force: &dyn LocalForce, is_fine: Vec<bool>) -> Self {
        let n = is_fine.len();
        let mut on_border = vec![false; n];
        for i in (0..n).filter(|&i| is_fine[i]) {
            force.neighbours(i, &mut |j| {
                if !is_fine[j] {
                    on_border[i] = true;
                    on_border[j] = true;
                }
            });
        }
        let zone = |wanted: &dyn Fn(usize) -> bool| {
            let points: PointSet = (0..n).filter(|&i| wanted(i)).map(|i| i as u32).collect();
            Zone::new(points, n)
        };
        Self {
            coarse: zone(&|i| !is_fine[i]),
            coarse_border: zone(&|i| !is_fine[i] && on_border[i]),
            coarse_inner: zone(&|i| !is_fine[i] && !on_border[i]),
            fine: zone(&|i| is_fine[i]),
            fine_border: zone(&|i| is_fine[i] && on_border[i]),
            active: zone(&|i| is_fine[i] || on_border[i]),
            is_coarse: is_fine.iter().map(|fine| !fine).collect(),
            is_fine,
        }
    }

    /// All points fine.
    pub(super) fn all_fine(n: usize) -> Self {
        Self {
            fine: Zone::all(n),
            active: Zone::all(n),
            is_fine: vec![true; n],
            is_coarse: vec![false; n],
            ..Self::default()
        }
    }
}

/// Marks all points within `layers` families of the marked points.
pub(super) fn grow(force: &dyn LocalForce, marks: &mut [bool], layers: u32) {
    let mut front: Vec<u32> = (0..marks.len() as u32)
        .filter(|&i| marks[i as usize])
        .collect();
    for _ in 0..layers {
        let mut next = Vec::new();
        for &i in &front {
            force.neighbours(i as usize, &mut |j| {
                if !marks[j] {
                    marks[j] = true;
                    next.push(j as u32);
                }
            });
        }
        front = next;
    }
}
