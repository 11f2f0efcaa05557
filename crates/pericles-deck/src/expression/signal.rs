//! Expressions of scalars of a run: columns of its tables and derived quantities.

use std::fmt;
use std::sync::Arc;

use exmex::{Express, FlatEx};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::condition::Test;
use super::unit::{UnitOperators, UnitValue};
use super::{Compiled, Malformed, grammar};
use crate::units::{self, Measure};

const NO_COLUMN: &str = "it refers to no column of the tables, such as tip.u_x";

/// A compiled function of named scalars of a run.
///
/// The names are those of columns, such as `tip_u_x` or `tip.u_x`. Names with other characters than letters, digits and
/// `_` are written in single quotes: `'left edge'.u_x`. Numbers with units are written in single quotes as well:
/// `top.y / '10 mm2'`.
#[derive(Clone)]
pub struct SignalExpression {
    text: Arc<str>,
    grouped: Arc<str>,
    compiled: Arc<Compiled>,
    names: Arc<[String]>,
    /// The variables of the compiled expression, in their order.
    operands: Arc<[Operand]>,
}

/// What a variable of a compiled expression stands for.
#[derive(Debug, Clone, Copy)]
enum Operand {
    /// The name of this index.
    Name(usize),
    /// A number with a unit.
    Number(Measure),
}

impl SignalExpression {
    /// What decks may contain.
    pub(crate) const ALLOWED: &str = "such as expression = \"tip.u_x - base.u_x\": columns of the tables, numbers in \
                                      SI units, functions; numbers with units, and names with other characters than \
                                      letters, digits and `_`, in single quotes";

    /// Parses an expression; its names are not checked.
    pub(crate) fn parse(text: &str) -> Result<Self, Malformed> {
        let expression = Self::parse_side(text)?;
        match expression.names.is_empty() {
            false => Ok(expression),
            true => Err(Malformed {
                reason: NO_COLUMN.into(),
            }),
        }
    }

    /// Parses a side of a comparison, which may be a number.
    fn parse_side(text: &str) -> Result<Self, Malformed> {
        let (grouped, names) = grammar::group_names(text)?;
        let compiled = Compiled::parse(&grouped).map_err(|error| Malformed {
            reason: format!("it is not a valid expression: {error}"),
        })?;
        let mut own = Vec::new();
        let variables: Vec<Operand> = names
            .into_iter()
            .map(|name| match units::parse(&name) {
                Ok(measure) => Operand::Number(measure),
                Err(_) => {
                    own.push(name);
                    Operand::Name(own.len() - 1)
                }
            })
            .collect();
        let operands = order(compiled.var_names()).map(|k| variables[k]).collect();
        Ok(Self {
            text: text.trim().into(),
            grouped: grouped.into(),
            operands,
            compiled: compiled.into(),
            names: own.into(),
        })
    }

    /// Returns the text of the expression.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the names that it refers to, each once.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Returns the value for the values of its [`names`](Self::names); NaN where it is undefined.
    pub fn value(&self, values: &[f64]) -> f64 {
        let of = |operand: &Operand| match operand {
            Operand::Name(k) => values[*k],
            Operand::Number(measure) => measure.value,
        };
        let given: Vec<f64> = self.operands.iter().map(of).collect();
        // The number of values is right, which is the only possible error.
        self.compiled.eval(&given).unwrap_or(f64::NAN)
    }

    /// Returns the SI unit of the value for the units of its names, empty for numbers without a unit. Numbers of the
    /// expression have the unit of the terms that they are added to.
    ///
    /// # Errors
    /// The reason why the value has no unit, such as a sum of different units.
    pub fn unit(&self, of_names: &[&str]) -> Result<String, String> {
        self.unit_value(of_names)?.text()
    }

    /// Returns whether two units as in tables are the same SI unit, such as `J/m2` and `N/m`.
    pub fn is_same_unit(one: &str, other: &str) -> bool {
        let of = |unit: &str| units::dimension_of(unit);
        one == other || of(one).is_some() && of(one) == of(other)
    }

    fn unit_value(&self, of_names: &[&str]) -> Result<UnitValue, String> {
        let known: Result<Vec<UnitValue>, String> = of_names
            .iter()
            .map(|unit| UnitValue::of_unit(unit))
            .collect();
        let known = known?;
        let of = |operand: &Operand| match operand {
            Operand::Name(k) => known[*k].clone(),
            Operand::Number(measure) => UnitValue::of_measure(measure),
        };
        let given: Vec<UnitValue> = self.operands.iter().map(of).collect();
        let compiled = FlatEx::<UnitValue, UnitOperators>::parse(&self.grouped);
        let value = compiled.and_then(|compiled| compiled.eval(&given));
        value.map_err(|error| error.to_string())
    }
}

