//! Tuned coefficients compared with published and independently computed values (Alebrahim et al. 2022, verified),
//! closed forms and optimality conditions.

use std::f64::consts::PI;

use pericles::PericlesError;
use pericles::family::VolumeCorrection;
use pericles::material::StressState;
use pericles_dispersion::DispersionError;
use pericles_dispersion::PhaseErrors;
use pericles_dispersion::tuning::{
    Combination, Method, ScalingModel, TunedTable, Tuning, Weights, continuum_speeds,
};
use pericles_dispersion::{long_wave_speeds, stability};

fn model(state: StressState, n: f64) -> ScalingModel {
    ScalingModel::new(state, n, VolumeCorrection::None).unwrap()
}

fn tuned(model: &ScalingModel, method: Method, combination: Combination) -> TunedTable {
    let tuning = Tuning {
        method,
        combination,
        ..Default::default()
    };
    model.tune(tuning).unwrap()
}

fn close(computed: f64, expected: f64, tolerance: f64, what: &str) {
    assert!(
        (computed - expected).abs() <= tolerance * expected.abs(),
        "{what}: {computed} instead of {expected}"
    );
}

/// Compares to within half a unit of the last given digit.
fn digits(computed: f64, expected: f64, places: i32, what: &str) {
    assert!(
        (computed - expected).abs() <= 0.51 * 10f64.powi(-places),
        "{what}: {computed} instead of {expected}"
    );
}

const PC: Method = Method::PointCollocation;
const SC: Method = Method::Subdomain;
const LS: Method = Method::LeastSquares;
const G: Method = Method::Galerkin;
const LITERAL: Method = Method::LiteralGalerkin;

/// Rows of a table of published values.
fn rows(text: &'static str) -> Vec<Vec<&'static str>> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines
        .skip(1)
        .map(|line| line.split(',').collect())
        .collect()
}

fn numbers(cell: &str) -> Vec<f64> {
    cell.split(' ').map(|x| x.parse().unwrap()).collect()
}

fn method(name: &str) -> Method {
    *Method::ALL
        .iter()
        .find(|method| method.name() == name)
        .unwrap()
}

const BAR: &str =
    include_str!("../../../../validation/dispersion-and-fracture/one-dimensional.csv");
const PLATE: &str =
    include_str!("../../../../validation/dispersion-and-fracture/two-dimensional.csv");

#[test]
fn bar_coefficients_match_published_values() {
    let rows = rows(BAR);
    assert_eq!(rows.len(), 20);
    for row in rows {
        let [n, error, omega] = [0, 2, 3].map(|c: usize| row[c].parse::<f64>().unwrap());
        let table = tuned(&model(StressState::Uniaxial, n), method(row[1]), SEP);
        let what = format!("N = {n}, {}", row[1]);
        for (alpha, expected) in table.alpha.iter().zip(numbers(row[4])) {
            close(*alpha, expected, 1e-4, &what);
        }
        digits(table.assessment.error.ratio, error, 5, &what);
        digits(table.assessment.stability.omega_max, omega, 4, &what);
        assert!(table.assessment.stability.is_stable(), "{what}");
        assert!(table.assessment.constraints[0].abs() < 1e-12, "{what}");
        assert!(
            table.condition < 1e4 && table.kkt < 1e-11,
            "{what}: {} {}",
            table.condition,
            table.kkt
        );
        // Signs alternate.
        let signs = table.alpha.iter().enumerate();
        assert!(
            signs.clone().all(|(i, a)| (i % 2 == 0) == (*a > 0.0)),
            "{what}"
        );
    }
}

