//! `check`: what a run of a deck would need. Runs nothing and writes nothing.

use pericles::family::geodesic::Ball;
use pericles::material::{BondConstants, SurfaceBond};
use pericles::space::surface::AreaRule;
use pericles_deck::{Deck, Model, Scheme, SurfaceDeck, VertexAreas};

use crate::args::CheckArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::given;
use crate::prepare::{self, Facts, Means};
use crate::refinement::{self, Comparison};
use crate::units::{bytes, count, duration, percent, quantity, significant, threads};
use crate::waves::WaveSpeeds;

/// Checks a deck.
///
/// # Errors
/// A deck that is refused.
pub(crate) fn check(args: &CheckArgs) -> Result<Exit, CliError> {
    let count_of_threads = args.threads.start()?;
    let deck = given::deck(&args.deck, &args.overrides.set)?;
    let model = prepare::model(
        &deck,
        &Means {
            caching: &args.caching,
            memory: args.memory.bytes(),
        },
    )?;
    let facts = Facts::of(&deck, &model);
    for warning in &facts.warnings {
        console::note(format_args!("warning: {warning}"));
    }
    let mut lines = body(&deck, &facts);
    match &deck.surface {
        Some(surface) => lines.extend(surface_material(surface)),
        None => lines.extend(material(&deck, &facts, &model.parts)),
    }
    lines.extend(time(&facts));
    for end in &facts.ends {
        lines.push(("absorbing end", end.line()));
    }
    if matches!(deck.time.scheme, Scheme::Relaxation(_)) {
        // A step goes from static state to static state: one would be the whole run.
        let note = "that of as many iterations as each static state takes";
        lines.push(("run time", note.into()));
    } else {
        let time = run_time(&deck, &facts, model, count_of_threads, &mut lines)?;
        lines.push(time);
    }
    let title = deck.title.as_deref().unwrap_or("no title");
    let mut text = format!("{}: {title}", args.deck.display());
    for (name, value) in lines {
        text += &format!("\n  {name:<18} {value}");
    }
    console::print(format_args!("{text}"))?;
    Ok(Exit::Done)
}

/// How long the run will take, from a few of its steps; what that says of two time steps is added to the lines.
fn run_time(
    deck: &Deck,
    facts: &Facts,
    mut model: Model,
    count_of_threads: usize,
    lines: &mut Vec<Line>,
) -> Result<Line, CliError> {
    model.integrator.start(&mut model.system, &mut model.state);
    let comparison = Comparison::measure(deck, &mut model)?;
    if let (Some(two), Some(comparison)) = (&facts.refinement, &comparison) {
        lines.extend(refinement::lines(two, facts.scheme, facts.dt, comparison));
    }
    let step = match comparison {
        Some(comparison) => comparison.seconds,
        None => refinement::seconds_per_step(
            &mut model.system,
            &mut model.state,
            &mut *model.integrator,
            facts.dt,
            // Not one more than the run has: histories of absorbing ends are no longer.
            facts.steps,
            refinement::LONGEST,
        )?,
    };
    let seconds = step * facts.steps as f64;
    Ok((
        "run time",
        format!(
            "about {} on {} ({}), files not counted",
            duration(seconds),
            threads(count_of_threads),
            facts.instruction_set
        ),
    ))
}

