//! Comparison with force densities and energies of an independent code and with plane waves of an infinite lattice.

use std::f64::consts::PI;

use pericles::material::StressState;
use pericles_solids::correspondence::{ElasticLaw, Stabilisation};

use crate::bodies::{force, jittered, lattice, material, operator, wave};

struct Reference {
    sides: &'static [usize],
    state: StressState,
    horizon: f64,
    law: ElasticLaw,
    stabilisation: Stabilisation,
    point: usize,
    force: &'static [f64],
    energy: f64,
}

const REFERENCES: [Reference; 4] = [
    Reference {
        sides: &[5, 5, 5],
        state: StressState::Spatial,
        horizon: 2.3,
        law: ElasticLaw::StVenantKirchhoff,
        stabilisation: Stabilisation::Wan,
        point: 62,
        force: &[-2.616775832308302, -3.297629886448748, -0.3551926011785536],
        energy: 14.29705526121666,
    },
    Reference {
        sides: &[5, 5, 5],
        state: StressState::Spatial,
        horizon: 2.3,
        law: ElasticLaw::NeoHooke,
        stabilisation: Stabilisation::Silling,
        point: 62,
        force: &[-4.189245914627366, -5.297011832131683, -0.5981457634803116],
        energy: 20.93405096270195,
    },
    Reference {
        sides: &[9, 9],
        state: StressState::PlaneStrain,
        horizon: 2.7,
        law: ElasticLaw::NeoHooke,
        stabilisation: Stabilisation::Wan,
        point: 40,
        force: &[0.253609733080162, -1.217939328854576],
        energy: 3.566571315852815,
    },
    Reference {
        sides: &[9, 9],
        state: StressState::PlaneStress,
        horizon: 2.7,
        law: ElasticLaw::StVenantKirchhoff,
        stabilisation: Stabilisation::None,
        point: 40,
        force: &[0.02039030118285842, 0.008923582119147582],
        energy: 0.365582182101014,
    },
];

#[test]
fn forces_and_energies_match_an_independent_code() {
    for reference in &REFERENCES {
        let cloud = jittered(reference.sides);
        let material = material(
            0.3,
            reference.horizon,
            reference.law,
            reference.stabilisation,
        );
        let operator = operator(&cloud, &material, reference.state);
        let u = wave(&cloud, 0.06);
        let found = force(&*operator, &u);
        let n = cloud.len();
        // The points of a cloud without a lattice are not reordered.
        for (c, expected) in reference.force.iter().enumerate() {
            let found = found[c * n + reference.point];
            assert!((found / expected - 1.0).abs() < 1e-10, "{found} {expected}");
        }
        let energy = operator.energy(0.0, &u);
        assert!((energy / reference.energy - 1.0).abs() < 1e-10, "{energy}");
    }
}

/// Q/(k² (λ + 2 G)) of longitudinal plane waves along an axis of a square lattice in plane strain, N = 3, ν =
/// 1/4, constant influence function; −Q is the force density on an interior point of the wave.
///
/// In Silling's control, the table uses the volume of 28 neighbours for the volume within the horizon,
/// whereas the reference values above use π δ²; Q is linear in the control.
#[test]
fn dispersion_of_plane_waves_matches_each_stabilisation() {
    const NONE: [f64; 5] = [0.9838, 0.659, 0.163, 0.0032, 0.0];
    const WAN: [f64; 5] = [0.99997, 0.9849, 0.8374, 0.3007, 0.0954];
    const SILLING: [f64; 5] = [1.0097, 1.181, 1.244, 0.480, 0.153];
    let cloud = lattice(&[15.0, 15.0]);
    let n = cloud.len();
    let middle = (0..n).find(|&i| cloud.point(i)[..2] == [7.5, 7.5]).unwrap();
    for (stabilisation, expected) in [
        (Stabilisation::None, NONE),
        (Stabilisation::Wan, WAN),
        (Stabilisation::Isotropic, WAN),
        (Stabilisation::Silling, SILLING),
    ] {
        let law = ElasticLaw::StVenantKirchhoff;
        let material = material(0.25, 3.0 * (1.0 + 1e-6), law, stabilisation);
        let operator = operator(&cloud, &material, StressState::PlaneStrain);
        // λ + 2 G for E = 10, ν = 1/4.
        let modulus = 12.0;
        for (number, k) in [0.1, 0.5, 1.0, 2.0, PI].into_iter().enumerate() {
            let mut direction = vec![0.0; 2 * n];
            for i in 0..n {
                direction[i] = (k * (cloud.point(i)[0] - 7.5)).cos();
            }
            let mut change = vec![0.0; 2 * n];
            operator.tangent_into(0.0, &vec![0.0; 2 * n], &direction, &mut change);
            let found = -change[middle] / (k * k * modulus);
            let more = match stabilisation {
                Stabilisation::Silling => 9.0 * PI / 28.0 - 1.0,
                _ => 0.0,
            };
            let expected = expected[number] + more * (expected[number] - NONE[number]);
            // The precision of the table.
            let error = (found - expected).abs();
            assert!(error < 6e-4, "{stabilisation:?}, {k}: {found} {expected}");
        }
    }
}
