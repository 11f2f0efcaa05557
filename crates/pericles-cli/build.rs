//! Embeds the files under `examples/` in the program for `pericles new`, and records the commit of the sources
//! (`PERICLES_SOURCE_COMMIT`) and the version with it (`PERICLES_VERSION`).

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
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
    fs::write(variable("OUT_DIR").join("examples.rs"), table)?;
    // A builder without Git names the commit itself.
    println!("cargo::rerun-if-env-changed=PERICLES_COMMIT");
    let mut version = env::var("CARGO_PKG_VERSION").unwrap_or_default();
    let named = env::var("PERICLES_COMMIT")
        .ok()
        .filter(|named| !named.is_empty());
    if let Some(commit) = named.or_else(commit) {
        println!("cargo::rustc-env=PERICLES_SOURCE_COMMIT={commit}");
        version = format!("{version} ({commit})");
    }
    println!("cargo::rustc-env=PERICLES_VERSION={version}");
    Ok(())
}

/// Returns the commit of the sources, with `-dirty` if they differ from it; `None` outside a checkout of Pericles, such
/// as an unpacked archive. A change of commit or of a source makes cargo run this script again. This package, the last
/// in the order of compilation, owns the script, so that no other one is compiled because of a commit.
fn commit() -> Option<String> {
    // An archive may be unpacked within another repository.
    if git(&["rev-parse", "--show-prefix"])? != "crates/pericles-cli/" {
        return None;
    }
    let commit = git(&["rev-parse", "HEAD"])?;
    for file in ["HEAD", "logs/HEAD"] {
        let path = git(&["rev-parse", "--git-path", file])?;
        if Path::new(&path).exists() {
            println!("cargo::rerun-if-changed={path}");
        }
    }
    println!("cargo::rerun-if-changed=../../Cargo.lock");
    for member in sorted(Path::new("..")).ok()? {
        for source in ["src", "Cargo.toml"].map(|name| member.join(name)) {
            if source.exists() {
                println!("cargo::rerun-if-changed={}", source.display());
            }
        }
    }
    let sources = [
        ":(top,glob)crates/*/src/**",
        ":(top,glob)crates/*/Cargo.toml",
        ":/Cargo.lock",
    ];
    let changed = git(&[["status", "--porcelain", "--"].as_slice(), &sources].concat())?;
    Some(if changed.is_empty() {
        commit
    } else {
        format!("{commit}-dirty")
    })
}

/// Returns the output of a Git command in the folder of this package; `None` if it fails or Git is missing.
fn git(arguments: &[&str]) -> Option<String> {
    let mut command = Command::new("git");
    let output = command
        .arg("--no-optional-locks")
        .args(arguments)
        .output()
        .ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
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
