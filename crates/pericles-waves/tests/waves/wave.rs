//! Nonlocal wave equation: functions of the stiffness, trigonometric and implicit schemes, spectral and Gauss-point
//! bodies.

use std::f64::consts::PI;
use std::sync::Arc;

use pericles::boundary::{Load, MotionKind, PrescribedMotion, TimeFunction};
use pericles::family::VolumeCorrection;
use pericles::kernel::{ActsOn, Influence, InfluenceFunction};
use pericles::material::{
    BondMaterial, Calibration, ElasticModulus, Fracture, Modulus, PairLaw, StressState,
};
use pericles::operator::{BondBody, Force, LinearOperator, Linearisation};
use pericles::round_trip::check_resume;
use pericles::space::{Grid, PointCloud, Shape, gauss_bar};
use pericles::time::{Implicit, ImplicitRule, Integrator, LinearSolver, State, VelocityVerlet};
use pericles::{Interrupt, PointScalar, Simulation, System};
use pericles_waves::ForceForm;
use pericles_waves::exact::{ExactSolution, LineSolution, SolutionError};
use pericles_waves::linear::{ConvolutionForce, GaussForce, SpectralForce};
use pericles_waves::{FunctionMethod, LoadRule, Trigonometric, TrigonometricOptions};

const UNIT_LINE: LineSolution = LineSolution {
    young: 1.0,
    density: 1.0,
    length: 1.0,
    width: 1.0,
    amplitude: 1.0,
    centre: 0.0,
};

/// Creates a scheme for a body.
type Make = fn(&System) -> Box<dyn Integrator>;

fn cells(origin: f64, sides: &[f64], spacing: f64) -> Arc<PointCloud> {
    let shape = Shape::Box {
        origin: [origin; 3],
        size: sides.to_vec(),
    };
    let grid = Grid {
        shape,
        spacing,
        section: 1.0,
        holes: vec![],
    };
    Arc::new(grid.points().unwrap())
}

fn material(law: PairLaw, horizon: f64, influence: Influence) -> BondMaterial {
    BondMaterial {
        law,
        density: 1.0,
        modulus: Modulus {
            value: ElasticModulus::Young(1.0),
            calibration: Calibration::Continuum,
        },
        horizon,
        influence,
        volume_correction: VolumeCorrection::Linear,
        fracture: Fracture::Unbreakable,
    }
}

/// C(ξ) = 4/√π exp(−ξ²).
fn gaussian() -> BondMaterial {
    let function = InfluenceFunction::Gaussian {
        length: 1.0,
        cutoff: None,
    };
    let influence = Influence {
        function,
        acts_on: ActsOn::Displacement,
    };
    material(PairLaw::Linear, 7.0, influence)
}

fn state_of(cloud: &PointCloud) -> StressState {
    [
        StressState::Uniaxial,
        StressState::PlaneStrain,
        StressState::Spatial,
    ][cloud.dimension() - 1]
}

fn bonds(cloud: &Arc<PointCloud>, material: &BondMaterial, form: ForceForm) -> Box<dyn Force> {
    let constants = material.constants(cloud, state_of(cloud)).unwrap();
    let body = BondBody::new(cloud, material, &constants);
    pericles_waves::assemble(&body.into(), form)
        .unwrap()
        .operator
}

fn system(cloud: &Arc<PointCloud>, operator: Box<dyn Force>) -> System {
    System::new(cloud.clone(), operator, PointScalar::Uniform(1.0)).unwrap()
}

fn spectral<const D: usize>(cloud: &Arc<PointCloud>, material: &BondMaterial) -> SpectralForce<D> {
    let constants = material.constants(cloud, state_of(cloud)).unwrap();
    SpectralForce::new(cloud.clone(), material, &constants).unwrap()
}

fn trigonometric(functions: FunctionMethod, system: &System) -> Box<dyn Integrator> {
    let options = TrigonometricOptions {
        functions,
        ..Default::default()
    };
    Box::new(Trigonometric::new(options, system).unwrap())
}

fn implicit(rule: ImplicitRule, system: &System) -> Box<dyn Integrator> {
    Box::new(Implicit::new(rule, system).unwrap())
}

