//! Peridynamics on surfaces, and the implicit schemes.

use std::f64::consts::TAU;
use std::sync::Arc;

use pericles::boundary::{Load, TimeFunction};
use pericles::family::geodesic::{GeodesicMethod, GeodesicPairs, geodesic_pairs};
use pericles::material::{PowerMaterial, SurfaceBond};
use pericles::noise::{SplitMix64, uniform_in_ball};
use pericles::observe::{EnergyBound, Snapshot, StartEnergy, SurfaceMeasure};
use pericles::operator::surface::{DisplacementBond, HalfInteger, SurfaceBody};
use pericles::operator::{ForceOperator, InstructionSet, On};
use pericles::solve::{SolveLimits, Work, conjugate_gradient};
use pericles::space::PointCloud;
use pericles::space::surface::{AreaRule, Surface};
use pericles::time::{
    DiscreteGradient, InnerSolver, Integrator, Newmark, NewmarkOptions, State, VelocityVerlet,
    highest_frequency,
};
use pericles::{
    Archive, Control, PericlesError, PointScalar, Saved, Simulation, SimulationError, System,
};

struct Sphere {
    surface: Surface,
    cloud: Arc<PointCloud>,
    pairs: GeodesicPairs,
}

impl Sphere {
    fn new(level: u32, pairs: impl Fn(&Surface) -> GeodesicPairs) -> Self {
        let surface = Surface::icosphere(level, 1.0).unwrap();
        let areas = surface.vertex_areas(AreaRule::Barycentric);
        Self {
            cloud: Arc::new(PointCloud::of_surface(&surface, areas).unwrap()),
            pairs: pairs(&surface),
            surface,
        }
    }

    fn standard() -> Self {
        Self::new(3, |surface| {
            geodesic_pairs(surface, 0.5, GeodesicMethod::Edge).unwrap()
        })
    }

    fn body<'a>(&'a self, material: &'a PowerMaterial) -> SurfaceBody<'a> {
        SurfaceBody {
            surface: &self.surface,
            cloud: &self.cloud,
            pairs: &self.pairs,
            material,
            stiffness: &[],
            no_fail: &[],
        }
    }

    fn operator(&self, material: &PowerMaterial) -> Box<dyn ForceOperator> {
        self.body(material).operator().unwrap()
    }

    fn system(&self, material: &PowerMaterial) -> System {
        let density = PointScalar::Uniform(material.density);
        System::new(self.cloud.clone(), self.operator(material), density).unwrap()
    }

    fn inner(&self, a: &[f64], b: &[f64]) -> f64 {
        let areas = self.cloud.volumes();
        (0..a.len())
            .map(|k| areas[k % areas.len()] * a[k] * b[k])
            .sum()
    }

    /// At rest with velocities in a ball.
    fn thrown(&self, radius: f64) -> State {
        let n = self.cloud.len();
        let mut state = State::at_rest(3 * n);
        for (i, velocity) in uniform_in_ball(3, radius, 1, n).iter().enumerate() {
            for c in 0..3 {
                state.v[c * n + i] = velocity[c];
            }
        }
        state
    }
}

/// Great-circle arcs.
fn arcs(surface: &Surface) -> GeodesicPairs {
    let mut pairs = GeodesicPairs {
        start: vec![0],
        neighbour: vec![],
        distance: vec![],
    };
    for i in 0..surface.len() {
        for j in (0..surface.len()).filter(|&j| j != i) {
            let arc = 2.0 * (0.5 * surface.chord(i, j)).asin();
            if arc < 0.5 {
                pairs.neighbour.push(j as u32);
                pairs.distance.push(arc);
            }
        }
        pairs.start.push(pairs.neighbour.len());
    }
    pairs
}

fn material(p: f64, alpha: f64) -> PowerMaterial {
    PowerMaterial {
        density: 1.0,
        kappa: 1.0,
        alpha,
        p,
        horizon: 0.5,
        bond: SurfaceBond::Displacement,
        self_cell: false,
        critical_stretch: f64::INFINITY,
    }
}

fn noise(len: usize, seed: u64) -> Vec<f64> {
    let mut generator = SplitMix64::new(seed);
    (0..len).map(|_| generator.signed()).collect()
}

