//! The files of a crate as modules.

use std::fs;
use std::path::Path;

use crate::syntax::{self, Import};

/// One source file.
pub struct Source {
    /// The file, relative to the folder of the crate's sources.
    pub file: String,
    /// The module, as the names below the crate's root.
    pub module: Vec<String>,
    /// Modules that the file declares outside of tests.
    pub declares: Vec<String>,
    pub imports: Vec<Import>,
    pub lines: usize,
}

impl Source {
    /// Reads the file `file`, relative to the folder of the crate's sources, from its text.
    pub fn new(file: &str, text: &str) -> Self {
        let mut module: Vec<String> = file
            .trim_end_matches(".rs")
            .split('/')
            .map(str::to_owned)
            .collect();
        if matches!(
            module.last().map(String::as_str),
            Some("mod" | "lib" | "main")
        ) {
            module.pop();
        }
        let tokens = syntax::tokens(text);
        let mut imports = syntax::imports(&tokens);
        // A single name comes from a `use` declaration, which is counted itself, or from a glob.
        if !imports.iter().any(Import::is_glob) {
            imports.retain(|import| import.name.is_some() || import.path.len() > 1);
        }
        Self {
            file: file.to_owned(),
            module,
            declares: syntax::declared_modules(&tokens),
            imports,
            lines: text.lines().count(),
        }
    }

    /// Reads all files of the folder `src`.
    pub fn of_crate(src: &Path) -> Vec<Self> {
        let mut sources = Vec::new();
        read(src, "", &mut sources);
        sources
    }
}

fn read(folder: &Path, prefix: &str, sources: &mut Vec<Source>) {
    let entries = fs::read_dir(folder).expect("a folder of sources is readable");
    let mut paths: Vec<_> = entries
        .map(|entry| entry.expect("an entry is readable").path())
        .collect();
    paths.sort();
    for path in paths {
        let name = path
            .file_name()
            .expect("an entry has a name")
            .to_string_lossy()
            .into_owned();
        if path.is_dir() {
            read(&path, &format!("{prefix}{name}/"), sources);
        } else if name.ends_with(".rs") {
            let text = fs::read_to_string(&path).expect("a source file is readable");
            sources.push(Source::new(&format!("{prefix}{name}"), &text));
        }
    }
}

/// Returns the dependencies in a manifest, each with its section.
pub fn dependencies(manifest: &str) -> Vec<(String, String)> {
    let mut section = String::new();
    let mut found = Vec::new();
    for line in manifest.lines().map(str::trim) {
        if let Some(name) = line.strip_prefix('[') {
            section = name.trim_end_matches(']').to_owned();
            if let Some((kind, name)) = section.clone().rsplit_once("dependencies.") {
                found.push((format!("{kind}dependencies"), name.to_owned()));
            }
        } else if section.ends_with("dependencies")
            && !line.starts_with('#')
            && let Some((key, _)) = line.split_once('=')
        {
            let name = key.trim().split('.').next().unwrap_or_default();
            found.push((section.clone(), name.trim_matches('"').to_owned()));
        }
    }
    found
}

#[test]
fn dependencies_are_read_from_a_manifest() {
    let manifest = "[package]\nname = \"x\"\n[dependencies]\n# a = 1\na.workspace = true\nb = { path = \"../b\" }\n\
                    [dev-dependencies]\nc = \"1\"\n[dependencies.d]\nversion = \"1\"\n";
    let expected = [
        ("dependencies", "a"),
        ("dependencies", "b"),
        ("dev-dependencies", "c"),
        ("dependencies", "d"),
    ];
    assert_eq!(
        dependencies(manifest),
        expected.map(|(section, name)| (section.to_owned(), name.to_owned()))
    );
}
