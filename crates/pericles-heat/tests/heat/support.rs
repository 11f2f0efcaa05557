//! Bodies and fields for tests.

use std::sync::Arc;

use pericles::PointScalar;
use pericles::family::VolumeCorrection;
use pericles::kernel::Influence;
use pericles::space::{Grid, PointCloud};
use pericles_heat::{Condition, Diffusion, DiffusionBody, Interface, Kind, Value};

pub fn body(cloud: Arc<PointCloud>, horizon: f64, k: f64) -> DiffusionBody {
    DiffusionBody {
        cloud,
        influence: Influence::default(),
        horizon,
        horizons: None,
        correction: VolumeCorrection::Extended,
        conductivity: PointScalar::Uniform(k),
        interface: Interface::Harmonic,
        surface_correction: false,
        prescribed: Vec::new(),
        broken_share: 0.0,
    }
}

pub fn box_of(dimension: usize, cells: usize, dx: f64) -> Arc<PointCloud> {
    let side = cells as f64 * dx;
    let grid = match dimension {
        1 => Grid::bar(side, dx, 2e-4),
        2 => Grid::plate([side, side], dx, 3e-3),
        _ => Grid::block([side; 3], dx),
    };
    Arc::new(grid.points().unwrap())
}

pub fn periodic(dimension: usize, cells: usize, dx: f64) -> Arc<PointCloud> {
    let cloud = Arc::try_unwrap(box_of(dimension, cells, dx)).unwrap();
    Arc::new(cloud.with_periodic_faces().unwrap())
}

/// Values without a pattern.
pub fn noise(n: usize) -> Vec<f64> {
    (0..n)
        .map(|i| 300.0 + 40.0 * (1.7 * i as f64).sin() + 3.0 * (0.01 * (i * i) as f64).cos())
        .collect()
}

pub fn flow(diffusion: &Diffusion, values: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; values.len()];
    diffusion.add_flow(values, &mut out);
    out
}

pub fn number(value: f64) -> Value {
    Arc::new(move |_, _| value)
}

pub fn prescribed(name: &str, points: Vec<u32>, value: f64) -> Condition {
    Condition {
        name: name.into(),
        points,
        kind: Kind::Prescribed(number(value)),
    }
}

pub fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

pub fn largest(a: &[f64]) -> f64 {
    a.iter().fold(0.0, |most, a| most.max(a.abs()))
}
