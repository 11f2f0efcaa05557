//! Embeds the files under `examples/` in the program for `pericles new`.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// Files that are not part of an example.
const LEFT_OUT: [&str; 2] = ["README.md", "expected.toml"];

fn main() -> io::Result<()> {
    let variable = |name| env::var_os(name).map(PathBuf::from).unwrap_or_default();
    let examples = variable("CARGO_MANIFEST_DIR").join("decks");
    println!("cargo::rerun-if-changed={}", examples.display());
    let mut table = String::from("&[\n");
    for topic in sorted(&examples)?.iter().filter(|path| path.is_dir()) {
        println!("cargo::rerun-if-changed={}", topic.display());
        for file in sorted(topic)?.iter().filter(|path| path.is_file()) {
            let name = name(file);
            if !LEFT_OUT.contains(&name) {
                let topic = self::name(topic);
                writeln!(table, "File {{ topic: {topic:?}, name: {name:?}, content: include_bytes!({file:?}) }},")
                    .map_err(io::Error::other)?;
            }
        }
    }
    table.push(']');
    fs::write(variable("OUT_DIR").join("examples.rs"), table)
}

fn sorted(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let mut paths = fs::read_dir(folder)?
        .map(|entry| Ok(entry?.path()))
        .collect::<io::Result<Vec<_>>>()?;
    paths.sort();
    Ok(paths)
}

fn name(path: &Path) -> &str {
    path.file_name()
        .and_then(|name| name.to_str())
        .unwrap_or_default()
}
