#![no_main]
//! Meshes from `.exo` files.

pericles_fuzz::target!(|content: &[u8]| pericles_fuzz::mesh("a.exo", content));
