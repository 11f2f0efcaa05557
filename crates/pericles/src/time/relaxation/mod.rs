//! Static states by fictitious motion: adaptive dynamic relaxation and FIRE.

mod fire;
mod motion;

pub use motion::Damping;

use motion::Motion;

use super::{InnerIterations, Integrator, State};
use crate::compatibility::{Need, Requirement, require};
use crate::error::{PericlesError, Result};
use crate::interrupt::Interrupt;
use crate::operator::PointSubset;
use crate::scalar::PointScalar;
use crate::step_end::{Path, StepEnd};
use crate::system::System;

/// Options of [`Relaxation`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelaxationOptions {
    /// Damping of the fictitious motion.
    pub damping: Damping,
    /// Allowed relative residual: norm of the unbalanced forces over the largest norm of loads or reactions so far.
    pub tolerance: f64,
    /// Largest number of iterations per equilibrium.
    pub iterations: u32,
}

impl Default for RelaxationOptions {
    fn default() -> Self {
        Self {
            damping: Damping::Adaptive,
            tolerance: 1e-6,
            iterations: 100_000,
        }
    }
}

/// Adaptive dynamic relaxation: each step leads from one static state to the next. Loads and constraints take their
/// values at the end of the step, and
///
/// M v̇ + c M v = f(u) + b
///
/// is integrated with unit steps by central differences until the force F = f + b on the free points is below the
/// tolerance. The fictitious masses M make a unit step stable (Underwood, *Dynamic relaxation*, 1983; Kilic &
/// Madenci, Theor. Appl. Fract. Mech. 53, 194, 2010):
///
/// v ← ((2 − c) v + 2 F/M)/(2 + c), u ← u + v.
///
/// With [`Damping::Fire`] there is no coefficient c. The velocity is turned towards the force and accelerated by
/// it in steps Δτ ≤ 1 (semi-implicit Euler),
///
/// v ← (1 − α) v + α |v| F/|F| + Δτ F/M, u ← u + Δτ v,
///
/// with the standard constants of Bitzek et al. (2006): after five steps with positive power F·v the step grows by
/// 10 % and α = 0.1 shrinks by 1 % per step; when the power is not positive the body stops, the step is halved and α
/// is reset. The norms include the masses. Steps begin at 0.1; the largest step of 1 is the stable step of the masses.
///
/// Then all bonds beyond their critical stretch break at once, and the body relaxes again under the same loads,
/// until no bond breaks. Physical masses play no role, and time enters through loads and constraints only.
///
/// Energy balance: loads and constraints change slowly within a load step from their values at the last static
/// state to those at the next. They do the work of their mean forces, which is exact for linear forces and
/// otherwise of second order in the length of load steps. The run starts from the unloaded body: in the first load
/// step all loads and prescribed displacements grow from zero, constant ones too, so that a dead load F does the
/// work ½ F u that the body stores. A bond that breaks dissipates its energy at the previous static state. The
/// energy that the body then releases until the next equilibrium, or from an initial displacement out of
/// equilibrium, goes into the damping, as it would go into waves. It is measured as the loss of elastic energy plus
/// the work of loads and constraints, and reported as the correction of the scheme.
#[derive(Debug, Clone)]
pub struct Relaxation {
    options: RelaxationOptions,
    motion: Motion,
    force: Vec<f64>,
    before: Vec<f64>,
    /// Largest norm of loads or reactions at an equilibrium so far, N.
    largest: f64,
    /// Energy taken by the damping after bonds broke, J.
    damped: f64,
    inner: InnerIterations,
    /// Number of iterations of the present step.
    iterations: u64,
}

/// Returns the name of the scheme with this damping.
fn name_of(damping: Damping) -> &'static str {
    match damping {
        Damping::Fire => "fire",
        Damping::Adaptive | Damping::Viscous(_) => "adaptive-dynamic-relaxation",
    }
}

