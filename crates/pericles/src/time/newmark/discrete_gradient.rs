//! The discrete gradient scheme, which conserves the energy of any elastic body.
//!
//! The mean of the force along the step conserves energy for steps of any size; a correction of the midpoint rule
//! alone has no solution at ten times the explicit limit. The derivative of the mean is symmetric and, for convex
//! energies, definite, so that conjugate gradients solve the step.

use super::InnerIterations;
use super::equation::{StepEquation, centre, root_masses};
use crate::compatibility::{Need, Requirement, require};
use crate::error::{PericlesError, Result};
use crate::interrupt::Interrupt;
use crate::operator::PointSubset;
use crate::solve::{SolveLimits, Work, newton_krylov};
use crate::step_end::{Path, StepEnd};
use crate::step_kind::StepKind;
use crate::system::System;
use crate::time::zone::{Sum, Zone};
use crate::time::{Integrator, State};

/// Discrete gradient scheme: v′ − v = dt (F̄ + b̄)/ρ, u′ − u = dt (v + v′)/2, with the mean F̄ of the force along
/// the segment from u to u′ (Harten, Lax & van Leer 1983; Quispel & McLaren 2008), whose work is the loss of
/// elastic energy:
///
/// > F̄ = Σ_k w_k F(u + τ_k Δu) − c ρ w,  c = (E(u′) − E(u) + ΣV F̄·Δu)/Σρ V w·w.
///
/// The mean uses three Gauss nodes, exact for energies of degree up to six; for others the coefficient c closes the
/// balance (Gonzalez 1996), with w = Δu without its rigid translation, so that momentum is conserved as well. b̄ is
/// the mean of the loads at both ends.
///
/// Second order; conserves energy to the tolerance, which is relative to the energy of the state, for any step.
/// Where the elastic energy is convex the equation of a step has a unique solution for any step. It is solved by
/// Newton's method with conjugate gradients, and c by the secant method. A step costs about a hundred times an
/// explicit step: useful where energy must not drift or the step is far above the explicit limit.
pub struct DiscreteGradient {
    tolerance: f64,
    zone: Zone,
    root_mass: Vec<f64>,
    work: Work,
    vectors: [Vec<f64>; 5],
    /// Known terms of the equation, the scaled end state, the end state.
    known: Vec<f64>,
    scaled: Vec<f64>,
    next: Vec<f64>,
    mean: Vec<f64>,
    /// Coefficient c of the previous step, used as initial guess.
    correction: f64,
    iterations: InnerIterations,
}

