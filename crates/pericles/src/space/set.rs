//! Checks of sets of points and of arrays on points.

use crate::error::{PericlesError, Result};

/// Refuses a set that is not ascending, or that names a point that a body of `points` points does not have.
///
/// # Errors
/// [`PericlesError::NoSuchPoint`] and [`PericlesError::BadSet`], with the text `what`.
pub fn check_set(what: &'static str, set: &[u32], points: usize) -> Result<()> {
    check_points(what, set, points)?;
    if set.windows(2).any(|pair| pair[0] >= pair[1]) {
        let reason = "the points must be ascending, and each may be named once";
        return Err(PericlesError::BadSet { what, reason });
    }
    Ok(())
}

/// Refuses numbers of points that a body of `points` points does not have; they may be in any order.
///
/// # Errors
/// [`PericlesError::NoSuchPoint`], with the text `what`.
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

/// Refuses an array that does not have the number of entries that is needed.
///
/// # Errors
/// [`PericlesError::WrongLength`], with the text `what`.
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
