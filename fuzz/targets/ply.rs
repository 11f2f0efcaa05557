#![no_main]
//! Surfaces from `.ply` files.

pericles_fuzz::target!(|content: &[u8]| pericles_fuzz::surface("a.ply", content));
