//! Initial states from files.

use std::path::Path;

use pericles::Control;
use pericles_deck::Deck;
use pericles_run::{FileError, Resources};

use super::common::{Build, Built};
use super::rejection;

const SPHERE: &str = r#"
[body]
shape = "icosphere"
level = 2
radius = 1
[material]
density = "1 kg/m2"
alpha = 0.5
p = 3
horizon = 0.8
[sets]
cap = { where = "z > 0.5" }
[[initial]]
velocity = [0, { expression = "z" }, 0.1]
[time]
end = 2
dt = 0.05
"#;

/// Returns the model of a deck with an initial state of these rows.
fn with_rows(text: &str, rows: &[f64]) -> Built {
    let deck = Deck::parse(text, "decks/sphere.toml", &[]).unwrap();
    assert_eq!(deck.model.files(), [Path::new("state.txt")]);
    let model = deck.build_with(Resources {
        read_table: &|path, points, columns, _| {
            assert_eq!(path, Path::new("decks/state.txt"));
            assert_eq!(columns, ["u_x", "u_y", "u_z", "v_x", "v_y", "v_z"]);
            assert_eq!(points.map(|points| 6 * points), Some(rows.len()));
            Ok(rows.to_vec())
        },
        ..Resources::default()
    });
    model.unwrap_or_else(|error| panic!("{error}"))
}

/// Returns displacement and velocity of each point after a number of steps, in the user's order.
fn rows_after(model: Built, steps: u64) -> Vec<f64> {
    let cloud = model.cloud.clone();
    let mut run = model.simulation();
    run.run(|run| match run.state().step {
        step if step == steps => Control::Stop,
        _ => Control::Continue,
    })
    .unwrap();
    assert_eq!(run.state().step, steps);
    let n = cloud.len();
    let mut rows = vec![0.0; 6 * n];
    for i in 0..n {
        let row = 6 * cloud.user_number(i);
        for c in 0..3 {
            rows[row + c] = run.state().u[c * n + i];
            rows[row + 3 + c] = run.state().v[c * n + i];
        }
    }
    rows
}

#[test]
fn a_run_with_the_state_of_another_continues_it() {
    let text =
        |initial: &str| SPHERE.replace("velocity = [0, { expression = \"z\" }, 0.1]", initial);
    let model = || super::build(SPHERE);
    let cloud = model().assembly.cloud;
    // The vertices of a surface are renumbered; the rows are in the order of the file.
    assert!((0..cloud.len()).any(|i| cloud.user_number(i) != i));
    let middle = rows_after(model(), 10);
    let whole = rows_after(model(), 20);
    let continued = rows_after(with_rows(&text("file = \"state.txt\""), &middle), 10);
    let largest = whole.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    for (one, other) in whole.iter().zip(&continued) {
        assert!((one - other).abs() < 1e-13 * largest, "{one} {other}");
    }
}

#[test]
fn only_points_of_the_set_are_initialised() {
    let initial = "velocity = [0, 0, 7]\n[[initial]]\nset = \"cap\"\nfile = \"state.txt\"";
    let text = SPHERE.replace("velocity = [0, { expression = \"z\" }, 0.1]", initial);
    let rows: Vec<f64> = (0..6 * 162).map(|k| 1e-6 * f64::from(k)).collect();
    let model = with_rows(&text, &rows);
    let n = model.cloud.len();
    let mut taken = 0;
    for i in 0..n {
        let row = 6 * model.cloud.user_number(i);
        let (u, v) = (model.state.u[i], model.state.v[2 * n + i]);
        if model.cloud.point(i)[2] > 0.5 {
            assert_eq!((u, v), (rows[row], rows[row + 5]));
            taken += 1;
        } else {
            assert_eq!((u, v), (0.0, 7.0));
        }
    }
    assert!(taken > 0 && taken < n);
}

