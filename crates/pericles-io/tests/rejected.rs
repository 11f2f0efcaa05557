//! Files that all readers must reject: those that declare more content than they have, and findings of
//! fuzzing. Each is rejected with a message that names it, without allocating the declared memory. New
//! findings are added to `tests/rejected/`, with the file extension of their format.

use std::fs;
use std::path::Path;

use pericles_io::{Container, SURFACE_ENDINGS, parse_fields, parse_points, parse_surface};

/// Memory limit for the content of a file, bytes.
const MEMORY: u64 = 1 << 26;

/// Returns the error of reading a file; `None` if it is accepted.
fn rejection(path: &Path) -> Option<String> {
    let content = fs::read(path).unwrap();
    let ending = path.extension().unwrap().to_str().unwrap();
    match ending {
        "chk" => Container::parse(path, &content, MEMORY)
            .err()
            .map(|e| e.to_string()),
        "txt" => (1..=3)
            .map(|dimension| parse_points(path, &content, dimension).err())
            .map(|error| error.map(|e| e.to_string()))
            .next_back()?,
        _ => {
            assert!(SURFACE_ENDINGS.contains(&ending), "{}", path.display());
            if ending.starts_with("vt") {
                let _ = parse_fields(path, &content, MEMORY);
            }
            parse_surface(path, &content, MEMORY)
                .err()
                .map(|e| e.to_string())
        }
    }
}

#[test]
fn all_files_in_the_folder_are_rejected() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/rejected");
    let mut paths: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    paths.sort();
    assert!(paths.len() >= 20);
    for path in paths {
        let message = rejection(&path).unwrap_or_else(|| panic!("{} is accepted", path.display()));
        let name = path.file_name().unwrap().to_str().unwrap();
        assert!(message.contains(name), "{message}");
    }
}
