//! A hard grain in a soft plate: a body that asks for a small step in a small part of it.
//!
//! The grain is M² times stiffer than the plate, so that the plate's stable step is M times that of the grain. Velocity Verlet must take the small step everywhere; r-RESPA and
//! Runge–Kutta with two steps need not.

use pericles_run::Assembly;
use pericles_run::RunError;

use super::problem::{Method, PAPER, Problem, problem, relative};
use super::turns::{Bench, Turns};
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(crate) const STUDY: Study = Study {
    id: "multi-time-step/inclusion",
    paper: PAPER,
    title: "A hard grain in a soft plate: two time steps against velocity Verlet",
    run,
};

const RATIO: u32 = 8;

/// Coarse steps of 1.6 µs to the deck's end.
const STEPS: u64 = 75;

fn run(_: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let mut rows = speed()?;
    rows.extend(ringing()?);
    rows.extend(struck()?);
    Ok(rows)
}

fn speed() -> Result<Vec<Row>, RunError> {
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    one.install(|| {
        let problem = problem!(example "inclusion.toml", |_| ());
        let assembly = problem.assembly(Method::Respa(RATIO), &[])?;
        let mut bench = Bench::new(&problem)?;
        bench.dt = assembly.dt;
        let Some((_, fine)) = assembly.sets.iter().find(|(name, _)| name == "fine") else {
            return Ok(Vec::new());
        };
        let fraction = fine.len() as f64 / bench.points() as f64;
        let report = assembly.integrator.refinement();
        let turns = Turns::take(&mut bench, RATIO, fine, [5, 4])?;
        let speed_up = turns.verlet / turns.respa;
        Ok(vec![
            Row::new("fraction of fine points", "", Some(fraction)).within(0.075, 0.075),
            Row::new(
                "r-RESPA, M = 8: speed-up against velocity Verlet with the fine step everywhere",
                "",
                Some(speed_up),
            ),
            Row::new("the same, at most 3", "", Some(speed_up.min(3.0)))
                .within(3.0, 0.0)
                .note("one thread, in turns, least of five rounds"),
            Row::new(
                "r-RESPA, M = 8: speed-up by the model of its cost",
                "",
                report.map(|report| report.speed_up()),
            ),
            Row::new(
                "RK4 with two steps, M = 8: speed-up against velocity Verlet with the fine step everywhere",
                "",
                Some(turns.verlet / turns.two),
            ),
            Row::new(
                "RK4 with two steps, M = 8: speed-up against RK4 with the fine step everywhere",
                "",
                Some(turns.uniform / turns.two),
            ),
        ])
    })
}

/// Relative distances of a set's displacements to those by velocity Verlet with a quarter of the fine step: of r-RESPA, RK4 with two steps and velocity Verlet with the
/// fine step.
fn errors(problem: &Problem, set: &str, steps: u64, end: f64) -> Result<[f64; 3], RunError> {
    let end = [format!("time.end={end:?}")];
    let assembly = problem.assembly(Method::Verlet, &[])?;
    let n = assembly.cloud.len();
    let found = assembly.sets.iter().find(|(name, _)| name == set);
    let points = found.map_or(&[][..], |(_, points)| points);
    let part = |u: &[f64]| -> Vec<f64> {
        let of = |c: usize| points.iter().map(move |&i| c * n + i as usize);
        of(0).chain(of(1)).map(|entry| u[entry]).collect()
    };
    let fine = steps * u64::from(RATIO);
    let exact = problem.run(Method::Verlet, 4 * fine, &end)?;
    let error = |method, steps| -> Result<f64, RunError> {
        let run = problem.run(method, steps, &end)?;
        Ok(relative(&part(&run.state().u), &part(&exact.state().u)))
    };
    Ok([
        error(Method::Respa(RATIO), steps)?,
        error(Method::Two(4, RATIO), steps)?,
        error(Method::Verlet, fine)?,
    ])
}

/// The grain itself breathes, too fast for the plate to follow.
fn ringing() -> Result<Vec<Row>, RunError> {
    const CENTRE: [f64; 2] = [0.06, 0.05];
    const RADIUS: f64 = 8e-3;
    /// Two coarse steps: one period or so of the breathing.
    const END: f64 = 3.2e-6;
    let problem = problem!(example "inclusion.toml", |assembly: &mut Assembly| {
        let n = assembly.cloud.len();
        let grain = assembly.sets.iter().find(|(name, _)| name == "grain");
        for &i in grain.map_or(&[][..], |(_, points)| points) {
            let i = i as usize;
            let place = assembly.cloud.point(i);
            let [x, y] = [place[0] - CENTRE[0], place[1] - CENTRE[1]];
            let r = x.hypot(y);
            let speed = (std::f64::consts::PI * r / RADIUS).sin();
            let slope = if r > 0.0 { speed / r } else { 0.0 };
            assembly.state.v[i] = slope * x;
            assembly.state.v[n + i] = slope * y;
        }
    });
    let [respa, two, verlet] = errors(&problem, "grain", 2, END)?;
    Ok(vec![
        Row::new("breathing grain, velocity Verlet with the fine step: error", "", Some(verlet)),
        Row::new("breathing grain, r-RESPA: error", "", Some(respa)),
        Row::new("breathing grain, r-RESPA: error over that of velocity Verlet", "", Some(respa / verlet))
            .within(1.0, 0.1)
            .note("relative distance of the grain's displacements from those with a quarter of the fine step: both schemes take the fine step there"),
        Row::new("breathing grain, RK4 with two steps: error", "", Some(two)),
    ])
}

/// The deck itself: a wave from outside, which the plate carries with the coarse step.
fn struck() -> Result<Vec<Row>, RunError> {
    let problem = problem!(example "inclusion.toml", |_| ());
    let [respa, two, verlet] = errors(&problem, "all", STEPS, 120e-6)?;
    Ok(vec![
        Row::new("struck from outside, velocity Verlet with the fine step: error", "", Some(verlet)),
        Row::new("struck from outside, r-RESPA: error", "", Some(respa)).note(
            "the plate carries the wave with a step eight times as long, near its stable limit: of second order, up to 64 times the error of the fine step everywhere",
        ),
        Row::new("struck from outside, RK4 with two steps: error", "", Some(two))
            .note("the same steps, of fourth order in both parts"),
    ])
}
