//! How a number of a deck's runs converges on finer and finer grids, with the observed order.
//!
//! Two limits are of interest (Bobaru et al., Int. J. Numer. Meth. Engng 77 (2009) 852–877): the horizon δ = m dx to zero at one m, where a
//! nonlocal body becomes a local one (δ-convergence), and the spacing to zero at one horizon, where the sums become the nonlocal integrals
//! (m-convergence). The runs are a sweep, in its folder and with all that sweeps can do.

mod family;
mod order;
mod scalar;

use std::io::Write;
use std::path::Path;

use pericles_io::{Axis, Curve, LineChart, csv_row, write_atomically};

use self::family::{Family, Point, families};
use self::scalar::Scalar;
use crate::error::RunError;
use crate::sweep::Sweep;
use crate::units::{quantity, significant};

/// What a number should converge to, and along which limit.
#[derive(Debug, Clone)]
pub struct Question {
    /// The number: a column of the tables for its last value, `max:COLUMN`, `min:COLUMN`, or a number of `run.json` such as `audit.elastic_energy`.
    pub scalar: String,
    /// What it should converge to.
    pub reference: Option<f64>,
    /// Whether all runs have one horizon (m-convergence); otherwise the horizon goes to zero with the spacing (δ-convergence).
    pub one_horizon: bool,
}

/// A number of the runs of a sweep, family by family, from coarse to fine.
pub struct Convergence {
    question: Question,
    families: Vec<Family>,
    unit: String,
}

impl Convergence {
    /// Reads the number from the results of a sweep over spacings.
    ///
    /// # Errors
    /// A number that runs do not have, tables that are damaged.
    pub fn of(sweep: &Sweep, question: Question) -> Result<Self, RunError> {
        let scalar = Scalar::named(&question.scalar);
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
        Ok(Self {
            families: families(points, question.one_horizon),
            question,
            unit,
        })
    }

    /// All runs with the order that is observed there.
    fn rows(&self) -> impl Iterator<Item = (&Family, Point, Option<f64>)> {
        let reference = self.question.reference;
        self.families.iter().flat_map(move |family| {
            let numbered = family.points.iter().enumerate();
            numbered.map(move |(k, point)| (family, *point, family.order(k, reference)))
        })
    }

    /// Writes a row per run as CSV.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), RunError> {
        let Question {
            scalar, reference, ..
        } = &self.question;
        let mut header: Vec<String> = ["m", "spacing [m]", "horizon [m]"].map(String::from).into();
        header.push(scalar.clone());
        if reference.is_some() {
            header.push("distance".into());
        }
        header.push("order".into());
        let mut table = vec![header];
        for (_, point, order) in self.rows() {
            let mut row = vec![point.ratio(), point.spacing, point.horizon, point.value];
            row.extend(reference.map(|reference| point.value - reference));
            let mut row: Vec<String> = row.iter().map(|number| format!("{number:?}")).collect();
            row.push(order.map_or(String::new(), |order| format!("{order:?}")));
            table.push(row);
        }
        Ok(write_atomically(path, |file| {
            let mut rows = table.iter();
            rows.try_for_each(|row| file.write_all(csv_row(row).as_bytes()))
        })?)
    }

    /// The distance from the reference on logarithmic axes, or the number itself without one.
    pub fn chart(&self) -> LineChart {
        let Question {
            scalar, reference, ..
        } = &self.question;
        let name = scalar.replace('_', " ");
        let unit = self.unit.as_str();
        let x = Axis::new("spacing", "m");
        let (x, y) = match reference {
            Some(_) => (
                x.logarithmic(),
                Axis::new(format!("|{name} − reference|"), unit).logarithmic(),
            ),
            None => (x, Axis::new(name, unit)),
        };
        let mut chart = LineChart::new(x, y);
        for family in &self.families {
            let spacings: Vec<f64> = family.points.iter().map(|point| point.spacing).collect();
            let values: Vec<f64> = family
                .points
                .iter()
                .map(|point| match reference {
                    Some(reference) => (point.value - reference).abs(),
                    None => point.value,
                })
                .collect();
            chart = chart.curve(Curve::line(&family.name, &spacings, &values).with_markers());
        }
        chart
    }

    /// A line per family, and one per run below it, for people.
    pub fn lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        let mut last = "";
        for (family, point, order) in self.rows() {
            if family.name != last {
                last = &family.name;
                lines.push(last.to_owned());
            }
            let mut line = format!(
                "  dx {:<8}  {} {}",
                quantity(point.spacing, "m"),
                self.question.scalar,
                significant(point.value, 8)
            );
            if let Some(reference) = self.question.reference {
                line += &format!("  off by {}", significant(point.value - reference, 3));
            }
            if let Some(order) = order {
                line += &format!("  order {order:.2}");
            }
            lines.push(line);
        }
        lines
    }
}
