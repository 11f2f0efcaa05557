//! Runs of bodies divided among several processes write the files of a run on a single process, byte for byte.
//!
//! The processes are threads; the communication by MPI is tested by `.ci/mpi`.

mod common;

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use common::processes::{
    PULL, assert_same, check, check_resumed, drive, means, notched_block, resume, run,
};
use pericles::domain::{Alone, Comm, Threads};
use pericles_deck::Deck;
use pericles_io::OutputFolder;
use pericles_run::{Assembled, Ending, Run, RunError, Source, shared_folder};

/// A notched plate that is torn apart, with two materials, a hole, loads and all tables.
const PLATE: &str = r#"
title = "Torn plate"
[body]
shape = "plate"
size = ["24 mm", "12 mm"]
spacing = "0.5 mm"
plane = "stress"
hole = [{ ball = { centre = ["15 mm", "4 mm"], radius = "1.2 mm" } }]
[material]
youngs_modulus = "72 GPa"
density = 2440
horizon_ratio = 3
critical_stretch = 0.002
[materials.soft]
youngs_modulus = "20 GPa"
density = 1500
horizon_ratio = 3
critical_stretch = 0.004
[sets.top]
layer = { side = "+y", cells = 1 }
[sets.bottom]
layer = { side = "-y", cells = 1 }
[sets.end]
where = "x > 20e-3"
[[assign]]
set = "end"
material = "soft"
[[crack]]
segment = [["0 mm", "6 mm"], ["8 mm", "6 mm"]]
[[initial]]
set = "end"
velocity = [{ expression = "0.1 * sin(1e3 * x)" }, 0]
random_velocity = { radius = "0.05 m/s", seed = 3 }
[[constraint]]
set = "top"
velocity = ["free", "4 m/s"]
[[load]]
set = "bottom"
traction = [0, "-20 MPa"]
[[probe]]
name = "tip"
at = ["9 mm", "6.2 mm"]
[[boundary]]
side = "-x"
kind = "damping-layer"
thickness = "3 mm"
[time]
end = "4 us"
dt = "0.04 us"
[output]
history = { every = 1, extremes = ["Velocity_y"] }
fields = { count = 4, names = ["Displacement", "Velocity", "Damage", "Reaction_Density", "External_Force_Density", "Strain_Energy_Density"], format = ["vtu", "vtkhdf"] }
cracks = { every = 5 }
[[output.quantity]]
name = "energy"
expression = "(tip_u_y - 1e-3*crack_1_advance)*top_y + elastic_energy"
[[time.stop_when]]
condition = "energy > 1e9 || crack_1_tip_x > 1"
[[output.picture]]
field = "Velocity_y"
count = 2
[[output.profile]]
name = "middle"
field = "Displacement_y"
from = ["0 mm", "6 mm"]
to = ["24 mm", "6 mm"]
[checkpoint]
every = 40
"#;

#[test]
fn a_plate_divided_among_processes_has_the_files_of_one_process() {
    check(PLATE, &[1, 2, 3, 4, 8]);
}

#[test]
fn a_run_is_resumed_on_another_number_of_processes() {
    check_resumed(PLATE, 47, &[(3, 1), (3, 2), (1, 4), (5, 8)]);
}

/// A breaking plate that is part of an infinite one, with a free side.
const OPEN_SIDES: &str = r#"
[body]
shape = "plate"
size = ["44 mm", "40 mm"]
spacing = "1 mm"
plane = "stress"
[material]
youngs_modulus = "72 GPa"
density = 2440
horizon_ratio = 3
critical_stretch = 0.002
[[crack]]
segment = [["20 mm", "28 mm"], ["24 mm", "28 mm"]]
[[initial]]
displacement = [0, { expression = "4e-5 * exp(-((x-0.022)^2 + (y-0.028)^2)/(3e-3)^2)" }]
[[boundary]]
kind = "open"
side = ["-x", "+x", "-y"]
cells = 10
[time]
end = "20 us"
dt = "0.1 us"
[output]
history = { every = 10 }
fields = { count = 4, names = ["Displacement", "Velocity", "Damage"] }
[checkpoint]
every = 90
"#;

#[test]
fn an_open_plate_divided_among_processes_has_the_files_of_one_process() {
    check(OPEN_SIDES, &[1, 2, 3]);
    check_resumed(OPEN_SIDES, 97, &[(3, 1), (1, 2)]);
}

