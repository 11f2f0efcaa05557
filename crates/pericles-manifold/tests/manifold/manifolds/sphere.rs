//! Sphere with bonds, and helpers for tests.

use std::sync::Arc;

use pericles::noise::{SplitMix64, uniform_in_ball};
use pericles::operator::{Force, PointSubset};
use pericles::solve::{SolveLimits, Work, conjugate_gradient};
use pericles::space::PointCloud;
use pericles::time::{InnerSolver, Integrator, NewmarkOptions, State};
use pericles::{Control, PointScalar, Simulation, System};
use pericles_manifold::force::SurfaceBody;
use pericles_manifold::geodesic::{GeodesicMethod, GeodesicPairs, geodesic_pairs};
use pericles_manifold::surface::{AreaRule, Surface};
use pericles_manifold::{PowerMaterial, SurfaceBond};

pub struct Sphere {
    pub surface: Surface,
    pub cloud: Arc<PointCloud>,
    pub pairs: GeodesicPairs,
}

impl Sphere {
    pub fn new(level: u32, pairs: impl Fn(&Surface) -> GeodesicPairs) -> Self {
        let surface = Surface::icosphere(level, 1.0).unwrap();
        let areas = surface.vertex_areas(AreaRule::Barycentric);
        Self {
            cloud: Arc::new(surface.points(areas).unwrap()),
            pairs: pairs(&surface),
            surface,
        }
    }

    pub fn standard() -> Self {
        Self::new(3, |surface| {
            geodesic_pairs(surface, 0.5, GeodesicMethod::Edge).unwrap()
        })
    }

    pub fn body<'a>(&'a self, material: &'a PowerMaterial) -> SurfaceBody<'a> {
        SurfaceBody {
            surface: &self.surface,
            cloud: &self.cloud,
            pairs: &self.pairs,
            material,
            stiffness: &[],
            no_fail: &[],
        }
    }

    pub fn operator(&self, material: &PowerMaterial) -> Box<dyn Force> {
        self.body(material).operator().unwrap()
    }

    pub fn system(&self, material: &PowerMaterial) -> System {
        let density = PointScalar::Uniform(material.density);
        System::new(self.cloud.clone(), self.operator(material), density).unwrap()
    }

    pub fn inner(&self, a: &[f64], b: &[f64]) -> f64 {
        let areas = self.cloud.volumes();
        (0..a.len())
            .map(|k| areas[k % areas.len()] * a[k] * b[k])
            .sum()
    }

    /// Undeformed, with initial velocities within a ball.
    pub fn thrown(&self, radius: f64) -> State {
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
pub fn arcs(surface: &Surface) -> GeodesicPairs {
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

pub fn material(p: f64, alpha: f64) -> PowerMaterial {
    PowerMaterial {
        density: 1.0,
        kappa: 1.0,
        alpha,
        p,
        horizon: 0.5,
        bond: SurfaceBond::Displacement,
        self_interaction: false,
        critical_stretch: f64::INFINITY,
    }
}

pub fn noise(len: usize, seed: u64) -> Vec<f64> {
    let mut generator = SplitMix64::new(seed);
    (0..len).map(|_| generator.signed()).collect()
}

pub fn force(operator: &dyn Force, u: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; u.len()];
    operator.add_force(0.0, u, PointSubset::All, &mut out);
    out
}

pub fn sum_of(u: &[f64], factor: f64, q: &[f64]) -> Vec<f64> {
    u.iter().zip(q).map(|(u, q)| u + factor * q).collect()
}

/// Derivative at 0 by the six-point difference formula.
pub fn derivative(h: f64, f: impl Fn(f64) -> f64) -> f64 {
    let d = |k: f64| f(k * h) - f(-k * h);
    (45.0 * d(1.0) - 9.0 * d(2.0) + d(3.0)) / (60.0 * h)
}

/// Lowest eigenvalue of −K for p = 2 on one component without its mean, starting from the coordinate x, and its
/// eigenvector.
pub fn breathing(sphere: &Sphere, material: &PowerMaterial) -> (f64, Vec<f64>) {
    let operator = sphere.operator(material);
    let linear = operator.as_linear().expect("p = 2");
    let n = sphere.cloud.len();
    let areas = sphere.cloud.volumes();
    let total: f64 = areas.iter().sum();
    // Shifts constants above the spectrum.
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

pub fn newmark(solver: InnerSolver) -> NewmarkOptions {
    NewmarkOptions {
        solver,
        tolerance: 1e-11,
        iterations: 400,
        ..NewmarkOptions::default()
    }
}

/// Runs, and returns the simulation with the relative spread of kinetic + elastic energy.
pub fn spread(
    system: System,
    integrator: Box<dyn Integrator>,
    state: State,
    dt: f64,
    steps: u64,
) -> (Simulation, f64) {
    let mut run = Simulation::new(system, integrator, state, dt, steps).unwrap();
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
