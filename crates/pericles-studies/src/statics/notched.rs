//! Quasi-static fracture of a notched plate: peak load, broken bonds, crack energy.

use std::sync::Arc;

use pericles::boundary::{PrescribedMotion, TimeFunction};
use pericles::family::{Crack, EndRule, VolumeCorrection};
use pericles::kernel::InfluenceFunction;
use pericles::material::{
    BondFailure, FractureCalibration, GivenConstants, LinearSolid, StateInfluence, Strains,
    StressState, StretchDefinition,
};
use pericles::operator::{BondForm, LinearSolidBody};
use pericles::space::{Grid, Shape};
use pericles::time::State;
use pericles::{Control, Outcome, PointScalar, Simulation, System};
use pericles_run::RunError;
use pericles_statics::{BreakingRule, StaticOptions, StaticScheme};

use super::bodies::points;
use crate::data::{Case, Found};

/// Fracture energy G₀, J/m².
const FRACTURE_ENERGY: f64 = 1e-4;
/// Prescribed displacement of each end at the last load step, m.
const OPENING: f64 = 0.012;
/// Number of load steps, of 2e-4 m each.
const STEPS: u64 = 60;
/// The run ends when the force has fallen to this fraction of its peak …
const SEVERED: f64 = 0.02;
/// … or, in event-to-event runs, after this number of events …
const EVENTS: u64 = 400;
/// … or when the crack tip is here, m.
const LAST_TIP: f64 = 0.42;
/// Height (m) of the notch tip at which bonds through the tip are cut on one side only. Where positions are rounded
/// differently this happens by chance, and the plate is not symmetric any more.
const ONE_SIDE: f64 = 1e-9;
/// Range of the crack (m) used for its energy: away from notch and edge.
const COUNTED: [f64; 2] = [-0.1, 0.3];

/// Static state as a point of the curve.
struct Event {
    displacement: f64,
    force: f64,
    tip: f64,
}

/// Peak force, the displacement at which it is reached, broken bonds, products and, for event-to-event runs, the
/// crack energy over G₀. The argument `rule` selects how bonds break.
pub(super) fn path(case: &Case<'_>) -> Result<Found, RunError> {
    let single = BreakingRule::Event {
        reference: 1.0,
        ties: 0.0,
    };
    let rules = [
        ("all", BreakingRule::All),
        ("worst first", BreakingRule::default()),
        ("event to event", single),
        (
            "event to event, equal bonds together",
            BreakingRule::events(1.0),
        ),
    ];
    let breaking = case.one_of("rule", &rules)?;
    let by_events = matches!(breaking, BreakingRule::Event { .. });
    // Bonds whose straight line touches the crack tip are intact, or those on one side of the notch are cut.
    let tips = [("sharp", 0.0), ("cut on one side", ONE_SIDE)];
    let tip = case.one_of("tip", &tips)?;
    let system = plate(case.count("cells")?, tip)?;
    let options = StaticOptions {
        breaking,
        ..StaticOptions::default()
    };
    let scheme = StaticScheme::new(options, &system)?;
    let steps = if by_events { EVENTS } else { STEPS };
    let state = State::of(&system);
    let dt = 1.0 / steps as f64;
    let mut run = Simulation::new(system, Box::new(scheme), state, dt, steps)?;
    let mut events: Vec<Event> = Vec::new();
    let mut peak: f64 = 0.0;
    let ended = run.run(|now| {
        let event = event(now);
        peak = peak.max(event.force);
        let over = event.force < SEVERED * peak || by_events && event.tip > LAST_TIP;
        events.push(event);
        match over {
            true => Control::Stop,
            false => Control::Continue,
        }
    });
    let ended =
        ended.map_err(|error| RunError::of_run(error, || "the study was stopped".into()))?;
    // The observer is not called after the last step.
    if ended == Outcome::Finished {
        events.push(event(&run));
    }
    let highest = events.iter().max_by(|a, b| a.force.total_cmp(&b.force));
    let inner = run.integrator().inner_iterations().unwrap_or_default();
    let curve: Vec<[f64; 2]> = events.iter().map(|e| [e.displacement, e.force]).collect();
    let column = |k: usize| -> Vec<f64> { curve.iter().map(|point| point[k]).collect() };
    let found: Found = [
        ("peak", peak),
        ("displacement", highest.map_or(f64::NAN, |e| e.displacement)),
        ("bonds", run.system().operator().broken_bonds() as f64),
        ("states", events.len() as f64),
        ("products", inner.total as f64),
        ("energy", energy(&events) / FRACTURE_ENERGY),
        ("balance", {
            let energies = run.snapshot().energies();
            energies.balance() / energies.work
        }),
    ]
    .into();
    Ok(found.curve("path", &column(0), &column(1)))
}

