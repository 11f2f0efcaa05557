//! Properties of every linear peridynamic solid on arbitrary points.

use std::sync::Arc;

use crate::bodies::{bodies, families, jittered, noise, solid, wave};
use crate::common::{boxed, material as bond_based};
use crate::twin::Twin;
use pericles::domain::Field;
use pericles::family::{BondList, Crack, EndRule, VolumeCorrection};
use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::material::{
    BondLimits, BondStretch, Calibration, ElasticModulus, Fracture, LinearSolid,
    LinearSolidConstants, Modulus, StateInfluence, Strains, StressState,
};
use pericles::operator::{
    AssembledBonds, BondForce, BondForm, DamageMeasure, Force, InstructionSet, LinearSolidBody,
    PointSubset,
};
use pericles::space::PointCloud;
use pericles::time::frequency_from_below;
use pericles::{PointScalar, StepEnd, System};

/// Influence functions evaluated by formula, stored by code, and stored as one number per bond.
fn functions() -> Vec<InfluenceFunction> {
    vec![
        InfluenceFunction::Constant,
        InfluenceFunction::Conical,
        InfluenceFunction::Inverse,
        InfluenceFunction::Gaussian {
            length: 1.3,
            cutoff: None,
        },
        InfluenceFunction::Tabulated {
            table: vec![(0.0, 1.0), (10.0, 0.3)],
        },
        InfluenceFunction::Power { exponent: 0.5 },
    ]
}

fn operator(cloud: &Arc<PointCloud>, constants: &LinearSolidConstants) -> Box<dyn Force> {
    let body = LinearSolidBody::new(cloud, constants, VolumeCorrection::None);
    body.operator(BondForm::Fastest).unwrap().operator
}

fn force_of(operator: &dyn Force, u: &[f64]) -> Vec<f64> {
    let mut force = vec![0.0; u.len()];
    operator.add_force(0.0, u, PointSubset::All, &mut force);
    force
}

fn largest(vector: &[f64]) -> f64 {
    vector.iter().fold(0.0, |most, x| most.max(x.abs()))
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter()
        .zip(b)
        .fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}

/// Strains of 0.01 use the polynomials, strains of 0.2 the exact forms.
#[test]
fn every_instruction_set_equals_the_definition() {
    for function in functions() {
        for (cloud, constants) in bodies(&function) {
            let bonds = families(&cloud, &constants);
            let twin = Twin {
                cloud: &cloud,
                bonds: &bonds,
                influence: &constants.influence,
                horizon: constants.horizon,
                dilatational: constants.dilatational,
                deviatoric: constants.deviatoric,
                intact: &|_, _| true,
            };
            for size in [0.002, 0.15] {
                let u = wave(&cloud, size);
                let (force, energy) = (twin.force(&u), twin.energy(&u));
                for set in InstructionSet::available() {
                    let mut operator = operator(&cloud, &constants);
                    operator.use_instruction_set(set);
                    assert_eq!(operator.instruction_set(), set);
                    let found = force_of(&*operator, &u);
                    let error = distance(&found, &force) / largest(&force);
                    assert!(error < 1e-12, "{function:?}, {set:?}, {size}: {error:e}");
                    let error = (operator.energy(0.0, &u) / energy - 1.0).abs();
                    assert!(error < 1e-12, "{function:?}, {set:?}, {size}: {error:e}");
                }
            }
        }
    }
}

