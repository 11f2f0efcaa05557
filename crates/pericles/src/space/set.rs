//! Checks of point sets and of arrays on points.

use crate::error::{PericlesError, Result};
use crate::sum::max_norm;

/// Checks that a set is in ascending order and contains only points of a body with `points` points.
///
/// # Errors
/// [`PericlesError::NoSuchPoint`] and [`PericlesError::BadSet`], with `what` in the message.
pub fn check_set(what: &'static str, set: &[u32], points: usize) -> Result<()> {
    check_points(what, set, points)?;
    if set.windows(2).any(|pair| pair[0] >= pair[1]) {
        let reason = "the points must be in ascending order, each at most once";
        return Err(PericlesError::BadSet { what, reason });
    }
    Ok(())
}

/// Checks that all numbers, in any order, are points of a body with `points` points.
///
/// # Errors
/// [`PericlesError::NoSuchPoint`], with `what` in the message.
pub fn check_points(what: &'static str, set: &[u32], points: usize) -> Result<()> {
    match set.iter().find(|&&i| i as usize >= points) {
        Some(&point) => Err(PericlesError::NoSuchPoint {
            what,
            point,
            points,
        }),
        None => Ok(()),
    }
}

/// Checks the length of an array.
///
/// # Errors
/// [`PericlesError::WrongLength`], with `what` in the message.
pub fn check_length(what: &'static str, length: usize, needed: usize) -> Result<()> {
    if length == needed {
        return Ok(());
    }
    Err(PericlesError::WrongLength {
        what,
        length,
        needed,
    })
}

/// Checks that the rounding of positions (m) is small compared with the spacing (m); otherwise points would
/// coincide or have arbitrary distances.
pub(super) fn check_resolution(positions: &[f64], spacing: f64) -> Result<()> {
    /// Allowed rounding relative to the spacing, as for sides that must be whole numbers of cells.
    const SHARE: f64 = 1e-6;
    let farthest = max_norm(positions);
    let resolution = f64::EPSILON * farthest;
    if resolution <= SHARE * spacing {
        return Ok(());
    }
    Err(PericlesError::Unresolved {
        farthest,
        resolution,
        spacing,
        allowed: SHARE * spacing / f64::EPSILON,
    })
}

#[cfg(test)]
mod tests {
    use crate::space::PointCloud;

    #[test]
    fn coordinates_must_resolve_the_spacing() {
        let pair = |x: f64| PointCloud::new(1, vec![x, x + 1.0], vec![1.0; 2], 1.0);
        assert!(pair(1e9).is_ok());
        let message = pair(-1e12).unwrap_err().to_string();
        assert!(message.contains("1.00 Tm from the origin"), "{message}");
        assert!(message.contains("4.50 Gm"), "{message}");
    }
}
