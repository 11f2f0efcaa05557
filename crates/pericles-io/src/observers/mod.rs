//! Observers that write the output files of a run.
//!
//! | observer | files | content |
//! |---|---|---|
//! | [`FieldSeries`] | `fields.pvd`, `fields/fields_000000.vtu` … | all fields on the points |
//! | [`ResultFile`] | `fields.exo`, `fields.vtkhdf` | all fields on the points, in one file |
//! | [`History`] | `history.csv` | energies and their balance, momentum, broken bonds; if available, errors against an exact solution, an energy bound, inner iterations |
//! | [`SignalTable`] | `probes.csv` | displacement and velocity at probe positions |
//! | | `reactions.csv` | forces of supports |
//! | | `impactors.csv` | place, motion and contact of impactors |
//! | | `quantities.csv` | quantities derived from other scalars |
//! | [`ForceDisplacement`] | `force_displacement.csv`, `force_displacement.png` | displacements and forces of supports at static states |
//! | [`Cracks`] | `cracks.csv` | crack tips |
//! | [`FragmentCourse`] | `fragments.csv` | pieces connected by intact bonds |
//! | [`SurfaceCourse`] | `surface.csv` | stretch of a surface, energy bound, localisation of energy |
//! | [`Profile`] | `profile_<name>.csv`, `profile_<name>.png` | a field along a straight line at the end of a run, with a known solution if there is one |
//! | [`Pictures`] | `pictures/Damage-000000.png` …, `pictures/Damage.apng` | pictures of a field and their animation |
//!
//! The content depends only on the observed states: not on the clock, path or number of threads. Each
//! observer records in a checkpoint how much it has written ([`Checkpointed`](pericles::Checkpointed)); after a restore it
//! truncates its files to that length and continues, so that the files of a stopped and resumed run equal
//! those of an uninterrupted one byte for byte. Rows are flushed to the operating system when they are
//! written, and synced to disk before a checkpoint.
//!
//! File errors pass through the simulation as boxed [`IoError`](crate::IoError).
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use std::sync::Arc;
//! use pericles::family::{BondList, VolumeCorrection};
//! use pericles::material::BondStretch;
//! use pericles::observe::Schedule;
//! use pericles::operator::{BondForce, Breaking, DamageMeasure};
//! use pericles::space::{Grid, Shape};
//! use pericles::time::{State, VelocityVerlet};
//! use pericles::{PointScalar, Simulation, System};
//! use pericles_io::observers::{History, HistoryRows};
//!
//! let shape = Shape::Box { origin: [0.0; 3], size: vec![1.0] };
//! let bar = Grid { shape, spacing: 0.1, section: 1.0, holes: vec![] };
//! let cloud = Arc::new(bar.points()?);
//! let bonds = BondList::new(&cloud, 0.3, VolumeCorrection::Extended)?;
//! let never = Breaking { critical_stretch: f64::INFINITY, no_fail: &[] };
//! let force = BondForce::<BondStretch, 1>::with_stiffness(cloud.clone(), bonds, &|_| 20.0, never, DamageMeasure::default())?;
//! let rows = HistoryRows::new(&cloud);
//! let system = System::new(cloud, Box::new(force), PointScalar::Uniform(1.0))?;
//! let mut state = State::at_rest(10);
//! state.v[0] = 0.01;
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("history.csv");
//! let mut simulation = Simulation::new(system, Box::new(VelocityVerlet), state, 0.05, 100)?;
//! simulation.observe(Schedule::Every(10), Box::new(History::new(&path, rows)));
//! simulation.run(|_| pericles::Control::Continue)?;
//! assert_eq!(pericles_io::read_csv(&path)?.rows(), 11);
//! # Ok(())
//! # }
//! ```

mod background;
mod body_shape;
mod cell_mesh;
mod columns;
mod cracks;
mod drawn_cells;
mod field_columns;
mod fields;
mod force_displacement;
mod fragments;
mod history;
mod impactors;
mod motion;
mod overlay;
mod picture_of;
mod pictures;
mod profile;
mod result_file;
mod rigid;
mod signals;
mod surface;
mod table;

pub use body_shape::{BodyShape, DrawnShape};
pub use cell_mesh::CellMesh;
pub use columns::{
    EnergyBoundColumns, ErrorColumns, ExtremeColumns, HistoryColumns, InnerColumns,
    LoadFactorColumn,
};
pub use cracks::{CrackSignals, Cracks};
pub use drawn_cells::CellArrays;
pub use field_columns::{FieldSelection, PointMark};
pub use fields::FieldSeries;
pub use force_displacement::ForceDisplacement;
pub use fragments::FragmentCourse;
pub use history::{History, HistoryRows};
pub use impactors::{ContactColumns, ImpactorSignals, ImpactorSurfaces};
pub use overlay::CarriedLine;
pub use picture_of::{DrawnState, PictureOf, leave_out_inactive};
pub use pictures::Pictures;
pub use profile::{Profile, Reference, profile_chart};
pub use result_file::{RecordedFields, ResultFile, ResultFormat};
pub use rigid::{RigidMesh, impactors};
pub use signals::{EnergySignals, ProbeSignals, ReactionSignals, SignalTable, Signals, TimeSignal};
pub use surface::SurfaceCourse;
pub use table::TableTarget;

#[cfg(test)]
mod tests;
