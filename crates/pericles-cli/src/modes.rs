//! `modes`: compute the lowest natural frequencies and mode shapes of a body.

use std::path::Path;

use pericles_deck::Processor;
use pericles_io::IoError;
use pericles_run::units::{count, quantity, significant};
use pericles_run::{Assembled, Means, Source, Vibration};
use pericles_statics::{ModeGroup, ModeOptions};
use serde::Serialize;

use crate::args::ModesArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::folder::output_folder;
use crate::given;

/// The JSON output.
#[derive(Serialize)]
struct Results<'a> {
    title: Option<&'a str>,
    points: usize,
    prestressed: bool,
    /// Number of rigid-body modes.
    rigid_modes: usize,
    /// Groups of equal frequency, in ascending order.
    modes: Vec<Group>,
    iterations: u32,
    /// Number of products with the stiffness matrix.
    products: u64,
}

/// A group of modes of equal frequency.
#[derive(Serialize)]
struct Group {
    frequency_hz: f64,
    multiplicity: usize,
    residual: f64,
}

impl From<ModeGroup> for Group {
    fn from(group: ModeGroup) -> Self {
        Self {
            frequency_hz: group.frequency_hz,
            multiplicity: group.multiplicity,
            residual: group.residual,
        }
    }
}

/// Computes the modes of the body of a deck, prints them and writes the mode shapes.
///
/// # Errors
/// The deck is invalid, the scheme for a prestress is not static, the modes do not converge, or output cannot be
/// written.
pub(crate) fn modes(args: &ModesArgs) -> Result<Exit, CliError> {
    args.execution.threads.start()?;
    let deck = given::deck(&args.deck, &args.overrides.set)?;
    let source = Source::of_deck(deck, args.deck.display().to_string());
    let model = source.model();
    let means = Means {
        caching: args.caching.wanted(),
        memory: args.memory.bytes(),
        // Modes have no steps.
        processor: Some(Processor::default()),
        ..Means::default()
    };
    let assembled = Assembled::of(&source, &means, &mut |_| {})?;
    let integrator = &assembled.assembly.integrator;
    if args.prestress && !integrator.is_static() {
        return Err(CliError::NotStatic {
            scheme: integrator.name(),
        });
    }
    let options = ModeOptions {
        count: args.modes as usize,
        tolerance: args.tolerance,
        ..ModeOptions::default()
    };
    let found = Vibration::of(model, assembled.assembly, options, args.prestress)?;
    let folder = output_folder(args.out.as_deref(), None, &args.deck, "-modes")?;
    found.write(
        &folder,
        model.title.as_deref().unwrap_or_default(),
        args.animation,
    )?;
    let results = Results {
        title: model.title.as_deref(),
        points: found.points(),
        prestressed: args.prestress,
        rigid_modes: found.modes.rigid_modes,
        modes: found.modes.groups().into_iter().map(Group::from).collect(),
        iterations: found.modes.iterations,
        products: found.modes.products,
    };
    if let Some(path) = &args.json {
        console::write_json(path, &results)?;
    }
    if args.json.as_deref() != Some(Path::new("-")) && !args.execution.quiet {
        print(&results, folder.path())?;
    }
    Ok(Exit::Done)
}

fn print(results: &Results<'_>, folder: &Path) -> Result<(), IoError> {
    console::print(format_args!(
        "{} points, {} rigid-body modes; {} iterations with {} matrix-vector products",
        count(results.points as u64),
        results.rigid_modes,
        results.iterations,
        count(results.products)
    ))?;
    console::print(format_args!("{:>14}  multiplicity  residual", "frequency"))?;
    for group in &results.modes {
        console::print(format_args!(
            "{:>14}  {:>12}  {}",
            quantity(group.frequency_hz, "Hz"),
            group.multiplicity,
            significant(group.residual, 2)
        ))?;
    }
    console::print(format_args!(
        "Results in {}: modes.csv, modes.pvd (ParaView), pictures in modes/.",
        folder.display()
    ))
}
