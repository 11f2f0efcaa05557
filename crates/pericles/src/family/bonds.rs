//! Neighbour list: the families of all points in compressed rows of eight.

use std::ops::Range;
use std::sync::Arc;

use rayon::prelude::*;

use super::search::{bond_vector, distance, pairs_of};
use super::{Crack, EndRule, VolumeCorrection};
use crate::error::{PericlesError, Result, positive};
use crate::lanes::LANES;
use crate::parallel::{Cost, PointSubset};
use crate::space::{PointCloud, PointSet, Sites, check_length};

/// The effect of a crack on a neighbour list.
#[derive(Debug, Clone, PartialEq)]
pub struct BondCut {
    /// Bonds removed.
    pub bonds: u64,
    /// Points that lost bonds.
    pub points: PointSet,
}

/// The neighbour list: the bonds of every own point, in compressed rows padded to whole groups of [`LANES`].
///
/// Group g contains the neighbours `base[g] + offsets[g * LANES + k]`; bit k of `present[g]` is set if its k-th
/// bond exists. Point i has the groups `start[i]..start[i + 1]`; a group whose neighbours are too far apart for
/// two-byte offsets is split. Padding entries repeat the previous neighbour, so that computing them is harmless.
/// Each bond is stored at both of its ends, in ascending order of the neighbour's number.
///
/// Neighbours are [`Sites`]: points, ghosts of other processes, and images beyond periodic faces. Methods on the
/// geometry of a bond take the sites of both of its ends; the site of point i is [`BondList::site`].
#[derive(Debug, Clone)]
pub struct BondList {
    sites: Arc<Sites>,
    start: Vec<usize>,
    base: Vec<u32>,
    offsets: Vec<u16>,
    /// Bonds of the geometric family, one bit each.
    geometric: Vec<u8>,
    /// Bonds that remain after pre-cutting, one bit each.
    present: Vec<u8>,
    /// Bonds that may break, one bit each; `None`: all.
    breakable: Option<Vec<u8>>,
    horizons: Horizons,
    correction: VolumeCorrection,
}

/// Horizons of the points, m.
#[derive(Debug, Clone)]
enum Horizons {
    Uniform(f64),
    /// By site. A bond exists within the larger horizon of its two ends.
    PerSite(Vec<f64>),
}

impl Horizons {
    fn of(&self, site: usize) -> f64 {
        match self {
            Self::Uniform(horizon) => *horizon,
            Self::PerSite(horizons) => horizons[site],
        }
    }
}

impl Horizons {
    fn largest(&self) -> f64 {
        match self {
            Self::Uniform(horizon) => *horizon,
            Self::PerSite(horizons) => horizons.iter().copied().fold(0.0, f64::max),
        }
    }
}

impl BondList {
    /// The families of a point cloud with one horizon.
    ///
    /// # Errors
    /// A horizon that is not positive or reaches no neighbour of any point.
    pub fn new(
        cloud: &Arc<PointCloud>,
        horizon: f64,
        correction: VolumeCorrection,
    ) -> Result<Self> {
        positive("the horizon", horizon)?;
        let reach = correction.reach(horizon, cloud.spacing());
        let sites = Sites::new(cloud, reach)?;
        let horizons = Horizons::Uniform(horizon);
        Self::of_sites(sites, reach, horizons, correction, &|_, _, r| r <= reach)
    }

    /// The families of a point cloud with one horizon per point: a bond exists within the larger horizon of its
    /// ends.
    ///
    /// # Errors
    /// Horizons that are not positive, not one per point, or reach no neighbour of any point.
    pub fn with_horizons(
        cloud: &Arc<PointCloud>,
        horizons: Vec<f64>,
        correction: VolumeCorrection,
    ) -> Result<Self> {
        check_length("the horizons of the points", horizons.len(), cloud.len())?;
        for &horizon in &horizons {
            positive("the horizon", horizon)?;
        }
        let largest = horizons.iter().copied().fold(0.0, f64::max);
        let reach = correction.reach(cloud.domain().max(largest), cloud.spacing());
        let sites = Sites::new(cloud, reach)?;
        let horizons = sites.spread(&horizons).into_owned();
        let places = sites.places();
        let wanted = |a: usize, b: usize, distance: f64| {
            let cell = mean_cell(places, a, b);
            distance <= correction.reach(horizons[a].max(horizons[b]), cell)
        };
        let all = Horizons::PerSite(horizons.clone());
        Self::of_sites(sites.clone(), reach, all, correction, &wanted)
    }

