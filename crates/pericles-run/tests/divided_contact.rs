//! Contact and impactors on bodies divided among processes: the files equal the files of a run on a single process.

mod common;

use std::fs;
use std::path::Path;

use common::processes::{check, check_resumed};
use pericles_deck::Deck;

/// Returns an example deck with changes that make it small.
fn example(name: &str, changes: &[(&str, &str)]) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut deck = fs::read_to_string(root.join(name)).unwrap();
    for (before, after) in changes {
        assert!(deck.contains(before), "{name}: {before}");
        deck = deck.replace(before, after);
    }
    assert!(Deck::parse(&deck, name, &[]).is_ok(), "{name}");
    deck
}

/// As `check`; in the run there are contacts that store or dissipate energy, or in which impactors move.
fn check_touching(deck: &str, sizes: &[usize]) {
    let history = check(deck, sizes);
    let mut lines = history.lines().filter(|line| !line.starts_with('#'));
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let place = names
        .iter()
        .position(|name| name.starts_with("contact_energy"));
    let place = place.unwrap_or_else(|| panic!("{names:?}"));
    let energies = lines.filter_map(|line| line.split(',').nth(place)?.parse::<f64>().ok());
    assert!(energies.fold(0.0, f64::max) > 0.0, "{history}");
}

/// A ball flies through a plate of glass, whose fragments touch each other.
fn glass() -> String {
    let deck = example(
        "contact/ball-through-glass.toml",
        &[
            ("spacing = \"0.75 mm\"", "spacing = \"1 mm\""),
            ("end = \"60 us\"", "end = \"12 us\""),
            (
                "[contact]",
                "[contact]\nfriction = { coefficient = 0.2, speed = \"0.1 m/s\" }\ndamping = 0.1",
            ),
            ("count = 6, ", "count = 2, format = [\"vtu\", \"vtkhdf\"], "),
            ("count = 3", "count = 1"),
            ("fragments = { interval = \"5 us\" }", ""),
        ],
    );
    format!("{deck}\n[checkpoint]\nevery = 10\n")
}

#[test]
fn a_ball_through_glass_has_the_files_of_one_process() {
    check_touching(&glass(), &[1, 2, 3, 4]);
}

#[test]
fn a_run_with_contact_is_resumed_on_another_number_of_processes() {
    check_resumed(&glass(), 25, &[(3, 1), (1, 4), (2, 3)]);
}

#[test]
fn pieces_and_crack_faces_in_contact_have_the_files_of_one_process() {
    let rings = example(
        "contact/two-rings.toml",
        &[
            ("end = \"2 ms\"", "end = \"0.3 ms\""),
            ("spacing = \"1 mm\"", "spacing = \"1.5 mm\""),
            ("pairs = \"pieces\"", "pairs = \"pieces\"\ndamping = 0.1"),
        ],
    );
    let crack = example(
        "contact/closing-crack.toml",
        &[
            ("spacing = \"0.5 mm\"", "spacing = \"1 mm\""),
            ("end = \"80 us\"", "end = \"20 us\""),
        ],
    );
    // The projectile strikes in its first steps; cracks start later.
    let projectile = example(
        "contact/kalthoff-winkler.toml",
        &[
            ("spacing = \"1 mm\"", "spacing = \"5 mm\""),
            ("end = \"90 us\"", "end = \"60 us\""),
        ],
    );
    for deck in [rings, crack, projectile] {
        check_touching(&deck, &[2, 3, 4]);
    }
}

#[test]
fn impactors_have_the_files_of_one_process() {
    let bar = example(
        "contact/taylor-bar.toml",
        &[
            ("spacing = \"0.8 mm\"", "spacing = \"1.6 mm\""),
            ("end = \"60 us\"", "end = \"10 us\""),
        ],
    );
    let sphere = example(
        "contact/dropped-sphere.toml",
        &[
            ("spacing = \"1.25 mm\"", "spacing = \"2 mm\""),
            ("end = \"200 us\"", "end = \"80 us\""),
            ("fragments = { interval = \"10 us\" }", ""),
        ],
    );
    let wall = example(
        "contact/bar-on-wall.toml",
        &[("spacing = \"0.5 mm\"", "spacing = \"2 mm\"")],
    );
    for deck in [bar, sphere, wall] {
        check_touching(&deck, &[2, 3, 4]);
    }
}

/// A notched block that touches itself; material and scheme are inserted.
fn block(material: &str, motion: &str) -> String {
    format!(
        r#"
[body]
shape = "block"
size = [10, 8, 5]
spacing = 1
[material]
density = 1
youngs_modulus = 1
horizon = 3.01
{material}
[sets.top]
layer = {{ side = "+y", cells = 1 }}
[sets.bottom]
layer = {{ side = "-y", cells = 1 }}
[[crack]]
polygon = [[-1, 4, -1], [11, 4, -1], [11, 4, 6], [-1, 4, 6]]
[[constraint]]
set = "bottom"
displacement = [0, 0, 0]
[[constraint]]
set = "top"
{motion}
[output]
history = {{ every = 1 }}
fields = {{ count = 2, names = ["Displacement", "Contact_Force_Density"] }}
"#
    )
}

const PUSH: &str = "velocity = [0.02, -0.05, 0]\n[contact]\nfriction = { coefficient = 0.3, speed = 0.01 }\n[time]\nend = 12\ndt = 0.3";

#[test]
fn materials_in_contact_with_themselves_have_the_files_of_one_process() {
    let solid = "poisson_ratio = 0.3\ncritical_stretch = 0.01";
    for material in [
        "critical_stretch = 0.01\nbonds = \"list\"".to_owned(),
        "critical_stretch = 0.01\nbonds = \"grid\"".to_owned(),
        "critical_stretch = 0.01\nsoftening = { law = \"linear\", onset_stretch = 0.003 }"
            .to_owned(),
        format!("model = \"state-based\"\nbonds = \"list\"\n{solid}"),
        format!("model = \"state-based\"\nbonds = \"grid\"\n{solid}"),
        format!("model = \"correspondence\"\n{solid}"),
    ] {
        println!("{material}");
        check_touching(&block(&material, PUSH), &[3]);
    }
}

#[test]
fn schemes_with_contact_have_the_files_of_one_process() {
    let dynamic = "velocity = [0, -0.05, 0]\n[contact]\n[time]\nend = 6\ndt = 0.3\nscheme = ";
    // A ball that is pressed into the block while the crack closes.
    let ball = "[[impactor]]\nname = \"ball\"\nshape = \"ball\"\nradius = 3\ncentre = [13, 5, 2.4]\nmotion = \"prescribed\"\ndisplacement = [-0.1, 0, 0]";
    // Without a schedule, static runs write checkpoints at intervals of wall-clock time.
    let every = "[checkpoint]\nevery = 1";
    let fixed = format!(
        "displacement = [0, -0.05, 0]\n[contact]\n{ball}\n[time]\ntolerance = 1e-3\nload_steps = 2\nscheme = "
    );
    for scheme in [
        format!("{dynamic}\"rk4\""),
        format!("{dynamic}\"dormand-prince\"\ntolerance = 1e-6"),
        format!("{dynamic}\"newmark\"\nsolver = \"newton-krylov\""),
        format!("{dynamic}\"discrete-gradient\""),
        format!("{fixed}\"adaptive-dynamic-relaxation\"\n{every}"),
        format!("{fixed}\"fire\"\n{every}"),
    ] {
        println!("{scheme}");
        check_touching(&block("bonds = \"list\"", &scheme), &[3]);
    }
}
