//! Two time steps in one body: whether they will pay, and whether they did.
//!
//! Against the same scheme with the fine step everywhere a scheme with two steps saves evaluations as long as the fine region is small. That is no
//! reason to use it: on a uniform grid of one material coarse and fine points have the same stable step, and velocity Verlet takes a quarter of the
//! evaluations of a Runge–Kutta method of order four. So `check` also compares with velocity Verlet, with the fine step and with its own largest one.

use std::time::{Duration, Instant};

use pericles::time::{
    HighestFrequency, Integrator, RefinementReport, RungeKutta, State, Tableau, VelocityVerlet,
    highest_frequency,
};
use pericles::{Interrupt, PericlesError, System};
use pericles_deck::{Deck, FineRegion, Model, Scheme};
use serde::Serialize;
use serde_json::json;

use crate::line::Line;
use crate::units::{percent, quantity, significant};

/// What is known of two time steps before the first; SI units.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct RefinementFacts {
    /// Fine steps in a coarse one, M.
    pub(crate) ratio: u32,
    /// Fraction φ of fine points at the start.
    pub(crate) fine_fraction: f64,
    /// Whether the fine region follows damage.
    pub(crate) follows_damage: bool,
    /// The highest frequency of the whole body; that of the model limits the coarse step.
    pub(crate) body_frequency: Option<f64>,
    /// The highest frequency that limits the coarse step, times that step.
    pub(crate) omega_dt: Option<f64>,
    /// The highest frequency of the whole body times the fine step.
    pub(crate) omega_dt_fine: Option<f64>,
    /// Evaluations per point in a coarse step.
    pub(crate) evaluations: f64,
    /// Evaluations of the same scheme with the fine step everywhere over those of this one.
    pub(crate) speed_up: f64,
    /// The same for velocity Verlet with the fine step everywhere.
    pub(crate) speed_up_over_verlet: f64,
    /// The same for velocity Verlet with its own largest stable step; none where no frequency is known.
    pub(crate) speed_up_over_stable_verlet: Option<f64>,
}

/// What two time steps did.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct RefinementAudit {
    pub(crate) ratio: u32,
    /// Mean over the steps.
    pub(crate) fine_fraction: f64,
    pub(crate) largest_fine_fraction: f64,
    /// Coarse steps, and those of them at the start that were fine everywhere.
    pub(crate) steps: u64,
    pub(crate) starting_steps: u64,
    /// Evaluations of the same scheme with the fine step everywhere over those of this one: by the model of its cost, and counted. The clock is for `check`, which lets
    /// schemes take turns: what a run takes holds its output and what else the machine does.
    pub(crate) predicted_speed_up: f64,
    pub(crate) achieved_speed_up: f64,
    /// The same for velocity Verlet with the fine step everywhere, counted.
    pub(crate) achieved_speed_up_over_verlet: f64,
}

