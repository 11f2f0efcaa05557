//! Runs of the presets, and quantities recorded at every step.

use std::f64::consts::TAU;
use std::rc::Rc;

use pericles::observe::Field;
use pericles::{Control, Simulation};
use pericles_io::observers::PictureOf;
use pericles_manifold::{SurfaceMeasure, SurfaceReading};
use pericles_run::{Resources, RunError, build};

use crate::common::largest;
use crate::data::{Case, Found};
use crate::decks::deck;

/// Quantities recorded at every step of a run.
#[derive(Default)]
struct Course {
    t: Vec<f64>,
    /// Relative change of area S/S₀ − 1.
    stretch: Vec<f64>,
    kinetic: Vec<f64>,
    elastic: Vec<f64>,
    /// Inner iterations of the step; none before the first.
    iterations: Vec<f64>,
    /// Measures at the steps `readings`.
    readings: Vec<SurfaceReading>,
    /// Number of loaded points.
    loaded: usize,
    /// Largest displacement at the end.
    displacement: f64,
}

impl Course {
    /// Deck of the case with overrides.
    fn of(case: &Case<'_>, changes: &[String]) -> Result<Rc<Self>, RunError> {
        let readings = match case.flag("readings") {
            true => &READINGS[..],
            false => &[],
        };
        let [file, set] = [case.text("deck")?, format!("{:?}", case.texts("set")?)];
        case.once(
            format!("course {file} {set} {changes:?} {readings:?}"),
            || Self::run(case, changes, readings),
        )
    }

    fn run(case: &Case<'_>, changes: &[String], readings: &[u64]) -> Result<Self, RunError> {
        let assembly = build(&deck(case, changes)?, &Resources::default())?;
        let surface = assembly.surface.clone();
        let measure = surface.clone().map(SurfaceMeasure::new);
        let mut simulation = assembly.simulation()?;
        let mut course = Self::default();
        course.see(&simulation, measure.as_ref());
        let mut trouble = None;
        let look = |course: &mut Self, run: &Simulation| -> Result<(), RunError> {
            course.see(run, measure.as_ref());
            let step = run.state().step;
            let (Some(measure), true) = (&measure, readings.contains(&step)) else {
                return Ok(());
            };
            course.readings.push(measure.read(&run.snapshot()));
            let Some(path) = case.context.figure(&format!("energy-{step}-ms.png")) else {
                return Ok(());
            };
            let picture = PictureOf {
                title: "elastic energy density, p = 5".into(),
                surface: surface.clone(),
                ..PictureOf::new(Field::StrainEnergyDensity)
            };
            Ok(picture.draw(&run.snapshot(), path)?)
        };
        simulation
            .run(|run| match look(&mut course, run) {
                Ok(()) => Control::Continue,
                Err(error) => {
                    trouble = Some(error);
                    Control::Stop
                }
            })
            .map_err(RunError::Simulation)?;
        // The observer is not called after the last step.
        course.see(&simulation, measure.as_ref());
        let loads = simulation.system().loads().iter();
        course.loaded = loads.map(|load| load.points.len()).sum();
        course.displacement = largest(&simulation.state().u);
        trouble.map_or(Ok(course), Err)
    }

    fn see(&mut self, run: &Simulation, measure: Option<&SurfaceMeasure>) {
        let energies = run.snapshot().energies();
        self.t.push(run.state().t);
        let stretch = measure.map_or(f64::NAN, |measure| measure.stretch(&run.state().u));
        self.stretch.push(stretch);
        self.kinetic.push(energies.kinetic);
        self.elastic.push(energies.elastic);
        if run.state().step > 0 {
            let inner = run.integrator().inner_iterations().unwrap_or_default();
            self.iterations.push(inner.last as f64);
        }
    }

    /// Value at the step nearest to a time.
    fn at(&self, t: f64, values: &[f64]) -> f64 {
        let after = self.t.partition_point(|&x| x < t - 1e-9);
        values[after.min(values.len() - 1)]
    }

    /// Energy spread (max E − min E)/E(0).
    fn energy_spread(&self) -> f64 {
        let total = |k: usize| self.kinetic[k] + self.elastic[k];
        let (mut low, mut high) = (total(0), total(0));
        for k in 0..self.t.len() {
            low = low.min(total(k));
            high = high.max(total(k));
        }
        (high - low) / total(0)
    }
}

