//! Models as data: JSON round trip, assembly without a deck, points and sets changed by a program.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use pericles::material::StressState;
use pericles::observe::Schedule;
use pericles::space::{ListedPoints, Region};
use pericles::{Control, Simulation};
use pericles_deck::{Deck, Model, specimens};
use pericles_run::{Grids, Resources, assemble, discretise};

use super::decks::{SURFACE, WAVE};
use super::{PLATE, STATIC, parse};

/// Returns the model after a JSON round trip; checks its ranges.
fn reread(model: &Model) -> Model {
    model.check().unwrap_or_else(|error| panic!("{error}"));
    let json = serde_json::to_string(model).unwrap_or_else(|error| panic!("{error}"));
    serde_json::from_str(&json).unwrap_or_else(|error| panic!("{error}\n{json}"))
}

/// Returns all decks below a folder.
fn decks(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            decks(&path, found);
        } else if name.ends_with(".toml") && name != "expected.toml" {
            found.push(path);
        }
    }
}

#[test]
fn every_example_round_trips_through_json() {
    let mut found = Vec::new();
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    decks(&examples, &mut found);
    assert!(found.len() > 5, "{found:?}");
    for path in found {
        let deck = Deck::read(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(reread(&deck.model), deck.model, "{}", path.display());
    }
}

#[test]
fn every_specimen_round_trips_through_json() {
    for (text, changes) in specimens() {
        let deck = Deck::parse(text, "specimen.toml", &changes);
        let deck = deck.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(reread(&deck.model), deck.model, "{changes:?}");
    }
}

#[test]
fn unknown_fields_and_words_are_rejected() {
    let json = serde_json::to_string(&parse(PLATE).model).unwrap();
    for (replace, by, says) in [
        ("\"sets\"", "\"stets\"", "stets"),
        ("\"plane-strain\"", "\"plane-strian\"", "plane-strain"),
        ("\"horizon\"", "\"horison\"", "horison"),
        ("\"spacing\"", "\"spaces\"", "spaces"),
    ] {
        assert!(json.contains(replace), "{json}");
        let error = serde_json::from_str::<Model>(&json.replace(replace, by)).unwrap_err();
        assert!(error.to_string().contains(says), "{error}");
    }
}

/// Returns the bits of displacements and velocities after some steps.
fn after(mut run: Simulation, steps: u64) -> Vec<u64> {
    let mut left = steps;
    let stop = |_: &_| {
        left -= 1;
        if left == 0 {
            Control::Stop
        } else {
            Control::Continue
        }
    };
    run.run(stop).unwrap();
    let state = run.state();
    state
        .u
        .iter()
        .chain(&state.v)
        .map(|x| x.to_bits())
        .collect()
}

/// Returns the simulation of a model.
fn run_of(model: &Model, resources: &Resources<'_>) -> Simulation {
    let points = discretise(model, resources).unwrap_or_else(|error| panic!("{error}"));
    let assembly = assemble(model, points, resources).unwrap_or_else(|error| panic!("{error}"));
    assembly.simulation().unwrap()
}

/// Returns a bar of listed points.
fn listed() -> ListedPoints {
    ListedPoints {
        positions: (0..20).map(|k| [0.1 * f64::from(k), 0.0, 0.0]).collect(),
        volumes: vec![0.1; 20],
        blocks: vec![0; 20],
    }
}

const LISTED: &str = r#"
[body]
shape = "points"
file = "bar.txt"
dimension = 1
spacing = 0.1
[material]
density = 1
youngs_modulus = 1
horizon_ratio = 3
[[initial]]
velocity = [{ expression = "x" }]
[time]
end = 1
"#;

#[test]
fn a_model_from_json_runs_like_its_deck() {
    let read_points = |path: &Path, _: usize, _: u64| {
        assert_eq!(path, Path::new("decks/bar.txt"));
        Ok(listed())
    };
    let resources = Resources {
        folder: Path::new("decks"),
        read_points: &read_points,
        ..Resources::default()
    };
    for (text, steps) in [
        (WAVE, 3),
        (PLATE, 5),
        (STATIC, 2),
        (SURFACE, 3),
        (LISTED, 5),
    ] {
        let deck = Deck::parse(text, "decks/deck.toml", &[]).unwrap();
        let built = pericles_run::build(&deck, &resources).unwrap();
        let json = run_of(&reread(&deck.model), &resources);
        assert_eq!(
            after(json, steps),
            after(built.simulation().unwrap(), steps)
        );
    }
}

const BAR: &str = r#"
[body]
shape = "bar"
length = 2
spacing = 0.1
[material]
density = 1
youngs_modulus = 1
horizon_ratio = 3
[sets.left]
layer = { side = "-x", cells = 1 }
[[initial]]
set = "left"
velocity = [1]
[time]
end = 1
"#;

#[test]
fn a_program_may_change_sets_and_points() {
    let model = parse(BAR).model;
    let resources = Resources::default();
    let points = discretise(&model, &resources).unwrap();
    assert_eq!(points.set("left").unwrap(), &[0]);
    // A modified set.
    let mut chosen = points.clone();
    *chosen.set_mut("left").unwrap() = vec![3, 4];
    let assembly = assemble(&model, chosen, &resources).unwrap();
    let moving: Vec<usize> = (0..20).filter(|&i| assembly.state.v[i] != 0.0).collect();
    assert_eq!(moving, [3, 4]);
    // Other points without cells.
    let mut placed = points.clone();
    placed.cloud = Arc::new(listed().cloud(1, 1.0).unwrap());
    placed.grids = Grids::one(20);
    let assembly = assemble(&model, placed, &resources).unwrap();
    assert!((0..20).any(|i| assembly.cloud.point(i)[0] == 0.0));
    after(assembly.simulation().unwrap(), 3);
    // Inconsistent points and sets are rejected.
    let mut wrong = points.clone();
    wrong.set_mut("left").unwrap().push(20);
    let message = assemble(&model, wrong, &resources)
        .err()
        .unwrap()
        .to_string();
    assert!(message.starts_with("sets.left: "), "{message}");
    let mut wrong = points;
    wrong.grids = Grids::one(19);
    let message = assemble(&model, wrong, &resources)
        .err()
        .unwrap()
        .to_string();
    assert!(message.starts_with("body.refine: "), "{message}");
}

#[test]
fn errors_of_a_model_without_a_deck_name_keys() {
    let mut model = parse(BAR).model;
    model.initial[0].set = "right".into();
    let resources = Resources::default();
    let points = discretise(&model, &resources).unwrap();
    let message = assemble(&model, points, &resources)
        .err()
        .unwrap()
        .to_string();
    assert!(
        message.starts_with("initial.0.set: unknown set `right`"),
        "{message}"
    );
    let solid = model.body.solid_mut().unwrap();
    solid.material.bonds_mut().unwrap().horizon = 0.01;
    let points = discretise(&model, &resources).unwrap();
    let message = assemble(&model, points, &resources)
        .err()
        .unwrap()
        .to_string();
    let keys = "material.horizon or material.horizon_ratio: ";
    assert!(message.starts_with(keys), "{message}");
}

#[test]
fn all_numbers_out_of_range_are_reported_at_once() {
    let resources = Resources::default();
    let mut model = parse(PLATE).model;
    model.time.end = f64::NAN;
    model.output.history.schedule = Schedule::Every(0);
    let solid = model.body.solid_mut().unwrap();
    solid.material.bonds_mut().unwrap().density = -1.0;
    solid.state = StressState::Spatial;
    let hole = Region::Cylinder {
        centre: [0.0; 3],
        axis: 3,
        radius: 1.0,
    };
    let grid = &mut solid.shape.lattice_mut().unwrap().grid;
    grid.holes.push(hole);
    let message = discretise(&model, &resources).err().unwrap().to_string();
    let keys: Vec<&str> = message
        .lines()
        .map(|line| line.split(':').next().unwrap())
        .collect();
    assert_eq!(
        keys,
        [
            "body.hole.0.cylinder.axis",
            "body.plane",
            "material.density",
            "time.end",
            "output.history.every"
        ]
    );
}
