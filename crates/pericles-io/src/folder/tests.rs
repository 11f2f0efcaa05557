//! Tests of output folders.

use super::*;
use std::collections::BTreeSet;
use std::thread;

fn populate(folder: &Path, files: &[&str]) {
    for file in files {
        let path = folder.join(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "x").unwrap();
    }
}

#[test]
fn an_existing_folder_is_rejected() {
    let place = tempfile::tempdir().unwrap();
    let error = OutputFolder::create(place.path(), false).unwrap_err();
    assert!(matches!(error, IoError::FolderExists { .. }), "{error}");
    assert!(error.is_output_problem());
}

#[test]
fn missing_parents_are_created() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a/b/c");
    let folder = OutputFolder::create(&path, false).unwrap();
    assert!(folder.path().is_dir());
    assert!(folder.subfolder("fields").unwrap().is_dir());
    assert!(folder.subfolder("fields").unwrap().is_dir());
}

const STRAYS: [&str; 10] = [
    "notes.txt",
    "measured.csv",
    "fields/mine.vtu",
    "fields/fields_best.vtu",
    "pictures/me.png",
    "pictures/a.svg",
    "more/run.json",
    "checkpoints/README",
    "checkpoints/kept.chk",
    ".notes.part",
];

fn assert_removed(path: &Path, results: &[&str]) {
    for file in results {
        assert!(!path.join(file).exists(), "{file}");
    }
    for file in STRAYS {
        assert!(path.join(file).exists(), "{file}");
    }
}

#[test]
fn force_removes_only_recorded_files() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("out");
    let names = [
        "run.json",
        "own.csv",
        "fields/fields_*.vtu",
        "pictures/a.apng",
    ];
    let folder = OutputFolder::create(&path, false).unwrap();
    folder.claim(&names.map(String::from)).unwrap();
    drop(folder);
    let results = [
        "run.json",
        "own.csv",
        "fields/fields_000000.vtu",
        "pictures/a.apng",
        "fields/.fields_000001.vtu.7-0.part",
    ];
    populate(&path, &results);
    populate(&path, &STRAYS);
    // A table that this run does not write.
    populate(&path, &["history.csv"]);
    let _folder = OutputFolder::create(&path, true).unwrap();
    assert_removed(&path, &results);
    assert!(path.join("history.csv").exists());
    assert!(!path.join(MANIFEST).exists());
}

#[test]
fn force_rejects_results_without_a_manifest() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("out");
    populate(&path, &["run.json", "history.csv"]);
    let report = r#"{"program": {"name": "pericles"}, "deck": {"source": ""}}"#;
    fs::write(path.join("run.json"), report).unwrap();
    let error = OutputFolder::create(&path, true).unwrap_err();
    assert!(matches!(error, IoError::FolderNotOurs { .. }), "{error}");
    assert!(path.join("history.csv").exists());
}

#[cfg(unix)]
#[test]
fn force_does_not_follow_links() {
    let place = tempfile::tempdir().unwrap();
    let (path, other) = (place.path().join("out"), place.path().join("other"));
    populate(&other, &["fields_000000.vtu"]);
    let folder = OutputFolder::create(&path, false).unwrap();
    folder.claim(&["fields/fields_*.vtu".into()]).unwrap();
    drop(folder);
    std::os::unix::fs::symlink(&other, path.join("fields")).unwrap();
    OutputFolder::create(&path, true).unwrap();
    assert!(other.join("fields_000000.vtu").exists());
}

