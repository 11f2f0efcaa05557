//! Positions of points: on a lattice or random.

use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::Table;

/// Positions of the points of a body.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Positions {
    /// Lattice nodes.
    #[default]
    Lattice,
    /// Lattice nodes with random displacements.
    Jittered {
        /// Largest displacement along each axis, in spacings: above 0 and below ½.
        jitter: f64,
        /// Random seed.
        seed: u64,
    },
    /// Blue noise (maximal Poisson-disc sampling): random with a minimum distance.
    BlueNoise {
        /// Random seed.
        seed: u64,
    },
}

impl Positions {
    /// Returns whether the positions are random.
    pub fn are_random(&self) -> bool {
        *self != Self::Lattice
    }
}

/// Reads `positions` with `jitter` and `seed`.
pub(super) fn read(table: &Table<'_>) -> Option<Positions> {
    #[derive(Clone, Copy, PartialEq)]
    enum Word {
        Lattice,
        Jittered,
        BlueNoise,
    }
    const WORDS: [(&str, Word); 3] = [
        ("lattice", Word::Lattice),
        ("jittered", Word::Jittered),
        ("blue-noise", Word::BlueNoise),
    ];
    const JITTER: f64 = 0.25;
    let word = table.choice_or_first("positions", "kind of positions", &WORDS);
    if word.is_some_and(|word| word != Word::Jittered) {
        table.forbid("jitter", "it requires positions = \"jittered\"");
    }
    if word == Some(Word::Lattice) {
        table.forbid(
            "seed",
            "it requires positions = \"jittered\" or \"blue-noise\"",
        );
        return Some(Positions::Lattice);
    }
    let seed = || table.or("seed", 1, |item| item.count());
    match word? {
        Word::Lattice => Some(Positions::Lattice),
        Word::BlueNoise => Some(Positions::BlueNoise { seed: seed()? }),
        Word::Jittered => {
            let jitter = table.or("jitter", JITTER, |item| {
                item.within(
                    Quantity::Number,
                    "a number of spacings above 0 and below 0.5",
                    |jitter| jitter > 0.0 && jitter < 0.5,
                )
            });
            let seed = seed();
            Some(Positions::Jittered {
                jitter: jitter?,
                seed: seed?,
            })
        }
    }
}
