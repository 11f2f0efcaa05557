#![no_main]
//! Surfaces from `.msh` files.

pericles_fuzz::target!(|content: &[u8]| pericles_fuzz::surface("a.msh", content));
