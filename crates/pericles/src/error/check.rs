//! Checks of arguments.

use super::{PericlesError, Result};

/// Checks that a quantity is positive and finite.
pub fn positive(quantity: &'static str, value: f64) -> Result<f64> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(PericlesError::NotPositive { quantity, value })
    }
}
