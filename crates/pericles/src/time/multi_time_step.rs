//! Multirate Runge–Kutta: small time steps in fine regions.

use super::fine_region::Fine;
use super::interface::{CoarseStep, History, Inside, Interpolant, Predictor};
use super::refinement::{PARTS_OF_THE_BODY, Refinement, SchemeCost};
use super::refinement_report::RefinementReport;
use super::runge_kutta::{Stages, StepForm};
use super::zone::Sum;
use super::zones::Zones;
use super::{HighestFrequency, Integrator, State, Tableau};
use crate::compatibility::{Need, Requirement};
use crate::error::{PericlesError, Result};
use crate::interrupt::Interrupt;
use crate::step_end::{Path, StepEnd};
use crate::system::System;

/// Options of [`MultiTimeStep`].
#[derive(Debug, Clone, PartialEq)]
pub struct MultiTimeStepOptions {
    /// Number M of fine steps per coarse step.
    pub ratio: u32,
    /// The points with the fine step.
    pub fine: Fine,
    /// Predictor of fine points at coarse stages.
    pub predictor: Predictor,
    /// Interpolant of coarse points at fine stages.
    pub interpolant: Interpolant,
}

/// Multirate Runge–Kutta of order three or four (Liu, Sun, Tian, Don & Ju 2024).
///
/// Coarse points C take a step dt, fine points F take M steps dt/M. One evaluation of all points is the first stage
/// of both. Then the coarse points take their step, with the fine points among their neighbours predicted at the
/// stages; then the fine points take theirs, with coarse neighbours interpolated at the stages. Each side sees the
/// other as a given function of time with error O(dt^r), so that the order r of the method is kept. A step
/// evaluates s (N_C + M N_F) points.
///
/// Bonds with a fine end may break after every sub-step, bonds between coarse points after every coarse step.
/// Momentum across the interface is conserved to the order of the method, not to round-off.
pub struct MultiTimeStep {
    name: &'static str,
    order: u32,
    limit: f64,
    form: StepForm,
    inside: Inside,
    predictor: Predictor,
    refinement: Refinement,
    everywhere: Zones,
    history: History,
    work: Work,
}

struct Work {
    stage: Vec<f64>,
    /// Velocity of a stage, if boundaries need it.
    velocity: Vec<f64>,
    /// Accelerations of stages 2 … s; entries of coarse points belong to the coarse step, entries of fine points to the
    /// sub-step.
    a: Vec<Vec<f64>>,
    /// First accelerations of the second and later sub-steps, and of the next step.
    first: Vec<f64>,
    u: Vec<f64>,
    v: Vec<f64>,
}

impl MultiTimeStep {
    /// Requirements on the system.
    pub const REQUIREMENTS: &'static [Requirement] = &[
        Requirement {
            need: Need::NoMemory,
            reason: "boundaries with memory support a single time step only; use velocity-verlet",
        },
        PARTS_OF_THE_BODY,
        Requirement::NO_ACTIVATION,
        Requirement {
            need: Need::NoInteractions,
            reason: "a contact may join points of zones with different time steps, whose forces are then known at different times; use velocity-verlet",
        },
    ];

    /// Makes the scheme for a system.
    ///
    /// # Errors
    /// A method of another order than three or four; a ratio below one; fine regions that are empty, overlap or are
    /// thinner than a horizon; forces that cannot be evaluated on a subset of the points.
    pub fn new(tableau: &Tableau, options: MultiTimeStepOptions, system: &System) -> Result<Self> {
        let (name, order) = match (tableau.order, tableau.len()) {
            (3, 3) => ("multirate-rk3", 3),
            (4, 4) => ("multirate-rk4", 4),
            _ => {
                return Err(PericlesError::SchemeNotUsable {
                    scheme: tableau.name,
                    reason: "predictors and interpolants of multirate schemes exist for rk3 and rk4 only",
                });
            }
        };
        let MultiTimeStepOptions {
            ratio,
            fine,
            predictor,
            interpolant,
        } = options;
        let cost = SchemeCost {
            name,
            requirements: Self::REQUIREMENTS,
            stages: tableau.len() as u32,
            shares_border: false,
        };
        let entries = system.dimension() * system.points();
        let array = || vec![0.0; entries];
        Ok(Self {
            name,
            order,
            limit: tableau.stability_limit(),
            form: StepForm::new(tableau),
            inside: Inside::new(interpolant, tableau),
            predictor,
            refinement: Refinement::new(system, cost, ratio, fine)?,
            everywhere: Zones::all_fine(system.domain()),
            history: History::new(predictor.levels(order), entries),
            work: Work {
                stage: array(),
                velocity: Vec::new(),
                a: (1..tableau.len()).map(|_| array()).collect(),
                first: array(),
                u: array(),
                v: array(),
            },
        })
    }
}

