//! The experiment of Kalthoff and Winkler with several projectiles.

use std::sync::Arc;

use pericles::observe::CrackTracker;
use pericles_contact::Impactor;
use pericles_run::{Resources, RunError, build};

use crate::common::watch;
use crate::data::{Case, Found};
use crate::decks::deck;

/// Position of the tips of the notches, m.
const NOTCH: [f64; 2] = [0.05, 0.025];
/// Window in which the struck edge is measured, s.
const WINDOW: [f64; 2] = [2e-6, 20e-6];
/// Damage above which a point belongs to a crack.
const THRESHOLD: f64 = 0.35;

/// Mean velocity of the struck edge, angle of the cracks to the notches, broken bonds, dissipated energy per thickness, final
/// velocity of the projectile, and error of the energy balance.
pub(super) fn projectile(case: &Case<'_>) -> Result<Found, RunError> {
    let deck = deck(case, &[])?;
    let assembly = build(&deck, &Resources::default())?;
    let cloud = Arc::clone(&assembly.cloud);
    let tracker = CrackTracker::new(&cloud, assembly.cracks.clone(), THRESHOLD)?;
    let n = cloud.len();
    let [x, y] = [cloud.axis(0), cloud.axis(1)];
    let struck = |&i: &usize| (0.0..cloud.spacing()).contains(&x[i]) && y[i].abs() < NOTCH[1];
    let edge: Vec<usize> = (0..n).filter(struck).collect();
    let block: Vec<usize> = (0..n).filter(|&i| x[i] < 0.0).collect();
    let mean = |v: &[f64], of: &[usize]| of.iter().map(|&i| v[i]).sum::<f64>() / of.len() as f64;
    let mut run = assembly.simulation()?;
    let mut speeds = Vec::new();
    watch(&mut run, |now| {
        if (WINDOW[0]..=WINDOW[1]).contains(&now.state().t) {
            speeds.push(mean(&now.state().v, &edge));
        }
    })?;
    let mut damage = vec![0.0; n];
    run.system().operator().damage_into(&mut damage);
    let tips = tracker.tips(&cloud, &damage);
    let angle = |[x, y, _]: [f64; 3]| (y.abs() - NOTCH[1]).atan2(x - NOTCH[0]).to_degrees();
    let angles: Vec<f64> = tips.iter().flatten().map(|tip| angle(tip.place)).collect();
    let mut rigid = run.system().interactions();
    let rigid = rigid.find_map(|one| one.downcast_ref::<Impactor>());
    let end = match rigid {
        Some(impactor) => Some(impactor.reading().velocity[0]),
        None => (!block.is_empty()).then(|| mean(&run.state().v, &block)),
    };
    let energies = run.snapshot().energies();
    let supplied = energies.initial + energies.work;
    Ok(Found::default()
        .value("edge", speeds.iter().sum::<f64>() / speeds.len() as f64)
        .value("angle", angles.iter().copied().reduce(f64::min))
        .value("largest angle", angles.iter().copied().reduce(f64::max))
        .value("bonds", run.system().operator().broken_bonds() as f64)
        .value("dissipated", energies.dissipated)
        .value("end", end)
        .value("balance", energies.balance().abs() / supplied))
}
