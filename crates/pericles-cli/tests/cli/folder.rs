//! Output folders: names, replacement, permissions.

use std::fs;
use std::process::Stdio;

use crate::common::{fail, report, run, succeed, text, with_plate};

#[test]
fn folders_are_named_after_the_deck_and_numbered() {
    let place = with_plate();
    for expected in ["plate", "plate-2", "plate-3"] {
        succeed(place.path(), "run plate.toml --quiet --set time.end=1e-6");
        let folder = place.path().join(expected);
        assert_eq!(report(&folder)["status"], "finished", "{expected}");
    }
    let folder = place.path().join("plate");
    let all = [
        "run.json",
        "fields.pvd",
        "fields/fields_000000.vtu",
        "history.csv",
        "reactions.csv",
        "cracks.csv",
        "probes.csv",
        "pictures/Damage-000002.png",
        "checkpoints/step-000000000000.chk",
    ];
    for name in all {
        assert!(folder.join(name).is_file(), "{name}");
    }
}

#[test]
fn an_existing_output_folder_is_replaced_only_with_force() {
    let place = with_plate();
    let line = "run plate.toml --out results --quiet --set time.end=1e-6";
    succeed(place.path(), line);
    let folder = place.path().join("results");
    fs::write(folder.join("notes.txt"), "mine").unwrap();
    fs::write(folder.join("fields/fields_000099.vtu"), "old").unwrap();
    let (status, message) = fail(place.path(), line);
    assert_eq!(status, 6);
    assert!(
        message.contains("results") && message.contains("--force"),
        "{message}"
    );
    assert!(folder.join("fields/fields_000099.vtu").exists());
    succeed(place.path(), &format!("{line} --force"));
    assert!(!folder.join("fields/fields_000099.vtu").exists());
    assert_eq!(
        fs::read_to_string(folder.join("notes.txt")).unwrap(),
        "mine"
    );
}

#[test]
fn force_removes_exactly_the_files_written_by_the_run() {
    let place = with_plate();
    let line = "run plate.toml --out results --quiet --set time.end=1e-6 --set output.fragments.every=5 \
                --set output.picture.0.animation=true";
    succeed(place.path(), line);
    let folder = place.path().join("results");
    succeed(place.path(), "report results");
    let mine = [
        "measured.csv",
        "pictures/photo.png",
        "pictures/photo-000001.png",
        "fields/other.vtu",
        "checkpoints/kept.chk",
    ];
    for file in mine {
        fs::write(folder.join(file), "mine").unwrap();
    }
    let before = crate::common::results(&folder);
    assert!(before.len() > 15, "{before:?}");
    // A run with minimal output: all files of the first one are removed.
    fs::write(
        place.path().join("bar.toml"),
        "[body]\nshape = \"bar\"\nlength = 10\nspacing = 1\n[material]\ndensity = 1\nyoungs_modulus = 1\nhorizon = 3\n\
         [time]\nend = 1\n[output]\nfields = \"never\"\n",
    )
    .unwrap();
    succeed(place.path(), "run bar.toml --out results --force --quiet");
    let left: Vec<String> = crate::common::results(&folder)
        .into_keys()
        .map(|path| path.to_str().unwrap().to_owned())
        .filter(|name| ![".manifest", "history.csv"].contains(&name.as_str()))
        .collect();
    let mut expected = mine.to_vec();
    // Checkpoints are not listed among the results.
    expected.retain(|name| !name.starts_with("checkpoints"));
    expected.sort_unstable();
    assert_eq!(left, expected);
    assert!(folder.join("checkpoints/kept.chk").exists());
    assert_eq!(report(&folder)["status"], "finished");
}

#[test]
fn force_does_not_replace_a_folder_with_the_run_json_of_another_program() {
    let place = with_plate();
    let folder = place.path().join("other");
    fs::create_dir(&folder).unwrap();
    fs::write(folder.join("run.json"), "{\"program\": \"other\"}").unwrap();
    fs::write(folder.join("data.csv"), "1,2\n").unwrap();
    let (status, message) = fail(place.path(), "run plate.toml --out other --force");
    assert_eq!(status, 6, "{message}");
    assert!(
        message.contains("contains files but no Pericles results"),
        "{message}"
    );
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);
}

#[test]
fn force_does_not_replace_a_folder_without_results() {
    let place = with_plate();
    fs::create_dir(place.path().join("thesis")).unwrap();
    fs::write(place.path().join("thesis/chapter.tex"), "words").unwrap();
    let (status, message) = fail(place.path(), "run plate.toml --out thesis --force");
    assert_eq!(status, 6, "{message}");
    assert_eq!(
        fs::read_dir(place.path().join("thesis")).unwrap().count(),
        1
    );
}

