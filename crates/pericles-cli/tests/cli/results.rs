//! The commands on results, `new`, and sweeps.

use std::fs;

use crate::common::{fail, run, succeed, text, with_plate};
use pericles_deck::Deck;
use pericles_io::OutputFolder;
use pericles_run::{Assembled, Cancel, Ending, Event, Means, Run, Source};
use serde_json::Value;

#[test]
fn an_example_is_copied_without_overwriting_and_is_a_valid_deck() {
    let place = tempfile::tempdir().unwrap();
    let list = text(&succeed(place.path(), "new").stdout);
    assert!(list.contains("\nfracture/branching  "), "{list}");
    let said = text(&succeed(place.path(), "new wave/bar").stdout);
    assert!(said.contains("pericles run bar.toml"), "{said}");
    succeed(place.path(), "check bar.toml");
    let (status, message) = fail(place.path(), "new wave/bar");
    assert_eq!(status, 6, "{message}");
    assert!(message.contains("bar.toml already exists"), "{message}");
    succeed(place.path(), "new wave/bar mine.toml");
    let shown = succeed(place.path(), "new wave/bar -").stdout;
    assert_eq!(
        text(&shown),
        fs::read_to_string(place.path().join("mine.toml")).unwrap()
    );
    // The name alone suffices if it is unique.
    succeed(place.path(), "new branching");
    let (status, message) = fail(place.path(), "new bar");
    assert_eq!(status, 2);
    assert!(message.contains("statics/bar or wave/bar"), "{message}");
    let (status, message) = fail(place.path(), "new wave/baar");
    assert_eq!(status, 2);
    assert!(message.contains("did you mean wave/bar?"), "{message}");
}

#[test]
fn info_shows_status_and_contents() {
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
        "2 output times from 0 s to 9.00 µs",
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
fn diff_reports_differences_and_their_size() {
    let place = with_plate();
    let start = |out: &str, more: &str| {
        let line = format!("run plate.toml --quiet --out {out} --set time.end=\"9us\" {more}");
        succeed(place.path(), &line);
    };
    start("a", "--threads 1");
    start("b", "--threads 2");
    // A load larger by 1e-6 (relative).
    start("c", "--set load.0.traction=[1.000001e6,0]");
    start("d", "--set output.history.every=3");
    let same = text(&succeed(place.path(), "diff a b").stdout);
    assert!(same.contains("bitwise identical"), "{same}");

    let differ = run(place.path(), "diff a c");
    assert_eq!(differ.status.code(), Some(5));
    let said = text(&differ.stdout);
    assert!(said.contains("Displacement"), "{said}");
    assert!(said.contains("history.csv"), "{said}");
    assert!(said.contains("at t = 9.00 µs, point"), "{said}");
    // The response is linear except for broken bonds: relative differences of about 1e-6.
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
        text(&differ.stdout).contains("14 rows in the first, 31 in the second"),
        "{}",
        text(&differ.stdout)
    );
    // Two of three rows of d have no row in a at the same time; the others are compared.
    let json = run(place.path(), "diff a d --json -").stdout;
    let report: Value = serde_json::from_slice(&json).unwrap();
    assert!(report["skipped"].as_u64() > Some(20), "{report:#}");
    let compared = |name: &str| {
        let rows = report["rows"].as_array().unwrap();
        let row = rows
            .iter()
            .find(|row| row["name"] == name && row["place"] == "history.csv");
        let row = row.unwrap();
        (
            row["values"].as_u64().unwrap(),
            row["different"].as_u64().unwrap(),
        )
    };
    // Steps 0, 21, 42, 63, 84 and the last.
    assert_eq!(compared("step"), (6, 0));
    assert_eq!(compared("kinetic_energy"), (6, 0));
    assert_eq!(fail(place.path(), "diff a gone").0, 3);
    assert_eq!(fail(place.path(), "diff a b --tolerance -1").0, 2);
}

