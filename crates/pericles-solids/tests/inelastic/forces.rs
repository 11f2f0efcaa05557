//! Forces of inelastic solids: elastic limits, derivatives, energy.

use crate::bodies::{jittered, noise, solid, wave};
use crate::setup::{difference, force_at, plastic, scaled, step, viscous};
use pericles::StepEnd;
use pericles::domain::Field;
use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{
    BondLimits, GivenConstants, LinearSolid, LinearSolidConstants, SolidSurface, StressState,
};
use pericles::operator::{BondForm, Force, LinearSolidBody, PointSubset};
use pericles_solids::inelastic::{InelasticSolidBody, Inelasticity};

const STATES: [(&[usize], StressState); 3] = [
    (&[5, 5, 5], StressState::Spatial),
    (&[9, 9], StressState::PlaneStrain),
    (&[9, 9], StressState::PlaneStress),
];

fn list(
    sides: &[usize],
    state: StressState,
    function: InfluenceFunction,
    law: &Inelasticity,
    limits: BondLimits,
) -> (Box<dyn Force>, Vec<f64>, Vec<f64>) {
    let cloud = jittered(sides);
    let mut constants = solid(0.35, 2.5, function).constants(&cloud, state).unwrap();
    constants.limits = limits;
    let laws = [law.clone()];
    let body = InelasticSolidBody {
        elastic: LinearSolidBody::new(&cloud, &constants, VolumeCorrection::None),
        laws: &laws,
    };
    let operator = body.operator(BondForm::Fastest).unwrap().operator;
    (operator, wave(&cloud, 0.05), cloud.volumes().to_vec())
}

#[test]
fn elastic_laws_and_unreachable_yield_stresses_give_the_elastic_force() {
    for (sides, state) in STATES {
        let cloud = jittered(sides);
        let constants = solid(0.35, 2.5, InfluenceFunction::Conical).constants(&cloud, state);
        let constants = constants.unwrap();
        let elastic = LinearSolidBody::new(&cloud, &constants, VolumeCorrection::None);
        let elastic = elastic.operator(BondForm::List).unwrap().operator;
        for law in [Inelasticity::Elastic, plastic(1e9, 0.0)] {
            let (mut operator, u, _) = list(
                sides,
                state,
                InfluenceFunction::Conical,
                &law,
                BondLimits::NONE,
            );
            let found = step(&mut *operator, [1.0, 1.0], &scaled(&u, 0.0), &u);
            assert!(difference(&found, &force_at(&*elastic, 0.0, &u)) < 1e-13);
            let error = operator.energy(1.0, &u) / elastic.energy(0.0, &u) - 1.0;
            assert!(error.abs() < 1e-13, "{error:e}");
            assert_eq!(operator.dissipated(), 0.0);
        }
    }
}

/// The force is linear in the moduli: under a constant displacement it equals that of an elastic solid with the
/// same dilatation modulus and the shear modulus G(t).
#[test]
fn stress_relaxation_follows_the_shear_modulus() {
    let terms = [[0.3, 0.2], [0.25, 3.0]];
    for (sides, state) in STATES {
        let cloud = jittered(sides);
        let material = solid(0.35, 2.5, InfluenceFunction::Inverse);
        let (mut operator, u, _) = list(
            sides,
            state,
            InfluenceFunction::Inverse,
            &viscous(&terms),
            BondLimits::NONE,
        );
        step(&mut *operator, [0.0, 0.0], &u, &u);
        let mut t = 0.0;
        for dt in [1e-7, 1e-3, 0.05, 0.4, 2.0, 30.0] {
            t += dt;
            let found = step(&mut *operator, [t, dt], &u, &u);
            let part = |[share, time]: [f64; 2]| share * (-t / time).exp_m1();
            let relaxed = 1.0 + terms.iter().map(|&term| part(term)).sum::<f64>();
            let constants = material.constants(&cloud, state).unwrap();
            // B is proportional to G, and A + B/D to the dilatation modulus.
            let dimension = cloud.dimension() as f64;
            let mut elastic = constants.clone();
            elastic.deviatoric *= relaxed;
            elastic.dilatational += constants.deviatoric * (1.0 - relaxed) / dimension;
            let body = LinearSolidBody::new(&cloud, &elastic, VolumeCorrection::None);
            let body = body.operator(BondForm::List).unwrap().operator;
            let error = difference(&found, &force_at(&*body, 0.0, &u));
            assert!(error < 1e-13, "{state:?}, {t}: {error:e}");
        }
    }
}

/// Applies two steps; with a critical stretch some bonds break in the first.
fn with_history(operator: &mut dyn Force, u: &[f64]) -> Vec<f64> {
    let n = u.len();
    let start = scaled(u, 0.0);
    step(operator, [0.0, 0.0], &start, &start);
    step(operator, [0.5, 0.5], &start, u);
    let mut next = scaled(u, -0.4);
    for (k, add) in noise(n, 2.0).iter().enumerate() {
        next[k] += 0.01 * add;
    }
    step(operator, [0.8, 0.3], u, &next);
    next
}

