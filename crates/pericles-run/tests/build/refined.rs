//! Filled surfaces and outlines with refined parts.

use std::f64::consts::TAU;

use pericles_deck::Deck;

use super::mesh::{SOLID, built, compare_forces, cube, rejected};

const SURFACE: &str = "shape = \"solid\"\nfile = \"cube.stl\"\nunit = \"mm\"";

/// Returns a deck of the filled cube with other keys of the body.
fn deck(body: &str) -> String {
    SOLID.replace(SURFACE, body)
}

/// The left half refined by a factor of 2.
const HALF: &str =
    "refine = [{ box = { min = [0, 0, 0], max = [\"4 mm\", \"8 mm\", \"8 mm\"] }, ratio = 2 }]";

#[test]
fn a_refined_filled_cube_equals_the_refined_block() {
    let ours = built(&deck(&format!("{SURFACE}\n{HALF}")), &cube());
    assert_eq!(ours.cloud.len(), 256 + 8 * 256);
    let volume: f64 = ours.cloud.volumes().iter().sum();
    assert!((volume / 512e-9 - 1.0).abs() < 1e-12, "{volume}");
    let size = "shape = \"block\"\nsize = [\"8 mm\", \"8 mm\", \"8 mm\"]";
    let theirs = super::build(&deck(&format!("{size}\n{HALF}")));
    compare_forces(&ours, &theirs);
    // An open surface has the same cells.
    let open = built(&deck(&format!("{SURFACE}\nopen = true\n{HALF}")), &cube());
    assert_eq!(open.cloud.len(), ours.cloud.len());
}

#[test]
fn a_refined_outline_equals_the_refined_plate() {
    const PLANE: &str = "plane = \"stress\"\nthickness = \"2 mm\"";
    // Around the hole, with a nested part.
    let refine = "refine = [{ box = { min = [\"1 mm\", 0], max = [\"6 mm\", \"4 mm\"] }, ratio = 2 }, { box = { min = [\"4 mm\", \"1 mm\"], max = [\"5 mm\", \"3 mm\"] }, ratio = 3 }]";
    let polygons = "polygons = [[[0, 0], [\"8 mm\", 0], [\"8 mm\", \"4 mm\"], [0, \"4 mm\"]], [[\"2 mm\", \"1 mm\"], [\"4 mm\", \"1 mm\"], [\"4 mm\", \"3 mm\"], [\"2 mm\", \"3 mm\"]]]";
    let outline = format!("shape = \"outline\"\n{PLANE}\n{polygons}\n{refine}");
    let ours = super::build(&deck(&outline));
    // 20 large cells are refined, of which 4 are in the hole and 2 have ratio 3; 12 are not refined.
    assert_eq!(ours.cloud.len(), 12 + 4 * 14 + 9 * 2);
    let plate = format!(
        "shape = \"plate\"\n{PLANE}\nsize = [\"8 mm\", \"4 mm\"]\nhole = [{{ box = {{ min = [\"2 mm\", \"1 mm\"], max = [\"4 mm\", \"3 mm\"] }} }}]\n{refine}"
    );
    let theirs = super::build(&deck(&plate));
    compare_forces(&ours, &theirs);
    // A hole instead of the inner polygon.
    let only = polygons.split(", [[\"2 mm\"").next().unwrap().to_owned() + "]";
    let hole = plate.split("hole = ").nth(1).unwrap();
    let outline = format!("shape = \"outline\"\n{PLANE}\n{only}\nhole = {hole}");
    compare_forces(&super::build(&deck(&outline)), &theirs);
}

#[test]
fn refined_cells_approximate_a_curved_outline_better() {
    const CORNERS: usize = 64;
    let corner = |k: usize| {
        let angle = TAU * k as f64 / CORNERS as f64;
        let [x, y] = [angle.cos(), angle.sin()].map(|x| 4.3 * x);
        format!("[\"{x} mm\", \"{y} mm\"]")
    };
    let corners: Vec<String> = (0..CORNERS).map(corner).collect();
    let body = |refine: &str| {
        let corners = corners.join(", ");
        let text = format!(
            "shape = \"outline\"\nplane = \"stress\"\nthickness = \"1 m\"\npolygons = [[{corners}]]\n{refine}"
        );
        super::build(&deck(&text))
    };
    let exact = 0.5 * CORNERS as f64 * 4.3e-3f64.powi(2) * (TAU / CORNERS as f64).sin();
    let error = |refine: &str| {
        let volume: f64 = body(refine).cloud.volumes().iter().sum();
        (volume / exact - 1.0).abs()
    };
    let (coarse, fine) = (error(""), error("refine = [{ all = true, ratio = 8 }]"));
    assert!(fine < 0.3 * coarse && fine < 5e-3, "{fine} {coarse}");
    // The centre of the cell at (4 mm, 2 mm) is outside, but some of its small cells are inside.
    let small = [3.5625e-3, 1.5625e-3, 0.0];
    let refined = body("refine = [{ all = true, ratio = 8 }]");
    let found = refined.cloud.point(refined.cloud.nearest(small));
    assert!(
        (0..2).all(|c| (found[c] - small[c]).abs() < 1e-9),
        "{found:?}"
    );
}

#[test]
fn invalid_refined_parts_are_reported_at_their_key() {
    let away = "refine = [{ ball = { centre = [\"90 mm\", 0, 0], radius = \"1 mm\" }, ratio = 2 }]";
    let error = rejected(&deck(&format!("{SURFACE}\n{away}")), &cube());
    assert!(
        error.contains("body.refine") || error.contains("deck.toml:6:"),
        "{error}"
    );
    for (body, parts) in [
        (
            "cells = \"partial\"\nrefine = [{ all = true, ratio = 2 }]",
            ["deck.toml:7:", "refinement requires whole cells"],
        ),
        (
            "positions = \"jittered\"\nrefine = [{ all = true, ratio = 2 }]",
            [
                "deck.toml:7:",
                "refinement requires positions = \"lattice\"",
            ],
        ),
        (
            "refine = [{ all = true, ratio = 40 }]",
            ["deck.toml:6:", "from 2 to 16"],
        ),
    ] {
        let text = deck(&format!("{SURFACE}\n{body}"));
        let error = Deck::parse(&text, "deck.toml", &[])
            .unwrap_err()
            .to_string();
        for part in parts {
            assert!(error.contains(part), "{part}:\n{error}");
        }
    }
}
