#![no_main]
//! Surfaces from `.msh` files.

libfuzzer_sys::fuzz_target!(|content: &[u8]| pericles_fuzz::surface("a.msh", content));
