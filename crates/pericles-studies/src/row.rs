//! One line of a study: a number beside the one it should be.

use std::borrow::Cow;

use serde::ser::{Serialize, SerializeStruct, Serializer};

/// A number computed by a study, SI units.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// What it is.
    pub case: String,
    /// The number in the paper.
    pub printed: Option<f64>,
    /// The number to judge by; a row without it is information only.
    pub expected: Option<f64>,
    /// The number found; none if what it measures did not happen.
    pub computed: Option<f64>,
    /// Allowed difference: relative to |expected| unless `absolute`.
    pub tolerance: f64,
    /// Whether the tolerance is in the row's own unit.
    pub absolute: bool,
    /// What a reader should know.
    pub note: String,
    /// SI unit, for the table; empty for a pure number.
    pub unit: Cow<'static, str>,
}

impl Row {
    /// A row for information.
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

    /// Judged: at most this far from the expected number.
    pub fn within(mut self, expected: f64, tolerance: f64) -> Self {
        self.expected = Some(expected);
        self.tolerance = tolerance;
        self.absolute = true;
        self
    }

    /// Judged: at most this share of the expected number away from it.
    pub fn within_share(mut self, expected: f64, tolerance: f64) -> Self {
        self.expected = Some(expected);
        self.tolerance = tolerance;
        self.absolute = false;
        self
    }

    /// With the number in the paper.
    pub fn printed(mut self, printed: f64) -> Self {
        self.printed = Some(printed);
        self
    }

    /// With a remark.
    pub fn note(mut self, note: impl Into<String>) -> Self {
        self.note = note.into();
        self
    }

    /// Whether the row holds; none if it is not judged. What did not happen or is no number does not hold.
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
    fn verdicts() {
        let row = |computed: f64| Row::new("a", "m", Some(computed));
        assert_eq!(row(1.0).pass(), None);
        assert_eq!(row(1.05).within(1.0, 0.1).pass(), Some(true));
        assert_eq!(row(1.15).within(1.0, 0.1).pass(), Some(false));
        assert_eq!(row(-190.0).within_share(-200.0, 0.06).pass(), Some(true));
        assert_eq!(row(-190.0).within_share(-200.0, 0.04).pass(), Some(false));
        // The limit itself holds, and a tolerance of zero asks for equality.
        assert_eq!(row(4.0).within(4.0, 0.0).pass(), Some(true));
        assert_eq!(row(0.0).within_share(0.0, 0.5).pass(), Some(true));
        assert_eq!(row(1e-9).within_share(0.0, 0.5).pass(), Some(false));
    }

    #[test]
    fn what_is_no_number_or_did_not_happen_fails() {
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
    fn rows_as_json() {
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
