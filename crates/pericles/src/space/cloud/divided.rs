//! The points of one of several processes, and the points of the whole body.

use std::borrow::Cow;

use super::PointCloud;
use crate::domain::{Domain, Replicated};
use crate::space::{Lattice, Point};

impl PointCloud {
    /// Makes these points the part of one of several processes; `spacing` belongs to the whole body, m.
    ///
    /// # Panics
    /// If the domain owns another number of points than the cloud has.
    #[must_use]
    pub fn with_domain(self, domain: Domain, spacing: f64) -> Self {
        assert_eq!(
            domain.owned_points(),
            self.len(),
            "one volume per own point"
        );
        Self {
            domain,
            spacing,
            ..self
        }
    }

    /// Returns the part of this body that a process owns, by the numbers of its points.
    ///
    /// # Panics
    /// If a number is not a point of this body.
    #[must_use]
    pub fn part(&self, domain: Domain) -> Self {
        let own: Vec<usize> = (0..domain.owned_points())
            .map(|k| domain.number(k))
            .collect();
        let axis = |c: usize| own.iter().map(move |&k| self.axis(c)[k]);
        let lattice = self.lattice.as_ref().map(|lattice| Lattice {
            node: own.iter().map(|&k| lattice.node[k]).collect(),
            ..lattice.clone()
        });
        let numbers = |numbers: &Vec<u32>| match numbers.is_empty() {
            true => Vec::new(),
            false => own.iter().map(|&k| numbers[k]).collect(),
        };
        Self {
            positions: (0..self.dimension).flat_map(axis).collect(),
            volumes: own.iter().map(|&k| self.volumes[k]).collect(),
            lattice,
            user_numbers: own.iter().map(|&k| self.user_number(k) as u32).collect(),
            blocks: numbers(&self.blocks),
            pieces: numbers(&self.pieces),
            domain,
            ..*self
        }
    }

    /// Returns the ghosts of a domain (of the cloud, or another one with the same own points) as points of a single process.
    /// All processes must call it together.
    #[must_use]
    pub(in crate::space) fn ghosts_of(&self, domain: &Domain) -> Self {
        let numbers = |own: &[u32]| -> Vec<u32> {
            let own: Vec<f64> = own.iter().map(|&number| f64::from(number)).collect();
            domain.ghosts(&own).iter().map(|&k| k as u32).collect()
        };
        let lattice = self.lattice.as_ref().map(|lattice| Lattice {
            node: numbers(&lattice.node),
            ..lattice.clone()
        });
        Self {
            positions: domain.ghosts(&self.positions),
            volumes: domain.ghosts(&self.volumes),
            lattice,
            // Arrays are empty on all processes or on none.
            pieces: numbers(&self.pieces),
            user_numbers: Vec::new(),
            blocks: Vec::new(),
            domain: Domain::alone(domain.ghost_points()),
            ..*self
        }
    }

    /// Returns own points, then ghosts, as points of a single process.
    #[must_use]
    pub(in crate::space) fn with_ghosts(&self, ghosts: &Self) -> Self {
        let axis = |c: usize| self.axis(c).iter().chain(ghosts.axis(c)).copied();
        let lattice = self.lattice.iter().zip(&ghosts.lattice);
        let mut lattice = lattice.map(|(own, ghosts)| Lattice {
            node: [&own.node[..], &ghosts.node].concat(),
            ..own.clone()
        });
        Self {
            positions: (0..self.dimension).flat_map(axis).collect(),
            volumes: [&self.volumes[..], &ghosts.volumes].concat(),
            lattice: lattice.next(),
            pieces: [&self.pieces[..], &ghosts.pieces].concat(),
            user_numbers: Vec::new(),
            blocks: Vec::new(),
            domain: Domain::alone(self.len() + ghosts.len()),
            ..*self
        }
    }

    /// Returns own points and the ghosts of a domain (of the cloud, or another one with the same own points) as points of a
    /// single process. All processes must call it together.
    #[must_use]
    pub fn with_ghosts_of(&self, domain: &Domain) -> Self {
        self.with_ghosts(&self.ghosts_of(domain))
    }

