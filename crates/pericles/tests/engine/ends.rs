//! Bodies whose bonds depend on their end points: the stencil compared with the neighbour list.

use std::sync::Arc;

use crate::common::{boxed, material, points};
use pericles::domain::Field;
use pericles::family::{Crack, EndRule, VolumeCorrection};
use pericles::material::{
    Approximation, BondConstants, BondMaterial, CubicLaw, Fracture, InterfaceRule, MaterialPairs,
    PairLaw, StressState, SurfaceCorrection,
};
use pericles::operator::{
    AssembledBonds, BondBody, BondForm, CompositeBody, Force, InstructionSet, PointSubset,
};
use pericles::space::{Grid, PointCloud, Region, Shape, rectangular_cells};
use pericles::time::{State, VelocityVerlet, highest_frequency};
use pericles::{Archive, Checkpointed, Control, PointScalar, Simulation, System};

const STRETCH: f64 = 0.02;

fn of_modulus(law: PairLaw, young: f64, stretch: f64) -> BondMaterial {
    BondMaterial {
        law,
        ..material(
            1.0,
            young,
            3.0,
            VolumeCorrection::Extended,
            Fracture::CriticalStretch(stretch),
        )
    }
}

fn state(dimension: usize) -> StressState {
    match dimension {
        1 => StressState::Uniaxial,
        2 => StressState::PlaneStress,
        _ => StressState::Spatial,
    }
}

/// Properties of a body in addition to its points.
#[derive(Clone, Copy)]
struct Parts {
    law: PairLaw,
    materials: bool,
    inclusion: bool,
    correction: SurfaceCorrection,
    crack: bool,
}

const PLAIN: Parts = Parts {
    law: PairLaw::BondStretch,
    materials: false,
    inclusion: false,
    correction: SurfaceCorrection::None,
    crack: false,
};

const ALL: Parts = Parts {
    materials: true,
    inclusion: true,
    correction: SurfaceCorrection::Energy,
    crack: true,
    ..PLAIN
};

fn crack(dimension: usize) -> Option<(Crack, EndRule)> {
    let crack = match dimension {
        2 => Crack::Segment {
            from: [0.0, 4.0],
            to: [5.0, 6.2],
        },
        3 => Crack::Disc {
            centre: [5.0, 3.0, 3.0],
            normal: [0.2, 1.0, 0.1],
            radius: 2.5,
        },
        _ => return None,
    };
    Some((crack, EndRule::Closed))
}

/// Three materials with an oblique and a straight interface; one pair has a lower critical stretch than its
/// materials.
fn classes(cloud: &PointCloud, all: &[BondConstants]) -> MaterialPairs {
    let number = |i: usize| {
        let [x, y, z] = cloud.point(i);
        u8::from(x + 0.5 * y - 0.2 * z > 9.0) + u8::from(x > 14.0)
    };
    let numbers = (0..cloud.len()).map(number).collect();
    let mut classes = MaterialPairs::new(numbers, all, InterfaceRule::Harmonic).unwrap();
    classes.set_critical_stretch([1, 2], 0.4 * STRETCH).unwrap();
    classes
}

fn assembled(cloud: &Arc<PointCloud>, parts: Parts, form: BondForm) -> AssembledBonds {
    let of = |young, stretch| of_modulus(parts.law, young, stretch);
    let glass = of(1.0, STRETCH);
    let state = state(cloud.dimension());
    let all = [
        glass.clone(),
        of(0.4, 0.8 * STRETCH),
        of(3.0, 1.5 * STRETCH),
    ];
    let all = all.map(|material| material.constants(cloud, state).unwrap());
    let classes = classes(cloud, &all);
    let share = |i: usize| if cloud.point(i)[0] < 3.0 { 1.5 } else { 1.0 };
    let shares: Vec<f64> = (0..cloud.len()).map(share).collect();
    let held = points(cloud, |x, _, _| x > 12.0 && x < 14.0);
    let cracks: Vec<_> = crack(cloud.dimension())
        .filter(|_| parts.crack)
        .into_iter()
        .collect();
    let body = BondBody {
        cracks: &cracks,
        no_fail: &held,
        stiffness: if parts.inclusion { &shares } else { &[] },
        ..BondBody::new(cloud, &glass, &all[0])
    };
    let body = CompositeBody {
        classes: parts.materials.then_some(&classes),
        correction: parts.correction,
        ..CompositeBody::from(body)
    };
    body.operator(form).unwrap()
}

