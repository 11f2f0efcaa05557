//! Loads and motions whose values are computed for all points at once.

use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use pericles::boundary::{
    AxisMotion, FieldFunction, Load, LoadDensity, MotionKind, PointValues, PrescribedMotion,
    TimeFunction, Trajectory,
};
use pericles::prelude::*;
use pericles::time::{Implicit, ImplicitRule, RungeKutta, Tableau};

/// The same field as a function of a point and as values of all points.
#[derive(Debug)]
struct Wave {
    size: f64,
    places: Vec<[f64; 3]>,
    calls: AtomicUsize,
}

const RATE: f64 = 3e4;

impl Wave {
    fn component(c: usize, place: [f64; 3], order: usize, t: f64) -> f64 {
        let size = [1.0, -0.5, 0.0][c] * (1.0 + 20.0 * place[0]);
        let phase = RATE * t + 0.5 * std::f64::consts::PI * order as f64;
        size * RATE.powi(order as i32) * phase.sin()
    }
}

impl PointValues for Wave {
    fn len(&self) -> usize {
        2 * self.places.len()
    }

    fn at(&self, order: usize, t: f64, read: &mut dyn FnMut(&[f64])) {
        self.calls.fetch_add(1, Ordering::Relaxed);
        let component = |c: usize| {
            let places = self.places.iter();
            places.map(move |&place| self.size * Self::component(c, place, order, t))
        };
        read(&component(0).chain(component(1)).collect::<Vec<f64>>());
    }
}

/// Values whose evaluation fails once, at the first time after a given one, and then records the failure.
#[derive(Debug)]
struct Failing {
    values: Arc<Wave>,
    after: f64,
    state: AtomicUsize,
}

impl Failing {
    const READY: usize = 0;
    const FAILED: usize = 1;
    const MENDED: usize = 2;
}

impl PointValues for Failing {
    fn len(&self) -> usize {
        self.values.len()
    }

    fn at(&self, order: usize, t: f64, read: &mut dyn FnMut(&[f64])) {
        if t > self.after && self.state.load(Ordering::Relaxed) == Self::READY {
            self.state.store(Self::FAILED, Ordering::Relaxed);
        }
        match self.has_failed() {
            true => read(&vec![f64::NAN; self.len()]),
            false => self.values.at(order, t, read),
        }
    }

    fn can_fail(&self) -> bool {
        true
    }

    fn has_failed(&self) -> bool {
        self.state.load(Ordering::Relaxed) == Self::FAILED
    }
}

#[derive(Debug)]
struct Scaled(f64, usize);

impl FieldFunction for Scaled {
    fn value(&self, c: usize, place: [f64; 3], t: f64) -> f64 {
        self.0 * Wave::component(c, place, 0, t)
    }
}

impl Trajectory for Scaled {
    fn derivative(&self, order: usize, place: [f64; 3], t: f64) -> f64 {
        self.0 * Wave::component(self.1, place, order, t)
    }
}

/// Largest force density of the load, N/m³, and displacement of the edge, m, up to a factor of 1.4.
const LOAD: f64 = 1e9;
const EDGE: f64 = 1e-6;

fn wave(size: f64, cloud: &PointCloud, points: &[u32]) -> Arc<Wave> {
    let places = points.iter().map(|&i| cloud.point(i as usize)).collect();
    let calls = AtomicUsize::new(0);
    Arc::new(Wave {
        size,
        places,
        calls,
    })
}

/// A plate with a load on its right half and a prescribed displacement on its left edge.
fn plate(at_once: bool) -> System {
    plate_of(at_once, |values, _| values)
}

/// The same; `wrap` may replace the values of all points of the load (true) and of the displacement (false).
fn plate_of(
    at_once: bool,
    mut wrap: impl FnMut(Arc<Wave>, bool) -> Arc<dyn PointValues>,
) -> System {
    let cloud = Grid::plate([0.02, 0.01], 1e-3, 1e-3).points().unwrap();
    let glass = BondMaterial::new(ElasticModulus::Young(70e9), 2500.0, 3.015e-3);
    let pick = |right: bool| -> Vec<u32> {
        let chosen = |&i: &u32| match right {
            true => cloud.point(i as usize)[0] > 0.01,
            false => cloud.point(i as usize)[0] < 1e-3,
        };
        (0..cloud.len() as u32).filter(chosen).collect()
    };
    let (loaded, moved) = (pick(true), pick(false));
    let places = |points: &[u32]| points.iter().map(|&i| cloud.point(i as usize)).collect();
    let density = match at_once {
        true => LoadDensity::Values(wrap(wave(LOAD, &cloud, &loaded), true)),
        false => LoadDensity::Field {
            field: Arc::new(Scaled(LOAD, 0)),
            factor: 1.0,
            places: places(&loaded),
        },
    };
    let values = wrap(wave(EDGE, &cloud, &moved), false);
    let along = |c: usize| match at_once {
        true => AxisMotion::Values(values.clone()),
        false => AxisMotion::Trajectory {
            trajectory: Arc::new(Scaled(EDGE, c)),
            places: places(&moved),
        },
    };
    let along = [Some(along(0)), Some(along(1)), None];
    let (n, load) = (
        cloud.len(),
        Load::new(loaded, density, TimeFunction::Constant),
    );
    let motion = PrescribedMotion::along(
        "edge".into(),
        moved,
        MotionKind::Displacement,
        along,
        TimeFunction::Constant,
        &vec![0.0; 2 * n],
        n,
    );
    let mut system = Body::new(cloud, glass)
        .stress_state(StressState::PlaneStress)
        .build()
        .unwrap();
    system.add_load(load).unwrap();
    system.add_motion(motion.unwrap()).unwrap();
    system
}

