//! Influence functions given by a value per class of lattice bonds.

use crate::error::{PericlesError, Result, positive};

/// A class of bonds: lattice offsets that the symmetries of the lattice map to each other, named by their absolute
/// values in descending order, such as (2, 1, 0).
pub type ClassOffset = [i32; 3];

/// A value for every class of bonds of a square or cubic lattice.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassTable {
    dimension: usize,
    spacing: f64,
    entries: Vec<(ClassOffset, f64)>,
    chord: Vec<(f64, f64)>,
}

impl ClassTable {
    /// Makes a table for a lattice of given dimension and spacing (m). Offsets may be given in any order and with
    /// any sign.
    ///
    /// # Errors
    /// An empty table; a class given twice; an offset along an axis beyond the dimension; values that are not
    /// finite.
    pub fn new(dimension: usize, spacing: f64, entries: &[(ClassOffset, f64)]) -> Result<Self> {
        let reject = |reason: String| Err(PericlesError::BadInfluence { reason });
        positive("the spacing of a table per class", spacing)?;
        let mut entries: Vec<_> = entries.iter().map(|(o, a)| (class_of(*o), *a)).collect();
        entries.sort_by_key(|(offset, _)| class_order(*offset));
        if entries.is_empty() {
            return reject("a table per class needs at least one class".into());
        }
        for (offset, value) in &entries {
            if *offset == [0; 3] || offset[dimension.min(3)..].iter().any(|c| *c != 0) {
                return reject(format!(
                    "({}, {}, {}) is not a bond of a lattice of dimension {dimension}; allowed: offsets with 1 to {dimension} nonzero components",
                    offset[0], offset[1], offset[2]
                ));
            }
            if !value.is_finite() {
                return reject(format!(
                    "the value {value} of a class is not finite; allowed: finite numbers"
                ));
            }
        }
        if let Some(twice) = entries.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            return reject(format!(
                "the class ({}, {}, {}) is given twice; leave out one of the values",
                twice[0].0[0], twice[0].0[1], twice[0].0[2]
            ));
        }
        // Classes of equal length are averaged, weighted by their numbers of bonds.
        let mut chord: Vec<(f64, f64)> = Vec::new();
        for same in entries.chunk_by(|a, b| square(a.0) == square(b.0)) {
            let weight = |offset| multiplicity(offset, dimension) as f64;
            let bonds: f64 = same.iter().map(|(offset, _)| weight(*offset)).sum();
            let total: f64 = same.iter().map(|(offset, a)| a * weight(*offset)).sum();
            chord.push((f64::from(square(same[0].0)).sqrt() * spacing, total / bonds));
        }
        Ok(Self {
            dimension,
            spacing,
            entries,
            chord,
        })
    }

    /// Dimension of the lattice.
    pub fn dimension(&self) -> usize {
        self.dimension
    }

    /// Spacing of the lattice, m.
    pub fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Classes with their values, ordered by length.
    pub fn entries(&self) -> &[(ClassOffset, f64)] {
        &self.entries
    }

    /// Points (r, mean value) of the piecewise linear function that replaces the table where a function of r is
    /// needed.
    pub fn chord(&self) -> &[(f64, f64)] {
        &self.chord
    }

    /// Returns the value of a bond with vector ξ, m; zero for classes not in the table.
    pub fn value(&self, xi: [f64; 3]) -> f64 {
        self.lookup(xi.map(|x| (x / self.spacing).round() as i32))
            .unwrap_or(0.0)
    }

    /// Returns the value of the class of an offset, if the table contains it.
    pub fn lookup(&self, offset: [i32; 3]) -> Option<f64> {
        let class = class_of(offset);
        let found = self
            .entries
            .binary_search_by_key(&class_order(class), |(offset, _)| class_order(*offset));
        found.ok().map(|entry| self.entries[entry].1)
    }

    /// Returns whether any value is negative.
    pub fn is_signed(&self) -> bool {
        self.entries.iter().any(|(_, value)| *value < 0.0)
    }

    pub(crate) fn check_dimension(&self, dimension: usize) -> Result<()> {
        if self.dimension == dimension {
            return Ok(());
        }
        Err(PericlesError::WrongDimension {
            what: "this table per class",
            needed: ["1", "2", "3"][self.dimension - 1],
            dimension,
        })
    }
}

/// Returns the class of an offset.
pub fn class_of(offset: [i32; 3]) -> ClassOffset {
    let mut class = offset.map(i32::abs);
    class.sort_unstable_by(|a, b| b.cmp(a));
    class
}

/// Number of offsets in a class: all signs and permutations within the dimension.
pub fn multiplicity(class: ClassOffset, dimension: usize) -> usize {
    let axes = &class[..dimension];
    let factorial = |n: usize| (1..=n).product::<usize>();
    let repeats: usize = axes
        .chunk_by(|a, b| a == b)
        .map(|same| factorial(same.len()))
        .product();
    let signs = axes.iter().filter(|c| **c != 0).count();
    (factorial(dimension) / repeats) << signs
}

fn square(class: ClassOffset) -> i32 {
    class.iter().map(|c| c * c).sum()
}

/// Sort key: by length, then by the longest component first, as in (3, 0, 0), (2, 2, 1).
fn class_order(class: ClassOffset) -> (i32, [std::cmp::Reverse<i32>; 3]) {
    (square(class), class.map(std::cmp::Reverse))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiplicities_equal_the_numbers_of_offsets() {
        for dimension in 1..=3 {
            let axis = |c: usize| if c < dimension { -3..=3 } else { 0..=0 };
            let mut counts = std::collections::BTreeMap::new();
            for x in axis(0) {
                for y in axis(1) {
                    for z in axis(2) {
                        *counts.entry(class_of([x, y, z])).or_insert(0) += 1;
                    }
                }
            }
            for (class, count) in counts {
                assert_eq!(multiplicity(class, dimension), count, "{class:?}");
            }
        }
    }

    #[test]
    fn classes_of_equal_length_keep_their_own_values() {
        let table = ClassTable::new(
            3,
            0.5,
            &[([2, 2, 1], 7.0), ([1, 0, 0], 2.0), ([0, -3, 0], 1.0)],
        )
        .unwrap();
        assert_eq!(table.value([0.5, -1.0, 1.0]), 7.0);
        assert_eq!(table.value([0.0, 0.0, 1.5]), 1.0);
        assert_eq!(table.value([0.5, 0.5, 0.0]), 0.0);
        // 24 bonds (2,2,1) and 6 bonds (3,0,0)
        assert_eq!(
            table.chord(),
            [(0.5, 2.0), (1.5, (7.0 * 24.0 + 6.0) / 30.0)]
        );
    }

    #[test]
    fn invalid_tables_are_rejected() {
        for entries in [
            &[][..],
            &[([0, 0, 0], 1.0)],
            &[([1, 1, 0], 1.0)],
            &[([1, 0, 0], f64::NAN)],
            &[([1, 0, 0], 1.0), ([-1, 0, 0], 2.0)],
        ] {
            assert!(ClassTable::new(1, 1.0, entries).is_err(), "{entries:?}");
        }
    }
}
