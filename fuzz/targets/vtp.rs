#![no_main]
//! Surfaces from `.vtp` files.

pericles_fuzz::target!(|content: &[u8]| pericles_fuzz::surface("a.vtp", content));
