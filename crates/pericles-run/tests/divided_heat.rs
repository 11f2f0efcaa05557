//! Heat conduction in bodies divided among processes: the files equal the files of a run on a single process.

mod common;

use std::fs;
use std::path::Path;

use common::processes::{check, check_resumed};
use pericles_deck::Deck;

/// A plate at rest that conducts, with two materials, a hole, an insulating crack and every kind of condition; SHAPE, THERMAL and
/// TIME are placeholders.
const PLATE: &str = r#"
[body]
shape = "plate"
size = [0.034, 0.015]
spacing = 0.001
plane = "stress"
hole = [{ ball = { centre = [0.021, 0.008], radius = 0.002 } }]
SHAPE
[material]
youngs_modulus = 210e9
density = 7850
horizon_ratio = 3
[materials.aluminium]
youngs_modulus = 70e9
density = 2700
[sets]
upper = { where = "y > 9e-3" }
left = { layer = { side = "-x", cells = 3 } }
right = { layer = { side = "+x", cells = 1 } }
top = { layer = { side = "+y", cells = 1 } }
bottom = { layer = { side = "-y", cells = 1 } }
[[assign]]
set = "upper"
material = "aluminium"
[[crack]]
segment = [[0.006, 0.006], [0.015, 0.006]]
[thermal]
conductivity = 45
specific_heat = 460
temperature = { expression = "300 + 1e3*x + 20*sin(9e2*y)" }
reference = 300
THERMAL
[[thermal.material]]
name = "aluminium"
conductivity = 200
specific_heat = 900
[[thermal.condition]]
set = "left"
temperature = { expression = "320 + 3*t" }
[[thermal.condition]]
set = "right"
convection = { coefficient = 500, ambient = 280 }
[[thermal.condition]]
set = "top"
radiation = { emissivity = 0.8, ambient = { expression = "800 - 5*t" } }
[[thermal.condition]]
set = "bottom"
flux = 2e4
function = { kind = "ramp", duration = 0.5 }
[[thermal.condition]]
set = "upper"
source = 1e6
[time]
scheme = "thermal"
TIME
[output]
history = { every = 1 }
fields = { count = 3, names = ["Temperature", "Heat_Flux"], format = ["vtu", "vtkhdf"] }
[[output.profile]]
name = "middle"
field = "Temperature"
from = [0, 0.0075]
to = [0.034, 0.0075]
[checkpoint]
every = 4
"#;

fn plate(shape: &str, thermal: &str, time: &str) -> String {
    PLATE
        .replace("SHAPE", shape)
        .replace("THERMAL", thermal)
        .replace("TIME", time)
}

const SHORT: &str = "end = 1\ndt = 0.1";

#[test]
fn explicit_conduction_has_the_files_of_one_process() {
    check(&plate("", "", SHORT), &[1, 2, 3, 4]);
    let thermal = "step = 0.03\ninterface = \"arithmetic\"\nbroken_conductance = 0.4";
    check(&plate("", thermal, SHORT), &[3]);
    let uncorrected = "surface_correction = false";
    check(&plate("", uncorrected, SHORT), &[4]);
}

#[test]
fn conduction_on_lists_has_the_files_of_one_process() {
    let refined = "refine = [{ ratio = 2, box = { min = [0.010, 0.004], max = [0.020, 0.010] } }]";
    let jittered = "positions = \"jittered\"";
    for (shape, thermal) in [
        (refined, "scheme = \"explicit\"\nstep = 0.03"),
        (refined, "scheme = \"trapezoidal\""),
        (jittered, "scheme = \"backward-euler\""),
    ] {
        println!("{shape}\n{thermal}");
        let deck = plate(shape, thermal, SHORT);
        let deck = match shape == jittered {
            // Such points have no layers of cells and no faces.
            true => ["convection =", "radiation =", "flux ="]
                .iter()
                .fold(deck, |deck, &key| {
                    deck.replace(key, &format!("area = 0.02\n{key}"))
                })
                .replace("cells = 3", "depth = 0.003")
                .replace("cells = 1", "depth = 0.001"),
            false => deck,
        };
        check(&deck, &[2, 3]);
    }
}

