//! r-RESPA: velocity Verlet with short steps for some bonds.

use super::fine_region::Fine;
use super::refinement::{PARTS_OF_THE_BODY, Refinement, SchemeCost};
use super::refinement_report::RefinementReport;
use super::zone::{Sum, Zone};
use super::zones::Zones;
use super::{HighestFrequency, Integrator, State};
use crate::compatibility::{Need, Requirement};
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::operator::PointSubset;
use crate::step_end::{Path, StepEnd};
use crate::step_kind::StepKind;
use crate::system::System;

/// The reversible reference system propagator algorithm (Tuckerman, Berne & Martyna 1992), split by bonds.
///
/// Bonds between coarse points are slow, all others fast; loads act with the points they are applied to. A step
/// applies half of the slow impulse to the coarse points, takes M velocity Verlet steps dt/M with the fast forces
/// on fine points and their coarse neighbours while the other coarse points drift, and applies the other half.
/// Second order; symplectic while the fine region is constant; momentum is conserved to round-off. A step evaluates
/// N_C + M (N_F + N_CB) points.
///
/// Slow impulses resonate with fast vibrations near ω dt = k π; the step is kept below the limit 2/ω of the coarse
/// points.
pub struct Respa {
    refinement: Refinement,
    /// Accelerations of coarse points by slow bonds.
    slow: Vec<f64>,
    /// Accelerations of fine points and their coarse neighbours by fast bonds.
    fast: Vec<f64>,
    /// Displacement at the start of the step, then the mean velocity over it.
    mean: Vec<f64>,
    /// Velocities damped by boundaries.
    damped: Vec<f64>,
    everywhere: Zone,
}

const NAME: &str = "respa";

impl Respa {
    /// Requirements on the system.
    pub const REQUIREMENTS: &'static [Requirement] = &[
        Requirement {
            need: Need::NoMemory,
            reason: "it applies parts of the force at different times, but boundaries with memory support a single time step only; use velocity-verlet",
        },
        PARTS_OF_THE_BODY,
        Requirement::NO_ACTIVATION,
        Requirement {
            need: Need::NoInteractions,
            reason: "a contact may join points of zones with different time steps, whose forces are then known at different times; use velocity-verlet",
        },
        Requirement {
            need: Need::SumOverBonds,
            reason: "it splits the force by bonds, but here the force of a bond depends on the other bonds of its ends; use multirate-rk3 or multirate-rk4",
        },
    ];

    /// Makes the scheme with M fast steps per slow step.
    ///
    /// # Errors
    /// A ratio below one; fine regions that are empty, overlap or are thinner than a horizon; forces that cannot be
    /// evaluated on a subset of the points.
    pub fn new(ratio: u32, fine: Fine, system: &System) -> Result<Self> {
        let array = || vec![0.0; system.dimension() * system.points()];
        let cost = SchemeCost {
            name: NAME,
            requirements: Self::REQUIREMENTS,
            stages: 1,
            shares_border: true,
        };
        let refinement = Refinement::new(system, cost, ratio, fine)?;
        Ok(Self {
            refinement,
            slow: array(),
            fast: array(),
            mean: array(),
            damped: Vec::new(),
            everywhere: Zone::all(system.points()),
        })
    }

    /// Computes both parts of the acceleration anew after a change of the zones.
    fn evaluate(&mut self, system: &mut System, t: f64, u: &[f64]) {
        let Zones {
            coarse_inner,
            coarse_border,
            fine,
            is_fine,
            is_coarse,
            count,
            ..
        } = &self.refinement.zones;
        let border = coarse_border.on();
        system.free_acceleration(t, u, &coarse_inner.on(), &mut self.slow);
        if count.border > 0 {
            system.free_acceleration_from(t, u, &border, is_coarse, true, &mut self.slow);
            system.free_acceleration_from(t, u, &border, is_fine, false, &mut self.fast);
        }
        if count.fine > 0 {
            system.free_acceleration(t, u, &fine.on(), &mut self.fast);
        }
    }

    /// Performs one fast step from t to t_next.
    fn fast_step(&mut self, system: &mut System, [u, v]: [&mut [f64]; 2], t: f64, t_next: f64) {
        let Zones {
            active,
            fine,
            coarse_border,
            is_fine,
            count,
            ..
        } = &self.refinement.zones;
        let (n, h) = (system.points(), t_next - t);
        kick(active, &self.fast, 0.5 * h, n, v);
        system.drive_mean_on(t, h, &active.on(), v);
        Sum::new().plus(h, v).add_to(active, n, u);
        system.place_on(t_next, &active.on(), u);
        let end = StepEnd {
            t: t_next,
            dt: h,
            u,
            path: Path::MeanVelocity(v),
        };
        system.end_step_on(&end, &fine.on(), &mut self.fast);
        if count.border > 0 {
            // Fast bonds were broken from their fine ends.
            let border = coarse_border.on();
            system.free_acceleration_from(t_next, u, &border, is_fine, false, &mut self.fast);
        }
        kick(active, &self.fast, 0.5 * h, n, v);
    }
}

