//! Errors of contact and rigid bodies.

use pericles::PericlesError;
use pericles::units::{quantity, significant};

/// An invalid contact or rigid body.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ContactError {
    /// A number of the contact law is out of range.
    #[error("{what} of the contact is {}; allowed: {allowed}", significant(*value, 4))]
    Law {
        /// The number.
        what: &'static str,
        /// The value given.
        value: f64,
        /// The allowed range.
        allowed: &'static str,
    },
    /// A number of a rigid body is out of range.
    #[error("impactor \"{name}\": {what} is {}; allowed: {allowed}", quantity(*value, unit))]
    Body {
        /// Name of the rigid body.
        name: String,
        /// The number.
        what: &'static str,
        /// The value given.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// The allowed range.
        allowed: &'static str,
    },
    /// A rigid body that cannot be used as given.
    #[error("impactor \"{name}\": {reason}")]
    Impactor {
        /// Name of the rigid body.
        name: String,
        /// What is wrong and what is allowed.
        reason: String,
    },
    /// Lists of numbers per point of another length.
    #[error("{what}: {given} values for {needed} points; allowed: one value per point")]
    Length {
        /// The list.
        what: &'static str,
        /// Values given.
        given: usize,
        /// Points of the body.
        needed: usize,
    },
    /// A triangle mesh that does not bound a volume.
    #[error("the mesh of an impactor {reason}")]
    Mesh {
        /// What is wrong.
        reason: String,
    },
    /// A body on which contact is not possible.
    #[error("contact between points is not possible here: {reason}")]
    NotPossible {
        /// The reason.
        reason: &'static str,
    },
}

impl From<ContactError> for PericlesError {
    fn from(error: ContactError) -> Self {
        Self::Extension(Box::new(error))
    }
}
