//! Trigonometric integrators: the exact flow of the linear part.
//!
//! The step adds increments to u and v, with the acceleration that is already computed. Rigid motion and constant
//! loads are exact, nothing is inverted, and no root of a matrix is needed, because all functions are entire in W².

mod engine;

use rayon::prelude::*;

pub use engine::FunctionMethod;

use crate::function::{Term, WaveFunction};
use engine::{Engine, NAME, add, apply, engine, subtract};
use pericles::Interrupt;
use pericles::StepKind;
use pericles::System;
use pericles::operator::PointSubset;
use pericles::parallel::BLOCK;
use pericles::time::{Integrator, State};
use pericles::{Need, Requirement, require};
use pericles::{PericlesError, Result};

/// Quadrature of time-dependent loads within a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LoadRule {
    /// Two Gauss nodes: order four.
    #[default]
    Gauss,
    /// Midpoint: order two.
    Midpoint,
}

/// Options of a [`Trigonometric`] integrator.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TrigonometricOptions {
    /// Method for functions of the stiffness.
    pub functions: FunctionMethod,
    /// Quadrature of loads.
    pub load_rule: LoadRule,
    /// Added to all eigenvalues ω², 1/s². Never required, and introduces an error; for comparison with methods that
    /// divide by W.
    pub regularisation: f64,
}

/// Trigonometric integrator: u′ = u + τ sinc(τW) v + (1 − cos τW) W⁻² a, v′ = cos(τW) v + τ sinc(τW) a, with W² =
/// K/ρ and a = −W²u + b/ρ at the start of the step.
///
/// Exact for linear forces and constant loads with any time step: one step may cover any time. Loads that vary within
/// the step contribute by the difference from its start, r(s) = b(t+s) − b(t) over ρ, as
/// Σ_k w_k [ sin((τ−s_k)W)/W r(s_k), cos((τ−s_k)W) r(s_k) ] with the Gauss nodes s_k (order 4) or the midpoint
/// (order 2).
///
/// The displacement of moving supports within the step is a cubic in time through its values at the start, both thirds and
/// the end. Its force on the body, which grows with the stiffness, is integrated exactly, so that the step may be
/// longer than the periods of the body.
///
/// Nonlinear forces are split into K, the tangent at the reference, and a remainder g, which changes the velocity
/// by τg/(2ρ) before and after the step of the linear part: second order, symmetric and symplectic (Deuflhard 1979;
/// Hairer, Lubich & Wanner, Geometric Numerical Integration, XIII.1), and stable as long as τ² times the
/// remainder's stiffness over ρ is small, however stiff the linear part is. Prescribed motion of nonlinear bodies
/// is then of second order as well.
///
/// Cost of a step: two applications of the functions (four with time-dependent loads), each some τω/2 products with
/// K by Chebyshev series.
///
/// Source: the schemes of Coclite, Fanizzi, Lopez, Maddalena & Pellegrino, Appl. Numer. Math. 155 (2020) 119–139,
/// written in increments, so that constant loads and rigid motions are exact and no inverse is needed; the second
/// load node of their order-4 scheme is misprinted.
pub struct Trigonometric {
    options: TrigonometricOptions,
    engine: Engine,
    /// Number of prescribed motions that constrained their points when the functions were created.
    held: u64,
    linear: bool,
    /// Displacement about which forces are linearised: zero.
    reference: Vec<f64>,
    push: Vec<f64>,
    pull: Vec<f64>,
    remainder: Vec<f64>,
    change: Vec<f64>,
    next: [Vec<f64>; 2],
}

