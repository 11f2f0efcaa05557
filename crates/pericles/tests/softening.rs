//! Softening bonds: force–stretch curve, fracture energy, energy balance, history.

use std::sync::Arc;

use pericles::boundary::{PrescribedMotion, TimeFunction};
use pericles::domain::Field;
use pericles::family::VolumeCorrection;
use pericles::material::{
    BondMaterial, CrackPlane, ElasticModulus, FractureCalibration, InterfaceRule, MaterialPairs,
    PairLaw, Scattered, Softening, SofteningLaw, StrengthScatter, StressState,
};
use pericles::operator::{BondBody, BondForm, CompositeBody, Force, InstructionSet, PointSubset};
use pericles::round_trip::check_resume;
use pericles::space::{Grid, PointCloud};
use pericles::time::{State, VelocityVerlet};
use pericles::{Control, Path, PointScalar, Simulation, StepEnd, System};

const LIMIT: f64 = 0.02;
const HORIZON: f64 = 3.0 * (1.0 + 1e-6);

fn laws() -> [SofteningLaw; 3] {
    [
        SofteningLaw::Linear,
        SofteningLaw::PETERSSON,
        SofteningLaw::Exponential,
    ]
}

fn softening(law: SofteningLaw) -> Softening {
    let onset = 0.4 * LIMIT;
    Softening { law, onset }
}

fn material(law: PairLaw) -> BondMaterial {
    let mut material = BondMaterial::new(ElasticModulus::Young(10.0), 1.0, HORIZON);
    material.law = law;
    material.volume_correction = VolumeCorrection::None;
    material.with_critical_stretch(LIMIT)
}

fn state_of(cloud: &PointCloud) -> StressState {
    match cloud.dimension() {
        1 => StressState::Uniaxial,
        2 => StressState::PlaneStress,
        _ => StressState::Spatial,
    }
}

fn operator(
    cloud: &Arc<PointCloud>,
    law: PairLaw,
    softening: Softening,
    no_fail: &[u32],
) -> Box<dyn Force> {
    let material = material(law);
    let constants = material.constants(cloud, state_of(cloud)).unwrap();
    let body = BondBody {
        no_fail,
        ..BondBody::new(cloud, &material, &constants)
    };
    let body = CompositeBody {
        softening: Some(softening),
        ..CompositeBody::from(body)
    };
    body.operator(BondForm::Fastest).unwrap().operator
}

/// Two points at distance 1 with one bond.
fn pair() -> Arc<PointCloud> {
    Arc::new(PointCloud::new(1, vec![0.0, 1.0], vec![1.0; 2], 1.0).unwrap())
}

/// Ends a step at `u` without a known path within the step.
fn reach(force: &mut dyn Force, u: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; u.len()];
    force.end_step(&StepEnd::sub_step(0.0, 0.0, u), PointSubset::All, &mut out);
    out
}

fn force_at(force: &dyn Force, u: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; u.len()];
    force.add_force(0.0, u, PointSubset::All, &mut out);
    out
}

/// Loading, unloading, compression, reloading and failure: the force follows curve and secant, energy and
/// dissipation their areas.
#[test]
fn bond_follows_its_softening_curve_and_unloads_to_the_origin() {
    for law in laws() {
        let cloud = pair();
        let mut force = operator(&cloud, PairLaw::Linear, softening(law), &[]);
        let curve = softening(law).curve(LIMIT).unwrap();
        let unit = force_at(&*force, &[0.0, 1e-3])[0] / 1e-3;
        let energy = force.energy(0.0, &[0.0, 1e-3]) / 1e-6;
        let mut largest: f64 = 0.0;
        let end = curve.end();
        let way = [0.3, 0.6, 0.2, -0.4, 0.5, 0.75, 0.1, 0.9, 1.01, 0.5, -0.3];
        for s in way.map(|part| part * end) {
            let u = [0.0, s];
            largest = largest.max(s);
            let retained = curve.retained(largest);
            // During the step, at its end, and after it.
            let trial = force_at(&*force, &u);
            let stored = force.energy(0.0, &u);
            let reached = reach(&mut *force, &u);
            for f in [trial, reached, force_at(&*force, &u)] {
                let wanted = unit * retained * s;
                assert!(
                    (f[0] - wanted).abs() < 1e-13 * unit * end,
                    "{law:?} {s}: {f:?}"
                );
                assert_eq!(f[0], -f[1]);
            }
            let wanted = energy * retained * s * s;
            assert!((stored - wanted).abs() < 1e-13 * energy * end * end);
            let lost = 2.0 * energy * curve.dissipated(largest);
            assert!((force.dissipated() - lost).abs() < 1e-12 * energy * end * end);
            let mut damage = [0.0; 2];
            force.damage_into(&mut damage);
            assert!((damage[0] - (1.0 - retained)).abs() < 1e-13, "{damage:?}");
        }
        assert_eq!(force.broken_bonds(), 1);
    }
}

