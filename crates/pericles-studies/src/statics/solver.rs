//! Cost of a static state: products and seconds, with and without the preconditioner, and by adaptive dynamic
//! relaxation.

use std::rc::Rc;
use std::time::Instant;

use pericles::operator::PointSubset;
use pericles::time::{Relaxation, RelaxationOptions, State};
use pericles::{Interrupt, Simulation, System};
use pericles_run::RunError;
use pericles_statics::krylov::{Goal, KrylovWork, LinearProblem, conjugate_gradients};
use pericles_statics::{Effort as Took, Equilibrium, StaticOptions, Target};

use super::bodies::{body, stretched};
use crate::common::finish;
use crate::data::{Case, Found};

/// Residual relative to loads or reactions at which a state counts as static.
const TOLERANCE: f64 = 1e-6;

/// Products and seconds of a static state by multigrid-preconditioned conjugate gradients.
struct Effort {
    products: f64,
    seconds: f64,
    points: f64,
}

/// Cost for the body of the case, computed once.
fn effort(case: &Case<'_>) -> Result<Rc<Effort>, RunError> {
    let (name, nu) = (case.text("body")?, case.number("nu")?);
    let (cells, cracked) = (case.count("cells")?, case.flag("cracked"));
    let key = format!("{name} {cells} {nu} {cracked}");
    case.once(key, || {
        let system = body(case)?;
        let began = Instant::now();
        let (found, _) = state_of(&system)?;
        Ok(Effort {
            products: found.products as f64,
            seconds: began.elapsed().as_secs_f64(),
            points: system.points() as f64,
        })
    })
}

/// Computes the static state from rest; returns its cost and the displacement.
pub(super) fn state_of(system: &System) -> Result<(Took, Vec<f64>), RunError> {
    let (free, load) = conditions(system);
    let options = StaticOptions {
        tolerance: TOLERANCE,
        ..StaticOptions::default()
    };
    let mut u = vec![0.0; load.len()];
    let mut supports = u.clone();
    system.place_on(0.0, &PointSubset::All, &mut supports);
    let target = Target {
        place: 0.0,
        t: 0.0,
        load: &load,
        supports: &supports,
        largest: 0.0,
        tolerance: TOLERANCE,
    };
    let mut solver = Equilibrium::new(options, system, free);
    let took = solver.find(system, &target, &mut u, Interrupt::never())?;
    Ok((took, u))
}

/// Products, Newton iterations, reaction and energy of the plate stretched by 5 %.
pub(super) fn newton(case: &Case<'_>) -> Result<Found, RunError> {
    let system = stretched(case.count("cells")?)?;
    let (took, u) = state_of(&system)?;
    let (n, volumes) = (system.points(), system.cloud().volumes());
    let mut force = vec![0.0; u.len()];
    system
        .operator()
        .add_force(0.0, &u, PointSubset::All, &mut force);
    let grip = system.motions()[1].points.iter();
    let reaction: f64 = grip
        .map(|&i| -volumes[i as usize] * force[n + i as usize])
        .sum();
    Ok([
        ("products", took.products as f64),
        ("steps", took.newton as f64),
        ("reaction", reaction),
        ("energy", system.operator().energy(0.0, &u)),
    ]
    .into())
}

/// 1 on free entries and 0 on constrained ones, and the loads (N/m³).
fn conditions(system: &System) -> (Vec<f64>, Vec<f64>) {
    let entries = system.dimension() * system.points();
    let (mut free, mut load) = (vec![1.0; entries], vec![0.0; entries]);
    system.hold_at(0.0, &mut free);
    system.load_density_into(0.0, &mut load);
    (free, load)
}

/// Products to a residual of 1e-6.
pub(super) fn products(case: &Case<'_>) -> Result<Found, RunError> {
    let effort = effort(case)?;
    Ok([("value", effort.products), ("points", effort.points)].into())
}

/// Seconds of multigrid including its set-up, of plain conjugate gradients and of adaptive dynamic relaxation, and
/// the products of each.
pub(super) fn times(case: &Case<'_>) -> Result<Found, RunError> {
    let multigrid = effort(case)?;
    let system = body(case)?;
    let (plain_products, plain_seconds) = plain(&system)?;
    let (evaluations, relaxation_seconds) = relaxed(system)?;
    Ok([
        ("plain", plain_products),
        ("evaluations", evaluations),
        ("relaxation", evaluations / multigrid.products),
        ("seconds", multigrid.seconds),
        ("plain-seconds", plain_seconds),
        ("relaxation-seconds", relaxation_seconds),
    ]
    .into())
}

/// Stiffness without a preconditioner.
struct Plain<'a> {
    system: &'a System,
    free: &'a [f64],
}

impl LinearProblem for Plain<'_> {
    fn multiply_into(&mut self, x: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.system
            .operator()
            .add_force(0.0, x, PointSubset::All, out);
        let (n, volumes) = (self.system.points(), self.system.cloud().volumes());
        for (k, out) in out.iter_mut().enumerate() {
            *out *= -volumes[k % n];
        }
    }

    fn precondition_into(&mut self, residual: &[f64], out: &mut [f64]) {
        for ((out, residual), free) in out.iter_mut().zip(residual).zip(self.free) {
            *out = residual * free;
        }
    }
}

/// Products and seconds of plain conjugate gradients; supports are at rest.
fn plain(system: &System) -> Result<(f64, f64), RunError> {
    let began = Instant::now();
    let (free, load) = conditions(system);
    let (n, volumes) = (system.points(), system.cloud().volumes());
    let force = |k: usize| volumes[k % n] * load[k];
    let mut residual: Vec<f64> = (0..load.len()).map(force).collect();
    let acting: f64 = residual.iter().map(|f| f * f).sum();
    let mut solution = vec![0.0; load.len()];
    let mut problem = Plain {
        system,
        free: &free,
    };
    let goal = Goal {
        absolute: 0.0,
        relative: TOLERANCE,
        acting: acting.sqrt(),
        products: 1_000_000,
        interrupt: Interrupt::never(),
    };
    let solved = conjugate_gradients(
        &mut problem,
        (system.domain(), &free),
        &mut residual,
        &mut solution,
        &goal,
        &mut KrylovWork::new(load.len()),
    )?;
    Ok((solved.products as f64, began.elapsed().as_secs_f64()))
}

/// Force evaluations and seconds of adaptive dynamic relaxation.
fn relaxed(system: System) -> Result<(f64, f64), RunError> {
    let began = Instant::now();
    let options = RelaxationOptions {
        tolerance: TOLERANCE,
        ..RelaxationOptions::default()
    };
    let scheme = Relaxation::new(options, &system)?;
    let state = State::of(&system);
    let mut run = Simulation::new(system, Box::new(scheme), state, 1.0, 1)?;
    finish(&mut run)?;
    let inner = run.integrator().inner_iterations().unwrap_or_default();
    Ok((inner.total as f64, began.elapsed().as_secs_f64()))
}