impl Trigonometric {
    /// Requirements on a system.
    pub const REQUIREMENTS: &'static [Requirement] = &[
        Requirement {
            need: Need::WholeBody,
            reason: "one of its steps couples all points, but the body is divided among several processes; use velocity-verlet, or run it on one process with threads",
        },
        Requirement {
            need: Need::NoMemory,
            reason: "the cosine of the stiffness extends much farther in one step than the ghosts of a boundary with memory, \
                which are as many as the horizon has points; use velocity-verlet",
        },
        Requirement {
            need: Need::NoInteractions,
            reason: "it is exact for the linear part of the force, but contacts open and close within a step; use velocity-verlet",
        },
    ];

    /// Creates the scheme for a body.
    ///
    /// # Errors
    /// A body without stiffness or with boundaries that have a memory; a negative regularisation;
    /// [`FunctionMethod::Fourier`] if the operator is not diagonal in plane waves.
    pub fn new(options: TrigonometricOptions, system: &System) -> Result<Self> {
        let regularisation = options.regularisation;
        if !(regularisation.is_finite() && regularisation >= 0.0) {
            return Err(PericlesError::SchemeParameter {
                parameter: "the regularisation of the trigonometric scheme",
                value: regularisation,
                allowed: "zero (the default, recommended) or a positive number, 1/s²",
            });
        }
        require(NAME, Self::REQUIREMENTS, system)?;
        let entries = system.dimension() * system.points();
        let array = || vec![0.0; entries];
        let reference = array();
        let engine = engine((options.functions, regularisation), system, &reference, 0.0)?;
        let linear = system.operator().as_linear().is_some();
        Ok(Self {
            options,
            engine,
            held: system.holding(0.0),
            linear,
            reference,
            push: array(),
            pull: array(),
            remainder: if linear { Vec::new() } else { array() },
            change: array(),
            next: [array(), array()],
        })
    }

    /// Recreates the functions if they depend on the constrained points and some have been released.
    fn follow_supports(&mut self, system: &System, t_next: f64) -> Result<()> {
        let held = system.holding(t_next);
        if held != self.held && self.options.functions == FunctionMethod::Eigenvectors {
            let functions = (self.options.functions, self.options.regularisation);
            self.engine = engine(functions, system, &self.reference, t_next)?;
        }
        self.held = held;
        Ok(())
    }

    /// Splits the acceleration in `pull` into the linear part, which stays there, and the remainder.
    fn split(&mut self, system: &System, [t, t_next]: [f64; 2], u: &[f64]) {
        system.vibration_at(t_next, &self.reference, u, &mut self.remainder);
        system.external_acceleration_into(t, &mut self.change);
        system.hold_at(t_next, &mut self.change);
        self.remainder
            .par_chunks_mut(BLOCK)
            .zip(self.pull.par_chunks_mut(BLOCK))
            .zip(self.change.par_chunks(BLOCK))
            .for_each(|((remainder, pull), external)| {
                for ((remainder, pull), external) in remainder.iter_mut().zip(pull).zip(external) {
                    let linear = external - *remainder;
                    *remainder = *pull - linear;
                    *pull = linear;
                }
            });
    }

    /// Computes r for the second of three times (start, node and end of the step); returns false if nothing varies.
    fn change_into(&mut self, system: &System, t: [f64; 3]) -> bool {
        let [push, change] = [&mut self.push, &mut self.change];
        system.external_acceleration_into(t[1], change);
        system.external_acceleration_into(t[0], push);
        subtract(change, push);
        system.hold_at(t[2], change);
        change.iter().any(|x| *x != 0.0)
    }

    /// Adds the effect of the motion of supports within the step.
    fn supports(
        &mut self,
        system: &System,
        [t, tau]: [f64; 2],
        u: &[f64],
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        /// Coefficients of s/τ, (s/τ)² and (s/τ)³ of the cubic with the values y at s = τ/3, 2τ/3 and τ, and zero at s = 0.
        const CUBIC: [[f64; 3]; 3] = [[9.0, -4.5, 1.0], [-22.5, 18.0, -4.5], [13.5, -13.5, 4.5]];
        const FUNCTIONS: [[WaveFunction; 2]; 3] = [
            [WaveFunction::Ramp, WaveFunction::Versine],
            [WaveFunction::Parabola, WaveFunction::Ramp],
            [WaveFunction::Cubic, WaveFunction::Parabola],
        ];
        if system.motions().is_empty() {
            return Ok(());
        }
        let t_next = t + tau;
        let mut factor = 1.0;
        for (power, (row, [of_u, of_v])) in CUBIC.iter().zip(FUNCTIONS).enumerate() {
            // (s/τ)^k = k!/τ^k · s^k/k!
            factor *= (power + 1) as f64 / tau;
            self.push.fill(0.0);
            for (node, weight) in row.iter().enumerate() {
                let moved = &mut self.pull;
                moved.copy_from_slice(u);
                let at = match node {
                    2 => t_next,
                    node => t + tau * (node + 1) as f64 / 3.0,
                };
                system.place_on(at, &PointSubset::All, moved);
                subtract(moved, u);
                add(&mut self.push, *weight, moved);
            }
            // Points that are released within the step are free during all of it.
            self.pull.copy_from_slice(&self.push);
            system.hold_at(t_next, &mut self.pull);
            subtract(&mut self.push, &self.pull);
            if self.push.iter().all(|x| *x == 0.0) {
                continue;
            }
            system.vibration_at(t_next, &self.reference, &self.push, &mut self.change);
            let [u_next, v_next] = &mut self.next;
            let terms = [
                Term::times(-factor, of_u, tau, u_next),
                Term::times(-factor, of_v, tau, v_next),
            ];
            apply(
                (&mut self.engine, self.options.regularisation),
                system,
                (&self.reference, t_next),
                (&self.change, terms),
                interrupt,
            )?;
        }
        Ok(())
    }

    fn flow(
        &mut self,
        system: &System,
        [t, t_next]: [f64; 2],
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let tau = t_next - t;
        let [u, v] = &mut self.next;
        let by_velocity = [
            Term::new(WaveFunction::Sine, tau, u),
            Term::new(WaveFunction::Cosine, tau, v),
        ];
        apply(
            (&mut self.engine, self.options.regularisation),
            system,
            (&self.reference, t_next),
            (&self.push, by_velocity),
            interrupt,
        )?;
        let by_force = [
            Term::new(WaveFunction::Versine, tau, u),
            Term::new(WaveFunction::Sine, tau, v),
        ];
        apply(
            (&mut self.engine, self.options.regularisation),
            system,
            (&self.reference, t_next),
            (&self.pull, by_force),
            interrupt,
        )
    }

    fn loads(
        &mut self,
        system: &System,
        [t, tau]: [f64; 2],
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        if system.loads().is_empty() {
            return Ok(());
        }
        let gauss = 0.5 / 3.0f64.sqrt();
        let nodes: &[(f64, f64)] = match self.options.load_rule {
            LoadRule::Gauss => &[(0.5 - gauss, 0.5), (0.5 + gauss, 0.5)],
            LoadRule::Midpoint => &[(0.5, 1.0)],
        };
        for (node, weight) in nodes {
            if self.change_into(system, [t, t + node * tau, t + tau]) {
                let left = (1.0 - node) * tau;
                let [u, v] = &mut self.next;
                let terms = [
                    Term::times(weight * tau, WaveFunction::Sine, left, u),
                    Term::times(weight * tau, WaveFunction::Cosine, left, v),
                ];
                apply(
                    (&mut self.engine, self.options.regularisation),
                    system,
                    (&self.reference, t + tau),
                    (&self.change, terms),
                    interrupt,
                )?;
            }
        }
        Ok(())
    }
}

