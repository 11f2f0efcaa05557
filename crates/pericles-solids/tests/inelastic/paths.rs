//! Plastic paths: the yield surface, and closed forms for uniform strains.

use std::sync::Arc;

use crate::bodies::{jittered, solid, wave};
use crate::setup::{operator, plastic, scaled, step};
use pericles::family::VolumeCorrection;
use pericles::kernel::{Influence, InfluenceFunction};
use pericles::material::{LinearSolidConstants, StressState};
use pericles::operator::{Force, LinearSolidBody, SmallStrain};
use pericles::space::{Grid, PointCloud, Shape};
use pericles_solids::inelastic::{InelasticSolid, InelasticSolidBody, Inelasticity, Yield};
use pericles_solids::solid::SolidForce;

/// Bonds of a point from the definitions: ω r², w and the entry.
fn bonds(
    force: &pericles::family::BondList,
    cloud: &PointCloud,
    influence: &Influence,
    i: usize,
) -> Vec<(f64, f64, usize, usize)> {
    let horizon = force.horizon();
    let family = force.family(i);
    family
        .map(|(entry, j)| {
            let xi = force.vector(i, j);
            let w = influence.alpha_of(xi, horizon);
            let r = force.length(i, j);
            let weight = w * force.volume_factor(i, j) * cloud.volumes()[j];
            (weight * r * r, w, entry, j)
        })
        .collect()
}

/// |t| of a point divided by its strength, from stretches and inelastic stretches.
fn load(
    constants: &LinearSolidConstants,
    bonds: &[(f64, f64, usize, usize)],
    deviators: &[f64],
) -> f64 {
    let m: f64 = bonds.iter().map(|bond| bond.0).sum();
    let pairs = bonds.iter().zip(deviators);
    let square: f64 = pairs.map(|(bond, e)| bond.0 * bond.1 * e * e).sum();
    constants.deviatoric / m * square.sqrt()
}

#[test]
fn force_states_return_to_the_yield_surface_and_flow_dissipates() {
    for function in [InfluenceFunction::Constant, InfluenceFunction::Inverse] {
        for hardening in [0.0, 3.0] {
            let (cloud, law) = (jittered(&[6, 5, 5]), plastic(0.2, hardening));
            let material = solid(0.3, 2.3, function.clone());
            let constants = material.constants(&cloud, StressState::Spatial).unwrap();
            let mut operator = operator::<3>(&cloud, &constants, &law);
            let n = cloud.len();
            let shape = wave(&cloud, 0.02);
            let mut before = scaled(&shape, 0.0);
            step(&mut operator, [0.0, 0.0], &before, &before);
            let (mut strain, mut dissipated) = (vec![0.0; n], 0.0);
            for k in 1..=12 {
                let t = f64::from(k);
                let u = scaled(&shape, (0.5 * t).sin());
                step(&mut operator, [t, 1.0], &before, &u);
                let force = &operator;
                let list = force.list();
                for i in 0..n {
                    let family = bonds(list, &cloud, &constants.influence, i);
                    let stretch = |j: usize| {
                        let xi = list.vector(i, j);
                        let y: f64 = (0..3)
                            .map(|c| (xi[c] + u[c * n + j] - u[c * n + i]).powi(2))
                            .sum();
                        y.sqrt() / list.length(i, j) - 1.0
                    };
                    let elastic: Vec<f64> = family
                        .iter()
                        .map(|&(.., entry, j)| stretch(j) - force.bond_history(entry, 1))
                        .collect();
                    let m: f64 = family.iter().map(|bond| bond.0).sum();
                    let mean = family.iter().zip(&elastic).map(|(bond, e)| bond.0 * e);
                    let mean = mean.sum::<f64>() / m;
                    let deviators: Vec<f64> = elastic.iter().map(|e| e - mean).collect();
                    let limit = force.shape(i).unwrap().strength
                        * (1.0 + hardening * force.history_of(i)[0] / 0.2);
                    let part = load(&constants, &family, &deviators) / limit;
                    assert!(part < 1.0 + 1e-12, "{part}");
                    if force.history_of(i)[0] > strain[i] {
                        assert!(part > 1.0 - 1e-12, "{part}");
                    }
                }
                strain = (0..strain.len()).map(|i| force.history_of(i)[0]).collect();
                let now = (&operator as &dyn Force).dissipated();
                assert!(now >= dissipated);
                dissipated = now;
                before = u;
            }
            assert!(strain.iter().filter(|&&strain| strain > 0.0).count() > n / 2);
        }
    }
}

