//! Integrator whose steps are static load steps.
//!
//! A load step is a step of the time loop, so that observers and checkpoints are the same as in dynamic runs. The
//! work is that of the mean forces between equilibria; the energy that a body loses after bonds break is measured and
//! reported as the correction of the scheme. Path-dependent forces are notified of every accepted state: a step then
//! ends at each static state, even where no bond can break.

mod controlled;
mod event;
mod jump;

use pericles::boundary::{Exchange, ProportionalLoading};
use pericles::operator::PointSubset;
use pericles::time::{Damping, InnerIterations, Integrator, Relaxation, RelaxationOptions, State};
use pericles::{
    Interrupt, Need, Path, PericlesError, Requirement, Result, StepEnd, System, require,
};

use crate::breaking::BreakingRule;
use crate::control::Control;
use crate::convergence::Convergence;
use crate::equilibrium::{Effort, Equilibrium};
use crate::error::{MOST_REPLICATED, StaticsError, is_no_equilibrium};
use crate::events;
use crate::options::StaticOptions;
use crate::path::{Follower, LoadStep, Loading};
use crate::reference::Reference;
use pericles::units::significant;

/// Static integrator: each step is a load step to the next static state. Loads and supports have their values
/// at the end of the step, and f(u) + b = 0 is solved on the free entries by Newton's method.
///
/// Linear problems are solved by conjugate gradients with the exact tangent, preconditioned by
/// smoothed-aggregation multigrid of springs between neighbouring points
/// ([`Surrogate`](crate::surrogate::Surrogate)), so that the number of products does not grow with the body.
/// Their accuracy is adapted to Newton's method (Eisenstat & Walker, SIAM J. Sci. Comput. 17, 1996), and they
/// stop at directions without positive curvature (Steihaug 1983). A correction that does not reduce the
/// residual is shortened; a load step that does not converge is divided.
///
/// Bonds that exceed their critical stretch in a static state break, by default those with the largest
/// stretch first ([`BreakingRule`](crate::BreakingRule)), and the state is recomputed at the same loads until
/// no bond breaks.
///
/// With [`BreakingRule::Event`] each step computes the load and the state at which the next bond breaks: for linear
/// forces from one solution, otherwise by a search of the load factor at which the largest ratio of a bond stretch to
/// its critical stretch is 1. Between events the bonds do not change, so that the load factor determines the state;
/// it jumps backwards where the body snaps back, and no arc length along a falling branch is needed.
///
/// With a [`Control`] each step is the state in which a quantity of the displacements has the value of its time, at the
/// load that belongs to it. Softening bodies are followed beyond the largest load in this way.
///
/// Energy balance: loads and supports change linearly within a load step. For linear forces their work is
/// exactly that of the mean forces; for nonlinear forces it is integrated by Simpson's rule over intermediate
/// static states, so that the energy balance closes to a small multiple of the tolerance. The run starts from
/// the unloaded body. The energy released after bonds broke is reported as the correction of the scheme, as
/// by [`Relaxation`](pericles::time::Relaxation).
#[derive(Debug, Clone)]
pub struct StaticScheme {
    options: StaticOptions,
    /// Control of the load factor.
    control: Option<Control>,
    entries: usize,
    /// Solver for the bonds and supports of the last static state.
    equilibrium: Equilibrium,
    /// Number of broken bonds when the solver was created.
    broken: u64,
    /// Whether the state of the solver was restored from a checkpoint, so that the solver must be created again.
    restored: bool,
    /// Largest norm of loads or reactions at a static state so far, N.
    largest: f64,
    /// Energy released after bonds broke, J.
    released: f64,
    /// Factor of loads and displacements of supports at the last event.
    factor: f64,
    /// Largest resultant of the loads on free bodies that was left out, relative to their norm.
    left_out: f64,
    /// Number of load steps with states that were found by damped dynamics.
    relaxed: u64,
    /// Whether states of the present load step are found by damped dynamics.
    relaxing: bool,
    inner: InnerIterations,
    /// Effort of the last step.
    effort: Effort,
}

const NAME: &str = "static";

