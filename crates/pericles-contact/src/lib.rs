//! Contact and impact of peridynamic bodies.
//!
//! * [`PointContact`] – points that touch each other: different pieces, fragments, faces of a crack.
//! * [`Impactor`] – rigid bodies with a prescribed or a free motion that touch the points.
//!
//! Both are [interactions](pericles::Interaction) of a system. A contact is a spring that acts in compression only,
//! with the potential Φ = F g/(p + 1) of the overlap g, so that the energy balance contains it
//! ([`ContactLaw`]). Dampers and friction are optional, and the energy that they dissipate is known exactly.
//!
//! The crate uses only public items of the engine, [`pericles`].

mod bodies;
mod error;
mod impactor;
mod law;
mod points;
mod vector;

pub use bodies::ContactBodies;
pub use error::ContactError;
pub use impactor::{
    ClosedMesh, Impactor, ImpactorMotion, Inertia, MassProperties, Pose, Reading, Shape,
};
pub use law::{ContactLaw, ContactPairs, ContactStiffness, Friction, PairLaw, usual_overlap};
pub use points::{PointContact, SearchReport};
