//! Static runs that are resumed between load steps equal uninterrupted ones, with the same number of products.

use pericles::round_trip::check_resume;

use super::build;

/// A plate that is pulled, sheared and unloaded; MATERIAL, REST and TIME are placeholders.
const PLATE: &str = r#"
body = { shape = "plate", size = [24, 10], spacing = 1, plane = "strain" }
material = { density = 1, youngs_modulus = 10, horizon_ratio = 3, MATERIAL }
sets = { left = { layer = { side = "-x", cells = 3 } }, right = { layer = { side = "+x", cells = 3 } }, middle = { where = "x > 8 && x < 16" } }
constraint = [{ set = "left", displacement = [0, 0] }, { set = "right", displacement = [{ expression = "0.4*sin(3*t)" }, { expression = "0.2*t" }] }]
REST
time = { scheme = "static", end = 1, load_steps = 8, TIME }
"#;

fn check(material: &str, rest: &str, time: &str) {
    let deck = PLATE
        .replace("MATERIAL", material)
        .replace("REST", rest)
        .replace("TIME", time)
        .replace(", }", " }");
    let pauses = [1, 3, 4, 6];
    check_resume(|| build(&deck).simulation(), pauses)
        .unwrap_or_else(|error| panic!("{error}\n{deck}"));
}

#[test]
fn materials_with_a_history() {
    for material in [
        "model = \"bond-stretch\", critical_stretch = 0.08, softening = { law = \"linear\", onset_stretch = 0.005 }",
        "model = \"state-based\", poisson_ratio = 0.2, strains = \"small\", yield_stress = 0.05",
        "model = \"state-based\", poisson_ratio = 0.3, yield_stress = 0.05, hardening = 1",
        "model = \"state-based\", poisson_ratio = 0.3, yield_stress = 0.05, critical_stretch = 0.02",
        "model = \"state-based\", poisson_ratio = 0.3, viscosity = [{ share = 0.7, time = 0.2 }]",
        "model = \"correspondence\", poisson_ratio = 0.3, yield_stress = 0.05, hardening = 1",
        "model = \"correspondence\", poisson_ratio = 0.3, yield_stress = 0.05, hardening = 1, critical_stretch = 0.03",
    ] {
        check(material, "", "");
    }
}

#[test]
fn bodies_that_conduct_heat() {
    let heat = "thermal = { conductivity = 2, specific_heat = 1, expansion = 1e-4, temperature = 300, reference = 280, condition = [{ set = \"left\", temperature = 400 }] }";
    for material in [
        "model = \"linear\"",
        "model = \"bond-stretch\", critical_stretch = 0.02",
        "model = \"state-based\", poisson_ratio = 0.3",
        "model = \"state-based\", poisson_ratio = 0.3, yield_stress = 0.05",
        "model = \"correspondence\", poisson_ratio = 0.3",
    ] {
        check(material, heat, "");
    }
}

#[test]
fn other_decks() {
    let brittle = "model = \"state-based\", poisson_ratio = 0.3, critical_stretch = 0.02";
    for breaking in ["worst-first", "all"] {
        check(brittle, "", &format!("breaking = \"{breaking}\""));
    }
    // Constraints of other components, and a rigid body in contact.
    let plastic = "model = \"state-based\", poisson_ratio = 0.3, yield_stress = 0.05";
    check(
        plastic,
        "load = [{ set = \"middle\", body_force = [0, { expression = \"-1e-3*t\" }] }]",
        "",
    );
    check(
        plastic,
        "impactor = [{ name = \"punch\", shape = \"ball\", radius = 3, centre = [12, 13], motion = \"prescribed\", displacement = [0, -0.3], function = { kind = \"ramp\", duration = 1 } }]",
        "",
    );
}
