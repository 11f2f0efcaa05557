//! The places that bonds lead to.

use std::borrow::Cow;
use std::sync::Arc;

use super::{Lattice, PointCloud};
use crate::domain::Domain;
use crate::error::{PericlesError, Result};

/// The places that the bonds of a body lead to: own points, *ghosts* that other processes own, and *images* of both beyond periodic faces.
///
/// A site stands for a point, whose displacement it takes; its position is that of the point, moved by whole periods for images. Sites are numbered in the order of the points' numbers in the whole
/// body, those without a shift first and then shift by shift, so that the neighbours of a point come in the same order for every division among processes. One process that owns all points of a body without
/// periodic faces has as many sites as points, and site i is point i.
#[derive(Debug, Clone)]
pub struct Sites {
    cloud: Arc<PointCloud>,
    /// Positions and volumes of all sites; the cloud itself where site i is point i.
    places: Arc<PointCloud>,
    /// None where site i is point i.
    map: Option<Map>,
}

#[derive(Debug, Clone)]
struct Map {
    /// Site without a shift of each point, ghosts behind own ones.
    unmoved: Vec<u32>,
    /// Point of each site: own ones first, ghosts behind them.
    point: Vec<u32>,
    /// Periods by which each site is moved.
    shift: Vec<[i16; 3]>,
    /// Number of the point in the whole body, behind the number of the shift.
    number: Vec<u64>,
}

impl Sites {
    /// Periods that bonds may lead through a body at most.
    pub const PERIODS: f64 = 100.0;

    /// The sites of a cloud that bonds up to this length (m) may lead to.
    ///
    /// # Errors
    /// Bonds that lead through a periodic body more than [`Sites::PERIODS`] times.
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
                    quantity: "the reach of bonds over the shortest side of the periodic body",
                    value: reach / shortest,
                    allowed: "at most 100; bonds = \"convolution\" and \"spectral\" reach any distance",
                });
            }
        }
        let points = cloud.with_ghost_points();
        let shifts = match (cloud.is_periodic(), points.lattice()) {
            (true, Some(lattice)) => images(cloud.dimension(), lattice, reach),
            _ => vec![
                (0..points.len() as u32)
                    .map(|point| ([0; 3], point))
                    .collect(),
            ],
        };
        let mut sites = Vec::new();
        for (k, mut of_shift) in shifts.into_iter().enumerate() {
            of_shift.sort_unstable_by_key(|&(_, point)| domain.number(point as usize));
            sites.extend(of_shift.into_iter().map(|(shift, point)| {
                let number = (k as u64) << 32 | domain.number(point as usize) as u64;
                (shift, point, number)
            }));
        }
        let mut unmoved = vec![0; points.len()];
        for (site, &(shift, point, _)) in sites.iter().enumerate() {
            if shift == [0; 3] {
                unmoved[point as usize] = site as u32;
            }
        }
        let moved: Vec<([i16; 3], u32)> = sites.iter().map(|&(s, point, _)| (s, point)).collect();
        Ok(Self {
            places: Arc::new(points.moved_points(&moved)),
            cloud: cloud.clone(),
            map: Some(Map {
                unmoved,
                point: moved.iter().map(|&(_, point)| point).collect(),
                shift: moved.iter().map(|&(shift, _)| shift).collect(),
                number: sites.iter().map(|&(_, _, number)| number).collect(),
            }),
        })
    }

    /// The own points alone.
    fn of_points(cloud: &Arc<PointCloud>) -> Self {
        Self {
            cloud: cloud.clone(),
            places: cloud.clone(),
            map: None,
        }
    }

    /// The own points.
    pub fn cloud(&self) -> &Arc<PointCloud> {
        &self.cloud
    }

    /// Number of sites.
    pub fn len(&self) -> usize {
        self.places.len()
    }

    /// Never true.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether site i is point i.
    pub fn are_points(&self) -> bool {
        self.map.is_none()
    }

    /// Positions, volumes and cells of the sites.
    pub fn places(&self) -> &PointCloud {
        &self.places
    }

    /// The site of own point k, or of a ghost, counted behind own points.
    #[inline(always)]
    pub fn of_point(&self, k: usize) -> usize {
        match &self.map {
            None => k,
            Some(map) => map.unmoved[k] as usize,
        }
    }

    /// The point that a site stands for; ghosts are counted behind own points.
    #[inline(always)]
    pub fn point(&self, site: usize) -> usize {
        match &self.map {
            None => site,
            Some(map) => map.point[site] as usize,
        }
    }

    /// The own point that a site stands for; none for ghosts.
    pub fn own_point(&self, site: usize) -> Option<usize> {
        Some(self.point(site)).filter(|&point| point < self.cloud.len())
    }

    /// Periods by which a site is moved from its point.
    pub fn shift(&self, site: usize) -> [i16; 3] {
        self.map.as_ref().map_or([0; 3], |map| map.shift[site])
    }

    /// The periods of the body, m: the sides of its box.
    pub fn periods(&self) -> [f64; 3] {
        match self.cloud.lattice() {
            Some(lattice) => lattice.sides(),
            None => [0.0; 3],
        }
    }

    /// A number that ascends with the sites and does not depend on the division among processes. Between sites of one shift it differs at least as much as the sites' own numbers.
    pub fn number(&self, site: usize) -> u64 {
        match &self.map {
            None => site as u64,
            Some(map) => map.number[site],
        }
    }

    /// One value for each site, from one for each own point; none from none. Every process must ask at the same time.
    pub fn spread<'a>(&self, of_points: &'a [f64]) -> Cow<'a, [f64]> {
        let Some(map) = self.map.as_ref().filter(|_| !of_points.is_empty()) else {
            return Cow::Borrowed(of_points);
        };
        let values = self.domain().with_ghosts(of_points);
        Cow::Owned(map.point.iter().map(|&k| values[k as usize]).collect())
    }

    /// A mark for each site, from one for each own point.
    pub fn spread_marks<'a>(&self, of_points: &'a [bool]) -> Cow<'a, [bool]> {
        let Some(map) = &self.map else {
            return Cow::Borrowed(of_points);
        };
        let marks = self.domain().marks_with_ghosts(of_points);
        Cow::Owned(map.point.iter().map(|&k| marks[k as usize]).collect())
    }

    /// A small number for each site, from one for each own point; none from none.
    pub fn spread_numbers(&self, of_points: &[u8]) -> Vec<u8> {
        let numbers: Vec<f64> = of_points.iter().map(|&k| f64::from(k)).collect();
        self.spread(&numbers).iter().map(|&k| k as u8).collect()
    }

    fn domain(&self) -> &Domain {
        self.cloud.domain()
    }

    /// Memory beside the points' own, bytes.
    pub fn bytes(&self) -> usize {
        let Some(map) = &self.map else { return 0 };
        let places = (self.places.dimension() + 1) * size_of::<f64>() + size_of::<u32>();
        let each = 2 * size_of::<u32>() + size_of::<u64>() + 3;
        size_of_val(&map.unmoved[..]) + self.len() * (places + each)
    }
}

/// The points of a periodic lattice and their images within `reach` of the box, shift by shift: that of no shift first.
fn images(dimension: usize, lattice: &Lattice, reach: f64) -> Vec<Vec<([i16; 3], u32)>> {
    // Rounding of the quotient must not lose the longest bonds.
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
        (lattice.node.iter().zip(0..))
            .filter(|&(&node, _)| near(shift, node))
            .map(|(_, point)| (shift.map(|s| s as i16), point))
            .collect()
    };
    shifts.into_iter().map(of_shift).collect()
}
