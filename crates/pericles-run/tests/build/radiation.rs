//! Radiation needs absolute temperatures.

use super::{build, rejection};

fn deck(start: &str, ambient: &str, more: &str) -> String {
    format!(
        r#"
[body]
shape = "plate"
size = ["10 mm", "10 mm"]
spacing = "1 mm"
plane = "stress"
thickness = "1 mm"
[material]
density = 7850
youngs_modulus = "210 GPa"
horizon_ratio = 3
[sets]
top = {{ layer = {{ side = "+y", cells = 1 }} }}
left = {{ layer = {{ side = "-x", cells = 3 }} }}
[thermal]
conductivity = 45
specific_heat = 460
temperature = {start}
scheme = "backward-euler"
[[thermal.condition]]
set = "top"
radiation = {{ emissivity = 0.8, ambient = {ambient} }}
{more}
[time]
scheme = "thermal"
end = "10 s"
dt = "1 s"
"#
    )
}

#[test]
fn negative_temperatures_are_rejected_and_those_of_rooms_in_celsius_lead_to_a_warning() {
    let left =
        |value: &str| format!("[[thermal.condition]]\nset = \"left\"\ntemperature = {value}\n");
    for (start, ambient, more, key) in [
        ("-20", "300", String::new(), "deck.toml:18"),
        ("300", "-5", String::new(), "deck.toml:22"),
        (
            "300",
            "{ expression = \"300 - 1e5*x\" }",
            String::new(),
            "deck.toml:22",
        ),
        ("300", "300", left("-1"), "deck.toml:25"),
    ] {
        let answer = rejection(&deck(start, ambient, &more)).to_string();
        assert!(
            answer.contains(key) && answer.contains("absolute temperatures"),
            "{answer}"
        );
    }
    let warnings = |start: &str, ambient: &str, more: &str| -> usize {
        let built = build(&deck(start, ambient, more));
        let lines = built.warnings.iter().map(|warning| warning.line());
        lines.filter(|line| line.contains("add 273.15")).count()
    };
    assert_eq!(warnings("800", "20", ""), 1);
    assert_eq!(warnings("25", "20", &left("60")), 3);
    // A radiator in space, and usual temperatures.
    assert_eq!(warnings("300", "2.7", ""), 0);
    assert_eq!(warnings("300", "0", ""), 0);
    assert_eq!(warnings("1073.15", "293.15", &left("350")), 0);
    // Without radiation temperatures may be in any scale.
    let celsius = deck("20", "20", "").replace(
        "radiation = { emissivity = 0.8, ambient = 20 }",
        "convection = { coefficient = 10, ambient = -5 }",
    );
    let quiet = build(&celsius);
    assert!(!quiet.warnings.iter().any(|w| w.line().contains("273.15")));
}

#[test]
fn large_coefficients_of_expansion_lead_to_a_warning() {
    let deck = |alpha: &str| {
        format!(
            "[body]\nshape = \"bar\"\nlength = 10\nspacing = 1\n[material]\ndensity = 1\nyoungs_modulus = 1\nhorizon = 3\n\
             [thermal]\nexpansion = {alpha}\ntemperature = 1\nreference = 0\n[time]\nend = 1\ndt = 0.1\n"
        )
    };
    let told = |alpha: &str| {
        let built = build(&deck(alpha));
        let lines = built.warnings.iter().map(|warning| warning.line());
        lines
            .filter(|line| line.contains("thermal expansion is"))
            .count()
    };
    assert_eq!(
        [told("12e-6"), told("0.01"), told("0.05"), told("-0.02")],
        [0, 0, 1, 1]
    );
}