#[test]
fn an_unwritable_output_folder_is_status_6() {
    let place = with_plate();
    // A path through a file is not writable even for the superuser.
    let (status, message) = fail(place.path(), "run plate.toml --out plate.toml/results");
    assert_eq!(status, 6, "{message}");
    assert!(message.contains("cannot write"), "{message}");
    let (status, message) = fail(
        place.path(),
        "reproduce fracture/inclined --out plate.toml/figures",
    );
    assert_eq!(status, 6, "{message}");
}

#[test]
fn check_and_invalid_decks_write_no_files() {
    let place = with_plate();
    succeed(place.path(), "check plate.toml");
    assert_eq!(fail(place.path(), "run plate.toml --set time.dt=1").0, 3);
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 1);
}

#[test]
fn quiet_runs_print_nothing_and_progress_is_printed_as_lines() {
    let place = with_plate();
    let quiet = succeed(place.path(), "run plate.toml --quiet --set time.end=1e-6");
    assert_eq!((quiet.stdout.len(), quiet.stderr.len()), (0, 0));
    let loud = succeed(place.path(), "run plate.toml");
    let (out, err) = (text(&loud.stdout), text(&loud.stderr));
    assert_eq!(err.matches(" %  step ").count(), 9, "{err}");
    assert!(out.contains("finished after step 400 of 400"), "{out}");
    assert!(out.contains("Results in ./plate-2"), "{out}");
}

#[test]
fn a_closed_pipe_is_not_an_error() {
    let place = with_plate();
    for line in [
        "run plate.toml",
        "check plate.toml",
        "reproduce --list",
        "--help",
    ] {
        let mut child = crate::common::pericles(place.path())
            .args(line.split(' '))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // The pipe is closed from the start.
        drop(child.stdout.take());
        if line.starts_with("run") {
            drop(child.stderr.take());
        }
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{line}");
        assert!(!text(&output.stderr).contains("panic"), "{line}");
    }
    assert_eq!(report(&place.path().join("plate"))["status"], "finished");
}

#[test]
fn run_json_contains_deck_model_and_results() {
    let place = with_plate();
    succeed(
        place.path(),
        "run plate.toml --threads 1 --quiet --set material.E=70e9",
    );
    let report = report(&place.path().join("plate"));
    let number = |path: &str| report.pointer(path).and_then(|v| v.as_f64()).unwrap();
    assert_eq!(report["program"]["threads"], 1);
    assert_eq!(report["program"]["version"], env!("CARGO_PKG_VERSION"));
    let commit = report["program"]["commit"].as_str();
    assert_eq!(commit, pericles_cli::COMMIT);
    let version = succeed(place.path(), "--version");
    let version = String::from_utf8(version.stdout).unwrap();
    assert_eq!(version.contains('('), commit.is_some(), "{version}");
    assert!(version.contains(commit.unwrap_or_default()), "{version}");
    assert_eq!(report["deck"]["source"], crate::common::PLATE);
    assert_eq!(report["deck"]["overrides"][0], "material.E=70e9");
    assert_eq!(number("/deck/values/body/spacing"), 1e-3);
    assert_eq!(number("/model/youngs_modulus"), 70e9);
    assert_eq!(number("/model/points"), 288.0);
    assert_eq!(number("/model/steps"), 400.0);
    assert!(number("/model/stable_step") > 1e-7);
    assert!(number("/progress/directed_bond_updates_per_second") > 0.0);
    assert!(number("/audit/broken_bonds") > 10.0);
    assert!(number("/audit/external_work") > 0.0);
    assert!(number("/audit/balance_over_work").abs() < 1e-3);
    assert!(number("/audit/largest_balance") >= number("/audit/balance").abs());
}

#[test]
fn check_reports_the_numbers_of_a_deck() {
    let place = with_plate();
    let output = succeed(
        place.path(),
        "check plate.toml --set material.volume_correction=none",
    );
    let text = text(&output.stdout);
    for part in [
        "Torn plate",
        "288",
        "400 of 100 ns",
        "0.002000",
        "Rayleigh",
        "stable step",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert_eq!(run(place.path(), "check gone.toml").status.code(), Some(3));
}

#[test]
fn check_draws_the_body_with_the_names_of_its_sets() {
    let place = with_plate();
    succeed(place.path(), "check plate.toml --picture sets.svg");
    let picture = std::fs::read_to_string(place.path().join("sets.svg")).unwrap();
    for name in ["top (", "bottom (", "no set ("] {
        assert!(picture.contains(name), "{name}");
    }
    let unknown = run(place.path(), "check plate.toml --picture gone/sets.png");
    assert_eq!(unknown.status.code(), Some(6));
}
