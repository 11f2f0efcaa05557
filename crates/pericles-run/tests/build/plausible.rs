//! Warnings about implausible values and values without effect; messages of schemes and outputs.

use super::common::Build;
use pericles_deck::Deck;

const BAR: &str = r#"
[body]
shape = "bar"
length = 10
spacing = 1
[material]
density = 1
youngs_modulus = 1
horizon = 3
[sets.left]
layer = { side = "-x", cells = 1 }
[[load]]
set = "left"
body_force = 1
[time]
end = 1
"#;

const PLATE: &str = r#"
[body]
shape = "plate"
size = [1, 0.5]
spacing = 0.02
plane = "stress"
[material]
density = 1
youngs_modulus = 1
horizon_ratio = 4.025
[sets.tip]
box = { min = [0.45, 0.2], max = [0.5, 0.3] }
[[load]]
set = "tip"
body_force = [1, 0]
[time]
end = 1
"#;

fn warnings(text: &str) -> Vec<String> {
    let deck = Deck::parse(text, "deck.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    let model = deck.build().unwrap_or_else(|error| panic!("{error}"));
    model
        .warnings
        .iter()
        .map(|warning| warning.line())
        .collect()
}

fn rejection(text: &str) -> String {
    let deck = Deck::parse(text, "deck.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    deck.build().map(|_| ()).unwrap_err().to_string()
}

#[test]
fn implausible_values_and_values_without_effect_lead_to_warnings() {
    assert_eq!(warnings(BAR), [""; 0]);
    for (replace, by, says) in [
        (
            "density = 1\n",
            "density = 1e18\n",
            "deck.toml:7:11: the density is 1.000e18 kg/m³",
        ),
        (
            "density = 1\nyoungs_modulus = 1",
            "density = 2700\nyoungs_modulus = 70",
            "Young's modulus is 70.0 Pa",
        ),
        (
            "length = 10\nspacing = 1\n",
            "length = 1e-13\nspacing = 1e-14\n",
            "the spacing is 0.0100 pm",
        ),
        (
            "body_force = 1",
            "body_force = 0",
            "nothing acts on the body",
        ),
        (
            "horizon = 3",
            "horizon = 3\nno_fail = \"left\"",
            "`material.no_fail` has no effect",
        ),
        (
            "horizon = 3",
            "horizon = 3\ndamage = { measure = \"count\" }",
            "`material.damage` has no effect",
        ),
        (
            "[time]",
            "[output]\nfragments = { count = 2 }\n[time]",
            "`output.fragments` has no effect",
        ),
        (
            "spacing = 1\n",
            "spacing = 1\nhole = [{ ball = { centre = 50, radius = 1 } }]\n",
            "deck.toml:6:9: this hole has no effect: it contains no cell centre",
        ),
    ] {
        assert_eq!(BAR.matches(replace).count(), 1, "{replace}");
        let deck = BAR.replace(replace, by).replace(
            "horizon = 3",
            if by.contains("1e-14") {
                "horizon = 3e-14"
            } else {
                "horizon = 3"
            },
        );
        let found = warnings(&deck);
        assert!(
            found.iter().any(|warning| warning.contains(says)),
            "{says}: {found:?}"
        );
    }
}

#[test]
fn holes_that_remove_points_lead_to_no_warning() {
    let hole = |ball: &str| {
        PLATE.replace(
            "spacing = 0.02\n",
            &format!("spacing = 0.02\nhole = [{{ ball = {{ centre = {ball} }} }}]\n"),
        )
    };
    let found = warnings(&hole("[0.2, 0.2], radius = 0.05"));
    assert!(
        found
            .iter()
            .all(|warning| !warning.contains("no cell centre")),
        "{found:?}"
    );
    let found = warnings(&hole("[0.2, 0.2], radius = 1e-3"));
    assert!(
        found
            .iter()
            .any(|warning| warning.contains("no cell centre")),
        "{found:?}"
    );
    let sides = hole("[0.2, 0.2], radius = 1e-3")
        .replace("spacing = 0.02", "spacing = [0.02, 0.025]")
        .replace("horizon_ratio = 4.025", "horizon = 0.1");
    let found = warnings(&sides);
    assert!(
        found
            .iter()
            .any(|warning| warning.contains("no cell centre")),
        "{found:?}"
    );
}

#[test]
fn a_thin_fine_set_is_reported_by_name() {
    let deck = PLATE.replace(
        "end = 1",
        "end = 1\nscheme = \"multirate-rk4\"\nratio = 4\nfine = \"tip\"",
    );
    let message = rejection(&deck);
    assert!(
        message.contains("the fine set `tip` is 60.0 mm thick along x; it must be at least as thick as its longest bond, 89.4 mm"),
        "{message}"
    );
    assert!(message.starts_with("deck.toml:20:8:"), "{message}");
}

#[test]
fn stress_output_works_with_multirate_schemes() {
    let deck = PLATE
        .replace("0.45", "0.3")
        .replace("end = 1", "end = 1\nscheme = \"multirate-rk4\"\nratio = 4\nfine = \"tip\"\n[output]\nfields = { names = [\"Stress\"] }");
    // The deck is built.
    warnings(&deck);
    let periodic = BAR
        .replace("spacing = 1\n", "spacing = 1\nperiodic = true\n")
        .replace("density", "model = \"linear\"\ndensity")
        .replace(
            "[time]",
            "[output]\nfields = { names = [\"Strain\"] }\n[time]",
        );
    warnings(&periodic);
}

#[test]
fn the_trigonometric_scheme_reports_its_requirements_for_surfaces() {
    let deck = r#"
[body]
shape = "icosphere"
level = 1
radius = 1
[material]
density = 1
alpha = 0.5
p = 3
horizon = 0.9
[[initial]]
random_velocity = { radius = 0.1, seed = 3 }
[time]
end = 1
dt = 0.1
scheme = "trigonometric"
"#;
    let message = rejection(deck);
    assert!(
        message.contains(
            "trigonometric is not available for this body: its forces have no linear part at rest"
        ),
        "{message}"
    );
    assert!(message.starts_with("deck.toml:16:10:"), "{message}");
}

#[test]
fn far_bodies_and_invalid_sides_are_rejected_with_allowed_values() {
    let far = BAR.replace(
        "spacing = 1\n",
        "spacing = 1\norigin = -9223372036854775808\n",
    );
    for quadrature in ["", "quadrature = \"gauss\"\n"] {
        let deck = far.replace(
            "[material]",
            &format!("{quadrature}[material]\nmodel = \"linear\""),
        );
        let message = rejection(&deck);
        assert!(message.starts_with("deck.toml:6:10: the body reaches 9.22e18 m from the origin, where double precision resolves"), "{message}");
    }
    let message = rejection(&PLATE.replace("spacing = 0.02", "spacing = 0.018"));
    assert!(message.contains("the nearest sides that fit: 990 mm and 1.008 m; spacings that divide all sides: 17.85714 mm and 18.51852 mm"), "{message}");
}

#[test]
fn absorbing_boundaries_of_periodic_bars_are_rejected() {
    let deck = BAR
        .replace("spacing = 1\n", "spacing = 1\nperiodic = true\n")
        .replace("density", "model = \"linear\"\ndensity")
        .replace(
            "[time]",
            "[[boundary]]\nkind = \"absorbing\"\nside = \"-x\"\n[time]",
        );
    let message = rejection(&deck);
    assert_eq!(
        message,
        "deck.toml:17:1: absorbing boundary: a periodic bar has no ends; remove `periodic` or the absorbing boundary"
    );
}

/// Asserts that a deck has exactly one warning that contains a text, and none with a replacement.
fn warned_without(deck: &str, says: &str, replace: &str, by: &str) {
    let found = warnings(deck);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains(says), "{found:?}");
    assert_eq!(deck.matches(replace).count(), 1, "{replace}");
    assert_eq!(warnings(&deck.replace(replace, by)), [""; 0], "{by}");
}

#[test]
fn impactors_narrower_than_the_spacing_and_friction_between_points_are_reported() {
    let deck = r#"
body = { shape = "block", size = [6, 6, 3], spacing = 1 }
material = { density = 1, youngs_modulus = 1, horizon_ratio = 3 }
impactor = [{ name = "shot", shape = "ball", radius = 0.3, centre = [3, 3, 5], mass = 1, velocity = [0, 0, -0.001] }]
time = { end = 1 }
"#;
    let says = "the impactor is 600 mm wide at its narrowest, less than the spacing of 1.00 m";
    warned_without(deck, says, "radius = 0.3", "radius = 0.6");
    let deck = r#"
body = { shape = "plate", size = [6, 6], spacing = 1, plane = "stress" }
material = { density = 1, youngs_modulus = 1, horizon_ratio = 3 }
contact = { friction = { coefficient = 0.2, speed = 0.01 } }
initial = [{ velocity = [1e-6, 0] }]
time = { end = 1 }
"#;
    let says = "friction between points does not conserve angular momentum";
    let friction = "friction = { coefficient = 0.2, speed = 0.01 }";
    warned_without(deck, says, friction, "");
}

#[test]
fn surfaces_whose_force_depends_on_the_mesh_are_reported() {
    let deck = r#"
body = { shape = "icosphere", level = 3, radius = 1 }
material = { model = "power", density = 1, alpha = 0.9, p = 3, horizon = 0.5 }
initial = [{ random_velocity = { radius = 0.1 } }]
time = { scheme = "newmark", end = 0.1, dt = 1e-3 }
"#;
    let says = "the interaction of a vertex with its own area, which the sum over bonds omits";
    warned_without(deck, says, "alpha = 0.9", "alpha = 0.3");
    // For p = 2 the interaction is added by default.
    let linear = deck.replace("p = 3", "p = 2");
    assert_eq!(warnings(&linear), [""; 0]);
    let model = Deck::parse(&linear, "deck.toml", &[]).unwrap().model;
    let material = &model.body.surface().unwrap().material;
    assert!(material.self_interaction);
    let weak = linear.replace("alpha = 0.9", "alpha = 0.4");
    let model = Deck::parse(&weak, "deck.toml", &[]).unwrap().model;
    assert!(!model.body.surface().unwrap().material.self_interaction);
}

#[test]
fn layers_that_bonds_bridge_are_reported() {
    let deck = |layer: &str, more: &str| {
        format!(
            r#"
body = {{ shape = "plate", size = [12, 30], spacing = 1, plane = "stress" }}
material = {{ name = "glass", density = 1, youngs_modulus = 1, horizon_ratio = 3 }}
materials.glue = {{ density = 1, youngs_modulus = 0.1 }}
assign = [{{ set = "layer", material = "glue" }}]
sets.layer = {{ where = "{layer}" }}
initial = [{{ velocity = [1e-6, 0] }}]
time = {{ end = 1 }}
{more}
"#
        )
    };
    // Straight and inclined layers of two cells, and a thin coating, a thick layer and an inclusion.
    for (layer, more, is_bridged) in [
        ("14 < y && y < 16", "", true),
        ("0 < y - x - 9 && y - x - 9 < 2", "", true),
        ("14 < y && y < 16", "crack = [{ layer = \"layer\" }]", false),
        ("y < 2", "", false),
        ("12 < y && y < 18", "", false),
        ("(x - 6)^2 + (y - 15)^2 < 16", "", false),
    ] {
        let found = warnings(&deck(layer, more));
        let says = "bonds bridge this layer";
        let count = found.iter().filter(|line| line.contains(says)).count();
        assert_eq!(count, usize::from(is_bridged), "{layer} {more}: {found:?}");
        assert_eq!(found.len(), count, "{found:?}");
    }
}
