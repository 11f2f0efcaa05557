//! Balance of energy and momentum at the end of a run.

use pericles::Simulation;
use pericles::observe::Field;
use serde::Serialize;

use crate::facts::Facts;
use crate::heat::HeatBalance;
use crate::mirror::{MirrorError, Symmetries};
use crate::refinement::RefinementAudit;
use crate::static_balance::StaticBalance;

/// Reference values from the state before the first step of the whole run.
pub struct Start {
    momentum: [f64; 3],
    symmetries: Symmetries,
}

impl Start {
    /// Takes the values of a simulation before its first step.
    pub fn of(simulation: &Simulation) -> Self {
        Self {
            momentum: simulation.system().momentum(&simulation.state().v),
            symmetries: Symmetries::of(simulation),
        }
    }
}

/// The balance of energy and momentum at the end.
#[derive(Debug, Clone, Serialize)]
pub struct Audit {
    /// Kinetic energy, J.
    pub kinetic_energy: f64,
    /// Elastic energy, J.
    pub elastic_energy: f64,
    /// Energy dissipated by broken bonds and damping, J.
    pub dissipated_energy: f64,
    /// Energy stored by contact, J; `None` without contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_energy: Option<f64>,
    /// Energy dissipated by dampers and friction of contact, J; `None` without contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub contact_dissipated: Option<f64>,
    /// Kinetic energy of impactors that move freely, J; `None` without contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub impactor_kinetic: Option<f64>,
    /// Work done on the body by loads and constraints, J.
    pub external_work: f64,
    /// Largest magnitude of this work during the run, J.
    pub largest_work: f64,
    /// Kinetic and elastic energy before the first step of the whole run, J.
    pub initial_energy: f64,
    /// Difference between the energy that the scheme conserves and kinetic + elastic energy, J.
    pub scheme_correction: f64,
    /// Error of the energy balance, J.
    pub balance: f64,
    /// The error relative to the external work.
    pub balance_over_work: f64,
    /// The error relative to the dissipated energy.
    pub balance_over_dissipated: f64,
    /// The largest error among the rows of history.csv, J.
    pub largest_balance: f64,
    /// Momentum, kg m/s; `None` for static states.
    pub momentum: Option<[f64; 3]>,
    /// Impulse of loads and constraints since the start, N s; `None` for static states.
    pub impulse: Option<[f64; 3]>,
    /// |momentum − initial momentum − impulse|, kg m/s; NaN (null) for static states, which have no momentum.
    pub momentum_error: f64,
    /// The same relative to √(2 · kinetic energy · mass).
    pub momentum_error_relative: f64,
    /// Bonds broken since the start, each counted once.
    pub broken_bonds: u64,
    /// Broken bonds that were stretched from compression, or to many times their critical stretch, within one step.
    pub coarse_breaks: u64,
    /// The largest damage of a point.
    pub largest_damage: f64,
    /// Error of the energy balance relative to the larger of the largest work and the initial energy; zero without energy.
    pub energy_drift: f64,
    /// Highest frequency of the reference state that limits the time step, times the step; `None` without stiffness.
    pub omega_dt: Option<f64>,
    /// Point-wise force evaluations since the start of the run; an evaluation of the whole body counts all its points.
    pub evaluated_points: u64,
    /// Rounding error of the last force in single precision, relative to the largest force.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub force_rounding: Option<f64>,
    /// Deviations from the mirror symmetries of the data.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub mirror_errors: Vec<MirrorError>,
    /// Residual and resultant of loads and reactions of static states.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub static_balance: Option<StaticBalance>,
    /// Heat balance of bodies with heat conduction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub heat: Option<HeatBalance>,
    /// Results of multirate schemes; `None` for other schemes.
    pub refinement: Option<RefinementAudit>,
    /// Warnings about the results.
    pub warnings: Vec<String>,
}

impl Audit {
    /// SI units of the numbers.
    pub(crate) const UNITS: [(&str, &[&str]); 2] = [
        (
            "J",
            &[
                "kinetic_energy",
                "elastic_energy",
                "dissipated_energy",
                "contact_energy",
                "contact_dissipated",
                "impactor_kinetic",
                "external_work",
                "initial_energy",
                "scheme_correction",
                "balance",
                "largest_balance",
            ],
        ),
        ("kg m/s", &["momentum", "impulse", "momentum_error"]),
    ];

    /// Evaluates the current state, without warnings. `largest_balance` is the largest magnitude of the energy balance in
    /// the history, J.
    pub(crate) fn of(
        simulation: &Simulation,
        start: &Start,
        largest_balance: f64,
        facts: &Facts,
    ) -> Self {
        let [frequency, dt] = ["limiting_frequency", "dt"].map(|key| facts.number(key));
        let (system, state) = (simulation.system(), simulation.state());
        let snapshot = simulation.snapshot();
        let energies = snapshot.energies();
        let balance = energies.balance();
        let momentum = system.momentum(&state.v);
        let impulse = system.ledger().impulse;
        let moves = !simulation.integrator().is_static();
        let error = if !moves {
            f64::NAN
        } else {
            (0..3)
                .map(|c| (momentum[c] - start.momentum[c] - impulse[c]).powi(2))
                .sum::<f64>()
                .sqrt()
        };
        let (domain, mass) = (system.domain(), system.mass());
        let damage = snapshot.field(Field::Damage).iter().copied();
        let touching = |energy: f64| system.has_interactions().then_some(energy);
        let largest_work = system.ledger().largest_work;
        let evaluated_points = domain.count(system.evaluated_points());
        Self {
            kinetic_energy: energies.kinetic,
            elastic_energy: energies.elastic,
            dissipated_energy: energies.dissipated,
            contact_energy: touching(energies.contact),
            contact_dissipated: touching(energies.contact_dissipated),
            impactor_kinetic: touching(energies.bodies),
            external_work: energies.work,
            largest_work,
            initial_energy: energies.initial,
            scheme_correction: energies.scheme,
            balance,
            balance_over_work: balance / energies.work.abs(),
            balance_over_dissipated: balance / energies.dissipated,
            largest_balance: largest_balance.max(balance.abs()),
            momentum: moves.then_some(momentum),
            impulse: moves.then_some(impulse),
            momentum_error: error,
            momentum_error_relative: error / (2.0 * energies.kinetic * mass).sqrt(),
            broken_bonds: system.operator().broken_bonds(),
            coarse_breaks: system.coarse_breaks(),
            largest_damage: domain.max(damage.fold(0.0, f64::max)),
            energy_drift: match largest_work.max(energies.initial.abs()) {
                0.0 => 0.0,
                scale => balance / scale,
            },
            omega_dt: frequency.zip(dt).map(|(omega, dt)| omega * dt),
            evaluated_points,
            force_rounding: system.operator().rounding(&simulation.state().u),
            mirror_errors: start.symmetries.errors(simulation),
            static_balance: StaticBalance::of(simulation),
            heat: HeatBalance::of(simulation),
            refinement: simulation
                .integrator()
                .refinement()
                .map(|refinement| RefinementAudit::of(&refinement, evaluated_points)),
            warnings: Vec::new(),
        }
    }
}
