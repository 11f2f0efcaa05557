//! Properties of every bond force, over a table of laws × dimensions × influence functions × volume corrections.

use std::sync::Arc;

use pericles::family::{BondList, VolumeCorrection};
use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::material::{
    Approximated, Approximation, BondConstants, BondMaterial, BondStretch, Calibration, CubicLaw,
    CubicSofteningBond, ElasticModulus, Fracture, GreenBond, LinearBond, Modulus, PairLaw,
    StressState, Trapezoidal,
};
use pericles::operator::{BondForce, DamageMeasure, Force, InstructionSet, PointSubset, VectorLaw};
use pericles::space::{Grid, PointCloud, Region, Shape};

const YOUNG: f64 = 2e9;
const STATES: [StressState; 4] = [
    StressState::Uniaxial,
    StressState::PlaneStress,
    StressState::PlaneStrain,
    StressState::Spatial,
];
const CORRECTIONS: [VolumeCorrection; 3] = [
    VolumeCorrection::None,
    VolumeCorrection::Linear,
    VolumeCorrection::Extended,
];

fn influences() -> Vec<Influence> {
    let functions = [
        InfluenceFunction::Constant,
        InfluenceFunction::Conical,
        InfluenceFunction::Inverse,
        InfluenceFunction::Power { exponent: 0.5 },
        InfluenceFunction::Gaussian {
            length: 0.02,
            cutoff: None,
        },
        InfluenceFunction::Tabulated {
            table: vec![(0.01, 3.0), (0.02, 1.0), (0.03, 0.5)],
        },
    ];
    let mut all = Vec::new();
    for function in functions {
        for acts_on in [ActsOn::Stretch, ActsOn::Displacement] {
            all.push(Influence {
                function: function.clone(),
                acts_on,
            });
        }
    }
    all
}

/// A body with a hole, so that boundaries of all kinds occur; irregular if `jitter` is not zero.
fn body(dimension: usize, jitter: f64) -> Arc<PointCloud> {
    let cells = [40.0, 12.0, 7.0][dimension - 1];
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.3, -0.1, 0.0],
            size: vec![cells * 0.01; dimension],
        },
        spacing: 0.01,
        section: if dimension == 3 { 1.0 } else { 0.02 },
        holes: vec![Region::Ball {
            centre: [0.35, -0.05, 0.05],
            radius: 0.012,
        }],
    };
    let points = grid.points().unwrap();
    if jitter == 0.0 {
        return Arc::new(points);
    }
    let moved = points
        .positions()
        .iter()
        .zip(noise(points.positions().len()))
        .map(|(x, r)| x + jitter * r)
        .collect();
    let volumes = points
        .volumes()
        .iter()
        .zip(noise(points.len()))
        .map(|(v, r)| v * (1.0 + 0.2 * r))
        .collect();
    Arc::new(PointCloud::new(dimension, moved, volumes, points.section()).unwrap())
}

/// Numbers in (−1, 1).
fn noise(len: usize) -> Vec<f64> {
    (0..len)
        .map(|k| ((k as f64 * 12.9898).sin() * 43758.5453).fract())
        .collect()
}

fn material(law: PairLaw, influence: Influence, correction: VolumeCorrection) -> BondMaterial {
    BondMaterial {
        law,
        density: 1000.0,
        modulus: Modulus {
            value: ElasticModulus::Young(YOUNG),
            calibration: Calibration::Continuum,
        },
        horizon: 0.03,
        influence,
        volume_correction: correction,
        fracture: Fracture::Unbreakable,
    }
}

fn operator<L: VectorLaw, const D: usize>(
    cloud: &Arc<PointCloud>,
    material: &BondMaterial,
    state: StressState,
) -> (Box<dyn Force>, BondConstants) {
    let constants = material.constants(cloud, state).unwrap();
    let bonds = BondList::new(cloud, material.horizon, material.volume_correction).unwrap();
    let operator = BondForce::<L, D>::new(
        cloud.clone(),
        bonds,
        material,
        &constants,
        &[],
        DamageMeasure::default(),
    )
    .unwrap();
    (Box::new(operator), constants)
}

/// A law that only bars support.
const TREATED: PairLaw = PairLaw::Approximated(CubicLaw::GreenStrain, Approximation::Trapezoidal);

