//! Plane waves of the analysis compared with the force operators, in space and in the time domain; influence
//! functions tuned against dispersion.

use std::sync::Arc;

use pericles::family::{BondList, VolumeCorrection};
use pericles::kernel::{ActsOn, ClassTable, Influence, InfluenceFunction};
use pericles::material::{
    BondMaterial, Calibration, ElasticModulus, Fracture, FractureCalibration, LinearBond, Modulus,
    PairLaw, StressState,
};
use pericles::operator::{BondBody, BondForce, BondForm, DamageMeasure, Force, PointSubset};
use pericles::space::{Grid, PointCloud, Shape};
use pericles_dispersion::spectrum::{PeriodicForce, SpectrumRun, measure};
use pericles_dispersion::tuning::{
    Method, ScalingModel, Tuning, continuum_speeds, fit_cosines, influence_alebrahim, polygon,
};
use pericles_dispersion::{BondLattice, Contour, long_wave_speeds};

const DX: f64 = 0.25e-3;

fn glass(
    function: InfluenceFunction,
    calibration: Calibration,
    fracture: Fracture,
) -> BondMaterial {
    BondMaterial {
        law: PairLaw::Linear,
        density: 2440.0,
        modulus: Modulus {
            value: ElasticModulus::Young(72e9),
            calibration,
        },
        horizon: 3.0 * DX,
        influence: Influence {
            function,
            acts_on: ActsOn::Stretch,
        },
        volume_correction: VolumeCorrection::None,
        fracture,
    }
}

fn body(dimension: usize, cells: f64) -> Arc<PointCloud> {
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: vec![cells * DX; dimension],
        },
        spacing: DX,
        section: if dimension == 3 { 1.0 } else { 1e-3 },
        holes: vec![],
    };
    Arc::new(grid.points().unwrap())
}

fn tuned(
    state: StressState,
    correction: VolumeCorrection,
    lower_bound: Option<f64>,
) -> InfluenceFunction {
    let model = ScalingModel::new(state, 3.0, correction).unwrap();
    let table = model
        .tune(Tuning {
            lower_bound,
            ..Default::default()
        })
        .unwrap();
    table.influence(state.dimension(), DX).unwrap().function
}

fn table_of(function: &InfluenceFunction) -> &ClassTable {
    match function {
        InfluenceFunction::Classes(table) => table,
        other => panic!("{other:?} is not a table"),
    }
}

/// Checks −f = ρ M(k) u for a plane wave in the interior of a body.
fn check_interior<const D: usize>(material: &BondMaterial, state: StressState) {
    let cells = 9.0;
    let cloud = body(D, cells);
    let constants = material.constants(&cloud, state).unwrap();
    let bonds = BondList::new(&cloud, material.horizon, material.volume_correction).unwrap();
    let list = BondForce::<LinearBond, D>::new(
        cloud.clone(),
        bonds,
        material,
        &constants,
        &[],
        DamageMeasure::default(),
    )
    .unwrap();
    let body = BondBody::new(&cloud, material, &constants);
    let grid = body.operator(BondForm::Grid).unwrap().operator;
    let lattice = BondLattice::of_body(&cloud, material, &constants).unwrap();
    let (n, centre) = (cloud.len(), cloud.nearest([0.5 * cells * DX; 3]));
    let mut k = [0.0; 3];
    k[..D].copy_from_slice(&[0.7 / DX, -1.9 / DX, 0.4 / DX][..D]);
    let e = [0.6, 0.3, -0.5];
    let origin = cloud.point(centre);
    let mut u = vec![0.0; D * n];
    for i in 0..n {
        let x = cloud.point(i);
        let phase: f64 = (0..3).map(|c| k[c] * (x[c] - origin[c])).sum();
        for c in 0..D {
            u[c * n + i] = e[c] * phase.cos();
        }
    }
    let mut out = vec![0.0; D * n];
    list.add_force(0.0, &u, PointSubset::All, &mut out);
    let mut other = vec![0.0; D * n];
    grid.add_force(0.0, &u, PointSubset::All, &mut other);
    let matrix = lattice.dynamical_matrix(k);
    for row in 0..D {
        let product: f64 = (0..D).map(|c| matrix[row][c] * e[c]).sum();
        let expected = -material.density * product;
        let computed = out[row * n + centre];
        let scale = material.density * matrix[0][0].abs();
        assert!(
            (computed - other[row * n + centre]).abs() < 1e-11 * scale,
            "{state:?}"
        );
        assert!(
            (computed - expected).abs() < 1e-11 * scale,
            "{state:?}: {computed} {expected}"
        );
    }
}