fn force(operator: &dyn ForceOperator, u: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; u.len()];
    operator.add_force(0.0, u, On::All, &mut out);
    out
}

fn sum_of(u: &[f64], factor: f64, q: &[f64]) -> Vec<f64> {
    u.iter().zip(q).map(|(u, q)| u + factor * q).collect()
}

/// The derivative at 0 by the six-point rule.
fn derivative(h: f64, f: impl Fn(f64) -> f64) -> f64 {
    let d = |k: f64| f(k * h) - f(-k * h);
    (45.0 * d(1.0) - 9.0 * d(2.0) + d(3.0)) / (60.0 * h)
}

fn materials() -> Vec<PowerMaterial> {
    let mut all = Vec::new();
    for p in [2.0, 2.5, 2.7, 3.0, 3.5, 4.0, 4.5, 5.0, 5.5, 6.0] {
        for bond in [SurfaceBond::Displacement, SurfaceBond::Chord] {
            all.push(PowerMaterial {
                bond,
                ..material(p, 0.5)
            });
        }
    }
    all.push(PowerMaterial {
        self_cell: true,
        ..material(2.0, 0.75)
    });
    all
}

/// A displacement and two directions. Chords are all stretched: neither length nor elongation comes near to zero, where difference quotients fail.
fn states(sphere: &Sphere, bond: SurfaceBond) -> [Vec<f64>; 3] {
    let x = sphere.cloud.positions();
    [1, 2, 3].map(|seed| {
        let noise = noise(x.len(), seed);
        match bond {
            SurfaceBond::Displacement => noise,
            SurfaceBond::Chord if seed == 1 => x
                .iter()
                .zip(&noise)
                .map(|(x, n)| 0.1 * x + 1e-3 * n)
                .collect(),
            SurfaceBond::Chord => noise.iter().map(|n| 1e-2 * n).collect(),
        }
    })
}

#[test]
fn forces_are_minus_the_gradient_of_the_energy() {
    let sphere = Sphere::standard();
    for material in materials() {
        let [u, q, _] = states(&sphere, material.bond);
        let operator = sphere.operator(&material);
        let slope = derivative(1e-2, |h| operator.energy(0.0, &sum_of(&u, h, &q)));
        let work = sphere.inner(&force(&*operator, &u), &q);
        let f = force(&*operator, &u);
        let scale = (sphere.inner(&f, &f) * sphere.inner(&q, &q)).sqrt();
        assert!(
            (slope + work).abs() < 1e-9 * scale,
            "p = {}, {:?}: {slope} and {work}",
            material.p,
            material.bond
        );
    }
}

#[test]
fn tangents_are_derivatives_symmetric_and_dissipate_nothing() {
    let sphere = Sphere::standard();
    let n = 3 * sphere.cloud.len();
    for material in materials() {
        let [u, d, e] = states(&sphere, material.bond);
        let operator = sphere.operator(&material);
        let tangent = |d: &[f64]| {
            let mut out = vec![f64::NAN; n];
            operator.tangent_into(0.0, &u, d, &mut out);
            out
        };
        let (along, across) = (tangent(&d), tangent(&e));
        let slope = derivative(1e-2, |h| {
            sphere.inner(&force(&*operator, &sum_of(&u, h, &d)), &e)
        });
        let [work, turned] = [sphere.inner(&along, &e), sphere.inner(&across, &d)];
        let scale = sphere.inner(&along, &d).abs();
        assert!((slope - work).abs() < 1e-6 * scale, "p = {}", material.p);
        assert!((turned - work).abs() < 1e-12 * scale, "p = {}", material.p);
        if material.bond == SurfaceBond::Displacement {
            assert!(sphere.inner(&along, &d) < 0.0);
        }
    }
}

