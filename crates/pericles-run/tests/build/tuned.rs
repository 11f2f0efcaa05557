//! Tuned influence functions in decks.

use super::common::Build;
use super::decks::solid;
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
    match &solid(deck).material.bonds().unwrap().influence.function {
        InfluenceFunction::Classes(table) => table.entries().iter().map(|entry| entry.1).collect(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_default_decay_is_one_radian_per_spacing() {
    let default = values(&deck(r#"influence = { function = "tuned" }"#).unwrap());
    let given = values(&deck(r#"influence = { function = "tuned", decay = 1 }"#).unwrap());
    assert_eq!(default, given);
    let expected = [10.17, 11.46, 1.13, -4.66, 1.48, 0.72];
    for (value, expected) in default.iter().zip(expected) {
        assert!((value - expected).abs() < 6e-3, "{value} {expected}");
    }
}

#[test]
fn tuned_kernels_are_compared_with_a_constant_one() {
    let quality = |lines: &str| {
        let deck = deck(lines).unwrap();
        let model = deck.build().unwrap();
        let waves = model.plane_waves(&deck.model).unwrap();
        let warned = deck.check_waves(&model);
        (waves, warned.iter().map(|w| w.line()).collect::<Vec<_>>())
    };
    let (good, warned) = quality(r#"influence = { function = "tuned" }"#);
    let [tuned, constant] = good.tuning.unwrap();
    assert!((5.0..6.5).contains(&tuned.spacings), "{tuned:?}");
    assert!((25.0..45.0).contains(&constant.spacings), "{constant:?}");
    assert!(tuned.worst < 0.04 && constant.worst > 0.3);
    assert!(warned.is_empty(), "{warned:?}");
    // Coefficients per class have no continuum limit.
    assert_eq!(good.model, None);
    // Equal weights with a horizon of five spacings are worse than no tuning.
    let text = PLATE
        .replace(
            "INFLUENCE",
            r#"influence = { function = "tuned", decay = "none" }"#,
        )
        .replace("horizon_ratio = 3", "horizon_ratio = 5");
    let deck = Deck::parse(&text, "deck.toml", &[]).unwrap();
    let warned = deck.check_waves(&deck.build().unwrap());
    let [warning] = &warned[..] else {
        panic!("{warned:?}")
    };
    let line = warning.line();
    assert!(
        line.starts_with(
            "deck.toml:12:13: the tuned influence function has more numerical dispersion"
        ),
        "{line}"
    );
    assert!(line.contains("decay = 1 (the default)"), "{line}");
}

#[test]
fn unstable_coefficients_require_allow_unstable() {
    let lines = r#"influence = { function = "tuned", method = "subdomain-collocation", decay = "none", lower_bound = "none" }"#;
    let rejected = deck(lines).unwrap_err();
    assert!(
        rejected.starts_with("deck.toml:12:13: the tuned coefficients make the lattice unstable"),
        "{rejected}"
    );
    assert!(rejected.contains("allow_unstable = true"), "{rejected}");
    let text = PLATE.replace("INFLUENCE", lines) + "allow_unstable = true\n";
    let deck = Deck::parse(&text, "deck.toml", &[]).unwrap();
    let warned = deck.check_waves(&deck.build().unwrap());
    let lines: Vec<String> = warned.iter().map(|w| w.line()).collect();
    assert!(
        lines.iter().any(|line| line.contains("some waves grow")),
        "{lines:?}"
    );
}

#[test]
fn kernels_that_would_be_unstable_are_bounded() {
    let block = PLATE
        .replace("\"plate\"", "\"block\"")
        .replace(
            "size = [\"12 mm\", \"12 mm\"]",
            "size = [\"8 mm\", \"8 mm\", \"8 mm\"]",
        )
        .replace("plane = \"strain\"\n", "");
    let tuned = |lines: &str| {
        let text = block.replace("INFLUENCE", lines);
        Deck::parse(&text, "deck.toml", &[])
    };
    let deck = tuned(r#"influence = { function = "tuned" }"#).unwrap();
    assert!(values(&deck).iter().all(|value| *value >= 0.0));
    let table = solid(&deck).material.tuned.as_ref().unwrap();
    assert_eq!(table.tuning.lower_bound, Some(0.0));
    assert!(table.assessment.stability.is_stable());
    let model = deck.build().unwrap();
    let [tuned_kernel, constant] = model.plane_waves(&deck.model).unwrap().tuning.unwrap();
    assert!(tuned_kernel.spacings < 0.7 * constant.spacings);
    assert!(tuned_kernel.worst < 0.5 * constant.worst);
    assert!(deck.check_waves(&model).is_empty());
    let rejected = tuned(r#"influence = { function = "tuned", lower_bound = "none" }"#);
    let message = rejected.unwrap_err().to_string();
    assert!(message.contains("unstable"), "{message}");
    // For a plate no bound is needed.
    let plate = self::deck(r#"influence = { function = "tuned" }"#).unwrap();
    assert_eq!(
        solid(&plate)
            .material
            .tuned
            .as_ref()
            .unwrap()
            .tuning
            .lower_bound,
        None
    );
}

#[test]
fn breakable_classes_without_stiffness_lead_to_a_warning() {
    let cautions = |lines: &str| {
        // With an initial velocity, to avoid the warning about a body at rest.
        let text = PLATE.replace("INFLUENCE", lines) + "[[initial]]\nvelocity = [1, 0]\n";
        let deck = Deck::parse(&text, "deck.toml", &[]).unwrap();
        let warnings = deck.build().unwrap().warnings;
        warnings.iter().map(|w| w.line()).collect::<Vec<_>>()
    };
    let breaks = r#"fracture_energy = "135 J/m2""#;
    let zero = r#"influence = { function = "tuned", lower_bound = 0 }"#;
    let found = cautions(&format!("{zero}\n{breaks}"));
    assert!(
        found[0].contains("4 of 6 bond classes have the coefficient 0"),
        "{found:?}"
    );
    assert!(found[0].contains("lower_bound such as 0.5"), "{found:?}");
    assert!(cautions(zero).is_empty());
    let half = zero.replace("lower_bound = 0", "lower_bound = 0.5");
    assert!(cautions(&format!("{half}\n{breaks}")).is_empty());
}

#[test]
fn weights_of_bars_are_rejected() {
    let bar = PLATE
        .replace("\"plate\"", "\"bar\"")
        .replace("size = [\"12 mm\", \"12 mm\"]", "length = \"12 mm\"")
        .replace("plane = \"strain\"\n", "");
    for key in ["pressure_weight", "shear_weight"] {
        let lines = format!("influence = {{ function = \"tuned\", {key} = 2 }}");
        let rejected =
            Deck::parse(&bar.replace("INFLUENCE", &lines), "deck.toml", &[]).unwrap_err();
        let message = rejected.to_string();
        assert!(
            message.contains(&format!("`{key}` is not allowed in [material.influence]")),
            "{message}"
        );
        assert!(
            message.contains("weights have no effect on a bar"),
            "{message}"
        );
    }
}

#[test]
fn coefficients_are_tuned_for_the_grid_of_the_deck() {
    let signed = deck(r#"influence = { function = "tuned", decay = "none" }"#).unwrap();
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
    assert!(model.constants().stiffness_error.abs() < 1e-12);
    let absolute = deck(
        r#"influence = { function = "tuned", method = "galerkin", combination = "absolute", decay = "none" }"#,
    );
    assert!((values(&absolute.unwrap())[0] - 20.83).abs() < 0.05);

    // Breaking bonds require positive coefficients.
    let breaks = "fracture_energy = 135\nfracture_calibration = \"continuum\"";
    let rejected = deck(&format!("influence = {{ function = \"tuned\" }}\n{breaks}")).unwrap();
    let message = rejected.build().err().unwrap().to_string();
    assert!(message.contains("negative"), "{message}");
    let positive = deck(&format!(
        "influence = {{ function = \"tuned\", lower_bound = 0.5 }}\n{breaks}"
    ))
    .unwrap();
    let model = positive.build().unwrap();
    // 5πG₀/(12Eδ) times m₃(1) m₂/(m₂(1) m₃) of the polygon: for δ = 0.75 mm it is 0.002025.
    let expected = 0.002025 * (0.25f64).sqrt();
    assert!((model.constants().critical_stretch - expected).abs() < 6e-7);
}

#[test]
fn values_by_class_are_read() {
    let table = "influence = { function = \"lattice-classes\", table = [[[1, 0], 3.76360], [[1, 1], 2.98631], [[2, 0], 0.5], [[2, 1], 0.5], [[2, 2], 0.5], [[3, 0], 0.5]] }";
    let given = deck(table).unwrap();
    assert_eq!(values(&given)[..3], [3.76360, 2.98631, 0.5]);
    assert!(given.build().unwrap().constants().stiffness_error.abs() < 1e-12);
    // Half a spacing more of reach adds two classes.
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
fn cosine_coefficients_match_the_published_ones() {
    let lines = r#"influence = { function = "cosines", wavenumber = 1.1, coefficients = [2.3, 2.0, -0.39, -0.48, 0.28, 0.14, -0.15, -0.02, 0.05] }
        modulus = "unmodified""#;
    let influence = solid(&deck(lines).unwrap())
        .material
        .bonds()
        .unwrap()
        .influence
        .clone();
    assert!((influence.alpha(1e-3, 3e-3) - 3.738).abs() < 6e-4);
    assert!((influence.alpha(3e-3, 3e-3) - 0.445).abs() < 6e-4);
}

#[test]
fn invalid_tuning_is_rejected_with_allowed_values() {
    for (lines, words) in [
        (
            r#"influence = { function = "tuned", method = "collocation" }"#,
            "point-collocation",
        ),
        (
            r#"influence = { function = "tuned", lower_bound = 2 }"#,
            "largest feasible bound",
        ),
        (
            r#"influence = { function = "tuned", method = "subdomain-collocation", decay = "none", lower_bound = "none" }"#,
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
            r#"influence = { function = "tuned", decay = 0 }"#,
            "or \"none\"",
        ),
        (
            r#"influence = { function = "tuned", decay = "all" }"#,
            "not a number",
        ),
        (
            r#"influence = { function = "lattice-classes", table = [[[1, 0, 0], 1]] }"#,
            "axis",
        ),
        (
            r#"influence = { function = "lattice-classes", table = [[[0.5, 0], 1]] }"#,
            "whole number",
        ),
        (
            r#"influence = { function = "lattice-classes", table = [[[1, 0], 1], [[0, 1], 1]] }"#,
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