#[test]
fn pure_dilatation_causes_no_plastic_flow() {
    let cloud = jittered(&[5, 5, 5]);
    let constants = solid(0.3, 2.3, InfluenceFunction::Conical);
    let constants = constants.constants(&cloud, StressState::Spatial).unwrap();
    let mut operator = operator::<3>(&cloud, &constants, &plastic(1e-3, 0.0));
    let n = cloud.len();
    let u: Vec<f64> = (0..3 * n).map(|k| 0.3 * cloud.axis(k / n)[k % n]).collect();
    step(&mut operator, [1.0, 1.0], &scaled(&u, 0.0), &u);
    assert!((0..cloud.len()).all(|i| operator.history_of(i)[1] == 0.0));
}

type Lattice<const D: usize> = SolidForce<InelasticSolid<SmallStrain>, D>;

/// A lattice of 9 cells along each axis and its middle point, for small strains.
fn lattice<const D: usize>(
    function: InfluenceFunction,
    spacings: f64,
    law: &Inelasticity,
) -> (Arc<PointCloud>, LinearSolidConstants, Lattice<D>, usize) {
    let cells = 2 * spacings as usize + 3;
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: vec![cells as f64; D],
        },
        spacing: 1.0,
        section: 1.0,
        holes: vec![],
    };
    let cloud = Arc::new(grid.points().unwrap());
    let state = match D {
        3 => StressState::Spatial,
        _ => StressState::PlaneStrain,
    };
    let mut material = solid(0.3, spacings * (1.0 + 1e-6), function);
    material.volume_correction = VolumeCorrection::Linear;
    let constants = material.constants(&cloud, state).unwrap();
    let laws = [law.clone()];
    let body = InelasticSolidBody {
        elastic: LinearSolidBody::new(&cloud, &constants, VolumeCorrection::Linear),
        laws: &laws,
    };
    let (force, _) = body.force::<SmallStrain, D>().unwrap();
    let middle = cloud.nearest([cells as f64 / 2.0; 3]);
    (cloud, constants, force, middle)
}

/// u = H x.
fn uniform(cloud: &PointCloud, gradient: [[f64; 3]; 3]) -> Vec<f64> {
    let (n, dimension) = (cloud.len(), cloud.dimension());
    let of = |k: usize| {
        let x = cloud.point(k % n);
        (0..dimension).map(|c| gradient[k / n][c] * x[c]).sum()
    };
    (0..dimension * n).map(of).collect()
}

/// Stretches of the bonds of a point minus their weighted mean, for u = H x.
fn deviators(
    list: &pericles::family::BondList,
    family: &[(f64, f64, usize, usize)],
    i: usize,
    gradient: [[f64; 3]; 3],
) -> Vec<f64> {
    let stretch = |j: usize| {
        let xi = list.vector(i, j);
        let square: f64 = xi.iter().map(|x| x * x).sum();
        let along: f64 = (0..3)
            .flat_map(|a| (0..3).map(move |b| (a, b)))
            .map(|(a, b)| gradient[a][b] * xi[a] * xi[b])
            .sum();
        along / square
    };
    let all: Vec<f64> = family.iter().map(|bond| stretch(bond.3)).collect();
    let m: f64 = family.iter().map(|bond| bond.0).sum();
    let mean = family
        .iter()
        .zip(&all)
        .map(|(bond, e)| bond.0 * e)
        .sum::<f64>()
        / m;
    all.iter().map(|e| e - mean).collect()
}

const SHEAR: [[f64; 3]; 3] = [[0.0, 1.0, 0.0], [0.0; 3], [0.0; 3]];
const STRETCH: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, -0.3, 0.0], [0.0, 0.0, -0.3]];

