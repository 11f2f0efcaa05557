//! Runge–Kutta with error control.

use rayon::prelude::*;

use super::runge_kutta::{Stages, StepForm};
use super::zone::{Sum, Zone};
use super::{Integrator, State, Tableau};
use crate::archive::{Archive, Checkpointed, Counter, Values};
use crate::compatibility::{Need, Requirement, require};
use crate::error::{PericlesError, Result, positive};
use crate::interrupt::Interrupt;
use crate::operator::PointSubset;
use crate::parallel::{BLOCK, for_each_chunk};
use crate::sum::max_norm;
use crate::system::System;

/// The Dormand–Prince pair with local extrapolation: within each step of the run, as many sub-steps as the
/// tolerance requires.
///
/// The error of a sub-step h is the difference of the two methods. A sub-step is accepted if max|e_u| ≤ tolerance ·
/// max|u| and likewise for v; the next one is h · 0.9 · error^(−1/5), with a factor within [0.2, 5] (Hairer,
/// Nørsett & Wanner, II.4). A sub-step costs seven evaluations: the last stage serves the error estimate, and is
/// evaluated again after breaking. The proposed sub-step is carried over to the next step.
pub struct AdaptiveRungeKutta {
    tolerance: f64,
    form: StepForm,
    /// b − b̂, for velocities and for displacements.
    error: [Vec<f64>; 2],
    zone: Zone,
    stage: Vec<f64>,
    /// Velocity of a stage, if boundaries need it.
    velocity: Vec<f64>,
    a: Vec<Vec<f64>>,
    next: [Vec<f64>; 2],
    /// Proposed sub-step, s; `None` before the first.
    proposed: Option<f64>,
    accepted: Counter,
    rejected: Counter,
}

/// Smallest and largest factor between consecutive sub-steps, and safety factor.
const SHRINK: f64 = 0.2;
const GROW: f64 = 5.0;
const SAFETY: f64 = 0.9;
/// Smallest sub-step, as a fraction of the step.
const SMALLEST: f64 = 1e-9;

/// Smallest tolerance with forces in single precision, whose rounding is up to 2e-5 of the largest force where
/// points are nearly in equilibrium.
const SMALLEST_IN_FLOATS: f64 = 1e-5;

const NAME: &str = "dormand-prince";

impl AdaptiveRungeKutta {
    /// Requirements on the system.
    pub const REQUIREMENTS: &'static [Requirement] = &[
        Requirement {
            need: Need::NoMemory,
            reason: "its steps vary in length, but a boundary with memory is made for one step length; use velocity-verlet",
        },
        Requirement::CONSERVATIVE_CONTACT,
        Requirement::NO_FREE_BODIES,
    ];

    /// Makes the scheme with a relative tolerance per sub-step.
    ///
    /// # Errors
    /// A tolerance that is not positive; boundaries with memory, whose state rejected sub-steps would disturb.
    pub fn new(tolerance: f64, system: &System) -> Result<Self> {
        positive("the tolerance of the adaptive step", tolerance)?;
        let in_floats = system.operator().capabilities().single_precision;
        if in_floats && tolerance < SMALLEST_IN_FLOATS {
            return Err(PericlesError::SchemeParameter {
                parameter: "the tolerance of the adaptive step with forces in single precision",
                value: tolerance,
                allowed: "at least 1e-5, the rounding of the forces",
            });
        }
        require(NAME, Self::REQUIREMENTS, system)?;
        let tableau = Tableau::dormand_prince();
        let entries = system.dimension() * system.points();
        let array = || vec![0.0; entries];
        let lower = tableau.embedded.as_deref().unwrap_or_default();
        let difference: Vec<f64> = tableau
            .weights
            .iter()
            .zip(lower)
            .map(|(b, b_lower)| b - b_lower)
            .collect();
        Ok(Self {
            tolerance,
            form: StepForm::new(&tableau),
            error: [difference.clone(), tableau.times_stages(&difference)],
            zone: Zone::all(system.points()),
            stage: array(),
            velocity: Vec::new(),
            a: (1..tableau.len()).map(|_| array()).collect(),
            next: [array(), array()],
            proposed: None,
            accepted: Counter::default(),
            rejected: Counter::default(),
        })
    }

    /// Numbers of accepted and rejected sub-steps so far.
    pub fn sub_steps(&self) -> (u64, u64) {
        (self.accepted.get(), self.rejected.get())
    }

    /// Tries a sub-step: stores its end in `next` and returns its error divided by the tolerance.
    fn attempt(&mut self, system: &mut System, state: &State, h: f64) -> f64 {
        let State { t, u, v, a, .. } = state;
        let (n, domain) = (system.points(), system.domain().clone());
        let [u_next, v_next] = &mut self.next;
        for i in 1..self.form.len() {
            let (before, later) = self.a.split_at_mut(i - 1);
            let known = Stages {
                first: a,
                later: before,
            };
            self.form
                .stage(i, h, v, known)
                .onto(u, &self.zone, n, &mut self.stage);
            let t_stage = t + self.form.nodes[i] * h;
            let velocity = &mut self.velocity;
            if system.has_boundaries() {
                velocity.resize(v.len(), 0.0);
                self.form
                    .stage_velocity(i, h, known)
                    .onto(v, &self.zone, n, velocity);
            }
            system.acceleration(
                t_stage,
                &self.stage,
                velocity,
                PointSubset::All,
                &mut later[0],
            );
        }
        let known = Stages {
            first: a,
            later: &self.a,
        };
        self.form
            .displacement(h, v, known)
            .onto(u, &self.zone, n, u_next);
        self.form.velocity(h, known).onto(v, &self.zone, n, v_next);
        let [of_velocity, of_displacement] = &self.error;
        let mut relative = |scale: f64, factors: &[f64], [before, after]: [&[f64]; 2]| {
            zero(&mut self.stage);
            Sum::new().plus_all(scale, factors, |j| known.at(j)).add_to(
                &self.zone,
                n,
                &mut self.stage,
            );
            let size = domain.max(largest(before).max(largest(after)));
            if size == 0.0 {
                0.0
            } else {
                domain.max(largest(&self.stage)) / (self.tolerance * size)
            }
        };
        let error_u = relative(h * h, of_displacement, [u, u_next]);
        let error_v = relative(h, of_velocity, [v, v_next]);
        error_u.max(error_v)
    }
}