impl Integrator for MultiTimeStep {
    fn name(&self) -> &'static str {
        self.name
    }

    fn vector_length(&self) -> Option<usize> {
        Some(self.work.stage.len())
    }

    fn requirements(&self) -> &'static [Requirement] {
        Self::REQUIREMENTS
    }

    fn order(&self) -> u32 {
        self.order
    }

    fn stability_limit(&self) -> Option<f64> {
        Some(self.limit)
    }

    fn limiting_frequency(
        &self,
        system: &System,
        u: &[f64],
        body: HighestFrequency,
    ) -> Result<HighestFrequency> {
        self.refinement.limiting_frequency(system, u, body)
    }

    fn refinement(&self) -> Option<RefinementReport> {
        Some(self.refinement.report())
    }

    fn start(&mut self, system: &mut System, state: &mut State) {
        state.start(system);
        self.refinement.start(system);
    }

    fn step(
        &mut self,
        system: &mut System,
        state: &mut State,
        t_next: f64,
        _interrupt: Interrupt<'_>,
    ) -> Result<()> {
        self.refinement.update(system, state);
        // The first levels of the predictor come from steps that are fine everywhere.
        let starting = !self.history.is_complete() && self.refinement.zones.count.fine > 0;
        self.refinement.count(starting);
        let step = Step {
            form: &self.form,
            order: self.order,
            predictor: self.predictor,
            inside: &self.inside,
            history: &self.history,
            zones: if starting {
                &self.everywhere
            } else {
                &self.refinement.zones
            },
            ratio: self.refinement.ratio,
            t: state.t,
            t_next,
        };
        step.coarse(system, state, &mut self.work);
        step.fine(system, state, &mut self.work);

        let dt = t_next - state.t;
        let Work { first, u, v, .. } = &mut self.work;
        let end = StepEnd {
            t: t_next,
            dt,
            u,
            path: Path::Cubic {
                u: &state.u,
                v: [&state.v, v],
            },
        };
        system.end_step(&end, v, first);
        std::mem::swap(&mut state.u, u);
        std::mem::swap(&mut state.v, v);
        std::mem::swap(&mut state.a, first);
        // The history takes the arrays of the old state.
        match self.predictor {
            Predictor::Structured => self.history.push(first, dt),
            Predictor::BackwardDifference => self.history.push(v, dt),
        }
        state.close(system, t_next);
        state.step += 1;
        Ok(())
    }
}

/// One coarse step and its data.
struct Step<'a> {
    form: &'a StepForm,
    order: u32,
    predictor: Predictor,
    inside: &'a Inside,
    history: &'a History,
    zones: &'a Zones,
    ratio: u32,
    t: f64,
    t_next: f64,
}