#[test]
fn rigid_motions_cause_no_force_and_momenta_are_conserved() {
    for function in functions() {
        for (cloud, constants) in bodies(&function) {
            let operator = operator(&cloud, &constants);
            let (n, dimension) = (cloud.len(), cloud.dimension());
            let u = wave(&cloud, 0.15);
            let force = force_of(&*operator, &u);
            // A rotation by one radian in the plane of the first two axes.
            let mut turned = vec![0.3; u.len()];
            if dimension > 1 {
                let (sine, cosine) = 1f64.sin_cos();
                for i in 0..n {
                    let [x, y, _] = cloud.point(i);
                    turned[i] += (cosine - 1.0) * x - sine * y;
                    turned[n + i] += sine * x + (cosine - 1.0) * y;
                }
            }
            let error = largest(&force_of(&*operator, &turned)) / largest(&force);
            assert!(error < 1e-11, "{function:?}: {error:e}");
            let volumes = cloud.volumes();
            let push = |c: usize, i: usize| force[c * n + i] * volumes[i];
            let place = |c: usize, i: usize| cloud.point(i)[c] + u[c * n + i];
            for c in 0..dimension {
                let sum: f64 = (0..n).map(|i| push(c, i)).sum();
                let size: f64 = (0..n).map(|i| push(c, i).abs()).sum();
                assert!(sum.abs() < 1e-14 * size, "{function:?}: {sum:e} of {size}");
                for d in 0..c {
                    let torque = |i: usize| place(c, i) * push(d, i) - place(d, i) * push(c, i);
                    let sum: f64 = (0..n).map(torque).sum();
                    let size: f64 = (0..n).map(|i| torque(i).abs()).sum();
                    assert!(sum.abs() < 1e-13 * size, "{function:?}: {sum:e} of {size}");
                }
            }
        }
    }
}

/// Also with a pre-crack, several materials and broken bonds: m does not change.
#[test]
fn forces_are_energy_gradients_and_tangents_are_symmetric_force_derivatives() {
    for strains in [Strains::Finite, Strains::Small] {
        let cloud = jittered(&[9, 9]);
        let function = InfluenceFunction::Conical;
        let state = StressState::PlaneStrain;
        let materials = [0.1, 0.45].map(|nu| {
            let mut constants = solid(nu, 2.7, function.clone())
                .constants(&cloud, state)
                .unwrap();
            constants.limits = BondLimits {
                stretch: 0.03,
                ..BondLimits::NONE
            };
            constants
        });
        let of_point = (0..cloud.len() as u8).map(|i| i % 2).collect();
        let classes = LinearSolidConstants::several(of_point, &materials).unwrap();
        let crack = Crack::Segment {
            from: [0.0, 4.5],
            to: [3.0, 4.5],
        };
        let body = LinearSolidBody {
            classes: Some(&classes),
            strains,
            cracks: &[(crack, EndRule::Closed)],
            ..LinearSolidBody::new(&cloud, &materials[0], VolumeCorrection::None)
        };
        let AssembledBonds {
            mut operator, cuts, ..
        } = body.operator(BondForm::Fastest).unwrap();
        assert!(cuts[0].bonds > 10);
        let u = wave(&cloud, 0.06);
        let step = StepEnd::sub_step(0.0, 0.0, &u);
        operator.end_step(&step, PointSubset::All, &mut vec![0.0; u.len()]);
        assert!(operator.broken_bonds() > 10);
        let (a, b) = (noise(u.len(), 0.2), noise(u.len(), 5.1));
        let h = 1e-5;
        let moved = |h: f64| -> Vec<f64> { u.iter().zip(&a).map(|(u, a)| u + h * a).collect() };
        let volumes = cloud.volumes();
        let inner = |x: &[f64], y: &[f64]| -> f64 {
            let terms = x.iter().zip(y).enumerate();
            terms
                .map(|(k, (x, y))| x * y * volumes[k % volumes.len()])
                .sum()
        };
        let work = inner(&force_of(&*operator, &u), &a);
        let slope =
            (operator.energy(0.0, &moved(h)) - operator.energy(0.0, &moved(-h))) / (2.0 * h);
        assert!((slope + work).abs() < 1e-8 * work.abs(), "{slope} {work}");
        let tangent = |direction: &[f64]| {
            let mut out = vec![f64::NAN; u.len()];
            operator.tangent_into(0.0, &u, direction, &mut out);
            out
        };
        let (ka, kb) = (tangent(&a), tangent(&b));
        let (up, down) = (
            force_of(&*operator, &moved(h)),
            force_of(&*operator, &moved(-h)),
        );
        for k in 0..u.len() {
            let slope = (up[k] - down[k]) / (2.0 * h);
            assert!(
                (slope - ka[k]).abs() < 1e-8 * largest(&ka),
                "{k}: {slope} {}",
                ka[k]
            );
        }
        let (ab, ba) = (inner(&ka, &b), inner(&a, &kb));
        assert!(
            (ab - ba).abs() < 1e-13 * inner(&ka, &ka).sqrt(),
            "{ab} {ba}"
        );
    }
}

