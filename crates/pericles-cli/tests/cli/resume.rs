//! Stopped and resumed runs, and runs with different numbers of threads, give bitwise identical results.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::time::{Duration, Instant};

use crate::common::{Background, assert_same_results, fail, report, succeed, text, with_plate};

/// A run long enough to be stopped midway: about a second, with some 100 kB of history.
const LONG: &str = "run plate.toml --threads 1 --set time.end=3e-3 --set output.fields.every=5000 \
                    --set output.history.every=100 --set output.cracks.every=1000 --set output.picture.1.every=9000 \
                    --set checkpoint.every=777";

#[test]
fn one_and_two_threads_give_identical_results() {
    let place = with_plate();
    for threads in [1, 2] {
        let line = format!("run plate.toml --quiet --threads {threads} --out on-{threads}");
        succeed(place.path(), &line);
    }
    let [one, two] = ["on-1", "on-2"].map(|name| place.path().join(name));
    assert_eq!(report(&one)["program"]["threads"], 1);
    assert_eq!(report(&two)["program"]["threads"], 2);
    assert_same_results(&one, &two);
}

#[test]
fn a_killed_run_resumes_to_identical_results() {
    let place = with_plate();
    succeed(place.path(), &format!("{LONG} --out whole"));
    let run = Background::start(place.path(), &format!("{LONG} --out killed"), "killed");
    run.signal("KILL");
    assert_eq!(run.finish().status.code(), None);
    let killed = place.path().join("killed");
    assert_eq!(report(&killed)["status"], "running");
    // The newest checkpoint is damaged: the one before it is used.
    let mut checkpoints: Vec<_> = fs::read_dir(killed.join("checkpoints"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "chk"))
        .collect();
    checkpoints.sort();
    let mut damaged = 0;
    if let [_, newest] = &checkpoints[..] {
        let mut bytes = fs::read(newest).unwrap();
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        fs::write(newest, bytes).unwrap();
        damaged += 1;
    }
    // The deck file is removed: the checkpoint contains it. The number of threads does not matter.
    fs::remove_file(place.path().join("plate.toml")).unwrap();
    let output = succeed(place.path(), "resume killed --threads 2");
    let err = text(&output.stderr);
    assert_eq!(
        err.matches("the previous checkpoint is used").count(),
        damaged,
        "{err}"
    );
    assert_eq!(report(&killed)["status"], "finished");
    assert_same_results(&place.path().join("whole"), &killed);
}

#[test]
fn ctrl_c_and_sigterm_stop_with_a_checkpoint() {
    let place = with_plate();
    succeed(place.path(), &format!("{LONG} --out whole"));
    let out = place.path().join("stopped");
    let run = Background::start(place.path(), &format!("{LONG} --out stopped"), "stopped");

    // During the run no other run may write to the folder.
    let (status, message) = fail(place.path(), "resume stopped");
    assert_eq!(status, 6, "{message}");
    assert!(message.contains("in use by another run"), "{message}");

    run.signal("INT");
    let output = run.finish();
    assert_eq!(output.status.code(), Some(130), "{}", text(&output.stderr));
    let said = text(&output.stdout);
    assert!(
        said.contains("Resume with `pericles resume stopped`"),
        "{said}"
    );
    let stopped = report(&out);
    assert_eq!(stopped["status"], "stopped");
    let step = stopped["progress"]["last_step"].as_u64().unwrap();
    assert!(step > 0 && step < 30_000, "{step}");
    let checkpoint = format!("checkpoints/step-{step:012}.chk");
    assert!(out.join(checkpoint).is_file());

    let rows = || {
        fs::read_to_string(out.join("history.csv"))
            .unwrap()
            .lines()
            .count()
    };
    let before = rows();
    let child = crate::common::pericles(place.path())
        .args(["resume", "stopped", "--threads", "1"])
        .spawn()
        .unwrap();
    let run = Background::waiting(child, || rows() > before + 3);
    run.signal("TERM");
    assert_eq!(run.finish().status.code(), Some(143));
    assert_eq!(report(&out)["progress"]["first_step"], step);

    succeed(place.path(), "resume stopped --quiet");
    assert_same_results(&place.path().join("whole"), &out);
    let again = succeed(place.path(), "resume stopped");
    assert!(text(&again.stdout).contains("has finished"));
}

