//! From a deck to its model, with the means that a machine has: a cache, memory, readers of files beside the deck.

use std::path::PathBuf;

use pericles::cache::{Cache, NoCache};
use pericles_deck::{Deck, FileError, Model, Resources};
use pericles_io::{
    DiskCache, IoError, MeshError, PointsError, RowsError, read_points, read_rows, read_surface,
};

use crate::error::RunError;
use crate::event::{Event, Tell};
use crate::facts::Facts;
use crate::machine;

/// What a model may be made with.
#[derive(Debug, Clone)]
pub struct Means {
    /// Where results that take long to compute are kept.
    pub caching: Caching,
    /// Memory, bytes.
    pub memory: u64,
}

impl Default for Means {
    /// The user's cache, and the memory that the machine has free.
    fn default() -> Self {
        Self {
            caching: Caching::User,
            memory: machine::memory(),
        }
    }
}

/// Where results that take long to compute, such as kernels and distances, are kept from run to run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Caching {
    /// In the user's cache folder; nowhere if the user has none.
    User,
    /// In this folder.
    Folder(PathBuf),
    /// Nowhere: everything is computed anew.
    Off,
}

impl Caching {
    /// The cache; none if it is off or the user has no place for one.
    fn cache(&self) -> Option<DiskCache> {
        match self {
            Self::User => DiskCache::of_user(),
            Self::Folder(folder) => Some(DiskCache::new(folder)),
            Self::Off => None,
        }
    }
}

/// The model of a deck, with what is known of it before the first step.
pub struct Modelled {
    /// The model.
    pub model: Model,
    /// The facts about it.
    pub facts: Facts,
}

impl Modelled {
    /// Builds the model; what takes long to compute comes from the cache if it is there.
    ///
    /// # Errors
    /// A deck that is refused.
    pub fn of(deck: &Deck, means: &Means, tell: Tell<'_>) -> Result<Self, RunError> {
        let cache = means.caching.cache();
        let cache = cache.map(|cache| cache.within(means.memory));
        let model = deck.build_with(Resources {
            cache: cache.as_ref().map_or(&NoCache as &dyn Cache, |cache| cache),
            memory: means.memory,
            ..readers()
        });
        for note in cache.iter().flat_map(DiskCache::notes) {
            tell(Event::CacheNote(&note.to_string()));
        }
        let model = model?;
        let facts = Facts::of(deck, &model);
        Ok(Self { model, facts })
    }
}

/// What files beside a deck are read with.
pub fn readers() -> Resources<'static> {
    Resources {
        cache: &NoCache,
        read_surface: &|path, memory| {
            read_surface(path, memory).map_err(|error| match &error {
                MeshError::Io(IoError::TooLarge { .. }) => FileError::TooLarge(error.to_string()),
                _ => FileError::Wrong(error.to_string()),
            })
        },
        read_points: &|path, dimension, memory| {
            read_points(path, dimension, memory).map_err(|error| match &error {
                PointsError::Io(IoError::TooLarge { .. }) => FileError::TooLarge(error.to_string()),
                _ => FileError::Wrong(error.to_string()),
            })
        },
        read_table: &|path, rows, columns, memory| {
            read_rows(path, rows, columns, memory).map_err(|error| match &error {
                RowsError::Io(IoError::TooLarge { .. }) => FileError::TooLarge(error.to_string()),
                _ => FileError::Wrong(error.to_string()),
            })
        },
        ..Resources::default()
    }
}
