//! Sites: the positions to which bonds lead.
//!
//! Periodic faces and divided bodies use the same mechanism, in neighbour lists and in stencils: loops read rows of
//! values packed by site. Where all points are computed, bond failure needs no communication, because both ends of a
//! bond reach the same decision; where only a part is computed, the other end is informed by messages. Direct solvers
//! require whole bodies with free faces.
//!
//! The positions of sites can be released and restored ([`Sites::release_places`]): stencil kernels need them during
//! set-up, and later for output and tangents only.

use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

use super::{Lattice, PointCloud};
use crate::domain::Domain;
use crate::error::{PericlesError, Result};

/// The sites to which the bonds of a body lead: own points, *ghosts* owned by other processes, and *images* of both
/// beyond periodic faces.
///
/// A site has the displacement of its point; its position is the position of the point, moved by whole periods for images.
/// Sites are numbered in the order of the point numbers in the whole body, first those without a shift and then
/// shift by shift, so that the neighbours of a point have the same order for every division among processes. For a
/// single process that owns all points of a body without periodic faces, site i is point i.
#[derive(Debug, Clone)]
pub struct Sites {
    cloud: Arc<PointCloud>,
    /// Positions and volumes of all sites, if site i is not point i; they can be restored at any time.
    places: OnceLock<PointCloud>,
    /// `None` if site i is point i.
    map: Option<Map>,
}

#[derive(Debug, Clone)]
struct Map {
    ghosts: PointCloud,
    /// Site without a shift of each point, first own points, then ghosts.
    unmoved: Vec<u32>,
    /// Point of each site: first own points, then ghosts.
    point: Vec<u32>,
    /// Numbers of periods by which sites are moved, with the first site of each shift; some have no sites.
    shifts: Vec<([i16; 3], usize)>,
}

impl Map {
    /// Returns the index of the shift of a site.
    fn shift(&self, site: usize) -> usize {
        self.shifts.partition_point(|&(_, first)| first <= site) - 1
    }
}

impl Sites {
    /// Largest number of periods that a bond may span.
    pub const PERIODS: f64 = 100.0;

    /// Makes the sites of a cloud to which bonds of length up to `reach` (m) may lead.
    ///
    /// # Errors
    /// Bonds that span more than [`Sites::PERIODS`] periods of the body.
    pub fn new(cloud: &Arc<PointCloud>, reach: f64) -> Result<Self> {
        let domain = cloud.domain();
        if domain.ghost_points() == 0 && !cloud.is_periodic() {
            return Ok(Self::of_points(cloud));
        }
        if let (Some(lattice), true) = (cloud.lattice(), cloud.is_periodic()) {
            let sides = &lattice.sides()[..cloud.dimension()];
            let shortest = sides.iter().copied().fold(f64::INFINITY, f64::min);
            if reach / shortest > Self::PERIODS {
                return Err(PericlesError::OutOfRange {
                    quantity: "the length of bonds over the shortest side of the periodic body",
                    value: reach / shortest,
                    allowed: "at most 100; use bonds = \"convolution\" or \"spectral\" for bonds of any length",
                });
            }
        }
        let ghosts = cloud.ghosts_of(domain);
        let points = cloud.with_ghosts(&ghosts);
        let groups = match (cloud.is_periodic(), points.lattice()) {
            (true, Some(lattice)) => images(cloud.dimension(), lattice, reach),
            _ => vec![([0; 3], (0..points.len() as u32).collect())],
        };
        let (mut point, mut shifts) = (Vec::new(), Vec::new());
        for (shift, mut of_shift) in groups {
            of_shift.sort_unstable_by_key(|&point| domain.number(point as usize));
            shifts.push((shift, point.len()));
            point.append(&mut of_shift);
        }
        let mut unmoved = vec![0; points.len()];
        let first_image = shifts.get(1).map_or(point.len(), |&(_, first)| first);
        for (site, &point) in point[..first_image].iter().enumerate() {
            unmoved[point as usize] = site as u32;
        }
        let map = Map {
            ghosts,
            unmoved,
            point,
            shifts,
        };
        let sites = Self {
            cloud: cloud.clone(),
            places: OnceLock::new(),
            map: Some(map),
        };
        // The points are at hand.
        let places = sites.placed(&points);
        Ok(Self {
            places: OnceLock::from(places),
            ..sites
        })
    }

    /// The own points only.
    fn of_points(cloud: &Arc<PointCloud>) -> Self {
        Self {
            cloud: cloud.clone(),
            places: OnceLock::new(),
            map: None,
        }
    }

    /// Returns positions and volumes of the sites of own points and ghosts.
    fn placed(&self, points: &PointCloud) -> PointCloud {
        points.moved_points(self.len(), |site| (self.shift(site), self.point(site)))
    }

    /// Frees the positions and volumes of the sites until they are needed again.
    pub fn release_places(&mut self) {
        self.places.take();
    }

    /// The own points.
    pub fn cloud(&self) -> &Arc<PointCloud> {
        &self.cloud
    }

    /// Number of sites.
    pub fn len(&self) -> usize {
        match &self.map {
            None => self.cloud.len(),
            Some(map) => map.point.len(),
        }
    }