/// Smooth initial state without symmetry.
fn start(system: &System, size: f64) -> State {
    let n = system.points();
    let mut state = State::at_rest(system.dimension() * n);
    for c in 0..system.dimension() {
        for i in 0..n {
            let x = system.cloud().point(i);
            let phase = x[0] + 0.7 * x[1] - 0.4 * x[2] + c as f64;
            state.u[c * n + i] = size * (-(x[0] - 0.3).powi(2) - x[1] * x[1] - x[2] * x[2]).exp();
            state.v[c * n + i] = size * (0.5 * phase).sin();
        }
    }
    state
}

fn steps(
    system: &mut System,
    scheme: &mut dyn Integrator,
    mut state: State,
    dt: f64,
    count: usize,
) -> State {
    scheme.start(system, &mut state);
    for k in 1..=count {
        scheme
            .step(system, &mut state, k as f64 * dt, Interrupt::never())
            .unwrap();
    }
    state
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
}

fn energy(system: &System, state: &State) -> f64 {
    system.kinetic_energy(&state.v) + system.operator().energy(state.t, &state.u)
}

#[test]
fn all_matrix_function_engines_agree() {
    let cloud = cells(-8.0, &[16.0], 0.1);
    // ω_max = 2 for the Gaussian.
    for tau in [0.1, 3.0, 50.0] {
        let mut ends: Vec<(FunctionMethod, State)> = Vec::new();
        for method in [
            FunctionMethod::Eigenvectors,
            FunctionMethod::Chebyshev,
            FunctionMethod::Lanczos,
        ] {
            let mut free = system(&cloud, bonds(&cloud, &gaussian(), ForceForm::List));
            let mut scheme = trigonometric(method, &free);
            let state = start(&free, 1.0);
            ends.push((method, steps(&mut free, &mut *scheme, state, tau, 1)));
        }
        let mut periodic: Vec<(FunctionMethod, State)> = Vec::new();
        for method in [
            FunctionMethod::Fourier,
            FunctionMethod::Eigenvectors,
            FunctionMethod::Chebyshev,
        ] {
            let mut body = system(&cloud, Box::new(spectral::<1>(&cloud, &gaussian())));
            let mut scheme = trigonometric(method, &body);
            let state = start(&body, 1.0);
            periodic.push((method, steps(&mut body, &mut *scheme, state, tau, 1)));
        }
        for ends in [&ends, &periodic] {
            for (method, end) in &ends[1..] {
                let error = distance(&end.u, &ends[0].1.u).max(distance(&end.v, &ends[0].1.v));
                assert!(error < 1e-12, "{method:?} τ = {tau}: {error:e}");
            }
        }
    }
}

#[test]
fn one_trigonometric_step_equals_many_small_steps() {
    let stretch = |m: f64| material(PairLaw::Linear, m, Influence::default());
    for (sides, m) in [(&[3.0, 2.0][..], 0.6), (&[1.2, 1.0, 0.8], 0.4)] {
        let cloud = cells(-0.5, sides, 0.2);
        for form in [ForceForm::Grid, ForceForm::List] {
            let mut body = system(&cloud, bonds(&cloud, &stretch(m), form));
            let state = start(&body, 0.1);
            let mut scheme = trigonometric(FunctionMethod::Fastest, &body);
            let large = steps(&mut body, &mut *scheme, state.clone(), 4.0, 1);
            let small = steps(&mut body, &mut *scheme, state.clone(), 0.05, 80);
            let error = distance(&large.u, &small.u);
            assert!(error < 3e-14, "{form:?} {error:e}");
            let constants = stretch(m).constants(&cloud, state_of(&cloud)).unwrap();
            let other = match sides.len() {
                2 => distance_by_convolution::<2>(&cloud, &stretch(m), &constants, &state, &large),
                _ => distance_by_convolution::<3>(&cloud, &stretch(m), &constants, &state, &large),
            };
            assert!(other < 1e-13, "{other:e}");
        }
    }
}

fn distance_by_convolution<const D: usize>(
    cloud: &Arc<PointCloud>,
    material: &BondMaterial,
    constants: &pericles::material::BondConstants,
    state: &State,
    end: &State,
) -> f64 {
    let force =
        ConvolutionForce::<D>::new(cloud.clone(), material, constants, &[], [false; D]).unwrap();
    let mut body = system(cloud, Box::new(force));
    let mut scheme = trigonometric(FunctionMethod::Fastest, &body);
    let other = steps(&mut body, &mut *scheme, state.clone(), 4.0, 1);
    distance(&other.u, &end.u)
}

