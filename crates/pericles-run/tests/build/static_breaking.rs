//! Every failure criterion with every breaking mode of static runs.

use pericles::{Control, Simulation};

use super::build;

/// A notched plate whose ends are pulled apart; MATERIAL, RISE (displacement of the top) and TIME are placeholders.
const PLATE: &str = r#"
body = { shape = "plate", size = [20, 12], spacing = 1, plane = "stress" }
material = { density = 1, youngs_modulus = 10, horizon_ratio = 3, no_fail = ["top", "bottom"], MATERIAL }
sets = { top = { layer = { side = "+y", cells = 3 } }, bottom = { layer = { side = "-y", cells = 3 } } }
crack = [{ segment = [[0, 6], [7, 6]] }]
constraint = [
  { set = "top", displacement = [0, RISE], function = { kind = "ramp", duration = 1 } },
  { set = "bottom", displacement = [0, 0] },
]
time = { end = 1, TIME }
"#;

/// Elastic materials with every failure criterion, and whether their forces are linear.
const CRITERIA: [&str; 13] = [
    "model = \"linear\", critical_stretch = 0.01",
    "model = \"linear\", critical_stretch = 0.01, bonds = \"list\"",
    "model = \"bond-stretch\", fracture_energy = 2e-3",
    "model = \"state-based\", strains = \"small\", poisson_ratio = 0.2, fracture_energy = 2e-3",
    "model = \"state-based\", poisson_ratio = 0.3, critical_stretch = 0.01",
    "model = \"state-based\", strains = \"small\", poisson_ratio = 0.2, fracture_energy = 2e-3, failure = \"bond-energy\"",
    "model = \"state-based\", poisson_ratio = 0.3, fracture_energy = 2e-3, failure = \"bond-energy\"",
    "model = \"state-based\", poisson_ratio = 0.3, failure = \"principal-stress\", strength = 0.1",
    "model = \"state-based\", poisson_ratio = 0.3, failure = \"expression\", criterion = \"(equivalent_stress / 0.1)^2\"",
    "model = \"correspondence\", poisson_ratio = 0.3, critical_stretch = 0.01",
    "model = \"correspondence\", poisson_ratio = 0.3, failure = \"principal-stress\", strength = 0.1",
    "model = \"correspondence\", poisson_ratio = 0.3, failure = \"expression\", criterion = \"strain_1 / 0.01\"",
    "model = \"correspondence\", poisson_ratio = 0.3, fracture_energy = 2e-3, failure = \"bond-energy\"",
];

/// Materials whose forces depend on the history.
const WITH_HISTORY: [&str; 5] = [
    "model = \"bond-stretch\", critical_stretch = 0.02, softening = { law = \"linear\", onset_stretch = 0.01 }",
    "model = \"state-based\", poisson_ratio = 0.3, yield_stress = 0.09, critical_stretch = 0.01",
    "model = \"correspondence\", poisson_ratio = 0.3, yield_stress = 0.09, critical_stretch = 0.01",
    "model = \"correspondence\", poisson_ratio = 0.3, yield_stress = 0.09, failure = \"expression\", criterion = \"strain_1 / 0.01\"",
    "model = \"correspondence\", poisson_ratio = 0.3, yield_stress = 0.09, fracture_energy = 2e-3, failure = \"bond-energy\"",
];

fn deck(material: &str, rise: f64, time: &str) -> String {
    PLATE
        .replace("MATERIAL", material)
        .replace("RISE", &rise.to_string())
        .replace("TIME", time)
}

fn simulation(material: &str, rise: f64, time: &str) -> Simulation {
    build(&deck(material, rise, time)).simulation()
}

/// Runs until the first bonds have broken and returns their number. After that a body may have no static state.
fn first_broken(mut run: Simulation) -> u64 {
    let broken = |run: &Simulation| run.system().operator().broken_bonds();
    let ended = run.run(|run| match broken(run) {
        0 => Control::Continue,
        _ => Control::Stop,
    });
    match broken(&run) {
        0 => ended.map(|_| 0).unwrap(),
        broken => broken,
    }
}

