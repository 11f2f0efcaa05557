//! Bond failure at static states: selected bonds and loads.

use std::sync::Arc;

use pericles::material::StressState;
use pericles::prelude::*;
use pericles::round_trip;
use pericles_statics::{BreakingRule, StaticOptions, StaticScheme};

use crate::bodies::points;

/// Prescribed displacement of each end at t = 1.
const OPENING: f64 = 0.012;

/// A linear plate of 16 × 16 points with an edge notch and prescribed displacements `opening` of both ends at t = 1.
fn plate(opening: f64, law: PairLaw) -> System {
    notched(16, opening, law)
}

/// A plate with an edge notch and prescribed displacements `opening` of both ends at t = 1.
fn notched(cells: u32, opening: f64, law: PairLaw) -> System {
    let dx = 1.0 / f64::from(cells);
    let plate = Arc::new(Grid::plate([1.0, 1.0], dx, 1.0).points().unwrap());
    let mut material =
        BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0 * dx).with_fracture_energy(1e-4);
    material.law = law;
    let top = points(&plate, |x| x[1] > 1.0 - 3.0 * dx);
    let bottom = points(&plate, |x| x[1] < 3.0 * dx);
    let open = |set: PointSet, u: f64| {
        let ramp = TimeFunction::Ramp {
            start: 0.0,
            duration: 1.0,
        };
        PrescribedMotion::displacement(set, [Some(0.0), Some(u), None], ramp)
    };
    Body::new(plate.clone(), material)
        .stress_state(StressState::PlaneStress)
        .crack(Crack::Segment {
            from: [0.0, 0.5],
            to: [0.3, 0.5],
        })
        .no_fail(top.clone())
        .no_fail(bottom.clone())
        .motion(open(top, opening))
        .motion(open(bottom, -opening))
        .build()
        .unwrap()
}

fn run_of(system: System, breaking: BreakingRule, steps: u64) -> Simulation {
    let options = StaticOptions {
        breaking,
        ..StaticOptions::default()
    };
    let scheme = StaticScheme::new(options, &system).unwrap();
    let state = State::of(&system);
    Simulation::new(system, Box::new(scheme), state, 1.0 / steps as f64, steps).unwrap()
}

fn notched_plate(breaking: BreakingRule) -> Simulation {
    run_of(plate(OPENING, PairLaw::Linear), breaking, 2)
}

#[test]
fn worst_first_breaks_fewer_bonds_than_all_and_closes_the_energy_balance() {
    let broken = |rule| {
        let mut run = notched_plate(rule);
        run.run_to_end().unwrap();
        let energies = run.snapshot().energies();
        let part = energies.balance() / energies.work;
        assert!(part.abs() < 1e-5, "{rule:?}: {part}");
        run.system().operator().broken_bonds()
    };
    let (worst, all) = (broken(BreakingRule::default()), broken(BreakingRule::All));
    println!("{worst} {all}");
    assert!(0 < worst && worst < all);
}

const EVENTS: BreakingRule = BreakingRule::Event {
    reference: 1.0,
    ties: 1e-3,
};

/// Displacement of a constrained end and the force on it.
fn curve_point(run: &Simulation) -> [f64; 2] {
    let system = run.system();
    let (grip, n) = (&system.motions()[0], system.points());
    let displacement = run.state().u[n + grip.points[0] as usize];
    [displacement, grip.reaction(system.cloud())[1]]
}

#[test]
fn event_by_event_stiffness_decreases_the_body_snaps_back_and_the_energy_balance_closes() {
    let mut run = run_of(plate(OPENING, PairLaw::Linear), EVENTS, 60);
    let (mut curve, mut broken) = (Vec::new(), vec![0]);
    let mut worst: f64 = 0.0;
    run.run(|now| {
        curve.push(curve_point(now));
        broken.push(now.system().operator().broken_bonds());
        let energies = now.snapshot().energies();
        worst = worst.max(energies.balance().abs() / energies.work);
        Control::Continue
    })
    .unwrap();
    assert!(worst < 1e-6, "{worst}");
    assert!(
        broken.windows(2).all(|pair| pair[1] > pair[0]),
        "{broken:?}"
    );
    let stiffness: Vec<f64> = curve.iter().map(|[u, force]| force / u).collect();
    let rounding = 1e-5 * stiffness[0];
    assert!(stiffness.windows(2).all(|k| k[1] < k[0] + rounding));
    assert!(curve.windows(2).any(|pair| pair[1][0] < pair[0][0]));
}

#[test]
fn first_event_is_the_load_at_which_the_first_bond_breaks() {
    let mut events = run_of(plate(OPENING, PairLaw::Linear), EVENTS, 1);
    events.run_to_end().unwrap();
    let [first, _] = curve_point(&events);
    let broken = |opening: f64| {
        let mut run = run_of(plate(opening, PairLaw::Linear), BreakingRule::default(), 1);
        run.run_to_end().unwrap();
        run.system().operator().broken_bonds()
    };
    assert_eq!(broken(0.9999 * first), 0);
    assert!(broken(1.0001 * first) > 0);
}

#[test]
fn resumed_event_by_event_run_is_bitwise_identical() {
    let run = || run_of(plate(OPENING, PairLaw::Linear), EVENTS, 4);
    round_trip::check_resume(run, [1, 2]).unwrap();
}

#[test]
fn systems_without_support_for_event_by_event_analysis_are_errors() {
    let rejected = |system: &System| {
        let options = StaticOptions {
            breaking: EVENTS,
            ..StaticOptions::default()
        };
        StaticScheme::new(options, system).unwrap_err().to_string()
    };
    let still = rejected(&plate(0.0, PairLaw::Linear));
    assert!(
        still.contains("no load and no prescribed displacement"),
        "{still}"
    );
}

#[test]
fn a_crack_through_the_plate_needs_few_products_per_broken_bond() {
    // With one preconditioner per load step and all states to the tolerance there are more than ten products per bond.
    for law in [PairLaw::Linear, PairLaw::BondStretch] {
        let mut run = run_of(notched(40, OPENING, law), BreakingRule::default(), 4);
        run.run_to_end().unwrap();
        let energies = run.snapshot().energies();
        let part = energies.balance() / energies.work;
        let broken = run.system().operator().broken_bonds();
        let products = run.integrator().inner_iterations().unwrap().total;
        println!("{law:?}: {products} products, {broken} broken bonds, balance {part:.1e}");
        assert!(broken > 800, "{law:?}: {broken}");
        assert!(products < 5 * broken, "{law:?}: {products}");
        assert!(part.abs() < 1e-6, "{law:?}: {part}");
    }
}
