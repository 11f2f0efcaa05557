//! An inclined crack in a square plate pulled on all sides: each tip forks.

use pericles_deck::Deck;
use pericles_io::Axis;
use pericles_run::RunError;

use super::figures::{curve, picture};
use super::front::{arms, slopes};
use super::looks::PAPER;
use super::record::{Look, Recorded, Symmetry, record};
use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(crate) const STUDY: Study = Study {
    id: "fracture/inclined",
    paper: PAPER,
    title: "Inclined crack in a Duran 50 glass plate under biaxial tension",
    run,
};

const DECK: &str = include_str!("../../../../validation/dispersion-and-fracture/inclined.toml");

/// Middle of the plate, m.
const MIDDLE: f64 = 25e-3;
/// Half the length of the pre-crack, m.
const HALF: f64 = 5e-3;
/// Window of speeds, s.
const WINDOW: f64 = 4e-6;

/// An influence function made against dispersion, and what the reference code found.
struct Variant {
    name: &'static str,
    overrides: &'static [&'static str],
    critical_stretch: f64,
    /// Of the first two arms, degrees.
    angles: [f64; 2],
    peak_speed: f64,
}

/// Runs that `--full` adds.
const VARIANTS: [Variant; 2] = [
    Variant {
        name: "positive table tuned against dispersion",
        overrides: &["material.influence={function=\"tuned\",decay=\"none\",lower_bound=0.5}"],
        critical_stretch: 2.621e-3,
        angles: [18.0, 72.0],
        peak_speed: 1892.0,
    },
    Variant {
        name: "influence function of equation 50",
        overrides: &[
            "material.influence={function=\"cosines\",wavenumber=1.1,coefficients=[2.3,2.0,-0.39,-0.48,0.28,0.14,-0.15,-0.02,0.05]}",
            "material.modulus=unmodified",
        ],
        critical_stretch: 2.714e-3,
        angles: [19.0, 71.0],
        peak_speed: 2028.0,
    },
];

/// (t, distance of the farthest point from the middle) and (t, its speed).
fn motion(recorded: &Recorded) -> [Vec<(f64, f64)>; 2] {
    let looks = recorded.looks.iter();
    let front: Vec<(f64, f64)> = looks.map(|look| (look.t, reach(recorded, look))).collect();
    let speeds = slopes(&front, WINDOW);
    [front, speeds]
}

fn run(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let mut rows = original(context)?;
    if context.full {
        for variant in &VARIANTS {
            rows.extend(variant_rows(variant, context)?);
        }
    }
    Ok(rows)
}

fn variant_rows(variant: &Variant, context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let overrides: Vec<String> = variant.overrides.iter().map(|&text| text.into()).collect();
    let deck = Deck::parse(DECK, "inclined.toml", &overrides)?;
    let recorded = record(&deck, Symmetry::half_turn, context)?;
    let row =
        |what: &str, unit, computed| Row::new(format!("{}: {what}", variant.name), unit, computed);
    let [_, speeds] = motion(&recorded);
    let peak = speeds.iter().map(|s| s.1).reduce(f64::max);
    let last = recorded.looks.last();
    let angles = last
        .map(|look| arms_at(&recorded, look, 18e-3))
        .unwrap_or_default();
    let mut rows = vec![
        row("critical stretch", "", recorded.facts.critical_stretch)
            .within_share(variant.critical_stretch, 1e-3),
        row("tips start", "s", recorded.start().map(|look| look.t)).within(6e-6, 1e-6),
        row("arms at radius 18 mm", "", Some(angles.len() as f64)).within(4.0, 0.0),
        row("peak speed", "m/s", peak).within_share(variant.peak_speed, 0.1),
    ];
    for (k, expected) in variant.angles.into_iter().enumerate() {
        let what = format!("angle of arm {} at 18 mm", k + 1);
        rows.push(row(&what, "°", angles.get(k).copied()).within(expected, 6.0));
    }
    Ok(rows)
}

