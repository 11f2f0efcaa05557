//! Points of all kinds, and their force kernels.

use pericles_deck::{Deck, DeckError};
use pericles_waves::ForceForm;

use super::common::{Build, Built};
use super::{build, parse, plate_with_time, rejection, ring};

#[test]
fn every_dimension_and_pair_law_is_built() {
    let rest = "[material]\ndensity=1\nE=1\nm=2\nmodel='LAW'\n[time]\nend=1\n";
    for body in [
        "shape='bar'\nlength=1\narea=0.1",
        "shape='disc'\nradius=0.5\nplane='stress'",
        "shape='cylinder'\nradius=0.3\ninner_radius=0.15\nheight=0.5",
        "shape='ball'\nradius=0.4",
    ] {
        for law in ["linear", "bond-stretch"] {
            let text = format!("[body]\nspacing=0.1\n{body}\n{rest}").replace("LAW", law);
            let model = build(&text);
            assert!(model.cloud.len() > 5, "{body}");
            let n = model.system.points() * model.system.dimension();
            let mut force = vec![0.0; n];
            model.system.operator().add_force(
                0.0,
                &vec![0.01; n],
                pericles::operator::PointSubset::All,
                &mut force,
            );
            // A translation causes no force.
            assert!(force.iter().all(|f| f.abs() < 1e-9), "{body} {law}");
        }
    }
}

/// The plate with a refined part.
fn refined(text: &str, radius: &str) -> String {
    let part = format!(
        "[[body.refine]]\nball = {{ centre = [\"10 mm\", \"5 mm\"], radius = \"{radius}\" }}\nratio = 2\n[material]"
    );
    text.replace("[material]", &part)
}

#[test]
fn refined_parts_have_their_own_spacing_and_constants() {
    let text =
        plate_with_time("").replace("fracture_energy = \"135 J/m2\"", "critical_stretch = 0.002");
    let (plain, fine) = (build(&text), build(&refined(&text, "3 mm")));
    assert!(fine.cloud.len() > plain.cloud.len() && fine.form == ForceForm::List);
    let volume = |model: &Built| model.cloud.volumes().iter().sum::<f64>();
    assert!((volume(&fine) / volume(&plain) - 1.0).abs() < 1e-12);
    // Half the horizon: twice the frequency, half the step.
    let ratio = plain.stable_step().unwrap() / fine.stable_step().unwrap();
    assert!((1.6..2.6).contains(&ratio), "{ratio}");
    // Every pair law, and a fracture energy with a critical stretch per grid.
    let energy = build(&refined(&plate_with_time(""), "3 mm"));
    assert!(energy.system.operator().can_break());
    build(&refined(&text, "3 mm").replace("[material]", "[material]\nmodel = \"green-strain\""));
    for (text, words, marked) in [
        (
            refined(&text, "1 um"),
            "contains no cell centre",
            "[[body.refine]]",
        ),
        (
            refined(&text, "3 mm").replace("[material]", "[material]\nbonds = \"grid\""),
            "cells of several sizes",
            "\"grid\"",
        ),
        (
            refined(&text, "3 mm")
                .replace("[material]", "[material]\nsurface_correction = \"volume\""),
            "families of two grids",
            "\"volume\"",
        ),
    ] {
        let error = rejection(&text);
        assert!(error.to_string().contains(words), "{error}");
        let excerpt = error.problems()[0].location().excerpt();
        assert!(excerpt.starts_with(marked), "{excerpt}");
    }
}

#[test]
fn force_kernels_of_linear_bodies_are_chosen_by_cost() {
    let with = |change: &[(&str, &str)]| {
        let mut text = ring();
        for (from, to) in change {
            assert!(text.contains(from));
            text = text.replace(from, to);
        }
        build(&text)
    };
    let form = |change: &[(&str, &str)]| with(change).form.name();
    assert_eq!(form(&[]), "convolution");
    assert_eq!(
        form(&[("density", "bonds = \"spectral\"\ndensity")]),
        "spectral"
    );
    // Seventy neighbours on either side: convolution.
    assert_eq!(form(&[("periodic = true", "")]), "convolution");
    let list = [
        ("periodic = true", ""),
        ("density", "bonds = \"list\"\ndensity"),
    ];
    assert_eq!(form(&list), "list");
    // Multirate schemes evaluate forces of parts of the body.
    let two = [
        ("periodic = true", ""),
        ("dt = 0.5\n", "dt = 0.5\nratio = 2\nfine = \"all\"\n"),
        ("\"trigonometric\"", "\"respa\""),
    ];
    assert_eq!(form(&two), "grid");
    let gauss = with(&[("periodic = true", "quadrature = \"gauss\"")]);
    assert_eq!((gauss.form.name(), gauss.cloud.len()), ("convolution", 400));
    assert_eq!(gauss.integrator.name(), "trigonometric");
    // Seven lengths.
    assert_eq!(parse(&ring()).model.body.horizon(), 7.0);
}

