//! Tensile strength as an input: onset of softening, strengths by direction, limits.

use pericles::PericlesError;
use pericles::family::VolumeCorrection;
use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::material::{
    BondMaterial, Calibration, ElasticModulus, Fracture, FractureCalibration, HomogeneousBonds,
    Softening, SofteningLaw, Strengths, StressState, TensileStrength,
};
use pericles::space::{Grid, PointCloud, Shape};

const LAWS: [SofteningLaw; 3] = [
    SofteningLaw::Linear,
    SofteningLaw::PETERSSON,
    SofteningLaw::Exponential,
];

const PLATE: [StressState; 2] = [StressState::PlaneStress, StressState::PlaneStrain];

/// A material with a strength: Pa, Pa, J/m², m.
#[derive(Clone, Copy)]
struct Given {
    young: f64,
    strength: f64,
    energy: f64,
    horizon: f64,
}

const CONCRETE: Given = Given {
    young: 37e9,
    strength: 3.9e6,
    energy: 143.2,
    horizon: 7.5e-3,
};

const WEAKER: Given = Given {
    young: 30e9,
    strength: 3e6,
    energy: 100.0,
    horizon: 20e-3,
};

/// Points of a lattice with N spacings per horizon.
fn cloud(state: StressState, spacing: f64) -> PointCloud {
    let shape = Shape::Box {
        origin: [0.0; 3],
        size: vec![8.0 * spacing; state.dimension()],
    };
    let section = match state {
        StressState::Spatial => 1.0,
        _ => 0.1,
    };
    let grid = Grid {
        shape,
        spacing,
        section,
        holes: vec![],
    };
    grid.points().unwrap()
}

fn material(given: Given, calibration: FractureCalibration) -> BondMaterial {
    let mut material = BondMaterial::new(ElasticModulus::Young(given.young), 1.0, given.horizon);
    material.volume_correction = VolumeCorrection::None;
    material.fracture = Fracture::Energy {
        energy: given.energy,
        calibration,
    };
    match calibration {
        FractureCalibration::Lattice => material.with_calibration(Calibration::Lattice),
        FractureCalibration::Continuum => material,
    }
}

/// The bonds of the material with δ = N Δx (1 + 1e-6), and its critical stretch.
fn bonds(material: &BondMaterial, state: StressState, ratio: f64) -> (HomogeneousBonds, f64) {
    let cloud = cloud(state, material.horizon / (ratio * (1.0 + 1e-6)));
    let constants = material.constants(&cloud, state).unwrap();
    let bonds = HomogeneousBonds::new(material, &constants, &cloud, state);
    (bonds, constants.critical_stretch)
}

/// Softening with a strength, the strengths and the critical stretch.
fn solved(
    material: &BondMaterial,
    (state, ratio): (StressState, f64),
    law: SofteningLaw,
    given: TensileStrength,
) -> (Softening, Strengths, f64) {
    let (bonds, critical) = bonds(material, state, ratio);
    let softening = bonds.softening(law, given).unwrap();
    let strengths = bonds.strengths(&softening, given.calibration).unwrap();
    (softening, strengths, critical)
}

fn near(found: f64, expected: f64, tolerance: f64, what: &str) {
    let error = found / expected - 1.0;
    assert!(
        error.abs() <= tolerance,
        "{what}: {found} instead of {expected}, relative error {error:.1e}"
    );
}

