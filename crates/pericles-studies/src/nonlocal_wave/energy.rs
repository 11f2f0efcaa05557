//! Figures 1 and 2: effect of the schemes on the pulse on the line and on its energy.

use pericles::System;
use pericles::boundary::{Load, TimeFunction};
use pericles::observe::{Snapshot, StartEnergy};
use pericles::time::{Integrator, State};
use pericles_manifold::EnergyInequality;
use pericles_run::RunError;

use super::line::{Method, UNIT, integrator, march, nodes, pulse, system};
use crate::common::difference;
use crate::data::{Case, Found};

/// Figure 1: asymmetry of the pulse with MSV on the finite domain, until waves reach its ends.
pub(super) fn pulse_on_line(_: &Case<'_>) -> Result<Found, RunError> {
    const H: f64 = 0.1;
    let cloud = nodes(Method::Msv, H)?;
    let mut system = system(&cloud, &UNIT.material())?;
    let mut scheme = integrator(Method::Msv, H, &system)?;
    let mut state = pulse(&cloud);
    let x = cloud.axis(0);
    let mut shown = vec![("t = 0".to_owned(), state.u.clone())];
    let mut asymmetry = 0.0f64;
    march(&mut system, &mut *scheme, &mut state, H, 300, |_, state| {
        if state.step.is_multiple_of(60) {
            shown.push((format!("t = {}", state.step / 10), state.u.clone()));
        }
        let mirrored: Vec<f64> = state.u.iter().rev().copied().collect();
        asymmetry = difference(&state.u, &mirrored).max(asymmetry);
    })?;
    let draw =
        |found: Found, (label, u): (String, Vec<f64>)| found.labelled("line", Some(label), x, &u);
    Ok(shown.into_iter().fold(asymmetry.into(), draw))
}

/// Largest deviation of the paper's E_n = ½ V·V + ½ U·AU from its initial value; the drift of the energy that the
/// scheme conserves; the initial energy, and its closed form for the line, (E U² L²/l²) √π [√2/L − 1/√(L²/2 +
/// l²/4)].
pub(super) fn energy(case: &Case<'_>) -> Result<Found, RunError> {
    let (method, h) = (Method::of(case)?, case.number("h")?);
    let cloud = nodes(method, h)?;
    let mut system = system(&cloud, &UNIT.material())?;
    let mut scheme = integrator(method, h, &system)?;
    let mut state = pulse(&cloud);
    scheme.start(&mut system, &mut state);
    let physical = |system: &System, state: &State| {
        system.kinetic_energy(&state.v) + system.operator().energy(state.t, &state.u)
    };
    // For ρ = 1 the paper's sum differs by the node volume only.
    let volume = cloud.volumes()[0];
    let before = physical(&system, &state);
    let correction = |scheme: &dyn Integrator, system: &System, state: &State| {
        physical(system, state) + scheme.energy_correction(system, state, h)
    };
    let kept_before = correction(&*scheme, &system, &state);
    let steps = (30.0 / h).round() as usize;
    let (mut t, mut paper) = (Vec::new(), Vec::new());
    march(
        &mut system,
        &mut *scheme,
        &mut state,
        h,
        steps,
        |system, state| {
            t.push(state.t);
            paper.push((physical(system, state) - before) / volume);
        },
    )?;
    let farther = |m: f64, x: &f64| if x.abs() > m.abs() { *x } else { m };
    let closed = std::f64::consts::PI.sqrt() * (2.0f64.sqrt() - 1.0 / 0.75f64.sqrt());
    Ok(Found::from([
        ("paper", paper.iter().fold(0.0, farther)),
        (
            "drift",
            correction(&*scheme, &system, &state) / kept_before - 1.0,
        ),
        ("start", before),
        ("closed", closed),
    ])
    .curve("energy", &t, &paper))
}

/// Under a load of finite duration: the largest ratio of the energy to its bound e(0) exp(νt) + 1/(2νρ) ∫ exp(ν(t−s))
/// ‖b‖² ds after the start, where both are equal.
pub(super) fn inequality(case: &Case<'_>) -> Result<Found, RunError> {
    const END: f64 = 8.0;
    let (method, dt, h) = (Method::of(case)?, case.number("dt")?, 0.1);
    let cloud = nodes(method, h)?;
    let mut body = system(&cloud, &UNIT.material())?;
    let middle = (0..cloud.len() as u32).filter(|&i| cloud.axis(0)[i as usize].abs() < 1.0);
    let pulse_of_load = TimeFunction::Pulse {
        start: 0.0,
        duration: 4.0,
    };
    body.add_load(Load::new(middle.collect(), [0.5, 0.0, 0.0], pulse_of_load))?;
    let mut scheme = integrator(method, h, &body)?;
    let mut state = pulse(&cloud);
    let mut inequality = EnergyInequality::new(1.0 / END);
    let start = StartEnergy {
        energy: body.operator().energy(0.0, &state.u),
        ..StartEnergy::default()
    };
    let (mut t, mut energy) = (vec![0.0], vec![start.energy]);
    let mut bound = vec![inequality.bound(&Snapshot::new(&body, &state, start, 0.0))];
    let steps = (END / dt).round() as usize;
    march(
        &mut body,
        &mut *scheme,
        &mut state,
        dt,
        steps,
        |body, state| {
            let snapshot = Snapshot::new(body, state, start, 0.0);
            let energies = snapshot.energies();
            t.push(state.t);
            energy.push(energies.kinetic + energies.elastic);
            bound.push(inequality.bound(&snapshot));
        },
    )?;
    let pairs = energy.iter().zip(&bound).skip(1);
    let nearest = pairs.map(|(e, bound)| e / bound).fold(0.0, f64::max);
    Ok(Found::from(nearest)
        .curve("loaded", &t, &energy)
        .curve("bound", &t, &bound))
}