/// Returns the numbers of the variables `v0`, `v1` … of an expression, in the order of their values.
fn order(names: &[String]) -> impl Iterator<Item = usize> {
    let number = |name: &String| name.trim_start_matches('v').parse().unwrap_or_default();
    names.iter().map(number)
}

/// A compiled condition on named scalars of a run.
#[derive(Clone)]
pub struct SignalCondition {
    text: Arc<str>,
    test: Arc<Test<SignalExpression>>,
}

impl SignalCondition {
    /// What decks may contain.
    pub(crate) const ALLOWED: &str = "such as condition = \"tip.u_x > 1e-4 && broken_bonds > 0\": columns of the \
                                      tables, quantities of [[output.quantity]], numbers in SI units";

    /// Parses a condition; its names are not checked.
    pub(crate) fn parse(text: &str) -> Result<Self, Malformed> {
        let test = Test::of(text, &SignalExpression::parse_side)?;
        let condition = Self {
            text: text.trim().into(),
            test: test.into(),
        };
        match condition.names().is_empty() {
            false => Ok(condition),
            true => Err(Malformed {
                reason: NO_COLUMN.into(),
            }),
        }
    }

    /// Returns the text of the condition.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns the names that it refers to, each once.
    pub fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for side in self.comparisons().into_iter().flatten() {
            for name in side.names() {
                if !names.contains(&name.as_str()) {
                    names.push(name);
                }
            }
        }
        names
    }

    /// Returns both sides of every comparison.
    pub fn comparisons(&self) -> Vec<[&SignalExpression; 2]> {
        let mut found = Vec::new();
        self.test.comparisons(&mut found);
        found
    }

    /// Returns whether the condition holds for the values of its expressions.
    pub fn holds(&self, value: &dyn Fn(&SignalExpression) -> f64) -> bool {
        self.test.holds(value)
    }

    /// Checks that both sides of every comparison have the same unit.
    ///
    /// # Errors
    /// The comparison that has no meaning, and the reason.
    pub fn check_units(&self, unit: &dyn Fn(&str) -> String) -> Result<(), String> {
        for [left, right] in self.comparisons() {
            let value = |side: &SignalExpression| {
                let units: Vec<String> = side.names().iter().map(|name| unit(name)).collect();
                let units: Vec<&str> = units.iter().map(String::as_str).collect();
                side.unit_value(&units)
            };
            value(left)?.compared(value(right)?)?;
        }
        Ok(())
    }
}

/// Implements serialisation as a text, comparison of texts and debug output.
macro_rules! as_text {
    ($type:ident) => {
        impl Serialize for $type {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.serialize_str(&self.text)
            }
        }

        impl<'de> Deserialize<'de> for $type {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let text = String::deserialize(deserializer)?;
                Self::parse(&text).map_err(|malformed| {
                    D::Error::custom(format!("`{text}`: {}", malformed.reason))
                })
            }
        }

        impl fmt::Debug for $type {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!(stringify!($type), "({:?})"), self.text)
            }
        }

        impl PartialEq for $type {
            fn eq(&self, other: &Self) -> bool {
                self.text == other.text
            }
        }
    };
}

as_text!(SignalExpression);
as_text!(SignalCondition);

#[cfg(test)]
mod tests {
    use super::*;

    fn unit_of(name: &str) -> String {
        match name {
            "a_u_x" | "b_u_x" => "m".into(),
            "top_y" => "N".into(),
            "kinetic_energy" => "J".into(),
            "momentum_x" => "kg m/s".into(),
            "time" => "s".into(),
            _ => String::new(),
        }
    }

    fn unit(text: &str) -> Result<String, String> {
        let expression = SignalExpression::parse(text).unwrap();
        let units: Vec<String> = expression
            .names()
            .iter()
            .map(|name| unit_of(name))
            .collect();
        let units: Vec<&str> = units.iter().map(String::as_str).collect();
        expression.unit(&units)
    }

    #[test]
    fn quoted_numbers_have_units() {
        let text = "top_y / '10 mm2' + 2*top_y/'1 cm'^2 - '3 MPa'";
        let expression = SignalExpression::parse(text).unwrap();
        assert_eq!(expression.names(), ["top_y"]);
        let expected = 50.0 / 1e-5 + 100.0 / 1e-4 - 3e6;
        assert!((expression.value(&[50.0]) / expected - 1.0).abs() < 1e-14);
        assert_eq!(unit(text).unwrap(), "Pa");
        assert!(unit("top_y / '1 mm' - '3 MPa'").is_err());
        assert!(SignalExpression::parse("2*'3 mm'").is_err());
        assert_eq!(unit("a_u_x/'2 mm'").unwrap(), "");
    }

