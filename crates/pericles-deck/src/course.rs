//! Time functions: `function = { kind = … }`.

use std::collections::HashMap;
use std::num::NonZeroUsize;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use gauss_quad::GaussLegendre;
use pericles::boundary::{MotionKind, TimeCourse, TimeFunction, TimeTable};
use pericles_deck_derive::DeckKeys;
use serde::{Deserialize, Serialize};

use crate::component;
use crate::declaration::DeckTable;
use crate::expression::{Expression, Jumps, Rates};
use crate::fault::Fault;
use crate::quantity::Quantity;
use crate::reader::{Item, Table};

/// Time function g(t) that multiplies the amplitude of a load or constraint, or the difference between a prescribed
/// temperature and its reference. Default: g = 1; in static schemes, loads and prescribed displacements that do not depend
/// on time grow linearly over all load steps, from zero at t = 0 to their values at `end`, unless they have `from` or
/// `until` or the body has initial displacements. `function = { kind = "constant" }` applies them at once.
///
/// The scope is whether the function is that of a prescribed displacement, whose velocity is its derivative.
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

    /// Returns the function for a prescribed motion until a time (s).
    ///
    /// # Errors
    /// As [`TimeHistory::function`]; for a displacement an expression with jumps or kinks, for a velocity one with very many.
    pub fn motion_function(&self, kind: MotionKind, end: f64) -> Result<TimeFunction, Fault> {
        if let Self::Expression(expression) = self {
            let course = Course::new(expression.clone());
            course.check_motion(kind, end)?;
        }
        self.function()
    }
}

/// Reads the time function of a table; `is_displacement`: of a prescribed displacement.
pub(crate) fn function(table: &Table<'_>, is_displacement: bool) -> Option<TimeHistory> {
    TimeHistory::read_table(table.table_or_empty("function")?, is_displacement)
}

