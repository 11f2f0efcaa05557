//! Runs with each instruction set.

use std::fs;
use std::path::Path;

use crate::common::{fail, succeed, with_plate};
use pericles::operator::InstructionSet;
use serde_json::Value;

fn report(folder: &Path) -> Value {
    serde_json::from_slice(&fs::read(folder.join("run.json")).unwrap()).unwrap()
}

#[test]
fn every_instruction_set_breaks_the_same_bonds() {
    let place = with_plate();
    let results = InstructionSet::available().into_iter().map(|set| {
        let name = set.name();
        let arguments = format!("run plate.toml --quiet --out {name} --instruction-set {name}");
        succeed(place.path(), &arguments);
        let report = report(&place.path().join(name));
        assert_eq!(report["model"]["instruction_set"], name, "{report}");
        let broken = report["audit"]["broken_bonds"].as_u64().unwrap();
        (broken, report["audit"]["elastic_energy"].as_f64().unwrap())
    });
    let results: Vec<(u64, f64)> = results.collect();
    let (broken, energy) = results[0];
    assert!(broken > 0);
    for (others, other) in results {
        assert_eq!(others, broken);
        assert!((other / energy - 1.0).abs() < 1e-9, "{other} {energy}");
    }
}

#[test]
fn an_unknown_instruction_set_is_rejected() {
    let place = with_plate();
    let (status, message) = fail(place.path(), "check plate.toml --instruction-set sse9");
    assert_eq!(status, 2);
    assert!(
        message.contains("allowed: baseline, avx2, avx512"),
        "{message}"
    );
}
