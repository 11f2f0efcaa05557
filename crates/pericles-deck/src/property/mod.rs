//! Properties of materials: numbers, functions of position and temperature, tables by temperature.

mod functions;

pub use functions::{MaterialFunction, MaterialFunctions, MaterialProperty};
pub(crate) use functions::{functions, number_of};

use serde::{Deserialize, Serialize};

use crate::component;
use crate::declaration::{Check, Measured, Spatial};
use crate::expression::{Expression, VARIABLES};
use crate::key_path::KeyPath;
use crate::quantity::Quantity;
use crate::range::Range;
use crate::reader::Item;

/// A property of a material in SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Property {
    /// A constant.
    Number(f64),
    /// A function of position or temperature.
    Function(PropertyFunction),
}

/// A property of a material as a function.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum PropertyFunction {
    /// An expression of x, y, z (m) and temperature (K).
    Expression(#[serde(with = "of_property")] Expression),
    /// Rows of temperature (K) and value: linear between the rows, constant below the first and above the last.
    Table(Vec<[f64; 2]>),
}

impl From<f64> for Property {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl Property {
    /// Returns the number, if it is a constant.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(*value),
            Self::Function(_) => None,
        }
    }

    /// Returns the value at a position (m) and temperature (K); NaN where it is undefined.
    pub fn value(&self, place: [f64; 3], temperature: f64) -> f64 {
        match self {
            Self::Number(value) => *value,
            Self::Function(function) => function.value(place, temperature),
        }
    }
}

impl PropertyFunction {
    /// Returns the value at a position (m) and temperature (K); NaN where it is undefined.
    pub fn value(&self, place: [f64; 3], temperature: f64) -> f64 {
        match self {
            Self::Expression(expression) => expression.value_heated(place, temperature),
            Self::Table(rows) => interpolated(rows, temperature),
        }
    }

    /// Returns whether it depends on the temperature.
    pub fn depends_on_temperature(&self) -> bool {
        match self {
            Self::Expression(expression) => expression.depends_on_temperature(),
            Self::Table(_) => true,
        }
    }

    /// Returns its text: the expression, or the rows of the table.
    pub fn text(&self) -> String {
        match self {
            Self::Expression(expression) => expression.text().to_owned(),
            Self::Table(rows) => format!("a table of {} temperatures", rows.len()),
        }
    }
}

/// Returns the value of a table at a temperature; NaN for a table without rows.
fn interpolated(rows: &[[f64; 2]], temperature: f64) -> f64 {
    let above = rows.partition_point(|[t, _]| *t <= temperature);
    match (above.checked_sub(1).map(|k| rows[k]), rows.get(above)) {
        (Some([t0, low]), Some([t1, high])) => {
            low + (high - low) * ((temperature - t0) / (t1 - t0))
        }
        (Some([_, value]), None) | (None, Some(&[_, value])) => value,
        (None, None) => f64::NAN,
    }
}

/// What the values of a property may depend on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PropertyScope {
    /// Dimension of the body; none if another error makes it unknown.
    pub(crate) dimension: Option<usize>,
    /// Whether it may depend on the temperature.
    pub(crate) temperature: bool,
}

impl Spatial for PropertyScope {
    fn dimension(&self) -> Option<usize> {
        self.dimension
    }
}

impl Measured<PropertyScope> for Property {
    fn read(
        item: &Item<'_>,
        quantity: Quantity,
        range: Range,
        scope: PropertyScope,
    ) -> Option<Self> {
        match item.is_table() {
            true => function(item, quantity, range, scope).map(Self::Function),
            false => item.number(quantity, range).map(Self::Number),
        }
    }

    fn check(&self, path: KeyPath, range: Range, _: PropertyScope, check: &mut Check) {
        match self {
            Self::Number(number) => check.number(path, *number, range),
            Self::Function(PropertyFunction::Table(rows)) => {
                for (k, [_, value]) in rows.iter().enumerate() {
                    check.number(path.key("table").index(k).index(1), *value, range);
                }
            }
            Self::Function(PropertyFunction::Expression(_)) => {}
        }
    }
}

