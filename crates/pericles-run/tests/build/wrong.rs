//! Errors of decks during discretisation and assembly.

use pericles_deck::{Deck, DeckError};

use super::common::Build;
use super::decks::{SURFACE, WAVE, Wrong, explained, wrong};

#[rustfmt::skip]
const WRONG_WAVES: &[Wrong] = &[
    wrong("periodic = true", "periodic = false", (14, 9), "\"spectral\"", &["the force kernel \"spectral\" (key `bonds`) is not available for this body", "body.periodic = true"]),
    wrong("model = \"linear\"", "model = \"bond-stretch\"", (17, 12), "\"nonlocal-pulse\"", &["requires model = \"linear\""]),
    wrong("bonds = \"spectral\"", "bonds = \"spectral\"\ncritical_stretch = 0.1", (14, 9), "\"spectral\"", &["the same bonds at every point"]),
    wrong("periodic = true", "periodic = true\nquadrature = \"gauss\"", (7, 1), "quadrature", &["`quadrature` is not allowed in [body]", "not periodic"]),
    wrong("shape = \"bar\"\nlength = 20\norigin = -10", "shape = \"plate\"\nsize = [20, 20]\nplane = \"strain\"\nquadrature = \"gauss\"", (5, 1), "quadrature", &["Gauss nodes require a bar"]),
    wrong("periodic = true", "periodic = true\nhole = [{ box = { max = 0 } }]", (6, 1), "periodic", &["`periodic` is not allowed in [body]", "without holes"]),
    wrong("influence = { function = \"gaussian\", length = 1, acts_on = \"displacement\" }", "influence = { function = \"conical\", acts_on = \"displacement\" }", (12, 11), "\"infinite\"", &["requires influence = { function = \"gaussian\""]),
    wrong("length = 1, acts_on", "length = 1, cutoff = 2, acts_on", (12, 11), "\"infinite\"", &["without a cutoff"]),
    wrong("horizon = \"infinite\"", "horizon = 3", (17, 12), "\"nonlocal-pulse\"", &["does not apply to this deck", "horizon = \"infinite\""]),
    wrong("dt = 0.5\n", "dt = \"auto\"\n", (24, 6), "\"auto\"", &["unconditionally stable", "give dt"]),
    wrong("scheme = \"trigonometric\"", "scheme = \"trigonometric\"\nregularisation = -1", (26, 18), "-1", &["zero (the default"]),
    wrong("scheme = \"trigonometric\"", "scheme = \"implicit-midpoint\"\nfunctions = \"chebyshev\"", (26, 1), "functions", &["requires scheme = \"trigonometric\""]),
    wrong("scheme = \"trigonometric\"", "scheme = \"trigonometric\"\nfunctions = \"fast\"", (26, 13), "\"fast\"", &["did you mean `fastest`?"]),
    wrong("dt = 0.5\nscheme = \"trigonometric\"", "dt = 1.5\nscheme = \"velocity-verlet\"", (24, 6), "1.5", &["the time step 1.50 s is unstable", "allow_unstable"]),
    wrong("bonds = \"spectral\"", "bonds = \"convolution\"\n[[crack]]\nsection = 0.05", (14, 9), "\"convolution\"", &["the same bonds at every point"]),
    wrong("scheme = \"trigonometric\"", "scheme = \"trapezoidal\"\nlinear_solver = \"lu\"", (26, 17), "\"lu\"", &["unknown linear solver `lu`", "\"direct\"", "\"conjugate-gradients\""]),
    wrong("scheme = \"trigonometric\"", "scheme = \"trigonometric\"\nlinear_solver = \"direct\"", (26, 1), "linear_solver", &["requires scheme = \"implicit-midpoint\""]),
    wrong("model = \"linear\"", "model = \"linear\"\napproximation = \"taylor-2\"", (10, 1), "approximation", &["requires model = \"green-strain\""]),
    wrong("model = \"linear\"", "model = \"green-strain\"\napproximation = \"taylor\"", (10, 17), "\"taylor\"", &["unknown approximation `taylor`", "did you mean `taylor-1`?"]),
    wrong("[time]", "[output]\nenergy_bound = 0\n[time]", (23, 16), "0", &["a positive number"]),
    wrong("[time]", "[output]\nenergy_bound = 3\n[[constraint]]\nset = \"all\"\nvelocity = 1\n[time]", (23, 1), "energy_bound", &["moving supports"]),
    wrong("periodic = true", "quadrature = \"gauss\"\nrefine = [{ all = true, ratio = 2 }]", (6, 1), "quadrature", &["`quadrature` is not allowed in [body]"]),
    wrong("scheme = \"trigonometric\"", "scheme = \"trigonometric\"\nstop_when = [{ set = \"all\", reaction_below = 0.1 }]", (26, 14), "{ set", &["the stop condition on `all` can never be met", "no [[constraint]] refers to this set"]),
    wrong("scheme = \"trigonometric\"", "scheme = \"trigonometric\"\nstop_when = [{ set = \"all\", damage_above = 0.1 }]", (26, 14), "{ set", &["the bonds of this body do not break", "a material with fracture"]),
    wrong("window = 3", "window = 0", (20, 10), "0", &["a positive number"]),
    wrong("window = 3", "window = 0.01", (20, 10), "0.01", &["contains no point: the nearest one is 50.0 mm away"]),
    wrong("window = 3", "window = 3\ncentre = 1e18", (17, 12), "\"nonlocal-pulse\"", &["a sum of 2.0e18 terms", "at most 1e5"]),
    wrong("width = 1", "width = 1e-9", (17, 12), "\"nonlocal-pulse\"", &["move exact.centre into the body"]),
    wrong("solution = \"nonlocal-pulse\"", "solution = \"pulse\"", (17, 12), "\"pulse\"", &["unknown exact solution `pulse`", "\"local-pulse\""]),
];

