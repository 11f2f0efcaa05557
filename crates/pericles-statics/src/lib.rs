//! Static equilibrium, quasi-static fracture and natural modes of peridynamic bodies.
//!
//! The crate uses only what the engine, [`pericles`], exports.