impl Integrator for Trigonometric {
    fn name(&self) -> &'static str {
        NAME
    }

    fn vector_length(&self) -> Option<usize> {
        Some(self.next[0].len())
    }

    fn requirements(&self) -> &'static [Requirement] {
        Self::REQUIREMENTS
    }

    fn step_kind(&self) -> StepKind {
        StepKind::Flow
    }

    fn order(&self) -> u32 {
        match self.options.load_rule {
            LoadRule::Gauss if self.linear => 4,
            _ => 2,
        }
    }

    fn stability_limit(&self) -> Option<f64> {
        None
    }

    fn intended_drift(&self) -> Option<&'static str> {
        (self.options.regularisation > 0.0).then_some(
            "regularisation adds a stiffness to the ground, whose energy the scheme conserves for any time step; \
            with regularisation = 0 it conserves the energy of the body",
        )
    }

    fn start(&mut self, system: &mut System, state: &mut State) {
        state.start(system);
    }

    fn step(
        &mut self,
        system: &mut System,
        state: &mut State,
        t_next: f64,
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let State { t, u, v, a, .. } = state;
        let (times, dt) = ([*t, t_next], t_next - *t);
        self.follow_supports(system, t_next)?;
        self.push.copy_from_slice(v);
        let mut exchange = system.damp(t_next, 0.5 * dt, &mut self.push, &mut self.change);
        self.pull.copy_from_slice(a);
        if self.linear {
            // The last push of supports is part of `a` as if it lasted for the whole step; the kicks of nonlinear
            // bodies halve it.
            if let Some(push) = system.last_push(times, u) {
                subtract(&mut self.pull, &push);
            }
        }
        system.hold_at(t_next, &mut self.push);
        system.hold_at(t_next, &mut self.pull);
        if !self.linear {
            self.split(system, times, u);
            add(&mut self.push, 0.5 * dt, &self.remainder);
        }
        if self.options.regularisation > 0.0 {
            add(&mut self.pull, -self.options.regularisation, u);
            system.hold_at(t_next, &mut self.pull);
        }
        self.next[0].copy_from_slice(u);
        self.next[1].fill(0.0);
        self.flow(system, times, interrupt)?;
        self.loads(system, [*t, dt], interrupt)?;
        self.supports(system, [*t, dt], u, interrupt)?;
        let [u_next, v_next] = &mut self.next;
        system.constrain(t_next, u_next, v_next);
        system.constrain_velocity(t_next, v_next);
        if !self.linear {
            let mut u_next = std::mem::take(&mut self.next[0]);
            system.free_acceleration(t_next, &u_next, &PointSubset::All, &mut self.pull);
            system.hold_at(t_next, &mut self.pull);
            self.split(system, [t_next; 2], &u_next);
            std::mem::swap(&mut self.next[0], &mut u_next);
            add(&mut self.next[1], 0.5 * dt, &self.remainder);
        }
        let v_next = &mut self.next[1];
        exchange.add(system.damp(t_next, 0.5 * dt, v_next, &mut self.change));
        system.book_exchange(exchange);
        state.complete(system, &mut self.next, t_next, dt);
        state.step += 1;
        Ok(())
    }
}

pericles::saved! {
    impl Checkpointed for Trigonometric {
        options, linear, reference: fixed,
        engine, held: rebuilt,
        push, pull, remainder, change, next: scratch,
    }
}
