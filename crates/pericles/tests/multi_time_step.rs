//! Runge–Kutta with one and with two time steps, r-RESPA: orders against independent numbers, limits of stability, equality with the plain
//! schemes, breaking, counts, accounts, restart, threads.

use std::f64::consts::PI;
use std::sync::Arc;

use pericles::boundary::{Load, MotionKind, PrescribedMotion, TimeFunction};
use pericles::family::{BondList, Crack, EndRule, VolumeCorrection};
use pericles::kernel::Influence;
use pericles::material::{
    BondMaterial, BondStretch, Calibration, ElasticModulus, Fracture, LinearBond, Modulus,
    PairForce, PairLaw, StressState,
};
use pericles::operator::{BondForce, Breaking, DamageMeasure, ForceOperator};
use pericles::space::{Grid, PointCloud, PointSet, Shape};
use pericles::time::{
    AdaptiveRungeKutta, Fine, Follow, Integrator, Interpolant, MultiTimeStep, MultiTimeStepOptions,
    Predictor, Respa, RungeKutta, State, Tableau, VelocityVerlet, highest_frequency,
    highest_frequency_on,
};
use pericles::{Archive, Control, PericlesError, PointScalar, Saved, Simulation, System};

fn grid(origin: [f64; 3], size: &[f64], spacing: f64, section: f64) -> Arc<PointCloud> {
    let grid = Grid {
        shape: Shape::Box {
            origin,
            size: size.to_vec(),
        },
        spacing,
        section,
        holes: vec![],
    };
    Arc::new(grid.points().unwrap())
}

struct Body {
    density: f64,
    young: f64,
    horizon: f64,
    state: StressState,
    fracture: Fracture,
}

fn force<L: PairForce, const D: usize>(
    cloud: &Arc<PointCloud>,
    body: &Body,
    no_fail: &[u32],
) -> BondForce<L, D> {
    let material = BondMaterial {
        law: PairLaw::BondStretch,
        density: body.density,
        modulus: Modulus {
            value: ElasticModulus::Young(body.young),
            calibration: Calibration::Continuum,
        },
        horizon: body.horizon,
        influence: Influence::default(),
        volume_correction: VolumeCorrection::None,
        fracture: body.fracture,
    };
    let constants = material.constants(cloud, body.state).unwrap();
    let bonds = BondList::new(cloud, body.horizon, VolumeCorrection::None).unwrap();
    BondForce::new(
        cloud.clone(),
        bonds,
        &material,
        &constants,
        no_fail,
        DamageMeasure::default(),
    )
}

fn system(cloud: &Arc<PointCloud>, operator: impl ForceOperator + 'static, density: f64) -> System {
    let density = PointScalar::Uniform(density);
    System::new(cloud.clone(), Box::new(operator), density).unwrap()
}

fn points(cloud: &PointCloud, inside: impl Fn(f64, f64, f64) -> bool) -> PointSet {
    (0..cloud.len() as u32)
        .filter(|&i| {
            let [x, y, z] = cloud.point(i as usize);
            inside(x, y, z)
        })
        .collect()
}

/// A problem: the body, its state at the start, the fine points, the end.
type Problem = (System, State, PointSet, f64);

/// A linear plate in plane stress, pulled along x from rest; a box of fine points.
fn plate() -> Problem {
    plate_with::<LinearBond>(1.0)
}

fn plate_with<L: PairForce>(load: f64) -> Problem {
    let spacing = 0.02;
    let cloud = grid([0.0; 3], &[1.0, 0.5], spacing, spacing);
    let body = Body {
        density: 7850.0,
        young: 200e9,
        horizon: 3.015 * spacing,
        state: StressState::PlaneStress,
        fracture: Fracture::Unbreakable,
    };
    let mut system = system(&cloud, force::<L, 2>(&cloud, &body, &[]), 7850.0);
    for (points, sign) in [
        (points(&cloud, |x, _, _| x < spacing), -1.0),
        (points(&cloud, |x, _, _| x > 1.0 - spacing), 1.0),
    ] {
        let density = [sign * load * 200e6 / spacing, 0.0, 0.0];
        system.add_load(Load::new(points, density, TimeFunction::Constant));
    }
    let fine = points(&cloud, |x, y, _| {
        (x - 0.5).abs() < 0.15 && (y - 0.25).abs() < 0.1
    });
    let state = State::at_rest(2 * cloud.len());
    (system, state, fine, 1.2e-4)
}

/// The nonlinear plate with twenty times the load, a moving bump, and ragged fine points.
fn nonlinear_plate() -> Problem {
    let (system, mut state, _, end) = plate_with::<BondStretch>(20.0);
    let cloud = system.cloud().clone();
    let n = cloud.len();
    for i in 0..n {
        let [x, y, _] = cloud.point(i);
        let bump = (-((x - 0.37).powi(2) + (y - 0.21).powi(2)) / 0.12f64.powi(2)).exp();
        state.u[i] = 2e-3 * bump;
        state.u[n + i] = -1e-3 * bump;
        state.v[n + i] = 5.0 * bump;
    }
    let fine = points(&cloud, |x, y, _| {
        let (dx, dy) = (x - 0.42, y - 0.23);
        let angle = dy.atan2(dx);
        dx.hypot(dy) < 0.13 + 0.04 * (5.0 * angle).sin() || x > 0.85
    });
    (system, state, fine, end)
}

