//! Refusals of a model, at the keys that are to blame.

use pericles::PericlesError;
use pericles_deck::{BuildError, Fault, KeyPath, Keys, Remark};
use pericles_waves::linear::NoConvolution;

/// The keys of the horizon, of which a deck gives one.
pub(super) const HORIZON: [&str; 2] = ["material.horizon", "material.horizon_ratio"];

/// The refusal of a value.
pub(super) fn at_path(keys: impl Into<Keys>, fault: Fault) -> BuildError {
    Remark::new(keys, fault).into()
}

/// What the library refuses, at a value.
pub(super) fn at(keys: impl Into<Keys>, error: PericlesError) -> BuildError {
    at_path(keys, error.into())
}

/// The key of a part with smaller cells that the library refuses; none of other errors.
pub(super) fn refined_key(error: &PericlesError) -> Option<Keys> {
    match error {
        PericlesError::FinerEmpty { part } | PericlesError::FinerRatio { part, .. } => {
            Some(KeyPath::from("body.refine").index(*part).into())
        }
        PericlesError::FinerParts { .. } => Some("body.refine".into()),
        _ => None,
    }
}

/// What the library refuses of a material.
pub(super) fn at_material(error: PericlesError) -> BuildError {
    match &error {
        PericlesError::BadInfluence { .. } => at("material.influence", error),
        PericlesError::FormNotUsable { .. } => at("material.bonds", error),
        _ if error.extension::<NoConvolution>().is_some() => at("material.bonds", error),
        PericlesError::HorizonTooSmall { .. } | PericlesError::HorizonTooLarge { .. } => {
            at(HORIZON, error)
        }
        _ => at("material", error),
    }
}
