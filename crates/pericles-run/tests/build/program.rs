//! Sets, initial states and loads that a program adds to a deck.

use pericles::boundary::{Load, TimeFunction};
use pericles_deck::Deck;
use pericles_run::{Assembly, DeckText, Resources, RunError, assemble, discretise};

const BAR: &str = r#"
body = { shape = "bar", length = "1 m", spacing = "1 cm" }
material = { density = 7850, youngs_modulus = "210 GPa", horizon_ratio = 3 }
time = { end = "0.1 ms" }
"#;

fn displacement(assembly: Assembly) -> Vec<f64> {
    let mut simulation = assembly.simulation().unwrap();
    simulation.run_to_end().unwrap();
    simulation.state().u.clone()
}

#[test]
fn conditions_of_a_program_equal_those_of_a_deck() {
    let given = format!(
        "{BAR}
        [[initial]]
        velocity = {{ expression = \"2*x\" }}
        [[load]]
        set = \"pushed\"
        body_force = 1e8
        [sets.pushed]
        layer = {{ side = \"+x\", cells = 4 }}"
    );
    let deck = Deck::parse(&given, "bar.toml", &[]).unwrap();
    let resources = Resources::default();
    let points = discretise(&deck.model, &resources).unwrap();
    let pushed = points.set("pushed").unwrap().clone();
    let expected = displacement(assemble(&deck.model, points, &resources).unwrap());

    let plain = Deck::parse(BAR, "bar.toml", &[]).unwrap();
    let mut points = discretise(&plain.model, &resources).unwrap();
    let velocity = points.cloud.axis(0).iter().map(|x| 2.0 * x).collect();
    points.conditions.velocity = Some(velocity);
    let load = Load::new(pushed, [1e8, 0.0, 0.0], TimeFunction::Constant);
    points.conditions.loads.push(load);
    let found = displacement(assemble(&plain.model, points, &resources).unwrap());
    assert!(expected.iter().any(|u| u.abs() > 1e-6));
    assert_eq!(found, expected);
}

#[test]
fn a_deck_may_name_sets_of_the_program() {
    let text = format!("{BAR}\n[[load]]\nset = \"pushed\"\nbody_force = 1e8");
    let sets = ["pushed".to_owned()];
    let deck = Deck::parse_with_sets(&text, "bar.toml", &[], &sets).unwrap();
    let resources = Resources::default();
    let mut points = discretise(&deck.model, &resources).unwrap();
    // The program has not added the set yet.
    let error = assemble(&deck.model, points.clone(), &resources).err();
    assert!(error.unwrap().to_string().contains("pushed"));
    points.sets.push(("pushed".into(), vec![96, 97, 98, 99]));
    let assembly = assemble(&deck.model, points, &resources).unwrap();
    assert_eq!(assembly.loads[0].points, 4);
}

#[test]
fn wrong_initial_states_are_rejected() {
    let deck = Deck::parse(BAR, "bar.toml", &[]).unwrap();
    let resources = Resources::default();
    let points = discretise(&deck.model, &resources).unwrap();
    for (wrong, says) in [
        (vec![0.0; 99], "99 values, the body needs 100"),
        (vec![f64::NAN; 100], "NaN or infinite"),
    ] {
        let mut points = points.clone();
        points.conditions.displacement = Some(wrong);
        let error = assemble(&deck.model, points, &resources).err().unwrap();
        assert!(error.to_string().contains(says), "{error}");
    }
}

#[test]
fn the_deck_of_an_amended_run_is_not_read_alone() {
    let deck = Deck::parse(BAR, "bar.toml", &[]).unwrap();
    let mut text = DeckText::of(&deck, "bar.toml".into());
    assert!(text.read().is_ok());
    text.amended.push("a load on `pushed`".into());
    let error = text.read().unwrap_err();
    assert!(matches!(error, RunError::Amended { .. }));
    assert!(error.to_string().contains("a load on `pushed`"), "{error}");
}