/// A linear block, held at one end, bent by a force at the other.
fn block() -> Problem {
    let spacing = 0.02;
    let cloud = grid([0.0; 3], &[0.5, 0.1, 0.1], spacing, 1.0);
    let body = Body {
        density: 7850.0,
        young: 200e9,
        horizon: 3.015 * spacing,
        state: StressState::Spatial,
        fracture: Fracture::Unbreakable,
    };
    let mut system = system(&cloud, force::<LinearBond, 3>(&cloud, &body, &[]), 7850.0);
    let loaded = points(&cloud, |x, _, _| x > 0.5 - spacing);
    let volume = loaded.len() as f64 * spacing.powi(3);
    system.add_load(Load::new(
        loaded,
        [0.0, 0.0, -5000.0 / volume],
        TimeFunction::Constant,
    ));
    let state = State::at_rest(3 * cloud.len());
    let held = PrescribedMotion::new(
        "held".into(),
        points(&cloud, |x, _, _| x < 3.0 * spacing),
        MotionKind::Velocity,
        [Some(0.0); 3],
        TimeFunction::Constant,
        &state.u,
        cloud.len(),
    );
    system.add_motion(held).unwrap();
    let fine = points(&cloud, |x, _, _| x < 0.2);
    (system, state, fine, 1.2e-4)
}

fn tableau(order: u32) -> Tableau {
    match order {
        3 => Tableau::rk3(0.75).unwrap(),
        _ => Tableau::rk4(),
    }
}

fn options(ratio: u32, fine: &PointSet) -> MultiTimeStepOptions {
    let regions = if fine.is_empty() {
        vec![]
    } else {
        vec![fine.clone()]
    };
    MultiTimeStepOptions {
        ratio,
        fine: Fine::Fixed(regions),
        predictor: Predictor::Structured,
        interpolant: Interpolant::Hermite,
    }
}

fn two_steps(system: &System, order: u32, options: MultiTimeStepOptions) -> Box<dyn Integrator> {
    Box::new(MultiTimeStep::new(&tableau(order), options, system).unwrap())
}

/// Makes the scheme for a body and its fine points.
type Scheme<'a> = dyn Fn(&System, &PointSet) -> Box<dyn Integrator> + Sync + 'a;

/// The end state of a problem with `steps` steps.
fn run(
    (system, state, fine, end): Problem,
    steps: u64,
    scheme: impl Fn(&System, &PointSet) -> Box<dyn Integrator>,
) -> Simulation {
    let integrator = scheme(&system, &fine);
    let mut simulation = Simulation::new(system, integrator, state, end / steps as f64, steps);
    simulation.run(|_| Control::Continue).unwrap();
    simulation
}

fn uniform(order: u32) -> impl Fn(&System, &PointSet) -> Box<dyn Integrator> {
    move |system, _| Box::new(RungeKutta::new(&tableau(order), system))
}

fn mixed(order: u32, ratio: u32) -> impl Fn(&System, &PointSet) -> Box<dyn Integrator> {
    move |system, fine| two_steps(system, order, options(ratio, fine))
}

/// max |u_x − reference| over the points.
fn error_x(simulation: &Simulation, reference: &[f64]) -> f64 {
    let n = simulation.system().points();
    (0..n)
        .map(|i| (simulation.state().u[i] - reference[i]).abs())
        .fold(0.0, f64::max)
}

fn reference(problem: Problem) -> Vec<f64> {
    run(problem, 2048, uniform(4)).state().u.clone()
}

/// Errors at T/32, T/64, T/128, T/256 from level `first` on must be those found by another code, and the last pair must show the order.
fn check_errors(
    problem: fn() -> Problem,
    reference: &[f64],
    scheme: &Scheme<'_>,
    expected: [f64; 4],
    first: usize,
    tolerance: f64,
    order: std::ops::Range<f64>,
) {
    let errors: Vec<f64> = [32, 64, 128, 256]
        .into_iter()
        .skip(first)
        .map(|steps| error_x(&run(problem(), steps, scheme), reference))
        .collect();
    println!("errors {errors:?}");
    for (found, expected) in errors.iter().zip(&expected[first..]) {
        assert!(
            (found / expected - 1.0).abs() < tolerance,
            "{errors:?}, expected {expected:?}"
        );
    }
    let last = errors.len() - 1;
    let observed = (errors[last - 1] / errors[last]).log2();
    assert!(order.contains(&observed), "order {observed} of {errors:?}");
}

const PLATE_RK3: [f64; 4] = [2.36e-6, 3.714e-7, 4.700e-8, 5.780e-9];
const PLATE_RK4: [f64; 4] = [4.135e-7, 3.49e-8, 2.31e-9, 1.467e-10];

#[test]
fn orders_of_the_plain_schemes_on_a_plate() {
    let exact = reference(plate());
    let u = exact.iter().fold(0.0, |max: f64, u| max.max(u.abs()));
    assert!((u / 6.759e-4 - 1.0).abs() < 1e-3, "{u}");
    let rk3 = [2.509e-6, 3.720e-7, 4.708e-8, 5.791e-9];
    let rk4 = [4.247e-7, 3.544e-8, 2.329e-9, 1.471e-10];
    check_errors(plate, &exact, &uniform(3), rk3, 2, 0.03, 2.95..3.10);
    check_errors(plate, &exact, &uniform(4), rk4, 2, 0.03, 3.90..4.05);
}

#[test]
fn orders_with_two_steps_on_a_plate() {
    let exact = reference(plate());
    let (scheme3, scheme4) = (mixed(3, 4), mixed(4, 4));
    check_errors(plate, &exact, &scheme3, PLATE_RK3, 2, 0.03, 2.95..3.10);
    check_errors(plate, &exact, &scheme4, PLATE_RK4, 2, 0.03, 3.90..4.05);
}