/// Rigid separation of two halves of a lattice: the mean dissipated energy over planes equals the fracture
/// energy, and the energy of each plane equals its lattice sum, to round-off.
#[test]
fn separation_dissipates_the_fracture_energy() {
    const ENERGY: f64 = 1e-3;
    for law in laws() {
        for pair_law in [PairLaw::Linear, PairLaw::BondStretch] {
            let cloud = Arc::new(Grid::plate([14.0, 14.0], 1.0, 1.0).points().unwrap());
            let mut material = material(pair_law).with_fracture_energy(ENERGY);
            material.volume_correction = VolumeCorrection::None;
            let constants = material
                .constants(&cloud, StressState::PlaneStress)
                .unwrap();
            assert_eq!(
                constants.fracture_calibration,
                Some(FractureCalibration::Lattice)
            );
            let mean = CrackPlane::mean(&constants.crack_planes);
            assert!((mean / ENERGY - 1.0).abs() < 1e-12, "{mean}");
            let softening = Softening {
                law,
                onset: 0.5 * constants.critical_stretch,
            };
            let body = CompositeBody {
                softening: Some(softening),
                ..CompositeBody::from(BondBody::new(&cloud, &material, &constants))
            };
            let mut force = body.operator(BondForm::List).unwrap().operator;
            let brittle = BondBody::new(&cloud, &material, &constants);
            let brittle = brittle.operator(BondForm::List).unwrap().operator;
            // Bonds across the middle, with their energies at the critical stretch.
            let n = cloud.len();
            let side = |i: usize| cloud.point(i)[0] > 7.0;
            let rest = vec![0.0; 2 * n];
            let view = brittle.capabilities().bonds.unwrap();
            let values = view.values_at(Field::new(&rest, &[]));
            let mut wanted = 0.0;
            for i in 0..n {
                view.for_each_bond(&values, i, &mut |bond| {
                    if side(i) != side(bond.neighbour) {
                        let length = bond.xi.iter().map(|x| x * x).sum::<f64>().sqrt();
                        let alpha = material.influence.alpha_of(bond.xi, material.horizon);
                        let c = constants.micromodulus * alpha;
                        let s = constants.critical_stretch;
                        wanted += 0.25
                            * c
                            * s
                            * s
                            * length
                            * cloud.volumes()[i]
                            * cloud.volumes()[bond.neighbour];
                    }
                });
            }
            for opening in [0.004, 0.011, 0.03, 0.02, 0.1, 0.4, 5.0] {
                let u: Vec<f64> = (0..2 * n)
                    .map(|entry| f64::from(entry < n && side(entry % n)) * opening)
                    .collect();
                reach(&mut *force, &u);
            }
            let error = force.dissipated() / wanted - 1.0;
            assert!(error.abs() < 1e-12, "{law:?} {pair_law:?}: {error:e}");
            assert!(force.broken_bonds() > 50);
        }
    }
}

fn shaken(cloud: &PointCloud, amplitude: f64) -> Vec<f64> {
    let n = cloud.len();
    let d = cloud.dimension();
    let of = |entry: usize| {
        let [x, y, z] = cloud.point(entry % n);
        let c = (entry / n) as f64;
        amplitude * (0.9 * x + 1.3 * y - 0.7 * z + c).sin()
    };
    (0..d * n).map(of).collect()
}