    fn of_sites(
        sites: Sites,
        reach: f64,
        horizons: Horizons,
        correction: VolumeCorrection,
        wanted: &(dyn Fn(usize, usize, f64) -> bool + Sync),
    ) -> Result<Self> {
        let n = sites.cloud().len();
        let place = |i: usize| sites.of_point(i);
        let places = sites.places();
        let wanted =
            |a: usize, b: usize, r: f64| places.piece(a) == places.piece(b) && wanted(a, b, r);
        let (row_start, pairs) = pairs_of(places, n, &place, reach, &wanted);
        let domain = sites.cloud().domain();
        if domain.all(pairs.is_empty()) {
            return Err(PericlesError::HorizonTooSmall {
                horizon: domain.max(horizons.largest()),
                spacing: sites.cloud().spacing(),
            });
        }
        let groups = pairs.len() / LANES + n;
        let mut start = Vec::with_capacity(n + 1);
        let mut base = Vec::with_capacity(groups);
        let mut offsets = Vec::with_capacity(groups * LANES);
        let mut geometric = Vec::with_capacity(groups);
        start.push(0);
        for i in 0..n {
            let mut row = &pairs[row_start[i]..row_start[i + 1]];
            while let Some(&first) = row.first() {
                let number = sites.number(first as usize);
                // By numbers in the whole body, so that groups do not depend on the division among processes.
                let near = |&j: &u32| sites.number(j as usize) - number <= u64::from(u16::MAX);
                let len = row[..row.len().min(LANES)].partition_point(near);
                let (group, rest) = row.split_at(len);
                base.push(first);
                offsets.extend(group.iter().map(|j| (j - first) as u16));
                let last = (group[len - 1] - first) as u16;
                offsets.extend(std::iter::repeat_n(last, LANES - len));
                geometric.push(0xFF >> (LANES - len));
                row = rest;
            }
            start.push(base.len());
        }
        base.shrink_to_fit();
        offsets.shrink_to_fit();
        geometric.shrink_to_fit();
        Ok(Self {
            sites: Arc::new(sites),
            start,
            base,
            offsets,
            present: geometric.clone(),
            breakable: None,
            geometric,
            horizons,
            correction,
        })
    }

    /// Removes the bonds that meet a crack, or, in periodic bodies, one of its images.
    ///
    /// # Errors
    /// A crack of another dimension than the body, or without extent.
    pub fn cut(&mut self, crack: &Crack, rule: EndRule) -> Result<BondCut> {
        let sites = Arc::clone(&self.sites);
        let cloud = sites.cloud();
        if crack.dimension() != cloud.dimension() {
            return Err(PericlesError::WrongDimension {
                what: "this type of crack",
                needed: ["1", "2", "3"][crack.dimension() - 1],
                dimension: cloud.dimension(),
            });
        }
        let cutter = crack.cutter(rule, 1e-9 * cloud.spacing())?;
        let (start, list) = (&self.start, (&self.base, &self.offsets));
        let removed: Vec<u32> = rows_mut(start, &mut self.present)
            .into_par_iter()
            .enumerate()
            .with_min_len(256)
            .map(|(i, row)| {
                let mut removed = 0;
                let here = sites.of_point(i);
                for (g, present) in row.iter_mut().enumerate() {
                    for k in 0..LANES {
                        let j = neighbour(list, (start[i] + g) * LANES + k);
                        if *present >> k & 1 == 1 && cutter.cuts_bond(&sites, here, j) {
                            *present &= !(1 << k);
                            removed += 1;
                        }
                    }
                }
                removed
            })
            .collect();
        let directed = removed.iter().map(|&count| u64::from(count)).sum();
        Ok(BondCut {
            bonds: cloud.domain().count(directed) / 2,
            points: (0..removed.len() as u32)
                .filter(|&i| removed[i as usize] > 0)
                .collect(),
        })
    }

    /// The sites to which bonds lead.
    pub fn sites(&self) -> &Sites {
        &self.sites
    }

    /// The sites to which bonds lead, shared.
    pub(crate) fn shared_sites(&self) -> Arc<Sites> {
        Arc::clone(&self.sites)
    }

    /// The site of an own point.
    #[inline(always)]
    pub fn site(&self, i: usize) -> usize {
        self.sites.of_point(i)
    }

    /// First group of each point, and at the end the number of groups.
    pub fn start(&self) -> &[usize] {
        &self.start
    }

    /// The groups of a point.
    pub fn groups(&self, i: usize) -> Range<usize> {
        self.start[i]..self.start[i + 1]
    }

