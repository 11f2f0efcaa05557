//! Forces of heated bodies: free and constrained expansion, derivatives.

use std::sync::Arc;

use crate::bodies::{jittered, noise, solid, wave};
use crate::setup::{ALPHA, Model, expansion, models, operator, plate};
use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{Strains, StressState};
use pericles::operator::{BondForm, Force, LinearSolidBody, PointSubset};
use pericles::space::{Grid, PointCloud};
use pericles::{Path, StepEnd};
use pericles_solids::inelastic::Inelasticity;

fn force_at(force: &dyn Force, t: f64, u: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; u.len()];
    force.add_force(t, u, PointSubset::All, &mut out);
    out
}

fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |most, x| most.max(x.abs()))
}

/// u = τ x.
fn expanded(cloud: &PointCloud, stretch: f64) -> Vec<f64> {
    let n = cloud.len();
    let of = |entry: usize| stretch * cloud.point(entry % n)[entry / n];
    (0..cloud.dimension() * n).map(of).collect()
}

/// E α ΔT over the spacing is 0.1 N/m³.
#[test]
fn free_expansion_causes_no_force_or_energy() {
    for model in models() {
        for sides in [&[12, 8][..], &[5, 5, 5], &[20]] {
            if sides.len() == 1 && !matches!(model, Model::Bonds(_)) {
                continue;
            }
            let cloud = jittered(sides);
            let mut force = operator(&cloud, &model, f64::INFINITY);
            force.expand(expansion(&cloud, [1.0, 0.0, 0.0])).unwrap();
            let u = expanded(&cloud, 0.01);
            let found = largest(&force_at(&*force, 0.0, &u));
            assert!(found < 1e-12 * 0.1, "{model:?}, {sides:?}: {found:e}");
            let energy = force.energy(0.0, &u);
            assert!(energy.abs() < 1e-12, "{model:?}: {energy:e}");
        }
    }
}

/// σ = −3 K α ΔT in three dimensions, −E α ΔT/(1 − ν) in plane stress: the dilatation of state-based solids is
/// exact on any lattice.
#[test]
fn constrained_expansion_has_the_stress_of_linear_elasticity() {
    let (young, nu) = (10.0, 0.35);
    let stretch = 100.0 * ALPHA;
    let cases = [
        (
            Grid::block([9.0, 9.0, 9.0], 1.0),
            StressState::Spatial,
            young / (1.0 - 2.0 * nu),
        ),
        (
            Grid::plate([13.0, 13.0], 1.0, 1.0),
            StressState::PlaneStress,
            young / (1.0 - nu),
        ),
    ];
    for (grid, state, modulus) in cases {
        let cloud = Arc::new(grid.points().unwrap());
        let constants = solid(nu, 2.5, InfluenceFunction::Constant);
        let constants = constants.constants(&cloud, state).unwrap();
        let body = LinearSolidBody::new(&cloud, &constants, VolumeCorrection::None);
        let mut force = body.operator(BondForm::List).unwrap().operator;
        force.expand(expansion(&cloud, [1.0, 0.0, 0.0])).unwrap();
        let n = cloud.len();
        let u = vec![0.0; cloud.dimension() * n];
        force_at(&*force, 0.0, &u);
        let middle = (0..n)
            .min_by(|&a, &b| {
                let from = |i: usize| {
                    let x = cloud.point(i);
                    let side = if state == StressState::Spatial {
                        4.5
                    } else {
                        6.5
                    };
                    (0..cloud.dimension())
                        .map(|c| (x[c] - side).powi(2))
                        .sum::<f64>()
                };
                from(a).total_cmp(&from(b))
            })
            .unwrap();
        let mut stress = 0.0;
        let field = pericles::domain::Field::new(&u, &[]);
        let bonds = force.as_bonds().unwrap();
        bonds.for_each_bond(&bonds.values_at(field), middle, &mut |bond| {
            stress += 0.5 * bond.force[0] * bond.xi[0];
        });
        let expected = -modulus * stretch;
        assert!(
            (stress / expected - 1.0).abs() < 1e-12,
            "{stress} {expected}"
        );
    }
}

/// Applies a step of 0.4 s; with a critical stretch some bonds break in it.
fn moved(force: &mut dyn Force, cloud: &PointCloud) -> Vec<f64> {
    let start = vec![0.0; 2 * cloud.len()];
    let u = wave(cloud, 0.05);
    for (t, dt, from, to) in [(0.0, 0.0, &start, &start), (0.4, 0.4, &start, &u)] {
        let rate = |(from, to): (&f64, &f64)| if dt > 0.0 { (to - from) / dt } else { 0.0 };
        let mean: Vec<f64> = from.iter().zip(to).map(rate).collect();
        let end = StepEnd {
            t,
            dt,
            u: to,
            path: Path::MeanVelocity(&mean),
        };
        force.end_step(&end, PointSubset::All, &mut vec![0.0; u.len()]);
    }
    let noise = noise(u.len(), 1.0);
    u.iter()
        .zip(noise)
        .map(|(u, add)| -0.5 * u + 0.01 * add)
        .collect()
}

