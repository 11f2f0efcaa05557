//! Schemes compared with the modal solution for p = 2.

use nalgebra::{DMatrix, SymmetricEigen};
use pericles::time::{InnerSolver, Integrator, Newmark, State, VelocityVerlet};
use pericles::{Control, Simulation, System};
use pericles_waves::{Trigonometric, TrigonometricOptions};

use super::sphere::*;

/// All natural modes of one displacement component, from a dense eigenproblem; the shapes are orthonormal with
/// respect to areas.
struct Modes {
    omega: Vec<f64>,
    shapes: Vec<Vec<f64>>,
}

impl Modes {
    fn of(system: &System) -> Self {
        let n = system.points();
        let root: Vec<f64> = system.cloud().volumes().iter().map(|a| a.sqrt()).collect();
        let mut matrix = DMatrix::zeros(n, n);
        let (mut unit, mut force) = (vec![0.0; 3 * n], vec![0.0; 3 * n]);
        for j in 0..n {
            unit[j] = 1.0;
            let linear = system.operator().as_linear().expect("p = 2");
            linear.apply_into(&unit, &mut force);
            unit[j] = 0.0;
            for i in 0..n {
                matrix[(i, j)] = -force[i] * root[i] / root[j];
            }
        }
        let asymmetry = (&matrix - matrix.transpose()).amax();
        assert!(asymmetry < 1e-12 * matrix.amax(), "{asymmetry}");
        let eigen = SymmetricEigen::new(matrix);
        Self {
            omega: eigen
                .eigenvalues
                .iter()
                .map(|l| l.max(0.0).sqrt())
                .collect(),
            shapes: eigen
                .eigenvectors
                .column_iter()
                .map(|column| column.iter().zip(&root).map(|(x, root)| x / root).collect())
                .collect(),
        }
    }

    /// Σ shape · evolve(ω, modal displacement, modal velocity) over all modes and the three components.
    fn evolved(
        &self,
        sphere: &Sphere,
        start: &State,
        evolve: impl Fn(f64, f64, f64) -> f64,
    ) -> Vec<f64> {
        let n = sphere.cloud.len();
        let areas = sphere.cloud.volumes();
        let mut u = vec![0.0; 3 * n];
        for (&omega, shape) in self.omega.iter().zip(&self.shapes) {
            for c in 0..3 {
                let share = |field: &[f64]| -> f64 {
                    (0..n).map(|i| areas[i] * shape[i] * field[c * n + i]).sum()
                };
                let amount = evolve(omega, share(&start.u), share(&start.v));
                for i in 0..n {
                    u[c * n + i] += amount * shape[i];
                }
            }
        }
        u
    }
}

/// sin(x t)/x, and t for x = 0.
fn sine_over(x: f64, t: f64) -> f64 {
    if x * t < 1e-6 { t } else { (x * t).sin() / x }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    let largest = |m: f64, (a, b): (&f64, &f64)| m.max((a - b).abs());
    a.iter().zip(b).fold(0.0, largest)
}

/// Sphere of 162 vertices with initial displacement and velocity that excite all modes and rigid translation.
fn start(sphere: &Sphere) -> State {
    let mut state = sphere.thrown(1.0);
    let noise = noise(state.u.len(), 3);
    state
        .u
        .iter_mut()
        .zip(noise)
        .for_each(|(u, x)| *u = 0.3 * x);
    state
}

type Scheme<'a> = &'a dyn Fn(&System) -> Box<dyn Integrator>;

fn end(sphere: &Sphere, alpha: f64, scheme: Scheme<'_>, dt: f64, steps: u64) -> Vec<f64> {
    let system = sphere.system(&material(2.0, alpha));
    let scheme = scheme(&system);
    let mut run = Simulation::new(system, scheme, start(sphere), dt, steps).unwrap();
    run.run(|_| Control::Continue).unwrap();
    run.state().u.clone()
}

fn implicit(solver: InnerSolver) -> impl Fn(&System) -> Box<dyn Integrator> {
    move |system| Box::new(Newmark::new(newmark(solver), system).unwrap())
}

