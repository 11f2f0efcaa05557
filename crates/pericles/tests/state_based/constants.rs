//! Constants of solids on lattices compared with tables computed independently.

use std::f64::consts::PI;

use crate::bodies::solid;
use pericles::PericlesError;
use pericles::family::VolumeCorrection;
use pericles::kernel::{Influence, InfluenceFunction};
use pericles::material::{
    BondFailure, CrackPlane, FractureCalibration, IsotropicInfluence, LatticeShear, LinearSolid,
    StateInfluence, StressState, StretchDefinition,
};

fn influence(function: InfluenceFunction) -> Influence {
    Influence {
        function,
        ..Influence::default()
    }
}

/// Shear stiffness along axes and diagonals divided by G at δ = (N + 0.015) Δx, to the four digits of the table;
/// the dilatation is exact.
#[test]
fn shear_stiffness_of_lattices_equals_the_table() {
    let (none, linear) = (VolumeCorrection::None, VolumeCorrection::Linear);
    let cases = [
        (3, 3, InfluenceFunction::Constant, none, [1.1102, 0.8347]),
        (3, 3, InfluenceFunction::Constant, linear, [1.0845, 0.8732]),
        (3, 3, InfluenceFunction::Inverse, linear, [1.0600, 0.9100]),
        (3, 3, InfluenceFunction::Conical, none, [1.0019, 0.9972]),
        (3, 4, InfluenceFunction::Constant, none, [1.0191, 0.9714]),
        (3, 4, InfluenceFunction::Constant, linear, [1.0242, 0.9637]),
        (3, 4, InfluenceFunction::Inverse, linear, [1.0168, 0.9748]),
        (3, 4, InfluenceFunction::Conical, none, [1.0082, 0.9877]),
        (2, 3, InfluenceFunction::Constant, none, [0.9647, 1.0353]),
        (2, 3, InfluenceFunction::Constant, linear, [1.0242, 0.9758]),
        (2, 3, InfluenceFunction::Inverse, linear, [1.0051, 0.9949]),
        (2, 3, InfluenceFunction::Conical, none, [1.0356, 0.9644]),
        (2, 4, InfluenceFunction::Constant, none, [0.9532, 1.0468]),
        (2, 4, InfluenceFunction::Constant, linear, [1.0187, 0.9813]),
        (2, 4, InfluenceFunction::Inverse, linear, [1.0095, 0.9905]),
        (2, 4, InfluenceFunction::Conical, none, [1.0241, 0.9759]),
        (2, 6, InfluenceFunction::Constant, none, [1.0341, 0.9659]),
        (2, 6, InfluenceFunction::Constant, linear, [1.0393, 0.9607]),
        (2, 6, InfluenceFunction::Inverse, linear, [1.0274, 0.9726]),
        (2, 6, InfluenceFunction::Conical, none, [1.0102, 0.9898]),
    ];
    for (dimension, spacings, function, correction, [axes, diagonals]) in cases {
        let dx = 2e-3;
        let horizon = (f64::from(spacings) + 0.015) * dx;
        let sides = vec![dx; dimension];
        let name = format!("{dimension}D, {spacings}, {function:?}, {correction:?}");
        let shear = LatticeShear::of(&sides, &influence(function), horizon, correction).unwrap();
        assert!((shear.axes - axes).abs() < 6e-5, "{name}: {shear:?}");
        assert!(
            (shear.diagonals - diagonals).abs() < 6e-5,
            "{name}: {shear:?}"
        );
        let mean = match dimension {
            3 => (3.0 * shear.axes + 2.0 * shear.diagonals) / 5.0,
            _ => (shear.axes + shear.diagonals) / 2.0,
        };
        assert!((mean - 1.0).abs() < 1e-14, "{name}: {mean}");
    }
}

/// c at δ = N Δx, to the six digits of the table; shear stiffnesses then equal those of the solid.
#[test]
fn the_isotropic_influence_function_equals_the_table() {
    let (none, linear) = (VolumeCorrection::None, VolumeCorrection::Linear);
    let cases = [
        (2, none, [0.972200, 0.840501, 0.899245, 1.003997, 1.061526]),
        (
            2,
            linear,
            [0.920993, 1.130157, 1.247754, 1.006401, 1.020997],
        ),
        (3, none, [0.898781, 0.997459, 1.081682, 1.013780, 1.004169]),
        (
            3,
            linear,
            [-2.467883, 0.985808, 1.012116, 0.989999, 0.988147],
        ),
    ];
    for (dimension, correction, coefficients) in cases {
        for (spacings, expected) in (2..).zip(coefficients) {
            let dx = 1e-3;
            let horizon = f64::from(spacings) * dx * (1.0 + 1e-6);
            let sides = vec![dx; dimension];
            let isotropic = IsotropicInfluence::of_lattice(&sides, horizon, correction).unwrap();
            let c = isotropic.coefficient();
            let name = format!("{dimension}D, {spacings}, {correction:?}: {c}");
            assert!((c - expected).abs() < 3e-6, "{name}");
            assert_eq!(isotropic.is_signed(), c > 1.0, "{name}");
            let shear =
                LatticeShear::of(&sides, &isotropic.influence(), horizon, correction).unwrap();
            assert!(shear.anisotropy() < 1e-13, "{name}: {shear:?}");
        }
    }
}

