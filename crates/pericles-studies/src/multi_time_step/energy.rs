//! Conservation of energy and momentum of a free plate by each scheme.

use pericles::Simulation;
use pericles_run::RunError;

use super::problem::{Method, Problem};
use crate::common::watch;
use crate::data::{Case, Found};

/// Results of a run of `steps` steps at ω dt = `omega`, or at half the deck's step: the largest relative change of
/// kinetic + elastic energy, sampled every `every` steps; the ratio of that in the second half to that in the
/// first; the relative change at the end; |change of momentum| over Σ |m v| and over |momentum|; and evaluations
/// per point and step.
pub(super) fn kept(case: &Case<'_>) -> Result<Found, RunError> {
    let (steps, every) = (case.count("steps")? as u64, case.count("every")? as u64);
    let problem = Problem::of(case)?;
    let mut assembly = problem.assembly(Method::of(case, "method")?, &case.texts("choice")?)?;
    let frequency = assembly
        .frequency
        .map_or(f64::NAN, |frequency| frequency.estimate);
    assembly.dt = match case.optional("omega") {
        Some(omega) => omega / frequency,
        None => 0.5 * assembly.dt,
    };
    assembly.steps = steps;
    let momentum = assembly.system.momentum(&assembly.state.v);
    let mut run = assembly.simulation()?;
    let at_start = run.start_energy().energy;
    let evaluated = run.system().evaluated_points();
    let mut largest = [0.0f64; 2];
    let change = |run: &Simulation| {
        let energies = run.snapshot().energies();
        (energies.kinetic + energies.elastic) / at_start - 1.0
    };
    watch(&mut run, |run| {
        let step = run.state().step;
        if step.is_multiple_of(every) {
            let half = &mut largest[usize::from(2 * step > steps)];
            *half = half.max(change(run).abs());
        }
    })?;
    let (system, v) = (run.system(), &run.state().v);
    let n = system.points();
    let after = system.momentum(v);
    let size = |p: [f64; 3]| p.iter().map(|p| p.powi(2)).sum::<f64>().sqrt();
    let apart = size([0, 1, 2].map(|c| after[c] - momentum[c]));
    let all: f64 = (0..n)
        .map(|i| system.density().at(i) * system.cloud().volumes()[i] * v[i].hypot(v[n + i]))
        .sum();
    let evaluations = (system.evaluated_points() - evaluated) as f64;
    Ok([
        ("largest", largest[0].max(largest[1])),
        ("halves", largest[1] / largest[0]),
        ("last", change(&run)),
        ("momentum", apart / all),
        (
            "momentum over itself",
            apart / size([0, 1, 2].map(|c| momentum[c])),
        ),
        ("evaluations", evaluations / (n as u64 * steps) as f64),
    ]
    .into())
}
