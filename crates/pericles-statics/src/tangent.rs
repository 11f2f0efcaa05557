//! Tangent stiffness of a body as a linear problem.

use pericles::System;
use pericles::domain::Replicated;
use pericles::parallel::for_each_chunk;

use crate::krylov::LinearProblem;
use crate::multigrid::Multigrid;
use crate::unknowns::Unknowns;

/// Derivative of the force of bonds that is the matrix of a linear problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Derivative {
    /// The tangent.
    Tangent,
    /// The derivative with constant damage.
    Secant,
}

/// Stiffness at a displacement, A = −V ∂f/∂u (N/m), preconditioned by multigrid of the surrogate.
pub struct Tangent<'a> {
    /// The derivative.
    pub of: Derivative,
    /// The body.
    pub system: &'a System,
    /// Times of bonds and of contact, s.
    pub times: [f64; 2],
    /// Displacement at which the force is linearised, m.
    pub u: &'a [f64],
    /// Makes vectors of the whole body.
    pub replicated: &'a Replicated,
    /// The free entries of the whole body.
    pub unknowns: &'a Unknowns,
    /// The preconditioner.
    pub multigrid: &'a mut Multigrid,
    /// Orthonormal rigid-body motions that are projected out of residuals and displacements.
    pub rigid: &'a [Vec<f64>],
    /// Two work vectors of unknowns.
    pub work: &'a mut [Vec<f64>; 2],
}

impl LinearProblem for Tangent<'_> {
    fn multiply_into(&mut self, x: &[f64], out: &mut [f64]) {
        stiffness_into(self.system, self.of, self.times, self.u, x, out);
    }

    fn precondition_into(&mut self, residual: &[f64], out: &mut [f64]) {
        let [right, solution] = &mut *self.work;
        // Every process applies the multigrid of the whole body.
        self.unknowns.gather(&self.replicated.of(residual), right);
        self.multigrid.apply_into(right, solution);
        let scatter = |whole: &mut [f64]| self.unknowns.scatter(solution, whole);
        let dimension = self.system.dimension();
        self.replicated.fill_own(dimension, out, scatter);
        remove(self.system, self.rigid, out);
    }
}

/// Computes `out` = −V ∂f/∂u x at displacement u, on all entries, with bonds at the first time and contact at the second
/// one.
pub fn stiffness_into(
    system: &System,
    of: Derivative,
    times: [f64; 2],
    u: &[f64],
    x: &[f64],
    out: &mut [f64],
) {
    match (system.operator().as_linear(), of) {
        (Some(linear), _) => linear.apply_into(x, out),
        (None, Derivative::Tangent) => system.operator().tangent_into(times[0], u, x, out),
        (None, Derivative::Secant) => system.operator().secant_into(times[0], u, x, out),
    }
    system.add_contact_tangent(times[1], u, x, out);
    let (n, volumes) = (system.points(), system.cloud().volumes());
    for_each_chunk(out, &|first, chunk| {
        for (k, out) in chunk.iter_mut().enumerate() {
            *out *= -volumes[(first + k) % n];
        }
    });
}

/// Removes the components along orthonormal vectors from a vector.
pub fn remove(system: &System, basis: &[Vec<f64>], vector: &mut [f64]) {
    for one in basis {
        let along = system.domain().dot(one, vector);
        crate::sparse::add_multiple(vector, -along, one);
    }
}
