//! Control of the load factor by a displacement: closed forms, equality of routes, energy balance, restarts.

use std::sync::Arc;

use pericles::boundary::TimeTable;
use pericles::family::Crack;
use pericles::material::{Softening, SofteningLaw};
use pericles::prelude::*;
use pericles::round_trip;
use pericles_statics::{
    BreakingRule, Control as LoadControl, ControlledQuantity, StaticOptions, StaticScheme,
};

use crate::bodies::points;

/// Difference of two displacement components, given by entries of the displacement; the first alone without a second.
#[derive(Debug)]
struct Opening(usize, Option<usize>);

impl ControlledQuantity for Opening {
    fn value(&self, _system: &System, _t: f64, u: &[f64]) -> pericles::Result<f64> {
        Ok(u[self.0] - self.1.map_or(0.0, |k| u[k]))
    }
}

/// Runs to the value `end` of a quantity in equal steps.
fn controlled(system: System, quantity: Opening, end: f64, steps: u64) -> Simulation {
    let options = StaticOptions {
        tolerance: 1e-9,
        ..StaticOptions::default()
    };
    let control = LoadControl {
        quantity: Arc::new(quantity),
        rate: end,
        reference: 1.0,
    };
    let scheme = StaticScheme::controlled(options, control, &system).unwrap();
    let state = State::of(&system);
    Simulation::new(system, Box::new(scheme), state, 1.0 / steps as f64, steps).unwrap()
}

/// Load factors after each step; the energy balance must close.
fn factors_of(run: &mut Simulation) -> Vec<f64> {
    let mut factors = Vec::new();
    let mut note = |now: &Simulation| {
        let energies = now.snapshot().energies();
        let balance = energies.balance().abs();
        // Chosen after the first runs: bonds that unload within a step leave errors of a few 1e-5.
        assert!(balance < 1e-4 * energies.work.abs(), "{energies:?}");
        factors.push(now.system().load_factor().unwrap());
    };
    run.run(|now| {
        note(now);
        Control::Continue
    })
    .unwrap();
    note(run);
    factors
}

const DX: f64 = 0.1;
const CRITICAL: f64 = 2e-3;
const ONSET: f64 = 1e-3;

/// Two points with one bond, of which the left one is fixed and the right one pulled by the force of the bond at its
/// onset of softening.
fn spring(softening: SofteningLaw) -> System {
    let bar = Arc::new(Grid::bar(2.0 * DX, DX, 1.0).points().unwrap());
    let mut material =
        BondMaterial::new(ElasticModulus::Young(1.0), 1.0, DX).with_critical_stretch(CRITICAL);
    material.law = PairLaw::Linear;
    material.volume_correction = VolumeCorrection::None;
    let body = |force: f64| {
        Body::new(bar.clone(), material.clone())
            .softening(Softening {
                law: softening,
                onset: ONSET,
            })
            .motion(PrescribedMotion::fixed(vec![0], 1))
            .load(Load::new(
                vec![1],
                [force / DX, 0.0, 0.0],
                TimeFunction::Constant,
            ))
            .build()
            .unwrap()
    };
    let mut density = [0.0; 2];
    body(0.0).force_density_into(0.0, &[0.0, ONSET * DX], &mut density);
    body(-DX * density[1])
}

#[test]
fn a_softening_spring_under_a_force_follows_its_falling_branch() {
    // With linear softening from s_e = 1e-3 and the area ½ s0² the bond breaks at s0²/s_e = 4e-3.
    let end = 0.95 * CRITICAL * CRITICAL / ONSET;
    for law in [SofteningLaw::Linear, SofteningLaw::Exponential] {
        let curve = Softening { law, onset: ONSET }.curve(CRITICAL).unwrap();
        let factors = factors_of(&mut controlled(spring(law), Opening(1, None), end * DX, 38));
        for (k, factor) in factors.iter().enumerate() {
            let stretch = end * (k + 1) as f64 / 38.0;
            let expected = curve.force(stretch) / ONSET;
            assert!((factor - expected).abs() < 1e-8, "{law:?} {k}: {factor}");
        }
        assert!(factors[37] < 0.2 * factors[9]);
    }
}

#[test]
fn the_energy_of_a_softening_spring_is_that_of_its_curve() {
    let end = 0.9 * CRITICAL * CRITICAL / ONSET;
    let system = spring(SofteningLaw::Linear);
    let energy = system.operator().energy(0.0, &[0.0, ONSET * DX]);
    let mut run = controlled(system, Opening(1, None), end * DX, 30);
    factors_of(&mut run);
    let curve = Softening {
        law: SofteningLaw::Linear,
        onset: ONSET,
    };
    let area = curve.curve(CRITICAL).unwrap().dissipated(end);
    // The elastic energy at the onset is that of the area ½ s_e².
    let expected = energy * area / (0.5 * ONSET * ONSET);
    let found = run.snapshot().energies().dissipated;
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
}

/// How a notched strip is loaded.
enum Pull {
    Forces,
    /// A displacement of the right end: its largest value (m) times a function of time.
    Displacement(f64, TimeFunction),
}

