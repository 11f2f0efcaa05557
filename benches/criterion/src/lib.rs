//! Nothing but benchmarks: see `operators.rs`, `linear.rs` and `output.rs`.
