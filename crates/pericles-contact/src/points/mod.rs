//! Contact between points.

mod cells;
mod contact;
mod ranges;
mod search;

use std::sync::{Arc, Mutex, PoisonError};

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
/// The law is that of [`ContactLaw`]. Each end of a pair computes its force from the same numbers, so that forces are
/// equal and opposite, and adds the pairs in ascending order, so that results do not depend on threads or on the search.
pub struct PointContact {
    touching: Touching,
    /// Pieces numbered from 0 without gaps.
    pieces: Vec<u32>,
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
    /// Makes the contact between the points of a body.
    ///
    /// # Errors
    /// Those of [`ContactLaw::check`]; numbers of points that are not positive or not one per point.
    pub fn new(cloud: Arc<PointCloud>, law: ContactLaw, bodies: ContactBodies) -> Result<Self> {
        let touching = Touching::new(cloud, law, bodies)?;
        let entries = match law.is_conservative() {
            true => 0,
            false => touching.cloud.dimension() * touching.cloud.len(),
        };
        let sizes = &touching.size;
        let mean = sizes.iter().sum::<f64>() / sizes.len().max(1) as f64;
        Ok(Self {
            pieces: renumbered(&touching.bodies.piece),
            skin: SKIN * mean,
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
    /// with a larger skin searches are rarer, and each evaluation looks at more pairs.
    #[must_use]
    pub fn with_skin(mut self, relative: f64) -> Self {
        let sizes = &self.touching.size;
        self.skin = relative * sizes.iter().sum::<f64>() / sizes.len().max(1) as f64;
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

    /// Returns contacts and searches.
    pub fn report(&self) -> SearchReport {
        let list = self.list.lock().unwrap_or_else(PoisonError::into_inner);
        SearchReport {
            pairs: self.pairs,
            candidates: list.candidates.as_ref().map_or(0, |list| list.pairs()),
            searches: list.searches,
            overlap: self.overlap,
        }
    }

    /// Returns the pairs that may touch at a configuration, from the last search if it still contains them.
    fn candidates(&self, at: &Configuration<'_>) -> Arc<Candidates> {
        let lock = || self.list.lock().unwrap_or_else(PoisonError::into_inner);
        // Not held during parallel loops, in which other work may wait for other locks.
        let kept = lock().candidates.take();
        let mut searched = 0;
        let mut candidates = match kept.filter(|list| list.contains_contacts(at.u)) {
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
        if self.touching.cloud.domain().is_divided() {
            return Err(ContactError::NotPossible {
                reason: "contact between points is implemented for a single process",
            }
            .into());
        }
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

/// Returns the pieces numbered from 0 without gaps.
fn renumbered(piece: &[u32]) -> Vec<u32> {
    let mut known = piece.to_vec();
    known.sort_unstable();
    known.dedup();
    let number = |p: &u32| known.partition_point(|q| q < p) as u32;
    piece.iter().map(number).collect()
}
