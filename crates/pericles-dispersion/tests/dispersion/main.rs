//! Tests of the crate in one program: what is generic is compiled once for all of them.

mod calibration;
#[path = "../../../pericles/tests/common/mod.rs"]
mod common;
mod frequency;
mod tuning;
mod waves;
