//! Newmark's method.

use super::equation::{StepEquation, root_masses};
use super::{InnerIterations, InnerSolver, NewmarkOptions, VelocityNorm};
use crate::boundary::Exchange;
use crate::compatibility::{Requirement, require};
use crate::error::{PericlesError, Result};
use crate::interrupt::Interrupt;
use crate::operator::PointSubset;
use crate::solve::{Anderson, Nonlinear, SolveLimits, Work, newton_krylov};
use crate::step_end::{Path, StepEnd};
use crate::step_kind::StepKind;
use crate::system::System;
use crate::time::zone::{Sum, Zone};
use crate::time::{Integrator, State, highest_frequency};

/// Newmark's method with a choice of inner solvers; see the module documentation.
///
/// Bonds break and the energy balance is updated once, at the end of a step. Prescribed displacements apply during
/// the inner iterations, prescribed velocities at the end.
pub struct Newmark {
    options: NewmarkOptions,
    zone: Zone,
    /// uP and vP.
    predicted: [Vec<f64>; 2],
    /// The iterate: displacement, velocity, acceleration, and the acceleration evaluated there.
    next: [Vec<f64>; 4],
    inner: Inner,
    iterations: InnerIterations,
}

enum Inner {
    FixedPoint,
    Anderson(Anderson),
    NewtonKrylov(Box<NewtonKrylov>),
}

struct NewtonKrylov {
    root_mass: Vec<f64>,
    work: Work,
    vectors: [Vec<f64>; 5],
    /// Known terms of the equation, and the scaled unknown.
    known: Vec<f64>,
    scaled: Vec<f64>,
    least_root_mass: f64,
    least_root_density: f64,
}

impl Newmark {
    /// Makes the method for a system.
    ///
    /// # Errors
    /// Parameters out of range; boundaries with memory if Newton's method is used.
    pub fn new(options: NewmarkOptions, system: &System) -> Result<Self> {
        options.check()?;
        require(
            options.solver.scheme(),
            options.solver.requirements(),
            system,
        )?;
        let entries = system.dimension() * system.points();
        let array = || vec![0.0; entries];
        let inner = match options.solver {
            InnerSolver::FixedPoint => Inner::FixedPoint,
            InnerSolver::Anderson { depth } => {
                Inner::Anderson(Anderson::new(depth as usize, entries))
            }
            InnerSolver::NewtonKrylov => {
                let root_mass = root_masses(system);
                // Of the whole body: all processes iterate to the same tolerance.
                let least = |x: &mut dyn Iterator<Item = f64>| {
                    -system.domain().max(-x.fold(f64::INFINITY, f64::min))
                };
                Inner::NewtonKrylov(Box::new(NewtonKrylov {
                    least_root_mass: least(&mut root_mass.iter().copied()),
                    least_root_density: least(
                        &mut (0..system.points()).map(|i| system.density().at(i).sqrt()),
                    ),
                    root_mass,
                    work: Work::on(system.domain(), entries),
                    vectors: std::array::from_fn(|_| array()),
                    known: array(),
                    scaled: array(),
                }))
            }
        };
        Ok(Self {
            options,
            zone: Zone::all(system.points()),
            predicted: std::array::from_fn(|_| array()),
            next: std::array::from_fn(|_| array()),
            inner,
            iterations: InnerIterations::default(),
        })
    }

    /// Parameters of the method.
    pub fn options(&self) -> &NewmarkOptions {
        &self.options
    }

    /// Computes u′ = uP + β dt² a, v′ = vP + γ dt a with prescribed values.
    fn correct(&mut self, system: &System, t: f64, dt: f64) {
        let n = system.points();
        let [u, v, a, _] = &mut self.next;
        Sum::new()
            .plus(self.options.beta * dt * dt, a)
            .onto(&self.predicted[0], &self.zone, n, u);
        Sum::new()
            .plus(self.options.gamma * dt, a)
            .onto(&self.predicted[1], &self.zone, n, v);
        system.place_on(t, &PointSubset::All, u);
        system.drive_on(t, &PointSubset::All, v);
    }

    /// Fixed-point iteration until the velocity converges. Leaves the last evaluated acceleration in `next[3]`.
    fn iterate(
        &mut self,
        system: &mut System,
        t: f64,
        dt: f64,
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let push = self.options.gamma * dt;
        self.next[2].fill(0.0);
        if let Inner::Anderson(anderson) = &mut self.inner {
            anderson.restart();
        }
        self.correct(system, t, dt);
        let mut change = f64::INFINITY;
        for k in 1..=u64::from(self.options.iterations) {
            interrupt.poll()?;
            let [u, v, a, found] = &mut self.next;
            system.acceleration(t, u, v, PointSubset::All, found);
            // The previous acceleration is no longer needed; its array stores the change.
            for (a, found) in a.iter_mut().zip(&*found) {
                *a = found - *a;
            }
            change = self.options.norm.of(system, push, a);
            if change <= self.options.tolerance {
                a.copy_from_slice(found);
                self.correct(system, t, dt);
                self.iterations.count(k, change);
                return Ok(());
            }
            if !change.is_finite() {
                break;
            }
            match &mut self.inner {
                Inner::Anderson(anderson) => {
                    for (a, found) in a.iter_mut().zip(&*found) {
                        *a = found - *a;
                    }
                    anderson.next(system.domain(), a, found);
                    a.copy_from_slice(found);
                }
                _ => a.copy_from_slice(found),
            }
            self.correct(system, t, dt);
        }
        Err(self.not_converged(system, t, dt, change))
    }

