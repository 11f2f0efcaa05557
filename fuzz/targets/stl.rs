#![no_main]
//! Surfaces from `.stl` files.

libfuzzer_sys::fuzz_target!(|content: &[u8]| pericles_fuzz::surface("a.stl", content));