/// A notched plate of softening bonds whose loads follow the opening of the notch.
const CONTROLLED: &str = r#"
[body]
shape = "plate"
size = ["24 mm", "12 mm"]
spacing = "1 mm"
plane = "stress"
[material]
youngs_modulus = "30 GPa"
density = 2400
horizon_ratio = 3
fracture_energy = "20 J/m2"
tensile_strength = "3 MPa"
softening = { law = "trilinear" }
no_fail = ["left", "right"]
[sets.left]
layer = { side = "-x", cells = 3 }
[sets.right]
layer = { side = "+x", cells = 3 }
[[crack]]
segment = [["12 mm", "0 mm"], ["12 mm", "4 mm"]]
[[constraint]]
set = "left"
displacement = [0, 0]
[[load]]
set = "right"
body_force = ["1e9 N/m3", 0]
[[probe]]
name = "near"
at = ["11.5 mm", "0.5 mm"]
[[probe]]
name = "far"
at = ["12.5 mm", "0.5 mm"]
[time]
scheme = "static"
load_steps = 6
control = { quantity = "opening", rate = "4 um/s" }
[output]
history = { every = 1 }
fields = { count = 2, names = ["Displacement", "Damage"] }
[[output.quantity]]
name = "opening"
expression = "far.u_x - near.u_x"
[checkpoint]
every = 2
"#;

#[test]
fn a_controlled_static_run_divided_among_processes_has_the_files_of_one_process() {
    check(CONTROLLED, &[1, 2, 3]);
    check_resumed(CONTROLLED, 3, &[(3, 1), (1, 2)]);
}

/// A notched plate of two materials that fail where the stress reaches their strength.
const STRENGTH: &str = r#"
[body]
shape = "plate"
size = ["20 mm", "20 mm"]
spacing = "1 mm"
plane = "stress"
[material]
youngs_modulus = "72 GPa"
density = 2440
horizon_ratio = 3
fracture_energy = "20 J/m2"
failure = "strength"
tensile_strength = "60 MPa"
scatter = { shape = 20, seed = 1 }
[materials.tough]
youngs_modulus = "50 GPa"
density = 2440
horizon_ratio = 3
fracture_energy = "400 J/m2"
tensile_strength = "40 MPa"
strength_surface = "stress_1 / 40e6 + stress_2 / 400e6"
[sets.end]
where = "x > 13e-3"
[[assign]]
set = "end"
material = "tough"
[sets.upper]
where = "y > 10e-3"
[sets.lower]
where = "y < 10e-3"
[[crack]]
segment = [["0 mm", "10 mm"], ["6 mm", "10 mm"]]
[[initial]]
set = "upper"
velocity = [0, "8 m/s"]
[[initial]]
set = "lower"
velocity = [0, "-8 m/s"]
[time]
end = "10 us"
dt = "0.1 us"
[output]
history = { every = 5 }
fields = { count = 2, names = ["Displacement", "Damage"] }
[checkpoint]
every = 30
"#;

#[test]
fn failure_by_strength_of_a_divided_plate_has_the_files_of_one_process() {
    check(STRENGTH, &[1, 2, 3]);
    check_resumed(STRENGTH, 47, &[(3, 1), (1, 2)]);
}

/// Steps of the example decks.
const STEPS: u64 = 8;

/// Returns the example decks.
fn examples() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let list = |folder: &Path| -> Vec<PathBuf> {
        let entries = fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().path()).collect()
    };
    let folders = list(&root).into_iter().filter(|path| path.is_dir());
    let decks = folders.flat_map(|folder| list(&folder));
    let is_deck = |path: &PathBuf| {
        path.extension().is_some_and(|end| end == "toml") && !path.ends_with("expected.toml")
    };
    let mut decks: Vec<PathBuf> = decks.filter(is_deck).collect();
    decks.sort();
    decks
}

/// Runs the first steps of an example on one of several processes.
fn begin(deck: &Path, folder: &Path, comm: Arc<dyn Comm>) -> Result<Ending, RunError> {
    let overrides = ["output.history = { every = 1 }".to_owned()];
    let deck = Deck::read(deck, &overrides)?;
    let source = Source::of_deck(deck, "deck.toml".into());
    let means = means(comm);
    let assembled = Assembled::of(&source, &means, &mut |_| {})?;
    let create = || Ok::<_, RunError>(OutputFolder::create(folder, false)?);
    let folder = shared_folder(&*means.comm, create)?;
    drive(Run::begin(&source, assembled, folder)?, Some(STEPS))
}