#[test]
fn implicit_and_steady_conduction_have_the_files_of_one_process() {
    for thermal in [
        "scheme = \"trapezoidal\"",
        "scheme = \"backward-euler\"\nstep = 0.25",
        "scheme = \"steady\"",
    ] {
        println!("{thermal}");
        check(&plate("", thermal, SHORT), &[2, 3, 4]);
    }
}

/// Returns an example deck with changes that make it small.
fn example(name: &str, changes: &[(&str, &str)]) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/heat");
    let mut deck = fs::read_to_string(root.join(name)).unwrap();
    for (before, after) in changes {
        assert!(deck.contains(before), "{name}: {before}");
        deck = deck.replace(before, after);
    }
    assert!(Deck::parse(&deck, name, &[]).is_ok(), "{name}");
    deck
}

/// Returns the last value of a column of a history.
fn last(history: &str, column: &str) -> f64 {
    let mut lines = history.lines().filter(|line| !line.starts_with('#'));
    let mut names = lines.next().unwrap().split(',');
    let place = names.position(|name| name.starts_with(column));
    let mut row = lines.next_back().unwrap().split(',');
    row.nth(place.unwrap()).unwrap().parse().unwrap()
}

/// A hot glass plate cracks when it is quenched.
fn quench(thermal: &str) -> String {
    let deck = example(
        "thermal-shock.toml",
        &[
            ("spacing = \"0.2 mm\"", "spacing = \"0.5 mm\""),
            ("temperature = \"400 K\"", "temperature = \"200 K\""),
            ("duration = \"20 us\"", "duration = \"1 us\""),
            ("end = \"400 us\"", "end = \"12 us\""),
            ("count = 4, ", "count = 2, "),
            (
                "reference = \"600 K\"",
                &format!("reference = \"600 K\"\n{thermal}"),
            ),
        ],
    );
    deck.replace("[output]", "[output]\nhistory = { every = 10 }") + "[checkpoint]\nevery = 40\n"
}

#[test]
fn thermal_shock_with_cracks_has_the_files_of_one_process() {
    for thermal in ["", "scheme = \"trapezoidal\"\nstep = \"0.3 us\""] {
        println!("{thermal}");
        let history = check(&quench(thermal), &[2, 3, 4]);
        assert!(last(&history, "broken_bonds") > 100.0, "{history}");
    }
}

#[test]
fn static_bodies_with_conduction_have_the_files_of_one_process() {
    let strip = example(
        "bimaterial-strip.toml",
        &[("spacing = \"0.25 mm\"", "spacing = \"0.5 mm\"")],
    );
    let strip = format!("{strip}\n[checkpoint]\nevery = 1\n");
    check(&strip, &[3]);
    let steps = (
        "scheme = \"static\"",
        "scheme = \"static\"\nend = \"20 s\"\nload_steps = 3",
    );
    let strip = strip.replace(steps.0, steps.1);
    check(
        &strip.replace("scheme = \"steady\"", "scheme = \"backward-euler\""),
        &[2, 4],
    );
}

/// A plate torn apart and sheared by its initial velocity; MODEL, THERMAL and TIME are placeholders.
const TORN: &str = r#"
body = { shape = "plate", size = [28, 10], spacing = 1, plane = "strain" }
material = { density = 1, youngs_modulus = 10, horizon_ratio = 3, MODEL }
sets = { middle = { where = "x > 8 && x < 20" }, edge = { layer = { side = "-x", cells = 3 } } }
initial = [{ velocity = [{ expression = "0.1*(x - 14) + 0.05*y" }, 0] }]
thermal = { conductivity = 0.5, specific_heat = 0.2, temperature = 300, dissipation = 0.9, expansion = 1e-4, reference = 300, condition = [{ set = "edge", temperature = 300 }], THERMAL }
time = { TIME }
output = { history = { every = 1 }, fields = { count = 2, names = ["Temperature", "Heat_Flux", "Damage"] } }
checkpoint = { every = 15 }
"#;

