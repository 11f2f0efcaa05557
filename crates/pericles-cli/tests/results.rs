//! Looking at results, and starting from an example.

mod common;

use std::fs;

use common::{fail, run, succeed, text, with_plate};
use serde_json::Value;

#[test]
fn an_example_is_written_once_and_is_a_deck() {
    let place = tempfile::tempdir().unwrap();
    let list = text(&succeed(place.path(), "new").stdout);
    assert!(list.contains("\nfracture/branching  "), "{list}");
    let said = text(&succeed(place.path(), "new wave/bar").stdout);
    assert!(said.contains("pericles run bar.toml"), "{said}");
    succeed(place.path(), "check bar.toml");
    let (status, message) = fail(place.path(), "new wave/bar");
    assert_eq!(status, 6, "{message}");
    assert!(message.contains("bar.toml exists already"), "{message}");
    succeed(place.path(), "new wave/bar mine.toml");
    let shown = succeed(place.path(), "new wave/bar -").stdout;
    assert_eq!(
        text(&shown),
        fs::read_to_string(place.path().join("mine.toml")).unwrap()
    );
    // The name alone is enough where only one topic has it.
    succeed(place.path(), "new branching");
    let (status, message) = fail(place.path(), "new bar");
    assert_eq!(status, 2);
    assert!(message.contains("statics/bar or wave/bar"), "{message}");
    let (status, message) = fail(place.path(), "new wave/baar");
    assert_eq!(status, 2);
    assert!(message.contains("did you mean wave/bar?"), "{message}");
}

#[test]
fn info_tells_how_a_run_stands_and_what_there_is() {
    let place = with_plate();
    succeed(
        place.path(),
        "run plate.toml --quiet --set title=\"Short\" --set time.end=\"9us\"",
    );
    let said = text(&succeed(place.path(), "info plate").stdout);
    for words in [
        "plate: Short",
        "finished; step 90 of 90, t = 9.00 µs",
        "plate.toml --set title=\"Short\"",
        "2 states from 0 s to 9.00 µs",
        "Damage",
        "history.csv, 14 rows: step, time",
        "pictures/",
        "bonds broken",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    fs::create_dir(place.path().join("other")).unwrap();
    let (status, message) = fail(place.path(), "info other");
    assert_eq!(status, 3);
    assert!(message.contains("run.json"), "{message}");
    fs::write(place.path().join("plate/run.json"), "{").unwrap();
    assert_eq!(fail(place.path(), "info plate").0, 3);
}

#[test]
fn diff_finds_what_differs_and_how_much() {
    let place = with_plate();
    let start = |out: &str, more: &str| {
        let line = format!("run plate.toml --quiet --out {out} --set time.end=\"9us\" {more}");
        succeed(place.path(), &line);
    };
    start("a", "--threads 1");
    start("b", "--threads 2");
    // A load that is larger by a millionth.
    start("c", "--set load.0.traction=[1.000001e6,0]");
    start("d", "--set output.history.every=3");
    let same = text(&succeed(place.path(), "diff a b").stdout);
    assert!(same.contains("the same, bit for bit"), "{same}");

    let differ = run(place.path(), "diff a c");
    assert_eq!(differ.status.code(), Some(5));
    let said = text(&differ.stdout);
    assert!(said.contains("Displacement"), "{said}");
    assert!(said.contains("history.csv"), "{said}");
    assert!(said.contains("at t = 9.00 µs, point"), "{said}");
    // The response is linear but for what breaks: a millionth, or a little more where velocities of the ends prevail.
    succeed(place.path(), "diff a c --tolerance 1e-4");
    let json = succeed(place.path(), "diff a c --tolerance 1e-4 --json -").stdout;
    let report: Value = serde_json::from_slice(&json).unwrap();
    let rows = report["rows"].as_array().unwrap();
    let of = |name: &str| {
        rows.iter()
            .find(|row| row["name"] == name && row["place"] == "fields")
            .unwrap()
    };
    assert!(of("Displacement")["relative"].as_f64().unwrap() > 1e-9);
    assert_eq!(of("Points")["different"], 0);

    let differ = run(place.path(), "diff a d --tolerance 1");
    assert_eq!(differ.status.code(), Some(5));
    assert!(
        text(&differ.stdout).contains("14 rows against 31"),
        "{}",
        text(&differ.stdout)
    );
    assert_eq!(fail(place.path(), "diff a gone").0, 3);
    assert_eq!(fail(place.path(), "diff a b --tolerance -1").0, 2);
}

#[test]
fn shells_and_manuals_get_what_they_read() {
    let place = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish"] {
        let script = text(&succeed(place.path(), &format!("completions {shell}")).stdout);
        assert!(script.contains("reproduce"), "{shell}");
    }
    let page = text(&succeed(place.path(), "man").stdout);
    assert!(
        page.contains(".TH") && page.contains(".SH PERICLES RESUME"),
        "{page}"
    );
}