#[test]
fn small_strains_are_the_linearisation() {
    for (cloud, constants) in bodies(&InfluenceFunction::Conical) {
        let body = LinearSolidBody {
            strains: Strains::Small,
            ..LinearSolidBody::new(&cloud, &constants, VolumeCorrection::None)
        };
        let linear = body.operator(BondForm::Fastest).unwrap().operator;
        assert!(linear.is_linear());
        let u = wave(&cloud, 1.0);
        let rest = vec![0.0; u.len()];
        let mut tangent = rest.clone();
        operator(&cloud, &constants).tangent_into(0.0, &rest, &u, &mut tangent);
        let error = distance(&force_of(&*linear, &u), &tangent) / largest(&tangent);
        assert!(error < 1e-13, "{error:e}");
    }
}

/// Dilatation and energy density of a uniform strain, for any points; for shear only the mean over all directions,
/// so that a lattice with its isotropic function is used.
#[test]
fn uniform_strains_of_a_lattice_have_the_energy_of_elasticity() {
    let cases = [
        (StressState::PlaneStress, 2, 3.0),
        (StressState::PlaneStrain, 2, 3.0),
        (StressState::Spatial, 3, 3.0),
    ];
    for (state, dimension, horizon) in cases {
        let cloud = boxed([0.0; 3], &vec![9.0; dimension], 1.0, 1.0);
        for nu in [-0.5, 0.1, 0.45] {
            let material = LinearSolid {
                influence: StateInfluence::Isotropic,
                ..solid(nu, horizon * (1.0 + 1e-6), InfluenceFunction::Constant)
            };
            let constants = material.constants(&cloud, state).unwrap();
            let operator = operator(&cloud, &constants);
            let n = cloud.len();
            let middle = cloud.nearest([4.5; 3]);
            let strain = [
                [3e-5, -2e-5, 1e-5],
                [-2e-5, 5e-5, 4e-5],
                [1e-5, 4e-5, -6e-5],
            ];
            let mut u = vec![0.0; dimension * n];
            for i in 0..n {
                let x = cloud.point(i);
                for c in 0..dimension {
                    u[c * n + i] = (0..dimension).map(|k| strain[c][k] * x[k]).sum();
                }
            }
            let body = LinearSolidBody {
                strains: Strains::Small,
                ..LinearSolidBody::new(&cloud, &constants, VolumeCorrection::None)
            };
            let linear = body.operator(BondForm::Fastest).unwrap().operator;
            let mut density = vec![0.0; n];
            linear.add_energy_density(0.0, &u, &mut density);
            let trace: f64 = (0..dimension).map(|c| strain[c][c]).sum();
            let all: f64 = (0..dimension)
                .flat_map(|c| (0..dimension).map(move |k| (c, k)))
                .map(|(c, k)| strain[c][k] * strain[c][k])
                .sum();
            let (shear, kappa) = (
                constants.elastic.shear(),
                constants.elastic.dilatation_modulus(state),
            );
            let deviator = all - trace * trace / dimension as f64;
            let exact = 0.5 * kappa * trace * trace + shear * deviator;
            let error = (density[middle] / exact - 1.0).abs();
            assert!(error < 1e-12, "{state:?}, {nu}: {error:e}");
            // The interior is in equilibrium.
            let force = force_of(&*linear, &u);
            let inside =
                (0..dimension).fold(0.0f64, |most, c| most.max(force[c * n + middle].abs()));
            assert!(inside < 1e-13 * largest(&force), "{state:?}, {nu}");
            assert!(largest(&force_of(&*operator, &u)) > 0.0);
        }
    }
}

