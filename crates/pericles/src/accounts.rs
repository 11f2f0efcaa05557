//! Work and impulse of external forces.

use crate::boundary::{Load, ProportionalLoading};
use crate::space::PointCloud;
use crate::step_end::{Path, StepEnd};

/// Work and impulse of loads, constraints and boundaries since the start.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ledger {
    /// Work, J.
    pub work: f64,
    /// The largest magnitude of the work so far, J.
    pub largest_work: f64,
    /// Sum of the magnitudes of all contributions to the work, J: the scale for relative errors of the energy
    /// balance.
    pub exchanged: f64,
    /// Impulse, N s.
    pub impulse: [f64; 3],
}

impl Ledger {
    pub(crate) fn book(&mut self, work: f64, impulse: [f64; 3]) {
        self.work += work;
        self.largest_work = self.largest_work.max(self.work.abs());
        self.exchanged += work.abs();
        for c in 0..3 {
            self.impulse[c] += impulse[c];
        }
    }

    /// Adds the work and impulse of a load over a step; `shares` returns the shares of the load that act on a point at its
    /// start and end.
    pub(crate) fn book_load(
        &mut self,
        step: &StepEnd<'_>,
        load: &Load,
        (loading, cloud): (Option<ProportionalLoading>, &PointCloud),
        shares: impl Fn(usize) -> [f64; 2] + Sync,
    ) {
        let (n, volumes) = (cloud.len(), cloud.volumes());
        // Paths other than the cubic do not use the middle: no values are computed for it.
        let middle = match step.path {
            Path::Cubic { .. } => step.t - 0.5 * step.dt,
            Path::MeanVelocity(_) | Path::Chord { .. } | Path::SubStep => step.t,
        };
        let mut times = [step.t - step.dt, middle, step.t];
        let mut levels = [1.0; 3];
        if let Some(loading) = loading {
            let [first, last] = loading.factors;
            times = [loading.reference; 3];
            levels = [first, 0.5 * (first + last), last];
        }
        let mut factors = [0, 1, 2].map(|m| levels[m] * load.factor(times[m]));
        if let Path::Chord { first: true, .. } = step.path {
            factors[0] = 0.0;
        }
        let (mut work, mut impulse) = (0.0, [0.0; 3]);
        if factors == [0.0; 3] {
            return;
        }
        load.with_amplitudes(times, |amplitude| {
            for c in (0..cloud.dimension()).filter(|&c| !load.is_free_of(c)) {
                let push_and_work = |k: usize| {
                    let (i, amplitude) = (load.points[k] as usize, amplitude(c, k));
                    let [first, last] = shares(i);
                    let shares = [first, last, last];
                    let forces =
                        std::array::from_fn(|m| amplitude[m] * factors[m] * volumes[i] * shares[m]);
                    step.push_and_work(forces, c * n + i)
                };
                let (domain, points) = (cloud.domain(), load.points.len());
                work += domain.sum(points, |k| push_and_work(k).1);
                impulse[c] = domain.sum(points, |k| push_and_work(k).0);
            }
        });
        self.book(work, impulse);
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
                    let step = StepEnd {
                        t,
                        dt,
                        u: &[t.sin()],
                        path: Path::Cubic {
                            u: &[(t - dt).sin()],
                            v: [&[(t - dt).cos()], &[t.cos()]],
                        },
                    };
                    let cloud = PointCloud::new(1, vec![0.0], vec![1.0], 1.0).unwrap();
                    let mut ledger = Ledger::default();
                    ledger.book_load(&step, &load, (None, &cloud), |_| [1.0; 2]);
                    ledger.work
                })
                .sum()
        };
        let reference = work(512);
        let errors = [8, 16].map(|steps| (work(steps) - reference).abs());
        let order = (errors[0] / errors[1]).log2();
        assert!((order - 4.0).abs() < 0.1, "{order}");
    }
}
