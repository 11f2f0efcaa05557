//! Tables of time functions.

use crate::error::{PericlesError, Result};

/// A time function given by a table: linear between the rows, constant before the first and after the last.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeTable {
    times: Vec<f64>,
    values: Vec<f64>,
    /// ∫ g from the first time to each row.
    integrals: Vec<f64>,
}

impl TimeTable {
    /// Makes a table from rows (time in s, value).
    ///
    /// # Errors
    /// No rows; numbers that are not finite; times that do not increase.
    pub fn new(rows: Vec<(f64, f64)>) -> Result<Self> {
        if rows.is_empty() {
            return Err(PericlesError::BadTimeTable { row: 0 });
        }
        for (row, (t, value)) in rows.iter().enumerate() {
            let rises = row == 0 || *t > rows[row - 1].0;
            if !(rises && t.is_finite() && value.is_finite()) {
                return Err(PericlesError::BadTimeTable { row });
            }
        }
        let mut integrals = vec![0.0];
        for pair in rows.windows(2) {
            let [(t, value), (next, next_value)] = [pair[0], pair[1]];
            let before = integrals[integrals.len() - 1];
            integrals.push(before + 0.5 * (value + next_value) * (next - t));
        }
        let (times, values) = rows.into_iter().unzip();
        Ok(Self {
            times,
            values,
            integrals,
        })
    }

    /// Index of the last row at or before t; `None` before the first.
    fn row(&self, t: f64) -> Option<usize> {
        self.times.partition_point(|&time| time <= t).checked_sub(1)
    }

    fn slope(&self, row: usize) -> f64 {
        if row + 1 < self.times.len() {
            (self.values[row + 1] - self.values[row]) / (self.times[row + 1] - self.times[row])
        } else {
            0.0
        }
    }

    /// g(t).
    pub fn value(&self, t: f64) -> f64 {
        match self.row(t) {
            None => self.values[0],
            Some(row) => self.values[row] + self.slope(row) * (t - self.times[row]),
        }
    }

    /// g'(t); at a kink the right-hand derivative.
    pub fn derivative(&self, t: f64) -> f64 {
        self.row(t).map_or(0.0, |row| self.slope(row))
    }

    /// ∫₀ᵗ g.
    pub fn integral(&self, t: f64) -> f64 {
        self.beyond_first(t) - self.beyond_first(0.0)
    }

    fn beyond_first(&self, t: f64) -> f64 {
        match self.row(t) {
            None => self.values[0] * (t - self.times[0]),
            Some(row) => {
                let beyond = t - self.times[row];
                self.integrals[row] + beyond * (self.values[row] + 0.5 * self.slope(row) * beyond)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolates_between_rows_and_is_constant_beyond() {
        let table = TimeTable::new(vec![(1.0, 2.0), (2.0, 6.0), (4.0, 0.0)]).unwrap();
        let cases = [
            (0.0, 2.0),
            (1.0, 2.0),
            (1.5, 4.0),
            (2.0, 6.0),
            (3.0, 3.0),
            (9.0, 0.0),
        ];
        for (t, value) in cases {
            assert_eq!(table.value(t), value);
        }
        // 2 before the first row, then trapezoids
        assert_eq!(table.integral(9.0), 2.0 + 4.0 + 6.0);
        for bad in [vec![], vec![(0.0, 1.0), (0.0, 2.0)], vec![(0.0, f64::NAN)]] {
            assert!(TimeTable::new(bad).is_err());
        }
    }
}
