//! The table of what works together says what systems and refusals do, and the book shows it.

use super::composition::{ONE_STEP, Operator, PART, TWO_STEPS};
use crate::common::Build;
use crate::parse;
use pericles_run::composition::{Condition, FORMS, Form, SCHEMES, Scheme, tables};

/// The row of the scheme that a text such as `scheme = "rk4", dt = 0.1` names.
fn row(time: &str) -> &'static Scheme {
    let name = time.split('"').nth(1).unwrap();
    let newton = time.contains("newton-krylov");
    let is_it = |scheme: &&Scheme| {
        let solver = name != "newmark" || scheme.words.contains("Newton–Krylov") == newton;
        scheme.names.contains(&name) && solver
    };
    SCHEMES.iter().find(is_it).unwrap()
}

fn form(operator: Operator) -> &'static Form {
    let is_it = |form: &&Form| form.name == operator.word();
    FORMS.iter().find(is_it).unwrap()
}

#[test]
fn forces_offer_what_the_table_says() {
    for operator in Operator::ALL {
        let form = form(operator);
        let assembly = parse(&operator.deck("dt = 0.01")).build().unwrap();
        for scheme in &SCHEMES {
            let mut needs = scheme.requirements.iter();
            let met = needs.all(|one| one.need.is_met_by(&assembly.system));
            let refused = scheme.refusal_of_form(form).is_some();
            assert_ne!(met, refused, "{} with {}", form.words, scheme.words);
        }
    }
}

#[test]
fn decks_are_refused_where_the_table_says() {
    for operator in Operator::ALL {
        for scheme in ONE_STEP.iter().chain(&TWO_STEPS) {
            let deck = parse(&(operator.deck(scheme.time) + PART));
            let refused = row(scheme.time).refusal_of_form(form(operator)).is_some();
            assert_eq!(
                deck.build().is_err(),
                refused,
                "{} with {}",
                operator.word(),
                scheme.time
            );
        }
    }
}

#[test]
fn the_book_shows_the_tables() {
    let folder = env!("CARGO_MANIFEST_DIR");
    let page = std::fs::read_to_string(format!("{folder}/../../book/src/composition.md")).unwrap();
    let begin = "<!-- tables: made by pericles_run::composition::tables -->\n";
    let (_, rest) = page.split_once(begin).unwrap();
    let (shown, _) = rest.split_once("<!-- end of tables -->").unwrap();
    let expected = tables();
    assert!(
        shown == expected,
        "put this between the marks of the page:\n{expected}"
    );
}

#[test]
fn cells_that_are_refused_do_not_become_more() {
    let refused = |scheme: &Scheme| {
        let forms = FORMS
            .iter()
            .filter(|form| scheme.refusal_of_form(form).is_some());
        let conditions = Condition::ALL.into_iter();
        forms.count()
            + conditions
                .filter(|one| scheme.refusal_of_condition(*one).is_some())
                .count()
    };
    let cells: usize = SCHEMES.iter().map(refused).sum();
    // As many as there were when the table was made.
    assert!(cells <= 40, "{cells}");
}
