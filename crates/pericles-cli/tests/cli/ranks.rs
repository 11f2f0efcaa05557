//! `pericles check --ranks`: predicted divisions among processes.

use crate::common::{fail, succeed, text};
use serde_json::Value;

/// A body of bonds of up to 3.015 cells.
fn deck(shape: &str, size: &str) -> String {
    format!(
        r#"
[body]
shape = "{shape}"
size = {size}
spacing = "1 mm"
{}
[material]
youngs_modulus = "72 GPa"
density = 2440
horizon_ratio = 3.015
volume_correction = "none"
[[initial]]
random_velocity = {{ radius = "0.05 m/s", seed = 3 }}
[time]
end = "1 us"
dt = "0.1 us"
"#,
        if shape == "plate" {
            "plane = \"stress\""
        } else {
            ""
        }
    )
}

fn checked(deck: &str, ranks: &str) -> (String, Vec<Value>, Value) {
    let place = tempfile::tempdir().unwrap();
    std::fs::write(place.path().join("deck.toml"), deck).unwrap();
    let line = format!("check deck.toml --ranks {ranks} --json out.json");
    let output = succeed(place.path(), &line);
    let written = std::fs::read_to_string(place.path().join("out.json")).unwrap();
    let json: Value = serde_json::from_str(&written).unwrap();
    let processes = json["processes"].as_array().unwrap().clone();
    (text(&output.stdout), processes, json)
}

fn number(value: &Value, keys: [&str; 2]) -> f64 {
    value[keys[0]][keys[1]].as_f64().unwrap()
}

#[test]
fn predicted_shares_are_those_of_an_independent_program() {
    // Cuts between planes of the lattice: for powers of two that divide the sides they are those between any points.
    let (_, cube, _) = checked(&deck("block", r#"["46 mm", "46 mm", "46 mm"]"#), "1,8,64");
    assert_eq!(cube.len(), 3);
    assert_eq!(number(&cube[0], ["halo", "largest"]), 0.0);
    assert_eq!(number(&cube[0], ["points", "mean"]), 97_336.0);
    // 23³ points; ghosts per own point, share of points with ghosts, and messages.
    assert_eq!(number(&cube[1], ["points", "largest"]), 12_167.0);
    for (at, halo, boundary, messages) in [(1, 0.415, 0.34, 7.0), (2, 1.40, 0.78, 26.0)] {
        let found = number(&cube[at], ["halo", "mean"]);
        assert!((found / halo - 1.0).abs() < 0.02, "{found}");
        let found = number(&cube[at], ["boundary", "mean"]);
        assert!((found - boundary).abs() < 0.006, "{found}");
        assert_eq!(number(&cube[at], ["messages", "largest"]), messages);
    }
    let (_, plate, _) = checked(&deck("plate", r#"["500 mm", "500 mm"]"#), "16");
    // Half the sides of the plate of 1000² in 64 parts: the same parts, but more of them have free sides.
    let found = number(&plate[0], ["halo", "mean"]);
    assert!(found > 0.06 && found < 0.085, "{found}");
    assert_eq!(number(&plate[0], ["points", "mean"]), 15_625.0);
}

#[test]
fn every_printed_number_is_in_the_json() {
    let (printed, processes, json) = checked(&deck("plate", r#"["60 mm", "40 mm"]"#), "2,3");
    let lines: Vec<&str> = printed
        .lines()
        .filter(|line| line.trim_start().starts_with("processes"))
        .collect();
    assert_eq!(lines.len(), 2, "{printed}");
    for (line, value) in lines.iter().zip(&processes) {
        let points = number(value, ["points", "largest"]);
        assert!(
            line.contains(&format!("(largest {points})")) || points >= 1000.0,
            "{line}"
        );
        let step = value["step_seconds"].as_f64().unwrap();
        assert!(step > 0.0 && step.is_finite(), "{line}");
        for keys in [
            ["memory", "mean"],
            ["memory", "largest"],
            ["bytes", "largest"],
        ] {
            assert!(number(value, keys) > 0.0, "{line}");
        }
    }
    // The model: compute time of the largest part, messages, bytes.
    let whole = json["step_seconds"].as_f64().unwrap();
    let latency = json["message_latency"].as_f64().unwrap();
    let bandwidth = json["message_bandwidth"].as_f64().unwrap();
    let [first, ..] = &processes[..] else {
        panic!("no processes")
    };
    let expected = whole * number(first, ["points", "largest"]) / 2400.0
        + latency * number(first, ["messages", "largest"])
        + number(first, ["bytes", "largest"]) / bandwidth;
    let found = first["step_seconds"].as_f64().unwrap();
    assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    // Velocities of two components of each ghost.
    let ghosts = number(first, ["bytes", "largest"]) / 16.0;
    assert_eq!(ghosts, ghosts.round());
}

#[test]
fn bodies_that_cannot_be_divided_are_rejected_with_the_reason() {
    let place = tempfile::tempdir().unwrap();
    let small = deck("plate", r#"["6 mm", "4 mm"]"#);
    std::fs::write(place.path().join("small.toml"), &small).unwrap();
    let (status, said) = fail(place.path(), "check small.toml --ranks 2,1000");
    assert_eq!(status, 3, "{said}");
    assert!(
        said.contains("24 points cannot be divided among 1000 processes"),
        "{said}"
    );
    let (status, said) = fail(place.path(), "check small.toml --ranks 0");
    assert_eq!(status, 2, "{said}");
    let transforms = small.replace(
        "[material]",
        "[material]\nbonds = \"convolution\"\nmodel = \"linear\"",
    );
    std::fs::write(place.path().join("small.toml"), transforms).unwrap();
    let (status, said) = fail(place.path(), "check small.toml --ranks 2");
    assert_eq!(status, 3, "{said}");
    assert!(
        said.contains("Fourier transforms need all points"),
        "{said}"
    );
}
