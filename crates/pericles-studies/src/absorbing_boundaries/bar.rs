//! The bar of the paper: x = −10 … 10 with 201 nodes, E = ρ = 1, Gaussian micromodulus with δ = 0.25 truncated
//! after 7 nodes.

use std::f64::consts::PI;
use std::sync::Arc;

use pericles::boundary::{MotionKind, PrescribedMotion, TimeCourse, TimeFunction};
use pericles::family::{BondList, VolumeCorrection};
use pericles::material::LinearBond;
use pericles::operator::{BondForce, Breaking, DamageMeasure, PointSubset};
use pericles::time::{State, VelocityVerlet};
use pericles::{
    Archive, Checkpointed, Control, Outcome, PericlesError, PointScalar, Simulation, System, Values,
};
use pericles_run::RunError;
use pericles_waves::absorbing::history::BlockedHistory;
use pericles_waves::absorbing::{
    AbsorbingEnd, GhostKernels, LatticeStencil, LatticeStep, OuterLayer, Side, contour_kernels,
    semi_discrete_kernels,
};

use crate::common::cells;

pub(super) const SPACING: f64 = 0.1;
/// Number of nodes from the middle to an end.
pub(super) const HALF: usize = 100;
const REACH: usize = 7;
/// Displaced node of [`Source::Node`], beside the middle.
pub(super) const NODE: usize = HALF - 30;
/// Half the width of the soft part; nodes on its boundary are hard.
const SOFT: f64 = 4.0;
const WAVELET: Ricker = Ricker {
    frequency: 0.2,
    delay: 5.0,
};
/// Release time of the node, s. The text says 5; the printed errors correspond to 10.
const RELEASE: f64 = 10.0;

/// Ricker wavelet (1 − 2q) exp(−q), q = π² f² (t − delay)².
#[derive(Debug)]
struct Ricker {
    frequency: f64,
    delay: f64,
}

impl Ricker {
    /// Returns π² f², the time from the peak, q and exp(−q).
    fn parts(&self, t: f64) -> [f64; 4] {
        let c = (PI * self.frequency).powi(2);
        let tau = t - self.delay;
        let q = c * tau * tau;
        [c, tau, q, (-q).exp()]
    }
}

impl TimeCourse for Ricker {
    fn value(&self, t: f64) -> f64 {
        let [_, _, q, bell] = self.parts(t);
        (1.0 - 2.0 * q) * bell
    }

    fn derivative(&self, t: f64) -> f64 {
        let [c, tau, q, bell] = self.parts(t);
        (4.0 * q - 6.0) * c * tau * bell
    }

    fn second_derivative(&self, t: f64) -> f64 {
        let [c, _, q, bell] = self.parts(t);
        (24.0 * q - 6.0 - 8.0 * q * q) * c * bell
    }

    fn integral(&self, t: f64) -> f64 {
        let primitive = |t: f64| {
            let [_, tau, _, bell] = self.parts(t);
            tau * bell
        };
        primitive(t) - primitive(0.0)
    }
}

/// Micromodulus C(ξ) = 4E/(δ³ √π) exp(−ξ²/δ²).
pub(super) fn micromodulus(xi: f64) -> f64 {
    const DELTA: f64 = 0.25;
    4.0 / (DELTA.powi(3) * PI.sqrt()) * (-(xi / DELTA).powi(2)).exp()
}

/// Lattice of the hard material.
pub(super) fn stencil() -> Result<LatticeStencil, RunError> {
    let weights: Vec<f64> = (1..=REACH)
        .map(|k| micromodulus(k as f64 * SPACING) * SPACING)
        .collect();
    Ok(LatticeStencil::new(&weights).map_err(PericlesError::from)?)
}

/// Excitation of the bar.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Source {
    /// Initial displacement u = exp(−x²).
    Bell,
    /// Displacement of one of the node [`NODE`].
    Node,
    /// Ricker wavelet prescribed at x = 0, released when it is over.
    Wavelet,
    /// No excitation.
    Rest,
}