#[test]
fn a_run_stopped_at_its_time_limit_resumes_to_identical_results() {
    let place = with_plate();
    succeed(place.path(), &format!("{LONG} --out whole"));
    let late = crate::common::run(place.path(), &format!("{LONG} --out late --wall-time=0.5s"));
    assert_eq!(late.status.code(), Some(7), "{}", text(&late.stderr));
    let out = place.path().join("late");
    assert_eq!(report(&out)["status"], "stopped");
    assert!(text(&late.stdout).contains("Resume with `pericles resume late`"));
    succeed(place.path(), "resume late --wall-time 1h");
    assert_same_results(&place.path().join("whole"), &out);
}

#[test]
fn resuming_at_the_start_does_not_repeat_output() {
    let place = with_plate();
    succeed(place.path(), "run plate.toml --quiet --out whole");
    succeed(
        place.path(),
        "run plate.toml --quiet --out begun --set checkpoint.every=10000",
    );
    let begun = place.path().join("begun");
    let text = fs::read_to_string(begun.join("run.json")).unwrap();
    fs::write(
        begun.join("run.json"),
        text.replace("\"finished\"", "\"running\""),
    )
    .unwrap();
    succeed(place.path(), "resume begun --quiet");
    assert_same_results(&place.path().join("whole"), &begun);
}

#[test]
fn a_checkpoint_that_does_not_match_the_output_files_is_rejected() {
    let place = with_plate();
    succeed(place.path(), "run plate.toml --quiet --out a");
    let folder = place.path().join("a");
    fs::remove_file(folder.join("run.json")).unwrap();
    fs::remove_file(folder.join("probes.csv")).unwrap();
    let (status, message) = fail(place.path(), "resume a");
    assert_eq!(status, 3, "{message}");
    assert!(message.contains("probes.csv"), "{message}");
}

#[test]
fn static_runs_resume_to_identical_results() {
    for scheme in [
        "'adaptive-dynamic-relaxation'",
        "'fire'",
        "'static',rigid_modes='fix'",
    ] {
        static_run_resumes(scheme);
    }
}

