//! Properties of materials that are functions of position or temperature.

use pericles::observe::Field;
use pericles::round_trip::check_resume;
use pericles::{Control, Simulation};

use pericles_deck::Deck;

use super::build;
use super::common::Build;

/// A plate in shear; KEYS, REST and TIME are placeholders.
const PLATE: &str = r#"
body = { shape = "plate", size = [16, 10], spacing = 1, plane = "strain" }
KEYS
sets = { low = { where = "y < 3" }, high = { where = "y > 7" }, right = { where = "x > 8" }, left = { where = "x < 8" } }
REST
initial = [{ velocity = [{ expression = "0.06*y + 0.03*x" }, { expression = "0.02*x" }] }]
time = { TIME }
"#;

const SHORT: &str = "end = 1, dt = 0.05";

fn plate(keys: &str, rest: &str) -> String {
    PLATE
        .replace("KEYS", keys)
        .replace("REST", rest)
        .replace("TIME", SHORT)
}

/// Returns the message of an invalid deck.
fn message(deck: &str) -> String {
    let deck = match Deck::parse(deck, "deck.toml", &[]) {
        Err(error) => return error.to_string(),
        Ok(deck) => deck,
    };
    match deck.build() {
        Err(error) => error.to_string(),
        Ok(_) => panic!("an error is expected"),
    }
}

fn finished(deck: &str) -> Simulation {
    let mut run = build(deck).simulation();
    run.run(|_| Control::Continue).unwrap();
    run
}

/// Asserts that two runs have equal displacements to round-off.
fn assert_equal(a: &str, b: &str) {
    let [a_run, b_run] = [a, b].map(finished);
    let (a_u, b_u) = (&a_run.state().u, &b_run.state().u);
    let size = a_u.iter().fold(0.0f64, |size, u| size.max(u.abs()));
    for (a_u, b_u) in a_u.iter().zip(b_u) {
        assert!(
            (a_u - b_u).abs() < 1e-12 * size,
            "{a_u}, {b_u} of {size}\n{a}{b}"
        );
    }
}

/// Materials whose force state belongs to a point, so that both ends of a bond have their own constants.
const SOLIDS: [&str; 3] = [
    "model = \"state-based\", poisson_ratio = 0.3, horizon_ratio = 3",
    "model = \"state-based\", strains = \"small\", poisson_ratio = 0.1, horizon_ratio = 3",
    "model = \"correspondence\", poisson_ratio = 0.3, horizon_ratio = 3",
];

/// One expression replaces a material for each value.
#[test]
fn a_piecewise_constant_function_equals_several_materials() {
    let constants = [
        ("density", ["1", "3"], "youngs_modulus = 10"),
        ("youngs_modulus", ["10", "30"], "density = 1"),
        (
            "yield_stress",
            ["0.2", "0.3"],
            "density = 1, youngs_modulus = 10, hardening = 1",
        ),
        (
            "youngs_modulus",
            ["10", "30"],
            "density = 1, yield_stress = 0.25, hardening = 2",
        ),
    ];
    for solid in SOLIDS {
        for (key, [left, right], others) in constants {
            let function = format!(
                "material = {{ {solid}, {others}, {key} = {{ expression = \"{left} + ({right} - {left})*step(x - 8)\" }} }}"
            );
            let ratio = if solid.contains("0.3") { "0.3" } else { "0.1" };
            let several = format!(
                "materials = {{ default = {{ {solid}, {others}, {key} = {left} }}, other = {{ poisson_ratio = {ratio}, {others}, {key} = {right} }} }}\nassign = [{{ set = \"right\", material = \"other\" }}]"
            );
            assert_equal(&plate(&function, ""), &plate(&several, ""));
        }
    }
    let bonds = "model = \"linear\", youngs_modulus = 10, horizon_ratio = 3";
    let function =
        format!("material = {{ {bonds}, density = {{ expression = \"1 + 2*step(x - 8)\" }} }}");
    let several = format!(
        "materials = {{ default = {{ {bonds}, density = 1 }}, other = {{ density = 3, youngs_modulus = 10 }} }}\nassign = [{{ set = \"right\", material = \"other\" }}]"
    );
    assert_equal(&plate(&function, ""), &plate(&several, ""));
}