#[test]
fn forces_on_interior_points_equal_the_dynamical_matrix() {
    for correction in [VolumeCorrection::None, VolumeCorrection::Extended] {
        for state in [
            StressState::Uniaxial,
            StressState::PlaneStress,
            StressState::PlaneStrain,
            StressState::Spatial,
        ] {
            for function in [
                InfluenceFunction::Constant,
                InfluenceFunction::Conical,
                influence_alebrahim(DX),
                tuned(state, correction, None),
            ] {
                let material = BondMaterial {
                    volume_correction: correction,
                    ..glass(function, Calibration::Continuum, Fracture::Unbreakable)
                };
                match state.dimension() {
                    1 => check_interior::<1>(&material, state),
                    2 => check_interior::<2>(&material, state),
                    _ => check_interior::<3>(&material, state),
                }
            }
        }
    }
}

#[test]
fn tuned_tables_give_exact_long_wave_speeds() {
    for correction in [VolumeCorrection::None, VolumeCorrection::Extended] {
        for state in [
            StressState::Uniaxial,
            StressState::PlaneStress,
            StressState::PlaneStrain,
            StressState::Spatial,
        ] {
            let cloud = body(state.dimension(), 8.0);
            let material = BondMaterial {
                volume_correction: correction,
                ..glass(
                    tuned(state, correction, None),
                    Calibration::Continuum,
                    Fracture::Unbreakable,
                )
            };
            let constants = material.constants(&cloud, state).unwrap();
            assert!(constants.stiffness_error.abs() < 1e-12);
            let lattice = BondLattice::of_body(&cloud, &material, &constants).unwrap();
            let bar = (72e9f64 / 2440.0).sqrt();
            let exact = continuum_speeds(state);
            let speeds = long_wave_speeds(&lattice, [2.0, 1.0, 3.0]);
            assert!(
                (speeds[0] / bar / exact.pressure - 1.0).abs() < 1e-11,
                "{state:?}"
            );
            if state.dimension() > 1 {
                assert!(
                    (speeds[1] / bar / exact.shear - 1.0).abs() < 1e-11,
                    "{state:?}"
                );
            }
        }
    }
}

#[test]
fn tables_that_do_not_fit_the_body_are_errors() {
    let cloud = body(2, 8.0);
    let strain = StressState::PlaneStrain;
    let function = tuned(strain, VolumeCorrection::None, None);
    let make = |function: InfluenceFunction| {
        glass(function, Calibration::Continuum, Fracture::Unbreakable)
    };
    let fits = make(function.clone());
    assert!(fits.constants(&cloud, strain).is_ok());
    // Signed values with breaking bonds.
    let breaks = BondMaterial {
        fracture: Fracture::Energy {
            energy: 135.0,
            calibration: FractureCalibration::Continuum,
        },
        ..fits.clone()
    };
    assert!(
        breaks
            .constants(&cloud, strain)
            .unwrap_err()
            .to_string()
            .contains("negative")
    );
    // Another volume correction, another spacing, another dimension.
    for correction in [VolumeCorrection::Extended, VolumeCorrection::Linear] {
        let other = BondMaterial {
            volume_correction: correction,
            ..fits.clone()
        };
        let rejected = other.constants(&cloud, strain).is_err();
        assert_eq!(rejected, correction == VolumeCorrection::Extended);
    }
    let shorter = BondMaterial {
        horizon: 2.0 * DX,
        ..fits.clone()
    };
    assert!(shorter.constants(&cloud, strain).is_err());
    let table = table_of(&function);
    let coarse = ClassTable::new(2, 2.0 * DX, table.entries()).unwrap();
    assert!(
        make(InfluenceFunction::Classes(coarse))
            .constants(&cloud, strain)
            .is_err()
    );
    let space = ClassTable::new(3, DX, table.entries()).unwrap();
    assert!(
        make(InfluenceFunction::Classes(space))
            .constants(&cloud, strain)
            .is_err()
    );
    // Points off the grid.
    let free = PointCloud::new(
        2,
        cloud.positions().to_vec(),
        cloud.volumes().to_vec(),
        1e-3,
    )
    .unwrap();
    assert!(fits.constants(&free, strain).is_err());
    assert!(BondLattice::of_body(&free, &fits, &fits.constants(&cloud, strain).unwrap()).is_err());
}