#[test]
fn untuned_bar_has_the_closed_form_errors() {
    for (n, ratio, omega) in [
        (1.0, 0.36554, 2.8284),
        (2.0, 0.75193, f64::NAN),
        (3.0, 1.0, f64::NAN),
        (5.0, 1.17644, f64::NAN),
        (10.0, 1.27588, f64::NAN),
    ] {
        let model = model(StressState::Uniaxial, n);
        let original = model.assess(&vec![1.0; n as usize]).unwrap();
        digits(original.error.ratio, ratio, 5, "error");
        if omega.is_finite() {
            digits(original.stability.omega_max, omega, 4, "frequency");
        }
        // Long waves: ω²/k² → 1 + 1/N.
        let speed = long_wave_speeds(&model.lattice(&vec![1.0; n as usize]), [1.0, 0.0, 0.0])[0];
        close(speed * speed, 1.0 + 1.0 / n, 1e-13, "long waves");
    }
    let three = model(StressState::Uniaxial, 3.0).assess(&[1.0; 3]).unwrap();
    digits(three.error.absolute, 7.812216, 6, "reference error");
}

#[test]
fn galerkin_coefficients_equal_their_closed_form() {
    for n in [3usize, 7, 10, 25, 40] {
        let table = tuned(
            &model(StressState::Uniaxial, n as f64),
            G,
            Combination::Separated,
        );
        let square = (n * n) as f64;
        let term = |i: usize| square * if i % 2 == 1 { 1.0 } else { -1.0 } / i as f64;
        for i in 1..=n - 2 {
            close(table.alpha[i - 1], term(i), 1e-10, "first coefficients");
        }
        // The last two from Σ α_i/i = N²π²/12 and Σ i α_i = N²/2.
        let part = |f: &dyn Fn(usize) -> f64| (1..=n - 2).map(|i| term(i) * f(i)).sum::<f64>();
        let a = square * PI * PI / 12.0 - part(&|i| 1.0 / i as f64);
        let b = square / 2.0 - part(&|i| i as f64);
        let (p, q) = ((n - 1) as f64, n as f64);
        let determinant = q / p - p / q;
        // Both sides have the round-off of the first coefficients, about N², times their conditioning.
        let [x, y] = [a * q - b / q, b / p - a * p].map(|x| x / determinant);
        let errors = [table.alpha[n - 2] - x, table.alpha[n - 1] - y];
        assert!(
            errors.iter().all(|error| error.abs() < 1e-9 * square),
            "{n}: {errors:?} {}",
            table.condition
        );
        assert!(table.condition < 1e6, "{n}: {}", table.condition);
    }
}

#[test]
fn least_squares_satisfies_the_stationarity_condition() {
    // At N = 2 the one free direction is (2, −1): ∫ R (2 b₁ − b₂) dk = 0, checked with the closed forms of ∫ b_i
    // b_j and ∫ b_i k².
    let table = tuned(
        &model(StressState::Uniaxial, 2.0),
        LS,
        Combination::Separated,
    );
    let n4 = 16.0;
    let bb = |i: f64, j: f64| 16.0 * PI / (n4 * i * j) * if i == j { 1.5 } else { 1.0 };
    let bk = |i: f64| {
        4.0 / (4.0 * i)
            * (PI.powi(3) / 3.0 - 2.0 * PI * if i == 1.0 { -1.0 } else { 1.0 } / (i * i))
    };
    let along = |j: f64| table.alpha[0] * bb(1.0, j) + table.alpha[1] * bb(2.0, j) - bk(j);
    assert!((2.0 * along(1.0) - along(2.0)).abs() < 1e-12);
}

const SEP: Combination = Combination::Separated;
const ABS: Combination = Combination::Absolute;
const L1: Method = Method::Absolute;

/// Half a unit of the last given digit, plus a margin.
fn rounding(cell: &str) -> f64 {
    let places = cell.split_once('.').map_or(0, |(_, digits)| digits.len());
    0.6 * 10f64.powi(-(places as i32))
}

