//! A strip that is periodic across and infinite along its length: absorbing boundaries by Fourier modes.

use std::collections::HashMap;
use std::sync::Arc;
use std::time::Instant;

use pericles::family::VolumeCorrection;
use pericles::space::PointCloud;
use pericles::time::{State, VelocityVerlet};
use pericles::{PericlesError, PointScalar, Simulation, System};
use pericles_io::{CellSize, ColourMap, FieldPicture};
use pericles_run::RunError;
use pericles_waves::absorbing::Side;
use pericles_waves::absorbing::strip::{StripEnd, StripLattice};
use pericles_waves::linear::ConvolutionForce;

use crate::common::{cells, watch};
use crate::context::Context;
use crate::data::{Case, Found};

/// Number of rows; lengths are in spacings.
const ROWS: usize = 32;
/// Number of columns from the middle to an end.
const HALF: usize = 40;
const HORIZON: f64 = 3.01;
const DT: f64 = 0.4;
const STEPS: usize = 400;
/// Number of columns over which fields decay beyond the light cone.
const MARGIN: usize = 60;

/// Plate with additional columns on each side, and a bell-shaped pulse beside its middle that moves upwards.
fn strip(margin: usize) -> Result<(System, State), RunError> {
    let half = HALF + margin;
    let origin = [-(half as f64) - 0.5, 0.0, 0.0];
    let size = vec![(2 * half + 1) as f64, ROWS as f64];
    let cloud = Arc::new(cells(origin, size, 1.0)?);
    // Bonds k ξ⊗ξ/|ξ|³ with k such that long waves along x have about unit speed.
    let force = ConvolutionForce::<2>::with_stiffness(
        Arc::clone(&cloud),
        HORIZON,
        VolumeCorrection::None,
        |_| 0.06,
        [false, true],
    )?;
    let n = cloud.len();
    let system = System::new(
        Arc::clone(&cloud),
        Box::new(force),
        PointScalar::Uniform(1.0),
    )?;
    let mut state = State::at_rest(2 * n);
    for i in 0..n {
        let [x, y] = [0, 1].map(|axis| cloud.axis(axis)[i]);
        let bell = (-((x + 6.0).powi(2) + (y - 13.0).powi(2)) / 16.0).exp();
        state.u[i] = bell;
        state.v[n + i] = 0.2 * bell;
    }
    Ok((system, state))
}

/// States at regular intervals of steps, and the time of the run in seconds.
fn run(
    (system, state): (System, State),
    every: usize,
) -> Result<(Vec<(State, f64)>, f64), RunError> {
    let mut simulation =
        Simulation::new(system, Box::new(VelocityVerlet), state, DT, STEPS as u64)?;
    let began = Instant::now();
    let mut states = Vec::new();
    let mut note = |now: &Simulation| {
        if now.state().step.is_multiple_of(every as u64) {
            let energies = now.snapshot().energies();
            states.push((now.state().clone(), energies.kinetic + energies.elastic));
        }
    };
    note(&simulation);
    watch(&mut simulation, &mut note)?;
    // The observer is not called for the last state of a run.
    note(&simulation);
    Ok((states, began.elapsed().as_secs_f64()))
}

/// Compares the strip with exact boundaries with a larger one: errors, energy, seconds.
pub(super) fn strip_ends(case: &Case<'_>) -> Result<Found, RunError> {
    const EVERY: usize = 10;
    let (mut system, state) = strip(0)?;
    let began = Instant::now();
    let mut memory = 0;
    for side in [Side::Left, Side::Right] {
        let lattice = StripLattice::of(&system, side).map_err(PericlesError::from)?;
        let kernels = lattice.kernels(DT, STEPS);
        let end = StripEnd::new(lattice, side, state.u.len(), &kernels);
        memory += end.bytes();
        system.add_boundary(Box::new(end));
    }
    let seconds_kernels = began.elapsed().as_secs_f64();
    let cloud = Arc::clone(system.cloud());
    let (small, seconds) = run((system, state), EVERY)?;

    let fastest = StripLattice::of(&strip(0)?.0, Side::Left).map_err(PericlesError::from)?;
    let cone = 0.5 * fastest.fastest() * DT * STEPS as f64;
    let (large, state) = strip(cone as usize + MARGIN)?;
    let inside = inner_entries(&large, &cloud);
    let points = large.points();
    let (large, seconds_large) = run((large, state), EVERY)?;
    let mut worst = 0.0_f64;
    for ((small, _), (large, _)) in small.iter().zip(&large) {
        for (entry, &place) in inside.iter().enumerate() {
            let u = (small.u[entry] - large.u[place]).abs();
            let v = (small.v[entry] - large.v[place]).abs();
            worst = worst.max(u).max(v);
        }
    }
    draw(case.context, &cloud, &small)?;
    let share = |energy: &f64| energy / small[0].1;
    let (t, shares): (Vec<f64>, Vec<f64>) = small
        .iter()
        .map(|(state, energy)| (state.t, share(energy)))
        .unzip();
    Ok(Found::from([
        ("error", worst),
        ("points", points as f64),
        ("strip", cloud.len() as f64),
        ("left", share(&small[small.len() - 1].1)),
        ("kernels", seconds_kernels),
        ("megabytes", 1e-6 * memory as f64),
        ("run", seconds),
        ("larger", seconds_large),
    ])
    .curve("energy", &t, &shares))
}

/// Indices of the small body's entries in the large one.
fn inner_entries(large: &System, small: &PointCloud) -> Vec<usize> {
    let cloud = large.cloud();
    let place = |cloud: &PointCloud, i: usize| {
        [0, 1].map(|axis| (2.0 * cloud.axis(axis)[i]).round() as i64)
    };
    let numbers: HashMap<_, _> = (0..cloud.len()).map(|i| (place(cloud, i), i)).collect();
    let entry = |c: usize| {
        let numbers = &numbers;
        (0..small.len()).map(move |i| c * cloud.len() + numbers[&place(small, i)])
    };
    entry(0).chain(entry(1)).collect()
}

fn draw(
    context: &Context<'_>,
    cloud: &PointCloud,
    states: &[(State, f64)],
) -> Result<(), RunError> {
    let n = cloud.len();
    let positions: Vec<f64> = [0, 1]
        .iter()
        .flat_map(|&axis| cloud.axis(axis).to_vec())
        .collect();
    for (name, k) in [("strip-start.png", 0), ("strip-leaving.png", 10)] {
        let Some(path) = context.figure(name) else {
            return Ok(());
        };
        let state = &states[k].0;
        FieldPicture::new(2, &positions, &state.u[..n], CellSize::Uniform(1.0))
            .label("u_x", "")
            .without_units()
            .colours(ColourMap::Diverging)
            .range(-0.3, 0.3)
            .title(format!(
                "computed part of an infinite strip, periodic across, at t = {}",
                state.t
            ))
            .write(path)?;
    }
    Ok(())
}
