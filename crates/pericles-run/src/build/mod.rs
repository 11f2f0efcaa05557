//! Assembly of models: [`discretise`] creates points and sets, [`assemble`] the equation of motion, the scheme and
//! the time step.

mod area;
mod assemble;
mod assembler;
mod assembly;
mod balance;
mod body;
mod boundary;
mod breaking;
mod conditions;
mod conduction;
mod constants;
mod contact;
mod content;
mod correspondence;
mod cracks;
mod damping;
mod discretisation;
mod discretise;
mod enclosure;
mod exact;
mod faces;
mod fields;
mod filled;
mod filled_graded;
mod forecast;
mod graded;
mod loads;
mod materials;
mod memory;
mod mesh;
mod mesh_body;
mod open;
mod output;
mod part;
mod pieces;
mod plausible;
mod plausible_heat;
mod points;
mod program;
mod random;
mod rejection;
mod resources;
mod rotation;
mod scheme;
mod sense;
mod softening;
mod solids;
mod state_based;
mod statics;
mod step;
mod stop;
mod surface;
mod thermal;
mod thin;

pub use assemble::{assemble, build};
pub use assembly::Assembly;
pub use constants::MaterialConstants;
pub use content::{Interior, KernelQuality, PlaneWaves};
pub(crate) use discretisation::is_on_grid;
pub use discretisation::{Discretisation, Grids, Sets};
pub use discretise::discretise;
pub use exact::ExactReference;
pub use forecast::{BANDWIDTH, Forecast, LATENCY, Spread};
pub use loads::LoadReport;
pub use mesh_body::{MeshBody, Meshes};
pub use open::OpenReport;
pub(crate) use part::gathered;
pub use program::Conditions;
pub use resources::{
    FileError, MeshReader, OutlineReader, PointsReader, Polygons, Resources, SurfaceReader,
    TableReader,
};
pub use softening::MaterialSoftening;
pub(crate) use step::whole_steps;