/// The modulus of a bond-based material is the relative stiffness of its points.
#[test]
fn the_modulus_of_bonds_is_the_mean_of_both_ends() {
    let bonds = "model = \"bond-stretch\", density = 1, horizon_ratio = 3";
    let function = format!(
        "material = {{ {bonds}, youngs_modulus = {{ expression = \"10 + 20*step(x - 8)\" }} }}"
    );
    let stiffness = format!(
        "material = {{ {bonds}, youngs_modulus = 10 }}\nassign = [{{ set = \"right\", stiffness = 3 }}]"
    );
    assert_equal(&plate(&function, ""), &plate(&stiffness, ""));
}

/// In a graded bar under a force F, u' = F/(A E(x)).
#[test]
fn a_graded_bar_has_the_displacement_of_the_closed_form() {
    for (model, tolerance) in [
        ("model = \"linear\", modulus = \"lattice\"", 2e-4),
        ("model = \"state-based\", strains = \"small\"", 2e-4),
        ("model = \"correspondence\"", 2e-4),
    ] {
        let deck = format!(
            r#"
body = {{ shape = "bar", length = 60, spacing = 1 }}
material = {{ {model}, density = 1, youngs_modulus = {{ expression = "10*(1 + x/30)" }}, horizon_ratio = 3 }}
sets = {{ left = {{ where = "x < 3" }}, right = {{ where = "x > 57" }} }}
constraint = [{{ set = "left", displacement = 0 }}]
load = [{{ set = "right", body_force = 1e-5 }}]
time = {{ scheme = "static", load_steps = 1, tolerance = 1e-10 }}
"#
        );
        let run = finished(&deck);
        let u = &run.state().u;
        // ∫ dx/E = (30/10) ln(1 + x/30) between points of the interior; the force is 3e-5 on 3 m.
        let exact = |x: f64| 3.0 * f64::ln(1.0 + x / 30.0) * 3e-5;
        let (from, to) = (10, 50);
        let found = u[to] - u[from];
        let expected = exact(to as f64 + 0.5) - exact(from as f64 + 0.5);
        let error = found / expected - 1.0;
        assert!(error.abs() < tolerance, "{model}: {error:e}");
    }
}

/// In a uniformly stretched bar bonds break whose mean critical stretch is below the stretch.
#[test]
fn strengths_are_the_means_of_both_ends() {
    const STRETCH: f64 = 0.01;
    for (model, key, exponent) in [
        (
            "model = \"linear\", bonds = \"list\"",
            "critical_stretch",
            1.0,
        ),
        (
            "model = \"linear\", bonds = \"grid\"",
            "critical_stretch",
            1.0,
        ),
        ("model = \"bond-stretch\"", "fracture_energy", 0.5),
        ("model = \"state-based\"", "critical_stretch", 1.0),
        ("model = \"state-based\"", "fracture_energy", 0.5),
        ("model = \"correspondence\"", "critical_stretch", 1.0),
    ] {
        let deck = |value: &str| {
            format!(
                r#"
body = {{ shape = "bar", length = 40, spacing = 1 }}
material = {{ {model}, density = 1, youngs_modulus = 10, horizon_ratio = 3, volume_correction = "none", damage = {{ measure = "count" }}, {key} = {value} }}
initial = [{{ displacement = {{ expression = "{STRETCH}*x" }} }}]
time = {{ end = 1e-6, dt = 1e-6 }}
"#
            )
        };
        // The critical stretch of a material with the constant 1 gives the scale.
        let unit = build(&deck("1"))
            .assembly
            .constants
            .unwrap()
            .critical_stretch();
        // It is the stretch at x = 20.2, between centres of bonds, and grows to the right.
        let middle = (STRETCH / unit).powf(1.0 / exponent);
        let value = |x: f64| middle * (0.495 + x / 40.0);
        let text = format!("{{ expression = \"{middle:e}*(0.495 + x/40)\" }}");
        let run = finished(&deck(&text));
        let snapshot = run.snapshot();
        let damage = snapshot.field(Field::Damage);
        let critical = |x: f64| unit * value(x).powf(exponent);
        for (i, damage) in damage.iter().enumerate() {
            let x = i as f64 + 0.5;
            let others = (1..=3).flat_map(|k| [x - f64::from(k), x + f64::from(k)]);
            let others: Vec<f64> = others.filter(|x| (0.0..40.0).contains(x)).collect();
            let broken = others
                .iter()
                .filter(|other| 0.5 * (critical(x) + critical(**other)) < STRETCH);
            let expected = broken.count() as f64 / others.len() as f64;
            // A point with a single bond or none left loses it in correspondence materials.
            if (17.0..23.0).contains(&x) && model.contains("correspondence") {
                continue;
            }
            assert!(
                (damage - expected).abs() < 1e-12,
                "{model}, {key}: {damage}, {expected} at {x}"
            );
        }
    }
}

