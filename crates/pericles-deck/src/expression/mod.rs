//! Expressions of x, y, z, t and the temperature in decks.
//!
//! The grammar has the usual precedence: `+ - * /` and `^` with `-x^2 = -(x^2)` and `2^3^2 = 2^(3^2)`,
//! parentheses, numbers, the variables `x y z t` (m and s; those the body has), the constants `pi` and `e`,
//! and the functions [`FUNCTIONS`]. Values are in SI units.
//!
//! exmex parses and evaluates expressions, with numbers or, for time derivatives, with [jets](jet). It binds
//! a sign tighter than a power (`-x^2 = x^2`) and evaluates powers from left to right; therefore [`grammar`]
//! puts every power in parentheses first.

mod bond;
mod condition;
mod grammar;
mod jet;
mod signal;
mod span;
mod unit;

use std::fmt;
use std::sync::Arc;

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

pub use bond::BondExpression;
pub use condition::Condition;
use exmex::{Express, FlatEx, FloatOpsFactory, MakeOperators, Operator};
use jet::{Jet, JetOperators, Variation};
pub use signal::{SignalCondition, SignalExpression};
use span::{Span, SpanOperators};

/// Functions of one argument. `step` is 0 for negative arguments, otherwise 1.
pub(crate) const FUNCTIONS: [&str; 20] = [
    "abs", "acos", "asin", "atan", "cbrt", "ceil", "cos", "cosh", "exp", "floor", "ln", "log10",
    "round", "sign", "sin", "sinh", "sqrt", "step", "tan", "tanh",
];

/// Names of the variables, in the order of their values. `block` is for conditions, `temperature` for properties of
/// materials only.
pub(crate) const VARIABLES: [&str; 6] = ["x", "y", "z", "t", "block", "temperature"];

/// Largest length of an expression, in characters.
pub(crate) const LONGEST: usize = 2000;

/// Operators of exmex, and our own.
#[derive(Clone, Debug)]
struct Operators;

impl MakeOperators<f64> for Operators {
    fn make<'a>() -> Vec<Operator<'a, f64>> {
        let mut operators = FloatOpsFactory::<f64>::make();
        operators.push(Operator::make_constant("pi", std::f64::consts::PI));
        operators.push(Operator::make_unary("round", f64::round));
        operators.push(Operator::make_unary("sign", sign));
        operators.push(Operator::make_unary("step", step));
        operators
    }
}

/// −1, 0 or 1.
fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

/// 0 for negative arguments, otherwise 1.
fn step(x: f64) -> f64 {
    if x >= 0.0 { 1.0 } else { 0.0 }
}

type Compiled = FlatEx<f64, Operators>;

/// An error in an expression: what is wrong, and what is allowed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Malformed {
    pub(crate) reason: String,
}

/// A compiled function of position and time.
#[derive(Clone)]
pub struct Expression {
    text: Arc<str>,
    compiled: Arc<Compiled>,
    /// Indices of its variables in [`VARIABLES`].
    variables: Arc<[usize]>,
}

impl Expression {
    /// Parses an expression of the variables named by `allowed`.
    pub(crate) fn parse(text: &str, allowed: &[&str]) -> Result<Self, Malformed> {
        let grouped = grammar::group_powers(text, allowed)?;
        let compiled = Compiled::parse(&grouped).map_err(|error| Malformed {
            reason: format!("it is not a valid expression: {error}"),
        })?;
        Ok(Self::new(text, compiled))
    }

    fn new(text: &str, compiled: Compiled) -> Self {
        let place = |name: &String| VARIABLES.iter().position(|v| v == name);
        let variables = compiled.var_names().iter().filter_map(place).collect();
        Self {
            text: text.into(),
            compiled: compiled.into(),
            variables,
        }
    }

    /// Returns the text of the expression.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Returns whether it depends on time.
    pub fn depends_on_time(&self) -> bool {
        self.variables.contains(&3)
    }

    /// Returns whether it depends on position.
    pub fn depends_on_place(&self) -> bool {
        self.variables.iter().any(|&v| v < 3)
    }

    /// Returns the value at a position (m) and time (s); NaN where it is undefined, such as for the root of a
    /// negative number.
    pub fn value(&self, [x, y, z]: [f64; 3], t: f64) -> f64 {
        self.at([x, y, z, t, f64::NAN, f64::NAN])
    }

