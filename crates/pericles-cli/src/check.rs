//! `check`: report what a run of a deck needs, without running it: as lines for people, and as JSON with every number in them.

use std::path::Path;

use pericles::kernel::ActsOn;
use pericles::material::{BondConstants, Calibration, ElasticWaves};
use pericles::observe::Probe;
use pericles_deck::{Deck, KernelQuality, Model, Scheme, SurfaceDeck, VertexAreas};
use pericles_manifold::SurfaceBond;
use pericles_manifold::geodesic::Ball;
use pericles_manifold::surface::AreaRule;
use pericles_run::refinement::{Comparison, LONGEST, seconds_per_step};
use pericles_run::units::{bytes, count, duration, percent, quantity, significant, threads};
use pericles_run::{Facts, Means, Modelled};
use serde::Serialize;
use serde_json::{Value, json};

use crate::args::CheckArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::given;
use crate::line::{self, Line};
use crate::refinement;
use crate::screen::Screen;

/// Checks a deck.
///
/// # Errors
/// A deck that is refused.
pub(crate) fn check(args: &CheckArgs) -> Result<Exit, CliError> {
    let count_of_threads = args.threads.start()?;
    let deck = given::deck(&args.deck, &args.overrides.set)?;
    let means = Means {
        caching: args.caching.wanted(),
        memory: args.memory.bytes(),
    };
    let mut screen = Screen::new(false);
    let Modelled { model, facts } = Modelled::of(&deck, &means, &mut |event| screen.show(event))?;
    for warning in &facts.warnings {
        console::note(format_args!("warning: {warning}"));
    }
    let mut lines = body(&deck, &facts);
    lines.extend(neighbours(&model));
    match &deck.surface {
        Some(surface) => lines.extend(surface_material(surface)),
        None => lines.extend(material(&deck, &facts, &model.parts)),
    }
    lines.extend(plane_waves(&deck, &model));
    lines.extend(time(&facts));
    /// Loads with a line of their own; `run.json` has all.
    const LOADS: usize = 20;
    for load in facts.loads.iter().take(LOADS) {
        lines.push(Line::new("load", load.line()));
    }
    if facts.loads.len() > LOADS {
        let more = facts.loads.len() - LOADS;
        lines.push(
            Line::new("loads", format!("{} more", count(more as u64)))
                .with("loads_not_listed", more),
        );
    }
    lines.extend(probes(&model));
    for end in &facts.ends {
        lines.push(Line::new("absorbing end", end.line()));
    }
    for changed in &facts.changed_defaults {
        lines.push(Line::new("changed default", changed.clone()));
    }
    if matches!(deck.time.scheme, Scheme::Relaxation(_)) {
        // A step goes from static state to static state: one would be the whole run.
        let note = "that of as many iterations as each static state takes";
        lines.push(Line::new("run time", note));
    } else {
        let time = run_time(&deck, &facts, model, count_of_threads, &mut lines)?;
        lines.push(time);
    }
    if let Some(path) = &args.json {
        let results = json_of(&args.deck, &deck, &facts, &lines)?;
        console::write_json(path, &results)?;
    }
    if args.json.as_deref() != Some(Path::new("-")) {
        let title = deck.title.as_deref().unwrap_or("no title");
        let mut text = format!("{}: {title}", args.deck.display());
        for line in &lines {
            text += &format!("\n  {line}");
        }
        console::print(format_args!("{text}"))?;
    }
    Ok(Exit::Done)
}

/// All that `check` knows, in SI units: the facts under the keys that they have in `model` of `run.json`, and the values of the lines.
fn json_of(path: &Path, deck: &Deck, facts: &Facts, lines: &[Line]) -> Result<Value, CliError> {
    #[derive(Serialize)]
    struct Named<'a> {
        deck: String,
        title: Option<&'a str>,
        #[serde(flatten)]
        facts: &'a Facts,
    }
    let mut json = serde_json::to_value(Named {
        deck: path.display().to_string(),
        title: deck.title.as_deref(),
        facts,
    })?;
    if let Value::Object(object) = &mut json {
        line::add_values(object, lines);
    }
    Ok(json)
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
        None => seconds_per_step(
            &mut model.system,
            &mut model.state,
            &mut *model.integrator,
            facts.dt,
            // Not one more than the run has: histories of absorbing ends are no longer.
            facts.steps,
            LONGEST,
        )?,
    };
    let seconds = step * facts.steps as f64;
    let text = format!(
        "about {} on {} ({}), files not counted",
        duration(seconds),
        threads(count_of_threads),
        facts.instruction_set
    );
    Ok(Line::new("run time", text)
        .with("run_seconds", seconds)
        .with("threads", count_of_threads))
}

