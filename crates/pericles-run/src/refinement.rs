//! Multirate schemes: predicted and achieved net speed-up.
//!
//! Compared with the same scheme and the fine step everywhere, a multirate scheme saves force evaluations if the fine
//! region is small. This alone does not justify it: on a uniform grid of one material, coarse and fine points have
//! the same stable step, and velocity Verlet needs a quarter of the evaluations of a fourth-order Runge–Kutta method.
//! Therefore `check` also compares with velocity Verlet, with the fine step and with its own largest stable step.

use std::time::{Duration, Instant};

use pericles::time::{
    HighestFrequency, Integrator, RefinementReport, RungeKutta, State, Tableau, VelocityVerlet,
};
use pericles::{Interrupt, PericlesError, System};
use pericles_deck::{FineRegion, Model, Scheme};
use serde::Serialize;

use crate::build::Assembly;
use crate::units::{percent, significant};

/// Properties of a multirate scheme before the first step; SI units.
#[derive(Debug, Clone, Serialize)]
pub struct RefinementFacts {
    /// Fine steps per coarse step, M.
    pub ratio: u32,
    /// Fraction φ of fine points at the start.
    pub fine_fraction: f64,
    /// Points with the fine step at the start.
    pub fine_points: u64,
    /// Points with the coarse step at the start.
    pub coarse_points: u64,
    /// Coarse points with fine neighbours at the start.
    pub border_points: u64,
    /// Whether the fine region follows damage.
    pub follows_damage: bool,
    /// The highest frequency of the whole body; the coarse step is limited by the frequency of the coarse part.
    pub body_frequency: Option<f64>,
    /// The frequency that limits the coarse step, times that step.
    pub omega_dt: Option<f64>,
    /// The highest frequency of the whole body times the fine step.
    pub omega_dt_fine: Option<f64>,
    /// Force evaluations per point and coarse step.
    pub evaluations: f64,
    /// Ratio of the evaluations of the same scheme with the fine step everywhere to those of this one.
    pub speed_up: f64,
    /// The same for velocity Verlet with the fine step everywhere.
    pub speed_up_over_verlet: f64,
    /// The same for velocity Verlet with its own largest stable step; `None` if no frequency is known.
    pub speed_up_over_stable_verlet: Option<f64>,
}

/// Results of a multirate scheme.
#[derive(Debug, Clone, Serialize)]
pub struct RefinementAudit {
    /// Fine steps per coarse step, M.
    pub ratio: u32,
    /// Fraction of fine points, mean over the steps.
    pub fine_fraction: f64,
    /// Fraction of fine points, maximum over the steps.
    pub largest_fine_fraction: f64,
    /// Number of coarse steps.
    pub steps: u64,
    /// Initial coarse steps that were fine everywhere.
    pub starting_steps: u64,
    /// Ratio of the evaluations of the same scheme with the fine step everywhere to those of this one, by the cost
    /// model. Measured times are compared by `check`, which runs the schemes alternately: the time of a run includes
    /// output and other load of the machine.
    pub predicted_speed_up: f64,
    /// The same, counted.
    pub achieved_speed_up: f64,
    /// The same for velocity Verlet with the fine step everywhere, counted.
    pub achieved_speed_up_over_verlet: f64,
}

impl RefinementFacts {
    /// Returns the properties of an assembled model with a multirate scheme.
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

/// Returns the stable step of velocity Verlet, s.
fn verlet_step(body: &HighestFrequency) -> f64 {
    /// The default of decks.
    const SAFETY: f64 = 0.95;
    VelocityVerlet
        .stability_limit()
        .map_or(f64::INFINITY, |limit| body.stable_step(limit, SAFETY))
}

impl RefinementAudit {
    /// Evaluates a scheme after the current step, given the number of force evaluations at points of the whole body.
    pub fn of(report: &RefinementReport, evaluated_points: u64) -> Self {
        let steps = report.steps + report.starting_steps;
        // Every scheme evaluates the initial state.
        let evaluated = evaluated_points.saturating_sub(report.points);
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

    /// Returns a summary line.
    pub fn line(&self) -> String {
        format!(
            "multirate: M = {}, {} of the points fine (at most {}); with the fine step everywhere the scheme would need {} times as many force evaluations (predicted: {}), velocity-verlet {} times",
            self.ratio,
            percent(self.fine_fraction),
            percent(self.largest_fine_fraction),
            significant(self.achieved_speed_up, 3),
            significant(self.predicted_speed_up, 3),
            significant(self.achieved_speed_up_over_verlet, 3),
        )
    }
}

/// Measured times of one coarse step, and of the same time interval with single-rate schemes.
#[derive(Debug, Clone, Copy)]
pub struct Comparison {
    /// The multirate scheme, s.
    pub seconds: f64,
    /// The same scheme with the fine step everywhere, s.
    pub uniform: f64,
    /// Velocity Verlet with the fine step everywhere, s.
    pub verlet: f64,
}

impl Comparison {
    /// Measures the times. This advances the state of the assembly.
    ///
    /// # Errors
    /// A scheme does not converge.
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
            // r-RESPA with a single step is velocity Verlet.
            _ => None,
        };
        let (system, state, dt) = (&mut assembly.system, &mut assembly.state, assembly.dt);
        let mut least = Self {
            seconds: f64::INFINITY,
            uniform: f64::INFINITY,
            verlet: f64::INFINITY,
        };
        // Alternately, so that other load of the machine affects all of them.
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

/// Maximum time of the measurement.
pub const LONGEST: Duration = Duration::from_millis(500);
const ROUNDS: u32 = 4;
/// Maximum number of measured steps.
const MOST: u64 = 500;

/// Measures the time per step of a scheme over at most `most` steps. This advances the state.
///
/// # Errors
/// The scheme does not converge.
pub fn seconds_per_step(
    system: &mut System,
    state: &mut State,
    integrator: &mut dyn Integrator,
    dt: f64,
    most: u64,
    longest: Duration,
) -> Result<f64, PericlesError> {
    let batch = integrator.steps_at_once();
    // Returns the number of steps.
    let mut advance = |most: u64| {
        let first = state.step;
        let steps = (dt, batch.min(most));
        integrator.advance(system, state, steps, Interrupt::never())?;
        Ok::<u64, PericlesError>(state.step - first)
    };
    let mut most = most.min(MOST);
    // The first step is slower because of cold caches and sleeping threads.
    if most > 1 {
        most -= advance(1)?;
    }
    let began = Instant::now();
    let (mut steps, mut next) = (0, 1);
    while steps < most && began.elapsed() < longest {
        steps += advance(next.min(most - steps))?;
        // Batches grow, so that a slow device does not compute a long one.
        next = batch.min(2 * next);
    }
    Ok(began.elapsed().as_secs_f64() / steps as f64)
}