    /// Returns whether it depends on the temperature.
    pub fn depends_on_temperature(&self) -> bool {
        self.variables.contains(&5)
    }

    /// Returns the value at a position (m) and temperature (K); NaN where it is undefined.
    pub fn value_heated(&self, [x, y, z]: [f64; 3], temperature: f64) -> f64 {
        self.at([x, y, z, f64::NAN, f64::NAN, temperature])
    }

    /// Returns the value for given values of all [`VARIABLES`].
    fn at(&self, all: [f64; VARIABLES.len()]) -> f64 {
        let mut given = [0.0; VARIABLES.len()];
        for (given, &v) in given.iter_mut().zip(&*self.variables) {
            *given = all[v];
        }
        let given = &given[..self.variables.len()];
        // The number of values is right, which is the only possible error.
        self.compiled.eval(given).unwrap_or(f64::NAN)
    }

    /// Returns its time derivatives, between jumps and kinks if it has any.
    pub(crate) fn rates(&self) -> Option<Rates> {
        let grouped = grammar::group_powers(&self.text, &VARIABLES).ok()?;
        Some(Rates {
            compiled: FlatEx::parse(&grouped).ok()?,
            variables: self.variables.clone(),
        })
    }

    /// Returns its jumps and kinks in time, if it has any.
    pub(crate) fn jumps(&self) -> Option<Jumps> {
        let grouped = grammar::group_powers(&self.text, &VARIABLES).ok()?;
        let is_rough = self.rates().is_some_and(|rates| !rates.is_smooth());
        Some(Jumps {
            compiled: FlatEx::parse(&grouped).ok()?,
            variables: self.variables.clone(),
        })
        .filter(|_| is_rough)
    }
}

/// Time derivatives of an [`Expression`].
#[derive(Debug)]
pub(crate) struct Rates {
    compiled: FlatEx<Jet, JetOperators>,
    /// Indices of its variables in [`VARIABLES`].
    variables: Arc<[usize]>,
}

impl Rates {
    /// Returns whether there are no jumps and kinks.
    pub(crate) fn is_smooth(&self) -> bool {
        self.at([0.0; 3], 0.0).variation != Variation::Rough
    }

    /// Returns the first and the second derivative at a position (m) and time (s).
    pub(crate) fn values(&self, place: [f64; 3], t: f64) -> [f64; 2] {
        let jet = self.at(place, t);
        [jet.rate, jet.second]
    }

    fn at(&self, [x, y, z]: [f64; 3], t: f64) -> Jet {
        let [x, y, z, none] = [x, y, z, f64::NAN].map(Jet::constant);
        let all = [x, y, z, Jet::time(t), none, none];
        let given: Vec<Jet> = self.variables.iter().map(|&v| all[v]).collect();
        // The number of values is right, which is the only possible error.
        self.compiled.eval(&given).unwrap_or(none)
    }
}

/// Jumps and kinks of an [`Expression`].
#[derive(Debug)]
pub(crate) struct Jumps {
    compiled: FlatEx<Span, SpanOperators>,
    /// Indices of its variables in [`VARIABLES`].
    variables: Arc<[usize]>,
}

impl Jumps {
    /// Returns the times of jumps and kinks at a position (m) in a range of times in ascending order, located to rounding;
    /// `None` if there are more than `most`.
    ///
    /// The range is bisected as long as interval arithmetic allows a jump, so that no jump is missed however short the
    /// time to the next one.
    pub(crate) fn within(
        &self,
        place: [f64; 3],
        [from, to]: [f64; 2],
        most: usize,
    ) -> Option<Vec<f64>> {
        let mut found: Vec<f64> = Vec::new();
        let mut open = vec![[from, to]];
        while let Some([a, b]) = open.pop() {
            if !self.may_jump(place, [a, b]) {
                continue;
            }
            let middle = a + 0.5 * (b - a);
            if middle <= a || middle >= b {
                // Adjacent intervals that touch a jump name it twice.
                if found.last().is_none_or(|last| *last < a) {
                    found.push(b);
                }
                if found.len() > most {
                    return None;
                }
                continue;
            }
            open.extend([[middle, b], [a, middle]]);
        }
        Some(found)
    }

