//! Correspondence materials: reference values, identities, breaking and plastic flow.

mod bodies;
mod fracture;
mod identities;
mod law;
mod plastic;
mod reference;
