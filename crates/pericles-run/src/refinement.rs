//! Two time steps in one body: whether they will pay, and whether they did.
//!
//! Against the same scheme with the fine step everywhere a scheme with two steps saves evaluations as long as the fine region is small. That is no
//! reason to use it: on a uniform grid of one material coarse and fine points have the same stable step, and velocity Verlet takes a quarter of the
//! evaluations of a Runge–Kutta method of order four. So `check` also compares with velocity Verlet, with the fine step and with its own largest one.

use std::time::{Duration, Instant};

use pericles::time::{
    HighestFrequency, Integrator, RefinementReport, RungeKutta, State, Tableau, VelocityVerlet,
};
use pericles::{Interrupt, PericlesError, System};
use pericles_deck::{FineRegion, Model, Scheme};
use serde::Serialize;

use crate::build::Assembly;
use crate::units::{percent, significant};

/// What is known of two time steps before the first; SI units.
#[derive(Debug, Clone, Serialize)]
pub struct RefinementFacts {
    /// Fine steps in a coarse one, M.
    pub ratio: u32,
    /// Fraction φ of fine points at the start.
    pub fine_fraction: f64,
    /// Points with the fine step at the start.
    pub fine_points: u64,
    /// Points with the coarse step at the start.
    pub coarse_points: u64,
    /// Those of the coarse points that have fine neighbours at the start.
    pub border_points: u64,
    /// Whether the fine region follows damage.
    pub follows_damage: bool,
    /// The highest frequency of the whole body; that of the model limits the coarse step.
    pub body_frequency: Option<f64>,
    /// The highest frequency that limits the coarse step, times that step.
    pub omega_dt: Option<f64>,
    /// The highest frequency of the whole body times the fine step.
    pub omega_dt_fine: Option<f64>,
    /// Evaluations per point in a coarse step.
    pub evaluations: f64,
    /// Evaluations of the same scheme with the fine step everywhere over those of this one.
    pub speed_up: f64,
    /// The same for velocity Verlet with the fine step everywhere.
    pub speed_up_over_verlet: f64,
    /// The same for velocity Verlet with its own largest stable step; none where no frequency is known.
    pub speed_up_over_stable_verlet: Option<f64>,
}

/// What two time steps did.
#[derive(Debug, Clone, Serialize)]
pub struct RefinementAudit {
    /// Fine steps in a coarse one, M.
    pub ratio: u32,
    /// Mean over the steps.
    pub fine_fraction: f64,
    /// The largest over the steps.
    pub largest_fine_fraction: f64,
    /// Coarse steps.
    pub steps: u64,
    /// Those of the coarse steps at the start that were fine everywhere.
    pub starting_steps: u64,
    /// Evaluations of the same scheme with the fine step everywhere over those of this one: by the model of its cost. The clock is for `check`, which lets
    /// schemes take turns: what a run takes holds its output and what else the machine does.
    pub predicted_speed_up: f64,
    /// The same, counted.
    pub achieved_speed_up: f64,
    /// The same for velocity Verlet with the fine step everywhere, counted.
    pub achieved_speed_up_over_verlet: f64,
}

impl RefinementFacts {
    /// The facts of an assembled model whose scheme has two time steps.
    pub fn of(model: &Model, assembly: &Assembly) -> Option<Self> {
        let report = assembly.integrator.refinement()?;
        let ratio = f64::from(report.ratio);
        let body = assembly.body_frequency;
        let limiting = assembly.frequency.map(|frequency| frequency.estimate);
        Some(Self {
            ratio: report.ratio,
            fine_fraction: report.mean_fraction,
            fine_points: report.fine_points,
            coarse_points: report.points - report.fine_points,
            border_points: report.border_points,
            follows_damage: matches!(
                fine_region(&model.time.scheme),
                Some(FineRegion::Adaptive(_))
            ),
            body_frequency: body.map(|body| body.estimate),
            omega_dt: limiting.map(|omega| omega * assembly.dt),
            omega_dt_fine: body.map(|body| body.estimate * assembly.dt / ratio),
            evaluations: report.evaluations(),
            speed_up: report.speed_up(),
            speed_up_over_verlet: report.speed_up_over_verlet(),
            speed_up_over_stable_verlet: body
                .map(|body| assembly.dt / verlet_step(&body) / report.evaluations()),
        })
    }
}

fn fine_region(scheme: &Scheme) -> Option<&FineRegion> {
    match scheme {
        Scheme::MultiTimeStep3 { fine, .. }
        | Scheme::MultiTimeStep4 { fine, .. }
        | Scheme::Respa { fine } => Some(&fine.region),
        _ => None,
    }
}

/// The step that velocity Verlet would take by itself, s.
fn verlet_step(body: &HighestFrequency) -> f64 {
    /// The default of decks.
    const SAFETY: f64 = 0.95;
    VelocityVerlet
        .stability_limit()
        .map_or(f64::INFINITY, |limit| body.stable_step(limit, SAFETY))
}