#[test]
fn surfaces_are_read_with_the_given_reader() {
    use pericles_manifold::surface::Surface;
    use pericles_run::{FileError, Resources};
    let text = r#"
[body]
shape = "surface"
file = "parts/ball.stl"
[material]
density = "1 kg/m2"
alpha = 0.5
p = 2
horizon = "0.6 m"
[time]
end = "1 ms"
"#;
    let deck = Deck::parse(text, "decks/ball.toml", &[]).unwrap();
    let asked = std::sync::Mutex::new(Vec::new());
    let built = |surface: fn() -> Result<Surface, FileError>| {
        deck.build_with(Resources {
            read_surface: &|path, _| {
                asked.lock().unwrap().push(path.to_owned());
                surface()
            },
            ..Resources::default()
        })
    };
    let sphere = || Ok(Surface::icosphere(2, 1.0).unwrap());
    let Ok(model) = built(sphere) else {
        panic!("a sphere is a surface");
    };
    assert_eq!(model.cloud.len(), 162);
    assert_eq!(
        asked.lock().unwrap()[0],
        std::path::Path::new("decks/parts/ball.stl")
    );
    // A triangle is missing: the surface is open.
    let open = || {
        let sphere = Surface::icosphere(2, 1.0).unwrap();
        Surface::new(
            sphere.positions().to_vec(),
            sphere.triangles()[1..].to_vec(),
        )
        .map_err(|error| FileError::Wrong(error.to_string()))
    };
    let message = |result: Result<Built, DeckError>| match result {
        Ok(_) => panic!("rejected"),
        Err(error) => error.to_string(),
    };
    let error = message(built(open));
    assert!(
        error.starts_with("decks/ball.toml:4:8:")
            && error.contains("ball.stl is not a valid surface"),
        "{error}"
    );
    let error = message(built(|| Err(FileError::Wrong("line 3: no number".into()))));
    assert!(error.contains("line 3: no number"), "{error}");
    // Without a reader.
    assert!(message(deck.build()).contains("no reader for"));
    let cells = text.replace(
        "[material]",
        "[sets]\ncap = { layer = { side = \"+z\", cells = 1 } }\n[material]",
    );
    let error = Deck::parse(&cells, "ball.toml", &[])
        .unwrap_err()
        .to_string();
    assert!(error.contains("no uniform spacing"), "{error}");
}

#[test]
fn anisotropic_spacing_reproduces_uniform_strain() {
    let text = r#"
[body]
shape = "plate"
size = ["12 mm", "9 mm"]
spacing = ["1 mm", "0.75 mm"]
plane = "stress"
[material]
model = "linear"
density = "2440 kg/m3"
youngs_modulus = "72 GPa"
horizon_ratio = 3
[time]
end = "1 us"
"#;
    let model = build(text);
    assert_eq!(model.cloud.len(), 144);
    let (n, x, y) = (144, model.cloud.axis(0), model.cloud.axis(1));
    let strain = [1e-3, -2e-3, 5e-4];
    let u: Vec<f64> = (0..n)
        .map(|i| strain[0] * x[i] + strain[2] * y[i])
        .chain((0..n).map(|i| strain[2] * x[i] + strain[1] * y[i]))
        .collect();
    let mut force = vec![0.0; 2 * n];
    model.system.force_density_into(0.0, &u, &mut force);
    let inside = |i: &usize| (3.7e-3..8.3e-3).contains(&x[*i]) && (3.7e-3..5.3e-3).contains(&y[*i]);
    let largest = force.iter().fold(0.0f64, |m, f| m.max(f.abs()));
    let inner = (0..n).filter(inside);
    let rest = inner
        .clone()
        .fold(0.0f64, |m, i| m.max(force[i].abs().max(force[n + i].abs())));
    assert!(
        inner.count() > 4 && rest < 1e-11 * largest,
        "{rest:e} {largest:e}"
    );
    // The dispersion analysis has the same bonds.
    let deck = parse(text);
    let spacing = model.interior(&deck.model).unwrap().lattice.spacing();
    assert_eq!(spacing, [1e-3, 0.75e-3, 0.0]);
    let classes = text.replace(
        "horizon_ratio = 3",
        "horizon_ratio = 3\ninfluence = { function = \"tuned\" }",
    );
    let message = Deck::parse(&classes, "deck.toml", &[])
        .unwrap_err()
        .to_string();
    assert!(message.contains("square and cubic cells"), "{message}");
}