/// Along a proportional path the deviatoric state keeps its direction, so that its flow follows from scalars:
/// loading, unloading and reverse yielding, in any number of steps.
#[test]
fn proportional_paths_follow_their_closed_form() {
    for gradient in [SHEAR, STRETCH] {
        for (hardening, steps) in [(0.0, 1), (0.0, 7), (2.0, 1), (2.0, 7)] {
            let yields = Yield {
                stress: 0.2,
                hardening,
            };
            let law = Inelasticity::Plastic(yields);
            let (cloud, constants, mut operator, middle) =
                lattice::<3>(InfluenceFunction::Conical, 2.0, &law);
            let list = operator.list();
            let family = bonds(list, &cloud, &constants.influence, middle);
            let unit = deviators(list, &family, middle, gradient);
            let norm = load(&constants, &family, &unit);
            let m: f64 = family.iter().map(|bond| bond.0).sum();
            let square: f64 = family
                .iter()
                .zip(&unit)
                .map(|(bond, e)| bond.0 * e * e)
                .sum();
            let equivalent = (5.0 * square / m).sqrt();
            let strength = operator.shape(middle).unwrap().strength;
            let slope = strength * hardening * equivalent / yields.stress;
            let (mut plastic, mut strain) = (0.0, 0.0);
            let unit_u = uniform(&cloud, gradient);
            let (mut t, mut size) = (0.0, 0.0);
            for target in [0.06, 0.05, -0.08, 0.1] {
                let start = size;
                for k in 1..=steps {
                    let next = start + (target - start) * k as f64 / steps as f64;
                    let [from, to] = [size, next].map(|size| scaled(&unit_u, size));
                    t += 1.0;
                    step(&mut operator, [t, 1.0], &from, &to);
                    size = next;
                }
                // |target − plastic| norm = strength (1 + H strain/σ) at the end of plastic flow.
                let elastic: f64 = target - plastic;
                let over =
                    elastic.abs() * norm - strength * (1.0 + hardening * strain / yields.stress);
                if over > 0.0 {
                    let flow = over / (norm + slope);
                    plastic += flow * elastic.signum();
                    strain += flow * equivalent;
                }
                let force = &operator;
                let found = force.history_of(middle)[0];
                assert!(
                    (found - strain).abs() <= 1e-13,
                    "{target}: {found} {strain}"
                );
                for ((.., entry, _), e) in family.iter().zip(&unit) {
                    let stretch = force.bond_history(*entry, 1);
                    assert!((stretch - plastic * e).abs() < 1e-13);
                }
            }
            assert!(strain > 0.05);
        }
    }
}

/// G γ √3/σ_y at yield in simple shear, and the equivalent strain over γ/√3. An independent implementation found
/// 0.988 to 1.016 in three dimensions and 0.997 to 1.003 in the plane for 200 directions, with horizons longer by
/// 0.015 spacings; hence bounds wider by 0.003.
#[test]
fn lattices_yield_at_the_given_stress() {
    let law = plastic(0.2, 0.0);
    let turned = |gradient: [[f64; 3]; 3], [c, s]: [f64; 2]| {
        // R H Rᵀ with a rotation about z.
        let rotation = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]];
        let mut out = [[0.0; 3]; 3];
        for (a, b) in (0..3).flat_map(|a| (0..3).map(move |b| (a, b))) {
            for (k, l) in (0..3).flat_map(|k| (0..3).map(move |l| (k, l))) {
                out[a][b] += rotation[a][k] * gradient[k][l] * rotation[b][l];
            }
        }
        out
    };
    let check = |norm: f64, equivalent: f64, strength: f64, shear: f64, [low, high]: [f64; 2]| {
        let ratio = strength / norm * shear * 3f64.sqrt() / 0.2;
        assert!((low..=high).contains(&ratio), "{ratio}");
        assert!(
            (equivalent * 3f64.sqrt() - 1.0).abs() < 0.05,
            "{equivalent}"
        );
    };
    let (c3, constants3, force3, i3) = lattice::<3>(InfluenceFunction::Inverse, 3.0, &law);
    let (c2, constants2, force2, i2) = lattice::<2>(InfluenceFunction::Inverse, 6.0, &law);
    for angle in [0.0, 0.2, 0.4, 0.6, std::f64::consts::FRAC_PI_4] {
        let gradient = turned(SHEAR, [f64::cos(angle), f64::sin(angle)]);
        let list = force3.list();
        let family = bonds(list, &c3, &constants3.influence, i3);
        let (m, unit) = (
            family.iter().map(|bond| bond.0).sum::<f64>(),
            deviators(list, &family, i3, gradient),
        );
        let square: f64 = family
            .iter()
            .zip(&unit)
            .map(|(bond, e)| bond.0 * e * e)
            .sum();
        let norm = load(&constants3, &family, &unit);
        let strength = force3.shape(i3).unwrap().strength;
        let shear = constants3.elastic.shear();
        check(
            norm,
            (5.0 * square / m).sqrt(),
            strength,
            shear,
            [0.985, 1.019],
        );
        let list = force2.list();
        let family = bonds(list, &c2, &constants2.influence, i2);
        let (m, unit) = (
            family.iter().map(|bond| bond.0).sum::<f64>(),
            deviators(list, &family, i2, gradient),
        );
        let square: f64 = family
            .iter()
            .zip(&unit)
            .map(|(bond, e)| bond.0 * e * e)
            .sum();
        let norm = load(&constants2, &family, &unit);
        let strength = force2.shape(i2).unwrap().strength;
        let shear = constants2.elastic.shear();
        let equivalent = (8.0 / 3.0 * square / m).sqrt();
        check(norm, equivalent, strength, shear, [0.994, 1.006]);
    }
}
