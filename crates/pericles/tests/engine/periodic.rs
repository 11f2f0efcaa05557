//! Bodies with periodic faces: bonds lead to images beyond the faces.

use std::sync::Arc;

use crate::common::{listed, material};
use pericles::family::{Crack, EndRule, VolumeCorrection};
use pericles::material::{BondMaterial, BondStretch, Fracture, GreenBond, PairLaw, StressState};
use pericles::operator::{DamageMeasure, Force, GridForce, PointSubset, VectorLaw};
use pericles::space::{Grid, PointCloud, Shape};
use pericles::time::{State, VelocityVerlet};
use pericles::{Control, PointScalar, Simulation, System};

fn grid(size: &[f64]) -> PointCloud {
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: size.to_vec(),
        },
        spacing: 1.0,
        section: 1.0,
        holes: vec![],
    };
    grid.points().unwrap()
}

fn periodic(size: &[f64]) -> Arc<PointCloud> {
    Arc::new(grid(size).with_periodic_faces().unwrap())
}

fn state_of_stress(dimension: usize) -> StressState {
    [
        StressState::Uniaxial,
        StressState::PlaneStrain,
        StressState::Spatial,
    ][dimension - 1]
}

fn glass(law: PairLaw, fracture: Fracture) -> BondMaterial {
    BondMaterial {
        law,
        ..material(1.0, 1.0, 3.0, VolumeCorrection::Extended, fracture)
    }
}

fn on_stencil<L: VectorLaw, const D: usize>(
    cloud: &Arc<PointCloud>,
    material: &BondMaterial,
    cracks: &[(Crack, EndRule)],
) -> GridForce<L, D> {
    let constants = material.constants(cloud, state_of_stress(D)).unwrap();
    let damage = DamageMeasure::default();
    GridForce::new(cloud.clone(), material, &constants, cracks, &[], damage).unwrap()
}

fn force_of(operator: &dyn Force, u: &[f64]) -> Vec<f64> {
    let mut force = vec![0.0; u.len()];
    operator.add_force(0.0, u, PointSubset::All, &mut force);
    force
}

/// The middle copy of many copies of a body side by side has the forces of the periodic body.
fn equals_copies<L: VectorLaw, const D: usize>(size: [f64; D], law: PairLaw, copies: usize) {
    let material = glass(law, Fracture::Unbreakable);
    let small = periodic(&size);
    let large = Arc::new(grid(&size.map(|side| side * copies as f64)));
    let shape = small.lattice().unwrap().shape;
    let lattice = large.lattice().unwrap();
    let (n, all) = (small.len(), large.len());
    let u: Vec<f64> = (0..D * n)
        .map(|k| 0.05 * ((k * k + 3) as f64).sin())
        .collect();
    // The point of the small body of which each point of the large one is a copy, and whether it lies in the middle
    // copy.
    let copy = |i: usize| {
        let at = lattice.coordinates(lattice.node[i]).map(|x| x as usize);
        let [x, y, z] = std::array::from_fn(|c| at[c] % shape[c]);
        let in_middle = (0..D).all(|c| at[c] / shape[c] == copies / 2);
        (x + shape[0] * (y + shape[1] * z), in_middle)
    };
    let mut repeated = vec![0.0; D * all];
    for c in 0..D {
        for i in 0..all {
            repeated[c * all + i] = u[c * n + copy(i).0];
        }
    }
    let listed_large = listed::<L, D>(&large, &material, state_of_stress(D), None, &[]);
    let expected = force_of(&listed_large, &repeated);
    let list = listed::<L, D>(&small, &material, state_of_stress(D), None, &[]);
    let stencil = on_stencil::<L, D>(&small, &material, &[]);
    let scale = expected.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
    let forms: [(&str, &dyn Force); 2] = [("list", &list), ("stencil", &stencil)];
    for (form, operator) in forms {
        let found = force_of(operator, &u);
        for i in (0..all).filter(|&i| copy(i).1) {
            for c in 0..D {
                let error = (found[c * n + copy(i).0] - expected[c * all + i]).abs();
                assert!(error < 1e-13 * scale, "{form} in {D} dimensions: {error:e}");
            }
        }
        let sum: f64 = found[..n].iter().sum();
        assert!(sum.abs() < 1e-13 * n as f64 * scale, "momentum: {sum:e}");
        let energy = operator.energy(0.0, &u);
        let mut density = vec![0.0; all];
        listed_large.add_energy_density(0.0, &repeated, &mut density);
        let middle: f64 = (0..all).filter(|&i| copy(i).1).map(|i| density[i]).sum();
        assert!(
            (energy / middle - 1.0).abs() < 1e-13,
            "{form}: {energy:e}, {middle:e}"
        );
    }
}