    fn may_jump(&self, [x, y, z]: [f64; 3], [from, to]: [f64; 2]) -> bool {
        let none = Span::constant(f64::NAN);
        let [x, y, z] = [x, y, z].map(Span::constant);
        let all = [x, y, z, Span::times(from, to), none, none];
        let given: Vec<Span> = self.variables.iter().map(|&v| all[v]).collect();
        // The number of values is right, which is the only possible error.
        self.compiled.eval(&given).is_ok_and(|span| span.has_jump)
    }
}

/// Serialises as its text.
impl Serialize for Expression {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.text)
    }
}

impl<'de> Deserialize<'de> for Expression {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        Self::parse(&text, &VARIABLES[..4])
            .map_err(|malformed| D::Error::custom(format!("`{text}`: {}", malformed.reason)))
    }
}

impl fmt::Debug for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Expression({:?})", self.text)
    }
}

/// Compares the texts.
impl PartialEq for Expression {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn value(text: &str) -> f64 {
        let expression = Expression::parse(text, &VARIABLES).unwrap();
        expression.value([2.0, 3.0, 5.0], 7.0)
    }

    #[test]
    fn signs_and_powers_have_the_usual_precedence() {
        let cases = [
            ("-x^2", -4.0),
            ("2 - -x^2", 6.0),
            ("2^-x", 0.25),
            ("2^3^x", 512.0),
            ("-2^-x", -0.25),
            ("(-x)^2", 4.0),
            ("1/x*y", 1.5),
            ("1/x/y", 1.0 / 6.0),
            ("t-y-x", 2.0),
            ("-x*-y", 6.0),
            ("exp(-x^2)", (-4.0f64).exp()),
            ("-exp(x)^2", -(2.0f64).exp().powi(2)),
            ("sin(x)^2+cos(x)^2", 1.0),
            ("2*pi", std::f64::consts::TAU),
            ("ln(e^3)", 3.0),
            ("1.5e-3*1E+3", 1.5),
            (".5*2.", 1.0),
            ("x*step(y-3) + 10*step(y-3.1)", 2.0),
            ("sign(-y) + abs(-y) + sqrt(4)", 4.0),
            ("((((x))))", 2.0),
            ("-(x+y)^2*2", -50.0),
            ("x^2^0.5*1", 2.0f64.powf(2.0f64.powf(0.5))),
        ];
        for (text, expected) in cases {
            let found = value(text);
            assert!(
                (found - expected).abs() < 1e-12,
                "{text}: {found}, not {expected}"
            );
        }
    }

    #[test]
    fn errors_name_the_mistake() {
        let cases = [
            ("", "empty"),
            ("x +", "end"),
            ("x ** 2", "*"),
            ("2x", "operator"),
            ("sin x", "parenthes"),
            ("sine(x)", "did you mean `sin`"),
            ("w + 1", "`w`"),
            ("z", "`z`"),
            ("(x", "closed"),
            ("x)", "no opening one"),
            ("x $ 2", "`$`"),
            ("()", "value"),
            ("1e400", "number"),
            ("sin", "parenthes"),
            ("x(2)", "operator"),
        ];
        for (text, part) in cases {
            let error = Expression::parse(text, &["x", "y", "t"]).unwrap_err();
            assert!(error.reason.contains(part), "{text}: {}", error.reason);
        }
        let long = "x+".repeat(LONGEST);
        assert!(Expression::parse(&long, &["x"]).is_err());
        let deep = "(".repeat(400) + "x" + &")".repeat(400);
        assert!(Expression::parse(&deep, &["x"]).is_err());
    }