    /// Returns the points of the whole body as points of a single process, from the parts of all processes. Its memory does
    /// not decrease with their number. All processes must call it together.
    pub fn whole(&self) -> Cow<'_, Self> {
        if !self.domain.is_divided() {
            return Cow::Borrowed(self);
        }
        let all = Replicated::new(&self.domain);
        let whole = |numbers: &[u32]| -> Vec<u32> {
            let numbers: Vec<f64> = numbers.iter().map(|&k| f64::from(k)).collect();
            all.of(&numbers).iter().map(|&k| k as u32).collect()
        };
        // Arrays are empty on all processes or on none.
        let lattice = self.lattice.as_ref().map(|lattice| Lattice {
            node: whole(&lattice.node),
            ..lattice.clone()
        });
        Cow::Owned(Self {
            positions: all.of(&self.positions).into_owned(),
            volumes: all.of(&self.volumes).into_owned(),
            lattice,
            user_numbers: whole(&self.user_numbers),
            blocks: whole(&self.blocks),
            pieces: whole(&self.pieces),
            domain: Domain::alone(all.points()),
            ..*self
        })
    }

    /// Returns the points of the whole body on the first process, as points of a single process; `None` on the others. All
    /// processes must call it together.
    pub fn gathered(&self) -> Option<Cow<'_, Self>> {
        if !self.domain.is_divided() {
            return Some(Cow::Borrowed(self));
        }
        let gather = |own: &[f64]| self.domain.gather(own).map(Cow::into_owned);
        let gather_numbers = |own: &[u32]| -> Option<Vec<u32>> {
            let own: Vec<f64> = own.iter().map(|&k| f64::from(k)).collect();
            Some(gather(&own)?.iter().map(|&k| k as u32).collect())
        };
        // All processes take part in all messages.
        let positions = gather(&self.positions);
        let volumes = gather(&self.volumes);
        let nodes = self.lattice.as_ref().map(|one| gather_numbers(&one.node));
        let [user_numbers, blocks, pieces] =
            [&self.user_numbers, &self.blocks, &self.pieces].map(|own| gather_numbers(own));
        let (positions, volumes) = (positions?, volumes?);
        let lattice = self.lattice.as_ref().zip(nodes.flatten());
        Some(Cow::Owned(Self {
            domain: Domain::alone(volumes.len()),
            positions,
            volumes,
            lattice: lattice.map(|(lattice, node)| Lattice {
                node,
                ..lattice.clone()
            }),
            user_numbers: user_numbers?,
            blocks: blocks?,
            pieces: pieces?,
            ..*self
        }))
    }

    /// Returns the least and largest coordinate c of the points of the whole body, m. All processes must call it together.
    pub fn extent(&self, c: usize) -> [f64; 2] {
        let mut ends = [f64::NEG_INFINITY; 2];
        for &x in self.axis(c) {
            ends = [ends[0].max(-x), ends[1].max(x)];
        }
        self.domain.max_each(&mut ends);
        [-ends[0], ends[1]]
    }

    /// Bounding box of the cells of the whole body, m; see [`PointCloud::bounds`]. All processes must call it together.
    pub fn body_bounds(&self) -> [Point; 2] {
        let [low, high] = self.bounds();
        let mut ends = [low.map(|x| -x), high].concat();
        self.domain.max_each(&mut ends);
        let end = |k: usize| std::array::from_fn(|c| ends[3 * k + c]);
        [end(0).map(|x: f64| -x), end(1)]
    }

    /// Returns the point of the whole body nearest to a position (m) if this process owns it, the first of several, and its
    /// distance, m. All processes must call it together.
    pub fn nearest_of_all(&self, place: Point) -> (Option<u32>, f64) {
        let own = self.nearest(place);
        let found = self.point(own);
        let square: f64 = (0..3).map(|c| (found[c] - place[c]).powi(2)).sum();
        let mut least = [-square];
        self.domain.max_each(&mut least);
        let number = self.domain.number(own) as f64;
        let mut first = [match least[0] == -square {
            true => -number,
            false => f64::NEG_INFINITY,
        }];
        self.domain.max_each(&mut first);
        let is_own = first[0] == -number;
        (is_own.then_some(own as u32), (-least[0]).sqrt())
    }

    /// Returns the position of the point with the lowest number in the whole body of the points that the processes pass, if any
    /// passes one. All processes must call it together.
    pub fn first_of_all(&self, own: Option<usize>) -> Option<Point> {
        let measure = own.map_or(f64::NEG_INFINITY, |k| -(self.domain.number(k) as f64));
        let place = own.map_or([0.0; 3], |k| self.point(k));
        let [number, x, y, z] =
            (self.domain).of_largest(measure, [measure, place[0], place[1], place[2]]);
        (number > f64::NEG_INFINITY).then_some([x, y, z])
    }
}
