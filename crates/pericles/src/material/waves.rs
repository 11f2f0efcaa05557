//! Wave speeds of the elastic continuum in the limit of small horizons.

use super::{ElasticConstants, StressState};

/// Wave speeds, m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticWaves {
    /// Speed of pressure waves; in a bar √(E/ρ).
    pub pressure: f64,
    /// Speeds of shear and Rayleigh waves; `None` in a bar.
    pub transverse: Option<TransverseWaves>,
}

/// Speeds of transverse waves, m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TransverseWaves {
    /// Speed of shear waves, m/s.
    pub shear: f64,
    /// Speed of Rayleigh waves, m/s: the upper limit of the speed of mode-I cracks.
    pub rayleigh: f64,
}

impl ElasticWaves {
    /// Returns the speeds for Young's modulus (Pa), density (kg/m³) and a state of stress, which fixes Poisson's ratio.
    pub fn of(young: f64, density: f64, state: StressState) -> Self {
        let Some(nu) = state.poisson_ratio() else {
            return Self {
                pressure: (young / density).sqrt(),
                transverse: None,
            };
        };
        let shear = (young / (2.0 * (1.0 + nu) * density)).sqrt();
        // c_s²/c_p²; in plane stress the speed of pressure waves is √(E/(1−ν²)/ρ).
        let ratio = match state {
            StressState::PlaneStress => 0.5 * (1.0 - nu),
            _ => (1.0 - 2.0 * nu) / (2.0 * (1.0 - nu)),
        };
        Self {
            pressure: shear / ratio.sqrt(),
            transverse: Some(TransverseWaves {
                shear,
                rayleigh: shear * rayleigh(ratio).sqrt(),
            }),
        }
    }

    /// Returns the speeds in a solid with any Poisson's ratio, for a density (kg/m³) and a state of stress.
    pub fn of_solid(solid: &ElasticConstants, density: f64, state: StressState) -> Self {
        let longitudinal = solid.longitudinal_modulus(state);
        let pressure = (longitudinal / density).sqrt();
        let shear = (solid.shear() / density).sqrt();
        let transverse = TransverseWaves {
            shear,
            rayleigh: shear * rayleigh(solid.shear() / longitudinal).sqrt(),
        };
        Self {
            pressure,
            transverse: (state != StressState::Uniaxial).then_some(transverse),
        }
    }
}

/// Returns the root x = c_R²/c_s² in (0, 1) of Rayleigh's equation (2 − x)² = 4 √(1 − x) √(1 − r x), r = c_s²/c_p² < 1.
fn rayleigh(ratio: f64) -> f64 {
    let excess = |x: f64| (2.0 - x).powi(2) - 4.0 * ((1.0 - x) * (1.0 - ratio * x)).sqrt();
    // x = 0 is also a root; the excess is negative just above it and 1 at x = 1.
    let (mut low, mut high) = (0.1, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if excess(middle) > 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rayleigh_speed_for_poisson_ratio_one_quarter_matches_the_closed_form() {
        // Poisson's ratio 1/4: x = 2 − 2/√3.
        let exact = 2.0 - 2.0 / 3f64.sqrt();
        assert!((rayleigh(1.0 / 3.0) - exact).abs() < 1e-14);
    }

    #[test]
    fn rayleigh_speeds_of_soda_lime_and_duran_glass_match_references() {
        let rayleigh = |young, density| {
            ElasticWaves::of(young, density, StressState::PlaneStrain)
                .transverse
                .unwrap()
                .rayleigh
        };
        assert!((rayleigh(72e9, 2440.0) - 3159.0).abs() < 0.5);
        assert!((rayleigh(65e9, 2235.0) - 3136.0).abs() < 0.5);
    }

    #[test]
    fn wave_speeds_of_solids_with_the_fixed_poisson_ratio_equal_bond_based_speeds() {
        for state in [
            StressState::Uniaxial,
            StressState::PlaneStress,
            StressState::PlaneStrain,
            StressState::Spatial,
        ] {
            let nu = state.poisson_ratio().unwrap_or(0.0);
            let solid = ElasticConstants::of_young(72e9, nu).unwrap();
            let (a, b) = (
                ElasticWaves::of_solid(&solid, 2440.0, state),
                ElasticWaves::of(72e9, 2440.0, state),
            );
            assert!((a.pressure / b.pressure - 1.0).abs() < 1e-14, "{state:?}");
            assert_eq!(a.transverse.is_some(), b.transverse.is_some());
            if let (Some(a), Some(b)) = (a.transverse, b.transverse) {
                assert!((a.shear / b.shear - 1.0).abs() < 1e-14);
                assert!((a.rayleigh / b.rayleigh - 1.0).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn rayleigh_speeds_agree_with_the_approximation_of_viktorov() {
        // The error of Viktorov's approximation (0.87 + 1.12 ν)/(1 + ν) is below 0.5 %.
        for nu in [0.0, 0.2, 0.45] {
            let solid = ElasticConstants::of_young(1.0, nu).unwrap();
            let waves = ElasticWaves::of_solid(&solid, 1.0, StressState::PlaneStrain);
            let found = waves.transverse.unwrap();
            let approximation = (0.87 + 1.12 * nu) / (1.0 + nu);
            assert!((found.rayleigh / found.shear / approximation - 1.0).abs() < 5e-3);
        }
    }

    #[test]
    fn wave_speed_of_a_steel_bar_is_root_of_modulus_over_density() {
        let speeds = ElasticWaves::of(210e9, 7850.0, StressState::Uniaxial);
        assert!((speeds.pressure - 5172.2).abs() < 0.1);
        assert_eq!(speeds.transverse, None);
    }
}
