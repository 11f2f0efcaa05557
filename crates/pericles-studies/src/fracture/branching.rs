//! A notched plate pulled from both sides: the crack runs and branches.

use pericles::material::ElasticWaves;
use pericles::space::PointCloud;
use pericles_deck::Deck;
use pericles_io::Axis;
use pericles_run::RunError;

use super::figures::{curve, picture};
use super::front::{groups, slopes, widest_gap};
use super::looks::PAPER;
use super::record::{Look, Recorded, Symmetry, record};
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(crate) const STUDY: Study = Study {
    id: "fracture/branching",
    paper: PAPER,
    title: "Crack branching in a soda-lime glass plate",
    run,
};

/// The example's deck is the study's.
const DECK: &str = include_str!("../../../../examples/fracture/branching.toml");

/// Length of the plate, m.
const LENGTH: f64 = 0.1;
/// Where the notch ends, m.
const NOTCH: f64 = 0.05;
/// Distance of two arms that counts as branching, m.
const APART: f64 = 3e-3;
/// Where the run of the crack ends, m.
const ARRIVAL: f64 = 98e-3;
/// Window of speeds, s.
const WINDOW: f64 = 5e-6;

/// A run of the deck with changes, and what the reference code found.
struct Variant {
    name: &'static str,
    overrides: &'static [&'static str],
    start: f64,
    /// Time and x.
    branching: (f64, f64),
    peak_speed: f64,
    arrival: Option<f64>,
}

/// Runs that `--full` adds.
const VARIANTS: [Variant; 5] = [
    Variant {
        name: "positive table tuned against dispersion",
        overrides: &["material.influence={function=\"tuned\",decay=\"none\",lower_bound=0.5}"],
        start: 8e-6,
        branching: (21e-6, 67.9e-3),
        peak_speed: 1664.0,
        arrival: Some(44.5e-6),
    },
    Variant {
        name: "influence function of equation 50",
        overrides: &[
            "material.influence={function=\"cosines\",wavenumber=1.1,coefficients=[2.3,2.0,-0.39,-0.48,0.28,0.14,-0.15,-0.02,0.05]}",
            "material.modulus=unmodified",
        ],
        start: 8.5e-6,
        branching: (22e-6, 68.6e-3),
        peak_speed: 1755.0,
        arrival: Some(44.5e-6),
    },
    Variant {
        name: "printed critical stretch",
        overrides: &["material.critical_stretch=1.3e-3"],
        start: 6e-6,
        branching: (19e-6, 70.6e-3),
        peak_speed: 1791.0,
        arrival: Some(36e-6),
    },
    Variant {
        name: "open end rule",
        overrides: &["crack.0.ends=open"],
        start: 8.5e-6,
        branching: (21e-6, 65.9e-3),
        peak_speed: 1568.0,
        arrival: Some(46e-6),
    },
    Variant {
        name: "open end rule, half the time step",
        overrides: &["crack.0.ends=open", "time.dt=12.5e-9"],
        start: 8.5e-6,
        branching: (21e-6, 66.6e-3),
        peak_speed: 1582.0,
        arrival: None,
    },
];

fn run(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let deck = read(&[])?;
    let recorded = watched(&deck, context)?;
    let course = Course::of(&recorded);
    course.draw(context, &recorded)?;
    let mut rows = base_rows(&deck, &recorded, &course);
    if context.full {
        for variant in &VARIANTS {
            let recorded = watched(&read(variant.overrides)?, context)?;
            rows.extend(variant_rows(variant, &Course::of(&recorded)));
        }
    }
    Ok(rows)
}

fn read(overrides: &[&str]) -> Result<Deck, RunError> {
    let overrides: Vec<String> = overrides.iter().map(|&text| text.into()).collect();
    Ok(Deck::parse(DECK, "branching.toml", &overrides)?)
}

fn watched(deck: &Deck, context: &Context<'_>) -> Result<Recorded, RunError> {
    let symmetry = |cloud: &_| {
        let columns = (LENGTH / PointCloud::spacing(cloud)).round() as usize;
        Symmetry::up_down(cloud, columns)
    };
    record(deck, symmetry, context)
}

/// The crack's way through the plate.
struct Course {
    start: Option<f64>,
    /// Time and x.
    branching: Option<(f64, f64)>,
    /// (t, x) of the foremost point.
    front: Vec<(f64, f64)>,
    /// (t, speed) of the foremost point.
    speeds: Vec<(f64, f64)>,
    arrival: Option<f64>,
}

impl Course {
    fn of(recorded: &Recorded) -> Self {
        let looks = &recorded.looks;
        let front: Vec<(f64, f64)> = looks
            .iter()
            .map(|look| (look.t, foremost(recorded, look)))
            .collect();
        Self {
            start: recorded.start().map(|look| look.t),
            branching: looks
                .iter()
                .find_map(|look| Some((look.t, branched(recorded, look)?))),
            speeds: slopes(&front, WINDOW),
            arrival: front
                .iter()
                .find(|look| look.1 >= ARRIVAL)
                .map(|look| look.0),
            front,
        }
    }

    fn peak_speed(&self) -> Option<f64> {
        self.speeds.iter().map(|speed| speed.1).reduce(f64::max)
    }