/// Gauss nodes of a step, with weights.
const NODES: [(f64, f64); 3] = [
    (0.112_701_665_379_258_31, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];
/// Largest number of corrections of c per step.
const MOST: usize = 60;
/// Largest number of Newton iterations per correction.
const NEWTON: usize = 40;
/// Residual that consists of rounding errors only, relative to the size of its terms.
const ROUNDING: f64 = 1e-15;

const NAME: &str = "discrete-gradient";

impl DiscreteGradient {
    /// Requirements on the system.
    pub const REQUIREMENTS: &'static [Requirement] = &[
        Requirement::IN_DOUBLES,
        Requirement {
            need: Need::BoundariesWithinStep,
            reason: "a boundary of the body supports explicit schemes only; use velocity-verlet, or an absorbing boundary made for the midpoint rule",
        },
        Requirement::CONSERVATIVE_CONTACT,
        Requirement::NO_FREE_BODIES,
    ];

    /// Makes the scheme for a system; `tolerance` is the relative error of the energy per step.
    ///
    /// # Errors
    /// A tolerance out of range; boundaries that do not support implicit schemes; forces in single precision.
    pub fn new(tolerance: f64, system: &System) -> Result<Self> {
        if !(1e-14..1e-2).contains(&tolerance) {
            return Err(PericlesError::SchemeParameter {
                parameter: "the tolerance of the energy",
                value: tolerance,
                allowed: "1e-14 to 1e-2",
            });
        }
        require(NAME, Self::REQUIREMENTS, system)?;
        let entries = system.dimension() * system.points();
        let array = || vec![0.0; entries];
        Ok(Self {
            tolerance,
            zone: Zone::all(system.points()),
            root_mass: root_masses(system),
            work: Work::on(system.domain(), entries),
            vectors: std::array::from_fn(|_| array()),
            known: array(),
            scaled: array(),
            next: array(),
            mean: array(),
            correction: 0.0,
            iterations: InnerIterations::default(),
        })
    }

    /// Applies prescribed displacements to the initial guess, and the last push of constraints on released points
    /// to the known terms.
    fn prescribe(&mut self, system: &mut System, [t, t_next]: [f64; 2], state: &State) {
        let theta = 0.5 * (t_next - t).powi(2);
        if let Some(push) = system.last_push([t, t_next], &state.u) {
            for (known, push) in self.known.iter_mut().zip(&push) {
                *known += theta * push;
            }
        }
        system.place_on(t_next, &PointSubset::All, &mut self.scaled);
    }

    /// Returns ‖√m Δu‖ of the points that constraints move.
    fn moved_by_supports(&mut self, system: &System, t_next: f64, state: &State) -> f64 {
        // Displacements of constrained points, zero elsewhere.
        let moved = &mut self.next;
        moved.copy_from_slice(&state.u);
        system.place_on(t_next, &PointSubset::All, moved);
        let (root, moved) = (&self.root_mass, &*moved);
        let scaled = |k: usize| (root[k] * (moved[k] - state.u[k])).powi(2);
        system.domain().sum(root.len(), scaled).sqrt()
    }

    /// Solves the step for a given c.
    fn attempt(
        &mut self,
        system: &System,
        state: &State,
        step: Step,
        c: f64,
        newton: &mut u64,
        interrupt: Interrupt<'_>,
    ) -> Result<Attempt> {
        let theta = 0.5 * step.dt * step.dt;
        let scale = system.domain().norm(&self.scaled);
        let limits = SolveLimits {
            absolute: 0.1 * self.tolerance * step.reach,
            relative: ROUNDING,
            iterations: NEWTON,
            interrupt,
        };
        let mut equation = StepEquation {
            system,
            t: step.t,
            root_mass: &self.root_mass,
            known: &self.known,
            theta,
            base: &state.u,
            nodes: &NODES,
            pull: theta * c,
            with_boundaries: system.has_boundaries(),
            work: &mut self.vectors,
        };
        let solved = newton_krylov(
            &mut equation,
            &mut self.scaled,
            scale,
            &limits,
            &mut self.work,
        )?;
        *newton += solved.iterations as u64;
        equation.displace(&self.scaled);
        equation.mean_force();
        let n = system.points();
        self.next.copy_from_slice(&self.vectors[0]);
        let (next, force, root_mass) = (&self.next, &self.vectors[2], &self.root_mass);
        let moved = |k: usize| next[k] - state.u[k];
        let means: [f64; 3] = std::array::from_fn(|c| {
            if c < system.dimension() {
                centre(system.domain(), root_mass, c, n, &moved)
            } else {
                0.0
            }
        });
        let volumes = system.cloud().volumes();
        let work = system
            .domain()
            .sum(next.len(), |k| volumes[k % n] * force[k] * moved(k));
        let shape = system.domain().sum(next.len(), |k| {
            (root_mass[k] * (moved(k) - means[k / n])).powi(2)
        });
        let elastic = system.stored_energy(step.t, next);
        let missing = elastic - step.elastic + work;
        let velocity = |k: usize| 2.0 * moved(k) / step.dt - state.v[k];
        let twice = system
            .domain()
            .sum(next.len(), |k| (root_mass[k] * velocity(k)).powi(2));
        Ok(Attempt {
            balanced: if shape > 0.0 { missing / shape } else { 0.0 },
            missing: missing - c * shape,
            energy: 0.5 * twice + elastic,
        })
    }

    /// Finds the c that balances the energy, by the secant method within a bracket.
    ///
    /// The energy gained by a step decreases with c, which acts as a drag. Below −1/θ the equation is no longer
    /// positive definite.
    fn balance(
        &mut self,
        system: &System,
        state: &State,
        step: Step,
        interrupt: Interrupt<'_>,
    ) -> Result<f64> {
        let unit = 2.0 / (step.dt * step.dt);
        let (mut c, mut newton) = (self.correction.max(-0.5 * unit), 0);
        let (mut gains, mut loses) = (-0.95 * unit, f64::INFINITY);
        let mut before: Option<(f64, f64)> = None;
        let (mut missing, mut allowed) = (f64::INFINITY, 0.0);
        for _ in 0..MOST {
            let attempt = self.attempt(system, state, step, c, &mut newton, interrupt)?;
            // Starting from rest, the energy is what the loads supply within the step.
            allowed = self.tolerance * attempt.energy.max(step.kinetic + step.elastic);
            missing = attempt.missing;
            if missing.abs() <= allowed {
                self.iterations.count(newton, missing.abs());
                return Ok(c);
            }
            if missing > 0.0 {
                gains = c;
            } else {
                loses = c;
            }
            let next = match before {
                Some((c_before, missing_before)) if missing != missing_before => {
                    c - missing * (c - c_before) / (missing - missing_before)
                }
                _ => attempt.balanced,
            };
            before = Some((c, missing));
            c = if next > gains && next < loses && (next - c).abs() < 4.0 * unit {
                next
            } else if loses.is_finite() {
                0.5 * (gains + loses)
            } else {
                gains + unit
            };
        }
        Err(PericlesError::NotConverged {
            solver: "the energy balance of the step",
            iterations: MOST,
            residual: missing.abs(),
            tolerance: allowed,
            cause: "the tolerance is below rounding, or the step is too large",
        })
    }
}