const BREAKING: BondLimits = BondLimits {
    stretch: 0.06,
    ..BondLimits::NONE
};

#[test]
fn the_force_is_the_gradient_of_the_free_energy_at_fixed_history() {
    for limits in [BondLimits::NONE, BREAKING] {
        for (sides, state) in STATES {
            // A plastic point does not flow under unloading.
            for (law, factor) in [(viscous(&[[0.4, 0.3]]), 1.2), (plastic(0.3, 2.0), 0.9)] {
                let function = InfluenceFunction::Conical;
                let (mut operator, u, volumes) = list(sides, state, function, &law, limits);
                let u = with_history(&mut *operator, &u);
                let u = scaled(&u, factor);
                let broken = operator.broken_bonds();
                assert_eq!(broken > 20, limits.can_break(), "{broken}");
                let direction = noise(u.len(), 0.3);
                let h = 1e-6;
                let at = |h: f64| -> f64 {
                    let moved: Vec<f64> =
                        u.iter().zip(&direction).map(|(u, d)| u + h * d).collect();
                    operator.energy(0.8, &moved)
                };
                let force = force_at(&*operator, 0.8, &u);
                let n = volumes.len();
                let power: f64 = (0..u.len())
                    .map(|k| -force[k] * direction[k] * volumes[k % n])
                    .sum();
                let error = (at(h) - at(-h)) / (2.0 * h) / power - 1.0;
                assert!(
                    error.abs() < 1e-6,
                    "{law:?} {state:?} {limits:?}: {error:e}"
                );
            }
        }
    }
}

#[test]
fn the_tangent_is_the_derivative_of_the_force_in_the_step() {
    for (function, symmetric) in [
        (InfluenceFunction::Constant, true),
        (InfluenceFunction::Inverse, false),
    ] {
        for (sides, state) in STATES {
            for (law, symmetric) in [
                (viscous(&[[0.4, 0.3], [0.2, 2.0]]), true),
                (plastic(0.3, 0.0), symmetric),
                (plastic(0.3, 4.0), symmetric),
            ] {
                let (mut operator, u, volumes) =
                    list(sides, state, function.clone(), &law, BREAKING);
                let u = with_history(&mut *operator, &u);
                // Within a step of a quarter of a second in which plastic points flow.
                let (t, u) = (1.05, scaled(&u, -1.5));
                let [direction, other] = [0.3, 7.0].map(|seed| noise(u.len(), seed));
                let tangent = |direction: &[f64]| {
                    let mut out = vec![0.0; u.len()];
                    operator.tangent_into(t, &u, direction, &mut out);
                    out
                };
                let h = 1e-7;
                let at = |h: f64| -> Vec<f64> {
                    let moved: Vec<f64> =
                        u.iter().zip(&direction).map(|(u, d)| u + h * d).collect();
                    force_at(&*operator, t, &moved)
                };
                let pairs = at(h).into_iter().zip(at(-h));
                let differences: Vec<f64> = pairs.map(|(a, b)| (a - b) / (2.0 * h)).collect();
                let found = tangent(&direction);
                let error = difference(&found, &differences);
                assert!(error < 1e-6, "{law:?} {state:?}: {error:e}");
                let n = volumes.len();
                let product = |a: &[f64], b: &[f64]| -> f64 {
                    (0..a.len()).map(|k| a[k] * b[k] * volumes[k % n]).sum()
                };
                let [ab, ba] = [
                    product(&other, &found),
                    product(&direction, &tangent(&other)),
                ];
                if symmetric {
                    assert!((ab / ba - 1.0).abs() < 1e-9, "{law:?} {state:?}: {ab} {ba}");
                }
            }
        }
    }
}

#[test]
fn single_bonds_add_up_to_the_force() {
    for law in [viscous(&[[0.4, 0.3]]), plastic(0.3, 1.0)] {
        let (mut operator, u, _) = list(
            &[9, 9],
            StressState::PlaneStrain,
            InfluenceFunction::Conical,
            &law,
            BREAKING,
        );
        let u = with_history(&mut *operator, &u);
        let force = force_at(&*operator, 0.8, &u);
        let n = u.len() / 2;
        let mut sums = vec![0.0; u.len()];
        let bonds = operator.as_bonds().unwrap();
        let values = bonds.values_at(Field::new(&u, &[]));
        for i in 0..n {
            bonds.for_each_bond(&values, i, &mut |bond| {
                sums[i] += bond.force[0];
                sums[n + i] += bond.force[1];
            });
        }
        assert!(difference(&sums, &force) < 1e-12);
    }
}

