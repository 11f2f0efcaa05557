//! Time functions: `function = { kind = … }`.

use std::num::NonZeroUsize;
use std::sync::{Arc, LazyLock};

use gauss_quad::GaussLegendre;
use pericles::boundary::{TimeCourse, TimeFunction, TimeTable};
use pericles_deck_derive::DeckKeys;
use serde::{Deserialize, Serialize};

use crate::component;
use crate::declaration::DeckTable;
use crate::expression::{Expression, Rates};
use crate::fault::Fault;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};

/// Time function g(t) that multiplies the amplitude of a load or constraint, or the difference between a prescribed
/// temperature and its reference. Default: g = 1; in static schemes, loads and prescribed displacements that do not depend
/// on time grow linearly over all load steps, from zero at t = 0 to their values at `end`, unless they have `from` or
/// `until` or the body has initial displacements. `function = { kind = "constant" }` applies them at once.
///
/// The scope is whether the function is that of a prescribed motion, whose acceleration is its derivative.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, DeckKeys)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
#[deck(
    tag = "kind",
    what = "time function",
    tag_about = "Kind of time function, with t₀ = `start` and T = `duration`. `constant`: g = 1; `ramp`: g = (t − t₀)/T, \
                 limited to 0 ≤ g ≤ 1; `pulse`: g = sin²(π (t − t₀)/T) for t₀ ≤ t ≤ t₀ + T, otherwise 0; `table`: \
                 piecewise linear; `expression`: a function of t (s).",
    define = "function",
    scope = bool
)]
pub enum TimeHistory {
    /// g = 1.
    #[default]
    Constant,
    /// g = (t − start)/duration, limited to 0 ≤ g ≤ 1.
    Ramp {
        /// ramp, pulse: start time t₀.
        ///
        /// In s.
        #[deck(quantity = Time, default = 0.0)]
        start: f64,
        /// ramp, pulse: duration T.
        ///
        /// In s.
        #[deck(quantity = Time, range = POSITIVE)]
        duration: f64,
    },
    /// g = sin²(π (t − start)/duration) within the duration, otherwise 0.
    Pulse {
        /// ramp, pulse: start time t₀.
        ///
        /// In s.
        #[deck(quantity = Time, default = 0.0)]
        start: f64,
        /// ramp, pulse: duration T.
        ///
        /// In s.
        #[deck(quantity = Time, range = POSITIVE)]
        duration: f64,
    },
    /// Piecewise linear.
    Table(
        /// table: rows [time, value] with increasing times.
        ///
        /// Time in s.
        #[deck(key = "rows", required, with = rows)]
        Vec<(f64, f64)>,
    ),
    /// An expression.
    Expression(
        /// expression: g(t), such as "sin(2*pi*1e6*t)".
        #[deck(key = "expression", with = expression)]
        Expression,
    ),
}

impl TimeHistory {
    /// Returns whether the function is 1 at all times.
    pub fn is_constant(&self) -> bool {
        *self == Self::Constant
    }

    /// Returns the function that the engine evaluates.
    ///
    /// # Errors
    /// A table without rows, or with times that do not increase.
    pub fn function(&self) -> Result<TimeFunction, Fault> {
        Ok(match self {
            Self::Constant => TimeFunction::Constant,
            &Self::Ramp { start, duration } => TimeFunction::Ramp { start, duration },
            &Self::Pulse { start, duration } => TimeFunction::Pulse { start, duration },
            Self::Table(rows) => TimeFunction::Table(Arc::new(TimeTable::new(rows.clone())?)),
            Self::Expression(text) => TimeFunction::Course(Arc::new(Course::new(text.clone()))),
        })
    }

    /// Returns the function for a prescribed motion, whose acceleration is its derivative.
    ///
    /// # Errors
    /// As [`TimeHistory::function`]; an expression with jumps or kinks.
    pub fn smooth_function(&self) -> Result<TimeFunction, Fault> {
        if let Self::Expression(expression) = self {
            let course = Course::new(expression.clone());
            if !course.has_rates() {
                return Err(course.rough());
            }
        }
        self.function()
    }
}

/// Reads the time function of a table; `is_motion`: of a prescribed motion.
pub(crate) fn function(table: &Table<'_>, is_motion: bool) -> Option<TimeHistory> {
    TimeHistory::read_table(table.table_or_empty("function")?, is_motion)
}

fn expression(item: &Item<'_>, is_motion: bool) -> Option<Expression> {
    let expression = component::expression(item, &["t"])?;
    let course = Course::new(expression.clone());
    if is_motion && !course.has_rates() {
        item.report(course.rough());
        return None;
    }
    Some(expression)
}

