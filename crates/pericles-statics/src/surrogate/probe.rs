//! Stiffness of a body at each point from the energies of small displacements.

use pericles::System;
use pericles::archive::Entry;

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

/// Stiffness of a body at each own point, from which the springs of its surrogate follow.
#[derive(Debug, Clone)]
pub struct Stiffness {
    /// Σ W over all unit displacement gradients e_i ⊗ e_j, J/m³.
    pub(super) traces: Vec<f64>,
    pub(super) resistance: Resistance,
}

impl Stiffness {
    /// Determines the stiffness of a body in its present state.
    ///
    /// The energies are half the second differences about the undeformed body, so that stress in the undeformed body (thermal,
    /// or from inelastic strain) has no influence. Along periodic axes the linear field is replaced by a sine and a cosine of
    /// one period, whose energies add up to that of a uniform gradient. All processes must call it together.
    pub(super) fn of(system: &System, neighbours: &Neighbours) -> Self {
        let (n, d) = (system.points(), system.dimension());
        let cloud = system.cloud();
        let energies = Energies::new(system);
        let mut traces = vec![0.0; n];
        let mut u = vec![0.0; d * n];
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
                    energies.add(&mut u, &mut traces);
                }
            }
        }
        let is_free = d == 1 || neighbours.period.iter().any(Option::is_some);
        let resistance = if is_free || !resists_rotation(&energies, &traces) {
            Resistance::Stretch
        } else {
            Resistance::Difference
        };
        let scale = 1.0 / (STRAIN * STRAIN);
        traces.iter_mut().for_each(|w| *w *= scale);
        Self { traces, resistance }
    }
}

pericles::saved! {
    impl Checkpointed for Stiffness {
        traces: points("static/stiffness"),
        resistance: array("static/resistance"),
    }
}

impl Entry for Resistance {
    type Number = u8;

    fn count(&self) -> usize {
        1
    }

    fn append_to(&self, array: &mut Vec<u8>) {
        array.push(u8::from(*self == Self::Difference));
    }

    fn take_from<'a>(&mut self, array: &'a [u8]) -> &'a [u8] {
        *self = match array[0] {
            0 => Self::Stretch,
            _ => Self::Difference,
        };
        &array[1..]
    }
}

/// Energies of displacements without the parts of order 0 and 1.
struct Energies<'a> {
    system: &'a System,
    /// Energy density of the undeformed body, J/m³; `None` if it is zero everywhere, so that there is no part of order 1.
    at_rest: Option<Vec<f64>>,
}

impl<'a> Energies<'a> {
    fn new(system: &'a System) -> Self {
        let mut density = vec![0.0; system.points()];
        let rest = vec![0.0; system.dimension() * system.points()];
        system
            .operator()
            .add_energy_density(0.0, &rest, &mut density);
        let is_relaxed = system.domain().all(density.iter().all(|w| *w == 0.0));
        Self {
            system,
            at_rest: (!is_relaxed).then_some(density),
        }
    }

    /// Adds the energy densities of displacements, which may change their sign.
    fn add(&self, u: &mut [f64], out: &mut [f64]) {
        let forces = self.system.operator();
        let Some(at_rest) = &self.at_rest else {
            forces.add_energy_density(0.0, u, out);
            return;
        };
        let mut both = vec![0.0; out.len()];
        forces.add_energy_density(0.0, u, &mut both);
        u.iter_mut().for_each(|u| *u = -*u);
        forces.add_energy_density(0.0, u, &mut both);
        for ((out, both), rest) in out.iter_mut().zip(&both).zip(at_rest) {
            *out += 0.5 * both - rest;
        }
    }
}

/// Returns whether an infinitesimal rotation in the x–y plane has energy of leading order.
fn resists_rotation(energies: &Energies<'_>, traces: &[f64]) -> bool {
    let system = energies.system;
    let (n, cloud) = (system.points(), system.cloud());
    let mut u = vec![0.0; system.dimension() * n];
    for i in 0..n {
        u[i] = -STRAIN * cloud.axis(1)[i];
        u[n + i] = STRAIN * cloud.axis(0)[i];
    }
    let mut turned = vec![0.0; n];
    energies.add(&mut u, &mut turned);
    let sum = |energies: &[f64]| system.domain().sum(n, |i| energies[i] * cloud.volumes()[i]);
    /// Small rotations stretch objective bonds in second order only.
    const PART: f64 = 0.01;
    sum(&turned) > PART * sum(traces)
}