#[test]
fn rigid_translations_are_free_and_rotations_only_for_chords() {
    let sphere = Sphere::standard();
    let n = sphere.cloud.len();
    let x = sphere.cloud.positions();
    // A rotation by 0.3 about z, and a translation.
    let (sin, cos) = 0.3_f64.sin_cos();
    let rotated: Vec<f64> = (0..3 * n)
        .map(|k| match k / n {
            0 => (cos - 1.0) * x[k] - sin * x[k + n],
            1 => sin * x[k - n] + (cos - 1.0) * x[k],
            _ => 0.0,
        })
        .collect();
    let moved: Vec<f64> = (0..3 * n).map(|k| [0.1, -2.0, 0.4][k / n]).collect();
    let largest = |x: Vec<f64>| x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    for p in [2.0, 3.0] {
        for bond in [SurfaceBond::Displacement, SurfaceBond::Chord] {
            let operator = sphere.operator(&PowerMaterial {
                bond,
                ..material(p, 0.5)
            });
            assert!(largest(force(&*operator, &moved)) < 1e-11);
            let resisted = largest(force(&*operator, &rotated));
            match bond {
                SurfaceBond::Displacement => assert!(resisted > 1e-2, "{resisted}"),
                SurfaceBond::Chord => assert!(resisted < 1e-11, "{resisted}"),
            }
            // Momentum: Σ A K u = 0 for any u.
            let f = force(&*operator, &noise(3 * n, 5));
            for c in 0..3 {
                let total: f64 = (0..n)
                    .map(|i| sphere.cloud.volumes()[i] * f[c * n + i])
                    .sum();
                assert!(total.abs() < 1e-11, "{total}");
            }
        }
    }
}

#[test]
fn instruction_sets_and_parts_of_the_body_agree() {
    let sphere = Sphere::standard();
    let n = sphere.cloud.len();
    let u = noise(3 * n, 4);
    let material = material(3.0, 0.5);
    let on = |set| {
        sphere
            .body(&material)
            .force(DisplacementBond(HalfInteger::<2, 0>))
            .with_instruction_set(set)
    };
    let baseline = force(&on(InstructionSet::Baseline), &u);
    for set in InstructionSet::available() {
        let operator = on(set);
        let whole = force(&operator, &u);
        for k in 0..3 * n {
            assert!((whole[k] - baseline[k]).abs() < 1e-12 * baseline[k].abs().max(1.0));
        }
        let some: Vec<u32> = (0..n as u32).filter(|i| i % 5 == 2).collect();
        let mut part = vec![0.0; 3 * n];
        operator.add_force(0.0, &u, On::Set(&some), &mut part);
        let mut range = vec![0.0; 3 * n];
        operator.add_force(0.0, &u, On::Range(100..600), &mut range);
        for k in 0..3 * n {
            let i = k % n;
            assert_eq!(part[k], if i % 5 == 2 { whole[k] } else { 0.0 });
            assert_eq!(
                range[k],
                if (100..600).contains(&i) {
                    whole[k]
                } else {
                    0.0
                }
            );
        }
    }
}

/// The lowest eigenvalue of −K for p = 2 on one component without its mean, from the coordinate x, and its vector.
fn breathing(sphere: &Sphere, material: &PowerMaterial) -> (f64, Vec<f64>) {
    let operator = sphere.operator(material);
    let linear = operator.as_linear().expect("p = 2");
    let n = sphere.cloud.len();
    let areas = sphere.cloud.volumes();
    let total: f64 = areas.iter().sum();
    // Constants are lifted above the spectrum.
    let lift = operator.frequency_bound(&|_| 1.0).powi(2);
    let mut apply = |x: &[f64], out: &mut [f64]| {
        let mut u = vec![0.0; 3 * n];
        u[..n].copy_from_slice(x);
        let mut f = vec![0.0; 3 * n];
        linear.apply_into(&u, &mut f);
        let mean: f64 = x.iter().zip(areas).map(|(x, a)| x * a).sum::<f64>() / total;
        for i in 0..n {
            out[i] = areas[i] * (lift * mean - f[i]);
        }
    };
    let mut vector = sphere.cloud.axis(0).to_vec();
    let mut value = 0.0;
    let mut work = Work::new(n);
    for _ in 0..30 {
        let right: Vec<f64> = vector.iter().zip(areas).map(|(x, a)| x * a).collect();
        let mut next = vector.clone();
        let limits = SolveLimits {
            relative: 1e-11,
            ..SolveLimits::default()
        };
        conjugate_gradient(&mut apply, &right, &mut next, &limits, &mut work).unwrap();
        let square = |x: &[f64], y: &[f64]| -> f64 { (0..n).map(|i| areas[i] * x[i] * y[i]).sum() };
        value = square(&next, &vector) / square(&next, &next);
        let norm = square(&next, &next).sqrt();
        next.iter_mut().for_each(|x| *x /= norm);
        vector = next;
    }
    (value, vector)
}

