//! Ghost points at surfaces: forces are the gradient of the energy of the body, and the energy density of a
//! uniform strain equals the stress of the material at every point.

use std::sync::Arc;

use crate::bodies::{noise, solid};
use crate::common::{boxed, material};
use pericles::PericlesError;
use pericles::domain::Field;
use pericles::family::VolumeCorrection;
use pericles::kernel::InfluenceFunction;
use pericles::material::{
    BondFailure, Fracture, LinearSolid, PairLaw, SolidSurface, Strains, StressState,
    SurfaceCorrection,
};
use pericles::operator::{
    BondBody, BondForm, CompositeBody, Force, GhostLayer, LinearSolidBody, PointSubset,
};
use pericles::space::{Grid, PointCloud, Region, Shape};

/// A plate with a hole, so that several points are nearest to a ghost.
fn plate() -> Arc<PointCloud> {
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: vec![9.0, 8.0],
        },
        spacing: 1.0,
        section: 1.0,
        holes: vec![Region::Ball {
            centre: [4.5, 4.5, 0.0],
            radius: 1.2,
        }],
    };
    Arc::new(grid.points().unwrap())
}

fn of_solid(cloud: &Arc<PointCloud>, strains: Strains, form: BondForm) -> Box<dyn Force> {
    let state = match cloud.dimension() {
        2 => StressState::PlaneStress,
        _ => StressState::Spatial,
    };
    let solid = solid(0.2, 2.2, InfluenceFunction::Conical);
    let constants = solid.constants(cloud, state).unwrap();
    let body = LinearSolidBody {
        strains,
        surface: SolidSurface::Ghosts,
        ..LinearSolidBody::new(cloud, &constants, VolumeCorrection::Linear)
    };
    body.operator(form).unwrap().operator
}

fn bond_based(cloud: &Arc<PointCloud>, law: PairLaw) -> Box<dyn Force> {
    let mut material = material(
        1.0,
        10.0,
        2.2,
        VolumeCorrection::Extended,
        Fracture::Unbreakable,
    );
    material.law = law;
    let constants = material.constants(cloud, StressState::PlaneStress);
    let constants = constants.unwrap();
    let composite = CompositeBody {
        body: BondBody::new(cloud, &material, &constants),
        classes: None,
        correction: SurfaceCorrection::Ghosts,
        softening: None,
        strengths: &[],
    };
    composite.operator(BondForm::List).unwrap().operator
}

fn bodies() -> Vec<(&'static str, Arc<PointCloud>, Box<dyn Force>)> {
    let (plate, block) = (plate(), boxed([0.0; 3], &[4.0, 3.0, 3.0], 1.0, 1.0));
    let solid = |strains, form| of_solid(&plate, strains, form);
    vec![
        (
            "small strains",
            plate.clone(),
            solid(Strains::Small, BondForm::List),
        ),
        (
            "finite strains",
            plate.clone(),
            solid(Strains::Finite, BondForm::List),
        ),
        (
            "stencil",
            plate.clone(),
            solid(Strains::Finite, BondForm::Grid),
        ),
        (
            "block",
            block.clone(),
            of_solid(&block, Strains::Finite, BondForm::List),
        ),
        (
            "linear bonds",
            plate.clone(),
            bond_based(&plate, PairLaw::Linear),
        ),
        (
            "bond stretch",
            plate.clone(),
            bond_based(&plate, PairLaw::BondStretch),
        ),
    ]
}

fn force(operator: &dyn Force, u: &[f64]) -> Vec<f64> {
    let mut force = vec![0.0; u.len()];
    operator.add_force(0.0, u, PointSubset::All, &mut force);
    force
}

fn scaled_noise(entries: usize, size: f64, seed: f64) -> Vec<f64> {
    noise(entries, seed).into_iter().map(|x| size * x).collect()
}

fn weighted(cloud: &PointCloud, a: &[f64], b: &[f64]) -> f64 {
    let volumes = cloud.volumes();
    let terms = a.iter().zip(b).enumerate();
    terms
        .map(|(k, (a, b))| volumes[k % cloud.len()] * a * b)
        .sum()
}

