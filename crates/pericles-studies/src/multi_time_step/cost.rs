//! Cost of multirate schemes: evaluations, which are judged, and wall times, compared with the fine step everywhere.
//!
//! Schemes are timed in alternation on the same body; a time is the minimum over the rounds. S = M/(1 + (M − 1) φ) is the
//! model of multirate Runge–Kutta compared with the same method with the fine step everywhere. Velocity Verlet with
//! the fine step everywhere is the more demanding reference: it needs M evaluations where multirate RK4 needs 4
//! (1 + (M − 1) φ).

use std::cell::RefCell;
use std::f64::consts::{PI, TAU};
use std::rc::Rc;

use pericles::space::{PointCloud, PointSet};
use pericles::time::{Integrator, MultiTimeStep, Respa};
use pericles_run::{Assembly, RunError};

use super::problem::{Method, Problem, tableau};
use super::turns::{Bench, Turns};
use crate::data::{Case, Found};

/// Outline of a fine region.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Outline {
    Box,
    /// Star with seven rays: r < R (1 + 0.35 sin 7φ).
    Ragged,
}

impl Outline {
    fn of(case: &Case<'_>) -> Result<Self, RunError> {
        case.one_of("outline", &[("box", Self::Box), ("ragged", Self::Ragged)])
    }

    /// Selects about this fraction of the points, in the middle of the body.
    fn points(self, cloud: &PointCloud, fraction: f64) -> PointSet {
        const SWING: f64 = 0.35;
        let [low, high] = cloud.bounds();
        let area = fraction * (high[0] - low[0]) * (high[1] - low[1]);
        let half = 0.5 * area.sqrt();
        // ½∫r² dφ = π R² (1 + swing²/2).
        let radius = (area / (PI * (1.0 + 0.5 * SWING * SWING))).sqrt();
        (0..cloud.len() as u32)
            .filter(|&i| {
                let [x, y, _] = cloud.point(i as usize);
                let (dx, dy) = (x - 0.5 * (low[0] + high[0]), y - 0.5 * (low[1] + high[1]));
                match self {
                    Self::Box => dx.abs() < half && dy.abs() < half,
                    Self::Ragged => {
                        let angle = dy.atan2(dx).rem_euclid(TAU);
                        dx.hypot(dy) < radius * (1.0 + SWING * (7.0 * angle).sin())
                    }
                }
            })
            .collect()
    }
}

/// Runs a function on the body of the case with a number of threads.
fn on_threads<T: Send>(
    case: &Case<'_>,
    count: usize,
    work: impl FnOnce(&mut Bench) -> Result<T, RunError> + Send,
) -> Result<T, RunError> {
    let threads = rayon::ThreadPoolBuilder::new().num_threads(count).build()?;
    let shared: Rc<RefCell<Bench>> = case.once("bench".into(), || {
        Ok(RefCell::new(Bench::new(Problem::of(case)?)?))
    })?;
    let bench = &mut *shared.borrow_mut();
    threads.install(|| work(bench))
}

/// Number of coarse steps in which evaluations are counted.
const STEPS: u32 = 3;

/// Point evaluations of a scheme in [`STEPS`] steps, and by the model of its cost: s (N_C + M N_F) per step, for r-RESPA
/// N_C + M (N_F + N_CB).
fn counted(
    bench: &mut Bench,
    method: Method,
    fine: &PointSet,
) -> Result<Option<[f64; 2]>, RunError> {
    let (n, f) = (bench.points(), fine.len() as u64);
    let (counted, model) = match method {
        Method::Respa(ratio) => {
            let regions = bench.options(ratio, fine).fine;
            let mut respa = Respa::new(ratio, regions, &bench.system)?;
            respa.start(&mut bench.system, &mut bench.state);
            let counted = bench.evaluations(&mut respa, STEPS)?;
            let shared = respa.refinement().map_or(0, |report| report.border_points);
            (counted, n - f + u64::from(ratio) * (f + shared))
        }
        Method::Two(order, ratio) => {
            let options = bench.options(ratio, fine);
            let mut two = MultiTimeStep::new(&tableau(order)?, options, &bench.system)?;
            let counted = bench.evaluations(&mut two, STEPS)?;
            (counted, u64::from(order) * (n - f + u64::from(ratio) * f))
        }
        Method::Uniform(_) | Method::Verlet => return Ok(None),
    };
    Ok(Some([counted as f64, (u64::from(STEPS) * model) as f64]))
}

/// Ratio of the counted evaluations of a scheme to those of the model, which must be one, for a fine region of about
/// this fraction; and the evaluations of the same scheme with the fine step everywhere over the counted ones, with the
/// model M/(1 + (M − 1) φ) of Runge–Kutta methods.
pub(super) fn evaluations(case: &Case<'_>) -> Result<Found, RunError> {
    let (method, outline) = (Method::of(case, "method")?, Outline::of(case)?);
    let (fraction, ratio) = (case.number("fraction")?, case.number("ratio")?);
    on_threads(case, 1, |bench| {
        let fine = outline.points(bench.system.cloud(), fraction);
        let share = fine.len() as f64 / bench.points() as f64;
        let everywhere = f64::from(STEPS * method.stages()) * ratio * bench.points() as f64;
        let Some([counted, model]) = counted(bench, method, &fine)? else {
            return Ok(Found::default());
        };
        Ok([
            ("value", counted / model),
            ("saved", everywhere / counted),
            ("model", model_of(ratio, share)),
            ("share", share),
        ]
        .into())
    })
}

