//! Correspondence materials: reference values, identities, breaking and plastic flow.

mod bodies;
mod fracture;
mod heat;
mod identities;
mod law;
mod plastic;
mod reference;
