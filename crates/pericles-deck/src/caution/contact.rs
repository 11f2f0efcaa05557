//! Warnings about contact.

use pericles::units::{quantity, significant};

use crate::wording::percent;

/// Kinds of warnings about contact of points and impactors.
#[derive(Debug, Clone, thiserror::Error)]
#[non_exhaustive]
pub enum ContactCaution {
    /// An impact in which points may pass each other.
    #[error("the impact at {} ({} of the wave speed) makes points overlap by about {} of the spacing; beyond 1 they pass each other",
        quantity(*speed, "m/s"), percent(speed / wave_speed), significant(*overlap, 2))]
    FastImpact {
        /// Relative speed of the bodies, m/s.
        speed: f64,
        /// Speed of waves, m/s.
        wave_speed: f64,
        /// Estimated overlap in spacings.
        overlap: f64,
    },
    /// An impactor that may pass between the points of the body.
    #[error("the impactor is {} wide at its narrowest, less than the spacing of {}: it may pass between the points without contact",
        quantity(*width, "m"), quantity(*spacing, "m"))]
    SmallImpactor {
        /// Smallest width, m.
        width: f64,
        /// Spacing of the points, m.
        spacing: f64,
    },
    /// Friction between points.
    #[error(
        "friction between points does not conserve angular momentum: its forces act at the two points, which are a distance apart, and points do not rotate"
    )]
    FrictionTorque,
    /// A step in which contacts are not resolved.
    #[error("a contact of two points lasts less than five steps of {}: bodies may leave each other with up to 10 % more or less velocity",
        quantity(*dt, "s"))]
    FewContactSteps {
        /// The step, s.
        dt: f64,
        /// The largest step with five steps per contact, s.
        longest: f64,
    },
    /// A step in which an impact stretches bonds far beyond the critical stretch.
    #[error("within a step the impact at {} stretches bonds by {} times the critical stretch",
        quantity(*speed, "m/s"), significant(*times, 2))]
    CoarseImpact {
        /// Relative speed of the bodies, m/s.
        speed: f64,
        /// Stretch in a step relative to the critical stretch.
        times: f64,
    },
}

impl ContactCaution {
    pub(super) fn advice(&self) -> String {
        let advice = match self {
            Self::FastImpact { .. } => {
                "use a larger `contact.stiffness` with a smaller step, fewer spacings per horizon, or a smaller speed; the history shows the overlap of impactors"
            }
            Self::SmallImpactor { .. } => "use a smaller spacing or a wider impactor",
            Self::FrictionTorque => {
                "the error of a sliding body is of the order of μ times the spacing over its size; a smaller spacing reduces it"
            }
            Self::FewContactSteps { longest, .. } => {
                return format!("use dt = \"auto\" or at most {}", quantity(*longest, "s"));
            }
            Self::CoarseImpact { .. } => {
                "broken bonds then depend on the time step; repeat the run with a smaller dt and compare"
            }
        };
        advice.into()
    }

    pub(super) fn label(&self) -> &'static str {
        match self {
            Self::FastImpact { .. } => "fast impact",
            Self::FewContactSteps { .. } | Self::CoarseImpact { .. } => "large step",
            Self::SmallImpactor { .. } => "narrow impactor",
            Self::FrictionTorque => "angular momentum",
        }
    }
}
