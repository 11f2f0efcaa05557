//! Solver for a static state: Newton's method with conjugate gradients.

mod controlled;

pub use self::controlled::ControlledTarget;

use pericles::domain::Replicated;
use pericles::operator::PointSubset;
use pericles::{Interrupt, IterationProgress, PericlesError, Result, System};

use crate::convergence::Convergence;
use crate::error::StaticsError;
use crate::krylov::{End, Goal, KrylovWork, Solution, conjugate_gradients};
use crate::multigrid::Multigrid;
use crate::options::StaticOptions;
use crate::rigid::{FreePiece, free_pieces, spread};
use crate::sparse::add_multiple;
use crate::surrogate::{Stiffness, Surrogate};
use crate::tangent::{Derivative, Tangent, remove, stiffness_into};
use crate::unknowns::Unknowns;

/// Loads and supports of a static state.
#[derive(Debug, Clone, Copy)]
pub struct Target<'a> {
    /// Time, s.
    pub t: f64,
    /// Time (s) at which rigid bodies in contact have their positions; within a load step it is before `t`.
    pub place: f64,
    /// Loads, N/m³.
    pub load: &'a [f64],
    /// Displacements, m; only constrained entries are used.
    pub supports: &'a [f64],
    /// Largest norm of loads or reactions before, N.
    pub largest: f64,
    /// Tolerance of the norm of the residual relative to the largest norm of loads or reactions.
    pub tolerance: f64,
}

/// Effort to find a static state.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effort {
    /// Number of Newton steps.
    pub newton: u64,
    /// Number of products with the tangent.
    pub products: u64,
    /// Number of force evaluations.
    pub forces: u64,
    /// Norm of the residual relative to loads or reactions.
    pub residual: f64,
    /// Larger norm of loads and reactions, N.
    pub acting: f64,
}

impl Effort {
    /// Adds the effort of another state and takes its residual.
    pub fn add(&mut self, other: Self) {
        self.newton += other.newton;
        self.products += other.products;
        self.forces += other.forces;
        self.residual = other.residual;
        self.acting = self.acting.max(other.acting);
    }
}

/// First forcing term: relative accuracy of the first linear problem.
const FORCING: f64 = 0.1;
/// Largest number of halvings of a Newton step that does not reduce the residual.
const HALVINGS: u32 = 8;

/// Solver of a body with given supports and bonds.
#[derive(Debug, Clone)]
pub struct Equilibrium {
    options: StaticOptions,
    free: Vec<f64>,
    replicated: Replicated,
    /// Unknowns of the whole body.
    unknowns: Unknowns,
    /// Stiffness from which the preconditioner was created, in an earlier state with the same bonds.
    stiffness: Stiffness,
    multigrid: Multigrid,
    /// Convergence of the linear problems of the present load step.
    pub(crate) convergence: Convergence,
    pieces: Vec<FreePiece>,
    /// Rigid-body motions that are projected out.
    rigid: Vec<Vec<f64>>,
    /// Largest resultant of loads along rigid-body motions that was projected out, relative to the norm of the loads.
    left_out: f64,
    krylov: KrylovWork,
    reduced: [Vec<f64>; 2],
    residual: Vec<f64>,
    correction: Vec<f64>,
    lift: Vec<f64>,
    trial: Vec<f64>,
    trial_residual: Vec<f64>,
}

impl Equilibrium {
    /// Creates the solver for the intact bonds of a body, with constraints at the entries that are zero in `free`. All
    /// processes must call it together.
    pub fn new(options: StaticOptions, system: &System, free: Vec<f64>) -> Self {
        Self::with(options, system, free, None)
    }

