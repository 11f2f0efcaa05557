//! Bodies with cells of several sizes.

use std::sync::Arc;

use pericles::domain::Field;
use pericles::family::VolumeCorrection;
use pericles::material::{
    Approximation, BondMaterial, CubicLaw, ElasticModulus, Fracture, FractureCalibration,
    InterfaceRule, InterfaceStiffness, MaterialInterface, MaterialPairs, Modulus, PairLaw,
    StressState,
};
use pericles::operator::{
    BondBody, BondForm, CompositeBody, DamageMeasure, Force, GradedBody, Materials, PointSubset,
};
use pericles::round_trip::check_resume;
use pericles::space::{Finer, GradedCloud, GradedGrid, Grid, PointCloud, Region, Shape};
use pericles::time::{Fine, Integrator, Respa, State, VelocityVerlet, highest_frequency};
use pericles::{Control, PointScalar, Simulation, StepEnd, System};

use crate::common::{boxed, material, points};

const SPACING: f64 = 0.01;

fn glass(volume_correction: VolumeCorrection) -> BondMaterial {
    material(
        2440.0,
        72e9,
        3.0 * SPACING,
        volume_correction,
        Fracture::Unbreakable,
    )
}

/// A box of cells, of which those inside the region are divided by `ratio`.
fn graded(size: &[f64], region: Region, ratio: u32) -> GradedCloud {
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.0; 3],
            size: size.to_vec(),
        },
        spacing: SPACING,
        section: 1.0,
        holes: vec![],
    };
    let finer = vec![Finer { region, ratio }];
    GradedGrid { grid, finer }.points().unwrap()
}

fn bonds(
    points: GradedCloud,
    material: &BondMaterial,
    state: StressState,
) -> (Arc<PointCloud>, Box<dyn Force>) {
    let cloud = Arc::new(points.cloud);
    let operator = bonds_of(
        &cloud,
        (&points.ratios, &points.grid_of_point),
        material,
        None,
        state,
    );
    (cloud, operator)
}

fn bonds_of(
    cloud: &Arc<PointCloud>,
    (ratios, grid_of_point): (&[u32], &[u8]),
    material: &BondMaterial,
    materials: Option<Materials<'_>>,
    state: StressState,
) -> Box<dyn Force> {
    let body = GradedBody {
        cloud,
        ratios,
        grid_of_point,
        material,
        materials,
        state,
        cracks: &[],
        no_fail: &[],
        stiffness: &[],
        damage: DamageMeasure::default(),
    };
    body.operator(BondForm::Fastest).unwrap().operator
}

fn middle(dimension: usize) -> Region {
    let mut bounds = [[f64::NEG_INFINITY; 3], [f64::INFINITY; 3]];
    for c in 0..dimension {
        bounds[0][c] = 0.04;
        bounds[1][c] = 0.08;
    }
    Region::Box {
        min: bounds[0],
        max: bounds[1],
    }
}

/// A smooth displacement that differs at every point.
fn bumpy(cloud: &PointCloud) -> Vec<f64> {
    let n = cloud.len();
    (0..cloud.dimension() * n)
        .map(|k| {
            let [x, y, z] = cloud.point(k % n);
            let phase = (k / n) as f64;
            1e-4 * (37.0 * x + 3.0 * phase).sin() * (1.0 + (23.0 * y - 11.0 * z).cos())
        })
        .collect()
}

#[test]
fn grid_refined_everywhere_equals_a_grid_of_small_cells() {
    for correction in [VolumeCorrection::None, VolumeCorrection::Extended] {
        let material = glass(correction);
        let state = StressState::PlaneStress;
        let (cloud, force) = bonds(graded(&[0.12, 0.08], Region::All, 2), &material, state);
        let half = 0.5 * SPACING;
        let plain = boxed([0.0; 3], &[0.12, 0.08], half, 1.0);
        let small = BondMaterial {
            horizon: 3.0 * half,
            ..material
        };
        let constants = small.constants(&plain, state).unwrap();
        let body = BondBody::new(&plain, &small, &constants);
        let expected = body.operator(BondForm::List).unwrap().operator;
        assert_eq!(force.directed_bonds(), expected.directed_bonds());
        // The points have a different order.
        let same: Vec<usize> = (0..cloud.len())
            .map(|i| plain.nearest(cloud.point(i)))
            .collect();
        let evaluate = |force: &dyn Force, cloud: &PointCloud| {
            let mut out = vec![0.0; 2 * cloud.len()];
            force.add_force(0.0, &bumpy(cloud), PointSubset::All, &mut out);
            out
        };
        let (found, expected) = (evaluate(&*force, &cloud), evaluate(&*expected, &plain));
        let n = cloud.len();
        let scale = expected.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
        for i in 0..n {
            for c in 0..2 {
                let error = (found[c * n + i] - expected[c * n + same[i]]).abs();
                assert!(error < 1e-11 * scale, "{error} {scale}");
            }
        }
    }
}

