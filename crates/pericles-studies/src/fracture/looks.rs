//! How the cracks of the studies are looked at.

/// The paper of the topic.
pub(super) const PAPER: &str = "Alebrahim et al. 2022, Comput. Part. Mech.";

/// Time between two looks at the crack, s.
pub(super) const LOOK: f64 = 0.5e-6;

/// Damage beyond which a point belongs to the crack.
pub(super) const THRESHOLD: f64 = 0.35;
