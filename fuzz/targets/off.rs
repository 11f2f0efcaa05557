#![no_main]
//! Surfaces from `.off` files.

libfuzzer_sys::fuzz_target!(|content: &[u8]| pericles_fuzz::surface("a.off", content));
