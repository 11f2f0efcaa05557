//! Units of expressions: the operators of expressions applied to units in place of numbers.

use std::convert::Infallible;
use std::str::FromStr;

use exmex::{BinOp, MakeOperators, Operator};

use crate::dimension::Dimension;
use crate::units::{self, Measure};

/// The unit of a value.
#[derive(Debug, Clone, Default)]
pub(super) struct UnitValue {
    /// The dimension; none for a number of the expression, which has the unit of the terms that it is added to.
    dimension: Option<Dimension>,
    /// The value, if it depends on numbers only.
    number: Option<f64>,
    /// The first combination without a unit.
    mistake: Option<String>,
}

impl UnitValue {
    fn of(dimension: Dimension) -> Self {
        Self {
            dimension: Some(dimension),
            ..Self::default()
        }
    }

    /// Returns the value of a number with a unit.
    pub(super) fn of_measure(measure: &Measure) -> Self {
        Self {
            dimension: measure.dimension,
            number: Some(measure.value),
            mistake: None,
        }
    }

    fn number(number: f64) -> Self {
        Self {
            number: Some(number),
            ..Self::default()
        }
    }

    fn mistake(reason: String) -> Self {
        Self {
            mistake: Some(reason),
            ..Self::default()
        }
    }

    /// Returns the value of a column with a unit as in tables, empty without a unit.
    ///
    /// # Errors
    /// The unit is not known.
    pub(super) fn of_unit(unit: &str) -> Result<Self, String> {
        units::dimension_of(unit)
            .map(Self::of)
            .ok_or_else(|| format!("the unit `{unit}` is unknown"))
    }

    /// Returns the text of the unit.
    ///
    /// # Errors
    /// The expression combines units in a way that has no unit.
    pub(super) fn text(self) -> Result<String, String> {
        match self.mistake {
            Some(reason) => Err(reason),
            None => Ok(self.dimension.unwrap_or(Dimension::NONE).name()),
        }
    }

    /// Checks that two values have the same unit.
    ///
    /// # Errors
    /// Their units differ, or one of them has none.
    pub(super) fn compared(self, other: Self) -> Result<(), String> {
        match (self.dimension, other.dimension) {
            _ if self.mistake.is_some() || other.mistake.is_some() => {
                Err(self.mistake.or(other.mistake).unwrap_or_default())
            }
            (Some(one), Some(two)) if one != two => {
                Err(format!("it compares {} with {}", shown(one), shown(two)))
            }
            _ => Ok(()),
        }
    }

    /// Returns the first mistake of two values.
    fn mistaken(&self, other: &Self) -> Option<Self> {
        let reason = self.mistake.as_ref().or(other.mistake.as_ref())?;
        Some(Self::mistake(reason.clone()))
    }

    fn joined(&self, other: &Self, join: impl Fn(f64, f64) -> f64) -> Option<f64> {
        Some(join(self.number?, other.number?))
    }

    fn added(self, other: Self, join: impl Fn(f64, f64) -> f64) -> Self {
        if let Some(mistake) = self.mistaken(&other) {
            return mistake;
        }
        match (self.dimension, other.dimension) {
            (Some(one), Some(two)) if one != two => Self::mistake(format!(
                "it adds values in {} and {}",
                shown(one),
                shown(two)
            )),
            (one, two) => Self {
                dimension: one.or(two),
                number: self.joined(&other, join),
                mistake: None,
            },
        }
    }

    fn times(self, other: Self, power: i32) -> Self {
        if let Some(mistake) = self.mistaken(&other) {
            return mistake;
        }
        let dimension = match (self.dimension, other.dimension) {
            (None, None) => None,
            (one, two) => {
                let one = one.unwrap_or(Dimension::NONE);
                Some(one.times(two.unwrap_or(Dimension::NONE), power))
            }
        };
        Self {
            dimension,
            number: self.joined(&other, |a, b| if power > 0 { a * b } else { a / b }),
            mistake: None,
        }
    }

