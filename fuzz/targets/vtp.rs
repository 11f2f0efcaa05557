#![no_main]
//! Surfaces from `.vtp` files.

libfuzzer_sys::fuzz_target!(|content: &[u8]| pericles_fuzz::surface("a.vtp", content));
