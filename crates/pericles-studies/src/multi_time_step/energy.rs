//! Energy and momentum of a free plate: what each scheme keeps.

use pericles::{Control, Simulation};
use pericles_run::RunError;

use super::problem::{Method, Problem};
use crate::data::{Case, Found};

/// What a run of so many `steps` at ω dt = `omega` does: the largest relative change of kinetic + elastic energy, that in the second half over that in the first, the relative change at the end, |change of
/// momentum| over Σ |m v|, and evaluations per point and step.
pub(super) fn kept(case: &Case<'_>) -> Result<Found, RunError> {
    let steps = case.count("steps")? as u64;
    let problem = Problem::of(case)?;
    let mut assembly = problem.assembly(Method::of(case, "method")?, &case.texts("choice")?)?;
    let frequency = assembly.frequency;
    assembly.dt =
        case.number("omega")? / frequency.map_or(f64::NAN, |frequency| frequency.estimate);
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
    run.run(|run| {
        let step = run.state().step;
        if step.is_multiple_of(steps.div_ceil(1500)) {
            let half = &mut largest[usize::from(2 * step > steps)];
            *half = half.max(change(run).abs());
        }
        Control::Continue
    })
    .map_err(|error| RunError::of_run(error, || "the study stopped there".into()))?;
    let (system, v) = (run.system(), &run.state().v);
    let n = system.points();
    let after = system.momentum(v);
    let apart: f64 = (0..3).map(|c| (after[c] - momentum[c]).powi(2)).sum();
    let all: f64 = (0..n)
        .map(|i| system.density().at(i) * system.cloud().volumes()[i] * v[i].hypot(v[n + i]))
        .sum();
    let evaluations = (system.evaluated_points() - evaluated) as f64;
    Ok([
        ("largest", largest[0].max(largest[1])),
        ("halves", largest[1] / largest[0]),
        ("last", change(&run)),
        ("momentum", apart.sqrt() / all),
        ("evaluations", evaluations / (n as u64 * steps) as f64),
    ]
    .into())
}
