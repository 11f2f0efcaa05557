//! Ratio of bond stretches to their critical stretches.

use pericles::System;

/// Returns whether each point has an intact, breakable bond beyond the fraction `part` of its critical stretch.
pub(crate) fn endangered(system: &System, u: &[f64], part: f64) -> Vec<bool> {
    let mut marks = vec![false; system.points()];
    if let Some(breaking) = system.operator().capabilities().breaking {
        breaking.mark_endangered(u, part, &mut marks);
    }
    marks
}

/// Largest ratio that is determined.
const LARGEST: f64 = 1e12;
const SMALLEST: f64 = 1e-12;

/// Returns a lower bound of the largest ratio of stretch to critical stretch of breakable bonds, to a
/// relative `accuracy`; `None` if no bond is stretched or the ratio exceeds 1e12.
pub(crate) fn largest_ratio(system: &System, u: &[f64], accuracy: f64) -> Option<f64> {
    let any = |part: f64| endangered(system, u, part).contains(&true);
    let (mut low, mut high) = (1.0, 1.0);
    if any(1.0) {
        while any(high) {
            (low, high) = (high, 2.0 * high);
            if high > LARGEST {
                return None;
            }
        }
    } else {
        while !any(low) {
            (low, high) = (0.5 * low, low);
            if low < SMALLEST {
                return None;
            }
        }
    }
    while high - low > accuracy * low {
        let middle = 0.5 * (low + high);
        *(if any(middle) { &mut low } else { &mut high }) = middle;
    }
    Some(low)
}
