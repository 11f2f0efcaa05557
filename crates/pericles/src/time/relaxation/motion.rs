//! Fictitious motion towards a static state.

use rayon::prelude::*;

use super::fire::Fire;
use crate::parallel::BLOCK;
use crate::system::System;

/// Damping of the fictitious motion.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Damping {
    /// Adaptive: c = 2 √(dᵀK d / dᵀM d) for the displacement d since the start, with K d from the change of the
    /// forces; critical for the shape of d (Underwood 1983).
    #[default]
    Adaptive,
    /// Constant c per iteration, between 0 and 2.
    Viscous(f64),
    /// No damping coefficient: the velocity is turned towards the force, and is set to zero when the forces
    /// do negative work: the fast inertial relaxation engine, FIRE (Bitzek, Koskinen, Gähler, Moseler & Gumbsch, Phys.
    /// Rev. Lett. 97, 170201, 2006).
    Fire,
}

/// Position and velocity of the fictitious motion, in units of its largest time step.
#[derive(Debug, Clone)]
pub(super) struct Motion {
    damping: Damping,
    /// Inverse fictitious mass times volume, per point.
    mobility: f64,
    /// 1 for free entries, 0 for prescribed ones.
    pub(super) free: Vec<f64>,
    velocity: Vec<f64>,
    start: Vec<f64>,
    first_force: Vec<f64>,
    from_rest: bool,
    fire: Fire,
}

impl Motion {
    pub(super) fn new(damping: Damping, mobility: f64, entries: usize) -> Self {
        let zeros = || vec![0.0; entries];
        Self {
            damping,
            mobility,
            free: zeros(),
            velocity: zeros(),
            start: zeros(),
            first_force: zeros(),
            from_rest: true,
            fire: Fire::default(),
        }
    }

    /// Sets the motion to rest at displacement `u`, with the points free that no constraint holds at time t.
    pub(super) fn rest(&mut self, system: &System, t: f64, u: &[f64]) {
        self.free.fill(1.0);
        system.hold_at(t, &mut self.free);
        self.start.copy_from_slice(u);
        self.velocity.fill(0.0);
        self.from_rest = true;
        self.fire = Fire::default();
    }

    /// Advances `u` by one step under the force density at `u`.
    pub(super) fn advance(&mut self, system: &System, force: &[f64], u: &mut [f64]) {
        let (keep, push, step) = match self.damping {
            Damping::Viscous(c) => self.damped(c),
            Damping::Adaptive => {
                let c = self.critical_damping(system, force, u);
                self.damped(c)
            }
            Damping::Fire => {
                let turn = self.fire.turn(system, [&self.free, &self.velocity, force]);
                (turn.keep, turn.push + turn.step * self.mobility, turn.step)
            }
        };
        if self.from_rest {
            self.first_force.copy_from_slice(force);
            self.from_rest = false;
        }
        self.velocity
            .par_chunks_mut(8 * BLOCK)
            .zip(u.par_chunks_mut(8 * BLOCK))
            .zip(force.par_chunks(8 * BLOCK))
            .zip(self.free.par_chunks(8 * BLOCK))
            .for_each(|(((velocity, u), force), free)| {
                for k in 0..u.len() {
                    velocity[k] = free[k] * (keep * velocity[k] + push * force[k]);
                    u[k] += step * velocity[k];
                }
            });
    }

    /// Returns the factors of velocity and force in the new velocity, and the time step, for central differences
    /// with damping c. The first step starts from rest with half a step.
    fn damped(&self, c: f64) -> (f64, f64, f64) {
        if self.from_rest {
            (0.0, 0.5 * self.mobility, 1.0)
        } else {
            ((2.0 - c) / (2.0 + c), 2.0 * self.mobility / (2.0 + c), 1.0)
        }
    }

    /// Returns 2 √(dᵀK d / dᵀM d), with K d = F₀ − F for the displacement d since the start.
    fn critical_damping(&self, system: &System, force: &[f64], u: &[f64]) -> f64 {
        // From 2 on the motion would reverse at every step.
        const MOST: f64 = 1.9;
        let (n, volumes) = (system.points(), system.cloud().volumes());
        let d = |entry: usize| u[entry] - self.start[entry];
        let weighted = |entry: usize, x: f64| self.free[entry] * volumes[entry % n] * x;
        let stiffness = system.domain().sum(u.len(), |entry| {
            weighted(entry, d(entry) * (self.first_force[entry] - force[entry]))
        });
        let mass = system
            .domain()
            .sum(u.len(), |entry| weighted(entry, d(entry).powi(2)));
        if stiffness > 0.0 && mass > 0.0 {
            (2.0 * (self.mobility * stiffness / mass).sqrt()).min(MOST)
        } else {
            0.0
        }
    }
}