/// Returns a plate of 12 × 6 cells of 1 mm as unordered listed points, with its right third as block 2.
fn listed_plate(volume: f64) -> pericles::space::ListedPoints {
    let mut listed = pericles::space::ListedPoints::default();
    for k in 0..72 {
        // 5 and 72 are coprime: every cell occurs once.
        let cell = 5 * k % 72;
        let (column, row) = (cell % 12, cell / 12);
        let place = [column, row].map(|c| (f64::from(c) + 0.5) * 1e-3);
        listed.positions.push([place[0], place[1], 0.0]);
        listed.blocks.push(if column < 8 { 1 } else { 2 });
        listed.volumes.push(volume);
    }
    listed
}

const LISTED: &str = r#"
[body]
shape = "points"
file = "plate.txt"
dimension = 2
spacing = "1 mm"
plane = "stress"
thickness = "2 mm"
[material]
density = "2440 kg/m3"
youngs_modulus = "72 GPa"
horizon_ratio = 3
[sets]
right = { block = 2 }
corner = { where = "x < 0.002 && y < 0.003 || block == 7" }
edge = { layer = { side = "-x", cells = 1 } }
[[load]]
set = "right"
traction = ["1 MPa", 0]
area = "12 mm2"
[time]
end = "1 us"
"#;

#[test]
fn listed_points_have_the_unit_of_length_of_the_deck() {
    use pericles_run::Resources;
    let built = |text: &str, unit: f64| {
        let deck = Deck::parse(text, "plate.toml", &[]).unwrap();
        let built = deck.build_with(Resources {
            read_points: &|_, _, _| {
                let mut listed = listed_plate(2e-9 / unit.powi(3));
                for place in &mut listed.positions {
                    *place = place.map(|x| x / unit);
                }
                Ok(listed)
            },
            ..Resources::default()
        });
        built.unwrap_or_else(|error| panic!("{error}"))
    };
    let metres = built(LISTED, 1.0);
    let unit = LISTED.replace("plate.txt\"", "plate.txt\"\nunit = \"mm\"");
    let millimetres = built(&unit, 1e-3);
    for i in 0..72 {
        let (a, b) = (metres.cloud.point(i), millimetres.cloud.point(i));
        assert!((0..2).all(|c| (a[c] - b[c]).abs() < 1e-15), "{a:?} {b:?}");
    }
    assert!((millimetres.cloud.spacing() / 1e-3 - 1.0).abs() < 1e-12);
    // Without `spacing`, the size of the mean cell counts.
    let automatic = LISTED.replace("spacing = \"1 mm\"\n", "");
    let error = Deck::parse(&automatic, "plate.toml", &[]).unwrap_err();
    let error = error.to_string();
    assert!(error.contains("before its file is read"), "{error}");
    assert!(error.contains("`depth` instead"), "{error}");
    let automatic = automatic.replace("cells = 1", "depth = \"1 mm\"");
    let automatic = automatic.replace("horizon_ratio = 3", "horizon = \"3 mm\"");
    let automatic = built(&automatic, 1.0);
    assert_eq!(automatic.cloud.spacing(), metres.cloud.spacing());
    let edge = automatic
        .sets
        .iter()
        .find(|(name, _)| name == "edge")
        .unwrap();
    assert_eq!(edge.1.len(), 6);
}

