//! Warnings about multirate runs with bond failure.

use super::warned_of;

/// A notched plate torn apart under a sudden tension that does far more work than the cracks dissipate.
const TORN: &str = r#"
body = { shape = "plate", size = [40, 20], spacing = 1, plane = "stress" }
material = { density = 1, youngs_modulus = 1, horizon_ratio = 3, critical_stretch = 0.01 }
crack = [{ segment = [[-1, 10], [12, 10]] }]
sets = { top = { layer = { side = "+y", cells = 1 } }, bottom = { layer = { side = "-y", cells = 1 } } }
load = [{ set = "top", traction = [0, 0.004] }, { set = "bottom", traction = [0, -0.004] }]
time = { end = 150, scheme = "multirate-rk4", ratio = 4, adaptive = { every = 4, threshold = 0.5, layers = 1 } }
output = { fields = "never" }
"#;

#[test]
fn energy_errors_that_are_not_small_relative_to_the_dissipated_energy_are_reported() {
    // 0.02 % of the work, but 7 % of the dissipated energy; the error of the scheme falls with the fourth power of the step.
    let says = [
        "of the dissipated energy",
        "fracture energies of this multirate run",
        "reduce dt or the ratio of the steps",
    ];
    warned_of(TORN, &says, "--set time.safety=0.25");
}
