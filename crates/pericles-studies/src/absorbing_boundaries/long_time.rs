//! Exactness of the boundaries over many steps, compared with the solution of the infinite lattice.

use std::f64::consts::TAU;

use pericles_run::RunError;
use pericles_waves::absorbing::LatticeStencil;

use super::bar::{Bar, HALF, Kind, NODE, Source, stencil};
use crate::common::{difference, largest};
use crate::data::{Case, Found};

/// Displacements of the infinite lattice at distances 0 … `most` from a node that was displaced by one, after a number
/// of steps of velocity Verlet from rest.
///
/// They are the mean over all wavenumbers κ of cos(nθ) cos(κd) with sin(θ/2) = ω(κ) dt/2. The mean over equidistant
/// wavenumbers is exact as long as waves have not reached the images of the node.
fn of_lattice(stencil: &LatticeStencil, dt: f64, steps: usize, most: usize) -> Vec<f64> {
    /// Number of nodes over which the displacement decays beyond the fastest waves.
    const MARGIN: usize = 2000;
    let reached = (stencil.fastest() * dt * steps as f64) as usize;
    let half = (reached + most + MARGIN) / 2;
    let mut u = vec![0.0; most + 1];
    for p in 0..=half {
        let kappa = TAU * p as f64 / (2 * half) as f64;
        let theta = 2.0 * (0.5 * dt * stencil.square_frequency(kappa).sqrt()).asin();
        let weight = if p == 0 || p == half { 0.5 } else { 1.0 };
        let amplitude = weight * (theta * steps as f64).cos() / half as f64;
        for (d, u) in u.iter_mut().enumerate() {
            *u += amplitude * (kappa * d as f64).cos();
        }
    }
    u
}

/// Largest error of the displacement after many steps: one node is displaced, so that all waves of the lattice are
/// excited, including those that leave slowly.
pub(super) fn long_time(case: &Case<'_>) -> Result<Found, RunError> {
    let (dt, steps) = (case.number("dt")?, case.count("steps")?);
    let bar = Bar {
        source: Source::Node,
        ..Bar::infinite(1.0)
    };
    let states = bar.states(Kind::Discrete, dt, &[dt * steps as f64])?;
    let by_distance = of_lattice(&stencil()?, dt, steps, HALF + HALF.abs_diff(NODE));
    let exact: Vec<f64> = (0..=2 * HALF)
        .map(|i| by_distance[i.abs_diff(NODE)])
        .collect();
    let error = states.last().map(|state| difference(&state.u, &exact));
    let found = Found::default().value("value", error);
    Ok(found.value("largest", largest(&exact)))
}
