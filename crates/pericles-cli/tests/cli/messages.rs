//! Error messages and exit statuses.

use std::fs;

use crate::common::{fail, report, succeed, with_plate};

#[test]
fn usage_errors_are_status_2() {
    let place = with_plate();
    for line in [
        "run",
        "walk plate.toml",
        "run plate.toml --threads 0",
        "run plate.toml --force",
    ] {
        assert_eq!(fail(place.path(), line).0, 2, "{line}");
    }
    let (status, message) = fail(place.path(), "reproduce fracture/branch");
    assert_eq!(status, 2);
    assert!(
        message.contains("did you mean fracture/branching"),
        "{message}"
    );
}

#[test]
fn an_invalid_deck_is_status_3_with_locations() {
    let place = with_plate();
    let deck = crate::common::PLATE
        .replace("72 GPa", "72 GPA")
        .replace("horizon_ratio", "horizont_ratio");
    fs::write(place.path().join("wrong.toml"), deck).unwrap();
    let (status, message) = fail(place.path(), "run wrong.toml");
    assert_eq!(status, 3);
    // Line 9 `youngs_modulus = "72 GPA"`, line 11 `horizont_ratio = 3`.
    assert!(message.contains("wrong.toml:9:18"), "{message}");
    assert!(message.contains("wrong.toml:11:1"), "{message}");
    assert!(
        message.contains("did you mean `horizon_ratio`"),
        "{message}"
    );
    assert!(message.starts_with("error: "), "{message}");
    let (status, message) = fail(place.path(), "check plate.toml --set body.spacing=0.7e-3");
    assert_eq!(status, 3);
    assert!(message.contains("whole number of cells"), "{message}");
}

#[test]
fn missing_inputs_are_status_3() {
    let place = with_plate();
    for line in ["run gone.toml", "resume gone"] {
        let (status, message) = fail(place.path(), line);
        assert_eq!(status, 3, "{line}");
        assert!(message.contains("gone"), "{message}");
    }
    fs::create_dir(place.path().join("other")).unwrap();
    let (status, message) = fail(place.path(), "resume other");
    assert_eq!(status, 3);
    assert!(
        message.contains("not the output folder of a run"),
        "{message}"
    );
    assert_eq!(fs::read_dir(place.path().join("other")).unwrap().count(), 0);
}

#[test]
fn an_unstable_run_is_status_4_and_keeps_its_state() {
    let place = with_plate();
    // Three times the stable step in an unbreakable plate. Growth of the energy leads to a warning, infinity stops
    // the run.
    let line = "run plate.toml --set time.dt=1e-6 --set time.allow_unstable=true --set time.end=1e-3 \
                --set material.critical_stretch=1e200 --set checkpoint.every=1000000";
    let (status, message) = fail(place.path(), line);
    assert_eq!(status, 4, "{message}");
    assert!(message.contains("unstable at step"), "{message}");
    assert!(message.contains("failed.chk"), "{message}");
    assert!(message.contains("pericles resume ./plate"), "{message}");
    assert!(
        message.contains("warning: "),
        "a warning about the large step is expected: {message}"
    );
    let folder = place.path().join("plate");
    let report = report(&folder);
    assert_eq!(report["status"], "failed");
    assert!(report["error"].as_str().unwrap().contains("unstable"));
    assert!(folder.join("checkpoints/failed.chk").is_file());
    assert!(folder.join("checkpoints/step-000000000000.chk").is_file());
}

#[test]
fn bench_names_its_cases_and_writes_json() {
    let place = with_plate();
    let (status, message) = fail(place.path(), "bench cube-46");
    assert_eq!(status, 2);
    assert!(message.contains("block-46-list"), "{message}");
    let timed = succeed(place.path(), "bench plate-512 --threads 1 --json -");
    let results: serde_json::Value = serde_json::from_slice(&timed.stdout).unwrap();
    let case = &results["cases"][0];
    assert_eq!(case["case"], "plate-512");
    assert_eq!(case["points"], 512 * 512);
    assert_eq!(case["threads"], 1);
    assert!(case["ns_per_bond"].as_f64().unwrap() > 0.0);
}