    fn draw(&self, context: &Context<'_>, recorded: &Recorded) -> Result<(), RunError> {
        picture(context, recorded, STUDY.title)?;
        let speed = Axis::new("speed of the foremost point", "m/s");
        curve(
            context,
            "tip.png",
            Axis::new("foremost x", "m"),
            &self.front,
        )?;
        curve(context, "speed.png", speed, &self.speeds)
    }
}

fn base_rows(deck: &Deck, recorded: &Recorded, course: &Course) -> Vec<Row> {
    let facts = &recorded.facts;
    let waves = deck.model.body.solid().zip(facts.youngs_modulus);
    let waves =
        waves.map(|(solid, young)| ElasticWaves::of(young, solid.material.density(), solid.state));
    let rayleigh = waves
        .and_then(|waves| waves.transverse)
        .map_or(f64::NAN, |transverse| transverse.rayleigh);
    let peak = course.peak_speed();
    let last = recorded.looks.last();
    let arms = last.map(|look| arms(recorded, look, 90e-3) as f64);
    // The round-off of one half grows without bound once arms run; before branching it must not.
    let before = |look: &&Look| course.branching.is_none_or(|(t, _)| look.t < t);
    let worst = |of: fn(&Look) -> f64| {
        recorded
            .looks
            .iter()
            .filter(before)
            .map(of)
            .reduce(f64::max)
    };
    let mut rows = vec![
        Row::new("critical stretch", "", facts.critical_stretch)
            .printed(0.0013)
            .within_share(1.809e-3, 1e-3)
            .note("the printed value is the formula's over √2 (as for twice the horizon or half the fracture energy); the formula is used"),
        Row::new("tip starts", "s", course.start).within(8e-6, 1e-6),
        Row::new("branching: x", "m", course.branching.map(|b| b.1)).within(65.9e-3, 4e-3),
        Row::new("branching: time", "s", course.branching.map(|b| b.0)).within(21e-6, 2e-6),
        Row::new("arms at x = 90 mm", "", arms).within(2.0, 0.0),
        Row::new("peak speed", "m/s", peak).note("of the foremost point, by a line through 5 µs"),
        Row::new("peak speed over Rayleigh speed", "", peak.map(|v| v / rayleigh))
            .within_share(0.49, 0.1),
        Row::new("Rayleigh speed", "m/s", Some(rayleigh)).within_share(3159.0, 1e-3),
        Row::new("tip reaches 98 mm", "s", course.arrival).within(46e-6, 2e-6),
        Row::new(
            "mirror symmetry of damage before branching",
            "",
            worst(|look| look.damage_defect),
        )
        .within(0.0, 0.0)
        .note("largest difference between a point and its mirror image"),
        Row::new(
            "mirror symmetry of displacement before branching",
            "",
            worst(|look| look.displacement_defect),
        )
        .within(0.0, 1e-9)
        .note("the same over the largest displacement"),
    ];
    rows.extend(recorded.energy_rows());
    rows
}

fn variant_rows(variant: &Variant, course: &Course) -> Vec<Row> {
    let row =
        |what: &str, unit, computed| Row::new(format!("{}: {what}", variant.name), unit, computed);
    let (time, x) = variant.branching;
    let branching = course.branching;
    let mut rows = vec![
        row("tip starts", "s", course.start).within(variant.start, 1e-6),
        row("branching x", "m", branching.map(|b| b.1)).within(x, 4e-3),
        row("branching time", "s", branching.map(|b| b.0)).within(time, 2e-6),
        row("peak speed", "m/s", course.peak_speed()).within_share(variant.peak_speed, 0.1),
    ];
    if let Some(arrival) = variant.arrival {
        rows.push(row("tip reaches 98 mm", "s", course.arrival).within(arrival, 2e-6));
    }
    rows
}

/// The largest x of the crack; that of the notch's end before it grows.
fn foremost(recorded: &Recorded, look: &Look) -> f64 {
    look.crack
        .iter()
        .map(|&point| recorded.place(point)[0])
        .fold(NOTCH, f64::max)
}

/// The foremost x at which two neighbouring arms are far enough apart.
fn branched(recorded: &Recorded, look: &Look) -> Option<f64> {
    let spacing = recorded.facts.spacing;
    let first = (NOTCH / spacing).round() as usize;
    let mut columns = vec![Vec::new(); (LENGTH / spacing).round() as usize];
    for &point in &look.crack {
        let [x, y] = recorded.place(point);
        columns[(x / spacing) as usize].push(y);
    }
    let k = (first..columns.len())
        .rev()
        .find(|&k| widest_gap(&mut columns[k]) >= APART)?;
    Some((k as f64 + 0.5) * spacing)
}

/// The number of arms at x (m).
fn arms(recorded: &Recorded, look: &Look, x: f64) -> usize {
    let spacing = recorded.facts.spacing;
    let mut heights: Vec<f64> = look
        .crack
        .iter()
        .map(|&point| recorded.place(point))
        .filter(|place| (place[0] - x).abs() <= spacing)
        .map(|place| place[1])
        .collect();
    heights.sort_by(f64::total_cmp);
    groups(&heights, APART).len()
}
