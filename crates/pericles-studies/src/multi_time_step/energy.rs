//! Energy and momentum of a free plate: what each scheme keeps.
//!
//! All modes are excited, so that the damping of short waves by Runge–Kutta methods shows: per step 1 − z⁴/24 (order three) and 1 − z⁶/144 (order four) at z = ω dt.

use pericles::Control;
use pericles_run::Assembly;
use pericles_run::RunError;

use super::problem::{Method, PAPER, Problem, problem};
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(crate) const STUDY: Study = Study {
    id: "multi-time-step/energy",
    paper: PAPER,
    title: "Energy and momentum of a free plate",
    run,
};

fn plate() -> Problem {
    problem!("free.toml", |assembly: &mut Assembly| {
        for (k, v) in assembly.state.v.iter_mut().enumerate() {
            *v = 1.0 + 10.0 * ((k * k) as f64).sin();
        }
    })
}

/// What a run did to the energy and the momentum.
struct Kept {
    /// The largest relative change of kinetic + elastic energy in the first and in the second half.
    largest: [f64; 2],
    /// The relative change at the end.
    last: f64,
    /// |change of momentum| over Σ |m v|.
    momentum: f64,
    /// Evaluations per point and step.
    evaluations: f64,
}

fn keep(method: Method, omega_dt: f64, steps: u64, changes: &[String]) -> Result<Kept, RunError> {
    let mut assembly = plate().assembly(method, changes)?;
    let omega = assembly
        .frequency
        .map_or(f64::NAN, |frequency| frequency.estimate);
    assembly.dt = omega_dt / omega;
    assembly.steps = steps;
    let momentum = assembly.system.momentum(&assembly.state.v);
    let mut run = assembly.simulation()?;
    let at_start = run.start_energy().energy;
    let evaluated = run.system().evaluated_points();
    let mut largest = [0.0f64; 2];
    let change = |run: &pericles::Simulation| {
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
    Ok(Kept {
        largest,
        last: change(&run),
        momentum: apart.sqrt() / all,
        evaluations: (system.evaluated_points() - evaluated) as f64 / (n as u64 * steps) as f64,
    })
}

fn run(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    const STEPS: u64 = 3000;
    let mut rows = Vec::new();
    for method in [Method::Verlet, Method::Respa(4)] {
        for omega_dt in [1.0, 0.5] {
            let kept = keep(method, omega_dt, STEPS, &[])?;
            rows.extend(bounded(method, omega_dt, &kept));
        }
    }
    if context.full {
        let (method, steps) = (Method::Respa(4), 100_000);
        let kept = keep(method, 1.0, steps, &[])?;
        let mut long = bounded(method, 1.0, &kept);
        for row in &mut long {
            row.case += &format!(", {steps} steps");
        }
        rows.extend(long);
    }
    let backward = ["time.predictor=backward-difference".to_owned()];
    let mut damped = vec![
        (Method::Uniform(4), &[][..]),
        (Method::Two(4, 4), &[]),
        (Method::Two(3, 4), &[]),
    ];
    if context.full {
        damped.push((Method::Uniform(3), &[]));
        damped.push((Method::Two(4, 4), &backward[..]));
    }
    for (method, changes) in damped {
        let what = match changes {
            [] => String::new(),
            _ => ", backward differences".into(),
        };
        let steps: &[f64] = if context.full { &[1.0, 0.5] } else { &[1.0] };
        for &omega_dt in steps {
            let kept = keep(method, omega_dt, STEPS, changes)?;
            let case =
                |what_of: &str| format!("{}{what}, ω dt = {omega_dt}: {what_of}", method.name());
            rows.push(Row::new(
                case("change of energy over 3000 steps"),
                "",
                Some(kept.last),
            ));
            let error = Row::new(case("momentum error over Σ|mv|"), "", Some(kept.momentum));
            rows.push(match method {
                Method::Uniform(_) => error.within(0.0, 1e-13),
                _ => error.note("the interface conserves momentum to the order of the method only"),
            });
            if omega_dt == 1.0 {
                rows.push(Row::new(
                    case("evaluations per point and step"),
                    "",
                    Some(kept.evaluations),
                ));
            }
        }
    }
    Ok(rows)
}

/// Rows of a scheme that keeps energy within bounds.
fn bounded(method: Method, omega_dt: f64, kept: &Kept) -> Vec<Row> {
    let case = |what: &str| format!("{}, ω dt = {omega_dt}: {what}", method.name());
    vec![
        Row::new(
            case("largest change of energy"),
            "",
            Some(kept.largest[0].max(kept.largest[1])),
        )
        // Velocity Verlet keeps E − (ω dt)²/4 · (elastic energy) of every mode.
        .within(0.0, 0.25 * omega_dt * omega_dt),
        Row::new(
            case("largest change in the second half over that in the first"),
            "",
            Some(kept.largest[1] / kept.largest[0]),
        )
        // No growth; it starts with all energy kinetic, which is the worst.
        .within(0.55, 0.55),
        Row::new(case("momentum error over Σ|mv|"), "", Some(kept.momentum)).within(0.0, 1e-13),
        Row::new(
            case("evaluations per point and step"),
            "",
            Some(kept.evaluations),
        ),
    ]
}
