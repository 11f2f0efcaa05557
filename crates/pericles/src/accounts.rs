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
        let g = |x: f64| load.function.value(x);
        let [first, middle, last] = [g(t - dt), g(t - 0.5 * dt), g(t)];
        // ∫ g and ∫ g v; by the cubic the middle velocity is 3/2 Δu/dt − (v₀ + v₁)/4, and Simpson's rule becomes what stands here.
        let factor = match self {
            Self::MeanVelocity(_) => 0.5 * dt * (last + first),
            Self::Cubic { .. } => dt / 6.0 * (first + 4.0 * middle + last),
        };
        let advance = |entry: usize| match self {
            Self::MeanVelocity(mean) => factor * mean[entry],
            Self::Cubic { u, v } => {
                middle * (u[1][entry] - u[0][entry])
                    + dt / 6.0 * ((first - middle) * v[0][entry] + (last - middle) * v[1][entry])
            }
        };
        let (mut work, mut impulse) = (0.0, [0.0; 3]);
        for c in 0..dimension {
            if load.density[c] == 0.0 {
                continue;
            }
            for &i in &load.points {
                let force = load.density[c] * volumes[i as usize];
                work += force * advance(c * n + i as usize);
                impulse[c] += force * factor;
            }
        }
        (work, impulse)
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
        let load = Load {
            points: vec![0],
            density: [2.0, 0.0, 0.0],
            function,
        };
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
