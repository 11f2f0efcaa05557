#![no_main]
//! Surfaces from `.ply` files.

libfuzzer_sys::fuzz_target!(|content: &[u8]| pericles_fuzz::surface("a.ply", content));
