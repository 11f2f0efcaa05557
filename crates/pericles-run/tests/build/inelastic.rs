//! Viscoelastic and elastoplastic state-based materials in decks.

use pericles::observe::Field;
use pericles::{Control, Simulation};
use pericles_deck::Deck;

use super::{build, rejection};

/// A plate stretched to a constant displacement; OTHER is a placeholder.
const HELD: &str = r#"
body = { shape = "plate", size = [46, 12], origin = [-23, -6], spacing = 1, plane = "stress" }
material = { model = "state-based", strains = "small", density = 1, youngs_modulus = 10, poisson_ratio = 0.35, horizon_ratio = 3, OTHER }
sets = { left = { where = "x < -20" }, right = { where = "x > 20" } }
constraint = [{ set = "left", displacement = [-0.02, "free"], function = { kind = "constant" } }, { set = "right", displacement = [0.02, "free"], function = { kind = "constant" } }]
time = { scheme = "adaptive-dynamic-relaxation", tolerance = 1e-8, end = 4, load_steps = 16 }
"#;

/// Returns the reaction of the right set after every load step.
fn reactions(other: &str) -> Vec<f64> {
    let force = |now: &Simulation| -> f64 {
        let n = now.system().points();
        let mut reaction = vec![0.0; 2 * n];
        for motion in now.system().motions() {
            motion.add_reaction(n, &mut reaction);
        }
        let volumes = now.system().cloud().volumes();
        let right = (0..n).filter(|&i| now.system().cloud().point(i)[0] > 20.0);
        right.map(|i| reaction[i] * volumes[i]).sum()
    };
    let mut run = build(&HELD.replace("OTHER", other)).simulation();
    let mut forces = Vec::new();
    run.run(|now| {
        forces.push(force(now));
        Control::Continue
    })
    .unwrap();
    // The callback is not called after the last step.
    forces.push(force(&run));
    forces
}

/// In plane stress 4/E = 1/κ + 1/G with the elastic in-plane bulk modulus κ. With one viscous term E relaxes
/// exponentially with the time constant τ (κ + G₀)/(κ + G₁).
#[test]
fn stress_relaxation_follows_youngs_modulus() {
    let (share, tau, dt) = (0.5, 1.0, 0.25);
    let forces = reactions("viscosity = [{ share = 0.5, time = 1 }]");
    let elastic = reactions("surface_correction = \"none\"");
    let last = *elastic.last().unwrap();
    assert_eq!(forces.len(), 16);
    let (kappa, shear): (f64, f64) = (10.0 / (2.0 * 0.65), 10.0 / (2.0 * 1.35));
    let relaxed = (1.0 - share) * shear;
    let young = |shear: f64| 4.0 * kappa * shear / (kappa + shear);
    let time = tau * (kappa + shear) / (kappa + relaxed);
    // The displacement is applied within the first load step.
    let growing = (f64::exp(dt / time) - 1.0) * time / dt;
    for (k, force) in forces.iter().enumerate() {
        let t = dt * (k + 1) as f64;
        let now = young(relaxed) + (young(shear) - young(relaxed)) * (-t / time).exp() * growing;
        let error = force / last / (now / young(shear)) - 1.0;
        // Effects of ends and surfaces are larger for the relaxed body, whose Poisson's ratio is 0.61: 2.0 % at the
        // end, also with load steps of a quarter of the length. Bound chosen after the first run.
        assert!(error.abs() < 0.025, "{t}: {error}");
    }
    assert!((forces[15] / last) < 0.65);
}

/// A plate in shear beyond its yield stress.
const SHEARED: &str = r#"
body = { shape = "plate", size = [16, 14], origin = [0, 0], spacing = 1, plane = "strain" }
material = { model = "state-based", density = 1, youngs_modulus = 10, poisson_ratio = 0.3, horizon_ratio = 3, yield_stress = 0.2, hardening = 1 }
initial = [{ velocity = [{ expression = "0.05*y" }, 0] }]
time = { end = 1, dt = 0.05 }
output = { fields = { names = ["Equivalent_Stress", "Plastic_Strain", "Yield_Flag"] } }
"#;

#[test]
fn plastic_strain_and_yield_flag_require_a_yield_stress() {
    let mut run = build(SHEARED).simulation();
    run.run(|_| Control::Continue).unwrap();
    let snapshot = run.snapshot();
    let [stress, strain, flag] = [
        Field::EquivalentStress,
        Field::PlasticStrain,
        Field::YieldFlag,
    ]
    .map(|field| snapshot.field(field));
    assert!(strain.iter().any(|&strain| strain > 1e-3));
    for (strain, flag) in strain.iter().zip(flag) {
        assert_eq!(*flag, f64::from(*strain > 0.0));
    }
    assert!(
        stress
            .iter()
            .all(|stress| stress.is_finite() && *stress >= 0.0)
    );
    let energies = snapshot.energies();
    assert!(energies.dissipated > 0.0);
    assert!(energies.balance().abs() < 1e-3 * energies.dissipated);
}

#[test]
fn unsupported_features_of_inelastic_materials_are_rejected() {
    for (from, to, words) in [
        (
            "horizon_ratio = 3",
            "horizon_ratio = 3, bonds = \"grid\"",
            "store the history of each bond of a neighbour list",
        ),
        (
            "horizon_ratio = 3",
            "horizon_ratio = 3, surface_correction = \"energy\"",
            "the surface correction of viscous and plastic materials is not supported",
        ),
        (
            "yield_stress = 0.2, hardening = 1",
            "viscosity = [{ share = 0.1, time = 1 }]",
            "only materials with a `yield_stress`",
        ),
    ] {
        let message = rejection(&SHEARED.replace(from, to)).to_string();
        assert!(message.contains(words), "{message}");
    }
    let bar = r#"
body = { shape = "bar", length = 60, spacing = 1 }
material = { model = "state-based", density = 1, youngs_modulus = 10, horizon_ratio = 3, yield_stress = 1 }
time = { end = 1, dt = 0.05 }
"#;
    let message = Deck::parse(bar, "bar.toml", &[]).err().unwrap().to_string();
    assert!(message.contains("dimension"), "{message}");
}
