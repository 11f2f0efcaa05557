//! Inclined crack in a square plate under biaxial tension: each tip branches.

use pericles_run::RunError;

use super::front::{arms, slopes};
use super::record::{Look, Recorded, Symmetry, record};
use crate::data::{Case, Found};

/// Centre of the plate, m.
const MIDDLE: f64 = 25e-3;
/// Half length of the pre-crack, m.
const HALF: f64 = 5e-3;
/// Time window of speeds, s.
const WINDOW: f64 = 4e-6;

/// Runs the deck and measures the arms of the crack, symmetry and energy.
pub(super) fn inclined(case: &Case<'_>) -> Result<Found, RunError> {
    let recorded = record(case, Symmetry::half_turn)?;
    let looks = recorded.looks.iter();
    // Point farthest from the centre.
    let front = looks.clone().map(|look| (look.t, reach(&recorded, look)));
    let front: Vec<(f64, f64)> = front.collect();
    let speeds = slopes(&front, WINDOW);
    let last = recorded.looks.last();
    let at = |radius: f64| {
        last.map(|look| arms_at(&recorded, look, radius))
            .unwrap_or_default()
    };
    let mut found = recorded
        .found(&front, &speeds)
        .value("peak", speeds.iter().map(|s| s.1).reduce(f64::max))
        .value("parted", parted(&recorded))
        .value(
            "damage defect",
            looks.map(|l| l.damage_defect).reduce(f64::max),
        );
    for radius in [10, 14, 18, 21] {
        let arms = at(1e-3 * f64::from(radius)).len();
        found = found.value(format!("arms at {radius} mm"), arms as f64);
    }
    let angles = at(18e-3);
    for arm in 0..4 {
        found = found.value(format!("angle {}", arm + 1), angles.get(arm).copied());
    }
    Ok(found)
}

/// Position of a point relative to the centre of the plate.
fn from_middle(recorded: &Recorded, point: u32) -> [f64; 2] {
    recorded.place(point).map(|x| x - MIDDLE)
}

/// Distance of the farthest point of the crack from the centre; before it grows that of the end of the pre-crack.
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
    let spacing = recorded.spacing();
    // A ring one cell diagonal wide contains at least one point of each arm; separate arms have at least three
    // undamaged points between them.
    arms(&points, radius, 1.5 * spacing, 4.0 * spacing)
}

/// Distance beyond the ends of the pre-crack at which four arms exist at the end of the run.
fn parted(recorded: &Recorded) -> Option<f64> {
    let last = recorded.looks.last()?;
    let spacing = recorded.spacing();
    (0..60)
        .map(|k| f64::from(k) * spacing)
        .find(|beyond| arms_at(recorded, last, HALF + beyond).len() == 4)
}
