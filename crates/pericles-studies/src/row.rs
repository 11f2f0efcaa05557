//! Row of a study: a computed value beside the expected one.

use std::borrow::Cow;

use serde::Serialize;
use serde::ser::{SerializeStruct, Serializer};

/// Rule by which a row is judged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rule {
    /// At most this difference from the expected value, in the unit of the row.
    Absolute(f64),
    /// At most this fraction of the expected value.
    Relative(f64),
    /// At most the expected value.
    AtMost,
    /// At least the expected value.
    AtLeast,
    /// Compared with the smallest and the largest measured value, without a verdict on the program.
    Measured([f64; 2]),
}

/// Agreement of a computed value with a measured range.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Agreement {
    /// The value is in the range.
    Inside,
    /// The value is outside the range, but its spread overlaps the range.
    Partly,
    /// Neither is in the range.
    Outside,
}

impl Rule {
    /// Tolerance of a two-sided rule.
    pub fn tolerance(self) -> Option<f64> {
        match self {
            Self::Absolute(tolerance) | Self::Relative(tolerance) => Some(tolerance),
            Self::AtMost | Self::AtLeast | Self::Measured(_) => None,
        }
    }

    /// Name of the bound of a one-sided rule.
    fn bound(self) -> Option<&'static str> {
        match self {
            Self::Absolute(_) | Self::Relative(_) | Self::Measured(_) => None,
            Self::AtMost => Some("upper bound"),
            Self::AtLeast => Some("lower bound"),
        }
    }
}

/// Value computed by a study, SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Label.
    pub case: String,
    /// Value printed in the paper.
    pub printed: Option<f64>,
    /// Value to judge by; only wall times and comparisons with measurements have none.
    pub expected: Option<f64>,
    /// Computed value; `None` if the measured event did not happen.
    pub computed: Option<f64>,
    /// Smallest and largest computed value over other spacings, horizons and time steps, if they were computed.
    pub spread: Option<[f64; 2]>,
    /// Comparison with the expected value.
    pub rule: Rule,
    /// Remark for the reader.
    pub note: String,
    /// SI unit for the table; empty for a pure number.
    pub unit: Cow<'static, str>,
}

impl Row {
    /// Creates a row that is not judged.
    pub fn new(
        case: impl Into<String>,
        unit: impl Into<Cow<'static, str>>,
        computed: Option<f64>,
    ) -> Self {
        Self {
            case: case.into(),
            printed: None,
            expected: None,
            computed,
            spread: None,
            rule: Rule::Absolute(0.0),
            note: String::new(),
            unit: unit.into(),
        }
    }

    /// Judges the row by an expected value.
    pub fn judged(mut self, expected: f64, rule: Rule) -> Self {
        self.expected = Some(expected);
        self.rule = rule;
        self
    }

    /// Judges the row by an absolute difference from the expected value.
    pub fn within(self, expected: f64, tolerance: f64) -> Self {
        self.judged(expected, Rule::Absolute(tolerance))
    }

    /// Judges the row by a difference relative to the expected value.
    pub fn within_share(self, expected: f64, tolerance: f64) -> Self {
        self.judged(expected, Rule::Relative(tolerance))
    }

    /// Compares the row with the smallest and the largest measured value.
    pub fn measured(mut self, range: [f64; 2]) -> Self {
        self.rule = Rule::Measured(range);
        self
    }

    /// Sets the value printed in the paper.
    pub fn printed(mut self, printed: f64) -> Self {
        self.printed = Some(printed);
        self
    }