#[test]
fn each_mode_has_the_numerical_frequency_of_the_scheme() {
    let sphere = Sphere::new(2, arcs);
    for alpha in [0.0001, 0.5, 0.999] {
        let modes = Modes::of(&sphere.system(&material(2.0, alpha)));
        let highest = modes.omega.iter().fold(0.0_f64, |max, w| max.max(*w));
        let still = modes.omega.iter().filter(|w| **w < 1e-6 * highest).count();
        assert_eq!(still, 1, "translations only");
        let mut slowest = modes.omega.clone();
        slowest.sort_by(f64::total_cmp);
        let [one, two, three, other] = [1, 2, 3, 4].map(|k| slowest[k]);
        assert!(
            three - one < 1e-9 * two && other > 1.1 * three,
            "breathing along x, y, z"
        );
        let start = start(&sphere);
        let steps = 40;

        // Trapezoidal rule: tan(θ/2) = ω dt/2. By fixed-point iteration below the explicit limit, by
        // Newton–Krylov ten times above it.
        for (solver, part) in [
            (InnerSolver::FixedPoint, 0.5),
            (InnerSolver::Anderson { depth: 4 }, 0.5),
            (InnerSolver::NewtonKrylov, 10.0),
        ] {
            let dt = part * 2.0 / highest;
            let expected = modes.evolved(&sphere, &start, |omega, u, v| {
                let rate = 2.0 / dt * (0.5 * omega * dt).atan();
                let t = steps as f64 * dt;
                let stretch = if omega > 0.0 { rate / omega } else { 1.0 };
                u * (rate * t).cos() + v * stretch * sine_over(rate, t)
            });
            let found = end(&sphere, alpha, &implicit(solver), dt, steps);
            let scale = expected.iter().fold(0.0_f64, |max, u| max.max(u.abs()));
            let error = distance(&found, &expected);
            assert!(error < 1e-8 * scale, "α = {alpha}, {solver:?}: {error}");
        }

        // Velocity Verlet: cos θ = 1 − ω²dt²/2.
        let dt = 0.9 * 2.0 / highest;
        let expected = modes.evolved(&sphere, &start, |omega, u, v| {
            let angle = 2.0 * (0.5 * omega * dt).asin();
            let turned = if angle < 1e-6 {
                steps as f64
            } else {
                (angle * steps as f64).sin() / angle.sin()
            };
            u * (angle * steps as f64).cos() + v * dt * turned
        });
        let found = end(&sphere, alpha, &|_| Box::new(VelocityVerlet), dt, steps);
        assert!(distance(&found, &expected) < 1e-9, "α = {alpha}");

        // The trigonometric scheme is exact for any time step.
        let dt = 7.0 / highest;
        let t = steps as f64 * dt;
        let expected = modes.evolved(&sphere, &start, |omega, u, v| {
            u * (omega * t).cos() + v * sine_over(omega, t)
        });
        let exact: Scheme<'_> = &|system| {
            Box::new(Trigonometric::new(TrigonometricOptions::default(), system).unwrap())
        };
        let found = end(&sphere, alpha, exact, dt, steps);
        assert!(distance(&found, &expected) < 1e-8, "α = {alpha}");
    }
}

#[test]
fn time_stepping_converges_with_second_order() {
    let sphere = Sphere::new(2, arcs);
    let alpha = 0.5;
    let modes = Modes::of(&sphere.system(&material(2.0, alpha)));
    let time = 2.0;
    let expected = modes.evolved(&sphere, &start(&sphere), |omega, u, v| {
        u * (omega * time).cos() + v * sine_over(omega, time)
    });
    let schemes: [Scheme<'_>; 2] = [&implicit(InnerSolver::FixedPoint), &|_| {
        Box::new(VelocityVerlet)
    }];
    for scheme in schemes {
        let errors = [100, 200].map(|steps| {
            let found = end(&sphere, alpha, scheme, time / steps as f64, steps);
            distance(&found, &expected)
        });
        let ratio = errors[0] / errors[1];
        assert!((ratio - 4.0).abs() < 0.2, "{errors:?}");
    }
}
