//! What breaks a rule today. Entries are removed, never added.

/// Cycles among sibling modules: the parent module, the modules, what must change.
pub const CYCLES: &[(&str, &str, &str)] = &[];

/// Source files that are too long, with their greatest length in lines.
pub const LONG_FILES: &[(&str, usize)] = &[];