impl Step<'_> {
    /// Computes the step of the coarse points into `work.u`, `work.v`.
    fn coarse(&self, system: &mut System, state: &State, work: &mut Work) {
        let Zones {
            coarse,
            fine_border,
            count,
            ..
        } = self.zones;
        if count.coarse == 0 {
            return;
        }
        let (n, dt) = (system.points(), self.t_next - self.t);
        let State { u, v, a, .. } = state;
        for i in 1..self.form.len() {
            let (before, later) = work.a.split_at_mut(i - 1);
            let x = self.form.nodes[i] * dt;
            self.form
                .stage(
                    i,
                    dt,
                    v,
                    Stages {
                        first: a,
                        later: before,
                    },
                )
                .onto(u, coarse, n, &mut work.stage);
            if !fine_border.is_empty() {
                self.predictor.at(self.order, x, v, a, self.history).onto(
                    u,
                    fine_border,
                    n,
                    &mut work.stage,
                );
            }
            if system.has_boundaries() {
                work.velocity.resize(v.len(), 0.0);
                let known = Stages {
                    first: a,
                    later: before,
                };
                self.form
                    .stage_velocity(i, dt, known)
                    .onto(v, coarse, n, &mut work.velocity);
            }
            let on = coarse.on();
            system.acceleration(self.t + x, &work.stage, &work.velocity, on, &mut later[0]);
        }
        let known = Stages {
            first: a,
            later: &work.a,
        };
        self.form
            .displacement(dt, v, known)
            .onto(u, coarse, n, &mut work.u);
        self.form
            .velocity(dt, known)
            .onto(v, coarse, n, &mut work.v);
        system.place_on(self.t_next, &coarse.on(), &mut work.u);
        system.drive_on(self.t_next, &coarse.on(), &mut work.v);
    }

    /// Computes the sub-steps of the fine points in `work.u`, `work.v`.
    fn fine(&self, system: &mut System, state: &State, work: &mut Work) {
        let Zones {
            fine,
            coarse_border,
            count,
            ..
        } = self.zones;
        if count.fine == 0 {
            return;
        }
        let n = system.points();
        let dt = self.t_next - self.t;
        let h = dt / f64::from(self.ratio);
        let Work {
            stage,
            velocity,
            a,
            first,
            u,
            v,
        } = work;
        Sum::new().onto(&state.u, fine, n, u);
        Sum::new().onto(&state.v, fine, n, v);
        for m in 0..self.ratio {
            let t = self.time(m);
            let opening: &[f64] = if m == 0 { &state.a } else { first };
            for i in 1..self.form.len() {
                let node = self.form.nodes[i];
                self.interpolate(
                    (f64::from(m) + node) / f64::from(self.ratio),
                    state,
                    [u, v],
                    a,
                    stage,
                    n,
                );
                let (before, later) = a.split_at_mut(i - 1);
                self.form
                    .stage(
                        i,
                        h,
                        v,
                        Stages {
                            first: opening,
                            later: before,
                        },
                    )
                    .onto(u, fine, n, stage);
                if system.has_boundaries() {
                    velocity.resize(v.len(), 0.0);
                    let known = Stages {
                        first: opening,
                        later: before,
                    };
                    self.form
                        .stage_velocity(i, h, known)
                        .onto(v, fine, n, velocity);
                }
                system.acceleration(t + node * h, stage, velocity, fine.on(), &mut later[0]);
            }
            let known = Stages {
                first: opening,
                later: a,
            };
            // The displacement needs the old velocity, so it comes first.
            self.form.displacement(h, v, known).add_to(fine, n, u);
            self.form.velocity(h, known).add_to(fine, n, v);
            let t_next = self.time(m + 1);
            system.place_on(t_next, &fine.on(), u);
            system.drive_on(t_next, &fine.on(), v);
            if m + 1 == self.ratio {
                break;
            }
            Sum::new().onto(u, fine, n, stage);
            if !coarse_border.is_empty() {
                self.interpolate(
                    f64::from(m + 1) / f64::from(self.ratio),
                    state,
                    [u, v],
                    a,
                    stage,
                    n,
                );
            }
            let ended = StepEnd::sub_step(t_next, h, stage);
            system.end_step_on(&ended, &fine.on(), first);
            system.finish(t_next, stage, v, &fine.on(), first);
        }
    }

    /// Time at the start of sub-step m.
    fn time(&self, m: u32) -> f64 {
        if m == self.ratio {
            self.t_next
        } else {
            self.t + (self.t_next - self.t) * (f64::from(m) / f64::from(self.ratio))
        }
    }

    /// Interpolates the displacements of coarse points next to fine ones.
    fn interpolate(
        &self,
        theta: f64,
        state: &State,
        [u_next, v_next]: [&[f64]; 2],
        a: &[Vec<f64>],
        stage: &mut [f64],
        n: usize,
    ) {
        let step = CoarseStep {
            dt: self.t_next - self.t,
            u: &state.u,
            v: &state.v,
            u_next,
            v_next,
            a: Stages {
                first: &state.a,
                later: a,
            },
        };
        self.inside
            .at(theta, &step)
            .onto(&state.u, &self.zones.coarse_border, n, stage);
    }
}

crate::saved! {
    impl Checkpointed for MultiTimeStep {
        refinement, history: part,
        name, order, limit, form, inside, predictor, everywhere: fixed,
        work: scratch,
    }
}
