//! Layers in which motion dies away.

use pericles::boundary::{DampingLayer, DampingProfile};
use pericles::round_trip::check_resume;
use pericles::space::Face;
use pericles::time::VelocityVerlet;
use pericles::{Simulation, System};

use crate::absorbing::bar::{bar, pulse, run};

const DT: f64 = 0.1;

fn layer(thickness: f64, reflection: f64) -> DampingProfile {
    DampingProfile::of_reflection(thickness, reflection, 2.0, 1.0)
}

/// With the layer at the right of a bar −20 … 20.
fn damped(profile: DampingProfile) -> System {
    let mut system = bar(200, 1.0);
    let face = Face::named("+x").unwrap();
    let layer = DampingLayer::new(
        system.cloud(),
        system.density(),
        face,
        profile,
        DT,
        Some(8.0),
    )
    .unwrap();
    system.add_boundary(Box::new(layer));
    system
}

/// What comes back into −10 … 10 of a bell that left it, over what would without a layer.
fn reflected(profile: DampingProfile) -> f64 {
    let system = damped(profile);
    let state = pulse(&system, 0.0);
    // The half that ran to the right is back in the middle; the one to the left was reflected by the free end, and is at the left.
    let steps = 350;
    let end = run(system, state, DT, steps);
    let energies = end.snapshot().energies();
    assert!(
        energies.balance().abs() < 1e-12 * energies.initial,
        "{energies:?}"
    );
    let cloud = end.system().cloud();
    let back = cloud.axis(0).iter().zip(&end.state().u);
    back.filter(|(x, _)| **x > 0.0)
        .fold(0.0, |a: f64, (_, u)| a.max(u.abs()))
        / 0.5
}

#[test]
fn the_layer_returns_what_it_is_asked_to() {
    // Less than that: the layer delays the long waves of the bell, which spread.
    for asked in [0.3, 0.1] {
        let found = reflected(layer(10.0, asked));
        assert!(found < asked && found > 0.4 * asked, "{asked}: {found}");
    }
    // Waves as long as the layer do not notice that it is graded: a deeper one returns less.
    let [thin, thick] = [3.0, 12.0].map(|thickness| reflected(layer(thickness, 1e-4)));
    assert!(thick < 0.05 && thin > 3.0 * thick, "{thin:e}, {thick:e}");
}

#[test]
fn damping_is_resumed() {
    let make = || {
        let system = damped(layer(10.0, 0.01));
        let state = pulse(&system, 12.0);
        Simulation::new(system, Box::new(VelocityVerlet), state, DT, 200).unwrap()
    };
    check_resume(make, [77]).unwrap();
}

#[test]
fn layers_that_cannot_be_are_refused() {
    let system = bar(50, 1.0);
    let refusal = |face: &str, profile, frequency| {
        let face = Face::named(face).unwrap();
        let refused = DampingLayer::new(
            system.cloud(),
            system.density(),
            face,
            profile,
            DT,
            Some(frequency),
        );
        refused
            .err()
            .map(|error| error.to_string())
            .unwrap_or_default()
    };
    assert!(refusal("+y", layer(1.0, 0.1), 8.0).contains("has no side +y"));
    assert!(refusal("+x", layer(0.05, 0.1), 8.0).contains("allowed: from a cell"));
    assert!(refusal("+x", layer(11.0, 0.1), 8.0).contains("less than the body"));
    assert!(refusal("+x", layer(0.3, 1e-6), 19.0).contains("ω dt is 1.9000"));
}
