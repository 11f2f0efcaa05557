//! From a model to what can be run: [`discretise`] makes points and sets, [`assemble`] makes the equation of motion, the scheme and the
//! time step.
//!
//! ```
//! use pericles_deck::Deck;
//! use pericles_run::{Resources, assemble, discretise};
//!
//! let text = r#"
//!     [body]
//!     shape = "bar"
//!     length = "1 m"
//!     spacing = "1 cm"
//!     [material]
//!     density = "7850 kg/m3"
//!     youngs_modulus = "210 GPa"
//!     horizon_ratio = 3
//!     [sets.left]
//!     layer = { side = "-x", cells = 1 }
//!     [[initial]]
//!     set = "left"
//!     velocity = "1 m/s"
//!     [time]
//!     end = "1 ms"
//! "#;
//! let deck = Deck::parse(text, "bar.toml", &[]).unwrap();
//! let resources = Resources::default();
//! let mut points = discretise(&deck.model, &resources).unwrap();
//! assert_eq!(points.cloud.len(), 100);
//! // The set is chosen by the program from here on.
//! points.set_mut("left").unwrap().extend([1, 2, 3]);
//! let assembly = assemble(&deck.model, points, &resources).unwrap();
//! assert_eq!(assembly.state.v.iter().sum::<f64>(), 4.0);
//! let simulation = assembly.simulation();
//! ```

mod area;
mod assemble;
mod assembler;
mod assembly;
mod body;
mod boundary;
mod breaking;
mod conditions;
mod content;
mod damping;
mod discretisation;
mod discretise;
mod exact;
mod fields;
mod graded;
mod loads;
mod memory;
mod parts;
mod plausible;
mod points;
mod refusal;
mod resources;
mod scheme;
mod sense;
mod step;
mod stop;
mod surface;

pub use assemble::{assemble, build};
pub use assembly::Assembly;
pub use content::{Interior, KernelQuality, PlaneWaves};
pub use discretisation::{Discretisation, Grids, Sets};
pub use discretise::{body_points, discretise};
pub use exact::ExactReference;
pub use loads::LoadReport;
pub use resources::{FileError, PointsReader, Resources, SurfaceReader, TableReader};
