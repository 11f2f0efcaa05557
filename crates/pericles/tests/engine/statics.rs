//! Static states by adaptive dynamic relaxation, bodies of several materials, surface corrections.

use std::sync::Arc;

use crate::common::{boxed, material, points};
use pericles::boundary::{Load, MotionKind, PrescribedMotion, TimeFunction};
use pericles::family::{BondList, VolumeCorrection};
use pericles::material::{
    BondConstants, BondMaterial, ElasticModulus, Fracture, InterfaceRule, MaterialPairs, Modulus,
    StressState, SurfaceCorrection, SurfaceFactors,
};
use pericles::operator::{BondBody, BondForm, CompositeBody, Force, PointSubset};
use pericles::space::PointCloud;
use pericles::time::{Damping, Relaxation, RelaxationOptions, State, VelocityVerlet};
use pericles::{
    Control, Found, Outcome, PericlesError, PointScalar, Simulation, SimulationError, StepEnd,
    StopCondition, StopWhen, System,
};

const CELLS: usize = 100;
const DX: f64 = 0.01;
const AREA: f64 = 0.01;
const YOUNG: f64 = 200e9;
const FORCE: f64 = 2e6;

/// A bar from 0 to 1 with a layer of three cells below 0.
fn bar() -> Arc<PointCloud> {
    boxed([-0.03, 0.0, 0.0], &[1.03], DX, AREA)
}

fn steel(fracture: Fracture) -> BondMaterial {
    material(
        7850.0,
        YOUNG,
        3.0 * DX,
        VolumeCorrection::Extended,
        fracture,
    )
}

fn constants(material: &BondMaterial, cloud: &PointCloud) -> BondConstants {
    material.constants(cloud, StressState::Uniaxial).unwrap()
}

fn operator(
    cloud: &Arc<PointCloud>,
    material: &BondMaterial,
    classes: Option<&MaterialPairs>,
    correction: SurfaceCorrection,
) -> Box<dyn Force> {
    let constants = constants(material, cloud);
    let body = BondBody::new(cloud, material, &constants);
    let composite = CompositeBody {
        body,
        classes,
        correction,
        softening: None,
        strengths: &[],
    };
    composite.operator(BondForm::List).unwrap().operator
}

/// Fixes the layer below 0; the other end is pulled by a force or a prescribed displacement.
enum Pull {
    Force,
    Move(f64),
}

fn held(cloud: &Arc<PointCloud>, operator: Box<dyn Force>, pull: &Pull) -> System {
    let mut system = System::new(cloud.clone(), operator, PointScalar::Uniform(7850.0)).unwrap();
    let ramp = || TimeFunction::Ramp {
        start: 0.0,
        duration: 1.0,
    };
    let still = vec![0.0; cloud.len()];
    let mut hold = |name: &str, inside: &dyn Fn(f64) -> bool, far: f64| {
        let motion = PrescribedMotion::new(
            name.into(),
            points(cloud, |x, _, _| inside(x)),
            MotionKind::Displacement,
            [Some(far), None, None],
            ramp(),
            &still,
            cloud.len(),
        )
        .unwrap();
        system.add_motion(motion).unwrap();
    };
    hold("left", &|x| x < 0.0, 0.0);
    let end = |x: f64| x > 1.0 - 3.0 * DX;
    match pull {
        Pull::Move(far) => hold("right", &end, *far),
        Pull::Force => {
            let layer = points(cloud, |x, _, _| end(x));
            let traction = [FORCE / AREA, 0.0, 0.0];
            system
                .add_load(Load::traction(cloud, layer, traction, AREA, ramp()).unwrap())
                .unwrap();
        }
    }
    system
}

fn relaxed(
    system: System,
    options: RelaxationOptions,
    steps: u64,
) -> Result<Simulation, SimulationError> {
    let scheme = Relaxation::new(options, &system).unwrap();
    let state = State::at_rest(system.points());
    let dt = 1.0 / steps as f64;
    let mut simulation = Simulation::new(system, Box::new(scheme), state, dt, steps).unwrap();
    simulation.run(|_| Control::Continue)?;
    Ok(simulation)
}

fn fine() -> RelaxationOptions {
    RelaxationOptions {
        tolerance: 1e-8,
        ..RelaxationOptions::default()
    }
}

/// Mean displacement of the last cell, and mean strain of the middle half.
fn end_and_strain(u: &[f64]) -> (f64, f64) {
    let (from, to) = (CELLS / 4, 3 * CELLS / 4);
    let strain = (u[to] - u[from]) / ((to - from) as f64 * DX);
    (u[u.len() - 1], strain)
}

