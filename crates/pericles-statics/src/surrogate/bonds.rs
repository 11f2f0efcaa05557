//! Neighbours of points in the surrogate.

use pericles::System;
use pericles::domain::Domain;
use pericles::family::pairs_within;
use pericles::parallel::for_each_point;
use pericles::space::PointCloud;

/// A bond from one of its end points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Bond {
    /// The other end point.
    pub neighbour: u32,
    /// Reference vector to the other end point, m.
    pub xi: [f64; 3],
}

impl Bond {
    /// |ξ|², m².
    pub fn length_squared(&self) -> f64 {
        self.xi.iter().map(|x| x * x).sum()
    }
}

/// Neighbours of every point, symmetric: a bond is kept if either of its end points selects it.
#[derive(Debug, Clone, Default)]
pub(crate) struct Neighbours {
    start: Vec<usize>,
    bonds: Vec<Bond>,
    /// Length of the period along each axis, m; `None` if the body is not periodic.
    pub period: [Option<f64>; 3],
}

impl Neighbours {
    /// Selects neighbours from the intact bonds of a body, whose points are `whole`. Each process of a divided body selects
    /// those of its own points, and has those of all points. All processes must call it together.
    pub fn of(system: &System, whole: &PointCloud) -> Self {
        let domain = system.domain();
        let chosen: Vec<Vec<Bond>> = match system.operator().as_bonds() {
            Some(view) => {
                let own = for_each_point(system.points(), &|i| {
                    let mut all = Vec::new();
                    view.for_each_undeformed(i, &mut |bond| {
                        // Ghosts of surface layers are no points of the body.
                        if !bond.to_ghost && bond.neighbour != i {
                            all.push(Bond {
                                neighbour: domain.number(bond.neighbour) as u32,
                                xi: bond.xi,
                            });
                        }
                    });
                    chosen(whole, all)
                });
                of_all_processes(domain, own)
            }
            None => {
                /// Search radius in spacings for forces without a view of their bonds.
                const REACH: f64 = 2.5;
                let (start, neighbours) = pairs_within(whole, REACH * whole.spacing());
                for_each_point(whole.len(), &|i| {
                    let near = neighbours[start[i]..start[i + 1]].iter();
                    let all = near.filter(|&&j| j as usize != i).map(|&j| {
                        let (here, there) = (whole.point(i), whole.point(j as usize));
                        Bond {
                            neighbour: j,
                            xi: std::array::from_fn(|c| there[c] - here[c]),
                        }
                    });
                    chosen(whole, all.collect())
                })
            }
        };
        let mut symmetric = Self::symmetric(chosen);
        symmetric.find_periods(whole);
        symmetric
    }

    fn symmetric(chosen: Vec<Vec<Bond>>) -> Self {
        let mut of_point: Vec<Vec<Bond>> = chosen.clone();
        for (i, bonds) in chosen.iter().enumerate() {
            for bond in bonds {
                of_point[bond.neighbour as usize].push(Bond {
                    neighbour: i as u32,
                    xi: bond.xi.map(|x| -x),
                });
            }
        }
        let mut start = vec![0];
        let mut all = Vec::new();
        for bonds in &mut of_point {
            // By the other end point, and several periodic images of it by the vector.
            bonds.sort_by(|a, b| {
                let by_vector = || a.xi.partial_cmp(&b.xi).unwrap_or(std::cmp::Ordering::Equal);
                a.neighbour.cmp(&b.neighbour).then_with(by_vector)
            });
            bonds.dedup_by(|a, b| a.neighbour == b.neighbour && is_same(a, b));
            all.extend_from_slice(bonds);
            start.push(all.len());
        }
        Self {
            start,
            bonds: all,
            period: [None; 3],
        }
    }

    fn find_periods(&mut self, cloud: &PointCloud) {
        if !cloud.is_periodic() {
            return;
        }
        for i in 0..cloud.len() {
            let here = cloud.point(i);
            for bond in &self.bonds[self.start[i]..self.start[i + 1]] {
                let there = cloud.point(bond.neighbour as usize);
                for c in 0..3 {
                    let shift = (bond.xi[c] - (there[c] - here[c])).abs();
                    if shift > 0.5 * cloud.spacing() {
                        self.period[c] = Some(self.period[c].map_or(shift, |p| p.min(shift)));
                    }
                }
            }
        }
    }

    /// Returns the bonds of a point.
    pub fn of_point(&self, i: usize) -> &[Bond] {
        &self.bonds[self.start[i]..self.start[i + 1]]
    }
}

/// Returns the bonds of all points, in the order of their numbers, from those of own points.
fn of_all_processes(domain: &Domain, own: Vec<Vec<Bond>>) -> Vec<Vec<Bond>> {
    if !domain.is_divided() {
        return own;
    }
    /// Numbers of a message per bond.
    const LENGTH: usize = 4;
    let of_point = |(i, bonds): (usize, &Vec<Bond>)| -> Vec<f64> {
        let head = [domain.number(i), bonds.len()].map(|k| k as f64);
        let numbers = bonds.iter().flat_map(|bond| {
            let [x, y, z] = bond.xi;
            [f64::from(bond.neighbour), x, y, z]
        });
        head.into_iter().chain(numbers).collect()
    };
    let message = own.iter().enumerate().flat_map(of_point).collect();
    let messages = domain.collect_everywhere(message);
    let mut all = vec![Vec::new(); domain.whole_points()];
    for mut left in messages.iter().map(Vec::as_slice) {
        while let [number, count, after @ ..] = left {
            let (bonds, next) = after.split_at(LENGTH * *count as usize);
            let bonds = bonds.chunks_exact(LENGTH).map(|bond| Bond {
                neighbour: bond[0] as u32,
                xi: [bond[1], bond[2], bond[3]],
            });
            all[*number as usize] = bonds.collect();
            left = next;
        }
    }
    all
}