#[test]
fn breathing_periods_and_highest_frequencies() {
    // Recomputed from the scalar eigenproblem by an independent code: distances along edges, and great-circle arcs.
    let sphere = Sphere::standard();
    let exact = Sphere::new(3, arcs);
    assert_eq!((sphere.pairs.len(), exact.pairs.len()), (22740, 23580));
    let printed = [
        (1e-4, 11.351, 10.556, 3.400),
        (0.5, 6.126, 5.667, 8.007),
        (0.999, 2.989, 2.791, 20.17),
    ];
    for (alpha, edges, great_circles, highest) in printed {
        let material = material(2.0, alpha);
        let period = |sphere: &Sphere| TAU / breathing(sphere, &material).0.sqrt();
        assert!((period(&sphere) / edges - 1.0).abs() < 1e-3);
        assert!((period(&exact) / great_circles - 1.0).abs() < 1e-3);
        let system = sphere.system(&material);
        let found = highest_frequency(&system, &vec![0.0; 3 * sphere.cloud.len()]).unwrap();
        assert!(found.converged && (found.estimate / highest - 1.0).abs() < 1e-3);
        assert!(found.bound >= found.estimate);
    }
}

#[test]
fn the_self_cell_brings_the_continuum() {
    // 2π ∫ (1 − cos t) sin t t^−(2+2α) dt up to 0.5.
    let continuum = [
        (0.25, 0.72096),
        (0.5, 1.53856),
        (0.75, 4.38811),
        (0.999, 1568.5),
    ];
    let spheres = [Sphere::new(2, arcs), Sphere::new(3, arcs)];
    for (alpha, expected) in continuum {
        let error = |sphere: &Sphere, self_cell| {
            let material = PowerMaterial {
                self_cell,
                ..material(2.0, alpha)
            };
            (breathing(sphere, &material).0 / expected - 1.0).abs()
        };
        let [with, without] = [true, false].map(|term| error(&spheres[1], term));
        assert!(
            with < 0.045 && with < without,
            "α = {alpha}: {with}, {without}"
        );
        assert!(with < error(&spheres[0], true), "α = {alpha}: {with}");
    }
}

fn newmark(solver: InnerSolver) -> NewmarkOptions {
    NewmarkOptions {
        solver,
        tolerance: 1e-11,
        iterations: 400,
        ..NewmarkOptions::default()
    }
}

/// Runs and returns the simulation with the relative spread of kinetic + elastic energy.
fn spread(
    system: System,
    integrator: Box<dyn Integrator>,
    state: State,
    dt: f64,
    steps: u64,
) -> (Simulation, f64) {
    let mut run = Simulation::new(system, integrator, state, dt, steps);
    let first = run.snapshot().energies().initial;
    let (mut low, mut high) = (first, first);
    run.run(|run| {
        let energies = run.snapshot().energies();
        let total = energies.kinetic + energies.elastic;
        (low, high) = (low.min(total), high.max(total));
        Control::Continue
    })
    .unwrap();
    (run, (high - low) / first)
}

#[test]
fn newmark_oscillates_as_its_dispersion_says() {
    // In an eigenvector the trapezoidal rule is a rotation with tan(ω̃ dt/2) = ω dt/2.
    let sphere = Sphere::standard();
    let material = material(2.0, 0.5);
    let (value, vector) = breathing(&sphere, &material);
    let (omega, dt, steps) = (value.sqrt(), 0.05, 200);
    let numerical = 2.0 / dt * (0.5 * omega * dt).atan();
    for solver in [
        InnerSolver::FixedPoint,
        InnerSolver::Anderson { depth: 4 },
        InnerSolver::NewtonKrylov,
    ] {
        let system = sphere.system(&material);
        let scheme = Newmark::new(newmark(solver), &system).unwrap();
        let mut state = State::at_rest(3 * sphere.cloud.len());
        state.u[..vector.len()].copy_from_slice(&vector);
        let (run, spread) = spread(system, Box::new(scheme), state, dt, steps);
        let expected = (numerical * dt * steps as f64).cos();
        for (u, x) in run.state().u.iter().zip(&vector) {
            assert!((u - expected * x).abs() < 1e-8, "{solver:?}");
        }
        assert!(spread < 1e-8, "{solver:?}: {spread}");
    }
}