fn build(
    cloud: &Arc<PointCloud>,
    material: &BondMaterial,
    state: StressState,
) -> (Box<dyn Force>, BondConstants) {
    match (material.law, state.dimension()) {
        (PairLaw::Linear, 1) => operator::<LinearBond, 1>(cloud, material, state),
        (PairLaw::Linear, 2) => operator::<LinearBond, 2>(cloud, material, state),
        (PairLaw::Linear, _) => operator::<LinearBond, 3>(cloud, material, state),
        (PairLaw::BondStretch, 1) => operator::<BondStretch, 1>(cloud, material, state),
        (PairLaw::BondStretch, 2) => operator::<BondStretch, 2>(cloud, material, state),
        (PairLaw::BondStretch, _) => operator::<BondStretch, 3>(cloud, material, state),
        (PairLaw::GreenStrain, 1) => operator::<GreenBond, 1>(cloud, material, state),
        (PairLaw::GreenStrain, 2) => operator::<GreenBond, 2>(cloud, material, state),
        (PairLaw::GreenStrain, _) => operator::<GreenBond, 3>(cloud, material, state),
        (PairLaw::CubicSoftening, _) => operator::<CubicSofteningBond, 1>(cloud, material, state),
        (TREATED, _) => operator::<Approximated<GreenBond, Trapezoidal>, 1>(cloud, material, state),
        (law, _) => panic!("{law:?} is not in the table"),
    }
}

fn force(operator: &dyn Force, u: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; u.len()];
    operator.add_force(0.0, u, PointSubset::All, &mut out);
    out
}

fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |m, x| x.abs().max(m))
}

/// u = (A − 1) x + shift.
fn affine(cloud: &PointCloud, a: [[f64; 3]; 3], shift: [f64; 3]) -> Vec<f64> {
    let (n, dimension) = (cloud.len(), cloud.dimension());
    let mut u = vec![0.0; n * dimension];
    for i in 0..n {
        let x = cloud.point(i);
        for c in 0..dimension {
            let image: f64 = (0..dimension).map(|k| a[c][k] * x[k]).sum();
            u[c * n + i] = image - x[c] + shift[c];
        }
    }
    u
}

fn rotation(dimension: usize) -> [[f64; 3]; 3] {
    let (s, c) = 0.7f64.sin_cos();
    match dimension {
        1 => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        2 => [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]],
        _ => {
            // About (1, 1, 1), a cyclic matrix.
            let (p, q) = ((1.0 - c) / 3.0, s / 3f64.sqrt());
            [
                [c + p, p - q, p + q],
                [p + q, c + p, p - q],
                [p - q, p + q, c + p],
            ]
        }
    }
}

/// Calls `check` for every law × state × influence × correction × body.
fn for_each_case(check: impl Fn(&str, &Arc<PointCloud>, &BondMaterial, StressState)) {
    let laws = [
        PairLaw::Linear,
        PairLaw::BondStretch,
        PairLaw::GreenStrain,
        TREATED,
    ];
    for law in laws {
        for state in STATES {
            if law == TREATED && state.dimension() > 1 {
                continue;
            }
            for jitter in [0.0, 0.003] {
                let cloud = body(state.dimension(), jitter);
                for influence in influences() {
                    for correction in CORRECTIONS {
                        let material = material(law, influence.clone(), correction);
                        let name = format!(
                            "{law:?} {state:?} {influence:?} {correction:?} jitter {jitter}"
                        );
                        check(&name, &cloud, &material, state);
                    }
                }
            }
        }
    }
}

#[test]
fn rigid_motions_cause_no_force() {
    for_each_case(|name, cloud, material, state| {
        let (operator, _) = build(cloud, material, state);
        let dimension = state.dimension();
        let unit = rotation(1);
        let strain = {
            let mut a = unit;
            a[0][0] += 1e-3;
            largest(&force(&*operator, &affine(cloud, a, [0.0; 3])))
        };
        let shifted = force(&*operator, &affine(cloud, unit, [0.5, -0.25, 0.125]));
        assert!(largest(&shifted) <= 1e-9 * strain, "{name}: translation");
        if material.law != PairLaw::Linear {
            let rotated = force(&*operator, &affine(cloud, rotation(dimension), [0.0; 3]));
            assert!(largest(&rotated) <= 1e-9 * strain, "{name}: rotation");
        } else {
            // A linear law is invariant only under infinitesimal rotations.
            let mut spin = unit;
            spin[0][1] -= 1e-3;
            spin[1][0] += 1e-3;
            let rotated = force(&*operator, &affine(cloud, spin, [0.0; 3]));
            assert!(
                largest(&rotated) <= 1e-9 * strain,
                "{name}: infinitesimal rotation"
            );
        }
    });
}