    fn power(self, exponent: Self) -> Self {
        if let Some(mistake) = self.mistaken(&exponent) {
            return mistake;
        }
        let plain = |dimension: Option<Dimension>| dimension.is_none_or(|d| d == Dimension::NONE);
        if !plain(exponent.dimension) {
            let unit = shown(exponent.dimension.unwrap_or(Dimension::NONE));
            return Self::mistake(format!("an exponent is a value in {unit}"));
        }
        let number = self.joined(&exponent, f64::powf);
        match (self.dimension, exponent.number) {
            (None, _) => Self {
                dimension: exponent.dimension,
                number,
                mistake: None,
            },
            (Some(Dimension::NONE), _) => Self::of(Dimension::NONE),
            (Some(dimension), Some(power)) => match dimension.to_power(power) {
                Some(raised) => Self::of(raised),
                None => Self::mistake(format!(
                    "a value in {} has the power {power}",
                    shown(dimension)
                )),
            },
            (Some(dimension), None) => Self::mistake(format!(
                "a value in {} has a power that is not a number",
                shown(dimension)
            )),
        }
    }

    /// The value of a function that keeps the unit.
    fn kept(self, f: fn(f64) -> f64) -> Self {
        Self {
            number: self.number.map(f),
            ..self
        }
    }

    /// The value of a function of numbers without a unit.
    fn plain(self, name: &str, f: fn(f64) -> f64) -> Self {
        match self.dimension {
            _ if self.mistake.is_some() => self,
            Some(dimension) if dimension != Dimension::NONE => Self::mistake(format!(
                "it takes `{name}` of a value in {}",
                shown(dimension)
            )),
            _ => self.kept(f),
        }
    }

    /// The value of a function whose result has no unit.
    fn sign(self, f: fn(f64) -> f64) -> Self {
        Self {
            dimension: Some(Dimension::NONE),
            ..self.kept(f)
        }
    }
}

fn shown(dimension: Dimension) -> String {
    match dimension.name() {
        name if name.is_empty() => "numbers without a unit".into(),
        name => name,
    }
}

impl FromStr for UnitValue {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(text.parse().map_or_else(|_| Self::default(), Self::number))
    }
}

/// Functions and operators of expressions for units.
#[derive(Clone, Debug)]
pub(super) struct UnitOperators;

impl MakeOperators<UnitValue> for UnitOperators {
    fn make<'a>() -> Vec<Operator<'a, UnitValue>> {
        type Join = fn(UnitValue, UnitValue) -> UnitValue;
        let joined = |apply: Join, prio, is_commutative| BinOp {
            apply,
            prio,
            is_commutative,
        };
        let unary = Operator::make_unary;
        vec![
            Operator::make_bin_unary("+", joined(|a, b| a.added(b, |a, b| a + b), 0, true), |a| a),
            Operator::make_bin_unary(
                "-",
                joined(|a, b| a.added(b, |a, b| a - b), 1, false),
                |a| a.kept(|x| -x),
            ),
            Operator::make_bin("*", joined(|a, b| a.times(b, 1), 2, true)),
            Operator::make_bin("/", joined(|a, b| a.times(b, -1), 3, false)),
            Operator::make_bin("^", joined(UnitValue::power, 4, false)),
            Operator::make_constant("pi", UnitValue::number(std::f64::consts::PI)),
            Operator::make_constant("e", UnitValue::number(std::f64::consts::E)),
            unary("abs", |a| a.kept(f64::abs)),
            unary("ceil", |a| a.kept(f64::ceil)),
            unary("floor", |a| a.kept(f64::floor)),
            unary("round", |a| a.kept(f64::round)),
            unary("sign", |a| a.sign(super::sign)),
            unary("step", |a| a.sign(super::step)),
            unary("sqrt", |a| a.power(UnitValue::number(0.5))),
            unary("cbrt", |a| a.power(UnitValue::number(1.0 / 3.0))),
            unary("acos", |a| a.plain("acos", f64::acos)),
            unary("asin", |a| a.plain("asin", f64::asin)),
            unary("atan", |a| a.plain("atan", f64::atan)),
            unary("cos", |a| a.plain("cos", f64::cos)),
            unary("cosh", |a| a.plain("cosh", f64::cosh)),
            unary("exp", |a| a.plain("exp", f64::exp)),
            unary("ln", |a| a.plain("ln", f64::ln)),
            unary("log10", |a| a.plain("log10", f64::log10)),
            unary("sin", |a| a.plain("sin", f64::sin)),
            unary("sinh", |a| a.plain("sinh", f64::sinh)),
            unary("tan", |a| a.plain("tan", f64::tan)),
            unary("tanh", |a| a.plain("tanh", f64::tanh)),
        ]
    }
}
