//! Numbers of cells along the sides of a body.

use crate::error::{PericlesError, Result, positive};

/// Largest number of nodes of a bounding box, which are numbered by u32.
pub(super) const CELL_LIMIT: u64 = u32::MAX as u64 - 1;

/// Returns the number of cells along a side, which must be whole.
pub(super) fn whole_cells(length: f64, spacing: f64) -> Result<f64> {
    positive("the spacing", spacing)?;
    let ratio = positive("a side of the body", length)? / spacing;
    let count = ratio.round();
    if count < 1.0 || (ratio - count).abs() > 1e-6 * ratio.max(1.0) {
        return Err(PericlesError::NotWholeCells {
            length,
            spacing,
            below: ratio.floor().max(1.0) * spacing,
            above: ratio.ceil() * spacing,
            fitting: fitting_spacings(&[length], spacing),
        });
    }
    Ok(count)
}

/// Returns the next smaller and larger spacing that divide all sides, if any within a factor of two.
pub(super) fn fitting_spacings(sides: &[f64], spacing: f64) -> Vec<f64> {
    /// Larger numbers of cells along a side do not occur.
    const MOST: f64 = 1e5;
    let Some(first) = sides.iter().copied().reduce(f64::min) else {
        return Vec::new();
    };
    let ratio = first / spacing;
    if !(ratio > 0.0 && ratio < MOST) {
        return Vec::new();
    }
    let whole = |cells: f64| (cells - cells.round()).abs() <= 1e-6 * cells;
    let fits = |count: &u32| {
        let dx = first / f64::from(*count);
        sides.iter().all(|side| whole(side / dx))
    };
    let middle = ratio.floor() as u32;
    let finer = (middle + 1..=2 * middle + 2).find(fits);
    let coarser = (middle.div_ceil(2).max(1)..=middle).rev().find(fits);
    let counts = finer.into_iter().chain(coarser);
    counts.map(|count| first / f64::from(count)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn suggested_spacings_divide_all_sides() {
        let near = |sides: &[f64], dx| fitting_spacings(sides, dx);
        assert_eq!(near(&[0.1, 0.04], 0.0007), [0.04 / 58.0, 0.04 / 56.0]);
        assert_eq!(near(&[1.0], 0.3), [0.25, 1.0 / 3.0]);
        // No common divisor within a factor of two.
        assert_eq!(near(&[1.0, std::f64::consts::SQRT_2], 0.3), [0.0; 0]);
        assert_eq!(near(&[1e300], 1e-300), [0.0; 0]);
    }
}
