//! `pericles check --json` contains every printed number in SI units.

use std::path::Path;

use crate::common::{PLATE, report, succeed, text};
use serde_json::Value;

/// Collects all numbers of a JSON value.
fn numbers(value: &Value, found: &mut Vec<f64>) {
    match value {
        Value::Number(number) => found.extend(number.as_f64()),
        Value::Array(list) => list.iter().for_each(|entry| numbers(entry, found)),
        Value::Object(map) => map.values().for_each(|entry| numbers(entry, found)),
        _ => {}
    }
}

/// Returns the numbers of a printed text, each with the value of one unit in its last digit.
fn printed(text: &str) -> Vec<(f64, f64)> {
    // Digits are grouped by spaces: `1 234 567`.
    let characters: Vec<char> = text.chars().collect();
    let digit = |k: usize| characters.get(k).is_some_and(char::is_ascii_digit);
    let group = |k: usize| {
        characters.get(k) == Some(&' ') && (1..=3).all(|j| digit(k + j)) && !digit(k + 4)
    };
    let mut found = Vec::new();
    let mut k = 0;
    while k < characters.len() {
        let begins = digit(k) && (k == 0 || !characters[k - 1].is_alphanumeric());
        if !begins {
            k += 1;
            continue;
        }
        let mut word = String::new();
        loop {
            if digit(k) || (characters.get(k) == Some(&'.') && digit(k + 1)) {
                word.push(characters[k]);
                k += 1;
            } else if !word.contains('.') && group(k) {
                k += 1;
            } else {
                break;
            }
        }
        let decimals = word.split_once('.').map_or(0, |(_, digits)| digits.len());
        let mut exponent = 0;
        if characters.get(k) == Some(&'e') {
            let rest: String = characters[k + 1..]
                .iter()
                .take_while(|c| c.is_ascii_digit() || **c == '-')
                .collect();
            exponent = rest.parse().unwrap();
            k += 1 + rest.len();
        }
        let scale = 10f64.powi(exponent);
        let value: f64 = word.parse().unwrap();
        found.push((value * scale, scale * 10f64.powi(-(decimals as i32))));
    }
    found
}

/// Returns whether a printed number is in the JSON, up to the factor of a unit prefix or of percent.
fn is_held(printed: f64, last: f64, numbers: &[f64]) -> bool {
    let factors = (-6..=6).map(|k| 1000f64.powi(k)).chain([0.01]);
    factors.into_iter().any(|factor| {
        let near = |number: &f64| (number.abs() - printed * factor).abs() <= 0.501 * last * factor;
        numbers.iter().any(near)
    })
}

/// Removes Miller indices such as `(10)` and directions such as `45°` from a line: they are names.
fn without_names(line: &str, json: &Value) -> String {
    let planes = json["crack_planes"].as_array().into_iter().flatten();
    let names = planes.filter_map(|plane| plane["plane"].as_str());
    let line = names.fold(line.to_owned(), |line, name| line.replace(name, ""));
    let materials = json["softening"].as_array().into_iter().flatten();
    let directions = materials.filter_map(|material| material["strength"].as_object());
    let names = directions.flat_map(|strengths| strengths.keys());
    names.fold(line, |line, name| {
        let line = line.replace(&format!("along ({name})"), "");
        line.replace(&format!("along {name}°"), "")
    })
}

fn assert_json_holds_what_is_printed(folder: &Path, deck: &str) -> Value {
    succeed(folder, &format!("check {deck} --json check.json"));
    let json: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.join("check.json")).unwrap()).unwrap();
    let mut held = Vec::new();
    numbers(&json, &mut held);
    let said = text(&succeed(folder, &format!("check {deck}")).stdout);
    for line in said.lines().skip(1) {
        // Measured times differ from call to call.
        if ["run time", "multirate cost", "net speed-up"]
            .iter()
            .any(|name| line.trim().starts_with(name))
        {
            continue;
        }
        for (value, last) in printed(&without_names(line, &json)) {
            assert!(
                is_held(value, last, &held),
                "{value} of `{line}` is not in {json:#}"
            );
        }
    }
    json
}