/// Returns whether two bonds to the same point are equal to round-off.
fn is_same(a: &Bond, b: &Bond) -> bool {
    let apart: f64 = (0..3).map(|c| (a.xi[c] - b.xi[c]).powi(2)).sum();
    apart < 1e-6 * a.length_squared()
}

/// Selects the bonds of a point: on a lattice those to adjacent cells, in space without corners, and where such a bond is broken
/// the shortest intact one near its direction, so that the springs connect the same parts of the body as the bonds; for other
/// clouds the nearest bonds.
fn chosen(cloud: &PointCloud, mut all: Vec<Bond>) -> Vec<Bond> {
    let d = cloud.dimension();
    all.sort_by(|a, b| {
        let by_length = a.length_squared().total_cmp(&b.length_squared());
        by_length.then_with(|| a.neighbour.cmp(&b.neighbour))
    });
    // Squared distances in cells: 1.5² and 1.45².
    let reach = if d == 3 { 2.1025 } else { 2.25 };
    let nearest = [3, 12, 18][d - 1];
    let Some(sides) = cloud.cell_sides() else {
        all.truncate(nearest);
        return all;
    };
    let cells = |bond: &Bond| -> [f64; 3] {
        std::array::from_fn(|c| if c < d { bond.xi[c] / sides[c] } else { 0.0 })
    };
    let square = |x: [f64; 3]| x.iter().map(|x| x * x).sum::<f64>();
    all.sort_by(|a, b| square(cells(a)).total_cmp(&square(cells(b))));
    let mut open = directions(d, reach);
    let (mut kept, mut passed) = (Vec::new(), Vec::new());
    for bond in all {
        let xi = cells(&bond);
        let along = |unit: &[f64; 3]| (0..3).map(|c| unit[c] * xi[c]).sum::<f64>();
        /// Smallest cosine of the angle between a bond and the direction that it represents.
        const COSINE: f64 = 0.86;
        let cosines = open.iter().map(along).enumerate();
        match cosines.max_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((direction, cosine)) if cosine > COSINE * square(xi).sqrt() => {
                open.remove(direction);
                kept.push(bond);
            }
            _ => passed.push(bond),
        }
        if open.is_empty() {
            break;
        }
    }
    let missing = (2 * d).saturating_sub(kept.len());
    kept.extend(passed.into_iter().take(missing));
    kept
}

/// Returns the unit vectors towards adjacent cells within a squared distance in cells.
fn directions(dimension: usize, reach: f64) -> Vec<[f64; 3]> {
    let place = |k: usize| [k % 3, k / 3 % 3, k / 9].map(|x| x as f64 - 1.0);
    let all = (0..27).map(place).filter_map(|offset| {
        let square: f64 = offset.iter().map(|x| x * x).sum();
        let is_flat = offset[dimension..].iter().all(|x| *x == 0.0);
        (is_flat && square > 0.0 && square <= reach).then(|| offset.map(|x| x / square.sqrt()))
    });
    all.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use pericles::space::Grid;

    /// Offsets, in cells, of the selected bonds of a point of a plate whose intact bonds are those for which `is_intact` holds.
    fn offsets(is_intact: impl Fn([i32; 2]) -> bool) -> Vec<[i32; 2]> {
        let cloud = Grid::plate([1.0, 1.0], 0.1, 1.0).points().unwrap();
        let all = (-3..=3).flat_map(|x: i32| (-3..=3).map(move |y: i32| [x, y]));
        let bonds =
            all.filter(|&[x, y]| [x, y] != [0, 0] && x * x + y * y <= 9 && is_intact([x, y]));
        let bonds = bonds.map(|[x, y]| Bond {
            neighbour: 0,
            xi: [0.1 * f64::from(x), 0.1 * f64::from(y), 0.0],
        });
        let cell = |x: f64| (10.0 * x).round() as i32;
        let chosen = chosen(&cloud, bonds.collect());
        let mut offsets: Vec<[i32; 2]> = chosen
            .iter()
            .map(|bond| [cell(bond.xi[0]), cell(bond.xi[1])])
            .collect();
        offsets.sort_unstable();
        offsets
    }

    #[test]
    fn springs_of_an_intact_lattice_connect_adjacent_cells() {
        let adjacent: Vec<[i32; 2]> = (-1..=1)
            .flat_map(|x| (-1..=1).map(move |y| [x, y]))
            .filter(|offset| *offset != [0, 0])
            .collect();
        assert_eq!(offsets(|_| true), adjacent);
    }

    #[test]
    fn springs_cross_a_crack_that_long_bonds_cross() {
        // Bonds to the next row above are broken, longer ones are intact.
        let chosen = offsets(|[_, y]| y != 1);
        assert_eq!(
            chosen.iter().filter(|[_, y]| *y > 1).count(),
            3,
            "{chosen:?}"
        );
        assert_eq!(chosen.len(), 8);
    }
}
