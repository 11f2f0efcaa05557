//! The life of a run as other programs see it: begun, cancelled, resumed on another thread, finished.

use std::fs;
use std::path::Path;
use std::thread;

use pericles_deck::Deck;
use pericles_io::OutputFolder;
use pericles_run::{
    Assembled, Caching, Cancel, Deadline, DeckText, Ending, Event, Means, Results, Run, RunError,
    Status,
};

const PLATE: &str = r#"
title = "Torn plate"
[body]
shape = "plate"
size = ["24 mm", "12 mm"]
spacing = "1 mm"
plane = "stress"
[material]
youngs_modulus = "72 GPa"
density = 2440
horizon_ratio = 3
critical_stretch = 0.002
[sets.top]
layer = { side = "+y", cells = 1 }
[[crack]]
segment = [["0 mm", "6 mm"], ["8 mm", "6 mm"]]
[[prescribe]]
set = "top"
velocity = ["free", "4 m/s"]
[time]
end = "4 us"
dt = "0.1 us"
[output]
history = { every = 1 }
"#;

fn means() -> Means {
    Means {
        caching: Caching::Off,
        ..Means::default()
    }
}

fn begun(folder: &Path) -> Run {
    let deck = Deck::parse(PLATE, "plate.toml", &[]).unwrap();
    let text = DeckText::of(&deck, "plate.toml".into());
    let assembled = Assembled::of(&deck, &means(), &mut |_| {}).unwrap();
    let folder = OutputFolder::create(folder, false).unwrap();
    Run::begin(&deck, text, assembled, folder).unwrap()
}

fn history(folder: &Path) -> String {
    fs::read_to_string(folder.join("history.csv")).unwrap()
}

#[test]
fn a_cancelled_run_goes_on_to_the_same_results_on_another_thread() {
    let place = tempfile::tempdir().unwrap();
    let (whole, parts) = (place.path().join("whole"), place.path().join("parts"));
    let mut run = begun(&whole);
    let mut steps = Vec::new();
    let ending = run.drive(None, &Cancel::new(), &mut |event| {
        if let Event::Step { step, .. } = event {
            steps.push(step);
        }
    });
    assert_eq!(ending.unwrap(), Ending::Finished);
    assert_eq!(run.report().status, Status::Finished);
    let last = run.simulation().steps();
    assert_eq!(steps, (1..last).collect::<Vec<_>>());
    assert!(run.report().audit.is_some());
    drop(run);

    let mut run = begun(&parts);
    let cancel = Cancel::new();
    let token = cancel.clone();
    let ending = run.drive(None, &cancel, &mut |event| {
        if let Event::Step { step: 3, .. } = event {
            token.cancel();
        }
    });
    assert_eq!(ending.unwrap(), Ending::Cancelled);
    assert_eq!(run.simulation().state().step, 3);
    assert_eq!(run.report().status, Status::Stopped);
    drop(run);
    let folder = parts.clone();
    let resumed = thread::spawn(move || {
        let mut run = Run::resume(&folder, &means(), &mut |_| {})?.expect("it has not finished");
        run.drive(None, &Cancel::new(), &mut |_| {})
    });
    assert_eq!(resumed.join().unwrap().unwrap(), Ending::Finished);
    assert_eq!(history(&whole), history(&parts));
    assert!(
        Run::resume(&parts, &means(), &mut |_| {})
            .unwrap()
            .is_none()
    );
    let results = Results::open(&parts).unwrap();
    assert_eq!(results.text("/status"), "finished");
    assert_eq!(results.count("/progress/first_step"), 3);
}

#[test]
fn a_stopped_run_may_be_driven_on_and_a_deadline_stops_it() {
    let place = tempfile::tempdir().unwrap();
    let (whole, parts) = (place.path().join("whole"), place.path().join("parts"));
    let ending = begun(&whole).drive(None, &Cancel::new(), &mut |_| {});
    assert_eq!(ending.unwrap(), Ending::Finished);
    let mut run = begun(&parts);
    let over = Deadline::from_now(Some(std::time::Duration::ZERO));
    let ending = run.drive(over, &Cancel::new(), &mut |_| {});
    assert_eq!(ending.unwrap(), Ending::Deadline);
    let ending = run.drive(None, &Cancel::new(), &mut |_| {});
    assert_eq!(ending.unwrap(), Ending::Finished);
    assert_eq!(history(&whole), history(&parts));
}

#[test]
fn a_folder_without_a_run_cannot_be_resumed() {
    let place = tempfile::tempdir().unwrap();
    let resumed = Run::resume(place.path(), &means(), &mut |_| {});
    assert!(matches!(resumed.err(), Some(RunError::NoRun { .. })));
}
