//! Contact between points.
//!
//! A pair of points without an intact bond can touch. The contact distance is at most the distance in the reference
//! configuration, so that the force is zero when a bond breaks in tension, and no energy appears.
//!
//! The search is repeated when points have moved relative to each other by more than the skin; only rows of blocks in
//! which bonds broke change in between. Pieces that are far apart may approach each other without a new search until
//! then.
//!
//! The energy that dampers and friction dissipate is minus the mean of their forces at both ends of a step times the
//! relative displacement, which is the work that velocity Verlet does. The stored energy differs from this work in
//! the steps in which a contact begins or ends, by terms of order dt².

mod cells;
mod contact;
mod nearby;
mod ranges;
mod search;
mod span;

use std::sync::{Arc, Mutex, PoisonError};

use pericles::domain::Domain;
use pericles::operator::Force;
use pericles::space::PointCloud;
use pericles::{Configuration, PointScalar, Result};

use crate::bodies::{ContactBodies, Touching};
use crate::error::ContactError;
use crate::law::{ContactLaw, ContactPairs};
use contact::Work;
use search::Candidates;

/// Skin of the search relative to the mean size of the cells.
const SKIN: f64 = 0.3;

/// Contact between the points of a body: pieces that meet, fragments that collide, faces of cracks that close.
///
/// The law is [`ContactLaw`]. Each end of a pair computes its force from the same numbers, so that forces are
/// equal and opposite, and adds the pairs in ascending order, so that results do not depend on threads or on the search.
pub struct PointContact {
    touching: Touching,
    pieces: Pieces,
    skin: f64,
    list: Mutex<Listed>,
    /// Forces of dampers and friction at the last accepted state, N, component-major; empty without them.
    drag: Vec<f64>,
    /// Energy dissipated so far, J.
    dissipated: f64,
    /// Number of pairs in contact at the last accepted state.
    pairs: u64,
    /// Largest overlap at the last accepted state, relative to the contact distance.
    overlap: f64,
    work: Work,
}

/// Pieces of the own points.
#[derive(Debug, Clone)]
struct Pieces {
    /// Piece of each point, numbered from 0 without gaps in the whole body.
    of_point: Vec<u32>,
    /// Number of pieces of the whole body.
    count: usize,
}

/// The present candidates.
#[derive(Debug, Default)]
struct Listed {
    candidates: Option<Arc<Candidates>>,
    searches: u64,
}

/// Contacts and searches of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchReport {
    /// Number of pairs in contact at the last accepted state.
    pub pairs: u64,
    /// Number of pairs in the list of candidates.
    pub candidates: u64,
    /// Number of searches since the object was made.
    pub searches: u64,
    /// Largest overlap at the last accepted state, relative to the contact distance.
    pub overlap: f64,
}

impl PointContact {
    /// Makes the contact between the points of a body. If they are divided among processes, all of them must call it together.
    ///
    /// # Errors
    /// The errors of [`ContactLaw::check`]; numbers of points that are not positive or not one per point.
    pub fn new(cloud: Arc<PointCloud>, law: ContactLaw, bodies: ContactBodies) -> Result<Self> {
        let touching = Touching::new(cloud, law, bodies)?;
        let entries = match law.is_conservative() {
            true => 0,
            false => touching.cloud.dimension() * touching.cloud.len(),
        };
        Ok(Self {
            pieces: Pieces::of(&touching.bodies.piece, touching.cloud.domain()),
            skin: SKIN * mean_size(&touching),
            touching,
            list: Mutex::default(),
            drag: vec![0.0; entries],
            dissipated: 0.0,
            pairs: 0,
            overlap: 0.0,
            work: Work::default(),
        })
    }

    /// Sets the skin of the search relative to the mean size of the cells; 0.3 by default. Results do not depend on it:
    /// with a larger skin searches are rarer, and each evaluation looks at more pairs. All processes must call it together.
    #[must_use]
    pub fn with_skin(mut self, relative: f64) -> Self {
        self.skin = relative * mean_size(&self.touching);
        self.list = Mutex::default();
        self
    }

    /// Sets the sizes of the points (m) that enter the contact distance, in place of the sizes of their cells.
    ///
    /// # Errors
    /// Sizes that are not positive, or not one per point.
    pub fn with_sizes(mut self, sizes: &PointScalar) -> Result<Self> {
        self.touching.set_sizes(sizes)?;
        self.list = Mutex::default();
        Ok(self)
    }

    /// Returns contacts and searches. All processes must call it together.
    pub fn report(&self) -> SearchReport {
        let list = self.list.lock().unwrap_or_else(PoisonError::into_inner);
        let (entries, searches) = match &list.candidates {
            Some(candidates) => (candidates.entries(), list.searches),
            None => (0, list.searches),
        };
        // Not held while this process waits for others.
        drop(list);
        SearchReport {
            pairs: self.pairs,
            candidates: self.touching.cloud.domain().count(entries) / 2,
            searches,
            overlap: self.overlap,
        }
    }

    /// Returns the pairs that may touch at a configuration, from the last search if it still contains them on all processes,
    /// which must call it together.
    fn candidates(&self, at: &Configuration<'_>) -> Arc<Candidates> {
        let lock = || self.list.lock().unwrap_or_else(PoisonError::into_inner);
        // Not held during parallel loops, in which other work may wait for other locks.
        let kept = lock().candidates.take();
        let mut searched = 0;
        let domain = self.touching.cloud.domain();
        let mut candidates = match kept.filter(|list| list.contains_contacts(at.u, domain)) {
            Some(candidates) => candidates,
            None => {
                searched = 1;
                let (touching, pieces) = (&self.touching, &self.pieces);
                Arc::new(Candidates::search(
                    touching, pieces, at.u, self.skin, at.forces,
                ))
            }
        };
        if candidates.is_behind(&self.touching, at.forces) {
            Arc::make_mut(&mut candidates).follow_breaks(&self.touching, at.forces);
        }
        let mut list = lock();
        list.searches += searched;
        list.candidates = Some(candidates.clone());
        candidates
    }

    fn check_bonds(&self, forces: &dyn Force) -> Result<()> {
        let unknown = forces.capabilities().breaking.is_none();
        if self.touching.law.pairs == ContactPairs::Unbonded && unknown {
            return Err(ContactError::NotPossible {
                reason: "this form of the force does not list its bonds, which decide which points may touch; use contact \
                         between pieces, or a force kernel with a list or a stencil",
            }
            .into());
        }
        Ok(())
    }
}

impl Pieces {
    /// Numbers the pieces of the points. All processes must call it together.
    fn of(piece: &[u32], domain: &Domain) -> Self {
        let own = distinct(piece.to_vec());
        let all = domain.collect_everywhere(own.into_iter().map(f64::from).collect());
        let known = distinct(all.concat().into_iter().map(|p| p as u32).collect());
        let number = |p: &u32| known.partition_point(|q| q < p) as u32;
        Self {
            of_point: piece.iter().map(number).collect(),
            count: known.len(),
        }
    }
}

fn distinct(mut numbers: Vec<u32>) -> Vec<u32> {
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}

/// Returns the mean size of the cells of the whole body, m. All processes must call it together.
fn mean_size(touching: &Touching) -> f64 {
    let (sizes, domain) = (&touching.size, touching.cloud.domain());
    domain.sum(sizes.len(), |i| sizes[i]) / domain.whole_points().max(1) as f64
}
