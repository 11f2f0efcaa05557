#![no_main]
//! Surfaces from `.obj` files.

pericles_fuzz::target!(|content: &[u8]| pericles_fuzz::surface("a.obj", content));
