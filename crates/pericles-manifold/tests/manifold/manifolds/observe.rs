//! Measured quantities of surfaces.

use std::sync::Arc;

use pericles::boundary::{Load, TimeFunction};
use pericles::observe::{Snapshot, StartEnergy};
use pericles::time::{InnerSolver, Newmark, State};
use pericles::{Control, Simulation};
use pericles_manifold::PowerMaterial;
use pericles_manifold::{EnergyBound, SurfaceMeasure};

use super::sphere::*;

#[test]
fn stretch_inversion_and_energy_concentration_are_measured() {
    let sphere = Sphere::standard();
    let n = sphere.cloud.len();
    let measure = SurfaceMeasure::new(Arc::new(sphere.surface.clone()));
    let system = sphere.system(&material(2.0, 0.5));
    let mut state = State::at_rest(3 * n);
    let read =
        |state: &State| measure.read(&Snapshot::new(&system, state, StartEnergy::default(), 0.0));
    // Inflated by a tenth; turned inside out through the equator; one vertex pulled out.
    let x = sphere.cloud.positions().to_vec();
    state.u = x.iter().map(|x| 0.1 * x).collect();
    let inflated = read(&state);
    assert!((inflated.stretch - 0.21).abs() < 1e-12);
    assert_eq!((inflated.inverted_triangles, inflated.zones.len()), (0, 0));
    assert!(inflated.localisation > 1.0 && inflated.localisation < 1.5);
    state.u = (0..3 * n)
        .map(|k| if k < 2 * n { 0.0 } else { -2.0 * x[k] })
        .collect();
    let turned = read(&state);
    assert!(turned.stretch.abs() < 1e-12);
    assert!(
        turned.inverted_triangles > 400,
        "{}",
        turned.inverted_triangles
    );
    state.u = vec![0.0; 3 * n];
    (0..3).for_each(|c| state.u[c * n + 17] = 2.0 * x[c * n + 17]);
    let pulled = read(&state);
    assert_eq!(pulled.zones.len(), 1);
    let centre = pulled.zones[0].centre;
    let apart: f64 = (0..3).map(|c| (centre[c] - x[c * n + 17]).powi(2)).sum();
    assert!(apart.sqrt() < 0.1 && pulled.overstretched_edges >= 5);
    assert!(pulled.top_share > 0.5 && pulled.localisation > 50.0);
}

#[test]
fn energy_bound_is_sharp_for_a_uniform_load() {
    // The body moves as a whole: √E = ∫‖b‖/√(2ρ).
    let sphere = Sphere::standard();
    let n = sphere.cloud.len();
    let mut system = sphere.system(&PowerMaterial {
        density: 3.0,
        ..material(3.0, 0.5)
    });
    let all = (0..n as u32).collect();
    system
        .add_load(Load::new(all, [0.3, -0.1, 0.2], TimeFunction::Constant))
        .unwrap();
    let scheme = Newmark::new(newmark(InnerSolver::FixedPoint), &system).unwrap();
    let mut run =
        Simulation::new(system, Box::new(scheme), State::at_rest(3 * n), 0.05, 40).unwrap();
    let mut bound = EnergyBound::default();
    bound.margin(&run.snapshot());
    run.run(|run| {
        let snapshot = run.snapshot();
        let energies = snapshot.energies();
        let margin = bound.margin(&snapshot);
        assert!(margin.abs() < 1e-9 * energies.kinetic.sqrt(), "{margin}");
        Control::Continue
    })
    .unwrap();
}
