//! Conservation of energy and momentum of a free plate by each scheme.

use pericles::Simulation;
use pericles_run::RunError;

use super::problem::{Method, Problem};
use crate::common::watch;
use crate::data::{Case, Found};

/// Results of a run of `steps` steps at ω dt = `omega`, or at half the deck's step: the largest relative change of
/// kinetic + elastic energy, sampled every `every` steps; the ratio of that in the second half to that in the first;
/// the relative change at the end; |change of momentum| over Σ |m v| and over |momentum|; and evaluations per point and
/// step, counted and by the model of the scheme's cost.
pub(super) fn kept(case: &Case<'_>) -> Result<Found, RunError> {
    let run = Kept::of(case, case.optional("omega"), case.count("steps")? as u64)?;
    Ok([
        ("largest", run.largest[0].max(run.largest[1])),
        ("halves", run.largest[1] / run.largest[0]),
        ("momentum", run.momentum),
        ("momentum over itself", run.momentum_over_itself),
        ("evaluations", run.evaluations),
        ("model", run.model),
    ]
    .into())
}

/// Orders in the step of the change of energy at the end, of its largest change and of the momentum error over a given
/// time, from twice the step ω dt = `omega` to it.
pub(super) fn orders(case: &Case<'_>) -> Result<Found, RunError> {
    let (omega, steps) = (case.number("omega")?, case.count("steps")? as u64);
    let coarse = Kept::of(case, Some(2.0 * omega), steps / 2)?;
    let fine = Kept::of(case, Some(omega), steps)?;
    let order = |of: fn(&Kept) -> f64| (of(&coarse) / of(&fine)).log2();
    Ok([
        ("loss", order(|run| run.last)),
        ("largest", order(|run| run.largest[0].max(run.largest[1]))),
        ("momentum", order(|run| run.momentum)),
        ("change", fine.last),
        ("error", fine.momentum),
    ]
    .into())
}

/// What a run kept of its energy and momentum.
struct Kept {
    /// Largest relative change of energy in the first and in the second half.
    largest: [f64; 2],
    /// Relative change of energy at the end.
    last: f64,
    /// |Change of momentum| over Σ |m v|.
    momentum: f64,
    /// |Change of momentum| over |momentum|.
    momentum_over_itself: f64,
    /// Evaluations per point and step.
    evaluations: f64,
    /// Evaluations by the model of the scheme's cost.
    model: f64,
}

impl Kept {
    fn of(case: &Case<'_>, omega: Option<f64>, steps: u64) -> Result<Self, RunError> {
        let every = case.count("every")? as u64;
        let method = Method::of(case, "method")?;
        let mut assembly = Problem::of(case)?.assembly(method, &case.texts("choice")?)?;
        let frequency = assembly
            .frequency
            .map_or(f64::NAN, |frequency| frequency.estimate);
        assembly.dt = match omega {
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
        let report = run.integrator().refinement();
        Ok(Self {
            largest,
            last: change(&run),
            momentum: apart / all,
            momentum_over_itself: apart / size([0, 1, 2].map(|c| momentum[c])),
            evaluations: evaluations / (n as u64 * steps) as f64,
            model: report.map_or(f64::from(method.stages()), |report| report.evaluations()),
        })
    }
}
