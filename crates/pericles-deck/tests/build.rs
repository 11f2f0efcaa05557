//! From decks to models.

mod common;

use common::WAVE;
use pericles::operator::BondForm;
use pericles::time::State;
use pericles_deck::{Deck, DeckError, Model};

fn parse(text: &str) -> Deck {
    Deck::parse(text, "deck.toml", &[]).unwrap_or_else(|error| panic!("{error}"))
}

fn build(text: &str) -> Model {
    parse(text)
        .build()
        .unwrap_or_else(|error| panic!("{error}"))
}

fn refusal(text: &str) -> DeckError {
    match parse(text).build() {
        Ok(_) => panic!("this deck is wrong:\n{text}"),
        Err(error) => error,
    }
}

/// A plate of 20 × 8 cells with a notch, pulled apart.
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
displacement = [0, "1 um"]
velocity = [0, "2 m/s"]
[[prescribe]]
set = "left"
velocity = ["3 m/s", "free"]
[[prescribe]]
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

#[test]
fn points_bonds_and_sets() {
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
    // m = 3 without correction: offsets in the closed disc of radius 3, counted in both directions.
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
    // `directed_bonds` are those left after pre-cutting.
    assert_eq!(
        model.system.operator().directed_bonds(),
        all - 2 * model.precut_bonds
    );
    // Bonds across the notch's height whose crossing lies at x ≤ 10 mm, by brute force.
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
    assert!((model.constants.micromodulus / c - 1.0).abs() < 1e-12);
    assert!((model.constants.critical_stretch / s0 - 1.0).abs() < 1e-12);
}

#[test]
fn conditions() {
    let model = build(PLATE);
    let loads = model.system.loads();
    let resultant = |k: usize, t: f64| {
        let force = loads[k].resultant(t, &model.cloud);
        [force[0], force[1]]
    };
    let close = |found: [f64; 2], wanted: [f64; 2]| {
        for c in 0..2 {
            assert!(
                (found[c] - wanted[c]).abs() < 1e-9 * 500.0,
                "{found:?} {wanted:?}"
            );
        }
    };
    // The top face: 20 mm × 2 mm.
    close(resultant(0, 0.0), [0.0, 480.0]);
    // A layer takes its face whatever the direction of the load; half way up the ramp.
    close(resultant(1, 0.5e-6), [100.0, -240.0]);
    // No layer: the side of the set normal to the load, 3 mm × 2 mm.
    close(resultant(2, 0.0), [6.0, 0.0]);
    close(resultant(3, 0.0), [7e3 * 12.0 * 2e-9, 0.0]);

    let motions = model.system.motions();
    assert_eq!(motions[0].name, "left");
    assert_eq!(motions[1].name, "left_2");
    let amplitudes = |k: usize| [0, 1, 2].map(|c| motions[k].amplitude(c));
    assert_eq!(amplitudes(0), [Some(3.0), None, None]);
    assert_eq!(amplitudes(1), [None, Some(0.0), None]);

    // Later initial values replace earlier ones, component-major.
    let State { u, v, .. } = &model.state;
    let n = model.cloud.len();
    for i in 0..n {
        let left = model.cloud.point(i)[0] < 2e-3;
        let expected = if left {
            (0.0, 2.0, 1e-6)
        } else {
            (1.0, 0.0, 0.0)
        };
        assert_eq!((v[i], v[n + i], u[n + i]), expected);
    }

    let middle = model.cloud.point(model.probes[0].points[0] as usize);
    assert!((middle[0] - 12.5e-3).abs() < 1e-9 && (middle[1] - 3.5e-3).abs() < 1e-9);
    assert_eq!(model.probes[1].points.len(), 20);
}

#[test]
fn automatic_steps_are_stable_and_end_on_time() {
    let model = build(PLATE);
    let stable = model.stable_step().unwrap();
    assert!((model.dt * model.steps as f64 / 2e-6 - 1.0).abs() < 1e-12);
    assert!(model.dt <= 0.95 * stable * (1.0 + 1e-8));
    // One step fewer would not do.
    assert!(2e-6 / (model.steps - 1) as f64 > 0.95 * stable);
    let fixed = build(&PLATE.replace("end = \"2 us\"", "end = \"2 us\"\ndt = \"30 ns\""));
    assert_eq!((fixed.dt, fixed.steps), (30e-9, 67));
    let whole = build(&PLATE.replace("end = \"2 us\"", "end = \"2 us\"\ndt = \"40 ns\""));
    assert_eq!(whole.steps, 50);
}

