//! From a deck or a model to its assembly, with the means that a machine has: a cache, memory, readers of files beside the deck.

use std::path::PathBuf;

use pericles::cache::{Cache, NoCache};
use pericles_io::{
    DiskCache, IoError, MeshError, TextError, read_mesh, read_outline, read_points, read_rows,
    read_surface,
};

use crate::build::{Assembly, FileError, Resources, assemble, discretise};
use crate::error::RunError;
use crate::event::{Event, Tell};
use crate::facts::Facts;
use crate::machine;
use crate::source::Source;

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

/// An assembled model, with what is known of it before the first step.
pub struct Assembled {
    /// The assembly.
    pub assembly: Assembly,
    /// The facts about it.
    pub facts: Facts,
}

impl Assembled {
    /// Discretises and assembles the model of a source. Results that take long to compute are read from the cache if it has them.
    ///
    /// # Errors
    /// A deck or model that is refused.
    pub fn of(source: &Source, means: &Means, tell: Tell<'_>) -> Result<Self, RunError> {
        let model = source.model();
        let assembly = means.with_resources(tell, |resources| {
            let resources = Resources {
                folder: source.folder(),
                ..*resources
            };
            let discretisation = discretise(model, &resources)?;
            assemble(model, discretisation, &resources)
        });
        let assembly = assembly.map_err(|error| source.refusal(error))?;
        let facts = match source {
            Source::Deck { deck, .. } => Facts::of_deck(deck, &assembly),
            Source::Model(_) => Facts::of(model, &assembly),
        };
        Ok(Self { assembly, facts })
    }
}

impl Means {
    /// Makes something with the resources, and tells what the cache notes.
    fn with_resources<T>(&self, tell: Tell<'_>, make: impl FnOnce(&Resources<'_>) -> T) -> T {
        let cache = self.caching.cache();
        let cache = cache.map(|cache| cache.within(self.memory));
        let made = make(&Resources {
            cache: cache.as_ref().map_or(&NoCache as &dyn Cache, |cache| cache),
            memory: self.memory,
            ..readers()
        });
        for note in cache.iter().flat_map(DiskCache::notes) {
            tell(Event::CacheNote(&note.to_string()));
        }
        made
    }
}

/// What files beside a deck are read with.
pub fn readers() -> Resources<'static> {
    Resources {
        cache: &NoCache,
        read_surface: &|path, memory| read_surface(path, memory).map_err(mesh_fault),
        read_points: &|path, dimension, memory| {
            read_points(path, dimension, memory).map_err(text_fault)
        },
        read_mesh: &|path, memory| read_mesh(path, memory).map_err(mesh_fault),
        read_outline: &|path, memory| read_outline(path, memory).map_err(text_fault),
        read_table: &|path, rows, columns, memory| {
            read_rows(path, rows, columns, memory).map_err(text_fault)
        },
        ..Resources::default()
    }
}

fn mesh_fault(error: MeshError) -> FileError {
    match &error {
        MeshError::Io(IoError::TooLarge { .. }) => FileError::TooLarge(error.to_string()),
        _ => FileError::Wrong(error.to_string()),
    }
}

fn text_fault(error: TextError) -> FileError {
    match &error {
        TextError::Io(IoError::TooLarge { .. }) => FileError::TooLarge(error.to_string()),
        _ => FileError::Wrong(error.to_string()),
    }
}
