//! Wave speeds of the elastic material that a bond-based one approaches.

use super::{ElasticConstants, StressState};

/// Speeds of waves, m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticWaves {
    /// Pressure waves; in a bar the bar wave, √(E/ρ).
    pub pressure: f64,
    /// Shear and Rayleigh waves; none in a bar.
    pub transverse: Option<TransverseWaves>,
}

/// Speeds of transverse waves, m/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TransverseWaves {
    /// Shear waves, m/s.
    pub shear: f64,
    /// Rayleigh waves along a free surface, which a crack in mode I cannot overtake, m/s.
    pub rayleigh: f64,
}

impl ElasticWaves {
    /// The speeds for Young's modulus (Pa), density (kg/m³) and the state of stress, with Poisson's ratio fixed by the state.
    pub fn of(young: f64, density: f64, state: StressState) -> Self {
        let Some(nu) = state.poisson_ratio() else {
            return Self {
                pressure: (young / density).sqrt(),
                transverse: None,
            };
        };
        let shear = (young / (2.0 * (1.0 + nu) * density)).sqrt();
        // c_s²/c_p²: in plane stress the pressure wave runs at √(E/(1−ν²)/ρ).
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

    /// The speeds in a solid with any Poisson's ratio, for the density (kg/m³) and the state of stress.
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

/// The root x = c_R²/c_s² in (0, 1) of Rayleigh's equation (2 − x)² = 4 √(1 − x) √(1 − r x), r = c_s²/c_p² < 1.
fn rayleigh(ratio: f64) -> f64 {
    let excess = |x: f64| (2.0 - x).powi(2) - 4.0 * ((1.0 - x) * (1.0 - ratio * x)).sqrt();
    // x = 0 is a root too; just above it the excess is negative, at 1 it is 1.
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
    fn rayleigh_s_equation_has_a_closed_form_at_a_quarter() {
        // Poisson's ratio 1/4: x = 2 − 2/√3.
        let exact = 2.0 - 2.0 / 3f64.sqrt();
        assert!((rayleigh(1.0 / 3.0) - exact).abs() < 1e-14);
    }

    #[test]
    fn glasses_of_the_fracture_studies() {
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
    fn solids_with_the_fixed_ratio_have_the_speeds_of_bond_based_materials() {
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
    fn rayleigh_waves_of_any_poisson_s_ratio() {
        // Viktorov's approximation (0.87 + 1.12 ν)/(1 + ν) is off by less than 0.5 %.
        for nu in [0.0, 0.2, 0.45] {
            let solid = ElasticConstants::of_young(1.0, nu).unwrap();
            let waves = ElasticWaves::of_solid(&solid, 1.0, StressState::PlaneStrain);
            let found = waves.transverse.unwrap();
            let approximation = (0.87 + 1.12 * nu) / (1.0 + nu);
            assert!((found.rayleigh / found.shear / approximation - 1.0).abs() < 5e-3);
        }
    }

    #[test]
    fn a_steel_bar() {
        let speeds = ElasticWaves::of(210e9, 7850.0, StressState::Uniaxial);
        assert!((speeds.pressure - 5172.2).abs() < 0.1);
        assert_eq!(speeds.transverse, None);
    }
}
