//! Implicit schemes of second order: the midpoint and the trapezoidal rule.

mod solver;

pub use solver::LinearSolver;
use solver::StepSolver;

use super::{Integrator, State, ends};
use crate::compatibility::{Need, Requirement, require};
use crate::error::{PericlesError, Result};
use crate::interrupt::Interrupt;
use crate::operator::PointSubset;
use crate::parallel::for_each_chunk;
use crate::solve::{Nonlinear, SolveLimits, Work, newton_krylov};
use crate::step_kind::StepKind;
use crate::system::System;

/// The force used in a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImplicitRule {
    /// Force at the mean of both ends: v′ = v + τ f((u+u′)/2, t+τ/2)/ρ.
    Midpoint,
    /// Mean of the forces at both ends: v′ = v + τ/2 [f(u, t) + f(u′, t′)]/ρ.
    Trapezoidal,
}

/// Implicit midpoint or trapezoidal rule: u′ = u + τ (v + v′)/2 with the force of an [`ImplicitRule`].
///
/// Second order, stable for any step, symmetric. For linear forces the rules differ in the treatment of loads only,
/// and both conserve kinetic plus elastic energy exactly up to the residual of the solver. For nonlinear forces
/// too, the midpoint rule is symplectic and conserves momentum exactly. An oscillation of frequency ω has the
/// numerical frequency (2/τ) atan(τω/2).
///
/// The unknown w is half the increment of the displacement: (ρ + τ²/4 K) w = ρ [τ/2 v + τ²/4 (a + Δb/ρ)], symmetric
/// and positive definite. Linear systems are solved by a Cholesky factor kept from step to step or by conjugate
/// gradients ([`LinearSolver`]), nonlinear ones by Newton–Krylov with the tangent. The residual is reduced to 1e-14
/// of the terms of the equation (velocity, acceleration, loads and prescribed motions of the step), or as far as
/// rounding allows: 1e-12 of these terms, or a few units in the last place of the displacement times the highest
/// stiffness. Boundaries with memory ([`ImplicitBoundary`](crate::boundary::ImplicitBoundary)) add a block to the matrix and
/// their history to the right-hand side. Conjugate gradients need about 15 (1 + τ²ω²/4)^½ iterations for the
/// highest ω.
pub struct Implicit {
    rule: ImplicitRule,
    /// Solver for linear bodies.
    solver: Option<StepSolver>,
    mass: Vec<f64>,
    /// Upper bound of ω² of a nonlinear body at rest, 1/s²: the amplification of rounding errors of the
    /// displacement.
    stiffest: f64,

    /// The unknown w.
    half: Vec<f64>,
    right: Vec<f64>,
    change: Vec<f64>,
    force: Vec<f64>,
    next: [Vec<f64>; 2],
    work: Work,
}

/// Required residual; what remains is an error of the energy in each step.
const LIMITS: SolveLimits<'_> = SolveLimits {
    relative: 1e-14,
    absolute: 0.0,
    iterations: 4000,
    interrupt: Interrupt::never(),
};
/// Residual accepted where rounding prevents a smaller one.
const ACCEPTED: f64 = 1e-12;
/// Residual accepted relative to τ²/4 ω² m u for the highest ω: displacements are rounded to about 1e-16, and
/// differences in rounding between neighbouring points act like the shortest wave.
const ROUNDING: f64 = 1e-15;

