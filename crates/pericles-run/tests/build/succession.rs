//! A run that starts from the state of another one continues it.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use pericles::Values;
use pericles::domain::{Alone, Comm, Threads};
use pericles_deck::Deck;
use pericles_io::{CheckpointFolder, CsvData, OutputFolder, read_csv};
use pericles_run::sequence::{Plan, Sequence, is_sequence};
use pericles_run::{
    Assembled, DeckText, Ending, InitialState, Origin, Results, Run, RunError, Source,
    shared_folder,
};

use super::common::processes::{assert_same, drive, means};

/// A notched plate that is torn and sheared at constant velocity; MATERIAL and REST are placeholders.
const PLATE: &str = r#"
body = { shape = "plate", size = [24, 12], spacing = 1, plane = "strain" }
material = { density = 1, youngs_modulus = 10, horizon_ratio = 3, MATERIAL }
sets = { bottom = { layer = { side = "-y", cells = 2 } }, top = { layer = { side = "+y", cells = 2 } } }
crack = [{ segment = [[-1, 6], [8, 6]] }, { segment = [[20, 4], [25, 4]] }]
constraint = [{ set = "bottom", displacement = [0, 0] }, { set = "top", velocity = [0.02, 0.05] }]
REST
"#;

fn deck(material: &str, rest: &str, time: &str) -> String {
    let deck = PLATE.replace("MATERIAL", material).replace("REST", rest);
    format!("{deck}{time}")
}

fn run(
    deck: &str,
    folder: &Path,
    from: Option<&Path>,
    comm: Arc<dyn Comm>,
) -> Result<Ending, RunError> {
    let source = Source::of_deck(Deck::parse(deck, "deck.toml", &[])?, "deck.toml".into());
    let means = means(comm);
    let open = |from: &Path| Origin::open(from, means.memory, &*means.comm);
    let origin = from.map(open).transpose()?;
    let assembled = Assembled::starting(&source, origin.as_ref().into(), &means, &mut |_| {})?;
    let create = || Ok::<_, RunError>(OutputFolder::create(folder, false)?);
    let folder = shared_folder(&*means.comm, create)?;
    drive(Run::begin(&source, assembled, folder)?, None)
}

fn alone(deck: &str, folder: &Path, from: Option<&Path>) {
    let ending = run(deck, folder, from, Arc::new(Alone));
    assert_eq!(
        ending.unwrap_or_else(|error| panic!("{error}\n{deck}")),
        Ending::Finished
    );
}

/// Returns the arrays of the last state.
fn last(folder: &Path) -> BTreeMap<String, Values> {
    let checkpoints = CheckpointFolder::new(folder.join("checkpoints"));
    let container = checkpoints.latest_valid(u64::MAX).unwrap().container;
    container.into_archive().unwrap().1.into_arrays()
}

/// Returns the largest difference of two arrays relative to their largest number.
fn difference(a: &Values, b: &Values) -> f64 {
    match (a, b) {
        (Values::F64(a), Values::F64(b)) => {
            assert_eq!(a.len(), b.len());
            let scale = a.iter().chain(b).fold(0.0_f64, |most, x| most.max(x.abs()));
            let pairs = a.iter().zip(b).filter(|(a, b)| a != b);
            pairs.fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs() / scale))
        }
        _ => f64::from(u8::from(a != b)),
    }
}

/// Compares a run of 4 with two runs of 2, the second from the state of the first.
fn check(material: &str, rest: &str, compared: &[&str]) {
    let place = tempfile::tempdir().unwrap();
    let [whole, first, second] = ["whole", "first", "second"].map(|name| place.path().join(name));
    let time = |end: u32| {
        deck(
            material,
            rest,
            &format!("time = {{ end = {end}, dt = 0.05 }}"),
        )
    };
    alone(&time(4), &whole, None);
    alone(&time(2), &first, None);
    alone(&time(2), &second, Some(&first));
    let (whole, first, second) = (last(&whole), last(&first), last(&second));
    for name in ["state/u", "state/v"].iter().chain(compared) {
        let name = *name;
        assert!(whole.contains_key(name), "{name}: {:?}", whole.keys());
        let error = difference(&whole[name], &second[name]);
        // Accelerations at the start are added up in another order than those at the end of a step.
        assert!(error < 1e-12, "{name}: {error:e}\n{material}");
        assert!(
            difference(&first[name], &second[name]) > 0.0,
            "{name} stays\n{material}"
        );
    }
}

