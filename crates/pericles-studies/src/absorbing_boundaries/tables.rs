//! Tables 2 to 6: errors of the truncated bar against the solution in continuous time.

use pericles::time::State;
use pericles_run::RunError;

use super::bar::{Bar, Kind, SEISMIC_BAR};
use super::figures;
use super::paper::PAPER;
use crate::row::Row;
use crate::study::{Context, Study};

/// Which field is compared.
#[derive(Clone, Copy)]
enum Field {
    Displacement,
    Velocity,
}

/// The printed errors of one step.
struct Line {
    dt: f64,
    printed: [f64; 4],
    /// A misprint: column and the number computed by a separate code.
    misprint: Option<(usize, f64)>,
}

struct Table {
    bar: Bar,
    field: Field,
    times: [f64; 4],
    lines: [Line; 5],
}

const fn line(dt: f64, printed: [f64; 4]) -> Line {
    Line {
        dt,
        printed,
        misprint: None,
    }
}

const fn corrected(dt: f64, printed: [f64; 4], column: usize, verified: f64) -> Line {
    Line {
        dt,
        printed,
        misprint: Some((column, verified)),
    }
}

const EARLY: [f64; 4] = [5.0, 10.0, 15.0, 40.0];
const LATE: [f64; 4] = [10.0, 15.0, 40.0, 100.0];

const DISPLACEMENT: Table = Table {
    bar: Bar::infinite(1.0),
    field: Field::Displacement,
    times: EARLY,
    lines: [
        line(0.005, [1.01e-5, 2.66e-5, 1.88e-5, 4.17e-8]),
        corrected(0.004, [2.51e-6, 1.70e-5, 1.21e-5, 2.67e-8], 0, 6.450e-6),
        line(0.0025, [2.51e-6, 6.65e-6, 4.72e-6, 1.04e-8]),
        line(0.002, [1.61e-6, 4.26e-6, 3.02e-6, 6.69e-9]),
        line(0.001, [4.03e-7, 1.06e-6, 7.57e-7, 1.67e-9]),
    ],
};

const VELOCITY: Table = Table {
    bar: Bar::infinite(1.0),
    field: Field::Velocity,
    times: EARLY,
    lines: [
        line(0.005, [2.46e-5, 5.64e-5, 1.98e-5, 2.21e-7]),
        line(0.004, [1.57e-5, 3.61e-5, 1.26e-5, 1.41e-7]),
        line(0.0025, [6.16e-6, 1.41e-5, 4.96e-6, 5.54e-8]),
        line(0.002, [3.94e-6, 9.03e-6, 3.17e-6, 3.54e-8]),
        line(0.001, [9.87e-7, 2.25e-6, 7.94e-7, 8.87e-9]),
    ],
};

const INTERFACE: Table = Table {
    bar: Bar::infinite(0.5),
    field: Field::Displacement,
    times: LATE,
    lines: [
        line(0.005, [5.84e-6, 1.59e-5, 5.82e-6, 2.43e-9]),
        line(0.004, [3.73e-6, 1.02e-5, 3.72e-6, 1.56e-9]),
        line(0.0025, [1.46e-6, 3.99e-6, 1.45e-6, 6.11e-10]),
        corrected(0.002, [9.34e-7, 2.55e-6, 9.33e-6, 3.90e-10], 2, 9.331e-7),
        line(0.001, [2.33e-7, 6.39e-7, 2.33e-7, 9.78e-11]),
    ],
};

const SOFT: Table = Table {
    bar: Bar::infinite(0.1),
    field: Field::Displacement,
    times: LATE,
    lines: [
        line(0.005, [6.10e-7, 1.97e-6, 2.03e-5, 9.75e-6]),
        line(0.004, [3.90e-7, 1.26e-6, 1.30e-5, 6.24e-6]),
        line(0.0025, [1.52e-7, 4.93e-7, 5.08e-6, 2.44e-6]),
        line(0.002, [9.76e-8, 3.16e-7, 3.25e-6, 1.56e-6]),
        line(0.001, [2.44e-8, 7.90e-8, 8.13e-7, 3.90e-7]),
    ],
};

