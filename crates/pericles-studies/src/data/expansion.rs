//! Expands the data of a study into rows and figures.

use std::collections::BTreeMap;
use std::rc::Rc;

use pericles_io::{Axis, Curve, LineChart};
use pericles_run::RunError;
use serde::Deserialize;
use toml::{Table, Value};

use super::case::{Case, Found, Measure, Shared, number};
use super::format::{Figure, Measured, Rows, StudyData, Style, When};
use super::template;
use crate::context::Context;
use crate::row::{Row, Rule};

/// Computes the rows of a study and draws its figures.
///
/// # Errors
/// Unknown names in the data, figures that cannot be written, and errors of runs.
pub(crate) fn rows(
    data: &StudyData,
    measures: &'static [Measure],
    context: &Context<'_>,
) -> Result<Vec<Row>, RunError> {
    let mut expansion = Expansion {
        measures,
        context,
        figures: &data.figure,
        shared: Shared::default(),
        known: Vec::new(),
        charts: Vec::new(),
        rows: Vec::new(),
    };
    for rows in &data.row {
        expansion.add(rows, &Place::default())?;
    }
    for (file, chart) in &expansion.charts {
        if let Some(path) = context.figure(file) {
            chart.write(path)?;
        }
    }
    Ok(expansion.rows)
}

/// Result with the arguments that its function requested.
struct Known {
    measure: String,
    asked: BTreeMap<String, Option<Value>>,
    found: Rc<Found>,
}

struct Expansion<'a> {
    measures: &'static [Measure],
    context: &'a Context<'a>,
    figures: &'a [Figure],
    shared: Shared,
    known: Vec<Known>,
    charts: Vec<(String, LineChart)>,
    rows: Vec<Row>,
}

/// Place of axes: its index on each, and the arguments there.
#[derive(Debug, Default, Clone)]
struct Place {
    index: Vec<usize>,
    arguments: Table,
}

impl Place {
    /// Places of an axis within this one.
    fn along(&self, axis: &BTreeMap<String, Vec<Value>>, full: bool) -> Vec<Self> {
        let count = axis.values().map(Vec::len).min().unwrap_or(0);
        let place = |k: usize| {
            let mut place = self.clone();
            place.index.push(k);
            for (name, column) in axis {
                place.arguments.insert(name.clone(), column[k].clone());
            }
            let when = place.arguments.remove("when");
            let when = when.map_or(Some(When::Always), |when| When::deserialize(when).ok());
            when.is_some_and(|when| when.holds(full)).then_some(place)
        };
        (0..count).filter_map(place).collect()
    }

    /// Entry of a list of lists at this place; a list of one entry holds for all places of its axis.
    fn entry<'a>(&self, cells: Option<&'a Value>) -> Option<&'a Value> {
        let enter = |cells: &'a Value, k: &usize| match cells {
            Value::Array(list) if list.len() == 1 => list.first(),
            Value::Array(list) => list.get(*k),
            single => Some(single),
        };
        self.index.iter().try_fold(cells?, enter)
    }
}