fn moved(u: &[f64], step: f64, v: &[f64]) -> Vec<f64> {
    u.iter().zip(v).map(|(u, v)| u + step * v).collect()
}

#[test]
fn forces_are_the_gradient_of_the_energy() {
    for (name, cloud, operator) in bodies() {
        let entries = cloud.dimension() * cloud.len();
        let (u, v) = (
            scaled_noise(entries, 0.02, 0.3),
            scaled_noise(entries, 1.0, 1.9),
        );
        let step = 1e-4;
        let energy = |step: f64| operator.energy(0.0, &moved(&u, step, &v));
        let difference = (energy(step) - energy(-step)) / (2.0 * step);
        let work = -weighted(&cloud, &force(&*operator, &u), &v);
        let size = weighted(&cloud, &force(&*operator, &u), &force(&*operator, &u)).sqrt();
        assert!(
            (difference - work).abs() < 1e-5 * size,
            "{name}: {difference} against {work}, forces {size}"
        );
    }
}

#[test]
fn the_tangent_is_the_symmetric_derivative_of_the_force() {
    for (name, cloud, operator) in bodies() {
        let entries = cloud.dimension() * cloud.len();
        let u = scaled_noise(entries, 0.02, 0.3);
        let (v, w) = (noise(entries, 1.9), noise(entries, 4.2));
        let tangent = |v: &[f64]| {
            let mut out = vec![0.0; entries];
            operator.tangent_into(0.0, &u, v, &mut out);
            out
        };
        let step = 1e-5;
        let ahead = force(&*operator, &moved(&u, step, &v));
        let behind = force(&*operator, &moved(&u, -step, &v));
        let change = tangent(&v);
        let largest = change.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        for k in 0..entries {
            let difference = (ahead[k] - behind[k]) / (2.0 * step);
            let error = (difference - change[k]).abs();
            assert!(error < 1e-6 * largest, "{name}: {error} of {largest}");
        }
        let (one, other) = (
            weighted(&cloud, &w, &change),
            weighted(&cloud, &v, &tangent(&w)),
        );
        let size = weighted(&cloud, &w, &w).sqrt() * weighted(&cloud, &change, &change).sqrt();
        assert!(
            (one - other).abs() < 1e-12 * size,
            "{name}: {one} and {other}"
        );
    }
}

#[test]
fn a_uniform_strain_has_the_same_energy_density_at_every_point() {
    for (name, cloud, operator) in bodies() {
        let n = cloud.len();
        let mut u = vec![0.0; cloud.dimension() * n];
        for i in 0..n {
            let [x, y, _] = cloud.point(i);
            u[i] = 1e-6 * (x + 0.4 * y);
            u[n + i] = -3e-7 * y;
        }
        let mut density = vec![0.0; n];
        operator.add_energy_density(0.0, &u, &mut density);
        for energy in &density {
            assert!((energy / density[0] - 1.0).abs() < 1e-5, "{name}");
        }
        let total: f64 = density
            .iter()
            .zip(cloud.volumes())
            .map(|(w, v)| w * v)
            .sum();
        let energy = operator.energy(0.0, &u);
        assert!((energy / total - 1.0).abs() < 1e-12, "{name}");
    }
}

#[test]
fn forces_conserve_momentum_and_rigid_motions_cause_none() {
    for (name, cloud, operator) in bodies() {
        let n = cloud.len();
        let u = scaled_noise(cloud.dimension() * n, 0.02, 0.3);
        let f = force(&*operator, &u);
        let volumes = cloud.volumes();
        let size: f64 = (0..n).map(|i| volumes[i] * f[i].abs()).sum();
        for of_axis in f.chunks(n) {
            let sum: f64 = of_axis.iter().zip(volumes).map(|(f, v)| f * v).sum();
            assert!(sum.abs() < 1e-12 * size, "{name}: {sum} of {size}");
        }
        // Moments vanish about deformed positions for finite strains, about reference positions for small strains.
        if name == "small strains" || name == "linear bonds" {
            continue;
        }
        let moment: f64 = (0..n)
            .map(|i| {
                let [x, y, _] = cloud.point(i);
                volumes[i] * ((x + u[i]) * f[n + i] - (y + u[n + i]) * f[i])
            })
            .sum();
        assert!(moment.abs() < 1e-11 * size, "{name}: {moment} of {size}");
        let (sin, cos) = 0.7f64.sin_cos();
        let mut turned = vec![0.0; u.len()];
        for i in 0..n {
            let [x, y, _] = cloud.point(i);
            turned[i] = cos * x - sin * y - x + 3.0;
            turned[n + i] = sin * x + cos * y - y;
        }
        let largest = f.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let left = force(&*operator, &turned);
        assert!(left.iter().all(|f| f.abs() < 1e-11 * largest), "{name}");
    }
}