#[test]
fn energy_of_a_linear_body_does_not_drift() {
    let cloud = cells(-6.0, &[12.0], 0.2);
    let body = || system(&cloud, bonds(&cloud, &gaussian(), ForceForm::Grid));
    let schemes: [(Make, f64); 4] = [
        (|s| trigonometric(FunctionMethod::Chebyshev, s), 0.7),
        (|s| implicit(ImplicitRule::Midpoint, s), 0.7),
        (|s| implicit(ImplicitRule::Trapezoidal, s), 0.7),
        (|_| Box::new(VelocityVerlet), 0.7),
    ];
    for (scheme, dt) in schemes {
        let mut body = body();
        let mut scheme = scheme(&body);
        let mut state = start(&body, 1.0);
        scheme.start(&mut body, &mut state);
        let kept = |body: &System, state: &State, scheme: &dyn Integrator| {
            energy(body, state) + scheme.energy_correction(body, state, dt)
        };
        let before = kept(&body, &state, &*scheme);
        let end = steps(&mut body, &mut *scheme, state, dt, 1000);
        let drift = kept(&body, &end, &*scheme) / before - 1.0;
        assert!(drift.abs() < 1e-12, "{} {drift:e}", scheme.name());
    }
}

#[test]
fn plane_wave_has_the_numerical_frequency_of_the_scheme() {
    // k = 2π/P, ω² = 4 (1 − e^{−k²/4}) on a period of 10.
    let cloud = cells(0.0, &[10.0], 0.25);
    let k = 2.0 * PI / 10.0;
    let omega = (-4.0 * (-0.25 * k * k).exp_m1()).sqrt();
    let dt = 0.9;
    let schemes: [(Make, f64); 3] = [
        (|s| trigonometric(FunctionMethod::Fastest, s), omega),
        (
            |s| implicit(ImplicitRule::Midpoint, s),
            2.0 / dt * (0.5 * dt * omega).atan(),
        ),
        (
            |_| Box::new(VelocityVerlet),
            2.0 / dt * (0.5 * dt * omega).asin(),
        ),
    ];
    for (scheme, numerical) in schemes {
        let mut body = system(&cloud, Box::new(spectral::<1>(&cloud, &gaussian())));
        let mut scheme = scheme(&body);
        let mut state = State::at_rest(cloud.len());
        for i in 0..cloud.len() {
            state.u[i] = (k * cloud.point(i)[0]).cos();
        }
        let end = steps(&mut body, &mut *scheme, state, dt, 20);
        let exact = (numerical * 20.0 * dt).cos();
        for i in 0..cloud.len() {
            let error = end.u[i] - exact * (k * cloud.point(i)[0]).cos();
            assert!(error.abs() < 1e-13, "{}: {error:e}", scheme.name());
        }
    }
}

#[test]
fn spectral_solution_equals_the_exact_line_to_round_off() {
    // Half period 4π, 128 cells, t = 3.5; every other point is a node of the window of the line.
    let half = 4.0 * PI;
    let cloud = cells(-half, &[2.0 * half], 2.0 * half / 128.0);
    let mut body = system(&cloud, Box::new(spectral::<1>(&cloud, &gaussian())));
    let x = cloud.axis(0);
    let mut state = State::at_rest(cloud.len());
    UNIT_LINE.displacement_into(0.0, x, &mut state.u);
    let mut scheme = trigonometric(FunctionMethod::Fastest, &body);
    let end = steps(&mut body, &mut *scheme, state, 3.5, 1);
    let mut exact = vec![0.0; x.len()];
    UNIT_LINE.displacement_into(3.5, x, &mut exact);
    let window = |field: &[f64]| -> Vec<f64> {
        let inside = field.iter().zip(x).filter(|(_, x)| x.abs() <= PI);
        inside.map(|(u, _)| *u).collect()
    };
    let error = SolutionError::between(&window(&end.u), &window(&exact));
    let largest = window(&exact).iter().fold(0.0f64, |m, u| m.max(u.abs()));
    assert!(error.largest / largest < 5e-14, "{error:?}");
}

