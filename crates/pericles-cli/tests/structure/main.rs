//! The structure of the workspace, from its sources: dependencies between crates, cycles among modules, lengths of
//! files.
//!
//! Known exceptions are listed in `known`. An entry that no longer applies fails its test.

mod book;
mod graph;
mod known;
mod phrases;
mod publishing;
mod source;
mod syntax;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use graph::Cycle;
use source::Source;

/// Maximum length of a source file, in lines.
const LONGEST_FILE: usize = 500;

/// The crates of the workspace with their allowed dependencies within the workspace. A crate comes after its
/// dependencies.
const CRATES: &[(&str, &[&str])] = &[
    ("pericles", &[]),
    ("pericles-waves", &["pericles"]),
    ("pericles-manifold", &["pericles"]),
    ("pericles-bench", &["pericles", "pericles-manifold"]),
    ("pericles-dispersion", &["pericles", "pericles-waves"]),
    ("pericles-mesh", &[]),
    ("pericles-solids", &["pericles"]),
    ("pericles-contact", &["pericles"]),
    ("pericles-gpu", &["pericles"]),
    ("pericles-mpi", &["pericles"]),
    ("pericles-statics", &["pericles"]),
    ("pericles-heat", &["pericles", "pericles-statics"]),
    ("pericles-deck-derive", &[]),
    (
        "pericles-deck",
        &[
            "pericles-deck-derive",
            "pericles",
            "pericles-waves",
            "pericles-manifold",
            "pericles-dispersion",
            "pericles-solids",
            "pericles-contact",
        ],
    ),
    (
        "pericles-io",
        &[
            "pericles",
            "pericles-waves",
            "pericles-manifold",
            "pericles-dispersion",
            "pericles-mesh",
            "pericles-contact",
        ],
    ),
    (
        "pericles-import",
        &["pericles", "pericles-deck", "pericles-io"],
    ),
    (
        "pericles-run",
        &[
            "pericles",
            "pericles-waves",
            "pericles-manifold",
            "pericles-dispersion",
            "pericles-mesh",
            "pericles-solids",
            "pericles-contact",
            "pericles-statics",
            "pericles-heat",
            "pericles-deck",
            "pericles-io",
        ],
    ),
    (
        "pericles-studies",
        &[
            "pericles",
            "pericles-waves",
            "pericles-manifold",
            "pericles-dispersion",
            "pericles-mesh",
            "pericles-solids",
            "pericles-contact",
            "pericles-statics",
            "pericles-heat",
            "pericles-deck",
            "pericles-io",
            "pericles-run",
        ],
    ),
    (
        "pericles-cli",
        &[
            "pericles",
            "pericles-bench",
            "pericles-waves",
            "pericles-manifold",
            "pericles-dispersion",
            "pericles-mesh",
            "pericles-solids",
            "pericles-contact",
            "pericles-gpu",
            "pericles-mpi",
            "pericles-statics",
            "pericles-heat",
            "pericles-deck",
            "pericles-io",
            "pericles-import",
            "pericles-run",
            "pericles-studies",
        ],
    ),
];

fn crates_folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("the crate is in the folder of all crates")
        .to_path_buf()
}

