//! Thermal expansion and scattered strength in decks.

use pericles::Control;
use pericles::observe::Field;

use super::{build, parse, rejection};

/// A free plate in plane strain; MODEL is a placeholder.
const PLATE: &str = r#"
body = { shape = "plate", size = [8, 4], spacing = 1, plane = "strain" }
material = { density = 1, youngs_modulus = 10, horizon_ratio = 3, MODEL }
sets = { left = { where = "x < 1" }, low = { where = "y < 1" } }
constraint = [{ set = "left", displacement = [0, "free"] }, { set = "low", displacement = ["free", 0] }]
thermal = { expansion = 1e-5, temperature = 303, reference = 293 }
time = { scheme = "adaptive-dynamic-relaxation", tolerance = 1e-7, load_steps = 1 }
output = { fields = { names = ["Temperature"] } }
"#;

/// The out-of-plane strain is prevented: the in-plane strain is (1 + ν) α ΔT for every model.
#[test]
fn plates_in_plane_strain_expand_freely_within_the_plane() {
    for (model, nu) in [
        ("model = \"linear\"", 0.25),
        (
            "model = \"state-based\", strains = \"small\", poisson_ratio = 0.4",
            0.4,
        ),
        ("model = \"correspondence\", poisson_ratio = 0.4", 0.4),
    ] {
        let mut run = build(&PLATE.replace("MODEL", model)).simulation();
        run.run(|_| Control::Continue).unwrap();
        let cloud = run.system().cloud().clone();
        let (n, stretch) = (cloud.len(), (1.0 + nu) * 1e-4);
        for i in 0..n {
            let place = cloud.point(i);
            for c in 0..2 {
                let expected = stretch * (place[c] - 0.5);
                let error = (run.state().u[c * n + i] - expected).abs();
                // Finite-strain effects are of the order of the strain.
                assert!(
                    error < 1e-3 * stretch * 8.0,
                    "{model}, {place:?}: {error:e}"
                );
            }
        }
        let snapshot = run.snapshot();
        assert!(
            snapshot
                .field(Field::Temperature)
                .iter()
                .all(|t| *t == 303.0)
        );
        let energies = snapshot.energies();
        let size = energies.work.abs().max(energies.initial);
        // The energy of the prevented out-of-plane strain, ½ E (α ΔT)², is included for correspondence materials only.
        let across = match model.contains("correspondence") {
            true => 0.5 * 10.0 * 1e-8 * 32.0,
            false => 0.0,
        };
        let error = (energies.elastic - across).abs();
        // Finite-strain effects are of the order of the strain, 1e-4; bound chosen after observing 2e-5.
        assert!(error < 1e-4 * size, "{model}: {energies:?}");
        assert!(
            energies.balance().abs() < 1e-3 * size,
            "{model}: {energies:?}"
        );
    }
}

#[test]
fn materials_have_their_own_expansion_coefficients() {
    let deck = r#"
body = { shape = "bar", length = 8, spacing = 1 }
materials = { default = { model = "linear", density = 1, youngs_modulus = 1, horizon_ratio = 3 }, hot = { density = 1, youngs_modulus = 1 } }
sets = { half = { where = "x > 4" } }
assign = [{ set = "half", material = "hot" }]
thermal = { expansion = 1e-3, temperature = { expression = "10 + x + t" }, reference = 10, material = [{ name = "hot", expansion = 2e-3 }] }
time = { end = 1, dt = 0.1 }
"#;
    let run = build(deck).simulation();
    let thermal = run.system().operator().capabilities().thermal.unwrap();
    let stretches = thermal.stretches(2.0);
    for (i, stretch) in stretches.iter().enumerate() {
        let x = run.system().cloud().point(i)[0];
        let alpha = if x > 4.0 { 2e-3 } else { 1e-3 };
        assert!(
            (stretch - alpha * (x + 2.0)).abs() < 1e-15,
            "{x}: {stretch}"
        );
    }
    let unknown = deck.replace("name = \"hot\"", "name = \"cold\"");
    let error = pericles_deck::Deck::parse(&unknown, "deck.toml", &[]).unwrap_err();
    assert!(format!("{error:?}").contains("cold"));
}

