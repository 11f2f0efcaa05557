//! Automatic differentiation: values with their first two time derivatives. Symbolic derivatives, which exmex
//! also offers, recurse with the length of the expression: a sum of a hundred terms overflows the stack.

use std::num::ParseFloatError;
use std::str::FromStr;

use exmex::{BinOp, MakeOperators, Operator};

/// Smoothness of a value in time; a combination has the lowest smoothness of its parts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Variation {
    #[default]
    Constant,
    Smooth,
    /// With jumps or kinks, so that derivatives do not exist everywhere.
    Rough,
}

/// A value and its first two derivatives.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Jet {
    pub(super) value: f64,
    pub(super) rate: f64,
    pub(super) second: f64,
    pub(super) variation: Variation,
}

impl Jet {
    pub(super) fn constant(value: f64) -> Self {
        Self {
            value,
            ..Self::default()
        }
    }

    /// Returns the time t.
    pub(super) fn time(t: f64) -> Self {
        Self {
            value: t,
            rate: 1.0,
            second: 0.0,
            variation: Variation::Smooth,
        }
    }

    /// Returns f(u) by the chain rule from f, f′ and f″ at u. For a constant only f is used: derivatives may
    /// be infinite, and infinity times zero is NaN.
    fn chain(self, value: f64, derivatives: impl FnOnce(f64) -> [f64; 2]) -> Self {
        if self.variation == Variation::Constant {
            return Self::constant(value);
        }
        let [first, second] = derivatives(self.value);
        Self {
            value,
            rate: first * self.rate,
            second: second * self.rate * self.rate + first * self.second,
            variation: self.variation,
        }
    }

    /// Returns f(u) for a function with jumps or kinks and constant slopes between them; derivatives are those between jumps.
    fn rough(self, f: impl FnOnce(f64) -> f64, slope: impl FnOnce(f64) -> f64) -> Self {
        match self.variation {
            Variation::Constant => Self::constant(f(self.value)),
            _ => Self {
                variation: Variation::Rough,
                ..self.chain(f(self.value), |u| [slope(u), 0.0])
            },
        }
    }

    fn negated(self) -> Self {
        Self {
            value: -self.value,
            rate: -self.rate,
            second: -self.second,
            variation: self.variation,
        }
    }

    fn plus(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            rate: self.rate + other.rate,
            second: self.second + other.second,
            variation: self.variation.max(other.variation),
        }
    }

    fn times(self, other: Self) -> Self {
        // A constant enters the derivatives as a factor only.
        let scaled = |jet: Self, by: f64| {
            let part = |derivative: f64| {
                if derivative == 0.0 {
                    0.0
                } else {
                    by * derivative
                }
            };
            [part(jet.rate), part(jet.second)]
        };
        let (a, b) = (scaled(self, other.value), scaled(other, self.value));
        Self {
            value: self.value * other.value,
            rate: a[0] + b[0],
            second: a[1] + 2.0 * self.rate * other.rate + b[1],
            variation: self.variation.max(other.variation),
        }
    }

    fn over(self, other: Self) -> Self {
        let inverse = 1.0 / other.value;
        let square = inverse * inverse;
        self.times(other.chain(inverse, |_| [-square, 2.0 * square * inverse]))
    }

    fn power(self, exponent: Self) -> Self {
        let (u, p) = (self.value, exponent.value);
        let value = u.powf(p);
        if exponent.variation == Variation::Constant {
            // Avoids p u^(p−1) for p = 0, which is NaN at u = 0.
            let term = |factor: f64, p: f64| {
                if factor == 0.0 {
                    0.0
                } else {
                    factor * u.powf(p)
                }
            };
            return self.chain(value, |_| [term(p, p - 1.0), term(p * (p - 1.0), p - 2.0)]);
        }
        let logarithm = exponent.times(self.ln());
        logarithm.chain(value, |_| [value, value])
    }

    fn ln(self) -> Self {
        self.chain(self.value.ln(), |u| [1.0 / u, -1.0 / (u * u)])
    }
}