/// Reads `[[time, value], …]`.
fn rows<S>(item: &Item<'_>, _: S) -> Option<Vec<(f64, f64)>> {
    let mut rows = Some(Vec::new());
    for row in item.list("a list of rows, each [time, value]")? {
        let read = row.exactly(2, "a row [time, value]").and_then(|pair| {
            let t = pair[0].quantity(Quantity::Time);
            let value = pair[1].quantity(Quantity::Number);
            Some((t?, value?))
        });
        match (read, &mut rows) {
            (Some(read), Some(rows)) => rows.push(read),
            _ => rows = None,
        }
    }
    let rows = rows?;
    item.accept(TimeTable::new(rows.clone()))?;
    Some(rows)
}

/// A time function given as an expression.
#[derive(Debug)]
pub struct Course {
    value: Expression,
    /// Derivatives; none if the expression has jumps or kinks.
    rates: Option<Rates>,
}

impl Course {
    /// From an expression of t, or of position and t.
    pub fn new(value: Expression) -> Self {
        let rates = value.rates();
        Self { value, rates }
    }

    /// Returns the function (order 0), its integral from t = 0 (−1) or one of its first two derivatives (1,
    /// 2) at a position. NaN for a derivative that does not exist.
    pub fn at(&self, order: i32, place: [f64; 3], t: f64) -> f64 {
        match order {
            -1 => integral(|t| self.value.value(place, t), t),
            0 => self.value.value(place, t),
            _ => match &self.rates {
                Some(rates) => rates.values(place, t)[(order - 1).min(1) as usize],
                None => f64::NAN,
            },
        }
    }

    /// Returns the error for a prescribed motion with jumps or kinks.
    pub fn rough(&self) -> Fault {
        let reason = "it has no derivative in time at jumps or kinks of abs, ceil, floor, round, sign or step of t, but a prescribed motion needs one; use a smooth expression, or the piecewise \
                     linear function = { kind = \"table\", rows = [[time, value], …] }";
        Fault::bad_expression(self.value.text().into(), reason.into())
    }

    /// Returns whether it has derivatives.
    pub fn has_rates(&self) -> bool {
        self.rates.is_some()
    }
}

impl TimeCourse for Course {
    fn value(&self, t: f64) -> f64 {
        self.at(0, [0.0; 3], t)
    }

    fn derivative(&self, t: f64) -> f64 {
        self.at(1, [0.0; 3], t)
    }

    fn second_derivative(&self, t: f64) -> f64 {
        self.at(2, [0.0; 3], t)
    }

    fn integral(&self, t: f64) -> f64 {
        self.at(-1, [0.0; 3], t)
    }
}

/// Gauss nodes per panel.
const NODES: NonZeroUsize = NonZeroUsize::new(5).unwrap();

/// Computes ∫₀ᵗ f by Gauss quadrature on equal panels, doubled until two results agree to 1e-13 of the integral of |f|.
/// The result depends on t only, not on earlier calls.
fn integral(f: impl Fn(f64) -> f64, t: f64) -> f64 {
    if t == 0.0 {
        return 0.0;
    }
    static RULE: LazyLock<GaussLegendre> = LazyLock::new(|| GaussLegendre::new(NODES));
    let with = |panels: usize| {
        let width = t / panels as f64;
        let (mut sum, mut size) = (0.0, 0.0);
        for panel in 0..panels {
            let start = panel as f64 * width;
            let mut magnitude = 0.0;
            sum += RULE.integrate(start, start + width, |t| {
                let value = f(t);
                magnitude += value.abs();
                value
            });
            // Equal weights are accurate enough for a scale.
            size += width.abs() * magnitude / NODES.get() as f64;
        }
        (sum, size)
    };
    let mut panels = 8;
    let (mut before, _) = with(panels);
    loop {
        panels *= 2;
        let (sum, size) = with(panels);
        if (sum - before).abs() <= 1e-13 * size || panels >= 1 << 14 || !sum.is_finite() {
            return sum;
        }
        before = sum;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrals_and_derivatives_match_the_expression() {
        let course = |text| Course::new(Expression::parse(text, &["t"]).unwrap());
        let wave = course("sin(200*t)*exp(-t)");
        assert!(wave.has_rates());
        // ∫ e^{-t} sin(a t) = (a − e^{-t}(sin(a t) + a cos(a t)))/(1 + a²)
        let (a, t) = (200.0f64, 3.0f64);
        let exact = (a - (-t).exp() * ((a * t).sin() + a * (a * t).cos())) / (1.0 + a * a);
        assert!((TimeCourse::integral(&wave, t) - exact).abs() < 1e-13);
        let square = course("t^2");
        assert!((TimeCourse::integral(&square, -3.0) + 9.0).abs() < 1e-13);
        assert!((TimeCourse::second_derivative(&square, 1.0) - 2.0).abs() < 1e-13);
        assert!(!course("floor(t)").has_rates());
    }
}
