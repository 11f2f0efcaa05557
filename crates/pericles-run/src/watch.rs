//! Plausibility checks of a finished run: warnings where a quantity exceeds its threshold.
//!
//! | quantity | threshold |
//! |---|---|
//! | energy balance | [`ENERGY`] of the largest external work or of the initial energy, whichever is larger, in any row of the history |
//! | energy balance of static states | [`STATIC_ENERGY`] of the work exchanged or of the initial energy |
//! | momentum balance | [`MOMENTUM`] of the momentum that corresponds to the energy; [`IMPULSE`] with constraints or multirate schemes |
//! | resultant of loads, reactions and contact forces of a static state | [`REACTIONS`] of their magnitudes, or of the forces during the run if these are larger |
//! | broken bonds, once during the run | [`BROKEN_AT_ONCE`] of the bonds in one step, [`BROKEN_IN_ALL`] in total |
//! | points close to failure in a run without broken bonds | [`ENDANGERED`] of the points have bonds above [`NEAR`] of the critical stretch |
//! | points of correspondence materials that lost all bonds because the remaining ones did not span the space | any |
//! | bonds broken within coarse steps | [`COARSE`] of the broken bonds |
//! | energy balance of multirate schemes | [`ENERGY`] of the dissipated energy, if bonds broke |
//! | load steps of relaxation schemes with inelastic deformation | fewer than [`LOAD_STEPS`] |
//! | energy dissipated by failure | negative, by more than [`CREATED`] of the energy exchanged |
//! | mirror symmetry of a run with symmetric data | displacements deviate from the symmetry by [`ASYMMETRY`] of the largest, by [`STATIC_ASYMMETRY`] in static states without broken bonds |
//!
//! Static states have no momentum. Waves that the grid does not resolve are reported before the run (`pericles check`).

use pericles::Simulation;

use crate::audit::Audit;
use crate::units::{percent, quantity, significant};

/// With steps close to the stable one the energy balance closes to 10⁻³ or better.
const ENERGY: f64 = 0.01;
/// For static states; the work between two states is exact for linear forces.
const STATIC_ENERGY: f64 = 1e-3;
/// Momentum is conserved up to rounding.
const MOMENTUM: f64 = 1e-6;
/// The impulse of constraints, and of forces between points with different steps, is integrated by the trapezoidal rule
/// over the ends of steps.
const IMPULSE: f64 = 1e-3;
/// A hundred times the default tolerance of adaptive dynamic relaxation.
const REACTIONS: f64 = 1e-4;
const NEAR: f64 = 0.9;
const ENDANGERED: f64 = 0.01;
const COARSE: f64 = 0.05;
/// The error of the work of mean forces is about 2 % with ten load steps.
const LOAD_STEPS: u64 = 10;
/// Share of the work that inelastic deformation dissipates.
const INELASTIC: f64 = 0.01;
/// Rounding errors of sums over all broken bonds.
const CREATED: f64 = 1e-10;
/// Rounding errors that do not grow are ten orders of magnitude smaller.
const ASYMMETRY: f64 = 1e-6;
/// Static states are as accurate as the tolerance of the scheme allows, which limits forces, not displacements.
const STATIC_ASYMMETRY: f64 = 1e-3;

/// Fraction of the bonds broken in one step that indicates an error. Cracks break far fewer; a fragmenting tube
/// (`examples/fragmentation`) breaks 7 %.
const BROKEN_AT_ONCE: f64 = 0.1;
/// Fraction of the bonds broken in a run that indicates an error.
const BROKEN_IN_ALL: f64 = 0.5;

/// Monitors the number of broken bonds and warns once.
pub struct Breakage {
    /// Number of bonds at the start.
    bonds: u64,
    /// Number of broken bonds after the last step.
    broken: u64,
    warned: bool,
}

impl Breakage {
    /// Starts monitoring at the current state of a run, which may have been warned about before.
    pub fn new(simulation: &Simulation, warned: bool) -> Self {
        let operator = simulation.system().operator();
        let directed = simulation
            .system()
            .domain()
            .count(operator.directed_bonds());
        Self {
            bonds: directed / 2,
            broken: operator.broken_bonds(),
            warned,
        }
    }

