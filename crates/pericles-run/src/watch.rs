//! The physics watch: warnings about a finished run where a quantity exceeds its threshold.
//!
//! | what | warned of beyond |
//! |---|---|
//! | energy account | [`ENERGY`] of the work done or of the energy at the start, whichever is larger, at any row of the history |
//! | energy balance of static states | [`STATIC_ENERGY`] of the work exchanged or of the energy at the start |
//! | momentum account | [`MOMENTUM`] of the momentum that the energy there was could have made; [`IMPULSE`] of it with supports or two time steps |
//! | loads and reactions of a static state | [`REACTIONS`] of the reactions |
//! | bonds that break in masses, once while the run goes on | [`BROKEN_AT_ONCE`] of the bonds in one step, [`BROKEN_IN_ALL`] in all |
//! | points near breaking, where nothing broke | [`ENDANGERED`] of the points have bonds beyond [`NEAR`] of the critical stretch |
//! | points of correspondence materials that lost all bonds because those that were left did not span the space | any |
//! | breaking within coarse steps | [`COARSE`] of the broken bonds |
//! | displacements of a run that began as its own mirror image | they differ from their image by [`ASYMMETRY`] of the largest |
//!
//! Static states have no momentum. Waves that the grid cannot carry are found before the run (`pericles check`).

use pericles::Simulation;
use pericles::observe::Field;

use crate::audit::Audit;
use crate::units::{percent, quantity, significant};

/// The account closes to 10⁻³ and better with steps near the stable one.
const ENERGY: f64 = 0.01;
/// Of static states: the work between two is exact for linear forces.
const STATIC_ENERGY: f64 = 1e-3;
/// Momentum is exact but for rounding.
const MOMENTUM: f64 = 1e-6;
/// The impulse of supports, and of forces between points with different steps, is that of their values at the ends of steps: an integral by trapezia.
const IMPULSE: f64 = 1e-3;
/// A hundred times the default tolerance of relaxation.
const REACTIONS: f64 = 1e-4;
const NEAR: f64 = 0.9;
const ENDANGERED: f64 = 0.01;
const COARSE: f64 = 0.05;
/// Rounding that did not grow is ten orders below.
const ASYMMETRY: f64 = 1e-6;

/// Share of the bonds that break in one step where a run goes wrong. Cracks break far less; a tube that flies apart in fragments (`examples/fragmentation`) 7 %.
const BROKEN_AT_ONCE: f64 = 0.1;
/// Share of the bonds that break in a run where little is left of the body.
const BROKEN_IN_ALL: f64 = 0.5;

/// Looks out for bonds that break in masses, and warns once.
pub struct Breakage {
    /// Bonds at the start.
    bonds: u64,
    /// Broken at the last step.
    broken: u64,
    warned: bool,
}

impl Breakage {
    /// From a state of a run on.
    pub fn from(simulation: &Simulation) -> Self {
        let operator = simulation.system().operator();
        let (bonds, broken) = (operator.directed_bonds() / 2, operator.broken_bonds());
        // A resumed run has warned before.
        let warned = broken as f64 > BROKEN_IN_ALL * bonds as f64;
        Self {
            bonds,
            broken,
            warned,
        }
    }

    /// Looks at the state after a step.
    pub fn look(&mut self, simulation: &Simulation) -> Option<String> {
        if self.warned {
            return None;
        }
        let broken = simulation.system().operator().broken_bonds();
        let share = |bonds: u64| bonds as f64 / self.bonds.max(1) as f64;
        let (now, all) = (share(broken.saturating_sub(self.broken)), share(broken));
        self.broken = broken;
        let what = if now > BROKEN_AT_ONCE {
            format!("{} of all bonds broke in one step", percent(now))
        } else if all > BROKEN_IN_ALL {
            format!("{} of all bonds have broken", percent(all))
        } else {
            return None;
        };
        self.warned = true;
        let state = simulation.state();
        Some(format!(
            "{what} (step {}, t = {}): the body falls apart in masses, not along cracks; check speeds, loads, fracture energy and their units",
            state.step,
            quantity(state.t, "s")
        ))
    }
}

/// Warnings about a finished run.
pub fn warnings(simulation: &Simulation, audit: &Audit) -> Vec<String> {
    let found = [
        simulation.instability().map(ToString::to_string),
        energy(simulation, audit),
        momentum(simulation, audit),
        reactions(simulation),
        endangered(simulation, audit),
        coarse_breaking(audit),
        dropped(simulation),
        asymmetry(audit),
    ];
    found.into_iter().flatten().collect()
}

/// Points of correspondence materials whose last bonds broke together.
fn dropped(simulation: &Simulation) -> Option<String> {
    let breaking = simulation.system().operator().capabilities().breaking?;
    match breaking.dropped_points() {
        0 => None,
        points => Some(format!(
            "{points} points lost all of their bonds because those that were left did not span the space: they are fragments without stress"
        )),
    }
}

