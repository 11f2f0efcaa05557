//! How points are arranged in a body: on its lattice, or at random.

use serde::{Deserialize, Serialize};

use crate::quantity::Quantity;
use crate::reader::Table;

/// How points are arranged in a body.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum Positions {
    /// On a lattice.
    #[default]
    Lattice,
    /// On a lattice whose nodes are displaced at random.
    Jittered {
        /// The largest displacement along each axis, in spacings: above 0 and below ½.
        jitter: f64,
        /// Random seed.
        seed: u64,
    },
    /// Blue noise (maximal Poisson disc): at random, but nowhere nearer to each other than a radius.
    BlueNoise {
        /// Random seed.
        seed: u64,
    },
}

impl Positions {
    /// Whether they are random.
    pub fn are_random(&self) -> bool {
        *self != Self::Lattice
    }
}

/// `positions`, with `jitter` and `seed`.
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
    let word = table.choice_or_first("positions", "arrangement of points", &WORDS);
    if word.is_some_and(|word| word != Word::Jittered) {
        table.forbid("jitter", "only positions = \"jittered\" have an amplitude");
    }
    if word == Some(Word::Lattice) {
        table.forbid(
            "seed",
            "only positions = \"jittered\" and \"blue-noise\" are random",
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
