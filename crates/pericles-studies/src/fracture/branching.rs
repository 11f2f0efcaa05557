//! Notched plate under tension from two sides: the crack propagates and branches.

use pericles::material::ElasticWaves;
use pericles::space::PointCloud;
use pericles_run::{MaterialConstants, RunError};

use super::front::{groups, slopes, widest_gap};
use super::record::{Look, Recorded, Symmetry, record};
use crate::data::{Case, Found};
use crate::decks::deck;

/// Length of the plate, m.
const LENGTH: f64 = 0.1;
/// End of the notch, m.
const NOTCH: f64 = 0.05;
/// Distance of two arms that counts as branching, m.
const APART: f64 = 3e-3;
/// Position at which the crack propagation ends, m.
const ARRIVAL: f64 = 98e-3;
/// Time window of speeds, s.
const WINDOW: f64 = 5e-6;

/// Runs the deck and measures the path of the crack, symmetry and energy.
pub(super) fn branching(case: &Case<'_>) -> Result<Found, RunError> {
    let symmetry = |cloud: &_| {
        let columns = (LENGTH / PointCloud::spacing(cloud)).round() as usize;
        Symmetry::up_down(cloud, columns)
    };
    let recorded = record(case, symmetry)?;
    let looks = &recorded.looks;
    let front = looks.iter().map(|look| (look.t, foremost(&recorded, look)));
    let front: Vec<(f64, f64)> = front.collect();
    let branching = looks
        .iter()
        .find_map(|look| Some((look.t, branched(&recorded, look)?)));
    let speeds = slopes(&front, WINDOW);
    let peak = speeds.iter().map(|speed| speed.1).reduce(f64::max);
    let arrival = front.iter().find(|look| look.1 >= ARRIVAL);
    let solid = deck(case, &[])?;
    let constants = recorded.constants.as_ref();
    let young = constants.map(MaterialConstants::young);
    let solid = solid.model.body.solid().zip(young);
    let waves =
        solid.map(|(solid, young)| ElasticWaves::of(young, solid.material.density(), solid.state));
    let transverse = waves.and_then(|waves| waves.transverse);
    let rayleigh = transverse.map_or(f64::NAN, |transverse| transverse.rayleigh);
    // Round-off asymmetry grows without bound once the arms propagate; before branching it must not.
    let before = |look: &&Look| branching.is_none_or(|(t, _)| look.t < t);
    let worst = |of: fn(&Look) -> f64| looks.iter().filter(before).map(of).reduce(f64::max);
    let arms = looks.last().map(|look| arms(&recorded, look, 90e-3) as f64);
    Ok(recorded
        .found(&front, &speeds)
        .value("time", branching.map(|b| b.0))
        .value("x", branching.map(|b| b.1))
        .value("arms", arms)
        .value("peak", peak)
        .value("peak over Rayleigh", peak.map(|v| v / rayleigh))
        .value("Rayleigh", rayleigh)
        .value("arrival", arrival.map(|look| look.0))
        .value("damage defect", worst(|look| look.damage_defect))
        .value(
            "displacement defect",
            worst(|look| look.displacement_defect),
        ))
}

/// Largest x of the crack; before it grows that of the end of the notch.
fn foremost(recorded: &Recorded, look: &Look) -> f64 {
    look.crack
        .iter()
        .map(|&point| recorded.place(point)[0])
        .fold(NOTCH, f64::max)
}

/// Largest x at which two neighbouring arms are far enough apart.
fn branched(recorded: &Recorded, look: &Look) -> Option<f64> {
    let spacing = recorded.spacing();
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

/// Number of arms at x (m).
fn arms(recorded: &Recorded, look: &Look, x: f64) -> usize {
    let spacing = recorded.spacing();
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
