//! Force operator of a surface: energy, tangent, symmetries, spectrum.

use std::f64::consts::TAU;

use pericles::cache::NoCache;
use pericles::operator::{Force, InstructionSet, PointSubset};
use pericles::time::highest_frequency;
use pericles_manifold::force::{DisplacementBond, HalfInteger};
use pericles_manifold::geodesic::{Ball, GeodesicMethod};
use pericles_manifold::{PowerMaterial, SurfaceBond};

use super::sphere::*;

fn materials() -> Vec<PowerMaterial> {
    let mut all = Vec::new();
    for p in [2.0, 2.5, 2.7, 3.0, 3.5, 4.0, 4.5, 5.0, 5.5, 6.0] {
        for bond in [SurfaceBond::Displacement, SurfaceBond::Chord] {
            all.push(PowerMaterial {
                bond,
                ..material(p, 0.5)
            });
        }
    }
    all.push(PowerMaterial {
        self_interaction: true,
        ..material(2.0, 0.75)
    });
    all
}

/// A displacement and two directions. All chords are stretched: length and elongation stay away from zero,
/// where difference quotients fail.
fn states(sphere: &Sphere, bond: SurfaceBond) -> [Vec<f64>; 3] {
    let x = sphere.cloud.positions();
    [1, 2, 3].map(|seed| {
        let noise = noise(x.len(), seed);
        match bond {
            SurfaceBond::Displacement => noise,
            SurfaceBond::Chord if seed == 1 => x
                .iter()
                .zip(&noise)
                .map(|(x, n)| 0.1 * x + 1e-3 * n)
                .collect(),
            SurfaceBond::Chord => noise.iter().map(|n| 1e-2 * n).collect(),
        }
    })
}

#[test]
fn forces_are_minus_the_gradient_of_the_energy() {
    let sphere = Sphere::standard();
    for material in materials() {
        let [u, q, _] = states(&sphere, material.bond);
        let operator = sphere.operator(&material);
        let slope = derivative(1e-2, |h| operator.energy(0.0, &sum_of(&u, h, &q)));
        let work = sphere.inner(&force(&*operator, &u), &q);
        let f = force(&*operator, &u);
        let scale = (sphere.inner(&f, &f) * sphere.inner(&q, &q)).sqrt();
        assert!(
            (slope + work).abs() < 1e-9 * scale,
            "p = {}, {:?}: {slope} and {work}",
            material.p,
            material.bond
        );
    }
}

#[test]
fn tangents_are_symmetric_derivatives_of_the_force() {
    let sphere = Sphere::standard();
    let n = 3 * sphere.cloud.len();
    for material in materials() {
        let [u, d, e] = states(&sphere, material.bond);
        let operator = sphere.operator(&material);
        let tangent = |d: &[f64]| {
            let mut out = vec![f64::NAN; n];
            operator.tangent_into(0.0, &u, d, &mut out);
            out
        };
        let (along, across) = (tangent(&d), tangent(&e));
        let slope = derivative(1e-2, |h| {
            sphere.inner(&force(&*operator, &sum_of(&u, h, &d)), &e)
        });
        let [work, turned] = [sphere.inner(&along, &e), sphere.inner(&across, &d)];
        let scale = sphere.inner(&along, &d).abs();
        assert!((slope - work).abs() < 1e-6 * scale, "p = {}", material.p);
        assert!((turned - work).abs() < 1e-12 * scale, "p = {}", material.p);
        if material.bond == SurfaceBond::Displacement {
            assert!(sphere.inner(&along, &d) < 0.0);
        }
    }
}

#[test]
fn translations_cost_no_energy_and_rotations_none_for_chords() {
    let sphere = Sphere::standard();
    let n = sphere.cloud.len();
    let x = sphere.cloud.positions();
    // A rotation by 0.3 about z, and a translation.
    let (sin, cos) = 0.3_f64.sin_cos();
    let rotated: Vec<f64> = (0..3 * n)
        .map(|k| match k / n {
            0 => (cos - 1.0) * x[k] - sin * x[k + n],
            1 => sin * x[k - n] + (cos - 1.0) * x[k],
            _ => 0.0,
        })
        .collect();
    let moved: Vec<f64> = (0..3 * n).map(|k| [0.1, -2.0, 0.4][k / n]).collect();
    let largest = |x: Vec<f64>| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for p in [2.0, 3.0] {
        for bond in [SurfaceBond::Displacement, SurfaceBond::Chord] {
            let operator = sphere.operator(&PowerMaterial {
                bond,
                ..material(p, 0.5)
            });
            assert!(largest(force(&*operator, &moved)) < 1e-11);
            let resisted = largest(force(&*operator, &rotated));
            match bond {
                SurfaceBond::Displacement => assert!(resisted > 1e-2, "{resisted}"),
                SurfaceBond::Chord => assert!(resisted < 1e-11, "{resisted}"),
            }
            // Momentum: Σ A K u = 0 for any u.
            let f = force(&*operator, &noise(3 * n, 5));
            for c in 0..3 {
                let total: f64 = (0..n)
                    .map(|i| sphere.cloud.volumes()[i] * f[c * n + i])
                    .sum();
                assert!(total.abs() < 1e-11, "{total}");
            }
        }
    }
}

