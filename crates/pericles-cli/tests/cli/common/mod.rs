//! Shared by the tests of the program: running it, a small deck, reading output folders.
#![allow(dead_code)] // each test file uses its part

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

/// Returns the program as a command in a folder.
pub fn pericles(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pericles"));
    command.current_dir(folder).stdin(Stdio::null());
    command
}

/// Runs the program; the arguments are split at spaces.
pub fn run(folder: &Path, arguments: &str) -> Output {
    pericles(folder)
        .args(arguments.split_whitespace())
        .output()
        .unwrap()
}

/// Runs the program and asserts success.
pub fn succeed(folder: &Path, arguments: &str) -> Output {
    let output = run(folder, arguments);
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert!(
        output.status.success(),
        "{arguments}: {:?}\n{out}\n{err}",
        output.status
    );
    output
}

/// Runs the program, asserts failure, and returns exit status and standard error.
pub fn fail(folder: &Path, arguments: &str) -> (i32, String) {
    let output = run(folder, arguments);
    (output.status.code().unwrap(), text(&output.stderr))
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A small notched plate that breaks, with all kinds of output.
pub const PLATE: &str = r#"
title = "Torn plate"
[body]
shape = "plate"
size = ["24 mm", "12 mm"]
spacing = "1 mm"
plane = "stress"
[material]
youngs_modulus = "72 GPa"
density = 2440
horizon_ratio = 3
critical_stretch = 0.002
[sets.top]
layer = { side = "+y", cells = 1 }
[sets.bottom]
layer = { side = "-y", cells = 1 }
[[crack]]
segment = [["0 mm", "6 mm"], ["8 mm", "6 mm"]]
[[constraint]]
set = "top"
velocity = ["free", "4 m/s"]
[[constraint]]
set = "bottom"
velocity = ["free", "-4 m/s"]
[[load]]
set = "top"
traction = ["1 MPa", 0]
[[probe]]
name = "corner"
at = ["23.5 mm", "11.5 mm"]
[time]
end = "40 us"
dt = "0.1 us"
[output]
fields = { every = 90 }
history = { every = 7 }
cracks = { every = 10 }
[[output.picture]]
field = "Damage"
count = 2
[[output.picture]]
field = "Velocity_y"
scale = 10
every = 150
[checkpoint]
every = 60
"#;

/// Returns a temporary folder with the deck of the plate.
pub fn with_plate() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("plate.toml"), PLATE).unwrap();
    folder
}

/// Returns all result files of a run with their contents, except run.json, checkpoints and the lock.
pub fn results(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(place) = open.pop() {
        for entry in fs::read_dir(place).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap();
            if path.is_dir() && name != "checkpoints" {
                open.push(path);
            } else if path.is_file() && name != "run.json" && name != ".lock" {
                let inside = path.strip_prefix(folder).unwrap().to_path_buf();
                found.insert(inside, fs::read(&path).unwrap());
            }
        }
    }
    found
}

/// Asserts that two runs have written identical files.
pub fn assert_same_results(one: &Path, other: &Path) {
    let (one, other) = (results(one), results(other));
    let names = |files: &BTreeMap<PathBuf, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&one), names(&other));
    assert!(
        one.len() >= 10,
        "too few files to compare: {:?}",
        names(&one)
    );
    for (name, bytes) in &one {
        assert!(other[name] == *bytes, "{} differs", name.display());
    }
}

/// Returns `run.json` of an output folder.
pub fn report(folder: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.join("run.json")).unwrap()).unwrap()
}

/// A run in the background that ends with the test.
pub struct Background(Option<Child>);

impl Background {
    /// Starts a run and waits until its history has several rows.
    pub fn start(folder: &Path, arguments: &str, out: &str) -> Self {
        let child = pericles(folder)
            .args(arguments.split_whitespace())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let history = folder.join(out).join("history.csv");
        Self::waiting(child, || {
            fs::read_to_string(&history).is_ok_and(|rows| rows.lines().count() > 4)
        })
    }

    /// Waits until a run satisfies a condition.
    pub fn waiting(child: Child, reached: impl Fn() -> bool) -> Self {
        let mut run = Self(Some(child));
        let start = Instant::now();
        while !reached() {
            let child = run.0.as_mut().unwrap();
            assert!(
                child.try_wait().unwrap().is_none(),
                "the run ended too early"
            );
            assert!(
                start.elapsed() < Duration::from_secs(60),
                "the run does not start"
            );
            std::thread::sleep(Duration::from_millis(2));
        }
        run
    }

    /// Sends a signal given by name.
    pub fn signal(&self, name: &str) {
        let child = self.0.as_ref().unwrap();
        let status = Command::new("kill")
            .args([&format!("-{name}"), &child.id().to_string()])
            .status()
            .unwrap();
        assert!(status.success());
    }

    /// Waits for the end of the run.
    pub fn finish(mut self) -> Output {
        self.0.take().unwrap().wait_with_output().unwrap()
    }
}

impl Drop for Background {
    fn drop(&mut self) {
        if let Some(mut child) = self.0.take() {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}
