#![no_main]
//! Meshes from `.inp` files.

pericles_fuzz::target!(|content: &[u8]| pericles_fuzz::mesh("a.inp", content));
