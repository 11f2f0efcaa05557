//! What a run says about itself to people.

use std::path::Path;

use pericles_io::IoError;
use pericles_run::units::{bytes, count, duration, percent, quantity, significant, threads};
use pericles_run::{Audit, Report, Status};

use crate::console;

/// Before the first step.
pub(crate) fn opening(report: &Report, folder: &Path) {
    let model = &report.model;
    console::note(format_args!(
        "{} points, {} bonds, {} steps of {}, about {}; results in {}",
        count(model.points as u64),
        count(model.bonds),
        count(model.steps),
        quantity(model.dt, "s"),
        bytes(model.memory_estimate),
        folder.display()
    ));
}

/// After the last step.
///
/// # Errors
/// A standard output that cannot be written.
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
        count(model.steps),
        quantity(progress.t, "s"),
        duration(progress.wall_seconds),
        significant(1e-6 * progress.directed_bond_updates_per_second, 3),
        threads(rayon::current_num_threads()),
        model.instruction_set,
    ))?;
    if let Some(reason) = &report.stop_reason {
        console::print(format_args!("ended by a stop condition: {reason}"))?;
    }
    if let Some(audit) = &report.audit {
        energies(audit)?;
        if let Some(error) = audit.force_rounding {
            console::print(format_args!(
                "forces in single precision: off by {} of the largest at the end",
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
        console::print(format_args!("go on with: pericles resume {folder}"))?;
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

fn energies(audit: &Audit) -> Result<(), IoError> {
    console::print(format_args!(
        "energy: kinetic {}, elastic {}, dissipated {}; work done on the body {}",
        quantity(audit.kinetic_energy, "J"),
        quantity(audit.elastic_energy, "J"),
        quantity(audit.dissipated_energy, "J"),
        quantity(audit.external_work, "J"),
    ))?;
    let forces = match &audit.static_balance {
        Some(balance) => format!(
            ", residual {:.1e}, resultant force {:.1e} and moment {:.1e} of loads and reactions",
            balance.residual, balance.force_relative, balance.moment_relative
        ),
        None => format!(", momentum by {:.1e} kg m/s", audit.momentum_error),
    };
    console::print(format_args!(
        "audit: energy off by {} ({}){forces}; {} bonds broken, largest damage {:.2}",
        quantity(audit.balance, "J"),
        percent(audit.energy_drift),
        count(audit.broken_bonds),
        audit.largest_damage,
    ))
}