impl FromStr for Jet {
    type Err = ParseFloatError;

    fn from_str(text: &str) -> Result<Self, ParseFloatError> {
        text.parse().map(Self::constant)
    }
}

/// Functions and operators of expressions for jets.
#[derive(Clone, Debug)]
pub(super) struct JetOperators;

impl MakeOperators<Jet> for JetOperators {
    fn make<'a>() -> Vec<Operator<'a, Jet>> {
        let joined = |apply, prio, is_commutative| BinOp {
            apply,
            prio,
            is_commutative,
        };
        let unary = Operator::make_unary;
        vec![
            Operator::make_bin_unary("+", joined(Jet::plus, 0, true), |a| a),
            Operator::make_bin_unary(
                "-",
                joined(|a, b| a.plus(b.negated()), 1, false),
                Jet::negated,
            ),
            Operator::make_bin("*", joined(Jet::times, 2, true)),
            Operator::make_bin("/", joined(Jet::over, 3, false)),
            Operator::make_bin("^", joined(Jet::power, 4, false)),
            Operator::make_constant("pi", Jet::constant(std::f64::consts::PI)),
            Operator::make_constant("e", Jet::constant(std::f64::consts::E)),
            unary("abs", |a| {
                a.rough(f64::abs, |u| if u < 0.0 { -1.0 } else { 1.0 })
            }),
            unary("ceil", |a| a.rough(f64::ceil, |_| 0.0)),
            unary("floor", |a| a.rough(f64::floor, |_| 0.0)),
            unary("round", |a| a.rough(f64::round, |_| 0.0)),
            unary("sign", |a| a.rough(super::sign, |_| 0.0)),
            unary("step", |a| a.rough(super::step, |_| 0.0)),
            unary("acos", |a| {
                a.chain(a.value.acos(), |u| {
                    let s = 1.0 - u * u;
                    [-1.0 / s.sqrt(), -u / (s * s.sqrt())]
                })
            }),
            unary("asin", |a| {
                a.chain(a.value.asin(), |u| {
                    let s = 1.0 - u * u;
                    [1.0 / s.sqrt(), u / (s * s.sqrt())]
                })
            }),
            unary("atan", |a| {
                a.chain(a.value.atan(), |u| {
                    let s = 1.0 / (1.0 + u * u);
                    [s, -2.0 * u * s * s]
                })
            }),
            unary("cbrt", |a| {
                let root = a.value.cbrt();
                let square = root * root;
                a.chain(root, |_| {
                    [1.0 / (3.0 * square), -2.0 / (9.0 * square * square * root)]
                })
            }),
            unary("cos", |a| {
                let (sine, cosine) = a.value.sin_cos();
                a.chain(cosine, |_| [-sine, -cosine])
            }),
            unary("cosh", |a| {
                a.chain(a.value.cosh(), |u| [u.sinh(), u.cosh()])
            }),
            unary("exp", |a| {
                let value = a.value.exp();
                a.chain(value, |_| [value, value])
            }),
            unary("ln", Jet::ln),
            unary("log10", |a| {
                let scale = std::f64::consts::LOG10_E;
                a.chain(a.value.log10(), |u| [scale / u, -scale / (u * u)])
            }),
            unary("sin", |a| {
                let (sine, cosine) = a.value.sin_cos();
                a.chain(sine, |_| [cosine, -sine])
            }),
            unary("sinh", |a| {
                a.chain(a.value.sinh(), |u| [u.cosh(), u.sinh()])
            }),
            unary("sqrt", |a| {
                let root = a.value.sqrt();
                a.chain(root, |u| [0.5 / root, -0.25 / (u * root)])
            }),
            unary("tan", |a| {
                let value = a.value.tan();
                let first = 1.0 + value * value;
                a.chain(value, |_| [first, 2.0 * value * first])
            }),
            unary("tanh", |a| {
                let value = a.value.tanh();
                let first = 1.0 - value * value;
                a.chain(value, |_| [first, -2.0 * value * first])
            }),
        ]
    }
}