impl Expansion<'_> {
    /// Adds the rows of one entry of the data.
    fn add(&mut self, rows: &Rows, around: &Place) -> Result<(), RunError> {
        if !rows.when.holds(self.context.full) {
            return Ok(());
        }
        let mut start = around.clone();
        start.arguments.extend(rows.with.clone());
        let mut places = vec![start];
        for axis in &rows.axes {
            let along = |place: &Place| place.along(axis, self.context.full);
            places = places.iter().flat_map(along).collect();
        }
        for place in &places {
            for inner in &rows.row {
                self.add(&inner.within(rows), place)?;
            }
            if rows.row.is_empty() {
                self.add_row(rows, place)?;
            }
        }
        Ok(())
    }

    fn add_row(&mut self, row: &Rows, place: &Place) -> Result<(), RunError> {
        let name = row.measure.as_deref().unwrap_or_default();
        let found = self.found(name, &place.arguments)?;
        self.draw(&row.draw, place, &found)?;
        let Some(label) = &row.label else {
            self.rows.extend(found.rows.iter().cloned());
            return Ok(());
        };
        let text = |text: &str| expanded(text, place, &found);
        let value = text(row.value.as_deref().unwrap_or("value"))?;
        let computed = found.number(&value);
        let computed = computed.ok_or_else(|| unknown("result", &value))?;
        let number = |cells: &Option<Value>| number_of(place.entry(cells.as_ref()), place, &found);
        let mut made = Row::new(text(label)?, row.unit.clone().unwrap_or_default(), computed);
        made.printed = number(&row.printed)?;
        let judged = [
            (&row.below, Some(Rule::AtMost)),
            (&row.above, Some(Rule::AtLeast)),
            (&row.expected, None),
        ];
        let judged = judged.into_iter().find(|(value, _)| value.is_some());
        if let Some((value, rule)) = judged {
            let expected = match value {
                Some(Value::String(name)) if name == "printed" => made.printed,
                // A result that is missing or NaN fails the row.
                Some(Value::String(_)) => Some(number(value)?.unwrap_or(f64::NAN)),
                value => number(value)?,
            };
            let Some(expected) = expected else {
                return Ok(());
            };
            let tolerance = |cells| Ok::<_, RunError>(number(cells)?.unwrap_or_default());
            let rule = match (rule, &row.absolute) {
                (Some(rule), _) => rule,
                (None, absolute @ Some(_)) => Rule::Absolute(tolerance(absolute)?),
                (None, None) => Rule::Relative(tolerance(&row.relative)?),
            };
            made = made.judged(expected, rule);
        }
        if let Some(Measured { low, high }) = &row.measured {
            let limit = |cells: &Value| number(&Some(cells.clone()));
            let (Some(low), Some(high)) = (limit(low)?, limit(high)?) else {
                return Ok(());
            };
            made = made.measured([low, high]);
            let spread = found.number("least").zip(found.number("greatest"));
            made.spread = spread.and_then(|(least, greatest)| Some([least?, greatest?]));
        }
        if let Some(Value::String(note)) = place.entry(row.note.as_ref()) {
            made.note = text(note)?;
        }
        self.rows.push(made);
        Ok(())
    }

    /// Returns the result of a function, which runs once for the same arguments.
    fn found(&mut self, name: &str, arguments: &Table) -> Result<Rc<Found>, RunError> {
        let same = |known: &&Known| {
            let mut asked = known.asked.iter();
            let now = |name: &str| template::argument(arguments, name);
            known.measure == name && asked.all(|(name, value)| now(name) == *value)
        };
        if let Some(known) = self.known.iter().find(same) {
            return Ok(Rc::clone(&known.found));
        }
        let measure = self.measures.iter().find(|(known, _)| *known == name);
        let (_, measure) = measure.ok_or_else(|| unknown("measure", name))?;
        let case = Case::new(arguments, self.context, &self.shared);
        let found = Rc::new(measure(&case)?);
        let asked = case.into_asked().into_iter();
        self.known.push(Known {
            measure: name.to_owned(),
            asked: asked
                .map(|name| {
                    let value = template::argument(arguments, &name);
                    (name, value)
                })
                .collect(),
            found: Rc::clone(&found),
        });
        Ok(found)
    }

    fn draw(&mut self, names: &[String], place: &Place, found: &Found) -> Result<(), RunError> {
        if self.context.figures.is_none() {
            return Ok(());
        }
        for name in names {
            let figure = self.figures.iter().find(|figure| figure.curves == *name);
            let figure = figure.ok_or_else(|| unknown("figure", name))?;
            let text = |text: &str| expanded(text, place, found);
            let file = text(&figure.file)?;
            let known = self.charts.iter().position(|(known, _)| *known == file);
            let mut chart = match known {
                Some(known) => self.charts.remove(known).1,
                None => figure.chart(text(&figure.title)?),
            };
            for drawn in found.curves.iter().filter(|drawn| drawn.name == *name) {
                let label = match &drawn.label {
                    Some(label) => label.clone(),
                    None => text(&figure.label)?,
                };
                chart = chart.curve(figure.curve(label, &drawn.x, &drawn.y));
            }
            self.charts
                .insert(known.unwrap_or(self.charts.len()), (file, chart));
        }
        Ok(())
    }
}

