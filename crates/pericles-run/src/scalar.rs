//! Scalars of a run.

use pericles_io::read_csv;

use crate::error::RunError;
use crate::results::Results;

/// Returns a scalar of a run and its unit: the last value of a table column, its maximum or minimum (`max:COLUMN`,
/// `min:COLUMN`), or a number of `run.json` such as `audit.elastic_energy`.
///
/// # Errors
/// The run does not have the scalar, or a table is damaged.
pub fn scalar(results: &Results, name: &str) -> Result<(f64, String), RunError> {
    Scalar::named(name).of(results)
}

/// The source of a scalar.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Scalar {
    name: String,
    pick: Pick,
}

/// The value of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Pick {
    Last,
    Greatest,
    Least,
}

impl Scalar {
    /// Parses `tip_u_x`, `max:kinetic_energy`, `min:…`, or `audit.elastic_energy` of run.json.
    pub(crate) fn named(text: &str) -> Self {
        let (pick, name) = match text.split_once(':') {
            Some(("max", name)) => (Pick::Greatest, name),
            Some(("min", name)) => (Pick::Least, name),
            _ => (Pick::Last, text),
        };
        Self {
            name: name.to_owned(),
            pick,
        }
    }

    /// Returns the name in charts: `kinetic energy`, `largest u x`.
    pub(crate) fn title(&self) -> String {
        let name = self.name.rsplit('.').next().unwrap_or_default();
        let name = name.replace('_', " ");
        match self.pick {
            Pick::Last => name,
            Pick::Greatest => format!("largest {name}"),
            Pick::Least => format!("smallest {name}"),
        }
    }

    /// Returns the scalar of a run and its unit.
    ///
    /// # Errors
    /// The run does not have the scalar, or a table is damaged.
    pub(crate) fn of(&self, results: &Results) -> Result<(f64, String), RunError> {
        let mut known = Vec::new();
        for path in results.tables() {
            let table = read_csv(path)?;
            if let Some(number) = table
                .column(&self.name)
                .and_then(|values| self.picked(values))
            {
                let mut columns = table.columns.iter();
                let column = columns.find(|column| column.is_named(&self.name));
                return Ok((number, column.map_or("", |column| column.unit()).to_owned()));
            }
            known.extend(table.columns.iter().map(|column| column.name().to_owned()));
        }
        let pointer = format!("/{}", self.name.replace('.', "/"));
        let unit = results.unit_of(&self.name);
        let number = results.number(&pointer).map(|number| (number, unit));
        number.ok_or_else(|| {
            let listing = format!(
                "the tables have the columns {}; run.json has numbers such as audit.elastic_energy",
                known.join(", ")
            );
            RunError::unknown("scalar", &self.name, &known, &listing)
        })
    }

    fn picked(&self, values: &[f64]) -> Option<f64> {
        match self.pick {
            Pick::Last => values.last().copied(),
            Pick::Greatest => values.iter().copied().reduce(f64::max),
            Pick::Least => values.iter().copied().reduce(f64::min),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_picked_from_columns() {
        let of = |text: &str| Scalar::named(text).picked(&[2.0, 5.0, 1.0, 3.0]);
        assert_eq!(of("u"), Some(3.0));
        assert_eq!(of("max:u"), Some(5.0));
        assert_eq!(of("min:u"), Some(1.0));
        assert_eq!(Scalar::named("min:u").name, "u");
        assert_eq!(Scalar::named("max:tip_u_x").title(), "largest tip u x");
        assert_eq!(
            Scalar::named("audit.elastic_energy").title(),
            "elastic energy"
        );
    }
}