fn body(deck: &Deck, facts: &Facts) -> Vec<Line> {
    let body = match &deck.surface {
        Some(_) => Line::new("body", "surface in 3D"),
        None => {
            let state = deck.body.state.name();
            let text = format!("{}D, {state}", facts.dimension);
            Line::new("body", text).with("state", state)
        }
    };
    let per_point = facts.directed_bonds as f64 / facts.points as f64;
    let ratio = facts.horizon / facts.spacing;
    let mut lines = vec![
        body,
        Line::new("points", count(facts.points as u64)),
        Line::new(
            "bonds",
            format!(
                "{} ({} directed, {} per point), kept as a {}",
                count(facts.bonds),
                count(facts.directed_bonds),
                significant(per_point, 3),
                facts.operator
            ),
        )
        .with("directed_bonds_per_point", per_point),
        Line::new(
            "memory",
            format!("about {} at the peak", bytes(facts.memory_estimate)),
        ),
        Line::new(
            "spacing, horizon",
            format!(
                "{}, {}; ratio {}",
                quantity(facts.spacing, "m"),
                quantity(facts.horizon, "m"),
                significant(ratio, 4)
            ),
        )
        .with("horizon_ratio", ratio),
    ];
    if facts.precut_bonds > 0 {
        let cut = Line::new("bonds cut before", count(facts.precut_bonds));
        lines.insert(3, cut);
    }
    lines
}

/// The fewest, mean and most neighbours of a point, where the operator knows them one by one.
fn neighbours(model: &Model) -> Option<Line> {
    let zoned = model.system.operator().as_zoned()?;
    let count_of = |i: usize| {
        let mut count = 0u64;
        zoned.neighbours(i, &mut |_| count += 1);
        count
    };
    let counts = (0..model.cloud.len()).map(count_of);
    let (least, most, sum) = counts.fold((u64::MAX, 0, 0), |(least, most, sum), n| {
        (least.min(n), most.max(n), sum + n)
    });
    let mean = sum as f64 / model.cloud.len() as f64;
    let text = format!(
        "{} to {} per point, {} on average",
        count(least),
        count(most),
        significant(mean, 3)
    );
    let value = json!({ "least": least, "mean": mean, "most": most });
    Some(Line::new("neighbours", text).with("neighbours", value))
}

/// Where the probes read: at a point, or the mean over a set.
fn probes(model: &Model) -> Vec<Line> {
    let line = |probe: &Probe| {
        let mut value = json!({ "name": probe.name, "points": probe.points.len() });
        let text = match probe.points[..] {
            [point] => {
                let place = model.cloud.point(point as usize);
                let place = &place[..model.cloud.dimension()];
                let shown: Vec<String> = place.iter().map(|x| quantity(*x, "m")).collect();
                value["place"] = json!(place);
                format!("{} at ({})", probe.name, shown.join(", "))
            }
            _ => format!(
                "{}: mean over {} points",
                probe.name,
                count(probe.points.len() as u64)
            ),
        };
        Line::new("probe", text).with_entry("probes", value)
    };
    model.probes.iter().map(line).collect()
}