/// The force is the gradient of the energy plus the dissipation of the step, and the tangent is its
/// derivative, in loading and unloading.
#[test]
fn forces_are_gradients_and_tangents_are_their_derivatives() {
    for (cells, law) in [
        (&[9][..], PairLaw::Linear),
        (&[6, 5], PairLaw::BondStretch),
        (&[4, 4, 3], PairLaw::BondStretch),
    ] {
        let size: Vec<f64> = cells.iter().map(|&count| f64::from(count)).collect();
        let grid = match size[..] {
            [x] => Grid::bar(x, 1.0, 1.0),
            [x, y] => Grid::plate([x, y], 1.0, 1.0),
            [x, y, z] => Grid::block([x, y, z], 1.0),
            _ => unreachable!(),
        };
        let cloud = Arc::new(grid.points().unwrap());
        for softening_law in laws() {
            let mut force = operator(&cloud, law, softening(softening_law), &[0, 1]);
            reach(&mut *force, &shaken(&cloud, 0.01));
            let u = shaken(&cloud, 0.013);
            let d = shaken(&cloud, 1.0);
            let entries = u.len();
            let d: Vec<f64> = d.iter().rev().copied().collect();
            let moved = |h: f64| -> Vec<f64> { u.iter().zip(&d).map(|(u, d)| u + h * d).collect() };
            let h = 1e-7;
            let (up, down) = (force_at(&*force, &moved(h)), force_at(&*force, &moved(-h)));
            let mut tangent = vec![0.0; entries];
            force.tangent_into(0.0, &u, &d, &mut tangent);
            let largest = tangent.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            for k in 0..entries {
                let slope = (up[k] - down[k]) / (2.0 * h);
                let error = (slope - tangent[k]).abs();
                assert!(
                    error < 1e-5 * largest,
                    "{softening_law:?} {k}: {slope} {}",
                    tangent[k]
                );
            }
            // E + D of a step to u ± h d, with two copies of the body.
            let total = |h: f64| {
                let mut copy = operator(&cloud, law, softening(softening_law), &[0, 1]);
                reach(&mut *copy, &shaken(&cloud, 0.01));
                let there = moved(h);
                reach(&mut *copy, &there);
                copy.energy(0.0, &there) + copy.dissipated()
            };
            let here = force_at(&*force, &u);
            let n = cloud.len();
            let work: f64 = (0..entries)
                .map(|k| here[k] * d[k] * cloud.volumes()[k % n])
                .sum();
            let slope = (total(1e-6) - total(-1e-6)) / 2e-6;
            assert!((slope + work).abs() < 1e-6 * work.abs(), "{slope} {work}");
        }
    }
}

/// A plate in tension by prescribed velocities of its ends.
fn torn(law: PairLaw, softening: Softening, dt: f64) -> Simulation {
    let cloud = Arc::new(Grid::plate([10.0, 16.0], 1.0, 1.0).points().unwrap());
    let n = cloud.len();
    let rows = |low: f64, high: f64| -> Vec<u32> {
        let inside = |i: &u32| (low..high).contains(&cloud.point(*i as usize)[1]);
        (0..n as u32).filter(inside).collect()
    };
    let (bottom, top) = (rows(0.0, 3.0), rows(13.0, 16.0));
    let no_fail: Vec<u32> = bottom.iter().chain(&top).copied().collect();
    let force = operator(&cloud, law, softening, &no_fail);
    let mut system = System::new(cloud.clone(), force, PointScalar::Uniform(1.0)).unwrap();
    for (points, speed) in [(bottom, -0.02), (top, 0.02)] {
        let velocity = [Some(0.0), Some(speed), None];
        let motion = PrescribedMotion::velocity(points, velocity, TimeFunction::Constant);
        system.add_motion(motion).unwrap();
    }
    let mut start = State::at_rest(2 * n);
    for i in 0..n {
        let [x, y, _] = cloud.point(i);
        if (3.0..13.0).contains(&y) {
            start.v[n + i] = 0.02 * (y - 8.0) / 5.0 + 0.003 * (0.6 * x).sin();
        }
    }
    let steps = (16.0 / dt).round() as u64;
    Simulation::new(system, Box::new(VelocityVerlet), start, dt, steps).unwrap()
}

/// For extensions linear in the displacement the energy balance of velocity Verlet is exact, including
/// softening and breaking bonds.
#[test]
fn energy_balance_with_small_strains_closes_to_round_off() {
    for law in laws() {
        let mut run = torn(PairLaw::Linear, softening(law), 0.1);
        run.run(|_| Control::Continue).unwrap();
        let energies = run.snapshot().energies();
        let broken = run.system().operator().broken_bonds();
        assert!(
            broken > 20 || law == SofteningLaw::Exponential,
            "{law:?}: {broken}"
        );
        assert!(energies.dissipated > 0.2 * energies.work, "{energies:?}");
        let error = energies.balance().abs() / energies.work;
        assert!(error < 1e-11, "{law:?}: {error:e}");
    }
}