#[test]
fn plate_coefficients_match_published_values() {
    let rows = rows(PLATE);
    assert_eq!(rows.len(), 35);
    for row in rows {
        let [n, tolerance, error, smallest] =
            [0, 4, 5, 6].map(|c: usize| row[c].parse::<f64>().unwrap());
        let combination = *Combination::ALL
            .iter()
            .find(|c| c.name() == row[2])
            .unwrap();
        let lower_bound = row[3].parse().ok();
        let table = model(StressState::PlaneStrain, n)
            .tune(Tuning {
                method: method(row[1]),
                combination,
                lower_bound,
                ..Default::default()
            })
            .unwrap();
        let what = format!("{row:?}: {:?}", table.alpha);
        for (alpha, cell) in table.alpha.iter().zip(row[8].split(' ')) {
            let expected: f64 = cell.parse().unwrap();
            let allowed = (tolerance * expected.abs()).max(rounding(cell));
            assert!(
                (alpha - expected).abs() <= allowed,
                "{what}, should be {expected}"
            );
        }
        let slack = |cell: &str| {
            if tolerance < 1e-3 {
                rounding(cell)
            } else {
                6e-3
            }
        };
        let stability = &table.assessment.stability;
        assert!(
            (table.assessment.error.ratio - error).abs() < slack(row[5]).min(1.1e-3),
            "{what}"
        );
        assert!(
            (stability.smallest - smallest).abs() < slack(row[6]),
            "{what}"
        );
        assert_eq!(stability.is_stable(), smallest > 0.0, "{what}");
        if let Ok(omega) = row[7].parse::<f64>() {
            assert!(
                (stability.omega_max - omega).abs() < 3.0 * slack(row[7]),
                "{what}"
            );
        }
        assert!(
            table.assessment.constraints.iter().all(|c| c.abs() < 1e-12),
            "{what}"
        );
        assert!(table.kkt < 1e-10, "{what}: {}", table.kkt);
        if let Some(bound) = lower_bound {
            let at_bound: Vec<usize> = (0..table.alpha.len())
                .filter(|c| table.alpha[*c] == bound)
                .collect();
            assert_eq!(table.active, at_bound, "{what}");
            assert_eq!(at_bound.len(), table.alpha.len() - 2, "a vertex");
        }
    }
}

#[test]
fn untuned_plate_has_the_closed_form_speeds() {
    for (n, absolute, smallest, omega) in [
        (2.0, 98.3298, 0.0774, 1.639),
        (3.0, 112.8406, 0.0511, 1.108),
    ] {
        let model = model(StressState::PlaneStrain, n);
        let ones = vec![1.0; model.classes().len()];
        let found = model.assess(&ones).unwrap();
        digits(found.error.absolute, absolute, 4, "error");
        assert_eq!(found.error.ratio, 1.0);
        digits(found.stability.smallest, smallest, 4, "smallest");
        digits(found.stability.omega_max, omega, 3, "highest");
    }
    // Long-wave speeds divided by those of the continuum: along an axis and the diagonal.
    #[rustfmt::skip]
    let rows = [
        (2.0, [1.0863, 0.8217], [0.9631, 1.1968]),
        (3.0, [1.0260, 1.0026], [1.0144, 1.0376]),
        (4.0, [0.9871, 0.9626], [0.9749, 0.9991]),
        (10.0, [1.0009, 1.0247], [1.0129, 0.9888]),
    ];
    let exact = continuum_speeds(StressState::PlaneStrain);
    for (n, axis, diagonal) in rows {
        let model = model(StressState::PlaneStrain, n);
        let lattice = model.lattice(&vec![1.0; model.classes().len()]);
        for (direction, expected) in [([1.0, 0.0, 0.0], axis), ([1.0, 1.0, 0.0], diagonal)] {
            let speeds = long_wave_speeds(&lattice, direction);
            digits(speeds[0] / exact.pressure, expected[0], 4, "pressure");
            digits(speeds[1] / exact.shear, expected[1], 4, "shear");
        }
    }
    // N = 1: ω_p = √(48/5π) k cos β.
    let one = model(StressState::PlaneStrain, 1.0).lattice(&[1.0]);
    close(
        long_wave_speeds(&one, [1.0, 0.0, 0.0])[0],
        1.7481,
        5e-5,
        "N = 1",
    );
}