fn material(deck: &Deck, facts: &Facts, parts: &[BondConstants]) -> Vec<Line> {
    let mut lines = vec![
        Line::new("Young's modulus", quantity(facts.youngs_modulus, "Pa")),
        Line::new(
            "bond constant c",
            format!(
                "{:.6e} (SI, of the force density c α {})",
                facts.micromodulus,
                match deck.material.bonds.influence.acts_on {
                    ActsOn::Stretch => "s",
                    ActsOn::Displacement => "η",
                }
            ),
        ),
        Line::new("stiffness error", stiffness_error(deck, facts)),
    ];
    let strength = facts.critical_stretch.zip(facts.fracture_energy);
    lines.push(Line::new("breaking", breaking(strength)));
    if !facts.crack_planes.is_empty() {
        lines.push(Line::new("crack planes", crack_planes(facts)));
    }
    for (part, constants) in deck.material.parts.iter().zip(parts) {
        let strength = Some((constants.critical_stretch, constants.fracture_energy))
            .filter(|(stretch, _)| stretch.is_finite());
        let text = format!(
            "{}: Young's modulus {}, {} kg/m³; breaking {}",
            part.name,
            quantity(constants.young, "Pa"),
            significant(part.density, 4),
            breaking(strength)
        );
        lines.push(Line::new("besides", text).with_entry(
            "parts",
            json!({
                "name": part.name,
                "youngs_modulus": constants.young,
                "density": part.density,
                "critical_stretch": strength.map(|(stretch, _)| stretch),
                "fracture_energy": strength.map(|(_, energy)| energy),
            }),
        ));
    }
    let density = deck.material.bonds.density;
    let speeds = ElasticWaves::of(facts.youngs_modulus, density, deck.body.state);
    let mut waves = format!("pressure {} m/s", speed(speeds.pressure));
    if let Some(transverse) = speeds.transverse {
        waves += &format!(
            ", shear {} m/s, Rayleigh {} m/s",
            speed(transverse.shear),
            speed(transverse.rayleigh)
        );
    }
    lines.push(Line::new("waves", waves).with(
        "wave_speeds",
        json!({
            "pressure": speeds.pressure,
            "shear": speeds.transverse.map(|transverse| transverse.shear),
            "rayleigh": speeds.transverse.map(|transverse| transverse.rayleigh),
        }),
    ));
    lines
}

/// A speed with whole metres per second, or with three digits where it is small.
fn speed(speed: f64) -> String {
    match speed.abs() >= 100.0 {
        true if speed < 1e7 => format!("{speed:.0}"),
        _ => significant(speed, 3),
    }
}

/// How far the grid's interior is from the stiffness asked for, and what can be done about it.
fn stiffness_error(deck: &Deck, facts: &Facts) -> String {
    /// Worth a word.
    const NOTICED: f64 = 0.01;
    let mut line = format!("{} in bulk", deviation(facts.stiffness_error));
    if facts.dimension > 1 {
        line += &format!(", {} in shear along the axes", deviation(facts.shear_error));
    }
    line += ", of the grid's interior";
    let calibration = deck.material.bonds.modulus.calibration;
    if facts.stiffness_error.abs() > NOTICED && calibration == Calibration::Continuum {
        line += "; modulus = \"lattice\" makes it 0 in bulk";
    }
    line
}

/// A relative deviation with its sign; what rounding leaves is none.
fn deviation(ratio: f64) -> String {
    // Plus zero: no minus before a zero.
    let rounded = (ratio * 1e6).round() * 1e-6 + 0.0;
    let sign = if rounded > 0.0 { "+" } else { "" };
    format!("{sign}{}", percent(rounded))
}

/// What cracks along the planes of the lattice cost.
fn crack_planes(facts: &Facts) -> String {
    let planes: Vec<String> = facts
        .crack_planes
        .iter()
        .map(|plane| format!("{} {}", plane.plane, deviation(plane.deviation)))
        .collect();
    let calibration = match facts.fracture_calibration {
        Some(calibration) => format!(" (fracture_calibration = \"{calibration}\")"),
        None => String::new(),
    };
    format!(
        "energy per area over the fracture energy: {}{calibration}",
        planes.join(", ")
    )
}

