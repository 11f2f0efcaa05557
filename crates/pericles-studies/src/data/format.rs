//! The format of the data.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::{Table, Value};

/// A study.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StudyData {
    /// The paper, short.
    pub(crate) paper: String,
    /// What the study shows.
    pub(crate) title: String,
    /// The charts of what the measures return as curves.
    #[serde(default)]
    pub(super) figure: Vec<Figure>,
    /// The rows, in the order of the table.
    pub(super) row: Vec<Rows>,
}

/// A row, or rows that have something in common: one for each place of the axes and each row inside, which takes over what it does not set itself.
///
/// Texts are templates: `{name}` is replaced by the argument or the result of this name, `{name:.2}` by a number with two digits behind the point and `{name:.2e}` by the same with an exponent.
/// Numbers and notes are lists of lists where they differ along the axes, the outermost axis first; a list of one entry holds for all places of its axis, and there are none beyond a list's end. A number that is
/// a text is that of an argument or of a result.
#[derive(Debug, Default, Clone, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(super) struct Rows {
    /// Whether the rows belong to the long study only, or to the short one only.
    pub(super) when: When,
    /// The function that computes them.
    pub(super) measure: Option<String>,
    /// Its arguments.
    pub(super) with: Table,
    /// Arguments that vary. The columns of an axis, which are as long as each other, vary together; a column `when` says where the place is taken.
    pub(super) axes: Vec<BTreeMap<String, Vec<Value>>>,
    /// What the row is; without a label the rows are those that the function returns, if any.
    pub(super) label: Option<String>,
    /// The result it shows; `value` if none is named.
    pub(super) value: Option<String>,
    /// SI unit.
    pub(super) unit: Option<String>,
    /// The number in the paper.
    pub(super) printed: Option<Value>,
    /// The number to judge by, or `"printed"`. NaN: none.
    pub(super) expected: Option<Value>,
    /// The allowed difference over |expected|.
    pub(super) relative: Option<Value>,
    /// The allowed difference in the row's unit.
    pub(super) absolute: Option<Value>,
    /// What a reader should know.
    pub(super) note: Option<Value>,
    /// The curves of the result that are drawn in the figures of their names; not taken over by rows inside.
    pub(super) draw: Vec<String>,
    /// Rows inside.
    pub(super) row: Vec<Rows>,
}

/// Which form of the study a row belongs to.
#[derive(Debug, Default, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum When {
    /// Both.
    #[default]
    Always,
    /// With `--full`.
    Full,
    /// Without `--full`.
    Short,
}

/// A chart.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Figure {
    /// Name of the curves.
    pub(super) curves: String,
    /// Name of the file, a template: one chart for each file.
    pub(super) file: String,
    /// Its title, a template; that of the first curves counts.
    #[serde(default)]
    pub(super) title: String,
    /// Quantity and unit along x.
    pub(super) x: [String; 2],
    /// Quantity and unit along y.
    pub(super) y: [String; 2],
    /// Whether y is logarithmic.
    #[serde(default)]
    pub(super) logarithmic: bool,
    /// Whether the key stands beside the chart.
    #[serde(default)]
    pub(super) key_beside: bool,
    /// Label of a curve that has none of its own, a template.
    #[serde(default)]
    pub(super) label: String,
    /// How the curves are drawn.
    #[serde(default)]
    pub(super) style: Style,
}

/// How curves are drawn.
#[derive(Debug, Default, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Style {
    /// As lines.
    #[default]
    Line,
    /// As dashed lines.
    Dashed,
    /// As lines with a mark at each point.
    Markers,
    /// As points.
    Points,
}

impl StudyData {
    /// Reads a file.
    ///
    /// # Errors
    /// What does not follow the format.
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
    /// These rows with what those around them set and they do not.
    pub(super) fn within(&self, around: &Self) -> Self {
        let or = |own: &Option<Value>, other: &Option<Value>| own.clone().or(other.clone());
        let or_text = |own: &Option<String>, other: &Option<String>| own.clone().or(other.clone());
        // One kind of tolerance takes the place of the other.
        let judged = self.relative.is_some() || self.absolute.is_some();
        let tolerance = if judged { self } else { around };
        Self {
            measure: or_text(&self.measure, &around.measure),
            label: or_text(&self.label, &around.label),
            value: or_text(&self.value, &around.value),
            unit: or_text(&self.unit, &around.unit),
            printed: or(&self.printed, &around.printed),
            expected: or(&self.expected, &around.expected),
            relative: tolerance.relative.clone(),
            absolute: tolerance.absolute.clone(),
            note: or(&self.note, &around.note),
            ..self.clone()
        }
    }
}

#[cfg(test)]
impl StudyData {
    /// Names of functions and figures that do not exist, and labels of rows with a number to judge by or a tolerance only.
    pub(crate) fn unknown_names(&self, measures: &[super::Measure]) -> Vec<String> {
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
            if is_leaf && rows.expected.is_some() && !tolerance {
                unknown.extend(rows.label.clone());
            }
            open.extend(rows.row.iter().map(|inner| inner.within(&rows)));
        }
        unknown
    }
}
