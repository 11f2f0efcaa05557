//! Small bodies: time of complete steps beside that of the force alone, on one thread and on several.

use std::sync::Arc;
use std::time::Instant;

use pericles::operator::{BondForm, PointSubset};
use pericles::time::{
    Fine, Integrator, Interpolant, MultiTimeStep, MultiTimeStepOptions, Predictor, RungeKutta,
    State, Tableau, VelocityVerlet,
};
use pericles::{Interrupt, PointScalar, Result, System};
use pericles_manifold::force::SurfaceBody;
use pericles_manifold::geodesic::{GeodesicMethod, geodesic_pairs};
use pericles_manifold::surface::{AreaRule, Surface};
use pericles_manifold::{PowerMaterial, SurfaceBond};

use crate::Case;

/// Time step, s: far below the stable one.
const DT: f64 = 1e-7;
/// Duration of a round, s.
const ROUND: f64 = 0.1;
/// Step ratio of the multirate scheme.
const RATIO: u32 = 8;
/// Fraction of the area of the plate with the fine step; a box of at least four spacings.
const FINE: f64 = 0.1;

/// A body and the scheme of its steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SmallBody {
    /// Bond-based bar, velocity Verlet.
    Bar,
    /// Bond-based plate, velocity Verlet.
    Verlet,
    /// Bond-based plate, classical Runge–Kutta.
    RungeKutta,
    /// Bond-based plate, multirate Runge–Kutta with eight fine steps in a box of a tenth of the area.
    Multirate,
    /// Plate of a linear peridynamic solid, velocity Verlet.
    LinearSolid,
    /// Sphere with a surface force, velocity Verlet.
    Surface,
}

/// Times of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct SmallTiming {
    /// Name of the body and its scheme.
    pub body: &'static str,
    /// Number of points.
    pub points: usize,
    /// Nanoseconds per point of one force evaluation on one thread.
    pub force_ns: f64,
    /// Number of force evaluations per point and step.
    pub evaluations: f64,
    /// Nanoseconds per point and step, for each number of threads.
    pub step_ns: Vec<f64>,
}

impl SmallBody {
    /// All bodies.
    pub const ALL: [Self; 6] = [
        Self::Bar,
        Self::Verlet,
        Self::RungeKutta,
        Self::Multirate,
        Self::LinearSolid,
        Self::Surface,
    ];

    /// Returns the name in results.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bar => "bar-verlet",
            Self::Verlet => "plate-verlet",
            Self::RungeKutta => "plate-rk4",
            Self::Multirate => "plate-multirate-rk4",
            Self::LinearSolid => "plate-lps-verlet",
            Self::Surface => "sphere-verlet",
        }
    }

    /// Returns the sizes: cells along the axes, or subdivisions of an icosahedron.
    fn sizes(self) -> Vec<Vec<usize>> {
        match self {
            Self::Bar => [100, 512, 513, 1024, 5000, 20_000, 100_000]
                .map(|n| vec![n])
                .into(),
            Self::Surface => (2..=5).map(|level| vec![level]).collect(),
            _ => [
                [10, 10],
                [27, 19],
                [40, 50],
                [80, 90],
                [150, 150],
                [316, 316],
            ]
            .map(Vec::from)
            .into(),
        }
    }

    /// Creates the body, and the number of force evaluations per point and step.
    fn create(self, size: &[usize]) -> Result<(Running, f64)> {
        let (mut system, mut state) = match self {
            Self::Surface => sphere(size[0])?,
            _ => Case {
                state_based: self == Self::LinearSolid,
                ..Case::new(self.name(), size.to_vec(), BondForm::Grid)
            }
            .system()?,
        };
        let mut evaluations = 1.0;
        let mut integrator: Box<dyn Integrator> = match self {
            Self::RungeKutta => {
                evaluations = 4.0;
                Box::new(RungeKutta::new(&Tableau::rk4(), &system))
            }
            Self::Multirate => {
                let cloud = system.cloud();
                let [low, high] = cloud.bounds();
                // At least as thick as the longest bond.
                let is_fine = |i: usize| {
                    (0..2).all(|c| {
                        let width = (FINE.sqrt() * (high[c] - low[c])).max(4.0 * cloud.spacing());
                        (cloud.point(i)[c] - 0.5 * (low[c] + high[c])).abs() <= 0.5 * width
                    })
                };
                let fine: Vec<u32> = (0..system.points())
                    .filter(|&i| is_fine(i))
                    .map(|i| i as u32)
                    .collect();
                let share = fine.len() as f64 / system.points() as f64;
                evaluations = 4.0 * (1.0 + f64::from(RATIO - 1) * share);
                let options = MultiTimeStepOptions {
                    ratio: RATIO,
                    fine: Fine::Fixed(vec![fine]),
                    predictor: Predictor::Structured,
                    interpolant: Interpolant::Hermite,
                };
                Box::new(MultiTimeStep::new(&Tableau::rk4(), options, &system)?)
            }
            _ => Box::new(VelocityVerlet),
        };
        integrator.start(&mut system, &mut state);
        let running = Running {
            system,
            state,
            integrator,
        };
        Ok((running, evaluations))
    }
}