fn cubes(dimension: usize) -> Vec<f64> {
    vec![1e-3; dimension]
}

#[test]
fn lattices_without_an_isotropic_function_are_errors() {
    let (dx, state) = (1e-3, StressState::PlaneStrain);
    let make = |spacings: f64, correction, failure| LinearSolid {
        influence: StateInfluence::Isotropic,
        volume_correction: correction,
        failure,
        ..solid(
            0.3,
            spacings * dx * (1.0 + 1e-6),
            InfluenceFunction::Constant,
        )
    };
    let breakable = BondFailure::CriticalStretch(0.01);
    let constants = |material: LinearSolid| material.constants_on(&cubes(2), 1.0, state);
    // c = 0.84, then 1.13.
    assert!(constants(make(3.0, VolumeCorrection::None, breakable)).is_ok());
    let rejected = constants(make(3.0, VolumeCorrection::Linear, breakable)).unwrap_err();
    assert!(
        rejected.to_string().contains("negative near the horizon"),
        "{rejected}"
    );
    let unbreakable = make(3.0, VolumeCorrection::Linear, BondFailure::Unbreakable);
    assert!(constants(unbreakable).is_ok());
    let bar = make(3.0, VolumeCorrection::None, breakable);
    let rejected = bar.constants_on(&cubes(1), 1.0, StressState::Uniaxial);
    assert!(
        rejected
            .unwrap_err()
            .to_string()
            .contains("a bar has no shear")
    );
    let flat = bar.constants_on(&[1e-3, 2e-3], 1.0, state);
    assert!(
        flat.unwrap_err()
            .to_string()
            .contains("square or cubic cells")
    );
}

const ENERGY: f64 = 135.0;

fn with_failure(
    function: InfluenceFunction,
    spacings: f64,
    correction: VolumeCorrection,
    nu: f64,
    failure: BondFailure,
) -> LinearSolid {
    LinearSolid {
        volume_correction: correction,
        failure,
        ..solid(nu, spacings * 1e-3 * (1.0 + 1e-6), function)
    }
}

fn stretch(definition: StretchDefinition, calibration: FractureCalibration) -> BondFailure {
    BondFailure::Stretch {
        fracture_energy: ENERGY,
        definition,
        calibration,
    }
}

fn bond_energy(calibration: FractureCalibration) -> BondFailure {
    BondFailure::BondEnergy {
        fracture_energy: ENERGY,
        calibration,
    }
}

/// Closed forms of the continuum, with the numbers for w = 1/r in three dimensions: P₁ = δ/5, P₂ = 26 δ/405.
#[test]
fn failure_limits_equal_the_continuum() {
    let horizon = 3e-3 * (1.0 + 1e-6);
    let limits = |nu: f64, failure| {
        let function = InfluenceFunction::Inverse;
        let material = with_failure(function, 3.0, VolumeCorrection::None, nu, failure);
        material
            .constants_on(&cubes(3), 1.0, StressState::Spatial)
            .unwrap()
            .limits
    };
    let continuum = FractureCalibration::Continuum;
    for nu in [0.1, 0.25, 0.4] {
        let (bulk, shear) = (10.0 / (3.0 * (1.0 - 2.0 * nu)), 10.0 / (2.0 * (1.0 + nu)));
        let (a, b) = (3.0 * bulk - 5.0 * shear, 15.0 * shear);
        let (first, second) = (horizon / 5.0, 26.0 * horizon / 405.0);
        for (definition, unit) in [
            (StretchDefinition::Bond, b * first),
            (StretchDefinition::Closing, b * first + 3.0 * a * second),
            (
                StretchDefinition::Isotropic,
                b * first + 3.0 * a * (2.0 * first - second),
            ),
        ] {
            let found = limits(nu, stretch(definition, continuum)).stretch;
            let expected = (ENERGY / unit).sqrt();
            assert!(
                (found / expected - 1.0).abs() < 1e-12,
                "{nu}, {definition:?}"
            );
        }
        // 4 G₀/(π δ⁴), for every influence function and Poisson's ratio.
        let found = limits(nu, bond_energy(continuum)).energy;
        let expected = 4.0 * ENERGY / (PI * horizon.powi(4));
        assert!((found / expected - 1.0).abs() < 1e-12);
    }
    // For A = 0: G₀ = 3 G δ s₀².
    let found = limits(0.25, stretch(StretchDefinition::Closing, continuum)).stretch;
    let expected = (ENERGY / (3.0 * 4.0 * horizon)).sqrt();
    assert!((found / expected - 1.0).abs() < 1e-12);
}

