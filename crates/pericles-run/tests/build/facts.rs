//! The list of facts of a run.

use std::collections::BTreeSet;

use pericles_run::Facts;
use serde_json::Value;

use crate::decks::WAVE;
use crate::{build, parse};

/// A plate of a breakable material with a load, and two plates without a common bond.
const PLATES: &str = r#"
[body]
name = "left"
shape = "plate"
size = [8, 6]
spacing = 1
plane = "stress"
[[body.piece]]
name = "right"
shape = "plate"
size = [5, 6]
origin = [9, 0]
[material]
model = "state-based"
density = 2
youngs_modulus = 3
poisson_ratio = 0.3
horizon_ratio = 3
critical_stretch = 0.01
[[load]]
set = "all"
body_force = [1, 0]
[time]
end = 1
dt = 0.01
"#;

fn facts(text: &str) -> (Facts, Facts) {
    let (deck, built) = (parse(text), build(text));
    let facts = Facts::of_deck(&deck, &built.assembly);
    let mut detailed = facts.clone();
    detailed.add_details(&deck.model, &built.assembly);
    (facts, detailed)
}

/// Each key has one fact, so that no value of the JSON replaces another one.
#[test]
fn keys_of_facts_are_unique() {
    for text in [WAVE, PLATES] {
        let (_, detailed) = facts(text);
        let keys: BTreeSet<&str> = detailed.iter().map(|fact| fact.key).collect();
        assert_eq!(keys.len(), detailed.iter().count(), "{keys:?}");
    }
}

#[test]
fn run_json_has_the_recorded_facts_and_check_has_all() {
    let (plain, detailed) = facts(PLATES);
    let Value::Object(run) = serde_json::to_value(&plain).unwrap() else {
        panic!("an object");
    };
    let check = detailed.to_json();
    for (key, value) in &run {
        assert_eq!(check[key], *value, "{key}");
    }
    assert!(check.contains_key("neighbours") && !run.contains_key("neighbours"));
    assert_eq!(check["units"]["end"], "s");
    assert_eq!(run["pieces"], 2);
    assert_eq!(run["loads"][0]["points"], 48 + 30);
    let printed = detailed.printed();
    let place = |label: &str| printed.iter().position(|line| line.0 == label).unwrap();
    assert!(place("points") < place("neighbours") && place("neighbours") < place("steps"));
}

#[test]
fn units_of_facts_are_those_of_the_body() {
    let (plain, _) = facts(PLATES);
    let unit = |key: &str| &*plain.iter().find(|fact| fact.key == key).unwrap().unit;
    // A plate without a thickness has masses per metre.
    assert_eq!(unit("mass"), "kg/m");
    assert_eq!(unit("youngs_modulus"), "Pa");
    assert_eq!(unit("points"), "");
    assert_eq!(plain.number("mass"), Some(2.0 * (48.0 + 30.0)));
}
