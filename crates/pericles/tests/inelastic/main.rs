//! Tests of linear peridynamic solids whose shear is viscous or plastic.

#[path = "../state_based/bodies.rs"]
#[allow(dead_code)] // a part of it is used here
mod bodies;
mod forces;
mod paths;
mod reference;
mod runs;
mod setup;
