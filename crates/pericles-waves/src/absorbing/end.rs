//! The end of a bar that lets waves leave, stepped by velocity Verlet.

use super::history::History;
use super::{AbsorbingError, FreeWave, OuterLayer};
use pericles::StepEnd;
use pericles::StepKind;
use pericles::boundary::{Boundary, Exchange, Stage};

/// Weight of the initial displacement in the history: velocity Verlet starts with half a kick, the trapezoidal rule with half a weight.
const FIRST: f64 = 0.5;

/// An absorbing end: K ghosts beyond the body, whose displacements follow from the history of the body's K outermost points, and the bonds that tie them
/// to the body.
///
/// At each accepted state the ghosts are taken from the history, which knows the steps before only (the ghosts of a step do not depend on the
/// body's displacement in it: kernels start with the first lag), their bonds' forces found, and the state is added to the history. The forces are then part of the acceleration; their
/// work is booked as that of an outer force, so that the energy account closes: what waves carry away is negative work.
pub struct AbsorbingEnd {
    layer: OuterLayer,
    history: Box<dyn History>,
    free: Option<FreeWave>,
    /// Whether the initial displacement has been taken.
    started: bool,
    own: Vec<f64>,
    ghosts: Vec<f64>,
    /// Accelerations by the ghosts' bonds.
    pull: Vec<f64>,
    /// Those of the step before.
    pull_before: Vec<f64>,
}

impl AbsorbingEnd {
    /// An end whose history gives the ghosts of the layer.
    ///
    /// # Errors
    /// A step that is unstable for the exterior.
    pub fn new(
        layer: OuterLayer,
        history: Box<dyn History>,
        dt: f64,
    ) -> std::result::Result<Self, AbsorbingError> {
        layer.stencil.check_step(dt)?;
        let reach = layer.points.len();
        Ok(Self {
            layer,
            history,
            free: None,
            started: false,
            own: vec![0.0; reach],
            ghosts: vec![0.0; reach],
            pull: vec![0.0; reach],
            pull_before: vec![0.0; reach],
        })
    }

    /// With initial fields beyond the end.
    #[must_use]
    pub fn with_free_wave(mut self, free: FreeWave) -> Self {
        self.free = Some(free);
        self
    }

    /// The outer layer.
    pub fn layer(&self) -> &OuterLayer {
        &self.layer
    }

    /// The history.
    pub fn history(&self) -> &dyn History {
        &*self.history
    }

    /// Takes the ghosts of the present from the history, and the present into it.
    fn advance(&mut self) {
        self.history.ghosts_into(&mut self.ghosts);
        if let Some(free) = &mut self.free {
            if self.started {
                free.step();
            }
            for (ghost, (_, beyond)) in self.ghosts.iter_mut().zip(free.outer()) {
                *ghost += beyond;
            }
        }
        std::mem::swap(&mut self.pull, &mut self.pull_before);
        self.layer
            .pull_into(&self.own, &self.ghosts, &mut self.pull);
        // The history is that of what the body sends out.
        for (k, (own, beyond)) in self.free.iter().flat_map(FreeWave::outer).enumerate() {
            self.own[k] -= own;
            self.ghosts[k] -= beyond;
        }
        if !self.started {
            self.own.iter_mut().for_each(|u| *u *= FIRST);
            self.started = true;
        }
        self.history.push(&self.own, &self.ghosts);
    }
}

impl Boundary for AbsorbingEnd {
    fn accept(&mut self, step: &StepEnd<'_>) -> Exchange {
        for (own, &i) in self.own.iter_mut().zip(&self.layer.points) {
            *own = step.u[i];
        }
        self.advance();
        let mut exchange = Exchange::default();
        for (p, &i) in self.layer.points.iter().enumerate() {
            let mean = 0.5 * self.layer.mass * (self.pull[p] + self.pull_before[p]);
            exchange.work += mean * step.mean_velocity(i) * step.dt;
            exchange.impulse[0] += mean * step.dt;
        }
        exchange
    }

    fn after_stage(&mut self, _stage: &Stage<'_>, acceleration: &mut [f64]) {
        for (pull, &i) in self.pull.iter().zip(&self.layer.points) {
            acceleration[i] += pull;
        }
    }

    fn step_kinds(&self) -> &'static [StepKind] {
        &[StepKind::EndOfStep]
    }

    fn steps(&self) -> Option<u64> {
        self.history.steps()
    }
}

pericles::saved! {
    impl Saved for AbsorbingEnd {
        pull: array("{}/pull", layer.name()),
        history: under("{}", layer.name()),
        free: under("{}", layer.name()),
        started: set(true),
        layer: fixed,
        own, ghosts, pull_before: scratch,
    }
}