#[test]
fn strain_of_a_bar_in_tension_is_exact() {
    let cloud = bar();
    let unbreakable = steel(Fracture::Unbreakable);
    let exact = FORCE / (YOUNG * AREA);
    for correction in [
        SurfaceCorrection::None,
        SurfaceCorrection::Volume,
        SurfaceCorrection::Energy,
    ] {
        let force = operator(&cloud, &unbreakable, None, correction);
        let run = relaxed(held(&cloud, force, &Pull::Force), fine(), 1).unwrap();
        let (end, strain) = end_and_strain(&run.state().u);
        // Inside the bar the bond-stretch law is linear: the strain is exact.
        assert!(
            (strain / exact - 1.0).abs() < 1e-5,
            "{correction:?}: {strain}"
        );
        assert!((end / exact - 1.0).abs() < 0.015, "{correction:?}: {end}");
        let reaction = run.system().motions()[0].reaction(&cloud)[0];
        assert!((reaction / -FORCE - 1.0).abs() < 1e-6, "{reaction}");
        let energies = run.snapshot().energies();
        assert!(energies.balance().abs() < 1e-6 * energies.work);
        assert_eq!(energies.kinetic, 0.0);
    }
}

#[test]
fn static_state_does_not_depend_on_damping_and_load_steps() {
    let cloud = bar();
    let unbreakable = steel(Fracture::Unbreakable);
    let run = |damping, steps| {
        let force = operator(&cloud, &unbreakable, None, SurfaceCorrection::None);
        let options = RelaxationOptions { damping, ..fine() };
        relaxed(held(&cloud, force, &Pull::Force), options, steps).unwrap()
    };
    let reference = run(Damping::Adaptive, 1);
    let others = [
        (Damping::Adaptive, 3),
        (Damping::Viscous(0.05), 1),
        (Damping::Fire, 1),
        (Damping::Fire, 3),
    ];
    for (damping, steps) in others {
        let other = run(damping, steps);
        for (a, b) in reference.state().u.iter().zip(&other.state().u) {
            assert!((a - b).abs() < 1e-8, "{damping:?}: {a} {b}");
        }
        let energies = other.snapshot().energies();
        assert!(
            energies.balance().abs() < 1e-6 * energies.work,
            "{energies:?}"
        );
    }
}

#[test]
fn unbalanced_load_on_a_free_body_is_an_error() {
    let cloud = bar();
    let force = operator(
        &cloud,
        &steel(Fracture::Unbreakable),
        None,
        SurfaceCorrection::None,
    );
    let mut system = System::new(cloud.clone(), force, PointScalar::Uniform(1.0)).unwrap();
    system
        .add_load(Load::new(vec![5], [1.0, 0.0, 0.0], TimeFunction::Constant))
        .unwrap();
    let options = RelaxationOptions {
        iterations: 500,
        ..fine()
    };
    match relaxed(system, options, 1) {
        Err(SimulationError::NoStaticState { source, .. }) => {
            let found = matches!(
                *source,
                PericlesError::NoEquilibrium {
                    iterations: 500,
                    ..
                }
            );
            assert!(found, "{source}");
        }
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("a free body has no equilibrium"),
    }
}

#[test]
fn breaking_bar_dissipates_the_work_done() {
    // The right third is softer, so that it is stretched more and breaks.
    let cloud = bar();
    let brittle = steel(Fracture::CriticalStretch(1e-3));
    let soft = BondMaterial {
        modulus: Modulus {
            value: ElasticModulus::Young(0.5 * YOUNG),
            ..brittle.modulus
        },
        ..brittle.clone()
    };
    let of_point = (0..cloud.len())
        .map(|i| u8::from(cloud.point(i)[0] > 0.66))
        .collect();
    let both = [constants(&brittle, &cloud), constants(&soft, &cloud)];
    let classes = MaterialPairs::new(of_point, &both, InterfaceRule::Harmonic).unwrap();
    let force = operator(&cloud, &brittle, Some(&classes), SurfaceCorrection::None);
    let system = held(&cloud, force, &Pull::Move(1.2e-3));
    let run = relaxed(system, fine(), 12).unwrap();
    let operator = run.system().operator();
    assert!(operator.broken_bonds() > 0);
    let energies = run.snapshot().energies();
    assert!(energies.dissipated > 0.0 && energies.scheme >= 0.0);
    // The damped energy is computed from the energies themselves; the energy balance is an independent check
    // only before bonds break.
    assert!(
        energies.balance().abs() < 1e-5 * energies.work,
        "{energies:?}"
    );
    // After the bar has broken, the reactions of both ends are negligible compared with their peak.
    let peak = 1e-3 * YOUNG * AREA;
    for motion in run.system().motions() {
        let reaction = motion.reaction(&cloud)[0];
        assert!(reaction.abs() < 1e-4 * peak, "{reaction}");
    }
}

