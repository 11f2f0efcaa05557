//! Scratch.
use pericles_deck::Deck;
use pericles_io::OutputFolder;
use pericles_run::*;
fn main() {
    for arg in std::env::args().skip(1) {
        if arg == "--reference" {
            print!("{}", pericles_deck::reference());
            continue;
        }
        let (file, out) = arg.split_once('=').unwrap();
        let text = std::fs::read_to_string(file).unwrap();
        let deck = Deck::parse(&text, file, &[]).unwrap_or_else(|e| panic!("{e}"));
        let source = Source::of_deck(deck, file.into());
        let begin = std::time::Instant::now();
        let a = Assembled::of(&source, &Means::default(), &mut |_| {})
            .unwrap_or_else(|e| panic!("{e}"));
        println!(
            "{file}: {} points, spacing {}, form {:?}, steps {}, warnings {:?}",
            a.assembly.cloud.len(),
            a.assembly.cloud.spacing(),
            a.assembly.form,
            a.assembly.steps,
            a.facts.warnings
        );
        let _ = std::fs::remove_dir_all(out);
        let folder = OutputFolder::create(std::path::Path::new(out), false).unwrap();
        let mut run = Run::begin(&source, a, folder).unwrap();
        println!(
            "{:?}",
            run.drive(None, &Cancel::new(), &mut |_| {}).unwrap()
        );
        println!(
            "{:.1} s, broken {:?}",
            begin.elapsed().as_secs_f64(),
            run.simulation().system().operator().broken_bonds()
        );
        drop(run);
        let results = Results::open(std::path::Path::new(out)).unwrap();
        if !results.fields().unwrap().is_empty() {
            export(
                &results,
                ExportFormat::Npz,
                &std::path::Path::new(out).join("fields.npz"),
            )
            .unwrap();
        }
    }
}
