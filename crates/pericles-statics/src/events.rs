//! Event-by-event analysis, from one breaking bond to the next.

use pericles::{Result, System};

use crate::error::StaticsError;
use crate::reference::Reference;
use crate::stretch::load_factor;

/// Returns an error for systems that event-by-event analysis does not support: the state between events must be
/// determined by the bonds and one factor of loads and supports.
pub(crate) fn check(system: &System, reference: f64) -> Result<()> {
    let refuse = |reason| StaticsError::NoEvents { reason };
    if system.operator().capabilities().path_dependent {
        return Err(refuse(
            "forces depend on the history of the deformation, so that the load factor does not determine the state (use an elastic material)",
        )
        .into());
    }
    if !system.operator().can_break() {
        return Err(refuse(
            "no bond can break (set a fracture energy or a critical stretch of the material)",
        )
        .into());
    }
    Reference::check(system, reference, refuse)
}

/// Factors beyond this multiple of the last one come from bonds stretched by round-off: the body is severed.
pub(crate) const SEVERED: f64 = 1e3;

/// Returns the factor at which the most stretched bond of a response reaches its critical stretch; `None` if
/// bonds are stretched only by round-off.
pub(crate) fn next(system: &System, response: &[f64], last: f64) -> Option<f64> {
    /// Relative accuracy of the factor.
    const ACCURACY: f64 = 1e-7;
    let factor = load_factor(system, response, ACCURACY)?;
    (last == 0.0 || factor <= SEVERED * last).then_some(factor)
}