#[test]
fn energy_of_cubic_bonds_spreads_with_the_square_of_the_step() {
    let sphere = Sphere::standard();
    let material = material(3.0, 0.999);
    let spreads: Vec<f64> = [1000, 2000]
        .map(|steps| {
            let system = sphere.system(&material);
            let scheme = Newmark::new(newmark(InnerSolver::FixedPoint), &system).unwrap();
            let dt = 1.0 / steps as f64;
            spread(system, Box::new(scheme), sphere.thrown(1.0), dt, steps).1
        })
        .to_vec();
    assert!(spreads[0] < 2e-3, "{spreads:?}");
    assert!((spreads[0] / spreads[1] - 4.0).abs() < 0.4, "{spreads:?}");
}

#[test]
fn implicit_schemes_stand_ten_times_the_explicit_limit() {
    let sphere = Sphere::standard();
    let linear = material(2.0, 0.5);
    let dt = 10.0 * 2.0 / 8.007;
    let system = sphere.system(&linear);
    let scheme = Newmark::new(newmark(InnerSolver::NewtonKrylov), &system).unwrap();
    assert!(scheme.stability_limit().is_none());
    let (run, change) = spread(system, Box::new(scheme), sphere.thrown(0.1), dt, 100);
    assert!(change < 1e-8, "{change}");
    assert!(run.integrator().inner_iterations().unwrap().most < 20);
    for p in [2.0, 3.0, 5.0] {
        let material = material(p, 0.5);
        // The explicit limit at a state the body comes to: the highest frequency after a time unit.
        let scout = VelocityVerlet;
        let (run, _) = spread(
            sphere.system(&material),
            Box::new(scout),
            sphere.thrown(0.5),
            1e-2,
            100,
        );
        let omega = highest_frequency(run.system(), &run.state().u)
            .unwrap()
            .estimate;
        let system = sphere.system(&material);
        let scheme = DiscreteGradient::new(1e-10, &system).unwrap();
        let before = system.momentum(&sphere.thrown(0.5).v);
        let dt = 20.0 / omega;
        let (run, change) = spread(system, Box::new(scheme), sphere.thrown(0.5), dt, 15);
        assert!(change < 1e-8, "p = {p}: {change}");
        let after = run.system().momentum(&run.state().v);
        for c in 0..3 {
            assert!((after[c] - before[c]).abs() < 1e-9, "p = {p}");
        }
    }
}

#[test]
fn discrete_gradients_are_of_second_order() {
    let sphere = Sphere::standard();
    let material = material(4.0, 0.5);
    let end = |integrator: &dyn Fn(&System) -> Box<dyn Integrator>, steps: u64| {
        let system = sphere.system(&material);
        let scheme = integrator(&system);
        let dt = 0.5 / steps as f64;
        let (run, _) = spread(system, scheme, sphere.thrown(1.0), dt, steps);
        run.state().u.clone()
    };
    let reference = end(&|_| Box::new(VelocityVerlet), 4000);
    let errors = [10, 20].map(|steps| {
        let u = end(
            &|system| Box::new(DiscreteGradient::new(1e-11, system).unwrap()),
            steps,
        );
        let square: f64 = u.iter().zip(&reference).map(|(a, b)| (a - b).powi(2)).sum();
        square.sqrt()
    });
    let order = (errors[0] / errors[1]).log2();
    assert!((order - 2.0).abs() < 0.2, "{order}");
}