fn static_run_resumes(scheme: &str) {
    let place = with_plate();
    let time =
        format!("run plate.toml --quiet --set time={{scheme={scheme},load_steps=8,end=4e-6}}");
    let statics = time
        + " --set checkpoint.every=3 --set load.0.traction=[0,0] \
                   --set output.fields.every=2 --set output.history.every=1 --set output.cracks.every=1 --set output.picture.1.every=4";
    for name in ["whole", "begun"] {
        succeed(place.path(), &format!("{statics} --out {name}"));
    }
    let begun = place.path().join("begun");
    assert!(report(&begun)["audit"]["broken_bonds"].as_u64().unwrap() > 0);
    // As if the run had been killed after an earlier checkpoint, between load steps.
    let mut checkpoints: Vec<_> = fs::read_dir(begun.join("checkpoints"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    checkpoints.sort();
    let last = checkpoints.pop().unwrap();
    assert!(
        checkpoints
            .last()
            .unwrap()
            .ends_with("step-000000000006.chk")
    );
    fs::remove_file(last).unwrap();
    let text = fs::read_to_string(begun.join("run.json")).unwrap();
    fs::write(
        begun.join("run.json"),
        text.replace("\"finished\"", "\"running\""),
    )
    .unwrap();
    succeed(place.path(), "resume begun --quiet");
    assert_eq!(report(&begun)["progress"]["first_step"], 6);
    assert_same_results(&place.path().join("whole"), &begun);
    let history = fs::read_to_string(begun.join("history.csv")).unwrap();
    let mut rows = history.lines();
    let header: Vec<&str> = rows.next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|column| *column == name).unwrap();
    let (iterations, residual) = (column("inner_iterations"), column("residual [1]"));
    for row in rows.skip(1) {
        let cells: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        assert!(cells[iterations] > 0.0 && cells[residual] <= 1e-6, "{row}");
    }
}

/// A plate whose static state takes much longer to compute than a test may run.
const SLOW: &str = "run plate.toml --threads 1 --set time={scheme='adaptive-dynamic-relaxation',damping=1e-6,tolerance=1e-11,iterations=100000000,end=4e-6} \
                    --set load.0.traction=[0,0] --set material.critical_stretch=0.5";

#[test]
fn a_load_step_can_be_interrupted() {
    let place = with_plate();
    // By the time limit.
    let begun = Instant::now();
    let late = crate::common::run(place.path(), &format!("{SLOW} --out late --wall-time=1s"));
    assert_eq!(late.status.code(), Some(7), "{}", text(&late.stderr));
    assert!(begun.elapsed() < Duration::from_secs(20));
    // By a signal.
    let out = place.path().join("asked");
    let child = crate::common::pericles(place.path())
        .args(format!("{SLOW} --out asked").split_whitespace())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let checkpoint = out.join("checkpoints/step-000000000000.chk");
    let run = Background::waiting(child, || checkpoint.is_file());
    std::thread::sleep(Duration::from_millis(300));
    let asked = Instant::now();
    run.signal("TERM");
    let output = run.finish();
    assert_eq!(output.status.code(), Some(143), "{}", text(&output.stderr));
    assert!(asked.elapsed() < Duration::from_secs(10));
    for name in ["late", "asked"] {
        let report = report(&place.path().join(name));
        assert_eq!(report["status"], "stopped");
        // The interrupted load step is undone.
        assert_eq!(report["progress"]["last_step"], 0);
        assert_eq!(report["audit"]["elastic_energy"], 0.0);
    }
}

#[test]
fn sighup_and_sigusr1_stop_with_a_checkpoint() {
    let place = with_plate();
    succeed(place.path(), &format!("{LONG} --out whole"));
    let out = place.path().join("stopped");
    let run = Background::start(place.path(), &format!("{LONG} --out stopped"), "stopped");
    run.signal("USR1");
    assert_eq!(run.finish().status.code(), Some(138));
    let step = report(&out)["progress"]["last_step"].as_u64().unwrap();
    let rows = || {
        let history = fs::read_to_string(out.join("history.csv"));
        history.map_or(0, |rows| rows.lines().count())
    };
    let before = rows();
    let child = crate::common::pericles(place.path())
        .args(["resume", "stopped", "--threads", "1"])
        .spawn()
        .unwrap();
    let run = Background::waiting(child, || rows() > before + 3);
    // An ignored SIGHUP, as under nohup, stays ignored.
    if is_ignored("HUP") {
        run.signal("TERM");
        run.finish();
    } else {
        run.signal("HUP");
        assert_eq!(run.finish().status.code(), Some(129));
        assert_eq!(report(&out)["progress"]["first_step"], step);
    }
    succeed(place.path(), "resume stopped --quiet");
    assert_same_results(&place.path().join("whole"), &out);
}

#[test]
fn an_ignored_sighup_stays_ignored() {
    let place = with_plate();
    let line = format!(
        "trap '' HUP; exec {} {LONG} --quiet --out kept",
        env!("CARGO_BIN_EXE_pericles")
    );
    let child = std::process::Command::new("sh")
        .args(["-c", &line])
        .current_dir(place.path())
        .spawn()
        .unwrap();
    let history = place.path().join("kept/history.csv");
    let run = Background::waiting(child, || {
        fs::read_to_string(&history).is_ok_and(|rows| rows.lines().count() > 4)
    });
    run.signal("HUP");
    assert_eq!(run.finish().status.code(), Some(0));
}

/// Returns whether child processes inherit the signal as ignored.
fn is_ignored(name: &str) -> bool {
    let script = format!("trap - {name}; kill -{name} $$; exit 0");
    let status = std::process::Command::new("sh")
        .args(["-c", &script])
        .status();
    status.unwrap().success()
}

/// Quasi-static fracture of the plate; the run ends when it no longer carries load.
const TORN: &str = "run plate.toml --quiet --set time={scheme='adaptive-dynamic-relaxation',load_steps=16,end=8e-6,stop_when=[{set='top',reaction_below=0.6}]} \
                    --set checkpoint.every=3 --set load.0.traction=[0,0] --set output.fields.every=2 --set output.history.every=1 --set output.cracks.every=1 \
                    --set output.picture.1.every=4";

#[test]
fn a_stop_condition_ends_a_resumed_run_at_the_same_step() {
    let place = with_plate();
    for name in ["whole", "begun"] {
        succeed(place.path(), &format!("{TORN} --out {name}"));
    }
    let whole = report(&place.path().join("whole"));
    assert_eq!(whole["status"], "finished");
    let last = whole["progress"]["last_step"].as_u64().unwrap();
    assert!((3..16).contains(&last), "{last}");
    let reason = whole["stop_reason"].as_str().unwrap();
    assert!(
        reason.starts_with("the reaction of `top` has fallen to"),
        "{reason}"
    );
    // The final state is written to the files.
    let history = fs::read_to_string(place.path().join("whole/history.csv")).unwrap();
    assert!(
        history
            .lines()
            .last()
            .unwrap()
            .starts_with(&format!("{last},"))
    );
    // As if the run had been killed before the load step in which the plate failed: the peak load lies before.
    let begun = place.path().join("begun");
    for entry in fs::read_dir(begun.join("checkpoints")).unwrap() {
        let path = entry.unwrap().path();
        let step: u64 = path.file_stem().unwrap().to_str().unwrap()[5..]
            .parse()
            .unwrap();
        if step + 1 > last {
            fs::remove_file(path).unwrap();
        }
    }
    let json = fs::read_to_string(begun.join("run.json")).unwrap();
    fs::write(
        begun.join("run.json"),
        json.replace("\"finished\"", "\"running\""),
    )
    .unwrap();
    let said = text(&succeed(place.path(), "resume begun").stdout);
    assert!(
        said.contains("stop condition reached: the reaction of `top`"),
        "{said}"
    );
    assert_eq!(report(&begun)["stop_reason"], reason);
    assert_same_results(&place.path().join("whole"), &begun);
    let again = succeed(place.path(), "resume begun");
    assert!(text(&again.stdout).contains("has finished"));
}

/// A ring of listed points with initial velocities from a file, as if stopped between a checkpoint and its end: the
/// final status is reset.
fn stopped_ring(place: &Path, out: &str) {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/points");
    for file in ["ring.toml", "ring.txt"] {
        fs::copy(examples.join(file), place.join(file)).unwrap();
    }
    let deck = fs::read_to_string(place.join("ring.toml")).unwrap();
    let (before, after) = deck.split_once("velocity = [{").unwrap();
    let (_, after) = after.split_once('\n').unwrap();
    let deck = format!("{before}file = \"start.txt\"\n{after}");
    fs::write(place.join("ring.toml"), deck).unwrap();
    let points = fs::read_to_string(place.join("ring.txt")).unwrap();
    let points = points.lines().filter(|line| !line.starts_with(['#', 'h']));
    let start: String = points.map(|_| "0 0 1 0.5\n").collect();
    fs::write(place.join("start.txt"), start).unwrap();
    let run = format!(
        "run ring.toml --quiet --out {out} --set time.end=10us --set time.dt=0.1us --set checkpoint.every=60"
    );
    succeed(place, &run);
    let report = place.join(out).join("run.json");
    let text = fs::read_to_string(&report).unwrap();
    fs::write(&report, text.replacen("\"finished\"", "\"running\"", 1)).unwrap();
    fs::remove_file(place.join(out).join("checkpoints/step-000000000100.chk")).unwrap();
}

#[test]
fn a_run_is_resumed_from_another_folder() {
    let place = tempfile::tempdir().unwrap();
    stopped_ring(place.path(), "ring");
    let whole = crate::common::results(&place.path().join("ring"));
    let elsewhere = tempfile::tempdir().unwrap();
    let folder = place.path().join("ring");
    let said = succeed(elsewhere.path(), &format!("resume {}", folder.display()));
    let said = text(&said.stderr);
    assert!(said.contains("step 60 of 100"), "{said}");
    assert_eq!(report(&folder)["status"], "finished");
    assert!(crate::common::results(&folder) == whole);
    let inputs = &report(&folder)["deck"]["inputs"]["files"];
    assert_eq!(inputs[0]["file"], "ring.txt");
    assert_eq!(inputs[1]["file"], "start.txt");
    assert_eq!(inputs[0]["sha256"].as_str().unwrap().len(), 64);
    // Results can also be re-rendered from there.
    succeed(
        elsewhere.path(),
        &format!("plot {} --field Velocity", folder.display()),
    );
}

#[test]
fn a_changed_input_file_is_reported_by_name() {
    let place = tempfile::tempdir().unwrap();
    stopped_ring(place.path(), "ring");
    let rejected = |command: &str, file: &str, says: &str| {
        let (status, message) = fail(place.path(), command);
        assert_eq!(status, 3, "{message}");
        assert!(
            message.contains(&format!("{file} of the run cannot be used: {says}")),
            "{message}"
        );
        assert!(
            message.contains("restore the original file, or start a new run"),
            "{message}"
        );
    };
    type Change = (&'static str, fn(&str) -> String);
    let changes: [Change; 3] = [
        // The last digit of a coordinate.
        ("ring.txt", |text| {
            text.replacen("0.0462500", "0.0462501", 1)
        }),
        // The same points in another order.
        ("ring.txt", |text| {
            let mut lines: Vec<&str> = text.lines().collect();
            lines.reverse();
            lines.join("\n")
        }),
        ("start.txt", |text| text.replacen("0.5", "0.6", 1)),
    ];
    for (file, change) in changes {
        let path = place.path().join(file);
        let before = fs::read_to_string(&path).unwrap();
        assert_ne!(change(&before), before);
        fs::write(&path, change(&before)).unwrap();
        rejected(
            "resume ring",
            file,
            "its content has changed since the run started",
        );
        rejected(
            "plot ring --field Velocity",
            file,
            "its content has changed",
        );
        fs::remove_file(&path).unwrap();
        rejected("resume ring", file, "it no longer exists");
        fs::write(&path, before).unwrap();
    }
    succeed(place.path(), "resume ring");
}

#[test]
fn missing_or_truncated_field_files_are_reported_on_resume() {
    let place = tempfile::tempdir().unwrap();
    stopped_ring(place.path(), "ring");
    let fields = place.path().join("ring/fields");
    let file = fs::OpenOptions::new()
        .write(true)
        .open(fields.join("fields_000002.vtu"))
        .unwrap();
    file.set_len(100).unwrap();
    fs::remove_file(fields.join("fields_000001.vtu")).unwrap();
    let said = text(&succeed(place.path(), "resume ring").stderr);
    assert!(
        said.contains("2 of the 11 field files written so far are missing or truncated, first fields/fields_000001.vtu at t = 1.00 µs"),
        "{said}"
    );
}

/// Two steps of the plate of the tests.
const STEPS: &str = r#"
[[step]]
name = "pull"
[step.time]
end = "2 us"
dt = "0.1 us"
[[step]]
[step.time]
end = "1 us"
dt = "0.1 us"
[[step.load]]
set = "top"
traction = [0, 0]
"#;

#[test]
fn a_deck_with_steps_is_checked_run_and_replaced() {
    let place = with_plate();
    let deck = fs::read_to_string(place.path().join("plate.toml")).unwrap();
    fs::write(place.path().join("steps.toml"), deck + STEPS).unwrap();
    let checked = succeed(place.path(), "check steps.toml --json -");
    let checked: serde_json::Value = serde_json::from_slice(&checked.stdout).unwrap();
    assert_eq!(checked["steps"][0]["steps"], 20);
    assert_eq!(checked["steps"][1]["steps"], 10);
    // The load of the second step is zero, but it starts from a moving body.
    let warnings = checked["steps"][1]["warnings"].to_string();
    assert!(!warnings.contains("nothing acts"), "{warnings}");

    let said = succeed(place.path(), "run steps.toml --out out");
    assert!(
        text(&said.stderr).contains("step 2 of 2: 2"),
        "{}",
        text(&said.stderr)
    );
    let info = succeed(place.path(), "info out");
    let info = text(&info.stdout);
    assert!(
        info.contains("2: finished; velocity-verlet, t = 2.00 µs to 3.00 µs"),
        "{info}"
    );
    let done = succeed(place.path(), "resume out");
    assert!(text(&done.stdout).contains("All 2 steps have finished"));
    succeed(place.path(), "plot out --field Damage --out pictures");

    // The results of steps that the new deck does not have are removed.
    let one = ["--set", "step.1=unset", "--set", "step.0.name=unset"].join(" ");
    succeed(
        place.path(),
        &format!("run steps.toml --quiet --out out --force {one}"),
    );
    let files = crate::common::results(&place.path().join("out"));
    let of_second = |path: &PathBuf| path.starts_with("2") || path.starts_with("1-pull");
    let left: Vec<&PathBuf> = files.keys().filter(|path| of_second(path)).collect();
    assert!(
        left.iter().all(|path| path.ends_with(".manifest")),
        "{left:?}"
    );

    let (status, message) = fail(place.path(), "resume out --set time.end=9us");
    assert_eq!(status, 3);
    assert!(message.contains("it has several steps"), "{message}");
}

#[test]
fn a_run_starts_from_another_one_and_is_extended() {
    let place = with_plate();
    succeed(
        place.path(),
        "run plate.toml --quiet --out first --set time.end=2us --set time.dt=0.1us",
    );
    let second = "plate.toml --set time.end=1us --set time.dt=0.1us --from first";
    let checked = succeed(place.path(), &format!("check {second}"));
    assert!(
        text(&checked.stdout).contains("at t = 2.00 µs"),
        "{}",
        text(&checked.stdout)
    );
    succeed(place.path(), &format!("run {second} --quiet --out second"));
    fs::remove_dir_all(place.path().join("first")).unwrap();
    succeed(place.path(), "resume second --quiet --set time.end=2us");
    assert_eq!(
        report(&place.path().join("second"))["progress"]["last_step"],
        20
    );
    let (status, message) = fail(place.path(), &format!("run {second}"));
    assert_eq!(status, 3);
    assert!(message.contains("first does not exist"), "{message}");
}
