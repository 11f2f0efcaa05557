//! Warnings about implausible decks.

use super::common::Build;
use super::{PLATE, STATIC, build, parse, plate_with_time, rejection, ring};

#[test]
fn implausible_decks_lead_to_warnings() {
    let cautions = |replace: &str, by: &str| {
        let model = build(&PLATE.replace(replace, by));
        let [warning] = &model.warnings[..] else {
            panic!("one warning for {by}")
        };
        (warning.location().line(), warning.line())
    };
    let away = "[[0, \"20 mm\"], [\"10 mm\", \"20 mm\"]]";
    let (line, text) = cautions("[[0, \"4 mm\"], [\"10 mm\", \"4 mm\"]]", away);
    assert_eq!(line, 20);
    assert!(text.starts_with("deck.toml:20:1: this crack lies outside the body"));
    let (line, text) = cautions("[\"12.4 mm\",", "[\"22.4 mm\",");
    assert_eq!(line, 49);
    assert!(text.contains("`middle`"), "{text}");
    let (line, text) = cautions(
        "end = \"2 us\"",
        "end = \"2 us\"\ndt = \"0.4 us\"\nallow_unstable = true",
    );
    assert_eq!(line, 55);
    assert!(text.contains("allow_unstable"), "{text}");
}

#[test]
fn implausible_time_steps_lead_to_warnings() {
    let mts = "scheme = \"multirate-rk4\"\nratio = 4\nfine = \"middle\"";
    for (time, words) in [
        (
            format!("{mts}\npredictor = \"backward-difference\""),
            "weakly unstable",
        ),
        (
            mts.replace("ratio = 4", "ratio = 1"),
            "both time steps are equal",
        ),
    ] {
        let model = build(&plate_with_time(&time));
        let [warning] = &model.warnings[..] else {
            panic!("one warning for {time}")
        };
        assert!(warning.line().contains(words), "{}", warning.line());
    }
    let quiet = format!("{mts}\npredictor = \"backward-difference\"\nsafety = 0.17");
    assert!(build(&plate_with_time(&quiet)).warnings.is_empty());
}

#[test]
fn a_short_period_leads_to_a_warning() {
    let warned = build(&ring().replace("length = 20\norigin = -10", "length = 10\norigin = -5"));
    let [warning] = &warned.warnings[..] else {
        panic!("{:?}", warned.warnings)
    };
    assert!(
        warning
            .to_string()
            .contains("the period of 10.0 m is short"),
        "{warning}"
    );
    assert_eq!(
        (warning.location().line(), warning.location().column()),
        (6, 12)
    );
    let window = build(&ring().replace("amplitude = 1", "amplitude = 1\nwindow = 3"));
    assert!(window.warnings.is_empty());
    let reference = window.assembly.exact.unwrap();
    assert_eq!(reference.points.len(), 60);
}

/// A bar of length 10 with wave speed 1 and a horizon of three spacings.
fn bar(spacing: f64, horizon: f64, rest: &str) -> Vec<String> {
    let text = format!(
        r#"
[body]
shape = "bar"
length = 10.0
spacing = {spacing}
[material]
density = 1
youngs_modulus = 1
horizon = {horizon}
[sets]
right = {{ layer = {{ side = "+x", depth = 0.06 }} }}
[time]
end = 5.0
{rest}"#
    );
    let deck = parse(&text);
    let model = deck.build().unwrap();
    let warnings = deck.check_waves(&model);
    warnings.iter().map(|w| w.line()).collect::<Vec<_>>()
}