    #[test]
    fn rates_are_time_derivatives() {
        for text in [
            "sin(3*t)*x",
            "exp(-t^2)",
            "t^3/y",
            "1/(1+t)",
            "x",
            "-t^2",
            "sqrt(1+t)*cos(t)",
            "t^t - (x+t)^(y*t)",
            "2^t/(3-t)",
            "acos(t)*asin(t) + atan(3*t)",
            "cbrt(t)*cosh(t) - sinh(2*t)",
            "ln(t)*log10(1+t)",
            "tan(t) + tanh(t)^2",
            "step(x-3)*abs(y)*t",
        ] {
            let f = Expression::parse(text, &VARIABLES).unwrap();
            let rates = f.rates().unwrap();
            let place = [2.0, 3.0, 5.0];
            let at = |t: f64| f.value(place, t);
            let (t, h) = (0.4, 1e-3);
            // Finite differences of fourth order.
            let slope =
                (8.0 * (at(t + h) - at(t - h)) - (at(t + 2.0 * h) - at(t - 2.0 * h))) / (12.0 * h);
            let curvature = (16.0 * (at(t + h) + at(t - h))
                - (at(t + 2.0 * h) + at(t - 2.0 * h))
                - 30.0 * at(t))
                / (12.0 * h * h);
            let [rate, second] = rates.values(place, t);
            let size = 1.0 + slope.abs() + curvature.abs();
            assert!(
                (rate - slope).abs() < 1e-8 * size,
                "{text}: {rate}, {slope}"
            );
            assert!(
                (second - curvature).abs() < 1e-7 * size,
                "{text}: {second}, {curvature}"
            );
        }
        let rough = ["step(t)", "x*abs(t)", "sin(floor(t))", "t^sign(t)"];
        for text in rough {
            let f = Expression::parse(text, &VARIABLES).unwrap();
            assert!(!f.rates().unwrap().is_smooth(), "{text}");
        }
    }

    #[test]
    fn jumps_are_located_to_rounding() {
        for (text, expected) in [
            ("step(t - 0.3)*sin(40*t)", vec![0.3]),
            ("step(0.25 - t) + abs(t - 0.5)", vec![0.25, 0.5]),
            ("floor(4*t)", vec![0.25, 0.5, 0.75, 1.0]),
            (
                "sign(sin(7*pi*t))",
                (0..=7).map(|k| f64::from(k) / 7.0).collect(),
            ),
            ("step(t - 0.5)*step(0.5000001 - t)", vec![0.5, 0.500_000_1]),
            ("step(cos(t))*exp(-t^2)/(1 + t)", vec![]),
            ("step(t - x/20)", vec![0.1]),
        ] {
            let f = Expression::parse(text, &VARIABLES).unwrap();
            let jumps = f.jumps().unwrap();
            let mut found = jumps
                .within([2.0, 3.0, 5.0], [0.0, 1.0 + 1e-9], 100)
                .unwrap();
            // A value that rounds to zero between two signs jumps twice.
            found.dedup_by(|b, a| *b - *a < 1e-15);
            assert_eq!(found.len(), expected.len(), "{text}: {found:?}");
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-15, "{text}: {found}");
            }
        }
        let many = Expression::parse("round(1e6*t)", &["t"])
            .unwrap()
            .jumps()
            .unwrap();
        assert!(many.within([0.0; 3], [0.0, 1.0], 100).is_none());
        assert!(
            Expression::parse("sin(t)", &["t"])
                .unwrap()
                .jumps()
                .is_none()
        );
    }

    #[test]
    fn powers_have_derivatives_at_zero() {
        for (text, expected) in [
            ("t", [1.0, 0.0]),
            ("t^1", [1.0, 0.0]),
            ("3*t^2", [0.0, 6.0]),
            ("t^0", [0.0, 0.0]),
        ] {
            let f = Expression::parse(text, &["t"]).unwrap();
            assert_eq!(f.rates().unwrap().values([0.0; 3], 0.0), expected, "{text}");
        }
    }

    /// Symbolic derivatives of an expression of the largest length overflow the stack.
    #[test]
    fn long_sums_have_derivatives() {
        let sum = "+t^t".repeat(LONGEST / 4);
        let deep = "sin(".repeat(29) + "t" + &")".repeat(29);
        for text in [sum, deep] {
            let rates = Expression::parse(&text, &["t"]).unwrap().rates().unwrap();
            assert!(rates.values([0.0; 3], 0.5).iter().all(|v| v.is_finite()));
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(512))]
        #[test]
        fn arbitrary_text_never_panics(text in "[-+*/^() .,0-9etxsincopqrt]{0,24}") {
            if let Ok(expression) = Expression::parse(&text, &VARIABLES) {
                expression.value([0.1, 0.2, 0.3], 0.4);
            }
        }
    }
}