/// The stiffest and lightest points limit the time step.
#[test]
fn the_stable_step_is_that_of_the_extreme_values() {
    let deck = |material: &str| {
        plate(&format!("material = {{ {material} }}"), "").replace(", dt = 0.05", "")
    };
    for solid in [
        "model = \"linear\", horizon_ratio = 3",
        SOLIDS[0],
        SOLIDS[2],
    ] {
        let step = |density: &str, modulus: &str| {
            let text = deck(&format!(
                "{solid}, density = {density}, youngs_modulus = {modulus}"
            ));
            build(&text).assembly.stable_step().unwrap()
        };
        let plain = step("1", "10");
        let light = step("{ expression = \"1 - 0.75*step(x - 8)\" }", "10");
        let stiff = step("1", "{ expression = \"10 + 30*step(x - 8)\" }");
        for found in [light, stiff] {
            let ratio = found / plain;
            assert!((ratio - 0.5).abs() < 0.03, "{solid}: {ratio}");
        }
    }
}

const HEAT: &str = "thermal = { expansion = 0, reference = 293, temperature = TEMPERATURE }";

/// A yield stress is evaluated at the temperature of its point.
#[test]
fn yield_stress_at_a_temperature_equals_its_value() {
    for solid in SOLIDS {
        let deck = |value: &str, temperature: &str| {
            let material = format!(
                "material = {{ {solid}, density = 1, youngs_modulus = 10, hardening = 1, yield_stress = {value} }}"
            );
            plate(&material, &HEAT.replace("TEMPERATURE", temperature))
        };
        let function = "{ expression = \"0.2*(1 - (temperature - 293)/1000)\" }";
        assert_equal(&deck(function, "393"), &deck("0.18", "393"));
        let table = "{ table = [[\"293 K\", 0.2], [\"493 K\", \"0.16 Pa\"]] }";
        assert_equal(&deck(table, "393"), &deck("0.18", "393"));
        let field = "{ expression = \"293 + 10*x\" }";
        let place = "{ expression = \"0.2*(1 - x/100)\" }";
        assert_equal(&deck(function, field), &deck(place, field));
        // A temperature that is reached before the first step.
        let quick = "{ expression = \"393 + 0*t\" }";
        assert_equal(&deck(function, quick), &deck("0.18", "393"));
    }
}

/// A stretched bar that is heated relaxes to the yield stress of its temperature; the work of the stress becomes dissipation.
#[test]
fn stress_follows_the_yield_stress_of_a_heated_body() {
    let deck = r#"
body = { shape = "bar", length = 24, spacing = 1 }
material = { model = "correspondence", density = 1, youngs_modulus = 10, horizon_ratio = 3, yield_stress = { table = [[300, 0.02], [500, 0.01]] }, hardening = 0.1 }
sets = { left = { where = "x < 3" }, right = { where = "x > 21" } }
constraint = [{ set = "left", displacement = 0 }, { set = "right", displacement = 0.1, function = { kind = "ramp", duration = 1 } }]
thermal = { expansion = 0, reference = 300, temperature = { expression = "300 + 200*(t - 1)*step(t - 1)" } }
time = { scheme = "static", end = 2, load_steps = 20, tolerance = 1e-8 }
output = { fields = { names = ["Equivalent_Stress", "Plastic_Strain"] } }
"#;
    let run = finished(deck);
    let snapshot = run.snapshot();
    let stress = snapshot.field(Field::EquivalentStress);
    let strain = snapshot.field(Field::PlasticStrain);
    let cloud = run.system().cloud();
    let middle = (0..cloud.len()).filter(|&i| (cloud.point(i)[0] - 12.0).abs() < 3.0);
    for i in middle {
        let yields = 0.01 + 0.1 * strain[i];
        assert!((stress[i] / yields - 1.0).abs() < 0.02, "{}", stress[i]);
    }
    let energies = snapshot.energies();
    assert!(energies.dissipated > 0.0);
    let balance = energies.balance().abs() / energies.dissipated;
    assert!(balance < 0.02, "{energies:?}");
}

