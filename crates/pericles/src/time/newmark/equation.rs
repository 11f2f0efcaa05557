//! The equation of an implicit step in the form required by the solver.

use crate::domain::Domain;
use crate::operator::PointSubset;
use crate::parallel::for_each_chunk;
use crate::solve::Nonlinear;
use crate::system::System;
use crate::time::ends;

/// The equation u − known − θ (f̄(u)/ρ + g) + φ P (u − base) = 0. f̄ = Σ weight · f(base + node · (u − base)) is
/// the mean force on the segment from the base, g the acceleration by boundaries at the middle of the step, and P
/// the projection on rigid translations that is orthogonal with respect to the masses.
///
/// The unknowns are y = √m u, and the residual is scaled in the same way. The derivative is then 1 − θ M^(−1/2) T
/// M^(−1/2) + φ P, which is symmetric, and positive definite where the tangent T is negative semi-definite.
pub(super) struct StepEquation<'a> {
    pub(super) system: &'a System,
    pub(super) t: f64,
    /// √m per unknown.
    pub(super) root_mass: &'a [f64],
    pub(super) known: &'a [f64],
    pub(super) theta: f64,
    /// Displacement at the start of the step.
    pub(super) base: &'a [f64],
    /// Positions between base and end, 0 to 1, with weights that add up to one.
    pub(super) nodes: &'a [(f64, f64)],
    /// Factor φ.
    pub(super) pull: f64,
    /// Whether boundaries act.
    pub(super) with_boundaries: bool,
    /// Displacement, direction, force, and the displacement and tangent of a node.
    pub(super) work: &'a mut [Vec<f64>; 5],
}

impl StepEquation<'_> {
    /// Computes √m (x − θ f/ρ + φ P (x − base) − known) with the force in `work[2]`; for a direction (`affine`
    /// false) without known and base.
    fn scale_into(&self, x: &[f64], affine: bool, out: &mut [f64]) {
        let n = self.system.points();
        let force = &self.work[2];
        let known = |k: usize| if affine { self.known[k] } else { 0.0 };
        let (phi, base) = (self.pull, self.base);
        let from = |k: usize| if affine { x[k] - base[k] } else { x[k] };
        let mean: [f64; 3] = std::array::from_fn(|c| {
            if phi == 0.0 || c >= self.system.dimension() {
                return 0.0;
            }
            centre(self.system.domain(), self.root_mass, c, n, &from)
        });
        let density = self.system.density();
        for_each_chunk(out, &|first, out| {
            for (i, out) in out.iter_mut().enumerate() {
                let k = first + i;
                let pull = if phi == 0.0 {
                    0.0
                } else {
                    phi * (from(k) - mean[k / n])
                };
                let acceleration = force[k] / density.at(k % n);
                *out = self.root_mass[k] * (x[k] - known(k) - self.theta * acceleration + pull);
            }
        });
        self.system.hold_at(self.t, out);
    }

    /// Adds −√m θ g at the displacement in `work[0]`, or its derivative in the direction in `work[1]`.
    fn add_boundaries(&mut self, of_direction: bool, out: &mut [f64]) {
        if !self.with_boundaries {
            return;
        }
        let [u, direction, _, middle, given] = &mut *self.work;
        given.fill(0.0);
        let factor = if of_direction {
            ends::add_stiffness(self.system, direction, given);
            0.5 * self.theta
        } else {
            between(self.base, u, 0.5, middle);
            ends::add_middle(self.system, middle, given);
            -self.theta
        };
        for ((out, given), root_mass) in out.iter_mut().zip(&*given).zip(self.root_mass) {
            *out += factor * root_mass * given;
        }
        self.system.hold_at(self.t, out);
    }

    fn unscale(&mut self, y: &[f64], slot: usize) {
        let root_mass = self.root_mass;
        for_each_chunk(&mut self.work[slot], &|first, x| {
            for ((x, y), root_mass) in x.iter_mut().zip(&y[first..]).zip(&root_mass[first..]) {
                *x = y / root_mass;
            }
        });
    }
}

/// Returns the mass-weighted mean of component c.
pub(super) fn centre(
    domain: &Domain,
    root_mass: &[f64],
    c: usize,
    n: usize,
    x: &(impl Fn(usize) -> f64 + Sync),
) -> f64 {
    let mass = |i: usize| root_mass[c * n + i].powi(2);
    domain.sum(n, |i| mass(i) * x(c * n + i)) / domain.sum(n, mass)
}

impl StepEquation<'_> {
    /// Stores the displacement of a scaled unknown in `work[0]`.
    pub(super) fn displace(&mut self, y: &[f64]) {
        self.unscale(y, 0);
    }

    /// Computes f̄ at the displacement in `work[0]` into `work[2]`.
    pub(super) fn mean_force(&mut self) {
        let [u, _, mean, at_node, force] = &mut *self.work;
        mean.fill(0.0);
        for &(node, weight) in self.nodes {
            between(self.base, u, node, at_node);
            force.fill(0.0);
            self.system
                .add_internal_force(self.t, at_node, &PointSubset::All, force);
            add(weight, force, mean);
        }
    }

    /// Computes the derivative of f̄ in the direction in `work[1]` into `work[2]`.
    fn mean_tangent(&mut self) {
        let [u, direction, mean, at_node, tangent] = &mut *self.work;
        mean.fill(0.0);
        for &(node, weight) in self.nodes {
            between(self.base, u, node, at_node);
            self.system
                .internal_tangent_into(self.t, at_node, direction, tangent);
            add(weight * node, tangent, mean);
        }
    }
}

fn between(from: &[f64], to: &[f64], node: f64, out: &mut [f64]) {
    if node == 1.0 {
        return out.copy_from_slice(to);
    }
    for ((out, from), to) in out.iter_mut().zip(from).zip(to) {
        *out = from + node * (to - from);
    }
}

fn add(factor: f64, x: &[f64], out: &mut [f64]) {
    for (out, x) in out.iter_mut().zip(x) {
        *out += factor * x;
    }
}

impl Nonlinear for StepEquation<'_> {
    fn residual_into(&mut self, y: &[f64], out: &mut [f64]) {
        self.unscale(y, 0);
        self.mean_force();
        self.scale_into(&self.work[0], true, out);
        self.add_boundaries(false, out);
    }

    fn rounding_into(&mut self, y: &[f64], out: &mut [f64]) {
        self.unscale(y, 0);
        ends::rounding_into(self.system, &self.work[0], out);
        for (error, root_mass) in out.iter_mut().zip(self.root_mass) {
            *error *= root_mass;
        }
        self.system.hold_at(self.t, out);
    }

    fn derivative_into(&mut self, y: &[f64], direction: &[f64], out: &mut [f64]) {
        self.unscale(y, 0);
        self.unscale(direction, 1);
        self.mean_tangent();
        self.scale_into(&self.work[1], false, out);
        self.add_boundaries(true, out);
    }
}

/// Returns √m of every unknown.
pub(super) fn root_masses(system: &System) -> Vec<f64> {
    let n = system.points();
    let mass = |i: usize| system.density().at(i) * system.cloud().volumes()[i];
    (0..system.dimension() * n)
        .map(|k| mass(k % n).sqrt())
        .collect()
}
