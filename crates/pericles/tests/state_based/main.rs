//! Tests of state-based materials.

mod bodies;
#[path = "../common/mod.rs"]
mod common;
mod constants;
mod criterion;
mod fracture;
mod ghosts;
mod identities;
mod reference;
mod schemes;
mod speed;
mod stencil;
mod surface;
mod twin;
