//! Control of the load factor by a quantity of the displacements.

use std::fmt::Debug;
use std::sync::Arc;

use pericles::{Result, System};

/// A scalar of the displacements, such as the opening of a crack mouth, m.
pub trait ControlledQuantity: Debug + Send + Sync {
    /// Returns the value at displacement `u`. All processes call it together and get the same value.
    ///
    /// # Errors
    /// A value that cannot be computed.
    fn value(&self, system: &System, t: f64, u: &[f64]) -> Result<f64>;
}

/// Control of loads and displacements of supports by a quantity that grows in proportion to time.
///
/// Loads and displacements of supports are multiples of their values at a reference time, with one factor for both. In
/// each state the factor is such that the quantity has its value at that time (indirect displacement control; de Borst,
/// Comput. Struct. 25, 1987). A quantity that grows while the body fails, such as the opening of a crack mouth, leads
/// along falling branches and through snap-backs.
#[derive(Debug, Clone)]
pub struct Control {
    /// The quantity.
    pub quantity: Arc<dyn ControlledQuantity>,
    /// Its rate, m/s.
    pub rate: f64,
    /// Time (s) at which loads and supports have the values that are scaled.
    pub reference: f64,
}

impl Control {
    /// Returns the value of the quantity at a time, for its value at zero displacement.
    pub(crate) fn value_at(&self, t: f64, unloaded: f64) -> f64 {
        unloaded + self.rate * t
    }
}