#[test]
fn gauss_force_equals_the_bond_list() {
    for (horizon, influence) in [
        (0.7, Influence::default()),
        (7.0, gaussian().influence),
        (1.0, gaussian().influence),
    ] {
        let cloud = Arc::new(gauss_bar(-2.0, 5.0, 0.25, 2.0).unwrap());
        let material = material(PairLaw::Linear, horizon, influence);
        let constants = material.constants(&cloud, StressState::Uniaxial).unwrap();
        let fast = GaussForce::new(cloud.clone(), &material, &constants).unwrap();
        let list = bonds(&cloud, &material, ForceForm::List);
        let u: Vec<f64> = cloud
            .axis(0)
            .iter()
            .map(|x| (1.3 * x).sin() + 5.0)
            .collect();
        let (mut a, mut b) = (vec![0.0; u.len()], vec![0.0; u.len()]);
        fast.apply_into(&u, &mut a);
        list.add_force(0.0, &u, pericles::operator::PointSubset::All, &mut b);
        let scale = b.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        assert!(
            distance(&a, &b) < 1e-13 * scale,
            "{:e}",
            distance(&a, &b) / scale
        );
        assert_eq!(fast.directed_bonds(), list.directed_bonds());
        let (mut a, mut b) = (vec![0.0; u.len()], vec![0.0; u.len()]);
        fast.add_energy_density(0.0, &u, &mut a);
        list.add_energy_density(0.0, &u, &mut b);
        assert!(distance(&a, &b) < 1e-13 * scale);
        assert!((fast.energy(0.0, &u) / list.energy(0.0, &u) - 1.0).abs() < 1e-13);
        let density = |_: usize| 1.0;
        let ratio = fast.frequency_bound(&density) / list.frequency_bound(&density);
        assert!((ratio - 1.0).abs() < 1e-12, "{ratio}");
    }
}

#[test]
fn grid_converges_to_the_spectral_operator() {
    // The grid with partial volumes is of second order; the spectral operator does not change with the grid.
    fn error<const D: usize>(spacing: f64) -> f64 {
        let cloud = cells(0.0, &vec![2.0; D], spacing);
        let influence = Influence {
            function: InfluenceFunction::Conical,
            acts_on: ActsOn::Displacement,
        };
        let material = material(PairLaw::Linear, 0.8, influence);
        let constants = material.constants(&cloud, state_of(&cloud)).unwrap();
        let n = cloud.len();
        let wave = |i: usize| {
            let x = cloud.point(i);
            (PI * (x[0] + 2.0 * x[1] - x[2])).sin()
        };
        let u: Vec<f64> = (0..D * n)
            .map(|entry| (1.0 + (entry / n) as f64) * wave(entry % n))
            .collect();
        let (mut a, mut b) = (vec![0.0; D * n], vec![0.0; D * n]);
        spectral::<D>(&cloud, &material).apply_into(&u, &mut a);
        let grid = ConvolutionForce::<D>::new(cloud.clone(), &material, &constants, &[], [true; D])
            .unwrap();
        grid.apply_into(&u, &mut b);
        let scale = a.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        distance(&a, &b) / scale
    }
    let errors = [error::<1>(0.1), error::<1>(0.05), error::<1>(0.025)];
    assert!(
        errors[2] < 2e-3 && errors[0] > 3.0 * errors[2],
        "{errors:?}"
    );
    let errors = [error::<2>(0.1), error::<2>(0.05)];
    assert!(
        errors[1] < 5e-3 && errors[0] > 2.0 * errors[1],
        "{errors:?}"
    );
    let errors = [error::<3>(0.2), error::<3>(0.1)];
    assert!(
        errors[1] < 2e-2 && errors[0] > 2.0 * errors[1],
        "{errors:?}"
    );
}

#[test]
fn fourier_functions_equal_chebyshev_series() {
    fn compare<const D: usize>(sides: &[f64]) {
        let cloud = cells(-0.5, sides, 0.2);
        let material = material(PairLaw::Linear, 0.6, Influence::default());
        let mut ends = Vec::new();
        for method in [FunctionMethod::Fourier, FunctionMethod::Chebyshev] {
            let mut body = system(&cloud, Box::new(spectral::<D>(&cloud, &material)));
            let mut scheme = trigonometric(method, &body);
            // Rough field: all wave vectors, including the highest.
            let mut state = start(&body, 0.1);
            state
                .u
                .iter_mut()
                .enumerate()
                .for_each(|(k, u)| *u += ((k * k) as f64 * 0.37).sin());
            ends.push(steps(&mut body, &mut *scheme, state, 2.0, 2));
        }
        assert!(distance(&ends[0].u, &ends[1].u) < 1e-13);
        assert!(distance(&ends[0].v, &ends[1].v) < 1e-12);
    }
    compare::<2>(&[1.2, 1.0]);
    compare::<3>(&[1.2, 0.8, 1.0]);
}