/// ν = 1/4, and 1/3 in plane stress: A = 0. A bond-based material with the stiffness (B/m_i + B/m_j) w r has the
/// same forces.
#[test]
fn solids_without_a_dilatational_part_equal_bond_based_materials() {
    let cloud = boxed([0.0; 3], &[7.0, 6.0, 5.0], 1.0, 1.0);
    let constants = solid(0.25, 2.0, InfluenceFunction::Conical)
        .constants(&cloud, StressState::Spatial)
        .unwrap();
    assert!(constants.dilatational.abs() < 1e-14 * constants.deviatoric);
    let body = LinearSolidBody::new(&cloud, &constants, VolumeCorrection::Extended);
    let state_based = body.operator(BondForm::Fastest).unwrap().operator;
    let bonds = BondList::new(&cloud, 2.0, VolumeCorrection::Extended).unwrap();
    let twin = Twin {
        cloud: &cloud,
        bonds: &bonds,
        influence: &constants.influence,
        horizon: 2.0,
        dilatational: 0.0,
        deviatoric: constants.deviatoric,
        intact: &|_, _| true,
    };
    let m: Vec<f64> = (0..cloud.len()).map(|i| twin.weighted_volume(i)).collect();
    let stiffness = |i: usize, j: usize, xi: [f64; 3]| {
        let r = xi.iter().map(|x| x * x).sum::<f64>().sqrt();
        let weight = constants.influence.alpha_of(xi, 2.0) * r;
        constants.deviatoric * (1.0 / m[i] + 1.0 / m[j]) * weight
    };
    let bond_based = BondForce::<BondStretch, 3>::with_pair_stiffness(
        cloud.clone(),
        bonds.clone(),
        &stiffness,
        pericles::operator::Breaking {
            critical_stretch: f64::INFINITY,
            no_fail: &[],
        },
        DamageMeasure::default(),
    )
    .unwrap();
    let u = wave(&cloud, 0.1);
    let (a, b) = (force_of(&*state_based, &u), force_of(&bond_based, &u));
    assert!(distance(&a, &b) < 1e-13 * largest(&b));
    let energies = [state_based.energy(0.0, &u), bond_based.energy(0.0, &u)];
    assert!((energies[0] / energies[1] - 1.0).abs() < 1e-13);
}

/// In the interior of a lattice the bond-based material with the same modulus, calibrated on the lattice, has twice
/// the stiffness B/m: both materials are equal.
#[test]
fn solid_with_poisson_ratio_one_quarter_equals_the_bond_based_material_in_the_interior() {
    let cloud = boxed([0.0; 3], &[9.0, 9.0], 1.0, 1.0);
    let horizon = 2.0;
    let constants = solid(0.25, horizon, InfluenceFunction::Inverse)
        .constants(&cloud, StressState::PlaneStrain)
        .unwrap();
    let state_based = operator(&cloud, &constants);
    let mut material = bond_based(
        1.0,
        10.0,
        horizon,
        VolumeCorrection::None,
        Fracture::Unbreakable,
    );
    material.influence = Influence {
        function: InfluenceFunction::Inverse,
        acts_on: ActsOn::Displacement,
    };
    material.modulus = Modulus {
        value: ElasticModulus::Young(10.0),
        calibration: Calibration::Lattice,
    };
    let bond_constants = material
        .constants(&cloud, StressState::PlaneStrain)
        .unwrap();
    let bonds = BondList::new(&cloud, horizon, VolumeCorrection::None).unwrap();
    let bond_based = BondForce::<BondStretch, 2>::new(
        cloud.clone(),
        bonds,
        &material,
        &bond_constants,
        &[],
        DamageMeasure::default(),
    )
    .unwrap();
    let u = wave(&cloud, 0.01);
    let (a, b) = (force_of(&*state_based, &u), force_of(&bond_based, &u));
    let (n, middle) = (cloud.len(), cloud.nearest([4.5; 3]));
    for c in 0..2 {
        let (a, b) = (a[c * n + middle], b[c * n + middle]);
        assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
    }
}

#[test]
fn the_frequency_bound_is_an_upper_bound() {
    for (cloud, constants) in bodies(&InfluenceFunction::Conical) {
        let operator = operator(&cloud, &constants);
        let bound = operator.frequency_bound(&|_| 1.0);
        let system = System::new(cloud.clone(), operator, PointScalar::Uniform(1.0)).unwrap();
        let rest = vec![0.0; cloud.dimension() * cloud.len()];
        let found = frequency_from_below(&system, &rest, 100);
        assert!(found <= bound && found > 0.3 * bound, "{found} {bound}");
    }
}