impl Relaxation {
    /// Requirements on the system.
    pub const REQUIREMENTS: &'static [Requirement] = &[
        Requirement::IN_DOUBLES,
        Requirement {
            need: Need::NoBoundaries,
            reason: "static states have no waves to absorb and no velocities to damp; leave the boundary out",
        },
        Requirement::CONSERVATIVE_CONTACT,
        Requirement::NO_FREE_BODIES,
    ];

    /// Makes the scheme for a system.
    ///
    /// # Errors
    /// Options out of range; a body whose stiffness at rest is zero or unknown.
    pub fn new(options: RelaxationOptions, system: &System) -> Result<Self> {
        let reject = |parameter, value, allowed| {
            Err(PericlesError::SchemeParameter {
                parameter,
                value,
                allowed,
            })
        };
        if !(options.tolerance > 0.0 && options.tolerance < 1.0) {
            return reject("the tolerance", options.tolerance, "above 0 and below 1");
        }
        if let Damping::Viscous(damping) = options.damping
            && !(damping > 0.0 && damping < 2.0)
        {
            return reject("the damping", damping, "above 0 and below 2");
        }
        let name = name_of(options.damping);
        require(name, Self::REQUIREMENTS, system)?;
        // Unit densities give the bound of the stiffness itself.
        let omega = system.operator().frequency_bound(&|_| 1.0);
        let omega = omega.hypot(system.contact_frequency(&PointScalar::Uniform(1.0)));
        if !(omega > 0.0 && omega.is_finite()) {
            return Err(PericlesError::SchemeNotUsable {
                scheme: name,
                reason: "its bonds have no stiffness at rest, which determines the fictitious masses",
            });
        }
        /// The stability limit is ω dt = 2; the margin covers bonds that stiffen as they rotate.
        const OMEGA_DT: f64 = 1.8;
        let entries = system.dimension() * system.points();
        let zeros = || vec![0.0; entries];
        Ok(Self {
            options,
            motion: Motion::new(options.damping, (OMEGA_DT / omega).powi(2), entries),
            force: zeros(),
            before: zeros(),
            largest: 0.0,
            damped: 0.0,
            inner: InnerIterations::default(),
            iterations: 0,
        })
    }

    /// Number of iterations of all equilibria so far.
    pub fn iterations(&self) -> u64 {
        self.inner.total
    }

    /// Moves `u` to the equilibrium at time t with the current bonds, without bookkeeping. The residual is relative to
    /// `largest` (N) at least, the largest norm of loads or reactions before. Returns the relative residual and the number of
    /// iterations.
    ///
    /// # Errors
    /// [`PericlesError::NoEquilibrium`]; [`PericlesError::Interrupted`].
    pub fn find(
        &mut self,
        system: &System,
        t: f64,
        u: &mut [f64],
        largest: f64,
        interrupt: Interrupt<'_>,
    ) -> Result<(f64, u64)> {
        self.largest = self.largest.max(largest);
        self.iterations = 0;
        let residual = self.relax(system, t, u, interrupt)?;
        Ok((residual, self.iterations))
    }

    /// Moves `u` to the equilibrium at time t with the current bonds; returns the relative residual.
    fn relax(
        &mut self,
        system: &System,
        t: f64,
        u: &mut [f64],
        interrupt: Interrupt<'_>,
    ) -> Result<f64> {
        let RelaxationOptions {
            tolerance,
            iterations,
            ..
        } = self.options;
        system.place_on(t, &PointSubset::All, u);
        self.motion.rest(system, t, u);
        system.load_density_into(t, &mut self.force);
        let load = self.norm(system, &self.force, |free| free);
        let load = load.max(system.thermal_force(t, u));
        let mut first = f64::NAN;
        let (mut ratio, mut done) = (f64::NAN, 0);
        for iteration in 0..=iterations {
            interrupt.poll()?;
            done = iteration;
            system.force_density_into(t, u, &mut self.force);
            let residual = self.norm(system, &self.force, |free| free);
            if iteration == 0 {
                first = residual;
            }
            let support = self.norm(system, &self.force, |free| 1.0 - free);
            // When a body breaks apart, no force remains to compare with; hence the largest forces so far count
            // too. Without any loads or reactions the initial residual is the scale.
            let acting = match load.max(support).max(self.largest) {
                0.0 => first,
                acting => acting,
            };
            ratio = if residual == 0.0 {
                0.0
            } else {
                residual / acting
            };
            if ratio <= tolerance {
                self.largest = self.largest.max(load).max(support);
                return Ok(ratio);
            }
            if !ratio.is_finite() || iteration == iterations {
                break;
            }
            self.iterations += 1;
            self.motion.advance(system, &self.force, u);
        }
        Err(PericlesError::NoEquilibrium {
            t,
            iterations: done,
            residual: ratio,
            tolerance,
        })
    }

    /// Returns √Σ (V F)² over the entries with `counts` = 1, N.
    fn norm(&self, system: &System, force: &[f64], counts: impl Fn(f64) -> f64 + Sync) -> f64 {
        let (n, volumes) = (system.points(), system.cloud().volumes());
        system
            .domain()
            .sum(force.len(), |entry| {
                counts(self.motion.free[entry]) * (force[entry] * volumes[entry % n]).powi(2)
            })
            .sqrt()
    }

    /// Breaks bonds beyond their critical stretch and relaxes again until none is left; returns the final relative
    /// residual.
    fn settle(
        &mut self,
        system: &mut System,
        state: &mut State,
        t: f64,
        mut residual: f64,
        interrupt: Interrupt<'_>,
    ) -> Result<f64> {
        loop {
            let broken = system.operator().broken_bonds();
            let end = StepEnd::sub_step(t, 0.0, &state.u);
            system.end_step_on(&end, &PointSubset::All, &mut state.a);
            if system.operator().broken_bonds() == broken {
                return Ok(residual);
            }
            self.before.copy_from_slice(&state.u);
            let (elastic, work) = (system.stored_energy(t, &state.u), system.ledger().work);
            residual = self.relax(system, t, &mut state.u, interrupt)?;
            let after_breaking = StepEnd {
                t,
                dt: 0.0,
                u: &state.u,
                path: Path::Chord {
                    u: &self.before,
                    first: false,
                },
            };
            system.book_equilibrium(&after_breaking, &mut state.a);
            self.damped +=
                elastic - system.stored_energy(t, &state.u) + system.ledger().work - work;
        }
    }
}

