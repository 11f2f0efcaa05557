//! Translation of values and expressions of boundary conditions.

use pericles_deck::Expression;
use serde::Deserialize;
use serde::de::IntoDeserializer;
use serde::de::value::Error;

use crate::entry::DEEPEST;
use crate::table;
use crate::units::{Quantity, Units};

/// A value of a boundary condition.
#[derive(Debug)]
pub(crate) struct Amount {
    /// The expression in units of the input file, of variables in SI units.
    text: String,
    constant: Option<f64>,
    depends_on_time: bool,
}

impl Amount {
    /// Translates a number or an expression of x, y, z and t whose time begins at `start`. Assignments to `value` and
    /// element-wise operators are allowed.
    ///
    /// # Errors
    /// Why there is no translation.
    pub(crate) fn read(given: &str, start: f64, units: &Units) -> Result<Self, String> {
        if let Ok(number) = given.parse() {
            return Self::number(number);
        }
        let mut text = given.trim();
        if let Some((name, value)) = text.split_once('=')
            && name.trim() == "value"
        {
            text = value.trim().trim_end_matches(';');
        }
        let mut plain = text.to_owned();
        for sign in ['*', '/', '+', '-', '^'] {
            plain = plain.replace(&format!(".{sign}"), &sign.to_string());
        }
        let translated = in_si_variables(&without_pairs(&plain, 0), start, units);
        let deserializer = translated.as_str().into_deserializer();
        let parsed = Expression::deserialize(deserializer);
        let expression =
            parsed.map_err(|error: Error| format!("not an expression of Pericles: {error}"))?;
        let depends_on_time = expression.depends_on_time();
        if !depends_on_time && !expression.depends_on_place() {
            return Self::number(expression.value([0.0; 3], 0.0));
        }
        Ok(Self {
            text: translated,
            constant: None,
            depends_on_time,
        })
    }

    fn number(number: f64) -> Result<Self, String> {
        if !number.is_finite() {
            return Err("the value is not finite".into());
        }
        Ok(Self {
            text: String::new(),
            constant: Some(number),
            depends_on_time: false,
        })
    }

    /// Returns the value divided by a number.
    pub(crate) fn over(self, divisor: f64) -> Self {
        Self {
            text: format!("({})/{}", self.text, table::number(divisor)),
            constant: self.constant.map(|number| number / divisor),
            ..self
        }
    }

    /// Returns whether the value is other than zero and the same at all times.
    pub(crate) fn is_steady(&self) -> bool {
        !self.depends_on_time && self.constant != Some(0.0)
    }

    /// Returns the value in SI units, as TOML.
    pub(crate) fn toml(&self, units: &Units, quantity: Quantity) -> String {
        match (self.constant, units.factor(quantity)) {
            (Some(number), _) => units.number(number, quantity),
            (None, 1.0) => format!("{{ expression = {} }}", table::text(&self.text)),
            (None, factor) => {
                let text = format!(
                    "{}*({})",
                    table::number(table::rounded(factor, 12)),
                    self.text
                );
                format!("{{ expression = {} }}", table::text(&text))
            }
        }
    }
}

/// Replaces functions of two arguments by expressions of functions of one argument.
fn without_pairs(text: &str, depth: usize) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(open) = rest.find('(').filter(|_| depth < DEEPEST) {
        let Some((arguments, length)) = arguments(&rest[open + 1..]) else {
            break;
        };
        let (head, tail) = (&rest[..open], &rest[open + 1 + length..]);
        let name = &head[head.trim_end_matches(is_letter).len()..];
        let arguments: Vec<String> = arguments
            .into_iter()
            .map(|argument| without_pairs(argument, depth + 1))
            .collect();
        let pair = match (name, &arguments[..]) {
            // The angle between −π and π.
            ("atan" | "atan2", [y, x]) => {
                format!("(acos(({x})/sqrt(({x})*({x})+({y})*({y})))*(2*step({y})-1))")
            }
            ("pow", [base, exponent]) => format!("(({base})^({exponent}))"),
            ("max", [a, b]) => format!("((({a})+({b})+abs(({a})-({b})))/2)"),
            ("min", [a, b]) => format!("((({a})+({b})-abs(({a})-({b})))/2)"),
            _ => format!("{name}({})", arguments.join(", ")),
        };
        out += &head[..head.len() - name.len()];
        out += &pair;
        rest = tail;
    }
    out + rest
}

/// Returns the arguments, separated by commas, up to the closing parenthesis of a text, and the length with it.
fn arguments(text: &str) -> Option<(Vec<&str>, usize)> {
    let (mut arguments, mut depth, mut begin) = (Vec::new(), 0, 0);
    for (k, c) in text.char_indices() {
        match c {
            '(' => depth += 1,
            ')' if depth > 0 => depth -= 1,
            ',' | ')' if depth == 0 => {
                arguments.push(&text[begin..k]);
                begin = k + 1;
                if c == ')' {
                    return Some((arguments, begin));
                }
            }
            _ => {}
        }
    }
    None
}

