//! Assembly of a deck or model with a cache, a memory limit, and readers of input files.
//!
//! Readers of files are passed to the code that builds a body, so that `pericles-deck` accesses no files.

use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

use pericles::DeviceError;
use pericles::PericlesError;
use pericles::cache::{Cache, NoCache};
use pericles::domain::{Alone, Comm};
use pericles::time::Device;
use pericles_deck::{BuildError, DeviceKind, Fault, Model, Processor};
use pericles_io::{
    DiskCache, IoError, MeshError, TextError, read_mesh, read_outline, read_points, read_rows,
    read_surface,
};

use crate::build::{Assembly, FileError, Resources, assemble, discretise};
use crate::error::RunError;
use crate::event::{Event, Tell};
use crate::facts::Facts;
use crate::machine;
use crate::origin::InitialState;
use crate::source::Source;

/// Cache, memory limit and processes for building and running a model.
#[derive(Clone)]
pub struct Means {
    /// Where expensive results are cached.
    pub caching: Caching,
    /// Memory limit, bytes.
    pub memory: u64,
    /// Communication with the processes among which the body is divided.
    pub comm: Arc<dyn Comm>,
    /// Opens graphics processors; `None` in programs without them.
    pub devices: Option<Arc<dyn Devices>>,
    /// The processor of the steps, if it is not that of the deck.
    pub processor: Option<Processor>,
}

/// Opens processors other than that of the machine.
pub trait Devices: Send + Sync {
    /// Opens the processor that a deck or user wants, whose kind is not [`DeviceKind::Cpu`].
    ///
    /// # Errors
    /// [`DeviceError`], as an extension error.
    fn open(&self, wanted: Processor) -> Result<Arc<dyn Device>, PericlesError>;
}

impl fmt::Debug for Means {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            caching,
            memory,
            comm,
            devices: _,
            processor,
        } = self;
        let (rank, size) = (comm.rank(), comm.size());
        write!(
            f,
            "{caching:?}, {memory} bytes, process {rank} of {size}, {processor:?}"
        )
    }
}

impl Default for Means {
    /// The user's cache, the available memory, and a single process.
    fn default() -> Self {
        Self {
            caching: Caching::User,
            memory: machine::memory(),
            comm: Arc::new(Alone),
            devices: None,
            processor: None,
        }
    }
}

/// Where expensive results, such as kernels and geodesic distances, are cached between runs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Caching {
    /// The user's cache folder, if there is one.
    User,
    /// A given folder.
    Folder(PathBuf),
    /// No cache.
    Off,
}

impl Caching {
    /// Returns the cache; `None` if it is off or the user has no cache folder.
    fn cache(&self) -> Option<DiskCache> {
        match self {
            Self::User => DiskCache::of_user(),
            Self::Folder(folder) => Some(DiskCache::new(folder)),
            Self::Off => None,
        }
    }
}

/// Returns the error of a program without graphics processors.
pub fn no_devices() -> PericlesError {
    let reason = "this program was built without graphics processors; build it with `cargo build --release -p pericles-cli --features gpu`, or use the device \"cpu\"";
    DeviceError::Missing(reason.into()).into()
}

/// An assembled model with its properties before the first step.
pub struct Assembled {
    /// The assembly.
    pub assembly: Assembly,
    /// Its properties.
    pub facts: Facts,
}

impl Assembled {
    /// Discretises and assembles the model of a source. Expensive results are read from the cache if available.
    ///
    /// # Errors
    /// The deck or model is invalid.
    pub fn of(source: &Source, means: &Means, tell: Tell<'_>) -> Result<Self, RunError> {
        Self::starting(source, InitialState::Model, means, tell)
    }

    /// Assembles the model of a source with an initial state; as [`Assembled::of`] otherwise.
    ///
    /// # Errors
    /// The deck or model is invalid, or the state belongs to another body.
    pub fn starting(
        source: &Source,
        start: InitialState<'_>,
        means: &Means,
        tell: Tell<'_>,
    ) -> Result<Self, RunError> {
        let model = source.model();
        Self::made(source, means, tell, |resources| {
            let resources = Resources {
                start,
                ..*resources
            };
            assemble(model, discretise(model, &resources)?, &resources)
        })
    }

    /// Assembles the model of a source by `make`, for programs that change or replace its points, sets and conditions;
    /// as [`Assembled::of`] otherwise. The resources have the cache, the memory limit, the readers of files, and the
    /// folder of the source.
    ///
    /// # Errors
    /// The errors of `make`, with locations in the text of a deck.
    pub fn made(
        source: &Source,
        means: &Means,
        tell: Tell<'_>,
        make: impl FnOnce(&Resources<'_>) -> Result<Assembly, BuildError>,
    ) -> Result<Self, RunError> {
        let model = source.model();
        let assembly = means.with_resources(tell, |resources| {
            make(&Resources {
                folder: source.folder(),
                ..*resources
            })
        });
        let mut assembly = assembly.map_err(|error| match is_elsewhere(&error) {
            true => PericlesError::OnAnotherProcess.into(),
            false => source.rejection(error),
        })?;
        means.place(model, &mut assembly)?;
        let facts = match source {
            Source::Deck { deck, .. } => Facts::of_deck(deck, &assembly),
            Source::Model(_) => Facts::of(model, &assembly),
        };
        Ok(Self { assembly, facts })
    }
}

/// Returns whether another process has found an error of the model.
fn is_elsewhere(error: &BuildError) -> bool {
    let problems = error.problems().iter();
    let mut faults = problems.map(|problem| problem.subject());
    faults.any(|fault| matches!(fault, Fault::Model(PericlesError::OnAnotherProcess)))
}

impl Means {
    /// Lets the processor that the deck or the user wants compute the steps.
    fn place(&self, model: &Model, assembly: &mut Assembly) -> Result<(), PericlesError> {
        let wanted = self.processor.unwrap_or(model.run);
        if wanted.device == DeviceKind::Cpu {
            return Ok(());
        }
        let Some(devices) = &self.devices else {
            return Err(no_devices());
        };
        let device = devices.open(wanted)?;
        let Assembly {
            system,
            integrator,
            dt,
            ..
        } = assembly;
        let (scheme, plan) = device.prepare(system, &**integrator, *dt)?;
        *integrator = scheme;
        assembly.device = Some(plan);
        Ok(())
    }

    /// Calls `make` with the resources, and reports the notes of the cache.
    fn with_resources<T>(&self, tell: Tell<'_>, make: impl FnOnce(&Resources<'_>) -> T) -> T {
        let cache = self.caching.cache();
        let cache = cache.map(|cache| cache.within(self.memory));
        let made = make(&Resources {
            cache: cache.as_ref().map_or(&NoCache as &dyn Cache, |cache| cache),
            memory: self.memory,
            comm: Some(&self.comm),
            ..readers()
        });
        for note in cache.iter().flat_map(DiskCache::notes) {
            tell(Event::CacheNote(&note.to_string()));
        }
        made
    }
}

/// Returns the readers of input files.
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