#[test]
fn equal_materials_equal_a_single_material() {
    let cloud = boxed([0.0; 3], &[0.12, 0.08], DX, 0.01);
    let steel = steel(Fracture::CriticalStretch(0.01));
    let constants = steel.constants(&cloud, StressState::PlaneStress).unwrap();
    let classes = MaterialPairs::new(
        (0..cloud.len()).map(|i| (i % 3) as u8).collect(),
        &[constants.clone(), constants.clone(), constants.clone()],
        InterfaceRule::Harmonic,
    )
    .unwrap();
    let body = BondBody::new(&cloud, &steel, &constants);
    let forces = |classes: Option<&MaterialPairs>| {
        let composite = CompositeBody {
            body: body.clone(),
            classes,
            correction: SurfaceCorrection::None,
            softening: None,
            strengths: &[],
        };
        let mut operator = composite.operator(BondForm::List).unwrap().operator;
        let entries = 2 * cloud.len();
        let u: Vec<f64> = (0..entries)
            .map(|k| 2e-4 * (1.7 * k as f64).sin())
            .collect();
        operator.end_step(
            &StepEnd::sub_step(0.0, 0.0, &u),
            PointSubset::All,
            &mut vec![0.0; u.len()],
        );
        let mut force = vec![0.0; entries];
        operator.add_force(0.0, &u, PointSubset::All, &mut force);
        (force, operator.broken_bonds(), operator.dissipated())
    };
    let (plain, mixed) = (forces(None), forces(Some(&classes)));
    assert!(plain.1 > 0);
    assert_eq!(plain, mixed);
}

#[test]
fn two_materials_in_series_act_as_springs_and_break_at_the_weak_interface() {
    let cloud = bar();
    let hard = steel(Fracture::Unbreakable);
    let soft = BondMaterial {
        modulus: Modulus {
            value: ElasticModulus::Young(YOUNG / 3.0),
            ..hard.modulus
        },
        ..hard.clone()
    };
    let both = [constants(&hard, &cloud), constants(&soft, &cloud)];
    let half = |i: usize| u8::from(cloud.point(i)[0] > 0.5);
    for rule in [
        InterfaceRule::Harmonic,
        InterfaceRule::Arithmetic,
        InterfaceRule::Weaker,
    ] {
        let of_point = (0..cloud.len()).map(half).collect();
        let mut classes = MaterialPairs::new(of_point, &both, rule).unwrap();
        let force = operator(&cloud, &hard, Some(&classes), SurfaceCorrection::None);
        let run = relaxed(held(&cloud, force, &Pull::Force), fine(), 1).unwrap();
        let strain = |from: usize, to: usize| {
            (run.state().u[to] - run.state().u[from]) / ((to - from) as f64 * DX)
        };
        let unit = FORCE / (YOUNG * AREA);
        assert!((strain(15, 40) / unit - 1.0).abs() < 1e-5, "{rule:?}");
        assert!(
            (strain(65, 90) / (3.0 * unit) - 1.0).abs() < 1e-5,
            "{rule:?}"
        );
        // Unbreakable halves with a weak interface: only mixed bonds break, three times two of them.
        classes.set_critical_stretch([0, 1], 1e-5).unwrap();
        let force = operator(&cloud, &hard, Some(&classes), SurfaceCorrection::None);
        let torn = relaxed(held(&cloud, force, &Pull::Move(1e-3)), fine(), 4).unwrap();
        assert_eq!(torn.system().operator().broken_bonds(), 6, "{rule:?}");
    }
}