/// What kernel and grid do to plane waves.
fn plane_waves(deck: &Deck, model: &Model) -> Vec<Line> {
    let Some(waves) = deck.plane_waves(model) else {
        return Vec::new();
    };
    let grid = waves.grid;
    let tolerance = percent(grid.tolerance);
    let length = std::f64::consts::TAU / grid.wavenumber;
    let spacings = length / model.cloud.spacing();
    let mut lines = Vec::new();
    if let Some(longest) = waves.model {
        let horizons = longest / deck.material.bonds.horizon;
        let text = format!(
            "phase speed within {tolerance} of long waves from wavelengths of {} ({} horizons)",
            quantity(longest, "m"),
            significant(horizons, 3)
        );
        let value =
            json!({ "tolerance": grid.tolerance, "wavelength": longest, "horizons": horizons });
        lines.push(Line::new("kernel dispersion", text).with("kernel_dispersion", value));
    }
    let reference = match waves.model {
        Some(_) => "the nonlocal continuum",
        None => "long waves",
    };
    let text = format!(
        "phase speed within {tolerance} of {reference} from wavelengths of {} ({} spacings)",
        quantity(length, "m"),
        significant(spacings, 3)
    );
    let value = json!({ "tolerance": grid.tolerance, "wavelength": length, "spacings": spacings });
    lines.push(Line::new("grid dispersion", text).with("grid_dispersion", value));
    if let (Some(pair), Some(table)) = (waves.tuning, &deck.material.tuned) {
        lines.push(tuned_kernel(pair, table.tuning.lower_bound));
    }
    lines
}

/// A tuned kernel beside a constant one.
fn tuned_kernel([tuned, constant]: [KernelQuality; 2], lower_bound: Option<f64>) -> Line {
    const TOLERANCE: f64 = 0.01;
    let shortest = KernelQuality::SHORTEST;
    let bound = match lower_bound {
        Some(bound) => format!("; coefficients of at least {bound}"),
        None => String::new(),
    };
    let text = format!(
        "within {} of long waves from {} spacings per wavelength (constant kernel: {}); at most {} off from {shortest} spacings (constant: {}){bound}",
        percent(TOLERANCE),
        significant(tuned.spacings, 3),
        significant(constant.spacings, 3),
        percent(tuned.worst),
        percent(constant.worst)
    );
    let quality = |quality: KernelQuality| json!({ "spacings": quality.spacings, "largest_error": quality.worst });
    let value = json!({
        "tolerance": TOLERANCE,
        "shortest_spacings": shortest,
        "tuned": quality(tuned),
        "constant": quality(constant),
        "lower_bound": lower_bound,
    });
    Line::new("tuned kernel", text).with("tuned_kernel", value)
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
    let same_area = match surface.areas {
        VertexAreas::Same(area) => Some(area),
        VertexAreas::Rule(_) => None,
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
        Line::new(
            "force",
            format!(
                "{law}; p = {}, α = {}, κ = {}",
                material.p, material.alpha, material.kappa
            ),
        )
        .with(
            "surface_law",
            json!({ "p": material.p, "alpha": material.alpha, "kappa": material.kappa }),
        ),
        Line::new(
            "distances",
            match surface.ball {
                Ball::Geodesic => surface.method.to_string(),
                Ball::Euclid => format!("{}, of the vertices in a ball of space", surface.method),
            },
        ),
        Line::new("areas", areas).with("vertex_area", same_area),
        Line::new("own cell", own_cell),
        Line::new("breaking", breaking),
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
        lines.push(
            Line::new("highest frequency", format!("{range}{certainty}"))
                .with("highest_frequency_margin", bound / omega - 1.0),
        );
    }
    if let (Some(omega), Some(bound)) = (facts.limiting_frequency, facts.limiting_frequency_bound)
        && facts.refinement.is_some()
    {
        let line = Line::new("of the coarse step", range(omega, bound));
        lines.push(line.with("limiting_frequency_margin", bound / omega - 1.0));
    }
    if let Some(limit) = facts.stable_step {
        let text = format!("{} ({})", quantity(limit, "s"), facts.scheme);
        lines.push(Line::new("stable step", text));
    }
    let ratio = facts.stable_step.map(|limit| facts.dt / limit);
    let share = ratio.map(step_share).unwrap_or_default();
    let end = facts.steps as f64 * facts.dt;
    let text = format!(
        "{} of {}{share}; end at {}",
        count(facts.steps),
        quantity(facts.dt, "s"),
        quantity(end, "s")
    );
    let steps = Line::new("steps", text)
        .with("end", end)
        .with("dt_over_stable_step", ratio)
        .with(
            "dt_above_stable_step",
            ratio.map(|ratio| (ratio - 1.0).max(0.0)),
        );
    lines.push(steps);
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
