//! Bodies divided among processes: states, energies and checkpoints are bitwise identical to those of a single process.

use std::sync::Arc;

use pericles::division::part_of;
use pericles::domain::{Comm, Threads};
use pericles::operator::BondForm;
use pericles::prelude::*;
use pericles::space::Shape as Outline;
use pericles::time::{
    InnerSolver, Newmark, NewmarkOptions, Relaxation, RelaxationOptions, RungeKutta, Tableau,
};
use pericles::{Archive, Checkpointed, Simulation};
use pericles_contact::{
    ClosedMesh, ContactBodies, ContactLaw, ContactPairs, Friction, Impactor, ImpactorMotion,
    Inertia, PointContact, Pose, Shape,
};

use crate::setup::{ELASTIC, colliding, disc_points, steady};

/// Horizon of three cells.
const REACH: f64 = 3.5;

/// The part of a process: oblique stripes, so that no part is a range of numbers or a box. The last of five processes has no
/// points.
fn part(whole: &Arc<PointCloud>, comm: Arc<dyn Comm>) -> Arc<PointCloud> {
    let size = comm.size().min(4) as f64;
    let along = |k: usize| {
        let [x, y, z] = whole.point(k);
        x + 0.4 * y + 0.2 * z
    };
    let all = || (0..whole.len()).map(along);
    let (low, high) = (
        all().fold(f64::INFINITY, f64::min),
        all().fold(f64::NEG_INFINITY, f64::max),
    );
    let owner = |x: f64| ((x - low) / (high - low) * size).min(size - 1.0) as u32;
    let owners: Vec<u32> = all().map(owner).collect();
    Arc::new(part_of(whole, &owners, REACH, comm).unwrap())
}

/// Runs until a step; returns the checkpoint and the energies, which all processes must have.
fn proceed(run: &mut Simulation, end: u64) -> (Archive, [u64; 7]) {
    run.run(|run| match run.state().step {
        step if step == end => Control::Stop,
        _ => Control::Continue,
    })
    .unwrap();
    let mut archive = Archive::default();
    run.save(&mut archive);
    let energies = run.snapshot().energies();
    let numbers = [
        energies.kinetic,
        energies.elastic,
        energies.contact,
        energies.contact_dissipated,
        energies.bodies,
        energies.dissipated,
        energies.work,
    ];
    (archive, numbers.map(f64::to_bits))
}

/// Runs a body on one process and on several, and continues at the step `pause` on other numbers of processes. Returns the run
/// on one process.
fn check(
    whole: &Arc<PointCloud>,
    make: impl Fn(Arc<PointCloud>) -> Simulation + Sync,
    pause: u64,
) -> Simulation {
    let mut alone = make(whole.clone());
    let [paused, end] = [pause, alone.steps()].map(|step| proceed(&mut alone, step));
    for (before, after) in [(2, 3), (3, 4), (4, 2), (1, 5), (5, 1)] {
        let divided = Threads::run(before, |comm| {
            let mut run = make(part(whole, comm));
            let (archive, energies) = proceed(&mut run, pause);
            assert_eq!(energies, paused.1, "{before} processes");
            let paused = archive.gathered(run.system().domain()).unwrap();
            let steps = run.steps();
            let (archive, energies) = proceed(&mut run, steps);
            assert_eq!(energies, end.1, "{before} processes");
            [paused, archive.gathered(run.system().domain()).unwrap()]
        });
        let [gathered, ended] = divided[0].each_ref().map(|one| one.as_ref().unwrap());
        assert_eq!(gathered.differences(&paused.0), [""; 0], "{before}");
        assert_eq!(ended.differences(&end.0), [""; 0], "{before} processes");
        let ends = Threads::run(after, |comm| {
            let first = comm.rank() == 0;
            let mut run = make(part(whole, comm));
            let domain = run.system().domain().clone();
            let mut own = Archive::default();
            run.save(&mut own);
            let own = Archive::scattered(&own, first.then_some(gathered), &domain);
            run.restore(&own.unwrap()).unwrap();
            let steps = run.steps();
            let (archive, energies) = proceed(&mut run, steps);
            assert_eq!(energies, end.1, "{before}, then {after} processes");
            archive.gathered(&domain).unwrap()
        });
        let resumed = ends[0].as_ref().unwrap();
        let case = format!("{before}, then {after} processes");
        assert_eq!(resumed.differences(&end.0), [""; 0], "{case}");
    }
    alone
}

/// A block of cells with its centre of the upper face at the origin.
fn block(sides: [f64; 3]) -> Arc<PointCloud> {
    let [x, y, z] = sides;
    let grid = Grid {
        shape: Outline::Box {
            origin: [-0.5 * x, -0.5 * y, -z],
            size: sides.to_vec(),
        },
        spacing: 1.0,
        section: 1.0,
        holes: Vec::new(),
    };
    Arc::new(grid.points().unwrap())
}

