//! Event-by-event analysis with applied forces: closed forms, snap-back, energy balance.

use std::cell::Cell;
use std::sync::Arc;

use pericles::boundary::ProportionalLoading;
use pericles::material::StressState;
use pericles::prelude::*;
use pericles::{Interrupt, round_trip};
use pericles_statics::{BreakingRule, StaticOptions, StaticScheme};

use crate::bodies::points;

const EVENTS: BreakingRule = BreakingRule::Event {
    reference: 1.0,
    ties: 1e-3,
};

fn run_of(system: System, breaking: BreakingRule, steps: u64) -> Simulation {
    let options = StaticOptions {
        breaking,
        tolerance: 1e-9,
        ..StaticOptions::default()
    };
    let scheme = StaticScheme::new(options, &system).unwrap();
    let state = State::of(&system);
    Simulation::new(system, Box::new(scheme), state, 1.0 / steps as f64, steps).unwrap()
}

/// Load factor, mean displacement of some entries and broken bonds after each event.
fn events_of(run: &mut Simulation, entries: &[usize]) -> Vec<(f64, f64, u64)> {
    let mut found = Vec::new();
    run.run(|now| {
        let energies = now.snapshot().energies();
        let balance = energies.balance().abs();
        assert!(balance < 1e-7 * energies.work.abs(), "{energies:?}");
        let factor = now.system().load_factor().unwrap();
        let broken = now.system().operator().broken_bonds();
        let sum: f64 = entries.iter().map(|&k| now.state().u[k]).sum();
        found.push((factor, sum / entries.len() as f64, broken));
        Control::Continue
    })
    .unwrap();
    found
}

const DX: f64 = 0.1;
const STRETCH: f64 = 1e-3;

/// How the middle point of a bar is moved.
enum Drive {
    /// By a force, N.
    Force(f64),
    /// By a displacement, m.
    Displacement(f64),
    /// By a force, while both points on the right have a prescribed displacement.
    Both(f64, f64),
}

/// Five points with bonds of one and two spacings and a critical stretch; all but the middle one are fixed. The
/// middle point is connected by two springs of length `DX` and two of length `2 DX`, in parallel.
fn springs(drive: &Drive) -> System {
    let bar = Arc::new(Grid::bar(5.0 * DX, DX, 1.0).points().unwrap());
    let mut material =
        BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 2.0 * DX).with_critical_stretch(STRETCH);
    material.law = PairLaw::Linear;
    material.volume_correction = VolumeCorrection::None;
    let middle = vec![2];
    let others = points(&bar, |x| (x[0] - 2.5 * DX).abs() > 0.5 * DX);
    let push = |force: f64| Load::new(vec![2], [force / DX, 0.0, 0.0], TimeFunction::Constant);
    let place = |set: PointSet, u: f64| {
        PrescribedMotion::displacement(set, [Some(u), None, None], TimeFunction::Constant)
    };
    let body = Body::new(bar, material);
    match *drive {
        Drive::Force(force) => body.motion(place(others, 0.0)).load(push(force)),
        Drive::Displacement(u) => body.motion(place(others, 0.0)).motion(place(middle, u)),
        Drive::Both(force, u) => body
            .motion(place(vec![0, 1], 0.0))
            .motion(place(vec![3, 4], u))
            .load(push(force)),
    }
    .build()
    .unwrap()
}

/// Stiffness of all four springs, N/m.
fn stiffness() -> f64 {
    let system = springs(&Drive::Displacement(0.0));
    let mut force = vec![0.0; 5];
    let mut u = vec![0.0; 5];
    u[2] = 1.0;
    system.force_density_into(0.0, &u, &mut force);
    -DX * force[2]
}

#[test]
fn loads_of_parallel_springs_at_which_bonds_break_match_the_closed_form() {
    // The force of a bond is proportional to its stretch u/r: stiffnesses k, k, k/2, k/2, 3 k in total. The shorter
    // spring in tension breaks at u = s0 DX with F = 3 k u; then the longer one at u = 2 s0 DX with F = 2 k u.
    let total = stiffness();
    let [first, second] = [STRETCH * DX, 2.0 * STRETCH * DX];
    let [f1, f2] = [total * first, 2.0 / 3.0 * total * second];
    for (reference, drive) in [(f1, Drive::Force(f1)), (0.25 * f1, Drive::Force(0.25 * f1))] {
        let found = events_of(&mut run_of(springs(&drive), EVENTS, 2), &[2]);
        for ((factor, u, broken), (force, moved, bonds)) in
            found.into_iter().zip([(f1, first, 1), (f2, second, 2)])
        {
            assert!((factor * reference / force - 1.0).abs() < 2e-7, "{factor}");
            assert!((u / moved - 1.0).abs() < 2e-7, "{u}");
            assert_eq!(broken, bonds);
        }
    }
}