#[test]
fn two_runs_equal_one_for_every_state_of_a_body() {
    let plastic = "poisson_ratio = 0.3, yield_stress = 0.05, hardening = 1";
    for (material, compared) in [
        ("model = \"linear\", bonds = \"grid\"".into(), &[][..]),
        ("critical_stretch = 0.02, bonds = \"grid\"".into(), &["operator/grid/bonds"]),
        ("critical_stretch = 0.02, bonds = \"list\"".into(), &["operator/intact"]),
        (
            "critical_stretch = 0.08, softening = { law = \"linear\", onset_stretch = 0.005 }".into(),
            &["softening/largest"],
        ),
        (
            "model = \"state-based\", poisson_ratio = 0.3, viscosity = [{ share = 0.7, time = 0.2 }]".into(),
            &["solid/bonds"],
        ),
        (format!("model = \"state-based\", critical_stretch = 0.03, {plastic}"), &["solid/bonds"]),
        (format!("model = \"correspondence\", {plastic}"), &["solid/points"]),
    ] {
        check(&material, "", compared);
    }
}

#[test]
fn the_temperature_is_handed_over() {
    let heat = "thermal = { conductivity = 2, specific_heat = 1, expansion = 1e-4, temperature = 300, reference = 280, condition = [{ set = \"bottom\", temperature = 400 }] }";
    for material in [
        "model = \"linear\"",
        "critical_stretch = 0.02",
        "model = \"state-based\", poisson_ratio = 0.3",
    ] {
        check(material, heat, &["temperature/to"]);
    }
    // The first run ends within a thermal step, where the temperature is interpolated.
    let place = tempfile::tempdir().unwrap();
    let [first, second] = ["first", "second"].map(|name| place.path().join(name));
    let heat = heat.replace(
        "conductivity",
        "step = 0.4, scheme = \"backward-euler\", conductivity",
    );
    let end = |end: f64| {
        deck(
            "model = \"linear\"",
            &heat,
            &format!("time = {{ end = {end}, dt = 0.05 }}"),
        )
    };
    alone(&end(1.0), &first, None);
    alone(&end(0.05), &second, Some(&first));
    let ends = last(&first);
    let [Values::F64(from), Values::F64(to)] =
        ["from", "to"].map(|one| ends[&format!("temperature/{one}")].clone())
    else {
        panic!("{:?}", ends.keys())
    };
    let middle: Vec<f64> = from.iter().zip(&to).map(|(a, b)| 0.5 * (a + b)).collect();
    assert!(difference(&Values::F64(middle), &last(&second)["temperature/from"]) < 1e-14);
}

/// The state of a run on some processes is handed over to others.
#[test]
fn the_number_of_processes_does_not_matter() {
    let place = tempfile::tempdir().unwrap();
    let rest = "output = { history = { every = 1 } }";
    let deck = deck(
        "model = \"state-based\", poisson_ratio = 0.3, viscosity = [{ share = 0.7, time = 0.2 }], critical_stretch = 0.03",
        rest,
        "time = { end = 2, dt = 0.05 }",
    );
    let [first, second] = [1, 2].map(|k| place.path().join(format!("alone-{k}")));
    alone(&deck, &first, None);
    alone(&deck, &second, Some(&first));
    for size in [2, 3] {
        let [a, b] = [1, 2].map(|k| place.path().join(format!("{size}-{k}")));
        for (folder, from) in [(&a, None), (&b, Some(&first))] {
            for ending in Threads::run(size, |comm| {
                run(&deck, folder, from.map(|p| p.as_path()), comm)
            }) {
                assert_eq!(ending.unwrap(), Ending::Finished);
            }
        }
        assert_same(&a, &first, "the first run");
        assert_same(&b, &second, "the second run");
    }
}

