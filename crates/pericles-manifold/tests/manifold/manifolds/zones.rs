//! Zone decomposition of surface forces, and multirate schemes on one surface.

use pericles::operator::PointSubset;
use pericles::time::{Fine, Follow, Integrator, Respa};
use pericles::{Path, StepEnd};
use pericles_manifold::{PowerMaterial, SurfaceBond};

use super::sphere::*;

/// Marks of a part of the sphere and of the rest, with their points.
fn zones(sphere: &Sphere) -> [(Vec<bool>, Vec<u32>); 2] {
    let n = sphere.cloud.len();
    [true, false].map(|inside| {
        let marks: Vec<bool> = (0..n).map(|i| ((i * i) % 7 < 3) == inside).collect();
        let points = (0..n as u32).filter(|&i| marks[i as usize]).collect();
        (marks, points)
    })
}

fn brittle(bond: SurfaceBond, critical_stretch: f64) -> PowerMaterial {
    PowerMaterial {
        bond,
        critical_stretch,
        ..material(3.0, 0.5)
    }
}

const BONDS: [SurfaceBond; 2] = [SurfaceBond::Displacement, SurfaceBond::Chord];

#[test]
fn partial_forces_sum_to_the_total_and_are_opposite() {
    let sphere = Sphere::standard();
    let n = sphere.cloud.len();
    let u = noise(3 * n, 7);
    let [(inside, inner), (outside, outer)] = zones(&sphere);
    for bond in BONDS {
        let operator = sphere.operator(&brittle(bond, f64::INFINITY));
        let local = operator.as_local().unwrap();
        let split = operator.as_split().unwrap();
        for i in 0..n {
            let mut family = Vec::new();
            local.neighbours(i, &mut |j| family.push(j as u32));
            assert_eq!(family, sphere.pairs.row(i).0);
        }
        let whole = force(&*operator, &u);
        let scale = whole.iter().fold(0.0_f64, |max, f| max.max(f.abs()));
        let mut parts = vec![0.0; 3 * n];
        split.add_force_from(0.0, &u, PointSubset::All, &inside, &mut parts);
        split.add_force_from(0.0, &u, PointSubset::All, &outside, &mut parts);
        for k in 0..3 * n {
            assert!((parts[k] - whole[k]).abs() < 1e-12 * scale);
        }
        let mut exchange = vec![0.0; 3 * n];
        split.add_force_from(0.0, &u, PointSubset::Set(&inner), &outside, &mut exchange);
        assert!((0..3 * n).all(|k| inside[k % n] || exchange[k] == 0.0));
        split.add_force_from(0.0, &u, PointSubset::Set(&outer), &inside, &mut exchange);
        for component in exchange.chunks(n) {
            let terms = component.iter().zip(sphere.cloud.volumes());
            let sum: f64 = terms.map(|(f, area)| f * area).sum();
            assert!(sum.abs() < 1e-12 * scale, "{sum}");
        }
    }
}

#[test]
fn breaking_by_partners_affects_only_their_bonds() {
    let sphere = Sphere::standard();
    let n = sphere.cloud.len();
    let (u, v) = (noise(3 * n, 8), noise(3 * n, 9));
    let end = StepEnd {
        t: 0.0,
        dt: 1e-3,
        u: &u,
        path: Path::MeanVelocity(&v),
    };
    let [(inside, inner), (outside, outer)] = zones(&sphere);
    for bond in BONDS {
        let material = brittle(bond, 6.0);
        let mut at_once = sphere.operator(&material);
        let mut expected = vec![0.0; 3 * n];
        at_once.end_step(&end, PointSubset::All, &mut expected);
        let mut parts = sphere.operator(&material);
        let mut sum = vec![0.0; 3 * n];
        let pairs = [
            (&outer, &outside),
            (&inner, &outside),
            (&inner, &inside),
            (&outer, &inside),
        ];
        let counts = pairs.map(|(rows, partners)| {
            let split = parts.split_mut().unwrap();
            split.end_step_from(&end, PointSubset::Set(rows), partners, &mut sum);
            parts.broken_bonds()
        });
        assert!(counts[0] > 5 && counts[0] < counts[1] && counts[1] < counts[2]);
        // The last pair was decided from its other end.
        assert_eq!(counts[2], counts[3]);
        assert_eq!(counts[3], at_once.broken_bonds());
        assert!((parts.dissipated() / at_once.dissipated() - 1.0).abs() < 1e-12);
        let scale = expected.iter().fold(0.0_f64, |max, f| max.max(f.abs()));
        assert!((0..3 * n).all(|k| (sum[k] - expected[k]).abs() < 1e-12 * scale));
    }
}

#[test]
fn endangered_points_have_bonds_that_would_break_at_a_lower_limit() {
    let sphere = Sphere::standard();
    let n = sphere.cloud.len();
    let u: Vec<f64> = noise(3 * n, 8).iter().map(|u| u.powi(3)).collect();
    let (critical, fraction) = (9.5, 0.8);
    let mut weak = sphere.operator(&brittle(SurfaceBond::Displacement, fraction * critical));
    weak.end_step(
        &StepEnd::sub_step(0.0, 0.0, &u),
        PointSubset::All,
        &mut vec![0.0; u.len()],
    );
    let mut damage = vec![0.0; n];
    weak.damage_into(&mut damage);
    let expected: Vec<bool> = damage.iter().map(|&damage| damage > 0.0).collect();
    assert!(expected.contains(&true) && expected.contains(&false));
    let mut marks = vec![false; n];
    let operator = sphere.operator(&brittle(SurfaceBond::Displacement, critical));
    let breaking = operator.capabilities().breaking.unwrap();
    breaking.mark_endangered(&u, fraction, &mut marks);
    assert_eq!(marks, expected);
}

#[test]
fn multirate_scheme_conserves_momentum_and_energy() {
    let sphere = Sphere::standard();
    let north: Vec<u32> = (0..sphere.cloud.len() as u32)
        .filter(|&i| sphere.cloud.point(i as usize)[2] > 0.3)
        .collect();
    for (fine, critical) in [
        (Fine::Fixed(vec![north]), f64::INFINITY),
        (Fine::Adaptive(Follow::default()), 0.5),
    ] {
        let system = sphere.system(&brittle(SurfaceBond::Displacement, critical));
        let scheme: Box<dyn Integrator> = Box::new(Respa::new(4, fine, &system).unwrap());
        let before = system.momentum(&sphere.thrown(1.0).v);
        let (run, change) = spread(system, scheme, sphere.thrown(1.0), 0.01, 60);
        let after = run.system().momentum(&run.state().v);
        for c in 0..3 {
            assert!((after[c] - before[c]).abs() < 1e-11);
        }
        let energies = run.snapshot().energies();
        if critical.is_finite() {
            assert!(run.system().operator().broken_bonds() > 10);
            let balance = energies.balance().abs() / energies.initial;
            assert!(balance < 5e-3, "{balance}");
        } else {
            assert!(change < 1e-3, "{change}");
        }
    }
}
