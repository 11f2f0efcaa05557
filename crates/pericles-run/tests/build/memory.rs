//! The memory of bodies and histories is checked before allocation.

use std::path::Path;

use super::common::Build;
use pericles::space::ListedPoints;
use pericles_deck::{Deck, DeckError};
use pericles_run::Resources;

/// Builds a deck with a replacement and a memory limit.
fn built(text: &str, [old, new]: [&str; 2], memory: u64) -> Result<(), DeckError> {
    assert!(text.contains(old), "{old}");
    let deck = Deck::parse(&text.replace(old, new), "a.toml", &[])?;
    let read_points = |_: &Path, _: usize, _: u64| {
        // A row of points.
        let places = (0..20_000).map(|k| [f64::from(k), 0.0, 0.0]);
        let mut points = ListedPoints::default();
        points.positions.extend(places);
        points.blocks.resize(20_000, 1);
        points.volumes.resize(20_000, 1.0);
        Ok(points)
    };
    let resources = Resources {
        memory,
        read_points: &read_points,
        ..Resources::default()
    };
    deck.build_with(resources).map(|_| ())
}

fn rejection(text: &str, change: [&str; 2], memory: u64, at: &str, says: &str) {
    match built(text, change, memory) {
        Err(error) => {
            assert!(error.is_too_large(), "{error}");
            let message = error.to_string();
            assert!(message.starts_with(at), "{message}");
            assert!(message.contains(says), "{message}");
        }
        Ok(()) => panic!("{change:?} fits into {memory} bytes?"),
    }
}

const BLOCK: &str = r#"[body]
shape = "block"
size = [1, 1, 1]
spacing = 0.1
[material]
density = 1
youngs_modulus = 1
horizon_ratio = 3
bonds = "list"
[time]
end = 1
dt = 0.01
"#;

#[test]
fn a_body_is_rejected_by_its_number_of_cells() {
    assert!(built(BLOCK, ["0.1", "0.1"], 10_000_000).is_ok());
    let fine = ["spacing = 0.1", "spacing = 0.001"];
    rejection(BLOCK, fine, 8_000_000_000, "a.toml:4:11: ", "1.0e9 points");
    rejection(
        BLOCK,
        fine,
        8_000_000_000,
        "a.toml:4:11: ",
        "TB of memory; the limit is 8.0 GB; use a larger spacing",
    );
    // A sphere in the same box has about half as many cells, a thin tube even fewer.
    let whole = 4_000_000;
    rejection(
        BLOCK,
        ["spacing = 0.1", "spacing = 0.05"],
        whole,
        "a.toml:4",
        "8 000 points",
    );
    let hole = [
        "spacing = 0.1",
        "spacing = 0.05\nhole = [{ box = { min = [0, 0, 0.1] } }]",
    ];
    assert!(built(BLOCK, hole, whole).is_ok());
    // Cells of refined parts are counted.
    let finer = [
        "spacing = 0.1",
        "spacing = 0.1\nrefine = [{ all = true, ratio = 16 }]",
    ];
    rejection(
        &BLOCK.replace("bonds = \"list\"\n", ""),
        finer,
        100_000_000,
        "a.toml:4",
        "4 096 000 points",
    );
    // Exceeding the largest number of points is not a memory error.
    let numberless = built(BLOCK, ["spacing = 0.1", "spacing = 1e-4"], u64::MAX).unwrap_err();
    assert!(!numberless.is_too_large(), "{numberless}");
    assert!(numberless.to_string().contains("at most"), "{numberless}");
}

#[test]
fn listed_points_are_rejected_by_their_number_of_bonds() {
    let text = r#"[body]
shape = "points"
file = "line.txt"
dimension = 1
spacing = 1
[material]
density = 1
youngs_modulus = 1
horizon = 3
[time]
end = 1
dt = 0.01
"#;
    assert!(built(text, ["horizon = 3", "horizon = 3"], 20_000_000).is_ok());
    let wide = ["horizon = 3", "horizon = 9000"];
    rejection(text, wide, 1_000_000_000, "a.toml:9:11: ", "GB of memory");
}