#[test]
fn plane_stress_has_the_coefficients_of_plane_strain() {
    for (method, combination, lower_bound) in [
        (LS, SEP, None),
        (SC, SEP, None),
        (G, ABS, None),
        (LS, SEP, Some(0.5)),
    ] {
        let tuning = Tuning {
            method,
            combination,
            lower_bound,
            ..Default::default()
        };
        let strain = model(StressState::PlaneStrain, 3.0).tune(tuning).unwrap();
        let stress = model(StressState::PlaneStress, 3.0).tune(tuning).unwrap();
        for (a, b) in strain.alpha.iter().zip(&stress.alpha) {
            assert!((a - b).abs() < 1e-8 * strain.alpha[0].abs(), "{a} {b}");
        }
        let factor = stress.assessment.stability.omega_max / strain.assessment.stability.omega_max;
        close(factor, (15.0f64 / 16.0).sqrt(), 1e-8, "frequencies");
    }
}

#[test]
fn block_coefficients_are_isotropic_and_optimal() {
    for (n, classes) in [(2.0, 4), (3.0, 9)] {
        let model = model(StressState::Spatial, n);
        assert_eq!(model.classes().len(), classes);
        let table = tuned(&model, LS, SEP);
        // Stability differs: for N = 3 some shear waves off the contour are unstable, which a bound prevents.
        assert_eq!(table.assessment.stability.is_stable(), n == 2.0);
        assert!(table.assessment.constraints.iter().all(|c| c.abs() < 1e-12));
        assert!(table.kkt < 1e-11 && table.condition < 1e4);
        assert!(table.assessment.error.ratio < 1.0);
        // Long waves are isotropic in every direction.
        let exact = continuum_speeds(StressState::Spatial);
        for direction in [
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [1.0, 1.0, 1.0],
            [3.0, 1.0, 2.0],
        ] {
            let speeds = long_wave_speeds(&model.lattice(&table.alpha), direction);
            close(speeds[0], exact.pressure, 1e-10, "pressure");
            close(speeds[1], exact.shear, 1e-10, "shear");
            close(speeds[2], exact.shear, 1e-10, "shear");
        }
        // The square error is minimal on the constraints: any step along them increases it.
        let error = |alpha: &[f64]| model.assess(alpha).unwrap().error.square;
        let best = error(&table.alpha);
        let positive = model
            .tune(Tuning {
                lower_bound: Some(0.3),
                ..Default::default()
            })
            .unwrap();
        assert!(error(&positive.alpha) > best && positive.assessment.stability.is_stable());
        for share in [0.1, -0.1] {
            let mixed: Vec<f64> = (table.alpha.iter().zip(&positive.alpha))
                .map(|(a, b)| a + share * (b - a))
                .collect();
            assert!(error(&mixed) > best);
        }
    }
}

/// Each table is the best for its own weights, by a direct sum over the contour.
#[test]
fn each_table_is_optimal_for_its_own_weights() {
    let model = model(StressState::PlaneStrain, 3.0);
    let choices = [
        Weights::default(),
        Weights {
            decay: Some(1.5),
            ..Default::default()
        },
        Weights {
            shear: 5.0,
            ..Default::default()
        },
    ];
    let cost = |alpha: &[f64], weights: Weights| -> f64 {
        let lattice = model.lattice(alpha);
        let points = pericles_dispersion::trace(&lattice, model.contour(), 400);
        let terms = points.iter().map(|point| {
            let square: f64 = point.k.iter().map(|k| k * k).sum();
            let near = weights.decay.map_or(1.0, |d| (-square / (d * d)).exp());
            let p = weights.pressure * (point.branches[0].omega_squared - 1.2 * square);
            let s = weights.shear * (point.branches[1].omega_squared - 0.4 * square);
            let length = model.contour().segments[point.segment].length();
            length * near * near * (p * p + s * s)
        });
        terms.sum()
    };
    let tables: Vec<Vec<f64>> = choices
        .iter()
        .map(|weights| {
            let tuning = Tuning {
                weights: *weights,
                ..Default::default()
            };
            model.tune(tuning).unwrap().alpha
        })
        .collect();
    for (own, weights) in choices.iter().enumerate() {
        for (other, table) in tables.iter().enumerate() {
            if own != other {
                assert!(cost(&tables[own], *weights) < 0.99 * cost(table, *weights));
            }
        }
    }
}

