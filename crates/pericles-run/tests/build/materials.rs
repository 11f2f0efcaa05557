//! Several materials in one body: assignments and interfaces.

use pericles::{Control, Simulation};
use pericles_deck::{Deck, Model};
use pericles_waves::ForceForm;

use super::composition::run_every_way;
use super::{build, parse, rejection};

fn model(text: &str) -> Model {
    parse(text).model
}

fn warnings(text: &str) -> Vec<String> {
    let built = build(text);
    built
        .warnings
        .iter()
        .map(|warning| warning.line())
        .collect()
}

fn run(text: &str) -> Simulation {
    let mut run = build(text).simulation();
    run.run(|_| Control::Continue).unwrap();
    run
}

/// A notched plate of three materials and a stiffened corner that fractures.
const PLATE: &str = r#"
[body]
shape = "plate"
size = ["24 mm", "16 mm"]
spacing = "1 mm"
plane = "strain"
thickness = "2 mm"
[material]
name = "glass"
density = "2440 kg/m3"
youngs_modulus = "72 GPa"
horizon_ratio = 3
fracture_energy = "135 J/m2"
[sets]
right = { where = "x > 0.014" }
grain = { ball = { centre = ["10 mm", "12 mm"], radius = "3 mm" } }
corner = { box = { max = ["6 mm", "5 mm"] } }
[materials.steel]
density = "7850 kg/m3"
youngs_modulus = "210 GPa"
critical_stretch = 0.002
[materials."hard grain"]
density = "3000 kg/m3"
bulk_modulus = "100 GPa"
modulus = "lattice"
fracture_energy = "30 J/m2"
[[assign]]
set = "right"
material = "steel"
[[assign]]
set = "grain"
material = "hard grain"
[[assign]]
set = "corner"
stiffness = 1.7
[[interface]]
rule = "weaker"
[[interface]]
between = ["glass", "steel"]
critical_stretch = 5e-4
[[crack]]
segment = [[0, "8 mm"], ["8 mm", "8 mm"]]
[[initial]]
velocity = [0, { expression = "12*(y - 0.008)/0.008" }]
[time]
end = "3 us"
"#;

#[test]
fn a_plate_of_several_materials_breaks_alike_with_every_kernel() {
    let run = run_every_way(PLATE);
    assert!(run.broken > 10, "{}", run.broken);
}

/// Overrides change tables of materials and interfaces.
#[test]
fn overrides_apply_to_materials_and_interfaces() {
    let overrides = [
        "materials.steel.rho=8000".to_owned(),
        "interface.0.rule=arithmetic".to_owned(),
    ];
    let deck = Deck::parse(PLATE, "deck.toml", &overrides).unwrap();
    assert_eq!(deck.model.materials[0].model.density(), 8000.0);
    let json = deck.to_json();
    assert_eq!(json["interface"][0]["rule"], "arithmetic");
    assert_eq!(json["materials"]["steel"]["density"], 8000.0);
}

/// A bar of three materials on overlapping sets, pulled at its right end.
const LAMINATE: &str = r#"
[body]
shape = "bar"
length = 120
spacing = 1
[material]
name = "soft"
strains = "small"
model = "MODEL"
density = 1
youngs_modulus = 10
horizon_ratio = 3
[materials.hard]
density = 3
youngs_modulus = 40
[materials.middle]
density = 2
youngs_modulus = 20
[[assign]]
set = ["centre", "right"]
material = "hard"
[[assign]]
set = "centre"
material = "middle"
[sets]
left = { layer = { side = "-x", cells = 3 } }
end = { layer = { side = "+x", cells = 3 } }
centre = { where = "40 < x < 80" }
right = { where = "x > 60" }
[[constraint]]
set = "left"
displacement = 0
[[load]]
set = "end"
traction = 0.01
[time]
scheme = "adaptive-dynamic-relaxation"
tolerance = 1e-10
"#;

fn laminate(model: &str) -> String {
    match model {
        "state-based" => LAMINATE.replace("MODEL", model),
        _ => LAMINATE
            .replace("MODEL", model)
            .replace("strains = \"small\"\n", ""),
    }
}

/// Layers in series have the same stress and strains σ/E; elongations add up. Within a horizon of an interface the
/// strain belongs to neither material; therefore the bound of the sum is 0.5 %.
#[test]
fn a_laminate_has_the_stiffness_of_its_layers_in_series() {
    for model in ["linear", "state-based"] {
        let run = run(&laminate(model));
        let density = |i: usize| run.system().density().at(i);
        assert_eq!([density(30), density(60), density(100)], [1.0, 2.0, 3.0]);
        let u = &run.state().u;
        let strain = |from: usize, to: usize| (u[to] - u[from]) / (to - from) as f64;
        for (from, to, young) in [(12, 30, 10.0), (48, 72, 20.0), (88, 108, 40.0)] {
            let error = strain(from, to) * young / 0.01 - 1.0;
            assert!(error.abs() < 1e-6, "{model}, E = {young}: {error:e}");
        }
        // Points are at cell centres: 27.5 cells of the first layer, 40 of the second, 28.5 of the third.
        let sum = 0.01 * (27.5 / 10.0 + 40.0 / 20.0 + 28.5 / 40.0);
        let error = (u[108] - u[12]) / sum - 1.0;
        assert!(error.abs() < 5e-3, "{model}: {error:e}");
    }
}