#[test]
fn events_do_not_depend_on_the_kind_of_loading() {
    let total = stiffness();
    let first = STRETCH * DX;
    let forces = events_of(
        &mut run_of(springs(&Drive::Force(total * first)), EVENTS, 2),
        &[2],
    );
    let moved = events_of(
        &mut run_of(springs(&Drive::Displacement(first)), EVENTS, 2),
        &[2],
    );
    for (a, b) in forces.iter().zip(&moved) {
        assert!((a.1 / b.1 - 1.0).abs() < 2e-7, "{a:?} {b:?}");
        assert_eq!(a.2, b.2);
    }
}

#[test]
fn loads_and_prescribed_displacements_are_scaled_by_the_same_factor() {
    // Force λ F and displacement λ U of the right points: the middle point is displaced by u = λ (F/3k + U/2), and by
    // u = λ (F/2k + 3 U/4) without the shorter spring on the left, which breaks at u = s0 DX; the longer one breaks at
    // twice this displacement. With F = 3/2 k s0 DX and U = s0 DX/2: λ = 4/3 and 16/9.
    let first = STRETCH * DX;
    let drive = Drive::Both(0.5 * stiffness() * first, 0.5 * first);
    let found = events_of(&mut run_of(springs(&drive), EVENTS, 2), &[2]);
    for ((factor, u, _), (exact, moved)) in found
        .into_iter()
        .zip([(4.0 / 3.0, first), (16.0 / 9.0, 2.0 * first)])
    {
        assert!((factor / exact - 1.0).abs() < 2e-7, "{factor}");
        assert!((u / moved - 1.0).abs() < 2e-7, "{u}");
    }
}

/// A plate with an edge notch that is pulled by forces on its end rows.
fn pulled_plate() -> System {
    let cells = 16;
    let dx = 1.0 / f64::from(cells);
    let plate = Arc::new(Grid::plate([1.0, 1.0], dx, 1.0).points().unwrap());
    let mut material =
        BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0 * dx).with_fracture_energy(1e-4);
    material.law = PairLaw::Linear;
    let top = points(&plate, |x| x[1] > 1.0 - 3.0 * dx);
    let bottom = points(&plate, |x| x[1] < 3.0 * dx);
    let density = 0.01 / (3.0 * dx);
    Body::new(plate, material)
        .stress_state(StressState::PlaneStress)
        .crack(Crack::Segment {
            from: [0.0, 0.5],
            to: [0.3, 0.5],
        })
        .no_fail(top.clone())
        .no_fail(bottom.clone())
        .motion(PrescribedMotion::fixed(bottom, 2))
        .load(Load::new(top, [0.0, density, 0.0], TimeFunction::Constant))
        .build()
        .unwrap()
}

#[test]
fn load_of_a_notched_plate_falls_as_the_crack_grows_and_the_energy_balance_closes() {
    let system = pulled_plate();
    // The loaded displacements: with their mean, the load does its work.
    let n = system.points();
    let loaded: Vec<usize> = system.loads()[0]
        .points
        .iter()
        .map(|&i| n + i as usize)
        .collect();
    let found = events_of(&mut run_of(system, EVENTS, 40), &loaded);
    let peak = found.iter().fold(0.0, |most: f64, at| most.max(at.0));
    let last = found.last().unwrap().0;
    assert!(last < 0.9 * peak, "{last} {peak}");
    // The compliance grows with every broken bond.
    let compliance: Vec<f64> = found.iter().map(|(factor, u, _)| u / factor).collect();
    assert!(
        compliance
            .windows(2)
            .all(|pair| pair[1] > pair[0] * (1.0 - 1e-7))
    );
    assert!(found.windows(2).all(|pair| pair[1].2 > pair[0].2));
}

#[test]
fn first_event_is_the_load_at_which_the_first_bond_breaks() {
    let mut events = run_of(pulled_plate(), EVENTS, 1);
    events.run_to_end().unwrap();
    let first = events.system().load_factor().unwrap();
    let breaks = |factor: f64| {
        let mut system = pulled_plate();
        let loading = ProportionalLoading {
            reference: 0.0,
            factors: [0.0, factor],
        };
        system.load_proportionally(loading);
        let rule = BreakingRule::default();
        let mut run = run_of(system, rule, 1);
        // A load above the strength has no static state once the crack grows.
        run.run_to_end().is_err() || run.system().operator().broken_bonds() > 0
    };
    assert!(!breaks(0.9999 * first));
    assert!(breaks(1.0001 * first));
}

#[test]
fn loads_on_a_separated_part_are_an_error() {
    // A chain of bonds of one spacing, fixed at one end and pulled at the other: all bonds break at once.
    let bar = Arc::new(Grid::bar(6.0 * DX, DX, 1.0).points().unwrap());
    let mut material =
        BondMaterial::new(ElasticModulus::Young(1.0), 1.0, DX).with_critical_stretch(STRETCH);
    material.law = PairLaw::Linear;
    let system = Body::new(bar, material)
        .motion(PrescribedMotion::fixed(vec![0], 1))
        .load(Load::new(vec![5], [1.0, 0.0, 0.0], TimeFunction::Constant))
        .build()
        .unwrap();
    let mut run = run_of(system, EVENTS, 2);
    let error = run.run_to_end().unwrap_err().to_string();
    assert!(
        error.contains("no longer connect to a constraint"),
        "{error}"
    );
    // The strength is the force of one bond at its critical stretch.
    assert_eq!(run.state().step, 1);
}