type Line = (&'static str, String);

fn body(deck: &Deck, facts: &Facts) -> Vec<Line> {
    let body = match &deck.surface {
        Some(_) => "surface in 3D".into(),
        None => format!("{}D, {}", facts.dimension, deck.body.state.name()),
    };
    let mut lines = vec![
        ("body", body),
        ("points", count(facts.points as u64)),
        (
            "bonds",
            format!(
                "{} ({} directed, {} per point), kept as a {}",
                count(facts.bonds),
                count(facts.directed_bonds),
                significant(facts.directed_bonds as f64 / facts.points as f64, 3),
                facts.operator
            ),
        ),
        ("memory", format!("about {}", bytes(facts.memory_estimate))),
        (
            "spacing, horizon",
            format!(
                "{}, {}; ratio {}",
                quantity(facts.spacing, "m"),
                quantity(facts.horizon, "m"),
                significant(facts.horizon / facts.spacing, 4)
            ),
        ),
    ];
    if facts.precut_bonds > 0 {
        lines.insert(3, ("bonds cut before", count(facts.precut_bonds)));
    }
    lines
}

fn material(deck: &Deck, facts: &Facts, parts: &[BondConstants]) -> Vec<Line> {
    let mut lines = vec![
        ("Young's modulus", quantity(facts.youngs_modulus, "Pa")),
        (
            "bond constant c",
            format!(
                "{:.6e} (SI, of the force density c α s)",
                facts.micromodulus
            ),
        ),
        (
            "stiffness error",
            format!("{} of the grid's interior", percent(facts.stiffness_error)),
        ),
    ];
    let strength = facts.critical_stretch.zip(facts.fracture_energy);
    lines.push(("breaking", breaking(strength)));
    for (part, constants) in deck.material.parts.iter().zip(parts) {
        let strength = (constants.critical_stretch, constants.fracture_energy);
        lines.push((
            "besides",
            format!(
                "{}: Young's modulus {}, {} kg/m³; breaking {}",
                part.name,
                quantity(constants.young, "Pa"),
                significant(part.density, 4),
                breaking(Some(strength).filter(|(stretch, _)| stretch.is_finite()))
            ),
        ));
    }
    let density = deck.material.bonds.density;
    let speeds = WaveSpeeds::of(facts.youngs_modulus, density, deck.body.state);
    let mut waves = format!("pressure {:.0} m/s", speeds.pressure);
    if let Some(transverse) = speeds.transverse {
        waves += &format!(
            ", shear {:.0} m/s, Rayleigh {:.0} m/s",
            transverse.shear, transverse.rayleigh
        );
    }
    lines.push(("waves", waves));
    lines
}

/// From critical stretch and fracture energy (J/m²).
fn breaking(strength: Option<(f64, f64)>) -> String {
    match strength {
        Some((stretch, energy)) => format!(
            "beyond the stretch {}, fracture energy {}",
            significant(stretch, 4),
            quantity(energy, "J/m²")
        ),
        None => "never".into(),
    }
}

fn surface_material(surface: &SurfaceDeck) -> Vec<Line> {
    let material = &surface.material;
    let law = match material.bond {
        SurfaceBond::Displacement => "κ |η|^(p−2) η / d^(2+αp)",
        SurfaceBond::Chord => "κ |ℓ−ℓ₀|^(p−2) (ℓ−ℓ₀) n / d^(2+αp), frame-indifferent",
    };
    let areas = match surface.areas {
        VertexAreas::Rule(AreaRule::Barycentric) => "a third of each triangle".into(),
        VertexAreas::Rule(AreaRule::MixedVoronoi) => "mixed Voronoi".into(),
        VertexAreas::Same(area) => format!("{area} m² each, not the surface's own"),
    };
    let own_cell = if material.self_cell {
        "added"
    } else if material.alpha >= 0.5 {
        "left out: for α of 1/2 and more results depend on the mesh"
    } else {
        "left out"
    };
    let breaking = if material.critical_stretch.is_finite() {
        format!(
            "beyond |η|/d = {}",
            significant(material.critical_stretch, 4)
        )
    } else {
        "never".into()
    };
    vec![
        (
            "force",
            format!(
                "{law}; p = {}, α = {}, κ = {}",
                material.p, material.alpha, material.kappa
            ),
        ),
        (
            "distances",
            match surface.ball {
                Ball::Geodesic => surface.method.to_string(),
                Ball::Euclid => format!("{}, of the vertices in a ball of space", surface.method),
            },
        ),
        ("areas", areas),
        ("own cell", own_cell.into()),
        ("breaking", breaking),
    ]
}

fn time(facts: &Facts) -> Vec<Line> {
    let mut lines = Vec::new();
    if let (Some(omega), Some(bound)) = (facts.highest_frequency, facts.highest_frequency_bound) {
        let certainty = match facts.highest_frequency_failure_probability {
            Some(probability) if probability > 0.0 => {
                format!(" (bound from random vectors, wrong with probability {probability:.0e})")
            }
            _ => String::new(),
        };
        let range = range(omega, bound);
        lines.push(("highest frequency", format!("{range}{certainty}")));
    }
    if let (Some(omega), Some(bound)) = (facts.limiting_frequency, facts.limiting_frequency_bound)
        && facts.refinement.is_some()
    {
        lines.push(("of the coarse step", range(omega, bound)));
    }
    if let Some(limit) = facts.stable_step {
        lines.push((
            "stable step",
            format!("{} ({})", quantity(limit, "s"), facts.scheme),
        ));
    }
    let share = facts
        .stable_step
        .map(|limit| step_share(facts.dt / limit))
        .unwrap_or_default();
    lines.push((
        "steps",
        format!(
            "{} of {}{share}; end at {}",
            count(facts.steps),
            quantity(facts.dt, "s"),
            quantity(facts.steps as f64 * facts.dt, "s")
        ),
    ));
    lines
}

/// A frequency between an estimate and a bound.
fn range(omega: f64, bound: f64) -> String {
    format!(
        "{omega:.4e} 1/s, at most {} more",
        percent((bound / omega - 1.0).max(0.0))
    )
}

/// A step over the stable one. A step above it is never called one of 100 %.
fn step_share(ratio: f64) -> String {
    if ratio > 1.0 {
        format!(", {} above the stable one", percent(ratio - 1.0))
    } else {
        format!(", {} of the stable one", percent(ratio))
    }
}
