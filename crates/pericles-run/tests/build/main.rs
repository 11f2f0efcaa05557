//! Assembly of decks.

#[path = "../common/mod.rs"]
mod common;
#[path = "../../../pericles-deck/tests/common/mod.rs"]
mod decks;

mod activation;
mod anisotropy;
mod bond_energy;
mod breaking_energy;
mod compatibility;
mod composition;
mod conditions;
mod constraints;
mod contact;
mod criterion;
mod dissipation;
mod ends;
mod extremes;
mod facts;
mod fields;
mod heat;
mod inelastic;
mod initial;
mod material;
mod materials;
mod memory;
mod mesh;
mod mesh_pieces;
mod model;
mod open;
mod pieces;
mod plate;
mod plausible;
mod points;
mod program;
mod properties;
mod radiation;
mod refined;
mod schemes;
mod sense;
mod solutions;
mod state_based;
mod static_breaking;
mod static_ramp;
mod static_resume;
mod stiffness;
mod strength;
mod stress;
mod succession;
mod thermal;
mod tuned;
mod wrong;

use common::{Build, Built};
use decks::WAVE;
use pericles::{Archive, Checkpointed, Simulation};
use pericles_deck::{Deck, DeckError};

fn parse(text: &str) -> Deck {
    Deck::parse(text, "deck.toml", &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn build(text: &str) -> Built {
    parse(text)
        .build()
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Does work with a number of threads.
fn with_threads<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.unwrap().install(work)
}

/// Returns the state of a run as a checkpoint stores it.
fn stored(run: &Simulation) -> Archive {
    let mut archive = Archive::default();
    run.save(&mut archive);
    archive
}

fn rejection(text: &str) -> DeckError {
    match parse(text).build() {
        Ok(_) => panic!("an error is expected:\n{text}"),
        Err(error) => error,
    }
}

/// A notched plate of 20 × 8 cells in tension.
const PLATE: &str = r#"
[body]
shape = "plate"
size = ["20 mm", "8 mm"]
spacing = "1 mm"
plane = "strain"
thickness = "2 mm"
[material]
density = "2440 kg/m3"
youngs_modulus = "72 GPa"
horizon_ratio = 3
volume_correction = "none"
fracture_energy = "135 J/m2"
no_fail = ["top", "bottom"]
[sets]
top = { layer = { side = "+y", cells = 1 } }
bottom = { layer = { side = "-y", cells = 1 } }
left = { layer = { side = "-x", cells = 2 } }
corner = { box = { max = ["4 mm", "3 mm"] } }
[[crack]]
segment = [[0, "4 mm"], ["10 mm", "4 mm"]]
[[initial]]
velocity = ["1 m/s", 0]
[[initial]]
set = "left"
displacement = [0, "0.1 um"]
velocity = [0, "2 m/s"]
[[constraint]]
set = "left"
velocity = ["3 m/s", "free"]
[[constraint]]
set = "left"
displacement = ["free", 0]
[[load]]
set = "top"
traction = [0, "12 MPa"]
[[load]]
set = "bottom"
traction = ["5 MPa", "-12 MPa"]
function = { kind = "ramp", duration = "1 us" }
[[load]]
set = "corner"
traction = ["1 MPa", 0]
[[load]]
set = "corner"
body_force = ["7 kN/m3", 0]
[[probe]]
name = "middle"
at = ["12.4 mm", "3.6 mm"]
[[probe]]
name = "edge"
set = "top"
[time]
end = "2 us"
"#;

/// Returns the plate with another `[time]` and a set in the middle.
fn plate_with_time(time: &str) -> String {
    let sets = "middle = { box = { min = [\"6 mm\", \"open\"], max = [\"14 mm\", \"open\"] } }\n\
                thin = { box = { min = [\"9 mm\", \"open\"], max = [\"11 mm\", \"open\"] } }\n";
    PLATE
        .replace("[[crack]]", &format!("{sets}[[crack]]"))
        .replace("end = \"2 us\"", &format!("end = \"2 us\"\n{time}"))
}

/// Returns a pulse on a periodic bar with a Gaussian kernel, compared with the exact solution.
fn ring() -> String {
    WAVE.replace("bonds = \"spectral\"\n", "")
        .replace("window = 3\n", "start = true\n")
}

/// A bar of 20 cells of two materials, fixed at its left end and pulled at its right end.
const STATIC: &str = r#"
[body]
shape = "bar"
length = "20 mm"
spacing = "1 mm"
area = "4 mm2"
[material]
name = "steel"
density = "7850 kg/m3"
youngs_modulus = "210 GPa"
horizon_ratio = 3
critical_stretch = 0.3
[materials.glue]
density = "1200 kg/m3"
youngs_modulus = "7 GPa"
critical_stretch = 0.01
[[assign]]
set = "middle"
material = "glue"
[[interface]]
between = ["glue", "steel"]
rule = "weaker"
critical_stretch = 0.005
[sets]
left = { where = "x < 0.003" }
middle = { where = "0.009 < x < 0.011" }
right = { layer = { side = "+x", cells = 3 } }
[[constraint]]
set = "left"
displacement = [0]
[[load]]
set = "right"
traction = ["1 MPa"]
[time]
scheme = "adaptive-dynamic-relaxation"
load_steps = 4
"#;
