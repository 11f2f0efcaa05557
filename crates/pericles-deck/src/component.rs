//! Vector components given as numbers or expressions.

use serde::{Deserialize, Serialize};
use serde_json::json;

use crate::declaration::{Check, Measured, Spatial};
use crate::expression::{Expression, VARIABLES};
use crate::fault::Fault;
use crate::key_path::KeyPath;
use crate::quantity::Quantity;
use crate::range::Range;
use crate::reader::Item;

/// A vector component in SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(from = "ComponentForm", into = "ComponentForm")]
pub enum Component {
    /// A constant.
    Number(f64),
    /// A function of position, and of time where allowed.
    Expression(Expression),
}

/// The form in decks: a number, or `{ expression = "…" }`.
#[derive(Serialize, Deserialize)]
#[serde(untagged)]
enum ComponentForm {
    Number(f64),
    Expression { expression: Expression },
}

impl From<ComponentForm> for Component {
    fn from(form: ComponentForm) -> Self {
        match form {
            ComponentForm::Number(number) => Self::Number(number),
            ComponentForm::Expression { expression } => Self::Expression(expression),
        }
    }
}

impl From<Component> for ComponentForm {
    fn from(component: Component) -> Self {
        match component {
            Component::Number(number) => Self::Number(number),
            Component::Expression(expression) => Self::Expression { expression },
        }
    }
}

impl From<f64> for Component {
    fn from(value: f64) -> Self {
        Self::Number(value)
    }
}

impl Component {
    /// Returns the value at a position (m) and time (s).
    pub fn value(&self, place: [f64; 3], t: f64) -> f64 {
        match self {
            Self::Number(value) => *value,
            Self::Expression(expression) => expression.value(place, t),
        }
    }

    /// Returns the number, if it is a constant.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Number(value) => Some(*value),
            Self::Expression(_) => None,
        }
    }

    /// Returns whether it depends on time.
    pub fn depends_on_time(&self) -> bool {
        matches!(self, Self::Expression(expression) if expression.depends_on_time())
    }
}

/// A vector of the body's dimension; components beyond it are zero.
pub type VectorField = [Component; 3];

/// Variables that expressions may use.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Variables {
    /// Dimension of the body, which determines the allowed coordinates; all are allowed if another error
    /// makes it unknown.
    pub(crate) dimension: Option<usize>,
    /// Whether t is allowed.
    pub(crate) time: bool,
}

impl Variables {
    fn names(self) -> Vec<&'static str> {
        let mut names = VARIABLES[..self.dimension.unwrap_or(3)].to_vec();
        if self.time {
            names.push("t");
        }
        names
    }
}

impl Spatial for Variables {
    fn dimension(&self) -> Option<usize> {
        self.dimension
    }
}

impl Measured<Variables> for Component {
    fn read(item: &Item<'_>, quantity: Quantity, _: Range, variables: Variables) -> Option<Self> {
        component(item, quantity, variables)
    }

    fn check(&self, path: KeyPath, range: Range, _: Variables, check: &mut Check) {
        if let Self::Number(number) = self {
            check.number(path, *number, range);
        }
    }
}

impl Measured<Variables> for VectorField {
    fn read(item: &Item<'_>, quantity: Quantity, _: Range, variables: Variables) -> Option<Self> {
        vector_field(item, quantity, variables)
    }

    fn check(&self, path: KeyPath, range: Range, variables: Variables, check: &mut Check) {
        for (c, component) in self.iter().enumerate() {
            Measured::check(component, path.index(c), range, variables, check);
        }
    }
}

/// Reads a number with a unit, or `{ expression = "…" }`.
pub(crate) fn component(
    item: &Item<'_>,
    quantity: Quantity,
    variables: Variables,
) -> Option<Component> {
    if !item.is_table() {
        return item.quantity(quantity).map(Component::Number);
    }
    expression_in(item, &variables.names()).map(Component::Expression)
}

/// Reads a table `{ expression = "…" }` of these variables.
pub(crate) fn expression_in(item: &Item<'_>, variables: &[&str]) -> Option<Expression> {
    let table = item.table()?;
    table.define("expression");
    table.about("Function of position and time.");
    table.describe(
        "expression",
        "Expression in SI units, such as \"1e-3 * exp(-(x/0.01)^2)\".",
    );
    let text = table.required("expression");
    let read = text.and_then(|item| expression(&item, variables));
    table.finish();
    read
}

/// Reads an expression of these variables.
pub(crate) fn expression(item: &Item<'_>, variables: &[&str]) -> Option<Expression> {
    let text = item.text()?;
    match Expression::parse(&text, variables) {
        Ok(expression) => {
            item.record(json!(text));
            Some(expression)
        }
        Err(malformed) => {
            item.report(Fault::bad_expression(text, malformed.reason));
            None
        }
    }
}

/// Reads a vector with one entry per dimension.
pub(crate) fn vector_field(
    item: &Item<'_>,
    quantity: Quantity,
    variables: Variables,
) -> Option<VectorField> {
    let items = item.components(variables.dimension, &quantity.expected())?;
    let mut field = Some([0.0; 3].map(Component::Number));
    for (c, item) in items.iter().enumerate() {
        // Continue after an invalid entry to report all of them.
        match (component(item, quantity, variables), &mut field) {
            (Some(component), Some(field)) => field[c] = component,
            _ => field = None,
        }
    }
    field
}