fn round() -> Arc<PointCloud> {
    let grid = Grid {
        shape: Shape::Disc {
            centre: [9.0, 9.0, 0.0],
            radius: 8.7,
        },
        spacing: 1.0,
        section: 1.0,
        holes: vec![Region::Ball {
            centre: [6.0, 8.0, 0.0],
            radius: 1.6,
        }],
    };
    Arc::new(grid.points().unwrap())
}

/// A box of cells with anisotropic spacing.
fn long_cells(size: &[f64], spacing: &[f64]) -> Arc<PointCloud> {
    Arc::new(rectangular_cells([0.0; 3], size, spacing, 1.0, &[]).unwrap())
}

fn bodies() -> Vec<(&'static str, Arc<PointCloud>)> {
    let plate = boxed([0.0; 3], &[21.0, 13.0], 1.0, 1.0);
    let block = boxed([0.0; 3], &[18.0, 7.0, 6.0], 1.0, 1.0);
    let periodic =
        |cloud: &Arc<PointCloud>| Arc::new(PointCloud::clone(cloud).with_periodic_faces().unwrap());
    vec![
        ("bar", boxed([0.0; 3], &[43.0], 1.0, 1.0)),
        ("periodic plate", periodic(&plate)),
        ("plate", plate),
        ("disc with a hole", round()),
        ("periodic block", periodic(&block)),
        ("block", block),
        (
            "plate of long cells",
            long_cells(&[21.0, 9.0], &[1.0, 0.75]),
        ),
        (
            "periodic plate of long cells",
            periodic(&long_cells(&[18.0, 9.0], &[0.9, 0.75])),
        ),
        (
            "block of flat cells",
            long_cells(&[18.0, 5.6, 5.0], &[1.0, 0.8, 1.25]),
        ),
    ]
}

fn noise(cloud: &PointCloud, size: f64) -> Vec<f64> {
    let len = cloud.len() * cloud.dimension();
    (0..len)
        .map(|k| size * ((k * k) as f64 * 0.7 + 0.3 * k as f64).sin())
        .collect()
}

fn assert_close(a: &[f64], b: &[f64], tolerance: f64, what: &str) {
    let scale = b.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    let most = apart.fold(0.0, f64::max);
    assert!(most <= tolerance * scale, "{what}: {most:e} of {scale:e}");
}

fn force_of(force: &dyn Force, u: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; u.len()];
    force.add_force(0.0, u, PointSubset::All, &mut out);
    out
}

fn each_part(dimension: usize) -> Vec<(&'static str, Parts)> {
    let mut all = vec![
        (
            "several materials",
            Parts {
                materials: true,
                ..PLAIN
            },
        ),
        (
            "inclusion",
            Parts {
                inclusion: true,
                ..PLAIN
            },
        ),
        ("all", ALL),
        (
            "all, linear",
            Parts {
                law: PairLaw::Linear,
                ..ALL
            },
        ),
    ];
    let green = Parts {
        law: PairLaw::GreenStrain,
        ..ALL
    };
    all.push(("all, Green strain", green));
    if dimension == 1 {
        let literal = Parts {
            law: PairLaw::CubicSoftening,
            ..ALL
        };
        all.push(("all, equation 57", literal));
        for cubic in [CubicLaw::GreenStrain, CubicLaw::CubicSoftening] {
            for approximation in [Approximation::SecondOrder, Approximation::Trapezoidal] {
                let law = PairLaw::Approximated(cubic, approximation);
                all.push(("all, treated", Parts { law, ..ALL }));
            }
        }
    }
    if dimension > 1 {
        let of = |correction| Parts {
            correction,
            ..PLAIN
        };
        all.push(("energy", of(SurfaceCorrection::Energy)));
        all.push(("volume", of(SurfaceCorrection::Volume)));
    }
    all
}

