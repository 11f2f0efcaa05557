//! The highest frequency of twenty bodies: estimate and bound against all eigenvalues of the dense matrix, and the bound of large bodies by plane waves.

use nalgebra::DMatrix;
use pericles::System;
use pericles_deck::Deck;
use pericles_run::{Resources, RunError, build};

use crate::row::Row;
use crate::study::{Context, Study};

/// The study.
pub(super) const STUDY: Study = Study {
    id: "numerics/highest-frequency",
    paper: "dense eigenvalues; Trefethen & Bau 1997",
    title: "Highest frequency: estimate and bound of 20 bodies against dense eigenvalues",
    run,
};

const BAR: &str = r#"
[body]
shape = "bar"
length = "60 mm"
spacing = "1 mm"
[material]
youngs_modulus = "210 GPa"
density = "7850 kg/m3"
horizon_ratio = 3
[sets.left]
layer = { side = "-x", cells = 3 }
[time]
end = "1 us"
"#;

const BAR_WITHOUT_HORIZON: &str = r#"
[body]
shape = "bar"
length = "60 mm"
spacing = "1 mm"
[material]
youngs_modulus = "210 GPa"
density = "7850 kg/m3"
[time]
end = "1 us"
"#;

const PLATE: &str = r#"
[body]
shape = "plate"
size = ["16 mm", "10 mm"]
spacing = "1 mm"
plane = "stress"
[material]
youngs_modulus = "70 GPa"
density = "2700 kg/m3"
horizon_ratio = 3
[sets.left]
layer = { side = "-x", cells = 3 }
[time]
end = "1 us"
"#;

const BLOCK: &str = r#"
[body]
shape = "block"
size = ["7 mm", "6 mm", "5 mm"]
spacing = "1 mm"
[material]
youngs_modulus = "70 GPa"
density = "2700 kg/m3"
horizon_ratio = 2
[sets.left]
layer = { side = "-x", cells = 1 }
[time]
end = "1 us"
"#;

const SPHERE: &str = r#"
[body]
shape = "icosphere"
level = 2
radius = 1
[material]
density = 1
alpha = 0.5
p = 2
horizon = 0.6
[time]
end = 1
dt = 1e-3
"#;

/// A body: its name, deck and changes to it.
type Body = (&'static str, &'static str, &'static [&'static str]);

const HELD: &str = "prescribe=[{ set = \"left\", displacement = [0] }]";
const HELD_2: &str = "prescribe=[{ set = \"left\", displacement = [0, 0] }]";
const HELD_3: &str = "prescribe=[{ set = \"left\", displacement = [0, 0, 0] }]";
const GAUSSIAN: &str =
    "material.influence={ function = \"gaussian\", length = \"8 mm\", acts_on = \"displacement\" }";

const BODIES: [Body; 20] = [
    ("bar", BAR, &[]),
    ("bar, m = 1", BAR, &["material.horizon_ratio=1"]),
    ("bar, m = 10", BAR, &["material.horizon_ratio=10"]),
    ("bar, held", BAR, &[HELD]),
    ("bar, linear", BAR, &["material.model=linear"]),
    (
        "bar, Gaussian kernel of infinite reach",
        BAR_WITHOUT_HORIZON,
        &[
            GAUSSIAN,
            "material.model=linear",
            "material.horizon=infinite",
        ],
    ),
    (
        "bar, conical kernel",
        BAR,
        &["material.influence={ function = \"conical\" }"],
    ),
    (
        "bar of Gauss nodes",
        BAR,
        &["body.quadrature=gauss", "material.model=linear"],
    ),
    (
        "periodic bar",
        BAR,
        &["body.periodic=true", "material.model=linear"],
    ),
    ("plate", PLATE, &[]),
    ("plate, m = 2", PLATE, &["material.horizon_ratio=2"]),
    ("plate, m = 5", PLATE, &["material.horizon_ratio=5"]),
    ("plate, held", PLATE, &[HELD_2]),
    (
        "plate, conical kernel",
        PLATE,
        &["material.influence={ function = \"conical\" }"],
    ),
    (
        "plate with a hole",
        PLATE,
        &["body.hole=[{ ball = { centre = [\"8 mm\", \"5 mm\"], radius = \"2.2 mm\" } }]"],
    ),
    ("plate as a list", PLATE, &["material.bonds=list"]),
    ("block", BLOCK, &[]),
    ("block, m = 3", BLOCK, &["material.horizon_ratio=3"]),
    ("block, held", BLOCK, &[HELD_3]),
    ("sphere", SPHERE, &[]),
];

/// Bodies of more than 10⁴ unknowns, whose bound is that of plane waves.
const LARGE: [Body; 3] = [
    ("long bar", BAR, &["body.length=12 m"]),
    ("large plate", PLATE, &["body.size=[\"100 mm\", \"80 mm\"]"]),
    (
        "large block",
        BLOCK,
        &["body.size=[\"24 mm\", \"20 mm\", \"16 mm\"]"],
    ),
];

fn run(_: &Context<'_>) -> Result<Vec<Row>, RunError> {
    let mut rows = Vec::new();
    for (name, deck, changes) in BODIES {
        let assembly = assembly(deck, changes)?;
        let Some(found) = assembly.body_frequency else {
            rows.push(Row::new(name, "", None).within(1.0, 0.0));
            continue;
        };
        let truth = largest_eigenvalue(&assembly.system, &assembly.state.u).sqrt();
        // At most the truth, and not below it by more than a thousandth; at least the truth, and not above it by more.
        rows.push(
            Row::new(
                format!("{name}: estimate/truth"),
                "",
                Some(found.estimate / truth),
            )
            .within(1.0 - 5e-4 + 1e-12, 5e-4),
        );
        rows.push(
            Row::new(
                format!("{name}: bound/truth"),
                "",
                Some(found.bound / truth),
            )
            .within(1.0 + 5e-4 - 1e-12, 5e-4)
            .note(format!("{} products", found.applications)),
        );
    }
    for (name, deck, changes) in LARGE {
        let found = assembly(deck, changes)?.body_frequency;
        let ratio = found.map(|found| found.bound / found.estimate);
        rows.push(
            Row::new(format!("{name}: bound/estimate"), "", ratio)
                .within(1.01, 0.01)
                .note(found.map_or(String::new(), |found| {
                    format!("{} products", found.applications)
                })),
        );
    }
    Ok(rows)
}

fn assembly(deck: &str, changes: &[&str]) -> Result<pericles_run::Assembly, RunError> {
    let changes: Vec<String> = changes.iter().map(|&change| change.into()).collect();
    let deck = Deck::parse(deck, "highest-frequency.toml", &changes)?;
    Ok(build(&deck, &Resources::default())?)
}

/// The largest eigenvalue of M^-1/2 K M^-1/2, its columns computed one by one.
fn largest_eigenvalue(system: &System, u: &[f64]) -> f64 {
    let roots: Vec<f64> = system.masses().iter().map(|mass| mass.sqrt()).collect();
    let n = roots.len();
    let mut matrix = DMatrix::zeros(n, n);
    let (mut unit, mut column) = (vec![0.0; n], vec![0.0; n]);
    for k in 0..n {
        unit[k] = 1.0;
        system.hold(&mut unit);
        system.vibration_into(u, &unit, &mut column);
        unit[k] = 0.0;
        for i in 0..n {
            matrix[(i, k)] = roots[i] * column[i] / roots[k];
        }
    }
    let matrix = 0.5 * (&matrix + matrix.transpose());
    matrix.symmetric_eigenvalues().max()
}
