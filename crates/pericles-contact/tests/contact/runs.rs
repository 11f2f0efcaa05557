//! Collisions: closed forms, conservation, energy balance, reproducibility.

use pericles::prelude::*;
use pericles::round_trip::check_resume;
use pericles::time::DiscreteGradient;
use pericles::{Archive, Checkpointed, Simulation};
use pericles_contact::{ContactLaw, Friction, Impactor};

use crate::setup::{ELASTIC, Grain, bars, discs, mean, steady};

const SPEED: f64 = 1e-3;

/// Time of the last contact in a run minus that of the first.
fn duration(run: &mut Simulation) -> f64 {
    let (mut first, mut last) = (f64::NAN, f64::NAN);
    run.run(|now| {
        let t = now.state().t;
        if now.snapshot().energies().contact > 0.0 {
            first = if first.is_nan() { t } else { first };
            last = t;
        }
        Control::Continue
    })
    .unwrap();
    last - first
}

#[test]
fn bars_that_meet_exchange_their_velocities() {
    // Restitution and duration of an independent program with the same start, 0.37 v dt apart.
    for (cells, e, lasting) in [(50, 0.98677, 2.150), (100, 0.99311, 2.075)] {
        let dt = 0.5 / cells as f64;
        let gap = 0.37 * SPEED * dt;
        let body = bars(cells, &[cells, cells], gap).touching(ELASTIC);
        let mut run = body.run(&[SPEED, 0.0], dt, 6 * cells as u64);
        let took = duration(&mut run);
        let (a, b) = run.state().v.split_at(cells);
        let found = (mean(b) - mean(a)) / SPEED;
        assert!((found - e).abs() < 2e-5, "{cells}: {found}");
        assert!((took - lasting).abs() < 2.5 * dt, "{cells}: {took}");
        let momentum = (mean(a) + mean(b)) / SPEED - 1.0;
        assert!(momentum.abs() < 1e-13, "{momentum:e}");
    }
}

#[test]
fn a_wall_is_the_mirror_image_of_a_bar() {
    let cells = 50;
    let dt = 0.5 / cells as f64;
    let gap = 0.37 * SPEED * dt;
    // Towards a wall with half of the gap, and two bars with opposite velocities.
    let wall = bars(cells, &[cells], 0.0).wall(1.0 + gap, steady([0.0; 3]), ELASTIC);
    let mut wall = wall.run(&[SPEED], dt, 300);
    wall.run_to_end().unwrap();
    let pair = bars(cells, &[cells, cells], 2.0 * gap).touching(ELASTIC);
    let mut pair = pair.run(&[SPEED, -SPEED], dt, 300);
    pair.run_to_end().unwrap();
    let (of_wall, of_pair) = (mean(&wall.state().v), mean(&pair.state().v[..cells]));
    assert!(
        (of_wall / of_pair - 1.0).abs() < 1e-10,
        "{of_wall} {of_pair}"
    );
    // The same restitution as two bars, one at rest.
    assert!((of_wall / -SPEED - 0.98677).abs() < 2e-5, "{of_wall}");
    let body: &Impactor = wall
        .system()
        .interactions()
        .next()
        .unwrap()
        .downcast_ref()
        .unwrap();
    let impulse = body.reading().impulse[0];
    assert!(
        (impulse / (of_wall - SPEED) - 1.0).abs() < 1e-12,
        "{impulse}"
    );
}

#[test]
fn a_bar_twice_as_long_leaves_the_other_at_rest() {
    // v1, v2 of an independent program; wave theory: 0 and ½.
    let cells = 100;
    let dt = 0.5 / cells as f64;
    let body = bars(cells, &[cells, 2 * cells], 0.37 * SPEED * dt).touching(ELASTIC);
    let mut run = body.run(&[SPEED, 0.0], dt, 8 * cells as u64);
    run.run_to_end().unwrap();
    let (a, b) = run.state().v.split_at(cells);
    assert!(
        (mean(a) / SPEED + 0.0174).abs() < 2e-4,
        "{}",
        mean(a) / SPEED
    );
    assert!(
        (mean(b) / SPEED - 0.5087).abs() < 2e-4,
        "{}",
        mean(b) / SPEED
    );
}

