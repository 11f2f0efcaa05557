//! How far the bonds of a displaced body are from breaking.

use pericles::System;

/// Points with a bond that is left, may break and is stretched beyond `part` of its critical stretch.
pub(crate) fn endangered(system: &System, u: &[f64], part: f64) -> Vec<bool> {
    let mut marks = vec![false; system.points()];
    if let Some(breaking) = system.operator().capabilities().breaking {
        breaking.mark_endangered(u, part, &mut marks);
    }
    marks
}

/// Ratios beyond these are not told apart.
const LARGEST: f64 = 1e12;
const SMALLEST: f64 = 1e-12;

/// The largest stretch over the critical stretch of the bonds that may break, from below, to a relative `accuracy`; none if no bond is stretched, or if the largest is not found below 1e12.
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
