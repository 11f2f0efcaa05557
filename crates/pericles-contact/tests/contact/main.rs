//! Tests of contact and rigid bodies.

mod bonded;
mod disc;
mod divided;
mod impact;
mod reference;
mod runs;
mod setup;