#[test]
fn momentum_is_conserved() {
    for_each_case(|name, cloud, material, state| {
        let (operator, _) = build(cloud, material, state);
        let (n, dimension) = (cloud.len(), cloud.dimension());
        let u: Vec<f64> = noise(n * dimension).iter().map(|r| 2e-3 * r).collect();
        let f = force(&*operator, &u);
        let weighted = |c: usize, i: usize| f[c * n + i] * cloud.volumes()[i];
        let place = |c: usize, i: usize| {
            let moved = match material.law {
                PairLaw::Linear => 0.0,
                _ => u[c * n + i],
            };
            cloud.point(i)[c] + moved
        };
        let magnitude: f64 = (0..dimension)
            .flat_map(|c| (0..n).map(move |i| (c, i)))
            .map(|(c, i)| weighted(c, i).abs())
            .sum();
        for c in 0..dimension {
            let sum: f64 = (0..n).map(|i| weighted(c, i)).sum();
            assert!(
                sum.abs() <= 1e-13 * magnitude,
                "{name}: linear, {sum} of {magnitude}"
            );
        }
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            if a.max(b) < dimension {
                let sum: f64 = (0..n)
                    .map(|i| place(a, i) * weighted(b, i) - place(b, i) * weighted(a, i))
                    .sum();
                assert!(
                    sum.abs() <= 1e-13 * magnitude,
                    "{name}: angular, {sum} of {magnitude}"
                );
            }
        }
    });
}

#[test]
fn force_is_minus_the_gradient_of_the_energy() {
    for_each_case(|name, cloud, material, state| {
        let (operator, _) = build(cloud, material, state);
        let (n, dimension) = (cloud.len(), cloud.dimension());
        let u: Vec<f64> = noise(n * dimension).iter().map(|r| 1e-3 * r).collect();
        let direction: Vec<f64> = noise(n * dimension + 7)[7..].to_vec();
        let at =
            |h: f64| -> Vec<f64> { u.iter().zip(&direction).map(|(u, d)| u + h * d).collect() };
        let h = 1e-6;
        let slope = (operator.energy(0.0, &at(h)) - operator.energy(0.0, &at(-h))) / (2.0 * h);
        let f = force(&*operator, &u);
        let work: f64 = (0..n * dimension)
            .map(|k| f[k] * direction[k] * cloud.volumes()[k % n])
            .sum();
        assert!(
            (slope + work).abs() <= 1e-6 * work.abs(),
            "{name}: {slope} {work}"
        );
        let mut tangent = vec![0.0; u.len()];
        operator.tangent_into(0.0, &u, &direction, &mut tangent);
        let (up, down) = (force(&*operator, &at(h)), force(&*operator, &at(-h)));
        let scale = largest(&tangent);
        for k in 0..u.len() {
            let slope = (up[k] - down[k]) / (2.0 * h);
            assert!(
                (slope - tangent[k]).abs() <= 1e-5 * scale,
                "{name}: tangent"
            );
        }
    });
}

