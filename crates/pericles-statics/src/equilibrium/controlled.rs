//! Static states in which a quantity of the displacements has a given value.

use pericles::operator::PointSubset;
use pericles::solve::Anderson;
use pericles::{Interrupt, IterationProgress, Result, StepEnd, System};

use super::{Effort, Equilibrium, Target, free_norm};
use crate::control::Control;
use crate::error::StaticsError;
use crate::krylov::{End, Goal};
use crate::reference::{Reference, scaled};
use crate::sparse::add_multiple;
use crate::tangent::{Derivative, remove, stiffness_into};

/// A static state in which a quantity has a given value.
pub struct ControlledTarget<'a> {
    /// Time, s.
    pub t: f64,
    /// Loads and supports of which a multiple acts.
    pub reference: &'a Reference,
    /// The quantity.
    pub control: &'a Control,
    /// Its value, m.
    pub value: f64,
    /// Largest norm of loads or reactions before, N.
    pub largest: f64,
}

/// Number of earlier iterates that are combined with the present one.
const DEPTH: usize = 5;

/// Residual and value of the quantity at an iterate.
struct Measured {
    /// Norm of the residual, N.
    norm: f64,
    /// Norm of the loads, N.
    of_loads: f64,
    /// Whether it is the wanted state.
    is_reached: bool,
    /// The error if it is the last iterate.
    failure: StaticsError,
}

impl Equilibrium {
    /// Advances `u` and the factor of the reference loads to the static state in which the quantity has its value.
    ///
    /// Each iteration solves two problems: the response to the reference loads and the correction for the residual. Their
    /// combination has the value of the quantity (bordering). The matrix is the tangent, as in Newton's method, until it is
    /// not positive definite or the residual does not fall; then it is the stiffness at constant damage, which is positive
    /// also where the load falls. That iteration converges linearly and is accelerated by combinations of the last iterates.
    ///
    /// # Errors
    /// [`StaticsError::NotControlled`] with a fraction of zero; [`StaticsError::NoControl`] if the quantity does not
    /// depend on the loads; interruption.
    pub(crate) fn find_controlled(
        &mut self,
        system: &System,
        target: &ControlledTarget<'_>,
        (u, factor): (&mut [f64], &mut f64),
        interrupt: Interrupt<'_>,
    ) -> Result<Effort> {
        /// Number of iterations within which the residual must fall below half of its least value before.
        const PATIENCE: u64 = 25;
        /// Largest ratio of successive residuals of Newton's method, and of the residual to its least value before.
        const FALL: f64 = 0.5;
        let mut effort = Effort::default();
        let mut mixing = Anderson::new(DEPTH, u.len());
        let mut matrix = Derivative::Tangent;
        let mut last = f64::INFINITY;
        // The least residual and its iteration; the first one is that of a state that is not on the path.
        let mut least = (f64::INFINITY, 0);
        loop {
            let at = (&mut *u, *factor);
            let found = self.measure(system, target, at, &mut effort, interrupt)?;
            if found.is_reached {
                return Ok(effort);
            }
            if effort.newton <= 1 || found.norm < FALL * least.0 {
                least = (found.norm, effort.newton);
            }
            if effort.newton > least.1 + PATIENCE || !found.norm.is_finite() {
                return Err(found.failure.into());
            }
            if effort.newton > 1 && found.norm > FALL * last {
                matrix = Derivative::Secant;
            }
            last = found.norm;
            let at = (&*u, *factor);
            let next = self.improved(
                system,
                target,
                (&found, &mut matrix),
                at,
                &mut effort,
                interrupt,
            )?;
            let (mut next, at) = next;
            *factor = match matrix {
                Derivative::Tangent => at,
                Derivative::Secant => mixing.next_with(system.domain(), u, (&mut next, at)),
            };
            u.copy_from_slice(&next);
        }
    }

    /// Advances `u` and the factor to a static state to which no static path leads: bonds keep the damage of all iterates,
    /// so that the body fails until it is in equilibrium. `work` is scratch memory for forces.
    ///
    /// # Errors
    /// As [`Self::find_controlled`].
    pub(crate) fn fail_to_controlled(
        &mut self,
        system: &mut System,
        target: &ControlledTarget<'_>,
        (u, factor): (&mut [f64], &mut f64),
        work: &mut [f64],
        interrupt: Interrupt<'_>,
    ) -> Result<Effort> {
        /// Largest number of iterations.
        const ITERATIONS: u64 = 3000;
        let mut effort = Effort::default();
        let mut matrix = Derivative::Secant;
        loop {
            let at = (&mut *u, *factor);
            let found = self.measure(system, target, at, &mut effort, interrupt)?;
            if found.is_reached {
                return Ok(effort);
            }
            if effort.newton == ITERATIONS || !found.norm.is_finite() {
                return Err(found.failure.into());
            }
            let at = (&*u, *factor);
            let (next, at) = self.improved(
                system,
                target,
                (&found, &mut matrix),
                at,
                &mut effort,
                interrupt,
            )?;
            u.copy_from_slice(&next);
            *factor = at;
            let end = StepEnd::sub_step(target.t, 0.0, u);
            system.end_step_on(&end, &PointSubset::All, work);
        }
    }

