//! Equilibrium of the forces in a static state.

use pericles::Simulation;
use pericles::observe::{Field, Snapshot};
use pericles::vector::cross;
use serde::Serialize;

/// Residual and resultants of the last static state.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct StaticBalance {
    /// Norm of the residual relative to that of loads or reactions, as measured by the tolerance of the scheme.
    pub residual: f64,
    /// Resultant of loads, reactions and impactors, N: zero at equilibrium.
    pub force: [f64; 3],
    /// Its magnitude relative to the sum of the magnitudes of all loads, reactions and contact forces, or to the norm of
    /// the forces to which the tolerance of the scheme refers, if this is larger: in a body that expands freely, or is
    /// severed, loads and reactions vanish.
    pub force_relative: f64,
    /// Moment of loads and reactions about the centre of the body, N m: zero at equilibrium.
    pub moment: [f64; 3],
    /// Its magnitude relative to the sum of the magnitudes of the moments of these forces, or to the same norm times the distance of
    /// the farthest point from the centre.
    pub moment_relative: f64,
}

impl StaticBalance {
    /// Evaluates the last state of a simulation; `None` unless its scheme is static.
    pub(crate) fn of(simulation: &Simulation) -> Option<Self> {
        let integrator = simulation.integrator();
        let inner = integrator.inner_iterations()?;
        if !integrator.is_static() {
            return None;
        }
        let snapshot = simulation.snapshot();
        let arms = arms(&snapshot);
        let forces = forces(&snapshot);
        let domain = simulation.system().domain();
        let n = arms.len();
        let total = |of: &(dyn Fn(usize) -> f64 + Sync)| domain.sum(n, of);
        let moments: Vec<[f64; 3]> = arms
            .iter()
            .zip(&forces)
            .map(|(x, f)| cross(*x, *f))
            .collect();
        let force = std::array::from_fn(|c| total(&|i| forces[i][c]));
        let moment = std::array::from_fn(|c| total(&|i| moments[i][c]));
        let relative = |resultant: &[f64; 3], sum: f64| match sum {
            0.0 => 0.0,
            sum => size(resultant) / sum,
        };
        let reference = match inner.change {
            0.0 => 0.0,
            change => unbalanced(&snapshot) / change,
        };
        let arm = domain.max(arms.iter().map(size).fold(0.0, f64::max));
        Some(Self {
            residual: inner.change,
            force_relative: relative(&force, total(&|i| size(&forces[i])).max(reference)),
            moment_relative: relative(&moment, total(&|i| size(&moments[i])).max(reference * arm)),
            force,
            moment,
        })
    }
}

/// Returns the positions of the points relative to their centre, m: deformed positions for nonlinear forces, reference
/// positions for linear ones.
fn arms(snapshot: &Snapshot<'_>) -> Vec<[f64; 3]> {
    let system = snapshot.system();
    let (n, cloud, u) = (system.points(), system.cloud(), &snapshot.state().u);
    let linear = system.operator().as_linear().is_some() && !system.has_interactions();
    let place = |i: usize| -> [f64; 3] {
        let mut place = cloud.point(i);
        if !linear {
            (0..system.dimension()).for_each(|c| place[c] += u[c * n + i]);
        }
        place
    };
    let points = system.domain().whole_points() as f64;
    let mean = |c: usize| system.domain().sum(n, |i| place(i)[c]) / points;
    let middle: [f64; 3] = std::array::from_fn(mean);
    (0..n)
        .map(|i| std::array::from_fn(|c| place(i)[c] - middle[c]))
        .collect()
}

/// Returns loads, reactions and forces of contact on each point, N.
fn forces(snapshot: &Snapshot<'_>) -> Vec<[f64; 3]> {
    let system = snapshot.system();
    let (n, volumes) = (system.points(), system.cloud().volumes());
    let [loads, reactions, contact] = [Field::ExternalForce, Field::Reaction, Field::ContactForce]
        .map(|field| snapshot.field(field));
    let of_point = |i: usize| {
        let mut force = [0.0; 3];
        for (c, force) in force.iter_mut().enumerate().take(system.dimension()) {
            let k = c * n + i;
            *force = volumes[i] * (loads[k] + reactions[k] + contact[k]);
        }
        force
    };
    (0..n).map(of_point).collect()
}

/// Returns the norm of the unbalanced forces, N.
fn unbalanced(snapshot: &Snapshot<'_>) -> f64 {
    let system = snapshot.system();
    let (n, volumes) = (system.points(), system.cloud().volumes());
    let [forces, reactions] = [Field::ForceDensity, Field::Reaction].map(|f| snapshot.field(f));
    let entries = system.dimension() * n;
    let square = |k: usize| (volumes[k % n] * (forces[k] + reactions[k])).powi(2);
    system.domain().sum(entries, square).sqrt()
}

fn size(vector: &[f64; 3]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}
