#![no_main]
//! Surfaces from `.stl` files.

pericles_fuzz::target!(|content: &[u8]| pericles_fuzz::surface("a.stl", content));