impl Implicit {
    /// Requirements on the system.
    pub const REQUIREMENTS: &'static [Requirement] = &[
        Requirement::IN_DOUBLES,
        Requirement {
            need: Need::BoundariesWithinStep,
            reason: "a boundary of the body supports explicit schemes only; use velocity-verlet, or an absorbing boundary made for the midpoint rule",
        },
        Requirement {
            need: Need::NoInteractions,
            reason: "it solves steps that are linear while no bond breaks, but contacts open and close within a step; use discrete-gradient or velocity-verlet",
        },
    ];

    /// Makes the scheme for a system.
    ///
    /// # Errors
    /// Boundaries that do not support implicit schemes; forces in single precision.
    pub fn new(rule: ImplicitRule, system: &System) -> Result<Self> {
        Self::with_solver(rule, LinearSolver::default(), system)
    }

    /// Makes the scheme with a given solver for linear systems.
    ///
    /// # Errors
    /// The errors of [`Implicit::new`].
    pub fn with_solver(rule: ImplicitRule, solver: LinearSolver, system: &System) -> Result<Self> {
        require(rule.name(), Self::REQUIREMENTS, system)?;
        let entries = system.dimension() * system.points();
        let array = || vec![0.0; entries];
        let solver = StepSolver::new(solver, system);
        let stiffest = match solver {
            Some(_) => 0.0,
            None => stiffest(system),
        };
        Ok(Self {
            rule,
            solver,
            stiffest,
            mass: system.masses(),
            half: array(),
            right: array(),
            change: array(),
            force: array(),
            next: [array(), array()],
            work: Work::on(system.domain(), entries),
        })
    }

    /// Sets `half` to its prescribed values, and to zero elsewhere.
    fn prescribe(&mut self, system: &System, t_next: f64, u: &[f64]) {
        self.half.fill(0.0);
        if system.motions().is_empty() {
            return;
        }
        self.half.copy_from_slice(u);
        system.place_on(t_next, &PointSubset::All, &mut self.half);
        each(&mut self.half, u, |half, u| *half = 0.5 * (*half - u));
    }

    /// Returns whether steps of length tau are solved by a Cholesky factor.
    pub fn is_direct(&self, tau: f64, system: &System) -> bool {
        let solver = self.solver.as_ref();
        solver.is_some_and(|solver| solver.is_direct(tau, system))
    }

    fn solve_linear(
        &mut self,
        solver: &mut StepSolver,
        system: &System,
        t: [f64; 2],
        ([u, v, a], push): ([&[f64]; 3], Option<&[f64]>),
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let tau = t[1] - t[0];
        let quarter = 0.25 * tau * tau;
        // Difference of the loads at the time of the rule and those in `a`, over density.
        let (place, weight) = match self.rule {
            ImplicitRule::Midpoint => (0.5 * (t[0] + t[1]), 1.0),
            ImplicitRule::Trapezoidal => (t[1], 0.5),
        };
        system.external_acceleration_into(place, &mut self.right);
        system.external_acceleration_into(t[0], &mut self.change);
        each(&mut self.right, &self.change, |now, before| {
            *now = weight * quarter * (*now - before);
        });
        // Boundaries: their acceleration at the middle for an unchanged displacement.
        ends::without_present(system, a, &mut self.change);
        ends::add_middle(system, u, &mut self.change);
        if let Some(push) = push {
            // `a` contains the last push of constraints as if it lasted for the whole step.
            each(&mut self.change, push, |a, push| *a -= push);
        }
        each(&mut self.right, &self.change, |right, a| {
            *right += quarter * a;
        });
        each(&mut self.right, v, |right, v| *right += 0.5 * tau * v);
        if !system.motions().is_empty() {
            system.vibration_at(t[1], &self.half, &self.half, &mut self.change);
            each(&mut self.right, &self.change, |right, pull| {
                *right -= quarter * pull;
            });
        }
        each(&mut self.right, &self.mass, |right, m| *right *= m);
        system.hold_at(t[1], &mut self.right);
        // Prescribed entries are known: the solver gets the free ones.
        let free = &mut self.change;
        let limits = SolveLimits {
            interrupt,
            ..LIMITS
        };
        let work = &mut self.work;
        let solved = solver.solve(system, &self.mass, t, &self.right, free, (&limits, work));
        let solved = good_enough(solved, ACCEPTED * system.domain().norm(&self.right));
        each(&mut self.half, free, |half, free| *half += free);
        solved
    }

    fn solve_nonlinear(
        &mut self,
        system: &mut System,
        t: [f64; 2],
        ([u, v, a], push): ([&[f64]; 3], Option<&[f64]>),
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let tau = t[1] - t[0];
        // w = τ/2 v + τ²/4 f(u + s w)/s, with known terms on the right.
        let quarter = 0.25 * tau * tau;
        let (place, reach, known) = match self.rule {
            ImplicitRule::Midpoint => (0.5 * (t[0] + t[1]), 1.0, 0.0),
            ImplicitRule::Trapezoidal => (t[1], 2.0, 0.5 * quarter),
        };
        let total = quarter - known;
        let of_step = self.size_of_the_step(system, [place, t[1]], u, [total, quarter]);
        // Boundaries act at the middle for both rules; remove them from `a`.
        ends::without_present(system, a, &mut self.right);
        each(&mut self.right, v, |right, v| {
            *right = 0.5 * tau * v + known * *right;
        });
        if let Some(push) = push {
            // The part of the last push of constraints that `known` does not contain.
            let share = quarter - 2.0 * known;
            each(&mut self.right, push, |right, push| *right += share * push);
        }
        system.hold_at(t[1], &mut self.right);
        // Initial guess: the explicit step.
        each(&mut self.half, &self.right, |half, right| *half += right);
        let size = &mut self.force;
        size.copy_from_slice(a);
        system.hold_at(t[1], size);
        each(&mut self.half, size, |half, a| *half += total * a);
        each(size, &self.right, |a, right| {
            *a = total * a.abs() + right.abs()
        });
        each(size, &self.mass, |size, m| *size *= m);
        let scale = system.domain().norm(size).max(of_step);
        let mass = &self.mass;
        let displacement = system
            .domain()
            .sum(u.len(), |k| (mass[k] * u[k]).powi(2))
            .sqrt();
        let rounding = ROUNDING * quarter * self.stiffest * displacement;
        let limits = SolveLimits {
            interrupt,
            ..LIMITS
        };
        let mut problem = Stage {
            system,
            mass: &self.mass,
            right: &self.right,
            u,
            place: &mut self.change,
            force: &mut self.force,
            t: [place, t[1]],
            reach,
            quarter,
        };
        let solved = newton_krylov(&mut problem, &mut self.half, scale, &limits, &mut self.work);
        good_enough(solved.map(|_| ()), (ACCEPTED * scale).max(rounding))
    }

    /// Returns ‖m (|τ²/4 b/s| + |τ²/4 K w|)‖ for the loads b at the time of the rule and the prescribed part of w,
    /// which `half` contains: terms of the equation that do not depend on initial velocity and acceleration. At
    /// rest there are no others.
    fn size_of_the_step(
        &mut self,
        system: &System,
        [t, t_next]: [f64; 2],
        u: &[f64],
        [share, quarter]: [f64; 2],
    ) -> f64 {
        let (load, pull) = (&mut self.right, &mut self.change);
        system.external_acceleration_into(t, load);
        system.hold_at(t_next, load);
        pull.fill(0.0);
        if !system.motions().is_empty() {
            // Evaluated where the constraints have moved, because some bodies have no stiffness at rest.
            let moved = &mut self.force;
            moved.copy_from_slice(u);
            each(moved, &self.half, |moved, half| *moved += half);
            system.vibration_at(t_next, moved, &self.half, pull);
        }
        let (load, pull, mass) = (&*load, &*pull, &self.mass);
        system
            .domain()
            .sum(load.len(), |k| {
                (mass[k] * (share * load[k].abs() + quarter * pull[k].abs())).powi(2)
            })
            .sqrt()
    }
}