#[test]
fn unresolved_waves_lead_to_a_warning() {
    let initial = |field: &str, wave: f64| {
        let hump = format!(
            "[[initial]]\n{field} = {{ expression = \"exp(-((x-5)/0.5)^2)*cos({wave}*x)\" }}"
        );
        bar(0.02, 0.06, &hump)
    };
    // Wavelengths of a hundred spacings and of two.
    for field in ["displacement", "velocity"] {
        assert!(initial(field, 3.0).is_empty());
        let narrow = initial(field, 154.0);
        assert_eq!(narrow.len(), 1, "{narrow:?}");
        assert!(
            narrow[0].contains("% of the energy of this initial"),
            "{narrow:?}"
        );
        assert!(
            narrow[0].contains("from that in the nonlocal continuum"),
            "{narrow:?}"
        );
    }
    let pulse = |what: &str, duration: f64| {
        let rest = format!(
            "{what}\nset = \"right\"\nfunction = {{ kind = \"pulse\", duration = {duration} }}"
        );
        bar(0.02, 0.06, &rest)
    };
    for what in [
        "[[load]]\nbody_force = 1",
        "[[constraint]]\nvelocity = 1",
        "[[constraint]]\ndisplacement = 1",
    ] {
        assert!(pulse(what, 2.0).is_empty(), "{what}");
        assert_eq!(pulse(what, 0.02).len(), 1, "{what}");
    }
}

/// The same pulse in the same nonlocal model: unresolved with three spacings per horizon, resolved with twelve.
#[test]
fn waves_are_resolved_by_a_finer_grid() {
    let hump = |spacing: f64| {
        let middle = 5.0 + 0.5 * spacing;
        let hump = format!(
            "[[initial]]\ndisplacement = {{ expression = \"exp(-((x-{middle})/0.008)^2)\" }}"
        );
        bar(spacing, 0.06, &hump)
    };
    assert_eq!(hump(0.02).len(), 1);
    assert!(hump(0.005).is_empty());
}

#[test]
fn rigid_motions_and_static_states_emit_no_waves() {
    let plate = |time: &str, rest: &str| {
        let text = format!(
            r#"
[body]
shape = "plate"
size = [40, 6]
spacing = 1
plane = "stress"
[material]
density = 1
youngs_modulus = 1
horizon_ratio = 3
[time]
{time}
{rest}"#
        );
        let deck = parse(&text);
        let warnings = deck.check_waves(&deck.build().unwrap());
        warnings.iter().map(|w| w.line()).collect::<Vec<_>>()
    };
    // Rotated by 0.3 rad, stress-free.
    let turned = "[[initial]]\ndisplacement = [{ expression = \"cos(0.3)*x-sin(0.3)*y-x\" }, { expression = \"sin(0.3)*x+cos(0.3)*y-y\" }]";
    assert!(plate("end = 10\ndt = 0.1", turned).is_empty());
    let spinning =
        "[[initial]]\nvelocity = [{ expression = \"-0.01*y\" }, { expression = \"0.01*x\" }]";
    assert!(plate("end = 10\ndt = 0.1", spinning).is_empty());
    let carried = "[[constraint]]\nset = \"all\"\nvelocity = [1e-3, 0]";
    assert!(plate("end = 10\ndt = 0.1", carried).is_empty());
    // A sudden load emits short waves, but not in a static analysis.
    let sudden = "[sets]\nright = { layer = { side = \"+x\", cells = 1 } }\nleft = { layer = { side = \"-x\", cells = 3 } }\n[[load]]\nset = \"right\"\nbody_force = [1e-6, 0]\nfunction = { kind = \"pulse\", duration = 0.1 }\n[[constraint]]\nset = \"left\"\ndisplacement = [0, 0]";
    assert_eq!(plate("end = 10\ndt = 0.1", sudden).len(), 1);
    let quiet = sudden.replace("function = { kind = \"pulse\", duration = 0.1 }\n", "");
    assert!(plate("scheme = \"adaptive-dynamic-relaxation\"", &quiet).is_empty());
}

/// A glass plate with its sides pulled apart.
fn pulled(conditions: &str) -> Vec<String> {
    let text = format!(
        r#"
[body]
shape = "plate"
size = ["40 mm", "20 mm"]
spacing = "1 mm"
plane = "strain"
[material]
density = 2440
youngs_modulus = "72 GPa"
horizon_ratio = 3
fracture_energy = "135 J/m2"
[sets]
top = {{ layer = {{ side = "+y", cells = 1 }} }}
[time]
end = "10 us"
{conditions}"#
    );
    let model = build(&text);
    model.warnings.iter().map(|w| w.line()).collect()
}