#[test]
fn loads_and_supports_have_the_expected_order() {
    let cloud = cells(0.0, &[6.0], 0.25);
    let n = cloud.len();
    let run = |rule: Option<LoadRule>, count: usize| {
        let mut body = system(&cloud, bonds(&cloud, &gaussian(), ForceForm::Grid));
        let pulse = TimeFunction::Pulse {
            start: -1.0,
            duration: 6.0,
        };
        body.add_load(Load::new(
            (n as u32 - 5..n as u32).collect(),
            [0.3, 0.0, 0.0],
            pulse.clone(),
        ))
        .unwrap();
        let motion = PrescribedMotion::new(
            "left".into(),
            (0..3).collect(),
            MotionKind::Displacement,
            [Some(0.2), None, None],
            pulse,
            &vec![0.0; n],
            n,
        )
        .unwrap();
        body.add_motion(motion).unwrap();
        let mut scheme: Box<dyn Integrator> = match rule {
            Some(load_rule) => {
                let options = TrigonometricOptions {
                    load_rule,
                    ..Default::default()
                };
                Box::new(Trigonometric::new(options, &body).unwrap())
            }
            None => implicit(ImplicitRule::Midpoint, &body),
        };
        let mut state = State::at_rest(n);
        state
            .v
            .iter_mut()
            .enumerate()
            .for_each(|(i, v)| *v = 0.1 * (i as f64).cos());
        steps(&mut body, &mut *scheme, state, 4.0 / count as f64, count)
    };
    let reference = run(Some(LoadRule::Gauss), 640);
    for (rule, order, tolerance, first) in [
        (Some(LoadRule::Gauss), 4.0, 0.05, 40),
        (Some(LoadRule::Midpoint), 2.0, 0.02, 40),
        (None, 2.0, 0.02, 160),
    ] {
        let error = |count| distance(&run(rule, count).u, &reference.u);
        let found = (error(first) / error(2 * first)).log2();
        assert!((found - order).abs() < tolerance, "{rule:?}: {found}");
    }
}

#[test]
fn moving_supports_are_integrated_exactly_at_steps_of_many_periods() {
    // A support that moves slowly: the body follows, and its highest period is much shorter than the step.
    let cloud = cells(0.0, &[6.0], 0.25);
    let n = cloud.len();
    let end = 400.0;
    let run = |count: usize| {
        let mut body = system(&cloud, bonds(&cloud, &gaussian(), ForceForm::Grid));
        let motion = |name: &str, points: std::ops::Range<u32>, far: f64| {
            let pulse = TimeFunction::Pulse {
                start: 0.0,
                duration: 2.0 * end,
            };
            PrescribedMotion::new(
                name.into(),
                points.collect(),
                MotionKind::Displacement,
                [Some(far), None, None],
                pulse,
                &vec![0.0; n],
                n,
            )
            .unwrap()
        };
        body.add_motion(motion("left", 0..3, 0.0)).unwrap();
        body.add_motion(motion("right", n as u32 - 3..n as u32, 0.2))
            .unwrap();
        let mut scheme = Trigonometric::new(TrigonometricOptions::default(), &body).unwrap();
        let dt = end / count as f64;
        let state = steps(&mut body, &mut scheme, State::at_rest(n), dt, count);
        (state.u, body.ledger().work)
    };
    let (reference, work) = run(4000);
    for (count, tolerance) in [(400, 1e-9), (100, 1e-7), (40, 1e-5)] {
        let (u, own) = run(count);
        let error = distance(&u, &reference) / distance(&reference, &vec![0.0; n]);
        assert!(error < tolerance, "{count} steps: {error:e}");
        assert!(
            (own / work - 1.0).abs() < 1e-2,
            "{count} steps: {own} {work}"
        );
    }
}

#[test]
fn constant_loads_are_integrated_exactly() {
    let cloud = cells(0.0, &[6.0], 0.25);
    let n = cloud.len();
    let run = |count: usize| {
        let mut body = system(&cloud, bonds(&cloud, &gaussian(), ForceForm::Grid));
        body.add_load(Load::new(
            (0..4).collect(),
            [0.3, 0.0, 0.0],
            TimeFunction::Constant,
        ))
        .unwrap();
        let mut scheme = trigonometric(FunctionMethod::Fastest, &body);
        let state = start(&body, 0.1);
        let end = steps(&mut body, &mut *scheme, state, 6.0 / count as f64, count);
        // Newton's second law.
        let momentum = body.momentum(&end.v)[0] - body.momentum(&start(&body, 0.1).v)[0];
        assert!((momentum / (0.3 * 4.0 * 0.25 * 6.0) - 1.0).abs() < 1e-13);
        end
    };
    assert!(distance(&run(1).u, &run(60).u) < 1e-13);
    assert_eq!(n, 24);
}