/// Returns the names of the crates of the workspace in alphabetical order.
fn crates() -> Vec<String> {
    let entries = fs::read_dir(crates_folder()).expect("the folder of all crates is readable");
    let mut names: Vec<String> = entries
        .map(|entry| entry.expect("an entry is readable").path())
        .filter(|path| path.join("Cargo.toml").is_file())
        .map(|path| {
            path.file_name()
                .expect("a folder has a name")
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    names.sort();
    names
}

/// Returns the crates with their source files.
static SOURCES: LazyLock<Vec<(String, Vec<Source>)>> = LazyLock::new(|| {
    let read = |name: String| {
        let sources = Source::of_crate(&crates_folder().join(&name).join("src"));
        (name, sources)
    };
    crates().into_iter().map(read).collect()
});

fn fail_on(problems: &[String]) {
    assert!(problems.is_empty(), "\n{}\n", problems.join("\n"));
}

#[test]
fn crates_depend_on_one_another_in_one_direction() {
    let mut problems = Vec::new();
    for (position, (name, allowed)) in CRATES.iter().enumerate() {
        for dependency in *allowed {
            if !CRATES[..position]
                .iter()
                .any(|(earlier, _)| earlier == dependency)
            {
                problems.push(format!(
                    "the table lists {name} before its dependency {dependency}"
                ));
            }
        }
    }
    for name in crates() {
        let Some(position) = CRATES.iter().position(|(known, _)| *known == name) else {
            problems.push(format!(
                "crates/{name} is not in the table of allowed dependencies"
            ));
            continue;
        };
        let manifest = fs::read_to_string(crates_folder().join(&name).join("Cargo.toml"))
            .expect("a manifest is readable");
        for (section, dependency) in source::dependencies(&manifest) {
            let Some(other) = CRATES.iter().position(|(known, _)| *known == dependency) else {
                continue;
            };
            // Tests of a crate may use any crate before it in the table; its code only the allowed ones.
            let allowed = match section.as_str() {
                "dev-dependencies" => other < position,
                _ => CRATES[position].1.contains(&dependency.as_str()),
            };
            if !allowed {
                problems.push(format!("crates/{name}/Cargo.toml, [{section}]: {dependency} is not an allowed dependency"));
            }
        }
    }
    fail_on(&problems);
}

#[test]
fn modules_have_no_cycles_among_siblings() {
    let mut known: BTreeMap<(String, BTreeSet<String>), &str> = known::CYCLES
        .iter()
        .map(|(parent, modules, change)| {
            (
                (
                    (*parent).to_owned(),
                    modules.split_whitespace().map(str::to_owned).collect(),
                ),
                *change,
            )
        })
        .collect();
    let mut problems = Vec::new();
    for (name, sources) in SOURCES.iter() {
        for cycle in graph::cycles(name, sources) {
            let Cycle {
                parent, modules, ..
            } = &cycle;
            if known.remove(&(parent.clone(), modules.clone())).is_none() {
                problems.push(cycle.to_string());
            }
        }
    }
    for ((parent, modules), change) in known {
        let modules: Vec<String> = modules.into_iter().collect();
        problems.push(format!(
            "{parent}: the listed cycle of {} no longer exists ({change}): remove it from the list, or list what is left of it",
            modules.join(", ")
        ));
    }
    fail_on(&problems);
}

#[test]
fn source_files_are_short() {
    let mut known: BTreeMap<&str, usize> = known::LONG_FILES.iter().copied().collect();
    let mut problems = Vec::new();
    for (name, sources) in SOURCES.iter() {
        for source in sources {
            let file = format!("crates/{name}/src/{}", source.file);
            match known.remove(file.as_str()) {
                Some(bound) if source.lines > bound => {
                    problems.push(format!(
                        "{file} has grown from {bound} to {} lines",
                        source.lines
                    ));
                }
                Some(_) if source.lines <= LONGEST_FILE => {
                    problems.push(format!(
                        "{file} has {} lines only: remove it from the list",
                        source.lines
                    ));
                }
                None if source.lines > LONGEST_FILE => {
                    problems.push(format!(
                        "{file} has {} lines; at most {LONGEST_FILE} are allowed",
                        source.lines
                    ));
                }
                _ => {}
            }
        }
    }
    problems.extend(
        known
            .keys()
            .map(|file| format!("{file} no longer exists: remove it from the list")),
    );
    fail_on(&problems);
}

#[test]
fn texts_use_the_terms_of_the_glossary() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let found = phrases::found(&root);
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn version_and_address_are_those_of_the_workspace() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    fail_on(&publishing::problems(&root));
}
