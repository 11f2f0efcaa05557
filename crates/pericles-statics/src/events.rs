//! Event-to-event analysis: a body of linear forces is followed from one breaking bond to the next.

use pericles::operator::On;
use pericles::{Result, System};

use crate::error::StaticsError;
use crate::stretch::largest_ratio;

/// Refuses what cannot be followed: states between events must be multiples of one solution, of which prescribed displacements alone are the cause.
pub(crate) fn check(system: &System, reference: f64) -> Result<()> {
    let refuse = |reason| Err(StaticsError::NoEvents { reason }.into());
    if system.operator().as_linear().is_none() {
        return refuse("forces are not linear in the displacements, which small strains make them");
    }
    if !system.operator().can_break() {
        return refuse(
            "no bond can break, give the material a fracture energy or a critical stretch",
        );
    }
    if !system.loads().is_empty() {
        return refuse(
            "loads are not scaled from event to event, drive the body by prescribed displacements alone",
        );
    }
    let mut supports = vec![0.0; system.dimension() * system.points()];
    system.place_on(reference, &On::All, &mut supports);
    if supports.iter().all(|u| *u == 0.0) {
        return refuse(
            "no displacement is prescribed that differs from zero at the end of the run",
        );
    }
    Ok(())
}

/// The factor at which the most stretched bond of a response reaches its critical stretch; none if no bond is stretched but by rounding.
pub(crate) fn next(system: &System, response: &[f64], last: f64) -> Option<f64> {
    /// Relative accuracy of the factor.
    const ACCURACY: f64 = 1e-7;
    /// A factor beyond this multiple of the last one belongs to bonds that only rounding stretches: the body is severed.
    const SEVERED: f64 = 1e3;
    let factor = 1.0 / largest_ratio(system, response, ACCURACY)?;
    (last == 0.0 || factor <= SEVERED * last).then_some(factor)
}