#[test]
fn the_scanner_parses_printed_numbers() {
    let found = printed("1 234 567 bonds (2.50 GPa), 46.0 ns of 3D; 1.5e-3 and 12 345");
    let expected = [
        (1234567.0, 1.0),
        (2.5, 0.01),
        (46.0, 0.1),
        (3.0, 1.0),
        (1.5e-3, 1e-4),
        (12345.0, 1.0),
    ];
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for ((value, last), (right, digit)) in found.iter().zip(expected) {
        assert!(
            (value - right).abs() < 1e-9 && (last / digit - 1.0).abs() < 1e-9,
            "{found:?}"
        );
    }
    assert!(is_held(46.0, 0.1, &[4.604e-8]));
    assert!(!is_held(46.0, 0.1, &[4.61e-8]));
    assert!(is_held(5.8, 0.1, &[-0.0579]));
}

#[test]
fn the_json_of_check_contains_every_printed_number() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    std::fs::write(folder.join("plate.toml"), PLATE).unwrap();
    let json = assert_json_holds_what_is_printed(folder, "plate.toml");
    assert_eq!(json["deck"], "plate.toml");
    assert_eq!(json["title"], "Torn plate");
    assert_eq!(json["points"], 288);
    assert_eq!(json["spacing"], 1e-3);
    assert_eq!(json["dt"], 1e-7);
    for key in [
        "/wave_speeds/rayleigh",
        "/run_seconds",
        "/horizon_ratio",
        "/end",
    ] {
        let number = json.pointer(key).and_then(Value::as_f64);
        assert!(number.is_some_and(|number| number > 0.0), "{key}: {json:#}");
    }
    let softening = concat!(
        "model = \"linear\"\nsoftening = { law = \"linear\" }\n",
        "tensile_strength = \"40 MPa\"\ncritical_stretch"
    );
    let softens = PLATE.replace("critical_stretch", softening);
    assert_ne!(softens, PLATE);
    std::fs::write(folder.join("softens.toml"), softens).unwrap();
    let json = assert_json_holds_what_is_printed(folder, "softens.toml");
    let strength = json["softening"][0]["tensile_strength"].as_f64().unwrap();
    assert!((strength / 40e6 - 1.0).abs() < 1e-8, "{json:#}");
    for example in [
        "wave/two-materials",
        "multi-time-step/notched-plate",
        "absorbing/free-end",
        "contact/two-rings",
    ] {
        succeed(folder, &format!("new {example} deck.toml"));
        assert_json_holds_what_is_printed(folder, "deck.toml");
        std::fs::remove_file(folder.join("deck.toml")).unwrap();
    }
}

#[test]
fn json_on_standard_output_is_the_only_output_and_has_the_keys_of_run_json() {
    let place = tempfile::tempdir().unwrap();
    std::fs::write(place.path().join("plate.toml"), PLATE).unwrap();
    let said = text(&succeed(place.path(), "check plate.toml --json -").stdout);
    let json: Value = serde_json::from_str(&said).unwrap();
    succeed(place.path(), "run plate.toml --quiet --set time.end=1us");
    let run = report(&place.path().join("plate"));
    for (key, value) in run["model"].as_object().unwrap() {
        // The run is shorter and may have fewer warnings.
        if !["steps", "warnings"].contains(&key.as_str()) {
            assert_eq!(json[key], *value, "{key}");
        }
    }
}

/// Two materials that never break may be joined by an interface that does.
#[test]
fn interfaces_state_how_their_bonds_break() {
    let place = tempfile::tempdir().unwrap();
    let deck = "body = { shape = \"bar\", length = 20, spacing = 1 }\n\
        material = { name = \"left\", density = 1, youngs_modulus = 10, horizon_ratio = 3 }\n\
        materials.right = { density = 1, youngs_modulus = 20 }\n\
        sets.right = { where = \"x > 10\" }\n\
        assign = [{ set = \"right\", material = \"right\" }]\n\
        interface = [{ between = [\"left\", \"right\"], fracture_energy = 2 }]\n\
        time = { end = 1, dt = 0.05 }\n";
    std::fs::write(place.path().join("deck.toml"), deck).unwrap();
    let output = succeed(place.path(), "check deck.toml");
    let printed = text(&output.stdout);
    assert!(
        printed.contains("left and right: bond failure by a fracture energy of 2"),
        "{printed}"
    );
    let output = succeed(place.path(), "check deck.toml --json -");
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["interfaces"][0]["fracture_energy"], 2.0);
    assert_eq!(json["interfaces"][0]["between"][1], "right");
}
