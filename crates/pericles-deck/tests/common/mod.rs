//! Decks shared by several tests.
#![allow(dead_code)] // each test uses its part

use pericles::space::Grid;
use pericles_deck::{Deck, DeckError, Lattice, Solid};

/// Returns the solid body of a deck.
pub fn solid(deck: &Deck) -> &Solid {
    deck.model.body.solid().unwrap()
}

/// Returns the lattice of its body.
pub fn lattice(deck: &Deck) -> &Lattice {
    solid(deck).shape.lattice().unwrap()
}

/// Returns the grid of its body.
pub fn grid(deck: &Deck) -> &Grid {
    &lattice(deck).grid
}

/// A valid deck of a wave in a periodic bar.
pub const WAVE: &str = r#"[body]
shape = "bar"
length = 20
origin = -10
spacing = 0.1
periodic = true

[material]
model = "linear"
density = 1
youngs_modulus = 1
horizon = "infinite"
influence = { function = "gaussian", length = 1, acts_on = "displacement" }
bonds = "spectral"

[exact]
solution = "nonlocal-pulse"
width = 1
amplitude = 1
window = 3

[time]
end = 3
dt = 0.5
scheme = "trigonometric"
"#;

/// A valid deck of a 2-manifold.
pub const SURFACE: &str = r#"[body]
shape = "icosphere"
level = 2
radius = 1

[geodesics]
method = "edge"

[material]
model = "power"
density = "1 kg/m2"
alpha = 0.5
p = 3
horizon = 0.8

[[initial]]
random_velocity = { radius = 0.1, seed = 3 }

[[load]]
set = "all"
traction = [0, 0, 1]

[time]
end = 1
dt = 0.1
scheme = "newmark"
"#;

pub struct Wrong {
    pub replace: &'static str,
    pub by: &'static str,
    /// Line and column of the problem.
    pub at: (usize, usize),
    /// Beginning of the marked text.
    pub marked: &'static str,
    /// Fragments of the message.
    pub says: &'static [&'static str],
}

pub const fn wrong(
    replace: &'static str,
    by: &'static str,
    at: (usize, usize),
    marked: &'static str,
    says: &'static [&'static str],
) -> Wrong {
    Wrong {
        replace,
        by,
        at,
        marked,
        says,
    }
}

/// Requires every wrong deck to be rejected at the location and with the fragments of its case.
pub fn explained(right: &str, wrong: &[Wrong], read: &dyn Fn(&str) -> Result<(), DeckError>) {
    for case in wrong {
        assert_eq!(
            right.matches(case.replace).count(),
            1,
            "`{}` must be unique",
            case.replace
        );
        let Err(error) = read(&right.replace(case.replace, case.by)) else {
            panic!("`{}` is accepted", case.by)
        };
        let message = error.to_string();
        let found = error.problems().iter().any(|problem| {
            let at = problem.location();
            (at.line(), at.column()) == case.at && at.excerpt().starts_with(case.marked)
        });
        assert!(found, "`{}`: {message}", case.by);
        let place = format!("plate.toml:{}:{}:", case.at.0, case.at.1);
        assert!(message.contains(&place), "{place} {message}");
        for words in case.says {
            assert!(
                message.contains(words),
                "`{}`: `{words}` is not in: {message}",
                case.by
            );
        }
    }
}
