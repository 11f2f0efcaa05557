//! Loads and motions whose values are computed for all points at once.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use pericles::boundary::{
    AxisMotion, FieldFunction, Load, LoadDensity, MotionKind, PointValues, PrescribedMotion,
    TimeFunction, Trajectory,
};
use pericles::prelude::*;
use pericles::time::{Implicit, ImplicitRule};

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
        true => LoadDensity::Values(wave(LOAD, &cloud, &loaded)),
        false => LoadDensity::Field {
            field: Arc::new(Scaled(LOAD, 0)),
            factor: 1.0,
            places: places(&loaded),
        },
    };
    let values = wave(EDGE, &cloud, &moved);
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