#[test]
fn printed_influence_function_reproduces_the_table() {
    let influence = Influence {
        function: influence_alebrahim(1.0),
        acts_on: ActsOn::Stretch,
    };
    let model = ScalingModel::new(StressState::PlaneStrain, 3.0, VolumeCorrection::None).unwrap();
    let alpha: Vec<f64> = model
        .classes()
        .iter()
        .map(|c| influence.alpha(c.length, 3.0))
        .collect();
    for (a, expected) in alpha.iter().zip([3.738, 3.233, 0.474, 0.449, 0.450, 0.445]) {
        assert!((a - expected).abs() < 6e-4, "{a} {expected}");
    }
    let samples = (1..=3000).map(|k| influence.alpha(f64::from(k) / 1000.0, 3.0));
    assert!((samples.fold(f64::INFINITY, f64::min) - 0.427).abs() < 6e-4);
    assert!(!influence.is_signed(3.0));
    assert!((influence.moment(2.0, 3.0) / 9.0 - 0.9784).abs() < 6e-5);
    // Σ α|ξ| over 2πN³/3.
    let sum: f64 = (model.classes().iter().zip(&alpha))
        .map(|(c, a)| c.multiplicity as f64 * c.length * a)
        .sum();
    assert!((sum / (18.0 * std::f64::consts::PI) - 0.9813).abs() < 6e-5);
    let exact = continuum_speeds(StressState::PlaneStrain);
    let lattice = model.lattice(&alpha);
    for (direction, expected) in [
        ([1.0, 0.0, 0.0], [0.986, 1.004]),
        ([1.0, 1.0, 0.0], [0.995, 0.977]),
    ] {
        let speeds = long_wave_speeds(&lattice, direction);
        assert!((speeds[0] / exact.pressure - expected[0]).abs() < 6e-4);
        assert!((speeds[1] / exact.shear - expected[1]).abs() < 6e-4);
    }
    assert!((model.assess(&alpha).unwrap().error.ratio - 0.872).abs() < 6e-4);
}

#[test]
fn critical_stretches_of_glass_match_verified_values() {
    // Plane strain, δ = 0.75 mm; verified values, with c of α ≡ 1 and with c from the function's own moments.
    let table = tuned(StressState::PlaneStrain, VolumeCorrection::None, Some(0.5));
    let functions = [
        InfluenceFunction::Constant,
        influence_alebrahim(DX),
        polygon(table_of(&table)),
        table.clone(),
    ];
    let cloud = body(2, 8.0);
    for (young, energy, expected) in [
        (
            72e9,
            135.0,
            [
                [0.001809, 0.001809],
                [0.002097, 0.002075],
                [0.002025, 0.002049],
                [0.002025, 0.002025],
            ],
        ),
        (
            65e9,
            204.0,
            [
                [0.002340, 0.002340],
                [0.002714, 0.002684],
                [0.002621, 0.002651],
                [0.002621, 0.002621],
            ],
        ),
    ] {
        for (function, expected) in functions.iter().zip(expected) {
            for (calibration, expected) in [Calibration::Unmodified, Calibration::Continuum]
                .into_iter()
                .zip(expected)
            {
                let fracture = Fracture::Energy {
                    energy,
                    calibration: FractureCalibration::Continuum,
                };
                let mut material = glass(function.clone(), calibration, fracture);
                material.modulus.value = ElasticModulus::Young(young);
                let s0 = material
                    .constants(&cloud, StressState::PlaneStrain)
                    .unwrap()
                    .critical_stretch;
                assert!(
                    (s0 - expected).abs() < 6e-7,
                    "{function:?} {calibration:?}: {s0} {expected}"
                );
            }
        }
    }
}

