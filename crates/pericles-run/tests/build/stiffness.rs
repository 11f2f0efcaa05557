//! Reported errors of the stiffness, compared with the elastic energy of a uniform strain, and inherited calibrations.

use super::{build, common::Built};

/// Returns the elastic energy of a bar under a uniform strain ε relative to E ε²/2 per volume; it differs from the volume
/// by the errors at both ends and in the interior.
fn energy(bar: &Built, young: f64) -> f64 {
    const STRAIN: f64 = 1e-6;
    let u: Vec<f64> = bar.cloud.axis(0).iter().map(|x| STRAIN * x).collect();
    bar.system.operator().energy(0.0, &u) / (0.5 * young * STRAIN * STRAIN)
}

fn bar(cells: usize, horizon: &str, influence: &str) -> String {
    format!(
        r#"
[body]
shape = "bar"
length = {cells}
spacing = 1
quadrature = "gauss"
[material]
density = 1
youngs_modulus = 7
horizon = {horizon}
{influence}
[time]
end = 1
dt = 0.01
"#
    )
}

#[test]
fn the_stiffness_error_of_gauss_nodes_is_that_of_the_elastic_energy() {
    let mut largest: f64 = 0.0;
    for horizon in ["2.2", "3", "3.7", "5.05"] {
        for influence in [
            "",
            "influence = { function = \"conical\" }",
            "volume_correction = \"none\"",
        ] {
            // Two lengths: the difference of their energies is the energy of the interior.
            let [short, long] = [40, 60].map(|cells| build(&bar(cells, horizon, influence)));
            let interior = energy(&long, 7.0) - energy(&short, 7.0);
            let error = long.constants().stiffness_error;
            assert!(
                (interior / 20.0 - 1.0 - error).abs() < 1e-9,
                "{horizon} {influence}: {} {error}",
                interior / 20.0 - 1.0
            );
            largest = largest.max(error.abs());
        }
    }
    assert!(largest > 1e-3, "{largest}");
}

#[test]
fn named_materials_inherit_the_calibration_of_the_modulus() {
    let deck = |modulus: &str, own: &str| {
        format!(
            r#"
[body]
shape = "plate"
size = [20, 10]
spacing = 1
plane = "stress"
[material]
density = 1
youngs_modulus = 7
horizon_ratio = 3
{modulus}
[materials.other]
density = 2
youngs_modulus = 9
{own}
[sets.left]
layer = {{ side = "-x", cells = 8 }}
[[assign]]
set = "left"
material = "other"
[time]
end = 1
dt = 0.01
"#
        )
    };
    let errors = |text: &str| {
        let built = build(text);
        let other = built.other_materials[0].bonds().unwrap().stiffness_error;
        [built.constants().stiffness_error, other]
    };
    let [first, other] = errors(&deck("modulus = \"lattice\"", ""));
    assert!(
        first.abs() < 1e-12 && other.abs() < 1e-12,
        "{first} {other}"
    );
    let [first, other] = errors(&deck("", ""));
    assert!(
        first.abs() > 1e-2 && (first - other).abs() < 1e-12,
        "{first} {other}"
    );
    // A material may have its own calibration.
    let [first, other] = errors(&deck("modulus = \"lattice\"", "modulus = \"continuum\""));
    assert!(first.abs() < 1e-12 && other.abs() > 1e-2, "{first} {other}");
}