/// Reference values of an independent program with 160 samples of the strain that are not refined: A, onset, end. Their
/// error is up to 7e-4 in the strength; the tolerance is 2e-3.
#[test]
fn onset_and_end_match_reference_values() {
    use FractureCalibration::{Continuum, Lattice};
    use StressState::{PlaneStrain, PlaneStress, Spatial};
    let thick = Given {
        horizon: 30e-3,
        ..CONCRETE
    };
    let [linear, trilinear, exponential] = LAWS;
    let cases = [
        (
            PlaneStress,
            Continuum,
            linear,
            CONCRETE,
            [119.801, 7.7552e-5, 9.2908e-3],
        ),
        (
            PlaneStress,
            Continuum,
            trilinear,
            CONCRETE,
            [114.565, 7.9305e-5, 1.62905e-2],
        ),
        (
            PlaneStress,
            Continuum,
            exponential,
            CONCRETE,
            [112.936, 7.9874e-5, 2.08749e-2],
        ),
        (
            PlaneStrain,
            Continuum,
            linear,
            WEAKER,
            [41.764, 7.2276e-5, 3.01852e-3],
        ),
        (
            Spatial,
            Continuum,
            linear,
            WEAKER,
            [37.084, 6.1199e-5, 2.26947e-3],
        ),
        (
            Spatial,
            Continuum,
            trilinear,
            thick,
            [21.510, 7.0696e-5, 2.68071e-3],
        ),
        (
            PlaneStress,
            Lattice,
            linear,
            CONCRETE,
            [130.987, 7.4300e-5, 9.7324e-3],
        ),
        (
            PlaneStress,
            Lattice,
            trilinear,
            CONCRETE,
            [126.582, 7.5582e-5, 1.71607e-2],
        ),
        (
            Spatial,
            Lattice,
            exponential,
            WEAKER,
            [34.658, 6.2977e-5, 4.9931e-3],
        ),
    ];
    for (state, calibration, law, given, [ratio, onset, end]) in cases {
        let strength = TensileStrength {
            strength: given.strength,
            calibration,
        };
        let (softening, strengths, critical) =
            solved(&material(given, calibration), (state, 3.0), law, strength);
        let what = format!("{state:?} {calibration:?} {law:?}");
        near(softening.onset, onset, 2e-3, &what);
        near(softening.curve(critical).unwrap().end(), end, 2e-3, &what);
        near(strengths.ratio, ratio, 4e-3, &what);
        near(strengths.tensile, given.strength, 1e-8, &what);
    }
}

/// Strengths of the lattice along directions, MPa, of the same program.
#[test]
fn strengths_by_direction_match_reference_values() {
    let [linear, trilinear, exponential] = LAWS;
    let calibration = FractureCalibration::Lattice;
    let cases: [(_, _, _, &[(&str, f64)]); 3] = [
        (
            StressState::PlaneStress,
            linear,
            CONCRETE,
            &[("0", 3.907e6), ("45", 3.893e6)],
        ),
        (
            StressState::PlaneStress,
            trilinear,
            CONCRETE,
            &[("0", 3.863e6), ("45", 3.937e6)],
        ),
        (
            StressState::Spatial,
            exponential,
            WEAKER,
            &[("100", 2.980e6), ("110", 2.982e6), ("111", 3.038e6)],
        ),
    ];
    for (state, law, given, expected) in cases {
        let strength = TensileStrength {
            strength: given.strength,
            calibration,
        };
        let (_, strengths, _) = solved(&material(given, calibration), (state, 3.0), law, strength);
        for (name, value) in expected {
            let found = strengths
                .by_direction
                .iter()
                .find(|(known, _)| known == name);
            near(
                found.unwrap().1,
                *value,
                2e-3,
                &format!("{state:?} {law:?} {name}"),
            );
        }
    }
}