#[test]
fn lattice_fracture_energies_match_reference_values() {
    let table = tuned(StressState::PlaneStrain, VolumeCorrection::None, Some(0.5));
    let half = 0.5f64.sqrt();
    for (function, grid, diagonal) in [
        (InfluenceFunction::Constant, 20.779, 21.224),
        (table, 15.538, 15.406),
        (influence_alebrahim(DX), 14.947, 14.687),
    ] {
        let influence = Influence {
            function,
            acts_on: ActsOn::Stretch,
        };
        // c = s₀ = D = 1
        let lattice = BondLattice::new(&[1.0, 1.0], 3.0 + 1e-9, |_, xi, _| {
            influence.alpha_of(xi.map(|x| x * DX), 3.0 * DX)
        })
        .unwrap();
        assert!((lattice.crack_energy([0.0, 1.0, 0.0]) - grid).abs() < 6e-4);
        assert!((lattice.crack_energy([half, half, 0.0]) - diagonal).abs() < 6e-4);
    }
}

#[test]
fn fitted_cosines_follow_the_interpolated_table() {
    let function = tuned(StressState::PlaneStrain, VolumeCorrection::None, Some(0.5));
    let table = table_of(&function);
    let (horizon, wave) = (3.0 * DX, 1.1 / DX);
    let line = Influence {
        function: polygon(table),
        acts_on: ActsOn::Stretch,
    };
    let error = |terms| {
        let fit = Influence {
            function: fit_cosines(table, horizon, wave, terms).unwrap(),
            acts_on: ActsOn::Stretch,
        };
        let samples = (1..=300).map(|k| horizon * f64::from(k) / 300.0);
        let square: f64 = samples
            .map(|r| (fit.alpha(r, horizon) - line.alpha(r, horizon)).powi(2))
            .sum();
        (square / 300.0).sqrt()
    };
    assert!(error(8) < error(4) && error(4) < error(2));
    assert!(error(8) < 0.05, "{}", error(8));
    assert!(fit_cosines(table, horizon, 0.0, 3).is_err());
}

fn unit_lattice(state: StressState, n: f64, table: Option<Method>) -> BondLattice {
    let model = ScalingModel::new(state, n, VolumeCorrection::None).unwrap();
    let alpha = match table {
        None => vec![1.0; model.classes().len()],
        Some(method) => {
            let tuning = Tuning {
                method,
                ..Default::default()
            };
            model.tune(tuning).unwrap().alpha
        }
    };
    model.lattice(&alpha)
}

fn check_spectrum(state: StressState, n: f64, table: Option<Method>, run: SpectrumRun) {
    let lattice = unit_lattice(state, n, table);
    let contour = Contour::irreducible(&lattice);
    let spectrum = measure(&lattice, &contour, run).unwrap();
    let (worst, count) = spectrum.worst_deviation();
    println!("{state:?} N = {n} {table:?}: {worst:.3} lines, {count} peaks");
    assert!(worst < 0.25, "{state:?}, N = {n}, {table:?}: {worst} lines");
    assert!(count > 3 * spectrum.waves.len() * state.dimension() / 4);
}

const BAR: [(f64, Option<Method>); 6] = [
    (1.0, None),
    (2.0, None),
    (3.0, None),
    (1.0, Some(Method::Galerkin)),
    (2.0, Some(Method::Galerkin)),
    (3.0, Some(Method::Galerkin)),
];
const PLATE: [(f64, Option<Method>); 4] = [
    (2.0, None),
    (3.0, None),
    (2.0, Some(Method::LeastSquares)),
    (3.0, Some(Method::LeastSquares)),
];