    /// Places the supports and evaluates the residual and the quantity.
    fn measure(
        &mut self,
        system: &System,
        target: &ControlledTarget<'_>,
        (u, factor): (&mut [f64], f64),
        effort: &mut Effort,
        interrupt: Interrupt<'_>,
    ) -> Result<Measured> {
        let tolerance = self.options.tolerance;
        self.place(factor, &target.reference.supports, u);
        let load = scaled(factor, &target.reference.load);
        let at = Target {
            t: target.t,
            place: target.t,
            load: &load,
            supports: &target.reference.supports,
            largest: target.largest,
            tolerance,
        };
        let norm = self.evaluate(system, &at, u, effort);
        let of_loads = self.load_norm(system, &at)?;
        effort.acting = self.acting(system, of_loads, target.largest, norm);
        effort.residual = match norm {
            0.0 => 0.0,
            norm => norm / effort.acting,
        };
        interrupt.report(IterationProgress {
            iteration: effort.newton,
            residual: effort.residual,
            tolerance,
            evaluations: effort.products + effort.forces,
        });
        let value = target.control.quantity.value(system, target.t, u)?;
        let wanted = target.value;
        let is_value = (value - wanted).abs() <= tolerance * value.abs().max(wanted.abs());
        Ok(Measured {
            norm,
            of_loads,
            is_reached: effort.residual <= tolerance && is_value,
            failure: StaticsError::NotControlled {
                t: target.t,
                fraction: 0.0,
                value,
                wanted,
                residual: effort.residual,
                tolerance,
            },
        })
    }

    /// Returns displacements and factor of the next iterate. The matrix changes to the stiffness at constant damage if
    /// the tangent is not positive definite.
    fn improved(
        &mut self,
        system: &System,
        target: &ControlledTarget<'_>,
        (found, matrix): (&Measured, &mut Derivative),
        (u, factor): (&[f64], f64),
        effort: &mut Effort,
        interrupt: Interrupt<'_>,
    ) -> Result<(Vec<f64>, f64)> {
        effort.newton += 1;
        // A part of the tolerance of the state, because the next residuals are smaller.
        let goal = Goal {
            absolute: 0.1 * self.options.tolerance * effort.acting,
            relative: 0.0,
            acting: found.of_loads,
            products: u64::from(self.options.products),
            interrupt,
        };
        let times = [target.t; 2];
        let residual = self.residual.clone();
        let (correction, response) = loop {
            self.residual.copy_from_slice(&residual);
            let solved = self.solve(system, (*matrix, times), u, &goal)?;
            effort.products += solved.products;
            let correction = self.correction.clone();
            if solved.end != End::Indefinite {
                let response = self.response(system, (target, *matrix), u, effort, interrupt)?;
                if let Some(response) = response {
                    break (correction, response);
                }
            }
            if *matrix == Derivative::Secant {
                return Err(found.failure.clone().into());
            }
            *matrix = Derivative::Secant;
        };
        let mut next = u.to_vec();
        add_multiple(&mut next, 1.0, &correction);
        let value = |u: &[f64]| target.control.quantity.value(system, target.t, u);
        let change = factor_change(&next, &response, target.value, &value)?;
        add_multiple(&mut next, change, &response);
        Ok((next, factor + change))
    }

    /// Sets the constrained entries of a vector to a multiple of the displacements of supports.
    fn place(&self, factor: f64, supports: &[f64], out: &mut [f64]) {
        for (k, out) in out.iter_mut().enumerate() {
            if self.free[k] == 0.0 {
                *out = factor * supports[k];
            }
        }
    }

    /// Returns the response of the displacements to the reference loads; `None` if the matrix is not positive definite.
    fn response(
        &mut self,
        system: &System,
        (target, matrix): (&ControlledTarget<'_>, Derivative),
        u: &[f64],
        effort: &mut Effort,
        interrupt: Interrupt<'_>,
    ) -> Result<Option<Vec<f64>>> {
        /// Accuracy of the response. Its error is corrected by the next iteration.
        const ACCURACY: f64 = 1e-4;
        let times = [target.t; 2];
        let mut response = vec![0.0; u.len()];
        self.place(1.0, &target.reference.supports, &mut response);
        let right = &mut self.residual;
        stiffness_into(system, matrix, times, u, &response, right);
        let (n, volumes) = (system.points(), system.cloud().volumes());
        for (k, right) in right.iter_mut().enumerate() {
            *right = volumes[k % n] * target.reference.load[k] - *right;
        }
        remove(system, &self.rigid, right);
        let norm = free_norm(system, &self.free, &self.residual);
        let goal = Goal {
            absolute: 0.0,
            relative: ACCURACY,
            acting: norm,
            products: u64::from(self.options.products),
            interrupt,
        };
        let solved = self.solve(system, (matrix, times), u, &goal)?;
        effort.products += solved.products + 1;
        add_multiple(&mut response, 1.0, &self.correction);
        Ok((solved.end != End::Indefinite).then_some(response))
    }
}

/// Returns the multiple of the response that must be added to the displacements for a value of the quantity, by the
/// secant method: one step for a linear quantity.
fn factor_change(
    u: &[f64],
    response: &[f64],
    wanted: f64,
    value: &dyn Fn(&[f64]) -> Result<f64>,
) -> Result<f64> {
    let at = |change: f64| -> Result<f64> {
        let mut moved = u.to_vec();
        add_multiple(&mut moved, change, response);
        Ok(value(&moved)? - wanted)
    };
    let mut here = [0.0, at(0.0)?];
    let whole = at(1.0)?;
    if whole == here[1] || !whole.is_finite() {
        return Err(StaticsError::NoControl {
            reason: "the quantity does not change with the loads; choose a quantity of points that the loads move",
        }
        .into());
    }
    let mut there = [1.0, whole];
    /// Enough for a smooth quantity.
    const STEPS: u32 = 20;
    for _ in 0..STEPS {
        let next = there[0] - there[1] * (there[0] - here[0]) / (there[1] - here[1]);
        if !next.is_finite() {
            break;
        }
        (here, there) = (there, [next, at(next)?]);
        if there[1].abs() <= 1e-12 * wanted.abs() || there[1] == here[1] {
            break;
        }
    }
    Ok(there[0])
}
