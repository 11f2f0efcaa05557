//! Neighbour search by a cell list.

use rayon::prelude::*;

use crate::space::{PointCloud, Sites};

/// Returns, for every point, the other points within `reach` (m), in ascending order, as compressed rows: the
/// neighbours of i are `neighbours[start[i]..start[i + 1]]`.
///
/// Points are sorted by counting into cubes of side `reach`; each point searches the 3^D cubes around its own. On a
/// lattice, lengths are computed from integer offsets, so that points at exactly the same distance are treated
/// identically. Cost O(N · family); memory O(N) in addition to the result.
pub fn pairs_within(cloud: &PointCloud, reach: f64) -> (Vec<usize>, Vec<u32>) {
    pairs_where(cloud, reach, &|_, _, distance| distance <= reach)
}

/// Returns the pairs at most `reach` (m) apart for which `wanted(i, j, distance)` is true. The condition must be
/// symmetric in i and j.
pub fn pairs_where(
    cloud: &PointCloud,
    reach: f64,
    wanted: &(dyn Fn(usize, usize, f64) -> bool + Sync),
) -> (Vec<usize>, Vec<u32>) {
    pairs_of(cloud, cloud.len(), &|k| k, reach, wanted)
}

/// As [`pairs_where`] for the sites that `place` assigns to the rows 0 to `rows`.
pub(super) fn pairs_of(
    cloud: &PointCloud,
    rows: usize,
    place: &(dyn Fn(usize) -> usize + Sync),
    reach: f64,
    wanted: &(dyn Fn(usize, usize, f64) -> bool + Sync),
) -> (Vec<usize>, Vec<u32>) {
    let cells = CellList::new(cloud, reach);
    let rows: Vec<Vec<u32>> = (0..rows)
        .into_par_iter()
        .with_min_len(256)
        .map(|row| {
            let i = place(row);
            let mut row = Vec::new();
            cells.for_each_near(i, reach, |j, distance| {
                if j != i && wanted(i, j, distance) {
                    row.push(j as u32);
                }
            });
            row.sort_unstable();
            row.shrink_to_fit();
            row
        })
        .collect();
    let mut start = Vec::with_capacity(rows.len() + 1);
    let mut total = 0;
    start.push(0);
    for row in &rows {
        total += row.len();
        start.push(total);
    }
    let mut neighbours = Vec::with_capacity(total);
    for row in rows {
        neighbours.extend_from_slice(&row);
    }
    (start, neighbours)
}

/// As [`pairs_where`] for the sites of some points: the sites within reach of each of the points `wanted`, for which the
/// condition holds for both sites and their distance.
pub(crate) fn pairs_of_sites(
    sites: &Sites,
    wanted: &[u32],
    reach: f64,
    holds: &(dyn Fn(usize, usize, f64) -> bool + Sync),
) -> (Vec<usize>, Vec<u32>) {
    let place = |row: usize| sites.of_point(wanted[row] as usize);
    pairs_of(sites.places(), wanted.len(), &place, reach, holds)
}

/// Returns the vector from point i to point j; on a lattice an exact multiple of the spacing.
pub(crate) fn bond_vector(cloud: &PointCloud, i: usize, j: usize) -> [f64; 3] {
    if let Some(lattice) = cloud.lattice() {
        let (a, b) = (
            lattice.coordinates(lattice.node[i]),
            lattice.coordinates(lattice.node[j]),
        );
        return lattice.vector(std::array::from_fn(|c| b[c] - a[c]));
    }
    let (a, b) = (cloud.point(i), cloud.point(j));
    std::array::from_fn(|c| b[c] - a[c])
}

pub(crate) fn distance(cloud: &PointCloud, i: usize, j: usize) -> f64 {
    let xi = bond_vector(cloud, i, j);
    (xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2]).sqrt()
}

/// Points sorted into cells.
struct CellList {
    shape: [usize; 3],
    cell_of: Vec<u32>,
    start: Vec<u32>,
    /// The points, cell by cell.
    order: Vec<u32>,
    /// Their positions in the same order, in units of `unit`: integers on a lattice, see [`bond_vector`].
    places: Vec<[f64; 3]>,
    unit: [f64; 3],
    /// Position of each point in that order.
    rank: Vec<u32>,
}

