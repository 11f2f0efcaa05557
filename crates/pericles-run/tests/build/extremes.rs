//! Extreme numbers for every key: each deck runs or is rejected; none panics or takes long.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use pericles::Control;
use serde_json::Value as Json;

use super::common::Build;
use pericles_deck::{Deck, Scheme, specimens};
use pericles_run::Resources;

/// Numbers at which conversions, sums and products overflow, or positions coincide after rounding.
const EXTREMES: [&str; 6] = [
    "0",
    "1e-300",
    "1e-14",
    "4294967296",
    "-9223372036854775808",
    "1e300",
];

/// Small decks of all kinds of bodies, schemes and boundaries.
const SMALL: [&str; 11] = [
    include_str!("../../../../fuzz/seeds/model/discrete-gradient.toml"),
    include_str!("../../../../fuzz/seeds/model/dormand-prince.toml"),
    include_str!("../../../../fuzz/seeds/model/ends-direct.toml"),
    include_str!("../../../../fuzz/seeds/model/ends-exponentials.toml"),
    include_str!("../../../../fuzz/seeds/model/grid-rk3-mts.toml"),
    include_str!("../../../../fuzz/seeds/model/list-anderson.toml"),
    include_str!("../../../../fuzz/seeds/model/list-respa.toml"),
    include_str!("../../../../fuzz/seeds/model/list-verlet.toml"),
    include_str!("../../../../fuzz/seeds/model/midpoint.toml"),
    include_str!("../../../../fuzz/seeds/model/surface-rk4.toml"),
    include_str!("../../../../fuzz/seeds/model/trigonometric.toml"),
];

/// Memory limit, bytes.
const MEMORY: u64 = 1 << 22;
/// Wall-clock time limit per deck, on a shared machine.
const LONGEST: Duration = Duration::from_secs(5);

/// Returns the keys of a record whose values are numbers or lists of numbers.
fn numeric_keys(record: &Json, key: &str, found: &mut Vec<(String, usize)>) {
    let below = |name: &str| match key {
        "" => name.to_owned(),
        key => format!("{key}.{name}"),
    };
    match record {
        Json::Number(_) => found.push((key.to_owned(), 0)),
        Json::Array(items) if !items.is_empty() && items.iter().all(Json::is_number) => {
            found.push((key.to_owned(), items.len()));
        }
        Json::Array(items) => {
            for (k, item) in items.iter().enumerate() {
                numeric_keys(item, &below(&k.to_string()), found);
            }
        }
        Json::Object(members) => {
            for (name, member) in members {
                numeric_keys(member, &below(name), found);
            }
        }
        _ => {}
    }
}

/// Returns the value of an override: the extreme number, or a list with it as the last entry.
fn value(extreme: &str, length: usize) -> String {
    match length {
        0 => extreme.into(),
        length => format!("[{}{extreme}]", "0.5, ".repeat(length - 1)),
    }
}

/// A deck with an extreme number.
struct Case {
    text: &'static str,
    changes: Vec<String>,
}

impl Case {
    fn all() -> Vec<Self> {
        let small = SMALL.iter().map(|&text| (text, Vec::new()));
        // Often enough to cover several kinds of bodies.
        const MOST: u32 = 3;
        let mut uses: BTreeMap<String, u32> = BTreeMap::new();
        let mut cases = Vec::new();
        for (text, changes) in small.chain(specimens()) {
            let deck = Deck::parse(text, "extreme.toml", &changes).unwrap();
            let mut keys = Vec::new();
            numeric_keys(deck.to_json(), "", &mut keys);
            for (key, length) in keys {
                // Exact geodesics on a tube with such thin cells take minutes.
                if key == "body.minor_radius" {
                    continue;
                }
                let uses = uses.entry(key.clone()).or_default();
                *uses += 1;
                if *uses > MOST {
                    continue;
                }
                cases.extend(EXTREMES.iter().map(|extreme| {
                    let mut changes = changes.clone();
                    changes.push(format!("{key}={}", value(extreme, length)));
                    Self { text, changes }
                }));
            }
        }
        cases
    }

    /// Reads, assembles and starts the deck; errors are valid outcomes.
    fn attempt(&self) {
        let Ok(deck) = Deck::parse(self.text, "extreme.toml", &self.changes) else {
            return;
        };
        let resources = Resources {
            memory: MEMORY,
            ..Resources::default()
        };
        let Ok(model) = deck.build_with(resources) else {
            return;
        };
        let _ = deck.check_waves(&model);
        // A billion iterations or substeps take long, as requested by such a deck.
        let adaptive = matches!(deck.model.time.scheme, Scheme::DormandPrince { .. });
        if adaptive || model.integrator.inner_iterations().is_some() {
            return;
        }
        let mut left = 2;
        let _ = model.simulation().run(|_| {
            left -= 1;
            if left == 0 {
                Control::Stop
            } else {
                Control::Continue
            }
        });
    }
}

impl std::fmt::Display for Case {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let begin: Vec<&str> = self.text.lines().take(3).collect();
        write!(f, "{:?} in {}", self.changes, begin.join(" "))
    }
}

/// Attempts the cases from a given one; reports whether each had an outcome.
fn attempt_from(cases: &Arc<Vec<Case>>, first: usize) -> Receiver<bool> {
    let (sender, receiver) = channel();
    let cases = Arc::clone(cases);
    std::thread::spawn(move || {
        for case in &cases[first..] {
            let answered = catch_unwind(AssertUnwindSafe(|| case.attempt())).is_ok();
            if sender.send(answered).is_err() {
                break;
            }
        }
    });
    receiver
}

#[test]
fn extreme_numbers_run_or_are_rejected() {
    let cases = Arc::new(Case::all());

    assert!(cases.len() > 2000, "{}", cases.len());
    let mut trouble = Vec::new();
    let mut answers = attempt_from(&cases, 0);
    for (k, case) in cases.iter().enumerate() {
        match answers.recv_timeout(LONGEST) {
            Ok(true) => {}
            Ok(false) => trouble.push(format!("a panic: {case}")),
            Err(_) => {
                trouble.push(format!("no answer within {LONGEST:?}: {case}"));
                answers = attempt_from(&cases, k + 1);
            }
        }
    }
    assert!(trouble.is_empty(), "{trouble:#?}");
}
