//! Absorbing boundary of a strip.

use realfft::num_complex::Complex;

use super::lattice::{Matrix, StripLattice};
use crate::absorbing::history::{BlockedHistory, History};
use crate::absorbing::{GhostKernels, Side};
use crate::linear::LineTransform;
use pericles::StepEnd;
use pericles::StepKind;
use pericles::boundary::{Boundary, Exchange, Stage};

/// Weight of the initial displacement in the history, as for bars.
const FIRST: f64 = 0.5;

/// Absorbing boundary of a strip: one history of 2K × 2K kernels for each Fourier mode along y, for real and
/// imaginary parts.
pub struct StripEnd {
    side: Side,
    lattice: StripLattice,
    entries: usize,
    modes: Vec<Mode>,
    /// Diagonal stiffness of a point of each outer column due to its bonds to ghosts.
    beyond: Vec<[f64; 2]>,
    transform: LineTransform,
    line: Vec<f64>,
    spectrum: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
    /// Accelerations of the outer columns by bonds to ghosts, by depth, component and row; in the current and the
    /// previous step.
    pull: Vec<f64>,
    pull_before: Vec<f64>,
    started: bool,
}

/// Fourier mode; parts are real and imaginary, entries 2 · place + component.
struct Mode {
    /// C_1 … C_K.
    couplings: Vec<Matrix>,
    histories: [BlockedHistory; 2],
    own: [Vec<f64>; 2],
    ghosts: Vec<f64>,
    pull: [Vec<f64>; 2],
}

impl StripEnd {
    /// Creates the boundary of a body at rest initially in its K outermost columns, which must be free of loads and
    /// constraints, for a number of steps of velocity Verlet; `entries` is the number of unknowns of the body.
    pub fn new(
        lattice: StripLattice,
        side: Side,
        entries: usize,
        kernels: &[GhostKernels],
    ) -> Self {
        let (reach, rows) = (lattice.reach(), lattice.rows());
        let transform = LineTransform::new(rows);
        let mode = |(q, kernels): (usize, &GhostKernels)| {
            let zeros = || vec![0.0; 2 * reach];
            Mode {
                couplings: lattice.couplings(q)[1..].to_vec(),
                histories: [(); 2].map(|()| BlockedHistory::new(kernels.clone())),
                own: [zeros(), zeros()],
                ghosts: zeros(),
                pull: [zeros(), zeros()],
            }
        };
        Self {
            side,
            entries,
            beyond: (1..=reach)
                .map(|nearest| lattice.stiffness_beyond(nearest))
                .collect(),
            modes: kernels.iter().enumerate().map(mode).collect(),
            line: vec![0.0; rows],
            spectrum: vec![Complex::default(); transform.modes()],
            scratch: transform.scratch(),
            transform,
            pull: vec![0.0; 2 * reach * rows],
            pull_before: vec![0.0; 2 * reach * rows],
            started: false,
            lattice,
        }
    }

    /// Memory of the histories, bytes.
    pub fn bytes(&self) -> usize {
        let histories = self.modes.iter().flat_map(|mode| &mode.histories);
        histories.map(History::bytes).sum()
    }

    fn entry(&self, component: usize, point: usize) -> usize {
        component * (self.entries / 2) + point
    }

    /// Transforms the displacements of the outer columns to modes.
    fn transform_in(&mut self, u: &[f64]) {
        for depth in 0..self.lattice.reach() {
            for component in 0..2 {
                for row in 0..self.line.len() {
                    let entry = self.entry(component, self.lattice.points[depth][row]);
                    self.line[row] = u[entry];
                }
                self.transform
                    .forward(&mut self.line, &mut self.spectrum, &mut self.scratch);
                for (mode, u) in self.modes.iter_mut().zip(&self.spectrum) {
                    // v = (û_x, i û_y)
                    let v = [*u, Complex::<f64>::i() * *u][component];
                    let place = 2 * depth + component;
                    mode.own[0][place] = v.re;
                    mode.own[1][place] = v.im;
                }
            }
        }
    }

    /// Transforms the accelerations of the modes to the outer columns.
    fn transform_out(&mut self) {
        let rows = self.line.len();
        for place in 0..2 * self.lattice.reach() {
            for (u, mode) in self.spectrum.iter_mut().zip(&self.modes) {
                let v = Complex::new(mode.pull[0][place], mode.pull[1][place]);
                *u = [v, -Complex::<f64>::i() * v][place % 2] / rows as f64;
            }
            self.transform
                .inverse(&mut self.spectrum, &mut self.line, &mut self.scratch);
            self.pull[place * rows..(place + 1) * rows].copy_from_slice(&self.line);
        }
    }
}

impl Mode {
    /// Computes the current ghosts from the histories, and appends the current state to them with a weight.
    fn advance(&mut self, beyond: &[[f64; 2]], weight: f64) {
        for part in 0..2 {
            let (own, pull) = (&mut self.own[part], &mut self.pull[part]);
            let history = &mut self.histories[part];
            history.ghosts_into(&mut self.ghosts);
            for (p, stiffness) in beyond.iter().enumerate() {
                for a in 0..2 {
                    let bonds = self.couplings[p..].iter().zip(self.ghosts.chunks_exact(2));
                    let towards: f64 = bonds.map(|(c, g)| c[a][0] * g[0] + c[a][1] * g[1]).sum();
                    pull[2 * p + a] = towards - stiffness[a] * own[2 * p + a];
                }
            }
            own.iter_mut().for_each(|u| *u *= weight);
            history.push(own, &self.ghosts);
        }
    }
}

impl Boundary for StripEnd {
    fn accept(&mut self, step: &StepEnd<'_>) -> Exchange {
        self.transform_in(step.u);
        std::mem::swap(&mut self.pull, &mut self.pull_before);
        let weight = if self.started { 1.0 } else { FIRST };
        self.started = true;
        for mode in &mut self.modes {
            mode.advance(&self.beyond, weight);
        }
        self.transform_out();
        let mut exchange = Exchange::default();
        let rows = self.line.len();
        for (k, (now, before)) in self.pull.iter().zip(&self.pull_before).enumerate() {
            let (depth, component, row) = (k / (2 * rows), k / rows % 2, k % rows);
            let entry = self.entry(component, self.lattice.points[depth][row]);
            let impulse = 0.5 * self.lattice.mass * (now + before) * step.dt;
            exchange.work += impulse * step.mean_velocity(entry);
            exchange.impulse[component] += impulse;
        }
        exchange
    }

    fn after_stage(&mut self, _stage: &Stage<'_>, acceleration: &mut [f64]) {
        let rows = self.line.len();
        for (k, pull) in self.pull.iter().enumerate() {
            let (depth, component, row) = (k / (2 * rows), k / rows % 2, k % rows);
            acceleration[self.entry(component, self.lattice.points[depth][row])] += pull;
        }
    }

    fn step_kinds(&self) -> &'static [StepKind] {
        &[StepKind::EndOfStep]
    }

    fn steps(&self) -> Option<u64> {
        self.modes
            .first()
            .and_then(|mode| mode.histories[0].steps())
    }
}

pericles::saved! {
    impl Checkpointed for StripEnd {
        pull: array("strip/{}/pull", side.name()),
        modes: under("strip/{}", side.name()),
        started: set(true),
        side, lattice, entries, beyond, transform: fixed,
        line, spectrum, scratch, pull_before: scratch,
    }
}

pericles::saved! {
    impl SavedUnder(name) for Mode {
        histories: under("{name}"),
        couplings: fixed,
        own, ghosts, pull: scratch,
    }
}