#[test]
fn energy_balance_with_finite_strains_converges_with_second_order() {
    for law in laws() {
        let errors = [0.16, 0.08, 0.04].map(|dt| {
            let mut run = torn(PairLaw::BondStretch, softening(law), dt);
            run.run(|_| Control::Continue).unwrap();
            let energies = run.snapshot().energies();
            energies.balance().abs() / energies.work
        });
        println!("{law:?}: {errors:?}");
        // Chosen before the first run. The bonds that break within a step depend on the step length, so that
        // the order is a mean.
        assert!(errors[2] < 1e-4, "{law:?}: {errors:?}");
        assert!(errors[2] < 0.25 * errors[0], "{law:?}: {errors:?}");
    }
}

/// The dissipated energy of a run is the area between the secants of its steps: exact for a linear curve, of
/// second order in the step for a nonlinear one.
#[test]
fn dissipation_converges_to_the_area_under_the_curve() {
    let cloud = pair();
    let errors_of = |law: SofteningLaw| {
        let curve = softening(law).curve(LIMIT).unwrap();
        // Softening starts at a tenth of the path, the end of a step for all numbers of steps.
        let end = 10.0 * curve.onset();
        [40, 80, 160].map(|steps| {
            let mut force = operator(&cloud, PairLaw::Linear, softening(law), &[]);
            let unit = force.energy(0.0, &[0.0, 1e-3]) / 1e-6;
            let dt = 1.0 / f64::from(steps);
            for k in 1..=steps {
                let u = [0.0, end * f64::from(k) * dt];
                let step = StepEnd {
                    t: f64::from(k) * dt,
                    dt,
                    u: &u,
                    path: Path::MeanVelocity(&[0.0, end]),
                };
                force.end_step(&step, PointSubset::All, &mut [0.0; 2]);
            }
            (force.dissipated() / (2.0 * unit * curve.dissipated(end)) - 1.0).abs()
        })
    };
    // Beyond the end of the linear curve, where its whole area is dissipated.
    let straight = errors_of(SofteningLaw::Linear);
    assert!(straight.iter().all(|error| *error < 1e-12), "{straight:?}");
    let bent = errors_of(SofteningLaw::Exponential);
    assert!(bent[2] < 1e-3, "{bent:?}");
    let order = (bent[0] / bent[2]).log2() / 2.0;
    assert!((order - 2.0).abs() < 0.1, "{bent:?}");
}

#[test]
fn runs_conserve_momentum_resume_and_are_bitwise_identical_for_any_number_of_threads() {
    for law in laws() {
        let make = || torn(PairLaw::BondStretch, softening(law), 0.1);
        let steps = make().steps();
        let end = check_resume(make, [steps / 2, 3 * steps / 4]).unwrap();
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            let stored = pool.unwrap().install(|| {
                let mut run = make();
                run.run(|_| Control::Continue).unwrap();
                let operator = run.system().operator();
                let f = force_at(operator, &run.state().u);
                let n = run.system().points();
                for c in 0..2 {
                    let all = &f[c * n..(c + 1) * n];
                    let total: f64 = all.iter().sum();
                    let size: f64 = all.iter().map(|f| f.abs()).sum();
                    assert!(total.abs() < 1e-13 * size, "{total} {size}");
                }
                let mut archive = pericles::Archive::default();
                pericles::Checkpointed::save(&run, &mut archive);
                archive
            });
            assert_eq!(end.differences(&stored), Vec::<String>::new(), "{threads}");
        }
    }
}

/// On all instruction sets the same bonds break, and forces differ by round-off.
#[test]
fn instruction_sets_agree() {
    let cloud = Arc::new(Grid::plate([9.0, 7.0], 1.0, 1.0).points().unwrap());
    let ends = InstructionSet::available().into_iter().map(|set| {
        let mut force = operator(
            &cloud,
            PairLaw::BondStretch,
            softening(SofteningLaw::Exponential),
            &[],
        );
        force.use_instruction_set(set);
        reach(&mut *force, &shaken(&cloud, 0.02));
        let dissipated = force.dissipated();
        (dissipated, reach(&mut *force, &shaken(&cloud, 0.015)))
    });
    let ends: Vec<_> = ends.collect();
    assert!(ends[0].0 > 0.0);
    for (dissipated, f) in &ends {
        assert_eq!(*dissipated, ends[0].0);
        let largest = f.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let differ = f
            .iter()
            .zip(&ends[0].1)
            .any(|(a, b)| (a - b).abs() > 1e-13 * largest);
        assert!(!differ);
    }
}