#[test]
fn the_inner_iteration_ends_where_explicit_schemes_do() {
    let sphere = Sphere::standard();
    let material = material(2.0, 0.999);
    let most = |part: f64, solver| {
        let system = sphere.system(&material);
        let options = NewmarkOptions {
            solver,
            iterations: 400,
            ..NewmarkOptions::default()
        };
        let scheme = Newmark::new(options, &system).unwrap();
        let dt = part * 2.0 / 20.17;
        let mut run = Simulation::new(system, Box::new(scheme), sphere.thrown(0.1), dt, 20);
        run.run(|_| Control::Continue)
            .map(|_| run.integrator().inner_iterations().unwrap().most)
    };
    let plain = most(0.9, InnerSolver::FixedPoint).unwrap();
    assert!((50..100).contains(&plain), "{plain}");
    let accelerated = most(0.9, InnerSolver::Anderson { depth: 5 }).unwrap();
    assert!(2 * accelerated < plain, "{accelerated} and {plain}");
    match most(1.02, InnerSolver::FixedPoint).unwrap_err() {
        SimulationError::Step(PericlesError::InnerIteration { omega, safe, .. }) => {
            assert!((omega / 20.17 - 1.0).abs() < 1e-2, "{omega}");
            assert!(safe < 2.0 / 20.17 && safe > 0.9 * 2.0 / 20.17, "{safe}");
        }
        other => panic!("{other}"),
    }
}

#[test]
fn bonds_break_once_and_dissipate_their_energy() {
    let sphere = Sphere::standard();
    let material = PowerMaterial {
        critical_stretch: 0.4,
        ..material(2.0, 0.5)
    };
    let run = |stop: u64| {
        let system = sphere.system(&material);
        let mut run = Simulation::new(
            system,
            Box::new(VelocityVerlet),
            sphere.thrown(1.0),
            0.01,
            200,
        );
        run.run(|run| {
            if run.state().step == stop {
                Control::Stop
            } else {
                Control::Continue
            }
        })
        .unwrap();
        run
    };
    let whole = run(u64::MAX);
    let energies = whole.snapshot().energies();
    let operator = whole.system().operator();
    assert!(operator.broken_bonds() > 100 && operator.broken_bonds() < 11370);
    assert!(energies.dissipated > 0.05 * energies.initial);
    assert!(
        energies.balance().abs() < 2e-3 * energies.initial,
        "{energies:?}"
    );
    let momentum = whole.system().momentum(&whole.state().v);
    let before = whole.system().momentum(&sphere.thrown(1.0).v);
    for c in 0..3 {
        assert!((momentum[c] - before[c]).abs() < 1e-11);
    }
    // Stop and go on, in a run that has broken other bonds in between.
    let mut archive = Archive::default();
    run(60).save(&mut archive);
    let mut resumed = run(120);
    resumed.restore(&archive).unwrap();
    resumed.run(|_| Control::Continue).unwrap();
    assert_eq!(resumed.state(), whole.state());
    assert_eq!(
        resumed.system().operator().dissipated(),
        energies.dissipated
    );
}

#[test]
fn implicit_schemes_go_on_from_a_checkpoint() {
    let sphere = Sphere::standard();
    let material = material(3.0, 0.5);
    type Make<'a> = &'a dyn Fn(&System) -> Box<dyn Integrator>;
    let schemes: [Make<'_>; 2] = [
        &|system| {
            Box::new(Newmark::new(newmark(InnerSolver::Anderson { depth: 3 }), system).unwrap())
        },
        &|system| Box::new(DiscreteGradient::new(1e-9, system).unwrap()),
    ];
    for scheme in schemes {
        let make = || {
            let system = sphere.system(&material);
            let integrator = scheme(&system);
            Simulation::new(system, integrator, sphere.thrown(1.0), 0.05, 12)
        };
        let mut whole = make();
        whole.run(|_| Control::Continue).unwrap();
        let mut first = make();
        first
            .run(|run| {
                if run.state().step == 5 {
                    Control::Stop
                } else {
                    Control::Continue
                }
            })
            .unwrap();
        let mut archive = Archive::default();
        first.save(&mut archive);
        let mut second = make();
        second.restore(&archive).unwrap();
        second.run(|_| Control::Continue).unwrap();
        assert_eq!(second.state(), whole.state());
        assert_eq!(
            second.integrator().inner_iterations(),
            whole.integrator().inner_iterations()
        );
    }
}