    /// The neighbours of a group as site numbers; valid for padding entries too.
    #[inline(always)]
    pub fn group(&self, group: usize) -> [usize; LANES] {
        let base = self.base[group] as usize;
        let offsets = &self.offsets[group * LANES..(group + 1) * LANES];
        let mut neighbours = [0; LANES];
        for k in 0..LANES {
            neighbours[k] = base + usize::from(offsets[k]);
        }
        neighbours
    }

    /// The neighbour of an entry.
    pub fn neighbour(&self, entry: usize) -> usize {
        neighbour((&self.base, &self.offsets), entry)
    }

    /// Bonds that exist after pre-cutting, one byte per group.
    pub fn present(&self) -> &[u8] {
        &self.present
    }

    /// Bonds of the geometric family including pre-cut ones, one byte per group.
    pub fn geometric(&self) -> &[u8] {
        &self.geometric
    }

    /// Returns whether the bond of an entry exists after pre-cutting.
    pub fn is_present(&self, entry: usize) -> bool {
        self.present[entry / LANES] >> (entry % LANES) & 1 == 1
    }

    /// Number of own points.
    pub fn len(&self) -> usize {
        self.start.len() - 1
    }

    /// Returns false: every body has points.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of directed bonds after pre-cutting: each bond counts twice.
    pub fn directed_bonds(&self) -> u64 {
        self.present.iter().map(|g| u64::from(g.count_ones())).sum()
    }

    /// Returns the cost of a loop over the bonds of a subset of the points.
    pub fn cost(&self, on: &PointSubset<'_>) -> Cost {
        Cost::bonds((LANES * self.present.len()) as u64).on(on, self.len())
    }

    /// Horizon δ, m; the largest if there are several.
    pub fn horizon(&self) -> f64 {
        self.horizons.largest()
    }

    /// Horizon δ, m, if it is the same for all points.
    pub fn uniform_horizon(&self) -> Option<f64> {
        match &self.horizons {
            Horizons::Uniform(horizon) => Some(*horizon),
            Horizons::PerSite(_) => None,
        }
    }

    /// The volume correction for cells cut by the horizon.
    pub fn correction(&self) -> VolumeCorrection {
        self.correction
    }

    /// The neighbours of a point in its geometric family, each with its entry in the list.
    pub fn family(&self, i: usize) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.groups(i).flat_map(move |g| {
            (0..LANES)
                .filter(move |k| self.geometric[g] >> k & 1 == 1)
                .map(move |k| (g * LANES + k, self.neighbour(g * LANES + k)))
        })
    }

    /// Calls `visit` once for every point other than i that has a bond with own point i; ghosts are counted after the
    /// own points.
    pub fn for_each_neighbour(&self, i: usize, visit: &mut dyn FnMut(usize)) {
        let family = self.family(i);
        let near = family.filter(|&(entry, _)| self.is_present(entry));
        if self.sites.are_points() {
            return near.for_each(|(_, j)| visit(j));
        }
        // Through periodic images a point may be a neighbour more than once, and a neighbour of itself.
        let mut points: Vec<usize> = near.map(|(_, site)| self.sites.point(site)).collect();
        points.sort_unstable();
        points.dedup();
        points.into_iter().filter(|&j| j != i).for_each(visit);
    }

    /// Excludes the bonds of the points `no_fail` from failure.
    pub fn hold(&mut self, no_fail: &[u32]) {
        let sites = Arc::clone(&self.sites);
        if sites.cloud().domain().all(no_fail.is_empty()) {
            return;
        }
        let mut held = vec![false; self.len()];
        for &i in no_fail {
            held[i as usize] = true;
        }
        let held = sites.spread_marks(&held);
        let mut breakable = vec![0u8; self.geometric.len()];
        for i in (0..self.len()).filter(|&i| !held[self.site(i)]) {
            for (entry, _) in self.family(i).filter(|&(_, site)| !held[site]) {
                breakable[entry / LANES] |= 1 << (entry % LANES);
            }
        }
        self.breakable = Some(breakable);
    }

    /// Bonds that may break, one byte per group; `None` if all may.
    pub fn breakable(&self) -> Option<&[u8]> {
        self.breakable.as_deref()
    }

    /// Returns whether the bond of an entry may break.
    pub fn may_break(&self, entry: usize) -> bool {
        let bits = self.breakable.as_ref();
        bits.is_none_or(|bits| bits[entry / LANES] >> (entry % LANES) & 1 == 1)
    }

    /// Volume fraction κ of the bond between two sites: the mean of the values of its two ends.
    pub fn volume_factor(&self, a: usize, b: usize) -> f64 {
        match &self.horizons {
            Horizons::Uniform(horizon) => {
                let cell = mean_cell(self.sites.places(), a, b);
                self.correction.factor(self.length(a, b), *horizon, cell)
            }
            Horizons::PerSite(_) => 0.5 * (self.end_factor(a, b) + self.end_factor(b, a)),
        }
    }

    /// Volume fraction κ of the bond from a to b with the horizon of site a; zero beyond that horizon.
    pub fn end_factor(&self, a: usize, b: usize) -> f64 {
        let (r, cell, horizon) = (
            self.length(a, b),
            mean_cell(self.sites.places(), a, b),
            self.horizons.of(a),
        );
        if r <= self.correction.reach(horizon, cell) {
            self.correction.factor(r, horizon, cell)
        } else {
            0.0
        }
    }

    /// Reference length of the bond between two sites, m.
    pub fn length(&self, a: usize, b: usize) -> f64 {
        distance(self.sites.places(), a, b)
    }

    /// Reference vector ξ from site a to site b, m.
    pub fn vector(&self, a: usize, b: usize) -> [f64; 3] {
        bond_vector(self.sites.places(), a, b)
    }

    /// The volume of a site, m³.
    pub fn volume(&self, site: usize) -> f64 {
        self.sites.places().volumes()[site]
    }

    /// Memory of the neighbour list, bytes.
    pub fn bytes(&self) -> usize {
        self.sites.bytes()
            + size_of_val(&self.start[..])
            + size_of_val(&self.base[..])
            + size_of_val(&self.offsets[..])
            + self.present.len()
            + self.geometric.len()
    }
}