impl RefinementFacts {
    /// The facts of a model whose scheme has two time steps.
    pub(crate) fn of(deck: &Deck, model: &Model) -> Option<Self> {
        let report = model.integrator.refinement()?;
        let ratio = f64::from(report.ratio);
        let body = highest_frequency(&model.system, &model.state.u).ok();
        let limiting = model.frequency.map(|frequency| frequency.estimate);
        Some(Self {
            ratio: report.ratio,
            fine_fraction: report.mean_fraction,
            follows_damage: matches!(
                fine_region(&deck.time.scheme),
                Some(FineRegion::Adaptive(_))
            ),
            body_frequency: body.map(|body| body.estimate),
            omega_dt: limiting.map(|omega| omega * model.dt),
            omega_dt_fine: body.map(|body| body.estimate * model.dt / ratio),
            evaluations: report.evaluations(),
            speed_up: report.speed_up(),
            speed_up_over_verlet: report.speed_up_over_verlet(),
            speed_up_over_stable_verlet: body
                .map(|body| model.dt / verlet_step(&body) / report.evaluations()),
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
    pub(crate) fn of(report: &RefinementReport, system: &System) -> Self {
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
    pub(crate) fn line(&self) -> String {
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
pub(crate) struct Comparison {
    /// This scheme.
    pub(crate) seconds: f64,
    /// The same scheme with the fine step everywhere.
    uniform: f64,
    /// Velocity Verlet with the fine step everywhere.
    verlet: f64,
}

impl Comparison {
    /// Measures. The model is worn out by it: its state moves on.
    ///
    /// # Errors
    /// Schemes that do not converge.
    pub(crate) fn measure(deck: &Deck, model: &mut Model) -> Result<Option<Self>, PericlesError> {
        let Some(report) = model.integrator.refinement() else {
            return Ok(None);
        };
        let ratio = f64::from(report.ratio);
        let mut uniform: Option<RungeKutta> = match &deck.time.scheme {
            Scheme::MultiTimeStep3 { alpha, .. } => {
                Some(RungeKutta::new(&Tableau::rk3(*alpha)?, &model.system))
            }
            Scheme::MultiTimeStep4 { .. } => Some(RungeKutta::new(&Tableau::rk4(), &model.system)),
            // r-RESPA with one step is velocity Verlet.
            _ => None,
        };
        let (system, state, dt) = (&mut model.system, &mut model.state, model.dt);
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
            least.seconds = least.seconds.min(time(&mut *model.integrator, dt)?);
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
pub(crate) const LONGEST: Duration = Duration::from_millis(500);
const ROUNDS: u32 = 4;
/// Steps that are enough however short they are.
const MOST: u64 = 500;

/// The time of the clock for one step of a scheme, from a few, at most `most`, on the built body, which moves on.
///
/// # Errors
/// Schemes that do not converge.
pub(crate) fn seconds_per_step(
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

/// The lines of `check` about two time steps.
pub(crate) fn lines(
    facts: &RefinementFacts,
    scheme: &str,
    dt: f64,
    comparison: &Comparison,
) -> Vec<Line> {
    let fine_dt = dt / f64::from(facts.ratio);
    let frequencies = match (facts.omega_dt, facts.omega_dt_fine) {
        (Some(coarse), Some(fine)) => format!("; ω dt {coarse:.2} coarse, {fine:.2} fine"),
        _ => String::new(),
    };
    let plain = plain_name(scheme);
    let following = if facts.follows_damage {
        " at the start, more as bonds come near to breaking"
    } else {
        ""
    };
    let steps = format!(
        "{} and {} for {} of the points{following}{frequencies}",
        quantity(dt, "s"),
        quantity(fine_dt, "s"),
        percent(facts.fine_fraction),
    );
    let over_uniform = comparison.uniform / comparison.seconds;
    let over_verlet = comparison.verlet / comparison.seconds;
    let cost = format!(
        "{} evaluations per point and step; {plain} with the fine step everywhere {} times that ({} by the clock), velocity-verlet there {} times ({} by the clock)",
        significant(facts.evaluations, 3),
        significant(facts.speed_up, 3),
        significant(over_uniform, 3),
        significant(facts.speed_up_over_verlet, 3),
        significant(over_verlet, 3),
    );
    vec![
        Line::new("two time steps", steps).with("dt_fine", fine_dt),
        Line::new("their cost", cost).with(
            "refinement_by_clock",
            json!({ "speed_up": over_uniform, "speed_up_over_verlet": over_verlet }),
        ),
        Line::new("do they pay", verdict(facts, scheme, comparison)),
    ]
}

/// The scheme with one step.
fn plain_name(scheme: &str) -> &str {
    match scheme {
        "respa" => "velocity-verlet",
        name => name.strip_suffix("-mts").unwrap_or(name),
    }
}

fn verdict(facts: &RefinementFacts, scheme: &str, comparison: &Comparison) -> String {
    let needless = facts
        .omega_dt_fine
        .zip(facts.omega_dt)
        // Whole and coarse frequency within a few percent: nothing in the body asks for the smaller step.
        .is_some_and(|(fine, coarse)| fine * f64::from(facts.ratio) < 1.05 * coarse);
    let reason = if needless {
        "coarse and fine points have the same stable step, so the smaller one serves accuracy only"
    } else {
        "the fine points need the smaller step"
    };
    let gain = comparison.verlet / comparison.seconds;
    let own = facts
        .speed_up_over_stable_verlet
        .filter(|own| *own < 1.0)
        .map_or(String::new(), |own| {
            format!(
                "; velocity-verlet with its own stable step takes {} of the evaluations",
                percent(own)
            )
        });
    if gain > 1.0 {
        format!(
            "yes: {} times faster than velocity-verlet with the fine step everywhere; {reason}{own}",
            significant(gain, 3)
        )
    } else if comparison.uniform > comparison.seconds && scheme != "respa" {
        format!(
            "only for the accuracy of {}: velocity-verlet with the fine step everywhere takes {} of the time; {reason}{own}",
            plain_name(scheme),
            percent(gain)
        )
    } else {
        format!(
            "no: velocity-verlet with the fine step everywhere takes {} of the time; {reason}{own}",
            percent(gain)
        )
    }
}