fn rough() -> ContactLaw {
    ContactLaw {
        damping: 0.1,
        friction: Some(Friction {
            coefficient: 0.3,
            speed: 0.01,
        }),
        ..ELASTIC
    }
}

/// A block hit by a rigid body, with dampers and friction, whose bonds break at a stretch of 0.02.
fn hit(cloud: Arc<PointCloud>, (shape, pose): (Shape, Pose), motion: ImpactorMotion) -> Simulation {
    let material =
        BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0).with_critical_stretch(0.02);
    let mut system = Body::new(cloud.clone(), material).build().unwrap();
    let law = rough();
    let bodies = ContactBodies::uniform(cloud.len(), 1.0, 3.0, 1.0);
    let impactor = Impactor::new("one", shape, pose, motion, cloud, law, bodies);
    system.add_interaction(Box::new(impactor.unwrap())).unwrap();
    let state = State::of(&system);
    Simulation::new(system, Box::new(VelocityVerlet), state, 0.4, 50).unwrap()
}

/// A pyramid with its tip at the origin and its base above.
fn pyramid(height: f64) -> ClosedMesh {
    let corner = |x: f64, y: f64| [x * height, y * height, height];
    let vertices = vec![
        [0.0; 3],
        corner(1.0, 0.9),
        corner(-1.1, 1.0),
        corner(-0.9, -1.0),
        corner(1.0, -1.1),
    ];
    let triangles = [
        [0, 2, 1],
        [0, 3, 2],
        [0, 4, 3],
        [0, 1, 4],
        [1, 2, 3],
        [1, 3, 4],
    ];
    ClosedMesh::new(vertices, triangles.to_vec()).unwrap()
}

fn reading(run: &Simulation) -> pericles_contact::Reading {
    let mut interactions = run.system().interactions();
    let impactor: &Impactor = interactions.find_map(|one| one.downcast_ref()).unwrap();
    impactor.reading()
}

#[test]
fn a_free_ball_that_breaks_a_divided_block_moves_as_on_one_process() {
    let whole = block([9.0, 8.0, 5.0]);
    let make = |cloud: Arc<PointCloud>| {
        let motion = ImpactorMotion::Free {
            inertia: Inertia::Mass {
                mass: 40.0,
                inertia: None,
            },
            velocity: [0.05, 0.02, -0.2],
            spin: [0.02, 0.0, 0.03],
        };
        let shape = Shape::Ball { radius: 3.0 };
        hit(cloud, (shape, Pose::at([0.3, -0.2, 3.02])), motion)
    };
    let run = check(&whole, make, 17);
    let end = reading(&run);
    assert!(end.impulse[2] < -1.0 && end.spin[0] != 0.02, "{end:?}");
    assert!(end.dissipated > 0.0, "{end:?}");
    assert!(run.system().operator().broken_bonds() > 0);
}

#[test]
fn a_mesh_pressed_into_a_divided_block_does_the_work_of_one_process() {
    let whole = block([9.0, 8.0, 5.0]);
    let make = |cloud: Arc<PointCloud>| {
        let place = (Shape::Mesh(pyramid(4.0)), Pose::at([0.2, 0.1, 0.1]));
        hit(cloud, place, steady([0.01, 0.0, -0.05]))
    };
    let run = check(&whole, make, 23);
    let end = reading(&run);
    assert!(end.points > 3 && end.work > 0.0, "{end:?}");
    assert!(run.system().operator().broken_bonds() > 0);
}

#[test]
fn all_processes_reject_an_impactor_that_contains_points() {
    let whole = block([9.0, 8.0, 5.0]);
    let reasons = Threads::run(3, |comm| {
        let cloud = part(&whole, comm);
        let bodies = ContactBodies::uniform(cloud.len(), 1.0, 3.0, 1.0);
        let (shape, pose) = (Shape::Ball { radius: 2.0 }, Pose::at([3.0, 0.0, -1.0]));
        let found = Impactor::new("one", shape, pose, steady([0.0; 3]), cloud, ELASTIC, bodies);
        found.err().unwrap().to_string()
    });
    assert!(reasons[0].contains("contains point"), "{}", reasons[0]);
    assert!(reasons.iter().all(|one| *one == reasons[0]), "{reasons:?}");
}

/// Contact between points at the end of a run: pairs that touched and energy dissipated.
fn report(run: &Simulation) -> (u64, f64) {
    let mut interactions = run.system().interactions();
    let contact: &PointContact = interactions.find_map(|one| one.downcast_ref()).unwrap();
    (contact.report().pairs, run.system().contact_dissipated())
}