fn zero(array: &mut [f64]) {
    for_each_chunk(array, &|_, chunk| chunk.fill(0.0));
}

/// Returns max |x|; infinite if an entry is NaN.
fn largest(array: &[f64]) -> f64 {
    let of_chunk = |chunk: &[f64]| {
        let max = max_norm(chunk);
        if chunk.iter().all(|x| x.is_finite()) {
            max
        } else {
            f64::INFINITY
        }
    };
    array
        .par_chunks(16 * BLOCK)
        .map(of_chunk)
        .reduce(|| 0.0, f64::max)
}

impl Integrator for AdaptiveRungeKutta {
    fn name(&self) -> &'static str {
        NAME
    }

    fn vector_length(&self) -> Option<usize> {
        Some(self.next[0].len())
    }

    fn requirements(&self) -> &'static [Requirement] {
        Self::REQUIREMENTS
    }

    fn order(&self) -> u32 {
        5
    }

    /// None: the error control reduces a step that would be unstable.
    fn stability_limit(&self) -> Option<f64> {
        None
    }

    /// Sub-steps are accepted one by one.
    fn changes_within_step(&self) -> bool {
        true
    }

    fn step(
        &mut self,
        system: &mut System,
        state: &mut State,
        t_next: f64,
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let whole = t_next - state.t;
        // The first guess is small; the controller adapts it within a few sub-steps.
        let mut h = self.proposed.unwrap_or(1e-3 * whole);
        loop {
            interrupt.poll()?;
            let left = t_next - state.t;
            // A remainder below a hundredth of a sub-step is added to the last one.
            let last = h >= 0.99 * left;
            let try_h = if last { left } else { h };
            let error = self.attempt(system, state, try_h);
            let factor = (SAFETY * error.powf(-0.2)).clamp(SHRINK, GROW);
            if error.is_nan() || error > 1.0 {
                self.rejected.add(1);
                h = try_h * if error.is_finite() { factor } else { SHRINK };
                if h < SMALLEST * whole {
                    return Err(PericlesError::StepTooSmall {
                        t: state.t,
                        step: h,
                    });
                }
                continue;
            }
            self.accepted.add(1);
            let t = if last { t_next } else { state.t + try_h };
            let [u_next, v_next] = &mut self.next;
            system.constrain(t, u_next, v_next);
            system.constrain_velocity(t, v_next);
            state.complete(system, &mut self.next, t, try_h);
            // A sub-step shortened by the end of the step gives no estimate for the next.
            h = if last {
                h.max(try_h * factor)
            } else {
                try_h * factor
            };
            if last {
                break;
            }
        }
        self.proposed = Some(h.min(whole));
        state.step += 1;
        Ok(())
    }
}

impl Checkpointed for AdaptiveRungeKutta {
    fn save(&self, archive: &mut Archive) {
        let Self {
            proposed,
            accepted,
            rejected,
            tolerance: _,
            form: _,
            error: _,
            zone: _,
            stage: _,
            velocity: _,
            a: _,
            next: _,
        } = self;
        let proposed = proposed.unwrap_or(0.0);
        archive.put("scheme/proposed", Values::F64(vec![proposed]));
        let counts = vec![accepted.get(), rejected.get()];
        archive.put("scheme/counts", Values::U64(counts));
    }

    fn restore(&mut self, archive: &Archive) -> Result<()> {
        let (mut proposed, mut counts) = ([0.0], [0; 2]);
        archive.f64_into("scheme/proposed", &mut proposed)?;
        archive.u64_into("scheme/counts", &mut counts)?;
        self.proposed = (proposed[0] > 0.0).then_some(proposed[0]);
        [self.accepted, self.rejected] = counts.map(Counter::from);
        Ok(())
    }
}