#[test]
#[ignore = "long: every ratio, predictor and interpolant, all levels"]
fn orders_with_every_choice_on_a_plate() {
    let exact = reference(plate());
    for predictor in [Predictor::Structured, Predictor::BackwardDifference] {
        for interpolant in [Interpolant::Hermite, Interpolant::Stages] {
            for ratio in [1, 2, 4, 8] {
                for (order, expected, range) in
                    [(3, PLATE_RK3, 2.95..3.10), (4, PLATE_RK4, 3.90..4.05)]
                {
                    println!("{predictor:?} {interpolant:?} M = {ratio}, order {order}");
                    let scheme = |system: &System, fine: &PointSet| {
                        let options = MultiTimeStepOptions {
                            predictor,
                            interpolant,
                            ..options(ratio, fine)
                        };
                        two_steps(system, order, options)
                    };
                    // The paper's predictor and interpolant were seen within 2.5 % of ours on the last three levels.
                    let (first, tolerance) = match ratio {
                        1 => (1, 0.10),
                        _ => (1, 0.05),
                    };
                    check_errors(plate, &exact, &scheme, expected, first, tolerance, range);
                }
            }
        }
    }
}

#[test]
fn orders_on_a_nonlinear_plate_with_ragged_fine_points() {
    let exact = reference(nonlinear_plate());
    let rk3 = [5.215e-5, 7.801e-6, 9.523e-7, 1.178e-7];
    let rk4 = [1.026e-5, 7.848e-7, 4.989e-8, 3.103e-9];
    let (scheme3, scheme4) = (mixed(3, 4), mixed(4, 4));
    check_errors(nonlinear_plate, &exact, &scheme3, rk3, 2, 0.03, 2.95..3.10);
    check_errors(nonlinear_plate, &exact, &scheme4, rk4, 2, 0.03, 3.90..4.05);
}

#[test]
fn orders_on_a_block() {
    // The largest error sits at the loaded end, where the methods come to their order late: the independent code found 2.94 and 4.05.
    let exact = reference(block());
    let rk3 = [4.248e-9, 7.326e-10, 1.016e-10, 1.320e-11];
    let rk4 = [7.858e-10, 4.312e-11, 2.592e-12, 1.56e-13];
    let (scheme3, scheme4) = (mixed(3, 4), mixed(4, 4));
    check_errors(block, &exact, &scheme3, rk3, 2, 0.03, 2.90..3.10);
    check_errors(block, &exact, &scheme4, rk4, 2, 0.03, 3.90..4.10);
}

/// The bits of everything a run is made of, but for what belongs to the scheme.
fn bits(simulation: &Simulation) -> (Vec<u64>, Vec<u64>, u64, u64) {
    let State { u, v, .. } = simulation.state();
    let bits = |x: &[f64]| x.iter().map(|x| x.to_bits()).collect();
    let operator = simulation.system().operator();
    (
        bits(u),
        bits(v),
        operator.broken_bonds(),
        operator.dissipated().to_bits(),
    )
}

/// A pre-cracked plate pulled apart, whose steps are binary fractions of a second: times add up without rounding. Fine is a strip about the crack.
fn cracking_plate() -> Problem {
    crack::<BondStretch>(40, 20.0, 0.006, 2f64.powi(-17))
}

/// A plate 0.05 m wide with a central crack and three rows above and below that move apart with ± speed.
fn crack<L: PairForce>(cells: usize, speed: f64, critical_stretch: f64, end: f64) -> Problem {
    let spacing = 0.05 / cells as f64;
    let height = 0.05 + 6.0 * spacing;
    let cloud = grid(
        [-0.025, -0.5 * height, 0.0],
        &[0.05, height],
        spacing,
        spacing,
    );
    let body = Body {
        density: 8000.0,
        young: 192e9,
        horizon: 3.015 * spacing,
        state: StressState::PlaneStress,
        fracture: Fracture::CriticalStretch(critical_stretch),
    };
    let material = BondMaterial {
        law: PairLaw::BondStretch,
        density: body.density,
        modulus: Modulus {
            value: ElasticModulus::Young(body.young),
            calibration: Calibration::Continuum,
        },
        horizon: body.horizon,
        influence: Influence::default(),
        volume_correction: VolumeCorrection::None,
        fracture: body.fracture,
    };
    let constants = material.constants(&cloud, body.state).unwrap();
    let mut bonds = BondList::new(&cloud, body.horizon, VolumeCorrection::None).unwrap();
    let cut = Crack::Segment {
        from: [-0.005, 0.0],
        to: [0.005, 0.0],
    };
    bonds.cut(&cloud, &cut, EndRule::Closed).unwrap();
    let rows = [
        points(&cloud, |_, y, _| y < -0.025),
        points(&cloud, |_, y, _| y > 0.025),
    ];
    let operator = BondForce::<L, 2>::new(
        cloud.clone(),
        bonds,
        &material,
        &constants,
        &rows.concat(),
        DamageMeasure::default(),
    );
    let mut system = system(&cloud, operator, body.density);
    let state = State::at_rest(2 * cloud.len());
    for (points, sign) in rows.into_iter().zip([-1.0, 1.0]) {
        let motion = PrescribedMotion::new(
            format!("{sign}"),
            points,
            MotionKind::Velocity,
            [None, Some(sign * speed), None],
            TimeFunction::Constant,
            &state.u,
            cloud.len(),
        );
        system.add_motion(motion).unwrap();
    }
    let fine = points(&cloud, |_, y, _| y.abs() < 0.005);
    (system, state, fine, end)
}

