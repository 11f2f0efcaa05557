//! Thermal expansion.

use std::sync::Arc;

use crate::bodies::{affine, force, jittered, largest, material, noise, operator, wave};
use pericles::material::StressState;
use pericles::operator::{Force, PointSubset};
use pericles::space::PointCloud;
use pericles::{PointScalar, Temperature, ThermalExpansion};
use pericles_solids::correspondence::{ElasticLaw, History, Stabilisation};

const LAWS: [ElasticLaw; 4] = [
    ElasticLaw::StVenantKirchhoff,
    ElasticLaw::NeoHooke,
    ElasticLaw::NeoHookeSplit,
    ElasticLaw::Hencky,
];

/// T = base + slope x, K.
#[derive(Debug)]
struct Linear {
    cloud: Arc<PointCloud>,
    base: f64,
    slope: f64,
}

impl Temperature for Linear {
    fn temperatures_into(&self, _t: f64, out: &mut [f64]) {
        for (i, out) in out.iter_mut().enumerate() {
            *out = self.base + self.slope * self.cloud.point(i)[0];
        }
    }

    fn is_steady(&self) -> bool {
        true
    }
}

/// The force of a body with the thermal stretch `base` + `slope` x.
fn heated(
    cloud: &Arc<PointCloud>,
    law: ElasticLaw,
    state: StressState,
    [base, slope]: [f64; 2],
) -> Box<dyn Force> {
    let material = material(0.3, 2.3, law, Stabilisation::Isotropic);
    let mut force = operator(cloud, &material, state);
    let temperature = Arc::new(Linear {
        cloud: cloud.clone(),
        base,
        slope,
    });
    let coefficient = PointScalar::Uniform(1.0);
    let expansion = ThermalExpansion::new(cloud.clone(), temperature, 0.0, coefficient);
    force.expand(expansion.unwrap()).unwrap();
    force
}

#[test]
fn free_thermal_expansion_has_no_force_and_no_energy() {
    let stretch = 0.05;
    for (sides, state) in [
        (&[4, 4, 4][..], StressState::Spatial),
        (&[7, 7], StressState::PlaneStress),
        (&[12], StressState::Uniaxial),
    ] {
        let cloud = jittered(sides);
        for law in LAWS {
            let operator = heated(&cloud, law, state, [stretch, 0.0]);
            let grow: [[f64; 3]; 3] = std::array::from_fn(|a| {
                std::array::from_fn(|b| if a == b { stretch } else { 0.0 })
            });
            let u = affine(&cloud, &grow);
            // E τ over the spacing is 0.5.
            let found = largest(&force(&*operator, &u));
            assert!(found < 1e-12, "{law:?}, {state:?}: {found:e}");
            assert!(operator.energy(0.0, &u).abs() < 1e-12);
        }
    }
}

/// Stress of constrained expansion in linear elasticity: −E τ/(1 − 2ν) in space and plane strain, −E τ/(1 −
/// ν) in plane stress, −E τ in a bar; finite-strain laws differ by O(τ).
#[test]
fn constrained_thermal_expansion_has_the_stress_of_linear_elasticity() {
    let (young, nu, stretch) = (10.0, 0.3, 1e-7);
    for law in LAWS {
        let expected = [
            (StressState::Spatial, young / (1.0 - 2.0 * nu)),
            (StressState::PlaneStrain, young / (1.0 - 2.0 * nu)),
            (StressState::PlaneStress, young / (1.0 - nu)),
            (StressState::Uniaxial, young),
        ];
        for (state, modulus) in expected {
            let material = material(nu, 2.3, law, Stabilisation::Isotropic);
            let sides: &[usize] = match state {
                StressState::Spatial => &[4, 4, 4],
                StressState::Uniaxial => &[12],
                _ => &[4, 4],
            };
            let constants = material.constants(&jittered(sides), state).unwrap();
            let solid = constants.point.expanded(1.0 + stretch);
            let rest = History::default();
            let stress = match state {
                StressState::Spatial => {
                    solid
                        .stress(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], &rest)
                        .stress[0][0]
                }
                StressState::Uniaxial => solid.stress(&[[1.0]], &rest).stress[0][0],
                _ => solid.stress(&[[1.0, 0.0], [0.0, 1.0]], &rest).stress[0][0],
            };
            let error = stress / (-modulus * stretch) - 1.0;
            assert!(error.abs() < 1e-5, "{law:?}, {state:?}: {error:e}");
        }
    }
}

#[test]
fn heated_forces_are_energy_gradients_and_tangents_are_their_derivatives() {
    for (sides, state) in [
        (&[4, 4, 4][..], StressState::Spatial),
        (&[7, 7], StressState::PlaneStrain),
        (&[7, 7], StressState::PlaneStress),
        (&[12], StressState::Uniaxial),
    ] {
        let cloud = jittered(sides);
        for law in LAWS {
            let operator = heated(&cloud, law, state, [0.02, 0.01]);
            let (u, d, h) = (
                wave(&cloud, 0.02),
                noise(cloud.len() * sides.len(), 2.0),
                1e-5,
            );
            let moved = |s: f64| -> Vec<f64> { u.iter().zip(&d).map(|(u, d)| u + s * d).collect() };
            let found = force(&*operator, &u);
            let slope =
                (operator.energy(0.0, &moved(h)) - operator.energy(0.0, &moved(-h))) / (2.0 * h);
            let n = cloud.len();
            let entries = 0..u.len();
            let work: f64 = entries
                .map(|k| -found[k] * d[k] * cloud.volumes()[k % n])
                .sum();
            let size: f64 = (0..u.len()).map(|k| (found[k] * d[k]).abs()).sum();
            assert!(
                (slope - work).abs() < 1e-8 * size,
                "{law:?}, {state:?}: {slope} {work}"
            );
            let mut tangent = vec![0.0; u.len()];
            operator.tangent_into(0.0, &u, &d, &mut tangent);
            let mut up = vec![0.0; u.len()];
            operator.add_force(0.0, &moved(h), PointSubset::All, &mut up);
            let down = force(&*operator, &moved(-h));
            let most = largest(&tangent);
            for k in 0..u.len() {
                let slope = (up[k] - down[k]) / (2.0 * h);
                assert!(
                    (slope - tangent[k]).abs() < 1e-7 * most,
                    "{law:?}, {state:?}"
                );
            }
        }
    }
}
