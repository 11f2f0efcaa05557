//! A plate: points, bonds, sets, a run, errors.

use pericles_waves::ForceForm;

use super::common::Build;
use super::{PLATE, STATIC, build, parse, rejection};

#[test]
fn points_bonds_and_sets_of_a_plate_are_exact() {
    let model = build(PLATE);
    assert_eq!(model.cloud.len(), 160);
    let volume: f64 = model.cloud.volumes().iter().sum();
    assert!((volume / (0.02 * 0.008 * 0.002) - 1.0).abs() < 1e-12);
    let sizes: Vec<(&str, usize)> = model
        .sets
        .iter()
        .map(|(name, points)| (name.as_str(), points.len()))
        .collect();
    assert_eq!(
        sizes,
        [
            ("all", 160),
            ("top", 20),
            ("bottom", 20),
            ("left", 16),
            ("corner", 12)
        ]
    );
    // m = 3 without volume correction: offsets in the closed disc of radius 3, in both directions.
    let pairs = |columns: i64, rows: i64| -> i64 {
        let mut sum = 0;
        for x in -3..=3i64 {
            for y in -3..=3i64 {
                if (1..=9).contains(&(x * x + y * y)) {
                    sum += (columns - x.abs()) * (rows - y.abs());
                }
            }
        }
        sum
    };
    let all = pairs(20, 8) as u64;
    // `directed_bonds` excludes bonds cut by pre-cracks.
    assert_eq!(
        model.system.operator().directed_bonds(),
        all - 2 * model.precut_bonds
    );
    // Bonds that cross the notch plane at x ≤ 10 mm, by brute force.
    let mut cut = 0;
    for i in 0..160usize {
        for j in 0..i {
            let (p, q) = (model.cloud.point(i), model.cloud.point(j));
            let (dx, dy) = ((q[0] - p[0]) * 1e3, (q[1] - p[1]) * 1e3);
            let (above, below) = (p[1] * 1e3 - 4.0, q[1] * 1e3 - 4.0);
            if dx * dx + dy * dy < 9.0001 && above * below < 0.0 {
                let crossing = p[0] * 1e3 + dx * above / (above - below);
                cut += u64::from(crossing <= 10.0 + 1e-6);
            }
        }
    }
    assert_eq!(model.precut_bonds, cut);
    assert_eq!(model.cracks.len(), 1);
    assert!(model.warnings.is_empty());
    // Plane strain: c = 48 E / (5 π h δ³) and s₀² = 5 π G₀ / (12 E δ).
    let (young, delta, pi) = (72e9, 3e-3f64, std::f64::consts::PI);
    let c = 48.0 * young / (5.0 * pi * 0.002 * delta.powi(3));
    let s0 = (5.0 * pi * 135.0 / (12.0 * young * delta)).sqrt();
    assert!((model.constants().micromodulus / c - 1.0).abs() < 1e-12);
    let text = PLATE.replace("no_fail", "fracture_calibration = \"continuum\"\nno_fail");
    let continuum = build(&text).constants().clone();
    assert!((continuum.critical_stretch / s0 - 1.0).abs() < 1e-12);
    // By default the mean over the planes (10) and (11) has the given fracture energy: 20.779 and 21.224 instead of
    // 20.25 for the continuum.
    let lattice = s0 * (20.25f64 / (0.5 * (20.779 + 21.224))).sqrt();
    assert!((model.constants().critical_stretch / lattice - 1.0).abs() < 2e-5);
    assert!((model.constants().fracture_energy / 135.0 - 1.0).abs() < 1e-12);
}

#[test]
fn the_run_is_created_and_moves() {
    let mut run = build(PLATE).simulation();
    run.run(|_| pericles::Control::Continue).unwrap();
    assert!((run.state().t / 2e-6 - 1.0).abs() < 1e-12);
    assert!(run.state().u.iter().any(|u| *u != 0.0));
}