#[test]
fn surface_corrections_preserve_interior_and_momentum() {
    let (width, height) = (0.32, 0.26);
    let cloud = boxed([0.0; 3], &[width, height], DX, 0.01);
    let steel = steel(Fracture::Unbreakable);
    let bonds = BondList::new(&cloud, steel.horizon, steel.volume_correction).unwrap();
    let constants = steel.constants(&cloud, StressState::PlaneStress).unwrap();
    assert_eq!(
        SurfaceCorrection::None.factors(&bonds, &steel),
        SurfaceFactors::None
    );
    for (correction, margin) in [
        (SurfaceCorrection::Volume, 0.08),
        // Each iteration of the condition extends the correction by a horizon.
        (SurfaceCorrection::Energy, 0.12),
    ] {
        let factors = correction.factors(&bonds, &steel);
        let factor = |i: usize, j: usize| factors.of_bond(i, j, bonds.vector(i, j));
        let corner = cloud.nearest([0.0; 3]);
        let (_, beside) = bonds.family(corner).next().unwrap();
        assert!(factor(corner, beside) > 1.5 && factor(corner, beside) < 5.0);
        for i in 0..cloud.len() {
            let [x, y, _] = cloud.point(i);
            let inside = |x: f64, side: f64| x > margin && x < side - margin;
            for (_, j) in bonds.family(i) {
                assert_eq!(factor(i, j), factor(j, i));
                if inside(x, width) && inside(y, height) {
                    let off = factor(i, j) - 1.0;
                    assert!(off.abs() < 1e-12, "{correction:?} {off}");
                }
            }
        }
        let body = BondBody::new(&cloud, &steel, &constants);
        let energy = |correction| {
            let composite = CompositeBody {
                body: body.clone(),
                classes: None,
                correction,
                softening: None,
                strengths: &[],
            };
            let operator = composite.operator(BondForm::List).unwrap().operator;
            let n = cloud.len();
            // Uniform dilation.
            let u: Vec<f64> = (0..2 * n).map(|k| 1e-6 * cloud.positions()[k]).collect();
            let mut force = vec![0.0; 2 * n];
            operator.add_force(0.0, &u, PointSubset::All, &mut force);
            for c in 0..2 {
                let total: f64 = force[c * n..(c + 1) * n].iter().sum();
                let scale: f64 = force[c * n..(c + 1) * n].iter().map(|f| f.abs()).sum();
                assert!(total.abs() < 1e-10 * scale);
            }
            operator.energy(0.0, &u)
        };
        // In plane stress with ν = 1/3: W = E/(1 − ν) strain² per volume.
        let exact = YOUNG / (2.0 / 3.0) * 1e-12 * width * height * 0.01;
        let error = |correction| (energy(correction) / exact - 1.0).abs();
        assert!(
            error(correction) < 0.35 * error(SurfaceCorrection::None),
            "{correction:?}"
        );
    }
}

/// On neighbour lists and on stencils.
#[test]
fn stress_and_strain_of_a_uniform_state_are_exact() {
    for form in [BondForm::List, BondForm::Grid] {
        uniform_state(form);
    }
}

fn uniform_state(form: BondForm) {
    use pericles::observe::{Field, Snapshot, StartEnergy};
    let cloud = boxed([0.0; 3], &[0.16, 0.12], DX, 0.01);
    let mut steel = steel(Fracture::Unbreakable);
    steel.modulus.calibration = pericles::material::Calibration::Lattice;
    let constants = steel.constants(&cloud, StressState::PlaneStress).unwrap();
    let body = BondBody::new(&cloud, &steel, &constants);
    let operator = body.operator(form).unwrap().operator;
    let system = System::new(cloud.clone(), operator, PointScalar::Uniform(1.0)).unwrap();
    let n = cloud.len();
    let mut state = State::at_rest(2 * n);
    // Stretched equally along both axes and rotated slightly.
    let (stretch, turn) = (1e-6, 3e-7);
    for i in 0..n {
        let [x, y, _] = cloud.point(i);
        state.u[i] = stretch * x - turn * y;
        state.u[n + i] = stretch * y + turn * x;
    }
    let snapshot = Snapshot::new(&system, &state, StartEnergy::default(), 0.0);
    let (stress, strain) = (snapshot.field(Field::Stress), snapshot.field(Field::Strain));
    snapshot.check(Field::Stress).unwrap();
    // Strain everywhere, stress where no bond is missing: E/(1 − ν) strain.
    let exact = YOUNG / (2.0 / 3.0) * stretch;
    for i in 0..n {
        for (c, expected) in [stretch, stretch, 0.0].into_iter().enumerate() {
            assert!((strain[c * n + i] - expected).abs() < 1e-9 * stretch);
        }
        let [x, y, _] = cloud.point(i);
        if (0.04..0.12).contains(&x) && (0.04..0.08).contains(&y) {
            for (c, expected) in [exact, exact, 0.0].into_iter().enumerate() {
                assert!((stress[c * n + i] - expected).abs() < 1e-5 * exact, "{c}");
            }
        }
    }
}

