//! Text output of `run` and `resume`: sizes before the first step, results after the last one.

use std::path::Path;

use pericles_io::IoError;
use pericles_run::units::{bytes, count, duration, percent, quantity, significant, threads};
use pericles_run::{Audit, Facts, Report, Status};

use crate::console;

/// Prints the size of the model before the first step.
pub(crate) fn opening(report: &Report, folder: &Path) {
    let model = &report.model;
    console::note(format_args!(
        "{} points, {} bonds, {} steps of {}, about {} of memory; results in {}",
        count(model.count("points")),
        count(model.count("bonds")),
        count(model.count("steps")),
        quantity(model.number("dt").unwrap_or_default(), "s"),
        bytes(model.count("memory_estimate")),
        folder.display()
    ));
    if let Some(start) = model.words("start") {
        console::note(format_args!("starting from the {start}"));
    }
}

/// Prints the results after the last step.
///
/// # Errors
/// Standard output cannot be written.
pub(crate) fn closing(report: &Report, place: &Path) -> Result<(), IoError> {
    let (model, progress) = (&report.model, &report.progress);
    let folder = place.display();
    let word = match report.status {
        Status::Finished => "finished",
        _ => "stopped",
    };
    console::print(format_args!(
        "{word} after step {} of {}, t = {}, in {}: {} million bond updates/s on {} ({})",
        count(progress.last_step),
        count(model.count("steps")),
        quantity(progress.t, "s"),
        duration(progress.wall_seconds),
        significant(1e-6 * progress.directed_bond_updates_per_second, 3),
        threads(rayon::current_num_threads()),
        model.text("instruction_set"),
    ))?;
    if let Some(sharing) = &report.sharing {
        console::print(format_args!("{}", sharing.line()))?;
    }
    if let Some(reason) = &report.stop_reason {
        console::print(format_args!("stop condition reached: {reason}"))?;
    }
    if let Some(audit) = &report.audit {
        // A body that does not move, with heat conduction only, has neither.
        if audit.momentum.is_some() || audit.static_balance.is_some() {
            energies(audit, model)?;
        }
        heat(audit, model)?;
        if let Some(error) = audit.force_rounding {
            console::print(format_args!(
                "rounding error of single-precision forces at the end: {} of the largest force",
                significant(error, 2)
            ))?;
        }
        for mirror in &audit.mirror_errors {
            console::print(format_args!("{mirror}"))?;
        }
        for warning in &audit.warnings {
            console::note(format_args!("warning: {warning}"));
        }
        if let Some(refinement) = &audit.refinement {
            console::print(format_args!("{}", refinement.line()))?;
        }
    }
    if report.status == Status::Stopped {
        console::print(format_args!("Resume with `pericles resume {folder}`."))?;
    }
    let files = [
        ("history.csv", "history.csv"),
        ("fields.pvd", "fields.pvd (ParaView)"),
        ("pictures", "pictures"),
        ("run.json", "run.json"),
    ];
    let written = files.iter().filter(|(file, _)| place.join(file).exists());
    let written: Vec<&str> = written.map(|(_, words)| *words).collect();
    console::print(format_args!(
        "Results in {folder}: {}. List them with `pericles info {folder}`.",
        written.join(", ")
    ))
}

fn heat(audit: &Audit, model: &Facts) -> Result<(), IoError> {
    let energy = |value: f64| quantity(value, &model.unit("J"));
    let Some(heat) = &audit.heat else {
        return Ok(());
    };
    let through: f64 = heat.inflows.iter().map(|one| one.heat).sum();
    let sources = [
        (heat.from_dissipation, "dissipation"),
        (heat.from_activation, "activation"),
    ];
    let generated = sources.into_iter().filter_map(|(heat, source)| {
        let heat = energy(heat?);
        Some(format!(", {heat} from {source}"))
    });
    let generated: String = generated.collect();
    let balance = match (heat.balance, heat.balance_relative) {
        (Some(error), Some(relative)) => format!(
            "; heat balance: error {} ({})",
            energy(error),
            percent(relative)
        ),
        _ => String::new(),
    };
    console::print(format_args!(
        "heat: content {}, initially {}; {} through conditions{generated}{balance}; temperature {} to {}",
        energy(heat.content),
        energy(heat.initial_content),
        energy(through),
        quantity(heat.lowest, "K"),
        quantity(heat.highest, "K"),
    ))
}

fn energies(audit: &Audit, model: &Facts) -> Result<(), IoError> {
    let shown = |value: f64| quantity(value, &model.unit("J"));
    let more = [
        ("contact", audit.contact_energy),
        ("dissipated by contact", audit.contact_dissipated),
        ("kinetic energy of impactors", audit.impactor_kinetic),
    ];
    let more = more.into_iter().filter_map(|(name, energy)| {
        let energy = energy.filter(|energy| *energy != 0.0)?;
        Some(format!(", {name} {}", shown(energy)))
    });
    console::print(format_args!(
        "energy: kinetic {}, elastic {}, dissipated {}{}; initially {}, external work {}",
        shown(audit.kinetic_energy),
        shown(audit.elastic_energy),
        shown(audit.dissipated_energy),
        more.collect::<String>(),
        shown(audit.initial_energy),
        shown(audit.external_work),
    ))?;
    let forces = match &audit.static_balance {
        Some(balance) => format!(
            "; residual {}, resultant force {} and moment {} of loads and reactions (relative)",
            significant(balance.residual, 2),
            significant(balance.force_relative, 2),
            significant(balance.moment_relative, 2)
        ),
        None => format!(
            "; momentum error {} {}",
            significant(audit.momentum_error, 2),
            model.unit("kg m/s")
        ),
    };
    console::print(format_args!(
        "energy balance: error {} ({}){forces}; {} bonds broken, largest damage {:.2}",
        shown(audit.balance),
        percent(audit.energy_drift),
        count(audit.broken_bonds),
        audit.largest_damage,
    ))
}