#[test]
fn tuning_supports_other_horizons_and_partial_volumes() {
    for (n, correction) in [
        (3.015, VolumeCorrection::None),
        (3.0, VolumeCorrection::Linear),
        (3.0, VolumeCorrection::Extended),
        (4.015, VolumeCorrection::Extended),
        (5.0, VolumeCorrection::None),
    ] {
        let model = ScalingModel::new(StressState::PlaneStress, n, correction).unwrap();
        let table = tuned(&model, LS, SEP);
        let exact = continuum_speeds(StressState::PlaneStress);
        let speeds = long_wave_speeds(&model.lattice(&table.alpha), [2.0, 1.0, 0.0]);
        close(speeds[0], exact.pressure, 1e-11, "pressure");
        close(speeds[1], exact.shear, 1e-11, "shear");
        assert!(table.assessment.error.ratio < 0.5);
    }
    // For N = 5 the classes (5,0) and (4,3) have equal length and two unknowns.
    let five = model(StressState::PlaneStrain, 5.0);
    let same: Vec<_> = five.classes().iter().filter(|c| c.length == 5.0).collect();
    assert_eq!(same.len(), 2);
    assert_eq!((same[0].multiplicity, same[1].multiplicity), (4, 8));
}

#[test]
fn infeasible_tuning_problems_are_errors() {
    let rejected = |state, n: f64, tuning| {
        ScalingModel::new(state, n, VolumeCorrection::None).and_then(|model| model.tune(tuning))
    };
    for n in [0.9, f64::NAN, -3.0, 1e9] {
        let error = rejected(StressState::Uniaxial, n, Tuning::default()).unwrap_err();
        assert!(matches!(error, PericlesError::OutOfRange { .. }), "{error}");
    }
    for state in [StressState::PlaneStrain, StressState::Spatial] {
        let error = rejected(state, 1.2, Tuning::default()).unwrap_err();
        assert!(
            matches!(error.extension(), Some(DispersionError::Anisotropic { .. })),
            "{error}"
        );
    }
    let high = Tuning {
        lower_bound: Some(2.0),
        ..Default::default()
    };
    let error = rejected(StressState::PlaneStrain, 3.0, high).unwrap_err();
    let Some(&DispersionError::InfeasibleBound { largest, .. }) = error.extension() else {
        panic!("{error}")
    };
    // The bound named by the error is feasible, a larger one is not.
    let at = |bound| Tuning {
        lower_bound: Some(bound),
        ..Default::default()
    };
    assert!(rejected(StressState::PlaneStrain, 3.0, at(largest - 1e-6)).is_ok());
    assert!(rejected(StressState::PlaneStrain, 3.0, at(largest + 1e-6)).is_err());
    let literal = Tuning {
        method: LITERAL,
        ..Default::default()
    };
    let error = rejected(StressState::PlaneStrain, 3.0, literal).unwrap_err();
    assert!(matches!(
        error.extension(),
        Some(DispersionError::TuningChoice { .. })
    ));
    let weight = Tuning {
        weights: Weights {
            pressure: -1.0,
            ..Default::default()
        },
        ..Default::default()
    };
    assert!(rejected(StressState::PlaneStrain, 3.0, weight).is_err());
    assert!(
        model(StressState::PlaneStrain, 3.0)
            .assess(&[1.0; 5])
            .is_err()
    );
    assert!(StressState::PlaneStrain.check_poisson_ratio(0.3).is_err());
}