#[test]
fn velocities_that_break_most_bonds_lead_to_warnings() {
    // 4 km/s is above the Rayleigh speed, 3159 m/s; a ramp starts at rest.
    let ramp = "function = { kind = \"ramp\", duration = \"10 us\" }";
    let fast = pulled(&format!(
        "[[constraint]]\nset = \"top\"\nvelocity = [0, \"4 km/s\"]\n{ramp}"
    ));
    // Nevertheless the first step is too long.
    assert_eq!(fast.len(), 2, "{fast:?}");
    assert!(
        fast[0].contains("reaches 3980 m/s, above the Rayleigh speed of 3159 m/s"),
        "{fast:?}"
    );
    assert!(fast[0].starts_with("deck.toml:16:1"), "{fast:?}");
    let sudden = |speed: &str| {
        pulled(&format!(
            "[[constraint]]\nset = \"top\"\nvelocity = [0, \"{speed}\"]"
        ))
    };
    let torn = sudden("100 m/s");
    assert_eq!(torn.len(), 1, "{torn:?}");
    assert!(torn[0].contains("stretches bonds of"), "{torn:?}");
    assert!(
        torn[0].contains("of 800 points beyond the critical stretch"),
        "{torn:?}"
    );
    assert!(sudden("0.5 m/s").is_empty());
    let initial = |x: &str| {
        pulled(&format!(
            "[[initial]]\nvelocity = [{{ expression = \"{x}\" }}, 0]"
        ))
    };
    // A velocity difference of 50 m/s over 40 mm breaks no bonds in one step; a jump in the middle does.
    assert!(initial("50*x/0.04").is_empty());
    let halves = initial("100*step(x-0.02)");
    assert!(
        halves
            .iter()
            .any(|line| line.contains("stretches bonds of")),
        "{halves:?}"
    );
    assert!(
        initial("10000*x/0.04")
            .iter()
            .any(|line| line.contains("initial velocity reaches"))
    );
    // A fast translation of the whole plate breaks no bonds.
    assert!(initial("5000").is_empty());
}

#[test]
fn unphysical_decks_lead_to_warnings() {
    let warned = |replace: &str, by: &str, says: &str| {
        let text = STATIC.replace("0.3\n", "0.1\n");
        let lines: Vec<String> = build(&text.replace(replace, by))
            .warnings
            .iter()
            .map(|warning| warning.line())
            .collect();
        assert!(lines.iter().any(|line| line.contains(says)), "{lines:?}");
    };
    warned(
        "set = \"right\"",
        "set = \"left\"\narea = \"4 mm2\"",
        "all 3 points of this load are constrained along it",
    );
    warned(
        "[time]",
        "[[crack]]\nsection = \"15 mm\"\n[time]",
        "5 of 20 points, such as the one at (0.015",
    );
    let rejected = |replace: &str, by: &str, says: &[&str]| {
        let message = rejection(&STATIC.replace(replace, by)).to_string();
        assert!(
            says.iter().all(|words| message.contains(words)),
            "{message}"
        );
    };
    rejected(
        "horizon_ratio = 3",
        "horizon = \"1e6 m\"",
        &["deck.toml:11:11", "Check the unit of the horizon"],
    );
    rejected(
        "[sets]",
        "[materials.more]\ndensity = 1\nyoungs_modulus = 1\n[[assign]]\nset = \"middle\"\nmaterial = \"more\"\n[sets]",
        &[
            "no point has the material `glue`",
            "put the larger set first",
        ],
    );
}

#[test]
fn wave_speeds_above_those_of_solids_lead_to_a_warning() {
    let light = build(&PLATE.replace("2440 kg/m3", "2.44e-9 kg/m3"));
    let said: Vec<String> = light.warnings.iter().map(|w| w.line()).collect();
    assert!(
        said[0].contains("check the density and the modulus"),
        "{said:?}"
    );
}

#[test]
fn a_crack_through_points_is_reported_as_the_cause_of_isolated_points() {
    let through = PLATE.replace(
        "segment = [[0, \"4 mm\"], [\"10 mm\", \"4 mm\"]]",
        "segment = [[0, \"3.5 mm\"], [\"10 mm\", \"3.5 mm\"]]",
    );
    let model = build(&through);
    let said: Vec<String> = model.warnings.iter().map(|w| w.line()).collect();
    assert!(
        said.concat().contains("shift it by half a cell"),
        "{said:?}"
    );
}
