//! Copies of the program that a launcher starts: a program without MPI does not run as several. Runs on several processes are
//! tested by `.ci/mpi`.
#![cfg(not(feature = "mpi"))]

use std::path::Path;
use std::process::Output;

use crate::common::{PLATE, pericles, text};

/// Runs the program as a launcher does.
fn launched(folder: &Path, arguments: &str, variables: &[(&str, &str)]) -> Output {
    let mut command = pericles(folder);
    command.args(arguments.split(' ')).envs(variables.to_vec());
    command.output().unwrap()
}

#[test]
fn copies_of_a_program_without_mpi_write_nothing_and_explain_once() {
    let place = tempfile::tempdir().unwrap();
    std::fs::write(place.path().join("plate.toml"), PLATE).unwrap();
    let launchers = [
        ["OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"],
        ["PMI_SIZE", "PMI_RANK"],
        ["SLURM_STEP_NUM_TASKS", "SLURM_PROCID"],
    ];
    for [size, rank] in launchers {
        let [first, second] = ["0", "1"].map(|number| {
            let variables = [(size, "2"), (rank, number)];
            launched(place.path(), "run plate.toml", &variables)
        });
        assert_eq!(first.status.code(), Some(9), "{size}");
        assert_eq!(second.status.code(), Some(9), "{size}");
        let said = text(&first.stderr);
        assert!(
            said.starts_with("error: 2 processes were started"),
            "{said}"
        );
        assert!(said.contains("--features mpi"), "{said}");
        assert_eq!(text(&second.stderr), "", "{size}");
        assert_eq!(text(&second.stdout), "", "{size}");
    }
    let left: Vec<_> = std::fs::read_dir(place.path()).unwrap().collect();
    assert_eq!(left.len(), 1, "{left:?}");
}

#[test]
fn commands_of_one_process_reject_several() {
    let place = tempfile::tempdir().unwrap();
    std::fs::write(place.path().join("plate.toml"), PLATE).unwrap();
    let variables = [("PMI_SIZE", "3"), ("PMI_RANK", "0")];
    let output = launched(place.path(), "check plate.toml", &variables);
    assert_eq!(output.status.code(), Some(9));
    let said = text(&output.stderr);
    assert!(
        said.contains("3 processes were started, but this command"),
        "{said}"
    );
}

#[test]
fn one_process_runs_under_a_launcher_and_in_batch_scripts() {
    let place = tempfile::tempdir().unwrap();
    std::fs::write(place.path().join("plate.toml"), PLATE).unwrap();
    let environments: [&[(&str, &str)]; 2] = [
        &[("OMPI_COMM_WORLD_SIZE", "1"), ("OMPI_COMM_WORLD_RANK", "0")],
        &[("SLURM_NTASKS", "8"), ("SLURM_PROCID", "0")],
    ];
    for (number, variables) in environments.iter().enumerate() {
        let line = format!("run plate.toml --quiet --out results-{number}");
        let output = launched(place.path(), &line, variables);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{said}");
    }
    // Threads that share a core, as under `mpirun -n 1`, which binds the process to one.
    let cores = std::thread::available_parallelism().unwrap().get();
    let line = format!(
        "run plate.toml --quiet --out results --threads {}",
        cores + 1
    );
    let output = launched(place.path(), &line, environments[0]);
    let said = text(&output.stderr);
    assert!(
        said.contains("warning: ") && said.contains("threads per process"),
        "{said}"
    );
}
