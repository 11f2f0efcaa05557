//! A tensile strength that softening cannot give.

use crate::units::{precise, significant};

/// A tensile strength above that of the brittle material.
///
/// The strength E s_e Φ(A) of a material with softening bonds, A = (s₀/s_e)², is largest for A = 1, where bonds break
/// at the critical stretch s₀ without softening.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "the tensile strength {} is above {}, the strength of the brittle material, whose bonds break at the critical stretch {} \
     without softening. {}",
    precise(self.strength, "Pa"), limit(self.brittle, "Pa"), significant(self.critical_stretch, 4), self.advice()
)]
pub struct UnreachableStrength {
    /// The strength given, Pa.
    pub strength: f64,
    /// Strength of the brittle material, Pa.
    pub brittle: f64,
    /// Critical stretch s₀.
    pub critical_stretch: f64,
    /// Whether s₀ follows from a fracture energy; otherwise it is given and does not depend on the horizon.
    pub by_energy: bool,
    /// Horizon, m.
    pub horizon: f64,
    /// Largest horizon at which softening gives the strength with the same fracture energy, m.
    pub largest_horizon: f64,
}

impl UnreachableStrength {
    fn advice(&self) -> String {
        let strength = limit(self.brittle, "Pa");
        let largest = limit(self.largest_horizon, "m");
        if self.by_energy {
            return format!(
                "Allowed: a horizon of at most {largest} with this strength and fracture energy, instead of {}; or a strength of at \
                 most {strength} with this horizon. Use a smaller horizon and spacing, a larger fracture energy, a smaller strength, or failure = \"strength\" without a limit of the horizon",
                precise(self.horizon, "m")
            );
        }
        let stretch = self.critical_stretch * self.strength / self.brittle;
        format!(
            "Allowed: a critical stretch above {}, or a strength of at most {strength}; with `fracture_energy` instead of \
             `critical_stretch` and the corresponding energy, a horizon of at most {largest}",
            significant(stretch, 4)
        )
    }
}

/// Formats an upper limit with four digits, rounded down, so that the printed value is allowed.
fn limit(value: f64, unit: &str) -> String {
    let digit = 10f64.powi(value.log10().floor() as i32 - 3);
    precise((value / digit).floor() * digit, unit)
}