#[test]
fn forces_on_both_ends_of_every_bond_are_opposite() {
    let treated = PairLaw::Approximated(CubicLaw::CubicSoftening, Approximation::SecondOrder);
    for (dimension, state, law) in [
        (1, StressState::Uniaxial, PairLaw::BondStretch),
        (1, StressState::Uniaxial, PairLaw::CubicSoftening),
        (1, StressState::Uniaxial, treated),
        (2, StressState::PlaneStrain, PairLaw::BondStretch),
        (2, StressState::PlaneStrain, PairLaw::GreenStrain),
        (3, StressState::Spatial, PairLaw::BondStretch),
        (3, StressState::Spatial, PairLaw::GreenStrain),
    ] {
        let size = vec![0.12; dimension];
        let points = graded(&size, middle(dimension), 2);
        let material = BondMaterial {
            law,
            ..glass(VolumeCorrection::Extended)
        };
        let (cloud, force) = bonds(points, &material, state);
        let n = cloud.len();
        let mut density = vec![0.0; dimension * n];
        force.add_force(0.0, &bumpy(&cloud), PointSubset::All, &mut density);
        for component in density.chunks(n) {
            let pull = |i: usize| component[i] * cloud.volumes()[i];
            let (sum, size) = (0..n).fold((0.0, 0.0), |(sum, size), i| {
                (sum + pull(i), size + pull(i).abs())
            });
            assert!(sum.abs() < 1e-13 * size, "{sum} of {size}");
        }
    }
}

#[test]
fn multirate_on_two_grids_conserves_momentum_and_energy() {
    let points_of = graded(&[0.24, 0.16], middle_of_plate(), 3);
    let state = StressState::PlaneStress;
    let (cloud, force) = bonds(points_of, &glass(VolumeCorrection::Extended), state);
    let system = System::new(cloud.clone(), force, PointScalar::Uniform(2440.0)).unwrap();
    let fine = points(&cloud, |x, y, _| {
        (x - 0.12).abs() < 0.062 && (y - 0.08).abs() < 0.062
    });
    let mut state = State::at_rest(2 * cloud.len());
    for (k, v) in state.v.iter_mut().enumerate() {
        *v = 1.0 + ((k * k) as f64).sin();
    }
    let scheme = Respa::new(3, Fine::Fixed(vec![fine]), &system).unwrap();
    // The large cells alone limit the coarse step.
    let whole = highest_frequency(&system, &state.u).unwrap();
    let limiting = scheme.limiting_frequency(&system, &state.u, whole).unwrap();
    let ratio = whole.estimate / limiting.estimate;
    assert!((2.4..3.1).contains(&ratio), "{ratio}");
    let momentum = system.momentum(&state.v);
    let dt = limiting.stable_step(2.0, 0.5);
    let mut run = Simulation::new(system, Box::new(scheme), state, dt, 400).unwrap();
    let at_start = run.start_energy().energy;
    run.run(|_| Control::Continue).unwrap();
    let energies = run.snapshot().energies();
    let change = (energies.kinetic + energies.elastic) / at_start - 1.0;
    assert!(change.abs() < 0.1, "{change}");
    let after = run.system().momentum(&run.state().v);
    for c in 0..2 {
        assert!((after[c] / momentum[c] - 1.0).abs() < 1e-12);
    }
}

fn middle_of_plate() -> Region {
    Region::Box {
        min: [0.09, 0.05, f64::NEG_INFINITY],
        max: [0.15, 0.11, f64::INFINITY],
    }
}

/// A plate of 24 × 20 large cells; the cells of its right half are divided by two.
fn half_fine() -> GradedCloud {
    let right = Region::Box {
        min: [0.12, f64::NEG_INFINITY, f64::NEG_INFINITY],
        max: [f64::INFINITY; 3],
    };
    graded(&[0.24, 0.2], right, 2)
}

/// Glass of 100 J/m² with the linear law, for which all bonds have the same stretch under dilatation.
fn breakable() -> BondMaterial {
    BondMaterial {
        law: PairLaw::Linear,
        fracture: Fracture::Energy {
            energy: 100.0,
            calibration: FractureCalibration::Lattice,
        },
        ..glass(VolumeCorrection::Extended)
    }
}

fn dilation(cloud: &PointCloud, strain: f64) -> Vec<f64> {
    (0..2)
        .flat_map(|c| cloud.axis(c).iter().map(move |x| strain * x))
        .collect()
}