/// Φ at 0°, 22.5° and 45° of the same program: horizons of 3, 4 and 6 spacings, linear law.
#[test]
fn lattice_anisotropy_of_the_strength_matches_reference_values() {
    let cases = [
        (3.0, VolumeCorrection::None, 2.0, [1.023, 1.114, 0.994]),
        (3.0, VolumeCorrection::None, 10.0, [1.236, 1.185, 1.262]),
        (3.0, VolumeCorrection::None, 50.0, [1.371, 1.260, 1.398]),
        (4.0, VolumeCorrection::Linear, 10.0, [1.178, 1.181, 1.211]),
        (4.0, VolumeCorrection::Linear, 50.0, [1.317, 1.301, 1.345]),
        (6.0, VolumeCorrection::None, 10.0, [1.173, 1.182, 1.190]),
    ];
    for (ratio, correction, square, expected) in cases {
        let mut material = material(CONCRETE, FractureCalibration::Lattice);
        material.volume_correction = correction;
        let (bonds, critical) = bonds(&material, StressState::PlaneStress, ratio);
        let softening = Softening {
            law: SofteningLaw::Linear,
            onset: critical / f64::sqrt(square),
        };
        let found = bonds
            .strengths(&softening, FractureCalibration::Lattice)
            .unwrap();
        let unit = CONCRETE.young * softening.onset;
        for ((name, strength), expected) in found.by_direction.iter().zip(expected) {
            near(
                strength / unit,
                expected,
                2e-3,
                &format!("N {ratio} A {square}, {name}"),
            );
        }
    }
}

/// Strengths over E s_e of isotropic materials, printed with four digits: uniaxial, equibiaxial, shear, hydrostatic.
#[test]
fn multiaxial_strengths_match_reference_values() {
    let plane = [
        (2.0, [1.0346, 1.5, 0.790]),
        (10.0, [1.1828, 1.5, 0.976]),
        (50.0, [1.3090, 1.5, 1.161]),
        (200.0, [1.3829, 1.5, 1.283]),
    ];
    let spatial = [
        (2.0, [1.1434, 1.375, 0.934]),
        (10.0, [1.4449, 1.555, 1.249]),
        (50.0, [1.6692, 1.714, 1.522]),
        (200.0, [1.7975, 1.812, 1.695]),
    ];
    let cases = [
        (StressState::PlaneStress, plane),
        (StressState::Spatial, spatial),
    ];
    for (state, rows) in cases {
        for (square, expected) in rows {
            let strengths = isotropic(state, SofteningLaw::Linear, square);
            let found = [
                strengths.tensile,
                strengths.equibiaxial.unwrap(),
                strengths.shear.unwrap(),
            ];
            for (found, expected) in found.into_iter().zip(expected) {
                near(found, expected, 1e-3, &format!("{state:?} A {square}"));
            }
        }
    }
}

/// Strengths over E s_e of a body without a lattice.
fn isotropic(state: StressState, law: SofteningLaw, square: f64) -> Strengths {
    let given = Given {
        young: 1.0,
        ..CONCRETE
    };
    let material =
        material(given, FractureCalibration::Continuum).with_critical_stretch(square.sqrt());
    let spacing = given.horizon / 3.0;
    let listed = listed(state, spacing);
    let constants = material.constants(&listed, state).unwrap();
    let bonds = HomogeneousBonds::new(&material, &constants, &listed, state);
    let softening = Softening { law, onset: 1.0 };
    bonds
        .strengths(&softening, FractureCalibration::Continuum)
        .unwrap()
}

/// Points without a lattice.
fn listed(state: StressState, spacing: f64) -> PointCloud {
    let grid = cloud(state, spacing);
    let (n, d) = (grid.len(), state.dimension());
    let positions = (0..d).flat_map(|c| grid.axis(c).to_vec()).collect();
    PointCloud::new(d, positions, vec![spacing.powi(d as i32); n], 1.0).unwrap()
}