#[test]
fn nonlinear_bodies_are_second_order_and_conserve_energy() {
    let cloud = cells(-0.6, &[1.6, 1.2], 0.1);
    let material = material(PairLaw::BondStretch, 0.3, Influence::default());
    let body = || system(&cloud, bonds(&cloud, &material, ForceForm::Grid));
    let schemes: [Make; 3] = [
        |s| trigonometric(FunctionMethod::Fastest, s),
        |s| implicit(ImplicitRule::Midpoint, s),
        |s| implicit(ImplicitRule::Trapezoidal, s),
    ];
    // Strains of ten per cent.
    let run = |scheme: Make, count: usize| {
        let mut body = body();
        let mut scheme = scheme(&body);
        let state = start(&body, 0.05);
        let before = energy(&body, &state);
        let end = steps(&mut body, &mut *scheme, state, 1.0 / count as f64, count);
        let change = energy(&body, &end) / before - 1.0;
        (end, change)
    };
    let reference = {
        let mut body = body();
        let tableau = pericles::time::Tableau::rk4();
        let mut scheme = pericles::time::RungeKutta::new(&tableau, &body);
        let state = start(&body, 0.05);
        steps(&mut body, &mut scheme, state, 1.0 / 400.0, 400)
    };
    for scheme in schemes {
        let (coarse, change) = run(scheme, 20);
        let (fine, _) = run(scheme, 40);
        let order = (distance(&coarse.u, &reference.u) / distance(&fine.u, &reference.u)).log2();
        assert!((order - 2.0).abs() < 0.15, "{order}");
        assert!(change.abs() < 2e-3, "{change:e}");
    }
}

#[test]
fn nonlinear_gauss_bar_converges_for_both_schemes() {
    // Both converge to the same motion, which differs from the linear one.
    let cloud = Arc::new(gauss_bar(-3.0, 6.0, 0.2, 1.0).unwrap());
    for law in [PairLaw::GreenStrain, PairLaw::CubicSoftening] {
        let material = material(law, 0.6, Influence::default());
        let run = |law, make: Make, count: usize| {
            let material = BondMaterial {
                law,
                ..material.clone()
            };
            let mut body = system(&cloud, bonds(&cloud, &material, ForceForm::Fastest));
            let mut scheme = make(&body);
            let mut state = State::at_rest(cloud.len());
            for (u, x) in state.u.iter_mut().zip(cloud.axis(0)) {
                *u = 0.1 * (-(x * x)).exp();
            }
            let before = energy(&body, &state);
            let end = steps(&mut body, &mut *scheme, state, 1.5 / count as f64, count);
            assert!((energy(&body, &end) / before - 1.0).abs() < 1e-3);
            end
        };
        let exact: Make = |s| trigonometric(FunctionMethod::Fastest, s);
        let midpoint: Make = |s| implicit(ImplicitRule::Midpoint, s);
        let fine = run(law, exact, 640);
        let linear = run(PairLaw::Linear, exact, 1);
        for (make, count) in [(exact, 40), (midpoint, 80)] {
            let error = |count| distance(&run(law, make, count).u, &fine.u);
            let order = (error(count) / error(2 * count)).log2();
            assert!((order - 2.0).abs() < 0.1, "{law:?} {order}");
        }
        let nonlinearity = distance(&linear.u, &fine.u);
        assert!(nonlinearity > 1e-3, "{nonlinearity:e}");
    }
}

