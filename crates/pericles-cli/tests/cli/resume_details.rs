//! Resumed runs: warnings, counters and field files equal those of an uninterrupted run.

use std::fs;

use crate::common::{report, succeed, with_plate};
use serde_json::Value;

/// A heated plate of which more than half of the bonds break at an early step.
const SHATTERED: &str = "run plate.toml --quiet --threads 1 --set material.critical_stretch=2e-5 --set checkpoint.every=60 \
                         --set thermal={conductivity=50,specific_heat=500,temperature=300,scheme='backward-euler',condition=[{set='top',temperature=400}]}";

fn warnings(report: &Value) -> Vec<String> {
    let lists = [&report["model"]["warnings"], &report["audit"]["warnings"]];
    let texts = lists
        .iter()
        .flat_map(|list| list.as_array().unwrap().clone());
    let texts = texts.map(|text| text.as_str().unwrap().to_owned());
    texts
        .filter(|text| !text.contains("missing or truncated"))
        .collect()
}

/// Sets the status of a finished run to that of a killed one, so that it is resumed from its last checkpoint.
fn unfinish(folder: &std::path::Path) {
    let path = folder.join("run.json");
    let text = fs::read_to_string(&path).unwrap();
    let killed = text.replace("\"status\": \"finished\"", "\"status\": \"running\"");
    assert_ne!(text, killed);
    fs::write(path, killed).unwrap();
}

#[test]
fn a_resumed_run_reports_what_the_uninterrupted_run_does() {
    let place = with_plate();
    for name in ["whole", "resumed"] {
        succeed(place.path(), &format!("{SHATTERED} --out {name}"));
    }
    let [whole, resumed] = ["whole", "resumed"].map(|name| place.path().join(name));
    unfinish(&resumed);
    // A lost field file, and the remains of a crash.
    fs::remove_file(resumed.join("fields/fields_000000.vtu")).unwrap();
    let parts = [
        "history.csv",
        "fields/fields_000009.vtu",
        "pictures/a.png",
        "cells/a.vtu",
    ];
    let parts = parts.map(|name| {
        let path = resumed.join(name);
        let file = path.file_name().unwrap().to_str().unwrap().to_owned();
        path.with_file_name(format!(".{file}.7-0.part"))
    });
    for part in &parts {
        fs::create_dir_all(part.parent().unwrap()).unwrap();
        fs::write(part, "x").unwrap();
    }
    succeed(place.path(), "resume resumed --quiet --threads 1");
    for part in &parts {
        assert!(!part.exists(), "{}", part.display());
    }
    let reports = [&whole, &resumed].map(|folder| report(folder));
    assert!(reports[1]["progress"]["first_step"].as_u64().unwrap() > 0);
    let [expected, found] = reports.each_ref().map(warnings);
    assert!(
        expected.iter().any(|text| text.contains("of all bonds")),
        "{expected:?}"
    );
    assert_eq!(found, expected);
    let [expected, found] = reports.each_ref().map(|report| {
        let heat = &report["audit"]["heat"];
        ["products", "most_products"].map(|key| heat[key].as_u64().unwrap())
    });
    assert!(expected[0] > 0);
    assert_eq!(found, expected);
    // Cells stay cells, also without the first file.
    let last = |folder: &std::path::Path| {
        let files = fs::read_dir(folder.join("fields")).unwrap();
        let last = files.map(|file| file.unwrap().path()).max().unwrap();
        fs::read(last).unwrap()
    };
    assert!(last(&whole) == last(&resumed));
}
