//! Anisotropic materials in decks.

use pericles::Control;

use super::{build, parse, rejection};

/// A strip of three bonded layers, 0°, ANGLE and 0°, stretched between grips that leave its width free.
const STRIP: &str = r#"
body = { shape = "plate", size = [80, 18], spacing = 1, plane = "stress" }
time = { scheme = "static", tolerance = 1e-10 }
assign = [{ set = "core", material = "core" }]
sets = { core = { where = "y > 6 && y < 12" }, left = { layer = { side = "-x", cells = 3 } }, right = { layer = { side = "+x", cells = 3 } }, corner = { box = { max = [3, 1] } } }
constraint = [{ set = "left", displacement = [0, "free"] }, { set = "right", displacement = [0.08, "free"] }, { set = "corner", displacement = ["free", 0] }]
[material]
model = "correspondence"
density = 1
horizon_ratio = 3
anisotropy = { youngs_modulus = [4, 1, 1], poisson_ratio = [0.26, 0.26, 0.4], shear_modulus = [0.4, 0.4, 0.35] }
[materials.core]
density = 1
anisotropy = { youngs_modulus = [4, 1, 1], poisson_ratio = [0.26, 0.26, 0.4], shear_modulus = [0.4, 0.4, 0.35], angle = "ANGLE deg" }
"#;

/// Layers beside each other have the same strain: the force is Σ E A ε with the modulus of each layer along the strip, E₁ and
/// E₂. The strain is measured half a width from the grips.
#[test]
fn layers_of_a_laminate_carry_force_by_their_orientation() {
    for (angle, core) in [("0", 4.0), ("90", 1.0)] {
        let mut run = build(&STRIP.replace("ANGLE", angle)).simulation();
        run.run(|_| Control::Continue).unwrap();
        let (system, u) = (run.system(), &run.state().u);
        let grip = &system.motions()[1];
        let n = system.points();
        let mut force = vec![0.0; 2 * n];
        system
            .operator()
            .add_force(0.0, u, pericles::operator::PointSubset::All, &mut force);
        let pull: f64 = grip.points.iter().map(|&i| -force[i as usize]).sum();
        let at = |x: f64| -> f64 {
            let column = (0..n).filter(|&i| (system.cloud().point(i)[0] - x).abs() < 0.1);
            let all: Vec<f64> = column.map(|i| u[i]).collect();
            all.iter().sum::<f64>() / all.len() as f64
        };
        let strain = (at(60.5) - at(19.5)) / 41.0;
        let expected = (12.0 * 4.0 + 6.0 * core) * strain;
        let error = pull / expected - 1.0;
        // At small strain; the law stiffens by 3/2 of the strain of 1e-3.
        assert!(error.abs() < 5e-3, "{angle}: {pull} {expected}");
    }
}

#[test]
fn anisotropic_models_round_trip_through_json() {
    let model = parse(&STRIP.replace("ANGLE", "30")).model;
    let json = serde_json::to_string(&model).unwrap();
    let read: pericles_deck::Model = serde_json::from_str(&json).unwrap();
    assert_eq!(read, model, "{json}");
}

/// Rotations out of the plane couple strains in the plane with shear out of it.
#[test]
fn materials_without_a_plane_of_symmetry_are_rejected() {
    let tilted = STRIP.replace("\"ANGLE deg\"", "\"30 deg\", axis = [0, 1, 0]");
    let error = rejection(&tilted).to_string();
    assert!(error.contains("plane of symmetry"), "{error}");
    // The table of the core.
    assert!(error.contains("deck.toml:12:1"), "{error}");
}
