//! Deadlines: stopping while there is time for a checkpoint.

use std::time::{Duration, Instant};

/// The time by which a run must have stopped.
#[derive(Debug, Clone)]
pub struct Deadline {
    end: Instant,
    /// The end of the step before.
    before: Instant,
    longest_step: Duration,
}

impl Deadline {
    /// A deadline so long from now; none without a limit, or with one that no clock can count.
    pub fn from_now(limit: Option<Duration>) -> Option<Self> {
        let now = Instant::now();
        Some(Self {
            end: now.checked_add(limit?)?,
            before: now,
            longest_step: Duration::ZERO,
        })
    }

    /// The first step begins.
    pub(crate) fn begin(&mut self) {
        self.before = Instant::now();
    }

    /// The time by which the run must have stopped.
    pub(crate) fn end(&self) -> Instant {
        self.end
    }

    /// Whether another step, output included, and a checkpoint may no longer fit in; to be asked once after every step.
    pub(crate) fn is_near(&mut self, checkpoint: Duration) -> bool {
        let now = Instant::now();
        self.longest_step = self.longest_step.max(now - self.before);
        self.before = now;
        // Twice as long as the last one: disks have moods.
        now + self.longest_step + 2 * checkpoint >= self.end
    }
}