/// Horizons of 3, 2 and 4 spacings: the same strains, because the constants of a material depend on its horizon.
#[test]
fn the_stiffness_of_a_laminate_does_not_depend_on_the_horizons() {
    let of = |text: &str, young: usize, ratio: usize| {
        let young = format!("youngs_modulus = {young}\n");
        assert!(text.contains(&young), "{text}");
        text.replace(&young, &format!("{young}horizon_ratio = {ratio}\n"))
    };
    let text = of(&of(&laminate("linear"), 20, 2), 40, 4);
    let assembly = build(&text);
    assert_eq!(assembly.form, ForceForm::Grid);
    let run = run(&text);
    let u = &run.state().u;
    // Boundary layers have the width of the horizon.
    for (from, to, young) in [(12, 30, 10.0), (48, 72, 20.0), (94, 102, 40.0)] {
        let strain = (u[to] - u[from]) / (to - from) as f64;
        let error = strain * young / 0.01 - 1.0;
        assert!(error.abs() < 1e-6, "E = {young}: {error:e}");
    }
    let transform = text.replacen("[material]\n", "[material]\nbonds = \"convolution\"\n", 1);
    let message = rejection(&transform).to_string();
    assert!(
        message.contains("the same bonds at every point"),
        "{message}"
    );
    let solids = laminate("state-based").replacen(
        "youngs_modulus = 20\n",
        "youngs_modulus = 20\nhorizon_ratio = 2\n",
        1,
    );
    let report = Deck::parse(&solids, "deck.toml", &[])
        .unwrap_err()
        .to_string();
    assert!(
        report.contains("`horizon` in [materials.middle] differs"),
        "{report}"
    );
}

#[test]
fn later_assignments_replace_earlier_ones() {
    let density = |text: &str, i: usize| build(text).system.density().at(i);
    let text = laminate("linear");
    assert_eq!(density(&text, 70), 2.0);
    // In reverse order the larger set replaces the right half of the smaller one.
    let tables = "[[assign]]\nset = \"centre\"\nmaterial = \"middle\"\n";
    let swapped = text.replace(tables, "");
    let swapped = swapped.replacen("[[assign]]", &format!("{tables}[[assign]]"), 1);
    let swapped = swapped.replace("[\"centre\", \"right\"]", "\"right\"");
    assert_eq!([density(&swapped, 50), density(&swapped, 70)], [2.0, 3.0]);
    // The material of the body can also be assigned.
    let back = text.replace(
        "[sets]",
        "[[assign]]\nset = \"centre\"\nmaterial = \"soft\"\n[sets]",
    );
    let message = rejection(&back).to_string();
    assert!(
        message.contains("no point has the material `middle`"),
        "{message}"
    );
    let back = back.replace(
        "set = \"centre\"\nmaterial = \"soft\"",
        "set = \"end\"\nmaterial = \"soft\"",
    );
    assert_eq!(density(&back, 118), 1.0);
}

/// Common keys of all bonds may be given in [material] only, or repeated; a deck may have only named materials.
#[test]
fn decks_may_have_only_named_materials() {
    let text = laminate("linear");
    let all_named = text
        .replace(
            "[material]\nname = \"soft\"\n",
            "[material]\nhorizon_ratio = 3\nmodel = \"linear\"\n[materials.default]\n",
        )
        .replacen("model = \"linear\"\ndensity", "density", 1)
        .replacen(
            "youngs_modulus = 10\nhorizon_ratio = 3",
            "youngs_modulus = 10\nhorizon = 3",
            1,
        );
    let (mut own, mut named) = (model(&text), model(&all_named));
    for model in [&mut own, &mut named] {
        model.body.solid_mut().unwrap().material.name = None;
    }
    assert_eq!(own, named);
    // Without [material] the first table has the common keys.
    let first = text.replace("[material]\nname = \"soft\"\n", "[materials.soft]\n");
    let message = rejection(&first).to_string();
    let words = "40 of 120 points have no material, such as the one at (0.5) m";
    assert!(message.contains(words), "{message}");
    let assigned = first.replacen(
        "[[assign]]",
        "[[assign]]\nset = \"all\"\nmaterial = \"soft\"\n[[assign]]",
        1,
    );
    let mut all = model(&assigned);
    assert!(!all.body.solid().unwrap().material.is_default);
    all.assignments.remove(0);
    all.body.solid_mut().unwrap().material.is_default = true;
    assert_eq!(all, model(&text));
}

