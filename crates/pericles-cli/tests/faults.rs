//! What happens to a run when the machine fails it: full disks, read-only folders, folders that go, impatient users. Nothing is corrupted, and the message says what to do.

mod common;

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use common::{Background, assert_same_results, fail, pericles, report, succeed, text, with_plate};

/// A file system in memory for as long as a test runs; none, with the reason printed, where this user may not make one.
struct SmallDisk<'a>(&'a Path);

impl<'a> SmallDisk<'a> {
    fn mounted(place: &'a Path, options: &str) -> Option<Self> {
        fs::create_dir_all(place).unwrap();
        let mount = Command::new("mount")
            .args(["-t", "tmpfs", "-o", options, "tmpfs"])
            .arg(place)
            .stderr(Stdio::null())
            .status();
        match mount {
            Ok(status) if status.success() => Some(Self(place)),
            other => {
                println!("skipped: no file system can be mounted here ({other:?})");
                None
            }
        }
    }

    fn remount(&self, options: &str) {
        let status = Command::new("mount")
            .args(["-o", &format!("remount,{options}")])
            .arg(self.0)
            .status();
        assert!(status.unwrap().success());
    }
}

impl Drop for SmallDisk<'_> {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(self.0).status();
    }
}

#[test]
fn a_full_disk_ends_a_run_that_goes_on_once_there_is_room() {
    let place = with_plate();
    succeed(place.path(), "run plate.toml --quiet --out whole");
    let disk = place.path().join("disk");
    let Some(disk) = SmallDisk::mounted(&disk, "size=160k") else {
        return;
    };
    let (status, message) = fail(place.path(), "run plate.toml --out disk/results");
    assert_eq!(status, 6, "{message}");
    assert!(
        message.contains("no room to write") && message.contains("free some space"),
        "{message}"
    );
    disk.remount("size=64m");
    succeed(place.path(), "resume disk/results --quiet");
    assert_same_results(
        &place.path().join("whole"),
        &place.path().join("disk/results"),
    );
}

#[test]
fn a_file_that_may_not_grow_is_a_full_disk() {
    let place = with_plate();
    // The shell hands on that the signal is ignored, so that writing fails instead.
    let line = format!(
        "trap '' XFSZ; ulimit -f 52; exec {} run plate.toml --out results",
        env!("CARGO_BIN_EXE_pericles")
    );
    let output = Command::new("sh")
        .args(["-c", &line])
        .current_dir(place.path())
        .output()
        .unwrap();
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(6), "{message}");
    assert!(message.contains("no room to write"), "{message}");
    // What was written before can be gone on from.
    succeed(place.path(), "resume results --quiet");
    assert_eq!(report(&place.path().join("results"))["status"], "finished");
}

#[test]
fn a_read_only_place_is_told() {
    let place = with_plate();
    let disk = place.path().join("disk");
    let Some(_disk) = SmallDisk::mounted(&disk, "ro") else {
        return;
    };
    let (status, message) = fail(place.path(), "run plate.toml --out disk/results");
    assert_eq!(status, 6, "{message}");
    assert!(
        message.contains("cannot write") && message.contains("choose another folder"),
        "{message}"
    );
}

#[test]
fn a_disk_that_turns_read_only_ends_a_run_that_goes_on_later() {
    let place = with_plate();
    succeed(place.path(), "run plate.toml --quiet --out whole");
    let disk = place.path().join("disk");
    let Some(disk) = SmallDisk::mounted(&disk, "size=64m") else {
        return;
    };
    // It stops by itself, and finds a disk that is read-only when it goes on.
    let line = "run plate.toml --quiet --out disk/results --wall-time 0.01s";
    assert_eq!(common::run(place.path(), line).status.code(), Some(7));
    disk.remount("ro");
    let (status, message) = fail(place.path(), "resume disk/results");
    assert_eq!(status, 6, "{message}");
    assert!(message.contains("cannot write"), "{message}");
    disk.remount("rw");
    succeed(place.path(), "resume disk/results --quiet");
    assert_same_results(
        &place.path().join("whole"),
        &place.path().join("disk/results"),
    );
}

/// Long enough for something to happen to it.
const LONG: &str = "run plate.toml --threads 1 --set time.end=1e-2 --set output.fields.every=100000 --set output.history.every=50 \
                    --set output.picture.1.every=100000 --set checkpoint.every=500";

#[test]
fn a_folder_that_is_removed_ends_the_run() {
    let place = with_plate();
    let run = Background::start(place.path(), &format!("{LONG} --out gone"), "gone");
    // The run may be about to write: what it makes between two removals is removed by the next.
    while place.path().join("gone").exists() {
        let _ = fs::remove_dir_all(place.path().join("gone"));
    }
    let output = run.finish();
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(6), "{message}");
    assert!(
        message.contains("its folder is not there any more"),
        "{message}"
    );
    assert!(!place.path().join("gone").exists());
}

#[test]
fn a_second_ctrl_c_ends_the_run_at_once() {
    let place = with_plate();
    // One coarse step of a thousand fine ones, which are not interrupted.
    let line = "run plate.toml --threads 1 --set body.spacing=2e-5 --set sets.top.layer.cells=300 --set material.critical_stretch=0.1 \
                --set time.scheme=respa --set time.ratio=1000 --set time.fine=top --set time.dt=1e-9 --out twice";
    let first = place.path().join("twice/checkpoints/step-000000000000.chk");
    let child = pericles(place.path())
        .args(line.split_whitespace())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let run = Background::waiting(child, || first.is_file());
    run.signal("INT");
    // Signals that come before the first is seen are one.
    std::thread::sleep(std::time::Duration::from_millis(200));
    run.signal("INT");
    let output = run.finish();
    assert_eq!(output.status.code(), Some(130), "{}", text(&output.stderr));
    // No time for a report or another checkpoint; the first one is there.
    assert_eq!(report(&place.path().join("twice"))["status"], "running");
    assert!(first.is_file());
}
