//! Absorbing boundary of a bar for velocity Verlet.

use super::history::History;
use super::{AbsorbingError, FreeWave, OuterLayer};
use pericles::StepEnd;
use pericles::StepKind;
use pericles::boundary::{Boundary, Exchange, Stage};

/// Weight of the initial displacement in the history convolution: velocity Verlet starts with half a kick, the
/// trapezoidal rule with half a weight.
const FIRST: f64 = 0.5;

/// Absorbing boundary: K ghost points beyond the body and their bonds to it. The ghost displacements follow from
/// the history of the body's K outermost points.
///
/// At each accepted state the ghost displacements are computed from the history of previous steps (kernels start at
/// lag one, so the ghosts do not depend on the body's current displacement), the forces of their bonds are
/// evaluated, and the state is appended to the history. The forces enter the acceleration. Their work is recorded
/// as external work, so that the energy balance closes: the energy carried away by waves is negative work.
pub struct AbsorbingEnd {
    layer: OuterLayer,
    history: Box<dyn History>,
    free: Option<FreeWave>,
    /// True once the initial displacement has been recorded.
    started: bool,
    own: Vec<f64>,
    ghosts: Vec<f64>,
    /// Accelerations by bonds to ghosts.
    pull: Vec<f64>,
    /// Accelerations by bonds to ghosts in the previous step.
    pull_before: Vec<f64>,
}

impl AbsorbingEnd {
    /// Creates the boundary with a history that determines the ghosts of the layer.
    ///
    /// # Errors
    /// The time step is unstable for the exterior.
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

    /// Adds initial fields beyond the boundary.
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

    /// Computes the current ghosts from the history and appends the current state to it.
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
        // The history contains only the displacement radiated by the body.
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
    impl Checkpointed for AbsorbingEnd {
        pull: array("{}/pull", layer.name()),
        history: under("{}", layer.name()),
        free: under("{}", layer.name()),
        started: set(true),
        layer: fixed,
        own, ghosts, pull_before: scratch,
    }
}
