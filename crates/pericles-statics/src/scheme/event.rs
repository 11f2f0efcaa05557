//! Steps from one breaking bond to the next.
//!
//! The state of a linear body is the load factor times one solution; for nonlinear forces the factor is searched with
//! fixed bonds. Only the load factor is kept between steps, so that a resumed run is bitwise identical.

use pericles::boundary::{Exchange, ProportionalLoading};
use pericles::time::State;
use pericles::{Interrupt, Result, System};

use super::{StaticScheme, chord};
use crate::error::StaticsError;
use crate::events;
use crate::path::{LoadStep, Loading};
use crate::reference::{Reference, scaled};
use crate::stretch::largest_ratio;

/// States between the last event and the next one.
struct Between {
    /// State at the load of the last event, after its bonds broke.
    settled: Vec<f64>,
    /// State at the next event.
    u: Vec<f64>,
    /// Factor of the reference loads at the next event; `None` if no bond is stretched.
    factor: Option<f64>,
    /// Work of loads and supports, J; `None` if it is that of the mean forces.
    work: Option<f64>,
}

impl StaticScheme {
    /// Advances `state` to the next event: scales loads and displacements of the supports such that the most
    /// stretched bond reaches its critical stretch, and breaks it.
    pub(super) fn step_to_event(
        &mut self,
        system: &mut System,
        state: &mut State,
        (t, reference): (f64, f64),
        interrupt: Interrupt<'_>,
    ) -> Result<()> {
        self.prepare(system, reference)?;
        let first = state.step == 0;
        let at = Reference::of(system, reference);
        let loading = |factors| ProportionalLoading { reference, factors };
        self.equilibrium.check_loads(system, t, &at.load)?;
        let between = if system.operator().as_linear().is_some() {
            self.next_of_linear(system, &at, &state.u, interrupt)?
        } else {
            self.search(system, &at, &state.u, interrupt)?
        };
        if between.factor.is_none() && first {
            return Err(StaticsError::NoEvents {
                reason: "no bond reaches its limit at any multiple of the loads and displacements at the end of the run (is the body in compression?)",
            }
            .into());
        }
        let factor = between.factor.unwrap_or(self.factor);
        let last = self.factor;
        system.load_proportionally(loading([last; 2]));
        if !first {
            let (elastic, work) = (system.operator().energy(t, &state.u), system.ledger().work);
            let end = chord(t, 0.0, &between.settled, &state.u, false);
            system.book_equilibrium(&end, &mut state.a);
            self.released += elastic - system.operator().energy(t, &between.settled)
                + system.ledger().work
                - work;
        }
        state.u = between.u;
        system.load_proportionally(loading([last, factor]));
        let end = chord(t, t - state.t, &state.u, &between.settled, first);
        let booked = system.ledger().work;
        system.book_equilibrium(&end, &mut state.a);
        if let Some(work) = between.work {
            let of_means = system.ledger().work - booked;
            system.book_exchange(Exchange {
                work: work - of_means,
                impulse: [0.0; 3],
            });
        }
        self.factor = factor;
        if between.factor.is_some() {
            let rule = self.options.breaking;
            let broken = rule.apply(system, t, &state.u, &mut state.a);
            self.released += broken.ok_or(StaticsError::NoEvents {
                reason: "bonds do not break at a critical stretch",
            })?;
        }
        Ok(())
    }

