//! What breaks a rule today. Entries are removed, never added.

/// Cycles among sibling modules: the parent module, the modules, what must change.
pub const CYCLES: &[(&str, &str, &str)] = &[
    (
        "pericles",
        "accounts boundary system",
        "the ledger of energies takes values instead of loads, and a damping layer what it reads of a system",
    ),
    (
        "pericles",
        "material operator parallel",
        "vectors of lanes move out of the operator, below the materials; the choice of points moves to `parallel`",
    ),
    (
        "pericles::kernel",
        "influence moments",
        "moments take functions, or the types of influence move below both",
    ),
    (
        "pericles::material",
        "constants crack_planes lattice",
        "the description of a material moves out of `constants`, below the sums over a lattice",
    ),
    (
        "pericles::material",
        "law polynomial treatment",
        "`PairForce` moves out of `law`, below the laws",
    ),
    (
        "pericles::operator",
        "assemble grid",
        "`BondForm` moves out of `assemble`",
    ),
    (
        "pericles::operator",
        "floats floats_x86 lanes lanes_x86",
        "the choice of the instruction set moves out of `lanes`, above the implementations",
    ),
    (
        "pericles::operator::grid",
        "breaking kernels",
        "`Grid` moves out of `kernels`",
    ),
    (
        "pericles::operator::grid",
        "force zoned",
        "`Partners` moves out of `zoned`",
    ),
    (
        "pericles::operator::list",
        "breaking kernels",
        "`Bonds` moves out of `kernels`",
    ),
    (
        "pericles-cli",
        "args given new plot prepare report run summary sweep watch",
        "the life of a run moves into a library; commands hand plain values to it, not their arguments",
    ),
    (
        "pericles-cli",
        "console drawn error",
        "an error does not print itself",
    ),
    (
        "pericles-cli::reproduce::absorbing_boundaries",
        "figures tables",
        "the data of the seismic bar moves out of `tables`",
    ),
];

/// Source files that are too long, with their greatest length in lines.
pub const LONG_FILES: &[(&str, usize)] = &[
    ("crates/pericles/src/error.rs", 570),
    ("crates/pericles/src/simulation.rs", 539),
    ("crates/pericles/src/system.rs", 559),
    ("crates/pericles-cli/src/check.rs", 547),
];
