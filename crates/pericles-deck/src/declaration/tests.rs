//! One field gives reader, default, range check, record and description of a key.

use pericles::material::StressState;
use pericles_deck_derive::{DeckKeys, DeckTable, DeckWords};

use super::{Check, DeckKeys, DeckTable, Exclusive, Keyed};
use crate::document;
use crate::key_path::KeyPath;
use crate::reader::{Closed, Ledger, Survey};
use crate::source::Sources;
use crate::subject::Subject;

/// Spring.
#[derive(Debug, PartialEq, DeckTable)]
#[deck(default)]
struct Spring {
    /// Stiffness k of the spring.
    ///
    /// In N/m.
    #[deck(quantity = Stiffness, range = POSITIVE, default = 2.0)]
    stiffness: f64,
    /// Ends.
    #[deck(default = End::Free)]
    ends: End,
    #[deck(flatten, default = Force::Linear)]
    force: Force,
    /// Length at rest.
    #[deck(quantity = Length, forbid_if(force == Some(&Force::Linear), "a linear force has no length"))]
    length: Option<f64>,
    /// Number of coils.
    #[deck(range = count_to(9), default = 3, allow_if(is_odd(coils), "an odd number"))]
    coils: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, DeckWords)]
#[deck(what = "end")]
enum End {
    Free,
    FixedInPlane,
}

/// Force law.
#[derive(Debug, PartialEq, DeckKeys)]
#[deck(tag = "law", what = "force law")]
enum Force {
    #[default]
    Linear,
    Power {
        /// Exponent.
        #[deck(range = at_least(1.0))]
        exponent: f64,
    },
}

fn is_odd(coils: Option<&u32>) -> bool {
    coils.is_none_or(|coils| coils % 2 == 1)
}

/// Support of a spring.
#[derive(Debug, PartialEq, DeckKeys)]
#[deck(exclusive)]
enum Support {
    /// Rigid support.
    #[deck(key = "rigid")]
    Rigid,
    /// Length of an elastic support.
    Elastic(#[deck(quantity = Length, range = POSITIVE)] f64),
}

/// End of a spring.
#[derive(Debug, PartialEq, DeckKeys)]
#[deck(exclusive)]
enum Fixture {
    Support(#[deck(flatten)] Support),
    /// Name of a neighbour.
    Neighbour(String),
}

fn read(text: &str) -> (Option<Spring>, Closed) {
    read_as(text)
}

fn read_as<T: DeckTable<()>>(text: &str) -> (Option<T>, Closed) {
    let sources = Sources::new("spring.toml", text);
    let root = document::parse(&sources).unwrap();
    let ledger = Ledger::surveyed(sources, Survey::default());
    let value = ledger
        .root(&root)
        .and_then(|table| T::read_table(table, ()));
    (value, ledger.close())
}

/// Returns the messages about a text, with their advice.
fn problems(text: &str) -> Vec<String> {
    let (_, closed) = read(text);
    let lines = closed.problems.iter().map(|problem| {
        let advice = problem.subject().advice().unwrap_or_default();
        format!("{problem}; {advice}")
    });
    lines.collect()
}

#[test]
fn missing_keys_have_their_defaults_which_are_recorded() {
    let (spring, closed) = read("");
    assert_eq!(spring.unwrap(), Spring::default());
    assert!(closed.problems.is_empty());
    let recorded = r#"{"coils":3,"ends":"free","law":"linear","stiffness":2.0}"#;
    assert_eq!(closed.record.json.to_string(), recorded);
    assert_eq!(
        Spring::keys(),
        ["stiffness", "ends", "law", "exponent", "length", "coils"]
    );
}

#[test]
fn values_have_units_words_and_ranges() {
    let text = "stiffness = \"3 kN/m\"\nends = \"fixed-in-plane\"\nlaw = \"power\"\nexponent = 2\nlength = \"1 mm\"";
    let (spring, _) = read(text);
    let spring = spring.unwrap();
    assert_eq!((spring.stiffness, spring.ends), (3000.0, End::FixedInPlane));
    assert_eq!(spring.force, Force::Power { exponent: 2.0 });
    assert_eq!(spring.length, Some(1e-3));
    for (text, expected) in [
        ("stiffness = -1", "`-1` is out of range"),
        ("stiffness = \"1 m\"", "not a stiffness"),
        ("ends = \"fixed\"", "unknown end `fixed`"),
        ("law = \"power\"", "requires `exponent`"),
        ("exponent = 2", "it requires law = \"power\""),
        ("length = 1", "a linear force has no length"),
        ("coils = 4", "allowed: an odd number"),
        ("coils = 11", "allowed: a whole number from 1 to 9"),
        ("coil = 3", "did you mean `coils`?"),
    ] {
        let problems = problems(text);
        let [problem] = &problems[..] else {
            panic!("{text}: {problems:?}");
        };
        assert!(problem.contains(expected), "{text}: {problem}");
    }
    // The keys that an unknown word selects are not reported.
    assert_eq!(
        problems("law = \"cubic\"\nexponent = 2\nlength = 1").len(),
        1
    );
}

#[test]
fn exclusive_keys_may_be_choices_among_further_ones() {
    assert_eq!(Fixture::choices(), ["rigid", "elastic", "neighbour"]);
    for (text, expected) in [
        ("rigid = true", Fixture::Support(Support::Rigid)),
        (
            "elastic = \"2 mm\"",
            Fixture::Support(Support::Elastic(2e-3)),
        ),
        ("neighbour = \"a\"", Fixture::Neighbour("a".into())),
    ] {
        assert_eq!(read_as::<Fixture>(text).0, Some(expected), "{text}");
    }
    for (text, expected) in [
        ("", "requires one of `rigid`, `elastic` and `neighbour`"),
        ("rigid = false", "`false` is out of range"),
        ("elastic = 0", "`0` is out of range"),
        ("rigid = true\nneighbour = \"a\"", "are given together"),
    ] {
        let (fixture, closed) = read_as::<Fixture>(text);
        let problem = closed.problems[0].to_string();
        assert!(
            fixture.is_none() && problem.contains(expected),
            "{text}: {problem}"
        );
    }
    let mut check = Check::default();
    let wrong = Fixture::Support(Support::Elastic(0.0));
    wrong.check_keys(&KeyPath::from("end"), (), &mut check);
    assert!(check.problems[0].line().starts_with("end.elastic: "));
}

#[test]
fn models_made_by_programs_have_the_same_ranges() {
    let spring = Spring {
        stiffness: f64::NAN,
        force: Force::Power { exponent: 0.5 },
        coils: 4,
        ..Spring::default()
    };
    let mut check = Check::default();
    spring.check_keys(&KeyPath::from("spring"), (), &mut check);
    let lines: Vec<String> = check
        .problems
        .iter()
        .map(|problem| problem.line())
        .collect();
    assert_eq!(lines.len(), 3, "{lines:#?}");
    assert!(lines[0].starts_with("spring.stiffness: ") && lines[0].ends_with("a positive number"));
    assert!(lines[1].starts_with("spring.exponent: ") && lines[1].ends_with("at least 1"));
    assert!(lines[2].starts_with("spring.coils: ") && lines[2].ends_with("an odd number"));
}

#[test]
fn the_first_paragraph_of_the_documentation_describes_a_key() {
    let (_, closed) = read("");
    let found: Vec<(Option<&str>, String)> = closed
        .survey
        .descriptions()
        .map(|(_, key, text)| (key, text))
        .collect();
    assert!(found.contains(&(None, "Spring.".into())), "{found:?}");
    assert!(found.contains(&(Some("stiffness"), "Stiffness k of the spring.".into())));
    assert!(found.contains(&(Some("law"), "Force law.".into())));
}

/// Plate on a spring.
#[derive(Debug, PartialEq, DeckTable)]
#[deck(at_most_one("rate", "period"))]
struct Plate {
    /// Poisson's ratio, which the engine checks.
    #[deck(quantity = Number, accept = of_bonds)]
    ratio: f64,
    /// Whether a spring supports the plate.
    #[deck(default = true)]
    supported: bool,
    #[deck(
        flatten,
        default = Force::Linear,
        forbid_if(supported == Some(&false), "a plate without support has no spring")
    )]
    force: Force,
    /// Rate of the load.
    #[deck(quantity = Rate)]
    rate: Option<f64>,
    /// Period of the load.
    #[deck(quantity = Time)]
    period: Option<f64>,
}