/// Returns the coordinates of a point in units of [`CellList::unit`]; their differences equal [`bond_vector`] bit
/// for bit.
fn coordinates(cloud: &PointCloud, i: usize) -> [f64; 3] {
    match cloud.lattice() {
        Some(lattice) => lattice.coordinates(lattice.node[i]).map(f64::from),
        None => cloud.point(i),
    }
}

impl CellList {
    fn new(cloud: &PointCloud, reach: f64) -> Self {
        let bounds = cloud.bounds();
        let n = cloud.len();
        // At most as many cells as points: sparse clouds get larger cells, not more memory.
        let mut side = reach * (1.0 + 1e-6);
        let shape_for = |side: f64| -> [f64; 3] {
            std::array::from_fn(|c| ((bounds[1][c] - bounds[0][c]) / side).floor().max(1.0))
        };
        while shape_for(side).iter().product::<f64>() > (n as f64).max(27.0) {
            side *= 1.3;
        }
        let shape = shape_for(side).map(|count| count as usize);
        let width: [f64; 3] = std::array::from_fn(|c| {
            ((bounds[1][c] - bounds[0][c]) / shape[c] as f64).max(f64::MIN_POSITIVE)
        });
        let cell_of: Vec<u32> = (0..n)
            .map(|i| {
                let x = cloud.point(i);
                let at = |c: usize| (((x[c] - bounds[0][c]) / width[c]) as usize).min(shape[c] - 1);
                (at(0) + shape[0] * (at(1) + shape[1] * at(2))) as u32
            })
            .collect();
        let mut start = vec![0u32; shape.iter().product::<usize>() + 1];
        for &cell in &cell_of {
            start[cell as usize + 1] += 1;
        }
        for k in 1..start.len() {
            start[k] += start[k - 1];
        }
        let mut next = start.clone();
        let mut order = vec![0u32; n];
        let mut places = vec![[0.0; 3]; n];
        let mut rank = vec![0u32; n];
        for (i, &cell) in cell_of.iter().enumerate() {
            let place = next[cell as usize];
            order[place as usize] = i as u32;
            places[place as usize] = coordinates(cloud, i);
            rank[i] = place;
            next[cell as usize] += 1;
        }
        Self {
            shape,
            cell_of,
            start,
            order,
            places,
            unit: cloud.lattice().map_or([1.0; 3], |lattice| lattice.spacing),
            rank,
        }
    }

    /// Calls `visit(j, |ξ|)` for the points within reach of point i and for some slightly beyond.
    fn for_each_near(&self, i: usize, reach: f64, mut visit: impl FnMut(usize, f64)) {
        let here = self.places[self.rank[i] as usize];
        // Skips the square root for points clearly out of reach, which are most of the candidates.
        let far = (reach * (1.0 + 1e-6)).powi(2);
        let cell = self.cell_of[i] as usize;
        let at = [
            cell % self.shape[0],
            cell / self.shape[0] % self.shape[1],
            cell / self.shape[0] / self.shape[1],
        ];
        let around = |c: usize| at[c].saturating_sub(1)..=(at[c] + 1).min(self.shape[c] - 1);
        for z in around(2) {
            for y in around(1) {
                for x in around(0) {
                    let cell = x + self.shape[0] * (y + self.shape[1] * z);
                    let (from, to) = (self.start[cell] as usize, self.start[cell + 1] as usize);
                    for (there, &j) in self.places[from..to].iter().zip(&self.order[from..to]) {
                        let xi: [f64; 3] =
                            std::array::from_fn(|c| (there[c] - here[c]) * self.unit[c]);
                        let square = xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2];
                        if square <= far {
                            visit(j as usize, square.sqrt());
                        }
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn cell_list_finds_the_same_pairs_as_a_full_search(
            dimension in 1usize..=3,
            coordinates in prop::collection::vec(-1.0f64..1.0, 30..90),
            reach in 0.05f64..2.5,
        ) {
            let n = coordinates.len() / dimension;
            let cloud = PointCloud::new(dimension, coordinates[..n * dimension].to_vec(), vec![1e-3; n], 1.0).unwrap();
            let (start, neighbours) = pairs_within(&cloud, reach);
            for i in 0..n {
                let naive: Vec<u32> = (0..n)
                    .filter(|&j| j != i && distance(&cloud, i, j) <= reach)
                    .map(|j| j as u32)
                    .collect();
                prop_assert_eq!(&neighbours[start[i]..start[i + 1]], &naive[..]);
            }
        }
    }
}
