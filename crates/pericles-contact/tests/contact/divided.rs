//! Bodies divided among processes: states, energies and checkpoints are bitwise identical to those of a single process.

use std::sync::Arc;

use pericles::division::part_of;
use pericles::domain::{Comm, Threads};
use pericles::prelude::*;
use pericles::space::Shape as Outline;
use pericles::{Archive, Checkpointed, Simulation};
use pericles_contact::{
    ClosedMesh, ContactBodies, ContactLaw, Friction, Impactor, ImpactorMotion, Inertia, Pose, Shape,
};

use crate::setup::{ELASTIC, steady};

/// Horizon of three cells.
const REACH: f64 = 3.5;

/// The part of a process: oblique stripes, so that no part is a range of numbers or a box.
fn part(whole: &Arc<PointCloud>, comm: Arc<dyn Comm>) -> Arc<PointCloud> {
    let size = comm.size() as f64;
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
    for (before, after) in [(2, 3), (3, 4), (4, 2), (1, 3), (3, 1)] {
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

/// A block hit by a rigid body, with dampers and friction, whose bonds break at a stretch of 0.02.
fn hit(cloud: Arc<PointCloud>, (shape, pose): (Shape, Pose), motion: ImpactorMotion) -> Simulation {
    let material =
        BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0).with_critical_stretch(0.02);
    let mut system = Body::new(cloud.clone(), material).build().unwrap();
    let law = ContactLaw {
        damping: 0.1,
        friction: Some(Friction {
            coefficient: 0.3,
            speed: 0.01,
        }),
        ..ELASTIC
    };
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
fn all_processes_refuse_an_impactor_that_contains_points() {
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
