//! Tests of state-based materials.

mod bodies;
#[path = "../common/mod.rs"]
mod common;
mod constants;
mod fracture;
mod identities;
mod reference;
mod twin;