#[test]
fn values_of_all_points_equal_the_same_field_point_by_point() {
    let run = |at_once: bool, implicit: bool| {
        let builder = Simulation::builder(plate(at_once)).steps(40);
        let mut simulation = match implicit {
            false => builder.build().unwrap(),
            true => {
                let made =
                    builder.scheme_for(|system| Implicit::new(ImplicitRule::Midpoint, system));
                made.unwrap().dt(2e-7).build().unwrap()
            }
        };
        simulation.run_to_end().unwrap();
        let energies = simulation.snapshot().energies();
        (simulation.state().u.clone(), energies.work)
    };
    for implicit in [false, true] {
        let (values, pointwise) = (run(true, implicit), run(false, implicit));
        assert!(values.0.iter().any(|u| u.abs() > 1e-9));
        assert_eq!(values, pointwise);
    }
}

const SCHEMES: [&str; 3] = ["velocity-verlet", "rk4", "midpoint"];

fn simulation(scheme: &str, system: System) -> Simulation {
    let builder = Simulation::builder(system).steps(40);
    let built = match scheme {
        "velocity-verlet" => builder.build(),
        "rk4" => {
            let rk4 = |system: &System| Ok(RungeKutta::new(&Tableau::rk4(), system));
            builder.scheme_for(rk4).unwrap().build()
        }
        _ => {
            let midpoint = |system: &System| Implicit::new(ImplicitRule::Midpoint, system);
            builder.scheme_for(midpoint).unwrap().dt(2e-7).build()
        }
    };
    built.unwrap()
}

/// A step in which an evaluation fails is undone, and the run continues from there as if nothing had happened.
#[test]
fn a_step_with_a_failed_evaluation_is_undone() {
    const LAST: u64 = 17;
    for scheme in SCHEMES {
        let mut whole = simulation(scheme, plate(true));
        let dt = whole.dt();
        whole.run_to_end().unwrap();
        for of_load in [true, false] {
            let mut made = None;
            let system = plate_of(true, |values, is_load| {
                if is_load != of_load {
                    return values;
                }
                let failing = Arc::new(Failing {
                    values,
                    after: (LAST as f64 + 0.1) * dt,
                    state: AtomicUsize::new(Failing::READY),
                });
                made = Some(Arc::clone(&failing));
                failing
            });
            let (failing, mut part) = (made.unwrap(), simulation(scheme, system));
            assert_eq!(part.run_to_end().unwrap(), Outcome::Stopped);
            assert!(failing.has_failed());
            assert_eq!(part.state().step, LAST, "{scheme}");
            failing.state.store(Failing::MENDED, Ordering::Relaxed);
            assert_eq!(part.run_to_end().unwrap(), Outcome::Finished);
            assert_eq!(part.state().u, whole.state().u, "{scheme}");
            let (a, b) = (part.snapshot().energies(), whole.snapshot().energies());
            assert_eq!(a.work.to_bits(), b.work.to_bits(), "{scheme}");
        }
    }
}

/// Distinct times at which a load is evaluated.
#[derive(Debug)]
struct Timed(Arc<Wave>, Mutex<BTreeSet<u64>>);

impl PointValues for Timed {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn at(&self, order: usize, t: f64, read: &mut dyn FnMut(&[f64])) {
        self.1.lock().unwrap().insert(t.to_bits());
        self.0.at(order, t, read);
    }
}

/// Velocity Verlet uses loads at the ends of steps only, the others also in the middle. No value is computed for the
/// energy balance alone.
#[test]
fn values_are_computed_for_the_times_of_the_scheme() {
    for (scheme, times) in SCHEMES.into_iter().zip([41, 81, 81]) {
        let mut made = None;
        let system = plate_of(true, |values, is_load| {
            let timed = Arc::new(Timed(values, Mutex::default()));
            if is_load {
                made = Some(Arc::clone(&timed));
            }
            timed
        });
        simulation(scheme, system).run_to_end().unwrap();
        assert_eq!(made.unwrap().1.lock().unwrap().len(), times, "{scheme}");
    }
}

#[test]
fn values_of_a_wrong_length_are_rejected() {
    let cloud = Grid::plate([0.01, 0.01], 1e-3, 1e-3).points().unwrap();
    let glass = BondMaterial::new(ElasticModulus::Young(70e9), 2500.0, 3.015e-3);
    let short = LoadDensity::Values(wave(LOAD, &cloud, &[0, 1]));
    let load = Load::new(vec![0, 1, 2], short, TimeFunction::Constant);
    let mut system = Body::new(cloud, glass)
        .stress_state(StressState::PlaneStress)
        .build()
        .unwrap();
    let error = system.add_load(load).unwrap_err().to_string();
    assert!(error.contains("the values of a load"), "{error}");
}