#[test]
fn resumed_run_is_bitwise_identical() {
    round_trip::check_resume(|| run_of(pulled_plate(), EVENTS, 4), [1, 2]).unwrap();
}

/// Prescribed displacement of an end, m.
const OPENING: f64 = 0.1;

/// The notched plate of a bond-based material, pulled by prescribed displacements.
fn stretched_plate(law: PairLaw, fracture_energy: f64, opening: f64) -> System {
    let cells = 16;
    let dx = 1.0 / f64::from(cells);
    let plate = Arc::new(Grid::plate([1.0, 1.0], dx, 1.0).points().unwrap());
    let mut material = BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0 * dx)
        .with_fracture_energy(fracture_energy);
    material.law = law;
    let top = points(&plate, |x| x[1] > 1.0 - 3.0 * dx);
    let bottom = points(&plate, |x| x[1] < 3.0 * dx);
    let opening = [Some(0.0), Some(opening), None];
    Body::new(plate, material)
        .stress_state(StressState::PlaneStress)
        .crack(Crack::Segment {
            from: [0.0, 0.5],
            to: [0.3, 0.5],
        })
        .no_fail(top.clone())
        .no_fail(bottom.clone())
        .motion(PrescribedMotion::fixed(bottom, 2))
        .motion(PrescribedMotion::displacement(
            top,
            opening,
            TimeFunction::Constant,
        ))
        .build()
        .unwrap()
}

#[test]
fn events_of_nonlinear_forces_approach_those_of_linear_forces_at_small_strains() {
    // Critical stretches of about 3e-4 and 3e-2: the laws differ in the order of the stretch.
    let factors = |law: PairLaw, energy: f64| -> Vec<f64> {
        let mut run = run_of(stretched_plate(law, energy, OPENING), EVENTS, 3);
        let mut found = Vec::new();
        run.run(|now| {
            let energies = now.snapshot().energies();
            assert!(
                energies.balance().abs() < 1e-5 * energies.work,
                "{energies:?}"
            );
            found.push(now.system().load_factor().unwrap());
            Control::Continue
        })
        .unwrap();
        found
    };
    let difference = |energy: f64| {
        let (linear, stretch) = (
            factors(PairLaw::Linear, energy),
            factors(PairLaw::BondStretch, energy),
        );
        (stretch[0] / linear[0] - 1.0).abs()
    };
    let (small, large) = (difference(1e-8), difference(1e-4));
    println!("{small:e} {large:e}");
    assert!(small < 1e-3, "{small}");
    assert!(large > 10.0 * small, "{large}");
}

#[test]
fn largest_stretch_is_critical_at_every_event_of_a_body_at_large_strain() {
    // Critical stretch of about 10 %.
    let mut run = run_of(
        stretched_plate(PairLaw::BondStretch, 1e-3, OPENING),
        EVENTS,
        12,
    );
    let mut factors = Vec::new();
    run.run(|now| {
        let (system, u) = (now.system(), &now.state().u);
        let mut marks = vec![false; system.points()];
        let view = system.operator().capabilities().breaking.unwrap();
        // The bonds of this event are broken; at most the accepted excess remains.
        view.mark_endangered(u, 1.0 + 2e-5, &mut marks);
        assert!(!marks.contains(&true));
        let energies = now.snapshot().energies();
        assert!(
            energies.balance().abs() < 1e-5 * energies.work,
            "{energies:?}"
        );
        factors.push(system.load_factor().unwrap());
        Control::Continue
    })
    .unwrap();
    assert!(
        factors.windows(2).any(|pair| pair[1] < pair[0]),
        "{factors:?}"
    );
    // The first event is the load at which the first bond breaks.
    let breaks = |factor: f64| {
        let system = stretched_plate(PairLaw::BondStretch, 1e-3, factor * OPENING);
        let mut run = run_of(system, BreakingRule::All, 1);
        run.run_to_end().unwrap();
        run.system().operator().broken_bonds() > 0
    };
    assert!(!breaks(0.9999 * factors[0]));
    assert!(breaks(1.0001 * factors[0]));
}

#[test]
fn run_interrupted_within_an_event_continues_bitwise_identically() {
    let make = || run_of(pulled_plate(), EVENTS, 3);
    let mut whole = make();
    whole.run_to_end().unwrap();
    for stop_after in [5, 30, 60] {
        let left = Cell::new(stop_after);
        let is_over = || {
            left.set(left.get() - 1);
            left.get() == 0
        };
        let mut run = make();
        let outcome = run
            .run_interruptible(Interrupt::when(&is_over), |_| Control::Continue)
            .unwrap();
        assert_eq!(outcome, Outcome::Stopped, "{stop_after}");
        run.run_to_end().unwrap();
        assert_eq!(run.state().u, whole.state().u, "{stop_after}");
        assert_eq!(run.system().load_factor(), whole.system().load_factor());
    }
}