    fn not_converged(&self, system: &System, t: f64, dt: f64, change: f64) -> PericlesError {
        // Frequency at the predicted state, because the iterate may be far off.
        let omega =
            highest_frequency(system, &self.predicted[0]).map_or(0.0, |frequency| frequency.bound);
        let iterations = self.options.iterations;
        // The correction shrinks by β ω² dt² per iteration; the last one should be a millionth of the first.
        let shrink = 1e-6_f64.powf(1.0 / f64::from(iterations - 1));
        let safe = (shrink / self.options.beta).sqrt() / omega;
        PericlesError::InnerIteration {
            t,
            iterations,
            change,
            tolerance: self.options.tolerance,
            dt,
            omega,
            // No advice if one evaluation cannot show convergence, or if the step is already short enough.
            safe: (iterations > 1 && safe.is_finite() && safe < dt).then_some(safe),
        }
    }

    /// Newton's method for u′ − uP − β dt² (f(u′) + b)/ρ = 0.
    fn solve(
        &mut self,
        system: &mut System,
        state: &State,
        [t, dt]: [f64; 2],
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let Inner::NewtonKrylov(newton) = &mut self.inner else {
            return Ok(());
        };
        let NewtonKrylov {
            root_mass,
            work,
            vectors,
            known,
            scaled,
            least_root_mass,
            least_root_density,
        } = &mut **newton;
        let n = system.points();
        let [u, v, a, found] = &mut self.next;
        let theta = self.options.beta * dt * dt;
        system.external_acceleration_into(t, found);
        Sum::new()
            .plus(theta, found)
            .onto(&self.predicted[0], &self.zone, n, known);
        Sum::new()
            .plus(theta, &state.a)
            .onto(&self.predicted[0], &self.zone, n, u);
        system.place_on(t, &PointSubset::All, u);
        scale_by(root_mass, u, scaled);
        let velocity = self.options.gamma / (self.options.beta * dt);
        let least = match self.options.norm {
            VelocityNorm::Weighted => *least_root_density,
            VelocityNorm::Sum | VelocityNorm::Largest => *least_root_mass,
        };
        let limits = SolveLimits {
            absolute: self.options.tolerance * least / velocity,
            relative: ROUNDING,
            iterations: self.options.iterations as usize,
            interrupt,
        };
        let scale = system.domain().norm(scaled);
        let mut equation = StepEquation {
            system,
            t,
            root_mass,
            known,
            theta,
            base: &state.u,
            nodes: &[(1.0, 1.0)],
            pull: 0.0,
            with_boundaries: false,
            work: vectors,
        };
        // The explicit step is close for smooth motion, but far from the solution after a jump of a prescribed displacement in steps
        // of many periods; the last displacement is then the better start.
        let [explicit, rest] = {
            let norm = |equation: &mut StepEquation<'_>, y: &[f64], out: &mut Vec<f64>| {
                equation.residual_into(y, out);
                system.domain().norm(out)
            };
            u.copy_from_slice(&state.u);
            system.place_on(t, &PointSubset::All, u);
            scale_by(root_mass, u, found);
            let mut residual = std::mem::take(v);
            let norms = [&*scaled, &*found].map(|y| norm(&mut equation, y, &mut residual));
            *v = residual;
            norms
        };
        // A residual that is NaN is larger than any other.
        if rest < explicit || explicit.is_nan() {
            scaled.copy_from_slice(found);
        }
        let solved = newton_krylov(&mut equation, scaled, scale, &limits, work)?;
        for ((u, y), root) in u.iter_mut().zip(&*scaled).zip(&*root_mass) {
            *u = y / root;
        }
        system.place_on(t, &PointSubset::All, u);
        Sum::new()
            .plus(-1.0, &self.predicted[0])
            .onto(u, &self.zone, n, a);
        a.iter_mut().for_each(|a| *a /= theta);
        Sum::new()
            .plus(self.options.gamma * dt, a)
            .onto(&self.predicted[1], &self.zone, n, v);
        system.drive_on(t, &PointSubset::All, v);
        self.iterations
            .count(solved.iterations as u64, solved.residual * velocity / least);
        Ok(())
    }

    /// Accepts the iterate: breaks bonds, updates the energy balance, and sets the acceleration at the start of the
    /// next step.
    fn accept(&mut self, system: &mut System, state: &mut State, t: f64, dt: f64) {
        let n = system.points();
        let [u, v, a, found] = &mut self.next;
        system.constrain(t, u, v);
        system.constrain_velocity(t, v);
        Sum::new()
            .plus(-1.0, &state.u)
            .onto(u, &self.zone, n, &mut self.predicted[0]);
        let mean_velocity = &mut self.predicted[0];
        mean_velocity.iter_mut().for_each(|x| *x /= dt);
        let end = StepEnd {
            t,
            dt,
            u,
            path: Path::MeanVelocity(mean_velocity),
        };
        // The last evaluation of the inner iteration is reused if nothing can break and nothing acts on the boundary.
        let last_stands = !matches!(self.inner, Inner::NewtonKrylov(_))
            && !system.operator().can_break()
            && system.motions().is_empty()
            && !system.has_boundaries()
            && !system.has_interactions();
        if last_stands {
            system.book_heating(&end);
            system.book_step(&end, found);
            a.copy_from_slice(found);
        } else {
            system.end_step(&end, v, a);
        }
        std::mem::swap(&mut state.u, u);
        std::mem::swap(&mut state.v, v);
        std::mem::swap(&mut state.a, a);
        state.close(system, t);
    }
}