#[test]
fn errors_of_the_engine_have_locations() {
    for (replace, by, line, marked, words) in [
        (
            "\"8 mm\"]",
            "\"8.4 mm\"]",
            4,
            "\"8.4 mm\"",
            "not a whole number of cells",
        ),
        (
            "\"20 mm\",",
            "\"20.5 mm\",",
            4,
            "\"20.5 mm\"",
            "not a whole number of cells",
        ),
        (
            "spacing = \"1 mm\"",
            "spacing = \"1 nm\"",
            5,
            "\"1 nm\"",
            "at most",
        ),
        (
            "thickness = \"2 mm\"",
            "hole = [{ all = true }]",
            2,
            "[body]",
            "no points",
        ),
        (
            "end = \"2 us\"",
            "end = \"2 us\"\ndt = \"1 us\"",
            55,
            "\"1 us\"",
            "unstable",
        ),
        (
            "end = \"2 us\"",
            "end = 1e300",
            53,
            "[time]",
            "at most 9e15 steps",
        ),
        (
            "cells = 2",
            "depth = \"0.1 mm\"",
            18,
            "{ layer",
            "`left` selects no point",
        ),
        (
            "displacement = [\"free\", 0]",
            "displacement = [0, 0]",
            31,
            "[[constraint]]",
            "already prescribed by [[constraint]] number 1",
        ),
        (
            "traction = [\"1 MPa\", 0]",
            "traction = [\"1 MPa\", 1]",
            43,
            "[\"1 MPa\", 1]",
            "set `area`",
        ),
        (
            "volume_correction = \"none\"",
            "influence = { function = \"tabulated\", r = \"horizon\", table = [[0, 3], [1, -1]] }",
            12,
            "{ function",
            "negative values",
        ),
    ] {
        assert_eq!(PLATE.matches(replace).count(), 1, "{replace}");
        let error = rejection(&PLATE.replace(replace, by));
        let message = error.to_string();
        let [problem] = error.problems() else {
            panic!("{message}")
        };
        assert_eq!(problem.location().line(), line, "{message}");
        assert!(
            problem.location().excerpt().starts_with(marked),
            "{message}"
        );
        assert!(message.contains(words), "{message}");
        assert!(
            message.starts_with(&format!("deck.toml:{line}:")),
            "{message}"
        );
    }
}

#[test]
fn overrides_change_the_model() {
    let mut deck = parse(PLATE);
    deck.model.cracks.clear();
    let solid = deck.model.body.solid_mut().unwrap();
    solid.shape.lattice_mut().unwrap().grid.spacing = 0.5e-3;
    let model = deck.build().unwrap();
    assert_eq!(model.cloud.len(), 640);
    assert_eq!(model.precut_bonds, 0);
    deck.model.sets.pop();
    let Err(error) = deck.build() else {
        panic!("the set `corner` is missing")
    };
    assert!(
        error.to_string().contains("unknown set `corner`"),
        "{error}"
    );
}

#[test]
fn sets_have_their_own_density_and_strength() {
    let model = build(STATIC);
    assert_eq!(
        (model.steps, model.dt, model.form),
        (4, 0.25, ForceForm::Grid)
    );
    let density = |x: f64| {
        model
            .system
            .density()
            .at(model.cloud.nearest([x, 0.0, 0.0]))
    };
    assert_eq!((density(2e-3), density(10e-3)), (7850.0, 1200.0));
    assert!(model.system.operator().can_break());
    let lines: Vec<String> = model
        .warnings
        .iter()
        .map(|warning| warning.line())
        .collect();
    let count = |says: &str| lines.iter().filter(|line| line.contains(says)).count();
    assert_eq!(
        count("deck.toml:12:20: the critical stretch is 30 %"),
        1,
        "{lines:?}"
    );
    // The glue is two cells thick.
    assert_eq!(count("bonds bridge this layer"), 1, "{lines:?}");
    assert_eq!(lines.len(), 2, "{lines:?}");
}