impl StaticScheme {
    /// Requirements on a system.
    pub const REQUIREMENTS: &'static [Requirement] = &[
        Requirement::IN_DOUBLES,
        Requirement {
            need: Need::NoBoundaries,
            reason: "static states have no waves to absorb and no velocities to damp; leave the boundary out",
        },
        Requirement::CONSERVATIVE_CONTACT,
        Requirement::NO_FREE_BODIES,
    ];

    /// Creates the scheme for a system with the supports at the start.
    ///
    /// # Errors
    /// Options out of range, a system that does not meet the requirements, unconstrained rigid-body motions.
    pub fn new(options: StaticOptions, system: &System) -> Result<Self> {
        Self::with(options, None, system)
    }

    /// Creates the scheme whose steps prescribe a quantity of the displacements. Loads and displacements of supports are
    /// multiples of their values at the reference time of the control.
    ///
    /// # Errors
    /// The errors of [`StaticScheme::new`]; event-by-event breaking, contact, thermal strain, no loads.
    pub fn controlled(options: StaticOptions, control: Control, system: &System) -> Result<Self> {
        let refuse = |reason| StaticsError::NoControl { reason };
        if let BreakingRule::Event { .. } = options.breaking {
            return Err(refuse(
                "breaking = \"event\" follows falling branches and snap-backs itself (end the run by a condition on the quantity in [[time.stop_when]])",
            )
            .into());
        }
        Reference::check(system, control.reference, refuse)?;
        Self::with(options, Some(control), system)
    }

    fn with(options: StaticOptions, control: Option<Control>, system: &System) -> Result<Self> {
        if !(options.tolerance > 0.0 && options.tolerance < 1.0) {
            return Err(PericlesError::SchemeParameter {
                parameter: "the tolerance",
                value: options.tolerance,
                allowed: "above 0 and below 1",
            });
        }
        require(NAME, Self::REQUIREMENTS, system)?;
        let supported = match options.breaking {
            BreakingRule::Event { reference, .. } => {
                events::check(system, reference)?;
                reference
            }
            _ => control.as_ref().map_or(0.0, |control| control.reference),
        };
        let unknowns = system.dimension() * system.domain().whole_points();
        if system.domain().is_divided() && unknowns > MOST_REPLICATED {
            return Err(StaticsError::TooManyUnknowns { unknowns }.into());
        }
        let equilibrium = Equilibrium::new(options, system, free_at(system, supported));
        equilibrium.check_support()?;
        Ok(Self {
            options,
            control,
            entries: system.dimension() * system.points(),
            broken: system.operator().broken_bonds(),
            restored: false,
            equilibrium,
            largest: 0.0,
            released: 0.0,
            factor: 0.0,
            left_out: 0.0,
            relaxed: 0,
            relaxing: false,
            inner: InnerIterations::default(),
            effort: Effort::default(),
        })
    }

    /// Returns the effort of the last step.
    pub fn effort(&self) -> Effort {
        self.effort
    }

    /// Returns the solver for the bonds and supports of the last static state.
    pub fn equilibrium(&self) -> &Equilibrium {
        &self.equilibrium
    }

    /// Returns the time at which loads and supports have the values that are scaled, if they are.
    fn reference(&self) -> Option<f64> {
        match (&self.control, self.options.breaking) {
            (Some(control), _) => Some(control.reference),
            (None, BreakingRule::Event { reference, .. }) => Some(reference),
            (None, _) => None,
        }
    }

    /// Recreates the solver if supports or bonds have changed.
    fn prepare(&mut self, system: &System, t: f64) -> Result<()> {
        let free = free_at(system, t);
        let broken = system.operator().broken_bonds();
        let held_anew = !system.domain().all(free == self.equilibrium.free());
        if held_anew || broken != self.broken {
            self.equilibrium = Equilibrium::new(self.options, system, free);
            self.broken = broken;
        } else if self.restored {
            self.equilibrium.recreate(system);
        }
        self.restored = false;
        // Parts that break off keep their displacement; parts that constraints release must be supported otherwise.
        if held_anew {
            self.equilibrium.check_support()?;
        }
        Ok(())
    }

    /// Advances `u`, and the factor of controlled loads, along a load step and returns the work done.
    fn follow(
        &mut self,
        system: &System,
        step: LoadStep<'_>,
        (u, factor, with_work): (&mut Vec<f64>, &mut f64, bool),
        interrupt: Interrupt<'_>,
    ) -> Result<f64> {
        let mut follower = Follower {
            system,
            equilibrium: &mut self.equilibrium,
            step,
            interrupt,
            exchanged: system.ledger().exchanged,
        };
        let followed = follower.follow(u, factor, with_work)?;
        self.left_out = self.left_out.max(self.equilibrium.left_out());
        self.effort.add(followed.effort);
        self.largest = self.largest.max(followed.effort.acting);
        Ok(followed.work)
    }

    /// Advances `u` along a load step, or by damped dynamics to a state at its end if there are no static states along it: a body
    /// that splits or buckles moves to its next state. Returns the work done; `None` if the path is not static.
    fn reach(
        &mut self,
        system: &System,
        step: LoadStep<'_>,
        (u, with_work): (&mut Vec<f64>, bool),
        interrupt: Interrupt<'_>,
    ) -> Result<Option<f64>> {
        let (t, largest) = (step.t, self.largest.max(step.largest));
        let tolerance = step.tolerance;
        let mut whole = 1.0;
        let failed = if self.relaxing {
            None
        } else {
            match self.follow(system, step, (u, &mut whole, with_work), interrupt) {
                Ok(work) => return Ok(Some(work)),
                Err(error) if is_no_equilibrium(&error) => Some(error),
                Err(error) => return Err(error),
            }
        };
        /// Largest number of iterations of damped dynamics.
        const ITERATIONS: u32 = 200_000;
        let options = RelaxationOptions {
            damping: Damping::Fire,
            tolerance,
            iterations: ITERATIONS,
        };
        let mut relaxation = Relaxation::new(options, system)?;
        match relaxation.find(system, t, u, largest, interrupt) {
            Ok((residual, iterations)) => {
                self.relaxing = true;
                self.effort.forces += iterations;
                self.effort.products += iterations;
                self.effort.residual = residual;
                Ok(None)
            }
            Err(PericlesError::Interrupted) => Err(PericlesError::Interrupted),
            Err(error) => Err(failed.unwrap_or(error)),
        }
    }

    /// Breaks bonds beyond their limits and recomputes the static state until no bond breaks. `is_jump` is that of
    /// [`Self::break_bonds`] for the present state.
    ///
    /// States between which bonds break only select the next bonds, for which a hundred times the tolerance suffices. When
    /// no bond breaks, the state is computed to the tolerance, and bonds are checked again.
    fn settle(
        &mut self,
        system: &mut System,
        state: &mut State,
        (t, load, mut is_jump): (f64, &[f64], bool),
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        let finest = self.options.tolerance;
        /// Largest tolerance of states between which bonds break.
        const COARSEST: f64 = 1e-3;
        let coarse = (100.0 * finest).min(COARSEST).max(finest);
        let mut tolerance = finest;
        loop {
            // A body that moves to its next state breaks everywhere.
            let rule = match self.relaxing {
                true => BreakingRule::All,
                false => self.options.breaking,
            };
            let breaks = self.break_bonds(system, state, (t, is_jump), rule);
            if !breaks && tolerance == finest {
                return Ok(());
            }
            tolerance = if breaks { coarse } else { finest };
            if self.equilibrium.convergence.is_outdated() {
                self.prepare(system, t)?;
            }
            is_jump = true;
            let before = state.u.clone();
            let (elastic, work) = (system.stored_energy(t, &before), system.ledger().work);
            let step = LoadStep {
                t,
                start: t,
                loading: Loading::Prescribed {
                    loads: [load; 2],
                    supports: [&before; 2],
                },
                largest: self.largest,
                tolerance,
            };
            self.reach(system, step, (&mut state.u, false), interrupt)?;
            system.book_equilibrium(&chord(t, 0.0, &state.u, &before, false), &mut state.a);
            self.released +=
                elastic - system.stored_energy(t, &state.u) + system.ledger().work - work;
        }
    }

    /// Records the effort of a step and advances the time to its end.
    fn close_step(&mut self, state: &mut State, t_next: f64) {
        self.relaxed += u64::from(self.relaxing);
        let InnerIterations { most, total, .. } = self.inner;
        self.inner = InnerIterations {
            last: self.effort.products,
            change: self.effort.residual,
            most: most.max(self.effort.products),
            total: total.saturating_add(self.effort.products),
        };
        state.v.fill(0.0);
        state.a.fill(0.0);
        state.t = t_next;
        state.step += 1;
    }
}