/// Bar of the paper.
#[derive(Clone, Copy)]
pub(super) struct Bar {
    pub(super) source: Source,
    /// Stiffness of bonds with an end in the soft part.
    pub(super) beta: f64,
    /// Sides with absorbing boundaries; the others are free.
    pub(super) sides: &'static [Side],
    /// Additional nodes on each side, for comparison with large bodies.
    pub(super) margin: usize,
}

/// Kernels of a boundary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    /// Kernels of the paper: semi-discrete, trapezoidal rule.
    SemiDiscrete,
    /// Kernels exact for the scheme.
    Discrete,
}

pub(super) fn kernels(kind: Kind, dt: f64, steps: usize) -> Result<GhostKernels, RunError> {
    let stencil = stencil()?;
    Ok(match kind {
        Kind::SemiDiscrete => semi_discrete_kernels(&stencil, dt, steps),
        Kind::Discrete => {
            GhostKernels::shift(contour_kernels(&stencil, LatticeStep::verlet(dt), steps))
        }
    })
}

/// Absorbing on the left, free on the right, excited in the middle.
pub(super) const SEISMIC_BAR: Bar = Bar {
    source: Source::Wavelet,
    beta: 1.0,
    sides: &[Side::Left],
    margin: 0,
};

impl Bar {
    /// Bar with absorbing boundaries at both ends.
    pub(super) const fn infinite(beta: f64) -> Self {
        Self {
            source: Source::Bell,
            beta,
            sides: &[Side::Left, Side::Right],
            margin: 0,
        }
    }

    /// Equation of motion without absorbing boundaries, and the initial state.
    pub(super) fn system(&self) -> Result<(System, State), RunError> {
        let half = HALF + self.margin;
        let origin = [-(half as f64 + 0.5) * SPACING, 0.0, 0.0];
        let size = vec![(2 * half + 1) as f64 * SPACING];
        let cloud = Arc::new(cells(origin, size, SPACING)?);
        let horizon = (REACH as f64 + 0.5) * SPACING;
        let bonds = BondList::new(&cloud, horizon, VolumeCorrection::None)?;
        let x = cloud.axis(0).to_vec();
        let hard = |i: usize| x[i].abs() > SOFT - 1e-9;
        let stiffness = |i: usize, j: usize, xi: [f64; 3]| {
            let share = if hard(i) && hard(j) { 1.0 } else { self.beta };
            share * micromodulus(xi[0]) * xi[0].abs()
        };
        let breaking = Breaking {
            critical_stretch: f64::INFINITY,
            no_fail: &[],
        };
        let damage = DamageMeasure::default();
        let force = BondForce::<LinearBond, 1>::with_pair_stiffness(
            Arc::clone(&cloud),
            bonds,
            &stiffness,
            breaking,
            damage,
        )?;
        let density = PointScalar::Uniform(1.0);
        let mut system = System::new(Arc::clone(&cloud), Box::new(force), density)?;
        let mut state = State::at_rest(cloud.len());
        match self.source {
            Source::Bell => {
                for (u, x) in state.u.iter_mut().zip(&x) {
                    *u = (-x * x).exp();
                }
            }
            Source::Node => state.u[NODE + self.margin] = 1.0,
            Source::Rest => {}
            Source::Wavelet => {
                let motion = PrescribedMotion::new(
                    "source".into(),
                    vec![half as u32],
                    MotionKind::Displacement,
                    [Some(1.0), None, None],
                    TimeFunction::Course(Arc::new(WAVELET)),
                    &state.u,
                    cloud.len(),
                )?;
                system.add_motion(motion)?;
            }
        }
        Ok((system, state))
    }