const SEISMIC: Table = Table {
    bar: SEISMIC_BAR,
    field: Field::Displacement,
    times: LATE,
    lines: [
        line(0.005, [2.11e-5, 6.96e-5, 3.47e-5, 2.87e-5]),
        line(0.004, [1.35e-5, 4.45e-5, 2.21e-5, 1.82e-5]),
        line(0.0025, [5.29e-6, 1.74e-5, 8.67e-6, 7.03e-6]),
        line(0.002, [3.38e-6, 1.11e-5, 5.55e-6, 4.49e-6]),
        line(0.001, [8.46e-7, 2.78e-6, 1.38e-6, 1.11e-6]),
    ],
};

pub(super) const TABLE_2: Study = Study {
    id: "absorbing-boundaries/table-2",
    paper: PAPER,
    title: "Displacement of a homogeneous bar with absorbing ends",
    run: |context| {
        figures::homogeneous(context)?;
        rows(context, &DISPLACEMENT)
    },
};

pub(super) const TABLE_3: Study = Study {
    id: "absorbing-boundaries/table-3",
    paper: PAPER,
    title: "Velocity of a homogeneous bar with absorbing ends",
    run: |context| rows(context, &VELOCITY),
};

pub(super) const TABLE_4: Study = Study {
    id: "absorbing-boundaries/table-4",
    paper: PAPER,
    title: "Bar with a soft middle, bonds of half the stiffness",
    run: |context| rows(context, &INTERFACE),
};

pub(super) const TABLE_5: Study = Study {
    id: "absorbing-boundaries/table-5",
    paper: PAPER,
    title: "Bar with a soft middle, bonds of a tenth of the stiffness",
    run: |context| {
        let mut rows = rows(context, &SOFT)?;
        rows.extend(figures::interfaces(context)?);
        Ok(rows)
    },
};

pub(super) const TABLE_6: Study = Study {
    id: "absorbing-boundaries/table-6",
    paper: PAPER,
    title: "Wavelet in a bar with one absorbing and one free end",
    run: |context| {
        let mut rows = figures::seismic(context)?;
        rows.extend(self::rows(context, &SEISMIC)?);
        Ok(rows)
    },
};

fn rows(context: &Context<'_>, table: &Table) -> Result<Vec<Row>, RunError> {
    /// The finest step takes as long as all others.
    const FINEST: f64 = 0.001;
    let reference = table.bar.reference(&table.times)?;
    let mut rows = Vec::new();
    let mut errors = Vec::new();
    for line in &table.lines {
        if line.dt <= FINEST && !context.full {
            continue;
        }
        let of = |kind| -> Result<Vec<f64>, RunError> {
            let states = table.bar.states(kind, line.dt, &table.times)?;
            let pairs = states.iter().zip(&reference);
            Ok(pairs.map(|(a, b)| largest(table.field, a, b)).collect())
        };
        let (paper, exact) = (of(Kind::SemiDiscrete)?, of(Kind::Discrete)?);
        for (column, t) in table.times.iter().enumerate() {
            let printed = line.printed[column];
            let case = format!("dt = {}, t = {t}: largest error", line.dt);
            let row = Row::new(case, "", Some(paper[column])).printed(printed);
            let beside = format!("ends exact for the scheme: {:.3e}", exact[column]);
            let verified = line.misprint.filter(|(at, _)| *at == column);
            rows.push(match verified {
                None => row.within_share(printed, 0.01).note(beside),
                Some((_, verified)) => row.within_share(verified, 0.01).note(format!(
                    "misprint: the neighbouring steps and the order leave {verified:.3e}, recomputed; {beside}"
                )),
            });
        }
        errors.push((line.dt, paper));
    }
    // Of the two finest steps: the wavelet's late errors have a part of higher order at the coarsest, in print as well.
    let [.., coarse, fine] = &errors[..] else {
        return Ok(rows);
    };
    for (column, t) in table.times.iter().enumerate() {
        let order = (coarse.1[column] / fine.1[column]).ln() / (coarse.0 / fine.0).ln();
        rows.push(Row::new(format!("order in dt at t = {t}"), "", Some(order)).within(2.0, 0.02));
    }
    Ok(rows)
}

/// The largest difference over all nodes.
fn largest(field: Field, a: &State, b: &State) -> f64 {
    let (a, b) = match field {
        Field::Displacement => (&a.u, &b.u),
        Field::Velocity => (&a.v, &b.v),
    };
    let pairs = a.iter().zip(b);
    pairs.map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}
