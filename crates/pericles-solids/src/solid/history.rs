//! Numbers stored per bond and per point.

use pericles::archive::Laid;
use pericles::family::BondList;
use pericles::lanes::{LANES, Lanes};
use pericles::parallel::BLOCK;
use pericles::saved;

use super::family::store;

/// Numbers that a material stores.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct HistorySize {
    /// Per point.
    pub per_point: usize,
    /// Per directed bond.
    pub per_bond: usize,
}

impl HistorySize {
    /// Returns the size that suffices for both.
    pub fn max(self, other: Self) -> Self {
        Self {
            per_point: self.per_point.max(other.per_point),
            per_bond: self.per_bond.max(other.per_bond),
        }
    }

    /// Returns whether anything is stored.
    pub fn is_empty(self) -> bool {
        self == Self::default()
    }
}

/// Place of the work of a bond among its stored numbers: the work, and force and stretch at the end of the last step.
#[derive(Debug, Clone, Copy)]
pub(super) struct BondWork {
    /// The first of the three numbers, behind those of the material.
    pub first: usize,
}

impl BondWork {
    /// Adds the numbers of the work to those of the material.
    pub fn behind(size: &mut HistorySize) -> Self {
        let first = size.per_bond;
        size.per_bond += 3;
        Self { first }
    }
}

/// Output of [`Solid::advance`](super::Solid::advance): the stored numbers at the end of a step.
pub struct NextHistory<'a> {
    /// Stored numbers of the point, which are those at the end of the last step until they are set.
    pub history: &'a mut [f64],
    pub(super) of_bonds: &'a mut [f64],
    pub(super) per_bond: usize,
}

impl NextHistory<'_> {
    /// Sets a stored number of the bonds of a batch.
    #[inline(always)]
    pub fn set_bonds<T: Lanes>(&mut self, batch: usize, number: usize, values: T) {
        store(self.of_bonds, batch * self.per_bond + number, values);
    }
}

/// The stored numbers of a body.
#[derive(Default)]
pub(super) struct History {
    pub size: HistorySize,
    /// Numbers of points, consecutive for each point.
    pub points: Vec<f64>,
    /// Numbers of bonds, by groups of eight: eight numbers for each of [`HistorySize::per_bond`].
    pub bonds: Vec<f64>,
    /// Time to which the numbers of each point belong, s; empty if nothing is stored and no criterion depends on it.
    pub time: Vec<f64>,
    start: Vec<usize>,
}

saved! {
    impl Checkpointed for History {
        points: by(Laid::per_point("solid/points", start.len() - 1, points.len())),
        bonds: by(Laid::rows("solid/bonds", start, bonds.len())),
        time: times("solid/time"),
        size, start: fixed,
    }
}

/// The stored numbers of a block of points.
pub(super) struct BlockHistory<'a> {
    pub points: &'a mut [f64],
    pub bonds: &'a mut [f64],
    pub time: &'a mut [f64],
    /// Stored numbers of points and of bonds at the end of the last step.
    pub last: [Vec<f64>; 2],
    /// Energy that each point dissipates in the step, J.
    pub works: Vec<f64>,
}

impl History {
    /// Creates the numbers of the bonds of a list; `times`: whether the time of the last step is stored in any case.
    pub fn new(list: &BondList, size: HistorySize, times: bool) -> Self {
        let n = list.len();
        Self {
            size,
            points: vec![0.0; n * size.per_point],
            bonds: vec![0.0; list.present().len() * LANES * size.per_bond],
            time: vec![0.0; if size.is_empty() && !times { 0 } else { n }],
            start: list.start().to_vec(),
        }
    }

    /// Returns the stored numbers of a point.
    #[inline(always)]
    pub fn of_point(&self, i: usize) -> &[f64] {
        let width = self.size.per_point;
        &self.points[i * width..(i + 1) * width]
    }

    /// Returns the stored numbers of the bonds of a point.
    #[inline(always)]
    pub fn of_bonds(&self, i: usize) -> &[f64] {
        let width = self.size.per_bond * LANES;
        &self.bonds[self.start[i] * width..self.start[i + 1] * width]
    }

    /// Returns the time since the last update of a point, s.
    #[inline(always)]
    pub fn since(&self, i: usize, t: f64) -> f64 {
        self.time.get(i).map_or(0.0, |last| (t - last).max(0.0))
    }

    /// Divides the stored numbers into blocks of points, with copies for the values at the end of the last step.
    pub fn blocks(&mut self) -> Vec<BlockHistory<'_>> {
        let n = self.time.len();
        let HistorySize {
            per_point,
            per_bond,
        } = self.size;
        let (mut points, mut bonds, mut time) = (
            &mut self.points[..],
            &mut self.bonds[..],
            &mut self.time[..],
        );
        let mut blocks = Vec::with_capacity(n.div_ceil(BLOCK));
        for first in (0..n).step_by(BLOCK) {
            let end = n.min(first + BLOCK);
            let groups = self.start[end] - self.start[first];
            let of_points = cut(&mut points, (end - first) * per_point);
            let of_bonds = cut(&mut bonds, groups * per_bond * LANES);
            blocks.push(BlockHistory {
                last: [of_points.to_vec(), of_bonds.to_vec()],
                points: of_points,
                bonds: of_bonds,
                time: cut(&mut time, end - first),
                works: vec![0.0; end - first],
            });
        }
        blocks
    }

    /// Returns the memory, bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.points[..]) + size_of_val(&self.bonds[..]) + size_of_val(&self.time[..])
    }
}

/// Cuts off the first entries of a slice.
pub(super) fn cut<'a, T>(slice: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    let (own, rest) = std::mem::take(slice).split_at_mut(count);
    *slice = rest;
    own
}