    /// Creates a run of the given number of steps with absorbing boundaries.
    pub(super) fn simulation(
        &self,
        kernels: &GhostKernels,
        dt: f64,
        steps: u64,
    ) -> Result<Simulation, RunError> {
        let (mut system, state) = self.system()?;
        for &side in self.sides {
            let end = OuterLayer::of(&system, side, &state, &[])
                .and_then(|layer| {
                    let history = Box::new(BlockedHistory::new(kernels.clone()));
                    AbsorbingEnd::new(layer, history, dt)
                })
                .map_err(PericlesError::from)?;
            system.add_boundary(Box::new(end));
        }
        Ok(Simulation::new(
            system,
            Box::new(VelocityVerlet),
            state,
            dt,
            steps,
        )?)
    }

    /// Runs and calls the observer with every state but the first.
    pub(super) fn follow(
        &self,
        kernels: &GhostKernels,
        dt: f64,
        steps: u64,
        mut visit: impl FnMut(&State),
    ) -> Result<(), RunError> {
        let release = match self.source {
            Source::Wavelet => (RELEASE / dt).round() as u64,
            Source::Bell | Source::Node | Source::Rest => steps,
        };
        let mut simulation = self.simulation(kernels, dt, steps)?;
        let mut run = |simulation: &mut Simulation, until: u64| -> Result<(), RunError> {
            let outcome = simulation.run(|now| {
                visit(now.state());
                match now.state().step == until {
                    true => Control::Stop,
                    false => Control::Continue,
                }
            });
            let outcome = outcome.map_err(|error| RunError::of_run(error, String::new))?;
            // The observer is not called for the last state of a run.
            if outcome == Outcome::Finished {
                visit(simulation.state());
            }
            Ok(())
        };
        run(&mut simulation, release)?;
        if simulation.state().step < steps {
            simulation = self.released(&simulation, kernels, dt, steps)?;
            run(&mut simulation, steps)?;
        }
        Ok(())
    }

    /// Continues the run with the node free: with the displacement and velocity prescribed last, and the
    /// acceleration of a free node.
    fn released(
        &self,
        held: &Simulation,
        kernels: &GhostKernels,
        dt: f64,
        steps: u64,
    ) -> Result<Simulation, RunError> {
        let rest = Self {
            source: Source::Rest,
            ..*self
        };
        let State { t, u, a, .. } = held.state();
        let node = HALF + self.margin;
        let mut free = a.clone();
        let here = PointSubset::Range(node..node + 1);
        rest.system()?.0.free_acceleration(*t, u, &here, &mut free);
        let mut archive = Archive::default();
        held.save(&mut archive);
        archive.put("state/a", Values::F64(free));
        let mut simulation = rest.simulation(kernels, dt, steps)?;
        simulation.restore(&archive)?;
        Ok(simulation)
    }

    /// States at the given ascending times with time step dt.
    pub(super) fn states(
        &self,
        kind: Kind,
        dt: f64,
        times: &[f64],
    ) -> Result<Vec<State>, RunError> {
        let number = |t: &f64| (t / dt).round() as u64;
        let steps: Vec<u64> = times.iter().map(number).collect();
        let last = steps.last().copied().unwrap_or_default();
        let kernels = kernels(kind, dt, last as usize)?;
        let mut states = Vec::new();
        self.follow(&kernels, dt, last, |state| {
            if steps.contains(&state.step) {
                states.push(state.clone());
            }
        })?;
        Ok(states)
    }

    /// Solution in continuous time at the given times, by Richardson extrapolation of two runs with exact
    /// boundaries, whose errors are those of the scheme only.
    pub(super) fn reference(&self, times: &[f64]) -> Result<Vec<State>, RunError> {
        /// The remaining error is of fourth order: some 1e-12.
        const DT: f64 = 0.002;
        let coarse = self.states(Kind::Discrete, DT, times)?;
        let mut fine = self.states(Kind::Discrete, 0.5 * DT, times)?;
        for (fine, coarse) in fine.iter_mut().zip(&coarse) {
            for (fine, coarse) in [(&mut fine.u, &coarse.u), (&mut fine.v, &coarse.v)] {
                for (x, y) in fine.iter_mut().zip(coarse) {
                    *x += (*x - y) / 3.0;
                }
            }
        }
        Ok(fine)
    }
}
