//! Failure by bond energy of correspondence, viscous and plastic materials.

use pericles::Control;

use super::build;
use super::composition::run_every_way;

/// A notched plate in tension that fractures; MATERIAL is a placeholder.
const TORN: &str = r#"
body = { shape = "plate", size = [30, 20], spacing = 1, plane = "stress" }
material = { density = 1, youngs_modulus = 1, poisson_ratio = 0.2, horizon_ratio = 3, fracture_energy = 3e-5, failure = "bond-energy", MATERIAL }
crack = [{ segment = [[0, 10], [12, 10]] }]
sets.top = { layer = { side = "+y", cells = 1 } }
sets.bottom = { layer = { side = "-y", cells = 1 } }
constraint = [{ set = "top", velocity = ["free", 0.004] }, { set = "bottom", velocity = ["free", -0.004] }]
initial = [{ velocity = [0, { expression = "8e-3*(y/20-0.5)" }] }]
time = { end = 10, dt = 0.1 }
"#;

/// A plastic material that never yields has the forces of the elastic one, computed by other loops: the same bonds break by
/// their energy.
#[test]
fn bonds_of_plastic_materials_break_by_the_energy_of_elastic_ones() {
    let [elastic, plastic] = ["", ", yield_stress = 1e6"].map(|plastic| {
        let material = format!("model = \"state-based\"{plastic}");
        run_every_way(&TORN.replace("MATERIAL", &material))
    });
    assert!(elastic.broken > 20, "{}", elastic.broken);
    assert_eq!(elastic.broken, plastic.broken);
    let [elastic, plastic] = [elastic.energies, plastic.energies];
    for (a, b) in [
        (elastic.kinetic, plastic.kinetic),
        (elastic.elastic, plastic.elastic),
        (elastic.dissipated, plastic.dissipated),
    ] {
        assert!((a / b - 1.0).abs() < 1e-10, "{a:e} {b:e}");
    }
}

/// Results are bitwise identical for any number of threads and after a stop, and the energy balance closes.
#[test]
fn correspondence_and_viscous_materials_break_by_their_bond_energy() {
    for material in [
        "model = \"correspondence\"",
        "model = \"correspondence\", stabilisation = \"silling\"",
        "model = \"correspondence\", yield_stress = 0.003, hardening = 0.1",
        "model = \"state-based\", viscosity = [{ share = 0.5, time = 20 }]",
    ] {
        let run = run_every_way(&TORN.replace("MATERIAL", material));
        assert!(run.broken > 20, "{material}: {}", run.broken);
        let off = run.energies.balance() / run.energies.dissipated;
        assert!(off.abs() < 1e-4, "{material}: {off:e}");
    }
}

/// A bar of a correspondence material under uniform strain ψ: both ends pull at a bond with w P K⁻¹ ξ, P = E ψ and
/// K = Σ w V ξ² = 28 for three neighbours on each side, so that its work is w E ξ² ψ²/K. The bonds of three spacings are the
/// first to reach the critical bond energy.
#[test]
fn a_bond_of_a_uniform_bar_breaks_at_its_critical_energy() {
    let deck = |strain: f64| {
        format!(
            r#"
body = {{ shape = "bar", length = 60, spacing = 1 }}
material = {{ model = "correspondence", density = 1, youngs_modulus = 1, horizon_ratio = 3, influence = {{ function = "constant" }}, volume_correction = "none", fracture_energy = 1e-6, failure = "bond-energy", no_fail = ["ends"] }}
sets = {{ ends = {{ where = "x < 7 || x > 53" }} }}
constraint = [{{ set = "all", displacement = [{{ expression = "{strain}*x" }}], function = {{ kind = "ramp", duration = 1 }} }}]
time = {{ end = 1, dt = 0.05 }}
"#
        )
    };
    let critical = {
        let built = build(&deck(1e-6));
        let energy = built.assembly.constants.as_ref();
        energy.unwrap().critical_bond_energy()
    };
    let strain = (28.0 * critical / 9.0).sqrt();
    let broken = |factor: f64| {
        let mut run = build(&deck(factor * strain)).simulation();
        run.run(|_| Control::Continue).unwrap();
        run.system().operator().broken_bonds()
    };
    assert!(strain < 1e-2, "the strain is small: {strain}");
    // Pairs of points in three spacings, neither of which is near an end.
    assert_eq!([broken(0.99), broken(1.01)], [0, 43]);
}

/// A crack along a wide clamped strip dissipates the fracture energy per area with a state-based material. The points of a
/// correspondence material keep their strain energy until the last of their bonds across the crack breaks, so that it
/// dissipates more, but less than with a critical stretch. The bounds of correspondence were chosen after seeing the results,
/// 1.5 and 2.7.
#[test]
fn a_crack_dissipates_the_fracture_energy() {
    let spent = |material: &str, rise: f64| {
        let deck = format!(
            r#"
body = {{ shape = "plate", size = [120, 24], spacing = 1, plane = "strain" }}
material = {{ density = 1, youngs_modulus = 1, poisson_ratio = 0.25, horizon_ratio = 3, influence = {{ function = "constant" }}, fracture_energy = 1e-3, no_fail = ["top", "bottom"], {material} }}
crack = [{{ segment = [[0, 12], [30, 12]] }}]
sets = {{ top = {{ layer = {{ side = "+y", cells = 3 }} }}, bottom = {{ layer = {{ side = "-y", cells = 3 }} }} }}
constraint = [
  {{ set = "top", displacement = ["free", {rise}], function = {{ kind = "ramp", duration = 1000 }} }},
  {{ set = "bottom", displacement = ["free", -{rise}], function = {{ kind = "ramp", duration = 1000 }} }},
]
damping = {{ mass = 0.05 }}
time = {{ end = 1500 }}
"#
        );
        let mut run = build(&deck).simulation();
        run.run_to_end().unwrap();
        let energies = run.snapshot().energies();
        // The strip is cut in two.
        assert!(
            energies.elastic < 1e-3 * energies.dissipated,
            "{energies:?}"
        );
        energies.dissipated / (1e-3 * 90.0)
    };
    let state_based = spent("model = \"state-based\", failure = \"bond-energy\"", 0.11);
    assert!((state_based - 1.0).abs() < 0.05, "{state_based}");
    let [by_energy, by_stretch] = ["bond-energy", "stretch"].map(|failure| {
        let material = format!("model = \"correspondence\", failure = \"{failure}\"");
        spent(&material, 0.2)
    });
    assert!(
        by_energy < 1.8 && by_energy < by_stretch,
        "{by_energy} {by_stretch}"
    );
}