    /// Returns the states of a linear body, all of which are multiples of one solution.
    fn next_of_linear(
        &mut self,
        system: &System,
        at: &Reference,
        u: &[f64],
        interrupt: Interrupt<'_>,
    ) -> Result<Between> {
        let free = self.equilibrium.free();
        let guess = |k: usize| match self.factor {
            _ if free[k] == 0.0 => at.supports[k],
            0.0 => 0.0,
            factor => u[k] / factor,
        };
        let mut response: Vec<f64> = (0..self.entries).map(guess).collect();
        /// Fraction of the largest reactions: a residual below it is sufficient for an almost severed body.
        const SEVERED: f64 = 1e-3;
        let step = LoadStep {
            start: at.t,
            t: at.t,
            loading: Loading::Prescribed {
                loads: [&at.load; 2],
                supports: [&at.supports; 2],
            },
            largest: SEVERED * self.largest,
            tolerance: self.options.tolerance,
        };
        self.follow(system, step, (&mut response, &mut 1.0, false), interrupt)?;
        let factor = events::next(system, &response, self.factor);
        Ok(Between {
            settled: scaled(self.factor, &response),
            u: scaled(factor.unwrap_or(self.factor), &response),
            factor,
            work: None,
        })
    }

    /// Searches the load factor at which the largest ratio of stretch to critical stretch is 1, along the static
    /// states of the body with its present bonds.
    fn search(
        &mut self,
        system: &System,
        at: &Reference,
        u: &[f64],
        interrupt: Interrupt<'_>,
    ) -> Result<Between> {
        /// Largest number of load factors.
        const TRIALS: u32 = 40;
        /// Excess of the ratio above 1 that is accepted.
        const WINDOW: f64 = 1e-5;
        /// Relative accuracy of the ratio.
        const ACCURACY: f64 = 1e-8;
        let mut here = self.factor;
        let mut u = u.to_vec();
        if here != 0.0 {
            self.advance(system, at, [here; 2], (&mut u, false), interrupt)?;
        }
        let settled = u.clone();
        let mut ratio = largest_ratio(system, &u, ACCURACY).filter(|_| here != 0.0);
        let mut power = 1.0;
        for _ in 0..TRIALS {
            let next = match ratio {
                // To the middle of the window.
                Some(ratio) => here * ((1.0 + 0.5 * WINDOW) / ratio).powf(1.0 / power),
                None if self.factor == 0.0 => 1.0,
                None => f64::INFINITY,
            };
            if self.factor != 0.0 && next > events::SEVERED * self.factor {
                return Ok(Between {
                    u: settled.clone(),
                    settled,
                    factor: None,
                    work: None,
                });
            }
            self.advance(system, at, [here, next], (&mut u, false), interrupt)?;
            let new = largest_ratio(system, &u, ACCURACY);
            if new.is_some_and(|new| (1.0..=1.0 + WINDOW).contains(&new)) {
                // Along the direct path, because the search may pass the event.
                let (range, mut end) = ([self.factor, next], settled.clone());
                let work = self.advance(system, at, range, (&mut end, true), interrupt)?;
                return Ok(Between {
                    settled,
                    u,
                    factor: Some(next),
                    work: Some(work),
                });
            }
            // The exponent of the growth of the ratio with the factor.
            if let (Some(old), Some(new)) = (ratio, new) {
                let slope = (new / old).ln() / (next / here).ln();
                power = if slope.is_finite() {
                    slope.clamp(0.25, 4.0)
                } else {
                    1.0
                };
            }
            (here, ratio) = (next, new);
        }
        Err(StaticsError::NoEvents {
            reason: "no load factor was found at which a bond reaches its critical stretch (the body is severed, or its stretches do not grow with the load)",
        }
        .into())
    }

    /// Advances `u` between two load factors and returns the work of loads and supports, if wanted.
    fn advance(
        &mut self,
        system: &System,
        at: &Reference,
        factors: [f64; 2],
        (u, with_work): (&mut Vec<f64>, bool),
        interrupt: Interrupt<'_>,
    ) -> Result<f64> {
        let loads = factors.map(|factor| scaled(factor, &at.load));
        let supports = factors.map(|factor| scaled(factor, &at.supports));
        let step = LoadStep {
            start: at.t,
            t: at.t,
            loading: Loading::Prescribed {
                loads: [&loads[0], &loads[1]],
                supports: [&supports[0], &supports[1]],
            },
            largest: self.largest,
            tolerance: self.options.tolerance,
        };
        self.follow(system, step, (u, &mut 1.0, with_work), interrupt)
    }
}
