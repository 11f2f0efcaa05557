//! Thermal expansion of bond-based and state-based bodies.

#[path = "../state_based/bodies.rs"]
mod bodies;
mod forces;
mod runs;
mod setup;