#[test]
fn divided_discs_that_collide_and_break_move_as_on_one_process() {
    let whole = disc_points(6.0);
    for pairs in [ContactPairs::Unbonded, ContactPairs::Pieces] {
        let make = |cloud: Arc<PointCloud>| {
            let law = ContactLaw { pairs, ..rough() };
            let (system, state) = colliding(cloud, 6.0, 0.2, 0.02, law, 0.3);
            Simulation::new(system, Box::new(VelocityVerlet), state, 0.4, 120).unwrap()
        };
        let run = check(&whole, make, 50);
        let (touching, dissipated) = report(&run);
        assert!(touching > 3 && dissipated > 0.0, "{touching} {dissipated}");
        assert!(run.system().operator().broken_bonds() > 50);
    }
}

/// A plate with a crack whose parts approach each other, or that is torn apart and falls together.
fn plate(cloud: Arc<PointCloud>, form: BondForm) -> (System, State) {
    let material =
        BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0).with_critical_stretch(0.02);
    let mut system = Body::new(cloud.clone(), material)
        .stress_state(StressState::PlaneStress)
        .form(form)
        .crack(Crack::Segment {
            from: [-12.0, -6.0],
            to: [2.0, -5.0],
        })
        .build()
        .unwrap();
    let bodies = ContactBodies::uniform(cloud.len(), 1.0, 3.0, 1.0);
    let contact = PointContact::new(cloud.clone(), rough(), bodies).unwrap();
    system.add_interaction(Box::new(contact)).unwrap();
    let mut state = State::of(&system);
    let n = cloud.len();
    for i in 0..n {
        let [x, y, _] = cloud.point(i);
        state.v[i] = 0.03 * (0.5 * y).sin() + if x > 4.0 { -0.06 } else { 0.0 };
        state.v[n + i] = -0.05 * ((y + 5.5) / 3.0).tanh() + 0.05 * (0.7 * x).cos();
    }
    (system, state)
}

#[test]
fn a_divided_plate_that_breaks_touches_itself_as_on_one_process() {
    let grid = Grid {
        shape: Outline::Box {
            origin: [-12.0, -12.0, 0.0],
            size: vec![22.0, 12.0],
        },
        spacing: 1.0,
        section: 1.0,
        holes: Vec::new(),
    };
    let whole = Arc::new(grid.points().unwrap());
    for form in [BondForm::List, BondForm::Grid] {
        let make = |cloud: Arc<PointCloud>| {
            let (system, state) = plate(cloud, form);
            Simulation::new(system, Box::new(VelocityVerlet), state, 0.4, 120).unwrap()
        };
        let run = check(&whole, make, 50);
        let (touching, dissipated) = report(&run);
        let broken = run.system().operator().broken_bonds();
        let case = format!("{form:?}: {touching} pairs, {dissipated} J, {broken} bonds");
        assert!(touching > 3 && dissipated > 0.0 && broken > 50, "{case}");
    }
}

#[test]
fn stages_tangents_and_static_states_of_divided_contact_are_those_of_one_process() {
    let whole = disc_points(5.0);
    let unbreakable = |cloud| colliding(cloud, 5.0, 0.2, f64::INFINITY, ELASTIC, 0.3);
    let stages = |cloud: Arc<PointCloud>| {
        let (system, state) = unbreakable(cloud);
        let scheme = RungeKutta::new(&Tableau::rk4(), &system);
        Simulation::new(system, Box::new(scheme), state, 0.4, 40).unwrap()
    };
    assert!(report(&check(&whole, stages, 20)).0 < 1000);
    let implicit = |cloud: Arc<PointCloud>| {
        let (system, state) = unbreakable(cloud);
        let options = NewmarkOptions {
            solver: InnerSolver::NewtonKrylov,
            ..NewmarkOptions::default()
        };
        let scheme = Newmark::new(options, &system).unwrap();
        Simulation::new(system, Box::new(scheme), state, 0.6, 25).unwrap()
    };
    check(&whole, implicit, 12);
    // The second disc is pressed against the first one, which is fixed.
    let pressed = |cloud: Arc<PointCloud>| {
        let far = |above: bool| -> Vec<u32> {
            let x = |i: &u32| cloud.point(*i as usize)[0];
            (0..cloud.len() as u32)
                .filter(|i| if above { x(i) > 12.0 } else { x(i) < -1.0 })
                .collect()
        };
        let (mut system, _) = colliding(cloud.clone(), 5.0, 0.0, f64::INFINITY, ELASTIC, 0.3);
        for (above, shift) in [(false, 0.0), (true, -2.0)] {
            let along = [Some(shift), Some(0.0), None];
            let motion = PrescribedMotion::displacement(far(above), along, TimeFunction::Constant);
            system.add_motion(motion).unwrap();
        }
        let scheme = Relaxation::new(RelaxationOptions::default(), &system).unwrap();
        let state = State::of(&system);
        Simulation::new(system, Box::new(scheme), state, 1.0, 2).unwrap()
    };
    let run = check(&whole, pressed, 1);
    assert!(run.snapshot().energies().contact > 0.0);
}
