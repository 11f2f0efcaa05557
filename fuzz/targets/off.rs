#![no_main]
//! Surfaces from `.off` files.

pericles_fuzz::target!(|content: &[u8]| pericles_fuzz::surface("a.off", content));
