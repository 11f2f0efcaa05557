//! Faults of checkpoints of divided bodies: all processes fail together or use the previous checkpoint, and the first reports.

mod common;

use std::fs;
use std::path::Path;
use std::sync::Arc;

use common::processes::{assert_same, drive, means, resume, run};
use pericles::domain::{Alone, Threads};
use pericles_io::IoError;
use pericles_run::{Ending, Run, RunError};

/// A notched block that is torn apart.
const BLOCK: &str = r#"
[body]
shape = "block"
size = [14, 10, 6]
spacing = 1
[material]
model = "state-based"
density = 1
youngs_modulus = 1
poisson_ratio = 0.2
horizon = 3.01
critical_stretch = 0.01
[sets.top]
layer = { side = "+y", cells = 1 }
[[crack]]
polygon = [[-1, 5, -1], [5, 5, -1], [5, 5, 7], [-1, 5, 7]]
[[constraint]]
set = "top"
velocity = ["free", 0.05, "free"]
[time]
end = 6
dt = 0.2
[output]
history = { every = 1 }
[checkpoint]
every = 10
"#;

/// Runs on several processes and stops with checkpoints of steps 10 and 17.
fn stopped(folder: &Path, size: usize) {
    for ending in Threads::run(size, |comm| run(BLOCK, folder, comm, Some(17))) {
        assert_eq!(ending.unwrap(), Ending::Cancelled);
    }
}

fn checkpoint(folder: &Path, step: u64) -> std::path::PathBuf {
    folder.join(format!("checkpoints/step-{step:012}.chk"))
}

/// Changes the last byte, which belongs to the last process that reads the file.
fn damage(path: &Path) {
    let mut bytes = fs::read(path).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    fs::write(path, bytes).unwrap();
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

#[test]
fn a_run_resumes_from_the_previous_checkpoint_if_the_newest_is_damaged() {
    let place = tempfile::tempdir().unwrap();
    let alone = place.path().join("alone");
    run(BLOCK, &alone, Arc::new(Alone), None).unwrap();
    for (before, after) in [(3, 4), (1, 2), (5, 1)] {
        let folder = place.path().join(format!("{before}-{after}"));
        stopped(&folder, before);
        damage(&checkpoint(&folder, 17));
        let warned = Threads::run(after, |comm| {
            let first = comm.rank() == 0;
            let run = Run::resume(&folder, &means(comm), &mut |_| {})
                .unwrap()
                .unwrap();
            assert_eq!(run.simulation().state().step, 10);
            let warnings = run.report().model.warnings.clone();
            assert_eq!(drive(run, None).unwrap(), Ending::Finished);
            let told = |one: &String| one.contains("the previous checkpoint is used");
            warnings.iter().any(told) == first
        });
        assert!(warned.into_iter().all(|as_expected| as_expected));
        assert_same(
            &folder,
            &alone,
            &format!("{before}, then {after} processes"),
        );
    }
}

#[test]
fn damaged_checkpoints_are_errors_of_all_processes() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("stopped");
    stopped(&folder, 2);
    let [older, newer] = [10, 17].map(|step| checkpoint(&folder, step));
    damage(&newer);
    let bytes = fs::read(&older).unwrap();
    fs::write(&older, &bytes[..bytes.len() - 100]).unwrap();
    let errors = Threads::run(3, |comm| resume_error(&folder, comm));
    let rejected = |error: &RunError| matches!(error, RunError::Io(IoError::NoValidCheckpoint { rejected, .. }) if rejected.len() == 2);
    assert!(rejected(&errors[0]), "{}", errors[0]);
    assert!(errors[1..].iter().all(RunError::is_elsewhere));
}

fn resume_error(folder: &Path, comm: Arc<dyn pericles::domain::Comm>) -> RunError {
    match Run::resume(folder, &means(comm), &mut |_| {}) {
        Ok(_) => panic!("the run is resumed"),
        Err(error) => error,
    }
}

#[test]
fn a_checkpoint_that_cannot_be_written_ends_the_run_and_leaves_the_previous_one() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("stopped");
    stopped(&folder, 3);
    // A folder in place of the next checkpoint.
    fs::create_dir(checkpoint(&folder, 20)).unwrap();
    let before = names(&folder.join("checkpoints"));
    let errors = Threads::run(3, |comm| resume(&folder, comm).unwrap_err());
    assert!(matches!(&errors[0], RunError::Io(error) if error.is_output_problem()));
    assert!(errors[1..].iter().all(RunError::is_elsewhere));
    assert_eq!(names(&folder.join("checkpoints")), before);
    fs::remove_dir(checkpoint(&folder, 20)).unwrap();
    for ending in Threads::run(4, |comm| resume(&folder, comm)) {
        assert_eq!(ending.unwrap(), Ending::Finished);
    }
}
