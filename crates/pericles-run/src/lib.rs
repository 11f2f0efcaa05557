//! Runs as a library, from a deck or a model to an output folder.
//!
//! * [`discretise`] and [`assemble`] – from a [`Model`](pericles_deck::Model) to points and sets
//!   ([`Discretisation`]), and to the equation of motion with state, scheme and time step ([`Assembly`]); [`build`]
//!   does both for a deck, with [`Resources`].
//! * [`Source`] – the source of a run: a deck, or a [`Model`](pericles_deck::Model) built by a program. It is stored in
//!   `run.json` and checkpoints.
//! * [`Assembled`] – the assembly of a source with its properties ([`Facts`]), built with a cache and a memory limit
//!   ([`Means`]).
//! * [`Origin`] – the state of another run, from which a run [starts](Assembled::starting).
//! * [`Run`] – a run with its output folder: [`begin`](Run::begin), or [`resume`](Run::resume) from the last
//!   checkpoint, then [`drive`](Run::drive) with a callback for [`Event`]s, a [`Cancel`] token and a [`Deadline`]. It
//!   writes the output of the model, checkpoints, and [`Report`] as `run.json`.
//! * [`sequence`] – runs of several steps.
//! * [`Results`] – reads the results of a run from its folder.
//! * [`sweep`] – parameter sweeps; [`convergence`] – convergence studies.
//! * [`Vibration`] – natural modes of a body as table, fields and pictures.
//! * [`draw_sets`] – picture of the body at rest with its sets.
//! * [`refinement`] – net speed-up of multirate schemes; [`dispersion`] – files of the dispersion analysis of a
//!   lattice.
//!
//! This library does not print, read the command line or handle signals.
//!
//! ```no_run
//! use pericles_deck::Deck;
//! use pericles_io::OutputFolder;
//! use pericles_run::{Assembled, Cancel, Ending, Event, Means, Run, Source};
//!
//! let deck = Deck::read("plate.toml", &[])?;
//! let source = Source::of_deck(deck, "plate.toml".into());
//! // or, of a model: Source::of_model(model, Path::new("folder of its files"))
//!
//! // The folder is created after the model has been checked.
//! let assembled = Assembled::of(&source, &Means::default(), &mut |_| {})?;
//! let folder = OutputFolder::create("plate", false)?;
//! let mut run = Run::begin(&source, assembled, folder)?;
//!
//! let cancel = Cancel::new();
//! let ending = run.drive(None, &cancel, &mut |event| {
//!     if let Event::Step { step, t } = event {
//!         println!("step {step}, t = {t} s");
//!     }
//! })?;
//! assert_eq!(ending, Ending::Finished);
//! if let Some(audit) = &run.report().audit {
//!     println!("{} bonds broke", audit.broken_bonds);
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod animations;
mod assembled;
mod audit;
mod body_record;
mod build;
mod cancel;
mod checkpoint;
pub mod columns;
pub mod composition;
mod control;
pub mod convergence;
mod deadline;
mod deck_text;
pub mod diff;
pub mod dispersion;
pub mod division;
mod error;
mod event;
mod export;
mod extension;
mod facts;
pub mod fit;
mod heat;
mod inputs;
mod json;
pub mod machine;
mod mirror;
mod observers;
mod open_facts;
mod origin;
mod processes;
pub mod refinement;
mod report;
mod results;
mod run;
mod scalar;
pub mod sequence;
mod sets_picture;
mod sharing;
mod signals;
mod source;
mod static_balance;
mod strength;
pub mod sweep;
mod time_axis;
pub mod units;
mod vibration;
mod watch;

pub use assembled::{Assembled, Caching, Devices, Means, no_devices, readers};
pub use audit::Audit;
pub use build::{
    Assembly, BANDWIDTH, Conditions, Discretisation, ExactReference, FileError, Forecast, Grids,
    Interior, KernelQuality, LATENCY, LoadReport, MaterialConstants, MaterialSoftening, MeshBody,
    MeshReader, Meshes, OpenReport, OutlineReader, PlaneWaves, PointsReader, Polygons, Resources,
    Sets, Spread, SurfaceReader, TableReader, assemble, build, discretise,
};
pub use cancel::Cancel;
pub use deadline::Deadline;
pub use deck_text::DeckText;
pub use error::RunError;
pub use event::{Event, Tell};
pub use export::{ExportFormat, Exported, Selection, export};
pub use facts::{Fact, Facts, Line, Section};
pub use heat::{HeatBalance, Inflow};
pub use inputs::Inputs;
pub use json::write_json;
pub use mirror::MirrorError;
pub use observers::{KeptTable, body_shape, picture_of, recorded, result_body};
pub use origin::{InitialState, Origin};
pub use processes::shared_folder;
pub use report::{Report, Span, Status, set_commit};
pub use results::{FieldFile, Results, file_name};
pub use run::{Ending, Run};
pub use scalar::scalar;
pub use sets_picture::draw_sets;
pub use sharing::Sharing;
pub use signals::SignalRegistry;
pub use source::{ModelData, Source, SourceRecord};
pub use static_balance::StaticBalance;
pub use strength::SofteningFacts;
pub use time_axis::TimeAxis;
pub use vibration::Vibration;
