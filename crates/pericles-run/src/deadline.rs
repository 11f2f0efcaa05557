//! Deadlines: a run stops while there is time for a checkpoint.

use std::time::{Duration, Instant};

/// The wall-clock time by which a run must have stopped.
#[derive(Debug, Clone)]
pub struct Deadline {
    end: Instant,
    /// The end of the previous step.
    before: Instant,
    longest_step: Duration,
}

impl Deadline {
    /// Creates a deadline after `limit`; `None` without a limit, or if the clock cannot represent it.
    pub fn from_now(limit: Option<Duration>) -> Option<Self> {
        let now = Instant::now();
        Some(Self {
            end: now.checked_add(limit?)?,
            before: now,
            longest_step: Duration::ZERO,
        })
    }

    /// Marks the start of the first step.
    pub(crate) fn begin(&mut self) {
        self.before = Instant::now();
    }

    /// Returns the time by which the run must have stopped.
    pub(crate) fn end(&self) -> Instant {
        self.end
    }

    /// Returns whether another step with output and a checkpoint may exceed the deadline; to be called once after
    /// every step.
    pub(crate) fn is_near(&mut self, checkpoint: Duration) -> bool {
        let now = Instant::now();
        self.longest_step = self.longest_step.max(now - self.before);
        self.before = now;
        // Twice the last duration, because disk speed varies.
        now + self.longest_step + 2 * checkpoint >= self.end
    }
}
