//! Interval arithmetic: the values of an expression over a range of times, to find its jumps and kinks.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::num::ParseFloatError;
use std::str::FromStr;

use exmex::{BinOp, MakeOperators, Operator};

/// An interval that contains all values of an expression over a range of times.
#[derive(Debug, Clone, Copy)]
pub(super) struct Span {
    low: f64,
    high: f64,
    /// Whether a part of the expression may have a jump or kink within the range.
    pub(super) has_jump: bool,
}

impl Default for Span {
    fn default() -> Self {
        Self::constant(0.0)
    }
}

impl Span {
    pub(super) fn constant(value: f64) -> Self {
        Self::of(value, value, false)
    }

    /// Returns the times of a range.
    pub(super) fn times(from: f64, to: f64) -> Self {
        Self::of(from, to, false)
    }

    /// Returns the interval between two values; the whole line if one is NaN.
    fn of(a: f64, b: f64, has_jump: bool) -> Self {
        let is_known = !a.is_nan() && !b.is_nan();
        let (low, high) = match is_known {
            true => (a.min(b), a.max(b)),
            false => (f64::NEG_INFINITY, f64::INFINITY),
        };
        Self {
            low,
            high,
            has_jump,
        }
    }

    fn whole(self) -> Self {
        Self::of(f64::NEG_INFINITY, f64::INFINITY, self.has_jump)
    }

    /// Returns the values of a monotone function.
    fn monotone(self, f: impl Fn(f64) -> f64) -> Self {
        Self::of(f(self.low), f(self.high), self.has_jump)
    }

    /// Returns the values of a function that is symmetric about zero and increases above it.
    fn even(self, f: impl Fn(f64) -> f64) -> Self {
        let most = self.low.abs().max(self.high.abs());
        let least = match self.crosses_zero() {
            true => 0.0,
            false => self.low.abs().min(self.high.abs()),
        };
        Self::of(f(least), f(most), self.has_jump)
    }

    /// Returns the values of a monotone function with jumps only.
    fn piecewise_constant(self, f: impl Fn(f64) -> f64) -> Self {
        let (low, high) = (f(self.low), f(self.high));
        let jumps = low != high;
        Self::of(low, high, self.has_jump || jumps)
    }

    fn crosses_zero(self) -> bool {
        self.low < 0.0 && self.high > 0.0
    }

    /// Returns whether zero is in the interval, or an end of it, so that kinks at ends of bisected ranges are found.
    fn touches_zero(self) -> bool {
        self.low <= 0.0 && self.high >= 0.0 && self.low < self.high
    }

    fn absolute(self) -> Self {
        Self {
            has_jump: self.has_jump || self.touches_zero(),
            ..self.even(f64::abs)
        }
    }

    fn negated(self) -> Self {
        Self::of(-self.low, -self.high, self.has_jump)
    }

    fn plus(self, other: Self) -> Self {
        let jumps = self.has_jump || other.has_jump;
        Self::of(self.low + other.low, self.high + other.high, jumps)
    }

    fn times_span(self, other: Self) -> Self {
        let jumps = self.has_jump || other.has_jump;
        let mut all = [0.0; 4];
        for (k, product) in all.iter_mut().enumerate() {
            let a = if k % 2 == 0 { self.low } else { self.high };
            let b = if k < 2 { other.low } else { other.high };
            // Infinity times zero: the factor is zero at all times.
            *product = if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        }
        let low = all.iter().copied().fold(f64::INFINITY, f64::min);
        let high = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Self::of(low, high, jumps)
    }

    fn over(self, other: Self) -> Self {
        if other.low <= 0.0 && other.high >= 0.0 {
            return self.plus(other).whole();
        }
        self.times_span(other.monotone(|x| 1.0 / x))
    }