#[test]
fn a_crack_along_the_interface_dissipates_the_mean_energy_of_both_grids() {
    let state = StressState::PlaneStress;
    let material = breakable();
    let (cloud, force) = bonds(half_fine(), &material, state);
    let stretch_on = |spacing: f64| {
        let own = BondMaterial {
            horizon: 3.0 * spacing,
            ..material.clone()
        };
        let sides = [spacing; 2];
        own.constants_on(&sides, 1.0, state)
            .unwrap()
            .critical_stretch
    };
    let [large, small] = [SPACING, 0.5 * SPACING].map(stretch_on);
    assert!(small > 1.3 * large);
    let is_fine = |i: usize| cloud.axis(0)[i] > 0.12;
    // Bonds that remain after the dilatation, within one grid or between both.
    let left = |strain: f64| {
        let (_, mut force) = bonds(half_fine(), &material, state);
        let u = dilation(&cloud, strain);
        let mut out = vec![0.0; u.len()];
        force.end_step(&StepEnd::sub_step(0.0, 1.0, &u), PointSubset::All, &mut out);
        let mut left = [0; 3];
        let view = force.as_bonds().unwrap();
        let values = view.values_at(Field::new(&u, &[]));
        for i in 0..cloud.len() {
            view.for_each_bond(&values, i, &mut |bond| {
                left[usize::from(is_fine(i)) + usize::from(is_fine(bond.neighbour))] += 1;
            });
        }
        left
    };
    let all = left(0.5 * large);
    for (grid, stretch) in [(0, large), (2, small)] {
        assert_eq!(left(stretch * (1.0 - 1e-9))[grid], all[grid]);
        assert_eq!(left(stretch * (1.0 + 1e-9))[grid], 0);
    }
    let (mut low, mut high) = (large, small);
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        match left(middle)[1] {
            0 => high = middle,
            count => {
                assert_eq!(count, all[1], "bonds between the grids break together");
                low = middle;
            }
        }
    }
    // Critical energies of the bonds across a line x = const, away from free surfaces, J/m².
    let strain = 1e-6;
    let u = dilation(&cloud, strain);
    let across = |line: f64| {
        let inside = |i: &usize| (0.07..0.13).contains(&cloud.axis(1)[*i]);
        let mut energy = 0.0;
        let view = force.as_bonds().unwrap();
        let values = view.values_at(Field::new(&u, &[]));
        for i in (0..cloud.len()).filter(inside) {
            view.for_each_bond(&values, i, &mut |bond| {
                let [a, b] = [i, bond.neighbour].map(|i| cloud.axis(0)[i]);
                if (a - line) * (b - line) > 0.0 {
                    return;
                }
                let stretch = match (is_fine(i), is_fine(bond.neighbour)) {
                    (false, false) => large,
                    (true, true) => small,
                    _ => low,
                };
                let norm = |x: [f64; 3]| x.iter().map(|x| x * x).sum::<f64>().sqrt();
                let force = norm(bond.force) * cloud.volumes()[i];
                // Each end has half of ½ F Δ.
                let stored = 0.25 * force * strain * norm(bond.xi);
                energy += stored * (stretch / strain).powi(2);
            });
        }
        energy / 0.06
    };
    let (coarse, interface, fine) = (across(0.06), across(0.12), across(0.18));
    // The same plane of both lattices; the calibration is a mean over planes.
    assert!((coarse / fine - 1.0).abs() < 1e-9, "{coarse}, {fine}");
    assert!((coarse / 100.0 - 1.0).abs() < 0.15, "{coarse}");
    // Observed: the interface has other bonds than a plane of either lattice.
    assert!(
        (interface / coarse - 1.0).abs() < 0.15,
        "{interface}, {coarse}"
    );
}

/// A plate of two materials in tension with a crack that propagates from large into small cells.
fn torn() -> Simulation {
    let state = StressState::PlaneStress;
    let points = half_fine();
    let cloud = Arc::new(points.cloud);
    let material = breakable();
    let stiff = BondMaterial {
        modulus: Modulus {
            value: ElasticModulus::Young(100e9),
            ..material.modulus
        },
        ..material.clone()
    };
    let of_point: Vec<u8> = cloud.axis(1).iter().map(|y| u8::from(*y > 0.15)).collect();
    let all = [material.clone(), stiff];
    let materials = Materials {
        all: &all,
        of_point: &of_point,
        interfaces: &[],
    };
    let grids = (&points.ratios[..], &points.grid_of_point[..]);
    let force = bonds_of(&cloud, grids, &material, Some(materials), state);
    let system = System::new(cloud.clone(), force, PointScalar::Uniform(2440.0)).unwrap();
    let mut start = State::at_rest(2 * cloud.len());
    let n = cloud.len();
    for i in 0..n {
        // Both halves move apart, the left ends faster.
        let [x, y, _] = cloud.point(i);
        start.v[n + i] = (y - 0.1).signum() * 12.0 * (1.0 - x / 0.3);
    }
    let omega = highest_frequency(&system, &start.u).unwrap();
    let dt = omega.stable_step(2.0, 0.5);
    Simulation::new(system, Box::new(VelocityVerlet), start, dt, 300).unwrap()
}