#[test]
fn the_run_can_be_made_and_moves() {
    let mut run = build(PLATE).simulation();
    run.run(|_| pericles::Control::Continue).unwrap();
    assert!((run.state().t / 2e-6 - 1.0).abs() < 1e-12);
    assert!(run.state().u.iter().any(|u| *u != 0.0));
}

#[test]
fn every_dimension_and_law() {
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
                pericles::operator::On::All,
                &mut force,
            );
            // A translation exerts no force.
            assert!(force.iter().all(|f| f.abs() < 1e-9), "{body} {law}");
        }
    }
}

#[test]
fn what_the_library_refuses_is_located() {
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
            "[[prescribe]]",
            "prescribed by [[prescribe]] number 1 already",
        ),
        (
            "traction = [\"1 MPa\", 0]",
            "traction = [\"1 MPa\", 1]",
            43,
            "[\"1 MPa\", 1]",
            "give `area`",
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
        let error = refusal(&PLATE.replace(replace, by));
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
fn what_is_odd_is_warned_of() {
    let cautions = |replace: &str, by: &str| {
        let model = build(&PLATE.replace(replace, by));
        let [warning] = &model.warnings[..] else {
            panic!("one warning for {by}")
        };
        (warning.location().line(), warning.line())
    };
    let away = "[[0, \"20 mm\"], [\"10 mm\", \"20 mm\"]]";
    let (line, text) = cautions("[[0, \"4 mm\"], [\"10 mm\", \"4 mm\"]]", away);
    assert_eq!(line, 20);
    assert!(text.starts_with("deck.toml:20:1: this crack lies outside of the body"));
    let (line, text) = cautions("[\"12.4 mm\",", "[\"22.4 mm\",");
    assert_eq!(line, 49);
    assert!(text.contains("`middle`"), "{text}");
    let (line, text) = cautions(
        "end = \"2 us\"",
        "end = \"2 us\"\ndt = \"1 us\"\nallow_unstable = true",
    );
    assert_eq!(line, 55);
    assert!(text.contains("allow_unstable"), "{text}");
}

#[test]
fn a_body_without_stiffness_needs_a_given_step() {
    let lone = "[body]\nshape='bar'\nlength=2\nspacing=1\n[[crack]]\nsection=1\n\
                [material]\ndensity=1\nE=1\nm=1\n[time]\nend=1\n";
    let error = refusal(lone);
    assert!(error.to_string().contains("give dt"), "{error}");
    let model = build(&format!("{lone}dt=0.1\n"));
    assert_eq!(model.steps, 10);
    assert!(model.frequency.is_none() && model.stable_step().is_none());
}

#[test]
fn models_of_changed_decks() {
    let mut deck = parse(PLATE);
    deck.cracks.clear();
    deck.body.grid.spacing = 0.5e-3;
    let model = deck.build().unwrap();
    assert_eq!(model.cloud.len(), 640);
    assert_eq!(model.precut_bonds, 0);
    deck.sets.pop();
    let Err(error) = deck.build() else {
        panic!("the set `corner` is gone")
    };
    assert!(
        error.to_string().contains("unknown set `corner`"),
        "{error}"
    );
}

/// The plate with another `[time]` and a middle set.
fn plate_with_time(time: &str) -> String {
    let sets = "middle = { box = { min = [\"6 mm\", \"open\"], max = [\"14 mm\", \"open\"] } }\n\
                thin = { box = { min = [\"9 mm\", \"open\"], max = [\"11 mm\", \"open\"] } }\n";
    PLATE
        .replace("[[crack]]", &format!("{sets}[[crack]]"))
        .replace("end = \"2 us\"", &format!("end = \"2 us\"\n{time}"))
}

#[test]
fn schemes() {
    for (time, name, order) in [
        ("scheme = \"rk3\"", "rk3", 3),
        ("scheme = \"rk4\"", "rk4", 4),
        (
            "scheme = \"dormand-prince\"\ndt = \"0.1 us\"",
            "dormand-prince",
            5,
        ),
        (
            "scheme = \"rk3-mts\"\nratio = 4\nfine = \"middle\"",
            "rk3-mts",
            3,
        ),
        (
            "scheme = \"rk4-mts\"\nratio = 4\nadaptive = {}",
            "rk4-mts",
            4,
        ),
        (
            "scheme = \"respa\"\nratio = 4\nfine = [\"middle\", \"left\"]",
            "respa",
            2,
        ),
    ] {
        let model = build(&plate_with_time(time));
        assert_eq!(
            (model.integrator.name(), model.integrator.order()),
            (name, order)
        );
        assert!(model.warnings.is_empty(), "{name}");
        let two = model.integrator.refinement();
        assert_eq!(two.is_some(), time.contains("ratio"));
        // They run.
        let mut simulation = model.simulation();
        simulation.run(|_| pericles::Control::Continue).unwrap();
    }
    let limit = |time: &str| build(&plate_with_time(time)).stable_step().unwrap();
    let verlet = limit("");
    assert!((limit("scheme = \"rk4\"") / verlet / 2f64.sqrt() - 1.0).abs() < 1e-6);
    assert!((limit("scheme = \"rk3\"") / verlet / 0.75f64.sqrt() - 1.0).abs() < 1e-6);
}

#[test]
fn schemes_that_do_not_fit_are_refused() {
    for (time, line, words) in [
        ("scheme = \"dormand-prince\"", 55, "give dt"),
        (
            "scheme = \"respa\"\nratio = 4\nfine = [\"middle\", \"thin\"]",
            59,
            "overlap",
        ),
        (
            "scheme = \"respa\"\nratio = 4\nfine = \"thin\"",
            59,
            "at least a horizon",
        ),
        (
            "scheme = \"rk4-mts\"\nratio = 4\nfine = \"middle\"\ndt = \"1 us\"",
            60,
            "rk4-mts needs dt",
        ),
    ] {
        let error = refusal(&plate_with_time(time));
        let message = error.to_string();
        assert!(message.contains(words), "{message}");
        assert_eq!(error.problems()[0].location().line(), line, "{message}");
    }
    let unbreakable = plate_with_time("scheme = \"respa\"\nratio = 4\nadaptive = {}")
        .replace("fracture_energy = \"135 J/m2\"\n", "");
    let error = refusal(&unbreakable);
    assert!(error.to_string().contains("never break"), "{error}");
}

/// The plate with a part of smaller cells.
fn refined(text: &str, radius: &str) -> String {
    let part = format!(
        "[[body.refine]]\nball = {{ centre = [\"10 mm\", \"5 mm\"], radius = \"{radius}\" }}\nratio = 2\n[material]"
    );
    text.replace("[material]", &part)
}

#[test]
fn parts_with_smaller_cells() {
    let text =
        plate_with_time("").replace("fracture_energy = \"135 J/m2\"", "critical_stretch = 0.002");
    let (plain, fine) = (build(&text), build(&refined(&text, "3 mm")));
    assert!(fine.cloud.len() > plain.cloud.len() && fine.form == BondForm::List);
    let volume = |model: &Model| model.cloud.volumes().iter().sum::<f64>();
    assert!((volume(&fine) / volume(&plain) - 1.0).abs() < 1e-12);
    // Half the horizon: twice the frequency, half the step.
    let ratio = plain.stable_step().unwrap() / fine.stable_step().unwrap();
    assert!((1.6..2.6).contains(&ratio), "{ratio}");
    for (text, words, marked) in [
        (refined(&text, "1 um"), "divides none", "[[body.refine]]"),
        (
            refined(&plate_with_time(""), "3 mm"),
            "give critical_stretch",
            "\"135 J/m2\"",
        ),
        (
            refined(&text, "3 mm").replace("[material]", "[material]\nbonds = \"grid\""),
            "there is no one lattice",
            "\"grid\"",
        ),
    ] {
        let error = refusal(&text);
        assert!(error.to_string().contains(words), "{error}");
        let excerpt = error.problems()[0].location().excerpt();
        assert!(excerpt.starts_with(marked), "{excerpt}");
    }
}

#[test]
fn odd_time_steps_are_warned_of() {
    let mts = "scheme = \"rk4-mts\"\nratio = 4\nfine = \"middle\"";
    for (time, words) in [
        (
            format!("{mts}\npredictor = \"backward-difference\""),
            "weakly unstable",
        ),
        (
            mts.replace("ratio = 4", "ratio = 1"),
            "both time steps are the same",
        ),
    ] {
        let model = build(&plate_with_time(&time));
        let [warning] = &model.warnings[..] else {
            panic!("one warning for {time}")
        };
        assert!(warning.line().contains(words), "{}", warning.line());
    }
    let quiet = format!("{mts}\npredictor = \"backward-difference\"\nsafety = 0.17");
    assert!(build(&plate_with_time(&quiet)).warnings.is_empty());
}

#[test]
fn a_stiff_inclusion_leaves_the_coarse_step_as_it_is() {
    let inclusion = |text: &str| {
        text.replace(
            "[sets]",
            "[[material.inclusion]]\nset = \"core\"\nstiffness = 16\n[sets]\n\
             core = { box = { min = [\"9 mm\", \"open\"], max = [\"11 mm\", \"open\"] } }",
        )
    };
    let limit = |text: &str| build(text).stable_step().unwrap();
    let mts = "scheme = \"respa\"\nratio = 4\nfine = \"middle\"";
    let plain = limit(&plate_with_time(""));
    let stiff = limit(&inclusion(&plate_with_time("")));
    let two = limit(&inclusion(&plate_with_time(mts)));
    // Bonds within the core are 16 times stiffer, those that leave it 8.5 times.
    assert!(
        stiff < 0.4 * plain && stiff > 0.25 * plain,
        "{stiff} {plain}"
    );
    assert!(two > 0.98 * plain, "{two} {plain}");
}

/// A pulse on a ring of Gaussian bonds, all of it compared with the solution.
fn ring() -> String {
    WAVE.replace("bonds = \"spectral\"\n", "")
        .replace("window = 3\n", "")
}

#[test]
fn forms_of_linear_bodies() {
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
    // Seventy neighbours on either side: by transforms.
    assert_eq!(form(&[("periodic = true", "")]), "convolution");
    let list = [
        ("periodic = true", ""),
        ("density", "bonds = \"list\"\ndensity"),
    ];
    assert_eq!(form(&list), "list");
    // Schemes with two steps take the force apart by points.
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
    assert_eq!(parse(&ring()).material.bonds.horizon, 7.0);
}

#[test]
fn a_short_period_is_warned_of() {
    let warned = build(&ring().replace("length = 20\norigin = -10", "length = 10\norigin = -5"));
    let [warning] = &warned.warnings[..] else {
        panic!("{:?}", warned.warnings)
    };
    assert!(
        warning.to_string().contains("the period of 1e1 m is short"),
        "{warning}"
    );
    assert_eq!(
        (warning.location().line(), warning.location().column()),
        (6, 12)
    );
    let window = build(&ring().replace("amplitude = 1", "amplitude = 1\nwindow = 3"));
    assert!(window.warnings.is_empty());
    let reference = window.exact.unwrap();
    assert_eq!(reference.points.len(), 60);
}

/// A bar that goes on for ever at both ends.
const BAR: &str = r#"
[body]
shape = "bar"
length = "100 mm"
spacing = "1 mm"
[material]
model = "linear"
density = "7850 kg/m3"
youngs_modulus = "210 GPa"
horizon_ratio = 3
volume_correction = "none"
[sets]
middle = { box = { min = "50 mm", max = "52 mm" } }
[[initial]]
set = "middle"
velocity = "1 m/s"
[[boundary]]
kind = "absorbing"
side = "-x"
[[boundary]]
kind = "absorbing"
side = "+x"
[time]
end = "100 us"
"#;

#[test]
fn waves_leave_through_absorbing_ends() {
    let model = build(BAR);
    assert_eq!(model.system.boundaries().count(), 2);
    let mut run = model.simulation();
    run.run(|_| pericles::Control::Continue).unwrap();
    let energies = run.snapshot().energies();
    // The shortest waves of a jump hardly travel; what left is booked.
    assert!(energies.work < -0.8 * energies.initial, "{energies:?}");
    assert!(
        energies.balance().abs() < 1e-12 * energies.initial,
        "{energies:?}"
    );
}

#[test]
fn waves_leave_in_implicit_steps_beyond_the_explicit_limit() {
    for scheme in ["implicit-midpoint", "trapezoidal"] {
        let time = format!("[time]\nscheme = \"{scheme}\"\ndt = \"1 us\"");
        let mut run = build(&BAR.replace("[time]", &time)).simulation();
        run.run(|_| pericles::Control::Continue).unwrap();
        let energies = run.snapshot().energies();
        // Long steps slow down the short waves of a jump, many of which are still under way.
        assert!(energies.work < -0.5 * energies.initial, "{energies:?}");
        assert!(
            energies.balance().abs() < 1e-11 * energies.initial,
            "{energies:?}"
        );
    }
}

#[test]
fn histories_by_exponentials_keep_their_tolerance() {
    let displacement = |text: &str| {
        let mut run = build(text).simulation();
        run.run(|_| pericles::Control::Continue).unwrap();
        run.state().u.clone()
    };
    let text = BAR.replace("[time]", "[time]\ndt = \"60 ns\"");
    let exact = displacement(&text);
    let history = "side = \"+x\"\nhistory = \"exponentials\"\ntolerance = 1e-6";
    let fitted = displacement(&text.replace("side = \"+x\"", history));
    let largest = exact.iter().fold(0.0, |a: f64, u| a.max(u.abs()));
    let pairs = exact.iter().zip(&fitted);
    let error = pairs.fold(0.0, |a: f64, (u, v)| a.max((u - v).abs())) / largest;
    assert!(error < 1e-5 && error > 0.0, "{error:e}");
}

#[test]
fn ends_that_cannot_be_continued_are_refused() {
    let cases: [(&str, &str, (usize, usize), &str); 9] = [
        (
            "[time]",
            "[time]\nscheme = \"trigonometric\"\ndt = \"1 us\"",
            (24, 10),
            "past any layer of ghosts",
        ),
        (
            "side = \"+x\"\n[time]",
            "side = \"+x\"\nexterior_data = \"9 mm\"\n[time]\nscheme = \"implicit-midpoint\"\ndt = \"1 us\"",
            (20, 1),
            "exterior_data needs scheme = \"velocity-verlet\"",
        ),
        (
            "side = \"+x\"",
            "side = \"-x\"",
            (20, 1),
            "two absorbing ends at -x",
        ),
        (
            "[time]",
            "[time]\nscheme = \"rk4\"",
            (24, 10),
            "made for velocity-verlet, implicit-midpoint or trapezoidal, not for rk4",
        ),
        ("[time]", "[time]\ndt = \"1 us\"", (24, 6), "is unstable"),
        (
            "set = \"middle\"\n",
            "",
            (16, 1),
            "the initial field reaches the end -x: point 0 has 1e0",
        ),
        (
            "[[initial]]",
            "[sets.left]\nlayer = { side = \"-x\", cells = 2 }\n[[material.inclusion]]\nset = \"left\"\nstiffness = 2\n[[initial]]",
            (22, 1),
            "the outer layer at -x is not homogeneous: the bond from point",
        ),
        (
            "[[initial]]",
            "[[load]]\nset = \"all\"\nbody_force = 1\n[[initial]]",
            (20, 1),
            "a load acts on point 0",
        ),
        (
            "volume_correction = \"none\"",
            "critical_stretch = 0.01",
            (17, 1),
            "its 3 outermost points must be in `no_fail`",
        ),
    ];
    for (replace, by, (line, column), says) in cases {
        assert_eq!(BAR.matches(replace).count(), 1, "{replace}");
        let error = refusal(&BAR.replace(replace, by));
        let message = error.to_string();
        assert!(
            message.contains(&format!("deck.toml:{line}:{column}:")),
            "{message}"
        );
        assert!(message.contains(says), "{message}");
    }
}

/// A bar of ten cells whose ends are driven and loaded by expressions.
const EXPRESSIONS: &str = r#"
[body]
shape = "bar"
length = 1.0
spacing = 0.1
[material]
density = 1
youngs_modulus = 1
horizon_ratio = 3
[sets]
left = { layer = { side = "-x", cells = 1 } }
right = { layer = { side = "+x", cells = 3 } }
[[initial]]
displacement = { expression = "1e-3*exp(-(x/0.2)^2)" }
velocity = { expression = "-x^2" }
[[prescribe]]
set = "left"
velocity = { expression = "x*cos(3*t)" }
until = 0.5
[[prescribe]]
set = "right"
displacement = { expression = "1e-2*x*t^2" }
[[load]]
set = "right"
body_force = { expression = "x*sin(t)" }
function = { kind = "table", rows = [[0, 2], [1, 4]] }
from = 0.25
[time]
end = 1.0
dt = 1e-3
"#;

#[test]
fn expressions_become_fields_of_place_and_time() {
    let model = build(EXPRESSIONS);
    for i in 0..10 {
        let x = 0.05 + 0.1 * i as f64;
        assert!((model.state.u[i] - 1e-3 * (-(x / 0.2).powi(2)).exp()).abs() < 1e-15);
        assert!((model.state.v[i] + x * x).abs() < 1e-15);
    }
    let start = model.state.u[0];
    let resultant = |t: f64| model.system.loads()[0].resultant(t, &model.cloud)[0];
    let exact = |t: f64| (0.75 + 0.85 + 0.95) * 0.1 * t.sin() * (2.0 + 2.0 * t);
    assert!((resultant(0.8) - exact(0.8)).abs() < 1e-12);
    assert_eq!(resultant(0.2), 0.0);

    // The motion is exact at the end of every step, and the left end is free once it is released.
    let (dt, mut held, mut simulation) = (model.dt, 0, model.simulation());
    simulation
        .run(|simulation| {
            let state = simulation.state();
            assert!((state.u[9] - 1e-2 * 0.95 * state.t.powi(2)).abs() < 1e-13);
            let expected = start + 0.05 * (3.0 * state.t).sin() / 3.0;
            let follows = (state.u[0] - expected).abs() < 1e-12;
            assert_eq!(follows, state.t <= 0.5 + 1e-9, "{}", state.t);
            held += u64::from(follows);
            pericles::Control::Continue
        })
        .unwrap();
    assert_eq!(held, (0.5 / dt + 1e-9) as u64);
    let energies = simulation.snapshot().energies();
    assert!(
        energies.balance().abs() < 1e-3 * energies.kinetic,
        "{energies:?}"
    );
}

#[test]
fn expressions_that_cannot_move_a_body_are_refused() {
    let cases = [
        ("x*cos(3*t)", "x*floor(t)", "has no derivative in time"),
        ("1e-3*exp(-(x/0.2)^2)", "sqrt(0.5-x)", "has no finite value"),
        ("x*sin(t)", "1/(t*x)", "has no finite value"),
    ];
    for (right, wrong, says) in cases {
        let error = refusal(&EXPRESSIONS.replace(right, wrong)).to_string();
        assert!(error.contains(says) && error.contains(wrong), "{error}");
    }
    let both = EXPRESSIONS.replace(
        "until = 0.5",
        "function = { kind = \"ramp\", duration = 1 }",
    );
    assert!(
        refusal(&both)
            .to_string()
            .contains("takes no function of time")
    );
}

#[test]
fn waves_that_the_grid_distorts_are_warned_of() {
    let bar = |rest: &str| {
        let text = format!(
            r#"
[body]
shape = "bar"
length = 10.0
spacing = 0.02
[material]
density = 1
youngs_modulus = 1
horizon_ratio = 3
[sets]
right = {{ layer = {{ side = "+x", cells = 3 }} }}
[time]
end = 5.0
{rest}"#
        );
        let deck = parse(&text);
        let model = deck.build().unwrap();
        let warnings = deck.judge_waves(&model);
        warnings.iter().map(|w| w.line()).collect::<Vec<_>>()
    };
    let initial = |field: &str, width: f64| {
        bar(&format!(
            "[[initial]]\n{field} = {{ expression = \"exp(-((x-5)/{width})^2)\" }}"
        ))
    };
    // wide and narrow humps
    for field in ["displacement", "velocity"] {
        assert!(initial(field, 0.5).is_empty());
        let narrow = initial(field, 0.03);
        assert_eq!(narrow.len(), 1, "{narrow:?}");
        assert!(
            narrow[0].contains("% of the energy of this initial"),
            "{narrow:?}"
        );
    }
    let pulse = |what: &str, duration: f64| {
        bar(&format!(
            "{what}\nset = \"right\"\nfunction = {{ kind = \"pulse\", duration = {duration} }}"
        ))
    };
    for what in [
        "[[load]]\nbody_force = 1",
        "[[prescribe]]\nvelocity = 1",
        "[[prescribe]]\ndisplacement = 1",
    ] {
        assert!(pulse(what, 2.0).is_empty(), "{what}");
        assert_eq!(pulse(what, 0.05).len(), 1, "{what}");
    }
}

#[test]
fn surfaces_come_from_files_handed_in() {
    use pericles::space::surface::Surface;
    use pericles_deck::Resources;
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
    let built = |surface: fn() -> Result<Surface, String>| {
        deck.build_with(Resources {
            read_surface: &|path| {
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
    // A triangle is left out: the surface is open.
    let open = || {
        let sphere = Surface::icosphere(2, 1.0).unwrap();
        Surface::new(
            sphere.positions().to_vec(),
            sphere.triangles()[1..].to_vec(),
        )
        .map_err(|error| error.to_string())
    };
    let message = |result: Result<Model, DeckError>| match result {
        Ok(_) => panic!("refused"),
        Err(error) => error.to_string(),
    };
    let error = message(built(open));
    assert!(
        error.starts_with("decks/ball.toml:4:8:") && error.contains("ball.stl gives no surface"),
        "{error}"
    );
    let error = message(built(|| Err("line 3: no number".into())));
    assert!(error.contains("line 3: no number"), "{error}");
    // Nobody hands in a reader.
    assert!(message(deck.build()).contains("handed in"));
    let cells = text.replace(
        "[material]",
        "[sets]\ncap = { layer = { side = \"+z\", cells = 1 } }\n[material]",
    );
    let error = Deck::parse(&cells, "ball.toml", &[])
        .unwrap_err()
        .to_string();
    assert!(error.contains("no cells of one size"), "{error}");
}

#[test]
fn cells_of_two_lengths_carry_uniform_strain() {
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
    assert_eq!(model.form.name(), "list");
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
    // The dispersion tool sees the same bonds.
    let deck = parse(text);
    let spacing = deck.bond_lattice(&model).unwrap().spacing();
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

/// A plate of 12 × 6 cells of 1 mm as a list of points in no order, with its right third as block 2.
fn listed_plate(volume: f64) -> pericles::space::ListedPoints {
    let mut listed = pericles::space::ListedPoints::default();
    for k in 0..72 {
        // 5 and 72 have no common divisor: every cell once.
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
fn listed_points_are_the_body_of_the_grid() {
    use pericles::operator::On;
    use pericles_deck::Resources;
    let built = |text: &str, volume: f64| {
        let deck = Deck::parse(text, "decks/plate.toml", &[]).unwrap();
        deck.build_with(Resources {
            read_points: &|path, dimension| {
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
    // The same plate as a grid: equal forces, to round-off.
    let grid = LISTED
        .replace(
            "\"points\"\nfile = \"plate.txt\"\ndimension = 2",
            "\"plate\"\nsize = [\"12 mm\", \"6 mm\"]",
        )
        .replace("block = 2", "where = \"x > 0.008\"");
    let grid = build(&grid);
    let displaced = |model: &Model| -> Vec<f64> {
        let places = (0..72).map(|i| model.cloud.point(i));
        let u: Vec<[f64; 2]> = places
            .map(|[x, y, _]| [1e-2 * x * x / 1e-3, 2e-3 * (x - y)])
            .collect();
        (0..2).flat_map(|c| u.iter().map(move |u| u[c])).collect()
    };
    let forces = |model: &Model| {
        let u = displaced(model);
        let mut force = vec![0.0; 144];
        model
            .system
            .operator()
            .add_force(0.0, &u, On::All, &mut force);
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
    // Volumes in mm³, a set without points, a traction without area.
    let refused =
        |text: &str, volume: f64| built(text, volume).map(|_| ()).unwrap_err().to_string();
    let error = refused(LISTED, 2.0);
    assert!(
        error.contains("plate.toml:6:11: the volumes of the listed points"),
        "{error}"
    );
    assert!(
        error.contains("volumes in m³; `thickness` is part"),
        "{error}"
    );
    let error = refused(&LISTED.replace("block = 2", "block = 3"), cell);
    assert!(
        error.contains("the set `right` selects no point"),
        "{error}"
    );
    let error = refused(&LISTED.replace("area = \"12 mm2\"", ""), cell);
    assert!(error.contains("listed points have no faces"), "{error}");
    assert!(refusal(LISTED).to_string().contains("handed in"));
}

/// A bar of 20 cells, held at its left end and pulled at its right one, in two materials.
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
[[material.part]]
name = "glue"
set = "middle"
density = "1200 kg/m3"
youngs_modulus = "7 GPa"
critical_stretch = 0.01
[material.interface]
rule = "weaker"
pair = [{ between = ["glue", "steel"], critical_stretch = 0.005 }]
[sets]
left = { where = "x < 0.003" }
middle = { where = "0.009 < x < 0.011" }
right = { layer = { side = "+x", cells = 3 } }
[[prescribe]]
set = "left"
displacement = [0]
[[load]]
set = "right"
traction = ["1 MPa"]
[time]
scheme = "relaxation"
load_steps = 4
"#;

#[test]
fn parts_have_their_own_density_and_strength() {
    let model = build(STATIC);
    assert_eq!(
        (model.steps, model.dt, model.form),
        (4, 0.25, BondForm::List)
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
    assert_eq!(lines.len(), 1, "{lines:?}");
    assert!(
        lines[0].contains("deck.toml:12:20: bonds break beyond a stretch of 30 %"),
        "{lines:?}"
    );
}

#[test]
fn what_makes_no_physical_sense_is_said() {
    let warned = |replace: &str, by: &str, says: &str| {
        let text = STATIC.replace("0.3\n", "0.1\n");
        let lines: Vec<String> = build(&text.replace(replace, by))
            .warnings
            .iter()
            .map(|warning| warning.line())
            .collect();
        assert!(lines.iter().any(|line| line.contains(says)), "{lines:?}");
    };
    warned(
        "set = \"right\"",
        "set = \"left\"\narea = \"4 mm2\"",
        "all 3 points of this load are held along it",
    );
    warned(
        "[time]",
        "[[crack]]\nsection = \"15 mm\"\n[time]",
        "5 of 20 points, such as that at (0.015",
    );
    let refused = |replace: &str, by: &str, says: &[&str]| {
        let message = refusal(&STATIC.replace(replace, by)).to_string();
        assert!(
            says.iter().all(|words| message.contains(words)),
            "{message}"
        );
    };
    refused(
        "horizon_ratio = 3",
        "horizon = \"1e6 m\"",
        &["deck.toml:11:11", "is a unit wrong?"],
    );
    refused(
        "[sets]",
        "[[material.part]]\nname = \"more\"\nset = \"middle\"\ndensity = 1\nyoungs_modulus = 1\n[sets]",
        &["the part `glue` has no point"],
    );
}

#[test]
fn fields_go_on_beyond_an_end() {
    // A bell at the end of the short bar, in the middle of the long one.
    let bell = BAR.replace(
        "set = \"middle\"\nvelocity = \"1 m/s\"",
        "displacement = { expression = \"1e-6*exp(-((x-0.095)/0.01)^2)\" }",
    );
    let bell = bell.replace("[time]", "[time]\ndt = \"60 ns\"");
    let displacement = |text: &str| {
        let mut run = build(text).simulation();
        run.run(|_| pericles::Control::Continue).unwrap();
        run.state().u.clone()
    };
    let long = displacement(&bell.replace("100 mm", "200 mm"));
    let data = "side = \"+x\"\nexterior_data = \"70 mm\"";
    let short = displacement(&bell.replace("side = \"+x\"", data));
    let pairs = long.iter().zip(&short);
    let error = pairs.fold(0.0, |a: f64, (u, v)| a.max((u - v).abs()));
    assert!(error < 1e-12 * 1e-6 * 10.0, "{error:e}");
    // Without, the field is refused; with too little, too.
    let message = refusal(&bell).to_string();
    assert!(message.contains("exterior_data"), "{message}");
    let message = refusal(&bell.replace("side = \"+x\"", &data.replace("70", "20"))).to_string();
    assert!(message.contains("does not die away"), "{message}");
}

#[test]
fn histories_say_how_they_are_made() {
    let ends =
        |keys: &str| build(&BAR.replace("side = \"+x\"", &format!("side = \"+x\"\n{keys}"))).ends;
    let (side, report) = ends("")[1];
    assert_eq!((side.name(), report.history), ("+x", "direct"));
    let (_, report) = ends("history = \"exponentials\"\nverify = true")[1];
    assert!(report.exponentials.unwrap() > 3 && report.residual.unwrap() < 1e-9);
    assert!(report.distance.unwrap() < 1e-8, "{report:?}");
    let warned = build(&BAR.replace("side = \"+x\"", "side = \"+x\"\nmethod = \"historical\""));
    let says = warned.warnings.iter().map(|w| w.line()).collect::<String>();
    assert!(says.contains("their errors grow with time"), "{says}");
}

#[test]
fn damping_layers_absorb() {
    let text = BAR.replace(
        "kind = \"absorbing\"\nside = \"+x\"",
        "kind = \"damping-layer\"\nside = \"+x\"\nthickness = \"40 mm\"",
    );
    // The layer takes some of the margin of the step.
    let text = text.replace("[time]", "[time]\nsafety = 0.7");
    let mut run = build(&text).simulation();
    run.run(|_| pericles::Control::Continue).unwrap();
    let energies = run.snapshot().energies();
    assert!(energies.work < -0.8 * energies.initial, "{energies:?}");
    assert!(
        energies.balance().abs() < 1e-12 * energies.initial,
        "{energies:?}"
    );
    let message = refusal(&text.replace("40 mm", "100 mm")).to_string();
    assert!(message.contains("less than the body"), "{message}");
}
