//! Contact and impactors of decks.

use pericles::Control;
use pericles_contact::{Impactor, PointContact};
use pericles_deck::Deck;
use pericles_waves::ForceForm;

use crate::common::Build;
use crate::common::Built;
use crate::{build, parse, rejection};

/// A bar with 100 cells, E = ρ = A = L = 1, that meets a wall at x = 0 with the speed 0.001.
const BAR: &str = r#"
[body]
shape = "bar"
length = 1
spacing = 0.01
area = 1
[material]
model = "linear"
modulus = "lattice"
volume_correction = "none"
density = 1
youngs_modulus = 1
horizon_ratio = 3
[[initial]]
velocity = -0.001
[[impactor]]
name = "wall"
shape = "half-space"
normal = 1
centre = 0
[time]
end = 3
"#;

fn run(built: Built) -> pericles::Simulation {
    let mut simulation = built.simulation();
    simulation.run(|_| Control::Continue).unwrap();
    simulation
}

fn mean_velocity(simulation: &pericles::Simulation) -> f64 {
    let v = &simulation.state().v;
    v.iter().sum::<f64>() / v.len() as f64
}

#[test]
fn a_bar_leaves_a_wall_with_the_velocity_of_wave_theory() {
    let built = build(BAR);
    assert_eq!(built.system.interactions().count(), 1);
    let end = run(built);
    // An independent program with the same equations has 0.99311 for 100 cells (dt = dx/2); the automatic step is larger.
    let ratio = mean_velocity(&end) / 0.001;
    assert!((ratio - 0.993).abs() < 0.006, "{ratio}");
    let wall = end.system().interactions().next().unwrap();
    let reading = wall.downcast_ref::<Impactor>().unwrap().reading();
    assert_eq!((reading.points, reading.force[0]), (0, 0.0));
    // The impulse is the change of momentum, m (1 + e) v.
    assert!((reading.impulse[0] / (0.001 * (1.0 + ratio)) - 1.0).abs() < 1e-9);
}

#[test]
fn the_automatic_step_resolves_contacts() {
    let with = build(BAR);
    let text = BAR.replace("[[impactor]]", "[contact]\nstiffness = 36\n[[impactor]]");
    let stiff = build(&text);
    let free = BAR.split("[[impactor]]").next().unwrap();
    let without = build(&format!("{free}[time]\nend = 3\n"));
    // ω_c² = k_w/m with k_w = 2 χ E V/δ² and m = ρ V.
    let contact = |chi: f64| (2.0 * chi / 0.03f64.powi(2)).sqrt();
    assert!(stiff.dt <= 0.63 / contact(36.0) * (1.0 + 1e-9));
    assert!(stiff.dt > 0.9 * 0.63 / contact(36.0));
    assert!(with.dt <= 0.63 / contact(2.25) * (1.0 + 1e-9) && with.dt < without.dt);
}

#[test]
fn contact_of_a_deck_acts_between_points() {
    let text = r#"
[body]
shape = "bar"
length = 1
spacing = 0.02
[[body.piece]]
name = "struck"
shape = "bar"
length = 1
origin = 1
[material]
model = "linear"
modulus = "lattice"
volume_correction = "none"
density = 1
youngs_modulus = 1
horizon_ratio = 3
[[initial]]
set = "main"
velocity = 0.001
[contact]
[time]
end = 3
"#;
    let built = build(text);
    assert!(
        built
            .system
            .interactions()
            .next()
            .unwrap()
            .downcast_ref::<PointContact>()
            .is_some()
    );
    let n = built.cloud.len();
    let sets = built.sets.clone();
    let end = run(built);
    let of = |name: &str| {
        let (_, points) = sets.iter().find(|(known, _)| known == name).unwrap();
        let sum: f64 = points.iter().map(|&i| end.state().v[i as usize]).sum();
        sum / points.len() as f64
    };
    // The bars exchange their velocities: an independent program has v2 = 0.99339 for 50 cells.
    let (first, second) = (of("main"), of("struck"));
    assert!((second / 0.001 - 0.993).abs() < 0.006, "{second}");
    assert!(((first + second) / 0.001 - 1.0).abs() < 1e-12 * n as f64);
    // Without contact the struck bar stays at rest, with a warning.
    let without = build(&text.replace("[contact]\n", ""));
    let warned = without
        .warnings
        .iter()
        .any(|one| one.to_string().contains("do not interact"));
    assert!(warned);
}