#[test]
fn the_energy_balance_is_of_second_order() {
    // Largest error over time relative to the energy, mean of ten phases of the first contact, of an independent
    // program: 4.7e-4, 1.2e-4, 2.9e-5.
    let cells = 100;
    let error = |part: f64| {
        let dt = part / cells as f64;
        let one = |phase: f64| {
            let body = bars(cells, &[cells, cells], phase * SPEED * dt).touching(ELASTIC);
            let steps = (3.0 * cells as f64 / part) as u64;
            let mut run = body.run(&[SPEED, 0.0], dt, steps);
            let mut most: f64 = 0.0;
            run.run(|now| {
                let energies = now.snapshot().energies();
                most = most.max(energies.balance().abs() / energies.initial);
                Control::Continue
            })
            .unwrap();
            most
        };
        (0..10).map(|k| one(0.05 + 0.1 * f64::from(k))).sum::<f64>() / 10.0
    };
    let errors = [1.0, 0.5, 0.25].map(error);
    for (error, expected) in errors.iter().zip([4.7e-4, 1.2e-4, 2.9e-5]) {
        let ratio = error / expected;
        assert!((1.0 / 1.5..1.5).contains(&ratio), "{errors:?}");
    }
    let order = (errors[0] / errors[2]).log2() / 2.0;
    assert!((order - 2.0).abs() < 0.15, "{order}");
}

/// A point that falls on a floor.
fn falling(gap: f64) -> Grain {
    Grain {
        mass: 2.0,
        force: [0.0; 2],
        gap,
        velocity: [0.0, -SPEED],
        stiffness: 50.0,
    }
}

#[test]
fn the_step_of_entry_changes_the_energy_by_a_known_amount() {
    let (dt, gap) = (0.1, 0.3 * SPEED * 0.1);
    let grain = falling(gap);
    let mut run = grain.run(ELASTIC, dt, 1);
    run.run_to_end().unwrap();
    let energies = run.snapshot().energies();
    let overlap = SPEED * dt - gap;
    // −½ k g₁ (v dt − g₁) for the linear law.
    let expected = -0.5 * grain.stiffness * overlap * gap;
    let found = energies.balance();
    assert!(
        (found / expected - 1.0).abs() < 1e-8,
        "{found:e} {expected:e}"
    );
}

#[test]
fn damping_gives_the_restitution_of_a_damped_oscillator() {
    for (damping, e) in [
        (0.0342652041, 0.9),
        (0.1222147478, 0.7),
        (0.4972393947, 0.3),
    ] {
        let law = ContactLaw { damping, ..ELASTIC };
        let grain = falling(1e-6);
        // ω dt = 0.005.
        let mut run = grain.run(law, 1e-3, 2000);
        run.run_to_end().unwrap();
        let found = run.state().v[1] / SPEED;
        assert!((found / e - 1.0).abs() < 0.01, "{found} instead of {e}");
        let energies = run.snapshot().energies();
        let lost = 0.5 * grain.mass * SPEED * SPEED * (1.0 - found * found);
        assert!((energies.contact_dissipated / lost - 1.0).abs() < 1e-2);
        assert!(energies.balance().abs() < 1e-4 * energies.initial);
    }
}

