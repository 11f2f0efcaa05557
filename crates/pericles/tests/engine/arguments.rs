//! Incompatible arguments return errors that name them, without panics from indices or lengths.

use std::sync::Arc;

use pericles::boundary::{AxisMotion, LoadDensity, MotionKind};
use pericles::family::BondList;
use pericles::material::{BondStretch, MaterialPairs};
use pericles::observe::Probe;
use pericles::operator::{BondForce, Breaking, DamageMeasure, GridForce};
use pericles::prelude::*;
use pericles::time::{RungeKutta, Tableau, highest_frequency, highest_frequency_on};
use pericles::{PointScalar, StopCondition, StopWhen};

fn cloud(cells: usize) -> Arc<PointCloud> {
    Arc::new(Grid::bar(cells as f64, 1.0, 1.0).points().unwrap())
}

fn material() -> BondMaterial {
    BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 3.0)
}

fn bonds(cloud: &Arc<PointCloud>) -> BondList {
    BondList::new(cloud, 3.0, VolumeCorrection::Extended).unwrap()
}

fn system() -> System {
    Body::new(cloud(10), material()).build().unwrap()
}

fn rejected<T>(result: Result<T, PericlesError>, says: &str) {
    let message = result.err().expect(says).to_string();
    assert!(message.contains(says), "{message} does not contain {says}");
}

#[test]
fn forces_of_another_body_are_errors() {
    let (ten, nine) = (cloud(10), cloud(9));
    let constants = material().constants(&ten, StressState::Uniaxial).unwrap();
    let new = |cloud: &Arc<PointCloud>, no_fail: &[u32]| {
        let (cloud, measure) = (cloud.clone(), DamageMeasure::default());
        BondForce::<BondStretch, 1>::new(
            cloud,
            bonds(&nine),
            &material(),
            &constants,
            no_fail,
            measure,
        )
    };
    rejected(
        new(&ten, &[]),
        "the families of the neighbour list: 9 entries",
    );
    rejected(
        new(&nine, &[9]),
        "point 9 does not exist; the points of the body are 0 to 8",
    );
    let never = Breaking {
        critical_stretch: f64::INFINITY,
        no_fail: &[],
    };
    let plane = BondForce::<BondStretch, 2>::with_stiffness(
        nine.clone(),
        bonds(&nine),
        &|_| 1.0,
        never,
        DamageMeasure::default(),
    );
    rejected(plane, "needs a body of dimension 2");
    let grid = GridForce::<BondStretch, 1>::new(
        ten.clone(),
        &material(),
        &constants,
        &[],
        &[10],
        DamageMeasure::default(),
    );
    rejected(grid, "point 10 does not exist");
    let force = Box::new(new(&nine, &[]).unwrap());
    let foreign = System::new(ten.clone(), force, PointScalar::Uniform(1.0));
    rejected(foreign, "the force acts on 9 points");
    let force = Box::new(new(&nine, &[]).unwrap());
    let densities = PointScalar::PerPoint(vec![1.0; 8]);
    rejected(
        System::new(nine, force, densities),
        "8 entries are given, 9 are needed",
    );
    rejected(
        BondList::new(&ten, f64::NAN, VolumeCorrection::None),
        "the horizon",
    );
    rejected(
        BondList::with_horizons(&ten, vec![3.0; 9], VolumeCorrection::None),
        "the horizons of the points: 9 entries",
    );
    rejected(
        material().constants_on(&[1.0, 1.0], 1.0, StressState::Uniaxial),
        "the sides of the cells: 2 entries",
    );
    let classes = MaterialPairs::new(vec![0; 10], &[constants], InterfaceRule::Harmonic);
    rejected(
        classes.unwrap().set_critical_stretch([0, 1], 0.1),
        "the material number of an interface",
    );
}

#[test]
fn errors_of_bodies_name_the_wrong_argument() {
    let body = || Body::new(cloud(10), material());
    rejected(body().no_fail(vec![10]).build(), "point 10 does not exist");
    rejected(
        body().material(vec![11], material()).build(),
        "point 11 does not exist",
    );
    let wide = BondMaterial::new(ElasticModulus::Young(1.0), 1.0, 4.0);
    rejected(
        body().material(vec![1], wide).build(),
        "must equal those of the first material",
    );
    rejected(
        body().stress_state(StressState::Spatial).build(),
        "dimension",
    );
    let plate = Grid::plate([10.0, 10.0], 1.0, 1.0).points().unwrap();
    rejected(
        Body::new(plate, material()).build(),
        "give PlaneStress or PlaneStrain",
    );
    rejected(Region::layer("top", 1.0), "`top` is not a face");
    // An axis beyond the dimension of space has no layer.
    let face = Face {
        axis: 3,
        upper: true,
    };
    assert!(
        cloud(10)
            .select(&Region::Layer { face, depth: 1.0 })
            .is_empty()
    );
    let beam = Grid {
        shape: Shape::Cylinder {
            base: [0.0; 3],
            axis: 3,
            radius: 1.0,
            height: 1.0,
        },
        spacing: 0.1,
        section: 1.0,
        holes: vec![],
    };
    rejected(beam.points(), "the axis of the cylinder is 3");
}

