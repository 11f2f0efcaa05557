//! One number of a run.

use pericles_io::read_csv;

use crate::error::RunError;
use crate::results::Results;

/// Where the number is.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scalar {
    name: String,
    pick: Pick,
}

/// Which of a column's values.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Pick {
    Last,
    Greatest,
    Least,
}

impl Scalar {
    /// `tip_u_x`, `max:kinetic_energy`, `min:…`, or `audit.elastic_energy` of run.json.
    pub(super) fn named(text: &str) -> Self {
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

    /// The number of a run, and its unit; empty for numbers of run.json.
    ///
    /// # Errors
    /// A run that has no such number, tables that are damaged.
    pub(super) fn of(&self, results: &Results) -> Result<(f64, String), RunError> {
        let mut known = Vec::new();
        for path in results.tables() {
            let table = read_csv(path)?;
            if let Some(number) = table
                .column(&self.name)
                .and_then(|values| self.picked(values))
            {
                let mut columns = table.columns.iter();
                let column = columns.find(|column| column.name() == self.name);
                return Ok((number, column.map_or("", |column| column.unit()).to_owned()));
            }
            known.extend(table.columns.iter().map(|column| column.name().to_owned()));
        }
        let pointer = format!("/{}", self.name.replace('.', "/"));
        let number = results
            .number(&pointer)
            .map(|number| (number, String::new()));
        number.ok_or_else(|| {
            let listing = format!(
                "the tables have {}; run.json has numbers such as audit.elastic_energy",
                known.join(", ")
            );
            RunError::unknown("number", &self.name, &known, &listing)
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
    }
}