fn kick(zone: &Zone, a: &[f64], dt: f64, n: usize, v: &mut [f64]) {
    Sum::new().plus(dt, a).add_to(zone, n, v);
}

impl Integrator for Respa {
    fn name(&self) -> &'static str {
        NAME
    }

    fn vector_length(&self) -> Option<usize> {
        Some(self.mean.len())
    }

    fn requirements(&self) -> &'static [Requirement] {
        Self::REQUIREMENTS
    }

    fn step_kind(&self) -> StepKind {
        StepKind::Kicks
    }

    fn order(&self) -> u32 {
        2
    }

    fn stability_limit(&self) -> Option<f64> {
        Some(2.0)
    }

    fn limiting_frequency(
        &self,
        system: &System,
        u: &[f64],
        body: HighestFrequency,
    ) -> Result<HighestFrequency> {
        self.refinement.limiting_frequency(system, u, body)
    }

    fn refinement(&self) -> Option<RefinementReport> {
        Some(self.refinement.report())
    }

    fn start(&mut self, system: &mut System, state: &mut State) {
        state.start(system);
        self.refinement.start(system);
        self.evaluate(system, state.t, &state.u);
    }

    fn step(
        &mut self,
        system: &mut System,
        state: &mut State,
        t_next: f64,
        _interrupt: Interrupt<'_>,
    ) -> Result<()> {
        if self.refinement.update(system, state) {
            self.evaluate(system, state.t, &state.u);
        }
        self.refinement.count(false);
        let State { t, u, v, a, .. } = state;
        let (n, dt, ratio) = (system.points(), t_next - *t, self.refinement.ratio);
        let Zones {
            coarse,
            coarse_inner,
            ..
        } = &self.refinement.zones;
        Sum::new().onto(u, &self.everywhere, n, &mut self.mean);
        let mut exchange = system.damp(t_next, 0.5 * dt, v, &mut self.damped);
        kick(coarse, &self.slow, 0.5 * dt, n, v);
        system.drive_mean_on(*t, dt, &coarse_inner.on(), v);
        Sum::new().plus(dt, v).add_to(coarse_inner, n, u);
        system.place_on(t_next, &coarse_inner.on(), u);
        if self.refinement.zones.count.fine > 0 {
            for m in 0..ratio {
                let time = |m: u32| {
                    if m == ratio {
                        t_next
                    } else {
                        *t + dt * (f64::from(m) / f64::from(ratio))
                    }
                };
                self.fast_step(system, [u, v], time(m), time(m + 1));
            }
        }
        let Zones {
            coarse,
            coarse_inner,
            coarse_border,
            is_coarse,
            count,
            ..
        } = &self.refinement.zones;
        self.everywhere
            .for_each_run(n, &mut self.mean, &|mean, range| {
                for (mean, u) in mean.iter_mut().zip(&u[range]) {
                    *mean = (u - *mean) / dt;
                }
            });
        let end = StepEnd {
            t: t_next,
            dt,
            u,
            path: Path::MeanVelocity(&self.mean),
        };
        system.end_step_on(&end, &coarse_inner.on(), &mut self.slow);
        if count.border > 0 {
            let border = coarse_border.on();
            system.end_step_on_from(&end, &border, is_coarse, true, &mut self.slow);
        }
        kick(coarse, &self.slow, 0.5 * dt, n, v);
        system.constrain_velocity(t_next, v);
        exchange.add(system.damp(t_next, 0.5 * dt, v, &mut self.damped));
        system.book_exchange(exchange);
        // Observers and the energy balance use the sum of both parts.
        Sum::new().onto(&self.slow, coarse, n, a);
        Sum::new().onto(&self.fast, &self.refinement.zones.fine, n, a);
        Sum::new().plus(1.0, &self.fast).add_to(coarse_border, n, a);
        system.book_heating(&end);
        system.book_step(&end, a);
        system.finish(t_next, u, v, &PointSubset::All, a);
        state.close(system, t_next);
        state.step += 1;
        Ok(())
    }
}

crate::saved! {
    impl Checkpointed for Respa {
        refinement: part,
        slow: points("scheme/slow"),
        fast: points("scheme/fast"),
        everywhere: fixed,
        mean, damped: scratch,
    }
}