/// The longer companion of the other tests: a few minutes.
#[test]
#[ignore = "minutes; run with --ignored"]
fn examples_divided_among_processes_have_the_files_of_one_process() {
    let place = tempfile::tempdir().unwrap();
    let mut divided = 0;
    for (k, deck) in examples().iter().enumerate() {
        let name = deck.display();
        let folder = place.path().join(format!("{k}-3"));
        let found = Threads::run(3, |comm| begin(deck, &folder, comm));
        if let Some(error) = found.iter().find_map(|one| one.as_ref().err()) {
            // All processes reject a model, before they create a folder.
            assert!(found.iter().all(Result::is_err), "{name}: {error}");
            assert!(!folder.exists(), "{name}: {error}");
            println!("{name}: {error}");
            continue;
        }
        let alone = place.path().join(format!("{k}-1"));
        begin(deck, &alone, Arc::new(Alone)).unwrap();
        assert_same(&folder, &alone, &name.to_string());
        divided += 1;
    }
    assert!(divided >= 12, "{divided} examples were divided");
}

fn block(material: &str, time: &str) -> String {
    let output = "history = { every = 1 }\nfields = { count = 2 }";
    notched_block(material, time, output)
}

const BONDS: &str = "density = 1\nyoungs_modulus = 1\nhorizon = 3.01\ncritical_stretch = 0.01";
const SOLID: &str = "model = \"state-based\"\ndensity = 1\nyoungs_modulus = 1\npoisson_ratio = 0.3\nhorizon = 3.01\ncritical_stretch = 0.01";
const PRESS: &str = "displacement = [0, 0.02, 0]\n[[constraint]]\nset = \"bottom\"\ndisplacement = [0, 0, 0]\n[time]\n";

#[test]
fn materials_on_lists_and_stencils_have_the_files_of_one_process() {
    let end = format!("{PULL}end = 3\ndt = 0.2");
    let correspondence = SOLID.replace("state-based", "correspondence");
    for material in [
        format!("{BONDS}\nbonds = \"list\""),
        format!("{BONDS}\nbonds = \"grid\"\nsurface_correction = \"energy\""),
        format!("{BONDS}\nsoftening = {{ law = \"linear\", onset_stretch = 0.003 }}"),
        format!("{SOLID}\nbonds = \"list\""),
        format!("{SOLID}\nbonds = \"grid\""),
        format!("{SOLID}\nviscosity = [{{ share = 0.5, time = 1 }}]"),
        format!("{SOLID}\nyield_stress = 0.002"),
        correspondence,
    ] {
        println!("{material}");
        check(&block(&material, &end), &[3]);
    }
}

#[test]
fn schemes_have_the_files_of_one_process() {
    let unbreakable = BONDS.replace("critical_stretch = 0.01", "bonds = \"list\"");
    for (material, scheme) in [
        (BONDS, format!("{PULL}end = 3\ndt = 0.2\nscheme = \"rk4\"")),
        (
            BONDS,
            format!("{PULL}end = 3\ndt = 0.2\nscheme = \"dormand-prince\"\ntolerance = 1e-6"),
        ),
        (
            &unbreakable,
            format!("{PULL}end = 3\ndt = 0.5\nscheme = \"newmark\""),
        ),
        (
            &unbreakable,
            format!("{PULL}end = 3\ndt = 0.5\nscheme = \"discrete-gradient\""),
        ),
        (
            SOLID,
            format!(
                "{PRESS}scheme = \"adaptive-dynamic-relaxation\"\ntolerance = 1e-4\nload_steps = 2"
            ),
        ),
        (
            SOLID,
            format!("{PRESS}scheme = \"fire\"\ntolerance = 1e-4\nload_steps = 2"),
        ),
    ] {
        println!("{material}\n{scheme}");
        check(&block(material, &scheme), &[3]);
    }
}

/// The block is torn apart quasi-statically.
const OPEN: &str = "displacement = [0, 0.15, 0]\n[[constraint]]\nset = \"bottom\"\ndisplacement = [0, 0, 0]\n[time]\nscheme = \"static\"\nload_steps = 3\n";

#[test]
fn static_states_have_the_files_of_one_process() {
    let place = tempfile::tempdir().unwrap();
    // Each number of processes, and each change of it, occurs with one material and breaking.
    for (k, (material, breaking, sizes, [before, after])) in [
        (BONDS, "worst-first", &[2, 4][..], [3, 2]),
        (BONDS, "event", &[3], [1, 4]),
        (SOLID, "worst-first", &[3], [3, 2]),
    ]
    .into_iter()
    .enumerate()
    {
        println!("{material}\n{breaking}");
        let deck = block(material, &format!("{OPEN}breaking = \"{breaking}\""));
        let alone = place.path().join(format!("alone-{k}"));
        run(&deck, &alone, Arc::new(Alone), None).unwrap();
        for &size in sizes {
            let folder = place.path().join(format!("{size}-{k}"));
            for ending in Threads::run(size, |comm| run(&deck, &folder, comm, None)) {
                assert_eq!(ending.unwrap(), Ending::Finished);
            }
            assert_same(&folder, &alone, &format!("{size} processes"));
        }
        let folder = place.path().join(format!("{before}-{after}-{k}"));
        for ending in Threads::run(before, |comm| run(&deck, &folder, comm, Some(2))) {
            assert_eq!(ending.unwrap(), Ending::Cancelled);
        }
        for ending in Threads::run(after, |comm| resume(&folder, comm)) {
            assert_eq!(ending.unwrap(), Ending::Finished);
        }
        assert_same(
            &folder,
            &alone,
            &format!("{before}, then {after} processes"),
        );
    }
}

