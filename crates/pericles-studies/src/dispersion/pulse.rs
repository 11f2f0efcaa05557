//! Ring-shaped pulse that travels fifty wavelengths, compared with the exact solution of the continuum.
//!
//! The box is periodic, and so is the exact solution: every wave vector of the initial field oscillates with V_p
//! |k|. The wavelengths of the pulse are about eight spacings.

use std::f64::consts::TAU;
use std::sync::Arc;

use pericles::material::StressState;
use pericles::time::{State, VelocityVerlet};
use pericles::{PointScalar, Simulation, System};
use pericles_dispersion::spectrum::{Complex64, CubeTransform, PeriodicForce};
use pericles_dispersion::tuning::{Tuning, Weights, continuum_speeds};
use pericles_dispersion::{BondLattice, verlet_frequency};
use pericles_run::RunError;

use super::models::model;
use crate::common::{cells, finish};
use crate::data::{Case, Found};

/// Points along an axis.
const NODES: usize = 64;
/// Wavelength at the centre of the pulse's spectrum, spacings.
const WAVELENGTH: f64 = 8.0;
/// Relative width of the spectrum.
const WIDTH: f64 = 0.2;
const WAVELENGTHS: f64 = 50.0;
/// Time step in units of spacing over pressure wave speed; small, so that the error is that of the lattice.
const DT: f64 = 0.05;

/// Error of a table for the pulse, if it is stable: of the run, and by the plane waves of the lattice; and its ratio to
/// the error of α = 1.
pub(super) fn pulse(case: &Case<'_>) -> Result<Found, RunError> {
    let model = model(StressState::PlaneStrain, 3.0)?;
    let error = |tuning: Option<Tuning>| -> Result<Option<[f64; 2]>, RunError> {
        let alpha = match tuning {
            Some(tuning) => model.tune(tuning)?.alpha,
            None => vec![1.0; model.classes().len()],
        };
        let stable = model.assess(&alpha)?.stability.is_stable();
        let lattice = model.lattice(&alpha);
        stable
            .then(|| Ok([cross(&lattice)?, by_waves(&lattice)]))
            .transpose()
    };
    let original = *case.once("original".into(), || error(None))?;
    let tuning = case.flag("tuned").then(|| -> Tuning {
        Tuning {
            weights: Weights {
                decay: case.optional("decay"),
                ..Default::default()
            },
            lower_bound: case.optional("lower_bound"),
            ..Default::default()
        }
    });
    let found = match tuning {
        Some(tuning) => error(Some(tuning))?,
        None => original,
    };
    let verdict = found.map_or("UNSTABLE", |_| "stable");
    let over = found
        .zip(original)
        .map(|(found, original)| found[0] / original[0]);
    Ok(Found::default()
        .value("value", found.map(|found| found[0]))
        .value("waves", found.map(|found| found[1]))
        .value("over", over)
        .text("verdict", verdict))
}

/// Number and length of the time steps.
fn steps(speed: f64) -> (usize, f64) {
    let end = WAVELENGTHS * WAVELENGTH / speed;
    let steps = (end / DT).ceil();
    (steps as usize, end / steps)
}

/// Signed wavenumber of an entry along an axis.
fn wave(m: usize) -> f64 {
    let signed = match 2 * m > NODES {
        true => m as f64 - NODES as f64,
        false => m as f64,
    };
    TAU * signed / NODES as f64
}

/// Amplitude of the pulse at a wavenumber; negligible at the zone border.
fn amplitude(k: f64) -> f64 {
    let middle = TAU / WAVELENGTH;
    (-((k - middle) / (WIDTH * middle)).powi(2)).exp()
}

/// The error that [`cross`] measures, from the frequencies and polarisations of the lattice's plane waves: each wave
/// vector is a sum of modes that oscillate with the numerical frequency of velocity Verlet.
fn by_waves(lattice: &BondLattice) -> f64 {
    let speed = continuum_speeds(StressState::PlaneStrain).pressure;
    let (steps, dt) = steps(speed);
    let end = steps as f64 * dt;
    let (mut miss, mut exact) = (0.0, 0.0);
    for entry in 0..NODES * NODES {
        let k = [wave(entry % NODES), wave(entry / NODES), 0.0];
        let size = k[0].hypot(k[1]);
        if size == 0.0 {
            continue;
        }
        let direction = k.map(|x| x / size);
        let mut u = [0.0; 3];
        for mode in lattice.modes(k) {
            let share: f64 = (0..2).map(|c| mode.polarisation[c] * direction[c]).sum();
            let turn = verlet_frequency(mode.omega(), dt).map_or(f64::NAN, |omega| omega * end);
            for (u, p) in u.iter_mut().zip(mode.polarisation) {
                *u += share * turn.cos() * p;
            }
        }
        let should = (speed * size * end).cos();
        let square = amplitude(size).powi(2);
        exact += square * should * should;
        miss += square
            * (0..2)
                .map(|c| (u[c] - should * direction[c]).powi(2))
                .sum::<f64>();
    }
    (miss / exact).sqrt()
}

/// Root mean square error of the displacement relative to the displacement.
fn cross(lattice: &BondLattice) -> Result<f64, RunError> {
    let speed = continuum_speeds(StressState::PlaneStrain).pressure;
    let (steps, dt) = steps(speed);
    let end = steps as f64 * dt;
    let cloud = Arc::new(cells([0.0; 3], vec![NODES as f64; 2], 1.0)?);
    let force = PeriodicForce::new(lattice, NODES, 1.0, 1.0)?;
    let system = System::new(
        Arc::clone(&cloud),
        Box::new(force),
        PointScalar::Uniform(1.0),
    )?;
    let mut state = State::at_rest(2 * cloud.len());
    state.u = continuum(0.0, speed);
    let mut simulation =
        Simulation::new(system, Box::new(VelocityVerlet), state, dt, steps as u64)?;
    finish(&mut simulation)?;
    let exact = continuum(end, speed);
    let square = |values: &mut dyn Iterator<Item = f64>| values.map(|x| x * x).sum::<f64>();
    let pairs = simulation.state().u.iter().zip(&exact);
    let miss = square(&mut pairs.map(|(u, v)| u - v));
    Ok((miss / square(&mut exact.iter().copied())).sqrt())
}

/// u(t) = Σ_k i k/|k| φ(|k|) cos(V_p |k| t) exp(i k·x), with φ a bell function around 2π over the wavelength;
/// component-major.
fn continuum(t: f64, speed: f64) -> Vec<f64> {
    let mut transform = CubeTransform::new(NODES, 2);
    let mut u = Vec::with_capacity(2 * NODES * NODES);
    for component in 0..2 {
        let mut field: Vec<Complex64> = (0..NODES * NODES)
            .map(|entry| {
                let k = [wave(entry % NODES), wave(entry / NODES)];
                let size = k[0].hypot(k[1]);
                if size == 0.0 {
                    return Complex64::new(0.0, 0.0);
                }
                let cosine = (speed * size * t).cos();
                Complex64::new(0.0, k[component] / size * amplitude(size) * cosine)
            })
            .collect();
        transform.inverse(&mut field);
        u.extend(field.iter().map(|z| z.re));
    }
    u
}