#[test]
fn a_surface_is_rejected_by_its_numbers_of_vertices_and_bonds() {
    let text = r#"[body]
shape = "icosphere"
level = 2
radius = 1
[material]
density = 1
alpha = 0.5
p = 2
horizon = 0.6
[time]
end = 1
dt = 0.01
"#;
    assert!(built(text, ["level = 2", "level = 2"], 3_000_000).is_ok());
    // The surface is not created to find its vertex spacing, which would take seconds and exceed the memory limit.
    let began = std::time::Instant::now();
    rejection(
        text,
        ["level = 2", "level = 10"],
        1_000_000_000,
        "a.toml:2:9: ",
        "10 485 762 points",
    );
    assert!(began.elapsed().as_secs_f64() < 1.0);
    rejection(
        text,
        ["level = 2", "level = 5"],
        60_000_000,
        "a.toml:9:11: ",
        "smaller horizon",
    );
}

#[test]
fn a_history_is_rejected_by_its_number_of_steps() {
    let text = r#"[body]
shape = "bar"
length = 10
spacing = 1
[material]
model = "linear"
density = 1
youngs_modulus = 1
horizon_ratio = 3
[[boundary]]
kind = "absorbing"
side = "+x"
history = "blocked"
[time]
end = 100
dt = 0.1
"#;
    assert!(built(text, ["end = 100", "end = 100"], 1_000_000).is_ok());
    let long = ["end = 100", "end = 1e9"];
    rejection(text, long, 8_000_000_000, "a.toml:10", "1.0e10 steps");
    // The memory of exponential histories does not grow with the steps.
    let same = ["end = 100", "end = 100"];
    rejection(text, same, 100_000, "a.toml:10", "1 000 steps");
    let forgetful = text.replace("\"blocked\"", "\"exponentials\"\ntolerance = 1e-4");
    assert!(built(&forgetful, same, 100_000).is_ok());
}

#[test]
fn a_fit_with_too_many_steps_is_rejected() {
    let text = r#"[body]
shape = "bar"
length = 10
spacing = 1
[material]
model = "linear"
density = 1
youngs_modulus = 1
horizon_ratio = 3
[[boundary]]
kind = "absorbing"
side = "+x"
history = "exponentials"
tolerance = 1e-4
[time]
end = 1e9
dt = 0.1
"#;
    let error = built(text, ["1e9", "1e9"], u64::MAX).unwrap_err();
    let message = error.to_string();
    assert!(message.starts_with("a.toml:10:"), "{message}");
    assert!(
        message.contains("at most 1e9 steps, but the run has 9.99"),
        "{message}"
    );
    // The largest number of steps.
    assert!(built(text, ["1e9", "8e14"], u64::MAX).is_err());
}

/// Temperatures and conductances count, and the multigrid of implicit steps.
#[test]
fn heat_conduction_counts() {
    let conducting = |scheme: &str| {
        format!(
            "{BLOCK}\n[thermal]\nconductivity = 1\nspecific_heat = 1\ntemperature = 300\nscheme = \"{scheme}\"\n"
        )
    };
    let estimate = |text: &str| {
        let deck = Deck::parse(text, "a.toml", &[]).unwrap();
        deck.build().unwrap().memory_estimate(&deck.model) as f64
    };
    let [without, explicit, implicit] = [
        BLOCK.to_owned(),
        conducting("explicit"),
        conducting("trapezoidal"),
    ]
    .map(|text| estimate(&text));
    assert!(explicit > without + 150e3, "{without} {explicit}");
    assert!(implicit > explicit + 2e6, "{explicit} {implicit}");
    // Every process stores the multigrid of the whole body.
    let divided = |scheme: &str| {
        let deck = Deck::parse(&conducting(scheme), "a.toml", &[]).unwrap();
        let forecast = deck.build().unwrap().forecast(&deck.model, 4).unwrap();
        forecast.memory.mean
    };
    let multigrid = divided("trapezoidal") - divided("explicit");
    let expected = implicit - explicit;
    assert!(
        (multigrid / expected - 1.0).abs() < 1e-3,
        "{multigrid} {expected}"
    );
    let limit = 4_000_000;
    let same = ["spacing = 0.1", "spacing = 0.1"];
    assert!(built(BLOCK, same, limit).is_ok());
    rejection(
        &conducting("trapezoidal"),
        same,
        limit,
        "a.toml:4:",
        "the limit is 4.0 MB",
    );
}