#[test]
fn listed_points_of_a_grid_equal_the_grid() {
    use pericles::operator::PointSubset;
    use pericles_run::Resources;
    let built = |text: &str, volume: f64| {
        let deck = Deck::parse(text, "decks/plate.toml", &[]).unwrap();
        deck.build_with(Resources {
            read_points: &|path, dimension, _| {
                assert_eq!(path, std::path::Path::new("decks/plate.txt"));
                assert_eq!(dimension, 2);
                Ok(listed_plate(volume))
            },
            ..Resources::default()
        })
    };
    let cell = 2e-9;
    let listed = built(LISTED, cell).unwrap_or_else(|error| panic!("{error}"));
    let sizes: Vec<(&str, usize)> = listed
        .sets
        .iter()
        .map(|(name, points)| (name.as_str(), points.len()))
        .collect();
    assert_eq!(
        sizes,
        [("all", 72), ("right", 24), ("corner", 6), ("edge", 6)]
    );
    // The same plate on a grid: equal forces to rounding.
    let grid = LISTED
        .replace(
            "\"points\"\nfile = \"plate.txt\"\ndimension = 2",
            "\"plate\"\nsize = [\"12 mm\", \"6 mm\"]",
        )
        .replace("block = 2", "where = \"x > 0.008\"");
    let grid = build(&grid);
    let displaced = |model: &Built| -> Vec<f64> {
        let places = (0..72).map(|i| model.cloud.point(i));
        let u: Vec<[f64; 2]> = places
            .map(|[x, y, _]| [1e-2 * x * x / 1e-3, 2e-3 * (x - y)])
            .collect();
        (0..2).flat_map(|c| u.iter().map(move |u| u[c])).collect()
    };
    let forces = |model: &Built| {
        let u = displaced(model);
        let mut force = vec![0.0; 144];
        model
            .system
            .operator()
            .add_force(0.0, &u, PointSubset::All, &mut force);
        force
    };
    let (ours, theirs) = (forces(&listed), forces(&grid));
    let scale = theirs.iter().fold(0.0, |max: f64, f| max.max(f.abs()));
    for i in 0..72 {
        let place = listed.cloud.point(i);
        let twin = grid.cloud.nearest(place);
        for c in 0..2 {
            let difference = ours[c * 72 + i] - theirs[c * 72 + twin];
            assert!(difference.abs() < 1e-11 * scale, "{i}: {difference}");
        }
    }
    // Volumes in mm³, an empty set, a traction without area.
    let rejected =
        |text: &str, volume: f64| built(text, volume).map(|_| ()).unwrap_err().to_string();
    let error = rejected(LISTED, 2.0);
    assert!(
        error.contains("plate.toml:6:11: the volumes of the listed points"),
        "{error}"
    );
    assert!(
        error.contains("volumes in its third power; `thickness` is part"),
        "{error}"
    );
    let unit = LISTED.replace("plate.txt\"", "plate.txt\"\nunit = \"10 m\"");
    let error = rejected(&unit, cell);
    assert!(error.contains("correspond to a spacing of 31.6"), "{error}");
    let error = rejected(&LISTED.replace("block = 2", "block = 3"), cell);
    assert!(
        error.contains("the set `right` selects no point"),
        "{error}"
    );
    let by_number = |numbers: &str| LISTED.replace("block = 2", &format!("points = {numbers}"));
    let some = built(&by_number("[3, \"5-7\", 6]"), cell).unwrap_or_else(|error| panic!("{error}"));
    let (_, members) = some.sets.iter().find(|(name, _)| name == "right").unwrap();
    let mut numbers: Vec<usize> = members
        .iter()
        .map(|&i| some.cloud.user_number(i as usize))
        .collect();
    numbers.sort_unstable();
    assert_eq!(numbers, [3, 5, 6, 7]);
    let error = rejected(&by_number("[0, 1000000]"), cell);
    assert!(error.contains("`1000000` is out of range"), "{error}");
    assert!(error.contains("point numbers from 0 to"), "{error}");
    let error = rejected(&LISTED.replace("area = \"12 mm2\"", ""), cell);
    assert!(error.contains("listed points have no faces"), "{error}");
    assert!(rejection(LISTED).to_string().contains("no reader for"));
}
