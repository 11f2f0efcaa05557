//! Tests of contact and rigid bodies.

mod bonded;
mod impact;
mod reference;
mod runs;
mod setup;