    fn power(self, exponent: Self) -> Self {
        let jumps = self.has_jump || exponent.has_jump;
        if self.low >= 0.0 {
            let corners =
                [self.low, self.high].map(|u| [exponent.low, exponent.high].map(|p| u.powf(p)));
            let all = corners.as_flattened();
            if all.iter().any(|value| value.is_nan()) {
                return self.plus(exponent).whole();
            }
            let low = all.iter().copied().fold(f64::INFINITY, f64::min);
            let high = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            return Self::of(low, high, jumps);
        }
        let power = exponent.low;
        let is_whole = power == exponent.high && power.fract() == 0.0 && power > 0.0;
        let span = match (is_whole, power % 2.0 == 0.0) {
            (false, _) => self.whole(),
            (true, true) => self.even(|u| u.powf(power)),
            (true, false) => self.monotone(|u| u.powf(power)),
        };
        Self {
            has_jump: jumps,
            ..span
        }
    }

    /// Returns the values of a function with slopes from −1 to 1 and values from −1 to 1.
    fn wave(self, f: impl Fn(f64) -> f64) -> Self {
        let width = self.high - self.low;
        if width.is_nan() || width >= TAU {
            return Self::of(-1.0, 1.0, self.has_jump);
        }
        // The middle of two adjacent numbers is one of them.
        let middle = f(self.low + 0.5 * width);
        Self::of(
            (middle - width).max(-1.0),
            (middle + width).min(1.0),
            self.has_jump,
        )
    }

    fn tangent(self) -> Self {
        let branch = |x: f64| ((x + FRAC_PI_2) / PI).floor();
        match branch(self.low) == branch(self.high) {
            true => self.monotone(f64::tan),
            false => self.whole(),
        }
    }
}

impl FromStr for Span {
    type Err = ParseFloatError;

    fn from_str(text: &str) -> Result<Self, ParseFloatError> {
        text.parse().map(Self::constant)
    }
}

/// Functions and operators of expressions for intervals.
#[derive(Clone, Debug)]
pub(super) struct SpanOperators;

impl MakeOperators<Span> for SpanOperators {
    fn make<'a>() -> Vec<Operator<'a, Span>> {
        let joined = |apply, prio, is_commutative| BinOp {
            apply,
            prio,
            is_commutative,
        };
        let unary = Operator::make_unary;
        vec![
            Operator::make_bin_unary("+", joined(Span::plus, 0, true), |a| a),
            Operator::make_bin_unary(
                "-",
                joined(|a, b| a.plus(b.negated()), 1, false),
                Span::negated,
            ),
            Operator::make_bin("*", joined(Span::times_span, 2, true)),
            Operator::make_bin("/", joined(Span::over, 3, false)),
            Operator::make_bin("^", joined(Span::power, 4, false)),
            Operator::make_constant("pi", Span::constant(PI)),
            Operator::make_constant("e", Span::constant(std::f64::consts::E)),
            unary("abs", Span::absolute),
            unary("ceil", |a| a.piecewise_constant(f64::ceil)),
            unary("floor", |a| a.piecewise_constant(f64::floor)),
            unary("round", |a| a.piecewise_constant(f64::round)),
            unary("sign", |a| a.piecewise_constant(super::sign)),
            unary("step", |a| a.piecewise_constant(super::step)),
            unary("acos", |a| a.monotone(f64::acos)),
            unary("asin", |a| a.monotone(f64::asin)),
            unary("atan", |a| a.monotone(f64::atan)),
            unary("cbrt", |a| a.monotone(f64::cbrt)),
            unary("cos", |a| a.wave(f64::cos)),
            unary("cosh", |a| a.even(f64::cosh)),
            unary("exp", |a| a.monotone(f64::exp)),
            unary("ln", |a| a.monotone(f64::ln)),
            unary("log10", |a| a.monotone(f64::log10)),
            unary("sin", |a| a.wave(f64::sin)),
            unary("sinh", |a| a.monotone(f64::sinh)),
            unary("sqrt", |a| a.monotone(f64::sqrt)),
            unary("tan", Span::tangent),
            unary("tanh", |a| a.monotone(f64::tanh)),
        ]
    }
}
