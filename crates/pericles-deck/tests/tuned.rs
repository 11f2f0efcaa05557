//! Influence functions made against dispersion, from decks.

use pericles::kernel::InfluenceFunction;
use pericles_deck::Deck;

const PLATE: &str = r#"
[body]
shape = "plate"
size = ["12 mm", "12 mm"]
spacing = "1 mm"
plane = "strain"
[material]
density = "2440 kg/m3"
youngs_modulus = "72 GPa"
horizon_ratio = 3
volume_correction = "none"
INFLUENCE
[time]
end = "1 us"
"#;

fn deck(lines: &str) -> Result<Deck, String> {
    let text = PLATE.replace("INFLUENCE", lines);
    Deck::parse(&text, "deck.toml", &[]).map_err(|error| error.to_string())
}

fn values(deck: &Deck) -> Vec<f64> {
    match &deck.material.bonds.influence.function {
        InfluenceFunction::Classes(table) => table.entries().iter().map(|entry| entry.1).collect(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn tuned_for_the_deck_s_own_grid() {
    let signed = deck(r#"influence = { function = "tuned" }"#).unwrap();
    for (value, expected) in values(&signed)
        .iter()
        .zip([27.1405, 6.5827, -19.7723, -0.4557, -0.3311, 6.7355])
    {
        assert!(
            (value - expected).abs() < 1e-4 * expected.abs() + 6e-5,
            "{value} {expected}"
        );
    }
    let model = signed.build().unwrap();
    assert!(model.constants.stiffness_error.abs() < 1e-12);
    let absolute = deck(
        r#"influence = { function = "tuned", method = "galerkin", combination = "absolute" }"#,
    );
    assert!((values(&absolute.unwrap())[0] - 20.83).abs() < 0.05);

    // With breaking only a positive table will do.
    let breaks = "fracture_energy = 135\nfracture_calibration = \"continuum\"";
    let refused = deck(&format!("influence = {{ function = \"tuned\" }}\n{breaks}")).unwrap();
    let message = refused.build().err().unwrap().to_string();
    assert!(message.contains("negative"), "{message}");
    let positive = deck(&format!(
        "influence = {{ function = \"tuned\", lower_bound = 0.5 }}\n{breaks}"
    ))
    .unwrap();
    let model = positive.build().unwrap();
    // 5πG₀/(12Eδ) times m₃(1) m₂/(m₂(1) m₃) of the polygon: for δ = 0.75 mm it is 0.002025.
    let expected = 0.002025 * (0.25f64).sqrt();
    assert!((model.constants.critical_stretch - expected).abs() < 6e-7);
}

#[test]
fn values_by_class() {
    let table = "influence = { function = \"classes\", table = [[[1, 0], 3.76360], [[1, 1], 2.98631], [[2, 0], 0.5], [[2, 1], 0.5], [[2, 2], 0.5], [[3, 0], 0.5]] }";
    let given = deck(table).unwrap();
    assert_eq!(values(&given)[..3], [3.76360, 2.98631, 0.5]);
    assert!(given.build().unwrap().constants.stiffness_error.abs() < 1e-12);
    // Half a spacing more reach needs two classes more.
    let text = PLATE
        .replace("INFLUENCE", table)
        .replace("\"none\"", "\"extended\"");
    let message = Deck::parse(&text, "deck.toml", &[])
        .unwrap()
        .build()
        .err()
        .unwrap()
        .to_string();
    assert!(message.contains("(3, 1, 0)"), "{message}");
}

#[test]
fn cosines_as_printed() {
    let lines = r#"influence = { function = "cosines", wavenumber = 1.1, coefficients = [2.3, 2.0, -0.39, -0.48, 0.28, 0.14, -0.15, -0.02, 0.05] }
        modulus = "unmodified""#;
    let influence = deck(lines).unwrap().material.bonds.influence;
    assert!((influence.alpha(1e-3, 3e-3) - 3.738).abs() < 6e-4);
    assert!((influence.alpha(3e-3, 3e-3) - 0.445).abs() < 6e-4);
}

#[test]
fn wrong_ones_say_what_is_allowed() {
    for (lines, words) in [
        (
            r#"influence = { function = "tuned", method = "collocation" }"#,
            "point-collocation",
        ),
        (
            r#"influence = { function = "tuned", lower_bound = 2 }"#,
            "largest possible bound",
        ),
        (
            r#"influence = { function = "tuned", method = "subdomain-collocation" }"#,
            "unstable",
        ),
        (
            r#"influence = { function = "tuned", method = "galerkin-literal" }"#,
            "least-squares",
        ),
        (
            r#"influence = { function = "tuned", combination = "absolute" }"#,
            "separated",
        ),
        (
            r#"influence = { function = "tuned", pressure_weight = 0 }"#,
            "positive",
        ),
        (
            r#"influence = { function = "classes", table = [[[1, 0, 0], 1]] }"#,
            "axis",
        ),
        (
            r#"influence = { function = "classes", table = [[[0.5, 0], 1]] }"#,
            "whole number",
        ),
        (
            r#"influence = { function = "classes", table = [[[1, 0], 1], [[0, 1], 1]] }"#,
            "twice",
        ),
        (
            r#"influence = { function = "cosines", wavenumber = -1, coefficients = [1] }"#,
            "positive",
        ),
    ] {
        let message = deck(lines)
            .err()
            .unwrap_or_else(|| panic!("{lines} was accepted"));
        assert!(message.contains(words), "{lines}: {message}");
        assert!(message.contains("deck.toml:"), "{message}");
    }
    let near = PLATE
        .replace("INFLUENCE", r#"influence = { function = "tuned" }"#)
        .replace("horizon_ratio = 3", "horizon_ratio = 1.2");
    let message = Deck::parse(&near, "deck.toml", &[])
        .err()
        .unwrap()
        .to_string();
    assert!(message.contains("isotropic"), "{message}");
}