#[test]
fn without_fine_points_or_with_nothing_else_the_plain_scheme_is_left() {
    // Bit for bit, breaking included.
    let nothing = |problem: Problem| (problem.0, problem.1, vec![], problem.3);
    let everything = |problem: Problem| {
        let all = (0..problem.0.points() as u32).collect();
        (problem.0, problem.1, all, problem.3)
    };
    let verlet = |_: &System, _: &PointSet| -> Box<dyn Integrator> { Box::new(VelocityVerlet) };
    let respa = |system: &System, fine: &PointSet| -> Box<dyn Integrator> {
        let fine = options(4, fine).fine;
        Box::new(Respa::new(4, fine, system).unwrap())
    };
    for order in [2, 3, 4] {
        let (plain, two): (&Scheme<'_>, &Scheme<'_>) = match order {
            2 => (&verlet, &respa),
            3 => (&uniform(3), &mixed(3, 4)),
            _ => (&uniform(4), &mixed(4, 4)),
        };
        let coarse = run(cracking_plate(), 64, plain);
        let fine = run(cracking_plate(), 256, plain);
        assert!(coarse.system().operator().broken_bonds() > 20);
        assert!(bits(&coarse) != bits(&fine));
        let none = run(nothing(cracking_plate()), 64, two);
        let all = run(everything(cracking_plate()), 64, two);
        // The dissipated energy of a bond involves the mean velocity of Verlet's step, which r-RESPA rounds otherwise.
        let compare = |a: &Simulation, b: &Simulation| {
            let (a, b) = (bits(a), bits(b));
            assert!((&a.0, &a.1, a.2) == (&b.0, &b.1, b.2), "order {order}");
            let (a, b) = (f64::from_bits(a.3), f64::from_bits(b.3));
            assert!((a / b - 1.0).abs() < 1e-12);
        };
        compare(&coarse, &none);
        compare(&fine, &all);
    }
}

#[test]
fn equal_steps_on_both_sides_differ_from_the_plain_scheme_by_its_order() {
    for order in [3, 4] {
        let difference = |steps| {
            let plain = run(nonlinear_plate(), steps, uniform(order));
            let zoned = run(nonlinear_plate(), steps, mixed(order, 1));
            error_x(&zoned, &plain.state().u)
        };
        let (coarse, fine) = (difference(64), difference(128));
        let observed = (coarse / fine).log2();
        assert!(
            observed > f64::from(order) - 0.15 && observed < f64::from(order) + 1.2,
            "order {order}: {observed} from {coarse} {fine}"
        );
    }
}

/// A clamped plate of 15 × 6 points whose points in the middle are fine; those a horizon within are stiffer by `stiffness`.
fn small_plate(stiffness: f64, core: f64) -> Problem {
    let spacing = 0.01;
    let cloud = grid([0.0; 3], &[0.15, 0.06], spacing, 1.0);
    let horizon = 2.015 * spacing;
    let bonds = BondList::new(&cloud, horizon, VolumeCorrection::None).unwrap();
    let stiff: Vec<bool> = (0..cloud.len())
        .map(|i| (cloud.point(i)[0] - 0.075).abs() < core)
        .collect();
    let breaking = Breaking {
        critical_stretch: f64::INFINITY,
        no_fail: &[],
    };
    let micromodulus = 9.0 * 2e11 / (PI * horizon.powi(3));
    let factor = |i: usize| if stiff[i] { stiffness } else { 1.0 };
    let pair = |i: usize, j: usize, _: [f64; 3]| 0.5 * micromodulus * (factor(i) + factor(j));
    let operator = BondForce::<LinearBond, 2>::with_pair_stiffness(
        cloud.clone(),
        bonds,
        pair,
        breaking,
        DamageMeasure::default(),
    );
    let mut system = system(&cloud, operator, 8000.0);
    let mut state = State::at_rest(2 * cloud.len());
    let held = PrescribedMotion::new(
        "clamp".into(),
        points(&cloud, |x, _, _| !(0.02..0.13).contains(&x)),
        MotionKind::Displacement,
        [Some(0.0), Some(0.0), None],
        TimeFunction::Constant,
        &state.u,
        cloud.len(),
    );
    system.add_motion(held).unwrap();
    for (k, v) in state.v.iter_mut().enumerate() {
        *v = ((k * k) as f64).sin();
    }
    let fine = points(&cloud, |x, _, _| (x - 0.075).abs() < 0.035);
    (system, state, fine, 1.0)
}

/// The growth per step of the largest velocity between two step numbers, for ω dt of the coarse points.
fn growth(problem: Problem, omega_dt: f64, steps: [u64; 2], scheme: &Scheme<'_>) -> f64 {
    let (mut system, mut state, fine, _) = problem;
    let coarse: PointSet = (0..system.points() as u32)
        .filter(|i| fine.binary_search(i).is_err())
        .collect();
    let all: PointSet = (0..system.points() as u32).collect();
    // Points without fine neighbours tell the coarse material's own frequency.
    let omega = highest_frequency_on(&system, &state.u, &coarse).unwrap();
    let whole = highest_frequency_on(&system, &state.u, &all).unwrap();
    assert!(omega.converged && omega.estimate <= whole.estimate * 1.001);
    let mut scheme = scheme(&system, &fine);
    let limiting = scheme.limiting_frequency(&system, &state.u).unwrap();
    let dt = omega_dt / limiting.estimate;
    scheme.start(&mut system, &mut state);
    let mut sizes = [0.0; 2];
    for step in 1..=steps[1] {
        scheme
            .step(&mut system, &mut state, step as f64 * dt)
            .unwrap();
        for k in 0..2 {
            // The largest of a few steps, so that the phase does not matter.
            if step <= steps[k] && step + 50 > steps[k] {
                sizes[k] = state.v.iter().fold(sizes[k], |m: f64, v| m.max(v.abs()));
            }
        }
        if sizes[0] > 1e100 {
            return f64::INFINITY;
        }
    }
    (sizes[1] / sizes[0]).ln() / (steps[1] - steps[0]) as f64
}

