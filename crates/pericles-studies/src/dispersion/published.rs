//! Tables of published numbers, and the words in them.

use pericles_dispersion::tuning::{Combination, Method};
use pericles_run::RunError;

use crate::data::named;

/// The rows of a table of published numbers: cells by column, comments and header left out.
pub(super) fn published(text: &'static str) -> impl Iterator<Item = Vec<&'static str>> {
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines.skip(1).map(|line| line.split(',').collect())
}

/// A number of such a table; none where it is empty.
pub(super) fn number(row: &[&str], column: usize) -> Option<f64> {
    row.get(column)?.parse().ok()
}

/// The numbers of one cell.
pub(super) fn numbers(row: &[&str], column: usize) -> Vec<f64> {
    let cell = row.get(column).copied().unwrap_or_default();
    cell.split(' ').filter_map(|x| x.parse().ok()).collect()
}

/// Half a unit of the last digit given, and a little.
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
    fn misspelt_words_of_the_data_are_refused() {
        assert_eq!(method("galerkin").unwrap(), Method::Galerkin);
        let refused = method("galerkyn").unwrap_err().to_string();
        assert_eq!(refused, "there is no method of tuning \"galerkyn\"");
        assert!(combination("seperated").is_err());
        assert!(combination("").is_err());
    }
}
