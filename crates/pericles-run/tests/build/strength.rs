//! Tensile strength in decks: strength of a block, several materials, scattered strength, reports.

use pericles::{Control, Simulation};
use pericles_deck::Deck;
use pericles_run::SofteningFacts;

use super::{build, parse, rejection};

/// A square of eight horizons whose ends are pulled apart.
const BLOCK: &str = r#"
body = { shape = "plate", size = [24, 24], spacing = 1, plane = "stress" }
material = { model = "linear", density = 1, youngs_modulus = 10, modulus = "lattice", horizon = 3.000003, volume_correction = "none", critical_stretch = 0.006, tensile_strength = 0.012, softening = { law = "exponential" }, surface_correction = "energy", no_fail = ["left", "right"] }
sets = { left = { layer = { side = "-x", cells = 3 } }, right = { layer = { side = "+x", cells = 3 } } }
constraint = [{ set = "left", displacement = [0, "free"], function = { kind = "constant" } }, { set = "right", displacement = [0.1, "free"], function = { kind = "ramp", duration = 1 } }]
time = { end = 1, scheme = "static", load_steps = 25, tolerance = 1e-6, rigid_modes = "fix", breaking = "all" }
"#;

/// A bar of two materials of different strength, constrained at its ends.
const BAR: &str = r#"
body = { shape = "bar", length = 40, spacing = 1 }
material = { model = "linear", density = 1, horizon_ratio = 3, youngs_modulus = 10, softening = { law = "linear" }, fracture_energy = 1e-3, tensile_strength = 0.02, no_fail = ["left", "right"] }
materials = { weak = { density = 1, youngs_modulus = 10, fracture_energy = 5e-4, tensile_strength = 0.012 } }
sets = { left = { layer = { side = "-x", cells = 3 } }, right = { layer = { side = "+x", cells = 3 } }, part = { where = "x > 15 && x < 25" } }
assign = [{ set = "part", material = "weak" }]
constraint = [{ set = "left", displacement = [0], function = { kind = "constant" } }, { set = "right", displacement = [0.09], function = { kind = "ramp", duration = 1 } }]
time = { end = 1, scheme = "static", load_steps = 100, tolerance = 1e-8, breaking = "all" }
"#;

/// Returns the largest total reaction of the right end over `section`, up to the load step at which it has fallen by a fifth.
fn peak(mut run: Simulation, section: f64) -> f64 {
    let reaction = |now: &Simulation| {
        let motions = now.system().motions();
        motions[1].reaction(now.system().cloud())[0].abs() / section
    };
    let mut largest = 0.0;
    run.run(|now| {
        let stress = reaction(now);
        if stress < 0.8 * largest {
            return Control::Stop;
        }
        largest = f64::max(largest, stress);
        Control::Continue
    })
    .unwrap();
    largest
}

fn facts(text: &str) -> Vec<SofteningFacts> {
    SofteningFacts::of(&parse(text).model, &build(text).assembly)
}

/// Points near the free sides of the block lack bonds, so that its peak stays below the strength of a homogeneous body. The
/// bound of 5 % was chosen after a peak of 0.96 times the strength along the axis was seen. With an onset of f_t/E the
/// peak would be 1.2 times as large.
#[test]
fn a_block_in_tension_has_the_given_strength() {
    let along = facts(BLOCK)[0].strength["0"];
    let peak = peak(build(BLOCK).simulation(), 24.0);
    println!("peak {peak}, strength along the axis {along}");
    assert!((peak / along - 1.0).abs() < 0.05, "{peak} of {along}");
    assert!((peak / 0.012 - 1.0).abs() < 0.05, "{peak}");
}

#[test]
fn each_material_of_a_bar_has_its_own_strength() {
    let weak = peak(build(BAR).simulation(), 1.0);
    let strong = peak(build(&BAR.replace("0.012", "0.02")).simulation(), 1.0);
    // A load step changes the stress by 2.4e-4.
    println!("{weak} {strong}");
    assert!((weak - 0.012).abs() < 2.5e-4, "{weak}");
    assert!((strong - 0.02).abs() < 2.5e-4, "{strong}");
    let [first, second] = &facts(BAR)[..] else {
        panic!("two materials soften");
    };
    assert_eq!([&*first.name, &*second.name], ["default", "weak"]);
    for (found, strength) in [(first, 0.02), (second, 0.012)] {
        assert!(
            (found.onset_stretch / (strength / 10.0) - 1.0).abs() < 1e-9,
            "{found:?}"
        );
    }
}

/// Scattered strength multiplies onset and critical stretch, so that the material is reported as without scatter.
#[test]
fn scatter_keeps_the_softening_of_the_material() {
    let scattered = BLOCK.replace("no_fail", "scatter = { shape = 8 }, no_fail");
    let ([plain], [found]) = (&facts(BLOCK)[..], &facts(&scattered)[..]) else {
        panic!("one material");
    };
    assert_eq!(plain.onset_stretch, found.onset_stretch);
    assert_eq!(plain.strength, found.strength);
}

/// A material with the onset that follows from a strength is the same material.
#[test]
fn a_given_onset_is_reported_with_its_strength() {
    let [by_strength] = &facts(BLOCK)[..] else {
        panic!("one material");
    };
    let onset = format!("onset_stretch = {:e} }}", by_strength.onset_stretch);
    let text = BLOCK
        .replace("tensile_strength = 0.012, ", "")
        .replace("\"exponential\" }", &format!("\"exponential\", {onset}"));
    let [by_onset] = &facts(&text)[..] else {
        panic!("one material");
    };
    assert_eq!(by_onset.strength, by_strength.strength);
    assert!((by_onset.tensile_strength / 0.012 - 1.0).abs() < 1e-9);
    let json = serde_json::to_value(by_onset).unwrap();
    for key in [
        "onset_stretch",
        "critical_stretch",
        "end_stretch",
        "ratio",
        "strength",
        "largest_horizon",
    ] {
        assert!(!json[key].is_null(), "{key} in {json}");
    }
}

#[test]
fn strengths_that_softening_cannot_give_are_errors_at_their_keys() {
    let rejected = |text: &str, words: &[&str]| {
        let message = rejection(text).to_string();
        for word in words {
            assert!(message.contains(word), "{message}");
        }
    };
    rejected(
        &BLOCK.replace("0.012", "0.08"),
        &["deck.toml:3", "80 mPa", "a critical stretch above 0.008"],
    );
    rejected(
        &BAR.replace("tensile_strength = 0.012", "tensile_strength = 0.4"),
        &["deck.toml:4", "400 mPa", "a horizon of at most"],
    );
    let missing = BAR.replace(", tensile_strength = 0.012", "");
    let message = Deck::parse(&missing, "deck.toml", &[])
        .unwrap_err()
        .to_string();
    assert!(message.contains("[materials.weak] requires"), "{message}");
    let interface = format!("{BAR}interface = [{{ critical_stretch = 1e-3 }}]\n");
    rejected(&interface, &["0.001", "above 0.0012", "interface"]);
    rejected(
        &BLOCK.replace("critical_stretch = 0.006, tensile_strength = 0.012, ", ""),
        &["deck.toml:3", "never break"],
    );
}
