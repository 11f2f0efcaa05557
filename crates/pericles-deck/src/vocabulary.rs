//! Words of the deck that mean the same, and words of which only one may be given.

/// A key with the other names it is known by.
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

/// What makes a set: a region, a condition, blocks, faces of a mesh.
pub(crate) const SELECTIONS: &[&str] = &[
    "all",
    "box",
    "ball",
    "cylinder",
    "half_space",
    "layer",
    "polygon",
    "union",
    "intersection",
    "complement",
    "where",
    "block",
    "near_faces",
];
/// The kinds of region: what makes a set, less conditions, blocks and faces, which need the body's points.
pub(crate) const REGIONS: &[&str] = SELECTIONS.split_at(SELECTIONS.len() - 3).0;
/// The elastic modulus.
pub(crate) const MODULI: &[&str] = &["youngs_modulus", "bulk_modulus", "shear_modulus"];
/// The horizon.
pub(crate) const HORIZONS: &[&str] = &["horizon", "horizon_ratio"];
/// The strength of bonds.
pub(crate) const STRENGTHS: &[&str] = &["fracture_energy", "critical_stretch"];
/// What each of several materials gives for itself; all else in its table is said of all bonds of the body.
pub(crate) const OWN_CONSTANTS: &[&str] = &[
    "name",
    "density",
    "youngs_modulus",
    "bulk_modulus",
    "shear_modulus",
    "poisson_ratio",
    "modulus",
    "fracture_energy",
    "critical_stretch",
    "yield_stress",
    "hardening",
];
/// How limits follow from a fracture energy: a material or interface that gives one takes these over from the first material.
pub(crate) const FAILURE_RULES: &[&str] =
    &["fracture_calibration", "failure", "stretch_definition"];
/// What may be assigned to sets.
pub(crate) const ASSIGNED: &[&str] = &["material", "stiffness"];
/// What the constant of bonds between two materials follows from.
pub(crate) const INTERFACE_STIFFNESSES: &[&str] =
    &["rule", "youngs_modulus", "bulk_modulus", "shear_modulus"];
/// What an interface is about.
pub(crate) const INTERFACE_KEYS: &[&str] = &[
    "rule",
    "youngs_modulus",
    "bulk_modulus",
    "shear_modulus",
    "fracture_energy",
    "critical_stretch",
];
/// When output is due.
pub(crate) const SCHEDULES: &[&str] = &["interval", "every", "count"];
/// When a checkpoint is due.
pub(crate) const CHECKPOINTS: &[&str] = &["wall", "every", "interval"];
/// The depth of a layer.
pub(crate) const DEPTHS: &[&str] = &["depth", "cells"];
/// A load.
pub(crate) const LOADS: &[&str] = &["body_force", "traction", "pressure"];

/// The points with the smaller time step.
pub(crate) const FINE_REGIONS: &[&str] = &["fine", "adaptive"];

/// The other names of a key.
pub(crate) fn synonyms(key: &str) -> &'static [&'static str] {
    SYNONYMS
        .iter()
        .find(|(name, _)| *name == key)
        .map_or(&[], |(_, others)| others)
}

/// The key that a name stands for.
pub(crate) fn canonical(name: &str) -> &str {
    SYNONYMS
        .iter()
        .find(|(_, others)| others.contains(&name))
        .map_or(name, |(key, _)| key)
}

/// Whether a value under the key `given` takes the place of one under `other` when it comes from an override: the same key under another
/// name, or the other choice where only one may be given.
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
    fn names_and_alternatives() {
        assert_eq!(canonical("dx"), "spacing");
        assert_eq!(canonical("unheard_of"), "unheard_of");
        assert_eq!(synonyms("fracture_energy"), ["Gc", "G0"]);
        assert!(replaces("E", "youngs_modulus") && replaces("K", "E") && replaces("m", "horizon"));
        assert!(replaces("wall", "interval") && !replaces("E", "rho"));
    }
}
