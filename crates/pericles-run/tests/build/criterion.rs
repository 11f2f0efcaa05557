//! Failure by stress and strain in decks.

use pericles::Control;

use super::{build, parse, rejection};

/// A bar or plate whose ends have the displacements of a uniform strain, in static equilibrium. The free points and
/// their neighbours have complete families along x, so that the strain is uniform.
fn pulled(body: &str, material: &str, strain: f64, other: &str) -> String {
    format!(
        "body = {{ {body} }}\n\
         material = {{ density = 1, youngs_modulus = 10, horizon_ratio = 3, {material} }}\n\
         sets.left = {{ layer = {{ side = \"-x\", cells = 6 }} }}\n\
         sets.right = {{ layer = {{ side = \"+x\", cells = 6 }} }}\n\
         constraint = [\n\
           {{ set = \"left\", displacement = [{{ expression = \"{strain}*x\" }}{other}] }},\n\
           {{ set = \"right\", displacement = [{{ expression = \"{strain}*x\" }}{other}] }},\n\
         ]\n\
         time = {{ scheme = \"static\", tolerance = 1e-10, rigid_modes = \"fix\" }}\n"
    )
}

const BAR: &str = "shape = \"bar\", length = 20, spacing = 1";
const PLATE: &str = "shape = \"plate\", size = [20, 7], spacing = 1, plane = \"stress\"";

/// Returns whether bonds break: all of them do at once, so that the body may have no further static state.
fn breaks(text: &str) -> bool {
    let mut run = build(text).simulation();
    let ended = run.run(|_| Control::Continue);
    ended.is_err() || run.system().operator().broken_bonds() > 0
}

/// σ = E ε in a bar, and in a plate of a correspondence material that is free to contract: the stress is exact at free
/// surfaces. A bond breaks where its failure index exceeds one.
#[test]
fn bodies_in_tension_break_at_the_predicted_strain() {
    let bar = "model = \"state-based\", strains = \"small\"";
    let plate = "model = \"correspondence\", poisson_ratio = 0.3";
    let strength = "failure = \"principal-stress\", strength = 0.01";
    let index = "failure = \"expression\", criterion = ";
    // Finite strains change the stress by terms of the order of the strain, 1e-3.
    for (body, model, other, margin) in [(BAR, bar, "", 1e-6), (PLATE, plate, ", \"free\"", 0.005)]
    {
        for criterion in [
            strength.to_owned(),
            format!("{index}\"stress_1 / 0.01\""),
            format!("{index}\"(equivalent_stress / 0.01)^2\""),
            format!("{index}\"strain_xx / 1e-3\""),
        ] {
            let material = format!("{model}, {criterion}");
            for (part, expected) in [(1.0 - margin, false), (1.0 + margin, true)] {
                let found = breaks(&pulled(body, &material, 1e-3 * part, other));
                assert_eq!(found, expected, "{material}: {part}");
            }
        }
    }
}

/// Each material has its own criterion; the inherited `failure` needs the key of its criterion.
#[test]
fn materials_have_criteria_of_their_own() {
    let text = pulled(
        BAR,
        "model = \"state-based\", strains = \"small\", failure = \"principal-stress\", strength = 0.02",
        1e-3,
        "",
    );
    let weak = "materials.weak = { density = 1, youngs_modulus = 10, strength = 0.009 }\nsets.part = { where = \"x > 14\" }\nassign = [{ set = \"part\", material = \"weak\" }]\n";
    assert!(breaks(&format!("{text}{weak}")));
    let strong = weak.replace("0.009", "0.011");
    assert!(!breaks(&format!("{text}{strong}")));
}

#[test]
fn constants_describe_the_criterion_and_the_stencil_is_rejected() {
    let material = "model = \"state-based\", poisson_ratio = 0.3, failure = \"expression\", criterion = \"stress_1 / 1e6\"";
    let text = pulled(PLATE, material, 1e-3, ", 0");
    let assembly = build(&text);
    let constants = assembly.assembly.constants.as_ref().unwrap();
    let words = constants.criterion().unwrap().words();
    assert_eq!(words, "where stress_1 / 1e6 exceeds 1");
    let on_grid = text.replace("model =", "bonds = \"grid\", model =");
    let reason = rejection(&on_grid).to_string();
    assert!(reason.contains("stress and strain"), "{reason}");
    let model = serde_json::to_string(&parse(&text).model).unwrap();
    let again: pericles_deck::Model = serde_json::from_str(&model).unwrap();
    assert_eq!(again, parse(&text).model);
}

/// The strength of a bar at rest under a uniform strain decreases at a position, time or temperature.
#[test]
fn criteria_may_depend_on_position_time_and_temperature() {
    for model in ["state-based", "correspondence"] {
        let deck = |change: &str| {
            format!(
                r#"
body = {{ shape = "bar", length = 20, spacing = 1 }}
material = {{ model = "{model}", density = 1e9, youngs_modulus = 10, horizon_ratio = 3, failure = "expression", criterion = "0.9*stretch/1e-3 + 0.2*{change}" }}
initial = [{{ displacement = {{ expression = "1e-3*x" }} }}]
thermal = {{ expansion = 0, reference = 300, temperature = {{ expression = "300 + 10*t" }} }}
time = {{ end = 1, dt = 0.1 }}
"#
            )
        };
        let run = |change: &str| {
            let mut run = build(&deck(change)).simulation();
            let mut times = Vec::new();
            run.run(|now| {
                if now.system().operator().broken_bonds() > 0 {
                    times.push(now.state().t);
                }
                Control::Continue
            })
            .unwrap();
            (times, run)
        };
        assert!(run("step(-1)").0.is_empty());
        let (times, right) = run("step(x - 10.1)");
        assert!(!times.is_empty());
        let mut damage = vec![0.0; 20];
        right.system().operator().damage_into(&mut damage);
        // Bonds of up to 3.5 spacings whose centres are at x > 10.1 reach points at x > 8.
        assert!(
            damage[..8].iter().all(|damage| *damage == 0.0),
            "{damage:?}"
        );
        assert!(
            damage[12..].iter().all(|damage| *damage > 0.9),
            "{damage:?}"
        );
        for change in ["step(t - 0.45)", "step(temperature - 304.5)"] {
            let (times, _) = run(change);
            assert!(
                (times[0] - 0.5).abs() < 1e-9,
                "{model}, {change}: {times:?}"
            );
        }
    }
    let unheated = "body = { shape = \"bar\", length = 20, spacing = 1 }\nmaterial = { model = \"state-based\", density = 1, youngs_modulus = 10, horizon_ratio = 3, failure = \"expression\", criterion = \"stress_1 + temperature\" }\ntime = { end = 1 }";
    let message = rejection(unheated).to_string();
    assert!(
        message.contains("a criterion of the temperature"),
        "{message}"
    );
}