/// Computes y = √m u.
fn scale_by(root_mass: &[f64], u: &[f64], y: &mut [f64]) {
    for ((y, u), root) in y.iter_mut().zip(u).zip(root_mass) {
        *y = u * root;
    }
}

/// Residual that consists of rounding errors only, relative to the size of its terms.
const ROUNDING: f64 = 1e-15;

impl Integrator for Newmark {
    fn name(&self) -> &'static str {
        "newmark"
    }

    fn vector_length(&self) -> Option<usize> {
        Some(self.next[0].len())
    }

    fn requirements(&self) -> &'static [Requirement] {
        self.options.solver.requirements()
    }

    fn step_kind(&self) -> StepKind {
        self.options.solver.step_kind()
    }

    fn order(&self) -> u32 {
        if self.options.gamma == 0.5 { 2 } else { 1 }
    }

    fn stability_limit(&self) -> Option<f64> {
        let scheme = self.options.stable();
        match self.options.solver {
            InnerSolver::FixedPoint if self.options.beta > 0.0 => {
                let iteration = 1.0 / self.options.beta.sqrt();
                Some(scheme.map_or(iteration, |scheme| scheme.min(iteration)))
            }
            _ => scheme,
        }
    }

    fn energy_correction(&self, system: &System, state: &State, dt: f64) -> f64 {
        (self.options.beta - 0.25) * dt * dt * system.kinetic_energy(&state.a)
    }

    fn inner_iterations(&self) -> Option<InnerIterations> {
        Some(self.iterations)
    }

    fn intended_drift(&self) -> Option<&'static str> {
        (self.options.gamma > 0.5)
            .then_some("gamma above 1/2 dissipates energy by design; gamma = 0.5 does not")
    }

    fn step(
        &mut self,
        system: &mut System,
        state: &mut State,
        t_next: f64,
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let (n, dt) = (system.points(), t_next - state.t);
        let NewmarkOptions { beta, gamma, .. } = self.options;
        let [u, v] = &mut self.predicted;
        let mut exchange = Exchange::default();
        let damped = matches!(self.inner, Inner::NewtonKrylov(_)) && system.has_boundaries();
        let before = if damped {
            let [_, before, _, work] = &mut self.next;
            before.copy_from_slice(&state.v);
            exchange = system.damp(t_next, 0.5 * dt, before, work);
            &*before
        } else {
            &state.v
        };
        Sum::new()
            .plus(dt, before)
            .plus((0.5 - beta) * dt * dt, &state.a)
            .onto(&state.u, &self.zone, n, u);
        Sum::new()
            .plus((1.0 - gamma) * dt, &state.a)
            .onto(before, &self.zone, n, v);
        match self.inner {
            Inner::NewtonKrylov(_) => self.solve(system, state, [t_next, dt], interrupt)?,
            Inner::FixedPoint | Inner::Anderson(_) => {
                self.iterate(system, t_next, dt, interrupt)?
            }
        }
        if damped {
            let [_, v, _, work] = &mut self.next;
            exchange.add(system.damp(t_next, 0.5 * dt, v, work));
            system.book_exchange(exchange);
        }
        self.accept(system, state, t_next, dt);
        state.step += 1;
        Ok(())
    }
}

crate::saved! {
    impl Checkpointed for Newmark {
        iterations: part,
        options, zone: fixed,
        predicted, next, inner: scratch,
    }
}