/// Computing time of the full tables; in release builds only.
#[test]
#[cfg_attr(debug_assertions, ignore = "times optimised code")]
fn tables_are_computed_within_the_time_limit() {
    let start = std::time::Instant::now();
    let two = model(StressState::PlaneStrain, 3.0);
    for combination in [SEP, ABS, Combination::SignedSum] {
        for method in [PC, SC, G] {
            tuned(&two, method, combination);
        }
    }
    tuned(&two, LS, SEP);
    tuned(&two, L1, ABS);
    let plate = start.elapsed().as_secs_f64();
    let start = std::time::Instant::now();
    let three = model(StressState::Spatial, 3.0);
    for (method, combination) in [(LS, SEP), (PC, SEP), (SC, SEP), (G, SEP), (L1, ABS)] {
        tuned(&three, method, combination);
    }
    let space = start.elapsed().as_secs_f64();
    println!("2D N = 3: {plate:.2} s, 3D N = 3: {space:.2} s");
    assert!(stability(&three.lattice(&[1.0; 9])).is_stable());
    // The targets are 1 s and 10 s on an idle machine.
    assert!(plate < 4.0 && space < 40.0, "{plate} {space}");
}

/// Compares the default decay with equal weights and with a constant influence function: fewer spacings per
/// wavelength for an error of 1 %, and smaller errors down to four spacings.
#[test]
fn default_decay_improves_on_a_constant_kernel() {
    for (state, n, least) in [
        (StressState::Uniaxial, 2.0, 3.9),
        (StressState::Uniaxial, 3.0, 3.1),
        (StressState::Uniaxial, 5.0, 2.6),
        (StressState::PlaneStress, 2.0, 14.0),
        (StressState::PlaneStrain, 3.0, 6.0),
        (StressState::PlaneStrain, 4.0, 3.7),
        (StressState::PlaneStrain, 5.0, 16.0),
        (StressState::Spatial, 3.0, 16.0),
    ] {
        let model = ScalingModel::new(state, n, VolumeCorrection::None).unwrap();
        let quality = |alpha: &[f64]| {
            let lattice = model.lattice(alpha);
            let errors = PhaseErrors::new(&lattice);
            let spacings = std::f64::consts::TAU / errors.resolved(0.01).wavenumber;
            (spacings, errors.largest(0.5 * std::f64::consts::PI))
        };
        let decayed = Tuning {
            weights: Weights {
                decay: Some(Weights::DECAY),
                ..Default::default()
            },
            ..Default::default()
        };
        let (tuned, equal) = (
            model.tune_stable(decayed).unwrap(),
            model.tune(Tuning::default()).unwrap(),
        );
        assert!(tuned.assessment.stability.is_stable());
        let constant = quality(&vec![1.0; model.classes().len()]);
        let (tuned, equal) = (quality(&tuned.alpha), quality(&equal.alpha));
        eprintln!("{state:?} {n}: tuned {tuned:?}, equal weights {equal:?}, constant {constant:?}");
        assert!(tuned.0 < constant.0 && tuned.0 < equal.0 && tuned.0 < least);
        assert!(tuned.1 < constant.1 && tuned.1 < equal.1);
    }
}

/// The reported functionals are those that were minimised.
#[test]
fn reported_functionals_are_the_minimised_ones() {
    let model = ScalingModel::new(StressState::Uniaxial, 3.0, VolumeCorrection::None).unwrap();
    let with = |method| {
        model
            .tune(Tuning {
                method,
                ..Default::default()
            })
            .unwrap()
    };
    // As many functionals as free unknowns: all vanish.
    for method in [
        Method::PointCollocation,
        Method::Subdomain,
        Method::Galerkin,
    ] {
        let table = with(method);
        assert_eq!(table.functionals.len(), 2);
        assert!(table.functionals.iter().flatten().all(|f| f.abs() < 1e-10));
    }
    let squares = with(Method::LeastSquares);
    let norm = squares.functionals[0][0];
    assert!((norm / squares.assessment.error.square - 1.0).abs() < 1e-6);
    let absolute = with(Method::Absolute);
    let sum = absolute.functionals[0][0];
    assert!((sum / absolute.assessment.error.absolute - 1.0).abs() < 1e-3);
    assert!(squares.functionals[0][0] > 0.0 && absolute.assessment.error.absolute > 0.0);
}
