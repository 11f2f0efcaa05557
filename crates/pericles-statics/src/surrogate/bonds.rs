//! Neighbours of points in the surrogate.

use pericles::System;
use pericles::domain::Field;
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
    /// Selects neighbours from the intact bonds of a body.
    pub fn of(system: &System) -> Self {
        let cloud = system.cloud();
        let n = system.points();
        let force = system.operator();
        let chosen: Vec<Vec<Bond>> = match force.as_bonds() {
            Some(view) => {
                let rest = vec![0.0; n * system.dimension()];
                for_each_point(n, &|i| {
                    let mut all = Vec::new();
                    view.for_each_bond(Field::new(&rest, &[]), i, &mut |bond| {
                        // Ghosts belong to other processes, which have their own surrogates.
                        let in_body = bond.neighbour < n && !bond.to_ghost;
                        if in_body && bond.neighbour != i {
                            all.push(Bond {
                                neighbour: bond.neighbour as u32,
                                xi: bond.xi,
                            });
                        }
                    });
                    chosen(cloud, all)
                })
            }
            None => {
                /// Search radius in spacings for forces without a view of their bonds.
                const REACH: f64 = 2.5;
                let (start, neighbours) = pairs_within(cloud, REACH * cloud.spacing());
                for_each_point(n, &|i| {
                    let near = neighbours[start[i]..start[i + 1]].iter();
                    let all = near.filter(|&&j| j as usize != i).map(|&j| {
                        let (here, there) = (cloud.point(i), cloud.point(j as usize));
                        Bond {
                            neighbour: j,
                            xi: std::array::from_fn(|c| there[c] - here[c]),
                        }
                    });
                    chosen(cloud, all.collect())
                })
            }
        };
        let mut symmetric = Self::symmetric(chosen);
        symmetric.find_periods(cloud);
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

/// Returns whether two bonds to the same point are equal to round-off.
fn is_same(a: &Bond, b: &Bond) -> bool {
    let apart: f64 = (0..3).map(|c| (a.xi[c] - b.xi[c]).powi(2)).sum();
    apart < 1e-6 * a.length_squared()
}

/// Selects the bonds of a point: on a lattice those to adjacent cells, in space without corners; for other
/// clouds the nearest ones; in any case enough to make the stiffness regular.
fn chosen(cloud: &PointCloud, mut all: Vec<Bond>) -> Vec<Bond> {
    let d = cloud.dimension();
    all.sort_by(|a, b| {
        let by_length = a.length_squared().total_cmp(&b.length_squared());
        by_length.then_with(|| a.neighbour.cmp(&b.neighbour))
    });
    // Squared distances in cells: 1.5² and 1.45².
    let reach = if d == 3 { 2.1025 } else { 2.25 };
    let nearest = [3, 12, 18][d - 1];
    let wanted = match cloud.cell_sides() {
        Some(sides) => {
            let cells = |bond: &Bond| (0..d).map(|c| (bond.xi[c] / sides[c]).powi(2)).sum::<f64>();
            // By distance in cells, so that bonds within reach come first.
            all.sort_by(|a, b| cells(a).total_cmp(&cells(b)));
            all.partition_point(|bond| cells(bond) <= reach)
        }
        None => nearest,
    };
    all.truncate(wanted.max(2 * d));
    all
}
