//! Format of the study data.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::{Table, Value};

/// A study.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StudyData {
    /// Short reference of the paper.
    pub(crate) paper: String,
    /// Subject of the study.
    pub(crate) title: String,
    /// Charts of the curves returned by the measures.
    #[serde(default)]
    pub(super) figure: Vec<Figure>,
    /// Rows in the order of the table.
    pub(super) row: Vec<Rows>,
}

/// Row, or rows with common settings: one for each place of the axes and each inner row, which inherits what it
/// does not set itself.
///
/// Texts are templates: `{name}` is replaced by the argument or result of this name, `{name:.2}` by a number with
/// two decimals and `{name:.2e}` by one in exponential form. Numbers and notes that vary along the axes are lists
/// of lists, the outermost axis first; a list of one entry holds for all places of its axis, and beyond the end of
/// a list there is none. A number given as text is that of an argument or a result.
#[derive(Debug, Default, Clone, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Rows {
    /// Selects the long or the short form of the study.
    pub(super) when: When,
    /// Function that computes the rows.
    pub(super) measure: Option<String>,
    /// Arguments of the function.
    pub(super) with: Table,
    /// Varying arguments. The columns of an axis have equal length and vary together; a column `when` selects the
    /// form of the study.
    pub(super) axes: Vec<BTreeMap<String, Vec<Value>>>,
    /// Label of the row; without a label the rows are those returned by the function, if any.
    pub(super) label: Option<String>,
    /// Result shown; default `value`.
    pub(super) value: Option<String>,
    /// SI unit.
    pub(super) unit: Option<String>,
    /// Value printed in the paper.
    pub(super) printed: Option<Value>,
    /// Value to judge by, or `"printed"`. Where it is NaN or beyond the end of a list, there is no row.
    pub(super) expected: Option<Value>,
    /// Allowed difference relative to |expected|.
    pub(super) relative: Option<Value>,
    /// Allowed difference in the unit of the row.
    pub(super) absolute: Option<Value>,
    /// Upper bound, in place of an expected value with a tolerance.
    pub(super) below: Option<Value>,
    /// Lower bound, in place of an expected value with a tolerance.
    pub(super) above: Option<Value>,
    /// Smallest and largest measured value, `low` and `high`, in place of an expected value or a bound.
    pub(super) measured: Option<Measured>,
    /// Remark for the reader.
    pub(super) note: Option<Value>,
    /// Curves of the result drawn in the figures with these names; not inherited by inner rows.
    pub(super) draw: Vec<String>,
    /// Inner rows.
    pub(super) row: Vec<Rows>,
}

/// Measured range.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Measured {
    pub(super) low: Value,
    pub(super) high: Value,
}

/// Form of the study to which a row belongs.
#[derive(Debug, Default, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum When {
    /// Both forms.
    #[default]
    Always,
    /// Only with `--full`.
    Full,
    /// Only without `--full`.
    Short,
}

/// Chart.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Figure {
    /// Name of the curves.
    pub(super) curves: String,
    /// File name, a template: one chart per file.
    pub(super) file: String,
    /// Title, a template; that of the first curves is used.
    #[serde(default)]
    pub(super) title: String,
    /// Quantity and unit along x.
    pub(super) x: [String; 2],
    /// Quantity and unit along y.
    pub(super) y: [String; 2],
    /// Logarithmic y axis.
    #[serde(default)]
    pub(super) logarithmic: bool,
    /// Place the key beside the chart.
    #[serde(default)]
    pub(super) key_beside: bool,
    /// Label of curves without one, a template.
    #[serde(default)]
    pub(super) label: String,
    /// Style of the curves.
    #[serde(default)]
    pub(super) style: Style,
}

/// Style of curves.
#[derive(Debug, Default, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Style {
    /// Lines.
    #[default]
    Line,
    /// Dashed lines.
    Dashed,
    /// Lines with a marker at each point.
    Markers,
    /// Points.
    Points,
}

impl StudyData {
    /// Parses a file.
    ///
    /// # Errors
    /// Violations of the format.
    pub(crate) fn read(text: &str) -> Result<Self, toml::de::Error> {
        toml::from_str(text)
    }
}

impl When {
    pub(super) fn holds(self, full: bool) -> bool {
        match self {
            Self::Always => true,
            Self::Full => full,
            Self::Short => !full,
        }
    }
}

impl Rows {
    /// Returns these rows with unset values inherited from the enclosing ones.
    pub(super) fn within(&self, around: &Self) -> Self {
        let or = |own: &Option<Value>, other: &Option<Value>| own.clone().or(other.clone());
        let or_text = |own: &Option<String>, other: &Option<String>| own.clone().or(other.clone());
        // A bound replaces the other one and an expected value, and one kind of tolerance the other.
        let bounded = self.below.is_some() || self.above.is_some();
        let none = Self::default();
        let bound = if bounded || self.expected.is_some() {
            self
        } else {
            around
        };
        let expected = if bounded { &none } else { around };
        let tolerance = if self.relative.is_some() || self.absolute.is_some() {
            self
        } else {
            expected
        };
        Self {
            measure: or_text(&self.measure, &around.measure),
            label: or_text(&self.label, &around.label),
            value: or_text(&self.value, &around.value),
            unit: or_text(&self.unit, &around.unit),
            printed: or(&self.printed, &around.printed),
            expected: or(&self.expected, &expected.expected),
            relative: tolerance.relative.clone(),
            absolute: tolerance.absolute.clone(),
            below: bound.below.clone(),
            above: bound.above.clone(),
            measured: self.measured.clone(),
            note: or(&self.note, &around.note),
            ..self.clone()
        }
    }
}

#[cfg(test)]
impl StudyData {
    /// Returns names of functions and figures that do not exist, and labels of rows that are not judged by exactly
    /// one rule; wall times are not judged.
    pub(crate) fn faults(&self, measures: &[super::Measure]) -> Vec<String> {
        let mut unknown = Vec::new();
        let mut open: Vec<Rows> = self.row.clone();
        while let Some(rows) = open.pop() {
            let name = rows.measure.clone().unwrap_or_default();
            let is_leaf = rows.row.is_empty();
            if is_leaf && !measures.iter().any(|(known, _)| *known == name) {
                unknown.push(name);
            }
            let drawn = |name: &&String| self.figure.iter().any(|figure| figure.curves == **name);
            unknown.extend(rows.draw.iter().filter(|name| !drawn(name)).cloned());
            let tolerance = rows.relative.is_some() || rows.absolute.is_some();
            let rules = [
                rows.expected.is_some() && tolerance,
                rows.below.is_some(),
                rows.above.is_some(),
                rows.measured.is_some(),
            ];
            let rules = rules.into_iter().filter(|rule| *rule).count();
            if let (true, Some(label)) = (is_leaf, &rows.label) {
                let required = usize::from(!label.contains("wall time"));
                if rules != required || (rows.expected.is_some() && !tolerance) {
                    unknown.push(label.clone());
                }
            }
            open.extend(rows.row.iter().map(|inner| inner.within(&rows)));
        }
        unknown
    }
}
