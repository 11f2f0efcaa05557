//! Event-by-event analysis, from one breaking bond to the next.

use pericles::operator::PointSubset;
use pericles::{Result, System};

use crate::error::StaticsError;
use crate::stretch::load_factor;

/// Returns an error for systems that event-by-event analysis does not support: the state between events must be
/// determined by the bonds and one factor of loads and supports.
pub(crate) fn check(system: &System, reference: f64) -> Result<()> {
    let refuse = |reason| Err(StaticsError::NoEvents { reason }.into());
    let capabilities = system.operator().capabilities();
    if capabilities.path_dependent {
        return refuse(
            "forces depend on the history of the deformation, so that the load factor does not determine the state (use an elastic material)",
        );
    }
    if capabilities.thermal.is_some() {
        return refuse("thermal strain is not scaled with the loads (remove [thermal])");
    }
    if system.has_interactions() {
        return refuse("contact opens and closes between events (remove [contact] and impactors)");
    }
    if !system.operator().can_break() {
        return refuse(
            "no bond can break (set a fracture energy or a critical stretch of the material)",
        );
    }
    let (mut supports, mut load) = (vec![0.0; entries(system)], vec![0.0; entries(system)]);
    system.place_on(reference, &PointSubset::All, &mut supports);
    system.load_density_into(reference, &mut load);
    let nothing = supports.iter().chain(&load).all(|x| *x == 0.0);
    if system.domain().all(nothing) {
        return refuse(
            "no load and no prescribed displacement differs from zero at the end of the run",
        );
    }
    Ok(())
}

fn entries(system: &System) -> usize {
    system.dimension() * system.points()
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