fn chord<'a>(t: f64, dt: f64, u: &'a [f64], before: &'a [f64], first: bool) -> StepEnd<'a> {
    let path = Path::Chord { u: before, first };
    StepEnd { t, dt, u, path }
}

/// Returns 1 for entries that are free at a time, 0 for constrained entries.
fn free_at(system: &System, t: f64) -> Vec<f64> {
    let mut free = vec![1.0; system.dimension() * system.points()];
    system.hold_at(t, &mut free);
    free
}

impl Integrator for StaticScheme {
    fn name(&self) -> &'static str {
        NAME
    }

    fn vector_length(&self) -> Option<usize> {
        Some(self.entries)
    }

    fn requirements(&self) -> &'static [Requirement] {
        Self::REQUIREMENTS
    }

    /// Returns the order of the work between static states in the length of load steps.
    fn order(&self) -> u32 {
        4
    }

    /// Returns `None`: load steps can have any length.
    fn stability_limit(&self) -> Option<f64> {
        None
    }

    /// Returns the energy released after bonds broke.
    fn energy_correction(&self, _system: &System, _state: &State, _dt: f64) -> f64 {
        self.released
    }

    fn inner_iterations(&self) -> Option<InnerIterations> {
        Some(self.inner)
    }

    fn is_static(&self) -> bool {
        true
    }

    /// Returns true: displacements are iterated in place, and bonds break between equilibria.
    fn changes_within_step(&self) -> bool {
        true
    }

    fn remark(&self) -> Option<String> {
        let left_out = (self.left_out > 0.0).then(|| {
            format!(
                "the loads on a free body are not exactly in balance: their resultant along rigid-body motions, {} % of their norm, is left out (rigid_modes = \"fix\")",
                significant(100.0 * self.left_out, 2)
            )
        });
        let found_by = match self.control {
            Some(_) => "failure of bonds at the controlled value",
            None => "damped dynamics",
        };
        let relaxed = (self.relaxed > 0).then(|| {
            format!(
                "{} load steps have no static path, because the body splits, softens or buckles: their states were found by {found_by}, and the energy released on the way is part of the scheme correction",
                self.relaxed
            )
        });
        let all: Vec<String> = [left_out, relaxed].into_iter().flatten().collect();
        (!all.is_empty()).then(|| all.join("; "))
    }

    fn start(&mut self, system: &mut System, state: &mut State) {
        if let Some(reference) = self.reference() {
            let factors = [0.0; 2];
            system.load_proportionally(ProportionalLoading { reference, factors });
        }
        state.v.fill(0.0);
        system.note_unloaded(state.t, &state.u, &mut state.a);
        state.a.fill(0.0);
    }

    fn step(
        &mut self,
        system: &mut System,
        state: &mut State,
        t_next: f64,
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        self.effort = Effort::default();
        if let BreakingRule::Event { reference, .. } = self.options.breaking {
            self.step_to_event(system, state, (t_next, reference), interrupt)?;
            self.close_step(state, t_next);
            return Ok(());
        }
        if let Some(control) = self.control.clone() {
            self.step_controlled(system, state, (t_next, &control), interrupt)?;
            self.close_step(state, t_next);
            return Ok(());
        }
        self.prepare(system, t_next)?;
        self.equilibrium.convergence = Convergence::default();
        let first = state.step == 0;
        let before = state.u.clone();
        // An initial displacement is not a static state: the first load step is a jump.
        let displaced = first && !system.domain().all(before.iter().all(|u| *u == 0.0));
        let mut loads = [vec![0.0; self.entries], vec![0.0; self.entries]];
        if !first {
            system.balanced_load_into(state.t, &mut loads[0]);
        }
        system.load_density_into(t_next, &mut loads[1]);
        self.equilibrium.check_loads(system, t_next, &loads[1])?;
        let mut supports = before.clone();
        system.place_on(t_next, &PointSubset::All, &mut supports);
        let step = LoadStep {
            t: t_next,
            start: state.t,
            loading: Loading::Prescribed {
                loads: [&loads[0], &loads[1]],
                supports: [&before, &supports],
            },
            largest: self.largest.max(system.thermal_force(t_next, &before)),
            tolerance: self.options.tolerance,
        };
        self.relaxing = false;
        let elastic = system.stored_energy(state.t, &before);
        let work = self.reach(system, step, (&mut state.u, !displaced), interrupt)?;
        let booked = system.ledger().work;
        let end = chord(t_next, t_next - state.t, &state.u, &before, first);
        let heating = system.operator().heating(&end);
        system.book_equilibrium(&end, &mut state.a);
        let of_means = system.ledger().work - booked;
        let is_jump = work.is_none() || displaced;
        match work {
            Some(work) if !displaced => system.book_exchange(Exchange {
                work: work + heating - of_means,
                impulse: [0.0; 3],
            }),
            // A jump: the body releases what it does not store.
            _ => self.released += elastic - system.stored_energy(t_next, &state.u) + of_means,
        }
        if system.operator().changes_at_step_ends() {
            self.settle(system, state, (t_next, &loads[1], is_jump), interrupt)?;
        }
        self.close_step(state, t_next);
        Ok(())
    }
}

pericles::saved! {
    impl Checkpointed for StaticScheme {
        released, largest, factor, left_out: array("static/account"),
        inner: part,
        broken, relaxed: array("static/counts"),
        equilibrium: part,
        options, control, entries: fixed,
        effort, relaxing: scratch,
        restored: set(true),
    }
}
