//! Schedules of observers.

/// A schedule in steps or time. The first and the last state of a run are always included, except with `Never`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Schedule {
    /// Never.
    #[default]
    Never,
    /// Every given number of steps.
    Every(u64),
    /// At the first step at or after every multiple of this time, s.
    Interval(f64),
    /// This number of times, evenly spaced over the run, in addition to the first state.
    Count(u64),
}

impl Schedule {
    /// Returns whether the state after `step` of `steps` steps of length `dt` is due.
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
                // A multiple of the interval that equals a multiple of dt up to rounding belongs to that step.
                let passed = |step: u64| (step as f64 * dt / interval + 1e-6).floor();
                passed(step) > passed(step - 1)
            }
            Self::Count(count) => {
                let passed = |step: u64| u128::from(step) * u128::from(count) / u128::from(steps);
                passed(step) > passed(step - 1)
            }
        }
    }

    /// Returns an upper bound of the number of states due in a run of `steps` steps of length `dt`; it exceeds the
    /// number by at most two.
    pub fn most(&self, dt: f64, steps: u64) -> u64 {
        match *self {
            Self::Never => 0,
            Self::Every(every) => steps.checked_div(every).unwrap_or(0) + 2,
            // The cast saturates.
            Self::Interval(interval) => {
                ((steps as f64 * dt / interval + 1e-6) as u64).min(steps) + 2
            }
            Self::Count(count) => count.min(steps) + 2,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn schedules_select_the_expected_steps() {
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
        for schedule in [
            Schedule::Never,
            Schedule::Every(0),
            Schedule::Every(3),
            Schedule::Every(11),
            Schedule::Interval(0.25),
            Schedule::Interval(0.01),
            Schedule::Count(0),
            Schedule::Count(3),
            Schedule::Count(100),
        ] {
            let (most, due) = (schedule.most(0.1, 10), due(schedule).len() as u64);
            assert!(
                (due..=due + 2).contains(&most),
                "{schedule:?}: {due} {most}"
            );
        }
    }
}