#[cfg(unix)]
#[test]
fn results_are_never_written_through_links() {
    use std::os::unix::fs::symlink;
    let place = tempfile::tempdir().unwrap();
    let (path, victim) = (place.path().join("out"), place.path().join("victim"));
    fs::write(&victim, "precious").unwrap();
    let names = [
        "history.csv",
        "fields.exo",
        "fields/fields_*.vtu",
        "cells/cells_*.vtu",
    ];
    let names = names.map(String::from);
    let folder = OutputFolder::create(&path, false).unwrap();
    folder.claim(&names).unwrap();
    folder.subfolder("fields").unwrap();
    drop(folder);
    let links = [
        "history.csv",
        "fields.exo",
        "fields/fields_000003.vtu",
        "cells",
    ];
    for link in links {
        symlink(&victim, path.join(link)).unwrap();
    }
    // Not the name of a result.
    symlink(&victim, path.join("notes")).unwrap();
    // A resumed run rejects the links, one that overwrites the results removes them.
    let folder = OutputFolder::open(&path).unwrap();
    assert!(matches!(folder.claim(&names), Err(IoError::Link { .. })));
    assert!(matches!(
        folder.subfolder("cells"),
        Err(IoError::Link { .. })
    ));
    drop(folder);
    let folder = OutputFolder::create(&path, true).unwrap();
    folder.claim(&names).unwrap();
    for link in links {
        assert!(!path.join(link).is_symlink(), "{link}");
    }
    assert!(path.join("notes").is_symlink());
    // A link with a name that no earlier run has recorded is rejected.
    symlink(&victim, path.join("probes.csv")).unwrap();
    let error = folder.claim(&["probes.csv".into()]).unwrap_err();
    assert!(
        error.is_output_problem() && error.path().ends_with("probes.csv"),
        "{error}"
    );
    drop(folder);
    fs::remove_file(path.join(LOCK)).unwrap();
    symlink(place.path().join("absent"), path.join(LOCK)).unwrap();
    assert!(matches!(
        OutputFolder::open(&path),
        Err(IoError::Link { .. })
    ));
    assert!(!place.path().join("absent").exists());
    assert_eq!(fs::read_to_string(&victim).unwrap(), "precious");
}

#[test]
fn force_rejects_a_folder_of_other_files() {
    let place = tempfile::tempdir().unwrap();
    populate(place.path(), &["thesis.tex", "data.csv", "pictures/me.png"]);
    let error = OutputFolder::create(place.path(), true).unwrap_err();
    assert!(matches!(error, IoError::FolderNotOurs { .. }), "{error}");
    assert!(place.path().join("data.csv").exists());
    assert!(!place.path().join(LOCK).exists());
}

#[test]
fn force_accepts_an_empty_folder_and_one_of_a_run_that_stopped_early() {
    let place = tempfile::tempdir().unwrap();
    drop(OutputFolder::create(place.path(), true).unwrap());
    assert!(place.path().join(LOCK).exists());
    OutputFolder::create(place.path(), true).unwrap();
    populate(place.path(), &["..manifest.7-0.part"]);
    OutputFolder::create(place.path(), true).unwrap();
    fs::write(place.path().join("notes.txt"), "mine").unwrap();
    assert!(OutputFolder::create(place.path(), true).is_err());
}

#[test]
fn a_second_run_is_locked_out_until_the_first_ends() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("out");
    let first = OutputFolder::create(&path, false).unwrap();
    first.claim(&["run.json".into()]).unwrap();
    populate(&path, &["run.json"]);
    for second in [OutputFolder::open(&path), OutputFolder::create(&path, true)] {
        assert!(matches!(second, Err(IoError::Locked { .. })), "{second:?}");
    }
    assert!(path.join("run.json").exists());
    drop(first);
    OutputFolder::open(&path).unwrap();
}

#[test]
fn runs_started_simultaneously_get_different_folders() {
    let place = tempfile::tempdir().unwrap();
    let stem = place.path().join("bar.v2");
    let folders: Vec<_> = thread::scope(|scope| {
        let start = || OutputFolder::create_numbered(&stem).unwrap();
        let handles: Vec<_> = (0..8).map(|_| scope.spawn(start)).collect();
        handles.into_iter().map(|run| run.join().unwrap()).collect()
    });
    let names: BTreeSet<_> = folders
        .iter()
        .map(|folder| folder.path().file_name().unwrap().to_str().unwrap())
        .collect();
    let expected = [
        "bar.v2", "bar.v2-2", "bar.v2-3", "bar.v2-4", "bar.v2-5", "bar.v2-6", "bar.v2-7",
        "bar.v2-8",
    ];
    assert_eq!(names, BTreeSet::from(expected));
}

#[test]
fn opening_a_missing_path_or_a_file_fails() {
    let place = tempfile::tempdir().unwrap();
    let gone = OutputFolder::open(place.path().join("gone"));
    assert!(matches!(gone, Err(IoError::NotFound { .. })));
    populate(place.path(), &["file"]);
    let file = OutputFolder::open(place.path().join("file"));
    assert!(matches!(file, Err(IoError::Read { .. })), "{file:?}");
}