#[test]
fn a_crack_through_two_grids_and_materials_conserves_energy_and_momentum() {
    let mut run = torn();
    let before = run.system().momentum(&run.state().v);
    let size = run.system().kinetic_energy(&run.state().v);
    run.run(|_| Control::Continue).unwrap();
    let force = run.system().operator();
    assert!(force.broken_bonds() > 500, "{}", force.broken_bonds());
    assert!(force.dissipated() > 1e-3 * size);
    let energies = run.snapshot().energies();
    let off = energies.balance().abs() / force.dissipated();
    assert!(off < 1e-3, "{off:e} {energies:?}");
    let after = run.system().momentum(&run.state().v);
    let scale = (2.0 * size * 2440.0 * 0.24 * 0.2).sqrt();
    for c in 0..2 {
        assert!((after[c] - before[c]).abs() < 1e-12 * scale);
    }
}

#[test]
fn a_crack_through_two_grids_resumes() {
    check_resume(torn, [90]).unwrap();
}

#[test]
fn several_materials_on_a_grid_refined_everywhere_equal_those_on_small_cells() {
    let state = StressState::PlaneStress;
    let points = graded(&[0.12, 0.08], Region::All, 2);
    let cloud = Arc::new(points.cloud);
    let half = 0.5 * SPACING;
    let stiff = |young: f64, horizon: f64| BondMaterial {
        horizon,
        modulus: Modulus {
            value: ElasticModulus::Young(young),
            ..breakable().modulus
        },
        ..breakable()
    };
    let number = |cloud: &PointCloud| -> Vec<u8> {
        cloud.axis(0).iter().map(|x| u8::from(*x > 0.06)).collect()
    };
    let interface = MaterialInterface {
        stiffness: InterfaceStiffness::Rule(InterfaceRule::Weaker),
        fracture: Some(Fracture::CriticalStretch(2e-4)),
    };
    let (of_point, interfaces) = (number(&cloud), [([0, 1], interface)]);
    let [soft, hard] = [50e9, 90e9].map(|young| stiff(young, 3.0 * SPACING));
    let all = [soft.clone(), hard];
    let materials = Materials {
        all: &all,
        of_point: &of_point,
        interfaces: &interfaces,
    };
    let grids = (&points.ratios[..], &points.grid_of_point[..]);
    let found = |materials| bonds_of(&cloud, grids, &soft, Some(materials), state);

    let plain = boxed([0.0; 3], &[0.12, 0.08], half, 1.0);
    let own = [50e9, 90e9].map(|young| stiff(young, 3.0 * half));
    let constants = own
        .each_ref()
        .map(|own| own.constants(&plain, state).unwrap());
    let mut classes =
        MaterialPairs::new(number(&plain), &constants, InterfaceRule::Weaker).unwrap();
    classes.set_critical_stretch([0, 1], 2e-4).unwrap();
    let composite = CompositeBody {
        body: BondBody::new(&plain, &own[0], &constants[0]),
        classes: Some(&classes),
        correction: Default::default(),
        softening: None,
        strengths: &[],
    };
    let expected = || composite.operator(BondForm::List).unwrap().operator;
    // The points have a different order.
    let same: Vec<usize> = (0..cloud.len())
        .map(|i| plain.nearest(cloud.point(i)))
        .collect();
    // Between the critical stretches of the interface and the materials, and beyond that of the stiffer one.
    let stretches = constants
        .each_ref()
        .map(|constants| constants.critical_stretch);
    for strain in [1e-4, 3e-4, 0.5 * (stretches[0] + stretches[1])] {
        let broken = |mut force: Box<dyn Force>, cloud: &PointCloud| {
            let u = dilation(cloud, strain);
            let mut out = vec![0.0; u.len()];
            force.end_step(&StepEnd::sub_step(0.0, 1.0, &u), PointSubset::All, &mut out);
            (force.broken_bonds(), out)
        };
        let (number, out) = broken(found(materials), &cloud);
        let (expected_number, expected) = broken(expected(), &plain);
        assert_eq!(number, expected_number);
        assert_eq!(number > 0, strain > 2e-4);
        let n = cloud.len();
        let scale = expected.iter().fold(0.0, |most: f64, f| most.max(f.abs()));
        for (k, out) in out.iter().enumerate() {
            let other = expected[k / n * n + same[k % n]];
            assert!((out - other).abs() < 1e-11 * scale, "{out} {other}");
        }
    }
}