impl ImplicitRule {
    /// Name in decks.
    pub fn name(self) -> &'static str {
        match self {
            Self::Midpoint => "implicit-midpoint",
            Self::Trapezoidal => "trapezoidal",
        }
    }
}

/// Upper bound of ω² at rest, 1/s²; zero if unknown, as for bonds without stiffness at rest.
fn stiffest(system: &System) -> f64 {
    let omega = system
        .operator()
        .frequency_bound(&|i| system.density().at(i));
    if omega.is_finite() {
        omega * omega
    } else {
        0.0
    }
}

/// The nonlinear equation of a step, weighted by masses: m [w − right − τ²/4 (f(u + s w)/s + g(u + w))] = 0 with
/// the accelerations f of the body and g of boundaries; on prescribed entries the residual is zero.
struct Stage<'a> {
    system: &'a mut System,
    mass: &'a [f64],
    right: &'a [f64],
    u: &'a [f64],
    place: &'a mut [f64],
    force: &'a mut [f64],
    /// Time of the force, and time at the end of the step for prescribed motion.
    t: [f64; 2],
    /// Factor s.
    reach: f64,
    /// τ²/4
    quarter: f64,
}

impl Stage<'_> {
    /// Moves to u + reach · half.
    fn go_to(&mut self, half: &[f64], reach: f64) {
        self.place.copy_from_slice(self.u);
        each(self.place, half, |place, half| *place += reach * half);
    }
}

