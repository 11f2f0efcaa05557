//! Bisection for the point at which a condition begins to hold.

/// Returns the first point between 0 and `end` at which a condition holds, found by stepping and bisection; `end`
/// if it never holds.
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
    // Never zero; satisfies the condition up to round-off.
    high
}
