//! Field files: cells and points, and the arrays that a deck asks for.

use std::path::Path;

use pericles_deck::Deck;
use pericles_io::{FieldData, OutputFolder};
use pericles_run::{Assembled, Caching, Cancel, Ending, Means, Results, Run, Source};

const PLATE: &str = r#"
[body]
shape = "plate"
size = ["8 mm", "6 mm"]
spacing = "1 mm"
plane = "stress"
[material]
youngs_modulus = "72 GPa"
density = 2440
horizon_ratio = 2
[materials.soft]
youngs_modulus = "7 GPa"
density = 2440
horizon_ratio = 2
[[assign]]
set = "left"
material = "soft"
[sets.left]
box = { max = ["3 mm", "inf"] }
[sets.right]
layer = { side = "+x", cells = 1 }
[[crack]]
segment = [["5 mm", "-1 mm"], ["5 mm", "7 mm"]]
[[constraint]]
set = "right"
velocity = ["1 m/s", "free"]
[time]
end = "1 us"
dt = "0.1 us"
[output.fields]
count = 1
"#;

const NAMES: &str = "output.fields.names=['Displacement', 'Stress', 'Von_Mises_Stress', 'Equivalent_Stress', 'Principal_Stress', 'Radius', 'Volume', 'Point_Id', 'Fragment_Id', 'Material_Id', 'Set_right']";

/// Runs a deck and returns its last state and the bytes of its last file.
fn last_state(text: &str, overrides: &[&str], folder: &Path) -> (FieldData, String) {
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    let deck = Deck::parse(text, "deck.toml", &overrides).unwrap();
    let means = Means {
        caching: Caching::Off,
        ..Means::default()
    };
    let source = Source::of_deck(deck, "deck.toml".into());
    let assembled = Assembled::of(&source, &means, &mut |_| {}).unwrap();
    let output = OutputFolder::create(folder, false).unwrap();
    let mut run = Run::begin(&source, assembled, output).unwrap();
    let ending = run.drive(None, &Cancel::new(), &mut |_| {}).unwrap();
    assert_eq!(ending, Ending::Finished);
    drop(run);
    let results = Results::open(folder).unwrap();
    let files = results.fields().unwrap();
    let last = files.last().unwrap();
    let bytes = std::fs::read(&last.path).unwrap();
    let text = String::from_utf8_lossy(&bytes).into_owned();
    (last.read().unwrap(), text)
}

#[test]
fn cells_hold_the_same_fields_as_points_at_their_centres() {
    let place = tempfile::tempdir().unwrap();
    let folder = |name: &str| place.path().join(name);
    let (cells, text) = last_state(PLATE, &[], &folder("auto"));
    assert!(text.contains("<CellData>") && cells.is_on_cells);
    assert!(text.contains("NumberOfPoints=\"63\" NumberOfCells=\"48\""));
    let (points, text) = last_state(PLATE, &["output.cells=false"], &folder("points"));
    assert!(!text.contains("<CellData>") && !points.is_on_cells);
    assert_eq!(cells.points.len(), points.points.len());
    for (a, b) in cells.points.iter().zip(&points.points) {
        assert!((a - b).abs() < 1e-17, "{a} {b}");
    }
    assert_eq!(cells.fields, points.fields);
    let (asked, _) = last_state(PLATE, &["output.cells=true"], &folder("asked"));
    assert_eq!(asked, cells);
}

#[test]
fn cells_are_lines_of_bars_and_hexahedra_of_blocks() {
    let place = tempfile::tempdir().unwrap();
    let bar = "[body]\nshape = 'bar'\nlength = 4\nspacing = 1\n[material]\ndensity = 1\nyoungs_modulus = 1\nhorizon = 2\n[[initial]]\nvelocity = [1]\n[time]\nend = 1\ndt = 0.1\n[output.fields]\ncount = 1\n";
    let (cells, text) = last_state(bar, &[], &place.path().join("bar"));
    assert!(cells.is_on_cells && text.contains("NumberOfPoints=\"5\" NumberOfCells=\"4\""));
    let block = bar
        .replace(
            "shape = 'bar'\nlength = 4",
            "shape = 'block'\nsize = [4, 3, 2]",
        )
        .replace("velocity = [1]", "velocity = [1, 0, 0]");
    let (cells, text) = last_state(&block, &[], &place.path().join("block"));
    assert!(cells.is_on_cells && text.contains("NumberOfPoints=\"60\" NumberOfCells=\"24\""));
}