/// A notched plate 24 × 12 whose ends are pulled along x, with the entries of both sides of its notch.
fn notched(softening: Option<Softening>, pull: Pull) -> (System, Opening) {
    let cloud = Arc::new(Grid::plate([24.0, 12.0], 1.0, 1.0).points().unwrap());
    let mut material = BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0);
    material.law = PairLaw::Linear;
    material = material.with_critical_stretch(CRITICAL);
    let ends = [
        points(&cloud, |x| x[0] < 3.0),
        points(&cloud, |x| x[0] > 21.0),
    ];
    let mouth = [11.5, 12.5].map(|x| {
        let at = |place: Point| (place[0] - x).abs() < 0.1 && place[1] < 1.0;
        points(&cloud, at)[0] as usize
    });
    let mut body = Body::new(cloud, material)
        .stress_state(StressState::PlaneStress)
        .crack(Crack::Segment {
            from: [12.0, 0.0],
            to: [12.0, 4.0],
        })
        .no_fail(ends.concat());
    if let Some(softening) = softening {
        body = body.softening(softening);
    }
    let [left, right] = ends;
    let held = PrescribedMotion::fixed(left, 2);
    body = match pull {
        Pull::Forces => {
            body.motion(held)
                .load(Load::new(right, [1e-3, 0.0, 0.0], TimeFunction::Constant))
        }
        Pull::Displacement(end, function) => {
            let along = [Some(end), None, None];
            let motion = PrescribedMotion::displacement(right, along, function);
            body.motion(held).motion(motion)
        }
    };
    (body.build().unwrap(), Opening(mouth[1], Some(mouth[0])))
}

fn softening() -> Option<Softening> {
    Some(Softening {
        law: SofteningLaw::Linear,
        onset: 5e-4,
    })
}

#[test]
fn a_softening_body_is_followed_beyond_its_largest_load() {
    let (system, opening) = notched(softening(), Pull::Forces);
    let factors = factors_of(&mut controlled(system, opening, 0.06, 40));
    let largest = factors.iter().copied().fold(0.0, f64::max);
    // The path rises, and falls to less than half of the largest load.
    assert!(factors[39] < 0.5 * largest, "{factors:?}");
    assert!(factors[0] < 0.5 * largest);
}

#[test]
fn states_under_control_are_those_of_prescribed_displacements() {
    const END: f64 = 0.02;
    const STEPS: u64 = 5;
    let (system, opening) = notched(softening(), Pull::Displacement(END, TimeFunction::Constant));
    let mut run = controlled(system, opening, 0.0125, STEPS);
    let factors = factors_of(&mut run);
    // Loads of the same states, because bonds that unload within a step keep no memory of their largest stretch.
    let times = (0..=STEPS).map(|k| k as f64 / STEPS as f64);
    let rows = times.zip(std::iter::once(0.0).chain(factors)).collect();
    let table = TimeFunction::Table(Arc::new(TimeTable::new(rows).unwrap()));
    let (system, _) = notched(softening(), Pull::Displacement(END, table));
    let options = StaticOptions {
        tolerance: 1e-9,
        ..StaticOptions::default()
    };
    let scheme = StaticScheme::new(options, &system).unwrap();
    let state = State::of(&system);
    let dt = 1.0 / STEPS as f64;
    let mut other = Simulation::new(system, Box::new(scheme), state, dt, STEPS).unwrap();
    other.run(|_| Control::Continue).unwrap();
    assert!(other.snapshot().energies().dissipated > 0.0);
    let pairs = run.state().u.iter().zip(&other.state().u);
    let difference = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(difference < 1e-6 * END, "{difference}");
}

#[test]
fn a_brittle_body_breaks_bond_by_bond_at_the_controlled_opening() {
    let (system, opening) = notched(None, Pull::Forces);
    let mut run = controlled(system, opening, 0.05, 40);
    let factors = factors_of(&mut run);
    let largest = factors.iter().copied().fold(0.0, f64::max);
    assert!(run.system().operator().broken_bonds() > 20);
    assert!(factors[39] < 0.5 * largest, "{factors:?}");
}

#[test]
fn a_resumed_run_has_the_same_bits() {
    let new = || {
        let (system, opening) = notched(softening(), Pull::Forces);
        controlled(system, opening, 0.04, 10)
    };
    round_trip::check_resume(new, [3, 6]).unwrap();
}

#[test]
fn what_cannot_be_controlled_is_an_error() {
    let control = |quantity| LoadControl {
        quantity: Arc::new(quantity),
        rate: 1e-3,
        reference: 1.0,
    };
    let (system, opening) = notched(None, Pull::Forces);
    let events = StaticOptions {
        breaking: BreakingRule::events(1.0),
        ..StaticOptions::default()
    };
    let error = StaticScheme::controlled(events, control(opening), &system).unwrap_err();
    assert!(error.to_string().contains("[[time.stop_when]]"), "{error}");
    let (system, opening) = notched(None, Pull::Displacement(0.0, TimeFunction::Constant));
    let options = StaticOptions::default();
    let error = StaticScheme::controlled(options, control(opening), &system).unwrap_err();
    assert!(error.to_string().contains("no load"), "{error}");
    // A point that does not move.
    let (system, _) = notched(None, Pull::Forces);
    let mut run = controlled(system, Opening(0, None), 1e-3, 1);
    let error = run.run(|_| Control::Continue).unwrap_err().to_string();
    assert!(error.contains("does not change with the loads"), "{error}");
}
