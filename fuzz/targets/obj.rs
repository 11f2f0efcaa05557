#![no_main]
//! Surfaces from `.obj` files.

libfuzzer_sys::fuzz_target!(|content: &[u8]| pericles_fuzz::surface("a.obj", content));