#[test]
fn spectral_nonlinear_forces_equal_sums_over_bonds() {
    // Smooth micromodulus, field and sum: both are exact except for round-off and values at the ends.
    let material = BondMaterial {
        law: PairLaw::GreenStrain,
        volume_correction: VolumeCorrection::None,
        ..gaussian()
    };
    let cloud = cells(-12.0, &[24.0], 0.1875);
    let ring = Arc::new(PointCloud::clone(&cloud).with_periodic_faces().unwrap());
    let list = bonds(&cloud, &material, ForceForm::List);
    let series = bonds(&ring, &material, ForceForm::Spectral);
    let x = cloud.axis(0);
    let bell = |width: f64| -> Vec<f64> {
        x.iter()
            .map(|x| 0.3 * (-((x - 0.4) / width).powi(2)).exp())
            .collect()
    };
    let (u, d) = (bell(1.0), bell(1.3));
    let n = x.len();
    let (mut a, mut b) = (vec![0.0; n], vec![0.0; n]);
    list.add_force(0.0, &u, pericles::operator::PointSubset::All, &mut a);
    series.add_force(0.0, &u, pericles::operator::PointSubset::All, &mut b);
    let size = a.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    assert!(
        distance(&a, &b) < 1e-10 * size,
        "{:e}",
        distance(&a, &b) / size
    );
    list.tangent_into(0.0, &u, &d, &mut a);
    series.tangent_into(0.0, &u, &d, &mut b);
    assert!(
        distance(&a, &b) < 1e-10 * size,
        "{:e}",
        distance(&a, &b) / size
    );
    let ratio = series.energy(0.0, &u) / list.energy(0.0, &u);
    assert!((ratio - 1.0).abs() < 1e-11, "{ratio}");
    // The force is a gradient: schemes related to the midpoint rule conserve energy to second order, and momentum
    // to round-off.
    let mut body = system(&ring, series);
    let mut scheme = trigonometric(FunctionMethod::Fastest, &body);
    let mut state = State::at_rest(n);
    state.u.copy_from_slice(&u);
    let before = energy(&body, &state);
    let end = steps(&mut body, &mut *scheme, state, 0.02, 100);
    assert!((energy(&body, &end) / before - 1.0).abs() < 1e-4);
    assert!(body.momentum(&end.v)[0].abs() < 1e-13);
}

#[test]
fn linearisation_error_is_second_order() {
    let cloud = cells(0.0, &[1.2, 1.0], 0.1);
    let stretch = material(PairLaw::BondStretch, 0.3, Influence::default());
    let linear = material(PairLaw::Linear, 0.3, Influence::default());
    let operator = bonds(&cloud, &stretch, ForceForm::Grid);
    let body = system(&cloud, bonds(&cloud, &linear, ForceForm::Grid));
    let u = start(&body, 1.0).u;
    let about = Linearisation::new(&*operator, vec![0.0; u.len()]);
    let (mut a, mut b) = (vec![0.0; u.len()], vec![0.0; u.len()]);
    about.apply_into(&u, &mut a);
    body.operator().as_linear().unwrap().apply_into(&u, &mut b);
    let size = b.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    assert!(distance(&a, &b) < 1e-13 * size);
    // Relative to the force, hence of first order in the strain.
    let error = |scale: f64| about.model_error(&u.iter().map(|u| scale * u).collect::<Vec<_>>());
    let order = (error(1e-2) / error(5e-3)).log2();
    assert!((order - 1.0).abs() < 0.05, "{order}");
}

#[test]
fn unsupported_bodies_and_options_are_errors() {
    let cloud = cells(0.0, &[6.0], 0.25);
    let body = system(&cloud, bonds(&cloud, &gaussian(), ForceForm::Grid));
    let with = |options| {
        Trigonometric::new(options, &body)
            .err()
            .unwrap()
            .to_string()
    };
    let negative = with(TrigonometricOptions {
        regularisation: -1.0,
        ..Default::default()
    });
    assert!(negative.contains("regularisation"), "{negative}");
    let fourier = with(TrigonometricOptions {
        functions: FunctionMethod::Fourier,
        ..Default::default()
    });
    assert!(fourier.contains("spectral"), "{fourier}");
    let constants = gaussian().constants(&cloud, StressState::Uniaxial).unwrap();
    let gauss = GaussForce::new(cloud.clone(), &gaussian(), &constants)
        .err()
        .unwrap();
    assert!(gauss.to_string().contains("Gauss nodes"), "{gauss}");
}

/// Bar of Gaussian bonds whose left end is moved.
fn driven_bar(form: ForceForm) -> System {
    let cloud = cells(-6.0, &[12.0], 0.1);
    let n = cloud.len();
    let mut body = system(&cloud, bonds(&cloud, &gaussian(), form));
    let pulse = TimeFunction::Pulse {
        start: 0.0,
        duration: 2.0,
    };
    let motion = PrescribedMotion::new(
        "left".into(),
        (0..3).collect(),
        MotionKind::Displacement,
        [Some(0.2), None, None],
        pulse,
        &vec![0.0; n],
        n,
    )
    .unwrap();
    body.add_motion(motion).unwrap();
    body
}