/// Every pair of materials has its own curve, which scattered strengths scale.
#[test]
fn softening_curves_depend_on_materials_and_strengths() {
    let cloud = Arc::new(Grid::plate([8.0, 4.0], 1.0, 1.0).points().unwrap());
    let n = cloud.len();
    let material = material(PairLaw::Linear);
    let constants = material
        .constants(&cloud, StressState::PlaneStress)
        .unwrap();
    let mut tough = constants.clone();
    tough.critical_stretch = 2.0 * LIMIT;
    let of_point: Vec<u8> = (0..n).map(|i| u8::from(cloud.point(i)[0] > 4.0)).collect();
    let all = [constants.clone(), tough];
    let classes = MaterialPairs::new(of_point, &all, InterfaceRule::default()).unwrap();
    let scatter = StrengthScatter {
        of: Scattered::CriticalStretch,
        shape: 8.0,
        seed: 5,
    };
    let factors = scatter.factors(&cloud).unwrap();
    let classes = classes.with_strengths(factors).unwrap();
    let law = SofteningLaw::Exponential;
    let body = CompositeBody {
        classes: Some(&classes),
        softening: Some(softening(law)),
        ..CompositeBody::from(BondBody::new(&cloud, &material, &constants))
    };
    let mut force = body.operator(BondForm::Fastest).unwrap().operator;
    // Uniform stretch along x: the stretch of a bond is s ξ_x²/|ξ|².
    let s = 1.7 * LIMIT;
    let u: Vec<f64> = (0..2 * n)
        .map(|entry| {
            if entry < n {
                s * cloud.point(entry)[0]
            } else {
                0.0
            }
        })
        .collect();
    reach(&mut *force, &u);
    let mut wanted = vec![0.0; n];
    let brittle = BondBody::new(&cloud, &material, &constants);
    let brittle = brittle.operator(BondForm::List).unwrap().operator;
    let view = brittle.capabilities().bonds.unwrap();
    let values = view.values_at(Field::new(&vec![0.0; 2 * n], &[]));
    for (i, damage) in wanted.iter_mut().enumerate() {
        let (mut whole, mut left) = (0.0, 0.0);
        view.for_each_bond(&values, i, &mut |bond| {
            let j = bond.neighbour;
            let square: f64 = bond.xi.iter().map(|x| x * x).sum();
            let stretch = s * bond.xi[0] * bond.xi[0] / square;
            let limit = classes.critical_stretch(i, j);
            let factor =
                limit / classes.pair_critical_stretch([i, j].map(|k| classes.of_point()[k]));
            let curve = softening(law).curve(limit / factor).unwrap();
            whole += 1.0;
            left += curve.retained(stretch / factor);
        });
        *damage = 1.0 - left / whole;
    }
    let mut damage = vec![0.0; n];
    force.damage_into(&mut damage);
    for i in 0..n {
        assert!(
            (damage[i] - wanted[i]).abs() < 1e-12,
            "{i}: {} {}",
            damage[i],
            wanted[i]
        );
    }
    assert!(damage.iter().any(|d| *d > 0.3));
}

#[test]
fn bodies_without_support_for_softening_are_errors() {
    let cloud = Arc::new(Grid::plate([8.0, 4.0], 1.0, 1.0).points().unwrap());
    let rejection = |material: &BondMaterial, onset: f64, form: BondForm| {
        let constants = material
            .constants(&cloud, StressState::PlaneStress)
            .unwrap();
        let body = CompositeBody {
            softening: Some(Softening {
                law: SofteningLaw::Linear,
                onset,
            }),
            ..CompositeBody::from(BondBody::new(&cloud, material, &constants))
        };
        body.operator(form).err().map(|error| error.to_string())
    };
    let own = material(PairLaw::Linear);
    assert_eq!(rejection(&own, 0.01, BondForm::Fastest), None);
    let stencil = rejection(&own, 0.01, BondForm::Grid).unwrap();
    assert!(stencil.contains("largest stretch"), "{stencil}");
    let onset = rejection(&own, 0.03, BondForm::List).unwrap();
    assert!(onset.contains("below the critical stretch"), "{onset}");
    let green = rejection(&material(PairLaw::GreenStrain), 0.01, BondForm::List).unwrap();
    assert!(green.contains("bond-stretch"), "{green}");
}
