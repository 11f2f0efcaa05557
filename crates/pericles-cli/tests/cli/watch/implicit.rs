//! Residuals of implicit steps.

use std::fs;

use super::{reactions, warnings};
use crate::common::succeed;

#[test]
fn implicit_schemes_accept_residuals_of_rounding_errors() {
    let place = tempfile::tempdir().unwrap();
    // A support moves slowly and comes to rest: in the end the force equals the force of the static state.
    for scheme in ["discrete-gradient", "implicit-midpoint", "trapezoidal"] {
        for dt in ["1e-6", "1e-5"] {
            let deck = format!(
                r#"
body = {{ shape = "bar", length = 0.1, spacing = 1e-3, area = 1e-4 }}
material = {{ model = "linear", density = 7850, youngs_modulus = 2e11, horizon_ratio = 3, modulus = "lattice" }}
sets.l = {{ layer = {{ side = "-x", cells = 3 }} }}
sets.r = {{ layer = {{ side = "+x", cells = 3 }} }}
constraint = [{{ set = "l", displacement = [0] }}, {{ set = "r", displacement = [{{ expression = "1e-5*sin(pi/2*t/2e-3)^2" }}] }}]
time = {{ scheme = "{scheme}", end = 2e-3, dt = {dt} }}
output = {{ fields = "never" }}
"#
            );
            assert_eq!(warnings(place.path(), &deck, ""), [""; 0], "{scheme} {dt}");
            let [left, right] = reactions(place.path())[..] else {
                panic!()
            };
            // Free length between the layers: 94 mm, and a part of the layers.
            assert!(
                (right / 2090.0 - 1.0).abs() < 2e-3,
                "{scheme} {dt}: {right}"
            );
            assert!((left / right + 1.0).abs() < 2e-3, "{scheme} {dt}: {left}");
        }
    }
    // Finite strains have rounding errors at rest.
    for law in [
        "law = \"neo-hooke\"",
        "law = \"hencky\", yield_stress = 1e9",
    ] {
        let deck = format!(
            r#"
body = {{ shape = "plate", size = [0.012, 0.006], spacing = 1e-3, plane = "strain" }}
material = {{ model = "correspondence", {law}, density = 7850, youngs_modulus = 2e11, poisson_ratio = 0.3, horizon_ratio = 3 }}
sets.l = {{ layer = {{ side = "-x", cells = 3 }} }}
sets.r = {{ layer = {{ side = "+x", cells = 3 }} }}
constraint = [{{ set = "l", displacement = [0, 0] }}, {{ set = "r", displacement = [{{ expression = "1e-6*sin(pi/2*t/2e-5)^2" }}, 0] }}]
time = {{ scheme = "implicit-midpoint", end = 2e-6, dt = 2e-7 }}
output = {{ fields = "never" }}
"#
        );
        fs::write(place.path().join("deck.toml"), &deck).unwrap();
        for scheme in ["implicit-midpoint", "trapezoidal"] {
            let more =
                format!("run deck.toml --quiet --out out --force --set time.scheme={scheme}");
            succeed(place.path(), &more);
        }
    }
    // A jump of a prescribed displacement, in steps of many periods.
    let deck = r#"
body = { shape = "plate", size = [12, 6], spacing = 1, plane = "stress" }
material = { model = "correspondence", density = 1000, youngs_modulus = 3e9, poisson_ratio = 0.33, horizon_ratio = 3 }
sets.l = { layer = { side = "-x", cells = 1 } }
sets.r = { layer = { side = "+x", cells = 1 } }
constraint = [{ set = "l", displacement = [0, 0] }, { set = "r", displacement = [0.01, 0] }]
time = { scheme = "newmark", solver = "newton-krylov", end = 100, dt = 10 }
output = { fields = "never" }
"#;
    fs::write(place.path().join("deck.toml"), deck).unwrap();
    succeed(place.path(), "run deck.toml --quiet --out out --force");
}
