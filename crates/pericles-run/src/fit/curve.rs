//! The measured curve, and its distance from that of a run.

use std::path::Path;

use pericles_deck::{SignalExpression, si_unit};
use pericles_io::{CsvData, read_csv};
use serde::{Deserialize, Serialize};

use crate::columns::PairOfColumns;
use crate::error::RunError;

/// Points (x, y) of a measurement in SI units.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(super) struct Measured {
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    /// Names of the columns in the tables of runs.
    pub names: [String; 2],
    /// SI units of the columns; empty if the file gives none.
    pub units: [String; 2],
}

/// Values of a run at the points of a measurement.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sampled {
    pub y: Vec<f64>,
    /// Number of points whose x the run does not reach; they have the last value of the run.
    pub beyond: usize,
}

impl Measured {
    /// Reads the columns `names` of a CSV table whose first line has names with units, such as `CMOD [mm],force [kN]`; a
    /// table of two columns may have other names.
    ///
    /// # Errors
    /// The table cannot be read, does not have the columns, has an unknown unit, or fewer than two points.
    pub fn read(path: &Path, names: [&str; 2]) -> Result<Self, RunError> {
        let damaged = |reason: String| RunError::Damaged {
            path: path.to_owned(),
            reason,
        };
        let table = read_csv(path)?;
        let places = places(&table, names).map_err(damaged)?;
        let (mut columns, mut units) = ([vec![], vec![]], [String::new(), String::new()]);
        for side in 0..2 {
            let column = &table.columns[places[side]];
            let factor;
            (factor, units[side]) = match column.unit() {
                "" => (1.0, String::new()),
                unit => si_unit(unit)
                    .ok_or_else(|| damaged(format!("unknown unit [{unit}] of a column")))?,
            };
            let values = table.values[places[side]].iter();
            columns[side] = values.map(|value| factor * value).collect();
        }
        let [x, y] = columns;
        let points = x.into_iter().zip(y);
        let (x, y): (Vec<f64>, Vec<f64>) = points
            .filter(|(x, y)| x.is_finite() && y.is_finite())
            .unzip();
        if x.len() < 2 {
            return Err(damaged(format!(
                "it has {} point(s) of the curve; at least 2 are needed",
                x.len()
            )));
        }
        if y.iter().all(|y| *y == 0.0) {
            return Err(damaged(format!("all values of {} are zero", names[1])));
        }
        Ok(Self {
            x,
            y,
            names: names.map(str::to_owned),
            units,
        })
    }

    /// Returns the curve of a run at the measured x: at each x that of the first segment of the curve that contains it.
    ///
    /// # Errors
    /// Units of the measurement and of the run differ, or the run has no row.
    pub fn sample(&self, pair: &PairOfColumns) -> Result<Sampled, RunError> {
        for ((name, measured), computed) in self.names.iter().zip(&self.units).zip(&pair.units) {
            if !measured.is_empty() && !SignalExpression::is_same_unit(measured, computed) {
                let reason = format!(
                    "{name} is measured in {measured}, but the run has it in {}; give the run the measured quantity, for instance by body.thickness or [[output.quantity]]",
                    if computed.is_empty() {
                        "no unit"
                    } else {
                        computed
                    }
                );
                return Err(RunError::NoFit { reason });
            }
        }
        let Some(last) = pair.y.last() else {
            let reason = format!(
                "a run has no row with {} and {}",
                self.names[0], self.names[1]
            );
            return Err(RunError::NoFit { reason });
        };
        let found: Vec<Option<f64>> = self.x.iter().map(|&x| at(pair, x)).collect();
        Ok(Sampled {
            beyond: found.iter().filter(|y| y.is_none()).count(),
            y: found.into_iter().map(|y| y.unwrap_or(*last)).collect(),
        })
    }

    /// Returns the distances from the measured values, divided by the largest of these.
    pub fn residuals(&self, sampled: &Sampled) -> Vec<f64> {
        let largest = self.largest();
        let pairs = sampled.y.iter().zip(&self.y);
        pairs
            .map(|(y, measured)| (y - measured) / largest)
            .collect()
    }