/// Bonds of a dilation are all alike, plane strain is plane stress with 16/15 of the stiffness, and a brittle material
/// has the strength E s_e.
#[test]
fn strengths_satisfy_exact_identities() {
    for law in LAWS {
        for square in [1.5, 12.0, 300.0] {
            let [stress, strain] = PLATE.map(|state| isotropic(state, law, square));
            let spatial = isotropic(StressState::Spatial, law, square);
            let bar = isotropic(StressState::Uniaxial, law, square);
            let what = format!("{law:?} A {square}");
            near(strain.tensile, 16.0 / 15.0 * stress.tensile, 1e-12, &what);
            near(
                strain.shear.unwrap(),
                16.0 / 15.0 * stress.shear.unwrap(),
                1e-12,
                &what,
            );
            near(stress.equibiaxial.unwrap(), 1.5, 1e-12, &what);
            near(strain.equibiaxial.unwrap(), 1.6, 1e-12, &what);
            near(spatial.hydrostatic.unwrap(), 2.0, 1e-10, &what);
            near(bar.tensile, 1.0, 1e-12, &what);
            assert!(stress.tensile > 1.0 && stress.tensile < 1.5, "{what}");
            assert!(
                spatial.tensile > stress.tensile && spatial.tensile < 2.0,
                "{what}"
            );
            near(stress.linear_limit, 1.0, 1e-12, &what);
            near(spatial.linear_limit, 1.0, 1e-9, &what);
        }
        for (state, limit) in [
            (StressState::PlaneStress, 1.0),
            (StressState::PlaneStrain, 16.0 / 15.0),
            (StressState::Spatial, 1.0),
        ] {
            let strengths = isotropic(state, law, 1.0 + 1e-6);
            near(
                strengths.tensile,
                limit,
                3e-5,
                &format!("{state:?} {law:?}"),
            );
            near(
                strengths.linear_limit,
                limit,
                1e-9,
                &format!("{state:?} {law:?}"),
            );
        }
    }
}

/// The strength by integrals does not depend on the influence function, and h = κ Φ²/A with κ = E δ s₀²/G.
#[test]
fn every_influence_function_gives_the_strength() {
    let functions = [
        InfluenceFunction::Constant,
        InfluenceFunction::Conical,
        InfluenceFunction::Inverse,
        InfluenceFunction::Gaussian {
            length: 3e-3,
            cutoff: None,
        },
    ];
    for function in functions {
        for acts_on in [ActsOn::Stretch, ActsOn::Displacement] {
            for calibration in [FractureCalibration::Continuum, FractureCalibration::Lattice] {
                let influence = Influence {
                    function: function.clone(),
                    acts_on,
                };
                let material = material(CONCRETE, calibration).with_influence(influence);
                let given = TensileStrength {
                    strength: CONCRETE.strength,
                    calibration,
                };
                let place = (StressState::PlaneStress, 4.0);
                let (softening, strengths, critical) =
                    solved(&material, place, SofteningLaw::Linear, given);
                let what = format!("{function:?} {acts_on:?} {calibration:?}");
                let phi = CONCRETE.strength / (CONCRETE.young * softening.onset);
                near(
                    strengths.ratio,
                    (critical / softening.onset).powi(2),
                    1e-12,
                    &what,
                );
                if calibration == FractureCalibration::Continuum {
                    let same = isotropic(place.0, SofteningLaw::Linear, strengths.ratio).tensile;
                    near(phi, same, 1e-8, &what);
                } else {
                    // The mean over the planes (10) and (11).
                    let of = |k: usize| strengths.by_direction[k].1;
                    near(0.5 * (of(0) + of(2)), CONCRETE.strength, 1e-8, &what);
                }
            }
        }
    }
}