fn of_bonds<S>(ratio: &f64, _: S) -> pericles::Result<()> {
    StressState::PlaneStrain.check_poisson_ratio(*ratio)
}

#[test]
fn the_engine_checks_values_and_all_keys_of_a_flattened_field_may_be_forbidden() {
    for (text, expected) in [
        ("ratio = 0.3", "one elastic constant"),
        (
            "ratio = 0.25\nsupported = false\nlaw = \"linear\"",
            "`law` is not allowed",
        ),
        (
            "ratio = 0.25\nsupported = false\nexponent = 2",
            "`exponent` is not allowed",
        ),
        (
            "ratio = 0.25\nrate = 1\nperiod = 1",
            "`rate` and `period` are given together",
        ),
    ] {
        let (_, closed) = read_as::<Plate>(text);
        let [problem] = &closed.problems[..] else {
            panic!("{text}: {} problems", closed.problems.len());
        };
        assert!(problem.to_string().contains(expected), "{text}: {problem}");
    }
    let (plate, _) = read_as::<Plate>("ratio = 0.25\nlaw = \"power\"\nexponent = 2\nrate = 1");
    let plate = plate.unwrap();
    assert_eq!(plate.force, Force::Power { exponent: 2.0 });
    let mut check = Check::default();
    let wrong = Plate {
        ratio: 0.3,
        ..plate
    };
    wrong.check_keys(&KeyPath::from("plate"), (), &mut check);
    assert_eq!(check.problems.len(), 1);
    assert!(check.problems[0].line().starts_with("plate.ratio: "));
}

/// Support.
#[derive(Debug, PartialEq, DeckKeys)]
#[deck(tag = "law", what = "support")]
enum Supported {
    Linear(#[deck(flatten)] Force),
    Power(#[deck(flatten)] Force),
    Free {
        /// Distance of the stop.
        #[deck(quantity = Length, otherwise = "a spring has no stop")]
        stop: f64,
    },
}

#[test]
fn a_variant_may_be_an_enum_with_the_same_tag() {
    let (read, _) = read_as::<Supported>("law = \"power\"\nexponent = 2");
    let power = Force::Power { exponent: 2.0 };
    assert_eq!(read, Some(Supported::Power(power)));
    for (text, expected) in [
        (
            "law = \"free\"\nstop = 1\nexponent = 2",
            "it requires law = \"power\"",
        ),
        ("law = \"linear\"\nstop = 1", "a spring has no stop"),
        (
            "law = \"linear\"\nexponent = 2",
            "it requires law = \"power\"",
        ),
    ] {
        let (_, closed) = read_as::<Supported>(text);
        let [problem] = &closed.problems[..] else {
            panic!("{text}: {} problems", closed.problems.len());
        };
        let line = problem.line();
        assert!(line.ends_with(expected), "{text}: {line}");
    }
}