#[test]
fn stability_reaches_the_full_limit_of_the_method() {
    for (stiffness, core) in [(1.0, 0.0), (16.0, 0.012)] {
        for (order, limit) in [(3, 3f64.sqrt()), (4, 8f64.sqrt())] {
            for interpolant in [Interpolant::Hermite, Interpolant::Stages] {
                let scheme = |system: &System, fine: &PointSet| {
                    let options = MultiTimeStepOptions {
                        interpolant,
                        ..options(4, fine)
                    };
                    two_steps(system, order, options)
                };
                let below = growth(
                    small_plate(stiffness, core),
                    0.99 * limit,
                    [1000, 4000],
                    &scheme,
                );
                let above = growth(
                    small_plate(stiffness, core),
                    1.02 * limit,
                    [500, 1500],
                    &scheme,
                );
                println!(
                    "stiffness {stiffness}, order {order}, {interpolant:?}: {below:e} {above:e}"
                );
                assert!(below < 1e-9, "order {order}: {below} per step");
                assert!(above > 1e-3, "order {order}: {above} per step");
            }
        }
    }
}

#[test]
fn the_papers_predictor_is_weakly_unstable_and_ours_is_not() {
    let rate = |predictor, omega_dt| {
        let scheme = move |system: &System, fine: &PointSet| {
            let options = MultiTimeStepOptions {
                predictor,
                ..options(4, fine)
            };
            two_steps(system, 4, options)
        };
        growth(small_plate(1.0, 0.0), omega_dt, [10_000, 20_000], &scheme)
    };
    // The rate depends on the plate and on where it is fine; another code found 3.3e-4 and 1.5e-3 on one like it.
    for (omega_dt, expected) in [(1.5, 3.3e-4), (2.0, 1.5e-3)] {
        let found = rate(Predictor::BackwardDifference, omega_dt);
        assert!(found > 0.1 * expected && found < 10.0 * expected, "{found}");
        assert!(rate(Predictor::Structured, omega_dt) < 1e-9);
    }
}

/// A free nonlinear plate of 800 points with a random start.
fn free_plate() -> Problem {
    let spacing = 0.01;
    let cloud = grid([0.0; 3], &[0.4, 0.2], spacing, spacing);
    let body = Body {
        density: 7850.0,
        young: 200e9,
        horizon: 3.015 * spacing,
        state: StressState::PlaneStress,
        fracture: Fracture::Unbreakable,
    };
    let system = system(&cloud, force::<BondStretch, 2>(&cloud, &body, &[]), 7850.0);
    let mut state = State::at_rest(2 * cloud.len());
    let n = cloud.len();
    for i in 0..n {
        let [x, y, _] = cloud.point(i);
        state.v[i] = 10.0 * (PI * x / 0.4).cos();
        state.v[n + i] = 10.0 * (PI * y / 0.2).cos() + 5.0;
    }
    let fine = points(&cloud, |x, y, _| {
        (x - 0.2).abs() < 0.1 && (y - 0.1).abs() < 0.04
    });
    (system, state, fine, 0.0)
}

fn respa(ratio: u32) -> impl Fn(&System, &PointSet) -> Box<dyn Integrator> {
    move |system, fine| {
        Box::new(Respa::new(ratio, Fine::Fixed(vec![fine.clone()]), system).unwrap())
    }
}

/// The problem with as many steps of the given ω dt.
fn steps_of(problem: Problem, omega_dt: f64, steps: u64) -> Problem {
    let (system, state, fine, _) = problem;
    let omega = highest_frequency(&system, &state.u).unwrap().estimate;
    (system, state, fine, steps as f64 * omega_dt / omega)
}

fn respa_keeps_energy_and_momentum(steps: u64) {
    for omega_dt in [0.5, 1.0] {
        let (system, state, fine, end) = steps_of(free_plate(), omega_dt, steps);
        let integrator = respa(4)(&system, &fine);
        let momentum = system.momentum(&state.v);
        let mut simulation = Simulation::new(system, integrator, state, end / steps as f64, steps);
        let initial = simulation.start_energy().energy;
        let mut worst = [0.0f64; 2];
        simulation
            .run(|simulation| {
                let late = usize::from(simulation.state().step > steps / 2);
                if simulation.state().step.is_multiple_of(steps / 500) {
                    let energies = simulation.snapshot().energies();
                    let error = (energies.balance() / initial).abs();
                    worst[late] = worst[late].max(error);
                }
                Control::Continue
            })
            .unwrap();
        println!("ω dt = {omega_dt}: {worst:?}");
        // Bounded: the second half is as good as the first.
        assert!(worst[0] < 0.03 * omega_dt * omega_dt && worst[1] < 1.5 * worst[0]);
        let system = simulation.system();
        let after = system.momentum(&simulation.state().v);
        let scale: f64 = {
            let n = system.points();
            let mass = 7850.0 * system.cloud().volumes()[0];
            let v = &simulation.state().v;
            (0..2 * n).map(|k| mass * v[k].abs()).sum()
        };
        for c in 0..2 {
            let error = (after[c] - momentum[c]).abs() / scale;
            assert!(error < 1e-11, "{error}");
        }
    }
}

#[test]
fn respa_keeps_energy_within_bounds_and_momentum_to_round_off() {
    respa_keeps_energy_and_momentum(4_000);
}

#[test]
#[ignore = "long: 1e5 steps"]
fn respa_keeps_energy_within_bounds_over_many_steps() {
    respa_keeps_energy_and_momentum(100_000);
}

#[test]
fn respa_is_of_second_order() {
    let exact = reference(nonlinear_plate());
    let errors: Vec<f64> = [128, 256, 512]
        .into_iter()
        .map(|steps| error_x(&run(nonlinear_plate(), steps, respa(4)), &exact))
        .collect();
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).log2();
        assert!((1.93..2.05).contains(&order), "{order} of {errors:?}");
    }
}

