//! Reproducibility of all examples: bitwise identical results for any number of threads, after a resume, and after the
//! process is killed at any time.
//!
//! Long; run with `cargo test --release --workspace --test cli trust -- --ignored --nocapture`, which prints a table. Short
//! versions in `resume.rs` always run.

use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};
use std::time::Duration;

use crate::common::{assert_same_results, fail, pericles, report, results, succeed};

/// Returns the decks under `examples/`.
fn decks() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let list = |folder: &Path| -> Vec<PathBuf> {
        let entries = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path());
        entries.collect()
    };
    let mut decks: Vec<PathBuf> = list(&root)
        .iter()
        .filter(|path| path.is_dir())
        .flat_map(|topic| list(topic))
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .filter(|path| !path.ends_with("expected.toml"))
        .collect();
    decks.sort();
    assert!(decks.len() >= 13);
    decks
}

fn fingerprint(folder: &Path) -> u64 {
    let mut hasher = DefaultHasher::new();
    results(folder).hash(&mut hasher);
    hasher.finish()
}

/// Makes a finished run look as if it had been killed after its second last checkpoint.
fn undo(folder: &Path) {
    let path = folder.join("run.json");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replace("\"finished\"", "\"running\"")).unwrap();
}

/// Time limit for the run of an example in seconds; PERICLES_SECONDS overrides the default.
fn seconds() -> f64 {
    std::env::var("PERICLES_SECONDS").map_or(10.0, |seconds| seconds.parse().unwrap())
}

/// Returns the override that shortens the run of a deck on one thread to [`seconds`]: none, or the end time reached
/// within the limit.
fn cut(place: &Path, deck: &Path) -> String {
    let line = format!(
        "run {} --quiet --no-cache --threads 1 --out probe --force --wall-time {}s",
        deck.display(),
        seconds()
    );
    let output = crate::common::run(place, &line);
    match output.status.code() {
        Some(0) => String::new(),
        Some(7) => format!(
            "--set time.end={}",
            report(&place.join("probe"))["progress"]["t"]
        ),
        _ => panic!("{line}: {}", crate::common::text(&output.stderr)),
    }
}

#[test]
#[ignore = "minutes: every example on 1, 2, 3 and 7 threads, run and resumed"]
fn every_example_is_reproducible_for_any_number_of_threads_and_after_a_resume() {
    let place = tempfile::tempdir().unwrap();
    println!(
        "A run that takes longer than {} s on one thread is cut to the steps that fit.\n\n\
         | deck | steps | broken bonds | threads 1 | 2 | 3 | 7 | resumed: 1 → 2 | 2 → 1 |\n|---|---|---|---|---|---|---|---|---|",
        seconds()
    );
    let (mut wrong, mut cuts) = (Vec::new(), 0);
    for deck in decks() {
        let name = format!(
            "{}/{}",
            deck.parent().unwrap().file_name().unwrap().display(),
            deck.file_stem().unwrap().display()
        );
        let cut = cut(place.path(), &deck);
        let run = |threads: usize, out: &str, more: &str| {
            let deck = deck.display();
            succeed(
                place.path(),
                &format!(
                    "run {deck} --quiet --no-cache --threads {threads} --out {out} --force {cut} {more}"
                ),
            );
            place.path().join(out)
        };
        let first = run(1, "one", "");
        let told = report(&first);
        let steps = told["model"]["steps"].as_u64().unwrap();
        let broken = &told["audit"]["broken_bonds"];
        let mut marks = vec![fingerprint(&first)];
        for threads in [2, 3, 7] {
            marks.push(fingerprint(&run(threads, "other", "")));
        }
        // One checkpoint, within the last half.
        let every = format!("--set checkpoint.every={}", (3 * steps / 5).max(1));
        for (before, after) in [(1, 2), (2, 1)] {
            let folder = run(before, "resumed", &every);
            undo(&folder);
            succeed(
                place.path(),
                &format!("resume resumed --quiet --no-cache --threads {after}"),
            );
            assert_eq!(report(&folder)["status"], "finished");
            marks.push(fingerprint(&folder));
        }
        let cells: Vec<String> = marks.iter().map(|mark| format!("{mark:016x}")).collect();
        let part = if cut.is_empty() { "" } else { ", cut" };
        cuts += usize::from(!cut.is_empty());
        println!(
            "| {name} | {steps}{part} | {broken} | {} |",
            cells.join(" | ")
        );
        if marks.iter().any(|mark| *mark != marks[0]) {
            wrong.push(name);
        }
    }
    println!(
        "\n{} decks, {cuts} of them cut; different bytes: {wrong:?}",
        decks().len()
    );
    assert!(wrong.is_empty(), "{wrong:?}");
}

/// Reproducible pseudo-random numbers (SplitMix64, Steele, Lea and Flood).
struct Dice(u64);

impl Dice {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (z ^ (z >> 31)) % limit
    }
}

