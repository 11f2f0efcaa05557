//! Where a condition begins to hold.

/// Where a condition first holds between 0 and `end`, found in steps and by bisection; `end` if it never does.
pub(super) fn last_before(end: f64, steps: usize, holds: impl Fn(f64) -> bool) -> f64 {
    let at = |step: usize| end * step as f64 / steps as f64;
    let Some(first) = (1..=steps).find(|&step| holds(at(step))) else {
        return end;
    };
    let (mut low, mut high) = (at(first - 1), at(first));
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    // Never zero, and at the condition but for round-off.
    high
}
