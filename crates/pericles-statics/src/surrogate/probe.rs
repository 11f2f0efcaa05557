//! Stiffness of a body at each point from the energies of small displacements.

use pericles::System;

use super::bonds::Neighbours;

/// Deformation that bonds resist.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Resistance {
    /// Changes of distance: bonds of solids.
    Stretch,
    /// All relative displacements: bonds of surfaces.
    Difference,
}

/// Size of the applied displacement gradients.
const STRAIN: f64 = 1e-4;

/// Returns Σ W over all unit displacement gradients e_i ⊗ e_j, J/m³, for each point, and the deformations
/// that bonds resist.
///
/// Along periodic axes the linear field is replaced by a sine and a cosine of one period, whose energies add
/// up to that of a uniform gradient.
pub(super) fn energies(system: &System, neighbours: &Neighbours) -> (Vec<f64>, Resistance) {
    let (n, d) = (system.points(), system.dimension());
    let cloud = system.cloud();
    let mut traces = vec![0.0; n];
    let mut u = vec![0.0; d * n];
    let add = |u: &[f64], out: &mut [f64]| system.operator().add_energy_density(0.0, u, out);
    for along in 0..d {
        let fields: Vec<Vec<f64>> = match neighbours.period[along] {
            None => vec![cloud.axis(along).to_vec()],
            Some(period) => {
                let k = std::f64::consts::TAU / period;
                let wave = |shift: f64| {
                    let places = cloud.axis(along).iter();
                    places.map(|x| (k * x + shift).sin() / k).collect()
                };
                vec![wave(0.0), wave(std::f64::consts::FRAC_PI_2)]
            }
        };
        for field in fields {
            for component in 0..d {
                u.fill(0.0);
                for (u, x) in u[component * n..(component + 1) * n].iter_mut().zip(&field) {
                    *u = STRAIN * x;
                }
                add(&u, &mut traces);
            }
        }
    }
    let is_free = d == 1 || neighbours.period.iter().any(Option::is_some);
    let resistance = if is_free || !resists_rotation(system, &traces) {
        Resistance::Stretch
    } else {
        Resistance::Difference
    };
    let scale = 1.0 / (STRAIN * STRAIN);
    traces.iter_mut().for_each(|w| *w *= scale);
    (traces, resistance)
}

/// Returns whether an infinitesimal rotation in the x–y plane has energy of leading order.
fn resists_rotation(system: &System, traces: &[f64]) -> bool {
    let (n, cloud) = (system.points(), system.cloud());
    let mut u = vec![0.0; system.dimension() * n];
    for i in 0..n {
        u[i] = -STRAIN * cloud.axis(1)[i];
        u[n + i] = STRAIN * cloud.axis(0)[i];
    }
    let mut energies = vec![0.0; n];
    system.operator().add_energy_density(0.0, &u, &mut energies);
    let sum = |energies: &[f64]| system.domain().sum(n, |i| energies[i] * cloud.volumes()[i]);
    /// Small rotations stretch objective bonds in second order only.
    const PART: f64 = 0.01;
    sum(&energies) > PART * sum(traces)
}
