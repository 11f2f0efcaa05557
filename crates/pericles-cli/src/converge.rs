//! `converge`: convergence study of a scalar over successively finer grids, with the observed order.

use pericles_run::DeckText;
use pericles_run::convergence::{Convergence, Limit, Question};
use pericles_run::sweep::{Axis, Plan};

use crate::args::ConvergeArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::folder::output_folder;
use crate::given;
use crate::sweep;

/// Runs the deck on all grids or with all time steps and evaluates the convergence of the scalar.
///
/// # Errors
/// The deck is invalid for one of the values, the runs do not have the scalar, or output cannot be written.
pub(crate) fn converge(args: &ConvergeArgs) -> Result<Exit, CliError> {
    let mut overrides = args.overrides.set.clone();
    let limit = match (&args.horizon, args.dt.is_empty()) {
        (_, false) => Limit::Time,
        (Some(_), true) => Limit::Nonlocal,
        (None, true) => Limit::Local,
    };
    let axes = match &args.horizon {
        _ if limit == Limit::Time => vec![axis("time.dt", args.dt.iter().cloned())],
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
    let plan = Plan::new(text, axes, None)?;
    let folder = output_folder(args.out.as_deref(), None, &args.deck, "-converge")?;
    let runs = plan.begin(folder)?;
    let exit = sweep::drive(&runs, &args.options)?;
    if exit != Exit::Done {
        return Ok(exit);
    }
    let question = Question {
        scalar: args.scalar.clone(),
        reference: args.reference,
        limit,
    };
    let found = Convergence::of(runs.found(), question)?;
    found.write(&runs.folder().file("convergence.csv"))?;
    found.chart().write(runs.folder().file("convergence.png"))?;
    for line in found.lines() {
        console::print(format_args!("{line}"))?;
    }
    console::print(format_args!(
        "Results in {}: convergence.csv, convergence.png",
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