#[test]
#[ignore = "minutes: 300 kills (or PERICLES_KILLS of them) over three decks"]
fn runs_killed_at_random_times_resume_to_identical_results() {
    let kills: u64 = std::env::var("PERICLES_KILLS").map_or(300, |kills| kills.parse().unwrap());
    let place = tempfile::tempdir().unwrap();
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    fs::write(place.path().join("plate.toml"), crate::common::PLATE).unwrap();
    let often = "--set checkpoint.every=37";
    let cases = [
        format!("plate.toml --set time.end=1e-3 --set output.fields.every=900 {often}"),
        format!("{}/surface/torus.toml {often}", examples.display()),
        format!("{}/absorbing/free-end.toml {often}", examples.display()),
    ];
    let mut dice = Dice(2026);
    for (number, case) in cases.iter().enumerate() {
        let whole = format!("whole-{number}");
        let run = format!("run {case} --quiet --threads 1 --force --out {whole}");
        // The first run fills the cache; the second one measures the run time.
        succeed(place.path(), &run);
        let began = std::time::Instant::now();
        succeed(place.path(), &run);
        let seconds = began.elapsed().as_secs_f64();
        let (mut done, mut runs, mut lives) = (0, 0, 0);
        while done < kills / 3 {
            let out = format!("killed-{number}");
            let _ = fs::remove_dir_all(place.path().join(&out));
            let mut line = format!("run {case} --quiet --out {out}");
            // The run is killed at random times up to its run time, repeatedly until it finishes.
            loop {
                let threads = 1 + dice.below(2);
                let arguments = format!("{line} --threads {threads}");
                let mut child = pericles(place.path())
                    .args(arguments.split_whitespace())
                    .spawn()
                    .unwrap();
                let most = (1e3 * seconds) as u64;
                std::thread::sleep(Duration::from_millis(dice.below(most.max(20))));
                let ended = child.try_wait().unwrap();
                child.kill().unwrap();
                child.wait().unwrap();
                lives += 1;
                let folder = place.path().join(&out);
                if let Some(status) = ended {
                    assert!(status.success(), "{arguments}: {status}");
                    break;
                }
                done += 1;
                // Before its first checkpoint a run cannot be resumed; this is reported.
                let begun = fs::read_dir(folder.join("checkpoints")).is_ok_and(|files| {
                    files.flatten().any(|file| {
                        file.path()
                            .extension()
                            .is_some_and(|ending| ending == "chk")
                    })
                });
                line = if begun {
                    format!("resume {out} --quiet")
                } else {
                    if folder.exists() {
                        assert_eq!(fail(place.path(), &format!("resume {out}")).0, 3);
                    }
                    format!("run {case} --quiet --out {out} --force")
                };
            }
            assert_same_results(&place.path().join(&whole), &place.path().join(&out));
            runs += 1;
        }
        println!(
            "case {number}: {runs} runs, killed {done} times in {lives} processes; all results are identical"
        );
    }
}

#[test]
#[ignore = "minutes: a million steps"]
fn a_million_steps_conserve_energy_without_growing_memory() {
    // A vibrating free bar: velocity Verlet conserves a discrete energy up to rounding, whose sum over N steps grows
    // at most like N, or like √N for random errors.
    const DECK: &str = r#"
[body]
shape = "bar"
length = 100
spacing = 1
[material]
model = "linear"
density = 1
youngs_modulus = 1
horizon_ratio = 3
bonds = "list"
[[initial]]
velocity = { expression = "sin(0.1*x)" }
[time]
end = 5e5
dt = 0.5
[output]
fields = "never"
history = { count = 1000 }
[checkpoint]
every = 100000
"#;
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("ringing.toml"), DECK).unwrap();
    let peak = |out: &str| {
        report(&place.path().join(out))["progress"]["peak_memory"]
            .as_f64()
            .unwrap()
    };
    succeed(
        place.path(),
        "run ringing.toml --quiet --threads 1 --out short --set time.end=5e2",
    );
    succeed(
        place.path(),
        "run ringing.toml --quiet --threads 1 --out long",
    );
    let history = pericles_io::read_csv(place.path().join("long/history.csv")).unwrap();
    let column = |name: &str| history.column(name).unwrap();
    let energy = column("kinetic_energy")[0];
    let drift = column("balance").iter().map(|b| b / energy);
    let (last, most) = drift.fold((0.0, 0.0f64), |(_, most), d| (d, most.max(d.abs())));
    let grown = peak("long") - peak("short");
    println!(
        "a million steps: relative energy error {last:e} at the end, at most {most:e}; memory {:.1} MB, {:.1} MB more than for a thousand steps",
        1e-6 * peak("long"),
        1e-6 * grown
    );
    // Linear growth of one rounding a step would be 1e6 · 1.1e-16.
    assert!(most < 1.1e-10, "{most:e}");
    assert!(grown < 2e6, "{grown}");
}
