//! Heat conduction in decks.

use pericles::observe::Field;
use pericles::{Control, Simulation};
use pericles_heat::{DiffusingField, SharedField};

use super::{build, rejection};

/// A bar that conducts only; THERMAL is a placeholder.
const BAR: &str = r#"
body = { shape = "bar", length = 0.1, spacing = 0.002, area = 1e-4 }
material = { density = 7850, youngs_modulus = 210e9, horizon_ratio = 3 }
sets = { left = { layer = { side = "-x", cells = 3 } }, right = { layer = { side = "+x", cells = 1 } } }
time = { scheme = "thermal", end = 100, dt = 2 }
output = { fields = { names = ["Temperature", "Heat_Flux"] } }
[thermal]
conductivity = 45
specific_heat = 460
temperature = { expression = "300 + 1000*x" }
THERMAL
"#;

fn field_of(run: &Simulation) -> SharedField {
    let mut fields = run.system().fields();
    let field = fields.find_map(|field| field.downcast_ref::<DiffusingField>());
    field.unwrap().shared()
}

/// Runs the bar; returns the relative error of the heat balance and the temperatures.
fn conducted(thermal: &str) -> (f64, Vec<f64>) {
    let mut run = build(&BAR.replace("THERMAL", thermal)).simulation();
    run.run(|_| Control::Continue).unwrap();
    let field = field_of(&run);
    let t = run.state().t;
    assert_eq!(t, 100.0);
    let inflow: f64 = field.flows(t).iter().sum();
    let error = (field.content(t) - field.initial_content() - inflow) / field.content(t);
    let temperatures = run.snapshot().field(Field::Temperature).to_vec();
    assert!(run.state().u.iter().all(|u| *u == 0.0));
    assert!(
        run.snapshot()
            .field(Field::HeatFlux)
            .iter()
            .all(|flux| flux.is_finite())
    );
    (error, temperatures)
}

#[test]
fn heat_balances_for_every_condition_and_scheme_of_decks() {
    let conditions = [
        "",
        "[[thermal.condition]]\nset = \"left\"\ntemperature = { expression = \"350 + t\" }",
        "[[thermal.condition]]\nset = \"right\"\nflux = 2e4\nfunction = { kind = \"ramp\", duration = 50 }",
        "[[thermal.condition]]\nset = \"all\"\nsource = 1e6",
        "[[thermal.condition]]\nset = \"right\"\nconvection = { coefficient = 500, ambient = 280 }",
        "[[thermal.condition]]\nset = \"right\"\nradiation = { emissivity = 0.8, ambient = { expression = \"800 - t\" } }",
    ];
    for scheme in ["explicit", "trapezoidal", "backward-euler"] {
        for condition in conditions {
            for step in ["", "step = 5", "step = 0.7"] {
                let thermal = format!("scheme = \"{scheme}\"\n{step}\n{condition}");
                let (error, _) = conducted(&thermal);
                assert!(error.abs() < 1e-12, "{thermal}: {error:e}");
            }
        }
    }
}

#[test]
fn flux_through_a_face_has_the_area_of_the_bar() {
    let thermal = "[[thermal.condition]]\nset = \"right\"\nflux = 2e4";
    let mut run = build(&BAR.replace("THERMAL", thermal)).simulation();
    run.run(|_| Control::Continue).unwrap();
    let heat = field_of(&run).flows(100.0)[0];
    assert!((heat / (2e4 * 1e-4 * 100.0) - 1.0).abs() < 1e-12, "{heat}");
}

#[test]
fn schemes_agree_and_a_steady_state_is_linear() {
    let condition = "[[thermal.condition]]\nset = \"left\"\ntemperature = 350\n[[thermal.condition]]\nset = \"right\"\ntemperature = 300";
    let runs = ["explicit", "trapezoidal", "backward-euler"]
        .map(|scheme| conducted(&format!("scheme = \"{scheme}\"\nstep = 0.5\n{condition}")).1);
    for other in &runs[1..] {
        let error = runs[0]
            .iter()
            .zip(other)
            .fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        assert!(error < 0.1, "{error}");
    }
    let (_, steady) = conducted(&format!("scheme = \"steady\"\n{condition}"));
    // Between the layers the temperature falls monotonically from 350 to 300 K.
    assert!(steady.windows(2).all(|pair| pair[1] <= pair[0] + 1e-9));
}