    /// Creates the solver with a known stiffness, that of an earlier state with the same bonds.
    fn with(
        options: StaticOptions,
        system: &System,
        free: Vec<f64>,
        known: Option<Stiffness>,
    ) -> Self {
        let replicated = Replicated::new(system.domain());
        let unknowns = Unknowns::new(system.dimension(), &replicated.of(&free));
        let (surrogate, stiffness) = Surrogate::with(system, known);
        let multigrid = surrogate.preconditioner(&unknowns);
        let pieces = free_pieces(system, &surrogate, &unknowns);
        let rigid = if options.fix_rigid_modes {
            spread(&pieces, system, &replicated)
        } else {
            Vec::new()
        };
        let entries = free.len();
        let zeros = || vec![0.0; entries];
        let reduced = || vec![0.0; unknowns.len()];
        Self {
            options,
            stiffness,
            multigrid,
            convergence: Convergence::default(),
            pieces,
            rigid,
            left_out: 0.0,
            krylov: KrylovWork::new(entries),
            reduced: [reduced(), reduced()],
            residual: zeros(),
            correction: zeros(),
            lift: zeros(),
            trial: zeros(),
            trial_residual: zeros(),
            replicated,
            unknowns,
            free,
        }
    }

    /// Creates the solver again from its restored state, for a body with the same bonds and constraints.
    pub(crate) fn recreate(&mut self, system: &System) {
        let (free, known) = (self.free.clone(), self.stiffness.clone());
        *self = Self::with(self.options, system, free, Some(known));
    }

    /// Returns the largest resultant of loads along rigid-body motions that was projected out, relative to their norm.
    pub fn left_out(&self) -> f64 {
        self.left_out
    }

    /// Returns 1 on free entries, 0 on constrained entries.
    pub fn free(&self) -> &[f64] {
        &self.free
    }

    /// Returns the preconditioner.
    pub fn multigrid(&self) -> &Multigrid {
        &self.multigrid
    }

    /// Returns an error for unconstrained rigid-body motions, unless they are projected out.
    ///
    /// # Errors
    /// [`StaticsError::Unconstrained`].
    pub fn check_support(&self) -> Result<()> {
        match self.pieces.first() {
            Some(piece) if !self.options.fix_rigid_modes => Err(StaticsError::Unconstrained {
                motions: piece.motions.clone(),
                points: piece.points.len(),
                of: self.replicated.points(),
            }
            .into()),
            _ => Ok(()),
        }
    }

    /// Returns an error for loads on a part of the body that bonds no longer connect to constraints, unless its
    /// motions are projected out.
    ///
    /// # Errors
    /// [`StaticsError::Separated`].
    pub fn check_loads(&self, system: &System, t: f64, load: &[f64]) -> Result<()> {
        if self.options.fix_rigid_modes {
            return Ok(());
        }
        let (of, n) = (self.replicated.points(), system.points());
        let separated = |points: usize| Err(StaticsError::Separated { t, points, of }.into());
        if !self.pieces.is_empty() {
            let whole = self.replicated.of(load);
            let volumes = self.replicated.of(system.cloud().volumes());
            let loaded = |piece: &&FreePiece| piece.moved_by(&whole, &volumes);
            if let Some(piece) = self.pieces.iter().find(loaded) {
                return separated(piece.points.len());
            }
        }
        let mut damage = vec![0.0; n];
        system.operator().damage_into(&mut damage);
        let loose = |k: usize| self.free[k] * load[k] != 0.0 && damage[k % n] >= 1.0;
        match system.domain().all(!(0..load.len()).any(loose)) {
            false => separated(1),
            true => Ok(()),
        }
    }

