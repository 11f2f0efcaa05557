//! Constants of materials in decks: consistency and warnings.

use super::common::{Build, Built};
use super::decks::solid;
use pericles::material::{Calibration, Fracture, FractureCalibration};
use pericles_deck::Deck;

/// A body and the keys of [material] other than density and modulus.
fn text(body: &str, material: &str) -> String {
    // Avoids the warning about a body at rest.
    format!(
        "[body]\n{body}\n[material]\ndensity = 2440\nyoungs_modulus = \"72 GPa\"\n{material}\n\
         [time]\nend = 1e-6\ndt = 1e-7\nallow_unstable = true\n\
         [[initial]]\nrandom_velocity = {{ radius = 1e-3 }}\n"
    )
}

const BAR: &str = "shape = \"bar\"\nlength = 0.02\nspacing = 0.001";
const PLATE: &str = "shape = \"plate\"\nsize = [0.012, 0.012]\nspacing = 0.001\nplane = \"strain\"";
const LISTED: &str = "shape = \"points\"\nfile = \"points.txt\"\nspacing = 0.001";
const CLASSES: &str = "horizon_ratio = 1\nvolume_correction = \"none\"\n\
                       influence = { function = \"lattice-classes\", table = [[[1], 1]] }";

fn deck(body: &str, material: &str) -> Deck {
    Deck::parse(&text(body, material), "deck.toml", &[]).unwrap()
}

fn model(body: &str, material: &str) -> Built {
    deck(body, material).build().unwrap()
}

/// Returns the single problem of a deck as one line.
fn rejection(body: &str, material: &str) -> String {
    let error = Deck::parse(&text(body, material), "deck.toml", &[]).unwrap_err();
    let lines: Vec<String> = error.problems().iter().map(|p| p.line()).collect();
    assert_eq!(lines.len(), 1, "{lines:?}");
    lines[0].clone()
}

fn warnings(body: &str, material: &str) -> Vec<String> {
    let model = model(body, material);
    model
        .warnings
        .iter()
        .map(|warning| warning.line())
        .collect()
}

#[test]
fn coefficients_per_class_use_the_lattice_modulus() {
    let calibration = |deck: Deck| solid(&deck).material.bonds().unwrap().modulus.calibration;
    assert_eq!(calibration(deck(BAR, CLASSES)), Calibration::Lattice);
    let given = format!("modulus = \"lattice\"\n{CLASSES}");
    assert_eq!(calibration(deck(BAR, &given)), Calibration::Lattice);
    assert_eq!(
        deck(BAR, CLASSES).to_json()["material"]["modulus"],
        "lattice"
    );
    for word in ["continuum", "unmodified"] {
        let message = rejection(BAR, &format!("modulus = \"{word}\"\n{CLASSES}"));
        assert!(
            message.contains(&format!("deck.toml:8:11: `{word}` is out of range")),
            "{message}"
        );
        assert!(
            message.contains("allowed: \"lattice\"; the influence functions"),
            "{message}"
        );
    }
}

#[test]
fn spectral_kernels_reject_lattice_options() {
    let spectral = "model = \"linear\"\nhorizon_ratio = 3\nbonds = \"spectral\"";
    let ring = format!("{BAR}\nperiodic = true");
    let message = rejection(&ring, &format!("modulus = \"lattice\"\n{spectral}"));
    assert!(
        message.contains("bonds = \"spectral\" uses integrals"),
        "{message}"
    );
    let message = rejection(&ring, &format!("volume_correction = \"none\"\n{spectral}"));
    assert!(
        message.contains("`volume_correction` is not allowed"),
        "{message}"
    );
    assert!(
        message.contains("without partial cells; remove the key"),
        "{message}"
    );
    let gauss = format!("{BAR}\nquadrature = \"gauss\"");
    let linear = "model = \"linear\"\nhorizon_ratio = 3";
    let message = rejection(&gauss, &format!("modulus = \"lattice\"\n{linear}"));
    assert!(
        message.contains("Gauss nodes are not a lattice"),
        "{message}"
    );
    // They have the modulus of the integral, not that of lattice sums.
    for (body, material) in [(&ring, spectral), (&gauss, linear)] {
        let error = model(body, material).constants().stiffness_error;
        assert!(error.abs() < 1e-12, "{error}");
    }
    let conical =
        format!("modulus = \"unmodified\"\ninfluence = {{ function = \"conical\" }}\n{spectral}");
    // ∫(1 − r/δ) r dr is a third of ∫ r dr.
    let error = model(&ring, &conical).constants().stiffness_error;
    assert!((error + 2.0 / 3.0).abs() < 1e-12, "{error}");
}