#[test]
fn evaluations_equal_the_model() {
    for ratio in [1, 3, 4] {
        for order in [3u64, 4] {
            let (system, state, fine, end) = plate();
            let (n, f) = (system.points() as u64, fine.len() as u64);
            let integrator = two_steps(&system, order as u32, options(ratio, &fine));
            let mut simulation = Simulation::new(system, integrator, state, end / 256.0, 10);
            simulation.run(|_| Control::Continue).unwrap();
            let report = simulation.integrator().refinement().unwrap();
            let m = u64::from(ratio);
            // One evaluation at the start; steps that are fine everywhere feed the predictor.
            assert_eq!(report.starting_steps, order - 3);
            let starting = report.starting_steps * order * m * n;
            let expected = n + starting + report.steps * order * (n - f + m * f);
            assert_eq!(simulation.system().evaluated_points(), expected);
            let speed_up = (order * m * n) as f64 / (order * (n - f + m * f)) as f64;
            assert!((report.speed_up() / speed_up - 1.0).abs() < 1e-12);
        }
        let (system, state, fine, end) = plate();
        let integrator = respa(ratio)(&system, &fine);
        let mut simulation = Simulation::new(system, integrator, state, end / 256.0, 10);
        let at_start = simulation.system().evaluated_points();
        simulation.run(|_| Control::Continue).unwrap();
        let report = simulation.integrator().refinement().unwrap();
        let (n, f, m) = (report.points, report.fine_points, u64::from(ratio));
        let per_step = n - f + m * (f + report.border_points);
        let counted = simulation.system().evaluated_points() - at_start;
        assert_eq!(counted, 10 * per_step);
    }
}

/// Crack run: broken bonds, tip, displacement.
struct Cracked {
    broken: u64,
    tip: f64,
    u: Vec<f64>,
    fraction: f64,
}

fn cracked(cells: usize, speed: f64, end: f64, steps: u64, scheme: &Scheme<'_>) -> Cracked {
    let simulation = run(
        crack::<BondStretch>(cells, speed, 0.006, end),
        steps,
        scheme,
    );
    let system = simulation.system();
    let cloud = system.cloud();
    let mut damage = vec![0.0; cloud.len()];
    system.operator().damage_into(&mut damage);
    let tip = (0..cloud.len())
        .filter(|&i| damage[i] > 0.3)
        .map(|i| cloud.point(i)[0])
        .fold(0.0, f64::max);
    Cracked {
        broken: system.operator().broken_bonds(),
        tip,
        u: simulation.state().u.clone(),
        fraction: simulation
            .integrator()
            .refinement()
            .map_or(0.0, |report| report.mean_fraction),
    }
}

fn adaptive(order: u32, ratio: u32) -> impl Fn(&System, &PointSet) -> Box<dyn Integrator> {
    move |system, _| {
        let options = MultiTimeStepOptions {
            fine: Fine::Adaptive(Follow::default()),
            ..options(ratio, &vec![])
        };
        two_steps(system, order, options)
    }
}

fn relative(a: &[f64], b: &[f64]) -> f64 {
    let square = |x: &mut dyn Iterator<Item = f64>| -> f64 { x.map(|x| x * x).sum() };
    let difference = square(&mut a.iter().zip(b).map(|(a, b)| a - b));
    (difference / square(&mut b.iter().copied())).sqrt()
}

#[test]
fn a_small_crack_agrees_with_the_fine_step_everywhere() {
    let (cells, speed, end, steps) = (40, 10.0, 1.2e-5, 64);
    let horizon = 3.015 * 0.05 / cells as f64;
    let fine = cracked(cells, speed, end, 4 * steps, &uniform(4));
    assert!(fine.broken > 50, "{}", fine.broken);
    let with = |scheme: &Scheme<'_>| {
        let found = cracked(cells, speed, end, steps, scheme);
        println!(
            "broken {} {}, tip {} {}, relative {}, fine {}",
            found.broken,
            fine.broken,
            found.tip,
            fine.tip,
            relative(&found.u, &fine.u),
            found.fraction
        );
        let broken = found.broken as f64 / fine.broken as f64;
        assert!((broken - 1.0).abs() < 0.1);
        assert!((found.tip - fine.tip).abs() < 2.0 * horizon);
        found
    };
    let strip = with(&mixed(4, 4));
    let following = with(&adaptive(4, 4));
    with(&respa(4));
    assert!(following.fraction < strip.fraction && following.fraction > 0.0);
}

#[test]
#[ignore = "long: 80 × 86 points, several fine steps"]
fn the_crack_agrees_with_the_fine_step_everywhere() {
    let horizon = 3.015 * 0.05 / 80.0;
    // Before failure spreads the same bonds break.
    for (end, most, distance) in [(7e-6, 0, 5e-4), (9e-6, 6, 3e-3)] {
        for ratio in [2, 4] {
            let steps = (128.0 * end / 1.5e-5_f64).round() as u64;
            let fine = cracked(80, 5.0, end, u64::from(ratio) * steps, &uniform(4));
            let found = cracked(80, 5.0, end, steps, &mixed(4, ratio));
            let l2 = relative(&found.u, &fine.u);
            println!(
                "{end:e}, M = {ratio}: {} {}, {l2:e}",
                found.broken, fine.broken
            );
            assert!(found.broken.abs_diff(fine.broken) <= most && l2 < distance);
        }
    }
    for ratio in [2, 4, 8] {
        let fine = cracked(80, 5.0, 1.5e-5, u64::from(ratio) * 128, &uniform(4));
        for scheme in [&mixed(4, ratio) as &Scheme<'_>, &adaptive(4, ratio)] {
            let found = cracked(80, 5.0, 1.5e-5, 128, scheme);
            println!(
                "M = {ratio}: {} {}, tip {} {}, fine {}",
                found.broken, fine.broken, found.tip, fine.tip, found.fraction
            );
            let broken = found.broken as f64 / fine.broken as f64;
            assert!((broken - 1.0).abs() < 0.1);
            assert!((found.tip - fine.tip).abs() < 2.0 * horizon);
        }
    }
}