#[test]
fn unused_materials_lead_to_warnings() {
    let more = laminate("linear").replace(
        "[sets]",
        "[materials.spare]\ndensity = 1\nyoungs_modulus = 1\n[sets]",
    );
    let found = warnings(&more);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(
        found[0].contains("deck.toml:24:1: the material `spare` is not assigned"),
        "{found:?}"
    );
}

#[test]
fn models_with_materials_round_trip_through_json() {
    let state_based = laminate("state-based")
        + "[[interface]]\nbetween = [\"soft\", \"hard\"]\nfracture_energy = 1\nfailure = \"bond-energy\"\n";
    let modulus = laminate("linear") + "[[interface]]\nyoungs_modulus = 3\nfracture_energy = 1\n";
    for text in [PLATE.to_owned(), state_based, modulus] {
        let model = model(&text);
        let json = serde_json::to_string(&model).unwrap();
        let read: Model = serde_json::from_str(&json).unwrap();
        assert_eq!(read, model, "{json}");
    }
}

/// Models built by a program are checked like decks.
#[test]
fn errors_of_models_are_reported_at_their_keys() {
    let lines = |change: &dyn Fn(&mut Model)| {
        let mut model = model(&laminate("state-based"));
        change(&mut model);
        model.check().unwrap_err().to_string()
    };
    let message = lines(&|model| model.assignments[1].material = Some("glue".into()));
    assert!(message.contains("assign.1.material"), "{message}");
    let message = lines(&|model| {
        let pericles_deck::MaterialModel::StateBased(state) = &mut model.materials[1].model else {
            panic!("state-based");
        };
        state.solid.horizon = 2.0;
    });
    assert!(message.contains("materials.middle.horizon"), "{message}");
}

/// Two halves of a bar separate at an interface with its own fracture energy; the materials do not break.
const GLUED: &str = r#"
[body]
shape = "bar"
length = 80
spacing = 1
area = 2
[material]
model = "MODEL"
name = "left"
density = 1
youngs_modulus = 10
horizon_ratio = 3
[materials.right]
density = 2
youngs_modulus = 40
[[assign]]
set = "right"
material = "right"
[[interface]]
between = ["right", "left"]
fracture_energy = 2e-5
OTHER
[sets.right]
where = "x > 40"
[[initial]]
velocity = { expression = "8e-3*(x-40)/40" }
[time]
end = 16
dt = 0.002
"#;

/// Exactly the bonds across the interface break, and they dissipate its fracture energy times its area. Bonds break
/// at the end of the step in which they exceed the critical stretch, 1.1e-3 or more. The gap opens by at most 8e-3
/// per unit of time, so that a bond of one cell is stretched by 1.6e-5 per step: 3 % of the energy at the critical
/// stretch.
#[test]
fn an_interface_dissipates_its_own_fracture_energy() {
    for (model, other) in [
        ("linear", ""),
        ("bond-stretch", "rule = \"arithmetic\""),
        ("linear", "youngs_modulus = 3"),
        ("state-based", ""),
        ("state-based", "failure = \"bond-energy\""),
    ] {
        let text = GLUED.replace("MODEL", model).replace("OTHER", other);
        // The default of state-based materials, 1 − r/δ, is zero for bonds of three spacings, which store no energy
        // and do not break.
        let text = text.replace(
            "horizon_ratio = 3",
            "horizon_ratio = 3\ninfluence = { function = \"constant\" }",
        );
        let run = run_every_way(&text);
        // Three cells on each side have 3 + 2 + 1 bonds across.
        assert_eq!(run.broken, 6, "{model} {other}");
        let expected = 2.0 * 2e-5;
        let energies = run.energies;
        let error = energies.dissipated / expected - 1.0;
        assert!(error.abs() < 0.03, "{model} {other}: {error:e}");
        let off = energies.balance() / energies.dissipated;
        assert!(off.abs() < 1e-4, "{model} {other}: {off:e}");
    }
}

/// An interface through a refined grid dissipates its fracture energy on both grids.
#[test]
fn an_interface_through_two_grids_dissipates_its_fracture_energy() {
    let text = r#"
body = { shape = "plate", size = [20, 12], spacing = 1, plane = "stress", refine = [{ ratio = 2, box = { min = [10, "open"], max = ["open", "open"] } }] }
material = { model = "linear", name = "below", density = 1, youngs_modulus = 10, horizon_ratio = 3 }
materials.above = { density = 2, youngs_modulus = 20 }
assign = [{ set = "above", material = "above" }]
interface = [{ fracture_energy = 2e-5 }]
sets.above = { where = "y > 6" }
initial = [{ velocity = [0, { expression = "6e-3*(y-6)/6" }] }]
time = { end = 12, dt = 0.002 }
"#;
    let run = run_every_way(text);
    // Bonds are missing at the free ends of the interface, and lattice planes differ by several per cent.
    let error = run.energies.dissipated / (20.0 * 2e-5) - 1.0;
    assert!(error.abs() < 0.15, "{error:e}");
}