/// Fraction of fine points, and the times of schemes run in alternation with a fine region of about this fraction.
fn timed(case: &Case<'_>, fraction: f64) -> Result<Rc<(f64, Turns)>, RunError> {
    let (outline, ratio) = (Outline::of(case)?, case.count("ratio")? as u32);
    let threads = case.count("threads")?;
    case.once(format!("{outline:?} {ratio} {fraction} {threads}"), || {
        on_threads(case, threads, |bench| {
            let fine = outline.points(bench.system.cloud(), fraction);
            let share = fine.len() as f64 / bench.points() as f64;
            Ok((share, Turns::take(bench, ratio, &fine, [7, 2])?))
        })
    })
}

fn model_of(ratio: f64, share: f64) -> f64 {
    ratio / (1.0 + (ratio - 1.0) * share)
}

/// Ratios of wall times: with the fine step everywhere over those of the multirate scheme.
pub(super) fn speed_up(case: &Case<'_>) -> Result<Found, RunError> {
    let timed = timed(case, case.number("fraction")?)?;
    Ok(timed.1.ratios().value("share", timed.0))
}

/// Figure of the ratios of wall times by the fraction of fine points.
pub(super) fn of_fractions(case: &Case<'_>) -> Result<Found, RunError> {
    if case.context.figures.is_none() {
        return Ok(Found::default());
    }
    let fractions = case.numbers("fractions")?;
    let times = fractions.iter().map(|&fraction| timed(case, fraction));
    let speed_ups = times.map(|timed| Ok(timed?.1.speed_up()));
    let speed_ups: Vec<f64> = speed_ups.collect::<Result<_, RunError>>()?;
    Ok(Found::default().curve("speed-up", &fractions, &speed_ups))
}

/// Curve of the model.
pub(super) fn model(case: &Case<'_>) -> Result<Found, RunError> {
    let ratio = case.number("ratio")?;
    let x: Vec<f64> = (0..=50).map(|k| 0.005 * f64::from(k)).collect();
    let y: Vec<f64> = x.iter().map(|&x| model_of(ratio, x)).collect();
    Ok(Found::default().curve("model", &x, &y))
}

/// Body of the case and its set `points`.
fn body_with_set(case: &Case<'_>) -> Result<(Assembly, Bench, PointSet), RunError> {
    let problem = Problem::of(case)?;
    let assembly = problem.assembly(Method::Verlet, &[])?;
    let set = case.text("points")?;
    let found = assembly.sets.iter().find(|(name, _)| *name == set);
    let fine = found.map_or_else(
        || Vec::new().into_iter().collect(),
        |(_, fine)| fine.clone(),
    );
    Ok((assembly, Bench::new(problem)?, fine))
}

/// Evaluations with a set of the deck as fine region: of RK4 and of velocity Verlet with the fine step everywhere over
/// those of multirate RK4, and of velocity Verlet over those of r-RESPA, counted and by the model; the fraction of fine
/// points, and the size ratio of a body with small cells everywhere.
pub(super) fn evaluations_of_set(case: &Case<'_>) -> Result<Found, RunError> {
    let ratio = case.count("ratio")? as u32;
    let (assembly, mut bench, fine) = body_with_set(case)?;
    let everywhere = f64::from(STEPS * ratio) * bench.points() as f64;
    let mut found = Found::default();
    for (name, method) in [
        ("RK4", Method::Two(4, ratio)),
        ("r-RESPA", Method::Respa(ratio)),
    ] {
        let Some([counted, model]) = counted(&mut bench, method, &fine)? else {
            continue;
        };
        let everywhere = f64::from(method.stages()) * everywhere;
        found = found
            .value(name, everywhere / counted)
            .value(format!("{name} by model"), everywhere / model);
    }
    let (cells, large) = (assembly.cloud.len() as f64, assembly.cloud.spacing());
    let [low, high] = assembly.cloud.bounds();
    let small = (high[0] - low[0]) * (high[1] - low[1]) / (large / f64::from(ratio)).powi(2);
    Ok(found
        .value("share", fine.len() as f64 / cells)
        .value("small cells everywhere", small / cells))
}

/// Ratios of wall times with a set of the deck as fine region, at the deck's own step if `own_step` is set.
pub(super) fn of_set(case: &Case<'_>) -> Result<Found, RunError> {
    let ratio = case.count("ratio")? as u32;
    let [rounds, steps] = [case.count("rounds")? as u32, case.count("steps")? as u32];
    let (assembly, mut bench, fine) = body_with_set(case)?;
    if case.flag("own_step") {
        bench.dt = assembly.dt;
    }
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let turns = one.install(|| Turns::take(&mut bench, ratio, &fine, [rounds, steps]))?;
    Ok(turns.ratios())
}