#[test]
fn the_force_is_the_gradient_of_the_energy() {
    for model in models() {
        for limit in [f64::INFINITY, 0.05] {
            let (cloud, mut force) = plate(&model, [1.0, 2.0, 0.3], limit);
            let u = moved(&mut *force, &cloud);
            let broken = force.broken_bonds();
            assert_eq!(broken > 0, limit.is_finite(), "{model:?}: {broken}");
            // At the end of the last step, so that inelastic stretches belong to the energy.
            let t = 0.4;
            if matches!(&model, Model::Solid(_, Inelasticity::Plastic(_))) {
                // The force within a plastic step contains its own flow.
                continue;
            }
            let found = force_at(&*force, t, &u);
            let d = noise(u.len(), 3.0);
            let h = 1e-5;
            let at = |s: f64| {
                let u: Vec<f64> = u.iter().zip(&d).map(|(u, d)| u + s * d).collect();
                force.energy(t, &u)
            };
            let slope = (at(h) - at(-h)) / (2.0 * h);
            let n = cloud.len();
            let work: f64 = (0..u.len())
                .map(|k| -found[k] * d[k] * cloud.volumes()[k % n])
                .sum();
            let size: f64 = (0..u.len()).map(|k| (found[k] * d[k]).abs()).sum();
            assert!(
                (slope - work).abs() < 1e-8 * size,
                "{model:?}: {slope} {work}"
            );
        }
    }
}

#[test]
fn the_tangent_is_the_derivative_of_the_force() {
    for model in models() {
        let (cloud, mut force) = plate(&model, [1.0, 2.0, 0.3], 0.05);
        let u = moved(&mut *force, &cloud);
        let (t, h) = (0.5, 1e-6);
        let d = noise(u.len(), 5.0);
        let mut tangent = vec![0.0; u.len()];
        force.tangent_into(t, &u, &d, &mut tangent);
        let at = |s: f64| {
            let u: Vec<f64> = u.iter().zip(&d).map(|(u, d)| u + s * d).collect();
            force_at(&*force, t, &u)
        };
        let (up, down) = (at(h), at(-h));
        let size = largest(&tangent);
        for k in 0..u.len() {
            let slope = (up[k] - down[k]) / (2.0 * h);
            assert!((slope - tangent[k]).abs() < 1e-6 * size, "{model:?}");
        }
    }
}

/// Two fixed points: the bond breaks where its length relative to the stress-free length exceeds the critical
/// stretch.
#[test]
fn cooling_breaks_bonds_at_the_critical_stretch() {
    let limit = 0.01;
    for model in [
        Model::Bonds(pericles::material::PairLaw::BondStretch),
        Model::Solid(Strains::Finite, Inelasticity::Elastic),
    ] {
        for (margin, breaks) in [(0.999, false), (1.001, true)] {
            let cloud = jittered(&[12, 8]);
            // 1/(1 + τ) − 1 = limit
            let stretch = 1.0 / (1.0 + margin * limit) - 1.0;
            let mut force = operator(&cloud, &model, limit);
            let heat = expansion(&cloud, [100.0 * stretch, 0.0, 0.0]);
            force.expand(heat).unwrap();
            let u = vec![0.0; 2 * cloud.len()];
            let end = StepEnd::start(0.0, &u, &u);
            force.end_step(&end, PointSubset::All, &mut vec![0.0; u.len()]);
            assert_eq!(force.broken_bonds() > 0, breaks, "{model:?}, {margin}");
        }
    }
}

/// Displacements in single precision are relative to one point; thermal stretches are not.
#[test]
fn stencils_in_single_precision_return_an_error() {
    use pericles::material::{BondMaterial, ElasticModulus};
    use pericles::operator::BondBody;
    let cloud = Arc::new(Grid::plate([12.0, 8.0], 1.0, 1.0).points().unwrap());
    let material = BondMaterial::new(ElasticModulus::Young(10.0), 1.0, 3.0);
    let constants = material
        .constants(&cloud, StressState::PlaneStress)
        .unwrap();
    let body = BondBody::new(&cloud, &material, &constants);
    let mut force = body.operator(BondForm::FloatGrid).unwrap().operator;
    let error = force
        .expand(expansion(&cloud, [1.0, 0.0, 0.0]))
        .unwrap_err();
    assert!(error.to_string().contains("double precision"), "{error}");
}