impl Figure {
    fn chart(&self, title: String) -> LineChart {
        let [x, y] = [&self.x, &self.y].map(|[name, unit]| Axis::new(name, unit));
        let y = if self.logarithmic { y.logarithmic() } else { y };
        let mut chart = LineChart::new(x, y);
        if !title.is_empty() {
            chart = chart.title(title);
        }
        if self.key_beside {
            chart = chart.key_beside();
        }
        chart
    }

    fn curve(&self, label: String, x: &[f64], y: &[f64]) -> Curve {
        match self.style {
            Style::Line => Curve::line(label, x, y),
            Style::Dashed => Curve::line(label, x, y).dashed(),
            Style::Markers => Curve::line(label, x, y).with_markers(),
            Style::Points => Curve::points(label, x, y),
        }
    }
}

fn unknown(kind: &'static str, name: &str) -> RunError {
    RunError::unknown(kind, name, [""; 0], "it is named in the study's data")
}

/// Argument, with names in its text replaced, or result.
fn shown(name: &str, place: &Place, found: &Found) -> Option<Value> {
    match place.arguments.get(name) {
        None => found.shown(name),
        Some(Value::String(text)) => {
            let inner = template::expand(text, &|other| shown(other, place, found));
            inner.ok().map(Value::String)
        }
        Some(value) => Some(value.clone()),
    }
}

/// Expands a template with the arguments and results of a place.
fn expanded(text: &str, place: &Place, found: &Found) -> Result<String, RunError> {
    template::expand(text, &|name| shown(name, place, found))
        .map_err(|name| unknown("argument or result", &name))
}