#[test]
fn arrays_that_a_deck_asks_for_have_their_values_and_units() {
    let place = tempfile::tempdir().unwrap();
    let (state, text) = last_state(PLATE, &[NAMES], &place.path().join("run"));
    let n = 48;
    let field = |name: &str| state.field(name).unwrap_or_else(|| panic!("{name}"));
    let values = |name: &str| &field(name).values;
    let x = |i: usize| state.points[3 * i];
    for i in 0..n {
        let is_left = x(i) < 3e-3;
        assert_eq!(values("Material_Id")[i], if is_left { 2.0 } else { 1.0 });
        assert_eq!(values("Set_right")[i], f64::from(x(i) > 7e-3));
        assert_eq!(values("Fragment_Id")[i], f64::from(x(i) > 5e-3));
        assert_eq!(values("Point_Id")[i], i as f64);
        assert!((values("Radius")[i] - 0.5e-3).abs() < 1e-18);
    }
    assert_eq!(values("Von_Mises_Stress"), values("Equivalent_Stress"));
    let stress = field("Stress");
    assert_eq!(stress.components, 6);
    let part = |i: usize, c: usize| stress.values[6 * i + c];
    let principal = |i: usize, c: usize| values("Principal_Stress")[3 * i + c];
    let mut largest: f64 = 0.0;
    for i in 0..n {
        let [xx, yy, xy] = [0, 1, 3].map(|c| part(i, c));
        assert_eq!([2, 4, 5].map(|c| part(i, c)), [0.0; 3]);
        assert_eq!(xx, values("Stress_xx")[i]);
        assert_eq!(xy, values("Stress_xy")[i]);
        let size = xx.abs().max(yy.abs()).max(xy.abs());
        largest = largest.max(size);
        // Invariants of the tensor.
        assert!((principal(i, 0) + principal(i, 1) - xx - yy).abs() <= 4e-15 * size);
        let determinant = principal(i, 0) * principal(i, 1);
        assert!((determinant - (xx * yy - xy * xy)).abs() <= 1e-14 * size * size);
        assert!(principal(i, 0) >= principal(i, 1));
    }
    assert!(largest > 0.0);
    for header in [
        "Name=\"Stress\" NumberOfComponents=\"6\" ComponentName0=\"XX\"",
        "<InformationKey name=\"UNITS_LABEL\" location=\"vtkDataArray\">Pa</InformationKey>",
        "type=\"Int32\" Name=\"Fragment_Id\"",
    ] {
        assert!(text.contains(header), "{header}");
    }
    assert!(!text.contains("Name=\"Velocity\""), "not asked for");
}

#[test]
fn cells_of_a_body_without_cells_and_unknown_sets_are_rejected() {
    let place = tempfile::tempdir().unwrap();
    std::fs::write(
        place.path().join("points.txt"),
        "0 0 0 1 1\n1 0 0 1 1\n0 1 0 1 1\n",
    )
    .unwrap();
    let deck = "[body]\nshape = 'points'\nfile = 'points.txt'\ndimension = 2\nspacing = 1\nplane = 'stress'\nthickness = 1\n[material]\ndensity = 1\nyoungs_modulus = 1\nhorizon = 2\n[time]\nend = 1\ndt = 0.1\n[output]\ncells = true\n";
    let path = place.path().join("deck.toml");
    std::fs::write(&path, deck).unwrap();
    let deck = Deck::read(&path, &[]).unwrap();
    let source = Source::of_deck(deck, path.display().to_string());
    let error = Assembled::of(&source, &Means::default(), &mut |_| {})
        .err()
        .unwrap();
    let message = error.to_string();
    assert!(message.contains("have no cells"), "{message}");
    let unknown = "output.fields.names=['Set_rihgt']".to_string();
    let error = Deck::parse(PLATE, "deck.toml", &[unknown]).unwrap_err();
    let message = error.problems()[0].line().to_string();
    assert!(message.contains("right"), "{message}");
}