/// Reads `{ expression = "…" }`, or `{ table = [[temperature, value], …] }` where the temperature is allowed. Values of
/// expressions are checked when they are evaluated.
pub(crate) fn function(
    item: &Item<'_>,
    quantity: Quantity,
    range: Range,
    scope: PropertyScope,
) -> Option<PropertyFunction> {
    const FORMS: &[&str] = &["expression", "table"];
    let mut names = VARIABLES[..scope.dimension.unwrap_or(3)].to_vec();
    if !scope.temperature {
        return component::expression_in(item, &names).map(PropertyFunction::Expression);
    }
    names.push("temperature");
    let table = item.table()?;
    // The yield stress is the only such property.
    table.about("Yield stress as a function of position or temperature. The temperature is that of `[thermal]`, prescribed or computed.");
    table.describe("expression", "Yield stress as a function of the position x, y, z (m) and the temperature `temperature` (K), in Pa.");
    table.describe("table", "Rows [temperature, yield stress] with increasing temperatures: linear between the rows, constant below the first and above the last.");
    let read = table
        .exactly_one(FORMS)
        .and_then(|(form, item)| match form {
            "table" => rows(&item, quantity, range).map(PropertyFunction::Table),
            _ => component::expression(&item, &names).map(PropertyFunction::Expression),
        });
    table.finish();
    read
}

/// Reads `[[temperature, value], …]`.
fn rows(item: &Item<'_>, quantity: Quantity, range: Range) -> Option<Vec<[f64; 2]>> {
    const RISING: &str = "temperatures that increase from row to row";
    let mut rows: Option<Vec<[f64; 2]>> = Some(Vec::new());
    let items = item.list("a list of rows, each [temperature, value]")?;
    if items.is_empty() {
        item.wrong_length("at least one row [temperature, value]");
        return None;
    }
    for row in items {
        let read = row
            .exactly(2, "a row [temperature, value]")
            .and_then(|pair| {
                let temperature = pair[0].quantity(Quantity::Temperature);
                let value = pair[1].number(quantity, range);
                let last = rows.as_ref().and_then(|rows| rows.last());
                if let (Some(temperature), Some([last, _])) = (temperature, last)
                    && temperature <= *last
                {
                    pair[0].out_of_range(RISING);
                    return None;
                }
                Some([temperature?, value?])
            });
        match (read, &mut rows) {
            (Some(read), Some(rows)) => rows.push(read),
            _ => rows = None,
        }
    }
    rows
}

/// Serialised form of expressions of position and temperature.
mod of_property {
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    use crate::expression::Expression;

    pub(super) fn serialize<S: Serializer>(
        expression: &Expression,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        expression.serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Expression, D::Error> {
        let text = String::deserialize(deserializer)?;
        let parsed = Expression::parse(&text, &["x", "y", "z", "temperature"]);
        parsed.map_err(|malformed| D::Error::custom(format!("`{text}`: {}", malformed.reason)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_linear_between_their_rows_and_constant_beyond() {
        let table = PropertyFunction::Table(vec![[300.0, 10.0], [400.0, 30.0], [500.0, 20.0]]);
        for (temperature, value) in [
            (0.0, 10.0),
            (300.0, 10.0),
            (350.0, 20.0),
            (400.0, 30.0),
            (475.0, 22.5),
            (900.0, 20.0),
        ] {
            assert_eq!(table.value([0.0; 3], temperature), value);
        }
        assert!(table.depends_on_temperature());
    }

    #[test]
    fn functions_survive_serialisation() {
        let expression = Expression::parse("350e6*(1 - (temperature - 293)/1000) + y", &VARIABLES);
        for function in [
            PropertyFunction::Expression(expression.unwrap()),
            PropertyFunction::Table(vec![[300.0, 1.5]]),
        ] {
            let property = Property::Function(function);
            let text = serde_json::to_string(&property).unwrap();
            assert_eq!(serde_json::from_str::<Property>(&text).unwrap(), property);
            let value = property.value([0.0, 7.0, 0.0], 293.0);
            assert!(value == 350e6 + 7.0 || value == 1.5);
        }
        assert!(serde_json::from_str::<Property>(r#"{"expression": "t"}"#).is_err());
    }
}
