//! Charts of table columns over time, one per unit.

use std::path::Path;

use pericles_io::observers::profile_chart;
use pericles_io::{Axis, CsvData, Curve, IoError, LineChart, read_csv};

use pericles_run::{Results, TimeAxis};

/// Most curves per chart: more are not distinguishable.
const MOST_CURVES: usize = 8;
/// Most points per curve: more than the width of a chart in pixels are not visible.
const MOST_POINTS: usize = 4000;

/// Momenta below this share of √(2 · kinetic energy · mass) are round-off.
const ROUND_OFF: f64 = 1e-9;

/// Scales of the charts of a run.
pub(crate) struct Scales {
    along: TimeAxis,
    /// Mass of the body, kg; zero if unknown.
    mass: f64,
}

impl Scales {
    /// Returns the scales of a run.
    pub(crate) fn of(results: &Results) -> Self {
        Self {
            along: TimeAxis::of(results),
            mass: results.number("/model/mass").unwrap_or_default(),
        }
    }

    /// Returns the momentum (kg m/s) below which the momenta of a history are round-off.
    fn smallest_momentum(&self, history: &CsvData) -> f64 {
        let energies = history.column("kinetic_energy").unwrap_or_default();
        let largest = energies.iter().copied().fold(0.0, f64::max);
        ROUND_OFF * (2.0 * largest * self.mass).sqrt()
    }
}

/// Curves of one unit over time.
pub(crate) struct Chart {
    /// Common name of the curves, such as `energy`, or the name of a single curve.
    pub(crate) name: String,
    /// The unit of the curves.
    pub(crate) unit: String,
    /// The horizontal axis.
    pub(crate) along: TimeAxis,
    /// Times in the unit of the axis.
    pub(crate) time: Vec<f64>,
    /// Names and values.
    pub(crate) curves: Vec<(String, Vec<f64>)>,
}

impl Chart {
    /// Returns the chart as a picture.
    pub(crate) fn drawn(&self) -> LineChart {
        let axes = (
            self.along.axis(),
            Axis::new(self.name.clone(), self.unit.clone()),
        );
        let several = self.curves.len() > 1;
        let curves = self.curves.iter();
        curves.fold(LineChart::new(axes.0, axes.1), |chart, (name, values)| {
            let label = if several { name.clone() } else { String::new() };
            chart.curve(Curve::line(label, &self.time, values))
        })
    }
}

/// Returns charts of the selected columns of a table over its column `time`, with the scales of the run. A table without this
/// column or with fewer than two rows has no charts. Constant columns, momenta that are round-off and step numbers are
/// omitted.
///
/// # Errors
/// The table cannot be read.
pub(crate) fn of_table(
    path: &Path,
    scales: &Scales,
    mut wanted: impl FnMut(&str) -> bool,
) -> Result<Vec<Chart>, IoError> {
    let table = read_csv(path)?;
    let Some(time) = table.column("time").filter(|time| time.len() > 1) else {
        return Ok(Vec::new());
    };
    let smallest = scales.smallest_momentum(&table);
    let stride = time.len().div_ceil(MOST_POINTS);
    let mut charts: Vec<Chart> = Vec::new();
    for (column, values) in table.columns.iter().zip(&table.values) {
        let changes = values.iter().any(|x| *x != values[0] && !x.is_nan());
        let is_momentum = column.name().starts_with("momentum_");
        let is_round_off = is_momentum && values.iter().all(|p| p.abs() < smallest);
        let is_left = is_round_off || !changes || ["step", "time"].contains(&column.name());
        if !wanted(column.name()) || is_left {
            continue;
        }
        let curve = (column.name().to_owned(), thinned(values, stride));
        // Dimensionless columns have no common scale: a ratio would be invisible beside a count.
        let alike = |chart: &&mut Chart| {
            let unit = column.unit();
            !unit.is_empty() && chart.unit == unit && chart.curves.len() < MOST_CURVES
        };
        match charts.iter_mut().find(alike) {
            Some(chart) => chart.curves.push(curve),
            None => charts.push(Chart {
                name: String::new(),
                unit: column.unit().to_owned(),
                along: scales.along,
                time: scales.along.scaled(&thinned(time, stride)),
                curves: vec![curve],
            }),
        }
    }
    for chart in &mut charts {
        let names: Vec<&str> = chart.curves.iter().map(|(name, _)| name.as_str()).collect();
        chart.name = common_words(&names, &chart.unit);
        for (name, _) in &mut chart.curves {
            *name = name.replace('_', " ");
        }
    }
    Ok(charts)
}