/// Share of the variance of a signal that the best sinusoid about an offset explains.
fn sinusoid(t: &[f64], values: &[f64]) -> f64 {
    const FREQUENCIES: usize = 2000;
    let span = t[t.len() - 1] - t[0];
    let middle = mean(values);
    let square: f64 = values.iter().map(|x| (x - middle).powi(2)).sum();
    let rest = |omega: f64| {
        // Normal equations of 1, cos ωt and sin ωt.
        let mut matrix = nalgebra::Matrix3::zeros();
        let mut right = nalgebra::Vector3::zeros();
        for (t, x) in t.iter().zip(values) {
            let (sine, cosine) = (omega * t).sin_cos();
            let row = nalgebra::Vector3::new(1.0, cosine, sine);
            matrix += row * row.transpose();
            right += row * (x - middle);
        }
        let fit = matrix.lu().solve(&right);
        fit.map_or(square, |fit| square - fit.dot(&right))
    };
    // From half a period in the signal to one hundred, in steps of a twentieth of a period.
    let periods = (10..FREQUENCIES).map(|k| 0.05 * k as f64);
    let least = periods.map(|count| rest(TAU * count / span));
    1.0 - least.fold(square, f64::min) / square
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Steps at which localisation is measured if `readings` is set.
const READINGS: [u64; 3] = [150, 300, 700];

/// Results of a run: over its whole length, over its second half, from time `from` on, at time `at`, and at the
/// `reading` with this number.
pub(super) fn run(case: &Case<'_>) -> Result<Found, RunError> {
    let course = Course::of(case, &[])?;
    let most = |values: &[f64], least: f64| values.iter().copied().fold(least, f64::max);
    let half = &course.stretch[course.stretch.len() / 2..];
    let middle = mean(half);
    let square: Vec<f64> = half.iter().map(|x| (x - middle).powi(2)).collect();
    let mut found = Found::from([
        ("peak", most(&course.stretch, f64::NEG_INFINITY)),
        ("spread", course.energy_spread()),
        ("most iterations", most(&course.iterations, 0.0)),
        ("mean", mean(&course.iterations)),
        ("middle", middle),
        ("variation", mean(&square).sqrt() / middle.abs()),
        ("loaded", course.loaded as f64),
    ])
    .curve("stretch", &course.t, &course.stretch)
    .curve("iterations", &course.t[1..], &course.iterations)
    .labelled("energy", Some("kinetic".into()), &course.t, &course.kinetic)
    .labelled("energy", Some("elastic".into()), &course.t, &course.elastic);
    if case.has("p") {
        found = found.value("sinusoid", sinusoid(&course.t, &course.stretch));
    }
    if let Some(t) = case.optional("at") {
        let kinetic = course.at(t, &course.kinetic) / course.kinetic[0];
        found = found
            .value("stretch", course.at(t, &course.stretch))
            .value("kinetic", kinetic);
    }
    if let Some(from) = case.optional("from") {
        let pairs = course.t.iter().zip(&course.stretch);
        let late: Vec<f64> = pairs
            .filter(|(t, _)| **t >= from)
            .map(|(_, s)| *s)
            .collect();
        found = found.value("late", mean(&late));
    }
    if let Some(number) = case.optional("reading") {
        let reading = course.readings.get(number as usize);
        found = found.value("localisation", reading.map(|reading| reading.localisation));
        if let Some(reading) = reading {
            found = found
                .value("zones", reading.zones.len() as f64)
                .value("share", 100.0 * reading.top_share);
        }
    }
    Ok(found)
}

/// Ratio of the energy spread to that with half the step `dt`.
pub(super) fn half_step(case: &Case<'_>) -> Result<Found, RunError> {
    let dt = case.number("dt")?;
    let spread = |dt: f64| -> Result<f64, RunError> {
        Ok(Course::of(case, &[format!("time.dt={dt}")])?.energy_spread())
    };
    let coarse = spread(dt)?;
    Ok([("spread", coarse), ("ratio", coarse / spread(0.5 * dt)?)].into())
}

/// Ratio of the displacement to that with the overrides `weaker`.
pub(super) fn linearity(case: &Case<'_>) -> Result<Found, RunError> {
    let weaker = Course::of(case, &case.texts("weaker")?)?;
    Ok((Course::of(case, &[])?.displacement / weaker.displacement).into())
}