/// Number that a cell contains or names; `None` for NaN.
fn number_of(cell: Option<&Value>, place: &Place, found: &Found) -> Result<Option<f64>, RunError> {
    let Some(cell) = cell else {
        return Ok(None);
    };
    let value = match cell {
        Value::String(name) => match (place.arguments.get(name), found.number(name)) {
            (Some(argument), _) => number(argument),
            (None, Some(value)) => value,
            _ => return Err(unknown("argument or result", name)),
        },
        cell => Some(number(cell).ok_or_else(|| unknown("number", &cell.to_string()))?),
    };
    Ok(value.filter(|value| !value.is_nan()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 10 a + b, and how often it was computed.
    fn sum(case: &Case<'_>) -> Result<Found, RunError> {
        let [a, b] = [case.number("a")?, case.number("b")?];
        let runs = case.once("runs".into(), || Ok(std::cell::Cell::new(0)))?;
        runs.set(runs.get() + 1);
        Ok([("value", 10.0 * a + b), ("runs", f64::from(runs.get()))].into())
    }

    fn rows_of(text: &str, full: bool) -> Result<Vec<Row>, RunError> {
        rows_by(text, full, &[("sum", sum)])
    }

    fn rows_by(text: &str, full: bool, measures: &'static [Measure]) -> Result<Vec<Row>, RunError> {
        let text = format!("paper = \"\"\ntitle = \"\"\n{text}");
        let data = StudyData::read(&text).unwrap();
        let context = Context {
            full,
            figures: None,
            tell: &|_| {},
        };
        rows(&data, measures, &context)
    }

    const AXES: &str = r#"
[[row]]
measure = "sum"
with = { b = 0, name = "a = {a}" }
axes = [{ a = [1, 2, 3], when = ["always", "full", "always"] }, { b = [4, 5] }]
label = "{name}, b = {b}: {value:.1}"
expected = [[14], [24, 25], [34, nan]]
relative = 0.5
note = [["first", ""], [], ["{runs} runs", ""]]
[[row.row]]
[[row.row]]
label = "runs"
value = "runs"
expected = "value"
absolute = 30
"#;

    #[test]
    fn rows_are_expanded_along_axes() {
        let found = rows_of(AXES, false).unwrap();
        let labels: Vec<&str> = found.iter().map(|row| &row.case[..]).collect();
        assert_eq!(labels[0], "a = 1, b = 4: 14.0");
        assert_eq!(labels[1..3], ["runs", "a = 1, b = 5: 15.0"]);
        assert_eq!(labels[4], "a = 3, b = 4: 34.0");
        // A list of one entry holds for all places, and there is no row where the expected value is NaN.
        assert_eq!(labels.len(), 7);
        assert_eq!(rows_of(AXES, true).unwrap().len(), 11);
        let expected: Vec<Option<f64>> = found.iter().map(|row| row.expected).collect();
        let numbers = [14.0, 14.0, 14.0, 15.0, 34.0, 34.0].map(Some);
        assert_eq!(expected[..6], numbers);
        assert_eq!(expected[6..], [Some(35.0)]);
        assert_eq!(found[0].rule, Rule::Relative(0.5));
        assert_eq!(found[1].rule, Rule::Absolute(30.0));
        // The measure runs once for each place.
        assert_eq!(found[6].computed, Some(4.0));
        let notes: Vec<&str> = found.iter().map(|row| &row.note[..]).collect();
        assert_eq!(notes[..4], ["first", "first", "", ""]);
        assert_eq!(notes[4], "3 runs");
    }

    const BOUNDS: &str = r#"
[[row]]
measure = "sum"
with = { a = 1 }
axes = [{ b = [2, 4] }]
label = "{b}"
expected = 12
absolute = 1
[[row.row]]
[[row.row]]
below = [13, nan]
[[row.row]]
above = "missing"
[[row.row]]
below = 13
[[row.row.row]]
expected = 12
absolute = 3
[[row.row]]
value = "missing"
"#;

    #[test]
    fn bounds_replace_expected_values() {
        let measure: Measure = ("sum", |case| Ok(sum(case)?.value("missing", None)));
        let found = rows_by(BOUNDS, false, vec![measure].leak()).unwrap();
        let rules: Vec<(Option<f64>, Rule)> = found.iter().map(|r| (r.expected, r.rule)).collect();
        assert_eq!(rules[0], (Some(12.0), Rule::Absolute(1.0)));
        assert_eq!(rules[1], (Some(13.0), Rule::AtMost));
        assert_eq!(rules[2].1, Rule::AtLeast);
        assert_eq!(rules[3], (Some(12.0), Rule::Absolute(3.0)));
        let pass: Vec<Option<bool>> = found.iter().map(Row::pass).collect();
        // A bound or a value that was not computed fails.
        let first = [true, true, false, true, false].map(Some);
        assert_eq!(pass[..5], first);
        // There is no row at the second place of the list of upper bounds.
        let second = [false, false, true, false].map(Some);
        assert_eq!(pass[5..], second);
    }

    #[test]
    fn unknown_names_are_errors() {
        let refused = |text: &str, part: &str| {
            let error = rows_of(text, false).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        };
        refused("[[row]]\nmeasure = \"some\"", "measure \"some\"");
        refused("[[row]]\nmeasure = \"sum\"", "number \"a\"");
        let sum = "[[row]]\nmeasure = \"sum\"\nwith = { a = 1, b = 2 }";
        refused(&format!("{sum}\nlabel = \"{{c}}\""), "\"c\"");
        refused(
            &format!("{sum}\nlabel = \"\"\nvalue = \"x\""),
            "result \"x\"",
        );
        refused(&format!("{sum}\nlabel = \"\"\nexpected = \"y\""), "\"y\"");
    }
}