/// Plate 1 × 1 (state-based with ν = 1/4, equivalent to bond-based) in plane strain with a notch of 0.3 from its
/// left edge, whose ends (three rows each) are pulled apart by prescribed displacements.
fn plate(cells: usize, tip: f64) -> Result<System, RunError> {
    let grid = Grid {
        shape: Shape::Box {
            origin: [-0.5, -0.5, 0.0],
            size: vec![1.0, 1.0],
        },
        spacing: 1.0 / cells as f64,
        section: 1.0,
        holes: Vec::new(),
    };
    let cloud = Arc::new(grid.points()?);
    let dx = cloud.spacing();
    let rows = |count: f64, side: f64| points(&cloud, |x| side * x[1] > 0.5 - count * dx);
    let solid = LinearSolid {
        density: 1.0,
        elastic: GivenConstants {
            young: Some(1.0),
            poisson_ratio: Some(0.25),
            ..GivenConstants::default()
        },
        horizon: 3.0 * dx * (1.0 + 1e-6),
        influence: StateInfluence::Function(InfluenceFunction::Conical),
        volume_correction: VolumeCorrection::Linear,
        failure: BondFailure::Stretch {
            fracture_energy: FRACTURE_ENERGY,
            definition: StretchDefinition::Closing,
            calibration: FractureCalibration::Continuum,
        },
    };
    let constants = solid.constants(&cloud, StressState::PlaneStrain)?;
    let notch = Crack::Segment {
        from: [-0.5, 0.0],
        to: [-0.2, tip],
    };
    let no_fail = [rows(6.0, 1.0), rows(6.0, -1.0)].concat();
    let body = LinearSolidBody {
        strains: Strains::Small,
        cracks: &[(notch, EndRule::Open)],
        no_fail: &no_fail,
        ..LinearSolidBody::new(&cloud, &constants, VolumeCorrection::Linear)
    };
    let force = body.operator(BondForm::Fastest)?.operator;
    let mut system = System::new(cloud.clone(), force, PointScalar::Uniform(1.0))?;
    for side in [1.0, -1.0] {
        let ramp = TimeFunction::Ramp {
            start: 0.0,
            duration: 1.0,
        };
        let opening = [Some(0.0), Some(side * OPENING), None];
        let grip = PrescribedMotion::displacement(rows(3.0, side), opening, ramp);
        system.add_motion(grip)?;
    }
    Ok(system)
}

fn event(run: &Simulation) -> Event {
    let (system, u) = (run.system(), &run.state().u);
    let cloud = system.cloud();
    let grip = &system.motions()[0];
    Event {
        displacement: u[cloud.len() + grip.points[0] as usize],
        force: grip.reaction(cloud)[1],
        tip: tip(system),
    }
}

/// Rightmost position at which the bond across the plane of the notch is broken, m.
fn tip(system: &System) -> f64 {
    let cloud = system.cloud();
    let dx = cloud.spacing();
    let column = |i: usize| ((cloud.point(i)[0] + 0.5) / dx) as usize;
    let beside = |i: usize, side: f64| {
        let y = side * cloud.point(i)[1];
        y > 0.0 && y < dx
    };
    let mut cut = vec![true; (1.0 / dx).round() as usize];
    if let Some(bonds) = system.operator().bond_set() {
        bonds.for_each_intact(&mut |i, j| {
            let across = beside(i, 1.0) && beside(j, -1.0) || beside(i, -1.0) && beside(j, 1.0);
            if across && column(i) == column(j) {
                cut[column(i)] = false;
            }
        });
    }
    let last = cut.iter().rposition(|cut| *cut);
    last.map_or(f64::NEG_INFINITY, |column| (column as f64 + 0.5) * dx - 0.5)
}

/// ½ U² Δk of all events whose tip is in the range, divided by the crack length that they create, J/m²; U is half
/// the opening, and the stiffness k is that of both ends.
fn energy(events: &[Event]) -> f64 {
    let counted = |event: &&[Event]| event[0].tip >= COUNTED[0] && event[0].tip <= COUNTED[1];
    let pairs: Vec<&[Event]> = events.windows(2).filter(counted).collect();
    let (Some(first), Some(last)) = (pairs.first(), pairs.last()) else {
        return f64::NAN;
    };
    // Each end moves by U against the force R: the elastic energy is R U.
    let spent = |pair: &&[Event]| {
        let stiffness = |event: &Event| event.force / event.displacement;
        pair[0].displacement.powi(2) * (stiffness(&pair[0]) - stiffness(&pair[1]))
    };
    pairs.iter().map(spent).sum::<f64>() / (last[1].tip - first[0].tip)
}