/// A bar in tension whose softer right third breaks.
fn torn_bar() -> System {
    let cloud = bar();
    let brittle = steel(Fracture::CriticalStretch(1e-3));
    let soft = BondMaterial {
        modulus: Modulus {
            value: ElasticModulus::Young(0.5 * YOUNG),
            ..brittle.modulus
        },
        ..brittle.clone()
    };
    let of_point = (0..cloud.len())
        .map(|i| u8::from(cloud.point(i)[0] > 0.66))
        .collect();
    let both = [constants(&brittle, &cloud), constants(&soft, &cloud)];
    let classes = MaterialPairs::new(of_point, &both, InterfaceRule::Harmonic).unwrap();
    let force = operator(&cloud, &brittle, Some(&classes), SurfaceCorrection::None);
    held(&cloud, force, &Pull::Move(2e-3))
}

#[test]
fn stop_conditions_end_static_and_dynamic_runs() {
    const STEPS: u64 = 24;
    let all = (0..bar().len() as u32).collect();
    let conditions = [
        StopCondition::ReactionBelow {
            share: 0.02,
            motions: vec![1],
        },
        StopCondition::DamageAbove {
            damage: 0.4,
            points: all,
        },
    ];
    for condition in conditions {
        let system = torn_bar();
        let scheme = Relaxation::new(fine(), &system).unwrap();
        let state = State::at_rest(system.points());
        let dt = 1.0 / STEPS as f64;
        let mut run = Simulation::new(system, Box::new(scheme), state, dt, STEPS).unwrap();
        run.stop_when(StopWhen::new("right".into(), condition.clone()))
            .unwrap();
        let mut states = 0;
        let ended = run.run(|_| {
            states += 1;
            Control::Continue
        });
        assert_eq!(ended.unwrap(), Outcome::Finished);
        let reason = run.stop_reason().expect("a stop condition is met");
        assert_eq!((reason.step, reason.t), (run.state().step, run.state().t));
        assert!(run.state().step < STEPS && run.state().step == states + 1);
        // The bar has just broken, in no earlier load step.
        assert!(run.system().operator().broken_bonds() > 0, "{reason}");
        match (&condition, reason.found.clone()) {
            (StopCondition::ReactionBelow { .. }, Found::Reaction { now, peak, .. }) => {
                assert!(now < 0.02 * peak, "{reason}");
                // At most the strength of the soft part; bonds of the fixed layer are stretched more than the mean
                // and break earlier.
                let strength = 1e-3 * 0.5 * YOUNG * AREA;
                assert!(peak > 0.5 * strength && peak < strength, "{peak}");
            }
            (StopCondition::DamageAbove { .. }, Found::Damage { damage, .. }) => {
                assert!(damage > 0.4, "{reason}");
            }
            other => panic!("{other:?}"),
        }
    }
    // Loaded within a few wave transits.
    let system = torn_bar();
    let n = system.points();
    let dt = 1e-6;
    let mut state = State::at_rest(n);
    for i in 0..n {
        state.v[i] = 20.0 * system.cloud().point(i)[0].max(0.0);
    }
    let mut run = Simulation::new(system, Box::new(VelocityVerlet), state, dt, 2000).unwrap();
    run.stop_when(StopWhen::new(
        "all".into(),
        StopCondition::DamageAbove {
            damage: 0.3,
            points: (0..n as u32).collect(),
        },
    ))
    .unwrap();
    assert_eq!(run.run(|_| Control::Continue).unwrap(), Outcome::Finished);
    assert!(run.stop_reason().is_some() && run.state().step < 2000);
}

#[test]
fn failure_under_a_load_is_reported_as_no_static_state() {
    // A dead load beyond the strength: once the bar is broken nothing constrains its end.
    let cloud = bar();
    let brittle = steel(Fracture::CriticalStretch(0.5 * FORCE / (YOUNG * AREA)));
    let force = operator(&cloud, &brittle, None, SurfaceCorrection::None);
    let system = held(&cloud, force, &Pull::Force);
    let options = RelaxationOptions {
        iterations: 2000,
        ..fine()
    };
    let error = relaxed(system, options, 4).err().expect("no static state");
    let message = error.to_string();
    for part in [
        "no static state was found for the load step that follows step",
        "bonds broke in this load step",
        "has probably lost its load-bearing capacity",
        "reaction_below or damage_above",
    ] {
        assert!(message.contains(part), "{message}");
    }
    assert!(!message.contains("m/s"), "{message}");
}
