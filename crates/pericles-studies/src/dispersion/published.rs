//! Tables of published values, and the words in them.

use pericles_dispersion::tuning::{Combination, Method};
use pericles_run::RunError;

use crate::data::named;

/// Rows of a table of published values: cells by column, without comments and header.
pub(super) fn published(text: &'static str) -> impl Iterator<Item = Vec<&'static str>> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.skip(1).map(|line| line.split(',').collect())
}

/// Number in such a table; `None` if the cell is empty.
pub(super) fn number(row: &[&str], column: usize) -> Option<f64> {
    row.get(column)?.parse().ok()
}

/// Numbers in one cell.
pub(super) fn numbers(row: &[&str], column: usize) -> Vec<f64> {
    let cell = row.get(column).copied().unwrap_or_default();
    cell.split(' ').filter_map(|x| x.parse().ok()).collect()
}

/// Half a unit of the last given digit, plus a margin.
pub(super) fn rounding(row: &[&str], column: usize) -> f64 {
    let cell = row.get(column).copied().unwrap_or_default();
    let places = cell.split_once('.').map_or(0, |(_, digits)| digits.len());
    0.6 * 10f64.powi(-(places as i32))
}

pub(super) fn method(name: &str) -> Result<Method, RunError> {
    let all = Method::ALL.map(|method| (method.name(), method));
    named("method of tuning", name, &all)
}

pub(super) fn combination(name: &str) -> Result<Combination, RunError> {
    let all = Combination::ALL.map(|combination| (combination.name(), combination));
    named("combination of branches", name, &all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn misspelt_words_in_the_data_are_errors() {
        assert_eq!(method("galerkin").unwrap(), Method::Galerkin);
        let refused = method("galerkyn").unwrap_err().to_string();
        assert_eq!(refused, "there is no method of tuning \"galerkyn\"");
        assert!(combination("seperated").is_err());
        assert!(combination("").is_err());
    }
}
