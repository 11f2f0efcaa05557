//! Bodies whose materials have different horizons.

use std::sync::Arc;

use crate::common::{boxed, material};
use pericles::family::{Crack, EndRule, VolumeCorrection};
use pericles::material::{
    BondMaterial, Fracture, InterfaceRule, MaterialPairs, PairLaw, StressState,
};
use pericles::operator::{
    AssembledBonds, BondBody, BondForm, CompositeBody, DamageMeasure, Force, GradedBody, Materials,
    PointSubset,
};
use pericles::space::PointCloud;
use pericles::time::{State, VelocityVerlet};
use pericles::{Control, PointScalar, Simulation, System};

fn of(young: f64, horizon: f64, stretch: f64) -> BondMaterial {
    let fracture = Fracture::CriticalStretch(stretch);
    let correction = VolumeCorrection::Extended;
    material(1.0, young, horizon, correction, fracture)
}

fn state(dimension: usize) -> StressState {
    match dimension {
        1 => StressState::Uniaxial,
        2 => StressState::PlaneStress,
        _ => StressState::Spatial,
    }
}

/// Three materials in oblique layers along x.
fn layers(cloud: &PointCloud, length: f64) -> Vec<u8> {
    let layer = |i: usize| {
        let [x, y, z] = cloud.point(i);
        let s = (x + 0.3 * y - 0.2 * z) / length;
        u8::from(s > 0.35) + u8::from(s > 0.7)
    };
    (0..cloud.len()).map(layer).collect()
}

fn graded(
    cloud: &Arc<PointCloud>,
    all: &[BondMaterial],
    of_point: &[u8],
    cracks: &[(Crack, EndRule)],
    form: BondForm,
) -> AssembledBonds {
    let body = GradedBody {
        cloud,
        ratios: &[1],
        grid_of_point: &vec![0; cloud.len()],
        material: &all[0],
        materials: Some(Materials {
            all,
            of_point,
            interfaces: &[],
        }),
        state: state(cloud.dimension()),
        cracks,
        no_fail: &[0, 3, 7],
        stiffness: &[],
        damage: DamageMeasure::default(),
    };
    let assembled = body.operator(form).unwrap();
    assert_eq!(assembled.form, form);
    assembled
}

fn whole(
    cloud: &Arc<PointCloud>,
    all: &[BondMaterial],
    of_point: &[u8],
    form: BondForm,
) -> Box<dyn Force> {
    graded(cloud, all, of_point, &[], form).operator
}

fn noise(cloud: &PointCloud, size: f64) -> Vec<f64> {
    let len = cloud.len() * cloud.dimension();
    (0..len)
        .map(|k| size * ((k * k) as f64 * 0.7 + 0.3 * k as f64).sin())
        .collect()
}

fn force_of(force: &dyn Force, u: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; u.len()];
    force.add_force(0.0, u, PointSubset::All, &mut out);
    out
}

fn assert_close(a: &[f64], b: &[f64], tolerance: f64) {
    let scale = b.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    let most = apart.fold(0.0, f64::max);
    assert!(most <= tolerance * scale, "{most:e} of {scale:e}");
}

/// ½ (c_i κ_i + c_j κ_j) s n V_j over all pairs within the larger of both horizons; c_i is the constant of the pair
/// of materials for the horizon of i.
fn by_pairs(cloud: &PointCloud, all: &[BondMaterial], of_point: &[u8], u: &[f64]) -> Vec<f64> {
    let (n, dimension) = (cloud.len(), cloud.dimension());
    let constant = |a: usize, b: usize| {
        let c = [a, b].map(|material| {
            let own = BondMaterial {
                horizon: all[a].horizon,
                ..all[material].clone()
            };
            let constants = own.constants(cloud, state(dimension)).unwrap();
            constants.micromodulus
        });
        2.0 * c[0] * c[1] / (c[0] + c[1])
    };
    let table: Vec<Vec<f64>> = (0..all.len())
        .map(|a| (0..all.len()).map(|b| constant(a, b)).collect())
        .collect();
    let mut out = vec![0.0; u.len()];
    for i in 0..n {
        for j in (0..n).filter(|&j| j != i) {
            let xi: [f64; 3] = std::array::from_fn(|c| cloud.point(j)[c] - cloud.point(i)[c]);
            let mut y = xi;
            for c in 0..dimension {
                y[c] += u[c * n + j] - u[c * n + i];
            }
            let norm = |x: [f64; 3]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
            let (r, length) = (norm(xi), norm(y));
            let end = |here: usize, there: usize| {
                let [a, b] = [here, there].map(|i| usize::from(of_point[i]));
                let kappa = VolumeCorrection::Extended.factor(r, all[a].horizon, cloud.spacing());
                table[a][b] * kappa
            };
            let stiffness = 0.5 * (end(i, j) + end(j, i)) * cloud.volumes()[j];
            for c in 0..dimension {
                out[c * n + i] += stiffness * (length / r - 1.0) * y[c] / length;
            }
        }
    }
    out
}

