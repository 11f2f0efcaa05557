//! Work and impulse of everything outside the body.

use crate::boundary::Load;

/// Work and impulse of everything outside the body since the start.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ledger {
    /// Work of loads and supports, J.
    pub work: f64,
    /// Sum of the magnitudes of its contributions, J: the scale of what was exchanged.
    pub exchanged: f64,
    /// Impulse of loads and supports, N s.
    pub impulse: [f64; 3],
}

impl Ledger {
    pub(crate) fn book(&mut self, work: f64, impulse: [f64; 3]) {
        self.work += work;
        self.exchanged += work.abs();
        for c in 0..3 {
            self.impulse[c] += impulse[c];
        }
    }
}

/// A step of a scheme whose forces acted over the whole of it: what it started and ended with.
#[derive(Debug, Clone, Copy)]
pub struct Completed<'a> {
    /// Time at the end, s.
    pub t: f64,
    /// Length, s.
    pub dt: f64,
    /// Displacement before and after, m.
    pub u: [&'a [f64]; 2],
    /// Velocity before and after, m/s.
    pub v: [&'a [f64]; 2],
}

/// How points went from the start of a step to its end.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Path<'a> {
    /// With this mean velocity, pushed by forces at both ends: the quadrature of velocity Verlet, for which work and energy match exactly.
    MeanVelocity(&'a [f64]),
    /// Along the cubic through displacements and velocities at both ends: work to fourth order.
    Cubic {
        u: [&'a [f64]; 2],
        v: [&'a [f64]; 2],
    },
    /// Straight from one equilibrium to another, pushed by forces that change linearly between their values at both.
    Chord(LoadStep<'a>),
}

/// A step from one static state to the next.
///
/// Loads and supports change slowly within it, from their values at the last equilibrium to those at the next, so that they do the work of their means. The first equilibrium of a run is
/// the body without loads: in the first load step all loads grow from zero, whatever their time functions say at t = 0, and supports move their points from where they are.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LoadStep<'a> {
    /// Displacement at the equilibria before and after, m.
    pub(crate) u: [&'a [f64]; 2],
    /// Whether it is the first of the run.
    pub(crate) first: bool,
}

impl Path<'_> {
    /// Work (J) and impulse (N s) of a load over the step of length dt that ended at t.
    pub(crate) fn work_of(
        &self,
        load: &Load,
        t: f64,
        dt: f64,
        dimension: usize,
        volumes: &[f64],
    ) -> (f64, [f64; 3]) {
        let n = volumes.len();
        let times = [t - dt, t - 0.5 * dt, t];
        let mut factors = times.map(|t| load.factor(t));
        if let Self::Chord(LoadStep { first: true, .. }) = self {
            factors[0] = 0.0;
        }
        let (mut work, mut impulse) = (0.0, [0.0; 3]);
        if factors == [0.0; 3] {
            return (work, impulse);
        }
        for c in 0..dimension {
            if load.is_free_of(c) {
                continue;
            }
            for (k, &i) in load.points.iter().enumerate() {
                let (i, entry) = (i as usize, c * n + i as usize);
                let forces: [f64; 3] = std::array::from_fn(|m| {
                    load.amplitude(c, k, times[m]) * factors[m] * volumes[i]
                });
                let (push, done) = self.push_and_work(forces, dt, entry);
                work += done;
                impulse[c] += push;
            }
        }
        (work, impulse)
    }

    /// ∫ b and ∫ b v of a force b that is `first`, `middle` and `last` at the start, middle and end of the step, on one entry of the arrays.
    fn push_and_work(&self, [first, middle, last]: [f64; 3], dt: f64, entry: usize) -> (f64, f64) {
        match self {
            Self::MeanVelocity(mean) => {
                let push = 0.5 * dt * (last + first);
                (push, push * mean[entry])
            }
            Self::Chord(LoadStep { u, .. }) => {
                let mean = 0.5 * (first + last);
                (dt * mean, mean * (u[1][entry] - u[0][entry]))
            }
            // The middle velocity of the cubic is 3/2 Δu/dt − (v₀ + v₁)/4, and Simpson's rule becomes what stands here.
            Self::Cubic { u, v } => (
                dt / 6.0 * (first + 4.0 * middle + last),
                middle * (u[1][entry] - u[0][entry])
                    + dt / 6.0 * ((first - middle) * v[0][entry] + (last - middle) * v[1][entry]),
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::boundary::TimeFunction;

    #[test]
    fn work_along_the_cubic_is_of_fourth_order() {
        // u = sin t, b = sin²(π t/3): ∫ b cos t over [0.3, 1.3] in one, two, four … steps.
        let function = TimeFunction::Pulse {
            start: 0.0,
            duration: 3.0,
        };
        let load = Load::new(vec![0], [2.0, 0.0, 0.0], function);
        let work = |steps: usize| -> f64 {
            let dt = 1.0 / steps as f64;
            (1..=steps)
                .map(|k| {
                    let t = 0.3 + k as f64 * dt;
                    let path = Path::Cubic {
                        u: [&[(t - dt).sin()], &[t.sin()]],
                        v: [&[(t - dt).cos()], &[t.cos()]],
                    };
                    path.work_of(&load, t, dt, 1, &[1.0]).0
                })
                .sum()
        };
        let reference = work(512);
        let errors = [8, 16].map(|steps| (work(steps) - reference).abs());
        let order = (errors[0] / errors[1]).log2();
        assert!((order - 4.0).abs() < 0.1, "{order}");
    }
}
