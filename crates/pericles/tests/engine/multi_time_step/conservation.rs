//! Conservation and balance of energy and momentum.

use pericles::material::BondStretch;
use pericles::space::PointSet;
use pericles::time::{AdaptiveRungeKutta, Integrator};
use pericles::{Control, Simulation, System};

use super::bodies::{crack, free_plate, pushed_bar, steps_of};
use super::schemes::{Scheme, adaptive, mixed, respa, run, uniform};

fn respa_keeps_energy_and_momentum(steps: u64) {
    for omega_dt in [0.5, 1.0] {
        let (system, state, fine, end) = steps_of(free_plate(), omega_dt, steps);
        let integrator = respa(4)(&system, &fine);
        let momentum = system.momentum(&state.v);
        let mut simulation =
            Simulation::new(system, integrator, state, end / steps as f64, steps).unwrap();
        let initial = simulation.start_energy().energy;
        let mut worst = [0.0f64; 2];
        simulation
            .run(|simulation| {
                let late = usize::from(simulation.state().step > steps / 2);
                if simulation.state().step.is_multiple_of(steps / 500) {
                    let energies = simulation.snapshot().energies();
                    let error = (energies.balance() / initial).abs();
                    worst[late] = worst[late].max(error);
                }
                Control::Continue
            })
            .unwrap();
        println!("ω dt = {omega_dt}: {worst:?}");
        // Bounded: the second half is as good as the first.
        assert!(worst[0] < 0.03 * omega_dt * omega_dt && worst[1] < 1.5 * worst[0]);
        let system = simulation.system();
        let after = system.momentum(&simulation.state().v);
        let scale: f64 = {
            let n = system.points();
            let mass = 7850.0 * system.cloud().volumes()[0];
            let v = &simulation.state().v;
            (0..2 * n).map(|k| mass * v[k].abs()).sum()
        };
        for c in 0..2 {
            let error = (after[c] - momentum[c]).abs() / scale;
            assert!(error < 1e-11, "{error}");
        }
    }
}

#[test]
fn respa_keeps_energy_bounded_and_momentum_to_round_off() {
    respa_keeps_energy_and_momentum(4_000);
}

#[test]
fn energy_and_momentum_balances_close_to_the_order_of_the_scheme() {
    // The work of a load is computed to fourth order, so that the error of the balance is the error of the scheme.
    let balance = |steps| {
        let simulation = run(pushed_bar(None), steps, mixed(4, 4));
        let energies = simulation.snapshot().energies();
        (energies.balance() / energies.work).abs()
    };
    let (coarse, fine) = (balance(64), balance(128));
    assert!(
        coarse < 1e-4 && (coarse / fine).log2() > 3.5,
        "{coarse} {fine}"
    );
    // The momentum of the body is the impulse of the load, except for what the interface loses.
    let simulation = run(pushed_bar(None), 128, mixed(4, 4));
    let momentum = simulation.system().momentum(&simulation.state().v)[0];
    let impulse = simulation.system().ledger().impulse[0];
    let error = (momentum / impulse - 1.0).abs();
    assert!(error < 1e-4, "{error}");
    let simulation = run(pushed_bar(None), 128, uniform(4));
    let momentum = simulation.system().momentum(&simulation.state().v)[0];
    let impulse = simulation.system().ledger().impulse[0];
    // Simpson's rule and the method use the same nodes.
    assert!((momentum / impulse - 1.0).abs() < 1e-12);
}

#[test]
fn the_energy_balance_closes_while_bonds_break() {
    let pair = |system: &System, _: &PointSet| -> Box<dyn Integrator> {
        Box::new(AdaptiveRungeKutta::new(1e-5, system).unwrap())
    };
    let schemes: [&Scheme<'_>; 5] = [&uniform(4), &mixed(4, 4), &adaptive(4, 4), &respa(4), &pair];
    for scheme in schemes {
        let simulation = run(crack::<BondStretch>(40, 10.0, 0.006, 1.2e-5), 256, scheme);
        let energies = simulation.snapshot().energies();
        let name = simulation.integrator().name();
        println!("{name}: {energies:?} {:e}", energies.balance());
        assert!(energies.dissipated > 0.0);
        assert!(
            energies.balance().abs() < 0.02 * energies.dissipated,
            "{name}: {energies:?}"
        );
    }
}
