//! Warnings about velocities that break most bonds instead of forming cracks.

use pericles::operator::PointSubset;
use pericles::time::State;
use pericles::{PericlesError, System};
use pericles_deck::{BuildError, Caution, Fault, KeyPath};

use super::assembler::Assembler;
use super::constants::MaterialConstants;
use super::rejection::at_path;
use super::step::Steps;

/// Initial displacements from a file at which intact bonds are beyond their limits.
#[derive(Debug, thiserror::Error)]
#[error(
    "the displacements of the file stretch intact bonds of {points} of {of} points beyond their limits: the file contains no broken bonds, so that bonds that broke in the run it comes from would be intact and break again at once, with a release of energy; \
     allowed: displacements at which no bond exceeds its limit; represent the crack by [[crack]], or load and release the body in one run"
)]
struct HealedBonds {
    points: usize,
    of: usize,
}

/// Number of times at which prescribed velocities are sampled.
const SAMPLES: usize = 200;

impl Assembler<'_> {
    /// Checks initial displacements from files, which contain neither broken bonds nor internal variables.
    ///
    /// # Errors
    /// Intact bonds beyond their limits: bonds that were broken would be intact again and break at once.
    pub(super) fn check_initial_files(
        &self,
        system: &System,
        state: &State,
    ) -> Result<(), BuildError> {
        let mut initial = self.model.initial.iter();
        let Some(k) = initial.position(|initial| initial.file.is_some()) else {
            return Ok(());
        };
        if system.domain().all(state.u.iter().all(|u| *u == 0.0)) {
            return Ok(());
        }
        let path = KeyPath::from("initial").index(k).key("file");
        if system.operator().capabilities().path_dependent {
            self.warn(&path, Caution::NoHistory);
        }
        match torn(system, &state.u) {
            0 => Ok(()),
            points => {
                let of = system.domain().whole_points();
                let healed = HealedBonds { points, of };
                let error = PericlesError::Extension(Box::new(healed));
                Err(at_path(path, Fault::Model(error)))
            }
        }
    }

    /// Warns of initial and prescribed velocities above the Rayleigh speed, and of velocities that stretch bonds
    /// beyond the critical stretch within the first step, if bonds can break. Static states have no velocities.
    pub(super) fn check_breaking(
        &self,
        system: &System,
        state: &State,
        constants: Option<&MaterialConstants>,
        steps: &Steps,
    ) {
        let dynamic = !self.model.time.scheme.is_static();
        let (Some(solid), Some(constants)) = (self.model.body.solid(), constants) else {
            return;
        };
        if !dynamic || !system.operator().can_break() {
            return;
        }
        let density = solid.material.density();
        let waves = constants.waves(density, solid.state);
        let limit = waves.transverse.map_or(waves.pressure, |t| t.rayleigh);
        let first = |key: &str| KeyPath::from(key).index(0);
        // Velocities relative to the mean: a translation of the whole body breaks no bonds.
        let speed = largest_relative_speed(system, &state.v);
        if speed > limit {
            let caution = fast("initial velocity", speed, limit, system.dimension());
            self.warn(first("initial"), caution);
        }
        for (k, speed) in prescribed_speeds(system, steps).into_iter().enumerate() {
            let points = system.motions()[k].points.len();
            let everywhere = system.domain().all(points == system.points());
            if speed > limit && !everywhere {
                let caution = fast("prescribed motion", speed, limit, system.dimension());
                self.warn(KeyPath::from("constraint").index(k), caution);
            }
        }
        let mut u: Vec<f64> = state.u.clone();
        u.iter_mut()
            .zip(&state.v)
            .for_each(|(u, v)| *u += steps.dt * v);
        let mut torn = torn(system, &u);
        let mut path = first("initial");
        if torn == 0 {
            system.place_on(steps.dt, &PointSubset::All, &mut u);
            torn = self::torn(system, &u);
            path = first("constraint");
        }
        if torn > 0 {
            let caution = Caution::TornAtOnce {
                points: torn,
                of: system.domain().whole_points(),
                dt: steps.dt,
            };
            self.warn(&path, caution);
        }
    }
}

/// Returns the largest speed of each prescribed motion during the run, m/s.
fn prescribed_speeds(system: &System, steps: &Steps) -> Vec<f64> {
    let (n, dimension) = (system.points(), system.dimension());
    let mut largest = vec![0.0f64; system.motions().len()];
    if largest.is_empty() {
        return largest;
    }
    let mut v = vec![0.0; dimension * n];
    for sample in 0..SAMPLES {
        let t = steps.count as f64 * steps.dt * sample as f64 / SAMPLES as f64;
        system.drive_on(t, &PointSubset::All, &mut v);
        for (largest, motion) in largest.iter_mut().zip(system.motions()) {
            let axes: Vec<usize> = motion.axes().collect();
            let square =
                |&i: &u32| -> f64 { axes.iter().map(|c| v[c * n + i as usize].powi(2)).sum() };
            let fastest = motion.points.iter().map(square).fold(0.0, f64::max);
            *largest = largest.max(fastest.sqrt());
        }
    }
    for largest in &mut largest {
        *largest = system.domain().max(*largest);
    }
    largest
}

fn fast(what: &'static str, speed: f64, limit: f64, dimension: usize) -> Caution {
    Caution::FastMotion {
        what,
        speed,
        limit,
        wave: if dimension == 1 {
            "wave speed of the bar"
        } else {
            "Rayleigh speed"
        },
    }
}

/// Returns the number of points of the whole body with bonds beyond the critical stretch.
fn torn(system: &System, u: &[f64]) -> usize {
    let Some(breaking) = system.operator().capabilities().breaking else {
        return 0;
    };
    let mut marks = vec![false; system.points()];
    breaking.mark_endangered(u, 1.0, &mut marks);
    let own = marks.iter().filter(|mark| **mark).count();
    system.domain().count(own as u64) as usize
}

/// Returns the largest speed of a point of the whole body relative to the mean velocity of the points, m/s.
fn largest_relative_speed(system: &System, v: &[f64]) -> f64 {
    let (n, domain) = (system.points(), system.domain());
    let whole = domain.whole_points() as f64;
    let mean = |c: usize| domain.sum(n, |i| v[c * n + i]) / whole;
    let means: Vec<f64> = (0..system.dimension()).map(mean).collect();
    let square = |i: usize| -> f64 {
        let relative = means.iter().zip(0..).map(|(mean, c)| v[c * n + i] - mean);
        relative.map(|x| x.powi(2)).sum()
    };
    domain.max((0..n).map(square).fold(0.0, f64::max).sqrt())
}