/// The solution of a step for one c.
struct Attempt {
    /// The c that would have balanced the energy.
    balanced: f64,
    /// Error of the energy balance, J.
    missing: f64,
    /// Kinetic and elastic energy at the end of the step, J.
    energy: f64,
}

/// Data at the start of a step.
#[derive(Clone, Copy)]
struct Step {
    t: f64,
    dt: f64,
    kinetic: f64,
    elastic: f64,
    /// The larger of ‖√m Δu‖ in free flight and by the loads alone: the scale of the displacement in the step.
    reach: f64,
}

impl Integrator for DiscreteGradient {
    fn name(&self) -> &'static str {
        NAME
    }

    fn vector_length(&self) -> Option<usize> {
        Some(self.next.len())
    }

    fn requirements(&self) -> &'static [Requirement] {
        Self::REQUIREMENTS
    }

    fn step_kind(&self) -> StepKind {
        StepKind::Middle
    }

    fn order(&self) -> u32 {
        2
    }

    fn stability_limit(&self) -> Option<f64> {
        None
    }

    fn inner_iterations(&self) -> Option<InnerIterations> {
        Some(self.iterations)
    }

    fn step(
        &mut self,
        system: &mut System,
        state: &mut State,
        t_next: f64,
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let (n, dt) = (system.points(), t_next - state.t);
        let theta = 0.5 * dt * dt;
        system.external_acceleration_into(state.t, &mut self.mean);
        system.external_acceleration_into(t_next, &mut self.next);
        let (first, last, root) = (&self.mean, &self.next, &self.root_mass);
        let pushed = system
            .domain()
            .sum(root.len(), |k| (root[k] * (first[k] + last[k])).powi(2))
            .sqrt();
        let kinetic = system.kinetic_energy(&state.v);
        Sum::new()
            .plus(dt, &state.v)
            .plus(0.5 * theta, &self.mean)
            .plus(0.5 * theta, &self.next)
            .onto(&state.u, &self.zone, n, &mut self.known);
        // Initial guess: constant acceleration.
        Sum::new().plus(dt, &state.v).plus(theta, &state.a).onto(
            &state.u,
            &self.zone,
            n,
            &mut self.scaled,
        );
        let mut given = 0.0;
        if !system.motions().is_empty() {
            self.prescribe(system, [state.t, t_next], state);
            given = self.moved_by_supports(system, t_next, state);
        }
        for (y, root) in self.scaled.iter_mut().zip(&self.root_mass) {
            *y *= root;
        }
        let step = Step {
            t: t_next,
            dt,
            kinetic,
            // Rigid bodies with a prescribed motion act from their place at the end of the step; the way there is not part
            // of the balance, but work of the outside.
            elastic: system.operator().energy(state.t, &state.u)
                + system.contact_energy(t_next, &state.u),
            reach: (dt * (2.0 * kinetic).sqrt())
                .max(0.5 * theta * pushed)
                .max(given),
        };
        self.correction = self.balance(system, state, step, interrupt)?;
        // v′ = 2 Δu/dt − v.
        for k in 0..self.next.len() {
            let mean = (self.next[k] - state.u[k]) / dt;
            state.v[k] = 2.0 * mean - state.v[k];
        }
        std::mem::swap(&mut state.u, &mut self.next);
        system.constrain(t_next, &mut state.u, &mut state.v);
        system.constrain_velocity(t_next, &mut state.v);
        let end = StepEnd {
            t: t_next,
            dt,
            u: &state.u,
            path: Path::Chord {
                u: &self.next,
                first: false,
            },
        };
        system.end_step(&end, &state.v, &mut state.a);
        state.close(system, t_next);
        state.step += 1;
        Ok(())
    }
}

crate::saved! {
    impl Checkpointed for DiscreteGradient {
        iterations: part,
        correction: array("discrete-gradient/correction"),
        tolerance, zone, root_mass: fixed,
        work, vectors, known, scaled, next, mean: scratch,
    }
}
