//! Runs under faults of the machine: full disks, read-only and removed folders, repeated interrupts. No file is
//! corrupted, and the message says what to do.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use crate::common::{
    Background, assert_same_results, fail, pericles, report, succeed, text, with_plate,
};

/// A temporary file system in memory; `None`, with the reason printed, if the user is not allowed to mount one.
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
fn a_run_stopped_by_a_full_disk_can_be_resumed() {
    let place = with_plate();
    succeed(place.path(), "run plate.toml --quiet --out whole");
    let disk = place.path().join("disk");
    let Some(disk) = SmallDisk::mounted(&disk, "size=160k") else {
        return;
    };
    let (status, message) = fail(place.path(), "run plate.toml --out disk/results");
    assert_eq!(status, 6, "{message}");
    assert!(
        message.contains("not enough space to write") && message.contains("free some space"),
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
fn a_file_size_limit_is_reported_as_a_full_disk() {
    let place = with_plate();
    // The ignored signal is inherited from the shell, so that writing fails instead.
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
    assert!(message.contains("not enough space to write"), "{message}");
    // The run can be resumed from what was written before.
    succeed(place.path(), "resume results --quiet");
    assert_eq!(report(&place.path().join("results"))["status"], "finished");
}

#[test]
fn a_read_only_folder_is_reported() {
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
fn a_run_stopped_by_a_read_only_disk_can_be_resumed() {
    let place = with_plate();
    succeed(place.path(), "run plate.toml --quiet --out whole");
    let disk = place.path().join("disk");
    let Some(disk) = SmallDisk::mounted(&disk, "size=64m") else {
        return;
    };
    // The run stops at its time limit; the disk is read-only when it is resumed.
    let line = "run plate.toml --quiet --out disk/results --wall-time 0.01s";
    assert_eq!(
        crate::common::run(place.path(), line).status.code(),
        Some(7)
    );
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

/// A run that is long enough to be disturbed.
const LONG: &str = "run plate.toml --threads 1 --set time.end=1e-2 --set output.fields.every=100000 --set output.history.every=50 \
                    --set output.picture.1.every=100000 --set checkpoint.every=500";

#[test]
fn a_folder_that_is_removed_ends_the_run() {
    let place = with_plate();
    let run = Background::start(place.path(), &format!("{LONG} --out gone"), "gone");
    // The run may be writing: files created between two removals are removed by the next.
    while place.path().join("gone").exists() {
        let _ = fs::remove_dir_all(place.path().join("gone"));
    }
    let output = run.finish();
    let message = text(&output.stderr);
    assert_eq!(output.status.code(), Some(6), "{message}");
    assert!(message.contains("its folder has been removed"), "{message}");
    assert!(!place.path().join("gone").exists());
}

#[test]
fn a_second_ctrl_c_ends_the_run_immediately() {
    let place = with_plate();
    // One coarse step of a thousand fine ones, which cannot be interrupted.
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
    // Signals that arrive before the first one is handled count as one.
    std::thread::sleep(std::time::Duration::from_millis(200));
    run.signal("INT");
    let output = run.finish();
    assert_eq!(output.status.code(), Some(130), "{}", text(&output.stderr));
    // Neither the report nor another checkpoint is written; the first checkpoint exists.
    assert_eq!(report(&place.path().join("twice"))["status"], "running");
    assert!(first.is_file());
}