/// The energy that a point loses with its bonds is the difference of its free energies with and without them. Both
/// bodies have the same history: in the last step no time passes, and plastic points unload because the body expands
/// and its shear decreases.
#[test]
fn breaking_dissipates_the_free_energy_lost() {
    for law in [viscous(&[[0.4, 0.3]]), plastic(0.03, 1.0)] {
        let cloud = jittered(&[9, 9]);
        let bodies = [BondLimits::NONE, BREAKING].map(|limits| {
            let (mut operator, u, _) = list(
                &[9, 9],
                StressState::PlaneStrain,
                InfluenceFunction::Constant,
                &law,
                limits,
            );
            let (rest, small) = (scaled(&u, 0.0), scaled(&u, 0.3));
            let n = cloud.len();
            let expanded = |(k, u): (usize, &f64)| 0.9 * u + 0.057 * cloud.point(k % n)[k / n];
            let large: Vec<f64> = small.iter().enumerate().map(expanded).collect();
            step(&mut *operator, [0.0, 0.0], &rest, &rest);
            step(&mut *operator, [0.5, 0.5], &rest, &small);
            assert_eq!(operator.broken_bonds(), 0);
            let flow = operator.dissipated();
            let mut force = vec![0.0; u.len()];
            operator.end_step(
                &StepEnd::sub_step(0.5, 0.0, &large),
                PointSubset::All,
                &mut force,
            );
            let energy = operator.energy(0.5, &large);
            let spent = operator.dissipated() - flow;
            (energy, spent, flow, operator.broken_bonds())
        });
        let [(whole, unloaded, flow, none), (torn, spent, _, broken)] = bodies;
        assert!(none == 0 && broken > 20 && flow > 0.0, "{broken}");
        assert_eq!(unloaded, 0.0, "{law:?}");
        let error = spent / (whole - torn) - 1.0;
        assert!(error.abs() < 1e-12, "{law:?}: {error:e}");
    }
}

#[test]
fn unsupported_features_of_inelastic_bodies_are_errors() {
    let cloud = jittered(&[6, 6]);
    let constants = solid(0.3, 2.5, InfluenceFunction::Conical);
    let constants = constants
        .constants(&cloud, StressState::PlaneStrain)
        .unwrap();
    let laws = [viscous(&[[0.4, 0.3]])];
    let body = |constants, surface, laws| InelasticSolidBody {
        elastic: LinearSolidBody {
            surface,
            ..LinearSolidBody::new(&cloud, constants, VolumeCorrection::None)
        },
        laws,
    };
    for (body, form, words) in [
        (
            body(&constants, SolidSurface::Energy, &laws),
            BondForm::List,
            "the surface correction of viscous and plastic materials",
        ),
        (
            body(&constants, SolidSurface::None, &laws),
            BondForm::Grid,
            "use bonds = \"list\"",
        ),
        (
            body(&constants, SolidSurface::None, &[]),
            BondForm::List,
            "one for each material",
        ),
    ] {
        let message = body.operator(form).err().unwrap().to_string();
        assert!(message.contains(words), "{message}");
    }
}

/// A viscous and a plastic material side by side with an elastic one between them: each point follows its own
/// material, and forces add up to zero.
#[test]
fn different_materials_combine_in_one_body() {
    let cloud = jittered(&[12, 6]);
    let n = cloud.len();
    let material = |ratio: f64| LinearSolid {
        elastic: GivenConstants {
            young: Some(10.0),
            poisson_ratio: Some(ratio),
            ..GivenConstants::default()
        },
        ..solid(0.3, 2.5, InfluenceFunction::Conical)
    };
    let constants: Vec<_> = [0.1, 0.3, 0.4]
        .map(|ratio| {
            material(ratio)
                .constants(&cloud, StressState::PlaneStrain)
                .unwrap()
        })
        .into();
    let of_point = (0..n).map(|i| (cloud.point(i)[0] / 4.0) as u8).collect();
    let classes = LinearSolidConstants::several(of_point, &constants).unwrap();
    let laws = [
        viscous(&[[0.4, 0.3], [0.1, 2.0]]),
        Inelasticity::Elastic,
        plastic(0.1, 1.0),
    ];
    let body = InelasticSolidBody {
        elastic: LinearSolidBody {
            classes: Some(&classes),
            ..LinearSolidBody::new(&cloud, &constants[0], VolumeCorrection::None)
        },
        laws: &laws,
    };
    let mut operator = body.operator(BondForm::Fastest).unwrap().operator;
    let u = wave(&cloud, 0.05);
    let u = with_history(&mut *operator, &u);
    let force = force_at(&*operator, 0.9, &u);
    for c in 0..2 {
        let total: f64 = (0..n).map(|i| force[c * n + i] * cloud.volumes()[i]).sum();
        assert!(total.abs() < 1e-13, "{total:e}");
    }
    let mut part = vec![0.0; u.len()];
    let odd: Vec<u32> = (0..n as u32).filter(|i| i % 2 == 1).collect();
    operator.add_force(0.9, &u, PointSubset::Set(&odd), &mut part);
    for &i in &odd {
        assert_eq!(part[i as usize].to_bits(), force[i as usize].to_bits());
    }
}