#[test]
fn runs_with_functions_resume() {
    let yields = "yield_stress = { expression = \"0.05*(1 + y/20)*(1 - (temperature - 300)/1000)\" }, youngs_modulus = { expression = \"10 + x/10\" }, density = { expression = \"1 + x/20\" }";
    let heat = "thermal = { conductivity = { expression = \"2 + x/10\" }, specific_heat = { expression = \"1 + y/10\" }, expansion = { expression = \"1e-4*(1 + x/20)\" }, temperature = 300, reference = 280, condition = [{ set = \"left\", temperature = 400 }] }";
    for solid in SOLIDS {
        for rest in [
            heat,
            &HEAT.replace("TEMPERATURE", "{ expression = \"300 + 50*t\" }"),
        ] {
            let material = format!(
                "material = {{ {solid}, {yields}, critical_stretch = {{ expression = \"0.05 + x/400\" }} }}"
            );
            let deck = plate(&material, rest);
            check_resume(|| build(&deck).simulation(), [1, 5, 13])
                .unwrap_or_else(|error| panic!("{error}\n{deck}"));
        }
    }
}

/// A conductivity k(x) in a steady state: q = −k T'.
#[test]
fn a_graded_conductor_has_the_temperature_of_the_closed_form() {
    let deck = r#"
body = { shape = "bar", length = 60, spacing = 1 }
material = { model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 3 }
sets = { left = { where = "x < 3" }, right = { where = "x > 57" } }
thermal = { conductivity = { expression = "2*(1 + x/30)" }, specific_heat = 1, temperature = 0, scheme = "steady", condition = [{ set = "left", temperature = 0 }, { set = "right", temperature = 1 }] }
time = { scheme = "thermal", end = 1, dt = 1 }
output = { fields = { names = ["Temperature"] } }
"#;
    let run = finished(deck);
    let snapshot = run.snapshot();
    let temperature = snapshot.field(Field::Temperature);
    // T(x) − T(10.5) is proportional to ln(1 + x/30).
    let exact = |i: usize| f64::ln(1.0 + (i as f64 + 0.5) / 30.0);
    let ratio = (temperature[30] - temperature[10]) / (temperature[50] - temperature[10]);
    let expected = (exact(30) - exact(10)) / (exact(50) - exact(10));
    assert!((ratio - expected).abs() < 2e-4, "{ratio}, {expected}");
}

#[test]
fn invalid_functions_name_the_point_and_the_value() {
    let solid = SOLIDS[0];
    for (keys, rest, words) in [
        (
            "density = { expression = \"1 - x/8\" }, youngs_modulus = 10",
            "",
            "its value at (8.50 m, 500 mm) is -0.06250 kg/m³; it must be positive at all points of the material",
        ),
        (
            "density = 1, youngs_modulus = { expression = \"sqrt(x - 1)\" }",
            "",
            "its value at (500 mm, 500 mm) is NaN",
        ),
        (
            "density = 1, youngs_modulus = 10, yield_stress = { table = [[300, 1]] }",
            "",
            "a function of the temperature",
        ),
        (
            "density = { expression = \"1 + temperature\" }, youngs_modulus = 10",
            HEAT,
            "`temperature`",
        ),
        (
            "density = 1, youngs_modulus = 10, yield_stress = { table = [[300, 1], [300, 2]] }",
            HEAT,
            "temperatures that increase from row to row",
        ),
        (
            "density = 1, bulk_modulus = { expression = \"x\" }, youngs_modulus = 10",
            "",
            "expected a modulus such as \"72 GPa\" or a plain number in Pa, found a table",
        ),
        (
            "density = 1, youngs_modulus = 10",
            "thermal = { expansion = { expression = \"1/(x - 0.5)\" }, reference = 293, temperature = 300 }",
            "its value at (500 mm, 500 mm) is inf",
        ),
    ] {
        let rest = rest.replace("TEMPERATURE", "300");
        let deck = plate(&format!("material = {{ {solid}, {keys} }}"), &rest);
        let message = message(&deck);
        assert!(message.contains(words), "{message}");
    }
}

/// A yield stress that is lost by heating ends the run.
#[test]
fn a_run_whose_yield_stress_vanishes_stops() {
    let material = format!(
        "material = {{ {}, density = 1, youngs_modulus = 10, yield_stress = {{ expression = \"0.2*(1 - (temperature - 293)/100)\" }} }}",
        SOLIDS[2]
    );
    let heat = HEAT.replace("TEMPERATURE", "{ expression = \"293 + 200*t\" }");
    let mut run = build(&plate(&material, &heat)).simulation();
    let error = run.run(|_| Control::Continue).unwrap_err().to_string();
    assert!(
        error.contains("the yield stress at the temperature of the point"),
        "{error}"
    );
    assert!((run.state().t - 0.5).abs() < 0.051, "{error}");
}