#[test]
fn the_stencil_agrees_with_the_neighbour_list() {
    for (name, cloud) in bodies() {
        for (parts, of) in each_part(cloud.dimension()) {
            let name = format!("{name}, {parts}");
            let list = assembled(&cloud, of, BondForm::List);
            let grid = assembled(&cloud, of, BondForm::Grid);
            assert_eq!(grid.form, BondForm::Grid, "{name}");
            let (list_cuts, grid_cuts) = (list.cuts, grid.cuts);
            assert_eq!(list_cuts.len(), grid_cuts.len());
            for (a, b) in list_cuts.iter().zip(&grid_cuts) {
                assert_eq!((a.bonds, &a.points), (b.bonds, &b.points), "{name}");
            }
            let (list, mut grid) = (list.operator, grid.operator);
            // Strains of 1e-6, of a few per cent, and of order one.
            for size in [1e-6, 0.015, 0.2] {
                let u = noise(&cloud, size);
                let what = format!("{name}, size {size}");
                let expected = force_of(&*list, &u);
                for set in InstructionSet::available() {
                    grid.use_instruction_set(set);
                    assert_close(&force_of(&*grid, &u), &expected, 1e-12, &what);
                }
                let density = |force: &dyn Force| {
                    let mut out = vec![0.0; cloud.len()];
                    force.add_energy_density(0.0, &u, &mut out);
                    out
                };
                assert_close(&density(&*grid), &density(&*list), 1e-12, &what);
                let direction = noise(&cloud, 1.3);
                let tangent = |force: &dyn Force| {
                    let mut out = vec![1.0; u.len()];
                    force.tangent_into(0.0, &u, &direction, &mut out);
                    out
                };
                assert_close(&tangent(&*grid), &tangent(&*list), 1e-12, &what);
                let bonds = |force: &dyn Force, i: usize| {
                    let mut sum = [0.0; 3];
                    let view = force.capabilities().bonds.unwrap();
                    view.for_each_bond(&view.values_at(Field::new(&u, &[])), i, &mut |bond| {
                        for c in 0..3 {
                            sum[c] += bond.force[c] * bond.xi[0];
                        }
                    });
                    sum
                };
                for i in (0..cloud.len()).step_by(17) {
                    assert_close(&bonds(&*grid, i), &bonds(&*list, i), 1e-11, &what);
                }
            }
            let bound = |force: &dyn Force| force.frequency_bound(&|i| 1000.0 + i as f64);
            assert!(
                (bound(&*grid) / bound(&*list) - 1.0).abs() < 1e-13,
                "{name}"
            );
        }
    }
}

fn expanding(cloud: &Arc<PointCloud>, force: Box<dyn Force>) -> Simulation {
    let system = System::new(cloud.clone(), force, PointScalar::Uniform(1.0)).unwrap();
    let n = cloud.len();
    let mut start = State::at_rest(n * cloud.dimension());
    for i in 0..n {
        for c in 0..cloud.dimension() {
            start.v[c * n + i] = 0.012 * (cloud.point(i)[c] - 3.0) + 0.03 * (i as f64).sin();
        }
    }
    Simulation::new(system, Box::new(VelocityVerlet), start, 0.1, 60).unwrap()
}

#[test]
fn the_same_bonds_break_as_in_the_neighbour_list() {
    for (name, cloud) in bodies() {
        let run = |form| {
            let mut run = expanding(&cloud, assembled(&cloud, ALL, form).operator);
            let energy = |run: &Simulation| {
                let (system, state) = (run.system(), run.state());
                let force = system.operator();
                let elastic = force.energy(state.t, &state.u);
                system.kinetic_energy(&state.v) + elastic + force.dissipated()
            };
            let (before, momentum) = (energy(&run), run.system().momentum(&run.state().v));
            run.run(|_| Control::Continue).unwrap();
            let after = energy(&run);
            let dissipated = run.system().operator().dissipated();
            // The fluctuation of velocity Verlet at this step, equal for stencil and list.
            assert!(
                (after - before).abs() < 2e-2 * dissipated,
                "{name}: {before} {after} {dissipated}"
            );
            let moved = run.system().momentum(&run.state().v);
            for c in 0..3 {
                assert!((moved[c] - momentum[c]).abs() < 1e-10, "{name}");
            }
            run
        };
        let (list, grid) = (run(BondForm::List), run(BondForm::Grid));
        let both = [&list, &grid].map(|run| run.system().operator());
        let broken = both.map(|force| force.broken_bonds());
        assert!(broken[0] > 20, "{name}: {broken:?}");
        assert_eq!(broken[0], broken[1], "{name}");
        let dissipated = both.map(|force| force.dissipated());
        assert!((dissipated[0] / dissipated[1] - 1.0).abs() < 1e-9, "{name}");
        let damage = both.map(|force| {
            let mut damage = vec![0.0; cloud.len()];
            force.damage_into(&mut damage);
            damage
        });
        assert_close(&damage[1], &damage[0], 1e-12, name);
        assert_close(&grid.state().u, &list.state().u, 1e-9, name);
    }
}