    /// Returns false: there is at least one site.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns whether site i is point i.
    pub fn are_points(&self) -> bool {
        self.map.is_none()
    }

    /// Positions, volumes and cells of the sites.
    pub fn places(&self) -> &PointCloud {
        match &self.map {
            None => &self.cloud,
            Some(map) => self
                .places
                .get_or_init(|| self.placed(&self.cloud.with_ghosts(&map.ghosts))),
        }
    }

    /// The site of own point k, or of a ghost; ghosts are counted after the own points.
    #[inline(always)]
    pub fn of_point(&self, k: usize) -> usize {
        match &self.map {
            None => k,
            Some(map) => map.unmoved[k] as usize,
        }
    }

    /// The point of a site; ghosts are counted after the own points.
    #[inline(always)]
    pub fn point(&self, site: usize) -> usize {
        match &self.map {
            None => site,
            Some(map) => map.point[site] as usize,
        }
    }

    /// The own point of a site; `None` for ghosts.
    pub fn own_point(&self, site: usize) -> Option<usize> {
        Some(self.point(site)).filter(|&point| point < self.cloud.len())
    }

    /// Number of periods by which a site is moved from its point.
    pub fn shift(&self, site: usize) -> [i16; 3] {
        self.map
            .as_ref()
            .map_or([0; 3], |map| map.shifts[map.shift(site)].0)
    }

    /// Periods of the body, m: the sides of its box.
    pub fn periods(&self) -> [f64; 3] {
        match self.cloud.lattice() {
            Some(lattice) => lattice.sides(),
            None => [0.0; 3],
        }
    }

    /// A number that increases with the sites and does not depend on the division among processes. Between sites of
    /// one shift it differs at least as much as the site numbers.
    pub fn number(&self, site: usize) -> u64 {
        match &self.map {
            None => site as u64,
            Some(map) => {
                let number = self.domain().number(map.point[site] as usize);
                (map.shift(site) as u64) << 32 | number as u64
            }
        }
    }

    /// Returns one value per site from one value per own point; empty if the input is empty. All processes must
    /// call it together.
    pub fn spread<'a>(&self, of_points: &'a [f64]) -> Cow<'a, [f64]> {
        let Some(map) = self.map.as_ref().filter(|_| !of_points.is_empty()) else {
            return Cow::Borrowed(of_points);
        };
        let values = self.domain().with_ghosts(of_points);
        Cow::Owned(map.point.iter().map(|&k| values[k as usize]).collect())
    }

    /// Returns one flag per site from one flag per own point.
    pub fn spread_marks<'a>(&self, of_points: &'a [bool]) -> Cow<'a, [bool]> {
        let Some(map) = &self.map else {
            return Cow::Borrowed(of_points);
        };
        let marks = self.domain().marks_with_ghosts(of_points);
        Cow::Owned(map.point.iter().map(|&k| marks[k as usize]).collect())
    }

    /// Returns one byte per site from one byte per own point; empty if the input is empty.
    pub fn spread_numbers(&self, of_points: &[u8]) -> Vec<u8> {
        let numbers: Vec<f64> = of_points.iter().map(|&k| f64::from(k)).collect();
        self.spread(&numbers).iter().map(|&k| k as u8).collect()
    }

    fn domain(&self) -> &Domain {
        self.cloud.domain()
    }

    /// Memory in addition to that of the cloud, bytes.
    pub fn bytes(&self) -> usize {
        let Some(map) = &self.map else { return 0 };
        let place = (self.cloud.dimension() + 1) * size_of::<f64>() + size_of::<u32>();
        let places = self.places.get().map_or(0, PointCloud::len) + map.ghosts.len();
        size_of_val(&map.unmoved[..]) + size_of_val(&map.point[..]) + places * place
    }
}

/// Returns the points of a periodic lattice and their images within `reach` of the box, shift by shift, starting
/// without a shift.
fn images(dimension: usize, lattice: &Lattice, reach: f64) -> Vec<([i16; 3], Vec<u32>)> {
    // The margin keeps rounding of the quotient from losing the longest bonds.
    let cells = (lattice.spacing).map(|dx| (reach / dx * (1.0 + 1e-9)).floor() as i32);
    let sides = lattice.shape.map(|nodes| nodes as i32);
    let most: [i32; 3] = std::array::from_fn(|c| match c < dimension {
        true => (cells[c] + sides[c] - 1) / sides[c],
        false => 0,
    });
    let mut shifts = vec![[0; 3]];
    for z in -most[2]..=most[2] {
        for y in -most[1]..=most[1] {
            for x in -most[0]..=most[0] {
                if [x, y, z] != [0; 3] {
                    shifts.push([x, y, z]);
                }
            }
        }
    }
    let near = |shift: [i32; 3], node: u32| {
        let at = lattice.coordinates(node);
        (0..3).all(|c| {
            let moved = at[c] + shift[c] * sides[c];
            (-cells[c]..sides[c] + cells[c]).contains(&moved)
        })
    };
    let of_shift = |shift: [i32; 3]| {
        let points = (lattice.node.iter().zip(0..))
            .filter(|&(&node, _)| near(shift, node))
            .map(|(_, point)| point);
        (shift.map(|s| s as i16), points.collect())
    };
    shifts.into_iter().map(of_shift).collect()
}