fn energy(simulation: &Simulation, audit: &Audit) -> Option<String> {
    if simulation.integrator().is_static() {
        return static_energy(simulation, audit);
    }
    let scale = audit.external_work.abs().max(audit.initial_energy.abs());
    let drift = audit.largest_balance / scale;
    let advice = simulation
        .integrator()
        .intended_drift()
        .unwrap_or("a smaller time step shows whether results depend on it");
    (drift > ENERGY).then(|| {
        format!(
            "the energy account is off by up to {}: {advice}",
            percent(drift)
        )
    })
}

fn momentum(simulation: &Simulation, audit: &Audit) -> Option<String> {
    if simulation.integrator().is_static() {
        return None;
    }
    let system = simulation.system();
    let mass: f64 = system.masses().iter().sum::<f64>() / system.dimension() as f64;
    // Not what is left: waves may have gone, and static states have none.
    let energy = audit.initial_energy.abs() + system.ledger().exchanged;
    let error = audit.momentum_error / (2.0 * energy * mass).sqrt();
    let by_trapezia =
        !system.motions().is_empty() || simulation.integrator().refinement().is_some();
    let limit = if by_trapezia { IMPULSE } else { MOMENTUM };
    (error > limit).then(|| {
        let cure = if by_trapezia {
            ": a smaller time step sums the impulses better"
        } else {
            ""
        };
        format!(
            "the momentum account is off by {} of what the energy could have made{cure}",
            significant(error, 2)
        )
    })
}

/// Of static states: what the work of loads and supports between them, taken as the mean of their forces at both, misses.
fn static_energy(simulation: &Simulation, audit: &Audit) -> Option<String> {
    if reactions(simulation).is_some() {
        // The states are not static, and that is what is reported.
        return None;
    }
    // Not the work that is left: a body that is unloaded again has none.
    let exchanged = simulation.system().ledger().exchanged;
    let drift = audit.largest_balance / exchanged.max(audit.initial_energy.abs());
    (drift > STATIC_ENERGY).then(|| {
        format!(
            "the energy balance of the static states is off by up to {} of the work done: the work between two states is that of the mean forces. Loads and displacements that grow over \
             more load steps (function = {{ kind = \"ramp\", … }} and time.load_steps) make it more accurate",
            percent(drift)
        )
    })
}

/// Of a static state: loads and reactions together are nothing.
fn reactions(simulation: &Simulation) -> Option<String> {
    let system = simulation.system();
    if !simulation.integrator().is_static() || system.motions().is_empty() {
        return None;
    }
    let snapshot = simulation.snapshot();
    let (n, volumes) = (system.points(), system.cloud().volumes());
    let sum = |field: Field, c: usize| -> f64 {
        let component = &snapshot.field(field)[c * n..(c + 1) * n];
        component
            .iter()
            .zip(volumes)
            .map(|(f, volume)| f * volume)
            .sum()
    };
    // Reactions of opposite supports add up to nothing: their sizes are what to compare with.
    let size: f64 = snapshot
        .field(Field::Reaction)
        .chunks(n)
        .flat_map(|component| component.iter().zip(volumes))
        .map(|(f, volume)| (f * volume).abs())
        .sum();
    let left = (0..system.dimension())
        .map(|c| (sum(Field::Reaction, c) + sum(Field::ExternalForce, c)).abs())
        .fold(0.0, f64::max);
    (left > REACTIONS * size).then(|| {
        format!(
            "loads and reactions differ by {}: a smaller tolerance of the relaxation helps",
            percent(left / size)
        )
    })
}

fn endangered(simulation: &Simulation, audit: &Audit) -> Option<String> {
    let (system, state) = (simulation.system(), simulation.state());
    let operator = system.operator();
    if audit.broken_bonds > 0 || !operator.can_break() {
        return None;
    }
    let mut marks = vec![false; system.points()];
    operator
        .capabilities()
        .breaking?
        .mark_endangered(&state.u, NEAR, &mut marks);
    let share = marks.iter().filter(|mark| **mark).count() as f64 / marks.len() as f64;
    (share > ENDANGERED).then(|| {
        format!(
            "{} of the points have bonds beyond {} of the critical stretch, and none broke: a little more load would break them",
            percent(share),
            percent(NEAR)
        )
    })
}

/// Bonds that break within steps too coarse for them dissipate what they should, but when and which of them break depends on the step.
fn coarse_breaking(audit: &Audit) -> Option<String> {
    let share = audit.coarse_breaks as f64 / audit.broken_bonds.max(1) as f64;
    (share > COARSE).then(|| {
        format!(
            "{} of the broken bonds were stretched from compression, or to more than twice the critical stretch, within one step: a smaller dt shows whether the results depend on it",
            percent(share)
        )
    })
}

fn asymmetry(audit: &Audit) -> Option<String> {
    let lost = audit
        .mirror_errors
        .iter()
        .filter(|mirror| mirror.error > ASYMMETRY);
    let axes: Vec<&str> = lost.clone().map(|mirror| mirror.axis).collect();
    let most = lost.map(|mirror| mirror.error).reduce(f64::max)?;
    Some(format!(
        "the run began as its own mirror image in {} and is none any more: displacements differ by {} of the largest. rounding has grown, as where cracks branch or bodies buckle, \
         or the time steps are small on one side only; which side it is to be is not known",
        axes.join(" and "),
        percent(most)
    ))
}