/// Returns the chart of a table of a field along a line; `None` for other tables.
///
/// # Errors
/// The table cannot be read.
pub(crate) fn of_profile(path: &Path) -> Result<Option<LineChart>, IoError> {
    let table = read_csv(path)?;
    // The place follows the distance, then the field and a known solution.
    let values = |k: usize| table.values.get(k).map(Vec::as_slice);
    let columns = &table.columns;
    let is_profile = columns
        .first()
        .is_some_and(|first| first.name() == "distance");
    Ok(match (values(0), columns.get(4), values(4)) {
        (Some(distances), Some(field), Some(numbers)) if is_profile => {
            let what = (field.name(), field.unit());
            Some(profile_chart(distances, what, numbers, values(5)))
        }
        _ => None,
    })
}

fn thinned(values: &[f64], stride: usize) -> Vec<f64> {
    values.iter().copied().step_by(stride).collect()
}

/// Returns the common last or first words of the names or, without any, the quantity that the unit measures.
fn common_words(names: &[&str], unit: &str) -> String {
    let words: Vec<Vec<&str>> = names.iter().map(|name| name.split('_').collect()).collect();
    let Some(first) = words.first() else {
        return String::new();
    };
    let shared = |matches: &dyn Fn(&Vec<&str>, usize) -> bool| {
        (1..=first.len())
            .take_while(|&count| words.iter().all(|words| matches(words, count)))
            .count()
    };
    let ending = shared(&|words, count| words.ends_with(&first[first.len() - count..]));
    let beginning = shared(&|words, count| words.starts_with(&first[..count]));
    match (ending, beginning) {
        (0, 0) => match unit {
            "J" | "J/m" | "J/m2" => "energy".into(),
            "N" | "N/m" | "N/m2" => "force".into(),
            "m" => "length".into(),
            "m/s" => "velocity".into(),
            _ => "value".into(),
        },
        (0, count) => first[..count].join(" "),
        (count, _) => first[first.len() - count..].join(" "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn charts_are_named_after_the_common_words_of_their_curves() {
        assert_eq!(
            common_words(&["kinetic_energy", "elastic_energy"], "J"),
            "energy"
        );
        assert_eq!(common_words(&["corner_u_x", "corner_u_y"], "m"), "corner u");
        assert_eq!(common_words(&["external_work"], "J"), "external work");
        assert_eq!(common_words(&["work", "drift"], "J"), "energy");
    }

    #[test]
    fn columns_are_grouped_by_unit_and_constant_columns_are_omitted() {
        let scales = Scales {
            along: TimeAxis::TIME,
            mass: 1.0,
        };
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("a.csv");
        let text = "step,time [s],a [J],b [J],c [N],still [N],ratio,count\n0,0,1,2,3,7,0,0\n1,1,2,3,4,7,0.5,9\n";
        std::fs::write(&path, text).unwrap();
        let names: Vec<String> = of_table(&path, &scales, |_| true)
            .unwrap()
            .into_iter()
            .map(|chart| chart.name)
            .collect();
        assert_eq!(names, ["energy", "c", "ratio", "count"]);

        let text = "time [s],kinetic_energy [J],momentum_x [kg m/s],momentum_y [kg m/s]\n0,0,0,0\n1,2,1e-3,2e-15\n";
        std::fs::write(&path, text).unwrap();
        let charts = of_table(&path, &scales, |_| true).unwrap();
        assert_eq!(charts[1].curves.len(), 1);
        assert_eq!(charts[1].name, "momentum x");
    }
}