/// Returns the message with which a deck rejects the state of a run of another one.
fn message(first: &str, second: &str) -> String {
    let place = tempfile::tempdir().unwrap();
    let [a, b] = [1, 2].map(|k| place.path().join(k.to_string()));
    alone(first, &a, None);
    let error = run(second, &b, Some(&a), Arc::new(Alone)).unwrap_err();
    assert!(!b.exists());
    error.to_string()
}

#[test]
fn states_of_other_bodies_are_rejected() {
    let time = "time = { end = 0.1, dt = 0.05 }";
    let brittle = deck("critical_stretch = 0.02", "", time);
    let softening =
        "critical_stretch = 0.08, softening = { law = \"linear\", onset_stretch = 0.005 }";
    let softening = deck(softening, "", time);
    let elastic = deck("model = \"bond-stretch\"", "", time);
    for (first, second, expected) in [
        (
            &brittle,
            brittle.replace("[24, 12]", "[24, 13]"),
            "its points are others",
        ),
        (
            &brittle,
            brittle.replace("[8, 6]", "[9, 6]"),
            "both decks must have the same [[crack]]s",
        ),
        (&softening, brittle.clone(), "does not have its state"),
    ] {
        let message = message(first, &second);
        assert!(message.contains(expected), "{message}");
    }
    // Bonds that could not break are intact.
    let place = tempfile::tempdir().unwrap();
    let [a, b] = [1, 2].map(|k| place.path().join(k.to_string()));
    alone(&elastic, &a, None);
    alone(&brittle, &b, Some(&a));
}

/// Runs the steps of a deck, at most to the given step number of the last one.
fn run_steps(deck: &str, folder: &Path, comm: Arc<dyn Comm>, stop: Option<u64>) {
    let means = means(comm);
    let deck = Deck::parse(deck, "deck.toml", &[]).unwrap_or_else(|error| panic!("{error}"));
    let text = DeckText::of(&deck, "deck.toml".into());
    let sequence = match is_sequence(folder) {
        true => Sequence::open(folder, &means).unwrap(),
        false => {
            let plan = Plan::new(text, None).unwrap().expect("the deck has steps");
            plan.check(InitialState::Model, &means, &mut |_| {})
                .unwrap();
            let create = || Ok::<_, RunError>(OutputFolder::create(folder, false)?);
            plan.begin(shared_folder(&*means.comm, create).unwrap(), &means)
                .unwrap()
        }
    };
    let last = sequence.names().len() - 1;
    let ending = sequence.drive(&means, &mut |_| {}, |number, run| {
        drive(run, stop.filter(|_| number == last))
    });
    ending.unwrap_or_else(|error| panic!("{error}"));
}

const BRITTLE: &str = "critical_stretch = 0.02";
const STEPS: &str = r#"
[time]
dt = 0.05
end = 2
[output]
history = { every = 2 }
fields = { count = 2 }
[[step]]
name = "tear"
[[step]]
[[step.constraint]]
set = "bottom"
displacement = [0, 0]
"#;