/// The bar at rest, fixed at its left end and pressed by the wall from the right.
fn pressed(law: &str, tail: &str) -> String {
    let start = BAR.find("[[initial]]").unwrap();
    let body = &BAR[..start].replace(r#"model = "linear""#, law);
    let supports = "[sets]\nroot = { where = \"x < 0.03\" }\ntip = { where = \"x > 0.99\" }\n\
         [[constraint]]\nset = \"root\"\ndisplacement = 0\n";
    format!(
        "{body}{supports}{tail}[time]\nscheme = \"static\"\nend = 1\nload_steps = 3\ntolerance = 1e-11\n"
    )
}

#[test]
fn a_static_wall_presses_like_its_force_on_the_last_point() {
    for law in [r#"model = "linear""#, r#"model = "bond-stretch""#] {
        let wall = "[[impactor]]\nname = \"wall\"\nshape = \"half-space\"\nnormal = -1\ncentre = 1\n\
             displacement = -0.003\nfunction = { kind = \"ramp\", duration = 1 }\n";
        let end = run(build(&pressed(law, wall)));
        let reading = end.system().interactions().next().unwrap();
        let reading = reading.downcast_ref::<Impactor>().unwrap().reading();
        assert_eq!(reading.points, 1);
        // The contact carries the stress of a bar with the stiffness of bar and contact in series, about 0.003.
        assert!((0.002..0.003).contains(&reading.force[0]), "{reading:?}");
        let energies = end.snapshot().energies();
        assert!(energies.contact > 0.0 && energies.work > 0.0);
        let lost = energies.balance().abs() / energies.work;
        assert!(lost < 1e-7, "{law}: {lost:e}");
        let density = -reading.force[0] / 0.01;
        let load = format!("[[load]]\nset = \"tip\"\nbody_force = {density:?}\n");
        let loaded = run(build(&pressed(law, &load)));
        let pairs = end.state().u.iter().zip(&loaded.state().u);
        for (a, b) in pairs {
            assert!((a - b).abs() < 1e-10 * 0.003, "{law}: {a:e} {b:e}");
        }
    }
}

#[test]
fn contact_of_unbonded_points_selects_a_kernel_that_lists_its_bonds() {
    // Without contact a linear plate with this horizon is computed by convolution.
    let plate = r#"
[body]
shape = "plate"
size = [48, 48]
spacing = 1
plane = "stress"
thickness = 1
[material]
model = "linear"
density = 1
youngs_modulus = 1
horizon_ratio = 8
[time]
end = 1
"#;
    assert_eq!(build(plate).form, ForceForm::Convolution);
    let touching = build(&plate.replace("[time]", "[contact]\n[time]"));
    assert_eq!(touching.form, ForceForm::Grid);
    assert_eq!(touching.system.interactions().count(), 1);
}

#[test]
fn bodies_of_contact_are_checked() {
    let cases = [
        ("periodic = true", "not periodic"),
        ("surface", "2-manifolds"),
    ];
    let periodic = BAR.replace("area = 1", "area = 1\nperiodic = true");
    let message = rejection(&periodic).to_string();
    assert!(message.contains(cases[0].1), "{message}");
    let twice = format!(
        "{BAR}[[impactor]]\nname = \"wall\"\nshape = \"ball\"\nradius = 1\ncentre = -9\ndensity = 1\n"
    );
    let message = Deck::parse(&twice, "deck.toml", &[])
        .unwrap_err()
        .to_string();
    assert!(
        message.contains("another impactor has this name"),
        "{message}"
    );
}

#[test]
fn large_steps_and_fast_impacts_are_reported() {
    let step = parse(&BAR.replace("end = 3", "end = 3\ndt = 0.01"))
        .build()
        .unwrap();
    let fast = build(&BAR.replace("velocity = -0.001", "velocity = -0.5"));
    let said = |built: &Built, words: &str| {
        built
            .warnings
            .iter()
            .any(|one| one.to_string().contains(words))
    };
    assert!(said(&step, "less than five steps"));
    assert!(said(&fast, "pass each other"));
    assert!(!said(&build(BAR), "pass each other"));
}
