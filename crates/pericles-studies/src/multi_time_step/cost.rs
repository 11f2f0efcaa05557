//! Cost of multirate schemes: evaluations and wall time compared with the fine step everywhere.
//!
//! Schemes run in alternation on the same body; a time is the minimum over the rounds. S = M/(1 + (M − 1) φ) is the
//! model of multirate Runge–Kutta compared with the same method with the fine step everywhere. Velocity Verlet with
//! the fine step everywhere is the more demanding reference: it needs M evaluations where multirate RK4 needs 4
//! (1 + (M − 1) φ).

use std::cell::RefCell;
use std::f64::consts::{PI, TAU};
use std::rc::Rc;
use std::time::Instant;

use pericles::operator::PointSubset;
use pericles::space::{PointCloud, PointSet};
use pericles::time::{Integrator, MultiTimeStep, Respa};
use pericles_run::RunError;

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

/// Ratio of the counted evaluations of a scheme with step ratio `ratio` to those of the model, which must be one.
pub(super) fn evaluations(case: &Case<'_>) -> Result<Found, RunError> {
    const STEPS: u32 = 3;
    let method = Method::of(case, "method")?;
    on_threads(case, 1, |bench| {
        let n = bench.points();
        let fine = Outline::Ragged.points(bench.system.cloud(), 0.1);
        let f = fine.len() as u64;
        let (counted, model) = match method {
            Method::Respa(ratio) => {
                let regions = bench.options(ratio, &fine).fine;
                let mut respa = Respa::new(ratio, regions, &bench.system)?;
                respa.start(&mut bench.system, &mut bench.state);
                let counted = bench.evaluations(&mut respa, STEPS)?;
                let shared = respa.refinement().map_or(0, |report| report.border_points);
                (
                    counted,
                    u64::from(STEPS) * (n - f + u64::from(ratio) * (f + shared)),
                )
            }
            Method::Two(order, ratio) => {
                let options = bench.options(ratio, &fine);
                let mut two = MultiTimeStep::new(&tableau(order)?, options, &bench.system)?;
                let counted = bench.evaluations(&mut two, STEPS)?;
                (
                    counted,
                    u64::from(STEPS * order) * (n - f + u64::from(ratio) * f),
                )
            }
            Method::Uniform(_) | Method::Verlet => return Ok(Found::default()),
        };
        Ok((counted as f64 / model as f64).into())
    })
}

/// Cost of the force on a part of the body, to explain a lost speed-up: time per point relative to that of the
/// whole body.
pub(super) fn force_on_part(case: &Case<'_>) -> Result<Found, RunError> {
    on_threads(case, 1, |bench| {
        let fine = Outline::Ragged.points(bench.system.cloud(), 0.1);
        let mut out = vec![0.0; bench.state.u.len()];
        let mut seconds = |on: PointSubset<'_>| {
            let times = (0..9).map(|_| {
                let began = Instant::now();
                let (t, u) = (bench.state.t, &bench.state.u);
                bench.system.free_acceleration(t, u, &on, &mut out);
                began.elapsed().as_secs_f64()
            });
            times.fold(f64::INFINITY, f64::min)
        };
        let part = seconds(PointSubset::Set(&fine)) / fine.len() as f64;
        let whole = seconds(PointSubset::All) / bench.points() as f64;
        Ok((part / whole).into())
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

/// Speed-up of a multirate scheme.
pub(super) fn speed_up(case: &Case<'_>) -> Result<Found, RunError> {
    let timed = timed(case, case.number("fraction")?)?;
    let model = model_of(case.number("ratio")?, timed.0);
    let found = timed
        .1
        .ratios()
        .value("share", timed.0)
        .value("model", model);
    // Exceeding the model is not an error.
    let reached = (timed.1.speed_up() / model).min(1.0);
    Ok(found.value("over model", reached))
}

/// Speed-ups by the fraction of fine points.
pub(super) fn of_fractions(case: &Case<'_>) -> Result<Found, RunError> {
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

/// Speed-ups with a set of the deck as fine region: the fraction of its points, the times at the deck's own step if
/// `step` is set, and the size ratio of a body with small cells everywhere.
pub(super) fn of_set(case: &Case<'_>) -> Result<Found, RunError> {
    let (ratio, set) = (case.count("ratio")? as u32, case.text("points")?);
    let [rounds, steps] = [case.count("rounds")? as u32, case.count("steps")? as u32];
    let (problem, method) = (Problem::of(case)?, Method::of(case, "method")?);
    let assembly = problem.assembly(method, &[])?;
    let mut bench = Bench::new(problem)?;
    if case.flag("own_step") {
        bench.dt = assembly.dt;
    }
    let fine = assembly.sets.iter().find(|(name, _)| *name == set);
    let Some((_, fine)) = fine else {
        return Ok(Found::default());
    };
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let turns = one.install(|| Turns::take(&mut bench, ratio, fine, [rounds, steps]))?;
    let report = assembly.integrator.refinement();
    let (cells, large) = (assembly.cloud.len() as f64, assembly.cloud.spacing());
    let [low, high] = assembly.cloud.bounds();
    let everywhere = (high[0] - low[0]) * (high[1] - low[1]) / (large / f64::from(ratio)).powi(2);
    let most = case.optional("most").unwrap_or(f64::INFINITY);
    let found = turns.ratios();
    Ok(found
        .value("share", fine.len() as f64 / cells)
        .value("speed-up at most", turns.speed_up().min(most))
        .value("r-RESPA at most", (turns.verlet / turns.respa).min(most))
        .value("r-RESPA by model", report.map(|report| report.speed_up()))
        .value("small cells everywhere", everywhere / cells))
}
