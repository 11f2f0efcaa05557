//! Convergence studies: a scalar over successively finer grids, with the observed order.
//!
//! Two limits of the grid are of interest (Bobaru et al., Int. J. Numer. Meth. Engng 77 (2009) 852–877): δ-convergence, where the horizon
//! δ = m dx tends to zero at fixed m and the nonlocal model approaches the local one, and m-convergence, where the spacing
//! tends to zero at fixed horizon and the sums approach the nonlocal integrals. A third one is the limit of the time step on a
//! fixed grid. The runs form a sweep.

mod family;
mod order;

use std::path::Path;

use pericles_io::{Axis, Curve, LineChart};

use self::family::{Family, Point, families};
use crate::error::RunError;
use crate::json::write_rows;
use crate::scalar::Scalar;
use crate::sweep::SweepResults;
use crate::units::{quantity, significant};

/// The scalar, its reference value, and the limit.
#[derive(Debug, Clone)]
pub struct Question {
    /// The scalar: a column of the tables (last value), `max:COLUMN`, `min:COLUMN`, or a number of `run.json` such as
    /// `audit.elastic_energy`.
    pub scalar: String,
    /// The reference value.
    pub reference: Option<f64>,
    /// The limit that the runs approach.
    pub limit: Limit,
}

/// The limit of a family of runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Limit {
    /// Spacing and horizon tend to zero at a fixed ratio m (δ-convergence).
    Local,
    /// The spacing tends to zero at a fixed horizon (m-convergence).
    Nonlocal,
    /// The time step tends to zero on a fixed grid.
    Time,
}

impl Limit {
    /// Returns the quantity that tends to zero: the spacing, m, or the time step, s.
    fn step(self, point: &Point) -> f64 {
        match self {
            Self::Local | Self::Nonlocal => point.spacing,
            Self::Time => point.dt,
        }
    }

    /// Returns its name and unit.
    fn axis(self) -> (&'static str, &'static str) {
        match self {
            Self::Local | Self::Nonlocal => ("spacing", "m"),
            Self::Time => ("time step", "s"),
        }
    }
}

/// The scalar of the runs of a sweep, by family, from coarse to fine.
pub struct Convergence {
    question: Question,
    families: Vec<Family>,
    unit: String,
}

impl Convergence {
    /// Reads the scalar from the results of a sweep over spacings.
    ///
    /// # Errors
    /// The runs do not have the scalar, or a table is damaged.
    pub fn of(sweep: &SweepResults, question: Question) -> Result<Self, RunError> {
        let scalar = Scalar::named(&question.scalar);
        let mut points = Vec::new();
        let mut unit = String::new();
        for results in sweep.runs().filter_map(|(_, results)| results) {
            let value;
            (value, unit) = scalar.of(&results)?;
            points.push(Point {
                spacing: results.number("/model/spacing").unwrap_or(f64::NAN),
                horizon: results.number("/model/horizon").unwrap_or(f64::NAN),
                dt: results.number("/model/dt").unwrap_or(f64::NAN),
                value,
            });
        }
        Ok(Self {
            families: families(points, question.limit),
            question,
            unit,
        })
    }

    /// Returns all runs with the observed order.
    fn rows(&self) -> impl Iterator<Item = (&Family, Point, Option<f64>)> {
        let (reference, limit) = (self.question.reference, self.question.limit);
        self.families.iter().flat_map(move |family| {
            let numbered = family.points.iter().enumerate();
            numbered.map(move |(k, point)| (family, *point, family.order(k, limit, reference)))
        })
    }

    /// Writes a CSV table with a row per run.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), RunError> {
        let Question {
            scalar,
            reference,
            limit,
        } = &self.question;
        let mut header: Vec<String> = ["m", "spacing [m]", "horizon [m]"].map(String::from).into();
        if *limit == Limit::Time {
            header.push("dt [s]".into());
        }
        header.push(scalar.clone());
        if reference.is_some() {
            header.push("distance".into());
        }
        header.push("order".into());
        let mut table = vec![header];
        for (_, point, order) in self.rows() {
            let mut row = vec![point.ratio(), point.spacing, point.horizon];
            row.extend((*limit == Limit::Time).then_some(point.dt));
            row.push(point.value);
            row.extend(reference.map(|reference| point.value - reference));
            let mut row: Vec<String> = row.iter().map(|number| format!("{number:?}")).collect();
            row.push(order.map_or(String::new(), |order| format!("{order:?}")));
            table.push(row);
        }
        write_rows(path, &table)
    }

    /// Returns a chart of the error on logarithmic axes or, without a reference, of the scalar.
    pub fn chart(&self) -> LineChart {
        let Question {
            scalar,
            reference,
            limit,
        } = &self.question;
        let name = Scalar::named(scalar).title();
        let unit = self.unit.as_str();
        let (step, step_unit) = limit.axis();
        let x = Axis::new(step, step_unit).logarithmic();
        let y = match reference {
            Some(_) => Axis::new(format!("error of {name}"), unit).logarithmic(),
            None => Axis::new(name, unit),
        };
        let mut chart = LineChart::new(x, y);
        for family in &self.families {
            let steps: Vec<f64> = family
                .points
                .iter()
                .map(|point| limit.step(point))
                .collect();
            let values: Vec<f64> = family
                .points
                .iter()
                .map(|point| match reference {
                    Some(reference) => (point.value - reference).abs(),
                    None => point.value,
                })
                .collect();
            chart = chart.curve(Curve::line(&family.name, &steps, &values).with_markers());
        }
        chart
    }

    /// Returns a line per family, followed by a line per run.
    pub fn lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        let mut last = "";
        for (family, point, order) in self.rows() {
            if family.name != last {
                last = &family.name;
                lines.push(last.to_owned());
            }
            let mut line = format!(
                "  {} {:<8}  {} {}",
                match self.question.limit {
                    Limit::Local | Limit::Nonlocal => "dx",
                    Limit::Time => "dt",
                },
                quantity(
                    self.question.limit.step(&point),
                    self.question.limit.axis().1
                ),
                self.question.scalar,
                significant(point.value, 8)
            );
            if let Some(reference) = self.question.reference {
                line += &format!("  error {}", significant(point.value - reference, 3));
            }
            if let Some(order) = order {
                line += &format!("  order {order:.2}");
            }
            lines.push(line);
        }
        lines
    }
}
