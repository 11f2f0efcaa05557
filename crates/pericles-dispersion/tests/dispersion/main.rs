//! All tests of the crate in one program, so that generic code is compiled once.

mod calibration;
#[path = "../../../pericles/tests/common/mod.rs"]
mod common;
mod frequency;
mod tuning;
mod waves;