    /// Returns the largest measured |y|.
    pub fn largest(&self) -> f64 {
        self.y.iter().fold(0.0, |most: f64, y| most.max(y.abs()))
    }
}

/// Returns y of the first segment of a curve that contains x.
fn at(pair: &PairOfColumns, x: f64) -> Option<f64> {
    if pair.x.first() == Some(&x) {
        return pair.y.first().copied();
    }
    (1..pair.x.len()).find_map(|k| {
        let (a, b) = (pair.x[k - 1], pair.x[k]);
        let share = (x - a) / (b - a);
        let is_within = (0.0..=1.0).contains(&share);
        is_within.then(|| pair.y[k - 1] + share * (pair.y[k] - pair.y[k - 1]))
    })
}

/// Returns the places of the columns in a table.
fn places(table: &CsvData, names: [&str; 2]) -> Result<[usize; 2], String> {
    let place = |name: &str| {
        table
            .columns
            .iter()
            .position(|column| column.is_named(name))
    };
    match names.map(place) {
        [Some(x), Some(y)] => Ok([x, y]),
        _ if table.columns.len() == 2 => Ok([0, 1]),
        found => {
            let missing = names.iter().zip(found).find(|(_, place)| place.is_none());
            let columns: Vec<&str> = table.columns.iter().map(|column| column.name()).collect();
            Err(format!(
                "it has no column {}; its columns are {}. The first line has names with units, such as `CMOD [mm],force [kN]`",
                missing.map_or("", |(name, _)| name),
                columns.join(", ")
            ))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured(text: &str) -> Result<Measured, RunError> {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("curve.csv");
        std::fs::write(&path, text).unwrap();
        Measured::read(&path, ["CMOD", "force"])
    }

    #[test]
    fn columns_are_found_by_name_and_converted() {
        let by_name = measured("time [s],force [kN],CMOD [mm]\n0,1,2\n1,,3\n2,3,4\n").unwrap();
        assert_eq!((by_name.x, by_name.y), (vec![2e-3, 4e-3], vec![1e3, 3e3]));
        assert_eq!(by_name.units, ["m", "N"]);
        let in_order = measured("opening,load\n1,2\n3,4\n").unwrap();
        assert_eq!((in_order.x, in_order.y), (vec![1.0, 3.0], vec![2.0, 4.0]));
        for (text, says) in [
            (
                "a,b,c\n1,2,3\n1,2,3\n",
                "it has no column CMOD; its columns are a, b, c",
            ),
            ("CMOD [furlong],force\n1,2\n3,4\n", "unknown unit [furlong]"),
            ("CMOD,force\n1,2\n", "it has 1 point(s)"),
            ("CMOD,force\n1,0\n2,0\n", "all values of force are zero"),
        ] {
            let error = measured(text).unwrap_err().to_string();
            assert!(error.contains(says), "{error}");
        }
    }

    #[test]
    fn the_curve_of_a_run_is_followed_in_its_order() {
        // The run snaps back: x decreases from 2 to 1.
        let pair = PairOfColumns {
            x: vec![0.0, 2.0, 1.0, 3.0],
            y: vec![0.0, 4.0, 1.0, 0.0],
            units: ["m".into(), "N".into()],
            left_out: None,
        };
        let measured = measured("CMOD [m],force [N]\n0,0\n1.5,2\n2.5,1\n4,0\n").unwrap();
        let sampled = measured.sample(&pair).unwrap();
        assert_eq!(sampled.y, [0.0, 3.0, 0.25, 0.0]);
        assert_eq!(sampled.beyond, 1);
        assert_eq!(measured.residuals(&sampled), [0.0, 0.5, -0.375, 0.0]);
        let other = PairOfColumns {
            units: ["m".into(), "Pa".into()],
            ..pair
        };
        let error = measured.sample(&other).unwrap_err().to_string();
        assert!(error.contains("force is measured in N"), "{error}");
    }
}