/// T₀ + g(t) (T − T₀) with T of each point from a file, in the order of the points of the user.
#[test]
fn temperatures_of_points_come_from_a_file_and_follow_a_time_function() {
    use pericles_run::{assemble, discretise, readers};
    let folder = tempfile::tempdir().unwrap();
    let line = |k: usize| format!("{}\n", 293.0 + k as f64);
    let write = |count: usize| {
        let text: String = (0..count).map(line).collect();
        std::fs::write(folder.path().join("temperatures.txt"), text).unwrap();
    };
    let table = "kind = \"table\", rows = [[0, 0], [1, 0.5], [3, 2]]";
    let text = PLATE
        .replace("MODEL", "model = \"state-based\", poisson_ratio = 0.3")
        .replace(
            "temperature = 303",
            &format!("file = \"temperatures.txt\", function = {{ {table} }}"),
        );
    let deck = parse(&text);
    assert_eq!(deck.model.files().len(), 1);
    let resources = pericles_run::Resources {
        folder: folder.path(),
        ..readers()
    };
    let built = || {
        let discretisation = discretise(&deck.model, &resources)?;
        assemble(&deck.model, discretisation, &resources)
    };
    write(32);
    let run = built().unwrap().simulation().unwrap();
    let thermal = run.system().operator().capabilities().thermal.unwrap();
    let cloud = run.system().cloud();
    for (t, factor) in [(0.0, 0.0), (1.0, 0.5), (2.0, 1.25), (9.0, 2.0)] {
        // (1 + ν) α in plane strain.
        let stretches = thermal.stretches(t);
        for (i, stretch) in stretches.iter().enumerate() {
            let expected = 1.3e-5 * factor * cloud.user_number(i) as f64;
            assert!((stretch - expected).abs() < 1e-15, "{t}, {i}: {stretch}");
        }
    }
    write(31);
    let error = built().err().unwrap().to_string();
    assert!(error.contains("temperatures.txt"), "{error}");
}

#[test]
fn thermal_expansion_is_rejected_where_it_is_not_supported() {
    let heated = PLATE.replace("MODEL", "bonds = \"grid-f32\"");
    assert!(rejection(&heated).to_string().contains("thermal expansion"));
    let spectral = PLATE.replace("MODEL", "model = \"linear\", bonds = \"convolution\"");
    rejection(&spectral);
    let corrected = PLATE.replace(
        "MODEL",
        "model = \"state-based\", poisson_ratio = 0.3, surface_correction = \"energy\"",
    );
    assert!(
        rejection(&corrected)
            .to_string()
            .contains("does not include thermal strain")
    );
    let ghosts = PLATE.replace("MODEL", "surface_correction = \"ghosts\"");
    let error = rejection(&ghosts).to_string();
    assert!(error.contains("ghost points"), "{error}");
    let cold = PLATE.replace("MODEL", "").replace(
        "thermal = { expansion = 1e-5, temperature = 303, reference = 293 }\n",
        "",
    );
    assert!(rejection(&cold).to_string().contains("Temperature"));
    let undefined = PLATE.replace("MODEL", "").replace(
        "temperature = 303",
        "temperature = { expression = \"sqrt(-1 - x)\" }",
    );
    assert!(rejection(&undefined).to_string().contains("sqrt"));
}

/// Equal random seeds give equal cracks, different seeds different ones.
#[test]
fn scattered_strengths_depend_on_the_random_seed() {
    let deck = r#"
body = { shape = "plate", size = [24, 8], spacing = 1, plane = "stress" }
material = { MODELdensity = 1, youngs_modulus = 1, horizon_ratio = 3, critical_stretch = 0.02, scatter = { shape = 6, seed = SEED } }
sets = { left = { where = "x < 3" }, right = { where = "x > 21" } }
constraint = [{ set = "left", velocity = [-0.02, 0] }, { set = "right", velocity = [0.02, 0] }]
time = { end = 15 }
"#;
    for model in [
        "",
        "model = \"state-based\", poisson_ratio = 0.2, ",
        "model = \"correspondence\", poisson_ratio = 0.2, ",
    ] {
        let damage = |seed: &str| {
            let text = deck.replace("MODEL", model).replace("SEED", seed);
            assert!(
                parse(&text)
                    .model
                    .body
                    .solid()
                    .unwrap()
                    .material
                    .scatter
                    .is_some()
            );
            let mut run = build(&text).simulation();
            run.run(|_| Control::Continue).unwrap();
            assert!(run.system().operator().broken_bonds() > 10, "{model}");
            run.snapshot().field(Field::Damage).to_vec()
        };
        let first = damage("3");
        assert_eq!(first, damage("3"), "{model}");
        assert_ne!(first, damage("4"), "{model}");
    }
}
