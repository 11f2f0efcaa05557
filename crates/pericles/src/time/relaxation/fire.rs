//! Velocities of the fast inertial relaxation engine (FIRE).

use crate::system::System;

/// Smallest number of steps with positive power before the time step grows.
const WAIT: u32 = 5;
/// Factor of the growing time step.
const GROW: f64 = 1.1;
/// Factor of the time step after a reversal.
const SHRINK: f64 = 0.5;
/// Fraction of the velocity that is turned towards the force after a reversal.
const MIXING: f64 = 0.1;
/// Factor of this fraction per step.
const MIXING_DECAY: f64 = 0.99;
/// First time step relative to the largest one.
const FIRST_STEP: f64 = 0.1;

/// State of the method, with the constants of Bitzek et al. (2006). The largest time step is 1.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fire {
    step: f64,
    mixing: f64,
    /// Number of steps since the power was last negative.
    downhill: u32,
}

impl Default for Fire {
    fn default() -> Self {
        Self {
            step: FIRST_STEP,
            mixing: MIXING,
            downhill: 0,
        }
    }
}

/// Change of a velocity v under a force density F: v ← keep v + push F, before the force acts for the time `step`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    pub(super) keep: f64,
    pub(super) push: f64,
    pub(super) step: f64,
}

impl Fire {
    /// Turns the velocity towards the force, v ← (1 − α) v + α |v| F/|F|, or stops the motion if the power of the
    /// forces Σ V F·v is not positive. Norms are weighted by volumes, like the fictitious masses.
    pub(super) fn turn(&mut self, system: &System, [free, velocity, force]: [&[f64]; 3]) -> Turn {
        let (n, volumes) = (system.points(), system.cloud().volumes());
        let sum = |of: &(dyn Fn(usize) -> f64 + Sync)| {
            system.domain().sum(force.len(), |entry| {
                free[entry] * volumes[entry % n] * of(entry)
            })
        };
        let power = sum(&|k| force[k] * velocity[k]);
        if power <= 0.0 {
            // The first step starts from rest, without power.
            if sum(&|k| velocity[k].powi(2)) > 0.0 {
                self.step *= SHRINK;
            }
            (self.mixing, self.downhill) = (MIXING, 0);
            return Turn {
                keep: 0.0,
                push: 0.0,
                step: self.step,
            };
        }
        let speed = sum(&|k| velocity[k].powi(2)).sqrt();
        let strength = sum(&|k| force[k].powi(2)).sqrt();
        let mixing = self.mixing;
        self.downhill += 1;
        if self.downhill > WAIT {
            self.step = (GROW * self.step).min(1.0);
            self.mixing *= MIXING_DECAY;
        }
        Turn {
            keep: 1.0 - mixing,
            push: mixing * speed / strength,
            step: self.step,
        }
    }
}