    /// Sets the remark.
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.note = note.into();
        self
    }

    /// Returns whether the rule is satisfied; `None` if the row is not judged. A missing, infinite or NaN value
    /// fails.
    pub fn pass(&self) -> Option<bool> {
        let expected = self.expected?;
        let Some(computed) = self.computed.filter(|computed| computed.is_finite()) else {
            return Some(false);
        };
        let error = (computed - expected).abs();
        // A comparison with NaN is false.
        Some(match self.rule {
            Rule::Absolute(tolerance) => error <= tolerance,
            Rule::Relative(tolerance) => error <= tolerance * expected.abs(),
            Rule::AtMost => computed <= expected,
            Rule::AtLeast => computed >= expected,
            Rule::Measured(_) => return None,
        })
    }

    /// Returns the agreement with the measured range; `None` if the row is not compared with measurements.
    pub fn agreement(&self) -> Option<Agreement> {
        let Rule::Measured([low, high]) = self.rule else {
            return None;
        };
        let inside = |value: f64| low <= value && value <= high;
        let overlaps = |[least, greatest]: [f64; 2]| least <= high && low <= greatest;
        Some(if self.computed.is_some_and(inside) {
            Agreement::Inside
        } else if self.spread.is_some_and(overlaps) {
            Agreement::Partly
        } else {
            Agreement::Outside
        })
    }

    /// Remark, which names the bound of a one-sided rule.
    fn remark(&self) -> String {
        let bound = self.expected.and_then(|_| self.rule.bound());
        let parts = bound.into_iter().chain([&self.note[..]]);
        let parts: Vec<&str> = parts.filter(|part| !part.is_empty()).collect();
        parts.join("; ")
    }
}

/// A one-sided bound is an expected value without a tolerance, and the remark begins with `upper bound` or `lower
/// bound`. Only rows that are compared with measurements have the keys `measured`, `spread` and `agreement`.
impl Serialize for Row {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let finite = |number: Option<f64>| number.filter(|x| x.is_finite());
        let tolerance = self.expected.and_then(|_| self.rule.tolerance());
        let absolute = self.expected.is_some() && !matches!(self.rule, Rule::Relative(_));
        let measured = match self.rule {
            Rule::Measured(range) => Some(range),
            _ => None,
        };
        let fields = if measured.is_some() { 11 } else { 8 };
        let mut row = serializer.serialize_struct("Row", fields)?;
        row.serialize_field("case", &self.case)?;
        row.serialize_field("printed", &finite(self.printed))?;
        row.serialize_field("expected", &finite(self.expected))?;
        row.serialize_field("computed", &finite(self.computed))?;
        row.serialize_field("tolerance", &tolerance)?;
        row.serialize_field("absolute", &absolute)?;
        row.serialize_field("pass", &self.pass())?;
        if let Some(range) = measured {
            row.serialize_field("measured", &range)?;
            row.serialize_field("spread", &self.spread)?;
            row.serialize_field("agreement", &self.agreement())?;
        }
        row.serialize_field("note", &self.remark())?;
        row.end()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn rows_are_judged_by_their_tolerance() {
        let row = |computed: f64| Row::new("a", "m", Some(computed));
        assert_eq!(row(1.0).pass(), None);
        assert_eq!(row(1.05).within(1.0, 0.1).pass(), Some(true));
        assert_eq!(row(1.15).within(1.0, 0.1).pass(), Some(false));
        assert_eq!(row(-190.0).within_share(-200.0, 0.06).pass(), Some(true));
        assert_eq!(row(-190.0).within_share(-200.0, 0.04).pass(), Some(false));
        // The tolerance is inclusive, and a tolerance of zero requires equality.
        assert_eq!(row(4.0).within(4.0, 0.0).pass(), Some(true));
        assert_eq!(row(0.0).within_share(0.0, 0.5).pass(), Some(true));
        assert_eq!(row(1e-9).within_share(0.0, 0.5).pass(), Some(false));
    }

