//! `converge`: one number of a deck's runs on finer and finer grids, with the observed order.

use pericles_run::DeckText;
use pericles_run::convergence::{Convergence, Question};
use pericles_run::sweep::{Axis, Plan};

use crate::args::ConvergeArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::folder::output_folder;
use crate::given;
use crate::sweep;

/// Runs the deck and judges how the number converges.
///
/// # Errors
/// Values that the deck refuses, a number that runs do not have, output that cannot be written.
pub(crate) fn converge(args: &ConvergeArgs) -> Result<Exit, CliError> {
    let mut overrides = args.overrides.set.clone();
    let axes = match &args.horizon {
        Some(horizon) => {
            overrides.push(format!("material.horizon={}", horizon.text));
            let spacings = args.m.iter().map(|m| horizon.metres / m);
            vec![axis("body.spacing", spacings.map(|dx| format!("{dx:e}")))]
        }
        None => vec![
            axis("material.horizon_ratio", args.m.iter().map(f64::to_string)),
            axis("body.spacing", args.dx.iter().map(|dx| dx.text.clone())),
        ],
    };
    let deck = given::deck(&args.deck, &overrides)?;
    let text = DeckText::of(&deck, args.deck.display().to_string());
    let plan = Plan::new(text, axes)?;
    let folder = output_folder(args.out.as_deref(), None, &args.deck, "-converge")?;
    let runs = plan.begin(folder)?;
    let exit = sweep::drive(&runs, &args.options)?;
    if exit != Exit::Done {
        return Ok(exit);
    }
    let question = Question {
        scalar: args.scalar.clone(),
        reference: args.reference,
        one_horizon: args.horizon.is_some(),
    };
    let found = Convergence::of(&runs, question)?;
    found.write(&runs.folder().file("convergence.csv"))?;
    found.chart().write(runs.folder().file("convergence.png"))?;
    for line in found.lines() {
        console::print(format_args!("{line}"))?;
    }
    console::print(format_args!(
        "convergence.csv and convergence.png in {}",
        runs.folder().path().display()
    ))?;
    Ok(Exit::Done)
}

fn axis(key: &str, values: impl Iterator<Item = String>) -> Axis {
    let mut values: Vec<String> = values.collect();
    values.dedup();
    Axis {
        key: key.to_owned(),
        values,
    }
}