#[test]
fn a_block_on_a_slope_slides_and_stops_by_coulombs_law() {
    // Slope, friction, first velocity; energy dissipated in half a second: μ N times the way.
    for (slope, coefficient, first, expected) in
        [(0.5f64, 0.3, 0.1, 1.627401), (0.3, 0.5, 2.0, 7.278563)]
    {
        let (mass, gravity, stiffness) = (2.0, 9.81, 2e4);
        let (sin, cos) = slope.sin_cos();
        let pressure = mass * gravity * cos;
        let grain = Grain {
            mass,
            force: [mass * gravity * sin, -pressure],
            gap: -pressure / stiffness,
            velocity: [first, 0.0],
            stiffness,
        };
        let law = ContactLaw {
            friction: Some(Friction {
                coefficient,
                speed: 1.0,
            }),
            ..ELASTIC
        };
        let mut run = grain.run(law, 1e-3, 500);
        run.run_to_end().unwrap();
        let energies = run.snapshot().energies();
        let found = energies.contact_dissipated;
        assert!((found / expected - 1.0).abs() < 1e-6, "{found}");
        assert!(
            energies.balance().abs() < 1e-11 * found,
            "{:e}",
            energies.balance()
        );
        let v = run.state().v[0];
        let sliding = first + 0.5 * gravity * (sin - coefficient * cos);
        assert!(
            (v - sliding.max(0.0)).abs() < 1e-12 * gravity,
            "{v} {sliding}"
        );
    }
}

#[test]
fn a_prescribed_wall_does_its_velocity_times_its_impulse() {
    // A mass at rest is thrown off with twice the velocity of the wall.
    let grain = Grain {
        velocity: [0.0; 2],
        gap: 0.0,
        ..falling(0.0)
    };
    let run = grain.run(ELASTIC, 1e-2, 100);
    assert_eq!(run.snapshot().energies().initial, 0.0);
    let cells = 4;
    let body = bars(cells, &[cells], 0.0).wall(1.0 + 1e-5, steady([-SPEED, 0.0, 0.0]), ELASTIC);
    let mut run = body.run(&[0.0], 0.02, 400);
    run.run_to_end().unwrap();
    let body: &Impactor = run
        .system()
        .interactions()
        .next()
        .unwrap()
        .downcast_ref()
        .unwrap();
    let reading = body.reading();
    let energies = run.snapshot().energies();
    assert!((reading.work - -SPEED * reading.impulse[0]).abs() < 1e-14 * reading.work);
    assert!((energies.work - reading.work).abs() < 1e-14 * reading.work);
    let momentum = run.system().momentum(&run.state().v)[0];
    assert!((momentum / reading.impulse[0] - 1.0).abs() < 1e-12);
    assert!(energies.balance().abs() < 1e-3 * energies.work);
}

fn collision(speed: f64, critical: f64, law: ContactLaw, skin: f64, steps: u64) -> Simulation {
    let (system, state) = discs(6.0, speed, critical, law, skin);
    Simulation::new(system, Box::new(VelocityVerlet), state, 0.4, steps).unwrap()
}

fn rough() -> ContactLaw {
    ContactLaw {
        damping: 0.3,
        friction: Some(Friction {
            coefficient: 0.3,
            speed: 1e-3,
        }),
        ..ELASTIC
    }
}

#[test]
fn collisions_with_breaking_bonds_conserve_momentum_and_angular_momentum() {
    for law in [ELASTIC, rough()] {
        let mut run = collision(0.15, 0.02, law, 0.3, 150);
        let moments = |run: &Simulation| {
            let (cloud, state) = (run.system().cloud(), run.state());
            let n = cloud.len();
            let angular: f64 = (0..n)
                .map(|i| {
                    let [x, y] = [0, 1].map(|c| cloud.axis(c)[i] + state.u[c * n + i]);
                    x * state.v[n + i] - y * state.v[i]
                })
                .sum();
            let [p, q, _] = run.system().momentum(&state.v);
            [p, q, angular]
        };
        let first = moments(&run);
        run.run_to_end().unwrap();
        let last = moments(&run);
        assert!(run.system().operator().broken_bonds() > 100);
        let scale = first[0].abs();
        for (k, lever) in [(0, 1.0), (1, 1.0), (2, 20.0)] {
            let change = (last[k] - first[k]).abs();
            // Dampers act between the points along their line; friction between points at a distance has a moment.
            let is_conserved = k < 2 || law.friction.is_none();
            assert!(
                !is_conserved || change < 1e-13 * scale * lever,
                "{k}: {change:e}"
            );
        }
        let energies = run.snapshot().energies();
        let error = energies.balance().abs() / energies.initial;
        assert!(error < 0.05, "{error}");
        assert!((energies.contact_dissipated > 0.0) == (law.damping > 0.0));
    }
}

