//! Bodies of several pieces.

use std::collections::HashMap;

use pericles::operator::PointSubset;

use crate::common::Built;
use crate::{build, rejection};

/// Two plates with a gap of `gap` along x between them; the models and further keys follow.
fn pair(gap: f64, model: &str) -> String {
    let origin = 8.0 + gap;
    format!(
        r#"
[body]
name = "left"
shape = "plate"
size = [8, 6]
spacing = 1
plane = "stress"
[[body.piece]]
name = "right"
shape = "plate"
size = [5, 6]
origin = [{origin}, 1]
velocity = [-2, 0.5]
[material]
model = "{model}"
density = 2
youngs_modulus = 3
{poisson}
horizon_ratio = 3
critical_stretch = 0.5
[contact]
[time]
end = 1
"#,
        poisson = if model == "linear" {
            ""
        } else {
            "poisson_ratio = 0.25"
        },
    )
}

/// Returns the force densities for a displacement that depends on the position, by position relative to the left end of
/// each piece.
fn forces(built: &Built, right: f64) -> HashMap<[i64; 3], [f64; 2]> {
    let (cloud, n) = (&built.cloud, built.cloud.len());
    let place = |i: usize| {
        let [x, y, _] = cloud.point(i);
        match cloud.piece(i) {
            0 => [0.0, x, y],
            _ => [1.0, x - right, y - 1.0],
        }
    };
    let mut u = vec![0.0; 2 * n];
    for i in 0..n {
        let [piece, x, y] = place(i);
        u[i] = 0.01 * (1.3 * x + 0.7 * y * y).sin() + piece;
        u[n + i] = 0.01 * (0.4 * x * y).cos() - 2.0 * piece;
    }
    let mut f = vec![0.0; 2 * n];
    let operator = built.system.operator();
    operator.add_force(0.0, &u, PointSubset::All, &mut f);
    let key = |i: usize| place(i).map(|x| (2.0 * x).round() as i64);
    (0..n).map(|i| (key(i), [f[i], f[n + i]])).collect()
}

#[test]
fn the_forces_of_a_piece_do_not_depend_on_the_other_one_nor_on_the_kernel() {
    for model in ["linear", "state-based"] {
        let [touching, whole, listed] = [0.0, 2.0, 2.3].map(|gap| build(&pair(gap, model)));
        assert!(touching.cloud.lattice().is_some() && whole.cloud.lattice().is_some());
        assert!(listed.cloud.lattice().is_none());
        let reference = forces(&touching, 8.0);
        let largest = reference
            .values()
            .flatten()
            .fold(0.0f64, |a, b| a.max(b.abs()));
        for (other, right) in [(&whole, 10.0), (&listed, 10.3)] {
            assert_eq!(
                other.system.operator().directed_bonds(),
                touching.system.operator().directed_bonds()
            );
            for (place, force) in forces(other, right) {
                for c in 0..2 {
                    let error = (force[c] - reference[&place][c]).abs();
                    assert!(error < 1e-12 * largest, "{model} {place:?} {error:e}");
                }
            }
        }
        // The left piece alone.
        let text = pair(0.0, model);
        let (before, rest) = text.split_once("[[body.piece]]").unwrap();
        let (_, after) = rest.split_once("[material]").unwrap();
        let alone = format!("{before}[material]{after}").replace("name = \"left\"\n", "");
        let alone = build(&alone);
        for (place, force) in forces(&alone, 0.0) {
            for c in 0..2 {
                assert!(
                    (force[c] - reference[&place][c]).abs() < 1e-12 * largest,
                    "{model}"
                );
            }
        }
        let mut damage = vec![1.0; touching.cloud.len()];
        touching.system.operator().damage_into(&mut damage);
        assert!(damage.iter().all(|damage| *damage == 0.0), "{model}");
    }
}

#[test]
fn a_piece_is_a_set_with_material_and_velocity() {
    let text = pair(1.0, "linear").replace(
        "velocity = [-2, 0.5]",
        "velocity = [-2, 0.5]\nmaterial = \"heavy\"",
    ) + "[materials.heavy]\ndensity = 7\nyoungs_modulus = 3\n[[initial]]\nset = \"left\"\nvelocity = [1, 0]\n";
    let built = build(&text);
    let n = built.cloud.len();
    assert_eq!(n, 48 + 30);
    let named = |name: &str| {
        let found = built.sets.iter().find(|(known, _)| known == name);
        found.unwrap().1.clone()
    };
    assert_eq!((named("left").len(), named("right").len()), (48, 30));
    for (name, v) in [("left", [1.0, 0.0]), ("right", [-2.0, 0.5])] {
        for i in named(name) {
            let i = i as usize;
            assert_eq!([built.state.v[i], built.state.v[n + i]], v);
        }
    }
    // ρ V v of both pieces.
    let momentum = built.system.momentum(&built.state.v);
    assert_eq!(momentum[0], 2.0 * 48.0 - 2.0 * 7.0 * 30.0);
}

#[test]
fn overlapping_pieces_are_rejected_with_their_names() {
    for gap in [-1.0, -0.6] {
        let message = rejection(&pair(gap, "linear")).to_string();
        for words in ["`left`", "`right`", "overlap", "half of a cell"] {
            assert!(message.contains(words), "{message}");
        }
    }
}

#[test]
fn rotated_pieces_keep_their_shape() {
    let text = pair(3.0, "linear").replace(
        "velocity = [-2, 0.5]",
        "rotation = { angle = \"-90 deg\", centre = [11, 1] }",
    );
    let built = build(&text);
    // The lower left corner of the block of 5 × 6 cells at (11, 1) becomes the upper left one.
    let mut found: Vec<[f64; 2]> = (0..built.cloud.len())
        .filter(|&i| built.cloud.piece(i) == 1)
        .map(|i| [built.cloud.point(i)[0], built.cloud.point(i)[1]])
        .collect();
    found.sort_by(|a, b| a.partial_cmp(b).unwrap());
    let mut expected: Vec<[f64; 2]> = (0..6)
        .flat_map(|i| (0..5).map(move |j| [11.5 + f64::from(i), 0.5 - f64::from(j)]))
        .collect();
    expected.sort_by(|a, b| a.partial_cmp(b).unwrap());
    // The order of positions is the same to within rounding.
    for (a, b) in found.iter().zip(&expected) {
        let near = expected
            .iter()
            .any(|b| (a[0] - b[0]).abs() + (a[1] - b[1]).abs() < 1e-12);
        assert!(near, "{a:?} {b:?}");
    }
    assert_eq!(found.len(), 30);
}
