//! Correspondence materials: reference values, identities, bond failure and plastic flow.

mod anisotropy;
mod bodies;
mod divided;
mod fracture;
mod heat;
mod identities;
mod law;
mod plastic;
mod reference;
mod stress;