#[test]
fn the_force_on_a_point_does_not_depend_on_subsets_or_threads() {
    let cloud = boxed([0.0; 3], &[12.0, 11.0, 10.0], 1.0, 1.0);
    let constants = solid(0.4, 2.5, InfluenceFunction::Conical)
        .constants(&cloud, StressState::Spatial)
        .unwrap();
    let operator = operator(&cloud, &constants);
    let u = wave(&cloud, 0.05);
    let whole = force_of(&*operator, &u);
    for threads in [1, 2, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let force = pool.unwrap().install(|| force_of(&*operator, &u));
        assert_eq!(force, whole, "{threads} threads");
    }
    let n = cloud.len();
    let third: Vec<u32> = (0..n as u32).filter(|i| i % 3 == 1).collect();
    for on in [PointSubset::Set(&third), PointSubset::Range(500..700)] {
        let wanted = |i: usize| match &on {
            PointSubset::Set(set) => set.contains(&(i as u32)),
            PointSubset::Range(range) => range.contains(&i),
            PointSubset::All => true,
        };
        // Dilatations of a previous evaluation must not be used.
        force_of(&*operator, &noise(u.len(), 0.1));
        let mut part = vec![0.0; u.len()];
        operator.add_force(0.0, &u, on.clone(), &mut part);
        for k in 0..u.len() {
            let expected = if wanted(k % n) { whole[k] } else { 0.0 };
            assert_eq!(part[k], expected, "{k}");
        }
    }
}

/// σ = κ tr ε + 2 G dev ε inside a lattice with its isotropic function.
#[test]
fn the_virial_stress_of_a_uniform_strain_equals_elasticity() {
    let cloud = boxed([0.0; 3], &[13.0, 13.0], 1.0, 1.0);
    let state = StressState::PlaneStress;
    let material = LinearSolid {
        influence: StateInfluence::Isotropic,
        ..solid(0.4, 3.0 * (1.0 + 1e-6), InfluenceFunction::Constant)
    };
    let constants = material.constants(&cloud, state).unwrap();
    let body = LinearSolidBody {
        strains: Strains::Small,
        ..LinearSolidBody::new(&cloud, &constants, VolumeCorrection::None)
    };
    let operator = body.operator(BondForm::Fastest).unwrap().operator;
    let (n, middle) = (cloud.len(), cloud.nearest([6.5; 3]));
    let strain = [[3e-3, -2e-3], [-2e-3, 5e-3]];
    let mut u = vec![0.0; 2 * n];
    for k in 0..2 * n {
        let x = cloud.point(k % n);
        u[k] = strain[k / n][0] * x[0] + strain[k / n][1] * x[1];
    }
    let bonds = operator.as_bonds().unwrap();
    let mut stress = [[0.0; 2]; 2];
    bonds.for_each_bond(&bonds.values_at(Field::new(&u, &[])), middle, &mut |bond| {
        for a in 0..2 {
            for b in 0..2 {
                stress[a][b] += 0.5 * bond.force[a] * bond.xi[b];
            }
        }
    });
    let (kappa, shear) = (
        constants.elastic.dilatation_modulus(state),
        constants.elastic.shear(),
    );
    let trace = strain[0][0] + strain[1][1];
    for a in 0..2 {
        for b in 0..2 {
            let identity = f64::from(u8::from(a == b));
            let deviator = strain[a][b] - 0.5 * trace * identity;
            let expected = kappa * trace * identity + 2.0 * shear * deviator;
            let error = (stress[a][b] / expected - 1.0).abs();
            assert!(error < 1e-12, "{a}, {b}: {error:e}");
        }
    }
}

#[test]
fn the_forces_of_single_bonds_add_up_to_the_force() {
    for (cloud, constants) in bodies(&InfluenceFunction::Gaussian {
        length: 1.3,
        cutoff: None,
    }) {
        let operator = operator(&cloud, &constants);
        let u = wave(&cloud, 0.15);
        let force = force_of(&*operator, &u);
        let bonds = operator.as_bonds().unwrap();
        let values = bonds.values_at(Field::new(&u, &[]));
        for i in 0..cloud.len() {
            let mut sum = [0.0; 3];
            bonds.for_each_bond(&values, i, &mut |bond| {
                (0..3).for_each(|c| sum[c] += bond.force[c]);
            });
            for c in 0..cloud.dimension() {
                let error = (sum[c] - force[c * cloud.len() + i]).abs() / largest(&force);
                assert!(error < 1e-12, "{error:e}");
            }
        }
    }
}