#[test]
fn the_energy_of_colliding_discs_converges() {
    // Largest error with dt = 0.8 and 0.4 dx/c of discs of radius 10 in an independent program: 9.9e-4, 3.3e-4.
    let error = |dt: f64| {
        let (system, state) = discs(6.0, 0.02, f64::INFINITY, ELASTIC, 0.3);
        let steps = (160.0 / dt) as u64;
        let mut run = Simulation::new(system, Box::new(VelocityVerlet), state, dt, steps).unwrap();
        let mut most: f64 = 0.0;
        run.run(|now| {
            let energies = now.snapshot().energies();
            most = most.max(energies.balance().abs() / energies.initial);
            Control::Continue
        })
        .unwrap();
        assert!(run.state().v.iter().any(|v| *v < 0.0));
        most
    };
    let errors = [0.8, 0.2].map(error);
    assert!(
        errors[1] < 1e-3 && errors[1] < 0.2 * errors[0],
        "{errors:?}"
    );
}

fn end_of(mut run: Simulation) -> Archive {
    run.run_to_end().unwrap();
    let mut archive = Archive::default();
    run.save(&mut archive);
    archive
}

#[test]
fn results_do_not_depend_on_threads_skins_and_restarts() {
    let end = end_of(collision(0.15, 0.02, rough(), 0.3, 120));
    for (threads, skin) in [(1, 0.3), (2, 0.1), (3, 1.0)] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let other = pool
            .unwrap()
            .install(|| end_of(collision(0.15, 0.02, rough(), skin, 120)));
        let different = end.differences(&other);
        assert!(
            different.is_empty(),
            "{threads} threads, skin {skin}: {different:?}"
        );
    }
    let make = || collision(0.15, 0.02, rough(), 0.3, 120);
    let resumed = check_resume(make, [25, 40, 80]).unwrap();
    assert!(end.differences(&resumed).is_empty());
}

#[test]
fn intact_bodies_do_not_touch_themselves() {
    let (system, state) = discs(6.0, 0.0, 0.02, ELASTIC, 0.3);
    let n = system.points();
    // Squeezed by a third.
    let u: Vec<f64> = (0..2 * n)
        .map(|k| -0.33 * system.cloud().axis(k / n)[k % n])
        .collect();
    assert!(system.contact_energy(0.0, &u) >= 0.0);
    let (a, b) = (
        system.contact_energy(0.0, &state.u),
        system.operator().broken_bonds(),
    );
    assert_eq!((a, b), (0.0, 0));
    let half = n / 2;
    // Only one disc is squeezed, towards its own centre.
    let own: Vec<f64> = (0..2 * n)
        .map(|k| if k % n < half { u[k] } else { 0.0 })
        .collect();
    assert_eq!(system.contact_energy(0.0, &own), 0.0);
}

#[test]
fn the_discrete_gradient_conserves_the_energy_of_bounces_at_large_steps() {
    let cells = 8;
    let body = bars(cells, &[cells, cells], 1e-5).touching(ELASTIC);
    // Four times the step that velocity Verlet would need.
    let dt = 4.0 * 0.5 / cells as f64;
    let mut state = State::of(&body.system);
    state.v[..cells].fill(SPEED);
    let scheme = DiscreteGradient::new(1e-10, &body.system).unwrap();
    let mut run = Simulation::new(body.system, Box::new(scheme), state, dt, 40).unwrap();
    let mut touched = false;
    run.run(|now| {
        let energies = now.snapshot().energies();
        touched |= energies.contact > 0.0;
        assert!(
            energies.balance().abs() < 1e-8 * energies.initial,
            "{energies:?}"
        );
        Control::Continue
    })
    .unwrap();
    assert!(touched);
    let momentum = run.system().momentum(&run.state().v)[0];
    assert!((momentum / SPEED - 1.0).abs() < 1e-10);
}
