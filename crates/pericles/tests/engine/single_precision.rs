//! Forces in single precision compared with double precision.

use std::sync::Arc;

use pericles::family::{Crack, EndRule, VolumeCorrection};
use pericles::kernel::Influence;
use pericles::material::{
    BondMaterial, Calibration, ElasticModulus, Fracture, Modulus, PairLaw, StressState,
};
use pericles::operator::{BondBody, BondForm, Force, InstructionSet, PointSubset};
use pericles::round_trip::check_resume;
use pericles::space::{Grid, PointCloud, Region, Shape};
use pericles::time::{State, VelocityVerlet};
use pericles::{Control, PointScalar, Simulation, System};
use pericles::{Path, StepEnd};

const SPACING: f64 = 0.01;

/// A box with a round hole whose rows are not whole numbers of chunks, with an odd number of chunks in some blocks.
fn body(cells: &[f64]) -> Arc<PointCloud> {
    let grid = Grid {
        shape: Shape::Box {
            origin: [0.3, -0.1, 0.0],
            size: cells.iter().map(|count| count * SPACING).collect(),
        },
        spacing: SPACING,
        section: if cells.len() == 3 { 1.0 } else { 0.02 },
        holes: vec![Region::Ball {
            centre: [0.352, -0.069, 0.02],
            radius: 0.016,
        }],
    };
    Arc::new(grid.points().unwrap())
}

fn crack(dimension: usize) -> Crack {
    match dimension {
        1 => Crack::Section { x: 0.5 },
        2 => Crack::Segment {
            from: [0.3, -0.07],
            to: [0.4, -0.07],
        },
        _ => Crack::Disc {
            centre: [0.33, -0.07, 0.02],
            normal: [0.2, 0.1, 1.0],
            radius: 0.025,
        },
    }
}

fn operator(
    cloud: &Arc<PointCloud>,
    law: PairLaw,
    critical_stretch: f64,
    form: BondForm,
) -> Box<dyn Force> {
    let material = BondMaterial {
        law,
        density: 1000.0,
        modulus: Modulus {
            value: ElasticModulus::Young(2e9),
            calibration: Calibration::Continuum,
        },
        horizon: 3.0 * SPACING,
        influence: Influence::default(),
        volume_correction: VolumeCorrection::Linear,
        fracture: if critical_stretch.is_finite() {
            Fracture::CriticalStretch(critical_stretch)
        } else {
            Fracture::Unbreakable
        },
    };
    let state = [
        StressState::Uniaxial,
        StressState::PlaneStrain,
        StressState::Spatial,
    ][cloud.dimension() - 1];
    let constants = material.constants(cloud, state).unwrap();
    let body = BondBody {
        cracks: &[(crack(cloud.dimension()), EndRule::Closed)],
        no_fail: &[0, 1, 2],
        ..BondBody::new(cloud, &material, &constants)
    };
    body.operator(form).unwrap().operator
}

fn force(operator: &dyn Force, u: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; u.len()];
    operator.add_force(0.0, u, PointSubset::All, &mut out);
    out
}

fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |most: f64, x| most.max(x.abs()))
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    let difference: Vec<f64> = a.iter().zip(b).map(|(a, b)| a - b).collect();
    largest(&difference) / largest(b)
}

/// A stretch of about `strain` in long waves with a little noise, and a rigid translation.
fn displacement(cloud: &PointCloud, strain: f64, flight: f64) -> Vec<f64> {
    let (n, d) = (cloud.len(), cloud.dimension());
    let mut u = vec![0.0; n * d];
    for (k, u) in u.iter_mut().enumerate() {
        let (c, i) = (k / n, k % n);
        let x = cloud.point(i);
        let wave = (30.0 * x[c] + 20.0 * x[(c + 1) % d]).sin() / 30.0;
        let noise = 0.1 * SPACING * (12.9898 * k as f64).sin();
        *u = strain * (wave + noise) + flight;
    }
    u
}

const BODIES: [&[f64]; 5] = [
    &[45.0],
    &[13.0, 7.0],
    &[64.0, 9.0],
    &[11.0, 5.0, 4.0],
    &[21.0, 6.0, 5.0],
];

#[test]
fn forces_agree_to_six_digits() {
    for cells in BODIES {
        let cloud = body(cells);
        for law in [PairLaw::BondStretch, PairLaw::Linear] {
            let exact = operator(&cloud, law, f64::INFINITY, BondForm::Grid);
            let mut floats = operator(&cloud, law, f64::INFINITY, BondForm::FloatGrid);
            // In the last case many bonds are beyond the range of the fast form.
            for (strain, flight) in [(1e-6, 0.0), (1e-3, 0.0), (1e-3, 1e3), (0.1, 0.0)] {
                let u = displacement(&cloud, strain, flight);
                let expected = force(&*exact, &u);
                for set in InstructionSet::available() {
                    floats.use_instruction_set(set);
                    let error = difference(&force(&*floats, &u), &expected);
                    let what = format!("{cells:?} {law:?} {strain} {flight} {set:?}: {error:e}");
                    println!("{what}");
                    // Six digits, minus those lost because the displacement of the body exceeds that of a bond.
                    assert!(error < 1e-5, "{what}");
                    assert!(error > 0.0, "{what}");
                    let reported = floats.rounding(&u).unwrap();
                    assert!(
                        (reported / error - 1.0).abs() < 1e-6,
                        "{what}: {reported:e}"
                    );
                }
                assert_eq!(exact.rounding(&u), None);
            }
        }
    }
}

