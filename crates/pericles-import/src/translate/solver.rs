//! The solver: `[time]`.

use super::{Code, Source};
use crate::entry::Entry;
use crate::error::Fault;
use crate::table::{self, Table};
use crate::units::{Quantity, Units};

/// Schemes by the names of their groups.
const SCHEMES: [(&str, Scheme); 8] = [
    ("Verlet", Scheme::Verlet),
    ("Verlet Matrix Based", Scheme::Verlet),
    ("QuasiStatic", Scheme::Static),
    ("NOXQuasiStatic", Scheme::Static),
    ("Static", Scheme::Static),
    ("Linear Static Matrix Based", Scheme::Static),
    ("Newmark", Scheme::Newmark),
    ("Implicit", Scheme::Newmark),
];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Scheme {
    Verlet,
    Static,
    Newmark,
}

/// The solver of an input file.
#[derive(Debug)]
pub(crate) struct Solver<'e> {
    pub(crate) table: Table,
    pub(crate) is_static: bool,
    /// Time at the start, in units of the input file; that of the deck is zero.
    pub(crate) start: f64,
    /// Number of the step, of a file with several.
    step: Option<&'e str>,
    /// Whether bonds may break.
    pub(crate) breaks: bool,
}

impl<'e> Solver<'e> {
    pub(crate) fn read(source: &Source<'e>) -> Result<Self, Fault> {
        let (solver, step) = first_step(source.root)?;
        let start = solver.number_of(&["Initial Time"])?.unwrap_or(0.0);
        let last = solver.need(&["Final Time"])?;
        let end = last.number()? - start;
        if end <= 0.0 {
            return Err(last.fault("it must be after the initial time"));
        }
        let given = SCHEMES.iter().find_map(|(name, scheme)| {
            let group = solver.find(name)?;
            Some((group, *scheme))
        });
        let Some((group, scheme)) = given else {
            let known: Vec<&str> = SCHEMES.iter().map(|(name, _)| *name).collect();
            let known = known.join(", ");
            return Err(solver.fault(format!(
                "no known solver; expected one of the groups {known}"
            )));
        };
        let option = |keys: &[&str]| group.find_any(keys).or_else(|| solver.find_any(keys));
        let table = Table::new("[time]").from(solver).from(group);
        let table = match scheme {
            Scheme::Verlet => explicit(table, end, &option, &source.units)?,
            Scheme::Static => statics(table, end, &option, &source.units)?,
            Scheme::Newmark => newmark(table, end, &option, &source.units)?,
        };
        let breaks = match source.code {
            Code::PeriLab => solver.is_set("Damage Models")?,
            Code::Peridigm => true,
        };
        if let Some(damping) = option(&["Numerical Damping"]) {
            damping.refuse("numerical damping has no counterpart; `[damping] mass` damps in proportion to the velocity");
        }
        let material = solver
            .find("Material Models")
            .filter(|_| source.code == Code::PeriLab);
        if let Some(material) = material
            && !material.flag()?
        {
            material.refuse("the deck computes the motion of the body");
        }
        Ok(Self {
            table,
            is_static: scheme == Scheme::Static,
            start,
            step,
            breaks,
        })
    }

    /// Returns whether an entry belongs to the translated step.
    pub(crate) fn includes(&self, entry: &Entry) -> Result<bool, Fault> {
        match (self.step, entry.find("Step ID")) {
            (Some(step), Some(steps)) => Ok(super::names(steps.text()?).any(|name| name == step)),
            (None, Some(steps)) => steps.text().map(|_| true),
            _ => Ok(true),
        }
    }
}

/// Returns the first of the solvers and the number of its step.
fn first_step(root: &Entry) -> Result<(&Entry, Option<&str>), Fault> {
    let steps = match root.find("Multistep Solver") {
        Some(steps) => steps.entries()?.iter().collect(),
        None => {
            let is_solver = |entry: &&Entry| entry.key().to_lowercase().starts_with("solver");
            root.entries()?.iter().filter(is_solver).collect::<Vec<_>>()
        }
    };
    let Some((first, others)) = steps.split_first() else {
        return Err(root.fault("the entry `Solver` is missing"));
    };
    for other in others {
        other.refuse("only the first step is translated; write the others as [[step]]");
    }
    let number = first.find("Step ID").map(Entry::text).transpose()?;
    Ok((first, number))
}

type Options<'o, 'e> = dyn Fn(&[&str]) -> Option<&'e Entry> + 'o;

fn explicit(
    table: Table,
    end: f64,
    option: &Options<'_, '_>,
    units: &Units,
) -> Result<Table, Fault> {
    let table = table.key("end", units.number(end, Quantity::Time));
    let safety = option(&["Safety Factor"]);
    let step = match (option(&["Fixed dt"]), option(&["Number of Steps"])) {
        (Some(step), _) => Some(step.positive()?),
        (None, Some(count)) => Some(end / count.count()? as f64),
        (None, None) => None,
    };
    match (step, safety) {
        (Some(step), safety) => {
            if let Some(safety) = safety {
                safety.refuse("without effect: the time step is given");
            }
            Ok(table.key("dt", units.number(step, Quantity::Time)))
        }
        (None, Some(safety)) => Ok(match safety.positive()? {
            factor if factor <= 1.0 => table.key("safety", table::number(factor)),
            _ => {
                safety.refuse("the time step would be unstable; allowed: at most 1");
                table
            }
        }),
        (None, None) => Ok(table),
    }
}

fn statics(
    table: Table,
    end: f64,
    option: &Options<'_, '_>,
    units: &Units,
) -> Result<Table, Fault> {
    let steps = match (
        option(&["Number of Load Steps", "Number of Steps"]),
        option(&["Fixed dt"]),
    ) {
        (Some(count), _) => count.count()?,
        (None, Some(step)) => (end / step.positive()?).round().max(1.0) as usize,
        (None, None) => 1,
    };
    for tolerance in [
        "Absolute Tolerance",
        "Residual tolerance",
        "Solution tolerance",
    ] {
        if let Some(tolerance) = option(&[tolerance]) {
            tolerance.refuse(
                "the residual of Pericles is relative to loads and reactions; see `time.tolerance`",
            );
        }
    }
    let table = table
        .key("scheme", "\"static\"")
        .key("end", units.number(end, Quantity::Time));
    Ok(table.key("load_steps", steps.to_string()))
}

fn newmark(
    table: Table,
    end: f64,
    option: &Options<'_, '_>,
    units: &Units,
) -> Result<Table, Fault> {
    let table = table
        .key("scheme", "\"newmark\"")
        .key("solver", "\"newton-krylov\"");
    let step = match (option(&["Fixed dt"]), option(&["Number of Steps"])) {
        (None, Some(count)) => Some(end / count.count()? as f64),
        (step, _) => step.map(Entry::positive).transpose()?,
    };
    let parameter = |key| {
        option(&[key])
            .map(|entry| entry.number().map(table::number))
            .transpose()
    };
    let table = table.key("end", units.number(end, Quantity::Time));
    let table = table.maybe("dt", step.map(|step| units.number(step, Quantity::Time)));
    Ok(table
        .maybe("beta", parameter("Beta")?)
        .maybe("gamma", parameter("Gamma")?))
}