impl Nonlinear for Stage<'_> {
    fn residual_into(&mut self, x: &[f64], out: &mut [f64]) {
        self.go_to(x, self.reach);
        self.system
            .free_acceleration(self.t[0], self.place, &PointSubset::All, self.force);
        let share = 1.0 / self.reach;
        self.force.iter_mut().for_each(|force| *force *= share);
        if self.system.has_boundaries() {
            self.go_to(x, 1.0);
            ends::add_middle(self.system, self.place, self.force);
        }
        let factor = self.quarter;
        out.copy_from_slice(x);
        each(out, self.right, |out, right| *out -= right);
        each(out, self.force, |out, force| *out -= factor * force);
        each(out, self.mass, |out, m| *out *= m);
        self.system.hold_at(self.t[1], out);
    }

    fn rounding_into(&mut self, x: &[f64], out: &mut [f64]) {
        self.go_to(x, self.reach);
        ends::rounding_into(self.system, self.place, out);
        let reach = self.reach;
        out.iter_mut().for_each(|error| *error /= reach);
        self.system.hold_at(self.t[1], out);
    }

    fn derivative_into(&mut self, x: &[f64], direction: &[f64], out: &mut [f64]) {
        self.go_to(x, self.reach);
        self.system
            .vibration_at(self.t[1], self.place, direction, out);
        ends::add_stiffness(self.system, direction, out);
        add_and_weigh(out, self.quarter, direction, self.mass);
    }
}

/// Computes out = m (x + factor out).
fn add_and_weigh(out: &mut [f64], factor: f64, x: &[f64], mass: &[f64]) {
    each(out, x, |out, x| *out = x + factor * *out);
    each(out, mass, |out, m| *out *= m);
}

fn each(y: &mut [f64], x: &[f64], set: impl Fn(&mut f64, f64) + Sync) {
    for_each_chunk(y, &|first, y| {
        let x = &x[first..];
        y.iter_mut().zip(x).for_each(|(y, x)| set(y, *x));
    });
}

/// Accepts a residual above the required one, due to rounding, up to `accepted`.
fn good_enough(solved: Result<()>, accepted: f64) -> Result<()> {
    match solved {
        Err(PericlesError::NotConverged { residual, .. }) if residual <= accepted => Ok(()),
        other => other,
    }
}

impl Integrator for Implicit {
    fn name(&self) -> &'static str {
        self.rule.name()
    }

    fn vector_length(&self) -> Option<usize> {
        Some(self.half.len())
    }

    fn step_kind(&self) -> StepKind {
        StepKind::Middle
    }

    fn requirements(&self) -> &'static [Requirement] {
        Self::REQUIREMENTS
    }

    fn order(&self) -> u32 {
        2
    }

    fn stability_limit(&self) -> Option<f64> {
        None
    }

    fn step(
        &mut self,
        system: &mut System,
        state: &mut State,
        t_next: f64,
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let State { t, u, v, a, .. } = state;
        let tau = t_next - *t;
        self.prescribe(system, t_next, u);
        let times = [*t, t_next];
        let push = system.last_push(times, u);
        let known = ([&**u, &**v, &**a], push.as_deref());
        match self.solver.take() {
            Some(mut solver) => {
                let solved = self.solve_linear(&mut solver, system, times, known, interrupt);
                self.solver = Some(solver);
                solved?;
            }
            None => self.solve_nonlinear(system, times, known, interrupt)?,
        }
        let [u_next, v_next] = &mut self.next;
        u_next.copy_from_slice(u);
        each(u_next, &self.half, |u, half| *u += 2.0 * half);
        v_next.copy_from_slice(v);
        each(v_next, &self.half, |v, half| *v = 4.0 / tau * half - *v);
        system.constrain(t_next, u_next, v_next);
        system.constrain_velocity(t_next, v_next);
        state.complete(system, &mut self.next, t_next, tau);
        state.step += 1;
        Ok(())
    }
}

// The scheme has no state from step to step except that of its solver.
crate::saved! {
    impl Checkpointed for Implicit {
        solver: part,
        rule, mass, stiffest: fixed,
        half, right, change, force, next, work: scratch,
    }
}
