//! A force without forces, for tests of which points may touch.

use std::ops::Range;

use pericles::neighbourhood::{BondSet, CoarseBreak};
use pericles::operator::{Breakable, Capabilities, Force, PointSubset};
use pericles::space::PointCloud;

/// Bonds that carry no force.
pub struct Bonded {
    points: usize,
    dimension: usize,
    /// Other ends of the bonds of each point.
    pub rows: Vec<Vec<usize>>,
}

impl Bonded {
    /// Bonds between the pairs of points that `is_bonded` selects.
    pub fn new(cloud: &PointCloud, is_bonded: impl Fn([f64; 3], [f64; 3]) -> bool) -> Self {
        let n = cloud.len();
        let row = |i: usize| {
            (0..n)
                .filter(|&j| j != i && is_bonded(cloud.point(i), cloud.point(j)))
                .collect()
        };
        Self {
            points: n,
            dimension: cloud.dimension(),
            rows: (0..n).map(row).collect(),
        }
    }
}

impl Force for Bonded {
    fn points(&self) -> usize {
        self.points
    }

    fn dimension(&self) -> usize {
        self.dimension
    }

    fn add_force(&self, _t: f64, _u: &[f64], _on: PointSubset<'_>, _out: &mut [f64]) {}

    fn add_energy_density(&self, _t: f64, _u: &[f64], _out: &mut [f64]) {}

    fn energy(&self, _t: f64, _u: &[f64]) -> f64 {
        0.0
    }

    fn frequency_bound(&self, _density: &dyn Fn(usize) -> f64) -> f64 {
        0.0
    }

    fn tangent_into(&self, _t: f64, _u: &[f64], _direction: &[f64], out: &mut [f64]) {
        out.fill(0.0);
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            breaking: Some(self),
            ..Capabilities::default()
        }
    }
}

impl Breakable for Bonded {
    fn bonds(&self) -> &dyn BondSet {
        self
    }

    fn bonds_mut(&mut self) -> &mut dyn BondSet {
        self
    }

    fn can_break(&self) -> bool {
        false
    }

    fn take_coarse_breaks(&mut self) -> Vec<CoarseBreak> {
        Vec::new()
    }

    fn mark_endangered(&self, _u: &[f64], _fraction: f64, _marks: &mut [bool]) {}
}

impl BondSet for Bonded {
    fn broken_bonds(&self) -> u64 {
        0
    }

    fn dissipated(&self) -> f64 {
        0.0
    }

    fn dissipate(&mut self, _i: usize, _energy: f64) {}

    fn follow_dissipation(&mut self) {}

    fn take_dissipated(&mut self, _out: &mut [f64]) {}

    fn damage_into(&self, out: &mut [f64]) {
        out.fill(0.0);
    }

    fn for_each_intact(&self, visit: &mut dyn FnMut(usize, usize)) {
        for (i, row) in self.rows.iter().enumerate() {
            row.iter().for_each(|&j| visit(i, j));
        }
    }

    fn for_each_intact_of(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        self.rows[i].iter().for_each(|&j| visit(j));
    }

    fn for_each_change_count(&self, visit: &mut dyn FnMut(Range<usize>, u64)) {
        visit(0..self.points, 0);
    }
}

pericles::saved! {
    impl Checkpointed for Bonded {
        points, dimension, rows: fixed,
    }
}
