//! The program `pericles`.
fn main() {}