    /// Advances `u` to the static state of a target.
    ///
    /// # Errors
    /// [`StaticsError::NoEquilibrium`] if Newton's method does not converge, with a fraction of zero;
    /// [`StaticsError::Unbalanced`]; [`PericlesError::Interrupted`].
    pub fn find(
        &mut self,
        system: &System,
        target: &Target<'_>,
        u: &mut [f64],
        interrupt: Interrupt<'_>,
    ) -> Result<Effort> {
        let mut effort = Effort::default();
        let load = self.load_norm(system, target)?;
        let linear = is_linear(system);
        let mut lifted = self.set_lift(system, target, u);
        let mut norm = self.evaluate(system, target, u, &mut effort);
        let first = norm;
        let mut forcing = FORCING;
        let mut indefinite = false;
        loop {
            let acting = self.acting(system, load, target.largest, first);
            if !lifted {
                effort.acting = acting;
                effort.residual = if norm == 0.0 { 0.0 } else { norm / acting };
                interrupt.report(IterationProgress {
                    iteration: effort.newton,
                    residual: effort.residual,
                    tolerance: target.tolerance,
                    evaluations: effort.products + effort.forces,
                });
                if effort.residual <= target.tolerance {
                    return Ok(effort);
                }
            }
            let failed = StaticsError::NoEquilibrium {
                t: target.t,
                fraction: 0.0,
                residual: effort.residual,
                tolerance: target.tolerance,
                indefinite,
            };
            if effort.newton == u64::from(self.options.newton_steps) || !norm.is_finite() {
                return Err(failed.into());
            }
            effort.newton += 1;
            /// Fraction of the tolerance, because round-off makes the true residual slightly larger than that
            /// of the recurrence.
            const MARGIN: f64 = 0.9;
            let finest = MARGIN * target.tolerance;
            let goal = Goal {
                absolute: if linear || lifted {
                    0.0
                } else {
                    forcing * norm
                },
                relative: if linear || !lifted { finest } else { FORCING },
                acting: load.max(target.largest),
                products: u64::from(self.options.products),
                interrupt,
            };
            if lifted {
                self.linearise_lift(system, target, u);
                effort.products += 1;
            }
            let times = [target.t, target.place];
            let solved = self.solve(system, (Derivative::Tangent, times), u, &goal)?;
            effort.products += solved.products;
            indefinite |= solved.end == End::Indefinite;
            if lifted {
                add_multiple(u, 1.0, &self.lift);
                add_multiple(u, 1.0, &self.correction);
                norm = self.evaluate(system, target, u, &mut effort);
                lifted = false;
                continue;
            }
            let Some(next) = self.search(system, target, u, norm, &mut effort) else {
                return Err(failed.into());
            };
            let ratio = next / norm;
            norm = next;
            // Eisenstat & Walker 1996, choice 2.
            forcing = (0.9 * ratio * ratio).min(FORCING);
        }
    }

    /// Returns the norm of the loads on free entries, N; an error for loads that move a free body. A small resultant is
    /// projected out.
    fn load_norm(&mut self, system: &System, target: &Target<'_>) -> Result<f64> {
        let (n, volumes) = (system.points(), system.cloud().volumes());
        let force = |k: usize| self.free[k] * volumes[k % n] * target.load[k];
        let load = system
            .domain()
            .sum(self.free.len(), |k| force(k).powi(2))
            .sqrt();
        let along = |mode: &Vec<f64>| {
            let part = system.domain().sum(mode.len(), |k| mode[k] * force(k));
            part.abs() / load
        };
        let part = self.rigid.iter().map(along).fold(0.0, f64::max);
        /// Tolerance for round-off of sums and positions.
        const BALANCED: f64 = 1e-9;
        /// Loads that are in balance on a surface act on points at some distance from it, which causes a resultant moment.
        const MOST: f64 = 0.01;
        if part > MOST {
            return Err(StaticsError::Unbalanced { t: target.t, part }.into());
        }
        if part > BALANCED.max(0.1 * self.options.tolerance) {
            self.left_out = self.left_out.max(part);
        }
        Ok(load)
    }

    /// Stores the differences of constrained entries to their prescribed values; returns whether any of the whole body is not
    /// zero.
    fn set_lift(&mut self, system: &System, target: &Target<'_>, u: &[f64]) -> bool {
        let mut any = false;
        for k in 0..u.len() {
            self.lift[k] = if self.free[k] == 0.0 {
                target.supports[k] - u[k]
            } else {
                0.0
            };
            any |= self.lift[k] != 0.0;
        }
        !system.domain().all(!any)
    }

    /// Sets the residual V (f + b) at u and returns its norm on free entries.
    fn evaluate(
        &mut self,
        system: &System,
        target: &Target<'_>,
        u: &[f64],
        effort: &mut Effort,
    ) -> f64 {
        effort.forces += 1;
        residual_into(system, target, u, &mut self.residual);
        remove(system, &self.rigid, &mut self.residual);
        free_norm(system, &self.free, &self.residual)
    }

    /// Returns the reference of the residual: the largest norm of loads or reactions so far; if there were
    /// none, the first residual.
    fn acting(&self, system: &System, load: f64, largest: f64, first: f64) -> f64 {
        let entries = self.residual.len();
        let held = |k: usize| (1.0 - self.free[k]) * self.residual[k].powi(2);
        let reactions = system.domain().sum(entries, held).sqrt();
        match load.max(reactions).max(largest) {
            0.0 => first,
            acting => acting,
        }
    }