/// A body during timing.
struct Running {
    system: System,
    state: State,
    integrator: Box<dyn Integrator>,
}

impl Running {
    /// Returns the time of one of `steps` steps, s.
    fn step(&mut self, steps: usize) -> Result<f64> {
        let begin = Instant::now();
        for _ in 0..steps {
            let next = self.state.t + DT;
            self.integrator
                .step(&mut self.system, &mut self.state, next, Interrupt::never())?;
        }
        Ok(begin.elapsed().as_secs_f64() / steps as f64)
    }

    /// Returns the time of one of `count` force evaluations, s.
    fn force(&mut self, count: usize, out: &mut [f64]) -> f64 {
        let begin = Instant::now();
        for _ in 0..count {
            let (t, u) = (self.state.t, &self.state.u);
            self.system.free_acceleration(t, u, &PointSubset::All, out);
        }
        begin.elapsed().as_secs_f64() / count as f64
    }
}

/// Creates a sphere of a subdivided icosahedron, with a horizon of about three edges.
fn sphere(level: usize) -> Result<(System, State)> {
    let surface = Surface::icosphere(level as u32, 1.0)?;
    let horizon = 3.5 / f64::from(1u32 << level);
    let pairs = geodesic_pairs(&surface, horizon, GeodesicMethod::Edge)?;
    let cloud = Arc::new(surface.points(surface.vertex_areas(AreaRule::Barycentric))?);
    let material = PowerMaterial {
        density: 1.0,
        kappa: 1.0,
        alpha: 0.25,
        p: 2.0,
        horizon,
        bond: SurfaceBond::Displacement,
        self_interaction: false,
        critical_stretch: f64::INFINITY,
    };
    let body = SurfaceBody {
        surface: &surface,
        cloud: &cloud,
        pairs: &pairs,
        material: &material,
        stiffness: &[],
        no_fail: &[],
    };
    let force = body.operator()?;
    let mut state = State::at_rest(3 * cloud.len());
    for (k, v) in state.v.iter_mut().enumerate() {
        *v = 1e-3 * (k as f64).sin();
    }
    Ok((System::new(cloud, force, PointScalar::Uniform(1.0))?, state))
}

/// Times small bodies on thread pools, in alternation over `rounds` rounds after a warm-up round; the median is
/// reported. The force is timed on the first pool. Bodies of more than `largest` points are left out. Calls `report` after
/// each body.
///
/// # Errors
/// Returns an error of the engine, and that of `report`.
pub fn small_bodies<E: From<pericles::PericlesError>>(
    pools: &[rayon::ThreadPool],
    rounds: usize,
    largest: usize,
    report: &mut dyn FnMut(SmallTiming) -> std::result::Result<(), E>,
) -> std::result::Result<(), E> {
    for body in SmallBody::ALL {
        for size in body.sizes() {
            let (mut running, evaluations) = body.create(&size)?;
            let points = running.system.points();
            if points > largest {
                // Sizes ascend.
                break;
            }
            let mut out = vec![0.0; running.state.u.len()];
            let estimate = pools[0].install(|| running.step(1))?;
            let steps = ((ROUND / estimate) as usize).clamp(1, 10_000);
            let evaluated = (steps as f64 * evaluations) as usize;
            let mut times = vec![Vec::new(); pools.len() + 1];
            for round in 0..=rounds {
                let force = pools[0].install(|| running.force(evaluated, &mut out));
                let mut found = vec![force];
                for pool in pools {
                    found.push(pool.install(|| running.step(steps))?);
                }
                if round > 0 {
                    times
                        .iter_mut()
                        .zip(found)
                        .for_each(|(times, time)| times.push(time));
                }
            }
            let per_point = |times: &mut Vec<f64>| {
                times.sort_by(f64::total_cmp);
                1e9 * times[times.len() / 2] / points as f64
            };
            let mut times = times.iter_mut().map(per_point);
            report(SmallTiming {
                body: body.name(),
                points,
                force_ns: times.next().unwrap_or(f64::NAN),
                evaluations,
                step_ns: times.collect(),
            })?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_bodies_are_timed_and_evaluations_follow_from_the_scheme() {
        let pools = [1, 2].map(|count| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(count);
            pool.build().unwrap()
        });
        let mut found = Vec::new();
        small_bodies::<pericles::PericlesError>(&pools, 1, 200, &mut |timing| {
            found.push(timing);
            Ok(())
        })
        .unwrap();
        let evaluations = |name: &str| {
            let timing = found.iter().find(|timing| timing.body == name).unwrap();
            assert!(timing.points <= 200 && timing.force_ns > 0.0);
            assert!(timing.step_ns.len() == 2 && timing.step_ns.iter().all(|&ns| ns > 0.0));
            timing.evaluations
        };
        assert_eq!(evaluations("plate-verlet"), 1.0);
        assert_eq!(evaluations("plate-rk4"), 4.0);
        // 16 of 100 points take eight steps.
        assert!((evaluations("plate-multirate-rk4") - 4.0 * 2.12).abs() < 1e-12);
        assert_eq!(evaluations("sphere-verlet"), 1.0);
    }
}