#[test]
fn diff_matches_times_up_to_rounding_and_counts_the_others() {
    let place = with_plate();
    succeed(
        place.path(),
        "run plate.toml --quiet --out a --set time.end=\"9us\" --set output.fields.every=30",
    );
    let copy = std::process::Command::new("cp")
        .args(["-r", "a", "b"])
        .current_dir(place.path())
        .status();
    assert!(copy.unwrap().success());
    let series = place.path().join("b/fields.pvd");
    let text_of = fs::read_to_string(&series).unwrap();
    let times: Vec<&str> = text_of
        .split("timestep=\"")
        .skip(1)
        .map(|rest| &rest[..rest.find('"').unwrap()])
        .collect();
    assert_eq!(times.len(), 4, "{text_of}");
    let last: f64 = times[3].parse().unwrap();
    let moved = |time: f64| text_of.replace(times[3], &format!("{time:e}"));

    fs::write(&series, moved(f64::from_bits(last.to_bits() + 1))).unwrap();
    let said = text(&succeed(place.path(), "diff a b").stdout);
    assert!(
        said.contains("bitwise identical") && !said.contains("not compared"),
        "{said}"
    );

    fs::write(&series, moved(1.1 * last)).unwrap();
    let differ = run(place.path(), "diff a b");
    assert_eq!(differ.status.code(), Some(5));
    let said = text(&differ.stdout);
    for words in [
        "fields: 1 of the 4 states of the first result, from t = 9.00 µs, not compared: the second has none at the same time",
        "fields: 1 of the 4 states of the second result, from t = 9.90 µs, not compared: the first has none at the same time",
        "; 2 states and rows were not compared",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
}

#[test]
fn completions_and_the_manual_page_are_printed() {
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

#[cfg(unix)]
#[test]
fn a_report_does_not_follow_links() {
    let place = with_plate();
    succeed(place.path(), "run plate.toml --quiet --set time.end=1e-6");
    let secret = place.path().join("secret.png");
    fs::write(&secret, "a private file").unwrap();
    let link = place.path().join("plate/pictures/Damage-000099.png");
    std::os::unix::fs::symlink(&secret, link).unwrap();
    succeed(place.path(), "report plate");
    let page = fs::read_to_string(place.path().join("plate/report.html")).unwrap();
    assert!(page.contains("Damage-000002.png"));
    assert!(!page.contains("Damage-000099.png"));
}

#[test]
fn control_characters_in_titles_and_names_are_escaped() {
    let place = with_plate();
    let deck = crate::common::PLATE.replace("Torn plate", "Torn\\u001b[2J plate\\u0007\\u202e");
    fs::write(place.path().join("plate.toml"), deck).unwrap();
    let ran = succeed(place.path(), "run plate.toml --set time.end=1e-6");
    let check = succeed(place.path(), "check plate.toml");
    let info = succeed(place.path(), "info plate");
    let rejected = run(place.path(), "check plate.toml --set \u{1b}[2J=1");
    for output in [ran, check, info, rejected] {
        for said in [text(&output.stdout), text(&output.stderr)] {
            let control = |c: char| (c.is_control() && c != '\n') || c == '\u{202e}';
            assert!(!said.contains(control), "{said:?}");
        }
    }
}

#[test]
fn a_report_is_a_self_contained_page() {
    let place = with_plate();
    let deck = crate::common::PLATE.replace("Torn plate", "Torn <plate>");
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
    // All pictures are embedded in the page.
    assert_eq!(
        page.matches("<img ").count(),
        page.matches("src=\"data:image/png;base64,iVBOR").count()
    );
    assert!(!page.contains("http"), "a link");
    // The page is one of the files of the run and is replaced with them.
    succeed(
        place.path(),
        "run plate.toml --quiet --set time.end=1e-6 --out plate --force",
    );
    assert!(!place.path().join("plate/report.html").exists());
}

#[test]
fn a_sweep_runs_every_value_and_can_be_resumed() {
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
    // A run of a sweep is identical to the single run.
    let one = "run plate.toml --quiet --out one --set time.end=\"9us\" --set material.horizon_ratio=3 --set load.0.traction=[2e6,0]";
    succeed(place.path(), one);
    crate::common::assert_same_results(
        &place.path().join("one"),
        &sweep.join("horizon_ratio=3,traction=_2e6,0_"),
    );

    // One run is missing, one was stopped early.
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

#[test]
fn extremes_in_the_history_and_volumes_in_field_files_are_written_on_request() {
    let place = with_plate();
    succeed(
        place.path(),
        "run plate.toml --quiet --set output.history.extremes=[\"Velocity_y\",\"Damage\",\"Displacement\"] \
         --set output.fields.names=[\"Volume\",\"Damage\",\"Displacement\",\"Velocity\"] --set output.history.every=90",
    );
    let history = pericles_io::read_csv(place.path().join("plate/history.csv")).unwrap();
    let column = |name: &str| history.column(name).unwrap();
    let states = pericles_io::read_fields(
        place.path().join("plate/fields/fields_000004.vtu"),
        u64::MAX,
    )
    .unwrap();
    // The fourth output is at step 360, like the fifth row.
    assert_eq!(column("step")[4], 360.0);
    let field = |name: &str| states.field(name).unwrap().values.clone();
    let most = |values: &[f64]| values.iter().fold(f64::NEG_INFINITY, |a: f64, b| a.max(*b));
    let least = |values: &[f64]| values.iter().fold(f64::INFINITY, |a: f64, b| a.min(*b));
    assert_eq!(column("max_Damage")[4], most(&field("Damage")));
    assert_eq!(column("min_Damage")[4], least(&field("Damage")));
    let y: Vec<f64> = field("Velocity").chunks(3).map(|v| v[1]).collect();
    assert_eq!(
        (column("min_Velocity_y")[4], column("max_Velocity_y")[4]),
        (least(&y), most(&y))
    );
    let size: Vec<f64> = field("Displacement")
        .chunks(3)
        .map(|u| u[0].hypot(u[1]))
        .collect();
    let ratio = column("max_Displacement")[4] / most(&size);
    assert!((ratio - 1.0).abs() < 1e-14, "{ratio}");
    // Cells of 1 mm × 1 mm × 1 m.
    let volume: f64 = field("Volume").iter().sum();
    assert!((volume / (0.024 * 0.012) - 1.0).abs() < 1e-12, "{volume}");
}

#[test]
fn the_run_json_of_another_program_is_rejected() {
    let place = tempfile::tempdir().unwrap();
    fs::write(place.path().join("run.json"), "{}").unwrap();
    for command in ["info .", "report .", "plot ."] {
        let (status, message) = fail(place.path(), command);
        assert_eq!(status, 3, "{message}");
        assert!(
            message.contains("its run.json was not written by Pericles"),
            "{message}"
        );
    }
}

#[test]
fn too_many_threads_are_rejected() {
    let place = with_plate();
    let (status, message) = fail(place.path(), "check plate.toml --threads 8000");
    assert_eq!(status, 2, "{message}");
    assert!(message.contains("an integer from 1 to"), "{message}");
}

#[test]
fn commands_work_on_the_folder_of_a_model_without_a_deck() {
    let place = with_plate();
    let short = ["time.end=\"9 us\"".to_owned()];
    succeed(
        place.path(),
        "run plate.toml --quiet --set time.end=\"9us\"",
    );
    // A program starts the same run and stops it.
    let deck = Deck::read(place.path().join("plate.toml"), &short).unwrap();
    let source = Source::of_model(deck.model, place.path());
    let assembled = Assembled::of(&source, &Means::default(), &mut |_| {}).unwrap();
    let folder = OutputFolder::create(place.path().join("model"), false).unwrap();
    let mut run = Run::begin(&source, assembled, folder).unwrap();
    let cancel = Cancel::new();
    let ending = run.drive(None, &cancel.clone(), &mut |event| {
        if let Event::Step { step: 40, .. } = event {
            cancel.cancel();
        }
    });
    assert_eq!(ending.unwrap(), Ending::Cancelled);
    drop(run);

    succeed(place.path(), "resume model --quiet");
    let said = text(&succeed(place.path(), "info model").stdout);
    for words in [
        "model: Torn plate",
        "finished; step 90 of 90",
        "built by a program",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    succeed(place.path(), "diff plate model");
    for (folder, plots) in [("plate", "a"), ("model", "b")] {
        succeed(place.path(), &format!("plot {folder} --out {plots}"));
    }
    let drawn = |plots: &str| {
        let picture = place.path().join(plots).join("Damage-000001.png");
        fs::read(picture).unwrap()
    };
    assert_eq!(drawn("a"), drawn("b"));
    succeed(place.path(), "report model");
    let page = fs::read_to_string(place.path().join("model/report.html")).unwrap();
    assert!(
        page.contains("Model data") && page.contains("plane-stress"),
        "{page}"
    );
}
