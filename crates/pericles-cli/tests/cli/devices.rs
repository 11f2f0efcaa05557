//! Graphics processors in a program without them. Runs on a device are tested by `.ci/gpu`.
#![cfg(not(feature = "gpu"))]

use crate::common::{PLATE, pericles, text};

#[test]
fn programs_without_graphics_processors_explain_how_to_get_them() {
    let place = tempfile::tempdir().unwrap();
    std::fs::write(place.path().join("plate.toml"), PLATE).unwrap();
    let on_device = format!("{PLATE}\n[run]\ndevice = \"gpu\"\n");
    std::fs::write(place.path().join("device.toml"), on_device).unwrap();
    for arguments in [
        "run plate.toml --device gpu",
        "check plate.toml --device gpu:1 --precision mixed",
        "bench block-20 --device gpu",
        "run device.toml",
        "devices",
    ] {
        let mut command = pericles(place.path());
        let output = command.args(arguments.split(' ')).output().unwrap();
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(10), "{arguments}: {said}");
        assert!(said.contains("--features gpu"), "{arguments}: {said}");
    }
    let left: Vec<_> = std::fs::read_dir(place.path()).unwrap().collect();
    assert_eq!(left.len(), 2, "{left:?}");
}

#[test]
fn the_command_line_has_priority_over_the_deck() {
    let place = tempfile::tempdir().unwrap();
    let on_device = format!("{PLATE}\n[run]\ndevice = \"gpu\"\n");
    std::fs::write(place.path().join("device.toml"), on_device).unwrap();
    let mut command = pericles(place.path());
    let arguments = "run device.toml --device cpu --quiet --out results";
    let output = command.args(arguments.split(' ')).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
}

#[test]
fn unknown_devices_are_rejected() {
    let place = tempfile::tempdir().unwrap();
    for (device, precision) in [("tpu", "mixed"), ("gpu:x", "mixed"), ("gpu", "half")] {
        let mut command = pericles(place.path());
        command.args([
            "run",
            "plate.toml",
            "--device",
            device,
            "--precision",
            precision,
        ]);
        let output = command.output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    }
}
