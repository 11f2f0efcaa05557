//! What is odd about a deck, and what makes no physical sense.

use super::{PLATE, STATIC, build, parse, plate_with_time, refusal, ring};

#[test]
fn what_is_odd_is_warned_of() {
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
    assert!(text.starts_with("deck.toml:20:1: this crack lies outside of the body"));
    let (line, text) = cautions("[\"12.4 mm\",", "[\"22.4 mm\",");
    assert_eq!(line, 49);
    assert!(text.contains("`middle`"), "{text}");
    let (line, text) = cautions(
        "end = \"2 us\"",
        "end = \"2 us\"\ndt = \"1 us\"\nallow_unstable = true",
    );
    assert_eq!(line, 55);
    assert!(text.contains("allow_unstable"), "{text}");
}

#[test]
fn odd_time_steps_are_warned_of() {
    let mts = "scheme = \"rk4-mts\"\nratio = 4\nfine = \"middle\"";
    for (time, words) in [
        (
            format!("{mts}\npredictor = \"backward-difference\""),
            "weakly unstable",
        ),
        (
            mts.replace("ratio = 4", "ratio = 1"),
            "both time steps are the same",
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
fn a_short_period_is_warned_of() {
    let warned = build(&ring().replace("length = 20\norigin = -10", "length = 10\norigin = -5"));
    let [warning] = &warned.warnings[..] else {
        panic!("{:?}", warned.warnings)
    };
    assert!(
        warning.to_string().contains("the period of 1e1 m is short"),
        "{warning}"
    );
    assert_eq!(
        (warning.location().line(), warning.location().column()),
        (6, 12)
    );
    let window = build(&ring().replace("amplitude = 1", "amplitude = 1\nwindow = 3"));
    assert!(window.warnings.is_empty());
    let reference = window.exact.unwrap();
    assert_eq!(reference.points.len(), 60);
}

#[test]
fn waves_that_the_grid_distorts_are_warned_of() {
    let bar = |rest: &str| {
        let text = format!(
            r#"
[body]
shape = "bar"
length = 10.0
spacing = 0.02
[material]
density = 1
youngs_modulus = 1
horizon_ratio = 3
[sets]
right = {{ layer = {{ side = "+x", cells = 3 }} }}
[time]
end = 5.0
{rest}"#
        );
        let deck = parse(&text);
        let model = deck.build().unwrap();
        let warnings = deck.judge_waves(&model);
        warnings.iter().map(|w| w.line()).collect::<Vec<_>>()
    };
    let initial = |field: &str, width: f64| {
        bar(&format!(
            "[[initial]]\n{field} = {{ expression = \"exp(-((x-5)/{width})^2)\" }}"
        ))
    };
    // wide and narrow humps
    for field in ["displacement", "velocity"] {
        assert!(initial(field, 0.5).is_empty());
        let narrow = initial(field, 0.03);
        assert_eq!(narrow.len(), 1, "{narrow:?}");
        assert!(
            narrow[0].contains("% of the energy of this initial"),
            "{narrow:?}"
        );
    }
    let pulse = |what: &str, duration: f64| {
        bar(&format!(
            "{what}\nset = \"right\"\nfunction = {{ kind = \"pulse\", duration = {duration} }}"
        ))
    };
    for what in [
        "[[load]]\nbody_force = 1",
        "[[prescribe]]\nvelocity = 1",
        "[[prescribe]]\ndisplacement = 1",
    ] {
        assert!(pulse(what, 2.0).is_empty(), "{what}");
        assert_eq!(pulse(what, 0.05).len(), 1, "{what}");
    }
}

#[test]
fn what_makes_no_physical_sense_is_said() {
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
        "all 3 points of this load are held along it",
    );
    warned(
        "[time]",
        "[[crack]]\nsection = \"15 mm\"\n[time]",
        "5 of 20 points, such as that at (0.015",
    );
    let refused = |replace: &str, by: &str, says: &[&str]| {
        let message = refusal(&STATIC.replace(replace, by)).to_string();
        assert!(
            says.iter().all(|words| message.contains(words)),
            "{message}"
        );
    };
    refused(
        "horizon_ratio = 3",
        "horizon = \"1e6 m\"",
        &["deck.toml:11:11", "is a unit wrong?"],
    );
    refused(
        "[sets]",
        "[[material.part]]\nname = \"more\"\nset = \"middle\"\ndensity = 1\nyoungs_modulus = 1\n[sets]",
        &["the part `glue` has no point"],
    );
}

#[test]
fn waves_faster_than_in_any_solid_are_warned_of() {
    let light = build(&PLATE.replace("2440 kg/m3", "2.44e-9 kg/m3"));
    let said: Vec<String> = light.warnings.iter().map(|w| w.line()).collect();
    assert!(said[0].contains("is the density in kg/m³"), "{said:?}");
}

#[test]
fn a_crack_through_points_is_named_as_the_reason_for_loose_ones() {
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
