//! Constraints that prescribe the same components of the same points.

use pericles::{Control, Simulation};

use super::build;

/// A plate whose left side moves down, and whose bottom side is pulled along x and moves down as the left side does. CORNER is
/// the set of the second constraint.
const PLATE: &str = r#"
body = { shape = "plate", size = [12, 10], spacing = 1, plane = "stress" }
material = { density = 1, youngs_modulus = 10, horizon_ratio = 3 }
sets.left = { box = { max = [3, 7] } }
sets.bottom = { layer = { side = "-y", cells = 3 } }
sets.rest = { box = { min = [3, 0], max = [12, 3] } }
constraint = [
  { set = "left", displacement = ["free", -0.01], function = { kind = "ramp", duration = 1 } },
  { set = "CORNER", displacement = ["free", -0.01], function = { kind = "ramp", duration = 1 } },
  { set = "right", displacement = [0.02, "free"], function = { kind = "ramp", duration = 1 } },
  { set = "top", displacement = [0, 0] },
]
sets.right = { box = { min = [9, 3], max = [12, 7] } }
sets.top = { layer = { side = "+y", cells = 3 } }
time = { end = 2, SCHEME }
"#;

fn finished(corner: &str, scheme: &str) -> Simulation {
    let deck = PLATE.replace("CORNER", corner).replace("SCHEME", scheme);
    let mut run = build(&deck).simulation();
    run.run(|_| Control::Continue).unwrap();
    run
}

/// Constraints that agree on common points give the results of constraints without common points: the components
/// belong to the earlier constraint, whose reaction contains theirs.
#[test]
fn constraints_that_agree_on_common_points_act_once() {
    for scheme in [
        "scheme = \"velocity-verlet\"",
        "scheme = \"rk4\"",
        "scheme = \"newmark\", dt = 0.1",
        "scheme = \"static\", load_steps = 2",
        "scheme = \"adaptive-dynamic-relaxation\", load_steps = 2",
    ] {
        let [common, apart] = ["bottom", "rest"].map(|corner| finished(corner, scheme));
        assert_eq!(common.state().u, apart.state().u, "{scheme}");
        assert_eq!(common.state().v, apart.state().v, "{scheme}");
        let ledgers = [&common, &apart].map(|run| *run.system().ledger());
        assert_eq!(ledgers[0], ledgers[1], "{scheme}");
        assert!(ledgers[0].work > 0.0, "{scheme}");
        for (a, b) in common
            .system()
            .motions()
            .iter()
            .zip(apart.system().motions())
        {
            let cloud = common.system().cloud();
            assert_eq!(a.reaction(cloud), b.reaction(cloud), "{scheme}: {}", a.name);
        }
    }
}