#[test]
fn forces_are_means_of_the_laws_of_both_end_points() {
    for size in [vec![40.0], vec![19.0, 11.0], vec![12.0, 7.0, 6.0]] {
        let cloud = boxed([0.0; 3], &size, 1.0, 1.0);
        let of_point = layers(&cloud, size[0]);
        let all = [of(1.0, 2.0, 0.1), of(3.0, 3.5, 0.1), of(0.5, 2.6, 0.1)];
        for form in [BondForm::List, BondForm::Grid] {
            check_force(&cloud, &all, &of_point, form);
        }
    }
}

fn check_force(cloud: &Arc<PointCloud>, all: &[BondMaterial], of_point: &[u8], form: BondForm) {
    let force = whole(cloud, all, of_point, form);
    let u = noise(cloud, 0.02);
    let found = force_of(&*force, &u);
    assert_close(&found, &by_pairs(cloud, all, of_point, &u), 1e-12);
    // Forces on both ends are opposite, and the force is the gradient of the energy.
    let total: f64 = found.iter().sum();
    let size: f64 = found.iter().map(|f| f.abs()).sum();
    assert!(total.abs() < 1e-13 * size, "{total:e} of {size:e}");
    let direction = noise(cloud, 1.7);
    let energy = |step: f64| {
        let moved: Vec<f64> = u
            .iter()
            .zip(&direction)
            .map(|(u, d)| u + step * d)
            .collect();
        force.energy(0.0, &moved)
    };
    let slope = (energy(1e-5) - energy(-1e-5)) / 2e-5;
    let power: f64 = found.iter().zip(&direction).map(|(f, d)| f * d).sum();
    let power = power * cloud.volumes()[0];
    assert!((slope / -power - 1.0).abs() < 1e-6, "{slope} {power}");
}

#[test]
fn materials_with_equal_horizons_equal_a_body_of_several_materials() {
    let cloud = boxed([0.0; 3], &[19.0, 11.0], 1.0, 1.0);
    let of_point = layers(&cloud, 19.0);
    let all = [of(1.0, 3.0, 0.1), of(3.0, 3.0, 0.1), of(0.5, 3.0, 0.1)];
    let constants = [0, 1, 2].map(|k: usize| all[k].constants(&cloud, state(2)).unwrap());
    let classes = MaterialPairs::new(of_point.clone(), &constants, InterfaceRule::Harmonic);
    let classes = classes.unwrap();
    let body = CompositeBody {
        classes: Some(&classes),
        ..CompositeBody::from(BondBody::new(&cloud, &all[0], &constants[0]))
    };
    let expected = body.operator(BondForm::List).unwrap().operator;
    let found = whole(&cloud, &all, &of_point, BondForm::List);
    assert_eq!(found.directed_bonds(), expected.directed_bonds());
    let u = noise(&cloud, 0.02);
    assert_close(&force_of(&*found, &u), &force_of(&*expected, &u), 1e-14);
}

/// The force in a section of a strained bar is E ε A where all bonds across it have the same horizon. The
/// forces near the interface of two horizons add up to zero.
#[test]
fn section_force_of_a_strained_bar_is_equal_on_both_sides_of_a_change_of_horizon() {
    let cloud = boxed([0.0; 3], &[60.0], 1.0, 1.0);
    let of_point: Vec<u8> = (0..60).map(|i| u8::from(i >= 30)).collect();
    let all = [of(1.0, 5.0, 0.1), of(1.0, 2.0, 0.1)].map(|material| BondMaterial {
        law: PairLaw::Linear,
        modulus: pericles::material::Modulus {
            calibration: pericles::material::Calibration::Lattice,
            ..material.modulus
        },
        ..material
    });
    let force = whole(&cloud, &all, &of_point, BondForm::Grid);
    let strain = 1e-3;
    let u: Vec<f64> = cloud.axis(0).iter().map(|x| strain * x).collect();
    let density = force_of(&*force, &u);
    let carried = |section: usize| -> f64 { -density[section..].iter().sum::<f64>() };
    for section in [12, 20, 24, 40, 50] {
        assert!((carried(section) / strain - 1.0).abs() < 1e-12, "{section}");
    }
    // Close to the interface bonds of both laws cross a section.
    assert!((carried(28) / strain - 1.0).abs() > 1e-3);
    let near: f64 = density[22..38].iter().sum();
    assert!(near.abs() < 1e-14, "{near:e}");
}