    /// Adds the linearised effect of the motion of the supports to the residual.
    fn linearise_lift(&mut self, system: &System, target: &Target<'_>, u: &[f64]) {
        let times = [target.t, target.place];
        stiffness_into(
            system,
            Derivative::Tangent,
            times,
            u,
            &self.lift,
            &mut self.correction,
        );
        add_multiple(&mut self.residual, -1.0, &self.correction);
        remove(system, &self.rigid, &mut self.residual);
    }

    /// Computes the correction for the residual.
    pub(crate) fn solve(
        &mut self,
        system: &System,
        (of, times): (Derivative, [f64; 2]),
        u: &[f64],
        goal: &Goal<'_>,
    ) -> Result<Solution> {
        let mut tangent = Tangent {
            of,
            system,
            times,
            u,
            replicated: &self.replicated,
            unknowns: &self.unknowns,
            multigrid: &mut self.multigrid,
            rigid: &self.rigid,
            work: &mut self.reduced,
        };
        let solved = conjugate_gradients(
            &mut tangent,
            (system.domain(), &self.free),
            &mut self.residual,
            &mut self.correction,
            goal,
            &mut self.krylov,
        )?;
        self.convergence.note(&solved);
        Ok(solved)
    }

    /// Line search along the correction. Returns the reduced norm of the residual; `None` if it does not decrease.
    fn search(
        &mut self,
        system: &System,
        target: &Target<'_>,
        u: &mut [f64],
        before: f64,
        effort: &mut Effort,
    ) -> Option<f64> {
        let mut length = 1.0;
        for _ in 0..=HALVINGS {
            self.trial.copy_from_slice(u);
            add_multiple(&mut self.trial, length, &self.correction);
            effort.forces += 1;
            residual_into(system, target, &self.trial, &mut self.trial_residual);
            remove(system, &self.rigid, &mut self.trial_residual);
            let norm = free_norm(system, &self.free, &self.trial_residual);
            if norm < before * (1.0 - 1e-4 * length) {
                u.copy_from_slice(&self.trial);
                self.residual.copy_from_slice(&self.trial_residual);
                return Some(norm);
            }
            length *= 0.5;
        }
        None
    }
}

pericles::saved! {
    impl Checkpointed for Equilibrium {
        free: points("static/free"),
        stiffness: part,
        options: fixed,
        // By `recreate`.
        replicated, unknowns, multigrid, pieces, rigid, left_out: rebuilt,
        convergence, krylov, reduced, residual, correction, lift, trial, trial_residual: scratch,
    }
}

/// Computes `out` = V (f(u) + b), N.
fn residual_into(system: &System, target: &Target<'_>, u: &[f64], out: &mut [f64]) {
    out.copy_from_slice(target.load);
    add_internal(system, [target.t, target.place], u, out);
    let (n, volumes) = (system.points(), system.cloud().volumes());
    pericles::parallel::for_each_chunk(out, &|first, chunk| {
        for (k, out) in chunk.iter_mut().enumerate() {
            *out *= volumes[(first + k) % n];
        }
    });
}

/// Returns whether residuals are linear in the displacement.
pub(crate) fn is_linear(system: &System) -> bool {
    system.operator().as_linear().is_some() && !system.has_interactions()
}

/// Adds the force density (N/m³) of bonds at the first time and that of contact at the second one.
pub(crate) fn add_internal(system: &System, times: [f64; 2], u: &[f64], out: &mut [f64]) {
    system
        .operator()
        .add_force(times[0], u, PointSubset::All, out);
    system.add_contact_force(times[1], u, out);
}

/// Returns the norm of the free entries of a vector.
fn free_norm(system: &System, free: &[f64], vector: &[f64]) -> f64 {
    system
        .domain()
        .sum(vector.len(), |k| free[k] * vector[k].powi(2))
        .sqrt()
}

/// Returns whether an error is an interruption, so that a shorter step does not help.
pub(crate) fn is_interrupt(error: &PericlesError) -> bool {
    matches!(error, PericlesError::Interrupted)
}