#[test]
fn instruction_sets_and_subdomains_give_equal_forces() {
    let sphere = Sphere::standard();
    let n = sphere.cloud.len();
    let u = noise(3 * n, 4);
    let material = material(3.0, 0.5);
    let on = |set| {
        sphere
            .body(&material)
            .force(DisplacementBond(HalfInteger::<2, 0>))
            .with_instruction_set(set)
    };
    let baseline = force(&on(InstructionSet::Baseline), &u);
    for set in InstructionSet::available() {
        let operator = on(set);
        let whole = force(&operator, &u);
        for k in 0..3 * n {
            assert!((whole[k] - baseline[k]).abs() < 1e-12 * baseline[k].abs().max(1.0));
        }
        let some: Vec<u32> = (0..n as u32).filter(|i| i % 5 == 2).collect();
        let mut part = vec![0.0; 3 * n];
        operator.add_force(0.0, &u, PointSubset::Set(&some), &mut part);
        let mut range = vec![0.0; 3 * n];
        operator.add_force(0.0, &u, PointSubset::Range(100..600), &mut range);
        for k in 0..3 * n {
            let i = k % n;
            assert_eq!(part[k], if i % 5 == 2 { whole[k] } else { 0.0 });
            assert_eq!(
                range[k],
                if (100..600).contains(&i) {
                    whole[k]
                } else {
                    0.0
                }
            );
        }
    }
}

#[test]
fn breathing_periods_and_highest_frequencies_match_reference_values() {
    // Computed from the scalar eigenproblem by an independent code: distances along edges, great-circle arcs,
    // and distances along edges within the Euclidean ball.
    let sphere = Sphere::standard();
    let exact = Sphere::new(3, arcs);
    let euclid = Sphere::new(3, |surface| {
        Ball::Euclid
            .pairs(surface, 0.5, GeodesicMethod::Edge, &NoCache)
            .unwrap()
    });
    let counts = [&sphere, &exact, &euclid].map(|sphere| sphere.pairs.len());
    assert_eq!(counts, [22740, 23580, 23940]);
    let expected = [
        (1e-4, 11.351, 10.556, 11.130, 3.400),
        (0.5, 6.126, 5.667, 6.065, 8.007),
        (0.999, 2.989, 2.791, 2.977, 20.17),
    ];
    for (alpha, edges, great_circles, ball, highest) in expected {
        let material = material(2.0, alpha);
        let period = |sphere: &Sphere| TAU / breathing(sphere, &material).0.sqrt();
        assert!((period(&sphere) / edges - 1.0).abs() < 1e-3);
        assert!((period(&exact) / great_circles - 1.0).abs() < 1e-3);
        assert!((period(&euclid) / ball - 1.0).abs() < 1e-3);
        let system = sphere.system(&material);
        let found = highest_frequency(&system, &vec![0.0; 3 * sphere.cloud.len()]).unwrap();
        assert!(found.converged && (found.estimate / highest - 1.0).abs() < 1e-3);
        assert!(found.bound >= found.estimate);
    }
}

#[test]
fn self_interaction_converges_to_the_continuum() {
    // 2π ∫ (1 − cos t) sin t t^−(2+2α) dt up to 0.5.
    let continuum = [
        (0.25, 0.72096),
        (0.5, 1.53856),
        (0.75, 4.38811),
        (0.999, 1568.5),
    ];
    let spheres = [Sphere::new(2, arcs), Sphere::new(3, arcs)];
    for (alpha, expected) in continuum {
        let error = |sphere: &Sphere, self_interaction| {
            let material = PowerMaterial {
                self_interaction,
                ..material(2.0, alpha)
            };
            (breathing(sphere, &material).0 / expected - 1.0).abs()
        };
        let [with, without] = [true, false].map(|term| error(&spheres[1], term));
        assert!(
            with < 0.045 && with < without,
            "α = {alpha}: {with}, {without}"
        );
        assert!(with < error(&spheres[0], true), "α = {alpha}: {with}");
    }
}
