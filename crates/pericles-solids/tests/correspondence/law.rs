//! Elastic laws.

use pericles::material::StressState;
use pericles_solids::correspondence::{ClassicalSolid, ElasticLaw, History, Moduli, Plasticity};

use crate::anisotropy::{in_plane, oblique};

const F: [[f64; 3]; 3] = [[1.1, 0.05, -0.02], [0.03, 0.95, 0.04], [0.01, -0.06, 1.02]];
const PLANE: [[f64; 2]; 2] = [[1.1, 0.05], [0.03, 0.95]];

fn solid(law: ElasticLaw, state: StressState) -> ClassicalSolid {
    ClassicalSolid {
        state,
        law,
        moduli: Moduli::new(11.3, 4.7),
        plasticity: None,
    }
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found / expected - 1.0).abs() < tolerance,
        "found {found}, expected {expected}"
    );
}

/// The first reference values have eight and ten digits only.
#[test]
fn energies_and_stresses_match_an_independent_code() {
    let rest = History::default();
    for (law, energy, stress, tolerance) in [
        (ElasticLaw::StVenantKirchhoff, 0.1088216595, 1.8389979, 1e-8),
        (
            ElasticLaw::NeoHooke,
            0.09207327085489175,
            1.375964051191175,
            1e-10,
        ),
        (
            ElasticLaw::NeoHookeSplit,
            0.08912073465837561,
            1.304409800364757,
            1e-10,
        ),
    ] {
        let found = solid(law, StressState::Spatial).stress(&F, &rest);
        close(found.energy, energy, tolerance);
        close(found.stress[0][0], stress, tolerance);
    }
    for (law, across, stress) in [
        (
            ElasticLaw::StVenantKirchhoff,
            0.9726862782138067,
            1.388542359582544,
        ),
        (ElasticLaw::NeoHooke, 0.9801919848589736, 1.058963774924176),
        (
            ElasticLaw::NeoHookeSplit,
            0.9827096998130017,
            1.020569348168519,
        ),
    ] {
        let found = solid(law, StressState::PlaneStress).stress(&PLANE, &rest);
        close(found.across, across, 1e-12);
        close(found.stress[0][0], stress, 1e-10);
    }
}

/// All laws, an anisotropic solid, and a plastic solid that continues to yield.
fn solids(state: StressState) -> Vec<(ClassicalSolid, History)> {
    let laws = [
        ElasticLaw::StVenantKirchhoff,
        ElasticLaw::NeoHooke,
        ElasticLaw::NeoHookeSplit,
        ElasticLaw::Hencky,
    ];
    let mut solids: Vec<_> = laws
        .into_iter()
        .map(|law| (solid(law, state), History::default()))
        .collect();
    let stiffness = match state {
        StressState::Uniaxial => None,
        StressState::Spatial => Some(oblique()),
        _ => Some(in_plane(0.4)),
    };
    solids.extend(stiffness.map(|stiffness| {
        let anisotropic = ClassicalSolid {
            moduli: Moduli::anisotropic(stiffness),
            ..solid(ElasticLaw::StVenantKirchhoff, state)
        };
        (anisotropic, History::default())
    }));
    let yielding = ClassicalSolid {
        plasticity: Some(Plasticity {
            yield_stress: 0.3,
            hardening: 0.7,
        }),
        ..solid(ElasticLaw::Hencky, state)
    };
    let (history, work) = match state {
        StressState::Uniaxial => yielding.advanced(&[[1.06]], &History::default()),
        StressState::Spatial => yielding.advanced(
            &[[1.04, 0.02, 0.0], [0.0, 0.99, 0.03], [0.01, 0.0, 0.97]],
            &History::default(),
        ),
        _ => yielding.advanced(&[[1.04, 0.02], [0.0, 0.99]], &History::default()),
    };
    assert!(work > 0.0 && history.accumulated > 0.0);
    solids.push((yielding, history));
    solids
}