#[test]
fn a_report_is_one_page_with_everything() {
    let place = with_plate();
    let deck = common::PLATE.replace("Torn plate", "Torn <plate>");
    fs::write(place.path().join("plate.toml"), deck).unwrap();
    succeed(place.path(), "run plate.toml --quiet");
    let said = text(&succeed(place.path(), "report plate").stdout);
    assert_eq!(said, "plate/report.html\n");
    let page = fs::read_to_string(place.path().join("plate/report.html")).unwrap();
    for words in [
        "<h1>Torn &lt;plate&gt;</h1>",
        "finished; step 400 of 400",
        "Velocity y (Velocity_y-000",
        "energy (history.csv)",
        "corner u (probes.csv)",
        "energy drift",
        "horizon_ratio = 3",
    ] {
        assert!(page.contains(words), "{words}");
    }
    // Nothing is fetched: every picture is in the page.
    assert_eq!(
        page.matches("<img ").count(),
        page.matches("src=\"data:image/png;base64,iVBOR").count()
    );
    assert!(!page.contains("http"), "a link");
    // It belongs to the results, and goes with them.
    succeed(
        place.path(),
        "run plate.toml --quiet --set time.end=1e-6 --out plate --force",
    );
    assert!(!place.path().join("plate/report.html").exists());
}

#[test]
fn a_sweep_runs_every_value_and_goes_on_where_it_was_stopped() {
    let place = with_plate();
    let line = "run plate.toml --quiet --set time.end=\"9us\" --sweep material.horizon_ratio=2,3 --sweep load.0.traction=[1e6,0],[2e6,0]";
    succeed(place.path(), line);
    let sweep = place.path().join("plate-sweep");
    let table = fs::read_to_string(sweep.join("summary.csv")).unwrap();
    let rows: Vec<&str> = table.lines().collect();
    assert_eq!(rows.len(), 5, "{table}");
    assert!(
        rows[0].starts_with("run,material.horizon_ratio,load.0.traction,status,points,"),
        "{table}"
    );
    assert!(rows[0].contains("corner_u_x [m]"), "{table}");
    assert!(
        rows[4].starts_with("\"horizon_ratio=3,traction=_2e6,0_\",3,\"[2e6,0]\",finished,288,"),
        "{table}"
    );
    // A run of a sweep is the run that one would do by hand.
    let one = "run plate.toml --quiet --out one --set time.end=\"9us\" --set material.horizon_ratio=3 --set load.0.traction=[2e6,0]";
    succeed(place.path(), one);
    common::assert_same_results(
        &place.path().join("one"),
        &sweep.join("horizon_ratio=3,traction=_2e6,0_"),
    );

    // One run is lost, one was stopped early.
    fs::remove_dir_all(sweep.join("horizon_ratio=2,traction=_1e6,0_")).unwrap();
    let stopped = sweep.join("horizon_ratio=2,traction=_2e6,0_/run.json");
    let text = fs::read_to_string(&stopped).unwrap();
    fs::write(&stopped, text.replace("\"finished\"", "\"running\"")).unwrap();
    fs::remove_file(sweep.join("summary.csv")).unwrap();
    succeed(place.path(), "resume plate-sweep --quiet");
    assert_eq!(
        fs::read_to_string(sweep.join("summary.csv")).unwrap(),
        table
    );

    let (status, message) = fail(
        place.path(),
        "run plate.toml --sweep body.spacing=1e-3,0.7e-3",
    );
    assert_eq!(status, 3, "{message}");
    assert!(message.contains("whole number of cells"), "{message}");
    assert_eq!(fail(place.path(), "run plate.toml --sweep spacing").0, 2);
}
