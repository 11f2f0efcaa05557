//! When observers look.

/// A schedule in steps or time. The first and the last state of a run are always due, unless the schedule is `Never`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Schedule {
    /// Not at all.
    #[default]
    Never,
    /// Every so many steps.
    Every(u64),
    /// At the first step at or after every multiple of this time, s.
    Interval(f64),
    /// So many times over the run, evenly, besides the first state.
    Count(u64),
}

impl Schedule {
    /// Whether the state after `step` of `steps` steps of length `dt` is due.
    pub fn is_due(&self, step: u64, dt: f64, steps: u64) -> bool {
        if matches!(self, Self::Never) {
            return false;
        }
        if step == 0 || step == steps {
            return true;
        }
        match *self {
            Self::Never => false,
            Self::Every(every) => every > 0 && step.is_multiple_of(every),
            Self::Interval(interval) => {
                // A multiple of the interval that is a multiple of dt up to rounding belongs to its own step.
                let passed = |step: u64| (step as f64 * dt / interval + 1e-6).floor();
                passed(step) > passed(step - 1)
            }
            Self::Count(count) => {
                let passed = |step: u64| u128::from(step) * u128::from(count) / u128::from(steps);
                passed(step) > passed(step - 1)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn schedules() {
        let due = |schedule: Schedule| -> Vec<u64> {
            (0..=10)
                .filter(|&step| schedule.is_due(step, 0.1, 10))
                .collect()
        };
        assert_eq!(due(Schedule::Every(4)), [0, 4, 8, 10]);
        assert_eq!(due(Schedule::Interval(0.3)), [0, 3, 6, 9, 10]);
        assert_eq!(due(Schedule::Interval(0.25)), [0, 3, 5, 8, 10]);
        assert_eq!(due(Schedule::Count(2)), [0, 5, 10]);
        assert_eq!(due(Schedule::Count(3)), [0, 4, 7, 10]);
        assert_eq!(due(Schedule::Interval(0.01)).len(), 11);
        assert!(due(Schedule::Never).is_empty());
    }
}
