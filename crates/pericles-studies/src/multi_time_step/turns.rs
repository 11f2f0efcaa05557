//! Timing of schemes run in alternation on one body.

use std::time::Instant;

use pericles::space::PointSet;
use pericles::time::{
    Fine, Integrator, Interpolant, MultiTimeStep, MultiTimeStepOptions, Predictor, Respa,
    RungeKutta, State, VelocityVerlet,
};
use pericles::{Interrupt, PericlesError, System};
use pericles_run::Assembly;
use pericles_run::RunError;

use super::problem::{Method, Problem, tableau};
use crate::data::Found;

/// Body with its state, on which schemes are timed.
pub(super) struct Bench {
    pub(super) system: System,
    pub(super) state: State,
    pub(super) dt: f64,
}

impl Bench {
    /// Creates the body of a problem; the coarse step is ω dt = 1.
    pub(super) fn new(problem: Problem<'_>) -> Result<Self, RunError> {
        let Assembly {
            mut system,
            mut state,
            mut integrator,
            frequency,
            dt,
            ..
        } = problem.assembly(Method::Verlet, &[])?;
        integrator.start(&mut system, &mut state);
        Ok(Self {
            dt: frequency.map_or(dt, |frequency| 1.0 / frequency.estimate),
            system,
            state,
        })
    }

    /// Number of points of the body.
    pub(super) fn points(&self) -> u64 {
        self.system.points() as u64
    }

    /// Default multirate options.
    pub(super) fn options(&self, ratio: u32, fine: &PointSet) -> MultiTimeStepOptions {
        MultiTimeStepOptions {
            ratio,
            fine: Fine::Fixed(vec![fine.clone()]),
            predictor: Predictor::Structured,
            interpolant: Interpolant::Hermite,
        }
    }

    /// Time of `steps` steps of a given length, s.
    fn time(
        &mut self,
        integrator: &mut dyn Integrator,
        dt: f64,
        steps: u32,
    ) -> Result<f64, PericlesError> {
        let began = Instant::now();
        for _ in 0..steps {
            let t_next = self.state.t + dt;
            integrator.step(
                &mut self.system,
                &mut self.state,
                t_next,
                Interrupt::never(),
            )?;
        }
        Ok(began.elapsed().as_secs_f64())
    }

    /// Number of point evaluations of `steps` steps after the starting steps.
    pub(super) fn evaluations(
        &mut self,
        integrator: &mut dyn Integrator,
        steps: u32,
    ) -> Result<u64, PericlesError> {
        self.time(integrator, self.dt, 2)?;
        let before = self.system.evaluated_points();
        self.time(integrator, self.dt, steps)?;
        Ok(self.system.evaluated_points() - before)
    }
}

/// Seconds per coarse step of schemes run in alternation.
pub(super) struct Turns {
    /// Multirate RK4.
    pub(super) two: f64,
    /// RK4 with the fine step everywhere.
    pub(super) uniform: f64,
    /// Velocity Verlet with the fine step everywhere.
    pub(super) verlet: f64,
    /// r-RESPA.
    pub(super) respa: f64,
}

impl Turns {
    /// Speed-up of multirate RK4 compared with the fine step everywhere.
    pub(super) fn speed_up(&self) -> f64 {
        self.uniform / self.two
    }

    /// Ratios of the times.
    pub(super) fn ratios(&self) -> Found {
        [
            ("speed-up", self.speed_up()),
            ("Verlet", self.verlet / self.two),
            ("r-RESPA", self.verlet / self.respa),
        ]
        .into()
    }

    /// Times the schemes in several rounds of several coarse steps each.
    pub(super) fn take(
        bench: &mut Bench,
        ratio: u32,
        fine: &PointSet,
        [rounds, steps]: [u32; 2],
    ) -> Result<Self, RunError> {
        let options = bench.options(ratio, fine);
        let regions = options.fine.clone();
        let rk4 = tableau(4)?;
        let mut two = MultiTimeStep::new(&rk4, options, &bench.system)?;
        let mut uniform = RungeKutta::new(&rk4, &bench.system);
        let mut respa = Respa::new(ratio, regions, &bench.system)?;
        let (dt, h) = (bench.dt, bench.dt / f64::from(ratio));
        // Warm-up: cold caches, starting steps, and the separate accelerations of r-RESPA.
        bench.time(&mut two, dt, 2)?;
        let mut times: [Vec<f64>; 4] = Default::default();
        for _ in 0..rounds {
            let round = [
                bench.time(&mut two, dt, steps)?,
                bench.time(&mut uniform, h, steps * ratio)?,
                bench.time(&mut VelocityVerlet, h, steps * ratio)?,
                {
                    respa.start(&mut bench.system, &mut bench.state);
                    bench.time(&mut respa, dt, steps)?
                },
            ];
            for (times, seconds) in times.iter_mut().zip(round) {
                times.push(seconds / f64::from(steps));
            }
        }
        // The minimum over the rounds: other load on the machine only adds to a time.
        let [two, uniform, verlet, respa] =
            times.map(|times| times.into_iter().fold(f64::INFINITY, f64::min));
        Ok(Self {
            two,
            uniform,
            verlet,
            respa,
        })
    }
}