fn notch() -> [(Crack, EndRule); 1] {
    let crack = Crack::Segment {
        from: [0.0, 11.7],
        to: [9.0, 12.4],
    };
    [(crack, EndRule::Closed)]
}

const THREE: [(f64, f64); 3] = [(3.0, 0.02), (4.5, 0.016), (2.0, 0.025)];

#[test]
fn the_stencil_agrees_with_the_neighbour_list() {
    let plate = boxed([0.0; 3], &[40.0, 24.0], 1.0, 1.0);
    let periodic = Arc::new(PointCloud::clone(&plate).with_periodic_faces().unwrap());
    for cloud in [plate, periodic] {
        let of_point = layers(&cloud, 40.0);
        let all = THREE.map(|(horizon, stretch)| of(1.0, horizon, stretch));
        let [list, grid] = [BondForm::List, BondForm::Grid]
            .map(|form| graded(&cloud, &all, &of_point, &notch(), form));
        assert_eq!(list.cuts[0].bonds, grid.cuts[0].bonds);
        assert_eq!(list.cuts[0].points, grid.cuts[0].points);
        let [list, grid] = [list.operator, grid.operator];
        assert_eq!(list.directed_bonds(), grid.directed_bonds());
        let u = noise(&cloud, 0.01);
        assert_close(&force_of(&*grid, &u), &force_of(&*list, &u), 1e-12);
        let direction = noise(&cloud, 1.3);
        let both = [&grid, &list].map(|force| {
            let mut tangent = vec![0.0; u.len()];
            force.tangent_into(0.0, &u, &direction, &mut tangent);
            let mut energy = vec![0.0; cloud.len()];
            force.add_energy_density(0.0, &u, &mut energy);
            let mut damage = vec![0.0; cloud.len()];
            force.damage_into(&mut damage);
            (tangent, energy, damage)
        });
        assert_close(&both[0].0, &both[1].0, 1e-12);
        assert_close(&both[0].1, &both[1].1, 1e-12);
        assert_close(&both[0].2, &both[1].2, 1e-12);
        let bound = |force: &dyn Force| force.frequency_bound(&|_| 1.0);
        assert!((bound(&*grid) / bound(&*list) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn energy_balance_of_a_crack_across_a_change_of_horizon_closes() {
    let cloud = boxed([0.0; 3], &[40.0, 24.0], 1.0, 1.0);
    let of_point = layers(&cloud, 40.0);
    let all = THREE.map(|(horizon, stretch)| of(1.0, horizon, stretch));
    let n = cloud.len();
    let run = |form: BondForm, dt: f64, steps: u64| {
        let force = graded(&cloud, &all, &of_point, &notch(), form).operator;
        let system = System::new(cloud.clone(), force, PointScalar::Uniform(1.0)).unwrap();
        let mut start = State::at_rest(2 * n);
        for i in 0..n {
            // The halves of the plate move apart.
            start.v[n + i] = 0.02 * (0.4 * (cloud.point(i)[1] - 12.0)).tanh();
        }
        let scheme = Box::new(VelocityVerlet);
        let mut run = Simulation::new(system, scheme, start, dt, steps).unwrap();
        let before = run.start_energy().energy;
        let momentum = run.system().momentum(&run.state().v);
        run.run(|_| Control::Continue).unwrap();
        let energies = run.snapshot().energies();
        let force = run.system().operator();
        let dissipated = force.dissipated();
        let after = energies.kinetic + energies.elastic + dissipated;
        let moved = run.system().momentum(&run.state().v);
        assert!((moved[1] - momentum[1]).abs() < 1e-12);
        let mut damage = vec![0.0; n];
        force.damage_into(&mut damage);
        for material in 0..3 {
            let is_cracked = |&i: &usize| of_point[i] == material && damage[i] > 0.2;
            assert!((0..n).filter(is_cracked).count() > 5, "material {material}");
        }
        ((after - before).abs() / dissipated, force.broken_bonds())
    };
    let broken = [BondForm::List, BondForm::Grid].map(|form| run(form, 0.2, 200).1);
    assert_eq!(broken[0], broken[1]);
    let errors = [(0.2, 200), (0.1, 400)].map(|(dt, steps)| run(BondForm::Grid, dt, steps).0);
    // The error of the energy of velocity Verlet is of second order.
    assert!(
        errors[1] < 5e-3 && errors[1] < 0.5 * errors[0],
        "{errors:?}"
    );
}