fn is_letter(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Replaces names of functions and variables: natural logarithm, time since the start, coordinates and time in SI units.
pub(crate) fn in_si_variables(text: &str, start: f64, units: &Units) -> String {
    let variable = |name: &str, quantity| match units.factor(quantity) {
        1.0 => name.to_owned(),
        factor => format!("({name}/{})", table::number(table::rounded(factor, 12))),
    };
    let mut out = String::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let begins = is_letter(c) && !out.ends_with(|c: char| is_letter(c) || c == '.');
        let length = if begins {
            rest.find(|c: char| !is_letter(c)).unwrap_or(rest.len())
        } else {
            c.len_utf8()
        };
        let (word, left) = rest.split_at(length);
        match word {
            "log" => out.push_str("ln"),
            "x" | "y" | "z" => out.push_str(&variable(word, Quantity::Length)),
            "t" if start != 0.0 => {
                let time = variable("t", Quantity::Time);
                out.push_str(&format!("({time} + {})", table::number(start)));
            }
            // `st` is the time since the start of the step.
            "t" | "st" => out.push_str(&variable("t", Quantity::Time)),
            word => out.push_str(word),
        }
        rest = left;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn translated(text: &str, start: f64) -> String {
        Amount::read(text, start, &Units::default())
            .unwrap()
            .toml(&Units::default(), Quantity::Length)
    }

    #[test]
    fn expressions_keep_their_values() {
        assert_eq!(translated("7.0e+5", 0.0), "700000");
        assert_eq!(
            translated("value = x*10;", 0.0),
            "{ expression = \"x*10\" }"
        );
        assert_eq!(
            translated("1.*t .+ 2.5e-3*x", 0.0),
            "{ expression = \"1*t + 2.5e-3*x\" }"
        );
        assert_eq!(
            translated("log(t)+st", 2.0),
            "{ expression = \"ln((t + 2))+t\" }"
        );
        assert_eq!(
            translated("2*sin(pi/6)*10", 0.0)
                .parse::<f64>()
                .unwrap()
                .round(),
            10.0
        );
        assert_eq!(
            Amount::read("6*t", 0.0, &Units::default())
                .unwrap()
                .over(2.0)
                .toml(&Units::default(), Quantity::Length),
            "{ expression = \"(6*t)/2\" }"
        );
    }

    #[test]
    fn expressions_of_other_units_have_the_same_values() {
        let units = Units::parse("mm,MPa,ms").unwrap();
        // 3 mm/ms · t + 0.5 · x at 2 ms and x = 4 mm: 8 mm.
        let amount = Amount::read("3*t + 0.5*x", 0.0, &units).unwrap();
        let toml = amount.toml(&units, Quantity::Length);
        assert_eq!(
            toml,
            "{ expression = \"0.001*(3*(t/0.001) + 0.5*(x/0.001))\" }"
        );
        let constant = Amount::read("5", 0.0, &units).unwrap();
        assert_eq!(constant.toml(&units, Quantity::Velocity), "5");
    }

    #[test]
    fn functions_of_two_arguments_keep_their_values() {
        let value = |text: &str, [x, y]: [f64; 2]| {
            let text = in_si_variables(&without_pairs(text, 0), 0.0, &Units::default());
            let parsed: Result<Expression, Error> =
                Expression::deserialize(text.as_str().into_deserializer());
            parsed.unwrap().value([x, y, 0.0], 0.0)
        };
        for place @ [x, y] in [
            [3.0, 4.0],
            [-3.0, 4.0],
            [-3.0, -4.0],
            [-1.0, 0.0],
            [0.0, -2.0f64],
        ] {
            let angle = y.atan2(x);
            let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-14, "{place:?}: {a} {b}");
            close(value("atan2(y, x)", place), angle);
            close(value("2*cos(atan(y,x))", place), 2.0 * angle.cos());
            close(
                value("max(x, min(y, 1)) + pow(x, 2)", place),
                x.max(y.min(1.0)) + x * x,
            );
            close(value("sin((x+y)*2)", place), ((x + y) * 2.0).sin());
        }
    }

    #[test]
    fn conditionals_and_unknown_functions_have_no_translation() {
        for text in [
            "if t>2 0 else 20 end",
            "atan2(y)",
            "atan2(y, x, t)",
            "hypot(x, y)",
            "",
            "nan",
            "1/0",
            "value = 1; x = 2;",
        ] {
            assert!(
                Amount::read(text, 0.0, &Units::default()).is_err(),
                "{text}"
            );
        }
    }
}