fn original(context: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let deck = Deck::parse(DECK, "inclined.toml", &[])?;
    let recorded = record(&deck, Symmetry::half_turn, context)?;
    let [front, speeds] = motion(&recorded);
    let peak = speeds.iter().map(|s| s.1).reduce(f64::max);
    draw(context, &recorded, &front, &speeds)?;

    let mut rows = vec![
        Row::new("critical stretch", "", recorded.facts.critical_stretch)
            .printed(0.0023)
            .within_share(2.340e-3, 1e-3),
        Row::new("tips start", "s", recorded.start().map(|look| look.t)).within(6e-6, 1e-6),
    ];
    let last = recorded.looks.last();
    let at = |radius: f64| {
        last.map(|look| arms_at(&recorded, look, radius))
            .unwrap_or_default()
    };
    for radius in [10e-3, 14e-3, 18e-3, 21e-3] {
        let case = format!("arms at radius {:.0} mm", 1e3 * radius);
        rows.push(Row::new(case, "", Some(at(radius).len() as f64)).within(4.0, 0.0));
    }
    let angles = at(18e-3);
    for (k, expected) in [20.0, 70.0, 200.0, 250.0].into_iter().enumerate() {
        rows.push(
            Row::new(
                format!("angle of arm {} at 18 mm", k + 1),
                "°",
                angles.get(k).copied(),
            )
            .within(expected, 6.0),
        );
    }
    rows.push(
        Row::new("arms 1 mm apart, beyond the tip", "m", parted(&recorded))
            .note("both tips fork at the tip of the pre-crack; arms less than 1 mm apart are not told apart"),
    );
    rows.push(
        Row::new("peak speed", "m/s", peak)
            .within_share(1780.0, 0.1)
            .note("of the distance of the farthest point from the middle, by a line through 4 µs"),
    );
    let asymmetry = recorded.looks.iter().map(|l| l.damage_defect);
    rows.push(
        Row::new(
            "asymmetry of damage under half a turn",
            "",
            asymmetry.reduce(f64::max),
        )
        .note("largest difference between a point and its image, whole run"),
    );
    rows.extend(recorded.energy_rows());
    Ok(rows)
}

/// A point seen from the middle of the plate.
fn from_middle(recorded: &Recorded, point: u32) -> [f64; 2] {
    recorded.place(point).map(|x| x - MIDDLE)
}

/// The distance of the farthest point of the crack from the middle; that of the pre-crack's end before it grows.
fn reach(recorded: &Recorded, look: &Look) -> f64 {
    look.crack
        .iter()
        .map(|&point| {
            let [x, y] = from_middle(recorded, point);
            x.hypot(y)
        })
        .fold(HALF, f64::max)
}

fn arms_at(recorded: &Recorded, look: &Look, radius: f64) -> Vec<f64> {
    let points: Vec<[f64; 2]> = look
        .crack
        .iter()
        .map(|&point| from_middle(recorded, point))
        .collect();
    let spacing = recorded.facts.spacing;
    // A ring one diagonal wide holds at least one point of each arm; arms apart have at least three points without damage between them.
    arms(&points, radius, 1.5 * spacing, 4.0 * spacing)
}

/// How far beyond the pre-crack's ends there are four arms at the end of the run.
fn parted(recorded: &Recorded) -> Option<f64> {
    let last = recorded.looks.last()?;
    let spacing = recorded.facts.spacing;
    (0..60)
        .map(|k| f64::from(k) * spacing)
        .find(|beyond| arms_at(recorded, last, HALF + beyond).len() == 4)
}

fn draw(
    context: &Context<'_>,
    recorded: &Recorded,
    front: &[(f64, f64)],
    speeds: &[(f64, f64)],
) -> Result<(), RunError> {
    picture(context, recorded, STUDY.title)?;
    let reach = Axis::new("farthest point from the middle", "m");
    curve(context, "tip.png", reach, front)?;
    curve(
        context,
        "speed.png",
        Axis::new("speed of the farthest point", "m/s"),
        speeds,
    )
}