#[test]
fn periodic_body_equals_the_middle_copy_of_many() {
    equals_copies::<BondStretch, 1>([12.0], PairLaw::BondStretch, 3);
    equals_copies::<GreenBond, 2>([13.0, 9.0], PairLaw::GreenStrain, 3);
    equals_copies::<BondStretch, 3>([8.0, 7.0, 9.0], PairLaw::BondStretch, 3);
    // Bonds that lead around the body, including from a point to itself.
    equals_copies::<BondStretch, 2>([5.0, 2.0], PairLaw::BondStretch, 5);
}

const SIZE: [f64; 2] = [40.0, 24.0];

/// A cracked plate torn by opposite velocities of its halves, with everything moved to the right by `shift`
/// periodically; displacements by column and row, and the conserved quantities.
fn torn(shift: usize, stencil: bool) -> (Vec<f64>, u64, [f64; 3]) {
    let cloud = periodic(&SIZE);
    let n = cloud.len();
    let material = glass(PairLaw::BondStretch, Fracture::CriticalStretch(0.02));
    let from = shift as f64;
    // A crack that leaves through one face and re-enters through the opposite one.
    let crack = Crack::Segment {
        from: [from, 12.0],
        to: [from + 10.0, 12.0],
    };
    let cracks = [(crack, EndRule::Closed)];
    let operator: Box<dyn Force> = if stencil {
        Box::new(on_stencil::<BondStretch, 2>(&cloud, &material, &cracks))
    } else {
        let crack = cracks[0].0.clone();
        let state = state_of_stress(2);
        Box::new(listed::<BondStretch, 2>(
            &cloud,
            &material,
            state,
            Some(crack),
            &[],
        ))
    };
    let system = System::new(cloud.clone(), operator, PointScalar::Uniform(1.0)).unwrap();
    let columns = SIZE[0] as usize;
    let moved = |i: usize| (i % columns + columns - shift) % columns + columns * (i / columns);
    let mut start = State::at_rest(2 * n);
    for i in 0..n {
        let k = moved(i);
        let row = (k / columns) as f64;
        start.v[i] = 0.001 * (k as f64).sin();
        // Continuous across the face and steep at the crack.
        start.v[n + i] = -0.03 * (std::f64::consts::TAU * (row + 0.5) / SIZE[1]).sin();
    }
    let before = system.momentum(&start.v);
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), start, 0.1, 120).unwrap();
    run.run(|_| Control::Continue).unwrap();
    let energies = run.snapshot().energies();
    let after = run.system().momentum(&run.state().v);
    let mut u = vec![0.0; 2 * n];
    for i in 0..n {
        u[moved(i)] = run.state().u[i];
        u[n + moved(i)] = run.state().u[n + i];
    }
    let lost = [
        energies.balance() / energies.dissipated,
        after[0] - before[0],
        after[1] - before[1],
    ];
    (u, run.system().operator().broken_bonds(), lost)
}

#[test]
fn results_do_not_depend_on_the_position_of_a_crack_relative_to_periodic_faces() {
    let (expected, broken, _) = torn(15, false);
    assert!(broken > 200, "{broken} bonds broken");
    let largest = expected.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
    for (shift, stencil) in [(15, true), (35, false), (35, true), (0, false), (0, true)] {
        let (u, count, lost) = torn(shift, stencil);
        let apart = u.iter().zip(&expected).map(|(a, b)| (a - b).abs());
        let apart = apart.fold(0.0, f64::max) / largest;
        let name = format!("moved by {shift}, stencil: {stencil}");
        assert_eq!(count, broken, "{name}");
        assert!(apart < 1e-10, "{name}: {apart:e}");
        assert!(lost[0].abs() < 1e-3, "{name}: energy {:e}", lost[0]);
        assert!(
            lost[1].abs().max(lost[2].abs()) < 1e-11,
            "{name}: momentum {lost:?}"
        );
    }
}
