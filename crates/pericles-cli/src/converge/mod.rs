//! `converge`: one number of a deck's runs on finer and finer grids, with the observed order.
//!
//! Two limits are of interest (Bobaru et al., Int. J. Numer. Meth. Engng 77 (2009) 852–877): the horizon δ = m dx to zero at one m, where a
//! nonlocal body becomes a local one (δ-convergence), and the spacing to zero at one horizon, where the sums become the nonlocal integrals
//! (m-convergence). The runs are a sweep, in its folder and with all that sweeps can do.

mod order;
mod scalar;

use std::io::Write;

use pericles_io::{Axis as ChartAxis, Curve, LineChart, csv_row, write_atomically};

use crate::args::ConvergeArgs;
use crate::console;
use crate::error::CliError;
use crate::exit::Exit;
use crate::sweep::{Axis, Settings, Sweep};
use crate::units::{quantity, significant};

use self::order::observed_order;
use self::scalar::Scalar;

/// One run.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Point {
    spacing: f64,
    horizon: f64,
    value: f64,
}

impl Point {
    /// Rounded, for the horizon is a product of decimal fractions.
    fn ratio(&self) -> f64 {
        (1e6 * self.horizon / self.spacing).round() / 1e6
    }
}

/// Runs that approach a limit together, the coarsest first.
struct Family {
    /// What they have in common: `m = 3`, `δ = 40.0 mm`.
    name: String,
    points: Vec<Point>,
}

impl Family {
    /// The observed order at a run: of the distance from the reference since the run before, or of the last three results without one.
    fn order(&self, at: usize, reference: Option<f64>) -> Option<f64> {
        let pairs: Vec<(f64, f64)> = self.points[..=at]
            .iter()
            .map(|point| (point.spacing, point.value))
            .collect();
        observed_order(&pairs, reference)
    }
}

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
    let sweep = Sweep::begun(
        &args.deck,
        &overrides,
        axes,
        args.out.as_deref(),
        "-converge",
    )?;
    let settings = Settings::new(&args.options);
    let exit = sweep.drive(&settings)?;
    if exit != Exit::Done {
        return Ok(exit);
    }
    let scalar = Scalar::named(&args.scalar);
    let mut points = Vec::new();
    let mut unit = String::new();
    for results in sweep.results() {
        let value;
        (value, unit) = scalar.of(&results)?;
        points.push(Point {
            spacing: results.number("/model/spacing").unwrap_or(f64::NAN),
            horizon: results.number("/model/horizon").unwrap_or(f64::NAN),
            value,
        });
    }
    let families = families(points, args.horizon.is_some());
    write_table(&sweep, &families, args)?;
    chart(&families, args, &unit).write(sweep.folder().file("convergence.png"))?;
    show(&families, args)?;
    console::print(format_args!(
        "convergence.csv and convergence.png in {}",
        sweep.folder().path().display()
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

/// Runs of one horizon, or of one ratio, from coarse to fine.
fn families(mut points: Vec<Point>, one_horizon: bool) -> Vec<Family> {
    points.sort_by(|a, b| b.spacing.total_cmp(&a.spacing));
    let mut families: Vec<Family> = Vec::new();
    for point in points {
        let name = if one_horizon {
            format!("δ = {}", quantity(point.horizon, "m"))
        } else {
            format!("m = {}", point.ratio())
        };
        match families.iter_mut().find(|family| family.name == name) {
            Some(family) => family.points.push(point),
            None => families.push(Family {
                name,
                points: vec![point],
            }),
        }
    }
    families.sort_by(|a, b| a.points[0].ratio().total_cmp(&b.points[0].ratio()));
    families
}

/// All runs with the order that is observed there.
fn rows(
    families: &[Family],
    reference: Option<f64>,
) -> impl Iterator<Item = (&Family, Point, Option<f64>)> {
    families.iter().flat_map(move |family| {
        let numbered = family.points.iter().enumerate();
        numbered.map(move |(k, point)| (family, *point, family.order(k, reference)))
    })
}

fn write_table(sweep: &Sweep, families: &[Family], args: &ConvergeArgs) -> Result<(), CliError> {
    let mut header: Vec<String> = ["m", "spacing [m]", "horizon [m]"].map(String::from).into();
    header.push(args.scalar.clone());
    if args.reference.is_some() {
        header.push("distance".into());
    }
    header.push("order".into());
    let mut table = vec![header];
    for (_, point, order) in rows(families, args.reference) {
        let mut row = vec![point.ratio(), point.spacing, point.horizon, point.value];
        row.extend(args.reference.map(|reference| point.value - reference));
        let mut row: Vec<String> = row.iter().map(|number| format!("{number:?}")).collect();
        row.push(order.map_or(String::new(), |order| format!("{order:?}")));
        table.push(row);
    }
    Ok(write_atomically(
        &sweep.folder().file("convergence.csv"),
        |file| {
            let mut rows = table.iter();
            rows.try_for_each(|row| file.write_all(csv_row(row).as_bytes()))
        },
    )?)
}

/// The distance from the reference on logarithmic axes, or the number itself without one.
fn chart(families: &[Family], args: &ConvergeArgs, unit: &str) -> LineChart {
    let name = args.scalar.replace('_', " ");
    let x = ChartAxis::new("spacing", "m");
    let (x, y) = match args.reference {
        Some(_) => (
            x.logarithmic(),
            ChartAxis::new(format!("|{name} − reference|"), unit).logarithmic(),
        ),
        None => (x, ChartAxis::new(name, unit)),
    };
    let mut chart = LineChart::new(x, y);
    for family in families {
        let spacings: Vec<f64> = family.points.iter().map(|point| point.spacing).collect();
        let values: Vec<f64> = family
            .points
            .iter()
            .map(|point| match args.reference {
                Some(reference) => (point.value - reference).abs(),
                None => point.value,
            })
            .collect();
        chart = chart.curve(Curve::line(&family.name, &spacings, &values).with_markers());
    }
    chart
}

fn show(families: &[Family], args: &ConvergeArgs) -> Result<(), CliError> {
    let mut last = "";
    for (family, point, order) in rows(families, args.reference) {
        if family.name != last {
            last = &family.name;
            console::print(format_args!("{last}"))?;
        }
        let mut line = format!(
            "  dx {:<8}  {} {}",
            quantity(point.spacing, "m"),
            args.scalar,
            significant(point.value, 8)
        );
        if let Some(reference) = args.reference {
            line += &format!("  off by {}", significant(point.value - reference, 3));
        }
        if let Some(order) = order {
            line += &format!("  order {order:.2}");
        }
        console::print(format_args!("{line}"))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn families_are_told_apart_and_run_from_coarse_to_fine() {
        let point = |spacing: f64, m: f64| Point {
            spacing,
            horizon: m * spacing,
            value: 1.0,
        };
        let all = vec![
            point(0.1, 3.0),
            point(0.05, 2.0),
            point(0.2, 3.0),
            point(0.1, 2.0),
        ];
        let found = families(all, false);
        let names: Vec<&str> = found.iter().map(|family| &family.name[..]).collect();
        assert_eq!(names, ["m = 2", "m = 3"]);
        let spacings: Vec<f64> = found[1].points.iter().map(|point| point.spacing).collect();
        assert_eq!(spacings, [0.2, 0.1]);
        let fixed = vec![point(0.1, 2.0), point(0.05, 4.0)];
        let found = families(fixed, true);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].name, "δ = 200 mm");
    }
}