/// Energy densities of an interior point under homogeneous strains, divided by those of the continuum.
fn patch(
    state: StressState,
    m: f64,
    correction: VolumeCorrection,
    calibration: Calibration,
    influence: Influence,
) -> Vec<f64> {
    let dimension = state.dimension();
    let cells = 2.0 * (m + 1.0).ceil() + 1.0;
    let cloud = Arc::new(
        Grid {
            shape: Shape::Box {
                origin: [0.0; 3],
                size: vec![cells * 0.01; dimension],
            },
            spacing: 0.01,
            section: if dimension == 3 { 1.0 } else { 0.3 },
            holes: vec![],
        }
        .points()
        .unwrap(),
    );
    let mut material = material(PairLaw::Linear, influence, correction);
    material.horizon = m * 0.01;
    material.modulus.calibration = calibration;
    let (operator, _) = build(&cloud, &material, state);
    let centre = cloud.nearest([0.5 * cells * 0.01; 3]);
    // In-plane Lamé constants: λ = μ for ν = 1/4, and also for ν = 1/3, where the plane-stress value is λ' = E ν/(1
    // − ν²) = μ.
    let nu = state.poisson_ratio().unwrap_or(0.0);
    let mu = YOUNG / (2.0 * (1.0 + nu));
    let lambda = match state {
        StressState::Uniaxial => 0.0,
        StressState::PlaneStress => YOUNG * nu / (1.0 - nu * nu),
        _ => YOUNG * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
    };
    let strains: Vec<[[f64; 3]; 3]> = {
        let diagonal = |x: f64, y: f64, z: f64| [[x, 0.0, 0.0], [0.0, y, 0.0], [0.0, 0.0, z]];
        let shear = [[0.0, 0.5, 0.0], [0.5, 0.0, 0.0], [0.0; 3]];
        match dimension {
            1 => vec![diagonal(1.0, 0.0, 0.0)],
            2 => vec![diagonal(1.0, 1.0, 0.0), diagonal(1.0, 0.0, 0.0), shear],
            _ => vec![diagonal(1.0, 1.0, 1.0), diagonal(1.0, 0.0, 0.0), shear],
        }
    };
    strains
        .iter()
        .map(|strain| {
            let mut a = rotation(1);
            let (mut trace, mut square) = (0.0, 0.0);
            for r in 0..3 {
                trace += strain[r][r];
                for c in 0..3 {
                    a[r][c] += 1e-3 * strain[r][c];
                    square += strain[r][c] * strain[r][c];
                }
            }
            let exact = match state {
                StressState::Uniaxial => 0.5 * YOUNG,
                _ => 0.5 * lambda * trace * trace + mu * square,
            } * 1e-6;
            let mut density = vec![0.0; cloud.len()];
            operator.add_energy_density(0.0, &affine(&cloud, a, [0.0; 3]), &mut density);
            density[centre] / exact
        })
        .collect()
}

#[test]
fn patch_test_of_the_extended_correction() {
    let errors = |state, m| -> f64 {
        patch(
            state,
            m,
            VolumeCorrection::Extended,
            Calibration::Continuum,
            Influence::default(),
        )
        .iter()
        .fold(0.0, |worst: f64, ratio| worst.max((ratio - 1.0).abs()))
    };
    for m in [2.0, 3.0, 4.0, 6.0, 7.0] {
        let error = errors(StressState::Uniaxial, m);
        assert!(error < 1e-12, "bar, m = {m}: {error}");
    }
    for (state, limit) in [
        (StressState::PlaneStress, 0.04),
        (StressState::PlaneStrain, 0.04),
        (StressState::Spatial, 0.08),
    ] {
        let error = errors(state, 3.0);
        assert!(error <= limit, "{state:?}, m = 3: {error}");
        for m in [6.0, 7.0, 8.0] {
            let error = errors(state, m);
            assert!(error <= 0.015, "{state:?}, m = {m}: {error}");
        }
    }
}

#[test]
fn patch_test_without_correction_gives_the_lattice_sum() {
    // Energy density of a lattice under isotropic strain e: ¼ c e² V Σ α |ξ|, summed here bond by bond.
    for state in STATES {
        let (m, dx): (f64, f64) = (3.0, 0.01);
        let dimension = state.dimension();
        let ratio = patch(
            state,
            m,
            VolumeCorrection::None,
            Calibration::Continuum,
            Influence::default(),
        )[0];
        let mut sum = 0.0;
        let range = |active: bool| if active { -4i32..=4 } else { 0..=0 };
        for x in range(true) {
            for y in range(dimension > 1) {
                for z in range(dimension > 2) {
                    let square = x * x + y * y + z * z;
                    if square > 0 && square <= 9 {
                        sum += f64::from(square).sqrt() * dx;
                    }
                }
            }
        }
        let delta: f64 = m * dx;
        let pi = std::f64::consts::PI;
        let integral = match dimension {
            1 => delta.powi(2),
            2 => 2.0 * pi * delta.powi(3) / 3.0,
            _ => pi * delta.powi(4),
        };
        let exact = sum * dx.powi(dimension as i32) / integral;
        assert!(
            (ratio / exact - 1.0).abs() < 1e-12,
            "{state:?}: {ratio} {exact}"
        );
    }
}

