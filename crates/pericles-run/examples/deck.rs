//! Running a deck and a modified model: the steel bar of `examples/statics/bar.toml`, and the same bar of aluminium,
//! each with its own output folder.
//!
//! A deck is read into a `Model`: plain data, which a program can change and run like the deck itself. The model is
//! stored in the output folder, so that `pericles resume`, `info`, `plot` and `report` work on it.

use std::error::Error;
use std::path::Path;

use pericles::material::ElasticModulus;
use pericles_deck::{Deck, Model};
use pericles_io::OutputFolder;
use pericles_run::{Assembled, Cancel, Event, Means, Results, Run, Source};

/// Runs a source into a folder and returns the displacement (m) of the point nearest to x = 997.5 mm.
fn end_displacement(source: &Source, folder: &Path) -> Result<f64, Box<dyn Error>> {
    // Points, forces, scheme and step. Errors of the model are reported here, before the folder is created.
    let assembled = Assembled::of(source, &Means::default(), &mut |_| {})?;
    let mut run = Run::begin(source, assembled, OutputFolder::create(folder, false)?)?;
    run.drive(None, &Cancel::new(), &mut |event| {
        if let Event::Warning(warning) = event {
            println!("warning: {warning}");
        }
    })?;
    let simulation = run.simulation();
    let end = simulation.system().cloud().nearest([0.9975, 0.0, 0.0]);
    Ok(simulation.state().u[end])
}

fn main() -> Result<(), Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/statics/bar.toml");
    let place = tempfile::tempdir()?;

    // The unmodified deck. Warnings and errors refer to locations in its text.
    let deck = Deck::read(&path, &[])?;
    let mut model: Model = deck.model.clone();
    let steel = Source::of_deck(deck, path.display().to_string());
    let steel = end_displacement(&steel, &place.path().join("steel"))?;

    // The model changed in Rust. It can also be read from JSON or built from scratch.
    model.title = Some("Aluminium bar in tension".into());
    let solid = model.body.solid_mut();
    if let Some(material) = solid.and_then(|solid| solid.material.bonds_mut()) {
        material.modulus.value = ElasticModulus::Young(70e9);
        material.density = 2700.0;
    }
    let folder = place.path().join("aluminium");
    let aluminium = end_displacement(&Source::of_model(model, Path::new("")), &folder)?;

    // Hooke's law: the end moves by F x/(E A) with F = 2 MN and A = 0.01 m².
    for (name, moved, young) in [("steel", steel, 200e9), ("aluminium", aluminium, 70e9)] {
        let exact = 2e6 * 0.9975 / (young * 0.01);
        println!(
            "{name:10} {:.4} mm, Hooke's law {:.4} mm",
            1e3 * moved,
            1e3 * exact
        );
        // Within a horizon of its ends the bar is softer; this is 1 % of its length.
        if (moved / exact - 1.0).abs() > 0.02 {
            return Err("the bar does not follow Hooke's law".into());
        }
    }

    // The folder tells what was run, and how it went.
    let results = Results::open(&folder)?;
    println!(
        "{}: {}, {} points",
        results.text("/title"),
        results.text("/status"),
        results.count("/model/points")
    );
    Ok(())
}
