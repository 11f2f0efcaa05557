//! A crack that runs: two time steps against the fine step everywhere.
//!
//! Before bonds break the orders are those of the method. Afterwards nobody can expect the same bonds: the check for breaking is of first order in the step, and halving the step of
//! one and the same scheme changes as much as the second step does. What must agree is how far the crack went and how much it broke.

use pericles::Simulation;
use pericles_run::RunError;

use super::problem::{Method, PAPER, Problem, problem, relative};
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(crate) const STUDY: Study = Study {
    id: "multi-time-step/crack",
    paper: PAPER,
    title: "A pre-cracked plate with two time steps, fixed and following the crack",
    run,
};

/// The horizon of the plate that fails, m.
const HORIZON: f64 = 3.015 * 0.625e-3;

/// Coarse steps to the end of the deck.
const STEPS: f64 = 128.0;
const END: f64 = 15e-6;

fn run(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let mut rows = pull()?;
    let ratios: &[u32] = if context.full { &[2, 4, 8] } else { &[4] };
    rows.extend(before_failure(ratios)?);
    for &ratio in ratios {
        rows.extend(failure(ratio)?);
    }
    Ok(rows)
}

/// Orders without failure.
fn pull() -> Result<Vec<Row>, RunError> {
    let problem = problem!("pull.toml");
    let exact = problem.run(Method::Uniform(4), 1120, &[])?;
    let mut rows = Vec::new();
    for (method, errors) in [
        (Method::Uniform(4), [2.25e-4, 1.43e-5, 8.96e-7]),
        (Method::Two(4, 4), [2.19e-4, 1.41e-5, 8.91e-7]),
        (Method::Two(3, 4), [1.44e-3, 2.07e-4, 2.64e-5]),
    ] {
        let mut found = Vec::new();
        for (steps, expected) in [35, 70, 140].into_iter().zip(errors) {
            let run = problem.run(method, steps, &[])?;
            let error = relative(&run.state().u, &exact.state().u);
            found.push(error);
            let case = format!("no failure, {}: relative error at T/{steps}", method.name());
            rows.push(Row::new(case, "", Some(error)).within_share(expected, 0.03));
        }
        let observed = (found[1] / found[2]).log2();
        let expected = (errors[1] / errors[2]).log2();
        let case = format!("no failure, {}: order of the last pair", method.name());
        rows.push(Row::new(case, "", Some(observed)).within(expected, 0.05));
    }
    Ok(rows)
}

fn plate() -> Problem {
    problem!("crack.toml")
}

/// The plate at a time, in steps of the length of the deck's over `ratio`.
fn at(method: Method, end: f64, ratio: u32, changes: &[String]) -> Result<Simulation, RunError> {
    let mut all = vec![format!("time.end={end:?}")];
    all.extend_from_slice(changes);
    let steps = (STEPS * end / END).round() as u64 * u64::from(ratio);
    plate().run(method, steps, &all)
}

/// Until the first bonds have broken the runs are the same.
fn before_failure(ratios: &[u32]) -> Result<Vec<Row>, RunError> {
    let mut rows = Vec::new();
    for (end, most, distance) in [(7e-6, 0.0, Some(3e-4)), (9e-6, 6.0, None)] {
        for &ratio in ratios {
            let fine = at(Method::Uniform(4), end, ratio, &[])?;
            let two = at(Method::Two(4, ratio), end, 1, &[])?;
            let at = format!("{:.0} µs, M = {ratio}", end * 1e6);
            let apart = broken(&two).abs_diff(broken(&fine)) as f64;
            rows.push(
                Row::new(
                    format!("{at}: broken bonds, difference to the fine step"),
                    "",
                    Some(apart),
                )
                .within(0.0, most)
                .note("the independent code: none at 7 µs, 0 … 2 at 9 µs"),
            );
            let apart = relative(&two.state().u, &fine.state().u);
            let row = Row::new(
                format!("{at}: relative distance of displacements"),
                "",
                Some(apart),
            );
            rows.push(match distance {
                Some(distance) => row.within(0.0, distance),
                // The same bonds, broken a sub-step earlier or later.
                None => row.note(
                    "the independent code: 2 … 3e-4; bonds that break one step apart make more",
                ),
            });
        }
    }
    Ok(rows)
}

fn broken(run: &Simulation) -> u64 {
    run.system().operator().broken_bonds()
}

/// The largest x of points with damage above 0.3, m.
fn tip(run: &Simulation) -> f64 {
    let cloud = run.system().cloud();
    let mut damage = vec![0.0; cloud.len()];
    run.system().operator().damage_into(&mut damage);
    (0..cloud.len())
        .filter(|&i| damage[i] > 0.3)
        .map(|i| cloud.point(i)[0])
        .fold(0.0, f64::max)
}

/// At the end, after several hundred bonds have broken.
fn failure(ratio: u32) -> Result<Vec<Row>, RunError> {
    let fine = at(Method::Uniform(4), END, ratio, &[])?;
    let following = ["time.adaptive={}".to_owned()];
    let mut rows = vec![
        Row::new(
            format!("RK4 with the step of M = {ratio} everywhere: broken bonds"),
            "",
            Some(broken(&fine) as f64),
        ),
        Row::new(
            format!("RK4 with the step of M = {ratio} everywhere: tip"),
            "m",
            Some(tip(&fine)),
        ),
    ];
    let verlet = at(Method::Verlet, END, ratio, &[])?;
    rows.push(Row::new(
        format!("velocity Verlet with the step of M = {ratio} everywhere: broken bonds"),
        "",
        Some(broken(&verlet) as f64),
    ));
    for (name, method, changes) in [
        ("strip", Method::Two(4, ratio), &[][..]),
        ("following", Method::Two(4, ratio), &following[..]),
        ("strip", Method::Respa(ratio), &[][..]),
    ] {
        let two = at(method, END, 1, changes)?;
        let name = format!("{}, {name}", method.name());
        let share = broken(&two) as f64 / broken(&fine) as f64;
        rows.push(
            Row::new(
                format!("{name}: broken bonds over those of the fine step"),
                "",
                Some(share),
            )
            .within(1.0, 0.1),
        );
        rows.push(
            Row::new(
                format!("{name}: tip beyond that of the fine step"),
                "m",
                Some(tip(&two) - tip(&fine)),
            )
            .within(0.0, 2.0 * HORIZON),
        );
        if let Some(report) = two.integrator().refinement() {
            rows.push(Row::new(
                format!("{name}: mean fraction of fine points"),
                "",
                Some(report.mean_fraction),
            ));
            let points = (report.points * two.steps()) as f64;
            let evaluations = two.system().evaluated_points() as f64 / points;
            rows.push(Row::new(
                format!("{name}: evaluations per point and step"),
                "",
                Some(evaluations),
            ));
        }
    }
    Ok(rows)
}