#[test]
fn steps_equal_runs_that_start_from_each_other() {
    let place = tempfile::tempdir().unwrap();
    let [steps, first, second] = ["steps", "first", "second"].map(|name| place.path().join(name));
    let both = deck(BRITTLE, "", STEPS);
    run_steps(&both, &steps, Arc::new(Alone), None);
    let (tables, _) = both.split_once("[[step]]").unwrap();
    let held = "{ set = \"top\", velocity = [0.02, 0.05] }";
    alone(tables, &first, None);
    alone(&tables.replace(held, ""), &second, Some(&first));
    for (step, run) in [("1-tear", &first), ("2", &second)] {
        assert_eq!(last(&steps.join(step)), last(run), "{step}");
    }

    let table = |folder: &Path| read_csv(folder.join("history.csv")).unwrap();
    let (all, parts) = (table(&steps), [&first, &second].map(|folder| table(folder)));
    let column = |table: &CsvData, name: &str| table.column(name).unwrap().to_vec();
    let times = column(&all, "time");
    assert!(times.is_sorted_by(|a, b| a < b) && times.last() == Some(&4.0));
    let broken = [&parts[0], &parts[1]].map(|part| column(part, "broken_bonds"));
    assert_eq!(
        column(&all, "broken_bonds"),
        [&broken[0][..], &broken[1][1..]].concat()
    );
    // A table with a row for each crack and time.
    let rows = |folder: &Path| read_csv(folder.join("cracks.csv")).unwrap().rows();
    assert_eq!(rows(&steps), rows(&first) + rows(&second) - 2);
    // The work of the first step stays in the balance.
    let work = column(&all, "external_work");
    let initial = column(&parts[1], "elastic_energy")[0] + column(&parts[1], "kinetic_energy")[0];
    assert!(work.last() > Some(&(0.9 * initial)), "{work:?} {initial}");
    let balance = column(&all, "balance");
    assert!(
        balance
            .iter()
            .all(|error| error.abs() < 2e-3 * work[work.len() - 1]),
        "{balance:?}"
    );
    let results = Results::open(&steps).unwrap();
    let times: Vec<f64> = results
        .fields()
        .unwrap()
        .iter()
        .map(|one| one.time)
        .collect();
    assert_eq!(times, [0.0, 1.0, 2.0, 3.0, 4.0]);
    assert!(
        results
            .fields()
            .unwrap()
            .iter()
            .all(|one| one.path.is_file())
    );
}

#[test]
fn interrupted_and_divided_steps_have_the_files_of_one_process() {
    let place = tempfile::tempdir().unwrap();
    let both = deck(BRITTLE, "", STEPS);
    let whole = place.path().join("whole");
    run_steps(&both, &whole, Arc::new(Alone), None);
    for (before, after) in [(1, 1), (2, 3)] {
        let folder = place.path().join(format!("{before}-{after}"));
        Threads::run(before, |comm| run_steps(&both, &folder, comm, Some(13)));
        assert_eq!(Results::open(&folder).unwrap().text("/status"), "stopped");
        Threads::run(after, |comm| run_steps(&both, &folder, comm, None));
        assert_eq!(Results::open(&folder).unwrap().text("/status"), "finished");
        for name in ["", "1-tear", "2"] {
            let [found, expected] = [&folder, &whole].map(|folder| folder.join(name));
            for file in ["history.csv", "fields.pvd", "reactions.csv"] {
                let read = |folder: &Path| std::fs::read(folder.join(file)).unwrap();
                assert!(read(&found) == read(&expected), "{name}/{file}");
            }
        }
        assert_same(&folder.join("2"), &whole.join("2"), "the second step");
    }
}

/// A prescribed displacement of a static step rises from that of the step before.
#[test]
fn static_steps_follow_the_path_of_one_run() {
    let place = tempfile::tempdir().unwrap();
    let [steps, whole] = ["steps", "whole"].map(|name| place.path().join(name));
    let material =
        "critical_stretch = 0.08, softening = { law = \"linear\", onset_stretch = 0.005 }";
    let pulled = |to: f64| {
        let moved = format!("displacement = [{}, {to}]", 0.5 * to);
        deck(material, "", "").replace("velocity = [0.02, 0.05]", &moved)
    };
    let statics = |steps: u32| {
        format!("time = {{ scheme = \"static\", tolerance = 1e-10, load_steps = {steps} }}\n")
    };
    alone(&format!("{}{}", pulled(0.2), statics(4)), &whole, None);
    let second = "step = [{}, { constraint = [{ set = \"bottom\", displacement = [0, 0] }, { set = \"top\", displacement = [0.1, 0.2] }] }]";
    let both = format!("{}{}{second}", pulled(0.1), statics(2));
    run_steps(&both, &steps, Arc::new(Alone), None);
    let (found, expected) = (last(&steps.join("2")), last(&whole));
    assert!(difference(&found["softening/largest"], &expected["softening/largest"]) < 1e-8);
    assert!(difference(&found["state/u"], &expected["state/u"]) < 1e-8);
}
