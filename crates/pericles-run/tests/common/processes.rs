//! Runs of decks on several processes, which are threads.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::Arc;

use pericles::domain::{Alone, Comm, Threads};
use pericles_deck::Deck;
use pericles_io::OutputFolder;
use pericles_run::{
    Assembled, Caching, Cancel, Ending, Event, Means, Run, RunError, Source, shared_folder,
};

/// Returns means without caches for one of several processes.
pub fn means(comm: Arc<dyn Comm>) -> Means {
    Means {
        caching: Caching::Off,
        comm,
        ..Means::default()
    }
}

/// Runs a deck on one of several processes until its end, or for a number of steps.
pub fn run(
    deck: &str,
    folder: &Path,
    comm: Arc<dyn Comm>,
    stop: Option<u64>,
) -> Result<Ending, RunError> {
    let deck = Deck::parse(deck, "deck.toml", &[])?;
    let source = Source::of_deck(deck, "deck.toml".into());
    let means = means(comm);
    let assembled = Assembled::of(&source, &means, &mut |_| {})?;
    let create = || Ok::<_, RunError>(OutputFolder::create(folder, false)?);
    let folder = shared_folder(&*means.comm, create)?;
    drive(Run::begin(&source, assembled, folder)?, stop)
}

/// Advances a run until its end, or for a number of steps.
pub fn drive(mut run: Run, stop: Option<u64>) -> Result<Ending, RunError> {
    let cancel = Cancel::new();
    let token = cancel.clone();
    run.drive(None, &cancel, &mut |event| {
        if let Event::Step { step, .. } = event
            && Some(step) == stop
        {
            token.cancel();
        }
    })
}

/// Resumes a run on one of several processes until its end.
pub fn resume(folder: &Path, comm: Arc<dyn Comm>) -> Result<Ending, RunError> {
    let run = Run::resume(folder, &means(comm), &mut |_| {})?;
    drive(run.expect("the run has not finished"), None)
}

/// Returns the contents of all files of a folder but `run.json`, which contains times.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            let inner = files(&path).into_iter();
            found.extend(inner.map(|(inner, bytes)| (format!("{name}/{inner}"), bytes)));
        } else if name != "run.json" && !name.starts_with('.') {
            found.insert(name, fs::read(path).unwrap());
        }
    }
    found
}

/// Compares all files of two folders but `run.json` and earlier checkpoints, which stopped and resumed runs write at other steps.
pub fn assert_same(found: &Path, expected: &Path, case: &str) {
    let files = |folder: &Path| {
        let mut files = files(folder);
        let earlier = |name: &&String| name.starts_with("checkpoints/step-");
        let mut earlier: Vec<String> = files.keys().filter(earlier).cloned().collect();
        earlier.pop();
        earlier.iter().for_each(|name| drop(files.remove(name)));
        files
    };
    let (found, expected) = (files(found), files(expected));
    let names = |of: &BTreeMap<String, Vec<u8>>| of.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&found), names(&expected), "{case}");
    let differ = |name: &&String| found[*name] != expected[*name];
    let differ: Vec<&String> = expected.keys().filter(differ).collect();
    assert!(differ.is_empty(), "{case}: {differ:?} differ");
}

/// Runs a deck on one process and on several, and compares all files; returns the history.
pub fn check(deck: &str, sizes: &[usize]) -> String {
    let place = tempfile::tempdir().unwrap();
    let alone = place.path().join("alone");
    let ending = run(deck, &alone, Arc::new(Alone), None).unwrap();
    assert_eq!(ending, Ending::Finished);
    for &size in sizes {
        let folder = place.path().join(format!("of-{size}"));
        let endings = Threads::run(size, |comm| run(deck, &folder, comm, None));
        for ending in endings {
            assert_eq!(ending.unwrap(), Ending::Finished);
        }
        assert_same(&folder, &alone, &format!("{size} processes"));
    }
    fs::read_to_string(alone.join("history.csv")).unwrap()
}

/// Stops a deck after a number of steps on the first number of processes of each pair, resumes it on the second one, and compares
/// the files with those of a run on one process.
pub fn check_resumed(deck: &str, stop: u64, sizes: &[(usize, usize)]) {
    let place = tempfile::tempdir().unwrap();
    let alone = place.path().join("alone");
    run(deck, &alone, Arc::new(Alone), None).unwrap();
    for &(before, after) in sizes {
        let folder = place.path().join(format!("{before}-{after}"));
        for ending in Threads::run(before, |comm| run(deck, &folder, comm, Some(stop))) {
            assert_eq!(ending.unwrap(), Ending::Cancelled);
        }
        for ending in Threads::run(after, |comm| resume(&folder, comm)) {
            assert_eq!(ending.unwrap(), Ending::Finished);
        }
        let case = format!("{before}, then {after} processes");
        assert_same(&folder, &alone, &case);
    }
}

/// A small notched block that is torn apart; the material, the scheme and the output are inserted.
pub fn notched_block(material: &str, time: &str, output: &str) -> String {
    format!(
        r#"
[body]
shape = "block"
size = [12, 8, 5]
spacing = 1
[material]
{material}
[sets.top]
layer = {{ side = "+y", cells = 1 }}
[sets.bottom]
layer = {{ side = "-y", cells = 1 }}
[[crack]]
polygon = [[-1, 4, -1], [4, 4, -1], [4, 4, 6], [-1, 4, 6]]
[[constraint]]
set = "top"
{time}
[output]
{output}
[checkpoint]
every = 5
"#
    )
}

/// Condition on the set "top" of [`notched_block`].
pub const PULL: &str = "velocity = [\"free\", 0.05, \"free\"]\n[time]\n";