#[test]
fn forces_on_a_subset_equal_a_full_evaluation_and_depend_on_neighbours_only() {
    for (name, cloud, operator) in bodies() {
        let n = cloud.len();
        let u = scaled_noise(cloud.dimension() * n, 0.02, 0.3);
        let all = force(&*operator, &u);
        let some = [0, 3, n as u32 - 1];
        let mut part = vec![0.0; u.len()];
        operator.add_force(0.0, &u, PointSubset::Set(&some), &mut part);
        let local = operator.capabilities().local.unwrap();
        for &i in &some {
            let i = i as usize;
            assert_eq!(part[i], all[i], "{name}");
            let mut near = vec![false; n];
            near[i] = true;
            local.neighbours(i, &mut |j| near[j] = true);
            let far: Vec<f64> = (0..u.len())
                .map(|k| if near[k % n] { u[k] } else { 7.0 * u[k] })
                .collect();
            assert_eq!(force(&*operator, &far)[i], all[i], "{name}");
        }
    }
}

#[test]
fn corner_points_have_as_many_bonds_as_interior_points() {
    for (name, cloud, operator) in bodies() {
        let n = cloud.len();
        let u = scaled_noise(cloud.dimension() * n, 0.02, 0.3);
        let view = operator.capabilities().bonds.unwrap();
        let values = view.values_at(Field::new(&u, &[]));
        let seen = |i: usize| {
            let (mut bonds, mut ghosts) = (0, 0);
            view.for_each_bond(&values, i, &mut |bond| {
                assert!(bond.neighbour < n);
                bonds += 1;
                ghosts += usize::from(bond.to_ghost);
            });
            (bonds, ghosts)
        };
        let (corner, ghosts) = seen(0);
        assert!(ghosts > corner / 2, "{name}: {ghosts} of {corner}");
        assert!((1..n).all(|i| seen(i).0 == corner), "{name}");
    }
}

#[test]
fn errors_of_ghost_layers_contain_the_reason() {
    let reason = |cloud: &Arc<PointCloud>, solid: &LinearSolid| {
        let constants = solid.constants(cloud, StressState::PlaneStress).unwrap();
        let body = LinearSolidBody {
            surface: SolidSurface::Ghosts,
            ..LinearSolidBody::new(cloud, &constants, VolumeCorrection::Linear)
        };
        match body.operator(BondForm::Fastest) {
            Err(PericlesError::NoGhostLayer { reason }) => reason,
            Err(other) => panic!("{other}"),
            Ok(_) => panic!("the ghost layer was accepted"),
        }
    };
    let unbreakable = solid(0.2, 2.2, InfluenceFunction::Conical);
    let breakable = LinearSolid {
        failure: BondFailure::CriticalStretch(0.01),
        ..unbreakable.clone()
    };
    let row = boxed([0.0; 3], &[8.0, 1.0], 1.0, 1.0);
    assert!(reason(&row, &unbreakable).contains("two cells"));
    assert!(reason(&plate(), &breakable).contains("bonds of this body can break"));
    let listed = crate::bodies::jittered(&[5, 5]);
    assert!(reason(&listed, &unbreakable).contains("do not lie on a regular grid"));
    assert!(GhostLayer::of_points(&listed, &[[9.0, 9.0, 0.0]], &[-1.0]).is_err());
}