    #[test]
    fn values_follow_the_order_of_the_names() {
        let expression =
            SignalExpression::parse("'left edge_y'^2 - 3*a_u_x + 'left edge_y'").unwrap();
        assert_eq!(expression.names(), ["left edge_y", "a_u_x"]);
        let dotted = SignalExpression::parse("2.5*'left edge'.u_y - reaction.top.y/3.").unwrap();
        assert_eq!(dotted.names(), ["left edge.u_y", "reaction.top.y"]);
        assert_eq!(dotted.value(&[2.0, 6.0]), 3.0);
        assert_eq!(expression.value(&[4.0, 5.0]), 5.0);
        // More than ten names: `v10` sorts before `v2`.
        let names: Vec<String> = (0..12).map(|k| format!("{}*s{k}", 1 << k)).collect();
        let expression = SignalExpression::parse(&names.join("+")).unwrap();
        let values: Vec<f64> = (0..12).map(f64::from).collect();
        let expected: f64 = (0..12).map(|k| f64::from((1 << k) * k)).sum();
        assert_eq!(expression.value(&values), expected);
    }

    #[test]
    fn units_are_derived() {
        for (text, expected) in [
            ("a_u_x - b_u_x", "m"),
            ("(a_u_x - b_u_x)/2 + 0.001", "m"),
            ("top_y/a_u_x", "N/m"),
            ("top_y*a_u_x", "J"),
            ("kinetic_energy/a_u_x^3", "Pa"),
            ("sqrt(kinetic_energy/top_y*b_u_x)", "m"),
            ("sin(a_u_x/b_u_x) + 1", ""),
            ("abs(-top_y)", "N"),
            ("momentum_x/time", "N"),
            ("1/time", "1/s"),
            ("top_y^2/time", "kg^2 m^2/s^5"),
            ("2^count", ""),
        ] {
            assert_eq!(unit(text).unwrap(), expected, "{text}");
        }
        for (text, says) in [
            ("a_u_x + top_y", "m and N"),
            ("sin(a_u_x)", "`sin` of a value in m"),
            ("sqrt(a_u_x)", "power"),
            ("a_u_x^count", "power"),
            ("2^a_u_x", "exponent"),
        ] {
            let reason = unit(text).unwrap_err();
            assert!(reason.contains(says), "{text}: {reason}");
        }
    }

    #[test]
    fn conditions_compare_equal_units() {
        let condition =
            SignalCondition::parse("a_u_x > 2*0.5e-4 && !(top_y < -2) || 1 < time <= 2").unwrap();
        assert_eq!(condition.names(), ["a_u_x", "top_y", "time"]);
        assert_eq!(condition.check_units(&unit_of), Ok(()));
        let holds = |values: [f64; 3]| {
            condition.holds(&|side| {
                let all = ["a_u_x", "top_y", "time"];
                let value = |name: &String| values[all.iter().position(|one| one == name).unwrap()];
                side.value(&side.names().iter().map(value).collect::<Vec<_>>())
            })
        };
        assert!(holds([1e-3, -1.0, 0.0]));
        assert!(!holds([1e-3, -3.0, 0.0]));
        assert!(!holds([f64::NAN, -1.0, 0.0]));
        assert!(holds([0.0, 0.0, 2.0]));
        let wrong = SignalCondition::parse("a_u_x > top_y").unwrap();
        assert!(
            wrong
                .check_units(&unit_of)
                .unwrap_err()
                .contains("m with N")
        );
    }

    #[test]
    fn mistakes_are_named() {
        for (text, says) in [
            ("2 + 1", "no column"),
            ("sine(a_u_x)", "did you mean `sin`"),
            ("a_u_x b_u_x", "operator"),
            ("'a_u_x", "quote is not closed"),
            ("''", "empty"),
            ("a. u_x", "is not a number"),
        ] {
            let malformed = SignalExpression::parse(text).unwrap_err();
            assert!(
                malformed.reason.contains(says),
                "{text}: {}",
                malformed.reason
            );
        }
        for (text, says) in [("a_u_x", "not a comparison"), ("1 < 2", "no column")] {
            let malformed = SignalCondition::parse(text).unwrap_err();
            assert!(
                malformed.reason.contains(says),
                "{text}: {}",
                malformed.reason
            );
        }
    }
}
