//! Data for publishing that several files repeat.

use std::fs;
use std::path::Path;

/// Files outside the workspace with the lines that repeat its version and its address.
const REPEATED: &[(&str, &[&str])] = &[
    (
        "CITATION.cff",
        &["version: VERSION", "repository-code: ADDRESS"],
    ),
    (
        "book/src/introduction.md",
        &["version = {VERSION},", "url = {ADDRESS}"],
    ),
    (
        "crates/pericles-mpi/Cargo.toml",
        &["version = \"VERSION\"", "repository = \"ADDRESS\""],
    ),
    (
        "packaging/conda/recipe.yaml",
        &[
            "version: VERSION",
            "homepage: ADDRESS",
            "repository: ADDRESS",
        ],
    ),
    ("pyproject.toml", &["Repository = \"ADDRESS\""]),
    ("python/Cargo.toml", &["version = \"VERSION\""]),
];

/// Returns a message for every missing line.
pub fn problems(root: &Path) -> Vec<String> {
    let read = |file: &str| {
        fs::read_to_string(root.join(file)).unwrap_or_else(|error| panic!("{file}: {error}"))
    };
    let manifest: toml::Table = read("Cargo.toml").parse().unwrap();
    let package = &manifest["workspace"]["package"];
    let (version, address) = (
        package["version"].as_str().unwrap(),
        package["repository"].as_str().unwrap(),
    );
    let mut problems = Vec::new();
    for (file, lines) in REPEATED {
        let text = read(file);
        for line in *lines {
            let line = line.replace("VERSION", version).replace("ADDRESS", address);
            if !text.lines().any(|found| found.trim() == line) {
                problems.push(format!(
                    "{file} has no line `{line}`, with the values of Cargo.toml"
                ));
            }
        }
    }
    for member in manifest["workspace"]["members"].as_array().unwrap() {
        let file = format!("{}/Cargo.toml", member.as_str().unwrap());
        if !read(&file).contains("repository.workspace = true") {
            problems.push(format!("{file} has no `repository.workspace = true`"));
        }
    }
    problems
}
