//! Natural modes against closed forms and dense eigenvalues.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use pericles::material::{Strains, StressState};
use pericles::prelude::*;
use pericles_statics::{ModeOptions, NaturalModes, symmetric_eigen};

use crate::bodies::Solid;

fn modes(system: &System, count: usize) -> NaturalModes {
    let options = ModeOptions {
        count,
        tolerance: 1e-7,
        ..ModeOptions::default()
    };
    let u = vec![0.0; system.dimension() * system.points()];
    let found = NaturalModes::find(options, system, (0.0, &u), Interrupt::never()).unwrap();
    println!(
        "{} iterations, {} products",
        found.iterations, found.products
    );
    found
}

/// A bar of length 1 whose bonds reach `m` cells.
fn bar(cells: usize, m: f64, periodic: bool) -> System {
    let dx = 1.0 / cells as f64;
    let mut points = Grid::bar(1.0, dx, 1.0).points().unwrap();
    if periodic {
        points = points.with_periodic_faces().unwrap();
    }
    let mut material = BondMaterial::new(ElasticModulus::Young(2.0), 3.0, m * dx);
    material.volume_correction = VolumeCorrection::None;
    material.law = PairLaw::Linear;
    Body::new(points, material).build().unwrap()
}

/// Row of the stiffness over the mass: −∂f/∂u_j/ρ for the force at point i.
fn row(system: &System, i: usize) -> Vec<f64> {
    let n = system.points();
    let (u, mut direction, mut column) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    direction[i] = 1.0;
    system
        .operator()
        .tangent_into(0.0, &u, &direction, &mut column);
    column.iter().map(|f| -f / 3.0).collect()
}

#[test]
fn a_free_bar_of_nearest_neighbours_has_the_frequencies_of_the_chain() {
    let cells = 60;
    let system = bar(cells, 1.0, false);
    // ω_k = 2 √(c/m) sin(kπ/2N) with the stiffness c of a spring and the mass m of a point.
    let spring = -row(&system, 20)[21];
    let found = modes(&system, 6);
    assert_eq!(found.rigid_modes, 1);
    for (k, mode) in found.modes.iter().enumerate() {
        let angle = (k + 1) as f64 * PI / (2.0 * cells as f64);
        let exact = 2.0 * spring.sqrt() * angle.sin() / TAU;
        assert!(
            (mode.frequency_hz / exact - 1.0).abs() < 1e-10,
            "{k}: {mode:?}"
        );
    }
}

#[test]
fn every_frequency_of_a_periodic_bar_is_double() {
    let cells = 48;
    for m in [1.0, 3.0] {
        let system = bar(cells, m, true);
        let row = row(&system, 0);
        let found = modes(&system, 6);
        assert_eq!(found.rigid_modes, 1);
        let groups = found.groups();
        assert_eq!(groups.len(), 3);
        for (q, group) in groups.iter().enumerate() {
            // ω(k)² by the plane wave of wavenumber k.
            let k = TAU * (q + 1) as f64 / cells as f64;
            let square: f64 = (0..cells).map(|j| row[j] * (k * j as f64).cos()).sum();
            let exact = square.sqrt() / TAU;
            assert_eq!(group.multiplicity, 2);
            assert!(
                (group.frequency_hz / exact - 1.0).abs() < 1e-10,
                "{group:?}"
            );
        }
    }
}

#[test]
fn a_free_plate_has_the_frequencies_of_the_dense_matrix() {
    let cloud = Arc::new(Grid::plate([1.0, 1.0], 1.0 / 7.0, 1.0).points().unwrap());
    let solid = Solid {
        cloud: cloud.clone(),
        poisson_ratio: 0.3,
        state: StressState::PlaneStress,
        strains: Strains::Small,
        cracks: vec![],
    };
    let system = solid.system();
    let entries = 2 * cloud.len();
    let (u, mut direction, mut column) =
        (vec![0.0; entries], vec![0.0; entries], vec![0.0; entries]);
    let mut dense = Vec::new();
    for k in 0..entries {
        direction.fill(0.0);
        direction[k] = 1.0;
        system
            .operator()
            .tangent_into(0.0, &u, &direction, &mut column);
        dense.extend(column.iter().map(|f| -f));
    }
    // Equal volumes and a density of 1: the matrix is symmetric but for rounding.
    let symmetric = (0..entries * entries)
        .map(|e| 0.5 * (dense[e] + dense[(e % entries) * entries + e / entries]));
    let (values, _) = symmetric_eigen(entries, symmetric.collect());
    let found = modes(&system, 8);
    assert_eq!(found.rigid_modes, 3);
    for (k, mode) in found.modes.iter().enumerate() {
        let exact = values[3 + k].sqrt() / TAU;
        assert!(
            (mode.frequency_hz / exact - 1.0).abs() < 1e-10,
            "{k}: {mode:?} {exact}"
        );
    }
}
