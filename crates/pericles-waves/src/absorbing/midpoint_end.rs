//! Absorbing boundary of a bar for the implicit midpoint rule.

use super::history::History;
use super::{AbsorbingError, LatticeStep, OuterLayer};
use pericles::StepEnd;
use pericles::StepKind;
use pericles::boundary::{Boundary, Exchange, ImplicitBoundary, Stage};

/// Absorbing boundary for the implicit midpoint rule and, because its exterior is linear, the trapezoidal rule.
///
/// Both rules evaluate the exterior forces at the mean ū of the displacements at both ends of a step. For a lattice
/// at rest initially these means satisfy, from the first step on, σ(w) ū = A ū with σ = (4/dt²)((1 − w)/(1 + w))²
/// and no initial terms, so
///
/// ```text
/// ū_{−n}^j = Σ_m Σ_{α ≥ 0} F_n^m[α] ū_m^{j−α}
/// ```
///
/// Since F\[0\] ≠ 0 the ghosts depend on the unknown step. This dependence is eliminated: with T the bonds between
/// outer points and ghosts, the force on the body is T (past) − S ū, where S = diag(Σ a) − T F\[0\] is a symmetric
/// K × K corner added to the matrix of the step ([`ImplicitBoundary`]).
///
/// The work of the boundary over a step is its force at the middle times the change of displacement; with it the
/// energy balance closes as accurately as the balance of the rule.
pub struct MidpointEnd {
    layer: OuterLayer,
    history: Box<dyn History>,
    dt: f64,
    /// S, row by row.
    corner: Vec<f64>,
    /// Force due to the past at the middle of the next step.
    past: Vec<f64>,
    /// Displacements of the outer points in the current state and before the step, and of the ghosts.
    own: Vec<f64>,
    before: Vec<f64>,
    beyond: Vec<f64>,
    /// Force of the ghosts in the current state.
    pull: Vec<f64>,
    /// Means over a step, of the outer points and of the ghosts.
    middle: Vec<f64>,
    ghosts: Vec<f64>,
    started: bool,
}

impl MidpointEnd {
    /// Creates the boundary with a history that determines the ghosts of the layer, with kernels of
    /// [`LatticeScheme::Midpoint`](super::LatticeScheme::Midpoint).
    ///
    /// # Errors
    /// The time step is not positive.
    pub fn new(
        layer: OuterLayer,
        history: Box<dyn History>,
        dt: f64,
    ) -> std::result::Result<Self, AbsorbingError> {
        LatticeStep::midpoint(dt).check(&layer.stencil)?;
        let reach = layer.points.len();
        let mut corner = vec![0.0; reach * reach];
        let (mut unit, mut pull) = (vec![0.0; reach], vec![0.0; reach]);
        for m in 0..reach {
            let mut ghosts = vec![0.0; reach];
            unit[m] = 1.0;
            history.settle(&unit, &mut ghosts);
            layer.pull_into(&unit, &ghosts, &mut pull);
            for (p, pull) in pull.iter().enumerate() {
                corner[p * reach + m] = -pull;
            }
            unit[m] = 0.0;
        }
        let array = || vec![0.0; reach];
        Ok(Self {
            layer,
            history,
            dt,
            corner,
            past: array(),
            own: array(),
            before: array(),
            beyond: array(),
            pull: array(),
            middle: array(),
            ghosts: array(),
            started: false,
        })
    }

    /// Completes the step that moved the outer points from `before` to `own`: work and impulse of the ghosts.
    fn end_step(&mut self) -> Exchange {
        let ends = self.before.iter().zip(&self.own);
        for (middle, (before, now)) in self.middle.iter_mut().zip(ends) {
            *middle = 0.5 * (before + now);
        }
        self.history.ghosts_into(&mut self.ghosts);
        self.history.settle(&self.middle, &mut self.ghosts);
        self.layer
            .pull_into(&self.middle, &self.ghosts, &mut self.pull);
        let mut exchange = Exchange::default();
        for ((pull, before), now) in self.pull.iter().zip(&self.before).zip(&self.own) {
            let force = self.layer.mass * pull;
            exchange.work += force * (now - before);
            exchange.impulse[0] += force * self.dt;
        }
        for (beyond, middle) in self.beyond.iter_mut().zip(&self.ghosts) {
            *beyond = 2.0 * middle - *beyond;
        }
        self.history.push(&self.middle, &self.ghosts);
        exchange
    }

    /// Updates the force of the ghosts in the current state and the force of the past in the next step.
    fn update_pulls(&mut self) {
        self.layer
            .pull_into(&self.own, &self.beyond, &mut self.pull);
        self.middle.fill(0.0);
        self.history.ghosts_into(&mut self.ghosts);
        self.history.settle(&self.middle, &mut self.ghosts);
        self.layer
            .pull_into(&self.middle, &self.ghosts, &mut self.past);
    }

    /// S u for the outer points, with their indices.
    fn corner_product<'a>(&'a self, u: &'a [f64]) -> impl Iterator<Item = (usize, f64)> + 'a {
        let points = &self.layer.points;
        let rows = self.corner.chunks_exact(points.len());
        points.iter().zip(rows).map(move |(&i, row)| {
            let terms = row.iter().zip(points);
            (i, terms.map(|(s, &j)| s * u[j]).sum())
        })
    }
}

impl Boundary for MidpointEnd {
    fn accept(&mut self, step: &StepEnd<'_>) -> Exchange {
        std::mem::swap(&mut self.own, &mut self.before);
        for (own, &i) in self.own.iter_mut().zip(&self.layer.points) {
            *own = step.u[i];
        }
        let exchange = match self.started {
            true => self.end_step(),
            false => Exchange::default(),
        };
        self.started = true;
        self.update_pulls();
        exchange
    }

    fn after_stage(&mut self, _stage: &Stage<'_>, acceleration: &mut [f64]) {
        self.add_present(acceleration);
    }

    fn step_kinds(&self) -> &'static [StepKind] {
        &[StepKind::Middle]
    }

    fn steps(&self) -> Option<u64> {
        self.history.steps()
    }

    fn within_step(&self) -> Option<&dyn ImplicitBoundary> {
        Some(self)
    }
}

impl ImplicitBoundary for MidpointEnd {
    fn add_present(&self, acceleration: &mut [f64]) {
        for (pull, &i) in self.pull.iter().zip(&self.layer.points) {
            acceleration[i] += pull;
        }
    }

    fn add_middle(&self, u: &[f64], acceleration: &mut [f64]) {
        for ((i, product), past) in self.corner_product(u).zip(&self.past) {
            acceleration[i] += past - product;
        }
    }

    fn add_stiffness(&self, u: &[f64], out: &mut [f64]) {
        for (i, product) in self.corner_product(u) {
            out[i] += product;
        }
    }
}

pericles::saved! {
    impl Checkpointed for MidpointEnd {
        own: array("{}/own", layer.name()),
        beyond: array("{}/beyond", layer.name()),
        history: under("{}", layer.name()),
        started: set(true),
        past, pull: rebuilt,
        layer, dt, corner: fixed,
        before, middle, ghosts: scratch,
    } then |end| {
        end.update_pulls();
        Ok(())
    }
}
