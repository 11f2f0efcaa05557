//! Ratio of bonds to their limits: of stretches to critical stretches, or that of another failure criterion.

use pericles::System;

/// Returns whether each point has an intact, breakable bond beyond the fraction `part` of its critical stretch.
pub(crate) fn endangered(system: &System, u: &[f64], part: f64) -> Vec<bool> {
    let mut marks = vec![false; system.points()];
    if let Some(breaking) = system.operator().capabilities().breaking {
        breaking.mark_endangered(u, part, &mut marks);
    }
    marks
}

/// Returns whether a point of the whole body has a bond beyond the fraction `part` of its critical stretch.
pub(crate) fn any_endangered(system: &System, u: &[f64], part: f64) -> bool {
    !system
        .domain()
        .all(!endangered(system, u, part).contains(&true))
}

/// Largest ratio that is determined.
const LARGEST: f64 = 1e12;
const SMALLEST: f64 = 1e-12;

/// Returns a lower bound of the largest ratio of stretch to critical stretch of breakable bonds, to a
/// relative `accuracy`; `None` if no bond is stretched or the ratio exceeds 1e12.
pub(crate) fn largest_ratio(system: &System, u: &[f64], accuracy: f64) -> Option<f64> {
    let breaking = system.operator().capabilities().breaking?;
    // Points without a bond beyond a fraction have none beyond a larger one: they are marked beforehand, hence skipped.
    let mut idle = vec![false; system.points()];
    largest(accuracy, |part| {
        let mut marks = idle.clone();
        breaking.mark_endangered(u, part, &mut marks);
        let is_beyond = |(mark, idle): (&bool, &bool)| *mark && !*idle;
        let any = !system.domain().all(!marks.iter().zip(&idle).any(is_beyond));
        if any {
            let pairs = idle.iter_mut().zip(&marks);
            pairs.for_each(|(idle, mark)| *idle |= !*mark);
        }
        any
    })
}

/// Returns the factor by which the displacements may be multiplied until the first bond breaks, to a relative
/// `accuracy`, also for failure criteria that are not proportional to the displacements; `None` as for
/// [`largest_ratio`].
pub(crate) fn load_factor(system: &System, u: &[f64], accuracy: f64) -> Option<f64> {
    let breaks = |factor: f64| {
        let scaled: Vec<f64> = u.iter().map(|u| factor * u).collect();
        any_endangered(system, &scaled, 1.0)
    };
    let factor = 1.0 / largest_ratio(system, u, accuracy)?;
    let margin = 10.0 * accuracy;
    if breaks(factor * (1.0 + margin)) && !breaks(factor * (1.0 - margin)) {
        return Some(factor);
    }
    // Without a result the criterion does not depend on the displacements alone.
    Some(largest(accuracy, |part| breaks(1.0 / part)).map_or(factor, |part| 1.0 / part))
}

/// Returns a lower bound of the largest number for which `any` holds.
fn largest(accuracy: f64, mut any: impl FnMut(f64) -> bool) -> Option<f64> {
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
