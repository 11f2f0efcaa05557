//! Observers that write files: what a run leaves behind.
//!
//! | observer | files | content |
//! |---|---|---|
//! | [`FieldSeries`] | `fields.pvd`, `fields/fields_000000.vtu` … | all fields on the points |
//! | [`ResultFile`] | `fields.exo`, `fields.vtkhdf` | the same in one file |
//! | [`History`] | `history.csv` | energies and their balance, momentum, broken bonds; where there are such, the distance from a known solution, a bound of the energy, inner iterations |
//! | [`Reactions`] | `reactions.csv` | forces of supports |
//! | [`ForceDisplacement`] | `force_displacement.csv`, `force_displacement.png` | displacements and forces of supports at static states |
//! | [`Cracks`] | `cracks.csv` | crack tips |
//! | [`FragmentCourse`] | `fragments.csv` | pieces that bonds hold together |
//! | [`Probes`] | `probes.csv` | displacement and velocity at chosen places |
//! | [`SurfaceCourse`] | `surface.csv` | stretch of a surface, energy bound, concentrations of energy |
//! | [`Pictures`] | `pictures/Damage-000000.png` …, `pictures/Damage.apng` | a field as a picture, and all of them as an animation |
//!
//! What they write depends on the states they are shown alone: no clock, path or number of threads enters a file. Each remembers in a checkpoint how
//! much it has written ([`Saved`](pericles::Saved)); restored, it cuts its files back to that and goes on, so that the files of a stopped and resumed
//! run equal those of an uninterrupted one byte for byte. Rows reach the system as they are written, and the disk before a checkpoint does.
//!
//! Errors of files travel through the simulation as boxed [`IoError`](crate::IoError).
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
//! use pericles_io::observers::History;
//!
//! let shape = Shape::Box { origin: [0.0; 3], size: vec![1.0] };
//! let bar = Grid { shape, spacing: 0.1, section: 1.0, holes: vec![] };
//! let cloud = Arc::new(bar.points()?);
//! let bonds = BondList::new(&cloud, 0.3, VolumeCorrection::Extended)?;
//! let never = Breaking { critical_stretch: f64::INFINITY, no_fail: &[] };
//! let force = BondForce::<BondStretch, 1>::with_stiffness(cloud.clone(), bonds, &|_| 20.0, never, DamageMeasure::default())?;
//! let system = System::new(cloud, Box::new(force), PointScalar::Uniform(1.0))?;
//! let mut state = State::at_rest(10);
//! state.v[0] = 0.01;
//!
//! let folder = tempfile::tempdir()?;
//! let path = folder.path().join("history.csv");
//! let mut simulation = Simulation::new(system, Box::new(VelocityVerlet), state, 0.05, 100)?;
//! simulation.observe(Schedule::Every(10), Box::new(History::new(&path, 1)));
//! simulation.run(|_| pericles::Control::Continue)?;
//! assert_eq!(pericles_io::read_csv(&path)?.rows(), 11);
//! # Ok(())
//! # }
//! ```

mod background;
mod columns;
mod cracks;
mod fields;
mod force_displacement;
mod fragments;
mod history;
mod pictures;
mod probes;
mod reactions;
mod result_file;
mod surface;
mod table;

pub use columns::{EnergyBoundColumns, ErrorColumns, ExtremeColumns, HistoryColumns, InnerColumns};
pub use cracks::Cracks;
pub use fields::{FieldSeries, MeshCells};
pub use force_displacement::ForceDisplacement;
pub use fragments::FragmentCourse;
pub use history::History;
pub use pictures::{DrawnState, PictureOf, Pictures};
pub use probes::Probes;
pub use reactions::Reactions;
pub use result_file::{ResultFile, ResultFormat};
pub use surface::SurfaceCourse;

#[cfg(test)]
mod tests;