    /// Checks the state after a step.
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
            "{what} (step {}, t = {}): the body disintegrates instead of cracking; check velocities, loads, fracture energy and their units",
            state.step,
            quantity(state.t, "s")
        ))
    }
}

/// Returns the warnings about a finished run.
pub fn warnings(simulation: &Simulation, audit: &Audit) -> Vec<String> {
    let found = [
        simulation.instability().map(ToString::to_string),
        simulation.integrator().remark(),
        energy(simulation, audit),
        momentum(simulation, audit),
        reactions(simulation, audit),
        endangered(simulation, audit),
        coarse_breaking(audit),
        created_energy(simulation, audit),
        fracture_energy(simulation, audit),
        few_load_steps(simulation, audit),
        dropped(simulation),
        asymmetry(simulation, audit),
    ];
    found.into_iter().flatten().collect()
}

/// Checks for points of correspondence materials whose last bonds were removed together.
fn dropped(simulation: &Simulation) -> Option<String> {
    let breaking = simulation.system().operator().capabilities().breaking?;
    match breaking.dropped_points() {
        0 => None,
        points => Some(format!(
            "{points} points lost all bonds because the remaining ones did not span the space; these points are stress-free fragments"
        )),
    }
}

fn energy(simulation: &Simulation, audit: &Audit) -> Option<String> {
    if simulation.integrator().is_static() {
        return static_energy(simulation, audit);
    }
    // Not the work at the end, which vanishes after a closed cycle.
    let scale = audit.largest_work.max(audit.initial_energy.abs());
    let drift = audit.largest_balance / scale;
    let advice = simulation
        .integrator()
        .intended_drift()
        .unwrap_or("reduce the time step and compare the results");
    (drift > ENERGY).then(|| {
        format!(
            "the error of the energy balance reaches {}: {advice}",
            percent(drift)
        )
    })
}

/// Checks the energy balance of multirate schemes against the dissipated energy, which the interface between the zones may
/// falsify where it is small relative to the work.
fn fracture_energy(simulation: &Simulation, audit: &Audit) -> Option<String> {
    simulation.integrator().refinement()?;
    let share = audit.balance.abs() / audit.dissipated_energy.abs();
    (audit.broken_bonds > 0 && share > ENERGY && share.is_finite()).then(|| {
        format!(
            "the error of the energy balance is {} of the dissipated energy: fracture energies of this multirate run have at least this error; reduce dt or the ratio of the steps and compare the results",
            percent(share)
        )
    })
}

/// Checks that the work of inelastic deformation is integrated over enough static states by schemes of low order.
fn few_load_steps(simulation: &Simulation, audit: &Audit) -> Option<String> {
    let (integrator, system) = (simulation.integrator(), simulation.system());
    let steps = simulation.state().step;
    let is_coarse = integrator.is_static() && integrator.order() <= 2 && steps < LOAD_STEPS;
    let inelastic = system.operator().capabilities().path_dependent
        && audit.dissipated_energy > INELASTIC * system.ledger().exchanged;
    (is_coarse && inelastic).then(|| {
        format!(
            "the work and the dissipated energy of inelastic deformation are computed with the mean forces between {} static states: with so few load steps they may be wrong by tens of per cent; set time.load_steps to {LOAD_STEPS} or more and compare the results",
            steps + 1
        )
    })
}

fn momentum(simulation: &Simulation, audit: &Audit) -> Option<String> {
    if simulation.integrator().is_static() {
        return None;
    }
    let system = simulation.system();
    let mass = system.mass();
    // Not the energy at the end: waves may have left the body, and static states have no kinetic energy.
    let energy = audit.initial_energy.abs() + system.ledger().exchanged;
    let error = audit.momentum_error / (2.0 * energy * mass).sqrt();
    let by_trapezia =
        !system.motions().is_empty() || simulation.integrator().refinement().is_some();
    let limit = if by_trapezia { IMPULSE } else { MOMENTUM };
    (error > limit).then(|| {
        let cure = if by_trapezia {
            "; a smaller time step integrates the impulses more accurately"
        } else {
            ""
        };
        format!(
            "the momentum error is {} of √(2 · energy · mass){cure}",
            significant(error, 2)
        )
    })
}