fn expression(item: &Item<'_>, is_displacement: bool) -> Option<Expression> {
    let expression = component::expression(item, &["t"])?;
    let course = Course::new(expression.clone());
    if is_displacement && !course.is_smooth() {
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
    /// Derivatives, between jumps and kinks.
    rates: Option<Rates>,
    /// Jumps and kinks, if there are any.
    jumps: Option<Jumps>,
    /// Pieces between jumps by position; those of expressions of time only are the same for all positions.
    pieces: Mutex<HashMap<[u64; 3], Pieces>>,
}

/// Pieces of a function between its jumps.
#[derive(Debug, Clone, Default)]
struct Pieces {
    /// End of the range in which the jumps are known, s.
    until: f64,
    /// Jumps, and the integral from zero to each.
    ends: Vec<(f64, f64)>,
}

impl Course {
    /// Largest number of jumps within a run.
    pub const MOST_JUMPS: usize = 10_000;

    /// From an expression of t, or of position and t.
    pub fn new(value: Expression) -> Self {
        Self {
            rates: value.rates(),
            jumps: value.jumps(),
            value,
            pieces: Mutex::default(),
        }
    }

    /// Returns the function (order 0), its integral from t = 0 (−1) or one of its first two derivatives (1,
    /// 2) at a position, which are those between jumps. NaN for a derivative that does not exist.
    pub fn at(&self, order: i32, place: [f64; 3], t: f64) -> f64 {
        match order {
            -1 => self.integral_at(place, t),
            0 => self.value.value(place, t),
            _ => match &self.rates {
                Some(rates) => rates.values(place, t)[(order - 1).min(1) as usize],
                None => f64::NAN,
            },
        }
    }

    /// Returns the error for a prescribed displacement with jumps or kinks.
    pub fn rough(&self) -> Fault {
        let reason = "it has no derivative in time at jumps or kinks of abs, ceil, floor, round, sign or step of t, but a prescribed displacement needs one; prescribe a velocity, which may have jumps, or use a smooth \
                     expression or the piecewise linear function = { kind = \"table\", rows = [[time, value], …] }";
        Fault::bad_expression(self.value.text().into(), reason.into())
    }

    /// Returns whether it has derivatives at all times.
    pub fn is_smooth(&self) -> bool {
        self.rates.is_some() && self.jumps.is_none()
    }

    /// Returns an error if a motion until a time (s) cannot be prescribed by it.
    fn check_motion(&self, kind: MotionKind, end: f64) -> Result<(), Fault> {
        match kind {
            MotionKind::Displacement if !self.is_smooth() => Err(self.rough()),
            MotionKind::Displacement => Ok(()),
            MotionKind::Velocity => self.check_jumps([0.0; 3], end),
        }
    }

    /// Returns an error if there are more jumps than supported at a position until a time.
    ///
    /// # Errors
    /// More than [`Course::MOST_JUMPS`] jumps.
    pub fn check_jumps(&self, place: [f64; 3], end: f64) -> Result<(), Fault> {
        let window = [0.0, window_of(end)];
        let found = match &self.jumps {
            None => return Ok(()),
            Some(jumps) => jumps.within(place, window, Self::MOST_JUMPS),
        };
        match found {
            Some(_) => Ok(()),
            None => {
                let reason = format!(
                    "it has more than {} jumps or kinks within the run, or a function such as step of a value that remains zero",
                    Self::MOST_JUMPS
                );
                Err(Fault::bad_expression(self.value.text().into(), reason))
            }
        }
    }

    /// Computes ∫₀ᵗ of the function: piece by piece between its jumps. The result depends on t only, not on earlier calls.
    fn integral_at(&self, place: [f64; 3], t: f64) -> f64 {
        let f = |t: f64| self.value.value(place, t);
        let Some(jumps) = &self.jumps else {
            return integral(f, [0.0, t], 8);
        };
        if t <= 0.0 {
            // Runs begin at t = 0.
            return integral(f, [0.0, t], 8);
        }
        let key = match self.value.depends_on_place() {
            true => place.map(f64::to_bits),
            false => [0; 3],
        };
        let mut known = self.pieces.lock().unwrap_or_else(PoisonError::into_inner);
        let pieces = known.entry(key).or_default();
        if pieces.until < t {
            // Windows are halves of each other, so that the same intervals are bisected for every t.
            let until = window_of(t);
            let found = jumps.within(place, [0.0, until], Self::MOST_JUMPS);
            let (mut start, mut sum) = (0.0, 0.0);
            let ends = found.unwrap_or_default().into_iter().map(|end| {
                sum += piece(f, [start, end]);
                start = end;
                (end, sum)
            });
            *pieces = Pieces {
                ends: ends.collect(),
                until,
            };
        }
        let before = pieces.ends.partition_point(|(end, _)| *end <= t);
        let (start, sum) = before
            .checked_sub(1)
            .map_or((0.0, 0.0), |last| pieces.ends[last]);
        sum + piece(f, [start, t])
    }
}

/// Returns the smallest power of two that is at least t.
fn window_of(t: f64) -> f64 {
    let exponent = t.log2().ceil() as i32;
    let window = 2.0f64.powi(exponent);
    if window < t { 2.0 * window } else { window }
}

/// Computes the integral of a function between two jumps, at which it has the values of its pieces.
fn piece(f: impl Fn(f64) -> f64, range: [f64; 2]) -> f64 {
    integral(f, range, 1)
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

/// Computes ∫ f by Gauss quadrature on equal panels, doubled until two results agree to 1e-13 of the integral of |f|.
fn integral(f: impl Fn(f64) -> f64, [from, to]: [f64; 2], panels: usize) -> f64 {
    if to == from {
        return 0.0;
    }
    static RULE: LazyLock<GaussLegendre> = LazyLock::new(|| GaussLegendre::new(NODES));
    let with = |panels: usize| {
        let width = (to - from) / panels as f64;
        let (mut sum, mut size) = (0.0, 0.0);
        for panel in 0..panels {
            let start = from + panel as f64 * width;
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
    let mut panels = panels;
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
        let wave = course("sin(200*t)*exp(-t)");
        assert!(wave.is_smooth());
        // ∫ e^{-t} sin(a t) = (a − e^{-t}(sin(a t) + a cos(a t)))/(1 + a²)
        let (a, t) = (200.0f64, 3.0f64);
        let exact = (a - (-t).exp() * ((a * t).sin() + a * (a * t).cos())) / (1.0 + a * a);
        assert!((TimeCourse::integral(&wave, t) - exact).abs() < 1e-13);
        let square = course("t^2");
        assert!((TimeCourse::integral(&square, -3.0) + 9.0).abs() < 1e-13);
        assert!((TimeCourse::second_derivative(&square, 1.0) - 2.0).abs() < 1e-13);
        assert!(!course("floor(t)").is_smooth());
    }

    /// Integrals of pieces, with jumps at any time and independent of earlier calls.
    #[test]
    fn integrals_across_jumps_are_exact() {
        for (text, exact) in [
            (
                "step(t - 0.3)",
                (|t| (t - 0.3f64).max(0.0)) as fn(f64) -> f64,
            ),
            ("3*step(t - 0.1)*step(0.2 - t)", |t| {
                3.0 * (t.min(0.2) - 0.1).max(0.0)
            }),
            ("sin(2*pi*50*t)*step(5/50 - t)", |t| {
                let w = std::f64::consts::TAU * 50.0;
                (1.0 - (w * t.min(0.1)).cos()) / w
            }),
            ("abs(t - 0.5)", |t| match t < 0.5 {
                true => 0.125 - 0.5 * (0.5 - t) * (0.5 - t),
                false => 0.125 + 0.5 * (t - 0.5) * (t - 0.5),
            }),
            ("floor(10*t)", |t| {
                let whole = (10.0 * t).floor();
                0.1 * (0.5 * whole * (whole - 1.0)) + whole * (t - 0.1 * whole)
            }),
        ] {
            let forward = course(text);
            let times: Vec<f64> = (1..40).map(|k| 0.0247 * f64::from(k)).collect();
            let values: Vec<f64> = times
                .iter()
                .map(|t| TimeCourse::integral(&forward, *t))
                .collect();
            for (t, value) in times.iter().zip(&values) {
                assert!((value - exact(*t)).abs() < 1e-14, "{text}, {t}: {value}");
            }
            // Any order of calls has the same bits.
            let backward = course(text);
            for (t, value) in times.iter().zip(&values).rev() {
                assert_eq!(
                    TimeCourse::integral(&backward, *t).to_bits(),
                    value.to_bits()
                );
            }
        }
        assert!(course("round(1e9*t)").check_jumps([0.0; 3], 1.0).is_err());
        assert!(course("step(t - 1)").check_jumps([0.0; 3], 2.0).is_ok());
    }

    fn course(text: &str) -> Course {
        Course::new(Expression::parse(text, &["t"]).unwrap())
    }
}