impl Integrator for Relaxation {
    fn name(&self) -> &'static str {
        name_of(self.options.damping)
    }

    fn vector_length(&self) -> Option<usize> {
        Some(self.force.len())
    }

    fn requirements(&self) -> &'static [Requirement] {
        Self::REQUIREMENTS
    }

    /// Order of the work between static states in the length of load steps.
    fn order(&self) -> u32 {
        2
    }

    /// None: load steps may have any length.
    fn stability_limit(&self) -> Option<f64> {
        None
    }

    /// Energy taken by the damping when bonds broke.
    fn energy_correction(&self, _system: &System, _state: &State, _dt: f64) -> f64 {
        self.damped
    }

    fn inner_iterations(&self) -> Option<InnerIterations> {
        Some(self.inner)
    }

    fn is_static(&self) -> bool {
        true
    }

    /// Displacements are iterated in place, and bonds break between equilibria.
    fn changes_within_step(&self) -> bool {
        true
    }

    fn start(&mut self, system: &mut System, state: &mut State) {
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
        let dt = t_next - state.t;
        let before = state.u.clone();
        let first = state.step == 0;
        let displaced = first && before.iter().any(|u| *u != 0.0);
        let elastic = if displaced {
            system.stored_energy(state.t, &before)
        } else {
            0.0
        };
        self.iterations = 0;
        let mut residual = self.relax(system, t_next, &mut state.u, interrupt)?;
        let load_step = StepEnd {
            t: t_next,
            dt,
            u: &state.u,
            path: Path::Chord { u: &before, first },
        };
        let work = system.ledger().work;
        system.book_equilibrium(&load_step, &mut state.a);
        if displaced {
            self.damped +=
                elastic - system.stored_energy(t_next, &state.u) + system.ledger().work - work;
        }
        if system.operator().changes_at_step_ends() {
            residual = self.settle(system, state, t_next, residual, interrupt)?;
        }
        self.inner.count(self.iterations, residual);
        state.v.fill(0.0);
        state.a.fill(0.0);
        state.t = t_next;
        state.step += 1;
        Ok(())
    }
}

crate::saved! {
    impl Checkpointed for Relaxation {
        damped, largest: array("relaxation/account"),
        inner: part,
        options: fixed,
        motion, force, before, iterations: scratch,
    }
}