#[test]
fn smooth_pull_of_a_cracked_plate_is_of_fourth_order() {
    // Without failure, against the numbers of another code: relative L2 error 2.19e-4, 1.41e-5 with M = 4.
    let pull = || crack::<BondStretch>(50, 5.0, f64::MAX, 6e-6);
    let exact = run(pull(), 1120, uniform(4)).state().u.clone();
    for (steps, expected) in [(35, 2.19e-4), (70, 1.41e-5)] {
        let found = relative(&run(pull(), steps, mixed(4, 4)).state().u, &exact);
        println!("{steps}: {found:e}");
        assert!((found / expected - 1.0).abs() < 0.05, "{found} {expected}");
    }
}

#[test]
fn stop_and_resume_equals_the_uninterrupted_run() {
    let following_respa = |system: &System, _: &PointSet| -> Box<dyn Integrator> {
        Box::new(Respa::new(3, Fine::Adaptive(Follow::default()), system).unwrap())
    };
    let pair = |system: &System, _: &PointSet| -> Box<dyn Integrator> {
        Box::new(AdaptiveRungeKutta::new(1e-6, system).unwrap())
    };
    let backward = |system: &System, fine: &PointSet| {
        let options = MultiTimeStepOptions {
            predictor: Predictor::BackwardDifference,
            interpolant: Interpolant::Stages,
            ..options(3, fine)
        };
        two_steps(system, 4, options)
    };
    let schemes: [&Scheme<'_>; 7] = [
        &uniform(3),
        &mixed(3, 3),
        &adaptive(4, 3),
        &backward,
        &respa(3),
        &following_respa,
        &pair,
    ];
    let everything = |simulation: &Simulation| {
        let mut archive = Archive::default();
        simulation.save(&mut archive);
        archive
    };
    for scheme in schemes {
        let start = || {
            let (system, state, fine, end) = cracking_plate();
            let integrator = scheme(&system, &fine);
            Simulation::new(system, integrator, state, end / 64.0, 64)
        };
        let mut whole = start();
        whole.run(|_| Control::Continue).unwrap();
        assert!(whole.system().operator().broken_bonds() > 20);
        for stop in [1, 2, 41] {
            let mut first = start();
            first
                .run(|s| {
                    if s.state().step == stop {
                        Control::Stop
                    } else {
                        Control::Continue
                    }
                })
                .unwrap();
            let mut second = start();
            second.restore(&everything(&first)).unwrap();
            second.run(|_| Control::Continue).unwrap();
            let name = whole.integrator().name();
            assert!(
                everything(&whole) == everything(&second),
                "{name} at {stop}"
            );
        }
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let following_respa = |system: &System, _: &PointSet| -> Box<dyn Integrator> {
        Box::new(Respa::new(3, Fine::Adaptive(Follow::default()), system).unwrap())
    };
    let pair = |system: &System, _: &PointSet| -> Box<dyn Integrator> {
        Box::new(AdaptiveRungeKutta::new(1e-6, system).unwrap())
    };
    let schemes: [&Scheme<'_>; 4] = [&mixed(3, 3), &adaptive(4, 3), &following_respa, &pair];
    for scheme in schemes {
        let on = |threads| {
            rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap()
                .install(|| {
                    let simulation = run(crack::<BondStretch>(60, 20.0, 0.006, 7e-6), 48, scheme);
                    let mut archive = Archive::default();
                    simulation.save(&mut archive);
                    archive
                })
        };
        let one = on(1);
        for threads in [2, 3] {
            assert!(on(threads) == one, "{threads} threads");
        }
    }
}

/// A bar that a smooth pulse pushes at one end, by a load or by prescribed motion.
fn pushed_bar(kind: Option<MotionKind>) -> Problem {
    let cloud = grid([0.0; 3], &[0.5], 0.005, 1e-4);
    let body = Body {
        density: 7850.0,
        young: 210e9,
        horizon: 0.015,
        state: StressState::Uniaxial,
        fracture: Fracture::Unbreakable,
    };
    let mut system = system(&cloud, force::<BondStretch, 1>(&cloud, &body, &[]), 7850.0);
    let state = State::at_rest(cloud.len());
    let function = TimeFunction::Pulse {
        start: -1e-6,
        duration: 8e-5,
    };
    let end = points(&cloud, |x, _, _| x < 0.015);
    match kind {
        None => system.add_load(Load::new(end, [1e10, 0.0, 0.0], function)),
        Some(kind) => {
            let amplitude = match kind {
                MotionKind::Displacement => 1e-3,
                MotionKind::Velocity => 30.0,
            };
            let motion = PrescribedMotion::new(
                "end".into(),
                end,
                kind,
                [Some(amplitude), None, None],
                function,
                &state.u,
                cloud.len(),
            );
            system.add_motion(motion).unwrap();
        }
    }
    let fine = points(&cloud, |x, _, _| x < 0.1);
    (system, state, fine, 6e-5)
}

#[test]
fn loads_and_prescribed_motion_keep_the_order() {
    for kind in [
        None,
        Some(MotionKind::Displacement),
        Some(MotionKind::Velocity),
    ] {
        let exact = reference(pushed_bar(kind));
        for order in [3, 4] {
            let errors = [64, 128].map(|steps| {
                let plain = run(pushed_bar(kind), steps, uniform(order));
                let zoned = run(pushed_bar(kind), steps, mixed(order, 4));
                for simulation in [&plain, &zoned] {
                    let state = simulation.state();
                    if let [motion] = simulation.system().motions() {
                        let g = &motion.function;
                        let amplitude = motion.amplitude(0).unwrap();
                        let (u, v) = match motion.kind {
                            MotionKind::Displacement => (g.value(state.t), g.derivative(state.t)),
                            MotionKind::Velocity => (g.integral(state.t), g.value(state.t)),
                        };
                        assert_eq!(state.u[0], amplitude * u);
                        assert_eq!(state.v[0], amplitude * v);
                    }
                }
                [error_x(&plain, &exact), error_x(&zoned, &exact)]
            });
            for k in 0..2 {
                let observed = (errors[0][k] / errors[1][k]).log2();
                println!("{kind:?} {order} {k}: {observed} {errors:?}");
                assert!(observed > f64::from(order) - 0.2, "{kind:?}: {observed}");
            }
        }
    }
}

#[test]
fn accounts_close_to_the_order_of_the_scheme() {
    // Work of a load is booked to fourth order, so that the balance is what the scheme itself loses.
    let balance = |steps| {
        let simulation = run(pushed_bar(None), steps, mixed(4, 4));
        let energies = simulation.snapshot().energies();
        (energies.balance() / energies.work).abs()
    };
    let (coarse, fine) = (balance(64), balance(128));
    assert!(
        coarse < 1e-4 && (coarse / fine).log2() > 3.5,
        "{coarse} {fine}"
    );
    // Momentum of the body is the impulse of the load, but for what the interface loses.
    let simulation = run(pushed_bar(None), 128, mixed(4, 4));
    let momentum = simulation.system().momentum(&simulation.state().v)[0];
    let impulse = simulation.system().ledger().impulse[0];
    let error = (momentum / impulse - 1.0).abs();
    assert!(error < 1e-4, "{error}");
    let simulation = run(pushed_bar(None), 128, uniform(4));
    let momentum = simulation.system().momentum(&simulation.state().v)[0];
    let impulse = simulation.system().ledger().impulse[0];
    // Simpson's rule and the method use the same nodes.
    assert!((momentum / impulse - 1.0).abs() < 1e-12);
}

#[test]
fn energy_is_accounted_for_while_bonds_break() {
    let pair = |system: &System, _: &PointSet| -> Box<dyn Integrator> {
        Box::new(AdaptiveRungeKutta::new(1e-5, system).unwrap())
    };
    let schemes: [&Scheme<'_>; 5] = [&uniform(4), &mixed(4, 4), &adaptive(4, 4), &respa(4), &pair];
    for scheme in schemes {
        let simulation = run(crack::<BondStretch>(40, 10.0, 0.006, 1.2e-5), 256, scheme);
        let energies = simulation.snapshot().energies();
        let name = simulation.integrator().name();
        println!("{name}: {energies:?} {:e}", energies.balance());
        assert!(energies.dissipated > 0.0);
        assert!(
            energies.balance().abs() < 0.02 * energies.dissipated,
            "{name}: {energies:?}"
        );
    }
}

#[test]
fn the_adaptive_pair_meets_its_tolerance() {
    let exact = {
        let (system, state, fine, _) = nonlinear_plate();
        run((system, state, fine, 1.2e-4), 2048, uniform(4))
            .state()
            .u
            .clone()
    };
    let size = exact.iter().fold(0.0, |max: f64, u| max.max(u.abs()));
    let mut last = (f64::INFINITY, 0);
    for tolerance in [1e-4, 1e-6, 1e-8] {
        let pair = |system: &System, _: &PointSet| -> Box<dyn Integrator> {
            Box::new(AdaptiveRungeKutta::new(tolerance, system).unwrap())
        };
        // Two steps of the run: the sub-steps are the scheme's own.
        let simulation = run(nonlinear_plate(), 2, pair);
        let error = error_x(&simulation, &exact) / size;
        let evaluations = simulation.system().evaluated_points();
        println!("{tolerance:e}: {error:e} with {evaluations}");
        assert!(error < 30.0 * tolerance, "{error} for {tolerance}");
        assert!(error < 0.2 * last.0 && evaluations > last.1);
        last = (error, evaluations);
    }
    assert!(AdaptiveRungeKutta::new(0.0, &plate().0).is_err());
}

#[test]
fn wrong_choices_are_refused() {
    let (system, _, fine, _) = plate();
    let refused = |ratio, fine| {
        let options = MultiTimeStepOptions {
            fine,
            ..options(ratio, &vec![])
        };
        match MultiTimeStep::new(&Tableau::rk4(), options, &system) {
            Ok(_) => panic!("refused"),
            Err(error) => error,
        }
    };
    assert!(matches!(
        refused(0, Fine::Fixed(vec![fine.clone()])),
        PericlesError::StepRatio { ratio: 0 }
    ));
    assert!(matches!(
        refused(2, Fine::Fixed(vec![fine.clone(), vec![]])),
        PericlesError::FineRegionEmpty { region: 1 }
    ));
    assert!(matches!(
        refused(2, Fine::Fixed(vec![fine.clone(), fine[7..9].to_vec()])),
        PericlesError::FineRegionsOverlap {
            first: 0,
            second: 1,
            ..
        }
    ));
    let strip = points(system.cloud(), |x, _, _| (x - 0.5).abs() < 0.021);
    assert!(matches!(
        refused(2, Fine::Fixed(vec![strip])),
        PericlesError::FineRegionThin { axis: 'x', .. }
    ));
    for follow in [
        Follow {
            threshold: 1.0,
            ..Follow::default()
        },
        Follow {
            every: 0,
            ..Follow::default()
        },
        Follow {
            layers: 0,
            ..Follow::default()
        },
    ] {
        assert!(matches!(
            refused(2, Fine::Adaptive(follow)),
            PericlesError::SchemeParameter { .. }
        ));
    }
    let pair = MultiTimeStep::new(&Tableau::dormand_prince(), options(2, &fine), &system);
    assert!(matches!(pair, Err(PericlesError::SchemeNotUsable { .. })));
    // A layer at the border of the body may be thin, and several regions are one.
    let [left, right] = [
        points(system.cloud(), |x, _, _| x < 0.03),
        points(system.cloud(), |x, _, _| (x - 0.7).abs() < 0.1),
    ];
    assert!(Respa::new(2, Fine::Fixed(vec![left, right]), &system).is_ok());
}