#[test]
fn lattice_calibration_makes_the_bulk_modulus_exact() {
    for state in STATES {
        for influence in influences() {
            for correction in CORRECTIONS {
                for m in [3.0, 3.015, 4.3] {
                    let bulk = patch(
                        state,
                        m,
                        correction,
                        Calibration::Lattice,
                        influence.clone(),
                    )[0];
                    assert!(
                        (bulk - 1.0).abs() < 1e-12,
                        "{state:?} {influence:?} {correction:?} m {m}: {bulk}"
                    );
                }
            }
        }
    }
}

#[test]
fn the_predicted_stiffness_error_equals_the_measured_one() {
    for state in STATES {
        let cloud = body(state.dimension(), 0.0);
        for correction in CORRECTIONS {
            let material = material(PairLaw::Linear, Influence::default(), correction);
            let predicted = material.constants(&cloud, state).unwrap().stiffness_error;
            let measured = patch(
                state,
                3.0,
                correction,
                Calibration::Continuum,
                Influence::default(),
            )[0] - 1.0;
            assert!((predicted - measured).abs() < 1e-12);
        }
    }
}

#[test]
fn all_subsets_give_the_same_bits_and_all_instruction_sets_the_same_force() {
    let cloud = body(3, 0.003);
    let material = material(
        PairLaw::BondStretch,
        Influence::default(),
        VolumeCorrection::Extended,
    );
    let constants = material.constants(&cloud, StressState::Spatial).unwrap();
    let operator = |set| {
        let bonds = BondList::new(&cloud, material.horizon, material.volume_correction).unwrap();
        BondForce::<BondStretch, 3>::new(
            cloud.clone(),
            bonds,
            &material,
            &constants,
            &[],
            DamageMeasure::default(),
        )
        .unwrap()
        .with_instruction_set(set)
    };
    let n = cloud.len();
    let u: Vec<f64> = noise(3 * n).iter().map(|r| 1e-3 * r).collect();
    let baseline = force(&operator(InstructionSet::Baseline), &u);
    for set in InstructionSet::available() {
        let operator = operator(set);
        let reference = force(&operator, &u);
        for (value, expected) in reference.iter().zip(&baseline) {
            assert!(
                (value - expected).abs() < 1e-13 * largest(&baseline),
                "{set:?}"
            );
        }
        let odd: Vec<u32> = (0..n as u32).filter(|i| i % 2 == 1).collect();
        let mut parts = vec![0.0; 3 * n];
        operator.add_force(0.0, &u, PointSubset::Set(&odd), &mut parts);
        for i in (0..n).step_by(2) {
            operator.add_force(0.0, &u, PointSubset::Range(i..i + 1), &mut parts);
        }
        assert_eq!(
            parts, reference,
            "{set:?}: the force on a point depends on the subset"
        );
    }
}

/// The sum over all pairs, from the definition.
#[test]
fn forces_equal_the_definition() {
    let cloud = body(2, 0.003);
    let material = material(
        PairLaw::BondStretch,
        Influence::default(),
        VolumeCorrection::None,
    );
    let (operator, constants) = build(&cloud, &material, StressState::PlaneStress);
    let n = cloud.len();
    let u: Vec<f64> = noise(2 * n).iter().map(|r| 1e-3 * r).collect();
    let f = force(&*operator, &u);
    let scale = largest(&f);
    for i in 0..n {
        let mut sum = [0.0; 2];
        for j in (0..n).filter(|&j| j != i) {
            let xi: [f64; 2] = std::array::from_fn(|c| cloud.point(j)[c] - cloud.point(i)[c]);
            let y: [f64; 2] = std::array::from_fn(|c| xi[c] + u[c * n + j] - u[c * n + i]);
            let (r, l) = (xi[0].hypot(xi[1]), y[0].hypot(y[1]));
            if r <= material.horizon * (1.0 + 1e-9) {
                for c in 0..2 {
                    sum[c] += constants.micromodulus * (l - r) / r * y[c] / l * cloud.volumes()[j];
                }
            }
        }
        for c in 0..2 {
            assert!((f[c * n + i] - sum[c]).abs() < 1e-12 * scale);
        }
    }
}