fn torn(model: &str, thermal: &str, time: &str) -> String {
    TORN.replace("MODEL", model)
        .replace("THERMAL", thermal)
        .replace("TIME", time)
        .replace(", }", " }")
}

/// As `check`; dissipated energy becomes heat.
fn check_warming(deck: &str, sizes: &[usize]) {
    let history = check(deck, sizes);
    assert!(last(&history, "heat_from_dissipation") > 0.0, "{history}");
}

#[test]
fn heat_from_dissipation_has_the_files_of_one_process() {
    for model in [
        "model = \"linear\", critical_stretch = 0.03, bonds = \"grid\"",
        "model = \"bond-stretch\", critical_stretch = 0.03, bonds = \"list\"",
        "model = \"bond-stretch\", critical_stretch = 0.06, softening = { law = \"linear\", onset_stretch = 0.01 }",
        "model = \"state-based\", poisson_ratio = 0.3, critical_stretch = 0.03, bonds = \"grid\"",
        "model = \"state-based\", poisson_ratio = 0.3, critical_stretch = 0.03, bonds = \"list\"",
        "model = \"correspondence\", poisson_ratio = 0.3, critical_stretch = 0.05",
    ] {
        println!("{model}");
        check_warming(&torn(model, "", "end = 4, dt = 0.05"), &[3]);
        let thermal = "step = 0.27, scheme = \"trapezoidal\"";
        check_warming(&torn(model, thermal, "end = 4, dt = 0.05"), &[2]);
    }
}

#[test]
fn schemes_with_computed_temperatures_have_the_files_of_one_process() {
    let list = "model = \"linear\", critical_stretch = 0.03, bonds = \"list\"";
    let solid = "model = \"state-based\", poisson_ratio = 0.3, critical_stretch = 0.03";
    for (model, time) in [
        (list, "end = 4, dt = 0.1, scheme = \"rk4\""),
        (list, "end = 4, dt = 0.1, scheme = \"dormand-prince\""),
        (
            list,
            "end = 4, dt = 0.2, scheme = \"respa\", ratio = 4, fine = \"middle\"",
        ),
        (
            list,
            "end = 4, dt = 0.2, scheme = \"multirate-rk4\", ratio = 4, fine = \"edge\"",
        ),
        (
            solid,
            "end = 4, dt = 0.2, scheme = \"multirate-rk3\", ratio = 4, fine = \"edge\"",
        ),
        (solid, "end = 4, dt = 0.1, scheme = \"newmark\""),
        (list, "end = 4, dt = 0.2, scheme = \"discrete-gradient\""),
    ] {
        println!("{time}");
        for thermal in ["", "scheme = \"backward-euler\""] {
            check_warming(&torn(model, thermal, time), &[4]);
        }
    }
}

#[test]
fn a_run_with_conduction_is_resumed_on_another_number_of_processes() {
    const SIZES: &[(usize, usize)] = &[(3, 1), (1, 4), (2, 3)];
    check_resumed(
        &plate("", "scheme = \"trapezoidal\"\nstep = 0.25", SHORT),
        7,
        SIZES,
    );
    for model in [
        "model = \"linear\", critical_stretch = 0.03, bonds = \"grid\"",
        "model = \"linear\", critical_stretch = 0.03, bonds = \"list\"",
    ] {
        check_resumed(&torn(model, "step = 0.27", "end = 4, dt = 0.05"), 38, SIZES);
    }
}

#[test]
fn bodies_that_grow_have_the_files_of_one_process() {
    let activation = "[[activation]]\nactive_from = { expression = \"0.1*(x - 6) + 0.05*y\" }\ntemperature = 400\n";
    for model in [
        "model = \"linear\"",
        "model = \"bond-stretch\", critical_stretch = 0.06, softening = { law = \"linear\", onset_stretch = 0.01 }",
    ] {
        let deck = torn(model, "", "end = 4, dt = 0.05").replace(
            "\"Damage\"] }",
            "\"Active\"] }, picture = [{ field = \"Temperature\", count = 2 }]",
        );
        let history = check(&format!("{deck}{activation}"), &[2, 3]);
        assert!(last(&history, "heat_from_activation") > 0.0, "{history}");
    }
}
