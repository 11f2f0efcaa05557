//! What devices do not compute.

use pericles::StepKind;
use pericles::System;
use pericles::operator::StencilData;
use pericles::time::Integrator;

use crate::error::GpuError;

/// A feature of runs that devices do not compute, with the text of the message.
struct Limit {
    reason: &'static str,
    applies: fn(&System, &dyn Integrator) -> bool,
}

const OTHER_FORCE: &str = "the force is not that of linear or bond-stretch bonds or of a linear peridynamic solid on a regular lattice at constant temperature (softening, viscous, plastic and correspondence materials, meshes, listed points and surfaces are computed by the processor)";

/// All limits.
const LIMITS: &[Limit] = &[
    Limit {
        reason: "the scheme is not velocity Verlet",
        applies: |_, integrator| integrator.step_kind() != StepKind::EndOfStep,
    },
    Limit {
        reason: "the body is divided among several processes",
        applies: |system, _| system.domain().is_divided(),
    },
    Limit {
        reason: OTHER_FORCE,
        applies: |system, _| system.operator().capabilities().stencil.is_none(),
    },
    Limit {
        reason: "it has contact or impactors",
        applies: |system, _| system.interactions().next().is_some(),
    },
    Limit {
        reason: "it computes a temperature",
        applies: |system, _| system.fields().next().is_some(),
    },
    Limit {
        reason: "a load is not a function of the position times a function of time",
        applies: |system, _| system.loads().iter().any(|load| !load.is_separable()),
    },
    Limit {
        reason: "its loads grow in proportion to a controlled quantity",
        applies: |system, _| system.load_factor().is_some(),
    },
    Limit {
        reason: "a prescribed motion is not a function of the position times a function of time",
        applies: |system, _| {
            let mut motions = system.motions().iter();
            motions.any(|motion| motion.components(system.points()).is_none())
        },
    },
    Limit {
        reason: "it has a boundary other than damping layers",
        applies: |system, _| {
            system
                .boundaries()
                .any(|boundary| boundary.as_layer().is_none())
        },
    },
];

/// Returns the reasons why devices do not compute a run.
pub fn unsupported(system: &System, integrator: &dyn Integrator) -> Vec<&'static str> {
    let limits = LIMITS
        .iter()
        .filter(|limit| (limit.applies)(system, integrator));
    limits.map(|limit| limit.reason).collect()
}

/// Returns the force of a run as data.
///
/// # Errors
/// The first reason why devices do not compute the run.
pub(crate) fn supported<'a>(
    system: &'a System,
    integrator: &dyn Integrator,
) -> Result<StencilData<'a>, GpuError> {
    let reasons = unsupported(system, integrator);
    match (reasons.first(), system.operator().capabilities().stencil) {
        (None, Some(force)) => Ok(force.data()),
        (reason, _) => Err(GpuError::NotSupported {
            reason: reason.copied().unwrap_or(OTHER_FORCE),
        }),
    }
}