#[test]
fn direct_solver_agrees_with_conjugate_gradients() {
    for form in [ForceForm::Grid, ForceForm::List, ForceForm::Convolution] {
        for rule in [ImplicitRule::Midpoint, ImplicitRule::Trapezoidal] {
            let run = |solver| {
                let mut body = driven_bar(form);
                let mut scheme = Implicit::with_solver(rule, solver, &body).unwrap();
                assert_eq!(scheme.is_direct(0.3, &body), solver == LinearSolver::Direct);
                let state = start(&body, 0.1);
                steps(&mut body, &mut scheme, state, 0.3, 40)
            };
            let direct = run(LinearSolver::Direct);
            let iterated = run(LinearSolver::ConjugateGradients);
            assert!(distance(&direct.u, &iterated.u) < 1e-13);
            assert!(distance(&direct.v, &iterated.v) < 1e-12);
        }
    }
    // Two nodes per cell, and a full matrix.
    let cloud = Arc::new(gauss_bar(-3.0, 6.0, 0.2, 1.0).unwrap());
    let plate = cells(0.0, &[1.0, 0.8], 0.2);
    let stretch = material(PairLaw::Linear, 0.4, Influence::default());
    for (cloud, material) in [(&cloud, &gaussian()), (&plate, &stretch)] {
        let run = |solver| {
            let mut body = system(cloud, bonds(cloud, material, ForceForm::Fastest));
            let mut scheme = Implicit::with_solver(ImplicitRule::Midpoint, solver, &body).unwrap();
            let state = start(&body, 0.1);
            steps(&mut body, &mut scheme, state, 0.3, 20)
        };
        let direct = run(LinearSolver::Direct);
        let iterated = run(LinearSolver::ConjugateGradients);
        assert!(distance(&direct.u, &iterated.u) < 1e-13);
    }
}

#[test]
fn direct_solver_is_selected_where_it_is_cheaper() {
    let stretch = |m: f64| material(PairLaw::Linear, m, Influence::default());
    let direct = |cloud: &Arc<PointCloud>, horizon: f64, dt: f64| {
        let body = system(cloud, bonds(cloud, &stretch(horizon), ForceForm::Fastest));
        let scheme = Implicit::new(ImplicitRule::Midpoint, &body).unwrap();
        scheme.is_direct(dt, &body)
    };
    let bar = cells(0.0, &[400.0], 0.1);
    assert!(direct(&bar, 0.3, 0.1) && direct(&bar, 0.3, 100.0));
    // A band so wide that transforms with few iterations are cheaper, except for very large steps.
    assert!(!direct(&bar, 100.0, 1.0) && direct(&bar, 10.0, 1e3));
    let block = cells(0.0, &[8.0, 8.0, 8.0], 0.5);
    assert!(!direct(&block, 1.5, 0.1));
}

#[test]
fn runs_resume_bit_for_bit() {
    let direct: Make = |body| {
        let rule = ImplicitRule::Midpoint;
        Box::new(Implicit::with_solver(rule, LinearSolver::Direct, body).unwrap())
    };
    let schemes: [(Make, ForceForm); 3] = [
        (direct, ForceForm::Grid),
        (
            |body| trigonometric(FunctionMethod::Chebyshev, body),
            ForceForm::List,
        ),
        (
            |body| trigonometric(FunctionMethod::Lanczos, body),
            ForceForm::Convolution,
        ),
    ];
    for (scheme, form) in schemes {
        let make = || {
            let body = driven_bar(form);
            let (scheme, state) = (scheme(&body), start(&body, 0.1));
            Simulation::new(body, scheme, state, 0.1 + 1.0 / 3.0, 20).unwrap()
        };
        let name = make().integrator().name();
        let checked = check_resume(make, [7]);
        assert!(checked.is_ok(), "{name}: {}", checked.unwrap_err());
    }
}

#[test]
fn stress_without_individual_bonds_is_an_error() {
    use pericles::observe::{Field, Snapshot, StartEnergy};
    let bar = driven_bar(ForceForm::Convolution);
    let state = State::at_rest(bar.points());
    let snapshot = Snapshot::new(&bar, &state, StartEnergy::default(), 0.0);
    let rejected = snapshot.check(Field::Stress).unwrap_err().to_string();
    assert!(
        rejected.starts_with("Stress is a sum over single bonds"),
        "{rejected}"
    );
    snapshot.check(Field::Velocity).unwrap();
}