fn derivatives_agree<const D: usize>(state: StressState, f: [[f64; D]; D]) {
    let direction: [[f64; D]; D] = std::array::from_fn(|a| {
        std::array::from_fn(|b| (1.3 * a as f64 + 0.7 * b as f64 + 0.4).sin())
    });
    let moved = |by: f64| -> [[f64; D]; D] {
        std::array::from_fn(|a| std::array::from_fn(|b| f[a][b] + by * direction[a][b]))
    };
    let h = 1e-5;
    for (solid, history) in solids(state) {
        let [plus, minus] = [h, -h].map(|by| solid.stress(&moved(by), &history));
        let here = solid.stress(&f, &history);
        let change = solid.stress_change(&f, &direction, &history);
        // A yielding body stores less than the work.
        if solid.plasticity.is_none() {
            let power: f64 = (0..D * D)
                .map(|k| here.stress[k / D][k % D] * direction[k / D][k % D])
                .sum();
            let difference = (plus.energy - minus.energy) / (2.0 * h);
            assert!(
                (difference - power).abs() < 1e-8,
                "{solid:?}: {difference} {power}"
            );
        }
        for k in 0..D * D {
            let (a, b) = (k / D, k % D);
            let difference = (plus.stress[a][b] - minus.stress[a][b]) / (2.0 * h);
            let error = (difference - change[a][b]).abs();
            assert!(
                error < 2e-7,
                "{solid:?}, {a} {b}: {difference} {}",
                change[a][b]
            );
        }
    }
}

/// Errors of central differences with the step 1e-5 are about 1e-9.
#[test]
fn stresses_are_energy_derivatives_and_tangents_are_stress_derivatives() {
    derivatives_agree(StressState::Spatial, F);
    derivatives_agree(StressState::PlaneStrain, PLANE);
    derivatives_agree(StressState::PlaneStress, PLANE);
    derivatives_agree(StressState::Uniaxial, [[1.1]]);
}

#[test]
fn all_laws_reduce_to_linear_elasticity_at_small_strain() {
    let rest = History::default();
    let strain = [[1.0, 0.3], [0.3, -0.5]];
    for state in [StressState::PlaneStrain, StressState::PlaneStress] {
        for (solid, _) in solids(state) {
            let linear = solid.linear_stress(&strain);
            let found = solid.stress_change(&[[1.0, 0.0], [0.0, 1.0]], &strain, &rest);
            for k in 0..4 {
                let (a, b) = (k / 2, k % 2);
                assert!((found[a][b] - linear[a][b]).abs() < 1e-12, "{solid:?}");
            }
        }
    }
}

/// The energies of some laws are differences of large terms, which must not cancel.
#[test]
fn energies_at_small_strain_equal_those_of_linear_elasticity() {
    let rest = History::default();
    let strain = [[1e-6, 3e-7], [3e-7, -5e-7]];
    for (solid, _) in solids(StressState::PlaneStrain) {
        let linear = solid.linear_stress(&strain);
        let energy: f64 = (0..4)
            .map(|k| 0.5 * linear[k / 2][k % 2] * strain[k / 2][k % 2])
            .sum();
        let f = [
            [1.0 + strain[0][0], strain[0][1]],
            [strain[1][0], 1.0 + strain[1][1]],
        ];
        let found = solid.stress(&f, &rest).energy;
        // The laws differ by terms of third order.
        assert!(
            (found / energy - 1.0).abs() < 1e-5,
            "{solid:?}: {found} {energy}"
        );
        let half = [[1.0 + 5e-7, 1.5e-7], [1.5e-7, 1.0 - 2.5e-7]];
        let quarter = solid.stress(&half, &rest).energy;
        assert!((4.0 * quarter / found - 1.0).abs() < 1e-5, "{solid:?}");
    }
}

#[test]
fn stress_of_inverted_points_is_nan() {
    let inverted = [[-0.2, 0.0], [0.0, 1.0]];
    for state in [StressState::PlaneStrain, StressState::PlaneStress] {
        for (solid, history) in solids(state) {
            assert!(
                solid.stress(&inverted, &history).energy.is_nan(),
                "{solid:?}"
            );
        }
    }
}