/// κ Φ(1)² E G/f_t², with κ = 4π/9 for integrals in plane stress.
#[test]
fn a_strength_above_that_of_the_brittle_material_names_the_largest_horizon() {
    let glass = Given {
        young: 72e9,
        strength: 60e6,
        energy: 8.0,
        horizon: 0.3e-3,
    };
    let calibration = FractureCalibration::Continuum;
    let strength = TensileStrength {
        strength: glass.strength,
        calibration,
    };
    let kappa = 4.0 * std::f64::consts::PI / 9.0;
    let largest = kappa * glass.young * glass.energy / glass.strength.powi(2);
    let state = StressState::PlaneStress;
    for law in LAWS {
        let (bonds, critical) = bonds(&material(glass, calibration), state, 3.0);
        let error = bonds.softening(law, strength).unwrap_err();
        let PericlesError::Strength(found) = error else {
            panic!("{error}");
        };
        near(found.largest_horizon, largest, 1e-9, "largest horizon");
        near(
            found.brittle,
            glass.young * critical,
            1e-9,
            "brittle strength",
        );
        let message = found.to_string();
        for part in ["60 MPa", "223.4 µm", "300 µm"] {
            assert!(message.contains(part), "{message}");
        }
        // Just below the limit softening gives the strength, just above it does not.
        for (part, is_given) in [(1.0 - 1e-3, true), (1.0 + 1e-3, false)] {
            let given = Given {
                horizon: part * largest,
                ..glass
            };
            let (bonds, _) = self::bonds(&material(given, calibration), state, 3.0);
            let found = bonds.softening(law, strength);
            assert_eq!(found.is_ok(), is_given, "{part} {law:?}");
            if let Ok(softening) = found {
                let strengths = bonds.strengths(&softening, calibration).unwrap();
                near(
                    strengths.tensile,
                    glass.strength,
                    1e-8,
                    "strength near the limit",
                );
                near(strengths.largest_horizon, largest, 1e-8, "largest horizon");
            }
        }
    }
}

/// A = s₀²/s_e² with the given critical stretch.
#[test]
fn a_given_critical_stretch_determines_the_softening() {
    for calibration in [FractureCalibration::Continuum, FractureCalibration::Lattice] {
        let material = material(CONCRETE, calibration).with_critical_stretch(4e-4);
        let given = TensileStrength {
            strength: CONCRETE.strength,
            calibration,
        };
        let place = (StressState::PlaneStrain, 3.0);
        let (softening, strengths, _) = solved(&material, place, SofteningLaw::Exponential, given);
        near(
            strengths.ratio,
            (4e-4 / softening.onset).powi(2),
            1e-12,
            "ratio",
        );
        near(strengths.tensile, CONCRETE.strength, 1e-8, "strength");
    }
}

/// In a bar all bonds have the same stretch: s_e = f_t/E.
#[test]
fn the_onset_in_a_bar_is_the_strength_over_the_modulus() {
    for law in LAWS {
        for calibration in [FractureCalibration::Continuum, FractureCalibration::Lattice] {
            let given = TensileStrength {
                strength: CONCRETE.strength,
                calibration,
            };
            let material = material(CONCRETE, calibration);
            let (softening, _, _) = solved(&material, (StressState::Uniaxial, 3.0), law, given);
            let onset = CONCRETE.strength / CONCRETE.young;
            near(softening.onset, onset, 1e-9, &format!("{law:?}"));
        }
    }
}

#[test]
fn strengths_out_of_range_and_unbreakable_bonds_are_errors() {
    let calibration = FractureCalibration::Lattice;
    let mut material = material(CONCRETE, calibration);
    let rejected = |material: &BondMaterial, strength: f64, word: &str| {
        let (bonds, _) = self::bonds(material, StressState::PlaneStress, 3.0);
        let given = TensileStrength {
            strength,
            calibration,
        };
        let error = bonds.softening(SofteningLaw::Linear, given).unwrap_err();
        assert!(error.to_string().contains(word), "{error}");
    };
    rejected(&material, 0.0, "positive");
    rejected(&material, f64::NAN, "positive");
    // Four neighbours have no stiffness against tension along the diagonals.
    let (bonds, _) = bonds(&material, StressState::PlaneStress, 1.0);
    let given = TensileStrength {
        strength: 1e6,
        calibration,
    };
    let error = bonds.softening(SofteningLaw::Linear, given).unwrap_err();
    assert!(error.to_string().contains("two spacings"), "{error}");
    let softening = Softening {
        law: SofteningLaw::Linear,
        onset: 1e-5,
    };
    // Reports of such lattices do not panic.
    bonds.strengths(&softening, calibration).unwrap();
    material.fracture = Fracture::Unbreakable;
    rejected(&material, 1e6, "fracture energy");
}