#[test]
fn poissons_ratio_of_bars_is_rejected() {
    let message = rejection(BAR, "horizon_ratio = 3\npoisson_ratio = 0.3");
    assert!(
        message.contains("`poisson_ratio` is not allowed in [material]"),
        "{message}"
    );
    assert!(message.contains("remove the key"), "{message}");
    let other = "horizon_ratio = 3\n[materials.a]\ndensity = 1\nyoungs_modulus = 1\nnu = 0.3";
    let message = rejection(BAR, other);
    assert!(
        message.contains("`nu` is not allowed in [materials.a]"),
        "{message}"
    );
}

#[test]
fn a_pair_of_materials_given_twice_is_rejected() {
    let interface = |second: &str| {
        format!(
            "name = \"a\"\nhorizon_ratio = 3\n[materials.b]\ndensity = 1\nyoungs_modulus = 1\n\
             [[interface]]\nbetween = [\"a\", \"b\"]\ncritical_stretch = 0.1\n\
             [[interface]]\nbetween = {second}\ncritical_stretch = 0.2"
        )
    };
    for second in ["[\"a\", \"b\"]", "[\"b\", \"a\"]"] {
        let message = rejection(BAR, &interface(second));
        assert!(message.contains("each pair of materials once"), "{message}");
    }
}

#[test]
fn listed_points_have_the_critical_stretch_of_the_continuum() {
    let energy = |deck: Deck| match solid(&deck).material.bonds().unwrap().fracture {
        Fracture::Energy { calibration, .. } => calibration,
        other => panic!("{other:?}"),
    };
    let breaks = "horizon_ratio = 3\nfracture_energy = 135";
    assert_eq!(energy(deck(LISTED, breaks)), FractureCalibration::Continuum);
    assert_eq!(energy(deck(PLATE, breaks)), FractureCalibration::Lattice);
    let given = format!("{breaks}\nfracture_calibration = \"lattice\"");
    let message = rejection(LISTED, &given);
    assert!(
        message.contains("listed points have no lattice planes"),
        "{message}"
    );
    let deck = deck(PLATE, &given);
    assert!(deck.gives("material.fracture_calibration"));
    assert!(!deck.gives("material.modulus"));
}

#[test]
fn large_stiffness_errors_lead_to_warnings() {
    // A conical function with the constant c of the constant function: one third of the stiffness in a bar.
    let conical = "horizon_ratio = 3\ninfluence = { function = \"conical\" }";
    let found = warnings(BAR, &format!("modulus = \"unmodified\"\n{conical}"));
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("deck.toml:8:11"), "{found:?}");
    assert!(found[0].contains("% of the given one"), "{found:?}");
    assert!(found[0].contains("modulus = \"lattice\""), "{found:?}");
    // The constant function that acts on displacements: the micromodulus 3 E/δ³ of the integral.
    let constant = "modulus = \"unmodified\"\nhorizon_ratio = 3\n\
                    influence = { function = \"constant\", acts_on = \"displacement\" }";
    let bar = model(BAR, constant);
    let exact = 3.0 * 72e9 / 3e-3f64.powi(3);
    assert!((bar.constants().micromodulus / exact - 1.0).abs() < 1e-12);
    assert!(bar.warnings.is_empty());
    // Common bodies lead to no warning.
    for material in ["horizon_ratio = 3", "horizon_ratio = 2", conical] {
        assert!(warnings(PLATE, material).is_empty(), "{material}");
    }
    // One spacing: neighbours along the axes only.
    let short = "modulus = \"lattice\"\nhorizon_ratio = 1\nvolume_correction = \"none\"";
    let found = warnings(PLATE, short);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].contains("deck.toml:10:17"), "{found:?}");
    assert!(
        found[0].contains("along the grid axes is 0 % of the material's"),
        "{found:?}"
    );
    assert!(warnings(BAR, short).is_empty());
}
