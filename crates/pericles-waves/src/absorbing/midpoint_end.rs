//! The end of a bar that lets waves leave, stepped by the implicit midpoint rule.

use super::history::History;
use super::{AbsorbingError, LatticeStep, OuterLayer};
use pericles::StepEnd;
use pericles::StepKind;
use pericles::boundary::{Boundary, Exchange, Stage, WithinStep};

/// An absorbing end for the implicit midpoint rule and, its exterior being linear, the trapezoidal rule.
///
/// Both rules take the exterior's forces at the mean ū of the displacements at both ends of a step. Of a lattice at rest at the start these means obey, from the first step on,
/// σ(w) ū = A ū with σ = (4/dt²)((1 − w)/(1 + w))² and nothing added for the start, so that
///
/// ```text
/// ū_{−n}^j = Σ_m Σ_{α ≥ 0} F_n^m[α] ū_m^{j−α}
/// ```
///
/// F\[0\] ≠ 0: the ghosts hang on the step that is to be found. What they owe to it is eliminated: with T the bonds between outer points and ghosts, the body feels
/// T (past) − S ū, S = diag(Σ a) − T F\[0\], a symmetric K × K corner that is added to the matrix of the step ([`WithinStep`]).
///
/// The work of an end over a step is its force at the middle times the change of displacement; with it the energy account closes as that of the rule does.
pub struct MidpointEnd {
    layer: OuterLayer,
    history: Box<dyn History>,
    dt: f64,
    /// S, row by row.
    corner: Vec<f64>,
    /// What the past alone pulls at the middle of the coming step.
    past: Vec<f64>,
    /// Displacements of the present state: of the outer points, and before the step; of the ghosts.
    own: Vec<f64>,
    before: Vec<f64>,
    beyond: Vec<f64>,
    /// What the ghosts pull in the present state.
    pull: Vec<f64>,
    /// Means over a step: of the outer points; of the ghosts.
    middle: Vec<f64>,
    ghosts: Vec<f64>,
    started: bool,
}

impl MidpointEnd {
    /// An end whose history gives the ghosts of the layer, with the kernels of [`LatticeScheme::Midpoint`](super::LatticeScheme::Midpoint).
    ///
    /// # Errors
    /// A step that is not positive.
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

    /// Ends the step that took the outer points from `before` to `own`: the work and impulse of the ghosts.
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

    /// Finds what the ghosts pull in the present state, and what the past pulls in the coming step.
    fn update_pulls(&mut self) {
        self.layer
            .pull_into(&self.own, &self.beyond, &mut self.pull);
        self.middle.fill(0.0);
        self.history.ghosts_into(&mut self.ghosts);
        self.history.settle(&self.middle, &mut self.ghosts);
        self.layer
            .pull_into(&self.middle, &self.ghosts, &mut self.past);
    }

    /// S u of the outer points, with their places.
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

    fn within_step(&self) -> Option<&dyn WithinStep> {
        Some(self)
    }
}

impl WithinStep for MidpointEnd {
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
    impl Saved for MidpointEnd {
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