#[test]
fn evaluations_on_subsets_are_bitwise_identical_for_any_number_of_threads() {
    for cells in BODIES {
        let cloud = body(cells);
        let n = cloud.len();
        let u = displacement(&cloud, 0.03, 0.2);
        for set in InstructionSet::available() {
            let make = || {
                let mut floats = operator(
                    &cloud,
                    PairLaw::BondStretch,
                    f64::INFINITY,
                    BondForm::FloatGrid,
                );
                floats.use_instruction_set(set);
                floats
            };
            let whole = force(&*make(), &u);
            let third: Vec<u32> = (0..n as u32).filter(|i| i % 3 == 1).collect();
            let (operator, mut parts) = (make(), vec![0.0; u.len()]);
            operator.add_force(0.0, &u, PointSubset::Set(&third), &mut parts);
            for i in (0..n).filter(|i| i % 3 != 1) {
                operator.add_force(0.0, &u, PointSubset::Range(i..i + 1), &mut parts);
            }
            assert!(parts == whole, "{cells:?} {set:?}");
            for threads in [1, 2, 3, 7] {
                let pool = rayon::ThreadPoolBuilder::new()
                    .num_threads(threads)
                    .build()
                    .unwrap();
                assert!(pool.install(|| force(&*make(), &u)) == whole);
            }
        }
    }
}

#[test]
fn both_end_points_break_the_same_bonds_on_all_instruction_sets() {
    for cells in BODIES {
        let cloud = body(cells);
        let u = displacement(&cloud, 0.02, 0.0);
        let v = vec![0.0; u.len()];
        let end = StepEnd {
            t: 0.0,
            dt: 1e-6,
            u: &u,
            path: Path::MeanVelocity(&v),
        };
        let broken = |form, set, on: PointSubset<'_>| {
            let mut operator = operator(&cloud, PairLaw::BondStretch, 0.01, form);
            operator.use_instruction_set(set);
            let mut out = vec![0.0; u.len()];
            operator.end_step(&end, on, &mut out);
            let mut intact = Vec::new();
            operator
                .capabilities()
                .breaking
                .unwrap()
                .bonds()
                .for_each_intact(&mut |i, j| intact.push((i, j)));
            // Bonds seen as broken by one end only would leave a resultant force.
            let resultant: f64 = out[..cloud.len()].iter().sum();
            (
                operator.broken_bonds(),
                operator.dissipated(),
                intact,
                resultant / largest(&out),
            )
        };
        let best = InstructionSet::detect();
        let (count, energy, ..) = broken(BondForm::Grid, best, PointSubset::All);
        let whole = broken(BondForm::FloatGrid, best, PointSubset::All);
        assert!(count > 20 && whole.0.abs_diff(count) <= 1 + count / 1000);
        assert!((whole.1 / energy - 1.0).abs() < 1e-3, "{cells:?}");
        assert!(whole.3.abs() < 1e-4, "{cells:?}: {}", whole.3);
        for set in InstructionSet::available() {
            let other = broken(BondForm::FloatGrid, set, PointSubset::All);
            assert_eq!(
                (other.0, &other.2),
                (whole.0, &whole.2),
                "{cells:?} {set:?}"
            );
            assert!((other.1 / whole.1 - 1.0).abs() < 1e-12);
        }
    }
}

/// A cracked plate in tension.
fn torn(form: BondForm) -> Simulation {
    let cloud = body(&[40.0, 21.0]);
    let operator = operator(&cloud, PairLaw::BondStretch, 0.004, form);
    let (n, mut state) = (cloud.len(), State::at_rest(2 * cloud.len()));
    for i in 0..n {
        state.v[n + i] = 30.0 * (cloud.point(i)[1] + 0.07) / 0.1;
    }
    let system = System::new(cloud, operator, PointScalar::Uniform(1000.0)).unwrap();
    Simulation::new(system, Box::new(VelocityVerlet), state, 2e-6, 400).unwrap()
}

#[test]
fn crack_in_a_plate_agrees_with_double_precision_and_resumes() {
    let (mut exact, mut floats) = (torn(BondForm::Grid), torn(BondForm::FloatGrid));
    exact.run(|_| Control::Continue).unwrap();
    floats.run(|_| Control::Continue).unwrap();
    let count = |run: &Simulation| run.system().operator().broken_bonds();
    println!("{} {}", count(&exact), count(&floats));
    assert!(count(&exact) > 100);
    assert!(count(&floats).abs_diff(count(&exact)) <= count(&exact) / 50);
    let energies = floats.snapshot().energies();
    let balance = energies.balance() / energies.initial;
    assert!(balance.abs() < 1e-5, "{balance:e}");
    check_resume(|| torn(BondForm::FloatGrid), [170]).unwrap();
}

#[test]
fn the_work_array_is_half_as_large() {
    let cloud = body(&[64.0, 64.0]);
    let bytes = |form| operator(&cloud, PairLaw::BondStretch, 0.01, form).bytes() as f64;
    let saved = bytes(BondForm::Grid) - bytes(BondForm::FloatGrid);
    assert!(saved > 0.9 * 8.0 * cloud.len() as f64, "{saved}");
}