#[test]
fn a_surface_is_measured() {
    let sphere = Sphere::standard();
    let n = sphere.cloud.len();
    let measure = SurfaceMeasure::new(Arc::new(sphere.surface.clone()));
    let system = sphere.system(&material(2.0, 0.5));
    let mut state = State::at_rest(3 * n);
    let read =
        |state: &State| measure.read(&Snapshot::new(&system, state, StartEnergy::default(), 0.0));
    // Inflated by a tenth; turned inside out through the equator; one vertex pulled out.
    let x = sphere.cloud.positions().to_vec();
    state.u = x.iter().map(|x| 0.1 * x).collect();
    let inflated = read(&state);
    assert!((inflated.stretch - 0.21).abs() < 1e-12);
    assert_eq!((inflated.inverted_triangles, inflated.zones.len()), (0, 0));
    assert!(inflated.localisation > 1.0 && inflated.localisation < 1.5);
    state.u = (0..3 * n)
        .map(|k| if k < 2 * n { 0.0 } else { -2.0 * x[k] })
        .collect();
    let turned = read(&state);
    assert!(turned.stretch.abs() < 1e-12);
    assert!(
        turned.inverted_triangles > 400,
        "{}",
        turned.inverted_triangles
    );
    state.u = vec![0.0; 3 * n];
    (0..3).for_each(|c| state.u[c * n + 17] = 2.0 * x[c * n + 17]);
    let pulled = read(&state);
    assert_eq!(pulled.zones.len(), 1);
    let centre = pulled.zones[0].centre;
    let apart: f64 = (0..3).map(|c| (centre[c] - x[c * n + 17]).powi(2)).sum();
    assert!(apart.sqrt() < 0.1 && pulled.overstretched_edges >= 5);
    assert!(pulled.top_share > 0.5 && pulled.localisation > 50.0);
}

#[test]
fn the_energy_bound_is_met_with_equality_by_a_uniform_load() {
    // The body moves as a whole: √E = ∫‖b‖/√(2ρ).
    let sphere = Sphere::standard();
    let n = sphere.cloud.len();
    let mut system = sphere.system(&PowerMaterial {
        density: 3.0,
        ..material(3.0, 0.5)
    });
    let all = (0..n as u32).collect();
    system.add_load(Load::new(all, [0.3, -0.1, 0.2], TimeFunction::Constant));
    let scheme = Newmark::new(newmark(InnerSolver::FixedPoint), &system).unwrap();
    let mut run = Simulation::new(system, Box::new(scheme), State::at_rest(3 * n), 0.05, 40);
    let mut bound = EnergyBound::default();
    bound.margin(&run.snapshot());
    run.run(|run| {
        let snapshot = run.snapshot();
        let energies = snapshot.energies();
        let margin = bound.margin(&snapshot);
        assert!(margin.abs() < 1e-9 * energies.kinetic.sqrt(), "{margin}");
        Control::Continue
    })
    .unwrap();
}

#[test]
fn materials_and_parameters_out_of_range_are_refused() {
    let good = material(2.0, 0.5);
    let wrong = [
        PowerMaterial { alpha: 1.0, ..good },
        PowerMaterial { alpha: 0.0, ..good },
        PowerMaterial {
            alpha: f64::NAN,
            ..good
        },
        PowerMaterial { p: 1.9, ..good },
        PowerMaterial {
            p: f64::NAN,
            ..good
        },
        PowerMaterial { kappa: 0.0, ..good },
        PowerMaterial {
            density: -1.0,
            ..good
        },
        PowerMaterial {
            horizon: 0.0,
            ..good
        },
        PowerMaterial {
            critical_stretch: 0.0,
            ..good
        },
        PowerMaterial {
            p: 3.0,
            self_cell: true,
            ..good
        },
    ];
    assert!(good.check().is_ok());
    for material in wrong {
        assert!(material.check().is_err(), "{material:?}");
    }
    let sphere = Sphere::standard();
    let system = sphere.system(&good);
    for options in [
        NewmarkOptions {
            beta: -0.1,
            ..Default::default()
        },
        NewmarkOptions {
            beta: 0.6,
            ..Default::default()
        },
        NewmarkOptions {
            gamma: 0.4,
            ..Default::default()
        },
        NewmarkOptions {
            tolerance: 0.0,
            ..Default::default()
        },
        NewmarkOptions {
            iterations: 0,
            ..Default::default()
        },
        newmark(InnerSolver::Anderson { depth: 9 }),
        NewmarkOptions {
            beta: 0.0,
            ..newmark(InnerSolver::NewtonKrylov)
        },
    ] {
        assert!(Newmark::new(options, &system).is_err(), "{options:?}");
    }
    assert!(DiscreteGradient::new(0.0, &system).is_err());
}
