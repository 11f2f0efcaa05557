//! Decks with names of former releases are read as their present form, with one warning.

mod common;

use common::SURFACE;
use pericles_deck::{Deck, DeckError};

const BAR: &str = "
[body]
shape = 'bar'
length = 1
spacing = 0.01

[material]
density = 1000
youngs_modulus = 1e9
horizon = 0.03

[sets.left]
box = { max = [0.2] }

[time]
end = 1e-4
dt = 1e-6
";

/// A deck, what it has in its former and in its present form, and the names that changed.
type Renaming = (
    &'static str,
    &'static str,
    &'static str,
    &'static [&'static str],
);

const RENAMED: &[Renaming] = &[
    (
        BAR,
        "prescribe=[{ set = 'left', velocity = [1] }]",
        "constraint=[{ set = 'left', velocity = [1] }]",
        &["`prescribe` is now `constraint`"],
    ),
    (
        BAR,
        "material={ model = 'green-strain', treatment = 'taylor-2', density = 1, youngs_modulus = 1, horizon = 0.03 }",
        "material={ model = 'green-strain', approximation = 'taylor-2', density = 1, youngs_modulus = 1, horizon = 0.03 }",
        &["`treatment` is now `approximation`"],
    ),
    (
        BAR,
        "material.influence={ function = 'classes', table = [[[1], 1], [[2], 1], [[3], 1]] }",
        "material.influence={ function = 'lattice-classes', table = [[[1], 1], [[2], 1], [[3], 1]] }",
        &["`classes` is now `lattice-classes`"],
    ),
    (
        BAR,
        "boundary=[{ kind = 'absorbing', side = '-x', exterior_data = 1 }]",
        "boundary=[{ kind = 'absorbing', side = '-x', exterior_extent = 1 }]",
        &["`exterior_data` is now `exterior_extent`"],
    ),
    (
        BAR,
        "time={ end = 1, dt = 1e-6, scheme = 'rk3-mts', ratio = 2, fine = 'left' }",
        "time={ end = 1, dt = 1e-6, scheme = 'multirate-rk3', ratio = 2, fine = 'left' }",
        &["`rk3-mts` is now `multirate-rk3`"],
    ),
    (
        BAR,
        "time={ end = 1, dt = 1e-6, scheme = 'rk4-mts', ratio = 2, adaptive = { every = 2, threshold = 0.8, layers = 1, hold = 3 } }",
        "time={ end = 1, dt = 1e-6, scheme = 'multirate-rk4', ratio = 2, adaptive = { every = 2, threshold = 0.8, layers = 1, keep_checks = 3 } }",
        &[
            "`rk4-mts` is now `multirate-rk4`",
            "`hold` is now `keep_checks`",
        ],
    ),
    (
        BAR,
        "time={ load_steps = 2, scheme = 'relaxation' }",
        "time={ load_steps = 2, scheme = 'adaptive-dynamic-relaxation' }",
        &["`relaxation` is now `adaptive-dynamic-relaxation`"],
    ),
    (
        SURFACE,
        "body={ shape = 'torus', major_radius = 1, minor_radius = 0.3, around = 24, across = 8 }",
        "body={ shape = 'torus', major_radius = 1, minor_radius = 0.3, major_segments = 24, minor_segments = 8 }",
        &[
            "`around` is now `major_segments`",
            "`across` is now `minor_segments`",
        ],
    ),
    (
        SURFACE,
        "material={ model = 'power', density = 1, kappa = 1, alpha = 0.5, p = 2, horizon = 1, self_cell = true }",
        "material={ model = 'power', density = 1, kappa = 1, alpha = 0.5, p = 2, horizon = 1, self_interaction = true }",
        &["`self_cell` is now `self_interaction`"],
    ),
];

fn parse(text: &str, overrides: &[&str]) -> Result<Deck, DeckError> {
    let overrides: Vec<String> = overrides.iter().map(ToString::to_string).collect();
    Deck::parse(text, "deck.toml", &overrides)
}

#[test]
fn former_names_are_read_as_their_present_form() {
    for (deck, former, present, names) in RENAMED {
        let now = parse(deck, &[present]).unwrap_or_else(|error| panic!("{present}: {error:?}"));
        let before = parse(deck, &[former]).unwrap_or_else(|error| panic!("{former}: {error:?}"));
        assert_eq!(before.to_json(), now.to_json(), "{former}");
        assert!(now.warnings().is_empty(), "{present}");
        let warnings = before.warnings();
        assert_eq!(warnings.len(), 1, "{former}");
        for name in *names {
            assert!(
                warnings[0].to_string().contains(name),
                "{}: {name}",
                warnings[0]
            );
        }
    }
}

#[test]
fn the_warning_names_the_line_of_the_first_former_name() {
    let text = format!("{BAR}\n[[prescribe]]\nset = 'left'\nvelocity = [1]\n");
    let deck = parse(&text, &[]);
    let line = text
        .lines()
        .position(|line| line == "[[prescribe]]")
        .unwrap()
        + 1;
    let warning = match deck {
        Ok(deck) => deck.warnings()[0].line(),
        Err(error) => panic!("{error:?}"),
    };
    assert!(warning.contains(&format!("deck.toml:{line}")), "{warning}");
}

#[test]
fn a_key_given_by_both_names_is_refused() {
    let text = format!(
        "{BAR}\n[[prescribe]]\nset = 'left'\nvelocity = [1]\n[[constraint]]\nset = 'left'\nvelocity = [1]\n"
    );
    let error = parse(&text, &[]).unwrap_err();
    let message = format!("{:?}", miette::Report::new(error));
    assert!(message.contains("prescribe"), "{message}");
}
