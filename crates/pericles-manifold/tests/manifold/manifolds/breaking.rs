//! Bond breaking on surfaces.

use pericles::time::VelocityVerlet;
use pericles::{Archive, Checkpointed, Control, Simulation};
use pericles_manifold::PowerMaterial;

use super::sphere::*;

#[test]
fn bonds_break_once_and_dissipate_their_energy() {
    let sphere = Sphere::standard();
    let material = PowerMaterial {
        critical_stretch: 0.4,
        ..material(2.0, 0.5)
    };
    let run = |stop: u64| {
        let system = sphere.system(&material);
        let mut run = Simulation::new(
            system,
            Box::new(VelocityVerlet),
            sphere.thrown(1.0),
            0.01,
            200,
        )
        .unwrap();
        run.run(|run| {
            if run.state().step == stop {
                Control::Stop
            } else {
                Control::Continue
            }
        })
        .unwrap();
        run
    };
    let whole = run(u64::MAX);
    let energies = whole.snapshot().energies();
    let operator = whole.system().operator();
    assert!(operator.broken_bonds() > 100 && operator.broken_bonds() < 11370);
    assert!(energies.dissipated > 0.05 * energies.initial);
    assert!(
        energies.balance().abs() < 2e-3 * energies.initial,
        "{energies:?}"
    );
    let momentum = whole.system().momentum(&whole.state().v);
    let before = whole.system().momentum(&sphere.thrown(1.0).v);
    for c in 0..3 {
        assert!((momentum[c] - before[c]).abs() < 1e-11);
    }
    // Save and resume into a run in which other bonds have broken.
    let mut archive = Archive::default();
    run(60).save(&mut archive);
    let mut resumed = run(120);
    resumed.restore(&archive).unwrap();
    resumed.run(|_| Control::Continue).unwrap();
    assert_eq!(resumed.state(), whole.state());
    assert_eq!(
        resumed.system().operator().dissipated(),
        energies.dissipated
    );
}