    #[test]
    fn bounds_are_one_sided_and_inclusive() {
        let row = |computed: f64| Row::new("a", "", Some(computed));
        let pass = |computed, rule| row(computed).judged(2.0, rule).pass();
        assert_eq!(pass(-1e9, Rule::AtMost), Some(true));
        assert_eq!(pass(2.0, Rule::AtMost), Some(true));
        assert_eq!(pass(2.1, Rule::AtMost), Some(false));
        assert_eq!(pass(1e9, Rule::AtLeast), Some(true));
        assert_eq!(pass(2.0, Rule::AtLeast), Some(true));
        assert_eq!(pass(1.9, Rule::AtLeast), Some(false));
    }

    #[test]
    fn nan_and_missing_values_fail() {
        for computed in [None, Some(f64::NAN), Some(f64::INFINITY)] {
            let row = Row::new("a", "", computed);
            assert_eq!(row.clone().within(1.0, 1e300).pass(), Some(false));
            assert_eq!(row.clone().within_share(1.0, 0.1).pass(), Some(false));
            assert_eq!(row.clone().judged(1.0, Rule::AtMost).pass(), Some(false));
            assert_eq!(row.clone().judged(1.0, Rule::AtLeast).pass(), Some(false));
            assert_eq!(
                row.pass(),
                None,
                "a row without an expected value is not judged"
            );
        }
        let doubtful = Row::new("a", "", Some(1.0));
        assert_eq!(doubtful.clone().within(1.0, f64::NAN).pass(), Some(false));
        assert_eq!(doubtful.within(f64::NAN, 1.0).pass(), Some(false));
    }

    #[test]
    fn rows_are_serialised_to_json() {
        let judged = Row::new("x", "m", Some(2.0)).within(1.0, 0.5).printed(1.2);
        assert_eq!(
            serde_json::to_value(judged.note("why")).unwrap(),
            json!({"case": "x", "printed": 1.2, "expected": 1.0, "computed": 2.0, "tolerance": 0.5,
                   "absolute": true, "pass": false, "note": "why"})
        );
        let bound = Row::new("z", "", Some(2.0)).judged(1.0, Rule::AtLeast);
        for (row, note) in [
            (bound.clone(), "lower bound"),
            (bound.note("why"), "lower bound; why"),
        ] {
            assert_eq!(
                serde_json::to_value(row).unwrap(),
                json!({"case": "z", "printed": null, "expected": 1.0, "computed": 2.0, "tolerance": null,
                       "absolute": true, "pass": true, "note": note})
            );
        }
        let lost = Row::new("y", "s", Some(f64::NAN));
        assert_eq!(
            serde_json::to_value(lost).unwrap(),
            json!({"case": "y", "printed": null, "expected": null, "computed": null, "tolerance": null,
                   "absolute": false, "pass": null, "note": ""})
        );
        let measured = Row::new("m", "N", Some(3.0)).measured([1.0, 2.0]);
        let measured = serde_json::to_value(measured).unwrap();
        assert_eq!(measured["measured"], json!([1.0, 2.0]));
        assert_eq!(measured["agreement"], json!("outside"));
        assert_eq!(measured["pass"], json!(null));
    }

    #[test]
    fn agreement_with_a_measured_range_counts_the_spread() {
        let row = |computed: Option<f64>| Row::new("m", "N", computed).measured([1.0, 2.0]);
        assert_eq!(row(Some(1.0)).agreement(), Some(Agreement::Inside));
        assert_eq!(row(Some(2.1)).agreement(), Some(Agreement::Outside));
        assert_eq!(row(Some(f64::NAN)).agreement(), Some(Agreement::Outside));
        assert_eq!(row(None).agreement(), Some(Agreement::Outside));
        let mut wide = row(Some(2.1));
        wide.spread = Some([1.9, 2.3]);
        assert_eq!(wide.agreement(), Some(Agreement::Partly));
        wide.spread = Some([2.05, 2.3]);
        assert_eq!(wide.agreement(), Some(Agreement::Outside));
        assert_eq!(wide.pass(), None);
        assert_eq!(Row::new("x", "", Some(1.0)).agreement(), None);
    }
}
