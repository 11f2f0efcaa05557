//! Tests of linear peridynamic solids with viscous or plastic shear.

#[path = "../../../pericles/tests/state_based/bodies.rs"]
#[allow(dead_code)] // only a part of it is used here
mod bodies;
mod criterion;
mod divided;
mod forces;
mod paths;
mod reference;
mod runs;
mod setup;
