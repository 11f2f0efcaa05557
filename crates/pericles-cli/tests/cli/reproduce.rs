//! `pericles reproduce`: the rows pass, and the output has the form that scripts expect.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::common::{fail, succeed, text};
use serde_json::Value;

/// Asserts that every row with a tolerance passes.
fn assert_holds(results: &Value, id: &str) {
    let failed: Vec<&Value> = rows(results)
        .iter()
        .filter(|row| row["pass"] == false)
        .collect();
    assert!(failed.is_empty(), "{failed:#?}");
    assert_eq!(results["pass"], true);
    assert_eq!(results["study"], id);
}

fn rows(results: &Value) -> &[Value] {
    results["rows"].as_array().unwrap()
}

#[test]
fn branching_as_json_alone() {
    let place = tempfile::tempdir().unwrap();
    let output = succeed(place.path(), "reproduce fracture/branching --json -");
    let out = text(&output.stdout);
    // Only JSON on standard output and, without --out, no figures.
    let results: Value = serde_json::from_str(&out).unwrap_or_else(|_| panic!("{out}"));
    assert_eq!(fs::read_dir(place.path()).unwrap().count(), 0);
    assert_holds(&results, "fracture/branching");
    let keys: Vec<&String> = results.as_object().unwrap().keys().collect();
    assert_eq!(keys, ["paper", "pass", "rows", "seconds", "study"]);
    assert!(results["seconds"].as_f64().unwrap() > 0.0);
    assert!(results["paper"].as_str().unwrap().contains("2022"));
    for row in rows(&results) {
        let keys: Vec<&String> = row.as_object().unwrap().keys().collect();
        assert_eq!(
            keys,
            [
                "absolute",
                "case",
                "computed",
                "expected",
                "note",
                "pass",
                "printed",
                "tolerance"
            ]
        );
        assert_eq!(row["pass"].is_null(), row["expected"].is_null(), "{row}");
        assert!(
            row["absolute"].is_boolean() && row["note"].is_string(),
            "{row}"
        );
    }
    let judged = rows(&results).iter().filter(|row| row["pass"] == true);
    assert!(judged.count() >= 10);
    // The published critical stretch is not reproducible; the row compares with the formula instead.
    let stretch = &rows(&results)[0];
    assert_eq!(stretch["printed"], 0.0013);
    assert_eq!(stretch["expected"], 1.809e-3);
    assert!(stretch["note"].as_str().unwrap().contains("√2"));
}

#[test]
fn inclined_with_figures_and_table() {
    let place = tempfile::tempdir().unwrap();
    let line = "reproduce fracture/inclined --out figures --json results.json";
    let output = succeed(place.path(), line);
    for name in ["damage.png", "tip.png", "speed.png"] {
        let bytes = fs::read(place.path().join("figures").join(name)).unwrap();
        assert!(bytes.starts_with(b"\x89PNG"), "{name}");
    }
    let results = fs::read_to_string(place.path().join("results.json")).unwrap();
    let results: Value = serde_json::from_str(&results).unwrap();
    assert_holds(&results, "fracture/inclined");
    let angles = rows(&results)
        .iter()
        .filter(|row| row["case"].as_str().unwrap().starts_with("angle of arm"));
    assert_eq!(angles.count(), 4);
    let table = text(&output.stdout);
    assert!(table.contains("| verdict"), "{table}");
    for row in rows(&results) {
        assert!(table.contains(row["case"].as_str().unwrap()), "{row}");
    }
    let (status, message) = fail(place.path(), line);
    assert_eq!(status, 6, "{message}");
}

#[test]
fn all_studies_are_listed() {
    let place = tempfile::tempdir().unwrap();
    let list = text(&succeed(place.path(), "reproduce --list").stdout);
    for id in [
        "dispersion/one-dimensional",
        "dispersion/pulse",
        "fracture/branching",
        "fracture/inclined",
        "manifolds/figure-2",
        "manifolds/figure-6",
        "manifolds/convergence",
        "multi-time-step/plate",
        "multi-time-step/two-grid",
    ] {
        let named = list
            .lines()
            .filter(|line| line.split(' ').next() == Some(id));
        assert_eq!(named.count(), 1, "{list}");
    }
}

/// Pages written by `book/verification.py` list all studies with their titles and papers, and no others; no comparison
/// fails, and the book contains the page of every topic.
#[test]
fn the_verification_pages_list_all_studies() {
    let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../book/src");
    let read = |name: &str| fs::read_to_string(book.join(name)).unwrap();
    let summary = [read("verification.md"), read("SUMMARY.md")];
    let mut expected: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for study in pericles_studies::studies() {
        let (id, title, paper) = (study.id, study.title, study.paper);
        let (topic, _) = id.split_once('/').unwrap();
        let anchor = id.replace('/', "");
        let row = format!("| [{id}](#{anchor}) | {title} | {paper} |");
        expected.entry(topic).or_default().push(row);
    }
    for (topic, studies) in &expected {
        let name = format!("verification/{topic}.md");
        for page in &summary {
            assert!(page.contains(&format!("({name})")), "{name}:\n{page}");
        }
        let page = read(&name);
        let listed: Vec<&str> = page.lines().filter(|row| row.starts_with("| [")).collect();
        assert_eq!(listed.len(), studies.len(), "{name}: {listed:#?}");
        for (row, study) in listed.iter().zip(studies) {
            let [rows, pass] = *row
                .strip_prefix(study.as_str())
                .unwrap_or_else(|| panic!("{name}: {row} is not {study}: run book/verification.py"))
                .split('|')
                .map(str::trim)
                .filter(|cell| !cell.is_empty())
                .collect::<Vec<_>>()
            else {
                panic!("{row}");
            };
            assert_eq!(rows, pass, "{row}");
        }
    }
    let pages = fs::read_dir(book.join("verification")).unwrap();
    // The page of the tests is written by hand.
    assert_eq!(pages.count(), expected.len() + 1);
}