#[test]
fn an_invalid_state_file_is_reported_at_its_key() {
    let text = SPHERE.replace(
        "velocity = [0, { expression = \"z\" }, 0.1]",
        "file = \"state.txt\"",
    );
    let message = |error: FileError| {
        let deck = Deck::parse(&text, "sphere.toml", &[]).unwrap();
        let built = deck.build_with(Resources {
            read_table: &|_, _, _, _| Err(error.clone()),
            ..Resources::default()
        });
        match built {
            Ok(_) => panic!("rejected"),
            Err(error) => error,
        }
    };
    let wrong = message(FileError::Wrong("state.txt:7: 5 numbers".into()));
    let says = wrong.to_string();
    assert!(
        says.starts_with("sphere.toml:14:8: state.txt:7: 5 numbers"),
        "{says}"
    );
    assert!(
        says.contains("one line for each of the 162 points"),
        "{says}"
    );
    assert!(!wrong.is_too_large());
    let large = message(FileError::TooLarge("state.txt needs about 4 TB".into()));
    assert!(large.is_too_large(), "{large}");
}

#[test]
fn state_files_do_not_support_an_exterior() {
    let text = r#"
[body]
shape = "bar"
length = "100 mm"
spacing = "1 mm"
[material]
model = "linear"
density = 1000
youngs_modulus = "1 GPa"
horizon_ratio = 3
[[initial]]
file = "state.txt"
[[boundary]]
kind = "absorbing"
side = "+x"
exterior_extent = "70 mm"
[time]
end = "10 us"
"#;
    let deck = Deck::parse(text, "bar.toml", &[]).unwrap();
    let built = deck.build_with(Resources {
        read_table: &|_, points, columns, _| Ok(vec![0.0; points.unwrap() * columns.len()]),
        ..Resources::default()
    });
    let says = match built {
        Ok(_) => panic!("rejected"),
        Err(error) => error.to_string(),
    };
    assert!(
        says.starts_with("bar.toml:12:8:") && says.contains("exterior_extent"),
        "{says}"
    );
    assert!(rejection(text).to_string().contains("no reader for"));
}

/// A plate with initial displacements and velocities from a file.
const HANDED_OVER: &str = r#"
body = { shape = "plate", size = [20, 10], spacing = 1, plane = "stress" }
material = { density = 1, youngs_modulus = 10, horizon_ratio = 3, MATERIAL }
initial = [{ file = "state.txt" }]
time = { end = 1 }
"#;

/// The file contains no broken bonds: an open crack would heal.
#[test]
fn displacements_that_break_intact_bonds_at_once_are_rejected() {
    let open = |x: f64| if x > 10.0 { 0.5 } else { 0.0 };
    let stretched = |x: f64| 1e-3 * x;
    for material in [
        "critical_stretch = 0.01",
        "model = \"state-based\", poisson_ratio = 0.3, critical_stretch = 0.01",
        "model = \"state-based\", poisson_ratio = 0.3, fracture_energy = 1e-3, failure = \"bond-energy\"",
        "model = \"state-based\", poisson_ratio = 0.3, failure = \"principal-stress\", strength = 0.1",
        "model = \"correspondence\", poisson_ratio = 0.3, critical_stretch = 0.01",
    ] {
        let text = HANDED_OVER.replace("MATERIAL", material);
        let deck = Deck::parse(&text, "deck.toml", &[]).unwrap();
        let read = |moved: &(dyn Fn(f64) -> f64 + Sync)| {
            deck.build_with(Resources {
                read_table: &|_, points, _, _| {
                    // In the order of the field files, row by row along x.
                    let row = |k: usize| [moved(0.5 + (k % 20) as f64), 0.0, 0.0, 0.0];
                    Ok((0..points.unwrap()).flat_map(row).collect())
                },
                ..Resources::default()
            })
        };
        assert!(read(&stretched).is_ok(), "{material}");
        let error = match read(&open) {
            Ok(_) => panic!("{material}"),
            Err(error) => error.to_string(),
        };
        assert!(error.contains("contains no broken bonds"), "{error}");
    }
}