/// The load at which the first bond breaks by the event-driven analysis is the limit between loads at which no bond
/// breaks and loads at which bonds break, also if the load is applied in several steps, along which the work of bonds
/// accumulates.
#[test]
fn the_first_bond_breaks_at_the_load_of_the_first_event() {
    for material in CRITERIA {
        let event = "scheme = \"static\", tolerance = 1e-9, load_steps = 1, breaking = \"event\"";
        let mut run = simulation(material, 0.05, event);
        run.run(|_| Control::Continue).unwrap();
        assert!(run.system().operator().broken_bonds() > 0, "{material}");
        let rise = 0.05 * run.system().load_factor().unwrap();
        for breaking in ["worst-first", "all"] {
            let time = format!(
                "scheme = \"static\", tolerance = 1e-9, load_steps = 3, breaking = \"{breaking}\""
            );
            for (part, expected) in [(1.0 - 3e-3, false), (1.0 + 3e-3, true)] {
                let broken = first_broken(simulation(material, rise * part, &time));
                assert_eq!(broken > 0, expected, "{breaking}, {part}, {material}");
            }
        }
    }
}

/// The work of the loads is stored, dissipated by broken bonds or released after they broke.
#[test]
fn energy_balances_in_every_breaking_mode() {
    for material in [0, 3, 5, 7].map(|k| CRITERIA[k]) {
        for breaking in ["worst-first", "all", "event"] {
            let time = format!(
                "scheme = \"static\", tolerance = 1e-8, load_steps = 3, breaking = \"{breaking}\""
            );
            let mut run = simulation(material, 0.08, &time);
            // A body that is severed may have no static state.
            let _ = run.run(|_| Control::Continue);
            let energies = run.snapshot().energies();
            assert!(energies.dissipated > 0.0, "{breaking}: {material}");
            let error = energies.balance() / energies.work;
            assert!(error.abs() < 1e-5, "{error}, {breaking}: {material}");
        }
    }
}

/// A softening body that splits at once: what its bonds dissipate by softening on the way is part of the energy that it
/// loses, and is booked once. The bound was chosen after errors of 3, 0.07 and 0.007 % with 6, 24 and 96 load steps; before
/// the energy was booked once they were of the order of a third.
#[test]
fn energy_balances_where_a_softening_body_splits() {
    for breaking in ["worst-first", "all"] {
        let time = format!(
            "scheme = \"static\", tolerance = 1e-8, load_steps = 24, breaking = \"{breaking}\""
        );
        let mut run = simulation(WITH_HISTORY[0], 0.6, &time);
        run.run(|_| Control::Continue).unwrap();
        assert!(run.integrator().remark().is_some(), "no jump");
        let energies = run.snapshot().energies();
        let error = energies.balance() / energies.work;
        assert!(energies.dissipated > 0.1 * energies.work);
        assert!(error.abs() < 5e-3, "{error}, {breaking}");
    }
}

#[test]
fn relaxation_and_bodies_with_a_history_break_too() {
    for scheme in ["adaptive-dynamic-relaxation", "fire"] {
        let time = format!("scheme = \"{scheme}\", load_steps = 4");
        for material in CRITERIA.into_iter().chain(WITH_HISTORY) {
            let broken = first_broken(simulation(material, 0.2, &time));
            assert!(broken > 0, "{scheme}: {material}");
        }
    }
    for material in WITH_HISTORY {
        for breaking in ["worst-first", "all"] {
            let time = format!("scheme = \"static\", load_steps = 10, breaking = \"{breaking}\"");
            let broken = first_broken(simulation(material, 0.3, &time));
            assert!(broken > 0, "{breaking}: {material}");
        }
    }
}

#[test]
fn event_driven_analysis_without_a_breaking_bond_is_an_error() {
    for material in CRITERIA {
        let time = "scheme = \"static\", load_steps = 2, breaking = \"event\"";
        // Nothing moves but the constrained points, whose bonds cannot break.
        let held = deck(material, 0.05, time)
            .replace("\"top\", \"bottom\"]", "\"every\"]")
            .replace("sets = {", "sets = { every = { where = \"x > -1\" },");
        let mut run = build(&held).simulation();
        let error = run.run(|_| Control::Continue).unwrap_err().to_string();
        assert!(error.contains("breaking = \"event\""), "{error}");
    }
}