/// Only bonds between two materials may break, so that the crack follows the interface.
#[test]
fn only_bonds_of_a_weak_interface_break() {
    let cloud = boxed([0.0; 3], &[30.0, 9.0], 1.0, 1.0);
    let glass = BondMaterial {
        fracture: Fracture::Unbreakable,
        ..of_modulus(PairLaw::BondStretch, 1.0, STRETCH)
    };
    let constants = glass.constants(&cloud, state(2)).unwrap();
    let side = |i: usize| u8::from(cloud.point(i)[0] + 0.3 * cloud.point(i)[1] > 16.0);
    let numbers: Vec<u8> = (0..cloud.len()).map(side).collect();
    let both = [constants.clone(), constants.clone()];
    let mut classes = MaterialPairs::new(numbers, &both, InterfaceRule::Harmonic).unwrap();
    classes.set_critical_stretch([0, 1], 0.01).unwrap();
    for form in [BondForm::List, BondForm::Grid, BondForm::FloatGrid] {
        let body = CompositeBody {
            classes: Some(&classes),
            ..CompositeBody::from(BondBody::new(&cloud, &glass, &constants))
        };
        let force = body.operator(form).unwrap().operator;
        let mut run = expanding(&cloud, force);
        run.run(|_| Control::Continue).unwrap();
        let force = run.system().operator();
        let mut across = 0;
        let breakable = force.capabilities().breaking.unwrap();
        breakable
            .bonds()
            .for_each_intact(&mut |i, j| across += usize::from(side(i) != side(j)));
        assert_eq!(across, 0, "{form:?}: every bond of the interface is broken");
        let of_interface = force.broken_bonds();
        let mut inside = 0;
        breakable.bonds().for_each_intact(&mut |_, _| inside += 1);
        assert_eq!(
            inside + of_interface,
            force.directed_bonds() / 2,
            "{form:?}"
        );
    }
}

#[test]
fn single_precision_agrees_within_rounding() {
    for (name, cloud) in bodies() {
        let exact = assembled(&cloud, ALL, BondForm::Grid).operator;
        let floats = assembled(&cloud, ALL, BondForm::FloatGrid).operator;
        let u = noise(&cloud, 0.02);
        let rounded = force_of(&*floats, &u);
        assert_close(&rounded, &force_of(&*exact, &u), 2e-5, name);
        assert_ne!(rounded, force_of(&*exact, &u));
    }
}

#[test]
fn subsets_threads_and_resumed_runs_are_bitwise_identical() {
    let cloud = boxed([0.0; 3], &[45.0, 30.0], 1.0, 1.0);
    let make = || assembled(&cloud, ALL, BondForm::Grid).operator;
    let u = noise(&cloud, 0.01);
    let whole = force_of(&*make(), &u);
    let third: Vec<u32> = (0..cloud.len() as u32).filter(|i| i % 3 == 1).collect();
    let rest: Vec<u32> = (0..cloud.len() as u32).filter(|i| i % 3 != 1).collect();
    let mut parts = vec![0.0; u.len()];
    let force = make();
    force.add_force(0.0, &u, PointSubset::Set(&third), &mut parts);
    force.add_force(0.0, &u, PointSubset::Set(&rest), &mut parts);
    assert!(parts == whole);
    let on = |threads, stop: Option<u64>| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(|| {
            let saved = |run: &Simulation| {
                let mut archive = Archive::default();
                run.save(&mut archive);
                archive
            };
            let mut run = expanding(&cloud, make());
            if let Some(stop) = stop {
                let at = |run: &Simulation| match run.state().step == stop {
                    true => Control::Stop,
                    false => Control::Continue,
                };
                run.run(at).unwrap();
                let archive = saved(&run);
                run = expanding(&cloud, make());
                run.restore(&archive).unwrap();
            }
            run.run(|_| Control::Continue).unwrap();
            assert!(run.system().operator().broken_bonds() > 100);
            saved(&run)
        })
    };
    let one = on(1, None);
    for (threads, stop) in [(2, None), (3, None), (7, None), (2, Some(31))] {
        assert!(on(threads, stop) == one, "{threads} threads");
    }
}

/// The time step follows from the highest frequency.
#[test]
fn the_highest_frequency_equals_that_of_the_neighbour_list() {
    for (name, cloud) in bodies() {
        let of = |form| {
            let force = assembled(&cloud, ALL, form).operator;
            let system = System::new(cloud.clone(), force, PointScalar::Uniform(1.0)).unwrap();
            highest_frequency(&system, &vec![0.0; cloud.len() * cloud.dimension()]).unwrap()
        };
        let (list, grid) = (of(BondForm::List), of(BondForm::Grid));
        // Both are results of iterations.
        for [a, b] in [[grid.estimate, list.estimate], [grid.bound, list.bound]] {
            assert!((a / b - 1.0).abs() < 1e-6, "{name}: {a} {b}");
        }
    }
}