/// Checks the energy balance of static states, whose work is computed with the mean of the forces at both.
fn static_energy(simulation: &Simulation, audit: &Audit) -> Option<String> {
    if reactions(simulation, audit).is_some() {
        // The states are not in equilibrium; this is reported instead.
        return None;
    }
    // Not the net work, which vanishes for a body that is unloaded again.
    let exchanged = simulation.system().ledger().exchanged;
    let drift = audit.largest_balance / exchanged.max(audit.initial_energy.abs());
    (drift > STATIC_ENERGY).then(|| {
        format!(
            "the error of the energy balance of the static states reaches {} of the work done, because the work between two states is computed with the mean forces; apply loads and displacements \
             over more load steps (function = {{ kind = \"ramp\", … }} and time.load_steps)",
            percent(drift)
        )
    })
}

/// Checks that the forces on the body in a static state add up to zero.
fn reactions(simulation: &Simulation, audit: &Audit) -> Option<String> {
    let left = audit.static_balance?.force_relative;
    if simulation.system().motions().is_empty() || left <= REACTIONS {
        return None;
    }
    Some(format!(
        "loads, reactions and contact forces are not in equilibrium: their resultant is {} of their magnitudes; use a smaller tolerance of the static scheme",
        percent(left)
    ))
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
    let domain = system.domain();
    let marked = domain.count(marks.iter().filter(|mark| **mark).count() as u64);
    let share = marked as f64 / domain.whole_points() as f64;
    (share > ENDANGERED).then(|| {
        format!(
            "{} of the points have bonds above {} of the critical stretch, but no bond broke; a slightly larger load would break bonds",
            percent(share),
            percent(NEAR)
        )
    })
}

/// Bonds that break within too coarse steps dissipate the correct energy, but which bonds break, and when, depends on
/// the step.
fn coarse_breaking(audit: &Audit) -> Option<String> {
    let share = audit.coarse_breaks as f64 / audit.broken_bonds.max(1) as f64;
    (share > COARSE).then(|| {
        format!(
            "{} of the broken bonds were stretched from compression, or to more than twice the critical stretch, within one step; reduce dt and compare the results",
            percent(share)
        )
    })
}

/// Checks that breaking bonds and inelastic deformation did not supply energy.
fn created_energy(simulation: &Simulation, audit: &Audit) -> Option<String> {
    let dissipated = simulation.system().operator().dissipated();
    let exchanged = simulation.system().ledger().exchanged + audit.initial_energy.abs();
    (dissipated < -CREATED * exchanged).then(|| {
        format!(
            "the energy dissipated by breaking bonds and inelastic deformation is negative, {}: failure has supplied energy to the body; reduce the time step or the load steps and compare the results",
            simulation.system().cloud().body_units().quantity(dissipated, "J")
        )
    })
}

fn asymmetry(simulation: &Simulation, audit: &Audit) -> Option<String> {
    let is_unbroken_state = simulation.integrator().is_static() && audit.broken_bonds == 0;
    let (limit, cause) = match is_unbroken_state {
        true => (
            STATIC_ASYMMETRY,
            "the static states are not more accurate than this, or the body has buckled; use a smaller time.tolerance",
        ),
        false => (
            ASYMMETRY,
            "rounding errors have grown, as in crack branching or buckling, or the multirate zones are not symmetric; the direction of the deviation has no physical meaning",
        ),
    };
    let mirrors = audit.mirror_errors.iter();
    let lost = mirrors.filter(|mirror| mirror.error > limit);
    let axes: Vec<&str> = lost.clone().map(|mirror| mirror.axis).collect();
    let most = lost.map(|mirror| mirror.error).reduce(f64::max)?;
    Some(format!(
        "the data are mirror-symmetric about {}, but the displacements deviate from the symmetry by {} of the largest: {cause}",
        axes.join(" and "),
        percent(most)
    ))
}
