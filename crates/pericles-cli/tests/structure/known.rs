//! Known exceptions to the rules. Entries are removed, never added.

/// Cycles among sibling modules: parent module, modules, required change.
pub const CYCLES: &[(&str, &str, &str)] = &[];

/// Source files that are too long, with their maximum length in lines.
pub const LONG_FILES: &[(&str, usize)] = &[];