fn spectrum_run(nodes: usize, steps: usize) -> SpectrumRun {
    SpectrumRun {
        nodes,
        steps,
        dt: 0.1,
        seed: 1,
    }
}

/// Bars and plates in runs of these sizes.
fn check_spectra(bars: SpectrumRun, plates: SpectrumRun) {
    for (n, table) in BAR {
        check_spectrum(StressState::Uniaxial, n, table, bars);
    }
    for (n, table) in PLATE {
        check_spectrum(StressState::PlaneStrain, n, table, plates);
    }
}

#[test]
fn measured_peaks_lie_on_the_time_discrete_curve() {
    check_spectra(spectrum_run(64, 2048), spectrum_run(16, 1024));
    check_spectrum(StressState::Spatial, 2.0, None, spectrum_run(8, 512));
}

/// Sizes of the paper: 512 nodes and 8192 steps, 48² nodes and 4096 steps.
#[test]
#[ignore = "takes a minute"]
fn measured_peaks_at_full_size() {
    check_spectra(spectrum_run(512, 8192), spectrum_run(48, 4096));
}

#[test]
fn unstable_tables_and_steps_are_errors() {
    let unstable = unit_lattice(StressState::PlaneStrain, 3.0, Some(Method::Subdomain));
    let run = |dt| SpectrumRun {
        nodes: 16,
        steps: 64,
        dt,
        seed: 1,
    };
    assert!(measure(&unstable, &Contour::irreducible(&unstable), run(0.1)).is_err());
    let stable = unit_lattice(StressState::PlaneStrain, 3.0, None);
    let contour = Contour::irreducible(&stable);
    assert!(measure(&stable, &contour, run(1.9)).is_err());
    assert!(measure(&stable, &contour, run(1.7)).is_ok());
    assert!(measure(&stable, &Contour::ray(&stable, [2.0, 1.0, 0.0]), run(0.1)).is_err());
}

#[test]
fn periodic_force_is_the_energy_gradient_and_sums_to_zero() {
    let lattice = unit_lattice(StressState::PlaneStrain, 3.0, Some(Method::LeastSquares));
    let force = PeriodicForce::new(&lattice, 12, 2.0, 3.0).unwrap();
    let n = force.points();
    let wave = |k: usize| ((k as f64 * 12.9898).sin() * 43758.5453).fract();
    let u: Vec<f64> = (0..2 * n).map(wave).collect();
    let d: Vec<f64> = (0..2 * n).map(|k| wave(k + 77)).collect();
    let mut f = vec![0.0; 2 * n];
    force.add_force(0.0, &u, PointSubset::All, &mut f);
    // Minus the gradient of the energy; zero net force; equal on a sub-domain.
    let moved = |h: f64| -> Vec<f64> { u.iter().zip(&d).map(|(u, d)| u + h * d).collect() };
    let slope = (force.energy(0.0, &moved(0.5)) - force.energy(0.0, &moved(-0.5))) / 1.0;
    let work: f64 = f.iter().zip(&d).map(|(f, d)| 2.0 * f * d).sum();
    assert!((slope + work).abs() < 1e-10 * work.abs());
    for component in f.chunks(n) {
        assert!(component.iter().sum::<f64>().abs() < 1e-11);
    }
    let mut part = vec![0.0; 2 * n];
    force.add_force(0.0, &u, PointSubset::Range(5..9), &mut part);
    force.add_force(0.0, &u, PointSubset::Set(&[0, 100]), &mut part);
    for i in [0, 5, 6, 7, 8, 100] {
        assert_eq!((part[i], part[n + i]), (f[i], f[n + i]));
    }
    assert_eq!(part.iter().filter(|x| **x != 0.0).count(), 12);
    let highest = pericles_dispersion::stability(&lattice).omega_max;
    assert!(force.frequency_bound(&|_| 3.0) >= highest);
}