/// A free plate heated uniformly by its conducted temperature; MODEL is a placeholder.
const PLATE: &str = r#"
body = { shape = "plate", size = [8, 4], spacing = 1, plane = "stress" }
material = { density = 1, youngs_modulus = 10, horizon_ratio = 3, MODEL }
sets = { left = { where = "x < 1" }, low = { where = "y < 1" } }
constraint = [{ set = "left", displacement = [0, "free"] }, { set = "low", displacement = ["free", 0] }]
thermal = { expansion = 1e-5, temperature = 293, reference = 293, conductivity = 1, specific_heat = 1, scheme = "steady", condition = [{ set = "left", convection = { coefficient = 1, ambient = 303 }, AREA }] }
time = { scheme = "SCHEME", tolerance = 1e-10 }
"#;

/// The stress of a free plate heated by 10 K is zero relative to E α ΔT.
#[test]
fn free_plates_expand_without_stress() {
    for model in [
        "model = \"linear\"",
        "model = \"bond-stretch\"",
        "model = \"state-based\", strains = \"small\", poisson_ratio = 0.4",
        "model = \"correspondence\", poisson_ratio = 0.4",
    ] {
        let deck = PLATE
            .replace("MODEL", model)
            .replace("SCHEME", "static")
            .replace("AREA", "area = 4");
        let mut run = build(&deck).simulation();
        run.run(|_| Control::Continue).unwrap();
        let snapshot = run.snapshot();
        let temperatures = snapshot.field(Field::Temperature);
        assert!(
            temperatures.iter().all(|t| (t - 303.0).abs() < 1e-9),
            "{temperatures:?}"
        );
        let energy = snapshot.energies().elastic;
        // The elastic energy of the stress E α ΔT in the whole plate.
        let scale = 0.5 * 10.0 * 1e-8 * 32.0;
        assert!(energy < 1e-7 * scale, "{model}: {energy:e} {scale:e}");
    }
}

#[test]
fn output_of_heat_flux_needs_heat_conduction() {
    let deck = PLATE
        .replace("MODEL", "model = \"linear\"")
        .replace("SCHEME", "static")
        .replace(", conductivity = 1, specific_heat = 1, scheme = \"steady\", condition = [{ set = \"left\", convection = { coefficient = 1, ambient = 303 }, AREA }]", "");
    let deck = format!("{deck}\n[output]\nfields = {{ names = [\"Heat_Flux\"] }}\n");
    let text = rejection(&deck).to_string();
    assert!(
        text.contains("Heat_Flux") && text.contains("conductivity"),
        "{text}"
    );
}

#[test]
fn a_flux_through_a_set_without_a_face_needs_an_area() {
    let deck = PLATE
        .replace("MODEL", "model = \"linear\"")
        .replace("SCHEME", "static")
        .replace(", AREA", "");
    let text = rejection(&deck).to_string();
    assert!(text.contains("area"), "{text}");
}

#[test]
fn the_thermal_scheme_needs_heat_conduction() {
    let deck = BAR.split("[thermal]").next().unwrap().replace(
        "names = [\"Temperature\", \"Heat_Flux\"]",
        "names = [\"Displacement\"]",
    );
    let text = rejection(&deck).to_string();
    assert!(text.contains("conductivity"), "{text}");
}

/// The stress of a bar between fixed ends that is heated by 10 K is −E α ΔT.
#[test]
fn a_constrained_bar_has_the_stress_of_the_prevented_expansion() {
    let deck = r#"
body = { shape = "bar", length = 1, spacing = 0.02, area = 1 }
material = { model = "linear", modulus = "lattice", density = 1, youngs_modulus = 1e9, horizon_ratio = 3, volume_correction = "none" }
sets = { left = { layer = { side = "-x", cells = 3 } }, right = { layer = { side = "+x", cells = 3 } } }
constraint = [{ set = "left", displacement = 0 }, { set = "right", displacement = 0 }]
thermal = { expansion = 1e-5, temperature = 293, reference = 293, conductivity = 1, specific_heat = 1, scheme = "steady", condition = [{ set = "left", temperature = 303 }] }
time = { scheme = "static", tolerance = 1e-10 }
"#;
    let mut run = build(deck).simulation();
    run.run(|_| Control::Continue).unwrap();
    let snapshot = run.snapshot();
    let stress = snapshot.field(Field::Stress);
    let middle = stress.len() / 2;
    let expected = -1e9 * 1e-5 * 10.0;
    assert!(
        (stress[middle] / expected - 1.0).abs() < 1e-9,
        "{} {expected}",
        stress[middle]
    );
}
