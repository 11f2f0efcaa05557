//! Bodies whose points are nodes of a lattice, without storing them.

use std::sync::Arc;

use super::set::check_resolution;
use super::{Lattice, Point, PointCloud, PointSource};
use crate::domain::{Alone, Domain};
use crate::error::{PericlesError, Result, positive};

/// The body whose points are all or some nodes of a lattice. It stores none of them: the points of one of several processes
/// can be created without those of the others.
pub struct LatticeBody<'a> {
    dimension: usize,
    /// Position of node 0, m.
    origin: Point,
    /// The lattice without points.
    lattice: Lattice,
    section: f64,
    /// Whether a node is a point; `None` if all nodes are.
    holds: Option<Box<dyn Fn(u32) -> bool + Sync + 'a>>,
    is_periodic: bool,
}

impl<'a> LatticeBody<'a> {
    /// Makes the body of the nodes for which `holds` returns true, of all nodes if it is `None`. Node 0 is at `origin`, m; the
    /// points of `lattice` are ignored; `section` as in [`PointCloud::new`].
    ///
    /// # Errors
    /// No points; a spacing or section that is not positive; coordinates so large that double precision does not resolve the
    /// spacing.
    pub fn new(
        dimension: usize,
        origin: Point,
        lattice: Lattice,
        section: f64,
        holds: Option<Box<dyn Fn(u32) -> bool + Sync + 'a>>,
    ) -> Result<Self> {
        positive("the section (area in 1D, thickness in 2D)", section)?;
        for dx in lattice.spacing {
            positive("the spacing", dx)?;
        }
        let last = lattice.nodes().saturating_sub(1) as u32;
        for node in [0, last] {
            let corner = lattice.position(dimension, origin, node);
            check_resolution(&corner, lattice.size(dimension))?;
        }
        let body = Self {
            dimension,
            origin,
            lattice,
            section,
            holds,
            is_periodic: false,
        };
        let is_empty = body.nodes().next().is_none();
        match is_empty {
            true => Err(PericlesError::EmptyBody),
            false => Ok(body),
        }
    }

    /// Makes opposite faces periodic.
    ///
    /// # Errors
    /// Nodes that are not points.
    pub fn with_periodic_faces(self) -> Result<Self> {
        match self.count() == self.lattice.nodes() {
            true => Ok(Self {
                is_periodic: true,
                ..self
            }),
            false => Err(PericlesError::NotPeriodic),
        }
    }

    /// Creates all points, in the order of the nodes.
    pub fn points(&self) -> PointCloud {
        let nodes: Vec<u32> = self.nodes().collect();
        let domain = Domain::alone(nodes.len());
        self.at(nodes, domain)
    }

    fn nodes(&self) -> impl Iterator<Item = u32> {
        let holds = |&node: &u32| self.holds.as_ref().is_none_or(|holds| holds(node));
        (0..self.lattice.nodes() as u32).filter(holds)
    }

    fn at(&self, node: Vec<u32>, domain: Domain) -> PointCloud {
        let lattice = Lattice {
            node,
            ..self.lattice.clone()
        };
        PointCloud::at_nodes((self.dimension, self.origin), lattice, self.section, domain)
            .with_faces(self.is_periodic)
    }
}

impl PointSource for LatticeBody<'_> {
    fn count(&self) -> usize {
        match self.holds {
            None => self.lattice.nodes(),
            Some(_) => self.nodes().count(),
        }
    }

    fn points_where(&self, is_wanted: &mut dyn FnMut(u32, Point) -> bool) -> PointCloud {
        let position = |node| self.lattice.position(self.dimension, self.origin, node);
        let wanted = (0..)
            .zip(self.nodes())
            .filter(|&(number, node)| is_wanted(number, position(node)));
        let (numbers, nodes): (Vec<u32>, Vec<u32>) = wanted.unzip();
        let own = numbers.len();
        self.at(
            nodes,
            Domain::new(numbers, own, Vec::new(), Arc::new(Alone)),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{Grid, Region, Shape};

    #[test]
    fn parts_of_a_body_have_the_points_of_the_whole_one() {
        let ring = Grid {
            shape: Shape::Disc {
                centre: [1.0, 2.0, 0.0],
                radius: 1.0,
            },
            spacing: 0.1,
            section: 0.3,
            holes: vec![Region::Ball {
                centre: [1.0, 2.0, 0.0],
                radius: 0.4,
            }],
        };
        let body = ring.body().unwrap();
        let whole = body.points();
        assert_eq!(body.count(), whole.len());
        let mut seen = 0;
        for third in 0..3 {
            let part = body.points_where(&mut |number, place| {
                assert_eq!(place, whole.point(number as usize));
                number % 3 == third
            });
            let of_whole = whole.points_where(&mut |number, _| number % 3 == third);
            for k in 0..part.len() {
                let number = part.domain().number(k);
                assert_eq!(number, of_whole.domain().number(k));
                assert_eq!(number, part.user_number(k));
                assert_eq!(part.point(k), whole.point(number));
                assert_eq!(part.volumes()[k], whole.volumes()[number]);
            }
            assert_eq!(part.lattice(), of_whole.lattice());
            assert_eq!(part.spacing(), whole.spacing());
            seen += part.len();
        }
        assert_eq!(seen, whole.len());
        assert!(body.points_where(&mut |_, _| false).is_empty());
    }
}