#[test]
fn errors_of_wave_decks_are_explained() {
    let build = |text: &str| -> Result<(), DeckError> {
        Deck::parse(text, "plate.toml", &[])?.build().map(|_| ())
    };
    build(WAVE).unwrap_or_else(|error| panic!("{error}"));
    explained(WAVE, WRONG_WAVES, &build);
}

#[test]
fn unsupported_features_of_surfaces_are_rejected() {
    for (replace, by, at, says) in [
        ("traction", "body_force", "plate.toml:21:", "`traction`"),
        ("dt = 0.1\n", "", "plate.toml:23:", "give dt"),
        (
            "\"icosphere\"\nlevel = 2\nradius = 1\n\n[geodesics]",
            "\"ellipsoid\"\nlevel = 2\nhalf_axes = [1, 1, 0.1]\n\n[geodesics]\nball = \"euclid\"",
            "plate.toml:7:8",
            "joins opposite walls",
        ),
    ] {
        let deck = Deck::parse(&SURFACE.replace(replace, by), "plate.toml", &[]).unwrap();
        let message = deck.build().map(|_| ()).unwrap_err().to_string();
        assert!(message.contains(at) && message.contains(says), "{message}");
    }
}

#[test]
fn a_periodic_body_may_have_the_default_model() {
    let deck = r#"
[body]
shape = "bar"
length = 10
spacing = 1
periodic = true
[material]
density = 1
youngs_modulus = 1
fracture_energy = 1
surface_correction = "volume"
horizon = 3
[[crack]]
section = 5
[time]
end = 1
"#;
    let deck = Deck::parse(deck, "ring.toml", &[]).unwrap();
    let body = deck.build().unwrap();
    // 10 points with 6 bonds each, minus those across the section: 1 + 2 + 3.
    let bonds = body.system.operator().directed_bonds();
    assert_eq!(bonds, 60 - 2 * 6);
}
