//! Pericles decks: reads TOML decks into checked models.
//!
//! A deck is one TOML file. [`Deck::read`] converts it to a [`Model`]: plain data in SI units, which
//! `pericles-run` discretises, assembles and runs. Reading is strict: unknown keys, wrong units, vectors of
//! the wrong length and undefined set names are errors that report file, line, column and what is allowed;
//! all errors are reported at once. Errors found later, while the model is discretised and assembled, are a
//! [`BuildError`] that names keys; [`Deck::rejection`] adds their locations in the text.
//!
//! ```
//! use pericles_deck::Deck;
//!
//! let text = r#"
//!     [body]
//!     shape = "bar"
//!     length = "1 m"
//!     spacing = "1 cm"
//!     area = "4 cm2"
//!     [material]
//!     density = "7850 kg/m3"
//!     youngs_modulus = "210 GPa"
//!     horizon_ratio = 3
//!     [time]
//!     end = "1 ms"
//! "#;
//! let deck = Deck::parse(text, "bar.toml", &[]).unwrap();
//! assert_eq!(deck.model.body.solid().unwrap().shape.section(), 4e-4);
//!
//! // The same deck with another horizon and a typo.
//! let changes = ["material.m=4".to_owned(), "time.ende=1".to_owned()];
//! let error = Deck::parse(text, "bar.toml", &changes).unwrap_err();
//! let message = error.to_string();
//! assert!(message.starts_with("--set time.ende:1:6: unknown key `ende` in [time]; did you mean `end`?"));
//! ```
//!
//! # Format
//! A deck has tables:
//! ```toml
//! title = "A crack branches"
//!
//! [body]                                 # a shape on a grid, listed points, or a surface
//! shape = "plate"
//! size = ["100 mm", "40 mm"]
//! spacing = "0.25 mm"
//! plane = "strain"
//!
//! [material]
//! density = "2440 kg/m3"
//! youngs_modulus = "72 GPa"
//! horizon_ratio = 3                      # or horizon = "0.75 mm"
//! fracture_energy = "135 J/m2"
//!
//! [sets.top]                             # named sets of points: a region, a condition or blocks; "all" always exists
//! layer = { side = "+y", cells = 1 }
//! [sets.bottom]
//! layer = { side = "-y", cells = 1 }
//!
//! [[crack]]                              # cuts bonds before the run
//! segment = [["0 mm", "20 mm"], ["50 mm", "20 mm"]]
//!
//! [[load]]                               # beside it [[initial]], [[constraint]] and [[boundary]]
//! set = "top"
//! traction = [0, "12 MPa"]
//! [[load]]
//! set = "bottom"
//! traction = [0, "-12 MPa"]
//!
//! [time]
//! end = "46 us"                          # dt is the largest stable step, the scheme velocity Verlet
//!
//! [output]
//! fields = { count = 20 }
//! ```
//! [`reference()`] lists all keys with their units, ranges and defaults (`pericles schema --markdown`, the page
//! "Deck" of the book); so does [`json_schema`]. Both are generated from the reader.
//!
#![doc = include_str!("language.md")]

mod activation;
mod anisotropy;
mod assign;
mod body;
mod boundary;
mod caution;
mod check;
mod component;
mod conditions;
mod constants;
mod contact;
mod correspondence;
mod course;
mod crack;
mod criterion;
mod damping;
mod deck;
mod declaration;
mod dimension;
mod document;
mod error;
mod exact;
mod expression;
mod fault;
mod finding;
mod form;
mod impactor;
mod influence;
mod inheritance;
mod interface;
mod key_path;
mod material;
mod model;
mod nearest;
mod newmark;
mod output;
mod overrides;
mod parse;
mod processor;
mod property;
mod quantity;
mod range;
mod reader;
mod region;
mod remark;
mod schema;
mod scheme;
mod scope;
mod set;
mod source;
mod state_based;
mod statics;
mod step;
mod stop;
mod subject;
mod surface;
mod thermal;
mod time;
mod units;
mod vocabulary;
mod wording;
mod words;

pub use activation::{Activation, ActivationStart};
pub use anisotropy::Anisotropy;
pub use assign::Assignment;
pub use body::{
    Boundary, FilledCells, FilledShape, Lattice, MeshFile, Piece, PointsFile, Positions,
    Quadrature, Rotation, SolidShape, SurfaceFile, SurfaceFormula, SurfaceShape, VertexAreas,
    length_unit, piece_path,
};
pub use boundary::BoundaryCondition;
pub use caution::{AreaCaution, Caution, ContactCaution};
pub use component::{Component, VectorField};
pub use conditions::{Constraint, Initial, Load, LoadAmplitude, Probe, ProbePlace, RandomVelocity};
pub use contact::{Contact, ContactFriction, ContactLaw, ContactPairs, ContactStiffness};
pub use correspondence::Correspondence;
pub use course::{Course, TimeHistory};
pub use crack::{CrackSurface, PreCrack};
pub use criterion::FailureCriterion;
pub use damping::Damping;
pub use deck::Deck;
pub use error::DeckError;
pub use exact::{Exact, KnownSolution, Pulse};
pub use expression::{BondExpression, Condition, Expression, SignalCondition, SignalExpression};
pub use fault::Fault;
pub use finding::{Finding, Problem, Warning};
pub use impactor::{Impactor, ImpactorInertia, ImpactorMotion, ImpactorShape};
pub use interface::{InterfaceFailure, MaterialInterface};
pub use key_path::KeyPath;
pub use material::{
    BondSoftening, FailureSurface, Material, MaterialModel, NamedMaterial, Scatter,
    ScatteredStrength,
};
pub use model::{Body, Model, Solid};
pub use output::{
    Checkpoint, CrackOutput, DerivedQuantity, FieldBlocks, FieldFormat, FieldNames, FieldOutput,
    FragmentOutput, HistoryOutput, Output, Picture, PictureColours, PictureFormat, PictureLook,
    PointNumber, Precision, Profile,
};
pub use processor::{DeviceKind, DevicePrecision, Processor};
pub use property::{
    MaterialFunction, MaterialFunctions, MaterialProperty, Property, PropertyFunction,
};
pub use quantity::{in_unit, is_quantity, metres, seconds, si_unit};
pub use region::Depth;
pub use remark::{BuildError, Keys, ModelProblem, ModelWarning, Remark};
pub use schema::{json_schema, reference, specimens, unit_of_key};
pub use scheme::{FineRegion, FineStep, Interface, RelaxationLimits, Scheme};
pub use set::{ALL, Members, NamedSet, NearFaces};
pub use source::{Location, is_invisible};
pub use state_based::StateBased;
pub use statics::{LoadControl, RigidModes, StaticBreaking, Statics};
pub use stop::{StopCondition, StopWhen};
pub use subject::Subject;
pub use surface::{Geodesics, SurfaceBody, SurfaceMaterial, SurfaceModel};
pub use thermal::{
    Conduction, ConductionScheme, ConductivityMean, MaterialThermal, Thermal, ThermalAmplitude,
    ThermalCondition,
};
pub use time::{Time, TimeStep};
pub use wording::{shortened, spot};