/// Returns the figures of a multirate scheme in `run.json`: before the first step and at the end.
fn refinement(folder: &Path) -> [serde_json::Value; 2] {
    let text = fs::read_to_string(folder.join("run.json")).unwrap();
    let report: serde_json::Value = serde_json::from_str(&text).unwrap();
    ["model", "audit"].map(|part| {
        let found = report[part]["refinement"].clone();
        assert!(found.is_object(), "{part}: {found}");
        found
    })
}

/// The fine set is at the end with the crack, so that some processes have no fine point. With the largest stable step many
/// bonds break in steps too large for them.
#[test]
fn multirate_schemes_have_the_files_of_one_process() {
    let notch = "[sets.notch]\nwhere = \"x < 6\"\n[[constraint]]\nset = \"top\"\n";
    let fixed = "ratio = 2\nfine = \"notch\"";
    let adaptive = "ratio = 2\nadaptive = { every = 2, threshold = 0.5, layers = 1 }";
    let stencil = format!("{BONDS}\nbonds = \"grid\"");
    let list = format!("{BONDS}\nbonds = \"list\"");
    let correspondence = SOLID.replace("state-based", "correspondence");
    for (material, scheme, fine, step) in [
        (&list[..], "respa", fixed, ""),
        (&stencil, "respa", adaptive, "dt = 0.2"),
        (&stencil, "multirate-rk4", adaptive, ""),
        (&list, "multirate-rk4", adaptive, "dt = 0.2"),
        (SOLID, "multirate-rk4", fixed, "dt = 0.2"),
        (SOLID, "multirate-rk3", adaptive, ""),
        (&correspondence, "multirate-rk3", adaptive, "dt = 0.2"),
    ] {
        println!("{material}\n{scheme}\n{fine}\n{step}");
        let time = format!("{PULL}end = 4\nscheme = \"{scheme}\"\n{fine}\n{step}");
        let deck = block(material, &time).replace("[[constraint]]\nset = \"top\"\n", notch);
        let place = tempfile::tempdir().unwrap();
        let alone = place.path().join("alone");
        let ending = run(&deck, &alone, Arc::new(Alone), None).unwrap();
        assert_eq!(ending, Ending::Finished);
        for size in [2, 4] {
            let folder = place.path().join(format!("of-{size}"));
            for ending in Threads::run(size, |comm| run(&deck, &folder, comm, None)) {
                assert_eq!(ending.unwrap(), Ending::Finished);
            }
            assert_same(&folder, &alone, &format!("{size} processes"));
            assert_eq!(refinement(&folder), refinement(&alone));
        }
    }
}

/// A block that is cut in three and torn: pieces extend over several processes.
#[test]
fn fragments_have_the_files_of_one_process() {
    let end = format!("{PULL}end = 3\ndt = 0.2");
    let correspondence = SOLID.replace("state-based", "correspondence");
    let output = "[output]\nfragments = { every = 3, smallest = 0.1 }\nfields = { count = 3, names = [\"Fragment_Id\", \"Damage\"] }\nhistory = { every = 1 }\n";
    for material in [
        format!("{BONDS}\nbonds = \"list\""),
        format!("{BONDS}\nbonds = \"grid\""),
        format!("{SOLID}\nbonds = \"list\""),
        format!("{SOLID}\nbonds = \"grid\""),
        format!("{SOLID}\nviscosity = [{{ share = 0.5, time = 1 }}]"),
        format!("{SOLID}\nyield_stress = 0.002"),
        correspondence,
    ] {
        println!("{material}");
        let deck = block(&material, &end);
        let cracks = "[[crack]]\npolygon = [[9, -1, -1], [9, 9, -1], [9, 9, 6], [9, -1, 6]]\n[[crack]]\npolygon = [[5, -1, -1], [5, 9, -1], [5, 9, 6], [5, -1, 6]]\n";
        let (before, after) = deck.split_once("[[crack]]").unwrap();
        let deck = format!("{before}{cracks}[[crack]]{after}");
        let (before, after) = deck.split_once("[output]").unwrap();
        let checkpoint = after.split_once("[checkpoint]").unwrap().1;
        check(
            &format!("{before}{output}[checkpoint]{checkpoint}"),
            &[2, 3, 4],
        );
    }
}
