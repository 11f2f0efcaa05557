//! Synonyms and mutually exclusive keys of decks.

/// Keys with their synonyms.
const SYNONYMS: [(&str, &[&str]); 10] = [
    ("spacing", &["dx"]),
    ("centre", &["center"]),
    ("density", &["rho"]),
    ("youngs_modulus", &["E"]),
    ("bulk_modulus", &["K"]),
    ("shear_modulus", &["G"]),
    ("poisson_ratio", &["nu"]),
    ("horizon_ratio", &["m"]),
    ("fracture_energy", &["Gc", "G0"]),
    ("critical_stretch", &["s0"]),
];

/// Elastic moduli.
pub(crate) const MODULI: &[&str] = &["youngs_modulus", "bulk_modulus", "shear_modulus"];
/// Keys of the horizon.
pub(crate) const HORIZONS: &[&str] = &["horizon", "horizon_ratio"];
/// Keys of the strength of bonds.
pub(crate) const STRENGTHS: &[&str] = &["fracture_energy", "critical_stretch"];
/// Words of `failure` for bonds that break by stress or strain, and the keys that they require.
pub(crate) const BY_STATE: [(&str, &str); 2] = [
    ("principal-stress", "strength"),
    ("expression", "criterion"),
];
/// Keys of which each material has its own value; all other keys are shared by all bonds of the body.
pub(crate) const OWN_CONSTANTS: &[&str] = &[
    "name",
    "density",
    "youngs_modulus",
    "bulk_modulus",
    "shear_modulus",
    "poisson_ratio",
    "anisotropy",
    "fracture_energy",
    "critical_stretch",
    "tensile_strength",
    "strength_surface",
    "strength",
    "criterion",
    "viscosity",
    "yield_stress",
    "hardening",
];
/// Failure rules that materials and interfaces with a fracture energy inherit from the first material.
pub(crate) const FAILURE_RULES: &[&str] =
    &["fracture_calibration", "failure", "stretch_definition"];
/// Keys that determine the bond constant between two materials.
pub(crate) const INTERFACE_STIFFNESSES: &[&str] =
    &["rule", "youngs_modulus", "bulk_modulus", "shear_modulus"];
/// Keys of output schedules.
pub(crate) const SCHEDULES: &[&str] = &["interval", "every", "count"];
/// Keys of checkpoint schedules.
pub(crate) const CHECKPOINTS: &[&str] = &["wall", "every", "interval"];
/// Keys of the depth of a layer.
const DEPTHS: &[&str] = &["depth", "cells"];
/// Keys of the amplitude of a load.
pub(crate) const LOADS: &[&str] = &["body_force", "traction", "pressure"];

/// Keys of the points with the fine time step.
pub(crate) const FINE_REGIONS: &[&str] = &["fine", "adaptive"];

/// Returns the synonyms of a key.
pub(crate) fn synonyms(key: &str) -> &'static [&'static str] {
    SYNONYMS
        .iter()
        .find(|(name, _)| *name == key)
        .map_or(&[], |(_, others)| others)
}

/// Returns the first name of a key.
pub(crate) fn canonical(name: &str) -> &str {
    SYNONYMS
        .iter()
        .find(|(_, others)| others.contains(&name))
        .map_or(name, |(key, _)| key)
}

/// Returns whether an override of the key `given` replaces a value under `other`: a synonym or a mutually
/// exclusive key.
pub(crate) fn replaces(given: &str, other: &str) -> bool {
    let (given, other) = (canonical(given), canonical(other));
    let alternatives = [
        MODULI,
        HORIZONS,
        STRENGTHS,
        SCHEDULES,
        CHECKPOINTS,
        DEPTHS,
        LOADS,
        FINE_REGIONS,
        INTERFACE_STIFFNESSES,
    ];
    given == other
        || alternatives
            .iter()
            .any(|group| group.contains(&given) && group.contains(&other))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn synonyms_and_exclusive_keys() {
        assert_eq!(canonical("dx"), "spacing");
        assert_eq!(canonical("unheard_of"), "unheard_of");
        assert_eq!(synonyms("fracture_energy"), ["Gc", "G0"]);
        assert!(replaces("E", "youngs_modulus") && replaces("K", "E") && replaces("m", "horizon"));
        assert!(replaces("wall", "interval") && !replaces("E", "rho"));
    }
}