#[test]
fn loads_and_motions_that_do_not_match_the_body_are_errors() {
    let constant = || TimeFunction::Constant;
    let load = |points: Vec<u32>, density: LoadDensity| {
        system().add_load(Load::new(points, density, constant()))
    };
    let unit = LoadDensity::Uniform([1.0, 0.0, 0.0]);
    rejected(
        load(vec![10], unit.clone()),
        "the points of a load: point 10",
    );
    rejected(load(vec![2, 1], unit.clone()), "must be in ascending order");
    rejected(load(vec![1, 1], unit), "each at most once");
    let amplitudes = LoadDensity::PerPoint(vec![1.0]);
    rejected(
        load(vec![1, 2], amplitudes),
        "the amplitudes of a load: 1 entries",
    );
    let traction = |points, area| Load::traction(&cloud(10), points, [1.0; 3], area, constant());
    rejected(traction(vec![], 1.0), "no points are given");
    rejected(traction(vec![1], 0.0), "the area of a traction");

    let fixed = |points| system().add_motion(PrescribedMotion::fixed(points, 1));
    rejected(
        fixed(vec![12]),
        "the points of a prescribed motion: point 12",
    );
    let across = PrescribedMotion::displacement(vec![1], [None, Some(0.0), None], constant());
    rejected(system().add_motion(across), "a motion along this axis");
    let mut changed = PrescribedMotion::fixed(vec![1], 1);
    changed.points.push(2);
    rejected(system().add_motion(changed), "after it was made");
    let along = |u: &[f64], axis: AxisMotion| {
        let along = [Some(axis), None, None];
        let points = vec![1, 2];
        PrescribedMotion::along(
            "pull".into(),
            points,
            MotionKind::Velocity,
            along,
            constant(),
            u,
            10,
        )
    };
    rejected(
        along(&[0.0; 9], AxisMotion::Uniform(1.0)),
        "9 entries are given, 10 are needed",
    );
    let short = along(&[0.0; 10], AxisMotion::PerPoint(vec![1.0])).unwrap();
    rejected(
        system().add_motion(short),
        "1 entries are given, 2 are needed",
    );
}

#[test]
fn states_and_steps_that_do_not_match_the_system_are_errors() {
    let new = |entries, dt| {
        let state = State::at_rest(entries);
        Simulation::new(system(), Box::new(VelocityVerlet), state, dt, 5)
    };
    rejected(new(9, 0.1), "the displacement of the state: 9 entries");
    rejected(new(10, f64::NAN), "the time step");
    let mut state = State::at_rest(10);
    state.v.pop();
    let run = Simulation::new(system(), Box::new(VelocityVerlet), state.clone(), 0.1, 5);
    rejected(run, "the velocity of the state: 9 entries");
    let other = Body::new(cloud(9), material()).build().unwrap();
    let scheme = RungeKutta::new(&Tableau::rk4(), &other);
    let run = Simulation::new(system(), Box::new(scheme), State::at_rest(10), 0.1, 5);
    rejected(run, "made for another system: 9 entries");
    let tableau = |nodes: &[f64], stages: Vec<Vec<f64>>, weights: &[f64]| {
        Tableau::new("own", 2, nodes.to_vec(), stages, weights.to_vec())
    };
    rejected(
        tableau(&[], vec![], &[]),
        "the weights of a Runge–Kutta method: 0 entries",
    );
    let rows = || vec![vec![], vec![0.5]];
    rejected(
        tableau(&[0.0, 0.5], rows(), &[1.0]),
        "1 entries are given, 2 are needed",
    );
    rejected(
        tableau(&[0.0, 1.0], rows(), &[0.0, 1.0]),
        "minus the sum of its row",
    );
    rejected(
        tableau(&[0.0, 0.5], rows(), &[0.5, 1.0]),
        "the sum of the weights",
    );
    assert!(tableau(&[0.0, 0.5], rows(), &[0.0, 1.0]).is_ok());
    let build = || Simulation::builder(system());
    rejected(build().state(state), "the velocity of the state");
    rejected(build().velocity_of(&vec![10], [1.0; 3]), "point 10");
    rejected(build().build(), "give end (s) or steps");
    rejected(build().end(-1.0).build(), "the end of the simulation");
    rejected(
        build().safety(0.0).steps(1).build(),
        "the fraction of the stable step",
    );
    rejected(
        highest_frequency(&system(), &[0.0; 9]),
        "the displacement: 9 entries",
    );
    rejected(
        highest_frequency_on(&system(), &[0.0; 10], &[10]),
        "the free points: point 10",
    );
    let mut run = new(10, 0.1).unwrap();
    let reaction = StopCondition::ReactionBelow {
        share: 0.5,
        motions: vec![0],
    };
    rejected(
        run.stop_when(StopWhen::new("left".into(), reaction)),
        "stop condition is 0",
    );
    let tracked = TrackedCrack {
        crack: Crack::Section { x: 5.0 },
        points: vec![10],
    };
    rejected(
        CrackTracker::new(&cloud(10), vec![tracked], 0.3).map(|_| ()),
        "point 10",
    );
    let probe = |points| Probe {
        name: "end".into(),
        points,
    };
    rejected(probe(vec![]).read(&run.snapshot()), "no points are given");
    rejected(
        probe(vec![10]).read(&run.snapshot()),
        "the points of a probe: point 10",
    );
}