/// Energy of a crack along (100) with the limits of the continuum, relative to the given fracture energy, for ν =
/// 1/4 (A = 0), where the definitions agree: to the three digits of an independent computation.
#[test]
fn fracture_energies_along_lattice_planes_equal_the_reference() {
    let closing = stretch(StretchDefinition::Closing, FractureCalibration::Continuum);
    let energy = bond_energy(FractureCalibration::Continuum);
    let (none, linear) = (VolumeCorrection::None, VolumeCorrection::Linear);
    let (constant, conical) = (InfluenceFunction::Constant, InfluenceFunction::Conical);
    let cases = [
        (3, constant.clone(), none, closing, 1.031),
        (3, conical, none, closing, 0.944),
        (3, constant.clone(), none, energy, 1.100),
        (3, constant.clone(), linear, energy, 0.878),
        (2, constant.clone(), none, closing, 0.982),
        (2, constant.clone(), none, energy, 1.000),
        (2, constant, linear, energy, 0.844),
    ];
    for (dimension, function, correction, failure, expected) in cases {
        let state = match dimension {
            3 => StressState::Spatial,
            _ => StressState::PlaneStrain,
        };
        let material = with_failure(function, 3.0, correction, 0.25, failure);
        let constants = material
            .constants_on(&cubes(dimension), 1.0, state)
            .unwrap();
        let ratio = constants.crack_planes[0].energy() / ENERGY;
        assert!(
            (ratio - expected).abs() < 6e-4,
            "{dimension}, {failure:?}: {ratio}"
        );
        assert!((constants.fracture_energy / ENERGY - 1.0).abs() < 1e-13);
    }
}

#[test]
fn the_mean_over_planes_equals_the_fracture_energy() {
    let lattice = FractureCalibration::Lattice;
    let failures = [
        stretch(StretchDefinition::Closing, lattice),
        stretch(StretchDefinition::Bond, lattice),
        stretch(StretchDefinition::Isotropic, lattice),
        bond_energy(lattice),
    ];
    for failure in failures {
        for nu in [0.2, 0.4] {
            for (dimension, state) in [
                (1, StressState::Uniaxial),
                (2, StressState::PlaneStress),
                (2, StressState::PlaneStrain),
                (3, StressState::Spatial),
            ] {
                // The limits refer to a section of 1; the limits of bonds are per section.
                for section in [1.0, 0.2] {
                    let function = InfluenceFunction::Conical;
                    let correction = VolumeCorrection::Extended;
                    let material = with_failure(function, 3.0, correction, nu, failure);
                    let section = if dimension == 3 { 1.0 } else { section };
                    let constants = material.constants_on(&cubes(dimension), section, state);
                    let constants = constants.unwrap();
                    let mean = CrackPlane::mean(&constants.crack_planes);
                    assert!((mean / ENERGY - 1.0).abs() < 1e-13, "{failure:?}");
                    assert_eq!(constants.fracture_calibration, Some(lattice));
                }
            }
        }
    }
}

/// The conical function vanishes at the horizon of three spacings: bonds of that length never break and are
/// not counted. The remaining bonds belong to a shorter horizon.
#[test]
fn bonds_without_force_are_not_counted_for_the_bond_energy() {
    let failure = bond_energy(FractureCalibration::Lattice);
    let critical = |function: &InfluenceFunction, spacings: f64| {
        let none = VolumeCorrection::None;
        let material = with_failure(function.clone(), spacings, none, 0.3, failure);
        let constants = material.constants_on(&cubes(3), 1.0, StressState::Spatial);
        constants.unwrap().limits.energy
    };
    let (constant, conical) = (InfluenceFunction::Constant, InfluenceFunction::Conical);
    let shorter = critical(&constant, 2.9);
    assert!((critical(&conical, 3.0) / shorter - 1.0).abs() < 1e-13);
    assert!(critical(&constant, 3.0) < 0.99 * shorter);
    // Slightly beyond three spacings they carry force.
    let longer = critical(&conical, 3.01);
    assert!((longer / critical(&constant, 3.01) - 1.0).abs() < 1e-13);
}

#[test]
fn failure_criteria_without_a_critical_stretch_are_errors() {
    // At ν = −0.9 the dilatational part exceeds the rest in the isotropic definition.
    let failure = stretch(StretchDefinition::Isotropic, FractureCalibration::Continuum);
    let function = InfluenceFunction::Constant;
    let material = with_failure(function, 3.0, VolumeCorrection::None, -0.9, failure);
    let rejected = material.constants_on(&cubes(3), 1.0, StressState::Spatial);
    assert!(matches!(
        rejected,
        Err(PericlesError::ElasticConstants { .. })
    ));
    let failure = BondFailure::CriticalStretch(-0.1);
    let function = InfluenceFunction::Tabulated {
        table: vec![(0.0, 1.0), (3e-3, -0.1)],
    };
    let bad = with_failure(
        InfluenceFunction::Constant,
        3.0,
        VolumeCorrection::None,
        0.3,
        failure,
    );
    assert!(
        bad.constants_on(&cubes(3), 1.0, StressState::Spatial)
            .is_err()
    );
    let failure = BondFailure::CriticalStretch(0.1);
    let signed = with_failure(function, 3.0, VolumeCorrection::None, 0.3, failure);
    let rejected = signed.constants_on(&cubes(3), 1.0, StressState::Spatial);
    assert!(matches!(rejected, Err(PericlesError::BadInfluence { .. })));
}
