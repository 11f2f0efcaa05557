//! Errors of a model, at the keys that cause them.

use pericles::PericlesError;
use pericles_deck::{BuildError, Fault, KeyPath, Keys, Remark};
use pericles_waves::linear::NoConvolution;

/// The keys of the horizon; a deck has one of them.
pub(super) const HORIZON: [&str; 2] = ["material.horizon", "material.horizon_ratio"];

/// Creates the error for the value of a key.
pub(super) fn at_path(keys: impl Into<Keys>, fault: Fault) -> BuildError {
    Remark::new(keys, fault).into()
}

/// Creates the error of the engine for the value of a key.
pub(super) fn at(keys: impl Into<Keys>, error: PericlesError) -> BuildError {
    at_path(keys, error.into())
}

/// Returns the key of an invalid refined part; `None` for other errors.
pub(super) fn refined_key(error: &PericlesError) -> Option<Keys> {
    match error {
        PericlesError::FinerEmpty { part } | PericlesError::FinerRatio { part, .. } => {
            Some(KeyPath::from("body.refine").index(*part).into())
        }
        PericlesError::FinerParts { .. } => Some("body.refine".into()),
        _ => None,
    }
}

/// Creates the error of the engine for a material.
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
