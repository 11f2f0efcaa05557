//! Row of a study: a computed value beside the expected one.

use std::borrow::Cow;

use serde::ser::{Serialize, SerializeStruct, Serializer};

/// Value computed by a study, SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Label.
    pub case: String,
    /// Value printed in the paper.
    pub printed: Option<f64>,
    /// Value to judge by; a row without it is for information.
    pub expected: Option<f64>,
    /// Computed value; `None` if the measured event did not happen.
    pub computed: Option<f64>,
    /// Allowed difference: relative to |expected| unless `absolute`.
    pub tolerance: f64,
    /// True if the tolerance is in the unit of the row.
    pub absolute: bool,
    /// Remark for the reader.
    pub note: String,
    /// SI unit for the table; empty for a pure number.
    pub unit: Cow<'static, str>,
}

impl Row {
    /// Creates a row for information.
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
            tolerance: 0.0,
            absolute: false,
            note: String::new(),
            unit: unit.into(),
        }
    }

    /// Judges the row by an absolute difference from the expected value.
    pub fn within(mut self, expected: f64, tolerance: f64) -> Self {
        self.expected = Some(expected);
        self.tolerance = tolerance;
        self.absolute = true;
        self
    }

    /// Judges the row by a difference relative to the expected value.
    pub fn within_share(mut self, expected: f64, tolerance: f64) -> Self {
        self.expected = Some(expected);
        self.tolerance = tolerance;
        self.absolute = false;
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

    /// Returns true if the row is within its tolerance; `None` if it is not judged. A missing or NaN value fails.
    pub fn pass(&self) -> Option<bool> {
        let expected = self.expected?;
        let scale = if self.absolute { 1.0 } else { expected.abs() };
        let error = self.computed.map(|computed| (computed - expected).abs());
        // A comparison with NaN is false.
        Some(error.is_some_and(|error| error <= self.tolerance * scale))
    }
}

impl Serialize for Row {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let finite = |number: Option<f64>| number.filter(|x| x.is_finite());
        let mut row = serializer.serialize_struct("Row", 8)?;
        row.serialize_field("case", &self.case)?;
        row.serialize_field("printed", &finite(self.printed))?;
        row.serialize_field("expected", &finite(self.expected))?;
        row.serialize_field("computed", &finite(self.computed))?;
        row.serialize_field("tolerance", &self.expected.map(|_| self.tolerance))?;
        row.serialize_field("absolute", &self.absolute)?;
        row.serialize_field("pass", &self.pass())?;
        row.serialize_field("note", &self.note)?;
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
    fn nan_and_missing_values_fail() {
        for computed in [None, Some(f64::NAN), Some(f64::INFINITY)] {
            let row = Row::new("a", "", computed);
            assert_eq!(row.clone().within(1.0, 1e300).pass(), Some(false));
            assert_eq!(row.clone().within_share(1.0, 0.1).pass(), Some(false));
            assert_eq!(row.pass(), None, "information is never judged");
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
        let lost = Row::new("y", "s", Some(f64::NAN));
        assert_eq!(
            serde_json::to_value(lost).unwrap(),
            json!({"case": "y", "printed": null, "expected": null, "computed": null, "tolerance": null,
                   "absolute": false, "pass": null, "note": ""})
        );
    }
}