impl RefinementAudit {
    /// The account of a scheme that has come so far with a body.
    pub fn of(report: &RefinementReport, system: &System) -> Self {
        let steps = report.steps + report.starting_steps;
        // The evaluation of the initial state belongs to every scheme.
        let evaluated = system.evaluated_points().saturating_sub(report.points);
        let everywhere = steps * u64::from(report.ratio) * report.points;
        let verlet = everywhere as f64 / evaluated as f64;
        Self {
            ratio: report.ratio,
            fine_fraction: report.mean_fraction,
            largest_fine_fraction: report.largest_fraction,
            steps,
            starting_steps: report.starting_steps,
            predicted_speed_up: report.speed_up(),
            achieved_speed_up: f64::from(report.stages) * verlet,
            achieved_speed_up_over_verlet: verlet,
        }
    }

    /// In words.
    pub fn line(&self) -> String {
        format!(
            "two time steps: M = {}, fine {} of the points (at most {}); the fine step everywhere would take {} times as many evaluations (model: {}), velocity-verlet there {} times",
            self.ratio,
            percent(self.fine_fraction),
            percent(self.largest_fine_fraction),
            significant(self.achieved_speed_up, 3),
            significant(self.predicted_speed_up, 3),
            significant(self.achieved_speed_up_over_verlet, 3),
        )
    }
}

/// Times of the clock for one coarse step of the deck's scheme and for the same span of time by schemes with one step, measured on the built body.
#[derive(Debug, Clone, Copy)]
pub struct Comparison {
    /// This scheme.
    pub seconds: f64,
    /// The same scheme with the fine step everywhere.
    pub uniform: f64,
    /// Velocity Verlet with the fine step everywhere.
    pub verlet: f64,
}

impl Comparison {
    /// Measures. The assembly is worn out by it: its state moves on.
    ///
    /// # Errors
    /// Schemes that do not converge.
    pub fn measure(model: &Model, assembly: &mut Assembly) -> Result<Option<Self>, PericlesError> {
        let Some(report) = assembly.integrator.refinement() else {
            return Ok(None);
        };
        let ratio = f64::from(report.ratio);
        let mut uniform: Option<RungeKutta> = match &model.time.scheme {
            Scheme::MultiTimeStep3 { alpha, .. } => {
                Some(RungeKutta::new(&Tableau::rk3(*alpha)?, &assembly.system))
            }
            Scheme::MultiTimeStep4 { .. } => {
                Some(RungeKutta::new(&Tableau::rk4(), &assembly.system))
            }
            // r-RESPA with one step is velocity Verlet.
            _ => None,
        };
        let (system, state, dt) = (&mut assembly.system, &mut assembly.state, assembly.dt);
        let mut least = Self {
            seconds: f64::INFINITY,
            uniform: f64::INFINITY,
            verlet: f64::INFINITY,
        };
        // In turns, so that what else the machine does meets all of them.
        for _ in 0..ROUNDS {
            let mut time = |scheme: &mut dyn Integrator, dt| {
                seconds_per_step(system, state, scheme, dt, MOST, LONGEST / ROUNDS)
            };
            least.seconds = least.seconds.min(time(&mut *assembly.integrator, dt)?);
            let verlet = ratio * time(&mut VelocityVerlet, dt / ratio)?;
            least.verlet = least.verlet.min(verlet);
            let uniform = match &mut uniform {
                Some(scheme) => ratio * time(scheme, dt / ratio)?,
                None => verlet,
            };
            least.uniform = least.uniform.min(uniform);
        }
        Ok(Some(least))
    }
}

/// How long schemes are tried.
pub const LONGEST: Duration = Duration::from_millis(500);
const ROUNDS: u32 = 4;
/// Steps that are enough however short they are.
const MOST: u64 = 500;

/// The time of the clock for one step of a scheme, from a few, at most `most`, on the built body, which moves on.
///
/// # Errors
/// Schemes that do not converge.
pub fn seconds_per_step(
    system: &mut System,
    state: &mut State,
    integrator: &mut dyn Integrator,
    dt: f64,
    most: u64,
    longest: Duration,
) -> Result<f64, PericlesError> {
    let mut step = || {
        let t_next = state.t + dt;
        integrator.step(system, state, t_next, Interrupt::never())
    };
    let mut most = most.min(MOST);
    // The first step finds cold caches and sleeping threads.
    if most > 1 {
        step()?;
        most -= 1;
    }
    let began = Instant::now();
    let mut steps = 0;
    while steps < most && began.elapsed() < longest {
        step()?;
        steps += 1;
    }
    Ok(began.elapsed().as_secs_f64() / steps as f64)
}