fn neighbour((base, offsets): (&Vec<u32>, &Vec<u16>), entry: usize) -> usize {
    base[entry / LANES] as usize + usize::from(offsets[entry])
}

fn mean_cell(cloud: &PointCloud, i: usize, j: usize) -> f64 {
    0.5 * (cloud.cell_size(i) + cloud.cell_size(j))
}

/// Splits an array with one entry per group into one slice per point.
fn rows_mut<'a, T>(start: &[usize], mut groups: &'a mut [T]) -> Vec<&'a mut [T]> {
    start
        .windows(2)
        .map(|bounds| {
            let (row, rest) = std::mem::take(&mut groups).split_at_mut(bounds[1] - bounds[0]);
            groups = rest;
            row
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{Grid, Shape};

    fn plate(cells: f64) -> Arc<PointCloud> {
        let grid = Grid {
            shape: Shape::Box {
                origin: [0.0; 3],
                size: vec![cells, cells],
            },
            spacing: 1.0,
            section: 1.0,
            holes: vec![],
        };
        Arc::new(grid.points().unwrap())
    }

    #[test]
    fn interior_family_sizes_of_a_plate_equal_lattice_counts() {
        let cloud = plate(12.0);
        let count = |correction| {
            let bonds = BondList::new(&cloud, 3.0, correction).unwrap();
            bonds.family(6 * 12 + 6).count()
        };
        // Nodes within 3 spacings: 28. Nodes within 3.5 spacings add (2,2)… up to √10 and √(2²+2²) < 3: 36 in all.
        assert_eq!(count(VolumeCorrection::None), 28);
        assert_eq!(count(VolumeCorrection::Extended), 36);
    }

    #[test]
    fn a_crack_cuts_both_ends_of_a_bond() {
        let cloud = plate(12.0);
        let mut bonds = BondList::new(&cloud, 3.0, VolumeCorrection::None).unwrap();
        let before = bonds.directed_bonds();
        let crack = Crack::Segment {
            from: [0.0, 6.0],
            to: [6.0, 6.0],
        };
        let cut = bonds.cut(&crack, EndRule::Closed).unwrap();
        assert_eq!(before - bonds.directed_bonds(), 2 * cut.bonds);
        let again = bonds.cut(&crack, EndRule::Closed).unwrap();
        assert_eq!((again.bonds, again.points.len()), (0, 0));
        let mut open = BondList::new(&cloud, 3.0, VolumeCorrection::None).unwrap();
        let kept = cut.bonds - open.cut(&crack, EndRule::Open).unwrap().bonds;
        // The six bonds of types (1,1), twice, and (2,2) … that lie symmetrically about the closed end pass through
        // it.
        assert_eq!(kept, 6);
    }

    #[test]
    fn a_horizon_below_the_spacing_is_rejected() {
        let error = BondList::new(&plate(4.0), 0.9, VolumeCorrection::None).unwrap_err();
        assert!(matches!(error, PericlesError::HorizonTooSmall { .. }));
    }
}
